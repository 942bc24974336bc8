#include "runtime/sources/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

namespace plumb::runtime {
namespace {

namespace fs = std::filesystem;

// The stamp in `SSSSSSSSSS.NNNNNNNNN`; none if the name is something else.
std::optional<double> ParseStamp(const std::string& stem) {
  double stamp_s = 0;
  const char* const end = stem.data() + stem.size();
  const auto [next, error] = std::from_chars(stem.data(), end, stamp_s, std::chars_format::fixed);
  const bool number = error == std::errc() && next == end && stem.find_first_not_of("0123456789.") == std::string::npos;
  return number ? std::optional(stamp_s) : std::nullopt;
}

// Some drivers stamp the sweep's end: their points come before it.
void StampAtFirstPoint(Scan& scan) {
  constexpr float kRounding_s = 1e-3f, kLongest_s = 2.0f;  // further off, the times are broken
  float first_s = 0;
  for (const float t : scan.time_s) {
    if (t < first_s) first_s = t;
  }
  if (first_s > -kRounding_s || first_s < -kLongest_s) return;
  scan.stamp_s += first_s;
  for (float& t : scan.time_s) t -= first_s;
}

}  // namespace

std::string ScanFileName(double stamp_s) { return fmt::format("{:020.9f}.pcd", stamp_s); }

Expected<Recording> Recording::Open(const std::string& folder) {
  std::vector<Error> faults;
  Expected<Recording> recording = OpenWithFaults(folder, faults);
  if (!faults.empty()) return tl::unexpected(faults.front());
  return recording;
}

Expected<Recording> Recording::OpenWithFaults(const std::string& folder, std::vector<Error>& faults) {
  const auto none = [&](const std::string& why) {
    return Fail(ErrorCode::kNotARecording, fmt::format("`{}` is no recording: {}", folder, why));
  };
  std::error_code error;
  std::vector<std::pair<double, std::string>> found;
  std::vector<std::string> unnamed;
  for (fs::directory_iterator it(fs::path(folder) / "scans", error), end; !error && it != end; it.increment(error)) {
    const fs::path& path = it->path();
    if (path.extension() != ".pcd") continue;
    if (const std::optional<double> stamp_s = ParseStamp(path.stem().string())) {
      found.emplace_back(*stamp_s, path.string());
    } else {
      unnamed.push_back(path.string());
    }
  }
  if (error == std::errc::no_such_file_or_directory) return none("it has no folder `scans`");
  if (error) return none("cannot list `scans`: " + error.message());
  std::sort(unnamed.begin(), unnamed.end());
  for (const std::string& path : unnamed) {
    faults.push_back(
        {ErrorCode::kNotARecording, fmt::format("`{}`: a scan's name must be its stamp in seconds, as `{}`", path, ScanFileName(12.3))});
  }
  if (found.empty()) return none(unnamed.empty() ? "it has no scans/*.pcd" : "no scan in it has its stamp for a name");
  std::sort(found.begin(), found.end());

  Recording recording;
  for (auto& [stamp_s, path] : found) {
    recording.stamps_s_.push_back(stamp_s);
    recording.scan_paths_.push_back(std::move(path));
  }
  const fs::path odometry = fs::path(folder) / "odometry.tum";
  if (fs::exists(odometry, error)) {
    Expected<Trajectory> trajectory = ReadTum(odometry.string());
    if (trajectory) {
      recording.odometry_ = std::move(*trajectory);
    } else {
      faults.push_back(trajectory.error());
    }
  }
  return recording;
}

Expected<Scan> Recording::Read(size_t i) const {
  Expected<Scan> scan = ReadPcd(scan_paths_[i], stamps_s_[i]);
  if (scan) StampAtFirstPoint(*scan);
  return scan;
}

}  // namespace plumb::runtime
