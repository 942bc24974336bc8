// Regions as spans of rows, and a plan's section as cells: the corpus' own way to tell rooms apart, independent of the compiler's planar
// map.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "schema/agraph.h"

namespace plumb::corpus {

using Rings = std::vector<Ring>;

// Where the line at height y runs inside the rings (winding number != 0), ascending.
[[nodiscard]] std::vector<std::pair<double, double>> SpansAt(const Rings& rings, double y_m);
[[nodiscard]] bool Inside(const Rings& rings, const Eigen::Vector2d& p);

// Intersection over union, sampled in rows of 1 cm.
[[nodiscard]] double Iou(const Rings& a, const Rings& b);

// Solid and free cells; free ones of one number are connected.
class Raster {
 public:
  static constexpr double kCell_m = 0.025;
  static constexpr int32_t kSolid = -1, kOutside = 0;

  // `regions` are solid, each by its own winding numbers, and so is every cell next to one.
  explicit Raster(const std::vector<Rings>& regions);

  [[nodiscard]] int32_t At(const Eigen::Vector2d& p) const;  // kOutside beyond the border
  [[nodiscard]] bool SolidWithin(const Eigen::Vector2d& p, double radius_m) const;
  [[nodiscard]] int32_t component_count() const { return static_cast<int32_t>(areas_m2_.size()); }  // with the outside
  [[nodiscard]] double area_m2(int32_t component) const { return areas_m2_[static_cast<size_t>(component)]; }

 private:
  void Fill(const Rings& rings);
  void Grow();
  void NumberComponents();
  void Flood(size_t start, int32_t component);

  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  int width_ = 0, height_ = 0;
  std::vector<int32_t> cells_;
  std::vector<double> areas_m2_;
};

}  // namespace plumb::corpus
