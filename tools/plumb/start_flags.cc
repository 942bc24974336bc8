#include "tools/plumb/start_flags.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "tools/plumb/config.h"
#include "tools/plumb/flag_names.h"

namespace plumb::tools {
namespace {

// "1,2.5"; none if anything but numbers and commas is in it.
std::optional<std::vector<double>> ParseNumbers(const std::string& text) {
  std::vector<double> numbers;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    if (!CLI::detail::lexical_cast(text.substr(begin, end - begin), numbers.emplace_back())) return std::nullopt;
    begin = end + 1;
  }
  return numbers;
}

}  // namespace

Expected<runtime::StartHint> ParseStartHint(const std::string& near, const std::vector<std::string>& rooms, const AGraph& plan) {
  runtime::StartHint hint;
  if (!near.empty()) {
    const auto numbers = ParseNumbers(near);
    if (!numbers || numbers->size() < 2 || numbers->size() > 3) {
      return Fail(ErrorCode::kBadOption, fmt::format("--near {}; must be X,Y or X,Y,SIGMA in metres", near));
    }
    hint.near_m = Eigen::Vector2d((*numbers)[0], (*numbers)[1]);
    if (numbers->size() == 3) hint.near_sigma_m = (*numbers)[2];
  }
  for (const std::string& name : rooms) {
    std::vector<std::string> names;
    const size_t before = hint.rooms.size();
    for (size_t i = 0; i < plan.rooms.size(); ++i) {
      if (plan.rooms[i].name == name || plan.rooms[i].guid == name) hint.rooms.emplace_back(i);
      names.push_back(plan.rooms[i].name);
    }
    if (hint.rooms.size() > before) continue;
    const std::string meant = NearestName(name, names);
    return Fail(ErrorCode::kBadOption, fmt::format("--room {}: the plan has no such room{}; `plumb inspect` lists them", name,
                                                   meant.empty() ? "" : fmt::format("; did you mean `{}`?", meant)));
  }
  if (const std::string wrong = hint.Check(); !wrong.empty()) return Fail(ErrorCode::kBadOption, InFlags(wrong));
  return hint;
}

Expected<Eigen::Vector3d> ParseMount(const std::string& mount) {
  if (mount.empty()) return Eigen::Vector3d(Eigen::Vector3d::UnitZ());
  const auto numbers = ParseNumbers(mount);
  if (!numbers || numbers->size() != 2 || !std::isfinite((*numbers)[0]) || !std::isfinite((*numbers)[1])) {
    return Fail(ErrorCode::kBadOption, fmt::format("--mount {}; must be ROLL,PITCH in degrees", mount));
  }
  constexpr double kDegree = std::numbers::pi / 180;
  const Eigen::AngleAxisd roll((*numbers)[0] * kDegree, Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd pitch((*numbers)[1] * kDegree, Eigen::Vector3d::UnitY());
  return Eigen::Vector3d((pitch * roll).inverse() * Eigen::Vector3d::UnitZ());
}

}  // namespace plumb::tools
