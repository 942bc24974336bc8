#include "tools/plumb/usage_errors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "tools/names/names.h"
#include "tools/plumb/config.h"

namespace plumb::tools {
namespace {

bool IsFlag(const std::string& argument) { return argument.size() > 1 && argument[0] == '-'; }

std::string WithoutSubcommand(const CLI::App& app, const std::vector<std::string>& arguments) {
  const std::vector<std::string> names = SubcommandNames(app);
  const auto word = std::find_if_not(arguments.begin(), arguments.end(), IsFlag);
  if (word == arguments.end()) return fmt::format("a subcommand is required: {}", fmt::join(names, ", "));
  const std::string near = NearestName(*word, names);
  return fmt::format("there is no subcommand `{}`; {}", *word,
                     near.empty() ? fmt::format("there are {}", fmt::join(names, ", ")) : fmt::format("did you mean `{}`?", near));
}

// The first argument that the subcommand does not take; of flags and values that follow them the flag.
std::string Unexpected(const CLI::App& app, const CLI::App& subcommand, const std::vector<std::string>& arguments) {
  const std::vector<std::string> rest = app.remaining(true);
  const auto is_left = [&rest](const std::string& argument) { return std::find(rest.begin(), rest.end(), argument) != rest.end(); };
  const auto command = std::find(arguments.begin(), arguments.end(), subcommand.get_name());
  if (const auto early = std::find_if(arguments.begin(), command, is_left); early != command)
    return fmt::format("`{}` stands before `{}`; flags stand behind it", *early, subcommand.get_name());
  const auto flag = std::find_if(command, arguments.end(), [&](const std::string& a) { return IsFlag(a) && is_left(a); });
  if (flag != arguments.end()) {
    const std::string name = flag->substr(0, flag->find('='));
    const std::string near = name.starts_with("--") ? NearestName(name.substr(2), FlagNames(subcommand)) : "";
    return fmt::format("`plumb {}` has no flag `{}`{}", subcommand.get_name(), name,
                       near.empty() ? "" : fmt::format("; did you mean `--{}`?", near));
  }
  const auto word = std::find_if(command, arguments.end(), is_left);
  return fmt::format("`{}` is one argument too many for `plumb {}`", word == arguments.end() ? rest.front() : *word, subcommand.get_name());
}

// "Could not convert: --start = x".
std::string Unconverted(std::string_view message, const CLI::App& subcommand) {
  constexpr std::string_view kHead = "Could not convert: ", kIs = " = ";
  const size_t is = message.find(kIs);
  if (!message.starts_with(kHead) || is == std::string_view::npos) return std::string(message);
  const std::string name(message.substr(kHead.size(), is - kHead.size())), value(message.substr(is + kIs.size()));
  const CLI::Option* option = subcommand.get_option_no_throw(name);
  const std::string type = option == nullptr ? "" : option->get_type_name();
  const char* kind = type.starts_with("FLOAT") ? "a number" : type.starts_with("BOOLEAN") ? "true or false" : "a whole number";
  return fmt::format("{} {}; must be {}", name, value, kind);
}

// "--svg: 1 required FILE.svg missing".
std::string WithoutValue(std::string_view message) {
  constexpr std::string_view kMiddle = ": 1 required ", kEnd = " missing";
  const size_t middle = message.find(kMiddle);
  if (middle == std::string_view::npos || !message.ends_with(kEnd)) return std::string(message);
  const size_t type = middle + kMiddle.size();
  return fmt::format("{} needs a value: {}", message.substr(0, middle), message.substr(type, message.size() - type - kEnd.size()));
}

}  // namespace

std::string UsageError(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& arguments) {
  const auto used = app.get_subcommands();
  if (used.empty()) return WithoutSubcommand(app, arguments);
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) return Unexpected(app, *used.front(), arguments);
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) return Unconverted(error.what(), *used.front());
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) return WithoutValue(error.what());
  return error.what();
}

std::string NotEmpty(const std::string& value) { return value.empty() ? "must not be empty" : ""; }

}  // namespace plumb::tools
