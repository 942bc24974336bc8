// What the subcommands share. Each has a file of its own and adds itself to the program.
#pragma once

#include <string>

#include "schema/error.h"
#include "tools/plumb/console.h"

namespace CLI {
class App;
}
namespace plumb::compiler {
struct CompileOptions;
}

namespace plumb::tools {

// The program's exit status.
enum class Status : int { kFine = 0, kFindings = 1, kBadInput = 2, kInternal = 3 };

// Handed to every subcommand; outlives them.
struct Session {
  Console console;
  Status status = Status::kFine;

  // Says what went wrong and turns it into an exit status.
  [[nodiscard]] Status Fail(const Error& error) {
    console.Error(error.message);
    return error.code == ErrorCode::kInternal ? Status::kInternal : Status::kBadInput;
  }
};

// A subcommand with the options that all have (--config, --print-config, --quiet) and its examples below --help.
[[nodiscard]] CLI::App* AddSubcommand(CLI::App& app, Session& session, const std::string& name, const std::string& description,
                                      const std::string& examples);

// The flags of `plumb compile` that change what a plan becomes; `plumb validate` has them too.
void AddCompileOptions(CLI::App& subcommand, compiler::CompileOptions& options);

// Of the subcommands in the second program (second_program.h), which the first lists, too.
inline constexpr const char* kSimulateName = "simulate";
inline constexpr const char* kSimulateSummary = "Build a house off its plan, drive a LiDAR through it and record";
inline constexpr const char* kLocalizeName = "localize";
inline constexpr const char* kLocalizeSummary = "Find the robot in the plan, track it, and measure how far each wall is off";

void AddCompile(CLI::App& app, Session& session);
void AddDoctor(CLI::App& app, Session& session);
void AddEvaluate(CLI::App& app, Session& session);
void AddExplain(CLI::App& app, Session& session);
void AddInspect(CLI::App& app, Session& session);
void AddLocalize(CLI::App& app, Session& session);
void AddReport(CLI::App& app, Session& session);
void AddSimulate(CLI::App& app, Session& session);
void AddValidate(CLI::App& app, Session& session);

}  // namespace plumb::tools
