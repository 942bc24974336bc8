#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "runtime/sources/recording.h"
#include "schema/files.h"

namespace plumb::runtime {
namespace {

constexpr size_t kMaxFileSize = size_t{1} << 30;
constexpr std::string_view kBlank = " \t\r,";

// Eight numbers and nothing else; false otherwise.
bool ParseNumbers(std::string_view line, std::array<double, 8>& numbers) {
  for (double& number : numbers) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    if (!line.empty() && line[0] == '+') line.remove_prefix(1);
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
    if (error != std::errc() || !std::isfinite(number)) return false;
    line.remove_prefix(static_cast<size_t>(end - line.data()));
  }
  return line.find_first_not_of(kBlank) == std::string_view::npos;
}

Eigen::Isometry3d Between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double ratio) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = (1 - ratio) * a.translation() + ratio * b.translation();
  T.linear() = Eigen::Quaterniond(a.linear()).slerp(ratio, Eigen::Quaterniond(b.linear())).toRotationMatrix();
  return T;
}

}  // namespace

Expected<Trajectory> ReadTum(const std::string& path) {
  const Expected<std::string> text = ReadFileText(path, kMaxFileSize);
  if (!text) return tl::unexpected(text.error());
  Trajectory trajectory;
  std::string_view rest = *text;
  for (size_t number = 1; !rest.empty(); ++number) {
    const size_t length = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, length);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    const size_t first = line.find_first_not_of(kBlank);
    if (first == std::string_view::npos || line[first] == '#') continue;
    const auto bad = [&](const char* why) { return Fail(ErrorCode::kBadTrajectory, fmt::format("`{}` line {}: {}", path, number, why)); };
    std::array<double, 8> v{};
    if (!ParseNumbers(line, v)) return bad("must be eight numbers `t x y z qx qy qz qw`");
    const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    if (std::abs(q.norm() - 1) > 0.01) return bad("qx qy qz qw must be of unit length");
    if (!trajectory.empty() && v[0] < trajectory.back().stamp_s) return bad("stamps must ascend");
    if (!trajectory.empty() && v[0] == trajectory.back().stamp_s) trajectory.pop_back();  // said twice: the later word counts
    StampedPose pose;
    pose.stamp_s = v[0];
    pose.T.translation() << v[1], v[2], v[3];
    pose.T.linear() = q.normalized().toRotationMatrix();
    trajectory.push_back(pose);
  }
  return trajectory;
}

std::string WriteTum(const Trajectory& trajectory) {
  std::string out;
  out.reserve(trajectory.size() * 112);
  for (const StampedPose& pose : trajectory) {
    Eigen::Quaterniond q(pose.T.linear());
    if (q.w() < 0) q.coeffs() = (-q.coeffs()).array() + 0.0;  // no negative zeros
    const Eigen::Vector3d t = pose.T.translation();
    fmt::format_to(std::back_inserter(out), "{:.9f} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", pose.stamp_s, t.x(), t.y(), t.z(),
                   q.x(), q.y(), q.z(), q.w());
  }
  return out;
}

std::optional<Eigen::Isometry3d> InterpolatePose(const Trajectory& trajectory, double stamp_s, double max_gap_s) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp_s,
                                      [](const StampedPose& pose, double stamp) { return pose.stamp_s < stamp; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp_s == stamp_s) return after->T;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double gap_s = after->stamp_s - before->stamp_s;
  if (gap_s > max_gap_s) return std::nullopt;
  return Between(before->T, after->T, (stamp_s - before->stamp_s) / gap_s);
}

}  // namespace plumb::runtime
