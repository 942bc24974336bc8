// Entities of a drawing from what dxflib says of them, call by call. Part of the DXF adapter: dxflib's types go no further.
#pragma once

#include <dl_creationadapter.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/frontends/dxf/dxf_curves.h"
#include "compiler/frontends/dxf/dxf_document.h"

namespace plumb::compiler {

// What is asked of each entity before dxflib has it.
struct DxfEntityHeader {
  std::string type;
  uint32_t line = 0, handle = 0xffffffffu;
  std::string layer = "0";
  bool paper = false, invisible = false, mirrored = false, tilted = false;
};

// Of the entity types that are read, or that say nothing of a wall: its name, kept for good. Empty for others.
[[nodiscard]] std::string_view KnownDxfType(std::string_view type);

class DxfBuilder : public DL_CreationAdapter {
 public:
  DxfBuilder(const DxfReadOptions& options, DxfDocument& out) : options_(options), out_(out) {}

  void Begin(DxfEntityHeader header) { header_ = std::move(header); }
  [[nodiscard]] bool full() const { return points_ > options_.max_points; }
  // The entity begun last is left out.
  void CountBad() {
    if (bad_++ == 0) first_bad_ = header_;
  }
  [[nodiscard]] size_t bad() const { return bad_; }
  [[nodiscard]] const DxfEntityHeader& first_bad() const { return first_bad_; }

  void addLayer(const DL_LayerData& data) override;
  void addBlock(const DL_BlockData& data) override;
  void endBlock() override {
    block_ = nullptr;
    in_paper_ = false;
  }
  void addLine(const DL_LineData& d) override { AddPath({{{d.x1, d.y1}, {d.x2, d.y2}}, false, false, false, {}}, false); }
  void addArc(const DL_ArcData& d) override;
  void addCircle(const DL_CircleData& d) override { AddArc({{d.cx, d.cy}, d.radius, 0, 2 * std::numbers::pi}); }
  void addEllipse(const DL_EllipseData& d) override;
  void addPolyline(const DL_PolylineData& d) override;
  void addVertex(const DL_VertexData& d) override {
    if (polyline_open_) vertices_.emplace_back(d.x, d.y, d.bulge);
    points_ += 1;
  }
  void endSequence() override { Finish(); }
  void addSpline(const DL_SplineData& d) override;
  void addControlPoint(const DL_ControlPointData& d) override {
    spline_.control.emplace_back(d.x, d.y);
    spline_.weights.push_back(d.w);
    points_ += 1;
  }
  void addFitPoint(const DL_FitPointData& d) override { spline_.fit.emplace_back(d.x, d.y); }
  void addKnot(const DL_KnotData& d) override { spline_.knots.push_back(d.k); }
  void addInsert(const DL_InsertData& d) override;
  void addTrace(const DL_TraceData& d) override { AddQuad(d, true); }
  void addSolid(const DL_SolidData& d) override { AddQuad(d, true); }
  void add3dFace(const DL_3dFaceData& d) override {
    AddPath({{{d.x[0], d.y[0]}, {d.x[1], d.y[1]}, {d.x[2], d.y[2]}, {d.x[3], d.y[3]}}, true, false, false, {}}, false);
  }
  void addText(const DL_TextData& d) override { AddText(d); }
  void addAttribute(const DL_AttributeData& d) override { AddText(d); }
  void addMTextChunk(const std::string& text) override { mtext_ += text; }
  void addMText(const DL_MTextData& d) override;
  void addHatch(const DL_HatchData&) override { Finish(), hatch_open_ = true, polyline_header_ = header_; }
  void addHatchLoop(const DL_HatchLoopData&) override { loops_.emplace_back(); }
  void addHatchEdge(const DL_HatchEdgeData& d) override;
  void endEntity() override { Finish(); }
  void setVariableInt(const std::string& key, int value, int) override {
    if (key == "$INSUNITS") out_.insunits = value;
    if (key == "$MEASUREMENT") out_.measurement = value;
  }
  void setVariableString(const std::string& key, const std::string& value, int) override {
    if (key == "$ACADVER") out_.version = value;
  }

  // What comes in several calls is complete.
  void Finish();

 private:
  static bool IsPaper(std::string_view block);
  static double Turn(double angle) {  // into (0, 2 pi]
    const double out = std::fmod(angle, 2 * std::numbers::pi);
    return out <= 1e-12 ? out + 2 * std::numbers::pi : out;
  }

  uint32_t LayerOf(const std::string& name);


  DxfEntity* NewEntity();

  // Points of arcs, polylines and fills are in the entity's own frame, those of lines in the drawing's.
  void AddPath(DxfPath path, bool own_frame);

  void AddArc(const Arc& arc);

  template <class Quad>
  void AddQuad(const Quad& d, bool filled) {
    DxfPath path{{{d.x[0], d.y[0]}, {d.x[1], d.y[1]}, {d.x[3], d.y[3]}, {d.x[2], d.y[2]}}, true, filled, false, {}};
    AddPath(std::move(path), true);
  }

  void AddText(const DL_TextData& d);

  // dxflib gives angles of texts in radians.
  static void AppendText(const std::string& text, const Eigen::Vector2d& at, const Eigen::Vector2d& offset, double angle_rad, double height,
                         DxfEntity& e);

  // Straight sides and arcs of a polyline as paths of their own where both occur, so that only steps of curves count as such.
  void AddVertices(std::vector<Eigen::Vector3d> vertices, bool closed, bool filled);

  const DxfReadOptions& options_;
  DxfDocument& out_;
  DxfEntityHeader header_, polyline_header_, first_bad_;
  DxfBlock* block_ = nullptr;
  bool in_paper_ = false, polyline_open_ = false, polyline_closed_ = false, spline_open_ = false, hatch_open_ = false;
  std::vector<Eigen::Vector3d> vertices_;  // x, y, bulge
  SplineCurve spline_;
  std::vector<DxfPath> loops_;
  std::string mtext_;
  std::unordered_map<std::string, uint32_t> layer_ids_;
  size_t points_ = 0, bad_ = 0;
};

}  // namespace plumb::compiler
