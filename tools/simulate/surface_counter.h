// Counts which plan surface each return of the lidar came from.
#pragma once

#include <vector>

#include "tools/simulate/as_built.h"
#include "tools/simulate/sweep.h"

namespace plumb::tools {

// Where a return came from: the surface, none if from something else than a wall's face or from a face that bounds nothing, and where the
// plan has the place, along the surface's line from its start and up from z = 0.
struct SurfaceHit {
  SurfaceId surface;
  double along_m = 0, up_m = 0;
};

class SurfaceCounter {
 public:
  SurfaceCounter(const AGraph& plan, const AsBuilt& built);

  [[nodiscard]] SurfaceHit HitOf(const Echo& echo) const;

 private:
  const AGraph& plan_;
  const AsBuilt& built_;
  std::vector<std::vector<SurfaceId>> of_wall_;
};

}  // namespace plumb::tools
