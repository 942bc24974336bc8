// `plumb-runtime`, beside `plumb`: the subcommands that need the solver and the ray caster. Loading these takes longer, and more memory,
// than many a plan takes to compile. People only ever call `plumb`.
#pragma once

#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace plumb::tools {

// Lists its subcommands in the help of `plumb`.
void AddSecondProgram(CLI::App& app);
[[nodiscard]] bool IsInSecondProgram(std::string_view subcommand);

// Becomes it, with the same arguments; returns only if that fails, with the reason.
[[nodiscard]] std::string RunSecondProgram(char** argv);

}  // namespace plumb::tools
