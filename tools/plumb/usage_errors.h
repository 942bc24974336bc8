// What is wrong with a command line, in words that say how to go on.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace plumb::tools {

// `error` as parsing `arguments` threw it: names what stands where a subcommand should, flags that there are not (with the nearest one),
// flags before the subcommand, what is too much, and what a value must be.
[[nodiscard]] std::string UsageError(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& arguments);

// For CLI::Option::check: an error unless there is something in it.
[[nodiscard]] std::string NotEmpty(const std::string& value);

}  // namespace plumb::tools
