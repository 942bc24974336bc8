#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <numbers>
#include <set>

#include "runtime/localizer/replay.h"
#include "runtime/rooms/sgraph_json.h"
#include "schema/agraph_reader.h"
#include "schema/counted.h"
#include "schema/files.h"
#include "tools/plumb/as_built_cloud.h"
#include "tools/plumb/command.h"
#include "tools/plumb/config.h"
#include "tools/plumb/flag_names.h"
#include "tools/plumb/inputs.h"
#include "tools/plumb/interrupt.h"
#include "tools/plumb/outputs.h"
#include "tools/plumb/replayer.h"
#include "tools/plumb/start_flags.h"
#include "tools/plumb/updates.h"
#include "tools/plumb/usage_errors.h"
#include "tools/run/ply.h"
#include "tools/run/run_folder.h"
#include "tools/run/run_info.h"

namespace plumb::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char *kWallMatcher = "wall", *kGraphMatcher = "graph";

struct LocalizeFlags {
  std::string plan, recording, output, updates;
  bool no_odometry = false;
  double tolerance_deg = 0.5;
  std::string near_m, mount_deg;
  std::vector<std::string> rooms;
  double map_voxel_m = 0.02;
  runtime::LocalizerOptions options;
  runtime::ReplayOptions replay;
};

size_t CountWalls(const AGraph& plan, const runtime::DeviationReport& report, runtime::SurfaceStatus status) {
  std::set<WallId> walls;
  for (const runtime::SurfaceDeviation& s : report.surfaces) {
    if (s.status == status) walls.insert(plan.surfaces[s.surface.index()].wall);
  }
  return walls.size();
}

RunInfo Describe(const LocalizeFlags& flags, const CLI::App& sub, const AGraph& plan, const ReplayResults& results,
                 const runtime::Localizer& localizer, const runtime::DeviationReport& report) {
  RunInfo info;
  info.plumb_version = PLUMB_VERSION;
  info.plan_path = fs::absolute(flags.plan).lexically_normal().string();
  info.plan_source = plan.source_path;
  info.plan_source_sha256 = plan.source_sha256;
  info.mode = runtime::ModeName(flags.options.joint.mode);
  info.recording_path = fs::absolute(flags.recording).lexically_normal().string();
  info.options = OptionValues(sub);
  info.scans = results.verdicts.size();
  info.unreadable_scans = results.unreadable_scans;
  info.untimed_scans = results.untimed_scans;
  info.unordered_scans = results.unordered_scans;
  info.interrupted = results.interrupted;
  for (const VerdictRow& v : results.verdicts) {
    if (v.verdict != "localized") continue;
    if (!info.time_to_localize_s) info.time_to_localize_s = v.stamp_s - results.verdicts.front().stamp_s;
    ++info.localized_scans;
  }
  if (!results.verdicts.empty()) info.duration_s = results.verdicts.back().stamp_s - results.verdicts.front().stamp_s;
  info.matcher = flags.options.matcher_kind == runtime::MatcherKind::kGraph ? kGraphMatcher : kWallMatcher;
  info.planar = localizer.map().planar;
  info.keyframes = static_cast<size_t>(std::count_if(localizer.map().keyframes.begin(), localizer.map().keyframes.end(),
                                                     [](const runtime::Keyframe& keyframe) { return !keyframe.merged; }));
  info.deviated_walls = CountWalls(plan, report, runtime::SurfaceStatus::kDeviated);
  info.missing_walls = CountWalls(plan, report, runtime::SurfaceStatus::kMissing);
  info.unplanned_walls = report.unplanned.size();
  info.range_bias_m = localizer.estimate().range_bias_m;
  info.pace = results.pace;
  double total_ms = 0;
  for (const TimingRow& t : results.timing) total_ms += t.stage == "latency" ? 0 : t.ms;
  if (info.scans > 0) info.ms_per_scan = total_ms / static_cast<double>(info.scans);
  if (info.localized_scans == 0) {
    info.last_reason = localizer.map().keyframes.empty() ? "too little was seen to begin a map"
                       : localizer.T_plan_map()          ? "found only after the last scan, when the graph had caught up"
                       : !localizer.last_try()           ? "the recording ended before the first try"
                                                         : localizer.last_try()->result.reason;
  }
  return info;
}

