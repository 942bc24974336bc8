#include "tools/plumb/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <system_error>

#include "schema/files.h"

namespace plumb::tools {

namespace fs = std::filesystem;

namespace {

// Whether it is the input, or of an input that is a folder one of the files that recordings and runs consist of.
bool IsOf(const fs::path& output, const fs::path& input) {
  constexpr const char* kNames[] = {
      "odometry.tum", "truth.tum",       "truth.json", "run.json",    "trajectory.tum", "trajectory_smoothed.tum",
      "verdicts.csv", "hypotheses.json", "timing.csv", "sgraph.json", "map.ply",        "deviations.json"};
  std::error_code error;
  if (fs::equivalent(output, input, error)) return true;
  if (!fs::is_directory(input, error)) return false;
  const fs::path folder = output.has_parent_path() ? output.parent_path() : fs::path(".");
  if (fs::equivalent(folder, input / "scans", error)) return true;
  return std::any_of(std::begin(kNames), std::end(kNames), [&](const char* name) { return fs::equivalent(output, input / name, error); });
}

}  // namespace

Expected<void> CheckOutputs(const std::vector<OutputFlag>& outputs, const std::vector<std::string>& inputs) {
  for (const OutputFlag& output : outputs) {
    if (output.path.empty()) continue;
    std::error_code ignored;
    const fs::path folder = fs::path(output.path).parent_path();
    if (fs::is_directory(output.path, ignored))
      return Fail(ErrorCode::kFileUnwritable, fmt::format("{} {}; is a folder, and a file is to be written", output.flag, output.path));
    if (!folder.empty() && !fs::is_directory(folder, ignored))
      return Fail(ErrorCode::kFileUnwritable, fmt::format("{} {}; there is no folder `{}`", output.flag, output.path, folder.string()));
    for (const std::string& input : inputs) {
      if (IsOf(output.path, input))
        return Fail(ErrorCode::kBadOption,
                    fmt::format("{} {}; must not be `{}` itself or a file of it, which is read", output.flag, output.path, input));
    }
  }
  return {};
}

Expected<OutputFolder> OutputFolder::Make(const std::string& path) {
  std::error_code error;
  fs::path folder(path);
  if (!folder.has_filename()) folder = folder.parent_path();  // "run/"
  std::vector<std::string> missing;
  for (fs::path at = folder; !at.empty() && !fs::exists(at, error); at = at.parent_path()) missing.push_back(at.string());
  OutputFolder out;
  out.made_.assign(missing.rbegin(), missing.rend());
  fs::create_directories(folder, error);
  if (error) return Fail(ErrorCode::kFileUnwritable, fmt::format("cannot make `{}`: {}", path, error.message()));
  std::string probe;
  for (int i = 0; probe.empty() || fs::exists(fs::symlink_status(probe, error)); ++i)
    probe = (folder / fmt::format(".plumb-writable-{}", i)).string();  // never a file of the user's
  if (auto written = WriteFileAtomically(probe, std::string_view()); !written) return tl::unexpected(written.error());
  fs::remove(probe, error);
  return out;
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  for (; !made_.empty(); made_.pop_back()) {
    if (!fs::is_empty(made_.back(), ignored) || !fs::remove(made_.back(), ignored)) return;
  }
}

}  // namespace plumb::tools
