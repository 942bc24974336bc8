#include "compiler/frontends/dxf/dxf_unfold.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

namespace plumb::compiler {
namespace {

constexpr uint32_t kNoSymbol = 0xffffffffu;

struct Place {
  Eigen::Affine2d T_drawing_block = Eigen::Affine2d::Identity();
  std::optional<uint32_t> layer;             // of the reference: for what lies on layer 0 of the block
  LayerUse use = LayerUse::kUnknown;         // by the block's name
  uint32_t symbol = kNoSymbol;
  const DxfEntity* reference = nullptr;      // the outermost one: what a person selects
  int depth = 0;
};

class Unfolder {
 public:
  Unfolder(const DxfDocument& document, const LayerRules& rules, const UnfoldOptions& options, DiagnosticSink& sink)
      : document_(document), options_(options), sink_(sink), rules_(rules) {
    for (const DxfLayer& layer : document.layers) uses_.push_back(rules.UseOf(layer.name));
    knows_walls_ = std::find(uses_.begin(), uses_.end(), LayerUse::kWall) != uses_.end();
  }

  std::optional<Drawing> Run() {
    Add(document_.entities, {});
    if (too_many_) {
      sink_.Emit(DiagnosticKind::kPlanTooComplex, {}, fmt::format("the drawing's blocks unfold to more than {} lines", options_.max_paths));
      return std::nullopt;
    }
    for (const std::string& name : missing_)
      sink_.Emit(DiagnosticKind::kBlockMissing, {}, fmt::format("block `{}` is referred to, but the file does not have it", name));
    for (const uint32_t layer : hidden_)
      sink_.Emit(DiagnosticKind::kLayerHidden, {}, fmt::format("layer `{}` is off or frozen; what is drawn on it is left out", document_.layers[layer].name));
    return std::move(out_);
  }

 private:
  void Add(const std::vector<DxfEntity>& entities, const Place& place) {
    for (const DxfEntity& e : entities) {
      if (out_.paths.size() > options_.max_paths) too_many_ = true;
      if (too_many_) return;
      const uint32_t layer = document_.layers[e.layer].name == "0" && place.layer ? *place.layer : e.layer;
      if (document_.layers[layer].hidden) {
        hidden_.insert(layer);
        continue;
      }
      if (e.insert) AddReference(e, layer, place);
      AddLines(e, layer, place);
      AddTexts(e, layer, place);
    }
  }

  SourceLocation LocationOf(const DxfEntity& e, const Place& place) const {
    const DxfEntity& named = place.reference != nullptr ? *place.reference : e;
    SourceLocation out;
    out.line = named.line;
    if (named.handle != 0xffffffffu) out.guid = fmt::format("{:X}", named.handle);
    out.type = fmt::format("{} on `{}`", named.type, document_.layers[named.layer].name);
    return out;
  }

  void AddLines(const DxfEntity& e, uint32_t layer, const Place& place) {
    const LayerUse on_layer = uses_[layer];
    if (on_layer == LayerUse::kIgnore || e.paths.empty()) return;
    const LayerUse use = place.use != LayerUse::kUnknown ? place.use : on_layer;
    if (place.use == LayerUse::kIgnore) return;
    const Eigen::Matrix2d m = place.T_drawing_block.linear();
    const double scale = std::sqrt(std::abs(m.determinant()));
    const bool similar = (m * m.transpose() - scale * scale * Eigen::Matrix2d::Identity()).cwiseAbs().maxCoeff() < 1e-6 * scale * scale;
    for (const DxfPath& path : e.paths) {
      DrawnPath drawn;
      drawn.role = RoleOf(use);
      // Where walls have layers of their own, other layers that nothing is known of can still have swings of doors.
      if (knows_walls_ && use == LayerUse::kUnknown) {
        if (path.arcs.empty() || path.filled) continue;
        drawn.role = LineRole::kOpening;
      }
      for (const auto& p : path.points) drawn.points.push_back(place.T_drawing_block * p);
      if (similar) {
        for (const Arc& arc : path.arcs) drawn.arcs.push_back(Moved(arc, place.T_drawing_block, scale));
      }
      drawn.closed = path.closed;
      if (drawn.points.size() > 2 && (drawn.points.front() - drawn.points.back()).norm() == 0) {
        drawn.points.pop_back();
        drawn.closed = true;
      }
      drawn.filled = path.filled;
      drawn.curved = path.curved;
      drawn.layer = layer;
      drawn.symbol = place.symbol;
      drawn.location = LocationOf(e, place);
      out_.paths.push_back(std::move(drawn));
    }
  }

  static Arc Moved(const Arc& arc, const Eigen::Affine2d& T, double scale) {
    Arc out;
    out.center = T * arc.center;
    out.radius_m = scale * arc.radius_m;
    const Eigen::Vector2d start = T.linear() * Eigen::Vector2d(std::cos(arc.start_rad), std::sin(arc.start_rad));
    out.start_rad = std::atan2(start.y(), start.x());
    out.sweep_rad = T.linear().determinant() < 0 ? -arc.sweep_rad : arc.sweep_rad;
    return out;
  }

