#include "compiler/frontends/ifc/ifc_surfaces.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/unit/compiler/frontends/ifc/ifc_reader_fixture.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kInner_m = 4, kOuter_m = 4.2, kHeight_m = 3;

// A curved wall about the z axis as an IfcAdvancedBrep, its curved faces on surfaces and between edges of the kinds that programs write.
class CurvedWallText {
 public:
  enum class Surface { kCylinder, kRevolution, kExtrusion, kSpline };

  CurvedWallText(Surface surface, bool spline_edges, double low_rad, double high_rad)
      : surface_(surface), spline_edges_(spline_edges), low_rad_(low_rad), high_rad_(high_rad) {
    AddEdges();
    const auto edge = [&](const Key& key, bool forward) {
      return Add("IFCORIENTEDEDGE(*,*,#{},.{}.)", edges_.at(key), forward ? 'T' : 'F');
    };
    const auto ring = [&](double r, double z, bool forward) { return edge({'a', r, z}, forward); };
    const auto post = [&](double r, double end, bool forward) { return edge({'v', r, end}, forward); };
    const auto jamb = [&](double end, double z, bool forward) { return edge({'r', end, z}, forward); };
    const double i = kInner_m, o = kOuter_m, h = kHeight_m;
    AddFace({ring(o, 0, true), post(o, 1, true), ring(o, h, false), post(o, 0, false)}, SurfaceAt(o), true);
    AddFace({ring(i, 0, false), post(i, 0, true), ring(i, h, true), post(i, 1, false)}, SurfaceAt(i), false);
    AddFace({ring(o, h, true), jamb(1, h, false), ring(i, h, false), jamb(0, h, true)}, Plane(), true);
    AddFace({ring(o, 0, false), jamb(0, 0, false), ring(i, 0, true), jamb(1, 0, true)}, Plane(), false);
    AddFace({jamb(0, 0, true), post(o, 0, true), jamb(0, h, false), post(i, 0, false)}, Plane(), true);
    AddFace({jamb(1, 0, false), post(i, 1, true), jamb(1, h, true), post(o, 1, false)}, Plane(), true);
    brep_ = Add("IFCADVANCEDBREP(#{})", Add("IFCCLOSEDSHELL(({}))", List(faces_)));
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] std::string item() const { return fmt::format("#{}", brep_); }

 private:
  using Key = std::tuple<char, double, double>;  // rings: radius, height; posts: radius, end (0 low, 1 high); jambs: end, height

  template <class... Args>
  int Add(fmt::format_string<Args...> format, Args&&... args) {
    text_ += fmt::format("#{}={};\n", ++id_, fmt::format(format, std::forward<Args>(args)...));
    return id_;
  }
  static std::string List(const std::vector<int>& ids) {
    std::string out;
    for (const int id : ids) out += fmt::format("{}#{}", out.empty() ? "" : ",", id);
    return out;
  }
  int Point(const Vector3d& p) { return Add("IFCCARTESIANPOINT(({:.12f},{:.12f},{:.12f}))", p.x(), p.y(), p.z()); }
  Vector3d At(double r, double end, double z) const {
    const double a = end > 0 ? high_rad_ : low_rad_;
    return {r * std::cos(a), r * std::sin(a), z};
  }
  int Line(const Vector3d& a, const Vector3d& b) {
    const Vector3d d = (b - a).normalized();
    const int direction = Add("IFCDIRECTION(({:.12f},{:.12f},{:.12f}))", d.x(), d.y(), d.z());
    const int vector = Add("IFCVECTOR(#{},{:.12f})", direction, (b - a).norm());
    return Add("IFCLINE(#{},#{})", Point(a), vector);
  }
  int Placement(double z) { return Add("IFCAXIS2PLACEMENT3D(#{},$,$)", Point({0, 0, z})); }
  int Plane() { return Add("IFCPLANE(#{})", Placement(0)); }

