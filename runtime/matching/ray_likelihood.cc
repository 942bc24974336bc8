#include "runtime/matching/ray_likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

namespace plumb::runtime {
namespace {

constexpr double kRandom = 0.08;
constexpr double kFurnished = 0.24;      // of the other rays end on something in front of the building, at least, ...
constexpr double kMostFurnished = 0.6;   // ... and at most: a pose that explains fewer rays than that explains nothing
constexpr double kAsPlanned = 0.75;      // of the hits; the others are on walls that deviate
constexpr double kThrough = 0.018;       // likelihood ratio of passing through a solid wall: -4 nats
constexpr double kThroughDepth_m = 0.6;  // beyond any deviation
constexpr double kOpeningMargin_m = 0.3;
constexpr double kMinIncidence = 0.25;
constexpr double kNormalsAgree = 2.5, kNormalsDiffer = 0.1;
constexpr double kSameNormal = 0.94;  // cosine of 20 degrees
// What a wrong plan still gains per judged ray at the pose that suits it best. It is the price of "in the plan".
constexpr double kForeignGain = 0.5;
constexpr uint32_t kNoTriangle = 0xffffffffu;  // as RayHit

double Gaussian(double x, double sigma) {
  const double t = x / sigma;
  return std::exp(-0.5 * t * t) / (sigma * std::sqrt(2 * std::numbers::pi));
}

// The likelihood ratio of one ray, up to the share of rays that end on something in front of the building.
struct RayJudgement {
  double hit = 0, short_of = 0;           // its densities over the background's as a hit and as something in front; ...
  double other = 0;                       // ... of neither
  bool judged = false, only_for = false;  // only_for: speaks for the pose or not at all
  bool explained = false, through = false, in_front = false;
  uint32_t triangle = kNoTriangle;  // of the plan, on which it should have ended

  [[nodiscard]] double LogRatio(double furnished) const {
    const double ratio = (1 - kRandom) * ((1 - furnished) * hit + furnished * short_of) + other;
    return only_for ? std::max(0.0, std::log(ratio)) : judged ? std::log(ratio) : 0;
  }
};

class Judge {
 public:
  Judge(const PlanIndex& plan, const MapView& map, const PlanarPose& pose, const MatcherOptions& options)
      : plan_(plan), map_(map), pose_(pose), R_(pose.rotation()), model_{options.range_sigma_m, options.deviation_sigma_m} {}

  [[nodiscard]] RayJudgement operator()(const MapRay& ray) const {
    Eigen::Vector3d origin, direction;
    origin << R_ * ray.origin.head<2>() + pose_.t_m, ray.origin.z() + pose_.z_m;
    direction << R_ * ray.direction.head<2>(), ray.direction.z();
    const PlanHit hit = plan_.Cast({origin.cast<float>(), direction.cast<float>()});
    if (!hit.first.hit()) return {};
    RayJudgement result;
    result.triangle = (hit.solid.hit() ? hit.solid : hit.first).triangle;
    const double background = map_.background.Density(ray.range_m);
    result.hit = HitDensity(ray, direction, hit.first) / background;
    double furthest_m = hit.first.range_m;
    if (hit.soft) {
      result.hit *= 0.5;
      if (!hit.solid.hit()) {
        // Beyond the soft thing is the open: no evidence against, only for.
        result.other = 0.5;
        result.only_for = true;
        return result;
      }
      result.hit += 0.5 * HitDensity(ray, direction, hit.solid) / background;
      furthest_m = hit.solid.range_m;
    }
    const double incidence = std::max(std::abs(hit.solid.normal.cast<double>().dot(direction)), kMinIncidence);
    const double beyond_m = (ray.range_m - furthest_m) * incidence;
    result.explained = (1 - kRandom) * (1 - kFurnished) * result.hit > 1;
    if (ray.range_m < furthest_m) {
      result.short_of = 1 / map_.background.Below(furthest_m);
      result.other = kRandom;
      result.in_front = !result.explained;
    } else if (beyond_m > 3 * model_.deviation_sigma_m && !result.explained) {
      if (plan_.NearOpening(origin + furthest_m * direction, kOpeningMargin_m)) return {.triangle = result.triangle};
      result.other = kThrough;
      result.through = beyond_m > kThroughDepth_m && std::abs(hit.solid.normal.z()) < 0.5f;
    } else {
      result.other = kRandom;
    }
    result.judged = true;
    return result;
  }

 private:
  [[nodiscard]] double HitDensity(const MapRay& ray, const Eigen::Vector3d& direction, const RayHit& hit) const {
    int normals = 0;
    if (ray.wall >= 0) {
      const Eigen::Vector2d n = R_ * map_.walls[ray.wall].normal;
      normals = n.dot(hit.normal.cast<double>().head<2>()) > kSameNormal ? 1 : -1;
    }
    return model_.HitDensity(ray.range_m, hit.range_m, std::abs(hit.normal.cast<double>().dot(direction)), normals);
  }

