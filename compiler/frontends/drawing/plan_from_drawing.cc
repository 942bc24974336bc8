#include "compiler/frontends/drawing/plan_from_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "compiler/frontends/drawing/face_cover.h"
#include "compiler/frontends/drawing/opening_leaves.h"
#include "compiler/frontends/drawing/plane.h"
#include "compiler/frontends/drawing/room_names.h"
#include "compiler/frontends/drawing/wall_report.h"
#include "compiler/frontends/drawing/wall_runs.h"
#include "compiler/geometry/sweep.h"
#include "schema/polygon.h"

namespace plumb::compiler {
namespace {

constexpr double kOff_m = 1e-3;
constexpr double kSliver_m = 0.02;  // leftovers thinner than this are rounding
constexpr double kMinLeftover_m2 = 1e-3;
constexpr double kInLine = 0.96;         // cosine between openings in one wall
constexpr double kFrame_m = 0.2;         // a door frame's width and a bit
constexpr double kSwingShare = 0.25;     // of a line's length, for it to be the swing of a leaf
constexpr double kSymbolDepth_m = 0.04;  // of a door leaf in its opening

Solid Prism(const std::vector<Eigen::Vector2d>& ring, double bottom_m, double top_m) {
  Solid out = Extrude({ring}, {0, 0, top_m - bottom_m});
  for (auto& v : out.vertices) v.z() += bottom_m;
  return out;
}

class StoreyBuilder {
 public:
  StoreyBuilder(const Drawing& drawing, const PlanStorey& storey, const DrawingOptions& options, PlanIr& plan, DiagnosticSink& sink)
      : drawing_(drawing), options_(options), plan_(plan), sink_(sink), base_m_(storey.elevation_m) {
    plan.storeys.push_back(storey);
    NoteOtherStoreys();
    storey_ = static_cast<uint32_t>(plan.storeys.size() - 1);
    top_m_ = base_m_ + options.heights.storey_m;
  }

  bool Run() {
    SortPaths();
    std::optional<WallMass> mass = FindWallMass(drawing_, wall_paths_, options_.mass);
    if (!mass) return Fail();
    const Outline outline(*mass);
    openings_ = FindOpenings(drawing_, symbols_, outline, options_.openings);
    if (!AddOpeningsBehindOutlines(outline)) return Fail();
    RunOptions run_options;
    run_options.max_thickness_m = options_.mass.max_thickness_m;
    runs_ = FindWallRuns(outline, openings_, run_options);
    const OpeningLeaves leaves(drawing_, symbols_, options_.openings);
    for (WallRun& run : runs_) AddWall(run, leaves);
    AddSpaces();
    if (!AddLeftovers(outline)) return Fail();
    ReportWalls(drawing_, *mass, options_.mass, sink_);
    return true;
  }

 private:
  bool Fail() {
    sink_.Emit(DiagnosticKind::kPlanTooComplex, {},
               fmt::format("the drawing's lines end, meet and cross in more than {} places", options_.mass.max_vertices));
    return false;
  }

  // Leaves and swings of doors drawn among the walls are no walls.
  void SortPaths() {
    std::vector<const Arc*> swings;
    for (const DrawnPath& path : drawing_.paths) {
      for (const Arc& arc : path.arcs) {
        if (path.role == LineRole::kAny && IsSwing(arc, options_.openings) && IsMostly(arc, path)) swings.push_back(&arc);
      }
    }
    std::vector<Eigen::AlignedBox2d> hinges;
    for (const Arc* arc : swings) hinges.emplace_back(arc->center);
    const BoxTree<2> tree(std::move(hinges));
    for (uint32_t p = 0; p < drawing_.paths.size(); ++p) {
      const DrawnPath& path = drawing_.paths[p];
      const bool wall = path.role == LineRole::kWall || path.role == LineRole::kColumn;
      const bool swing =
          std::any_of(path.arcs.begin(), path.arcs.end(), [&](const Arc& a) { return IsSwing(a, options_.openings) && IsMostly(a, path); });
      if (wall || (path.role == LineRole::kAny && !swing && !IsLeaf(path, swings, tree)))
        wall_paths_.push_back(p);
      else
        symbols_.push_back(p);
    }
  }

  // The rest of a swing's line is at most its leaf; a rounded corner is little of a wall's outline.
  static bool IsMostly(const Arc& arc, const DrawnPath& path) {
    double length_m = path.closed ? (path.points.back() - path.points.front()).norm() : 0;
    for (size_t i = 0; i + 1 < path.points.size(); ++i) length_m += (path.points[i + 1] - path.points[i]).norm();
    return std::abs(arc.sweep_rad) * arc.radius_m > kSwingShare * length_m;
  }