  // Three quadratic arcs.
  static constexpr int kControls = 7;
  double Weight(int k) const { return k % 2 == 0 ? 1 : std::cos((high_rad_ - low_rad_) / (kControls - 1)); }
  int Control(double r, double z, int k) {
    const double a = low_rad_ + (high_rad_ - low_rad_) * k / (kControls - 1), q = r / Weight(k);
    return Point({q * std::cos(a), q * std::sin(a), z});
  }
  int Round(double r, double z) {
    if (!spline_edges_) return Add("IFCCIRCLE(#{},{:.12f})", Placement(z), r);
    std::vector<int> points;
    std::string weights;
    for (int k = 0; k < kControls; ++k) {
      points.push_back(Control(r, z, k));
      weights += fmt::format("{}{:.12f}", k > 0 ? "," : "", Weight(k));
    }
    return Add("IFCRATIONALBSPLINECURVEWITHKNOTS(2,({}),.UNSPECIFIED.,.F.,.F.,(3,2,2,3),(0.,1.,2.,3.),.UNSPECIFIED.,({}))", List(points),
               weights);
  }
  int SurfaceAt(double r) {
    switch (surface_) {
      case Surface::kCylinder: return Add("IFCCYLINDRICALSURFACE(#{},{:.12f})", Placement(0), r);
      case Surface::kRevolution: {  // of a line in the plane of x and z, which is the position's xy plane
        const int line = Add("IFCPOLYLINE((#{},#{}))", Point({r, 0, 0}), Point({r, kHeight_m, 0}));
        const int y = Add("IFCDIRECTION((0.,-1.,0.))"), x = Add("IFCDIRECTION((1.,0.,0.))"), up = Add("IFCDIRECTION((0.,1.,0.))");
        const int position = Add("IFCAXIS2PLACEMENT3D(#{},#{},#{})", Point({0, 0, 0}), y, x);
        const int axis = Add("IFCAXIS1PLACEMENT(#{},#{})", Point({0, 0, 0}), up);
        return Add("IFCSURFACEOFREVOLUTION(#{},#{},#{})", Add("IFCARBITRARYOPENPROFILEDEF(.CURVE.,$,#{})", line), position, axis);
      }
      case Surface::kExtrusion: {
        const int profile = Add("IFCARBITRARYOPENPROFILEDEF(.CURVE.,$,#{})", Round(r, 0));
        return Add("IFCSURFACEOFLINEAREXTRUSION(#{},$,#{},3.)", profile, Add("IFCDIRECTION((0.,0.,1.))"));
      }
      case Surface::kSpline: break;
    }
    std::string points, weights;
    for (int k = 0; k < kControls; ++k) {
      const char* comma = k > 0 ? "," : "";
      points += fmt::format("{}(#{},#{})", comma, Control(r, 0, k), Control(r, kHeight_m, k));
      weights += fmt::format("{}({:.12f},{:.12f})", comma, Weight(k), Weight(k));
    }
    return Add(
        "IFCRATIONALBSPLINESURFACEWITHKNOTS(2,1,({}),.UNSPECIFIED.,.F.,.F.,.F.,(3,2,2,3),(2,2),(0.,1.,2.,3.),(0.,1.),.UNSPECIFIED.,({}))",
        points, weights);
  }

  void AddEdges() {
    std::map<Key, int> vertices;  // radius, end, height as an 'e'
    const auto vertex = [&](double r, double end, double z) {
      const auto [at, fresh] = vertices.try_emplace({static_cast<char>('0' + static_cast<int>(end)), r, z}, 0);
      if (fresh) at->second = Add("IFCVERTEXPOINT(#{})", Point(At(r, end, z)));
      return at->second;
    };
    const auto add = [&](const Key& key, int a, int b, int curve) { edges_[key] = Add("IFCEDGECURVE(#{},#{},#{},.T.)", a, b, curve); };
    for (const double r : {kInner_m, kOuter_m}) {
      for (const double z : {0.0, kHeight_m}) add({'a', r, z}, vertex(r, 0, z), vertex(r, 1, z), Round(r, z));
      for (const double end : {0.0, 1.0})
        add({'v', r, end}, vertex(r, end, 0), vertex(r, end, kHeight_m), Line(At(r, end, 0), At(r, end, kHeight_m)));
    }
    for (const double end : {0.0, 1.0}) {
      for (const double z : {0.0, kHeight_m})
        add({'r', end, z}, vertex(kInner_m, end, z), vertex(kOuter_m, end, z), Line(At(kInner_m, end, z), At(kOuter_m, end, z)));
    }
  }
  void AddFace(const std::vector<int>& edges, int surface, bool same_sense) {
    const int bound = Add("IFCFACEOUTERBOUND(#{},.T.)", Add("IFCEDGELOOP(({}))", List(edges)));
    faces_.push_back(Add("IFCADVANCEDFACE((#{}),#{},.{}.)", bound, surface, same_sense ? 'T' : 'F'));
  }

