#include "compiler/frontends/svg/svg_document.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "compiler/frontends/svg/svg_names.h"
#include "compiler/frontends/svg/svg_shapes.h"
#include "compiler/frontends/svg/svg_style.h"
#include "compiler/frontends/svg/svg_values.h"
#include "compiler/frontends/xml/xml.h"

namespace plumb::compiler {
namespace {

using Eigen::Affine2d;
using Eigen::Vector2d;
using tinyxml2::XMLElement;

constexpr double kLetter = 0.6;        // its width, in the text's height
constexpr double kJump = 1.5;          // from the start of one letter to that of the next, which none is wide
constexpr double kMiddle = 0.35;       // of capital letters above the base line
constexpr double kMaxCoordinate = 1e9;
constexpr std::string_view kLayerLabel = "inkscape:label";

bool IsOneOf(std::string_view name, std::initializer_list<std::string_view> names) { return std::find(names.begin(), names.end(), name) != names.end(); }

bool IsAscii(char c) { return static_cast<unsigned char>(c) < 0x80; }

struct Place {
  Affine2d T = Affine2d::Identity();  // from user units here to those of the document, y up
  Vector2d viewport = Vector2d::Zero();
  SvgStyle style;
  uint32_t node = kNoSvgNode;
  std::string_view id;  // of the innermost element that has one
  Eigen::AlignedBox2d clip = Eigen::AlignedBox2d(Vector2d::Constant(-2 * kMaxCoordinate), Vector2d::Constant(2 * kMaxCoordinate));
  int uses = 0;
};

class Reader {
 public:
  Reader(const Source& source, const SvgReadOptions& options, DiagnosticSink& sink) : source_(source), options_(options), sink_(sink) {}

  std::optional<SvgDocument> Run() {
    const XMLElement* root = ParseXml(source_.bytes, std::filesystem::path(source_.path).filename().string(), "svg", document_, sink_);
    if (root == nullptr) return std::nullopt;
    Collect(*root);
    Place place;
    place.T.linear() << 1, 0, 0, -1;
    place.viewport = RootSize(*root);
    Inherit(*root, place);
    VisitChildren(*root, place);
    if (!full_) return std::move(out_);
    sink_.Emit(DiagnosticKind::kPlanTooComplex, {}, fmt::format("the drawing has more than {} points, or more than {} elements with those that are used again", options_.max_points, options_.max_elements));
    return std::nullopt;
  }

 private:
  // User units are those of the viewBox: the size only tells how long they are on paper.
  Vector2d RootSize(const XMLElement& root) {
    const auto box = ParseSvgViewBox(SvgAttribute(root, "viewBox"));
    const std::string_view width = SvgAttribute(root, "width");
    if (const auto width_m = SvgPhysicalLength_m(width); width_m && *width_m > 0) {
      const double units = box ? box->width : SvgLength(width, 0).value_or(0);
      if (units > 0) out_.unit_on_paper_m = *width_m / units;
    }
    if (box) return {box->width, box->height};
    return {SvgLength(width, 0).value_or(0), SvgLength(SvgAttribute(root, "height"), 0).value_or(0)};
  }

  void Collect(const XMLElement& e) {
    if (const std::string_view id = SvgAttribute(e, "id"); !id.empty()) by_id_.emplace(id, &e);
    if (LocalName(e) == "style") {
      for (const auto* n = e.FirstChild(); n != nullptr; n = n->NextSibling()) {
        if (n->ToText() != nullptr) sheet_.Add(n->Value());
      }
    }
    for (const XMLElement* c = e.FirstChildElement(); c != nullptr; c = c->NextSiblingElement()) Collect(*c);
  }

