#include "tools/report/report.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "schema/agraph_reader.h"
#include "schema/files.h"
#include "tools/plumb/command.h"
#include "tools/plumb/inputs.h"
#include "tools/plumb/outputs.h"
#include "tools/plumb/usage_errors.h"

namespace plumb::tools {
namespace {

struct ReportFlags {
  std::string run, plan, output;
};

Status RunReport(const ReportFlags& flags, Session& session) {
  if (const auto fits = CheckInputs({{flags.run, InputKind::kRun}}); !fits) return session.Fail(fits.error());
  if (const auto apart = CheckOutputs({{"--output", flags.output}}, {flags.run}); !apart) return session.Fail(apart.error());
  const auto info = ReadRunInfo(flags.run);
  if (!info) return session.Fail(info.error());
  const auto run = ReadRun(flags.run);
  if (!run) return session.Fail(run.error());
  const std::string plan_path = flags.plan.empty() ? info->plan_path : flags.plan;
  const auto apart = CheckOutputs({{"--output", flags.output}}, {plan_path, info->recording_path});
  if (!apart) return session.Fail(apart.error());
  const auto plan = ReadAGraphFile(plan_path);
  if (!plan && flags.plan.empty() && plan.error().code == ErrorCode::kFileNotFound) {
    return session.Fail({plan.error().code, fmt::format("`{}`, which run.json names as the run's plan, is not there any more: --plan "
                                                        "FILE.agraph says where it is",
                                                        plan_path)});
  }
  if (!plan) return session.Fail(plan.error());
  if (!info->plan_source_sha256.empty() && plan->source_sha256 != info->plan_source_sha256) {
    return session.Fail({ErrorCode::kBadRunFolder, fmt::format("`{}` was made with another plan than `{}`", flags.run, plan_path)});
  }
  const auto html = RunToHtml(*plan, *run, *info);
  if (!html) return session.Fail(html.error());
  if (const auto written = WriteFileAtomically(flags.output, std::string_view(*html)); !written) return session.Fail(written.error());
  session.console.Info(fmt::format("{}: open it in a browser", flags.output));
  return Status::kFine;
}

}  // namespace

void AddReport(CLI::App& app, Session& session) {
  auto flags = std::make_shared<ReportFlags>();
  CLI::App* sub = AddSubcommand(app, session, "report", "Draw a run: one HTML page with the plan, the deviations and the trajectory",
                                "  plumb report run/ -o run/report.html");
  sub->add_option("RUN", flags->run, "folder written by `plumb localize`")->required()->type_name("");
  sub->add_option("-o,--output", flags->output, "the page to write")->required()->check(NotEmpty)->type_name("FILE.html");
  sub->add_option("--plan", flags->plan, "the plan, where it is no longer where run.json says")->type_name("FILE.agraph");
  sub->callback([flags, &session] { session.status = RunReport(*flags, session); });
}

}  // namespace plumb::tools