  Surface surface_;
  bool spline_edges_;
  double low_rad_, high_rad_;
  int id_ = 99, brep_ = 0;
  std::string text_;
  std::map<Key, int> edges_;
  std::vector<int> faces_;
};

using Kind = CurvedWallText::Surface;

class CurvedWallTest : public IfcReaderTest, public testing::WithParamInterface<std::tuple<Kind, bool, double>> {};

TEST_P(CurvedWallTest, FollowsItsSurface) {
  const auto [surface, spline_edges, sweep_rad] = GetParam();
  const CurvedWallText wall(surface, spline_edges, -0.8, -0.8 + sweep_rad);
  const ShapeParts parts = ReadItem(wall.text(), wall.item(), "AdvancedBrep");
  ASSERT_EQ(parts.size(), 1u);
  const Solid& solid = parts[0].solid;
  EXPECT_TRUE(IsClosed(solid));
  EXPECT_NEAR(Volume(solid), 0.5 * sweep_rad * (kOuter_m * kOuter_m - kInner_m * kInner_m) * kHeight_m, 0.03);
  for (const Diagnostic& d : diagnostics_.all()) EXPECT_NE(d.kind, DiagnosticKind::kSimplifiedGeometry) << d.message;
  for (const Eigen::Vector3i& t : solid.triangles) {
    Vector3d middle = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) middle += solid.vertices[static_cast<size_t>(t[k])] / 3;
    EXPECT_GT(middle.head<2>().norm(), kInner_m - 0.003);
    EXPECT_LT(middle.head<2>().norm(), kOuter_m + 0.003);
  }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, CurvedWallTest,
                         testing::Combine(testing::Values(Kind::kCylinder, Kind::kRevolution, Kind::kExtrusion, Kind::kSpline),
                                          testing::Bool(), testing::Values(1.0, kPi, 4.7, 6.0)));

class SurfaceReaderTest : public IfcReaderTest {};

TEST_F(SurfaceReaderTest, AHoleLiesInItsFaceBeyondTheSeam) {
  Open("#10=IFCCYLINDRICALSURFACE(#11,2.);\n#11=IFCAXIS2PLACEMENT3D(#12,$,$);\n#12=IFCCARTESIANPOINT((0.,0.,0.));");
  const auto ring = [](double low_rad, double high_rad, double low_m, double high_m) {
    Ring3 out;
    const auto add = [&](int k, double z_m) {
      const double a = low_rad + (high_rad - low_rad) * k / 20;
      out.emplace_back(2 * std::cos(a), 2 * std::sin(a), z_m);
    };
    for (int k = 0; k <= 20; ++k) add(k, low_m);
    for (int k = 20; k >= 0; --k) add(k, high_m);
    return out;
  };
  const UnrolledFace face = SurfaceReader(*model_, *placements_, *curves_, options_.chord_tolerance_m)
                                .Unroll(Get(10), {ring(-0.8, 3.9, 0, 3), ring(3.3, 3.6, 1, 2)});
  ASSERT_EQ(face.rings.size(), 2u);
  EXPECT_NEAR(face.rings[0].front().x(), 2 * -0.8, 1e-9);
  EXPECT_NEAR(face.rings[1].front().x(), 2 * 3.3, 1e-9);
  EXPECT_TRUE(face.is_ruled);
}