Expected<void> WriteRun(const LocalizeFlags& flags, const AGraph& plan, const ReplayResults& results, const runtime::Localizer& localizer,
                        const runtime::DeviationReport& report, const RunInfo& info) {
  const runtime::UpperLayers layers = runtime::DeriveUpperLayers(localizer.map());
  const std::pair<const char*, std::string> files[] = {
      {"trajectory.tum", runtime::WriteTum(results.online)},
      {"trajectory_smoothed.tum", runtime::WriteTum(localizer.SmoothedTrajectory())},
      {"verdicts.csv", VerdictsToCsv(results.verdicts)},
      {"hypotheses.json", TriesToJson(results.tries)},
      {"timing.csv", TimingToCsv(results.timing)},
      {"map.ply", PointsToPly(AsBuiltCloud(localizer, flags.map_voxel_m),
                              fmt::format("as built, {} frame, metres", localizer.T_plan_map() ? "plan" : "map"))},
      {"sgraph.json", runtime::SGraphToJson(localizer.map(), layers, localizer.T_plan_map())},
      {"deviations.json", runtime::DeviationsToJson(plan, report)},
      {"run.json", RunInfoToJson(info)},
  };
  for (const auto& [name, text] : files) {
    if (auto written = WriteFileAtomically((fs::path(flags.output) / name).string(), std::string_view(text)); !written) return written;
  }
  return {};
}

// The options with what the flags say; an empty text, or what is wrong with them.
std::string CompleteOptions(LocalizeFlags& flags) {
  if (!(flags.tolerance_deg >= 0)) return fmt::format("--tolerance-angle {}; must be >= 0", flags.tolerance_deg);
  if (!(flags.map_voxel_m > 0)) return fmt::format("--map-voxel {}; must be positive", flags.map_voxel_m);
  if (flags.options.matcher_kind == runtime::MatcherKind::kGraph && !(flags.near_m.empty() && flags.rooms.empty())) {
    return "--near and --room go with --matcher wall; the graph matcher takes no hints";
  }
  flags.options.deviations.min_yaw_rad = flags.tolerance_deg * std::numbers::pi / 180;
  flags.replay.given_odometry = !flags.no_odometry;
  for (const std::string& wrong : {flags.options.Check(), flags.replay.Check()}) {
    if (!wrong.empty()) return InFlags(wrong);
  }
  return {};
}

// What only the recording tells of the flags.
std::string CheckAgainst(const runtime::Recording& recording, const LocalizeFlags& flags) {
  std::error_code error;
  if (fs::equivalent(flags.output, flags.recording, error))
    return fmt::format("--output {}; must be another folder than the recording's", flags.output);
  const double length_s = recording.stamp_s(recording.size() - 1) - recording.stamp_s(0);
  if (flags.replay.start_s > length_s)
    return fmt::format("--start {}; must be within the recording, which is {:.1f} s long", flags.replay.start_s, length_s);
  return {};
}

void SayNotLocalized(const LocalizeFlags& flags, const RunInfo& info, const ReplayResults& results, const runtime::Localizer& localizer,
                     Console& console) {
  console.Info(fmt::format("{}: not localized in {} scans: {}", flags.output, info.scans, info.last_reason));
  if (localizer.T_plan_map()) return;
  if (!results.tries.empty() && results.tries.back().guidance) console.Info(Advice(*results.tries.back().guidance));
  const bool hinted = !flags.near_m.empty() || !flags.rooms.empty();
  console.Info(fmt::format(
      "{0}/hypotheses.json lists where it could be, {0}/trajectory.tum is empty; drive through more rooms, or {1}. If that does not help: "
      "another plan or storey? `plumb validate` looks at the plan, `plumb doctor` at the recording",
      flags.output, hinted ? "look whether it started where --near or --room say" : "say --near or --room"));
}

