#include "tools/plumb/config.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>

#include "schema/files.h"
#include "tools/names/names.h"

namespace plumb::tools {
namespace {

bool IsConfigurable(const CLI::Option& option) {
  if (option.get_lnames().empty()) return false;
  const std::string& name = option.get_lnames().front();
  return name != "help" && name != "config" && name != "print-config";
}

// The file named by `--config FILE` or `--config=FILE`; the last one counts.
std::optional<std::string> ConfigPath(const std::vector<std::string>& arguments) {
  constexpr std::string_view kFlag = "--config";
  std::optional<std::string> path;
  for (size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == kFlag && i + 1 < arguments.size()) path = arguments[i + 1];
    if (arguments[i].starts_with(std::string(kFlag) + "=")) path = arguments[i].substr(kFlag.size() + 1);
  }
  return path;
}

const CLI::App* FindSubcommand(const CLI::App& app, const std::string& name) {
  for (const CLI::App* subcommand : app.get_subcommands({})) {
    if (subcommand->get_name() == name) return subcommand;
  }
  return nullptr;
}

std::optional<std::string> ValueText(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_integer()) return std::to_string(number->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  return std::nullopt;
}

Error UnknownKey(const std::string& path, const std::string& key, size_t line, const CLI::App& subcommand) {
  std::string message = fmt::format("`{}:{}`: `plumb {}` has no option `{}`", path, line, subcommand.get_name(), key);
  const std::string near = NearestName(key, FlagNames(subcommand));
  if (!near.empty()) message += fmt::format("; did you mean `{}`?", near);
  return {ErrorCode::kBadOption, message};
}

// Turns the table's entries into flags; tables in it are those of subcommands.
Expected<void> AddFlags(const toml::table& table, const std::string& path, const CLI::App& subcommand, std::vector<std::string>& flags) {
  const std::vector<std::string> names = FlagNames(subcommand);
  for (const auto& [toml_key, node] : table) {
    const std::string key(toml_key.str());
    if (node.is_table()) continue;
    const size_t line = node.source().begin.line;
    if (std::find(names.begin(), names.end(), key) == names.end()) return tl::unexpected(UnknownKey(path, key, line, subcommand));
    // An array is an option that is given several times.
    const toml::array* list = node.as_array();
    for (size_t i = 0; i < (list != nullptr ? list->size() : 1); ++i) {
      const auto value = ValueText(list != nullptr ? *list->get(i) : node);
      if (!value)
        return Fail(ErrorCode::kBadOption,
                    fmt::format("`{}:{}`: `{}` is neither a number, nor text, nor true or false, nor a list of them", path, line, key));
      flags.push_back(fmt::format("--{}={}", key, *value));
    }
  }
  return {};
}

std::string UnknownTable(const std::string& path, const std::string& name, size_t line, const std::vector<std::string>& subcommands) {
  std::string message = fmt::format("`{}:{}`: there is no subcommand `{}`", path, line, name);
  const std::string near = NearestName(name, subcommands);
  return near.empty() ? message : message + fmt::format("; did you mean `{}`?", near);
}

Expected<std::vector<std::string>> FlagsOf(const toml::table& root, const std::string& path, const CLI::App& app,
                                           const CLI::App& subcommand) {
  const std::vector<std::string> subcommands = SubcommandNames(app);
  std::vector<std::string> flags;
  if (const auto added = AddFlags(root, path, subcommand, flags); !added) return tl::unexpected(added.error());
  for (const auto& [toml_key, node] : root) {
    const toml::table* table = node.as_table();
    const std::string key(toml_key.str());
    if (!table) continue;
    if (std::find(subcommands.begin(), subcommands.end(), key) == subcommands.end()) {
      return Fail(ErrorCode::kBadOption, UnknownTable(path, key, node.source().begin.line, subcommands));
    }
    if (key != subcommand.get_name()) continue;
    if (const auto added = AddFlags(*table, path, subcommand, flags); !added) return tl::unexpected(added.error());
  }
  return flags;
}

// A TOML basic string.
std::string Quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

// Of "05", ".5" and "+5" neither TOML nor JSON know anything.
std::string NumberLiteral(const std::string& text) {
  int64_t whole = 0;
  uint64_t large = 0;
  double number = 0;
  if (CLI::detail::lexical_cast(text, whole)) return std::to_string(whole);
  if (CLI::detail::lexical_cast(text, large)) return std::to_string(large);
  return CLI::detail::lexical_cast(text, number) ? fmt::format("{}", number) : text;
}

// As TOML and JSON both write it; empty where it has no value.
std::string Literal(const CLI::Option& option) {
  if (option.get_items_expected_max() > 1) {
    std::string out;
    for (const std::string& item : option.count() > 0 ? option.results() : std::vector<std::string>())
      out += (out.empty() ? "" : ", ") + Quoted(item);
    return "[" + out + "]";
  }
  const std::string value = option.count() > 0 ? option.results().back() : option.get_default_str();
  const std::string type = option.get_type_name();
  if (option.get_expected_max() == 0 || type.starts_with("BOOLEAN"))
    return value.empty() || value == "false" || value == "0" ? "false" : "true";
  if (value.empty()) return {};
  const bool is_number = type.starts_with("INT") || type.starts_with("UINT") || type.starts_with("FLOAT");
  return is_number ? NumberLiteral(value) : Quoted(value);
}

}  // namespace

