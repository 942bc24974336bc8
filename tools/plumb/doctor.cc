#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "runtime/sources/recording.h"
#include "schema/counted.h"
#include "schema/files.h"
#include "tools/plumb/command.h"
#include "tools/plumb/inputs.h"

namespace plumb::tools {
namespace {

// What one look through a recording finds.
struct Examination {
  std::string facts;
  std::vector<std::string> findings;
};

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void ExamineStamps(const runtime::Recording& recording, Examination& out) {
  const size_t n = recording.size();
  const double span_s = recording.stamp_s(n - 1) - recording.stamp_s(0);
  auto write = std::back_inserter(out.facts);
  fmt::format_to(write, "scans      {}, {:.1f} s", n, span_s);
  if (n < 2) {
    out.facts += "\n";
    out.findings.emplace_back("a single scan: nothing can be tracked");
    return;
  }
  std::vector<double> steps_s;
  for (size_t i = 1; i < n; ++i) steps_s.push_back(recording.stamp_s(i) - recording.stamp_s(i - 1));
  const double period_s = Median(steps_s);
  size_t gaps = 0, repeated = 0;
  double longest_s = 0;
  for (const double step_s : steps_s) {
    longest_s = std::max(longest_s, step_s);
    gaps += step_s > 1.8 * period_s;
    repeated += step_s <= 0;
  }
  fmt::format_to(write, ", {:.2f} Hz, longest step {:.3f} s\n", 1 / period_s, longest_s);
  if (repeated > 0) out.findings.push_back(fmt::format("{} with the stamp of the one before", Counted(repeated, "scan")));
  if (gaps > 0)
    out.findings.push_back(
        fmt::format("{} gaps between scans, the longest {:.2f} s at a period of {:.3f} s: scans are missing", gaps, longest_s, period_s));
}

// Reads every scan; the files are what mostly goes wrong.
void ExamineScans(const runtime::Recording& recording, Console& console, Examination& out) {
  size_t unreadable = 0, empty = 0, without_time = 0, without_ring = 0, read = 0;
  std::string first_error;
  double points = 0;
  float least_s = 0, most_s = 0, farthest_m = 0;
  for (size_t i = 0; i < recording.size(); ++i) {
    console.Progress("reading", i + 1, recording.size());
    const auto scan = recording.Read(i);
    if (!scan) {
      if (unreadable++ == 0) first_error = scan.error().message;
      continue;
    }
    ++read;
    points += static_cast<double>(scan->points.size());
    empty += scan->points.size() < 100;
    without_time += scan->time_s.empty();
    without_ring += scan->ring.empty();
    for (const float t : scan->time_s) least_s = std::min(least_s, t), most_s = std::max(most_s, t);
    for (const auto& p : scan->points) farthest_m = std::max(farthest_m, p.norm());
  }
  auto write = std::back_inserter(out.facts);
  if (read > 0) fmt::format_to(write, "points     {:.0f} per scan, farthest {:.1f} m\n", points / static_cast<double>(read), farthest_m);
  fmt::format_to(write, "time       {}\n",
                 without_time == read ? "none" : fmt::format("{:.4f} to {:.4f} s after the stamp", least_s, most_s));
  fmt::format_to(write, "ring       {}\n", without_ring == read ? "none" : "yes");
  if (unreadable > 0) out.findings.push_back(fmt::format("{} cannot be read, the first: {}", Counted(unreadable, "scan"), first_error));
  if (empty > 0) out.findings.push_back(fmt::format("{} with fewer than 100 points", Counted(empty, "scan")));
  if (without_time > 0)
    out.findings.push_back(
        fmt::format("{} without time per point: motion during the sweep cannot be taken out", Counted(without_time, "scan")));
  if (farthest_m > 1000)
    out.findings.push_back(fmt::format("a point is {:.0f} m away: are these millimetres? coordinates are in metres", farthest_m));
  if (most_s > 0.5F || least_s < -0.5F)
    out.findings.emplace_back("times per point span more than half a second: are they in seconds after the stamp?");
}

void ExamineOdometry(const runtime::Recording& recording, bool is_unreadable, Examination& out) {
  const runtime::Trajectory& odometry = recording.odometry();
  if (odometry.empty()) {
    out.facts += is_unreadable ? "odometry   cannot be read\n" : "odometry   none; not needed\n";
    return;
  }
  size_t covered = 0;
  for (size_t i = 0; i < recording.size(); ++i) covered += runtime::InterpolatePose(odometry, recording.stamp_s(i)).has_value();
  double path_m = 0;
  for (size_t i = 1; i < odometry.size(); ++i) path_m += (odometry[i].T.translation() - odometry[i - 1].T.translation()).norm();
  fmt::format_to(std::back_inserter(out.facts), "odometry   {} poses, {:.1f} m, covers {} of {} scans\n", odometry.size(), path_m, covered,
                 recording.size());
  if (covered + 1 < recording.size()) {
    out.findings.push_back(fmt::format("odometry.tum does not cover {} of {} scans: other clock, or it stops early",
                                       recording.size() - covered, recording.size()));
  }
}

bool IsName(const Error& fault) { return fault.code == ErrorCode::kNotARecording; }

// Of many scans with bad names the first.
void AddFaults(const std::vector<Error>& faults, Examination& out) {
  const auto names = static_cast<size_t>(std::count_if(faults.begin(), faults.end(), IsName));
  for (size_t i = 0; i < faults.size(); ++i) {
    if (IsName(faults[i]) && i > 0) continue;
    const bool is_first_of_many = IsName(faults[i]) && names > 1;
    out.findings.push_back((is_first_of_many ? Counted(names, "scan") + " with bad names, the first: " : "") + faults[i].message);
  }
}

void SayFindings(const Examination& examination, Console& console) {
  for (const std::string& finding : examination.findings) console.Print("finding: " + finding + "\n");
}

// As `plumb simulate` leaves it when it is stopped.
bool IsBrokenOff(const std::filesystem::path& truth) {
  const auto text = ReadFileText(truth.string());
  if (!text) return false;
  const nlohmann::json root = nlohmann::json::parse(*text, nullptr, false);
  return root.is_object() && root.value("incomplete", false);
}

Status RunDoctor(const std::string& folder, Session& session) {
  if (const auto fits = CheckInputs({{folder, InputKind::kRecording}}); !fits) return session.Fail(fits.error());
  std::vector<Error> faults;
  const auto recording = runtime::Recording::OpenWithFaults(folder, faults);
  Examination examination;
  AddFaults(faults, examination);
  if (!recording) {
    SayFindings(examination, session.console);
    return session.Fail(recording.error());
  }
  ExamineStamps(*recording, examination);
  ExamineScans(*recording, session.console, examination);
  ExamineOdometry(*recording, !std::all_of(faults.begin(), faults.end(), IsName), examination);
  if (IsBrokenOff(std::filesystem::path(folder) / "truth.json"))
    examination.findings.emplace_back("the simulation that wrote it was broken off: simulate it again");
  const bool has_truth = std::filesystem::exists(std::filesystem::path(folder) / "truth.tum");
  examination.facts += has_truth ? "truth      yes\n" : "truth      none: `plumb evaluate` needs it, nothing else does\n";
  session.console.Print(examination.facts);
  SayFindings(examination, session.console);
  if (examination.findings.empty()) session.console.Print("nothing amiss\n");
  return examination.findings.empty() ? Status::kFine : Status::kFindings;
}

}  // namespace

void AddDoctor(CLI::App& app, Session& session) {
  auto folder = std::make_shared<std::string>();
  CLI::App* sub =
      AddSubcommand(app, session, "doctor", "Check a recording folder: rates, gaps, missing fields, odometry", "  plumb doctor rec/");
  sub->add_option("REC", *folder, "recording folder")->required()->type_name("");
  sub->callback([folder, &session] { session.status = RunDoctor(*folder, session); });
}

}  // namespace plumb::tools
