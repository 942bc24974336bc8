// Counts which plan surface each return of the lidar came from.
#pragma once

#include <vector>

#include "tools/simulate/as_built.h"
#include "tools/simulate/sweep.h"

namespace plumb::tools {

class SurfaceCounter {
 public:
  SurfaceCounter(const AGraph& plan, const AsBuilt& built);

  // The surface that the echo came from; none if it was something else than a wall's face, or a face that bounds nothing.
  [[nodiscard]] SurfaceId SurfaceOf(const Echo& echo) const;

 private:
  const AGraph& plan_;
  const AsBuilt& built_;
  std::vector<std::vector<SurfaceId>> of_wall_;
};

}  // namespace plumb::tools