  // False: the element and what it contains are not displayed.
  bool Inherit(const XMLElement& e, Place& place) {
    const std::vector<std::string> classes = SvgWords(SvgAttribute(e, "class"));
    const std::string_view id = SvgAttribute(e, "id");
    bool shown = true;
    for (const auto* a = e.FirstAttribute(); a != nullptr; a = a->Next()) shown &= ApplySvgDeclaration(a->Name(), a->Value(), place.style);
    for (const SvgDeclaration* d : sheet_.For(LocalName(e), classes, id)) shown &= ApplySvgDeclaration(d->property, d->value, place.style);
    for (const SvgDeclaration& d : ParseSvgDeclarations(SvgAttribute(e, "style"))) shown &= ApplySvgDeclaration(d.property, d.value, place.style);
    if (!id.empty()) place.id = id;
    SvgNode node;
    node.parent = place.node;
    node.names = SvgNames(SvgAttribute(e, kLayerLabel.data()), SvgAttribute(e, "data-name"), classes, id);
    if (!shown && SvgAttribute(e, "inkscape:groupmode") == "layer") out_.hidden_layers.insert(node.names.empty() ? std::string(id) : node.names.front());
    if (node.names.empty()) return shown;
    place.node = static_cast<uint32_t>(out_.nodes.size());
    out_.nodes.push_back(std::move(node));
    return shown;
  }

  void VisitChildren(const XMLElement& parent, const Place& place) {
    for (const XMLElement* e = parent.FirstChildElement(); e != nullptr && !full_; e = e->NextSiblingElement()) Visit(*e, place);
  }

