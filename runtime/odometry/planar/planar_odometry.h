// Odometry of a planar laser: each scan is registered to the last few metres' scans.
//
// Prior (given odometry or constant velocity), correlative search in a window that follows from it (correlative_search.h), point-to-line
// registration (planar_registration.h). The map reaches back some metres only: a robot that comes back finds its old map off by its drift,
// and closing that loop is the mapper's affair (mapping/loop_closure.h), so that odometry's frame never jumps.
#pragma once

#include <memory>
#include <optional>

#include "runtime/odometry/odometry.h"
#include "runtime/odometry/scan_preparation.h"

namespace plumb::runtime {

class PlanarOdometry {
 public:
  // `normal`: of the scan plane in the lidar frame (ScanPlaneNormal), taken as up.
  PlanarOdometry(const OdometryOptions& options, const Eigen::Vector3d& normal);
  ~PlanarOdometry();

  // As Odometry::Register; points off the scan plane are taken into it.
  [[nodiscard]] OdometryResult Register(const PreparedScan& prepared, const std::optional<Odometry::GivenMotion>& given);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumb::runtime
