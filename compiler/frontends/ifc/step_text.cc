#include "compiler/frontends/ifc/step_text.h"

#include <iconv.h>

#include <cstdint>
#include <optional>

namespace plumb::compiler {
namespace {

constexpr uint32_t kReplacement = 0xfffd;

void AppendUtf8(uint32_t code, std::string& out) {
  if (code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) code = kReplacement;
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xc0 | code >> 6);
    out += static_cast<char>(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    out += static_cast<char>(0xe0 | code >> 12);
    out += static_cast<char>(0x80 | (code >> 6 & 0x3f));
    out += static_cast<char>(0x80 | (code & 0x3f));
  } else {
    out += static_cast<char>(0xf0 | code >> 18);
    out += static_cast<char>(0x80 | (code >> 12 & 0x3f));
    out += static_cast<char>(0x80 | (code >> 6 & 0x3f));
    out += static_cast<char>(0x80 | (code & 0x3f));
  }
}

// Length of the well-formed UTF-8 sequence that starts at text[i]; 0 if there is none.
size_t SequenceLength(std::string_view text, size_t i) {
  const auto byte = [&](size_t k) { return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0u; };
  const auto continues = [&](size_t k) { return (byte(k) & 0xc0) == 0x80; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead >= 0xc2 && lead < 0xe0) return continues(1) ? 2 : 0;
  if (lead >= 0xe0 && lead < 0xf0) {
    const bool ok = continues(1) && continues(2) && !(lead == 0xe0 && byte(1) < 0xa0) && !(lead == 0xed && byte(1) >= 0xa0);
    return ok ? 3 : 0;
  }
  if (lead >= 0xf0 && lead < 0xf5) {
    const bool ok = continues(1) && continues(2) && continues(3) && !(lead == 0xf0 && byte(1) < 0x90) && !(lead == 0xf4 && byte(1) >= 0x90);
    return ok ? 4 : 0;
  }
  return 0;
}

bool IsUtf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    const size_t n = SequenceLength(text, i);
    if (n == 0) return false;
    i += n;
  }
  return true;
}

int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

std::optional<uint32_t> Hex(std::string_view text, size_t at, size_t digits) {
  if (at + digits > text.size()) return std::nullopt;
  uint32_t value = 0;
  for (size_t i = 0; i < digits; ++i) {
    const int digit = HexDigit(text[at + i]);
    if (digit < 0) return std::nullopt;
    value = value << 4 | static_cast<uint32_t>(digit);
  }
  return value;
}

// The character of ISO 8859-`part` at `byte`.
uint32_t FromIso8859(int part, unsigned char byte) {
  if (part == 1 || byte < 0x80) return byte;
  const std::string name = "ISO-8859-" + std::to_string(part);
  const iconv_t converter = iconv_open("UTF-32BE", name.c_str());
  if (converter == reinterpret_cast<iconv_t>(-1)) return kReplacement;
  char in = static_cast<char>(byte);
  unsigned char code[4] = {};
  char* from = &in;
  char* to = reinterpret_cast<char*>(code);
  size_t left = 1, room = sizeof code;
  const bool ok = iconv(converter, &from, &left, &to, &room) != static_cast<size_t>(-1) && room == 0;
  iconv_close(converter);
  if (!ok) return kReplacement;
  return uint32_t{code[0]} << 24 | uint32_t{code[1]} << 16 | uint32_t{code[2]} << 8 | code[3];
}

class Decoder {
 public:
  explicit Decoder(std::string_view raw) : raw_(raw), utf8_(IsUtf8(raw)) {}

  std::string Run() {
    while (at_ < raw_.size()) {
      const char c = raw_[at_];
      if (c == '\'' && raw_.substr(at_).starts_with("''")) {
        out_ += c;
        at_ += 2;
      } else if (c == '\\') {
        if (!Directive()) CopyByte();
      } else {
        CopyByte();
      }
    }
    return std::move(out_);
  }

 private:
  void CopyByte() {
    const auto byte = static_cast<unsigned char>(raw_[at_++]);
    if (utf8_) {
      out_ += static_cast<char>(byte);
    } else {
      AppendUtf8(byte, out_);
    }
  }

  // True: a directive stood here and was consumed.
  bool Directive() {
    const std::string_view rest = raw_.substr(at_);
    if (rest.starts_with("\\\\")) {
      out_ += '\\';
      at_ += 2;
      return true;
    }
    if (rest.starts_with("\\S\\") && rest.size() >= 4 && static_cast<unsigned char>(rest[3]) < 0x80) {
      AppendUtf8(FromIso8859(part_, static_cast<unsigned char>(rest[3]) | 0x80u), out_);
      at_ += rest.substr(3).starts_with("''") ? 5 : 4;  // a quote is doubled here too
      return true;
    }
    if (rest.size() >= 4 && rest[1] == 'P' && rest[3] == '\\' && rest[2] >= 'A' && rest[2] <= 'I') {
      part_ = rest[2] - 'A' + 1;
      at_ += 4;
      return true;
    }
    if (rest.starts_with("\\X\\")) {
      const auto code = Hex(rest, 3, 2);
      if (!code) return false;
      AppendUtf8(*code, out_);
      at_ += 5;
      return true;
    }
    if (rest.starts_with("\\X2\\")) return Wide(4);
    if (rest.starts_with("\\X4\\")) return Wide(8);
    return false;
  }

  // \X2\...\X0\ and \X4\...\X0\: UTF-16 with surrogate pairs, as programs write it, and UTF-32.
  bool Wide(size_t digits) {
    size_t p = at_ + 4;
    std::string decoded;
    while (true) {
      if (raw_.substr(p).starts_with("\\X0\\")) break;
      auto code = Hex(raw_, p, digits);
      if (!code) return false;
      p += digits;
      if (digits == 4 && *code >= 0xd800 && *code < 0xdc00) {
        const auto low = Hex(raw_, p, 4);
        if (low && *low >= 0xdc00 && *low < 0xe000) {
          code = 0x10000 + ((*code - 0xd800) << 10) + (*low - 0xdc00);
          p += 4;
        }
      }
      AppendUtf8(*code, decoded);
    }
    out_ += decoded;
    at_ = p + 4;
    return true;
  }

  std::string_view raw_;
  bool utf8_;
  size_t at_ = 0;
  int part_ = 1;  // of ISO 8859
  std::string out_;
};

}  // namespace

std::string DecodeStepString(std::string_view raw) { return Decoder(raw).Run(); }

}  // namespace plumb::compiler