TEST_F(SurfaceReaderTest, WhatBulgesIsUnrolledButSaidNotToBeFollowed) {
  Open(
      "#10=IFCBSPLINESURFACEWITHKNOTS(2,2,((#21,#22,#23),(#24,#25,#26),(#27,#28,#29)),.UNSPECIFIED.,.F.,.F.,.F.,(3,3),(3,3),(0.,1.),(0.,1.)"
      ","
      ".UNSPECIFIED.);\n#21=IFCCARTESIANPOINT((0.,0.,0.));\n#22=IFCCARTESIANPOINT((0.,0.,1.));\n#23=IFCCARTESIANPOINT((0.,0.,2.));\n"
      "#24=IFCCARTESIANPOINT((1.,0.,0.));\n#25=IFCCARTESIANPOINT((1.,1.,1.));\n#26=IFCCARTESIANPOINT((1.,0.,2.));\n"
      "#27=IFCCARTESIANPOINT((2.,0.,0.));\n#28=IFCCARTESIANPOINT((2.,0.,1.));\n#29=IFCCARTESIANPOINT((2.,0.,2.));");
  const UnrolledFace face = SurfaceReader(*model_, *placements_, *curves_, options_.chord_tolerance_m)
                                .Unroll(Get(10), {{{0, 0, 0}, {2, 0, 0}, {2, 0, 2}, {0, 0, 2}, {1, 0.25, 1}}});
  ASSERT_EQ(face.rings.size(), 1u);
  EXPECT_FALSE(face.is_ruled);
  const Vector2d middle = 0.25 * (face.rings[0][0] + face.rings[0][1] + face.rings[0][2] + face.rings[0][3]);
  EXPECT_LT((face.rings[0][4] - middle).norm(), 1e-6);
}

// A sheet of 10 x 10 control points over [0, 0.9] x [0, 0.9], #10, waved along x.
std::string Sheet(double height_m) {
  std::string rows, points;
  for (int i = 0; i < 10; ++i) {
    rows += i > 0 ? ",(" : "(";
    for (int j = 0; j < 10; ++j) {
      const int id = 100 + 10 * i + j;
      rows += fmt::format("{}#{}", j > 0 ? "," : "", id);
      points += fmt::format("#{}=IFCCARTESIANPOINT(({:.3f},{:.3f},{:.6f}));\n", id, 0.1 * i, 0.1 * j, height_m * std::sin(i));
    }
    rows += ")";
  }
  return fmt::format(
      "#10=IFCBSPLINESURFACEWITHKNOTS(3,3,({}),.UNSPECIFIED.,.F.,.F.,.F.,(4,1,1,1,1,1,1,4),(4,1,1,1,1,1,1,4),(0.,1.,2.,3.,4.,5.,6.,7.),(0.,"
      "1.,2.,3.,4.,5.,6.,7.),.UNSPECIFIED.);\n{}",
      rows, points);
}

// A loop of 40 points near the sheet's edges, not in a plane.
Ring3 SheetBound() {
  Ring3 ring;
  for (int k = 0; k < 40; ++k) {
    const double a = 2 * kPi * k / 40;
    ring.emplace_back(0.45 + 0.4 * std::cos(a), 0.45 + 0.4 * std::sin(a), 0.02 * std::sin(3 * a));
  }
  return ring;
}

TEST_F(SurfaceReaderTest, SplinesBeyondTheBudgetAreSimplifiedAndTheFileIsNotRefused) {
  Open(Sheet(0.02));
  const SurfaceReader reader(*model_, *placements_, *curves_, options_.chord_tolerance_m);
  size_t unrolled = 0;
  for (int face = 0; face < 2000; ++face) unrolled += reader.Unroll(Get(10), {SheetBound()}).rings.empty() ? 0 : 1;
  EXPECT_GT(unrolled, 100u);
  EXPECT_LT(unrolled, 2000u);
  EXPECT_TRUE(model_->Spend(900000, Get(10).index));
  EXPECT_TRUE(diagnostics_.all().empty());
}

TEST_F(SurfaceReaderTest, APlaneFaceOfASplineIsFlattenedOntoItsPlane) {
  Open(Sheet(0.0005));
  Ring3 ring = SheetBound();
  for (Vector3d& p : ring) p.z() = 0.0004;
  const UnrolledFace face = SurfaceReader(*model_, *placements_, *curves_, options_.chord_tolerance_m).Unroll(Get(10), {ring});
  ASSERT_EQ(face.rings.size(), 1u);
  EXPECT_TRUE(face.is_ruled);
  EXPECT_NEAR((face.rings[0][20] - face.rings[0][0]).norm(), 0.8, 1e-9);
  Open(Sheet(0.1));
  EXPECT_FALSE(SurfaceReader(*model_, *placements_, *curves_, options_.chord_tolerance_m).Unroll(Get(10), {ring}).is_ruled);
}

