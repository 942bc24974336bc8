#include "compiler/frontends/drawing/room_outlines.h"

#include <algorithm>
#include <map>
#include <vector>

#include "compiler/frontends/drawing/plane.h"
#include "compiler/frontends/drawing/room_names.h"
#include "compiler/geometry/box_tree.h"
#include "schema/polygon.h"

namespace plumb::compiler {
namespace {

struct Candidate {
  uint32_t path = 0;
  double area_m2 = 0;
};

class RoomOutlines {
 public:
  RoomOutlines(const Drawing& drawing, const RoomOutlineOptions& options) : drawing_(drawing), options_(options) {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (uint32_t p = 0; p < drawing.paths.size(); ++p) {
      const DrawnPath& path = drawing.paths[p];
      if (path.role != LineRole::kAny || !path.closed) continue;
      const double area = AreaOf(path.points);
      if (area < options.min_closet_m2) continue;
      outlines_.push_back({p, area});
      boxes.push_back(BoxOf(path.points));
    }
    tree_ = BoxTree<2>(std::move(boxes));
  }

  // Paths, in the order of the drawing.
  std::vector<uint32_t> Run() const {
    std::map<uint32_t, Eigen::Vector2d> rooms = Named(options_.min_area_m2, {});
    const std::vector<uint32_t> frames = FramesAmong(rooms);
    for (const uint32_t frame : frames) rooms.erase(frame);
    // A small outline within that of a room is a tag.
    for (const auto& [closet, at] : Named(options_.min_closet_m2, frames)) rooms.emplace(closet, at);
    std::vector<uint32_t> out;
    for (const auto& [room, at] : rooms) out.push_back(outlines_[room].path);
    return out;
  }

 private:
  const std::vector<Eigen::Vector2d>& Ring(uint32_t i) const { return drawing_.paths[outlines_[i].path].points; }

  // The smallest outline around each name, with the place of the name.
  std::map<uint32_t, Eigen::Vector2d> Named(double min_m2, const std::vector<uint32_t>& frames) const {
    std::map<uint32_t, Eigen::Vector2d> out;
    for (const DrawnText& text : drawing_.texts) {
      if (RoomName({&text}).empty()) continue;
      const auto [best, in_room] = Around(text.at, min_m2, frames);
      if (best != kNone && !(in_room && outlines_[best].area_m2 < options_.min_area_m2)) out.emplace(best, text.at);
    }
    return out;
  }

  // The smallest outline around a place that is no frame, and whether one of the size of a room is among all of them.
  std::pair<uint32_t, bool> Around(const Eigen::Vector2d& at, double min_m2, const std::vector<uint32_t>& frames) const {
    uint32_t best = kNone;
    bool in_room = false;
    tree_.ForEachIn(Eigen::AlignedBox2d(at), [&](uint32_t i) {
      if (outlines_[i].area_m2 < min_m2 || std::binary_search(frames.begin(), frames.end(), i) || !Contains(Ring(i), at)) return;
      in_room = in_room || outlines_[i].area_m2 >= options_.min_area_m2;
      if (best == kNone || std::pair(outlines_[i].area_m2, i) < std::pair(outlines_[best].area_m2, best)) best = i;
    });
    return {best, in_room};
  }

  // Much of what they hold are other rooms: outlines of storeys and around titles. Ascending.
  std::vector<uint32_t> FramesAmong(const std::map<uint32_t, Eigen::Vector2d>& rooms) const {
    std::map<uint32_t, double> held_m2;
    for (const auto& [room, at] : rooms) {
      tree_.ForEachIn(Eigen::AlignedBox2d(at), [&](uint32_t i) {
        if (i != room && outlines_[i].area_m2 > outlines_[room].area_m2 && Contains(Ring(i), at)) held_m2[i] += outlines_[room].area_m2;
      });
    }
    std::vector<uint32_t> out;
    for (const auto& [frame, held] : held_m2) {
      if (held > options_.max_held_share * outlines_[frame].area_m2) out.push_back(frame);
    }
    return out;
  }

  const Drawing& drawing_;
  const RoomOutlineOptions& options_;
  std::vector<Candidate> outlines_;
  BoxTree<2> tree_;
};

}  // namespace

void AddOutlinedRooms(Drawing& drawing, const RoomOutlineOptions& options) {
  const std::vector<uint32_t> rooms = RoomOutlines(drawing, options).Run();
  if (rooms.size() < options.min_rooms) return;
  for (const uint32_t room : rooms) {
    DrawnPath& path = drawing.paths[room];
    path.outlines_room = true;
    drawing.spaces.push_back({{}, path.points, path.location});
  }
}

}  // namespace plumb::compiler