  const PlanIndex& plan_;
  const MapView& map_;
  const PlanarPose& pose_;
  Eigen::Matrix2d R_;
  RayModel model_;
};

}  // namespace

double RayModel::HitDensity(double range_m, double expected_m, double incidence, int normals) const {
  if (expected_m < 0) return 0;
  const double slant = 1 / std::max(incidence, kMinIncidence);  // a wall's offset shows larger along a grazing ray
  const double planned_sigma_m = range_sigma_m * std::hypot(1.0, slant);
  const double deviated_sigma_m = std::hypot(range_sigma_m, 2 * deviation_sigma_m * slant);
  const double off_m = range_m - expected_m;
  const double density = kAsPlanned * Gaussian(off_m, planned_sigma_m) + (1 - kAsPlanned) * Gaussian(off_m, deviated_sigma_m);
  return density * (normals > 0 ? kNormalsAgree : normals < 0 ? kNormalsDiffer : 1.0);
}

namespace {

// All rays, or every so many, under one pose.
class Judgements {
 public:
  Judgements(const Judge& judge, const MapView& map, size_t stride) {
    rays_.reserve(map.rays.size() / stride + 1);
    for (size_t i = 0; i < map.rays.size(); i += stride) {
      const RayJudgement& j = rays_.emplace_back(judge(map.rays[i]));
      judged_ += j.judged;
      explained_ += j.explained;
      through_ += j.through;
      in_front_ += j.in_front;
    }
    if (rays_.empty()) return;
    // How much furniture there is nobody knows beforehand: as much as suits the pose.
    furnished_ = std::clamp(static_cast<double>(in_front_) / std::max(judged_, 1), kFurnished, kMostFurnished);
    scale_ = static_cast<double>(map.rays.size()) / static_cast<double>(rays_.size());
  }

  [[nodiscard]] const std::vector<RayJudgement>& rays() const { return rays_; }

  // Of one ray. Charged for every ray, judged or not: a pose from which nothing of the plan is seen explains nothing. But what furniture
  // stops says as little of a wrong plan as of the right one.
  [[nodiscard]] double LogLikelihood(const RayJudgement& j, const MatcherOptions& options) const {
    return scale_ * (j.LogRatio(furnished_) - (j.in_front ? 0 : kForeignGain)) / options.rays_per_independent;
  }

  [[nodiscard]] RayEvidence Evidence(const MatcherOptions& options) const {
    RayEvidence evidence;
    evidence.judged = judged_;
    for (const RayJudgement& j : rays_) evidence.log_likelihood += LogLikelihood(j, options);
    if (judged_ > 0) {
      evidence.explained_ratio = static_cast<double>(explained_) / judged_;
      evidence.in_front_ratio = static_cast<double>(in_front_) / judged_;
      evidence.through_ratio = static_cast<double>(through_) / judged_;
    }
    return evidence;
  }

 private:
  std::vector<RayJudgement> rays_;
  double furnished_ = kFurnished, scale_ = 1;
  int judged_ = 0, explained_ = 0, through_ = 0, in_front_ = 0;
};

// What moves with a triangle of the plan: the wall that it is of or that hosts it, else its element. The nothing beyond the plan is one
// too.
uint32_t OwnerOf(const AGraph& plan, uint32_t triangle) {
  if (triangle == kNoTriangle) return triangle;
  const uint32_t element = plan.mesh.triangles[triangle].element;
  const WallId wall = plan.elements[element].wall;
  return wall.valid() ? static_cast<uint32_t>(wall.index()) : static_cast<uint32_t>(plan.walls.size()) + element;
}

}  // namespace

RayEvidence JudgeRays(const PlanIndex& plan, const MapView& map, const PlanarPose& pose, const MatcherOptions& options, size_t stride) {
  return Judgements(Judge(plan, map, pose, options), map, stride).Evidence(options);
}

double LeadOver(const PlanIndex& plan, const MapView& map, const PlanarPose& pose, std::span<const PlanarPose> others,
                const MatcherOptions& options, size_t stride, bool either) {
  const Judgements here(Judge(plan, map, pose, options), map, stride);
  double least = std::numeric_limits<double>::infinity();
  for (const PlanarPose& other : others) {
    const Judgements there(Judge(plan, map, other, options), map, stride);
    std::map<uint32_t, double> by_here, by_there;  // by what the ray should have ended on
    double sum = 0;
    for (size_t i = 0; i < here.rays().size(); ++i) {
      const double lead = here.LogLikelihood(here.rays()[i], options) - there.LogLikelihood(there.rays()[i], options);
      sum += lead;
      by_here[OwnerOf(plan.plan(), here.rays()[i].triangle)] += lead;
      if (either) by_there[OwnerOf(plan.plan(), there.rays()[i].triangle)] += lead;
    }
    double most = 0;
    for (const auto* leads : {&by_here, &by_there}) {
      for (const auto& [owner, lead] : *leads) {
        if (owner != kNoTriangle) most = std::max(most, lead);
      }
    }
    least = std::min(least, sum - most);
  }
  return least;
}

}  // namespace plumb::runtime