  void AddTexts(const DxfEntity& e, uint32_t layer, const Place& place) {
    const double scale = std::sqrt(std::abs(place.T_drawing_block.linear().determinant()));
    for (const DxfText& text : e.texts) {
      if (!text.at.allFinite() || !std::isfinite(text.height)) continue;
      out_.texts.push_back({text.text, place.T_drawing_block * text.at, scale * text.height, text.underlined, uses_[layer] == LayerUse::kRoomName, LocationOf(e, place)});
    }
  }

  void AddReference(const DxfEntity& e, uint32_t layer, const Place& place) {
    const DxfInsert& insert = *e.insert;
    const auto block = document_.blocks.find(insert.block);
    if (block == document_.blocks.end()) {
      missing_.insert(insert.block);
      return;
    }
    const bool within_itself = std::find(open_.begin(), open_.end(), &block->second) != open_.end();
    const bool too_often = insert.columns > options_.max_copies || insert.rows > options_.max_copies ||
                           static_cast<int64_t>(std::max(1, insert.columns)) * std::max(1, insert.rows) > options_.max_copies;
    if (within_itself || place.depth >= options_.max_depth || too_often) {
      sink_.Emit(DiagnosticKind::kBlockNesting, LocationOf(e, place),
                 within_itself ? fmt::format("block `{}` contains itself; it is left out there", insert.block)
                 : too_often   ? fmt::format("block `{}` is repeated more than {} times; it is left out", insert.block, options_.max_copies)
                               : fmt::format("blocks are nested more than {} deep; `{}` is left out", options_.max_depth, insert.block));
      return;
    }
    Place inner;
    inner.layer = layer;
    inner.use = UseOfBlock(insert.block, layer, place);
    inner.reference = place.reference != nullptr && IsSymbolUse(place.use) ? place.reference : IsSymbolUse(inner.use) ? &e : place.reference;
    inner.depth = place.depth + 1;
    open_.push_back(&block->second);
    for (int row = 0; row < std::max(1, insert.rows); ++row) {
      for (int column = 0; column < std::max(1, insert.columns); ++column) {
        inner.symbol = place.symbol != kNoSymbol ? place.symbol : IsSymbolUse(inner.use) ? symbols_++ : kNoSymbol;
        const Eigen::Vector2d offset(column * insert.spacing.x(), row * insert.spacing.y());
        Eigen::Affine2d T = Eigen::Affine2d::Identity();
        if (e.mirrored) T.linear() << -1, 0, 0, 1;
        T = T * Eigen::Translation2d(insert.at) * Eigen::Rotation2Dd(insert.angle_rad) * Eigen::Translation2d(offset) * Eigen::Scaling(insert.scale) *
            Eigen::Translation2d(-block->second.base);
        inner.T_drawing_block = place.T_drawing_block * T;
        Add(block->second.entities, inner);
        if (too_many_) break;
      }
    }
    open_.pop_back();
  }

  // A reference on a layer of doors is a door, whatever the layers within it; else the block's name tells.
  LayerUse UseOfBlock(const std::string& name, uint32_t layer, const Place& place) {
    if (place.use != LayerUse::kUnknown) return place.use;
    if (uses_[layer] == LayerUse::kIgnore || IsSymbolUse(uses_[layer])) return uses_[layer];
    const auto known = block_uses_.find(name);
    if (known != block_uses_.end()) return known->second;
    LayerUse use = rules_.UseOf(name);
    for (const LayerRules& set : BuiltInLayerRules()) {
      if (use == LayerUse::kUnknown) use = set.UseOf(name);
    }
    if (!IsSymbolUse(use) && use != LayerUse::kColumn) use = LayerUse::kUnknown;
    return block_uses_.emplace(name, use).first->second;
  }

  const DxfDocument& document_;
  const UnfoldOptions& options_;
  DiagnosticSink& sink_;
  const LayerRules& rules_;
  std::vector<LayerUse> uses_;
  bool knows_walls_ = false, too_many_ = false;
  std::vector<const DxfBlock*> open_;
  std::map<std::string, LayerUse> block_uses_;
  std::set<std::string> missing_;
  std::set<uint32_t> hidden_;
  uint32_t symbols_ = 0;
  Drawing out_;
};

}  // namespace

std::vector<LayerWeight> WeighLayers(const DxfDocument& document) {
  std::vector<LayerWeight> out;
  for (const DxfLayer& layer : document.layers) out.push_back({layer.name, 0});
  const auto weigh = [&](const std::vector<DxfEntity>& entities) {
    for (const DxfEntity& e : entities) out[e.layer].weight += static_cast<double>(e.paths.size());
  };
  weigh(document.entities);
  for (const auto& [name, block] : document.blocks) {
    if (!name.starts_with("*D")) weigh(block.entities);  // those of dimensions are never drawn
  }
  return out;
}

std::optional<Drawing> Unfold(const DxfDocument& document, const LayerRules& rules, const UnfoldOptions& options, DiagnosticSink& sink) {
  return Unfolder(document, rules, options, sink).Run();
}

}  // namespace plumb::compiler
