// The unit of a drawing: what it states, checked against how thick walls and how wide doors are.
#pragma once

#include <optional>
#include <string>

#include "compiler/frontends/drawing/drawing.h"

namespace plumb::compiler {

struct LengthUnit {
  std::string name;  // "mm", "in"
  double metres = 1;
};

// By its name: mm, cm, dm, m, km, in, ft, yd. None: there is no such unit.
[[nodiscard]] std::optional<LengthUnit> FindUnit(const std::string& name);

struct UnitOptions {
  double min_wall_m = 0.05, max_wall_m = 0.6;
  double min_door_m = 0.6, max_door_m = 1.3;
  double usual_wall_m = 0.15, usual_door_m = 0.85;
};

// Both in the drawing's unit; 0: there is none.
struct DrawnSizes {
  double wall = 0;    // median distance between parallel partners
  double door = 0;    // median radius of swings; where there are none, median width of what is drawn as a door
  double extent = 0;  // the longer side of all lines
};

struct UnitChoice {
  LengthUnit unit;
  bool stated_holds = true;  // false: the stated one contradicts the sizes, or none is stated
  std::string reason;        // "walls are 0.14 m thick, doors 0.81 m wide"
};

// Whether walls, doors and the plan as a whole have usual sizes where the drawing's unit is that long.
[[nodiscard]] bool SizesHold(const DrawnSizes& sizes, double metres, const UnitOptions& options = {});
[[nodiscard]] std::string DescribeSizes(const DrawnSizes& sizes, const LengthUnit& unit);  // "in mm the plan is 12 m long, walls 0.14 m thick"
[[nodiscard]] DrawnSizes MeasureSizes(const Drawing& drawing);  // in the drawing's unit
[[nodiscard]] UnitChoice ChooseUnit(const DrawnSizes& sizes, const std::optional<LengthUnit>& stated, const UnitOptions& options = {});

}  // namespace plumb::compiler
