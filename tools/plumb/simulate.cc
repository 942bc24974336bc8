#include "tools/simulate/simulate.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "schema/agraph_reader.h"
#include "schema/files.h"
#include "schema/counted.h"
#include "tools/inspect/storeys.h"
#include "tools/plumb/command.h"
#include "tools/plumb/flag_names.h"
#include "tools/plumb/inputs.h"
#include "tools/plumb/outputs.h"
#include "tools/plumb/usage_errors.h"
#include "tools/simulate/sensor.h"

namespace plumb::tools {
namespace {

constexpr std::string_view kAnyStorey = "-1";  // the one with most rooms

struct SimulateFlags {
  std::string plan, output;
  std::string deviate = "3", doorways = "0", doorway_m = "0.03:0.3";
  std::string storey;  // empty: the one with most rooms
  std::string translation = "0.05:0.35", rotation_deg = "0:5";
  bool force = false, duration_given = false;
  SimulateOptions options;
};

// "0.05:0.35" or "0.2", which stands for "0.2:0.2".
std::optional<std::pair<double, double>> ParseRange(const std::string& text) {
  double lo = 0, hi = 0;
  const size_t colon = text.find(':');
  if (!CLI::detail::lexical_cast(text.substr(0, colon), lo)) return std::nullopt;
  if (colon == std::string::npos) return std::pair(lo, lo);
  if (!CLI::detail::lexical_cast(text.substr(colon + 1), hi)) return std::nullopt;
  return std::pair(lo, hi);
}

// "3", or "25%" of those that may be.
Expected<void> ParseCount(const char* flag, const std::string& text, int& count, double& ratio) {
  const bool share = !text.empty() && text.back() == '%';
  count = 0;
  if (share ? CLI::detail::lexical_cast(text.substr(0, text.size() - 1), ratio) && ratio >= 0 && ratio <= 100
            : CLI::detail::lexical_cast(text, count)) {
    ratio = share ? ratio / 100 : 0;
    return {};
  }
  return Fail(ErrorCode::kBadOption, fmt::format("{} {}; must be a number, or a share from 0% to 100%", flag, text));
}

Expected<SimulateOptions> OptionsOf(const SimulateFlags& flags) {
  SimulateOptions options = flags.options;
  if (const auto parsed = ParseCount("--deviate", flags.deviate, options.deviate, options.deviate_ratio); !parsed)
    return tl::unexpected(parsed.error());
  if (const auto parsed = ParseCount("--doorways", flags.doorways, options.doorways, options.doorways_ratio); !parsed)
    return tl::unexpected(parsed.error());
  const auto translation = ParseRange(flags.translation), rotation = ParseRange(flags.rotation_deg);
  if (!translation) return Fail(ErrorCode::kBadOption, fmt::format("--translation {}; must be LEAST:MOST in metres", flags.translation));
  if (!rotation) return Fail(ErrorCode::kBadOption, fmt::format("--rotation {}; must be LEAST:MOST in degrees", flags.rotation_deg));
  const auto doorway = ParseRange(flags.doorway_m);
  if (!doorway) return Fail(ErrorCode::kBadOption, fmt::format("--doorway-shift {}; must be LEAST:MOST in metres", flags.doorway_m));
  const auto within = [](const std::pair<double, double>& range, double most) {
    return range.first >= 0 && range.second >= range.first && range.second <= most;
  };
  if (!within(*translation, 2))
    return Fail(ErrorCode::kBadOption, fmt::format("--translation {}; must be within 0:2 m, the least first", flags.translation));
  if (!within(*rotation, 30))
    return Fail(ErrorCode::kBadOption, fmt::format("--rotation {}; must be within 0:30 deg, the least first", flags.rotation_deg));
  if (!within(*doorway, 1))
    return Fail(ErrorCode::kBadOption, fmt::format("--doorway-shift {}; must be within 0:1 m, the least first", flags.doorway_m));
  std::tie(options.min_doorway_m, options.max_doorway_m) = *doorway;
  constexpr double kRadPerDeg = std::numbers::pi / 180;
  std::tie(options.min_translation_m, options.max_translation_m) = *translation;
  options.min_rotation_rad = rotation->first * kRadPerDeg;
  options.max_rotation_rad = rotation->second * kRadPerDeg;
  // Whoever asks for a short recording does not mean the usual length.
  if (!flags.duration_given) options.min_duration_s = std::min(options.min_duration_s, options.max_duration_s);
  if (const std::string wrong = options.Check(); !wrong.empty()) return Fail(ErrorCode::kBadOption, InFlags(wrong));
  return options;
}

// Scans, whatever their names, or an odometry, without the truth that simulations write: the seed is in it, or that it is incomplete.
bool HoldsARecordingOfOthers(const std::filesystem::path& folder) {
  std::error_code error;
  const auto truth = ReadFileText((folder / "truth.json").string());
  if (truth && (truth->find("\"seed\"") != std::string::npos || truth->find("\"incomplete\"") != std::string::npos)) return false;
  if (truth) return true;
  if (std::filesystem::exists(folder / "odometry.tum", error)) return true;
  for (std::filesystem::directory_iterator it(folder / "scans", error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".pcd") return true;
  }
  return false;
}

Status RunSimulate(const SimulateFlags& flags, Session& session) {
  auto options = OptionsOf(flags);
  if (!options) return session.Fail(options.error());
  if (!flags.force && HoldsARecordingOfOthers(flags.output)) {
    return session.Fail(
        {ErrorCode::kBadOption,
         fmt::format("`{}` holds a recording that no simulation wrote; --force replaces it", flags.output)});
  }
  if (const auto fits = CheckInputs({{flags.plan, InputKind::kAGraph}}); !fits) return session.Fail(fits.error());
  const auto plan = ReadAGraphFile(flags.plan);
  if (!plan) return session.Fail(plan.error());
  if (!flags.storey.empty() && flags.storey != kAnyStorey) {
    const auto storey = FindStorey(*plan, flags.storey);
    if (!storey) return session.Fail(storey.error());
    options->storey = static_cast<int>(storey->index());
  }
  const auto output = OutputFolder::Make((std::filesystem::path(flags.output) / "scans").string());
  if (!output) return session.Fail(output.error());
  const auto done = Simulate(*plan, *options, flags.output, [&](size_t i, size_t n) { session.console.Progress("simulating", i, n); });
  if (!done) return session.Fail(done.error());
  session.console.Info(fmt::format(
      "{}: {} in {:.1f} s over {:.1f} m, {} of {} visited; {} off the plan, {} missing, {} unplanned, {} elsewhere or of another width",
      flags.output, Counted(done->scans, "scan"), done->duration_s, done->path_m, done->visited.size(),
      Counted(done->visited.size() + done->not_visited.size(), "room"), Counted(done->walls.size(), "wall"), done->missing.size(),
      done->unplanned.size(), Counted(done->doorways_changed, "doorway")));
  return Status::kFine;
}

}  // namespace

void AddSimulate(CLI::App& app, Session& session) {
  auto flags = std::make_shared<SimulateFlags>();
  SimulateOptions& o = flags->options;
  CLI::App* sub =
      AddSubcommand(app, session, kSimulateName, kSimulateSummary,
                    "  plumb simulate house.agraph --seed 1 --deviate 3 --translation 0.05:0.35 --rotation 0:5 --sensor vlp16 -o rec/\n"
                    "  plumb simulate house.agraph --deviate 0 --duration 60 --max-duration 60 -o short/");
  std::string sensors;
  for (const std::string& name : SensorNames()) sensors += (sensors.empty() ? "" : ", ") + name;
  sub->add_option("FILE.agraph", flags->plan, "the plan")->required()->type_name("");
  sub->add_option("-o,--output", flags->output, "the recording folder to write")->required()->check(NotEmpty)->type_name("REC");
  sub->add_option("--seed", o.seed, "of all random numbers; same seed, same recording");
  sub->add_option("--deviate", flags->deviate,
                  "walls that are built off the plan: their number, or a share of those that may be (25%), as far as they can")
      ->type_name("N|N%");
  sub->add_option("--missing", o.missing, "number of planned walls that are not built");
  sub->add_option("--unplanned", o.unplanned, "number of walls that are built and not in the plan");
  sub->add_option("--doorways", flags->doorways,
                  "doorways that are elsewhere in their wall, narrower or wider: their number, or a share of those that may be (25%)")
      ->type_name("N|N%");
  sub->add_option("--doorway-shift", flags->doorway_m, "least and largest shift of such a doorway, and change of its width, m")
      ->type_name("LEAST:MOST");
  sub->add_option("--translation", flags->translation, "least and largest displacement of such a wall, m")->type_name("LEAST:MOST");
  sub->add_option("--rotation", flags->rotation_deg, "least and largest turn of such a wall, deg")->type_name("LEAST:MOST");
  sub->add_option("--sensor", o.sensor, "one of " + sensors);
  sub->add_option("--noise", o.noise_m, "sigma of a measured range, m; 0: the sensor's own");
  sub->add_option("--storey", flags->storey, "storey to drive on, by name or counted from 0; else the one with most rooms")
      ->type_name("NAME");
  sub->add_option("--speed", o.speed_m_s, "of the robot, m/s");
  sub->add_option("--sensor-height", o.sensor_height_m, "above the floor, m");
  sub->add_option("--duration", o.min_duration_s, "drive at least this long, s");
  sub->add_option("--max-duration", o.max_duration_s, "stop after this long wherever the robot is, s");
  sub->add_option("--glass-transmission", o.glass_transmission, "chance that a ray passes a pane");
  sub->add_option("--clutter", o.clutter, "boxes that stand about and are not in the plan");
  sub->add_flag("--force", flags->force, "replace a recording that no simulation wrote");
  sub->callback([flags, sub, &session] {
    flags->duration_given = sub->count("--duration") > 0;
    session.status = RunSimulate(*flags, session);
  });
}

}  // namespace plumb::tools