  // A line or a thin box from the hinge, as long as the swing's radius.
  static bool IsLeaf(const DrawnPath& path, const std::vector<const Arc*>& swings, const BoxTree<2>& tree) {
    if (path.points.size() < 2 || path.points.size() > 5) return false;
    const Eigen::AlignedBox2d box = BoxOf(path.points);
    const double length = (path.points[1] - path.points[0]).norm(),
                 longest = std::max(length, path.points.size() > 2 ? (path.points[2] - path.points[1]).norm() : 0);
    const double width = path.points.size() == 2 ? 0 : LesserSide(path.points);
    bool leaf = false;
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(0.08);
    tree.ForEachIn({box.min() - reach, box.max() + reach}, [&](uint32_t i) {
      const double r = swings[i]->radius_m;
      if (std::abs(longest - r) > 0.08 * r || width > 0.1 * r) return;
      for (const auto& p : path.points) leaf = leaf || (p - swings[i]->center).norm() < 0.1 * r;
    });
    return leaf;
  }

  // The outlines of rooms go on across doorways: those that are nothing but gaps show in the other lines.
  bool AddOpeningsBehindOutlines(const Outline& outline) {
    std::vector<uint32_t> others = wall_paths_;
    std::erase_if(others, [&](uint32_t p) { return drawing_.paths[p].outlines_room; });
    if (others.size() == wall_paths_.size() || others.empty()) return true;
    const std::optional<WallMass> mass = FindWallMass(drawing_, others, options_.mass);
    if (!mass) return false;
    std::vector<DrawnOpening> behind;
    for (DrawnOpening& o : FindOpenings(drawing_, symbols_, Outline(*mass), options_.openings)) {
      const bool is_known = std::any_of(openings_.begin(), openings_.end(), [&](const DrawnOpening& k) {
        return (k.middle() - o.middle()).norm() < 0.5 * std::max(k.width_m(), o.width_m());
      });
      if (is_known || !outline.InWall(o.middle())) continue;
      std::erase_if(openings_, [&](const DrawnOpening& k) { return IsPieceBeside(k, o); });
      o.in_wall = true;
      behind.push_back(std::move(o));
    }
    std::move(behind.begin(), behind.end(), std::back_inserter(openings_));
    return true;
  }

  // Known by its frames alone, one of which is that of a doorway beside it: the piece of wall from there to the next frame.
  static bool IsPieceBeside(const DrawnOpening& known, const DrawnOpening& doorway) {
    if (known.path != kNone || !known.in_wall || doorway.in_wall || known.width_m() <= doorway.width_m()) return false;
    if (std::abs(known.along().dot(doorway.along())) < kInLine) return false;
    for (const Eigen::Vector2d& p : {known.from, known.to}) {
      if ((p - doorway.from).norm() < kFrame_m || (p - doorway.to).norm() < kFrame_m) return true;
    }
    return false;
  }

  const SourceLocation& LocationOf(uint32_t path) const {
    static const SourceLocation nowhere;
    return path < drawing_.paths.size() ? drawing_.paths[path].location : nowhere;
  }

  // Source ids are unique in the plan: the second wall of one polyline has "2F#2", one of another storey with an id that was there before
  // "Upper floor:2F".
  std::string UniqueGuid(const SourceLocation& at) {
    if (at.guid.empty()) return {};
    const std::string guid = of_other_storeys_.contains(at.guid) ? fmt::format("{}:{}", plan_.storeys[storey_].name, at.guid) : at.guid;
    const int number = ++guids_[guid];
    return number == 1 ? guid : fmt::format("{}#{}", guid, number);
  }

  void NoteOtherStoreys() {
    const auto note = [&](const auto& items) {
      for (const auto& item : items) of_other_storeys_.insert(item.guid.substr(0, item.guid.find('#')));
    };
    note(plan_.elements);
    note(plan_.openings);
    note(plan_.spaces);
  }

  PlanElement NewElement(ElementKind kind, const SourceLocation& location) {
    PlanElement out;
    out.kind = kind;
    out.location = location;
    out.type = location.type;
    out.guid = UniqueGuid(location);
    out.storey = storey_;
    return out;
  }

