// The straight wall surfaces of real plans against an independent tessellation, that of npm's web-ifc, run by node as a child process.
// Skipped without node, web-ifc or the plans.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "compiler/frontends/ifc/ifc_frontend.h"
#include "compiler/passes/polygon.h"
#include "compiler/passes/section.h"
#include "compiler/source/source.h"
#include "schema/files.h"
#include "tests/support/temporary_folder.h"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using compiler::DiagnosticKind;

constexpr double kExact_m = 0.001;
constexpr double kStep_m = 0.2;          // between samples, along and up
constexpr double kMargin_m = 0.03;       // samples keep off the edges of a surface and its openings
// Of the samples lie on the wall; the rest are tops that slope and openings that the A-Graph has none for.
constexpr double kMinCovered = 0.95;
constexpr int kNoWebIfc = 3;

struct Facet {
  Eigen::Vector3d a, b, c;
};
using FacetsOfWalls = std::map<std::string, std::vector<Facet>>;

double DistanceToEdge(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double t = along.squaredNorm() > 0 ? std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
  return (p - a - t * along).norm();
}

double DistanceTo(const Facet& f, const Eigen::Vector3d& p) {
  const Eigen::Vector3d n = (f.b - f.a).cross(f.c - f.a);
  const auto inside = [&](const Eigen::Vector3d& u, const Eigen::Vector3d& v) { return n.dot((v - u).cross(p - u)) >= 0; };
  if (n.norm() > 0 && inside(f.a, f.b) && inside(f.b, f.c) && inside(f.c, f.a)) return std::abs(n.normalized().dot(p - f.a));
  return std::min({DistanceToEdge(p, f.a, f.b), DistanceToEdge(p, f.b, f.c), DistanceToEdge(p, f.c, f.a)});
}

// As web_ifc.mjs writes them.
FacetsOfWalls ParseFacets(const std::string& bytes) {
  FacetsOfWalls out;
  constexpr size_t kHead = 28, kFacet = 9 * sizeof(double);
  for (size_t at = 0; at + kHead <= bytes.size();) {
    uint32_t count = 0;
    std::memcpy(&count, bytes.data() + at + 24, sizeof(count));
    std::vector<Facet>& facets = out[bytes.substr(at, 22)];
    for (at += kHead; count > 0 && at + kFacet <= bytes.size(); --count, at += kFacet) {
      double v[9];
      std::memcpy(v, bytes.data() + at, kFacet);
      facets.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}});
    }
  }
  return out;
}

bool LiesOn(const std::vector<Facet>& facets, const Eigen::Vector3d& p) {
  return std::any_of(facets.begin(), facets.end(), [&](const Facet& f) { return DistanceTo(f, p) <= kExact_m; });
}

// web-ifc loses faces of some walls when it cuts openings. The area vectors of a closed surface add up to nothing, however it is divided.
bool LacksFaces(const std::vector<Facet>& facets) {
  constexpr double kMaxShare = 0.01;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area_m2 = 0;
  for (const Facet& f : facets) {
    const Eigen::Vector3d n = 0.5 * (f.b - f.a).cross(f.c - f.a);
    sum += n;
    area_m2 += n.norm();
  }
  return sum.norm() > kMaxShare * area_m2;
}

double CutHeight(const AGraph& graph, const Surface& s) {
  return graph.storeys[s.storey.index()].elevation_m + compiler::CompileOptions().section_height_m;
}

// Ranges along a wall and up where it is open.
struct Hole {
  double from_m, to_m, bottom_m, top_m;
};

std::vector<Hole> HolesOf(const AGraph& graph, const Surface& s, const Eigen::Vector2d& along) {
  std::vector<Hole> holes;
  const auto add = [&](const auto& opening) {
    if (opening.wall != s.wall) return;
    const double middle = along.dot(opening.position.template head<2>() - s.start), half = opening.width_m / 2 + kMargin_m;
    holes.push_back({middle - half, middle + half, opening.position.z() - kMargin_m, opening.position.z() + opening.height_m + kMargin_m});
  };
  for (const Doorway& d : graph.doorways) add(d);
  for (const Window& w : graph.windows) add(w);
  return holes;
}

