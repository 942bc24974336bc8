#include "schema/agraph_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

double Round(double value, double step) {
  const double rounded = std::round(value / step) * step;
  // Through text: the shortest decimal, and never -0.
  return rounded == 0 ? 0 : std::round(rounded * 1e12) / 1e12;
}
double Metres(double v) { return Round(v, 1e-4); }
Json Point(const Eigen::Vector2d& p) { return Json::array({Metres(p.x()), Metres(p.y())}); }
Json Point(const Eigen::Vector3d& p) { return Json::array({Metres(p.x()), Metres(p.y()), Metres(p.z())}); }
Json Direction(const Eigen::Vector3d& n) { return Json::array({Round(n.x(), 1e-9), Round(n.y(), 1e-9), Round(n.z(), 1e-9)}); }
double Radians(double v) { return Round(v, 1e-7); }

Json Points(const Ring& ring) {
  Json out = Json::array();
  for (const auto& p : ring) out.push_back(Point(p));
  return out;
}

template <class Tag>
Json Reference(Id<Tag> id) {
  return id.valid() ? Json(id.value) : Json(nullptr);
}

template <class Tag>
Json Ids(const std::vector<Id<Tag>>& ids) {
  Json out = Json::array();
  for (Id<Tag> id : ids) out.push_back(id.value);
  return out;
}

// Of a doorway, with `opens_to` as a position in its `rooms`.
Json Leaves(const Doorway& d) {
  Json out = Json::array();
  for (const DoorLeaf& l : d.leaves) {
    Json entry;
    entry["operation"] = l.operation == LeafOperation::kUnknown ? Json(nullptr) : Json(NameOf(l.operation));
    entry["jamb"] = l.jamb == Jamb::kUnknown ? Json(nullptr) : Json(l.jamb == Jamb::kLeft ? "left" : "right");
    entry["opens_to"] = l.opens_to == DoorwaySide::kUnknown ? Json(nullptr) : Json(l.opens_to == DoorwaySide::kRoomA ? 0 : 1);
    entry["width_m"] = l.width_m > 0 ? Json(Metres(l.width_m)) : Json(nullptr);
    out.push_back(std::move(entry));
  }
  return out;
}

// The entries that every array has: id, guid, name, storey.
Json Entry(size_t id, const std::string& guid, const std::string& name, StoreyId storey) {
  Json out;
  out["id"] = id;
  out["guid"] = guid.empty() ? Json(nullptr) : Json(guid);
  out["name"] = name;
  out["storey"] = Reference(storey);
  return out;
}

Json Storeys(const AGraph& g) {
  Json out = Json::array();
  for (size_t i = 0; i < g.storeys.size(); ++i) {
    const Storey& s = g.storeys[i];
    Json entry = Entry(i, s.guid, s.name, StoreyId(i));
    entry["elevation_m"] = Metres(s.elevation_m);
    entry["height_m"] = Metres(s.height_m);
    out.push_back(std::move(entry));
  }
  return out;
}

Json Walls(const AGraph& g) {
  Json out = Json::array();
  for (size_t i = 0; i < g.walls.size(); ++i) {
    const Wall& w = g.walls[i];
    Json entry = Entry(i, w.guid, w.name, w.storey);
    entry["type"] = w.type;
    entry["axis"] = Json::array({Point(w.axis_start), Point(w.axis_end)});
    entry["thickness_m"] = Metres(w.thickness_m);
    entry["z_min_m"] = Metres(w.z_min_m);
    entry["z_max_m"] = Metres(w.z_max_m);
    entry["external"] = w.external;
    out.push_back(std::move(entry));
  }
  return out;
}

Json Surfaces(const AGraph& g) {
  Json out = Json::array();
  for (size_t i = 0; i < g.surfaces.size(); ++i) {
    const Surface& s = g.surfaces[i];
    const Wall& wall = g.walls[s.wall.index()];
    Json entry = Entry(i, wall.guid, wall.name, s.storey);
    entry["wall"] = s.wall.value;
    entry["room"] = Reference(s.room);
    entry["normal"] = Direction(s.normal);
    entry["d_m"] = Metres(s.d_m);
    entry["segment"] = Json::array({Point(s.start), Point(s.end)});
    entry["z_min_m"] = Metres(s.z_min_m);
    entry["z_max_m"] = Metres(s.z_max_m);
    if (s.arc) {
      entry["arc"] = {{"center", Point(s.arc->center)},
                      {"radius_m", Metres(s.arc->radius_m)},
                      {"start_rad", Radians(s.arc->start_rad)},
                      {"sweep_rad", Radians(s.arc->sweep_rad)}};
    }
    out.push_back(std::move(entry));
  }
  return out;
}

Json Rooms(const AGraph& g) {
  Json out = Json::array();
  for (size_t i = 0; i < g.rooms.size(); ++i) {
    const Room& r = g.rooms[i];
    Json entry = Entry(i, r.guid, r.name, r.storey);
    entry["polygon"] = Points(r.polygon);
    entry["holes"] = Json::array();
    for (const Ring& hole : r.holes) entry["holes"].push_back(Points(hole));
    entry["area_m2"] = Metres(r.area_m2);
    entry["center"] = Point(r.center);
    entry["yaw_rad"] = Radians(r.yaw_rad);
    entry["floor_z_m"] = Metres(r.floor_z_m);
    entry["ceiling_z_m"] = Metres(r.ceiling_z_m);
    entry["surfaces"] = Ids(r.surfaces);
    out.push_back(std::move(entry));
  }
  return out;
}

