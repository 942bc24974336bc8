#include "compiler/frontends/svg/svg_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

namespace plumb::compiler {
namespace {

// `_x5F_` is how Illustrator writes `_` and whatever else an id must not have.
std::string Unescaped(std::string_view id) {
  std::string out;
  for (size_t i = 0; i < id.size(); ++i) {
    const size_t end = id.substr(i).starts_with("_x") ? id.find('_', i + 1) : std::string_view::npos;
    uint32_t code = 0;
    bool hex = end != std::string_view::npos && end > i + 2 && end - i <= 6;
    for (size_t k = i + 2; hex && k < end; ++k) {
      const auto c = static_cast<unsigned char>(id[k]);
      hex = std::isxdigit(c) != 0;
      code = 16 * code + static_cast<uint32_t>(std::isdigit(c) != 0 ? c - '0' : (c | 32) - 'a' + 10);
    }
    if (!hex || code >= 0x80) {
      out += id[i];
      continue;
    }
    out += static_cast<char>(code);
    i = end;
  }
  return out;
}

// "path4109", "g12-3": a drawing program's own numbering.
bool IsNumbered(std::string_view id) {
  const size_t letters = id.find_first_of("0123456789-");
  if (letters == std::string_view::npos || id.find_first_not_of("0123456789-", letters) != std::string_view::npos) return false;
  constexpr std::array<std::string_view, 15> kKinds = {"g",    "path",  "rect", "line", "polyline", "polygon", "circle", "ellipse",
                                                       "text", "tspan", "use",  "svg",  "symbol",   "image",   "layer"};
  return std::find(kKinds.begin(), kKinds.end(), id.substr(0, letters)) != kKinds.end();
}

}  // namespace

std::vector<std::string> SvgWords(std::string_view text) {
  std::vector<std::string> out;
  for (size_t at = text.find_first_not_of(" \t\r\n"); at != std::string_view::npos; at = text.find_first_not_of(" \t\r\n", at)) {
    const size_t end = std::min(text.find_first_of(" \t\r\n", at), text.size());
    out.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return out;
}

std::vector<std::string> SvgNames(std::string_view label, std::string_view data_name, const std::vector<std::string>& classes,
                                  std::string_view id) {
  std::vector<std::string> out;
  if (!label.empty()) out.emplace_back(label);
  if (!data_name.empty()) out.emplace_back(data_name);
  out.insert(out.end(), classes.begin(), classes.end());
  if (!id.empty() && !IsNumbered(id)) out.push_back(Unescaped(id));
  return out;
}

}  // namespace plumb::compiler
