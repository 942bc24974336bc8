#include "compiler/frontends/dxf/dxf_builder.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "compiler/frontends/dxf/dxf_text.h"

namespace plumb::compiler {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLetter = 0.7;  // its width, in the text's height
constexpr double kLine = 1.6;    // from line to line, in the text's height
constexpr double kMaxCoordinate = 1e12;

}  // namespace

std::string_view KnownDxfType(std::string_view type) {
  static constexpr std::string_view kKnown[] = {
      "LINE",   "LWPOLYLINE", "POLYLINE",  "VERTEX",         "SEQEND",    "ARC",      "CIRCLE",  "ELLIPSE",   "SPLINE",
      "INSERT", "HATCH",      "SOLID",     "TRACE",          "3DFACE",    "TEXT",     "MTEXT",   "ATTRIB",    "ATTDEF",
      "POINT",  "DIMENSION",  "LEADER",    "MULTILEADER",    "VIEWPORT",  "IMAGE",    "WIPEOUT", "XLINE",     "RAY",
      "BLOCK",  "ENDBLK",     "TOLERANCE", "ARCALIGNEDTEXT", "OLE2FRAME", "OLEFRAME", "SHAPE",   "ACAD_TABLE"};
  const auto* at = std::find(std::begin(kKnown), std::end(kKnown), type);
  return at == std::end(kKnown) ? std::string_view() : *at;
}

void DxfBuilder::addLayer(const DL_LayerData& data) {
  DxfLayer& layer = out_.layers[LayerOf(DecodeDxfText(data.name))];
  layer.hidden = data.off || (data.flags & 1) != 0 || getAttributes().getColor() < 0;
}

void DxfBuilder::addBlock(const DL_BlockData& data) {
  const std::string name = DecodeDxfText(data.name);
  in_paper_ = IsPaper(name);
  block_ = &out_.blocks[name];
  *block_ = {};
  block_->base = {data.bpx, data.bpy};
}

void DxfBuilder::addArc(const DL_ArcData& d) {
  AddArc({{d.cx, d.cy}, d.radius, d.angle1 * kDegree, Turn((d.angle2 - d.angle1) * kDegree)});
}

void DxfBuilder::addEllipse(const DL_EllipseData& d) {
  DxfPath path;
  path.curved = true;
  const double sign = header_.mirrored ? -1 : 1;
  AppendEllipse({{d.cx, d.cy}, {d.mx, d.my}, sign * d.ratio, d.angle1, Turn(d.angle2 - d.angle1)}, options_.chord_share, path.points);
  AddPath(std::move(path), false);
}

void DxfBuilder::addPolyline(const DL_PolylineData& d) {
  Finish();
  constexpr int kMeshes = 16 | 64;
  polyline_open_ = (d.flags & kMeshes) == 0;
  polyline_closed_ = (d.flags & 1) != 0;
  polyline_header_ = header_;
  if (!polyline_open_) ++out_.not_read["POLYLINE (mesh)"];
}

void DxfBuilder::addSpline(const DL_SplineData& d) {
  Finish();
  spline_ = {};
  spline_.degree = d.degree;
  spline_.closed = (d.flags & 1) != 0;
  spline_open_ = true;
  polyline_header_ = header_;
}

void DxfBuilder::addInsert(const DL_InsertData& d) {
  DxfInsert insert{DecodeDxfText(d.name), {d.ipx, d.ipy}, {d.sx, d.sy}, {d.colSp, d.rowSp}, d.angle * kDegree, d.cols, d.rows};
  const bool finite = insert.at.allFinite() && insert.scale.allFinite() && insert.spacing.allFinite() && std::isfinite(insert.angle_rad);
  if (!finite) return CountBad();
  if (DxfEntity* e = NewEntity()) e->insert = std::move(insert);
}

