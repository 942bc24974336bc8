#include "compiler/frontends/svg/svg_drawing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "compiler/frontends/drawing/arc_fit.h"

namespace plumb::compiler {
namespace {

constexpr double kDark = 0.5;    // luminance of fills that are material
constexpr double kPaper = 0.95;  // ... that are background

struct Meaning {
  LayerUse use = LayerUse::kUnknown;
  uint32_t symbol = 0xffffffffu;  // the outermost node of a door or window
  std::string room_name;
};

// Lines that go on where the one before ends, as one.
std::vector<SvgOutline> Joined(const std::vector<SvgOutline>& outlines) {
  std::vector<SvgOutline> out;
  for (const SvgOutline& o : outlines) {
    if (out.empty() || out.back().closed || o.closed || out.back().points.back() != o.points.front()) out.push_back(o);
    else out.back().points.insert(out.back().points.end(), o.points.begin() + 1, o.points.end());
  }
  return out;
}

class Converter {
 public:
  Converter(const SvgDocument& document, const LayerRules& rules) : document_(document) {
    for (uint32_t n = 0; n < document.nodes.size(); ++n) meanings_.push_back(MeaningOf(document.nodes[n], n, rules));
    for (const SvgShape& shape : document.shapes) {
      const LayerUse use = UseOf(shape.node);
      knows_walls_ |= use == LayerUse::kWall;
      knows_rooms_ |= use == LayerUse::kRoomName;
      only_tints_ &= !shape.strokes && shape.fill_luminance >= kDark;
    }
  }

  Drawing Run() {
    for (const SvgShape& shape : document_.shapes) Add(shape);
    for (const SvgText& text : document_.texts)
      out_.texts.push_back({text.text, text.at, text.height, false, UseOf(text.node) == LayerUse::kRoomName, text.location});
    return std::move(out_);
  }

 private:
  LayerUse UseOf(uint32_t node) const { return node == kNoSvgNode ? LayerUse::kUnknown : meanings_[node].use; }

  Meaning MeaningOf(const SvgNode& node, uint32_t index, const LayerRules& rules) const {
    Meaning out = node.parent == kNoSvgNode ? Meaning() : meanings_[node.parent];
    if (out.use == LayerUse::kIgnore || IsSymbolUse(out.use)) return out;
    for (size_t i = 0; i < node.names.size(); ++i) {
      const LayerUse use = rules.UseOf(node.names[i]);
      if (use == LayerUse::kUnknown) continue;
      out.use = use;
      // CubiCasa's "Door None": an opening without a door.
      const auto is_none = [](const std::string& name) { return name == "None"; };
      if (use == LayerUse::kDoor && std::any_of(node.names.begin(), node.names.end(), is_none)) out.use = LayerUse::kPassage;
      if (IsSymbolUse(use)) out.symbol = index;
      if (use == LayerUse::kRoomName) out.room_name = i + 1 < node.names.size() ? node.names[i + 1] : std::string();
      return out;
    }
    // Names within a group of rooms are those of rooms.
    if (out.use == LayerUse::kRoomName && !node.names.empty()) out.room_name = node.names.front();
    return out;
  }

  void Add(const SvgShape& shape) {
    const LayerUse use = UseOf(shape.node);
    if (use == LayerUse::kIgnore) return;
    if (use == LayerUse::kRoomName) {
      AddSpaces(shape);
      if (!knows_walls_) AddPaths(shape, LineRole::kAny);
      return;
    }
    const bool tint = !shape.strokes && (shape.fill_luminance >= kPaper || (shape.fill_luminance >= kDark && use == LayerUse::kUnknown));
    if (tint && !only_tints_) return;
    // Where walls have groups of their own, others that nothing is known of can still have swings of doors; so it is with rooms.
    const bool known = knows_walls_ || knows_rooms_;
    AddPaths(shape, known && use == LayerUse::kUnknown ? LineRole::kOpening : RoleOf(use));
  }

  void AddSpaces(const SvgShape& shape) {
    for (const SvgOutline& outline : shape.outlines) {
      if (outline.points.size() > 2 && (outline.closed || shape.fills)) out_.spaces.push_back({meanings_[shape.node].room_name, outline.points, shape.location});
    }
  }

  void AddPaths(const SvgShape& shape, LineRole role) {
    const bool unknown = role == LineRole::kOpening && UseOf(shape.node) == LayerUse::kUnknown;
    DrawnPath path;
    path.role = role;
    path.layer = StyleOf(shape);
    if (shape.node != kNoSvgNode) path.symbol = meanings_[shape.node].symbol;
    path.location = shape.location;
    for (const SvgOutline& outline : shape.fills ? shape.outlines : Joined(shape.outlines)) {
      path.points = outline.points;
      // A fill closes its outline. One that consists of several has holes, which lines alone tell.
      path.closed = outline.points.size() > 2 && (outline.closed || (shape.fills && !shape.strokes));
      path.filled = path.closed && shape.fills && shape.fill_luminance < kPaper && shape.outlines.size() == 1;
      path.stroke_m = path.filled ? 0 : shape.stroke_width;
      for (DrawnPath& part : SplitAtArcs(path)) {
        if (!unknown || (!part.arcs.empty() && !part.filled)) out_.paths.push_back(std::move(part));
      }
    }
  }

  // What is drawn alike: in one group, or where groups have no names, by one pen.
  uint32_t StyleOf(const SvgShape& shape) {
    const auto width = static_cast<int64_t>(std::llround(1000 * std::min(shape.stroke_width, 1e9)));
    return styles_.emplace(std::tuple(UseOf(shape.node), shape.stroke_rgb, width), static_cast<uint32_t>(styles_.size())).first->second;
  }

  const SvgDocument& document_;
  std::vector<Meaning> meanings_;  // by node
  bool knows_walls_ = false, knows_rooms_ = false, only_tints_ = true;
  std::map<std::tuple<LayerUse, uint32_t, int64_t>, uint32_t> styles_;
  Drawing out_;
};

}  // namespace

std::vector<LayerWeight> WeighNames(const SvgDocument& document) {
  const auto is_known = [](const std::string& name) {
    const auto& sets = BuiltInLayerRules();
    return std::any_of(sets.begin(), sets.end(), [&](const LayerRules& set) { return set.UseOf(name) != LayerUse::kUnknown; });
  };
  std::map<std::string, double> weights;
  std::map<uint32_t, std::string> name_of;  // by node: the innermost name that a set knows
  for (const SvgShape& shape : document.shapes) {
    auto [at, added] = name_of.try_emplace(shape.node);
    for (uint32_t n = shape.node; added && n != kNoSvgNode && at->second.empty(); n = document.nodes[n].parent) {
      const auto& names = document.nodes[n].names;
      const auto known = std::find_if(names.begin(), names.end(), is_known);
      if (known != names.end()) at->second = *known;
    }
    weights[at->second] += 1;
  }
  std::vector<LayerWeight> out;
  for (const auto& [name, weight] : weights) out.push_back({name, weight});
  return out;
}

Drawing DrawingFromSvg(const SvgDocument& document, const LayerRules& rules) { return Converter(document, rules).Run(); }

}  // namespace plumb::compiler