Expected<std::vector<std::string>> ExpandConfig(const CLI::App& app, const std::vector<std::string>& arguments) {
  const auto path = ConfigPath(arguments);
  const auto at = std::find_if(arguments.begin(), arguments.end(), [](const std::string& a) { return !a.starts_with("-"); });
  const CLI::App* subcommand = at == arguments.end() ? nullptr : FindSubcommand(app, *at);
  if (!path || !subcommand) return arguments;
  const auto text = ReadFileText(*path);
  if (!text) return tl::unexpected(text.error());
  try {
    const toml::table root = toml::parse(*text, *path);
    auto flags = FlagsOf(root, *path, app, *subcommand);
    if (!flags) return tl::unexpected(flags.error());
    std::vector<std::string> out(arguments.begin(), std::next(at));
    out.insert(out.end(), flags->begin(), flags->end());
    out.insert(out.end(), std::next(at), arguments.end());
    return out;
  } catch (const toml::parse_error& e) {
    return Fail(ErrorCode::kBadOption, fmt::format("`{}:{}`: no TOML: {}", *path, e.source().begin.line, e.description()));
  }
}

std::string ConfigToToml(const CLI::App& subcommand) {
  std::string out = fmt::format("[{}]\n", subcommand.get_name());
  for (const CLI::Option* option : subcommand.get_options()) {
    if (!IsConfigurable(*option)) continue;
    const std::string value = Literal(*option);
    // An option without a value is shown, but not set.
    out += fmt::format("{}{} = {}\n", value.empty() ? "# " : "", option->get_lnames().front(), value.empty() ? "\"\"" : value);
  }
  return out;
}

std::vector<Option> OptionValues(const CLI::App& subcommand) {
  std::vector<Option> out;
  for (const CLI::Option* option : subcommand.get_options()) {
    if (IsConfigurable(*option)) out.push_back({option->get_lnames().front(), Literal(*option)});
  }
  return out;
}

std::vector<std::string> SubcommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* subcommand : app.get_subcommands({})) names.push_back(subcommand->get_name());
  return names;
}

std::vector<std::string> FlagNames(const CLI::App& subcommand) {
  std::vector<std::string> names;
  for (const CLI::Option* option : subcommand.get_options()) {
    if (IsConfigurable(*option)) names.push_back(option->get_lnames().front());
  }
  return names;
}

}  // namespace plumb::tools
