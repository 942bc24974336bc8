// The text header of a PCD file: which fields a point has, how many points follow and how they are stored.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "schema/error.h"

namespace plumb::runtime {

enum class PcdStorage : uint8_t { kAscii, kBinary, kBinaryCompressed };

struct PcdField {
  std::string name;
  char type = 'F';       // F, I or U
  size_t size = 4;       // bytes of one value: 1, 2, 4 or 8
  size_t count = 1;      // values per point
  size_t offset = 0;     // bytes from the point's start
  size_t column = 0;     // values from the point's start
};

struct PcdHeader {
  std::vector<PcdField> fields;
  size_t points = 0;
  size_t point_size = 0;  // bytes
  size_t columns = 0;     // values per point
  PcdStorage storage = PcdStorage::kAscii;
  size_t data_at = 0;     // first byte after the header

  // The first field that has one of the names (letter case ignored), earlier names first; null if none has.
  [[nodiscard]] const PcdField* Find(std::span<const std::string_view> names) const;
};

// Errors: kBadScan. Sizes are checked for overflow, not against the file's length.
[[nodiscard]] Expected<PcdHeader> ParsePcdHeader(std::span<const uint8_t> bytes, const std::string& path);

}  // namespace plumb::runtime
