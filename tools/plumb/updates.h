// What `plumb localize` writes while it runs: a line for every update of the estimate, and deviations.json when asked for by a signal.
#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "runtime/localizer/estimate_update.h"
#include "schema/agraph.h"
#include "schema/error.h"

namespace plumb::tools {

class UpdateWriter {
 public:
  // `stream_path`: of the lines, may be empty. `plan` must outlive it.
  UpdateWriter(const AGraph& plan, std::string stream_path, std::string deviations_path);

  [[nodiscard]] Expected<void> Open();
  // On one thread at a time.
  void Write(const runtime::EstimateUpdate& update);
  // Once no more updates come: the first write that failed, after which nothing was written.
  [[nodiscard]] Expected<void> Close();

 private:
  const AGraph& plan_;
  std::string stream_path_, deviations_path_;
  std::ofstream stream_;
  runtime::ToldDeviations told_;
  std::optional<Error> failure_;
};

}  // namespace plumb::tools
