#include "compiler/frontends/mesh/mesh_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "compiler/frontends/mesh/mesh_bands.h"
#include "compiler/frontends/mesh/mesh_levels.h"

namespace plumb::compiler {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Unit {
  const char* name;
  double length_m;
};

constexpr std::array kUnits = {Unit{"m", 1.0}, Unit{"mm", 0.001}, Unit{"cm", 0.01}, Unit{"in", 0.0254}, Unit{"ft", 0.3048}};
// What storeys and walls measure, and how far that spreads (of the logarithm).
constexpr double kStoreyHeight_m = 2.7, kStoreySpread = 0.35, kThickness_m = 0.16, kThicknessSpread = 0.6;
constexpr double kUnpaired = 0.05;       // of the weight, for meshes without any wall of two faces
constexpr double kStatedAdvantage = 20;  // a stated unit is left only for one that fits this many times better
constexpr double kStatedAxisAdvantage = 0.6, kUsualAxisAdvantage = 0.2;  // in nats
constexpr double kDisorderWeight = 0.4;                                  // many storeys have many heights
constexpr double kSureAxis = 2.5;                                        // nats of disorder that one axis is ahead of the others
constexpr size_t kMaxTried = 200000;                                     // triangles, beyond which the disorder alone decides
constexpr double kUnusualAxisLag = 1.5;                                  // no program has x up by itself
constexpr double kLevels = 2000;                                         // steps of the histogram over the greatest extent

double Bell(double value, double middle, double spread) {
  const double x = std::log(std::max(value, 1e-9) / middle) / spread;
  return std::exp(-0.5 * x * x);
}

Matrix3d TurnFor(UpAxis up) {
  Matrix3d m = Matrix3d::Identity();
  if (up == UpAxis::kY) m << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == UpAxis::kX) m << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return m;
}

void Apply(const Matrix3d& m, MeshScene& scene) {
  for (MeshObject& o : scene.objects) {
    for (Vector3d& v : o.solid.vertices) v = m * v;
  }
  scene.origin = m * scene.origin;
}

// Numbers in the file and here differ by whole metres.
void RoundOrigin(MeshScene& scene) {
  const Vector3d whole = scene.origin.array().round(), rest = scene.origin - whole;
  scene.origin = whole;
  if (rest.isZero(0)) return;
  for (MeshObject& o : scene.objects) {
    for (Vector3d& v : o.solid.vertices) v += rest;
  }
}

// Entropy of the corners' coordinates along an axis: a building has few heights (floors, sills, lintels, tops) but many places.
double Disorder(const MeshScene& scene, int axis, double step) {
  std::map<int64_t, double> bins;
  double total = 0;
  for (const MeshObject& o : scene.objects) {
    for (const Eigen::Vector3i& t : o.solid.triangles) {
      for (int k = 0; k < 3; ++k) bins[std::llround(o.solid.vertices[static_cast<size_t>(t[k])][axis] / step)] += 1;
      total += 3;
    }
  }
  double out = 0;
  for (const auto& [bin, count] : bins) out -= count / total * std::log(count / total);
  return out;
}

const char* NameOf(UpAxis axis) { return axis == UpAxis::kX ? "x" : axis == UpAxis::kY ? "y" : "z"; }

// How much the walls of the scene, if its unit is `length_m`, look like those of buildings; 0..1.
double Likeness(const MeshScene& scene, double length_m, const MeshOptions& options) {
  std::vector<MeshObject> objects = scene.objects;
  for (MeshObject& o : objects) {
    for (Vector3d& v : o.solid.vertices) v *= length_m;
  }
  const std::vector<StoreyRange> storeys = FindStoreys(objects, objects);
  if (storeys.empty()) return 0;
  const StoreyRange& range = storeys.front();
  const double height_m = range.top_z_m - range.floor_z_m;
  SectionStack stack;
  stack.heights_m = {range.floor_z_m + 0.45 * height_m};
  stack.segments = {CutScene(objects, stack.heights_m[0])};
  double length = 0;
  for (const FaceSegment& f : stack.segments[0]) length += (f.b - f.a).norm();
  const auto directions = FindDirections(objects);
  const std::vector<uint32_t> group_of(objects.size(), 0);
  std::vector<std::pair<double, double>> thicknesses;  // with the length of wall that has it
  double paired = 0;
  for (const Band& band : FindBands(directions, stack, group_of, FindFacing(directions, stack, options), options)) {
    if (band.sheet) continue;
    double along = 0;
    for (const Span& s : band.spans[0]) along += s.s1_m - s.s0_m;
    thicknesses.emplace_back(band.c1_m - band.c0_m, along);
    paired += along;
  }
  const double storey = Bell(height_m, kStoreyHeight_m, kStoreySpread);
  if (!(paired > 0)) return kUnpaired * storey;
  std::sort(thicknesses.begin(), thicknesses.end());
  double sum = 0, median = thicknesses.back().first;
  for (const auto& [thickness, along] : thicknesses) {
    if ((sum += along) < 0.5 * paired) continue;
    median = thickness;
    break;
  }
  return storey * Bell(median, kThickness_m, kThicknessSpread) * std::min(1.0, kUnpaired + 2 * paired / length);
}

