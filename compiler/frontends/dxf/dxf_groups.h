// The groups of a DXF file, text or binary: a code and a value each, with the line (text) or byte (binary) where it stands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace plumb::compiler {

struct DxfGroup {
  int code = 0;
  std::string value;
  uint32_t line = 0;  // of the code; in binary files its number among the groups
};

class DxfGroups {
 public:
  explicit DxfGroups(std::string_view bytes);
  [[nodiscard]] bool binary() const { return binary_; }
  // False at the end, and where the file is no DXF syntax: then fault() says why.
  [[nodiscard]] bool Next(DxfGroup& group);
  [[nodiscard]] const std::string& fault() const { return fault_; }
  [[nodiscard]] uint32_t line() const { return line_; }

 private:
  [[nodiscard]] bool NextText(DxfGroup& group);
  [[nodiscard]] bool NextBinary(DxfGroup& group);
  [[nodiscard]] std::string_view TakeLine();
  [[nodiscard]] bool Take(size_t count, std::string_view& out);

  std::string_view rest_;
  bool binary_ = false, wide_codes_ = true;
  uint32_t line_ = 0;
  std::string fault_;
};

}  // namespace plumb::compiler
