#include "tests/compile/by_eye.h"

#include <algorithm>
#include <optional>
#include <sstream>

#include "schema/polygon.h"

namespace plumb::test {
namespace {

using Eigen::Vector2d;

// Each place takes the first item that is free and fits; counts the places and the items that are left over.
template <class Item, class Fits, class PlaceOf>
void Match(const std::vector<Vector2d>& places, const std::vector<Item>& items, const char* kind, const Fits& fits, const PlaceOf& place_of,
           size_t& missed, size_t& added, std::ostream& out) {
  std::vector<bool> used(items.size(), false);
  for (const Vector2d& p : places) {
    size_t i = 0;
    while (i < items.size() && (used[i] || !fits(items[i], p))) ++i;
    if (i < items.size()) {
      used[i] = true;
      continue;
    }
    ++missed;
    out << kind << " missed at " << p.transpose() << '\n';
  }
  for (size_t i = 0; i < items.size(); ++i) {
    if (used[i]) continue;
    ++added;
    out << kind << " added at " << place_of(items[i]).transpose() << '\n';
  }
}

}  // namespace

Compared Compare(const ByEye& expected, const AGraph& graph, double reach_m) {
  std::vector<Vector2d> rooms = expected.rooms, doorways = expected.doorways;
  for (Vector2d& p : rooms) p *= expected.unit_m;
  for (Vector2d& p : doorways) p *= expected.unit_m;
  Compared out;
  std::ostringstream text;
  Match(
      rooms, graph.rooms, "room", [](const Room& r, const Vector2d& p) { return Contains(r.polygon, p); },
      [](const Room& r) -> Vector2d { return r.center.head<2>(); }, out.rooms_missed, out.rooms_added, text);
  Match(
      doorways, graph.doorways, "doorway",
      [&](const Doorway& d, const Vector2d& p) { return (d.position.head<2>() - p).norm() <= reach_m; },
      [](const Doorway& d) -> Vector2d { return d.position.head<2>(); }, out.doorways_missed, out.doorways_added, text);
  out.text = text.str();
  return out;
}

}  // namespace plumb::test