// The unit in which the walls look most like those of buildings, and how much they do.
std::pair<double, double> BestUnit(const MeshScene& scene, const MeshOptions& options) {
  if (const auto given = UnitFromName(options.unit)) return {*given, Likeness(scene, *given, options)};
  double best_m = scene.unit_m.value_or(1), best = Likeness(scene, best_m, options);
  // Good enough without a look at the others.
  if (best > 0.3 || (scene.unit_m && best > 0.01)) return {best_m, best};
  if (scene.unit_m) best *= kStatedAdvantage;
  for (const Unit& unit : kUnits) {
    const double likeness = Likeness(scene, unit.length_m, options);
    if (likeness <= best) continue;
    best = likeness;
    best_m = unit.length_m;
  }
  return {best_m, best};
}

struct AxisScore {
  UpAxis axis = UpAxis::kZ;
  double disorder = 0, lead = 0;  // nats; the lead of what is stated or usual
  [[nodiscard]] double Total() const { return disorder - lead; }
};

// The axis along which there are few heights; where several axes are close, as in buildings of many storeys and few rooms, that in whose
// sections walls look like walls.
UpAxis FindUp(const MeshScene& scene, const MeshOptions& options) {
  Eigen::AlignedBox3d box;
  size_t triangles = 0;
  for (const MeshObject& o : scene.objects) {
    box.extend(Bounds(o.solid));
    triangles += o.solid.triangles.size();
  }
  const double step = std::max(box.sizes().maxCoeff() / kLevels, 1e-9);
  std::vector<AxisScore> scores;
  for (const UpAxis axis : {UpAxis::kZ, UpAxis::kY, UpAxis::kX}) {
    AxisScore score{axis, Disorder(scene, static_cast<int>(axis), step), 0};
    if (scene.up) {
      score.lead = scene.up == axis ? kStatedAxisAdvantage : 0;
    } else if (axis != UpAxis::kY) {
      score.lead = axis == UpAxis::kZ ? kUsualAxisAdvantage : -kUnusualAxisLag;
    }
    scores.push_back(score);
  }
  std::stable_sort(scores.begin(), scores.end(), [](const AxisScore& a, const AxisScore& b) { return a.Total() < b.Total(); });
  if (triangles > kMaxTried || scores[1].Total() - scores[0].Total() > kSureAxis) return scores[0].axis;
  MeshOptions any_unit = options;  // a unit that is stated wrongly says nothing of the axes
  any_unit.unit.clear();
  UpAxis best = scores[0].axis;
  double most = -1e300;
  for (const AxisScore& score : scores) {
    if (score.Total() - scores[0].Total() > kSureAxis) continue;
    MeshScene turned = scene;
    Apply(TurnFor(score.axis), turned);
    const double fit = std::log(std::max(BestUnit(turned, any_unit).second, 1e-6)) + score.lead - kDisorderWeight * score.disorder;
    if (fit <= most) continue;
    most = fit;
    best = score.axis;
  }
  return best;
}

std::string TextOf(double unit_m) {
  for (const Unit& u : kUnits) {
    if (u.length_m == unit_m) return u.name;
  }
  return fmt::format("{} m", unit_m);
}

void ChooseUp(const MeshOptions& options, MeshScene& scene, DiagnosticSink& sink) {
  UpAxis up = UpAxis::kZ;
  if (options.up.empty()) {
    up = FindUp(scene, options);
    if (scene.up && *scene.up != up) {
      sink.Emit(DiagnosticKind::kMeshAxisContradiction, {},
                fmt::format("the format has {} up, but floors and lintels lie across {}; {} is taken to be up", NameOf(*scene.up),
                            NameOf(up), NameOf(up)),
                "state it: plumb compile --up");
    } else {
      sink.Emit(DiagnosticKind::kMeshFrame, {},
                fmt::format("{} is up, as {}", NameOf(up), scene.up ? "the format has it" : "its heights show"));
    }
  } else {
    up = options.up == "x" ? UpAxis::kX : options.up == "y" ? UpAxis::kY : UpAxis::kZ;
  }
  Apply(TurnFor(up), scene);
}

void ChooseUnit(const MeshOptions& options, MeshScene& scene, DiagnosticSink& sink) {
  double unit_m = UnitFromName(options.unit).value_or(1);
  if (options.unit.empty()) {
    unit_m = BestUnit(scene, options).first;
    if (scene.unit_m && *scene.unit_m != unit_m) {
      sink.Emit(DiagnosticKind::kMeshUnitContradiction, {},
                fmt::format("the format's unit is {}, but storeys and walls measure as in {}; {} is taken", TextOf(*scene.unit_m),
                            TextOf(unit_m), TextOf(unit_m)),
                "state it: plumb compile --unit");
    } else {
      sink.Emit(DiagnosticKind::kMeshFrame, {},
                fmt::format("the unit is {}, as {}", TextOf(unit_m), scene.unit_m ? "the format has it" : "storeys and walls measure"));
    }
  }
  if (unit_m != 1) Apply(unit_m * Matrix3d::Identity(), scene);
}

}  // namespace

std::optional<double> UnitFromName(std::string_view name) {
  for (const Unit& u : kUnits) {
    if (name == u.name) return u.length_m;
  }
  return std::nullopt;
}

void MoveToPlanFrame(const MeshOptions& options, MeshScene& scene, DiagnosticSink& sink) {
  ChooseUp(options, scene, sink);
  ChooseUnit(options, scene, sink);
  RoundOrigin(scene);
}

}  // namespace plumb::compiler
