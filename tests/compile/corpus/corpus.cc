// corpus PLAN|FOLDER... [--facts facts.json] [--min-ratio 0.95]: compiles plans and prints what was found of what is there, every miss by
// name.
//
// Spaces count as matched from an intersection over union of 0.8 with a room; only those that walls enclose count towards the ratio. Doors
// count as right if their doorway joins the rooms that hold the points on its two sides (truth.h). Exit status 1 if the ratio of either
// over all plans stays below --min-ratio, 77 if there is no plan.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "compiler/frontends/ifc/ifc_frontend.h"
#include "compiler/passes/build_agraph.h"
#include "compiler/passes/polygon.h"
#include "compiler/source/source.h"
#include "compiler/validate_graph.h"
#include "tests/compile/corpus/truth.h"

namespace plumb::corpus {
namespace {

using compiler::PlanElement;
using compiler::PlanIr;

constexpr double kMatched = 0.8;

struct Tally {
  size_t good = 0, all = 0;
  void Count(bool is_good) {
    good += is_good;
    ++all;
  }
  Tally& operator+=(const Tally& o) {
    good += o.good;
    all += o.all;
    return *this;
  }
  [[nodiscard]] std::string Text() const { return fmt::format("{}/{}", good, all); }
  [[nodiscard]] double ratio() const { return all == 0 ? 1 : static_cast<double>(good) / static_cast<double>(all); }
};

struct PlanScore {
  std::string name;
  Tally storeys, walls, doors, windows, enclosed, open, joined;
  size_t rooms = 0, doorways = 0, passages = 0, errors = 0;
  double read_ms = 0, passes_ms = 0;
  std::vector<std::string> misses;
};

Rings RingsOf(const Room& r) {
  Rings out = {r.polygon};
  out.insert(out.end(), r.holes.begin(), r.holes.end());
  return out;
}

double Milliseconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
}

std::string NameOf(const AGraph& graph, RoomId id) { return id.valid() ? graph.rooms[id.index()].name : "outside"; }

std::string Describe(const Truth& truth, const DoorSide& side) {
  switch (side.kind) {
    case DoorSide::Kind::kSpace:
      return fmt::format("space `{}`", truth.spaces()[static_cast<size_t>(side.id)].name);
    case DoorSide::Kind::kCell:
      return fmt::format("the cell at ({:.2f}, {:.2f})", side.point.x(), side.point.y());
    case DoorSide::Kind::kOutside:
      return "outside";
    case DoorSide::Kind::kBlocked:
      return "nothing";
  }
  return {};
}

void ScoreSpaces(const Truth& truth, const AGraph& graph, PlanScore& score) {
  for (const TrueSpace& s : truth.spaces()) {
    double best = 0;
    for (const Room& r : graph.rooms) {
      if (r.floor_z_m < s.z_m && s.z_m < r.ceiling_z_m) best = std::max(best, Iou(s.outline, RingsOf(r)));
    }
    (s.enclosed ? score.enclosed : score.open).Count(best >= kMatched);
    if (best < kMatched) {
      score.misses.push_back(fmt::format("{} space `{}` {} on `{}`: best room has intersection over union {:.2f}",
                                         s.enclosed ? "enclosed" : "open", s.name, s.guid, s.storey, best));
    }
  }
}

// Whether the doorway's room on this side is the one that holds the point, or, where none does, begins behind the next wall: linings,
// low walls and parapets stand within spaces.
bool Fits(const AGraph& graph, RoomId id, const DoorSide& side, double z_m) {
  constexpr double kLining_m = 0.35;
  if (side.kind == DoorSide::Kind::kBlocked) return false;
  if (!id.valid()) return side.kind == DoorSide::Kind::kOutside || side.open_air;
  if (side.kind == DoorSide::Kind::kOutside) return false;
  const auto holds = [&](const Room& r) { return r.floor_z_m < z_m && z_m < r.ceiling_z_m && Inside(RingsOf(r), side.point); };
  if (Inside(RingsOf(graph.rooms[id.index()]), side.point)) return true;
  if (std::any_of(graph.rooms.begin(), graph.rooms.end(), holds)) return false;
  return compiler::DistanceToRings(side.point, RingsOf(graph.rooms[id.index()])) < kLining_m;
}

bool IsRight(const AGraph& graph, const Doorway& d, const TrueDoor& truth) {
  const DoorSide &a = truth.sides[0], &b = truth.sides[1];
  const bool differ = a.kind != b.kind || a.id != b.id;
  if (differ && d.room_a == d.room_b) return false;
  const auto fits = [&](RoomId id, const DoorSide& side) { return Fits(graph, id, side, truth.z_m); };
  return (fits(d.room_a, a) && fits(d.room_b, b)) || (fits(d.room_a, b) && fits(d.room_b, a));
}

void ScoreDoors(const Truth& truth, const AGraph& graph, PlanScore& score) {
  for (const TrueDoor& t : truth.doors()) {
    const auto found = std::find_if(graph.doorways.begin(), graph.doorways.end(), [&](const Doorway& d) { return d.guid == t.guid; });
    const bool right = found != graph.doorways.end() && IsRight(graph, *found, t);
    score.joined.Count(right);
    if (right) continue;
    const std::string got = found == graph.doorways.end()
                                ? "is no doorway"
                                : fmt::format("joins `{}` and `{}`", NameOf(graph, found->room_a), NameOf(graph, found->room_b));
    score.misses.push_back(fmt::format("door `{}` {} on `{}` at ({:.2f}, {:.2f}) {}; its sides are {} and {}", t.name, t.guid, t.storey,
                                       t.center.x(), t.center.y(), got, Describe(truth, t.sides[0]), Describe(truth, t.sides[1])));
  }
}

// IfcWindows that are a window of a wall, and what is said of those that are not.
void ScoreWindows(const PlanIr& plan, const AGraph& graph, const compiler::DiagnosticSink& sink, PlanScore& score) {
  std::set<std::string> found, drawn;
  for (const Window& w : graph.windows) found.insert(w.guid);
  for (const PlanElement& e : plan.elements) {
    if (!e.type.starts_with("IfcWindow") || !drawn.insert(e.guid).second) continue;
    score.windows.Count(found.contains(e.guid));
    if (found.contains(e.guid)) continue;
    const auto said = [&](const compiler::Diagnostic& d) {
      return d.location.guid == e.guid && d.kind >= compiler::DiagnosticKind::kOpeningNotPlaced;
    };
    const auto why = std::find_if(sink.all().begin(), sink.all().end(), said);
    score.misses.push_back(fmt::format("window `{}`: {}", e.name, why == sink.all().end() ? "nothing is said of it" : why->message));
  }
}

void CountAgainst(const nlohmann::json& facts, const AGraph& graph, PlanScore& score) {
  for (const auto& f : facts) {
    if (f.at("file") != score.name) continue;
    const auto& counts = f.at("counts");
    score.storeys.all = counts.at("storeys");
    score.walls.all = counts.at("walls");
    score.doors.all = counts.at("doors");
    score.windows.all = counts.at("windows");
    score.joined.all = std::max(score.joined.all, score.doors.all);
  }
  std::set<std::string> walls;
  for (const Wall& w : graph.walls) {
    if (w.type.starts_with("IfcWall")) walls.insert(w.guid);
  }
  score.storeys.good = graph.storeys.size();
  score.walls.good = walls.size();
  for (const Doorway& d : graph.doorways) (d.has_leaf ? score.doors.good : score.passages)++;
}

PlanScore ScorePlan(const std::string& path, const nlohmann::json& facts) {
  PlanScore out;
  out.name = std::filesystem::path(path).filename();
  compiler::DiagnosticSink sink;
  const auto start = std::chrono::steady_clock::now();
  const auto source = compiler::LoadSource(path, sink);
  std::optional<PlanIr> plan = source ? compiler::ReadIfc(*source, sink) : std::nullopt;
  out.read_ms = Milliseconds(start);
  if (!plan) {
    out.misses.push_back("is not read: " + compiler::DiagnosticsToText(sink.all(), path));
    return out;
  }
  const auto read = std::chrono::steady_clock::now();
  const std::optional<compiler::Built> built = compiler::BuildAGraph(*plan, {}, sink);
  out.passes_ms = Milliseconds(read);
  if (!built) {
    out.misses.push_back("is not compiled: " + compiler::DiagnosticsToText(sink.all(), path));
    return out;
  }
  const Truth truth(*plan);
  ScoreSpaces(truth, built->graph, out);
  ScoreDoors(truth, built->graph, out);
  ScoreWindows(*plan, built->graph, sink, out);
  CountAgainst(facts, built->graph, out);
  out.rooms = built->graph.rooms.size();
  out.doorways = built->graph.doorways.size();
  for (const auto& d : compiler::ValidateGraph(built->graph)) {
    if (d.severity != Severity::kError || d.kind == compiler::DiagnosticKind::kNoTriangles) continue;
    ++out.errors;
    out.misses.push_back("fault: " + d.message);
  }
  return out;
}

void Print(const std::vector<PlanScore>& scores, const PlanScore& sum) {
  constexpr const char* kRow = "{:<38} {:>7} {:>9} {:>9} {:>9} {:>6} {:>9} {:>9} {:>9} {:>8} {:>6} {:>8} {:>8}\n";
  fmt::print(fmt::runtime(kRow), "plan (found/known)", "storeys", "walls", "windows", "doors", "rooms", "enclosed", "open", "doors ok",
             "passages", "faults", "read ms", "pass ms");
  const auto print = [&](const PlanScore& s) {
    fmt::print(fmt::runtime(kRow), s.name, s.storeys.Text(), s.walls.Text(), s.windows.Text(), s.doors.Text(), s.rooms, s.enclosed.Text(),
               s.open.Text(), s.joined.Text(), s.passages, s.errors, fmt::format("{:.0f}", s.read_ms), fmt::format("{:.0f}", s.passes_ms));
  };
  for (const PlanScore& s : scores) print(s);
  print(sum);
  for (const PlanScore& s : scores) {
    if (!s.misses.empty()) fmt::print("\n{}\n", s.name);
    for (const std::string& miss : s.misses) fmt::print("  {}\n", miss);
  }
  fmt::print("\nenclosed spaces matched: {:.1f} %, doors that join the right rooms: {:.1f} %\n", 100 * sum.enclosed.ratio(),
             100 * sum.joined.ratio());
}

// Plans as they are, folders as the plans in them; what is not there is left out.
std::vector<std::string> PlansOf(const std::vector<std::string>& paths) {
  std::vector<std::string> out;
  for (const std::string& path : paths) {
    if (!std::filesystem::is_directory(path)) {
      if (std::filesystem::exists(path)) out.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      if (entry.path().extension() == ".ifc") found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

int Run(const std::vector<std::string>& given, const std::string& facts_path, double min_ratio) {
  constexpr int kSkipped = 77;
  const std::vector<std::string> paths = PlansOf(given);
  if (paths.empty()) {
    fmt::print("no plans there: nothing to compare\n");
    return kSkipped;
  }
  nlohmann::json facts = nlohmann::json::array();
  if (std::ifstream file(facts_path); file) facts = nlohmann::json::parse(file);
  std::vector<PlanScore> scores;
  PlanScore sum;
  sum.name = "all";
  for (const std::string& path : paths) {
    scores.push_back(ScorePlan(path, facts));
    const PlanScore& s = scores.back();
    sum.storeys += s.storeys;
    sum.walls += s.walls;
    sum.doors += s.doors;
    sum.windows += s.windows;
    sum.enclosed += s.enclosed;
    sum.open += s.open;
    sum.joined += s.joined;
    sum.rooms += s.rooms;
    sum.passages += s.passages;
    sum.errors += s.errors;
    sum.read_ms += s.read_ms;
    sum.passes_ms += s.passes_ms;
  }
  Print(scores, sum);
  return sum.errors == 0 && sum.enclosed.ratio() >= min_ratio && sum.joined.ratio() >= min_ratio ? 0 : 1;
}

}  // namespace
}  // namespace plumb::corpus

int main(int argc, char** argv) {
  CLI::App app("Compiles plans and prints what was found of what is there");
  std::vector<std::string> paths;
  std::string facts;
  double min_ratio = 0.95;
  app.add_option("PLAN", paths, "plans")->required();
  app.add_option("--facts", facts, "counts by an independent reader");
  app.add_option("--min-ratio", min_ratio, "of spaces matched, and of doors right, for exit status 0");
  CLI11_PARSE(app, argc, argv);
  return plumb::corpus::Run(paths, facts, min_ratio);
}