void DxfBuilder::addMText(const DL_MTextData& d) {
  const std::vector<std::string> lines = PlainLines(mtext_ + d.text);
  const bool underlined = (mtext_ + d.text).find("\\L") != std::string::npos;
  mtext_.clear();
  DxfEntity* e = NewEntity();
  if (e == nullptr) return;
  const int column = (d.attachmentPoint - 1) % 3, row = (d.attachmentPoint - 1) / 3;
  const double count = static_cast<double>(lines.size());
  for (size_t i = 0; i < lines.size(); ++i) {
    const double width = kLetter * d.height * static_cast<double>(lines[i].size());
    const double down = kLine * d.height * (static_cast<double>(i) + 0.5 - (row == 1 ? 0.5 * count : row == 2 ? count : 0.0));
    AppendText(lines[i], {d.ipx, d.ipy}, {width * (column == 0 ? 0.5 : column == 2 ? -0.5 : 0.0), -down}, d.angle, d.height, *e);
    e->texts.back().underlined = underlined;
  }
}

bool DxfBuilder::IsPaper(std::string_view block) {
  return block.starts_with("*Paper_Space") || block.starts_with("*PAPER_SPACE") || block.starts_with("$PAPER_SPACE");
}

uint32_t DxfBuilder::LayerOf(const std::string& name) {
  const auto [at, added] = layer_ids_.emplace(name, static_cast<uint32_t>(out_.layers.size()));
  if (added) out_.layers.push_back({name, false});
  return at->second;
}

DxfEntity* DxfBuilder::NewEntity() {
  if (header_.paper || in_paper_ || header_.invisible) return nullptr;
  if (header_.tilted) {
    ++out_.not_read[header_.type + " (not in the plane)"];
    return nullptr;
  }
  std::vector<DxfEntity>& list = block_ != nullptr ? block_->entities : out_.entities;
  DxfEntity& e = list.emplace_back();
  e.layer = LayerOf(header_.layer);
  e.handle = header_.handle;
  e.line = header_.line;
  e.type = KnownDxfType(header_.type);
  e.mirrored = header_.mirrored;
  return &e;
}

void DxfBuilder::AddPath(DxfPath path, bool own_frame) {
  const auto usable = [](const Eigen::Vector2d& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < kMaxCoordinate; };
  if (path.points.size() < 2 || !std::all_of(path.points.begin(), path.points.end(), usable)) return CountBad();
  if (own_frame && header_.mirrored) {
    for (auto& p : path.points) p.x() = -p.x();
    for (Arc& a : path.arcs) a.center.x() = -a.center.x(), a.start_rad = std::numbers::pi - a.start_rad, a.sweep_rad = -a.sweep_rad;
  }
  points_ += path.points.size();
  if (DxfEntity* e = NewEntity()) e->paths.push_back(std::move(path));
}

void DxfBuilder::AddArc(const Arc& arc) {
  if (!(arc.radius_m > 0) || !std::isfinite(arc.start_rad + arc.sweep_rad)) return CountBad();
  DxfPath path;
  path.curved = true;
  AppendArc(arc, options_.chord_share, path.points);
  path.closed = arc.sweep_rad >= 2 * std::numbers::pi - 1e-9;
  if (path.closed) path.points.pop_back();
  path.arcs.push_back(arc);
  AddPath(std::move(path), true);
}

void DxfBuilder::AddText(const DL_TextData& d) {
  const std::string text = PlainText(d.text);
  DxfEntity* e = text.empty() ? nullptr : NewEntity();
  if (e == nullptr) return;
  const bool aligned = d.hJustification != 0 || d.vJustification != 0;
  const double width = kLetter * d.height * static_cast<double>(text.size());
  const double x = d.hJustification == 1 || d.hJustification == 4 ? 0 : d.hJustification == 2 ? -0.5 * width : 0.5 * width;
  const double y = d.vJustification == 3 ? -0.5 * d.height : d.vJustification == 2 || d.hJustification == 4 ? 0 : 0.5 * d.height;
  AppendText(text, aligned ? Eigen::Vector2d(d.apx, d.apy) : Eigen::Vector2d(d.ipx, d.ipy), {x, y}, d.angle, d.height, *e);
  e->texts.back().underlined = d.text.find("%%u") != std::string::npos || d.text.find("%%U") != std::string::npos;
  if (header_.mirrored) e->texts.back().at.x() = -e->texts.back().at.x();
}

void DxfBuilder::AppendText(const std::string& text, const Eigen::Vector2d& at, const Eigen::Vector2d& offset, double angle_rad,
                            double height, DxfEntity& e) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  e.texts.push_back({text, at + Eigen::Vector2d(c * offset.x() - s * offset.y(), s * offset.x() + c * offset.y()), height, false});
}

