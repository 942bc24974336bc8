#include <fmt/format.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "runtime/sources/lzf.h"
#include "runtime/sources/pcd_header.h"
#include "runtime/sources/point_time.h"
#include "runtime/sources/recording.h"
#include "schema/files.h"

namespace plumb::runtime {
namespace {

static_assert(std::endian::native == std::endian::little, "PCD files hold little-endian values");

constexpr size_t kMaxFileSize = size_t{1} << 30;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using namespace std::string_view_literals;
constexpr std::array kXNames = {"x"sv}, kYNames = {"y"sv}, kZNames = {"z"sv};
constexpr std::array kIntensityNames = {"intensity"sv, "i"sv, "reflectivity"sv};
constexpr std::array kRingNames = {"ring"sv, "line"sv, "channel"sv};
constexpr std::array kTimeNames = {"time"sv, "t"sv, "timestamp"sv, "offset_time"sv, "time_offset"sv, "time_stamp"sv};

template <class T>
double Load(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

double LoadValue(const PcdField& field, const uint8_t* at) {
  const bool is_signed = field.type == 'I';
  if (field.type == 'F') return field.size == 4 ? Load<float>(at) : Load<double>(at);
  switch (field.size) {
    case 1: return is_signed ? Load<int8_t>(at) : Load<uint8_t>(at);
    case 2: return is_signed ? Load<int16_t>(at) : Load<uint16_t>(at);
    case 4: return is_signed ? Load<int32_t>(at) : Load<uint32_t>(at);
    default: return is_signed ? Load<int64_t>(at) : Load<uint64_t>(at);
  }
}

// The fields of a header that a scan keeps; null where it has none.
struct ScanFields {
  const PcdField *x = nullptr, *y = nullptr, *z = nullptr, *intensity = nullptr, *ring = nullptr, *time = nullptr;

  explicit ScanFields(const PcdHeader& header)
      : x(header.Find(kXNames)), y(header.Find(kYNames)), z(header.Find(kZNames)), intensity(header.Find(kIntensityNames)),
        ring(header.Find(kRingNames)), time(header.Find(kTimeNames)) {}
};

// Collects points, dropping those without a return.
class ScanBuilder {
 public:
  ScanBuilder(const ScanFields& fields, size_t points) : fields_(fields) {
    scan_.points.reserve(points);
    if (fields.intensity != nullptr) scan_.intensity.reserve(points);
    if (fields.ring != nullptr) scan_.ring.reserve(points);
    if (fields.time != nullptr) times_.reserve(points);
  }

  // value(field): the point's value of that field.
  template <class Value>
  void Add(Value value) {
    const Eigen::Vector3f p = Eigen::Vector3d(value(*fields_.x), value(*fields_.y), value(*fields_.z)).cast<float>();
    const double time = fields_.time != nullptr ? value(*fields_.time) : 0.0;
    if (!p.allFinite() || p.isZero(0) || !std::isfinite(time)) return;
    scan_.points.push_back(p);
    if (fields_.time != nullptr) times_.push_back(time);
    if (fields_.intensity != nullptr) {
      const auto intensity = static_cast<float>(value(*fields_.intensity));
      scan_.intensity.push_back(std::isfinite(intensity) ? intensity : 0.0f);
    }
    if (fields_.ring != nullptr) {
      const double ring = value(*fields_.ring);
      scan_.ring.push_back(ring >= 0 && ring <= 65535 ? static_cast<uint16_t>(ring) : uint16_t{0});
    }
  }

  Scan Finish(double stamp_s) {
    scan_.stamp_s = stamp_s;
    if (fields_.time != nullptr) {
      scan_.time_s = PointTimesAfterStamp(times_, {fields_.time->name, fields_.time->type == 'F', fields_.time->size == 8}, stamp_s);
    }
    return std::move(scan_);
  }

 private:
  const ScanFields& fields_;
  Scan scan_;
  std::vector<double> times_;
};

tl::unexpected<Error> Bad(const std::string& path, const std::string& why) {
  return Fail(ErrorCode::kBadScan, fmt::format("`{}`: {}", path, why));
}

// Point after point, or field after field (as compressed files have it). `data` holds header.points * header.point_size bytes.
void AddBinary(const PcdHeader& header, std::span<const uint8_t> data, bool field_major, ScanBuilder& builder) {
  for (size_t i = 0; i < header.points; ++i) {
    builder.Add([&](const PcdField& f) {
      const size_t at = field_major ? f.offset * header.points + i * f.size : i * header.point_size + f.offset;
      return LoadValue(f, data.data() + at);
    });
  }
}

// Returns what is wrong; empty if nothing.
std::string AddAscii(const PcdHeader& header, std::string_view text, ScanBuilder& builder) {
  std::vector<double> row(header.columns);
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  const auto skip_blank = [&] {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r' || *at == '\n')) ++at;
  };
  for (size_t i = 0; i < header.points; ++i) {
    for (double& value : row) {
      skip_blank();
      const auto [next, error] = std::from_chars(at, end, value);
      if (error == std::errc::result_out_of_range) value = kNan;
      else if (error != std::errc()) return fmt::format("point {} of {} is cut off or holds something else than numbers", i, header.points);
      at = next;
    }
    builder.Add([&](const PcdField& f) { return row[f.column]; });
  }
  return {};
}

template <class T>
void Append(std::vector<uint8_t>& out, T value) {
  const size_t at = out.size();
  out.resize(at + sizeof(T));
  std::memcpy(out.data() + at, &value, sizeof(T));
}

}  // namespace

Expected<Scan> ReadPcd(const std::string& path, double stamp_s) {
  const Expected<std::vector<uint8_t>> bytes = ReadFileBytes(path, kMaxFileSize);
  if (!bytes) return tl::unexpected(bytes.error());
  const Expected<PcdHeader> header = ParsePcdHeader(*bytes, path);
  if (!header) return tl::unexpected(header.error());
  const ScanFields fields(*header);
  if (fields.x == nullptr || fields.y == nullptr || fields.z == nullptr) return Bad(path, "it has no fields x, y and z");
  const std::span<const uint8_t> data = std::span(*bytes).subspan(header->data_at);
  const size_t size = header->points * header->point_size;

  if (header->storage == PcdStorage::kAscii) {
    if (data.size() + 1 < header->points * header->columns * 2) {  // a digit and a blank for each value, but the last
      return Bad(path, fmt::format("it has {} bytes for {} points of {} values", data.size(), header->points, header->columns));
    }
    ScanBuilder builder(fields, header->points);
    const std::string fault = AddAscii(*header, {reinterpret_cast<const char*>(data.data()), data.size()}, builder);
    return fault.empty() ? Expected<Scan>(builder.Finish(stamp_s)) : Bad(path, fault);
  }
  if (header->storage == PcdStorage::kBinary) {
    if (data.size() < size) return Bad(path, fmt::format("it has {} bytes; {} points need {}", data.size(), header->points, size));
    ScanBuilder builder(fields, header->points);
    AddBinary(*header, data, false, builder);
    return builder.Finish(stamp_s);
  }
  uint32_t sizes[2] = {0, 0};  // compressed, uncompressed
  if (data.size() < sizeof(sizes)) return Bad(path, "its compressed data are cut off");
  std::memcpy(sizes, data.data(), sizeof(sizes));
  if (sizes[0] > data.size() - sizeof(sizes)) return Bad(path, "its compressed data are cut off");
  if (sizes[1] != size) return Bad(path, fmt::format("its data unpack to {} bytes; {} points need {}", sizes[1], header->points, size));
  const auto unpacked = DecompressLzf(data.subspan(sizeof(sizes), sizes[0]), size);
  if (!unpacked) return Bad(path, "its compressed data are damaged");
  ScanBuilder builder(fields, header->points);
  AddBinary(*header, *unpacked, true, builder);
  return builder.Finish(stamp_s);
}

Expected<void> WritePcd(const Scan& scan, const std::string& path) {
  const size_t n = scan.points.size();
  const auto absent_or_full = [n](size_t size) { return size == 0 || size == n; };
  if (!absent_or_full(scan.intensity.size()) || !absent_or_full(scan.ring.size()) || !absent_or_full(scan.time_s.size())) {
    return Bad(path, "the scan has not one value per point");
  }
  const bool intensity = !scan.intensity.empty(), ring = !scan.ring.empty(), time = !scan.time_s.empty();
  const auto column = [&](const char* i, const char* r, const char* t) {
    return fmt::format("{}{}{}", intensity ? i : "", ring ? r : "", time ? t : "");
  };
  const std::string header = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z{}\nSIZE 4 4 4{}\nTYPE F F F{}\nCOUNT 1 1 1{}\n"
      "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      column(" intensity", " ring", " time"), column(" 4", " 2", " 4"), column(" F", " U", " F"), column(" 1", " 1", " 1"), n, n);
  std::vector<uint8_t> bytes(header.begin(), header.end());
  bytes.reserve(bytes.size() + n * 22);
  for (size_t i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) Append(bytes, scan.points[i][k]);
    if (intensity) Append(bytes, scan.intensity[i]);
    if (ring) Append(bytes, scan.ring[i]);
    if (time) Append(bytes, scan.time_s[i]);
  }
  return WriteFileAtomically(path, bytes);
}

}  // namespace plumb::runtime
