#include "runtime/optimization/estimation_mode.h"

#include <array>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr std::array<std::pair<EstimationMode, const char*>, 4> kModes{{
    {EstimationMode::kDis, "dis"},
    {EstimationMode::kIs, "is"},
    {EstimationMode::kUc, "uc"},
    {EstimationMode::kSo, "so"},
}};

}  // namespace

const char* ModeName(EstimationMode mode) {
  for (const auto& [known, name] : kModes) {
    if (known == mode) return name;
  }
  return "dis";
}

std::optional<EstimationMode> ParseMode(std::string_view name) {
  for (const auto& [mode, known] : kModes) {
    if (known == name) return mode;
  }
  return std::nullopt;
}

std::vector<std::string> ModeNames() {
  std::vector<std::string> out;
  for (const auto& [mode, name] : kModes) out.emplace_back(name);
  return out;
}

EstimationSchedule ScheduleOf(EstimationMode mode) {
  using WallPrior = EstimationSchedule::WallPrior;
  switch (mode) {
    case EstimationMode::kDis: break;
    case EstimationMode::kIs: return {WallPrior::kHeld, false, false};
    case EstimationMode::kUc: return {WallPrior::kUniform, false, false};
    case EstimationMode::kSo: return {WallPrior::kMixture, false, false};
  }
  return {};
}

}  // namespace plumb::runtime