// Points of a surface that lie on the wall's body, as far as the A-Graph says: from its foot up to where the wall was cut. Above, a surface
// reaches to the highest point of a top that may slope.
std::vector<Eigen::Vector3d> Samples(const AGraph& graph, const Surface& s) {
  const Eigen::Vector2d along = (s.end - s.start).normalized();
  const std::vector<Hole> holes = HolesOf(graph, s, along);
  const double top_m = std::min(CutHeight(graph, s), s.z_max_m - kMargin_m);
  std::vector<Eigen::Vector3d> out;
  for (double x = kMargin_m; x < s.length_m() - kMargin_m; x += kStep_m) {
    for (double z = top_m; z > s.z_min_m + kMargin_m; z -= kStep_m) {
      const bool open = std::any_of(holes.begin(), holes.end(),
                                    [&](const Hole& h) { return x > h.from_m && x < h.to_m && z > h.bottom_m && z < h.top_m; });
      const Eigen::Vector2d at = s.start + x * along;
      if (!open) out.emplace_back(at.x(), at.y(), z);
    }
  }
  return out;
}

// Whether the surface is where the section cuts a face that leans: the top of a gable, a battered wall. No upright facet is there then, but
// all along the cut lies the wall.
bool LiesOnLeaningFace(const AGraph& graph, const Surface& s, const std::vector<Facet>& facets) {
  const Eigen::Vector2d along = (s.end - s.start).normalized();
  for (double x = kMargin_m; x < s.length_m() - kMargin_m; x += kStep_m) {
    const Eigen::Vector2d at = s.start + x * along;
    if (!LiesOn(facets, {at.x(), at.y(), CutHeight(graph, s)})) return false;
  }
  return true;
}

// GlobalIds of what the compiler says it did not read exactly.
std::set<std::string> NotExact(const compiler::DiagnosticSink& sink) {
  std::set<std::string> out;
  for (const compiler::Diagnostic& d : sink.all()) {
    const int code = static_cast<int>(d.kind);
    if (code >= static_cast<int>(DiagnosticKind::kUnsupportedGeometry) && code < static_cast<int>(DiagnosticKind::kWallWithoutBody)) {
      out.insert(d.location.guid);
    }
  }
  return out;
}

class WebIfc : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const fs::path plan = fs::path(PLUMB_SOURCE_DIR) / "../shared/data/plans/ifc" / (GetParam() + ".ifc");
    if (!fs::exists(plan)) GTEST_SKIP() << plan << " is not there";
    const test::TemporaryFolder folder;
    const std::string out = folder / "walls";
    const std::string command =
        "node '" PLUMB_SOURCE_DIR "/tests/support/web_ifc.mjs' walls '" + plan.string() + "' '" + out + "' 2> /dev/null";
    const int status = std::system(command.c_str());
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    if (code == kNoWebIfc || code == 127) GTEST_SKIP() << "node or web-ifc is not installed: npm install -g web-ifc";
    ASSERT_EQ(code, 0) << command;
    facets_ = ParseFacets(ReadFileText(out).value());
    result_ = compiler::Compile(plan.string());
    ASSERT_TRUE(result_.graph);
    compiler::DiagnosticSink sink;
    const auto source = compiler::LoadSource(plan.string(), sink);
    ASSERT_TRUE(source);
    plan_ = compiler::ReadIfc(*source, sink).value_or(compiler::PlanIr());
  }

  // Whether an opening of the wall takes it away at a point of its side. What fills it is another element, as a shop front.
  [[nodiscard]] bool IsOpenAt(const std::string& wall, const Eigen::Vector3d& p) const {
    const Eigen::Vector3d q = p - plan_.origin;
    return std::any_of(plan_.openings.begin(), plan_.openings.end(), [&](const compiler::PlanOpening& o) {
      if (o.wall == compiler::kNoIndex || plan_.elements[o.wall].guid != wall) return false;
      const std::vector<Ring> rings = compiler::CutSolid(o.body, q.z()).rings;
      return compiler::WindingNumber(rings, q.head<2>()) != 0 || compiler::DistanceToRings(q.head<2>(), rings) <= kMargin_m;
    });
  }

  // Whether openings take all of the surface at the height of the section.
  [[nodiscard]] bool IsOpen(const AGraph& graph, const Surface& s) const {
    const Eigen::Vector2d along = (s.end - s.start).normalized();
    for (double x = kMargin_m; x < s.length_m() - kMargin_m; x += kStep_m) {
      const Eigen::Vector2d at = s.start + x * along;
      if (!IsOpenAt(graph.walls[s.wall.index()].guid, {at.x(), at.y(), CutHeight(graph, s)})) return false;
    }
    return true;
  }

  FacetsOfWalls facets_;
  compiler::CompileResult result_;
  compiler::PlanIr plan_;
};

