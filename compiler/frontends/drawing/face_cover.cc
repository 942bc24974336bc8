#include "compiler/frontends/drawing/face_cover.h"

#include "compiler/frontends/drawing/plane.h"
#include "compiler/geometry/box_tree.h"
#include "compiler/geometry/for_each_job.h"

namespace plumb::compiler {
namespace {

constexpr size_t kMinParallel = 1 << 14;  // faces

}  // namespace

std::vector<FaceCover> CoverOfFaces(const LineMap& map, const std::vector<WallRun>& runs, const Outline& outline) {
  std::vector<Eigen::AlignedBox2d> boxes;
  for (const WallRun& run : runs) boxes.push_back(BoxOf(run.Corners()));
  const BoxTree<2> tree(std::move(boxes));
  std::vector<FaceCover> out(map.num_faces(), FaceCover::kFree);
  ForEachJob(out.size(), kMinParallel, [&](size_t f) {
    const std::optional<Eigen::Vector2d> p = f == 0 ? std::nullopt : map.PointIn(static_cast<uint32_t>(f));
    if (!p) return;
    bool in_run = false;
    tree.ForEachIn(Eigen::AlignedBox2d(*p), [&](uint32_t r) { in_run = in_run || runs[r].Holds(*p, 0); });
    out[f] = in_run ? FaceCover::kRun : outline.InWall(*p) ? FaceCover::kWall : FaceCover::kFree;
  });
  return out;
}

}  // namespace plumb::compiler
