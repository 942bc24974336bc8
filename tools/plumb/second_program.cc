#include "tools/plumb/second_program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "tools/plumb/command.h"

namespace plumb::tools {
namespace {

struct Entry {
  const char* name;
  const char* summary;
};
constexpr std::array kEntries = {Entry{kSimulateName, kSimulateSummary}, Entry{kLocalizeName, kLocalizeSummary}};

}  // namespace

void AddSecondProgram(CLI::App& app) {
  for (const Entry& entry : kEntries) app.add_subcommand(entry.name, entry.summary);
}

bool IsInSecondProgram(std::string_view subcommand) {
  return std::any_of(kEntries.begin(), kEntries.end(), [&](const Entry& entry) { return subcommand == entry.name; });
}

std::string RunSecondProgram(char** argv) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return fmt::format("cannot tell where this program lies: {}", error.message());
  const std::string program = self.parent_path() / "plumb-runtime";
  execv(program.c_str(), argv);
  return fmt::format("cannot run `{}`, which has the subcommand `{}`: {}", program, argv[1], std::strerror(errno));
}

}  // namespace plumb::tools
