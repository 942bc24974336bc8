#include "tools/inspect/rooms.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "tools/names/names.h"

namespace plumb::tools {
namespace {

constexpr size_t kMostListed = 12;

// Of the rooms whose name, or a word of it, is nearest.
std::vector<std::string> NearestRooms(const AGraph& graph, const std::string& name) {
  std::vector<std::string> candidates;
  for (const Room& room : graph.rooms) {
    candidates.push_back(Folded(room.name));
    std::istringstream words(candidates.back());
    for (std::string word; words >> word;) candidates.push_back(word);
  }
  const std::string nearest = NearestName(Folded(name), candidates);
  std::vector<std::string> out;
  for (const Room& room : graph.rooms) {
    const bool is_listed = std::find(out.begin(), out.end(), room.name) != out.end();
    if (!nearest.empty() && !is_listed && IsPartOfName(nearest, room.name)) out.push_back(room.name);
  }
  return out;
}

std::string List(const std::vector<std::string>& names, const char* last) {
  std::string out;
  for (size_t i = 0; i < names.size() && i < kMostListed; ++i)
    out += fmt::format("{}`{}`", i == 0 ? "" : i + 1 == names.size() ? last : ", ", names[i]);
  return names.size() > kMostListed ? out + ", ..." : out;
}

}  // namespace

Expected<std::vector<RoomId>> FindRooms(const AGraph& graph, const std::string& name) {
  const std::function<bool(const Room&)> fits[] = {[&](const Room& room) { return room.name == name || room.guid == name; },
                                                   [&](const Room& room) { return IsSameName(room.name, name); },
                                                   [&](const Room& room) { return IsPartOfName(name, room.name); }};
  for (const auto& fit : fits) {
    std::vector<RoomId> found;
    for (size_t i = 0; i < graph.rooms.size() && !name.empty(); ++i) {
      if (fit(graph.rooms[i])) found.emplace_back(i);
    }
    if (!found.empty()) return found;
  }
  if (graph.rooms.empty()) return Fail(ErrorCode::kBadOption, "the plan has no rooms");
  if (const std::vector<std::string> near = NearestRooms(graph, name); !near.empty())
    return Fail(ErrorCode::kBadOption, fmt::format("the plan has no such room; did you mean {}?", List(near, " or ")));
  std::vector<std::string> all;
  for (const Room& room : graph.rooms) all.push_back(room.name);
  return Fail(ErrorCode::kBadOption, fmt::format("the plan has no such room, but {}; `plumb inspect` lists them", List(all, " and ")));
}

}  // namespace plumb::tools