void DxfBuilder::AddVertices(std::vector<Eigen::Vector3d> v, bool closed, bool filled) {
  const bool bulged = std::any_of(v.begin(), v.end(), [](const auto& p) { return std::abs(p.z()) > 1e-9; });
  DxfPath whole;
  whole.closed = closed;
  whole.filled = filled;
  if (!bulged) {
    for (const auto& p : v) whole.points.emplace_back(p.head<2>());
    return AddPath(std::move(whole), true);
  }
  DxfPath straight;
  const size_t sides = closed ? v.size() : v.size() - 1;
  const auto flush = [&] {
    if (straight.points.size() > 1 && !filled) AddPath(straight, true);
    straight.points.clear();
  };
  for (size_t i = 0; i < sides; ++i) {
    const Eigen::Vector2d a = v[i].head<2>(), b = v[(i + 1) % v.size()].head<2>();
    if (std::abs(v[i].z()) <= 1e-9 || a == b) {
      if (straight.points.empty()) straight.points.push_back(a);
      straight.points.push_back(b);
      whole.points.push_back(a);
      continue;
    }
    flush();
    DxfPath curve;
    curve.curved = true;
    curve.arcs.push_back(ArcOfBulge(a, b, v[i].z()));
    AppendArc(curve.arcs.back(), options_.chord_share, curve.points);
    curve.points.front() = a;
    curve.points.back() = b;
    whole.points.insert(whole.points.end(), curve.points.begin(), curve.points.end() - 1);
    if (!filled) AddPath(std::move(curve), true);
  }
  flush();
  whole.curved = true;
  if (filled) AddPath(std::move(whole), true);
}

void DxfBuilder::addHatchEdge(const DL_HatchEdgeData& d) {
  if (loops_.empty()) return;
  DxfPath& loop = loops_.back();
  points_ += 1;
  if (!d.vertices.empty()) {
    std::vector<Eigen::Vector3d> v;
    for (const auto& p : d.vertices) {
      if (p.size() >= 2) v.emplace_back(p[0], p[1], p.size() > 2 ? p[2] : 0.0);
    }
    for (size_t i = 0; i < v.size(); ++i) {
      const Eigen::Vector2d a = v[i].head<2>(), b = v[(i + 1) % v.size()].head<2>();
      if (std::abs(v[i].z()) > 1e-9 && a != b)
        AppendArc(ArcOfBulge(a, b, v[i].z()), options_.chord_share, loop.points), loop.points.pop_back();
      else
        loop.points.push_back(a);
    }
    return;
  }
  const double sign = d.ccw ? 1 : -1;
  switch (d.type) {
    case 1: loop.points.emplace_back(d.x1, d.y1); break;
    case 2:
      AppendArc({{d.cx, d.cy}, d.radius, sign * d.angle1, sign * Turn(d.angle2 - d.angle1)}, options_.chord_share, loop.points);
      break;
    case 3:
      AppendEllipse({{d.cx, d.cy}, {d.mx, d.my}, d.ratio, sign * d.angle1, sign * Turn(d.angle2 - d.angle1)}, options_.chord_share,
                    loop.points);
      break;
    case 4:
      for (const auto& p : d.controlPoints) {
        if (p.size() >= 2) loop.points.emplace_back(p[0], p[1]);
      }
      break;
    default: break;
  }
}

void DxfBuilder::Finish() {
  if (!polyline_open_ && !spline_open_ && !hatch_open_) return;
  const DxfEntityHeader now = std::exchange(header_, polyline_header_);
  if (std::exchange(polyline_open_, false) && vertices_.size() > 1) AddVertices(std::move(vertices_), polyline_closed_, false);
  vertices_.clear();
  if (std::exchange(spline_open_, false)) {
    DxfPath path;
    path.curved = true;
    path.points = SplinePoints(spline_);
    path.closed = spline_.closed;
    AddPath(std::move(path), false);
    spline_ = {};
  }
  if (std::exchange(hatch_open_, false)) {
    for (DxfPath& loop : loops_) {
      loop.closed = loop.filled = true;
      if (loop.points.size() > 2) AddPath(std::move(loop), true);
    }
    loops_.clear();
  }
  header_ = now;
}

}  // namespace plumb::compiler