class CylinderTest : public IfcReaderTest {
 protected:
  // All round the cylinder of radius 2 about z.
  static Ring3 Round(double start_rad, double z_m, bool forward) {
    Ring3 out;
    for (int k = 0; k < 48; ++k) {
      const double a = start_rad + (forward ? 2 : -2) * kPi * k / 48;
      out.emplace_back(2 * std::cos(a), 2 * std::sin(a), z_m + 0.2 * std::sin(a));
    }
    return out;
  }
  UnrolledFace Unroll(const std::vector<Ring3>& rings) {
    Open("#10=IFCCYLINDRICALSURFACE(#11,2.);\n#11=IFCAXIS2PLACEMENT3D(#12,$,$);\n#12=IFCCARTESIANPOINT((0.,0.,0.));");
    return SurfaceReader(*model_, *placements_, *curves_, options_.chord_tolerance_m).Unroll(Get(10), rings);
  }
  static Ring3 Window(double middle_rad) {
    Ring3 out;
    for (const auto& [da, z] : {std::pair(-0.25, 1.0), {0.25, 1.0}, {0.25, 2.0}, {-0.25, 2.0}})
      out.emplace_back(2 * std::cos(middle_rad + da), 2 * std::sin(middle_rad + da), z);
    return out;
  }
};

TEST_F(CylinderTest, TwoRingsAllRoundBecomeOne) {
  for (const bool opposed : {true, false}) {
    for (const double start_rad : {0.0, 1.3, kPi}) {
      const UnrolledFace face = Unroll({Round(0, 0, true), Round(start_rad, 3, !opposed)});
      ASSERT_EQ(face.rings.size(), 1u);
      EXPECT_EQ(face.rings[0].size(), 98u);
      EXPECT_EQ(face.points.size(), 98u);
      EXPECT_NEAR(SignedArea(face.rings[0]), 4 * kPi * 3, 0.1);
    }
  }
}

TEST_F(CylinderTest, TheSeamKeepsClearOfHoles) {
  for (const double middle_rad : {0.0, 0.2, 1.0, kPi, 6.2}) {
    const UnrolledFace face = Unroll({Round(0, 0, true), Window(middle_rad), Window(middle_rad + 2), Round(0, 3, false)});
    ASSERT_EQ(face.rings.size(), 3u);
    double area_m2 = 0;
    const Triangulation2 result = TriangulatePolygon(face.rings);
    for (const Eigen::Vector3i& t : result.triangles) {
      const Ring2 corners = {result.points[static_cast<size_t>(t[0])], result.points[static_cast<size_t>(t[1])],
                             result.points[static_cast<size_t>(t[2])]};
      area_m2 += SignedArea(corners);
    }
    EXPECT_EQ(result.points.size(), face.points.size());
    EXPECT_NEAR(area_m2, 4 * kPi * 3 - 2 * 1.0, 0.1) << middle_rad;
  }
}

TEST_F(CylinderTest, OneRingAllRoundBoundsNothing) {
  EXPECT_TRUE(Unroll({Round(0, 0, true)}).rings.empty());
  EXPECT_TRUE(Unroll({Round(0, 0, true), Round(0, 1, true), Round(0, 2, false)}).rings.empty());
}

TEST_F(SurfaceReaderTest, AConeIsAFanAboutItsApex) {
  Open(
      "#10=IFCSURFACEOFREVOLUTION(#11,#15,#16);\n#11=IFCARBITRARYOPENPROFILEDEF(.CURVE.,$,#12);\n#12=IFCPOLYLINE((#13,#14));\n"
      "#13=IFCCARTESIANPOINT((1.,0.,0.));\n#14=IFCCARTESIANPOINT((0.,2.,0.));\n#15=IFCAXIS2PLACEMENT3D(#17,#18,#19);\n"
      "#16=IFCAXIS1PLACEMENT(#17,#20);\n#17=IFCCARTESIANPOINT((0.,0.,0.));\n#18=IFCDIRECTION((0.,-1.,0.));\n"
      "#19=IFCDIRECTION((1.,0.,0.));\n#20=IFCDIRECTION((0.,1.,0.));");
  Ring3 ring;  // round the rim, up the seam to the apex and down again
  for (int k = 0; k <= 48; ++k) ring.emplace_back(std::cos(2 * kPi * (k % 48) / 48), std::sin(2 * kPi * (k % 48) / 48), 0);
  ring.emplace_back(0, 0, 2);
  const UnrolledFace face = SurfaceReader(*model_, *placements_, *curves_, options_.chord_tolerance_m).Unroll(Get(10), {ring});
  ASSERT_EQ(face.rings.size(), 1u);
  EXPECT_TRUE(face.is_ruled);
  const Triangulation2 result = TriangulatePolygon(face.rings);
  EXPECT_EQ(result.triangles.size(), 48u);
  for (const Eigen::Vector3i& t : result.triangles) EXPECT_EQ(t.maxCoeff(), 49);
  ring.pop_back();
  ring.pop_back();
  EXPECT_TRUE(SurfaceReader(*model_, *placements_, *curves_, options_.chord_tolerance_m).Unroll(Get(10), {ring}).rings.empty());
}