// How far the nearest facet that is parallel to the surface, and before it, lies off its plane.
double OffPlane(const Surface& s, const std::vector<Facet>& facets) {
  const Eigen::Vector2d along = (s.end - s.start).normalized();
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Facet& f : facets) {
    double off_m = 0, low = s.length_m(), high = 0;
    for (const Eigen::Vector3d& p : {f.a, f.b, f.c}) {
      off_m = std::max(off_m, std::abs(s.normal.dot(p) + s.d_m));
      low = std::min(low, along.dot(p.head<2>() - s.start));
      high = std::max(high, along.dot(p.head<2>() - s.start));
    }
    const bool beside = high < kMargin_m || low > s.length_m() - kMargin_m;
    if (!beside) nearest_m = std::min(nearest_m, off_m);
  }
  return nearest_m;
}

TEST_P(WebIfc, HasTheSameWallSurfacesToAMillimetre) {
  const AGraph& graph = *result_.graph;
  const std::set<std::string> not_exact = NotExact(result_.diagnostics);
  size_t surfaces = 0, leaning = 0, open = 0, samples = 0, covered = 0;
  std::set<std::string> lacking;
  double worst_m = 0;
  for (size_t i = 0; i < graph.surfaces.size(); ++i) {
    const Surface& s = graph.surfaces[i];
    const Wall& wall = graph.walls[s.wall.index()];
    const auto facets = facets_.find(wall.guid);
    // A bridged gap is taken for wall where none was drawn.
    if (s.arc || not_exact.contains(wall.guid) || facets == facets_.end() ||
        s.length_m() <= std::max(2 * kMargin_m, compiler::CompileOptions().max_gap_m))
      continue;
    const double off_m = OffPlane(s, facets->second);
    const bool lacks_faces = LacksFaces(facets->second);
    if (off_m > kExact_m && lacks_faces) {
      lacking.insert(wall.guid);
      continue;
    }
    if (off_m > kExact_m && LiesOnLeaningFace(graph, s, facets->second)) {
      ++leaning;
      continue;
    }
    if (off_m > kExact_m && IsOpen(graph, s)) {
      ++open;
      continue;
    }
    EXPECT_LE(off_m, kExact_m) << "surface " << i << " from " << s.start.transpose() << " to " << s.end.transpose() << " of wall "
                               << wall.guid << " `" << wall.name << "`";
    ++surfaces;
    worst_m = std::max(worst_m, off_m);
    for (const Eigen::Vector3d& p : Samples(graph, s)) {
      const bool lies_on = LiesOn(facets->second, p);
      if (!lies_on && (lacks_faces || IsOpenAt(wall.guid, p))) continue;
      ++samples;
      covered += lies_on;
    }
  }
  EXPECT_GT(surfaces, 0u);
  EXPECT_GE(static_cast<double>(covered), kMinCovered * static_cast<double>(samples))
      << covered << " of " << samples << " samples lie on a wall";
  std::cout << GetParam() << ": " << surfaces << " surfaces at most " << 1000 * worst_m << " mm off; " << covered << " of " << samples
            << " samples lie on the wall; left out: " << leaning << " on leaning faces, " << open
            << " that openings take whole, walls that lack faces in web-ifc: " << lacking.size() << "\n";
}

// Plans of at least some rooms, whose straight walls the compiler reads exactly.
INSTANTIATE_TEST_SUITE_P(All, WebIfc,
                         ::testing::Values("AC11-Institute-Var-2-IFC", "AC20-FZK-Haus", "Allplan-Smiley-West",
                                           "brunopostle_creative-freedom", "Duplex_A_20110907", "Jesse.1", "jgs_fhnw_model",
                                           "MAD_SCIENTIST_212", "Office_A_20110811", "revit2012_janesville_restaurant"),
                         [](const auto& plan) {
                           std::string name = plan.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
                           return name;
                         });

}  // namespace
}  // namespace plumb
