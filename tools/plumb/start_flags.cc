#include "tools/plumb/start_flags.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "tools/inspect/rooms.h"
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

// A place far off the plan is in other coordinates, or a slip.
std::string CheckNear(const runtime::StartHint& hint, const AGraph& plan) {
  constexpr double kBeside_m = 20;
  Eigen::AlignedBox2d plan_box;
  for (const Surface& s : plan.surfaces) plan_box.extend(s.start).extend(s.end);
  if (plan_box.isEmpty() || plan_box.exteriorDistance(*hint.near_m) <= std::max(kBeside_m, 3 * hint.near_sigma_m)) return {};
  return fmt::format("--near {:.2f},{:.2f}; must be in the plan, which reaches from {:.2f},{:.2f} to {:.2f},{:.2f} m", hint.near_m->x(),
                     hint.near_m->y(), plan_box.min().x(), plan_box.min().y(), plan_box.max().x(), plan_box.max().y());
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
    if (const std::string wrong = CheckNear(hint, plan); !wrong.empty()) return Fail(ErrorCode::kBadOption, wrong);
  }
  for (const std::string& name : rooms) {
    const auto found = FindRooms(plan, name);
    if (!found) return Fail(found.error().code, fmt::format("--room {}: {}", name, found.error().message));
    for (const RoomId room : *found) {
      if (std::find(hint.rooms.begin(), hint.rooms.end(), room) == hint.rooms.end()) hint.rooms.push_back(room);
    }
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
