#include "tools/evaluate/evaluate.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "schema/files.h"
#include "tools/plumb/command.h"
#include "tools/plumb/flag_names.h"
#include "tools/plumb/inputs.h"
#include "tools/plumb/outputs.h"
#include "tools/run/run_info.h"

namespace plumb::tools {
namespace {

struct EvaluateFlags {
  std::string run, truth, json;
  double wrong_fix_deg = 20;
  EvaluateOptions options;
  // What has to hold; none: nothing is asked.
  std::optional<double> within_s, ate_m, deviation_m, rotation_deg;
};

std::vector<std::string> UnmetRequirements(const Evaluation& e, const EvaluateFlags& flags) {
  std::vector<std::string> unmet;
  if (flags.within_s && (!e.time_to_localize_s || *e.time_to_localize_s > *flags.within_s || e.wrong_fixes > 0)) {
    unmet.push_back(fmt::format("not rightly localized within {} s", *flags.within_s));
  }
  if (flags.ate_m && (e.online.count == 0 || e.online.rmse_m >= *flags.ate_m))
    unmet.push_back(fmt::format("ATE is not below {} m", *flags.ate_m));
  if (flags.deviation_m) {
    if (e.CountWalls(WallOutcome::kMissed) > 0) unmet.emplace_back("a deviated wall was missed");
    if (e.CountWalls(WallOutcome::kUnobserved) > 0) unmet.emplace_back("a deviated wall was not observed");
    if (e.CountWalls(WallOutcome::kFalse) > 0) unmet.emplace_back("a wall was reported that stands as planned");
    if (e.max_translation_error_m() >= *flags.deviation_m)
      unmet.push_back(fmt::format("a deviation is off by {} m or more", *flags.deviation_m));
  }
  if (flags.rotation_deg && e.max_rotation_error_deg() >= *flags.rotation_deg) {
    unmet.push_back(fmt::format("the turn of a deviated wall is off by {} deg or more", *flags.rotation_deg));
  }
  return unmet;
}

Status RunEvaluate(EvaluateFlags flags, Session& session) {
  flags.options.wrong_fix_rad = flags.wrong_fix_deg * std::numbers::pi / 180;
  if (const std::string wrong = flags.options.Check(); !wrong.empty()) return session.Fail({ErrorCode::kBadOption, InFlags(wrong)});
  const auto fit = CheckInputs({{flags.run, InputKind::kRun}, {flags.truth, InputKind::kRecording}});
  if (!fit) return session.Fail(fit.error());
  if (const auto apart = CheckOutputs({{"--json", flags.json}}, {flags.run, flags.truth}); !apart) return session.Fail(apart.error());
  const auto run = ReadRun(flags.run);
  if (!run) return session.Fail(run.error());
  const auto truth = ReadTruth(flags.truth);
  if (!truth) return session.Fail(truth.error());
  const auto info = ReadRunInfo(flags.run);
  if (!info) return session.Fail(info.error());
  if (!truth->plan_source_sha256.empty() && !info->plan_source_sha256.empty() && truth->plan_source_sha256 != info->plan_source_sha256) {
    return session.Fail({ErrorCode::kBadRunFolder,
                         fmt::format("`{}` was made with another plan than `{}`: walls cannot be compared", flags.run, flags.truth)});
  }
  if (std::error_code error; !std::filesystem::equivalent(info->recording_path, flags.truth, error)) {
    session.console.Info(fmt::format("note: {} was made from {}, the truth is that of {}", flags.run, info->recording_path, flags.truth));
  }
  flags.options.in_plane = info->planar;
  const Evaluation evaluation = Evaluate(*run, *truth, flags.options);
  session.console.Print(EvaluationToText(evaluation));
  if (!flags.json.empty()) {
    const auto written = WriteFileAtomically(flags.json, std::string_view(EvaluationToJson(evaluation)));
    if (!written) return session.Fail(written.error());
  }
  const std::vector<std::string> unmet = UnmetRequirements(evaluation, flags);
  for (const std::string& requirement : unmet) session.console.Print("unmet: " + requirement + "\n");
  return unmet.empty() ? Status::kFine : Status::kFindings;
}

}  // namespace

void AddEvaluate(CLI::App& app, Session& session) {
  auto flags = std::make_shared<EvaluateFlags>();
  CLI::App* sub = AddSubcommand(app, session, "evaluate", "Compare a run with the truth of its recording",
                                "  plumb evaluate run/ --truth rec/\n"
                                "  plumb evaluate run/ --truth rec/ --json result.json --require-localized-within 20 --require-ate 0.06");
  sub->add_option("RUN", flags->run, "folder written by `plumb localize`")->required()->type_name("");
  sub->add_option("--truth", flags->truth, "recording folder with truth.tum and truth.json")->required()->type_name("REC");
  sub->add_option("--json", flags->json, "write the figures as JSON too")->type_name("FILE");
  sub->add_option("--wrong-fix-distance", flags->options.wrong_fix_m, "a pose further off while localized is a wrong fix, m");
  sub->add_option("--wrong-fix-angle", flags->wrong_fix_deg, "so is one turned by more than this, deg");
  sub->add_option("--min-points", flags->options.min_points, "a wall with fewer returns on each side was not observed");
  sub->add_option("--min-seen", flags->options.min_seen_m2, "nor was one of which they came from less of each side, m2");
  sub->add_option("--require-localized-within", flags->within_s, "finding unless localized after this long, and never wrongly, s");
  sub->add_option("--require-ate", flags->ate_m, "finding unless the ATE is below this, m");
  sub->add_option("--require-deviations", flags->deviation_m,
                  "finding unless all deviated walls are found to within this, and no others, m");
  sub->add_option("--require-rotation", flags->rotation_deg,
                  "finding unless the turns of all deviated walls are found to within this, deg");
  sub->callback([flags, &session] { session.status = RunEvaluate(*flags, session); });
}

}  // namespace plumb::tools