Json Doorways(const AGraph& g) {
  Json out = Json::array();
  for (size_t i = 0; i < g.doorways.size(); ++i) {
    const Doorway& d = g.doorways[i];
    Json entry = Entry(i, d.guid, d.name, d.storey);
    entry["rooms"] = Json::array({Reference(d.room_a), Reference(d.room_b)});
    entry["wall"] = Reference(d.wall);
    entry["position"] = Point(d.position);
    entry["yaw_rad"] = Radians(d.yaw_rad);
    entry["width_m"] = Metres(d.width_m);
    entry["height_m"] = Metres(d.height_m);
    entry["has_leaf"] = d.has_leaf;
    entry["leaves"] = Leaves(d);
    out.push_back(std::move(entry));
  }
  return out;
}

Json Windows(const AGraph& g) {
  Json out = Json::array();
  for (size_t i = 0; i < g.windows.size(); ++i) {
    const Window& w = g.windows[i];
    Json entry = Entry(i, w.guid, w.name, w.storey);
    entry["wall"] = Reference(w.wall);
    entry["position"] = Point(w.position);
    entry["yaw_rad"] = Radians(w.yaw_rad);
    entry["width_m"] = Metres(w.width_m);
    entry["height_m"] = Metres(w.height_m);
    out.push_back(std::move(entry));
  }
  return out;
}

Json Columns(const AGraph& g) {
  Json out = Json::array();
  for (size_t i = 0; i < g.columns.size(); ++i) {
    const Column& c = g.columns[i];
    Json entry = Entry(i, c.guid, c.name, c.storey);
    entry["outline"] = Points(c.outline);
    entry["z_min_m"] = Metres(c.z_min_m);
    entry["z_max_m"] = Metres(c.z_max_m);
    out.push_back(std::move(entry));
  }
  return out;
}

Json OpenBoundaries(const AGraph& g) {
  Json out = Json::array();
  for (size_t i = 0; i < g.open_boundaries.size(); ++i) {
    const OpenBoundary& b = g.open_boundaries[i];
    Json entry = Entry(i, "", "", b.storey);
    entry["rooms"] = Json::array({Reference(b.room_a), Reference(b.room_b)});
    entry["segment"] = Json::array({Point(b.start), Point(b.end)});
    out.push_back(std::move(entry));
  }
  return out;
}

Json Aliases(const AGraph& g) {
  Json out = Json::array();
  for (const Alias& a : g.aliases) {
    out.push_back({{"yaw_rad", Radians(a.yaw_rad)},
                   {"translation", Point(a.translation)},
                   {"closed", a.closed},
                   {"overlap_ratio", Round(a.overlap_ratio, 1e-4)},
                   {"tolerance_m", Metres(a.tolerance_m)},
                   {"section_length_m", Metres(a.section_length_m)},
                   {"storeys", Json::array({Reference(a.from_storey), Reference(a.to_storey)})},
                   {"rooms", Ids(a.rooms)},
                   {"twins", Ids(a.twins)},
                   {"differences", Json::array()}});
    for (ElementId e : a.differences) {
      const Element& element = g.elements[e.index()];
      out.back()["differences"].push_back({{"guid", element.guid}, {"name", element.name}, {"type", element.type}});
    }
  }
  return out;
}

Json AllLookAlikes(const AGraph& g) {
  Json out = Json::array();
  for (const LookAlikes& l : g.look_alikes) out.push_back(Ids(l.rooms));
  return out;
}

}  // namespace

const char* NameOf(LeafOperation operation) {
  switch (operation) {
    case LeafOperation::kUnknown: break;
    case LeafOperation::kSwing: return "swing";
    case LeafOperation::kDoubleActing: return "double-acting";
    case LeafOperation::kSliding: return "sliding";
    case LeafOperation::kFolding: return "folding";
    case LeafOperation::kRevolving: return "revolving";
    case LeafOperation::kLifting: return "lifting";
    case LeafOperation::kFixed: return "fixed";
  }
  return "unknown";
}

std::string AGraphToJson(const AGraph& g) {
  Json out;
  out["schema"] = std::to_string(kSchemaMajor) + "." + std::to_string(kSchemaMinor);
  out["source"] = {{"path", g.source_path}, {"format", g.source_format}, {"sha256", g.source_sha256}};
  if (g.true_north_rad) out["true_north_rad"] = Radians(*g.true_north_rad);
  out["storeys"] = Storeys(g);
  out["walls"] = Walls(g);
  out["surfaces"] = Surfaces(g);
  out["rooms"] = Rooms(g);
  out["doorways"] = Doorways(g);
  out["windows"] = Windows(g);
  out["columns"] = Columns(g);
  out["open_boundaries"] = OpenBoundaries(g);
  out["aliases"] = Aliases(g);
  out["look_alikes"] = AllLookAlikes(g);
  // Bytes that are no UTF-8 (a damaged name) become U+FFFD instead of an exception.
  return out.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace plumb
