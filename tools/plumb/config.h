// Configuration files: TOML with the names of the flags.
#pragma once

#include <string>
#include <vector>

#include "schema/agraph.h"
#include "schema/error.h"

namespace CLI {
class App;
}

namespace plumb::tools {

// Replaces nothing and adds: every key of the file after `--config` becomes a flag right behind the subcommand, so that flags on the
// command line, which come later, win. Keys at the top level and in the table named after the subcommand count; tables of other subcommands
// are left alone. Errors: kFileNotFound, kBadOption (TOML syntax with its line; unknown key, with the nearest name).
[[nodiscard]] Expected<std::vector<std::string>> ExpandConfig(const CLI::App& app, const std::vector<std::string>& arguments);

// All options of the subcommand with the values they have now, as a configuration file. Positional arguments are not part of it.
[[nodiscard]] std::string ConfigToToml(const CLI::App& subcommand);

// The same as name and value, a JSON literal (empty: it has none), in the order of --help.
[[nodiscard]] std::vector<Option> OptionValues(const CLI::App& subcommand);

[[nodiscard]] std::vector<std::string> SubcommandNames(const CLI::App& app);

// Long names of the subcommand's flags, without the dashes.
[[nodiscard]] std::vector<std::string> FlagNames(const CLI::App& subcommand);

}  // namespace plumb::tools
