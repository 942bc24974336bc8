#include "tools/run/ply.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace plumb::tools {

static_assert(std::endian::native == std::endian::little, "the file is little-endian and is written as it lies in memory");
static_assert(sizeof(Eigen::Vector3d) == 24);

std::string PointsToPly(const std::vector<Eigen::Vector3d>& points, const std::string& comment) {
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {}\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\nend_header\n",
      comment, points.size());
  const size_t header = out.size();
  out.resize(header + points.size() * sizeof(Eigen::Vector3d));
  if (!points.empty()) std::memcpy(out.data() + header, points.data(), points.size() * sizeof(Eigen::Vector3d));
  return out;
}

}  // namespace plumb::tools