void SayLocalized(const LocalizeFlags& flags, const RunInfo& info, const runtime::DeviationReport& report, Console& console) {
  console.Info(fmt::format("{}: localized after {:.1f} s, {} of {} scans; {}, {} missing, {} unplanned; {:.0f} ms per scan", flags.output,
                           *info.time_to_localize_s, info.localized_scans, info.scans, Counted(info.deviated_walls, "deviated wall"),
                           info.missing_walls, info.unplanned_walls, info.ms_per_scan));
  if (!report.unjudged.empty()) console.Info(fmt::format("{}: {}", flags.output, report.unjudged));
  if (flags.options.joint.mode == runtime::EstimationMode::kIs)
    console.Info("mode is: every wall is taken to stand as planned; deviations are not looked for");
  if (info.pace) {
    console.Info(fmt::format("{}: poses {:.0f} ms after their scan (99 %: {:.0f} ms); {} keyframes solved later, {} scans not mapped",
                             flags.output, info.pace->latency_p50_ms, info.pace->latency_p99_ms, info.pace->held_solves,
                             info.pace->unmapped_scans));
  }
}

// What came of it, and the exit status that says so.
Status Conclude(const LocalizeFlags& flags, const RunInfo& info, const ReplayResults& results, const runtime::Localizer& localizer,
                const runtime::DeviationReport& report, size_t num_scans, Console& console) {
  if (info.interrupted)
    console.Info(fmt::format("interrupted after {} of {} scans; {} has what was known by then", info.scans, num_scans, flags.output));
  if (!info.time_to_localize_s) {
    SayNotLocalized(flags, info, results, localizer, console);
    return Status::kFindings;
  }
  SayLocalized(flags, info, report, console);
  if (!localizer.T_plan_map()) {
    console.Error(fmt::format("{}: lost at the end of the recording: what was seen since then has no place in the plan", flags.output));
    return Status::kFindings;
  }
  return results.unreadable_scans == 0 && !results.interrupted ? Status::kFine : Status::kFindings;
}

Status RunLocalize(LocalizeFlags flags, const CLI::App& sub, Session& session) {
  if (const std::string wrong = CompleteOptions(flags); !wrong.empty()) return session.Fail({ErrorCode::kBadOption, wrong});
  const auto fit = CheckInputs({{flags.plan, InputKind::kAGraph}, {flags.recording, InputKind::kRecording}});
  if (!fit) return session.Fail(fit.error());
  const auto plan = ReadAGraphFile(flags.plan);
  if (!plan) return session.Fail(plan.error());
  const auto hint = ParseStartHint(flags.near_m, flags.rooms, *plan);
  if (!hint) return session.Fail(hint.error());
  flags.options.hint = *hint;
  for (const RoomId room : hint->rooms)
    session.console.Info(fmt::format("starts in `{}`, or so it is said", plan->rooms[room.index()].name));
  const auto up_in_lidar = ParseMount(flags.mount_deg);
  if (!up_in_lidar) return session.Fail(up_in_lidar.error());
  flags.options.odometry.up_in_lidar = *up_in_lidar;
  const auto recording = runtime::Recording::Open(flags.recording);
  if (!recording) return session.Fail(recording.error());
  if (const std::string wrong = CheckAgainst(*recording, flags); !wrong.empty()) return session.Fail({ErrorCode::kBadOption, wrong});
  const auto output = OutputFolder::Make(flags.output);  // before hours of work: can the results be written?
  if (!output) return session.Fail(output.error());
  const auto apart = CheckOutputs({{"--updates", flags.updates}}, {flags.plan, flags.recording});
  if (!apart) return session.Fail(apart.error());

  UpdateWriter updates(*plan, flags.updates, (fs::path(flags.output) / "deviations.json").string());
  if (const auto ready = updates.Open(); !ready) return session.Fail(ready.error());
  flags.options.on_update = [&updates](const runtime::EstimateUpdate& update) { updates.Write(update); };
  flags.options.update_every_solve = !flags.updates.empty();

  InterruptGuard interrupt;  // until all is written: a signal that comes late is no reason to lose it
  Replayer replayer(*plan, flags.options, flags.replay);
  const auto results = replayer.Run(*recording, session.console, interrupt);
  if (const auto written = updates.Close(); !written) return session.Fail(written.error());
  if (!results) return session.Fail(results.error());
  runtime::Localizer& localizer = replayer.localizer();
  localizer.Finish();
  const runtime::DeviationReport report = localizer.Deviations();
  const RunInfo info = Describe(flags, sub, *plan, *results, localizer, report);
  if (const auto written = WriteRun(flags, *plan, *results, localizer, report, info); !written) return session.Fail(written.error());
  return Conclude(flags, info, *results, localizer, report, recording->size(), session.console);
}

}  // namespace

