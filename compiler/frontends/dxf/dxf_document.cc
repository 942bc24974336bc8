#include "compiler/frontends/dxf/dxf_document.h"

#include <dl_dxf.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <istream>
#include <streambuf>
#include <string_view>
#include <utility>

#include "compiler/frontends/dxf/dxf_builder.h"
#include "compiler/frontends/dxf/dxf_groups.h"
#include "compiler/frontends/dxf/dxf_text.h"

namespace plumb::compiler {
namespace {

constexpr double kInPlane = 0.99;  // of the extrusion's direction along z
constexpr size_t kMaxValue = 1000;
constexpr const char* kNothing = "NOTHING";  // a type that dxflib does not know

using Groups = std::vector<DxfGroup>;

int ToInt(const std::string& text) {
  int out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

double ToReal(const std::string& text) {
  double out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

DxfEntityHeader HeaderOf(const Groups& groups) {
  DxfEntityHeader out;
  out.type = groups[0].value;
  out.line = groups[0].line;
  for (const DxfGroup& g : groups) {
    if (g.code == 100 || g.code == 102) continue;
    if (g.code == 5 && out.handle == 0xffffffffu) {
      uint32_t handle = 0;
      if (std::from_chars(g.value.data(), g.value.data() + g.value.size(), handle, 16).ec == std::errc()) out.handle = handle;
    }
    if (g.code == 8) out.layer = DecodeDxfText(g.value);
    if (g.code == 67) out.paper = ToInt(g.value) == 1;
    if (g.code == 60) out.invisible = ToInt(g.value) == 1;
    if (g.code == 230) out.mirrored = ToReal(g.value) < -kInPlane, out.tilted = std::abs(ToReal(g.value)) < kInPlane;
  }
  return out;
}

// dxflib trusts the counts that a file states and reserves memory for them.
void MendCounts(Groups& groups) {
  const std::string& type = groups[0].value;
  const auto count = [&](int code) {
    return std::count_if(groups.begin(), groups.end(), [&](const DxfGroup& g) { return g.code == code; });
  };
  const auto set = [&](int code, std::ptrdiff_t value) {
    for (DxfGroup& g : groups) {
      if (g.code == code) g.value = std::to_string(value);
    }
  };
  if (type == "LWPOLYLINE") set(90, count(10));
  if (type == "SPLINE") set(72, count(40)), set(73, count(10)), set(74, count(11));
  if (type == "LEADER") set(76, count(10));
}

// Codes that no entity's shape depends on.
bool IsNeeded(int code, const std::string& type) {
  if (code == 62) return type == "LAYER";  // negative: off
  return code < 300 && code != 5 && code != 6 && code != 48 && code != 100 && code != 102;
}

constexpr std::array<int, 4> kLineCodes = {10, 20, 11, 21};

// A line whose four numbers are plain. dxflib takes most of the time of a large drawing for turning texts into numbers, and most of such a
// drawing is lines.
std::optional<DL_LineData> PlainLine(const Groups& groups) {
  if (groups[0].value != "LINE") return std::nullopt;
  std::array<std::optional<double>, kLineCodes.size()> values;
  for (const DxfGroup& g : groups) {
    const auto* code = std::find(kLineCodes.begin(), kLineCodes.end(), g.code);
    if (code == kLineCodes.end()) continue;
    double value = 0;
    const char* end = g.value.data() + g.value.size();
    const auto [stop, error] = std::from_chars(g.value.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    values[static_cast<size_t>(code - kLineCodes.begin())] = value;
  }
  if (!values[0] || !values[1] || !values[2] || !values[3]) return std::nullopt;
  return DL_LineData(*values[0], *values[1], 0, *values[2], *values[3], 0);
}

// Does a line lack one of its four numbers, or have a text for it? dxflib would read 0. Blanks and decimal commas are let pass.
bool LacksNumbers(const Groups& groups) {
  if (groups[0].value != "LINE") return false;
  return std::any_of(kLineCodes.begin(), kLineCodes.end(), [&](int code) {
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const DxfGroup& g) { return g.code == code; });
    if (group == groups.end()) return true;
    std::string text = group->value;
    std::erase_if(text, [](char c) { return c == ' ' || c == '\t' || c == '+'; });
    std::replace(text.begin(), text.end(), ',', '.');
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc::invalid_argument || stop != text.data() + text.size() || !std::isfinite(value);
  });
}

// Lets a stream read a text in place.
class TextBuffer : public std::streambuf {
 public:
  void Set(std::string& text) { setg(text.data(), text.data(), text.data() + text.size()); }
};

class Feeder {
 public:
  Feeder(const std::string& bytes, const DxfReadOptions& options, DiagnosticSink& sink)
      : groups_(bytes), builder_(options, out_), options_(options), sink_(sink) {}

  std::optional<DxfDocument> Run() {
    DxfGroup group;
    while (!ended_ && groups_.Next(group)) {
      if (group.code == 999) continue;
      if (group.code == 0 && !Hand()) return std::nullopt;
      entity_.push_back(std::move(group));
    }
    if (!groups_.fault().empty()) {
      sink_.Emit(DiagnosticKind::kDxfSyntax, {groups_.line(), 0, {}, {}, 0},
                 fmt::format("{}; a DXF file is pairs of a group code and a value", groups_.fault()));
      return std::nullopt;
    }
    if (!Hand()) return std::nullopt;
    Feed(0, "EOF");
    builder_.Finish();
    if (!section_.empty() || (!ended_ && !saw_entities_)) {
      sink_.Emit(
          DiagnosticKind::kDrawingCutOff, {groups_.line(), 0, {}, {}, 0},
          fmt::format("the file ends {} after {} {}", section_.empty() ? "before its section ENTITIES" : "within its section " + section_,
                      groups_.line(), groups_.binary() ? "groups" : "lines"),
          "copy or export the file again");
      return std::nullopt;
    }
    if (builder_.bad() > 0) {
      const DxfEntityHeader& at = builder_.first_bad();
      sink_.Emit(DiagnosticKind::kBadEntity, {at.line, 0, at.handle != 0xffffffffu ? fmt::format("{:X}", at.handle) : "", at.type, 0},
                 fmt::format("{} entities have numbers that are none, too large, or no extent, and are left out", builder_.bad()));
    }
    return std::move(out_);
  }

 private:
  void Feed(int code, const std::string& value) {
    // At the start of an entity dxflib makes the one before, for which the builder still has the header. It reads a group from a stream
    // only, by lines that it cuts at 1024 bytes.
    text_ = fmt::format("{}\n{}\n", code, std::string_view(value).substr(0, kMaxValue));
    buffer_.Set(text_);
    stream_.clear();
    dxf_.readDxfGroups(stream_, &builder_);
  }

  // Hands what was collected to dxflib, if it says something of the plan. False: too much.
  bool Hand() {
    if (entity_.empty()) return true;
    Groups groups = std::move(entity_);
    entity_.clear();
    const std::string& type = groups[0].value;
    if (type == "EOF") ended_ = true;
    if (section_ == "ENTITIES" && type == "ENDSEC") saw_entities_ = true;
    if (type == "SECTION") section_ = groups.size() > 1 ? groups[1].value : "?";
    const bool wanted = section_ == "HEADER" || section_ == "TABLES" || section_ == "BLOCKS" || section_ == "ENTITIES";
    if (!wanted || (section_ == "TABLES" && type != "LAYER" && type != "SECTION" && type != "ENDSEC") ||
        (section_ == "HEADER" && !FeedHeader(groups))) {
      if (type == "ENDSEC") section_.clear();
      return true;
    }
    if (type == "ENDSEC") section_.clear();
    if ((section_ == "BLOCKS" || section_ == "ENTITIES") && type != "SECTION" && KnownDxfType(type).empty()) ++out_.not_read[type];
    if (const std::optional<DL_LineData> line = PlainLine(groups)) {
      // What dxflib still has comes first: it makes that at the start of something else.
      if (std::exchange(pending_, false)) Feed(0, kNothing);
      builder_.Begin(HeaderOf(groups));
      builder_.addLine(*line);
    } else if (LacksNumbers(groups)) {
      if (std::exchange(pending_, false)) Feed(0, kNothing);
      builder_.Begin(HeaderOf(groups));
      builder_.CountBad();
    } else {
      MendCounts(groups);
      Feed(0, type);
      pending_ = true;
      builder_.Begin(HeaderOf(groups));
      for (size_t i = 1; i < groups.size(); ++i) {
        if (IsNeeded(groups[i].code, type)) Feed(groups[i].code, groups[i].value);
      }
    }
    if (!builder_.full()) return true;
    sink_.Emit(DiagnosticKind::kPlanTooComplex, {groups[0].line, 0, {}, type, 0},
               fmt::format("the drawing has more than {} points", options_.max_points));
    return false;
  }

  // Variables are one entity to us.
  bool FeedHeader(const Groups& groups) {
    if (groups[0].value == "ENDSEC") return true;
    for (size_t i = 1; i + 1 < groups.size(); ++i) {
      const std::string& name = groups[i].value;
      if (groups[i].code != 9) continue;
      if (name == "$INSUNITS") builder_.setVariableInt(name, ToInt(groups[i + 1].value), 70);
      if (name == "$MEASUREMENT") builder_.setVariableInt(name, ToInt(groups[i + 1].value), 70);
      if (name == "$ACADVER") builder_.setVariableString(name, groups[i + 1].value, 1);
    }
    return false;
  }

  DxfGroups groups_;
  DxfDocument out_;
  DxfBuilder builder_;
  DL_Dxf dxf_;
  std::string text_;
  TextBuffer buffer_;
  std::istream stream_{&buffer_};
  const DxfReadOptions& options_;
  DiagnosticSink& sink_;
  Groups entity_;
  std::string section_;
  bool ended_ = false, saw_entities_ = false, pending_ = false;
};

}  // namespace

std::optional<DxfDocument> ReadDxfDocument(const std::string& bytes, const DxfReadOptions& options, DiagnosticSink& sink) {
  return Feeder(bytes, options, sink).Run();
}

}  // namespace plumb::compiler
