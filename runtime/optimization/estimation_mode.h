// The whole method, or the method without one of its parts: the ablations of the diS-Graphs paper. METHOD.md, "Modes", has the reasons.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::runtime {

enum class EstimationMode : uint8_t {
  kDis,  // all of it
  kIs,   // no deviations: every wall stands as planned (iS-Graphs)
  kUc,   // uniform covariances: every wall has the same prior, whether it is likely to deviate or not
  kSo,   // single optimization: place and deviations at once from where the matcher put the map, no consensus before, no second round
};
[[nodiscard]] const char* ModeName(EstimationMode mode);  // dis | is | uc | so
[[nodiscard]] std::optional<EstimationMode> ParseMode(std::string_view name);
[[nodiscard]] std::vector<std::string> ModeNames();

// What a mode does: all that sets the modes apart.
struct EstimationSchedule {
  enum class WallPrior : uint8_t {
    kMixture,  // as tight as the wall is likely to stand as planned
    kUniform,  // the mixture's variance, for all walls
    kHeld,     // at zero, and every view of a wall counts in full however far off the plan it is
  };
  WallPrior prior = WallPrior::kMixture;
  bool consensus = true;  // the plan's place is found from the walls that agree before deviations are looked at (place_seed.h)
  bool alternate = true;  // which walls deviate is asked again after each solve; else once
};
[[nodiscard]] EstimationSchedule ScheduleOf(EstimationMode mode);

}  // namespace plumb::runtime
