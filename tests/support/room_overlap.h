// Rooms as they are written to JSON, compared.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "schema/polygon.h"

namespace plumb::test {

using Ring2 = std::vector<Eigen::Vector2d>;

inline Eigen::Vector2d PointOf(const nlohmann::json& p) { return {p.at(0).get<double>(), p.at(1).get<double>()}; }

inline Ring2 RingOf(const nlohmann::json& polygon) {
  Ring2 ring;
  for (const nlohmann::json& p : polygon) ring.push_back(PointOf(p));
  return ring;
}

// Intersection over union, on a grid of 5 cm.
inline double Overlap(const Ring2& a, const Ring2& b) {
  Eigen::AlignedBox2d box;
  for (const Ring2* ring : {&a, &b}) {
    for (const Eigen::Vector2d& p : *ring) box.extend(p);
  }
  int both = 0, either = 0;
  for (double y = box.min().y() + 0.025; y < box.max().y(); y += 0.05) {
    for (double x = box.min().x() + 0.025; x < box.max().x(); x += 0.05) {
      const bool in_a = Contains(a, {x, y}), in_b = Contains(b, {x, y});
      both += in_a && in_b ? 1 : 0;
      either += in_a || in_b ? 1 : 0;
    }
  }
  return either > 0 ? static_cast<double>(both) / either : 0;
}

// Of the room among `rooms` that overlaps most.
inline double BestOverlap(const Ring2& room, const nlohmann::json& rooms) {
  double best = 0;
  for (const nlohmann::json& other : rooms) best = std::max(best, Overlap(room, RingOf(other.at("polygon"))));
  return best;
}

}  // namespace plumb::test
