#include "tools/inspect/storeys.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <iterator>
#include <vector>

#include "tools/names/names.h"

namespace plumb::tools {
namespace {

std::string List(const AGraph& graph) {
  std::string out;
  for (size_t i = 0; i < graph.storeys.size(); ++i) {
    fmt::format_to(std::back_inserter(out), "{}`{}` ({})", i == 0 ? "" : ", ", graph.storeys[i].name, i);
  }
  return out;
}

}  // namespace

Expected<StoreyId> FindStorey(const AGraph& graph, const std::string& name_or_number) {
  const auto named = [&](const std::function<bool(const std::string&)>& matches) {
    std::vector<StoreyId> out;
    for (size_t i = 0; i < graph.storeys.size(); ++i) {
      if (matches(graph.storeys[i].name)) out.emplace_back(i);
    }
    return out;
  };
  auto found = named([&](const std::string& name) { return name == name_or_number; });
  if (found.empty()) found = named([&](const std::string& name) { return IsSameName(name, name_or_number); });
  if (found.size() == 1) return found[0];
  size_t number = 0;
  const char* end = name_or_number.data() + name_or_number.size();
  const auto parsed = std::from_chars(name_or_number.data(), end, number);
  if (found.empty() && parsed.ec == std::errc() && parsed.ptr == end && number < graph.storeys.size()) return StoreyId(number);
  return Fail(ErrorCode::kBadOption,
              fmt::format("{} storey is `{}`; the plan has {}", found.empty() ? "no" : "more than one", name_or_number, List(graph)));
}

StoreyId MainStorey(const AGraph& graph) {
  std::vector<size_t> rooms(graph.storeys.size(), 0);
  for (const Room& r : graph.rooms) {
    if (r.storey.valid()) ++rooms[r.storey.index()];
  }
  if (rooms.empty()) return StoreyId();
  return StoreyId(static_cast<size_t>(std::max_element(rooms.begin(), rooms.end()) - rooms.begin()));
}

}  // namespace plumb::tools
