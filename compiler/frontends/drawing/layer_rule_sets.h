// The built-in rules for layers. Ignored layers come first: `A-WALL-PATT` is no wall, `Türbeschriftung` no door.
#pragma once

#include <array>

namespace plumb::compiler {

inline constexpr std::array<const char*, 7> kLayerRuleSets = {
    R"(name = "aia"
[[rule]]
use = "ignore"
names = ["?-????-PATT*", "?-????-IDEN*", "?-????-DIMS*", "?-????-TEXT*", "?-????-NOTE*", "?-ANNO*", "?-DIMS*", "?-NOTE*", "?-TEXT*", "?-FURN*", "?-FLOR*", "?-EQPM*",
  "?-CLNG*", "?-ROOF*", "?-FIXT*", "?-CASE*", "?-HEADER*", "?-BEAM*", "?-FOOT*", "?-STEM*", "?-SLAB*", "?-FNDN*", "?-GRID*", "?-DETL*", "?-SECT*", "?-ELEV*",
  "?-HATCH*", "?-PATT*", "?-STRS*", "?-HRAL*", "?-SITE*", "?-PROP*", "?-PLNT*", "E-*", "M-*", "P-*", "L-*", "C-*", "V-*", "DEFPOINTS"]
[[rule]]
use = "room-name"
names = ["?-AREA-IDEN*", "?-ROOM*", "?-AREA-NAME*", "?-SPCE*"]
[[rule]]
use = "ignore"
names = ["?-AREA*"]
[[rule]]
use = "column"
names = ["?-COLS*"]
[[rule]]
use = "door"
names = ["?-DOOR*", "?-GARAGE-DOOR*"]
[[rule]]
use = "window"
names = ["?-GLAZ*", "?-WIND*"]
[[rule]]
use = "opening"
names = ["?-OPEN*", "?-OPNG*"]
[[rule]]
use = "wall"
names = ["?-WALL*", "?-PRTN*", "?-CORE*"]
)",
    R"(name = "english"
[[rule]]
use = "ignore"
layers = ["dim*", "anno*", "text*", "note*", "furn*", "hatch*", "grid*", "axis", "axes", "fixture*", "equip*", "ceiling*", "roof*", "stair*", "elec*", "plumb*", "title*", "border*",
  "viewport*", "defpoints", "site", "landscape", "tree*", "sanitary", "casework", "kitchen", "symbol*"]
[[rule]]
use = "room-name"
layers = ["room*", "space*"]
[[rule]]
use = "column"
layers = ["column*", "pillar*", "pier*"]
[[rule]]
use = "door"
layers = ["door*"]
[[rule]]
use = "window"
layers = ["window*", "glaz*", "glass"]
[[rule]]
use = "opening"
layers = ["opening*"]
[[rule]]
use = "wall"
layers = ["wall*", "*wall", "*walls", "partition*", "structure", "structural", "masonry", "brick*"]
)",
    R"(name = "german"
[[rule]]
use = "ignore"
layers = ["bema*", "*bemassung*", "*bemaßung*", "*beschriftung*", "text*", "*text", "*schraffur*", "möb*", "moeb*", "moeb*", "mobiliar*", "einricht*", "achse*", "raster", "sanit*",
  "treppe*", "dach*", "decke*", "elektro*", "rahmen", "plankopf", "gelände", "defpoints", "höhen*", "maß*", "mass", "masse"]
[[rule]]
use = "room-name"
layers = ["raum*", "räume*", "raeume*", "zimmer*"]
[[rule]]
use = "column"
layers = ["stütze*", "stuetze*", "*stützen", "säule*", "saeule*", "pfeiler*"]
[[rule]]
use = "door"
layers = ["tür*", "tuer*", "*türen", "*tueren", "*tür", "*tuer", "tor", "tore"]
[[rule]]
use = "window"
layers = ["fenster*", "*fenster", "verglas*"]
[[rule]]
use = "opening"
layers = ["öffnung*", "oeffnung*", "*öffnungen"]
[[rule]]
use = "wall"
layers = ["*wand", "*wände", "*waende", "wand*", "wände*", "waende*", "mauer*", "*mauer", "*mauern", "*mauerwerk", "rohbau"]
)",
    R"(name = "french"
[[rule]]
use = "ignore"
layers = ["cot*", "texte*", "hachure*", "mobilier*", "meuble*", "axe", "axes", "sanitaire*", "escalier*", "toit*", "toiture*", "plafond*", "elec*", "élec*", "cartouche", "defpoints"]
[[rule]]
use = "room-name"
layers = ["piece*", "pièce*", "local", "locaux", "nom", "noms", "salle*"]
[[rule]]
use = "column"
layers = ["poteau*", "pilier*", "colonne*"]
[[rule]]
use = "door"
layers = ["porte", "portes", "huisserie*"]
[[rule]]
use = "window"
layers = ["fenetre*", "fenêtre*", "vitrage*", "baie*", "chassis", "châssis"]
[[rule]]
use = "opening"
layers = ["ouverture*", "menuiserie*"]
[[rule]]
use = "wall"
layers = ["mur", "murs", "cloison*", "maçonnerie*", "maconnerie*", "refend*", "voile*", "facade*", "façade*"]
)",
    R"(name = "italian"
[[rule]]
use = "ignore"
layers = ["quot*", "testi", "testo*", "retino*", "campitur*", "arred*", "mobili*", "assi", "sanitari*", "scal*", "tetto", "copertura", "impiant*", "defpoints"]
[[rule]]
use = "room-name"
layers = ["stanz*", "local*", "vano", "vani", "ambient*"]
[[rule]]
use = "column"
layers = ["pilastr*", "colonn*"]
[[rule]]
use = "door"
layers = ["port*"]
[[rule]]
use = "window"
layers = ["finestr*", "vetr*"]
[[rule]]
use = "opening"
layers = ["apertur*", "infiss*", "serrament*"]
[[rule]]
use = "wall"
layers = ["mur*", "paret*", "tramezz*", "divisor*", "tamponament*"]
)",
    R"(name = "spanish"
[[rule]]
use = "ignore"
layers = ["cota*", "texto*", "sombreado*", "trama*", "mobiliario*", "mueble*", "eje", "ejes", "sanitario*", "escalera*", "techo*", "cubierta*", "electric*", "defpoints"]
[[rule]]
use = "room-name"
layers = ["local*", "recinto*", "habitacion*", "habitación*", "estancia*", "espacio*"]
[[rule]]
use = "column"
layers = ["columna*", "pilar*"]
[[rule]]
use = "door"
layers = ["puerta*"]
[[rule]]
use = "window"
layers = ["ventana*", "vidrio*"]
[[rule]]
use = "opening"
layers = ["abertura*", "hueco*", "carpinter*", "vano*"]
[[rule]]
use = "wall"
layers = ["muro*", "pared*", "tabique*", "tabiquer*", "fachada*"]
)",
    R"(name = "none"
[[rule]]
use = "ignore"
layers = ["dim*", "hatch*", "furn*", "defpoints", "anno*"]
)"};

}  // namespace plumb::compiler