  void Visit(const XMLElement& e, Place place) {
    if (++elements_ > options_.max_elements) full_ = true;
    const std::string_view kind = LocalName(e);
    if (full_ || !IsOneOf(kind, {"g", "a", "switch", "svg", "use", "path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "text", "image", "foreignObject"}))
      return;
    if (!SvgAttribute(e, "requiredExtensions").empty() || !Inherit(e, place)) return;
    if (const std::string_view transform = SvgAttribute(e, "transform"); !transform.empty()) {
      const auto T = SvgTransform(transform);
      if (!T) return Bad(e, "its transform is none");
      place.T = place.T * *T;
    }
    NarrowClip(e, place);
    if (IsOneOf(kind, {"g", "a", "switch"})) return VisitChildren(e, place);
    if (kind == "svg") return VisitViewport(e, e, place);
    if (kind == "use") return VisitUse(e, place);
    if (kind == "text") return AddTexts(e, place);
    if (kind == "image" || kind == "foreignObject") {
      ++out_.not_read[std::string(kind)];
      return;
    }
    AddShape(e, kind, place);
  }

  // To the box around its clip path, which is what drawing programs cut patterns with.
  void NarrowClip(const XMLElement& e, Place& place) {
    std::string_view reference = SvgAttribute(e, "clip-path");
    if (!reference.starts_with("url(#") || !reference.ends_with(")")) return;
    const auto found = by_id_.find(reference.substr(5, reference.size() - 6));
    if (found == by_id_.end() || SvgAttribute(*found->second, "clipPathUnits") == "objectBoundingBox") return;
    const Affine2d T = place.T * SvgTransform(SvgAttribute(*found->second, "transform")).value_or(Affine2d::Identity());
    Eigen::AlignedBox2d box;
    for (const XMLElement* c = found->second->FirstChildElement(); c != nullptr; c = c->NextSiblingElement()) {
      const Affine2d T_child = T * SvgTransform(SvgAttribute(*c, "transform")).value_or(Affine2d::Identity());
      for (const SvgOutline& outline : OutlinesOf(*c, LocalName(*c), place)) {
        for (const Vector2d& p : outline.points) box.extend(T_child * p);
      }
    }
    if (!box.isEmpty()) place.clip = place.clip.intersection(box);
  }

  // Of a nested <svg>, or of a <symbol> where `use` places it.
  void VisitViewport(const XMLElement& content, const XMLElement& use, Place place) {
    const auto box = ParseSvgViewBox(SvgAttribute(content, "viewBox"));
    const auto size = [&](const char* name, double whole) {
      return SvgLengthOf(use, name, whole, SvgLengthOf(content, name, whole, whole));
    };
    const Vector2d viewport(size("width", place.viewport.x()), size("height", place.viewport.y()));
    if (&content == &use) place.T = place.T * Eigen::Translation2d(SvgLengthOf(use, "x", place.viewport.x()), SvgLengthOf(use, "y", place.viewport.y()));
    place.viewport = box ? Vector2d(box->width, box->height) : viewport;
    if (box && viewport.minCoeff() > 0) place.T = place.T * SvgViewport(*box, viewport.x(), viewport.y(), SvgAttribute(content, "preserveAspectRatio"));
    VisitChildren(content, place);
  }

  void VisitUse(const XMLElement& use, Place place) {
    std::string_view href = SvgAttribute(use, "href");
    if (href.empty()) href = SvgAttribute(use, "xlink:href");
    const auto found = href.starts_with('#') ? by_id_.find(href.substr(1)) : by_id_.end();
    const auto unresolved = [&](const char* why) {
      sink_.Emit(DiagnosticKind::kUseUnresolved, LocationOf(use, place), fmt::format("`{}` {}; it is left out there", href, why));
    };
    if (found == by_id_.end()) return unresolved("is no element of the file");
    const XMLElement& target = *found->second;
    if (std::find(open_.begin(), open_.end(), &target) != open_.end()) return unresolved("uses itself");
    if (place.uses >= options_.max_depth) return unresolved("is used by what is used, too many times over");
    ++place.uses;
    place.T = place.T * Eigen::Translation2d(SvgLengthOf(use, "x", place.viewport.x()), SvgLengthOf(use, "y", place.viewport.y()));
    open_.push_back(&target);
    if (LocalName(target) == "symbol" || LocalName(target) == "svg") {
      if (Inherit(target, place)) VisitViewport(target, use, place);
    } else {
      Visit(target, place);
    }
    open_.pop_back();
  }

  SourceLocation LocationOf(const XMLElement& e, const Place& place) const {
    SourceLocation out;
    out.line = static_cast<uint32_t>(std::max(0, e.GetLineNum()));
    out.guid = std::string(place.id);
    out.type = std::string(LocalName(e));
    if (place.node != kNoSvgNode) out.type += fmt::format(" in `{}`", fmt::join(out_.nodes[place.node].names, " "));
    return out;
  }

  void Bad(const XMLElement& e, const char* why) {
    SourceLocation where;
    where.line = static_cast<uint32_t>(std::max(0, e.GetLineNum()));
    where.type = std::string(LocalName(e));
    where.guid = std::string(SvgAttribute(e, "id"));
    sink_.Emit(DiagnosticKind::kXmlBadValue, where, fmt::format("<{}> is left out: {}", LocalName(e), why));
  }

  std::vector<SvgOutline> OutlinesOf(const XMLElement& e, std::string_view kind, const Place& place) {
    bool faulty = false;
    std::vector<SvgOutline> out = SvgOutlinesOf(e, kind, place.viewport, options_.max_points - std::min(points_, options_.max_points), faulty);
    if (faulty) {
      sink_.Emit(DiagnosticKind::kXmlBadValue, LocationOf(e, place),
                 fmt::format("<{}>: its path data has a fault; it is read up to there", LocalName(e)));
    }
    return out;
  }

  void AddShape(const XMLElement& e, std::string_view kind, const Place& place) {
    SvgShape shape;
    shape.strokes = place.style.strokes();
    shape.fills = place.style.fills() && kind != "line";
    if (!shape.strokes && !shape.fills) return;
    shape.outlines = OutlinesOf(e, kind, place);
    for (SvgOutline& outline : shape.outlines) {
      points_ += outline.points.size();
      for (Vector2d& p : outline.points) {
        p = place.T * p;
        if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kMaxCoordinate) return Bad(e, "its coordinates are beyond reason");
      }
    }
    full_ |= points_ >= options_.max_points;
    std::erase_if(shape.outlines, [&](SvgOutline& outline) { return !ClipSvgOutline(place.clip, outline); });
    if (shape.outlines.empty()) return;
    shape.node = place.node;
    shape.fill_luminance = place.style.fill.luminance();
    shape.stroke_width = shape.strokes ? place.style.stroke_width * ScaleOf(place) : 0;
    shape.stroke_rgb = place.style.stroke.rgb;
    shape.location = LocationOf(e, place);
    out_.shapes.push_back(std::move(shape));
  }

  static double ScaleOf(const Place& place) { return std::sqrt(std::abs(place.T.linear().determinant())); }

  struct Line {
    std::string text;
    Vector2d at = Vector2d::Zero();
    double width = 0;  // stated by the places of its letters
    std::vector<double> letters_x = {};  // ... which these are, where each of them has its own
  };

  // Each part with a place of its own is a text of its own.
  void AddTexts(const XMLElement& text, const Place& place) {
    Line line;
    ReadLine(text, place, line);
    Flush(text, place, line);
  }

  void ReadLine(const XMLElement& e, const Place& place, Line& line) {
    const std::vector<double> x = SvgNumbers(SvgAttribute(e, "x")), y = SvgNumbers(SvgAttribute(e, "y")), dy = SvgNumbers(SvgAttribute(e, "dy"));
    if (!x.empty() || !y.empty() || !dy.empty()) {
      Flush(e, place, line);
      if (!x.empty()) line.at.x() = x.front(), line.letters_x = x;
      if (!y.empty()) line.at.y() = y.front();
      if (!dy.empty()) line.at.y() += SvgAttribute(e, "dy").find("em") != std::string_view::npos ? dy.front() * place.style.font_size : dy.front();
    }
    for (const auto* n = e.FirstChild(); n != nullptr; n = n->NextSibling()) {
      if (n->ToText() != nullptr) line.text += n->Value();
      const XMLElement* child = n->ToElement();
      if (child == nullptr || LocalName(*child) != "tspan") continue;
      Place inner = place;
      if (!Inherit(*child, inner)) continue;
      ReadLine(*child, inner, line);
      if (child->Attribute("x") != nullptr || child->Attribute("y") != nullptr) Flush(*child, inner, line);
    }
  }

  // Programs that print put several texts of one height into one element: they are told by the jumps between their letters.
  void Flush(const XMLElement& e, const Place& place, Line& line) {
    const std::vector<double> x = std::exchange(line.letters_x, {});
    const std::string text = fmt::format("{}", fmt::join(SvgWords(std::exchange(line.text, {})), " "));
    const double size = place.style.font_size, letter = kLetter * size;
    const bool one_by_one = x.size() > 1 && x.size() <= text.size() && std::all_of(text.begin(), text.end(), IsAscii);
    size_t first = 0;
    for (size_t i = 1; one_by_one && i < x.size(); ++i) {
      if (x[i] > x[i - 1] && x[i] - x[i - 1] < kJump * size) continue;
      line.text = text.substr(first, i - first);
      line.at.x() = x[first];
      line.width = x[i - 1] - x[first] + letter;
      FlushPart(e, place, line);
      first = i;
    }
    line.text = text.substr(first);
    if (!x.empty()) line.at.x() = x[first];
    line.width = x.size() > first + 1 ? x.back() - x[first] + letter : 0;
    FlushPart(e, place, line);
  }

  void FlushPart(const XMLElement& e, const Place& place, Line& line) {
    const std::string text = fmt::format("{}", fmt::join(SvgWords(std::exchange(line.text, {})), " "));
    const double size = place.style.font_size;
    const double width = line.width > 0 ? line.width : kLetter * size * static_cast<double>(text.size());
    const Vector2d at = place.T * (line.at + Vector2d((0.5 - place.style.text_anchor) * width, -kMiddle * size));
    line.width = 0;
    if (text.empty() || !place.style.visible || !at.allFinite()) return;
    out_.texts.push_back({text, at, size * ScaleOf(place), place.node, LocationOf(e, place)});
  }

  const Source& source_;
  const SvgReadOptions& options_;
  DiagnosticSink& sink_;
  tinyxml2::XMLDocument document_;
  SvgStyleSheet sheet_;
  std::map<std::string_view, const XMLElement*> by_id_;
  std::vector<const XMLElement*> open_;  // what is used, down to here
  size_t elements_ = 0, points_ = 0;
  bool full_ = false;
  SvgDocument out_;
};

}  // namespace

std::optional<SvgDocument> ReadSvgDocument(const Source& source, const SvgReadOptions& options, DiagnosticSink& sink) {
  return Reader(source, options, sink).Run();
}

}  // namespace plumb::compiler
