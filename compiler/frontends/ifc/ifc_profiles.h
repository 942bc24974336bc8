// IfcProfileDef as plane areas. Metres.
#pragma once

#include <vector>

#include "compiler/frontends/ifc/ifc_curves.h"
#include "compiler/geometry/sweep.h"

namespace plumb::compiler {

struct Profile {
  Area area;
  std::vector<Arc> arcs;  // exact arcs of the boundary
};

class ProfileReader {
 public:
  ProfileReader(const IfcModel& model, const PlacementReader& placements, const CurveReader& curves, double chord_tolerance_m)
      : model_(model), placements_(placements), curves_(curves), chord_tolerance_m_(chord_tolerance_m) {}

  // All closed profiles of the schema; fillets of rolled sections are left out, centre lines, open or closed, are given their
  // thickness.
  // Empty, with an UnsupportedGeometry diagnostic, for others.
  [[nodiscard]] Profile Read(const IfcInstance& profile) const { return Read(profile, 0); }

 private:
  [[nodiscard]] Profile Read(const IfcInstance& profile, int depth) const;
  [[nodiscard]] Profile Parameterized(const IfcInstance& profile) const;
  [[nodiscard]] Profile AlongCenterLine(const IfcInstance& profile) const;
  [[nodiscard]] Profile Arbitrary(const IfcInstance& profile) const;
  [[nodiscard]] Profile Round(double x_m, double y_m, double hollow_m) const;
  [[nodiscard]] Area RolledSection(const IfcInstance& profile) const;

  const IfcModel& model_;
  const PlacementReader& placements_;
  const CurveReader& curves_;
  double chord_tolerance_m_;
};

}  // namespace plumb::compiler
