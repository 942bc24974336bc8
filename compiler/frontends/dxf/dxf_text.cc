#include "compiler/frontends/dxf/dxf_text.h"

#include <charconv>
#include <cstdint>

namespace plumb::compiler {
namespace {

void AppendUtf8(uint32_t c, std::string& out) {
  if (c < 0x80) {
    out += static_cast<char>(c);
  } else if (c < 0x800) {
    out += static_cast<char>(0xc0 | (c >> 6));
    out += static_cast<char>(0x80 | (c & 0x3f));
  } else {
    out += static_cast<char>(0xe0 | (c >> 12));
    out += static_cast<char>(0x80 | ((c >> 6) & 0x3f));
    out += static_cast<char>(0x80 | (c & 0x3f));
  }
}

bool IsUtf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    const size_t length = c < 0x80 ? 1 : c >= 0xc2 && c < 0xe0 ? 2 : c >= 0xe0 && c < 0xf0 ? 3 : c >= 0xf0 && c < 0xf5 ? 4 : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (size_t k = 1; k < length; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
    }
    i += length;
  }
  return true;
}

std::string Trimmed(std::string text) {
  const size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

std::string DecodeDxfText(std::string_view text) {
  std::string out;
  const bool utf8 = IsUtf8(text);
  for (size_t i = 0; i < text.size(); ++i) {
    uint32_t code = 0;
    if (text.substr(i).starts_with("\\U+") && i + 7 <= text.size() &&
        std::from_chars(text.data() + i + 3, text.data() + i + 7, code, 16).ptr == text.data() + i + 7 && code >= 0x20) {
      AppendUtf8(code, out);
      i += 6;
    } else if (utf8) {
      out += text[i];
    } else {
      AppendUtf8(static_cast<unsigned char>(text[i]), out);
    }
  }
  return out;
}

std::string PlainText(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    if (!text.substr(i).starts_with("%%") || i + 2 >= text.size()) {
      out += text[i];
      continue;
    }
    const char code = text[i + 2];
    i += 2;
    if (code == 'd' || code == 'D') out += "\xc2\xb0";
    if (code == 'c' || code == 'C') out += "\xc3\x98";
    if (code == 'p' || code == 'P') out += "\xc2\xb1";
    if (code == '%') out += '%';
  }
  return Trimmed(DecodeDxfText(out));
}

std::vector<std::string> PlainLines(std::string_view text) {
  std::vector<std::string> lines(1);
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '{' || c == '}') continue;
    if (c != '\\' || i + 1 >= text.size()) {
      lines.back() += c;
      continue;
    }
    const char code = text[++i];
    if (code == 'P' || code == 'X') {
      lines.emplace_back();
    } else if (code == '~') {
      lines.back() += ' ';
    } else if (code == '\\' || code == '{' || code == '}') {
      lines.back() += code;
    } else if (code == 'U') {
      lines.back() += "\\U";
    } else if (std::string_view("ACFHQTWSfpc").find(code) != std::string_view::npos) {
      const size_t end = text.find(';', i);
      if (code == 'S') lines.back() += std::string(text.substr(i + 1, end == std::string_view::npos ? 0 : end - i - 1));
      if (end == std::string_view::npos) break;
      i = end;
    }  // \L \l \O \o \K \k: lines under, over and through
  }
  std::vector<std::string> out;
  for (const std::string& line : lines) {
    if (std::string plain = PlainText(line); !plain.empty()) out.push_back(std::move(plain));
  }
  return out;
}

}  // namespace plumb::compiler
