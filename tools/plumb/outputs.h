// Where results go: not over what is read, and no empty folders for those that do not come.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "schema/error.h"

namespace plumb::tools {

struct OutputFlag {
  std::string flag, path;  // "--output", what it names; empty: not given
};

// Errors: kBadOption, if an output is one of the inputs or, of inputs that are folders, a file that recordings or runs have there, by
// whatever path; kFileUnwritable, if it is a folder or lies in none: said before
// any work is done.
[[nodiscard]] Expected<void> CheckOutputs(const std::vector<OutputFlag>& outputs, const std::vector<std::string>& inputs);

// A folder for results, made with those above it. What it made and is still empty when it goes is removed: of a run that failed nothing
// stays.
class OutputFolder {
 public:
  // Errors: kFileUnwritable, also if no file can be written in it.
  [[nodiscard]] static Expected<OutputFolder> Make(const std::string& path);

  OutputFolder(OutputFolder&& other) noexcept : made_(std::exchange(other.made_, {})) {}
  OutputFolder& operator=(OutputFolder&& other) noexcept {
    std::swap(made_, other.made_);
    return *this;
  }
  ~OutputFolder();

 private:
  OutputFolder() = default;

  std::vector<std::string> made_;  // the innermost one last
};

}  // namespace plumb::tools