  void AddWall(WallRun& run, const OpeningLeaves& leaves) {
    PlanElement wall = NewElement(ElementKind::kWall, LocationOf(run.source));
    wall.uncut = Prism(run.Corners(), base_m_, top_m_);
    wall.thickness_m = run.thickness_m();
    wall.arcs = run.Arcs();
    const double middle = 0.5 * (run.left_m + run.right_m);
    if (!run.curve) wall.axis = std::make_pair(run.At(run.start_m, middle), run.At(run.end_m, middle));
    std::sort(run.openings.begin(), run.openings.end(),
              [&](uint32_t a, uint32_t b) { return run.S(openings_[a].middle()) < run.S(openings_[b].middle()); });
    double at = run.start_m;
    for (const uint32_t o : run.openings) {
      const auto [from, to] = Extent(run, o);
      if (from > at + kOff_m) AppendSolid(Prism(run.Part(at, from), base_m_, top_m_), wall.body);
      const auto [sill, head] = HeightsOf(openings_[o].use);
      if (head < top_m_) AppendSolid(Prism(run.Part(std::max(at, from), to), head, top_m_), wall.body);
      if (sill > base_m_) AppendSolid(Prism(run.Part(std::max(at, from), to), base_m_, sill), wall.body);
      at = std::max(at, to);
    }
    if (run.end_m > at + kOff_m) AppendSolid(Prism(run.Part(at, run.end_m), base_m_, top_m_), wall.body);
    plan_.elements.push_back(std::move(wall));
    const auto index = static_cast<uint32_t>(plan_.elements.size() - 1);
    for (const uint32_t o : run.openings) AddOpening(run, o, index, leaves);
  }

  std::pair<double, double> Extent(const WallRun& run, uint32_t o) const {
    const auto [from, to] = std::minmax({run.S(openings_[o].from), run.S(openings_[o].to)});
    return {std::clamp(from, run.start_m, run.end_m), std::clamp(to, run.start_m, run.end_m)};
  }

  std::pair<double, double> HeightsOf(DrawnUse use) const {
    const HeightOptions& h = options_.heights;
    if (use == DrawnUse::kWindow) return {base_m_ + h.sill_m, base_m_ + h.window_top_m};
    return {base_m_, base_m_ + h.door_m};
  }

  void AddOpening(const WallRun& run, uint32_t o, uint32_t wall, const OpeningLeaves& leaves) {
    const DrawnOpening& drawn = openings_[o];
    const auto [from, to] = Extent(run, o);
    if (to - from < kOff_m) return;
    const auto [sill, head] = HeightsOf(drawn.use);
    PlanOpening opening;
    opening.location = drawn.location;
    opening.wall = wall;
    opening.width_m = (run.At(to, 0) - run.At(from, 0)).norm();
    opening.height_m = head - sill;
    opening.body = Prism(run.Part(from, to), sill, head);
    if (drawn.use != DrawnUse::kPassage) {
      PlanElement filling = NewElement(drawn.use == DrawnUse::kDoor ? ElementKind::kDoor : ElementKind::kWindow, drawn.location);
      if (drawn.use == DrawnUse::kWindow) {
        filling.material = Material::kGlass;
        const double middle = 0.5 * (run.left_m + run.right_m), half = 0.5 * kSymbolDepth_m;
        filling.body = Prism(run.Layer(from, to, middle - half, middle + half), sill, head);
      }
      filling.leaves = leaves.Of(drawn);
      opening.filling = static_cast<uint32_t>(plan_.elements.size());
      plan_.elements.push_back(std::move(filling));
    } else {
      opening.guid = UniqueGuid(drawn.location);
    }
    plan_.openings.push_back(std::move(opening));
  }

  // What no run covers of the walls, and the free faces that texts lie in.
  bool AddLeftovers(const Outline& outline) {
    std::vector<MapLine> lines;
    for (const Side& s : outline.sides()) lines.push_back({s.a, s.b, s.source});
    for (const WallRun& run : runs_) {
      const auto corners = run.Corners();
      for (size_t k = 0; k < corners.size(); ++k) lines.push_back({corners[k], corners[(k + 1) % corners.size()], run.source});
    }
    const std::optional<LineMap> map = LineMap::Build(lines, options_.mass.join_m, options_.mass.max_vertices);
    if (!map) return false;
    const std::vector<FaceCover> covers = CoverOfFaces(*map, runs_, outline);
    for (uint32_t f = 1; f < covers.size(); ++f) {
      if (covers[f] == FaceCover::kWall) AddLeftover(*map, f);
    }
    NameFaces(*map, covers);
    return true;
  }

