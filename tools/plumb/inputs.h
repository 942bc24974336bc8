// What users gave, where something else was meant.
#pragma once

#include <string>
#include <vector>

#include "schema/error.h"

namespace plumb::tools {

enum class InputKind {
  kMissing,  // there is nothing
  kOther,    // some file
  kFolder,   // some folder
  kPlan,     // a file that `plumb compile` may take, by its name or its first bytes
  kAGraph,
  kRecording,  // a folder with scans/
  kScans,      // that folder, or another one with .pcd files in it
  kRun,        // a folder that `plumb localize` wrote
};

// By a look at names and first bytes; whether it is whole shows when it is read.
[[nodiscard]] InputKind KindOf(const std::string& path);

struct Input {
  std::string path;
  InputKind wanted;  // kPlan, kAGraph, kRecording or kRun
};

// Errors: kFileNotFound; kBadOption, for what is clearly something else: says what it is, and the command or the folder that was meant,
// also where two inputs were given in each other's place. What may be the thing wanted passes.
[[nodiscard]] Expected<void> CheckInputs(const std::vector<Input>& inputs);

}  // namespace plumb::tools
