// The leaves of the doors of an IFC file: how they open as stated (OperationType of the door, its type or its style), and as drawn.
#pragma once

#include <Eigen/Geometry>
#include <unordered_map>
#include <vector>

#include "compiler/frontends/ifc/ifc_curves.h"
#include "compiler/frontends/ifc/ifc_door_operations.h"
#include "compiler/frontends/ifc/ifc_relations.h"
#include "compiler/ir/plan_ir.h"

namespace plumb::compiler {

class DoorReader {
 public:
  // What is passed must outlive the reader.
  DoorReader(const IfcModel& model, PlacementReader& placements, const Relations& relations)
      : model_(model), placements_(placements), relations_(relations), curves_(model, placements, kChord_m) {}

  // Of an IfcDoor. IFC has a door open along the y axis of its placement and calls left what is so for who looks that way (low x). What its
  // type states is in the type's frame: a mapped item that mirrors the type's shape mirrors that, too. What is not stated is taken from
  // the swings among the curves of its representations.
  [[nodiscard]] std::vector<PlanLeaf> Leaves(uint32_t door) const;

 private:
  static constexpr double kChord_m = 0.01;  // only exact arcs are looked at, not their steps

  // A swing in the door's frame.
  struct Swing {
    Eigen::Vector3d hinge, start, end;
  };

  // In the door's frame.
  [[nodiscard]] std::vector<FramedLeaf> Stated(const IfcInstance& door, const IfcInstance& type, double door_width_m) const;
  // `mirrored`: the type's left is the leaves' right.
  void AddPanelWidths(const IfcInstance& type, double door_width_m, bool mirrored, std::vector<FramedLeaf>& leaves) const;
  [[nodiscard]] Eigen::Matrix3d FrameOfType(const IfcInstance& door, const IfcInstance& type) const;
  [[nodiscard]] std::vector<FramedLeaf> Drawn(const IfcInstance& door, double door_width_m) const;
  void AddSwings(const IfcInstance& item, const Eigen::Affine3d& T_door_item, int depth, std::vector<Swing>& swings) const;
  // Of an IfcRepresentationMap, in its own frame.
  [[nodiscard]] const std::vector<Swing>& InMap(const IfcInstance& map, int depth) const;
  // Of an IfcMappedItem: how it lays the mapped representation.
  [[nodiscard]] Eigen::Affine3d Mapping(const IfcInstance& item, const IfcInstance& map) const;
  [[nodiscard]] std::vector<IfcInstance> Items(const IfcInstance& door) const;  // of all its representations

  const IfcModel& model_;
  PlacementReader& placements_;
  const Relations& relations_;
  CurveReader curves_;
  mutable std::unordered_map<uint32_t, std::vector<Swing>> in_map_;
};

}  // namespace plumb::compiler
