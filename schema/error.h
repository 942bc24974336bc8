// The error type of every function that can fail for reasons outside the program.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace plumb {

// Numbered in blocks per module; numbers are never reused.
enum class ErrorCode : int {
  // 100s: files
  kFileNotFound = 100,
  kFileUnreadable = 101,
  kFileUnwritable = 102,
  kFileTooLarge = 103,
  // 200s: A-Graph files
  kNotAnAGraph = 200,
  kAGraphDamaged = 201,
  kAGraphTooNew = 202,
  kAGraphInconsistent = 203,
  // 300s: options
  kBadOption = 300,
  // 400s: recordings and run folders
  kNotARecording = 400,
  kBadScan = 401,
  kBadTrajectory = 402,
  kBadRunFolder = 403,
  // 500s: simulation
  kPlanUnsuitable = 500,
  // 900s: internal
  kInternal = 900,
};

struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;  // one sentence: what was observed, where, and the rule it breaks
};

template <class T>
using Expected = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> Fail(ErrorCode code, std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(message)});
}

}  // namespace plumb
