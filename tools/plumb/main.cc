// plumb: compiles building plans, localizes a robot in them and measures how the building deviates from its plan.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "tools/plumb/command.h"
#include "tools/plumb/config.h"
#include "tools/plumb/memory.h"
#include "tools/plumb/second_program.h"
#include "tools/plumb/usage_errors.h"

namespace plumb::tools {

namespace {

// Thrown by --print-config, like CLI11's own --help: a request, not an error.
struct PrintConfigRequest {
  const CLI::App* subcommand = nullptr;
};

#ifdef PLUMB_SECOND_PROGRAM
void AddSubcommands(CLI::App& app, Session& session) {
  AddSimulate(app, session);
  AddLocalize(app, session);
}
#else
// A robot builds without the compiler and its subcommands.
void AddSubcommands(CLI::App& app, Session& session) {
#ifdef PLUMB_WITH_COMPILER
  AddCompile(app, session);
  AddValidate(app, session);
#endif
  AddInspect(app, session);
  AddSecondProgram(app);
  AddEvaluate(app, session);
  AddReport(app, session);
  AddDoctor(app, session);
#ifdef PLUMB_WITH_COMPILER
  AddExplain(app, session);
#endif
}
#endif

int Parse(CLI::App& app, Session& session, std::vector<std::string> arguments) {
  if (arguments.empty()) arguments.emplace_back("--help");
  try {
    const auto expanded = ExpandConfig(app, arguments);
    if (!expanded) return static_cast<int>(session.Fail(expanded.error()));
    std::vector<std::string> reversed(expanded->rbegin(), expanded->rend());  // as CLI11 wants them
    app.parse(reversed);
    return static_cast<int>(session.status);
  } catch (const PrintConfigRequest& request) {
    session.console.Print(ConfigToToml(*request.subcommand));
    return 0;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    session.console.Error(UsageError(app, e, arguments));
    const auto used = app.get_subcommands();
    fmt::print(stderr, "Run `plumb {}--help` for the options.\n", used.empty() ? "" : used.front()->get_name() + " ");
    return static_cast<int>(Status::kBadInput);
  }
}

}  // namespace

CLI::App* AddSubcommand(CLI::App& app, Session& session, const std::string& name, const std::string& description,
                        const std::string& examples) {
  CLI::App* sub = app.add_subcommand(name, description);
  sub->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)->always_capture_default();
  sub->footer("Examples:\n" + examples + "\nExit status: 0 fine, 1 findings, 2 bad input or usage, 3 internal error.");
  sub->add_option_function<std::string>(
         "--config", [](const std::string&) {}, "TOML file with options under the names of these flags")
      ->type_name("FILE");
  sub->add_flag_callback(
      "--print-config", [sub] { throw PrintConfigRequest{sub}; }, "print the options in force as TOML, and stop");
  sub->add_flag_function(
         "-q,--quiet", [&session](int64_t count) { session.console.set_quiet(count > 0); }, "say nothing but results and errors")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);  // -q after a configuration file with quiet = false
  return sub;
}

}  // namespace plumb::tools

int main(int argc, char** argv) {
  char help[] = "--help";
  if (argc > 1 && std::strcmp(argv[1], "help") == 0) {  // `plumb help inspect` is `plumb inspect --help`
    argv[1] = argc > 2 ? argv[2] : help;
    if (argc > 2) argv[2] = help;
  }
  std::signal(SIGUSR1, SIG_IGN);  // a request for a report (interrupt.h) that comes early must not end what it asks about
#ifdef PLUMB_SECOND_PROGRAM
  plumb::tools::ReturnLargeBlocks();
#endif
  plumb::tools::Session session;
  try {
#ifndef PLUMB_SECOND_PROGRAM
    if (argc > 1 && plumb::tools::IsInSecondProgram(argv[1])) {
      session.console.Error(plumb::tools::RunSecondProgram(argv));
      return static_cast<int>(plumb::tools::Status::kInternal);
    }
#endif
    CLI::App app("Plumb tells how far a building stands from its plan, and where the robot stands in it.", "plumb");
    app.set_version_flag("--version", "plumb " PLUMB_VERSION);
    app.require_subcommand(1);
    app.footer("Run `plumb SUBCOMMAND --help` for options and examples.");
    plumb::tools::AddSubcommands(app, session);
    const int status = plumb::tools::Parse(app, session, {argv + 1, argv + argc});
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
    session.console.Error(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
    return static_cast<int>(plumb::tools::Status::kBadInput);
  } catch (const std::bad_alloc&) {
    session.console.Error("out of memory");
  } catch (const std::exception& e) {
    session.console.Error(fmt::format("internal: {}", e.what()));
  }
  return static_cast<int>(plumb::tools::Status::kInternal);
}
