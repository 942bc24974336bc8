// What wheels would say about a drive: planar, in a start frame of its own, drifting.
#pragma once

#include "runtime/sources/recording.h"
#include "tools/simulate/drive.h"
#include "tools/simulate/simulate.h"

namespace plumb::tools {

// Poses of the sensor at options.odometry_rate_hz from before the first firing to after the last; stamps from options.start_stamp_s.
[[nodiscard]] runtime::Trajectory SimulateOdometry(const Drive& drive, const SimulateOptions& options);

}  // namespace plumb::tools
