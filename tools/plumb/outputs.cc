#include "tools/plumb/outputs.h"

#include <fmt/format.h>

#include <filesystem>

namespace plumb::tools {

Expected<void> CheckOutputs(const std::vector<OutputFlag>& outputs, const std::vector<std::string>& inputs) {
  for (const OutputFlag& output : outputs) {
    for (const std::string& input : inputs) {
      std::error_code error;
      if (!output.path.empty() && std::filesystem::equivalent(output.path, input, error))
        return Fail(ErrorCode::kBadOption, fmt::format("{} {}; must not be `{}` itself, which is read", output.flag, output.path, input));
    }
  }
  return {};
}

}  // namespace plumb::tools
