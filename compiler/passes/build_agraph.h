// All passes in order: PlanIr -> FloorIr -> A-Graph.
#pragma once

#include <optional>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/ir/floor_ir.h"
#include "compiler/passes/assign_storeys.h"
#include "compiler/passes/bridge_gaps.h"
#include "compiler/passes/divide_rooms.h"
#include "compiler/passes/doorways.h"
#include "compiler/passes/host_openings.h"
#include "compiler/passes/name_rooms.h"
#include "compiler/passes/planar_map.h"
#include "compiler/passes/rooms.h"
#include "compiler/passes/wall_arcs.h"
#include "compiler/passes/wall_footprints.h"
#include "compiler/passes/wall_surfaces.h"

namespace plumb::compiler {

struct PassOptions {
  double section_height_m = 1.1;  // walls are cut here above the zero of their level's highest storey
  bool verify = false;            // run the verifiers of PlanIr and FloorIr; a fault is an InternalError and ends the passes
  StoreyOptions storeys;
  FootprintOptions footprints;
  PlanarMapOptions planar_map;
  BridgeOptions bridges;
  DivideOptions division;
  WallArcOptions arcs;
  RoomOptions rooms;
  NamingOptions naming;
  SurfaceOptions surfaces;
  HostingOptions hosting;
  DoorwayOptions doorways;
  [[nodiscard]] std::string Check() const;
};

struct Built {
  FloorIr floors;
  AGraph graph;
};

// PlanIr to FloorIr. Sets the storeys of elements and spaces in `plan`.
[[nodiscard]] std::optional<FloorIr> BuildFloors(PlanIr& plan, const PassOptions& options, DiagnosticSink& sink);

// Every table of the A-Graph except mesh, provenance and diagnostics, which emit adds; frame: as PlanIr (origin not added yet).
// graph.elements has one entry per PlanIr::elements. None: the plan was not usable, and an error in `sink` says why.
[[nodiscard]] std::optional<Built> BuildAGraph(PlanIr& plan, const PassOptions& options, DiagnosticSink& sink);

}  // namespace plumb::compiler