  void AddLeftover(const LineMap& map, uint32_t face) {
    Area area;
    double around_m = 0;
    for (const uint32_t loop : map.LoopsOf(face)) {
      area.push_back(map.RingAt(loop));
      around_m += LengthAround(area.back());
    }
    // Between a drawn round wall and its run lies a ring as thin as its chords are off it, whatever its extent.
    const double width_m = area.size() > 1 ? 2 * map.AreaOf(face) / around_m : LesserSide(area[0]);
    if (map.AreaOf(face) < kMinLeftover_m2 || width_m < kSliver_m) return;
    const uint32_t source = map.edges()[map.LoopsOf(face)[0] / 2].source;
    PlanElement wall = NewElement(ElementKind::kWall, LocationOf(source));
    wall.uncut = Extrude(area, {0, 0, top_m_ - base_m_});
    for (auto& v : wall.uncut.vertices) v.z() += base_m_;
    wall.body = wall.uncut;
    if (!wall.uncut.empty()) plan_.elements.push_back(std::move(wall));
  }

  // As the source draws them. What stands in them names them.
  void AddSpaces() {
    for (const DrawnSpace& drawn : drawing_.spaces) {
      std::vector<const DrawnText*> texts;
      for (const DrawnText& text : drawing_.texts) {
        if (Contains(drawn.outline, text.at)) texts.push_back(&text);
      }
      const std::string name = RoomName(texts);
      AddSpace(name.empty() ? drawn.name : name, drawn.location, {drawn.outline});
    }
  }

  void AddSpace(std::string name, const SourceLocation& location, const Area& area) {
    PlanSpace space;
    space.name = std::move(name);
    space.location = location;
    space.guid = UniqueGuid(location);
    space.storey = storey_;
    space.body = Extrude(area, {0, 0, top_m_ - base_m_});
    for (auto& v : space.body.vertices) v.z() += base_m_;
    plan_.spaces.push_back(std::move(space));
  }

  void NameFaces(const LineMap& map, const std::vector<FaceCover>& covers) {
    std::map<uint32_t, std::vector<const DrawnText*>> by_face;
    for (const DrawnText& text : drawing_.texts) {
      const uint32_t face = map.FaceAt(text.at);
      const bool drawn =
          std::any_of(drawing_.spaces.begin(), drawing_.spaces.end(), [&](const DrawnSpace& s) { return Contains(s.outline, text.at); });
      if (face != 0 && covers[face] == FaceCover::kFree && !drawn) by_face[face].push_back(&text);
    }
    for (const auto& [face, texts] : by_face) {
      const std::string name = RoomName(texts);
      if (name.empty()) continue;
      Area area;
      for (const uint32_t loop : map.LoopsOf(face)) area.push_back(map.RingAt(loop));
      AddSpace(name, texts[0]->location, area);
    }
  }

  const Drawing& drawing_;
  const DrawingOptions& options_;
  PlanIr& plan_;
  DiagnosticSink& sink_;
  double base_m_, top_m_;
  uint32_t storey_ = 0;
  std::vector<uint32_t> wall_paths_, symbols_;
  std::vector<DrawnOpening> openings_;
  std::vector<WallRun> runs_;
  std::map<std::string, int> guids_;
  std::set<std::string> of_other_storeys_;
};

}  // namespace

std::string HeightOptions::Check() const {
  if (!(storey_m > 1.2 && storey_m < 50)) return fmt::format("HeightOptions.storey_m = {}; must be in (1.2, 50)", storey_m);
  if (!(door_m > 1.2 && door_m <= storey_m)) return fmt::format("HeightOptions.door_m = {}; must be in (1.2, storey_m]", door_m);
  if (!(sill_m > 0 && sill_m < window_top_m && window_top_m <= storey_m))
    return fmt::format("HeightOptions.sill_m = {}, window_top_m = {}; must be 0 < sill_m < window_top_m <= storey_m", sill_m, window_top_m);
  return {};
}

std::string DrawingOptions::Check() const {
  for (const std::string& fault : {mass.Check(), openings.Check(), heights.Check()}) {
    if (!fault.empty()) return fault;
  }
  return {};
}

bool AppendStorey(const Drawing& drawing, const PlanStorey& storey, const DrawingOptions& options, PlanIr& plan, DiagnosticSink& sink) {
  return StoreyBuilder(drawing, storey, options, plan, sink).Run();
}

}  // namespace plumb::compiler
