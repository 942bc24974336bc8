#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <numbers>
#include <set>
#include <unordered_set>

#include "runtime/localizer/localizer.h"
#include "runtime/mapping/sgraph_json.h"
#include "schema/agraph_reader.h"
#include "schema/files.h"
#include "tools/plumb/command.h"
#include "tools/plumb/config.h"
#include "tools/plumb/interrupt.h"
#include "tools/run/ply.h"
#include "tools/run/run_folder.h"
#include "tools/run/run_info.h"

namespace plumb::tools {
namespace {

namespace fs = std::filesystem;

struct LocalizeFlags {
  std::string plan, recording, output;
  bool no_odometry = false;
  double start_s = 0, max_duration_s = 0;
  double tolerance_deg = 0.5;
  double map_voxel_m = 0.02;
  runtime::LocalizerOptions options;
};

// What the scans gave, in the order of the scans.
struct Results {
  runtime::Trajectory online;
  std::vector<VerdictRow> verdicts;
  std::vector<TimingRow> timing;
  size_t unreadable_scans = 0, untimed_scans = 0;
  bool interrupted = false;
};

Expected<Results> AddScans(const runtime::Recording& recording, const LocalizeFlags& flags, runtime::Localizer& localizer, Console& console) {
  Results results;
  Error last_error{ErrorCode::kBadScan, fmt::format("`{}` has no scan after {} s", flags.recording, flags.start_s)};
  const InterruptGuard interrupt;
  for (size_t i = 0; i < recording.size(); ++i) {
    const double time_s = recording.stamp_s(i) - recording.stamp_s(0);
    if (time_s < flags.start_s) continue;
    if (flags.max_duration_s > 0 && time_s - flags.start_s > flags.max_duration_s) break;
    if (interrupt.requested()) {
      results.interrupted = true;
      break;
    }
    const auto scan = recording.Read(i);
    if (!scan) {  // one bad file is no reason to lose hours of good ones
      console.Error(scan.error().message + "; skipped");
      last_error = scan.error();
      ++results.unreadable_scans;
      continue;
    }
    std::optional<runtime::Odometry::GivenMotion> given;
    if (!flags.no_odometry) given = runtime::GivenMotionDuring(*scan, recording.odometry());
    const runtime::ScanVerdict verdict = localizer.AddScan(*scan, given);
    if (!verdict.timed && !scan->points.empty() && results.untimed_scans++ == 0) {
      console.Info(fmt::format("scans without {}per-point time: deskew off", scan->time_s.empty() ? "" : "usable "));
    }
    results.verdicts.push_back({verdict.stamp_s, runtime::VerdictName(verdict.verdict), verdict.hypotheses});
    if (verdict.T_plan_lidar) results.online.push_back({verdict.stamp_s, *verdict.T_plan_lidar});
    for (const runtime::StageTime& stage : verdict.timing) results.timing.push_back({verdict.stamp_s, stage.stage, stage.ms});
    console.Progress("localizing", i + 1, recording.size());
  }
  if (results.verdicts.empty()) return tl::unexpected(last_error);
  return results;
}

struct Voxel {
  int64_t x = 0, y = 0, z = 0;
  friend bool operator==(const Voxel&, const Voxel&) = default;
};
struct VoxelHash {
  size_t operator()(const Voxel& v) const noexcept {
    return static_cast<size_t>(v.x) * 73856093u ^ static_cast<size_t>(v.y) * 19349663u ^ static_cast<size_t>(v.z) * 83492791u;
  }
};

// The keyframes' points in the plan frame, the first of each voxel. Nothing before the first fix: the map then lies nowhere in the plan.
std::vector<Eigen::Vector3d> AsBuiltCloud(const runtime::Localizer& localizer, double voxel_m) {
  std::vector<Eigen::Vector3d> cloud;
  const std::optional<Eigen::Isometry3d> T_plan_map = localizer.T_plan_map();
  if (!T_plan_map) return cloud;
  std::unordered_set<Voxel, VoxelHash> taken;
  for (const runtime::Keyframe& keyframe : localizer.map().keyframes) {
    const Eigen::Isometry3d T_plan_kf = *T_plan_map * keyframe.T_map_kf;
    for (const Eigen::Vector3f& point : keyframe.points) {
      const Eigen::Vector3d p = T_plan_kf * point.cast<double>();
      const Eigen::Vector3d cell = (p / voxel_m).array().floor();
      const Voxel voxel{static_cast<int64_t>(cell.x()), static_cast<int64_t>(cell.y()), static_cast<int64_t>(cell.z())};
      if (taken.insert(voxel).second) cloud.push_back(p);
    }
  }
  return cloud;
}

size_t CountDeviatedWalls(const AGraph& plan, const runtime::DeviationReport& report) {
  std::set<WallId> walls;
  for (const runtime::SurfaceDeviation& s : report.surfaces) {
    if (s.status == runtime::SurfaceStatus::kDeviated || s.status == runtime::SurfaceStatus::kMissing) {
      walls.insert(plan.surfaces[s.surface.index()].wall);
    }
  }
  return walls.size();
}

RunInfo Describe(const LocalizeFlags& flags, const CLI::App& sub, const AGraph& plan, const Results& results, const runtime::Localizer& localizer,
                 const runtime::DeviationReport& report) {
  RunInfo info;
  info.plumb_version = PLUMB_VERSION;
  info.plan_path = fs::absolute(flags.plan).lexically_normal().string();
  info.plan_source = plan.source_path;
  info.plan_source_sha256 = plan.source_sha256;
  info.recording_path = fs::absolute(flags.recording).lexically_normal().string();
  info.options = OptionValues(sub);
  info.scans = results.verdicts.size();
  info.unreadable_scans = results.unreadable_scans;
  info.untimed_scans = results.untimed_scans;
  info.interrupted = results.interrupted;
  for (const VerdictRow& v : results.verdicts) {
    if (v.verdict != "localized") continue;
    if (!info.time_to_localize_s) info.time_to_localize_s = v.stamp_s - results.verdicts.front().stamp_s;
    ++info.localized_scans;
  }
  if (!results.verdicts.empty()) info.duration_s = results.verdicts.back().stamp_s - results.verdicts.front().stamp_s;
  info.planar = localizer.map().planar;
  info.keyframes = localizer.map().keyframes.size();
  info.deviated_walls = CountDeviatedWalls(plan, report);
  info.range_bias_m = localizer.estimate().range_bias_m;
  double total_ms = 0;
  for (const TimingRow& t : results.timing) total_ms += t.ms;
  if (info.scans > 0) info.ms_per_scan = total_ms / static_cast<double>(info.scans);
  if (info.localized_scans == 0) {
    info.last_reason = localizer.map().keyframes.empty() ? "too little was seen to begin a map" : localizer.last_match().reason;
  }
  return info;
}

Expected<void> WriteRun(const LocalizeFlags& flags, const AGraph& plan, const Results& results, const runtime::Localizer& localizer,
                        const runtime::DeviationReport& report, const RunInfo& info) {
  const std::pair<const char*, std::string> files[] = {
      {"trajectory.tum", runtime::WriteTum(results.online)},
      {"trajectory_smoothed.tum", runtime::WriteTum(localizer.SmoothedTrajectory())},
      {"verdicts.csv", VerdictsToCsv(results.verdicts)},
      {"timing.csv", TimingToCsv(results.timing)},
      {"map.ply", PointsToPly(AsBuiltCloud(localizer, flags.map_voxel_m), "as built, plan frame, metres")},
      {"sgraph.json", runtime::SGraphToJson(localizer.map(), localizer.T_plan_map())},
      {"deviations.json", runtime::DeviationsToJson(plan, report)},
      {"run.json", RunInfoToJson(info)},
  };
  for (const auto& [name, text] : files) {
    if (auto written = WriteFileAtomically((fs::path(flags.output) / name).string(), std::string_view(text)); !written) return written;
  }
  return {};
}

// Before hours of work: can the results be written?
Expected<void> PrepareOutput(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return tl::unexpected(Error{ErrorCode::kFileUnwritable, fmt::format("cannot make `{}`: {}", folder, error.message())});
  const std::string probe = (fs::path(folder) / ".writable").string();
  if (auto written = WriteFileAtomically(probe, std::string_view()); !written) return written;
  fs::remove(probe, error);
  return {};
}

Status RunLocalize(LocalizeFlags flags, const CLI::App& sub, Session& session) {
  flags.options.deviations.min_yaw_rad = flags.tolerance_deg * std::numbers::pi / 180;
  if (const std::string wrong = flags.options.Check(); !wrong.empty()) return session.Fail({ErrorCode::kBadOption, wrong});
  if (!(flags.map_voxel_m > 0)) return session.Fail({ErrorCode::kBadOption, fmt::format("--map-voxel {}; must be positive", flags.map_voxel_m)});
  const auto plan = ReadAGraphFile(flags.plan);
  if (!plan) return session.Fail(plan.error());
  const auto recording = runtime::Recording::Open(flags.recording);
  if (!recording) return session.Fail(recording.error());
  if (const auto ready = PrepareOutput(flags.output); !ready) return session.Fail(ready.error());

  runtime::Localizer localizer(*plan, flags.options);
  const auto results = AddScans(*recording, flags, localizer, session.console);
  if (!results) return session.Fail(results.error());
  localizer.Finish();
  const runtime::DeviationReport report = localizer.Deviations();
  const RunInfo info = Describe(flags, sub, *plan, *results, localizer, report);
  if (const auto written = WriteRun(flags, *plan, *results, localizer, report, info); !written) return session.Fail(written.error());
  if (info.interrupted) session.console.Error(fmt::format("interrupted after {} of {} scans; {} has what was known by then", info.scans, recording->size(), flags.output));
  if (!info.time_to_localize_s) {
    session.console.Info(fmt::format("{}: not localized in {} scans: {}", flags.output, info.scans, info.last_reason));
    session.console.Info("drive through more rooms; if that does not help: another plan or storey? `plumb validate` looks at the plan, `plumb doctor` at the recording");
    return Status::kFindings;
  }
  session.console.Info(fmt::format("{}: localized after {:.1f} s, {} of {} scans; {} walls deviate; {:.0f} ms per scan", flags.output,
                                   *info.time_to_localize_s, info.localized_scans, info.scans, info.deviated_walls, info.ms_per_scan));
  if (!localizer.T_plan_map()) {
    session.console.Error(fmt::format("{}: lost at the end of the recording: what was seen since then has no place in the plan", flags.output));
    return Status::kFindings;
  }
  return results->unreadable_scans == 0 && !results->interrupted ? Status::kFine : Status::kFindings;
}

}  // namespace

void AddLocalize(CLI::App& app, Session& session) {
  auto flags = std::make_shared<LocalizeFlags>();
  runtime::LocalizerOptions& o = flags->options;
  CLI::App* sub = AddSubcommand(app, session, kLocalizeName, kLocalizeSummary,
                                "  plumb localize house.agraph rec/ -o run/\n"
                                "  plumb localize house.agraph rec/ -o run/ --no-odometry --tolerance 0.03");
  sub->add_option("FILE.agraph", flags->plan, "the plan")->required();
  sub->add_option("REC", flags->recording, "recording folder: scans/*.pcd and, where there is one, odometry.tum")->required();
  sub->add_option("-o,--output", flags->output, "the run folder to write")->required()->type_name("RUN");
  sub->add_flag("--no-odometry", flags->no_odometry, "do without the recording's odometry.tum");
  sub->add_option("--start", flags->start_s, "leave out this much of the recording at its beginning, s");
  sub->add_option("--max-duration", flags->max_duration_s, "stop after this much of the rest; 0: all of it, s");
  sub->add_option("--tolerance", o.deviations.min_offset_m, "walls displaced by less are as planned, m");
  sub->add_option("--tolerance-angle", flags->tolerance_deg, "walls turned by less are as planned, deg");
  sub->add_option("--false-discovery-rate", o.deviations.false_discovery_rate, "share of wrong ones among the walls reported");
  sub->add_option("--accept-probability", o.matcher.accept_probability, "a place in the plan is accepted from this posterior probability on");
  sub->add_option("--map-voxel", flags->map_voxel_m, "map.ply keeps one point of each cube with this edge, m");
  sub->callback([flags, sub, &session] { session.status = RunLocalize(*flags, *sub, session); });
}

}  // namespace plumb::tools