// A column between two circles, its side without a seam edge, with or without its upper circle.
std::string SeamlessColumn(bool whole) {
  return fmt::format(
      "#10=IFCADVANCEDBREP(#11);\n#11=IFCCLOSEDSHELL((#12,#13,#14));\n#12=IFCADVANCEDFACE((#20{}),#40,.T.);\n"
      "#13=IFCADVANCEDFACE((#22),#41,.F.);\n#14=IFCADVANCEDFACE((#23),#42,.T.);\n"
      "#20=IFCFACEBOUND(#24,.T.);\n#21=IFCFACEBOUND(#25,.T.);\n#22=IFCFACEOUTERBOUND(#24,.F.);\n#23=IFCFACEOUTERBOUND(#25,.F.);\n"
      "#24=IFCEDGELOOP((#26));\n#25=IFCEDGELOOP((#27));\n#26=IFCORIENTEDEDGE(*,*,#30,.T.);\n#27=IFCORIENTEDEDGE(*,*,#31,.F.);\n"
      "#30=IFCEDGECURVE(#32,#32,#34,.T.);\n#31=IFCEDGECURVE(#33,#33,#35,.T.);\n#32=IFCVERTEXPOINT(#36);\n#33=IFCVERTEXPOINT(#37);\n"
      "#34=IFCCIRCLE(#43,0.5);\n#35=IFCCIRCLE(#44,0.5);\n#36=IFCCARTESIANPOINT((0.5,0.,0.));\n#37=IFCCARTESIANPOINT((0.5,0.,3.));\n"
      "#40=IFCCYLINDRICALSURFACE(#43,0.5);\n#41=IFCPLANE(#43);\n#42=IFCPLANE(#44);\n#43=IFCAXIS2PLACEMENT3D(#45,$,$);\n"
      "#44=IFCAXIS2PLACEMENT3D(#46,$,$);\n#45=IFCCARTESIANPOINT((0.,0.,0.));\n#46=IFCCARTESIANPOINT((0.,0.,3.));",
      whole ? ",#21" : "");
}

TEST_F(CylinderTest, AColumnWithoutSeamEdgeIsClosed) {
  const ShapeParts parts = ReadItem(SeamlessColumn(true), "#10", "AdvancedBrep");
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_TRUE(IsClosed(parts[0].solid));
  EXPECT_NEAR(Volume(parts[0].solid), kPi * 0.25 * 3, 0.03);
  EXPECT_TRUE(diagnostics_.all().empty());
}

TEST_F(CylinderTest, AFaceThatCannotBeUnrolledIsSaidToBeSimplified) {
  (void)ReadItem(SeamlessColumn(false), "#10", "AdvancedBrep");
  ASSERT_FALSE(diagnostics_.all().empty());
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kSimplifiedGeometry);
}

TEST_F(SurfaceReaderTest, KnotsThatDoNotFitAreNoSurface) {
  Open(
      "#10=IFCBSPLINESURFACEWITHKNOTS(1,1,((#21,#22),(#23,#24)),.UNSPECIFIED.,.F.,.F.,.F.,(2,3),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.);\n"
      "#21=IFCCARTESIANPOINT((0.,0.,0.));\n#22=IFCCARTESIANPOINT((0.,0.,1.));\n#23=IFCCARTESIANPOINT((1.,0.,0.));\n"
      "#24=IFCCARTESIANPOINT((1.,0.,1.));");
  EXPECT_TRUE(SurfaceReader(*model_, *placements_, *curves_, options_.chord_tolerance_m)
                  .Unroll(Get(10), {{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}}})
                  .rings.empty());
}

}  // namespace
}  // namespace plumb::compiler
