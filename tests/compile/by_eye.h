// Rooms and doorways as a person reads them in a picture of the plan itself, and which of them a graph has, place by place: two errors
// cannot cancel.
#pragma once

#include <Eigen/Core>
#include <ostream>
#include <string>
#include <vector>

#include "schema/agraph.h"

namespace plumb::test {

struct ByEye {
  const char* path = "";
  double unit_m = 1;                             // of the places
  std::vector<Eigen::Vector2d> rooms, doorways;  // a place in each room; the middle of each doorway
  // What is known to differ, and why.
  size_t rooms_missed = 0, rooms_added = 0, doorways_missed = 0, doorways_added = 0;
  const char* why = "";
};
inline void PrintTo(const ByEye& b, std::ostream* out) { *out << b.path; }

struct Compared {
  size_t rooms_missed = 0, rooms_added = 0, doorways_missed = 0, doorways_added = 0;
  std::string text;  // the places of all of these
};

// A room holds one place at most, a doorway lies within `reach_m` of its own.
[[nodiscard]] Compared Compare(const ByEye& expected, const AGraph& graph, double reach_m = 0.3);

}  // namespace plumb::test
