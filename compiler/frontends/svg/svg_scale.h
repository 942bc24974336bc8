// How long a user unit of an SVG plan is in the building.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/frontends/drawing/units.h"

namespace plumb::compiler {

struct ScaleChoice {
  enum class Origin {
    kStated,  // the page is as large as the building
    kRatio,   // the page times a ratio that a text states
    kSizes,   // seen in doors and walls
  };
  double metres = 1;  // of one user unit
  Origin origin = Origin::kSizes;
  std::string reason;
};

// The N of every text "1:N" in the drawing that can be a plan's.
[[nodiscard]] std::vector<double> RatiosIn(const Drawing& drawing);

// The first of these that gives doors and walls usual sizes: the page's own size, that times a ratio that is stated, a unit that plans are
// drawn in, a usual ratio of the page near to what the sizes say, the scale at which doors (else walls) have their usual size.
[[nodiscard]] ScaleChoice ChooseScale(const DrawnSizes& sizes, const std::optional<double>& unit_on_paper_m,
                                      const std::vector<double>& ratios, const UnitOptions& options = {});

}  // namespace plumb::compiler