void AddLocalize(CLI::App& app, Session& session) {
  auto flags = std::make_shared<LocalizeFlags>();
  runtime::LocalizerOptions& o = flags->options;
  CLI::App* sub = AddSubcommand(app, session, kLocalizeName, kLocalizeSummary,
                                "  plumb localize house.agraph rec/ -o run/\n"
                                "  plumb localize house.agraph rec/ -o run/ --no-odometry --tolerance 0.03\n"
                                "  plumb localize house.agraph rec/ -o run/ --rate 1");
  sub->add_option("FILE.agraph", flags->plan, "the plan")->required()->type_name("");
  sub->add_option("REC", flags->recording, "recording folder: scans/*.pcd and, where there is one, odometry.tum")
      ->required()
      ->type_name("");
  sub->add_option("-o,--output", flags->output, "the run folder to write")->required()->check(NotEmpty)->type_name("RUN");
  sub->add_option("--near", flags->near_m,
                  "the robot starts about here, plan frame; SIGMA is 2 unless given, m. A hint: what the robot sees may overrule it")
      ->type_name("X,Y[,SIGMA]");
  sub->add_option("--room", flags->rooms,
                  "the robot starts in a room of this name, some words of it, or source id; may be given again, for either. A hint")
      ->type_name("NAME")
      ->default_str("")
      ->allow_extra_args(false);
  sub->add_option("--mount", flags->mount_deg, "how the lidar sits on the robot, deg; needed where it is over 35 off upright")
      ->type_name("ROLL,PITCH");
  sub->add_flag("--no-odometry", flags->no_odometry, "do without the recording's odometry.tum");
  sub->add_option("--start", flags->replay.start_s, "leave out this much of the recording at its beginning, s");
  sub->add_option("--max-duration", flags->replay.max_duration_s, "stop after this much of the rest; 0: all of it, s");
  sub->add_option("--threads", flags->replay.threads,
                  "threads to work with; 0: all the machine has. The results are the same for any number");
  sub->add_option("--rate", flags->replay.rate,
                  "give scans at this multiple of the pace they were recorded at, as on a robot, and report latencies; 0: as fast as it "
                  "goes, reproducibly");
  sub->add_option_function<std::string>(
         "--matcher",
         [flags](const std::string& name) {
           flags->options.matcher_kind = name == kGraphMatcher ? runtime::MatcherKind::kGraph : runtime::MatcherKind::kWall;
         },
         "what finds the robot: wall, walls and rays; graph, rooms and their walls as in the paper, for comparison: needs two rooms with "
         "four walls")
      ->check(CLI::IsMember({kWallMatcher, kGraphMatcher}))
      ->default_str(kWallMatcher);
  sub->add_option("--tolerance", o.deviations.min_offset_m, "walls displaced by less are as planned, m");
  sub->add_option("--tolerance-angle", flags->tolerance_deg, "walls turned by less are as planned, deg");
  sub->add_option("--false-discovery-rate", o.deviations.false_discovery_rate, "share of wrong ones among the walls reported");
  sub->add_option("--accept-probability", o.matcher.accept_probability,
                  "a place in the plan is accepted from this posterior probability on");
  sub->add_option_function<std::string>(
         "--mode", [flags](const std::string& name) { flags->options.joint.mode = *runtime::ParseMode(name); },
         "what is estimated: dis all; is no deviations; uc all walls weighted alike; so all at once, with no consensus on the place before")
      ->check(CLI::IsMember(runtime::ModeNames()))
      ->default_str(runtime::ModeName(o.joint.mode));
  sub->add_option("--updates", flags->updates,
                  "write a line of JSON here after every solve while driving: t, verdict, T_plan_map, changed surfaces. SIGUSR1 writes "
                  "deviations.json as it is then")
      ->type_name("FILE");
  sub->add_option("--map-voxel", flags->map_voxel_m, "map.ply keeps one point of each cube with this edge, m");
  sub->callback([flags, sub, &session] { session.status = RunLocalize(*flags, *sub, session); });
}

}  // namespace plumb::tools
