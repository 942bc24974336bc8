#include "compiler/frontends/drawing/room_outlines.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "compiler/frontends/drawing/plane.h"
#include "compiler/frontends/drawing/room_names.h"
#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {
namespace {

double AreaOf(const std::vector<Eigen::Vector2d>& ring) {
  double twice = 0;
  for (size_t i = 0; i < ring.size(); ++i) twice += Cross(ring[i] - ring[0], ring[(i + 1) % ring.size()] - ring[0]);
  return std::abs(0.5 * twice);
}

}  // namespace

void AddOutlinedRooms(Drawing& drawing, const RoomOutlineOptions& options) {
  std::vector<uint32_t> outlines;
  std::vector<double> areas;
  std::vector<Eigen::AlignedBox2d> boxes;
  for (uint32_t p = 0; p < drawing.paths.size(); ++p) {
    const DrawnPath& path = drawing.paths[p];
    if (path.role != LineRole::kAny || !path.closed) continue;
    const double area = AreaOf(path.points);
    if (area < options.min_area_m2) continue;
    outlines.push_back(p);
    areas.push_back(area);
    boxes.push_back(BoxOf(path.points));
  }
  const BoxTree<2> tree(std::move(boxes));
  std::set<uint32_t> rooms;  // in `outlines`
  std::vector<uint32_t> around;
  for (const DrawnText& text : drawing.texts) {
    if (RoomName({&text}).empty()) continue;
    uint32_t best = kNone;
    tree.ForEachIn(Eigen::AlignedBox2d(text.at), [&](uint32_t i) {
      const bool smaller = best == kNone || areas[i] < areas[best] || (areas[i] == areas[best] && i < best);
      if (smaller && Contains(drawing.paths[outlines[i]].points, text.at)) best = i;
    });
    if (best != kNone) rooms.insert(best);
  }
  std::set<uint32_t> frames;
  for (const uint32_t room : rooms) {
    const Eigen::Vector2d corner = drawing.paths[outlines[room]].points[0];
    tree.ForEachIn(Eigen::AlignedBox2d(corner), [&](uint32_t i) {
      if (i != room && areas[i] > 2 * areas[room] && Contains(drawing.paths[outlines[i]].points, corner)) frames.insert(i);
    });
  }
  for (const uint32_t frame : frames) rooms.erase(frame);
  if (rooms.size() < options.min_rooms) return;
  for (const uint32_t room : rooms) {
    const DrawnPath& path = drawing.paths[outlines[room]];
    drawing.spaces.push_back({{}, path.points, path.location});
  }
}

}  // namespace plumb::compiler
