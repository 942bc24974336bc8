// AGraph::source_path of a plan that is drawn in several files.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// It may stand in the name of a file, too: what is told apart here is for people, and what may be written over asks the whole as well.
inline constexpr std::string_view kBetweenSourcePaths = " + ";

[[nodiscard]] inline std::vector<std::string> SplitSourcePaths(std::string_view joined) {
  std::vector<std::string> out;
  for (size_t at = joined.find(kBetweenSourcePaths); at != std::string_view::npos; at = joined.find(kBetweenSourcePaths)) {
    out.emplace_back(joined.substr(0, at));
    joined.remove_prefix(at + kBetweenSourcePaths.size());
  }
  out.emplace_back(joined);
  return out;
}

// For people: without their folders.
[[nodiscard]] inline std::string SourceFileNames(std::string_view joined) {
  std::string out;
  for (const std::string& path : SplitSourcePaths(joined))
    out += std::string(out.empty() ? "" : kBetweenSourcePaths) + path.substr(path.find_last_of('/') + 1);
  return out;
}

}  // namespace plumb
