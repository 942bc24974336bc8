#include "tools/plumb/start_hint_flags.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
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
    const auto found = FindRooms(plan, name);
    if (!found) return Fail(found.error().code, fmt::format("--room {}: {}", name, found.error().message));
    for (const RoomId room : *found) {
      if (std::find(hint.rooms.begin(), hint.rooms.end(), room) == hint.rooms.end()) hint.rooms.push_back(room);
    }
  }
  if (const std::string wrong = hint.Check(); !wrong.empty()) return Fail(ErrorCode::kBadOption, InFlags(wrong));
  return hint;
}

}  // namespace plumb::tools
