#include "runtime/deviations/jamb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr std::array<double, JambEvidence::kClasses> kSigmas_m = {0.007, 0.011, 0.016, 0.025};  // of a class: its largest
constexpr double kFrame_m = 0.15;    // a frame's parts lie so far behind the jamb
constexpr double kDensity_m = 0.08;  // up to so far from the jamb lines are about as dense as at it
constexpr int kRounds = 3;
constexpr double kJambShare = 0.8, kFrameShare = 0.15;
constexpr double kAbout_m = 0.25;  // lines so far from the jamb may contradict it ...
constexpr double kClear_m = 0.02;  // ... if they are so far on its wrong side
constexpr double kBorder_m = 0.01;
constexpr double kReachesShare = 0.02;  // of the lines that pass beside a jamb pass right at it: evenly spread it is a tenth
constexpr double kFaceEndShare = 0.02;  // of what is seen on a face near its end lies beyond

double Phi(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

}  // namespace

JambEvidence::JambEvidence(double outward_m, double inward_m)
    : outward_m_(outward_m), inward_m_(inward_m), bins_(static_cast<size_t>(std::ceil((outward_m + inward_m) / kBin_m)) + 1) {
  for (Histogram* h : {&faces_[0], &faces_[1], &inside_, &passed_}) {
    for (std::vector<uint32_t>& counts : *h) counts.assign(bins_, 0);
  }
}

bool JambEvidence::Add(Histogram& histogram, double x_m, double sigma_m) const {
  if (!(x_m >= -outward_m_ && x_m <= inward_m_)) return false;
  size_t c = 0;
  while (c < kClasses && sigma_m > kSigmas_m[c]) ++c;
  if (c == kClasses) return false;
  ++histogram[c][std::min(bins_ - 1, static_cast<size_t>((x_m + outward_m_) / kBin_m))];
  return true;
}

void JambEvidence::Count(Seen& seen, uint32_t keyframe) {
  if (seen.last != keyframe) ++seen.keyframes;
  seen.last = keyframe;
}

void JambEvidence::AddFace(int side, double x_m, double sigma_m, uint32_t keyframe) {
  if (Add(faces_[static_cast<size_t>(side)], x_m, sigma_m)) Count(wall_seen_, keyframe);
}

void JambEvidence::AddInside(double x_m, double sigma_m, uint32_t keyframe) {
  if (Add(inside_, x_m, sigma_m)) Count(wall_seen_, keyframe);
}

void JambEvidence::AddPassed(double x_m, double sigma_m, uint32_t keyframe) {
  if (Add(passed_, x_m, sigma_m)) Count(passed_seen_, keyframe);
}

class JambSearch {
 public:
  JambSearch(const JambEvidence& evidence, const JambOptions& options)
      : e_(evidence), options_(options), by_wall_(evidence.bins_, 0.0), by_passed_(evidence.bins_, 0.0) {
    for (const JambEvidence::Histogram& face : e_.faces_)
      AddAll(
          face, [this](double d, double s) { return OneSided(d, s); }, by_wall_);
    AddAll(
        e_.inside_, [this](double d, double s) { return Inside(d, s); }, by_wall_);
    AddAll(
        e_.passed_, [this](double d, double s) { return OneSided(-d, s); }, by_passed_);
  }

  JambEstimate Run(double planned_step_m) {
    JambEstimate out = Posterior(0);
    for (int i = 0; i < kRounds; ++i) out = Posterior(PushPerMetre(out.x_m));
    double variance_m2 = out.sigma_m * out.sigma_m + options_.floor_sigma_m * options_.floor_sigma_m;
    const bool border = out.x_m < -e_.outward_m_ + kBorder_m || out.x_m > e_.inward_m_ - kBorder_m;
    bool known = !border && IsSeen(out.x_m) && !IsContradicted(out.x_m);
    // Lining or lumber: the wall ends somewhere between its last face and what is seen to pass.
    double beyond_m = 0;
    known = known && FacesEnd(out.x_m, &beyond_m);
    const double excess_m = beyond_m - planned_step_m;
    if (excess_m > options_.max_step_m) {
      out.x_m -= 0.5 * excess_m;
      variance_m2 += excess_m * excess_m / 12;
    }
    out.sigma_m = std::sqrt(variance_m2);
    out.known = known && out.sigma_m <= options_.max_sigma_m;
    out.on_reveal = IsOnReveal(out.x_m);
    return out;
  }

  JambEstimate Confirm(double x_m, double sigma_m) const {
    const double beyond = Count(e_.passed_, x_m - kAbout_m, x_m - kClear_m), beside = CountPassed(x_m);
    const double at = Count(e_.passed_, x_m - kClear_m, x_m + kClear_m);
    const bool known = beside >= options_.min_lines && e_.passed_seen_.keyframes >= options_.min_keyframes &&
                       beyond <= options_.max_contradicted * beside && at >= kReachesShare * beside;
    return {known && sigma_m <= options_.max_sigma_m, x_m, std::hypot(sigma_m, options_.floor_sigma_m), true};
  }

 private:
  [[nodiscard]] double X(size_t bin) const { return (static_cast<double>(bin) + 0.5) * JambEvidence::kBin_m - e_.outward_m_; }

  // Lines smear over the jamb, and each kind would push it off by that, as often as there are lines of it: of evenly spread lines by their
  // density, which is the derivative of the normalisation of P(x | e) that is left out in by_wall_ and by_passed_. + inwards.
  [[nodiscard]] double PushPerMetre(double x_m) const {
    double wall = 0;
    for (const auto& face : e_.faces_) wall += Count(face, x_m - kDensity_m, x_m - kClear_m);
    return (wall - Count(e_.passed_, x_m + kClear_m, x_m + kDensity_m)) / (kDensity_m - kClear_m);
  }

  [[nodiscard]] JambEstimate Posterior(double push_per_m) const {
    std::vector<double> log_p(e_.bins_);
    for (size_t i = 0; i < log_p.size(); ++i) log_p[i] = (by_wall_[i] + by_passed_[i] - push_per_m * X(i)) / options_.correlation;
    const double most = *std::max_element(log_p.begin(), log_p.end());
    double sum = 0, mean = 0, square = 0;
    for (size_t i = 0; i < log_p.size(); ++i) {
      const double p = std::exp(log_p[i] - most), x = X(i);
      sum += p;
      mean += p * x;
      square += p * x * x;
    }
    mean /= sum;
    return {false, mean, std::sqrt(std::max(0.0, square / sum - mean * mean))};
  }

  // Of a line that says e >= x, d = e - x.
  [[nodiscard]] double OneSided(double d, double sigma_m) const {
    return std::log(options_.outliers + (1 - options_.outliers) * Phi(d / sigma_m));
  }

  // Density, per metre: on the jamb's face, on something behind it, or anything.
  [[nodiscard]] double Inside(double d, double sigma_m) const {
    const double on = std::exp(-0.5 * d * d / (sigma_m * sigma_m)) / (sigma_m * std::sqrt(2 * std::numbers::pi));
    const double behind = (Phi(d / sigma_m) - Phi((d - kFrame_m) / sigma_m)) / kFrame_m;
    return std::log(kJambShare * on + kFrameShare * behind + options_.outliers);
  }

  template <class F>
  void AddAll(const JambEvidence::Histogram& histogram, F&& log_of, std::vector<double>& out) const {
    const size_t n = e_.bins_;
    std::vector<double> table(2 * n - 1);
    for (size_t c = 0; c < histogram.size(); ++c) {
      const std::vector<uint32_t>& counts = histogram[c];
      if (std::all_of(counts.begin(), counts.end(), [](uint32_t k) { return k == 0; })) continue;
      for (size_t k = 0; k < table.size(); ++k) {
        table[k] = log_of((static_cast<double>(k) - static_cast<double>(n - 1)) * JambEvidence::kBin_m, kSigmas_m[c]);
      }
      for (size_t x = 0; x < n; ++x) {
        if (counts[x] == 0) continue;
        for (size_t e = 0; e < n; ++e) out[e] += counts[x] * table[e + n - 1 - x];
      }
    }
  }

  [[nodiscard]] double Count(const JambEvidence::Histogram& histogram, double from_m, double to_m) const {
    double sum = 0;
    for (size_t i = 0; i < e_.bins_; ++i) {
      if (X(i) < from_m || X(i) > to_m) continue;
      for (const std::vector<uint32_t>& counts : histogram) sum += counts[i];
    }
    return sum;
  }

  // Near a jamb at x.
  [[nodiscard]] double CountWall(double x_m) const {
    double wall = Count(e_.inside_, x_m - options_.near_m, x_m + kClear_m);
    for (const auto& face : e_.faces_) wall += Count(face, x_m - options_.near_m, x_m + kClear_m);
    return wall;
  }
  [[nodiscard]] double CountPassed(double x_m) const { return Count(e_.passed_, x_m - kClear_m, x_m + options_.near_m); }

  [[nodiscard]] bool IsSeen(double x_m) const {
    return std::min(CountWall(x_m), CountPassed(x_m)) >= options_.min_lines &&
           std::min(e_.wall_seen_.keyframes, e_.passed_seen_.keyframes) >= options_.min_keyframes;
  }

  [[nodiscard]] bool IsOnReveal(double x_m) const {
    const double on = Count(e_.inside_, x_m - kClear_m, x_m + kClear_m), behind = Count(e_.inside_, x_m - kFrame_m, x_m - kClear_m);
    return on >= options_.min_lines && on >= behind;
  }

  [[nodiscard]] bool IsContradicted(double x_m) const {
    double wrong = Count(e_.passed_, x_m - kAbout_m, x_m - kClear_m), all = Count(e_.passed_, x_m - kAbout_m, x_m + kAbout_m);
    for (const auto* h : {&e_.faces_[0], &e_.faces_[1], &e_.inside_}) {
      wrong += Count(*h, x_m + kClear_m, x_m + kAbout_m);
      all += Count(*h, x_m - kAbout_m, x_m + kAbout_m);
    }
    return wrong > options_.max_contradicted * all;
  }

  // How far before the jamb each face ends that was seen near it; false: they end at different places, and the jamb is not where it is
  // planned, so that it may be something that stands in the opening. (One face may be hidden.)
  [[nodiscard]] bool FacesEnd(double x_m, double* beyond_m) const {
    double nearest = kFrame_m, farthest = 0;
    int seen = 0;
    double far = 0;  // lines that end on faces, but not near the jamb
    for (const auto& face : e_.faces_) {
      const double near = Count(face, x_m - kFrame_m, x_m + kClear_m);
      if (near < options_.min_lines) {
        far += Count(face, -e_.outward_m_, x_m - kFrame_m);
        continue;
      }
      ++seen;
      double left = std::max(3.0, kFaceEndShare * near), end_m = x_m + kClear_m;
      while (end_m > x_m - kFrame_m && Count(face, end_m, x_m + kClear_m) < left) end_m -= JambEvidence::kBin_m;
      nearest = std::min(nearest, x_m - end_m);
      farthest = std::max(farthest, x_m - end_m);
    }
    *beyond_m = seen == 0 ? 0 : std::max(0.0, nearest);
    if (seen == 0) return far < options_.min_lines;  // what stands so far from the end of the wall is a leaf, or lumber
    return seen < 2 || farthest - nearest <= options_.max_faces_apart_m || std::abs(x_m) <= options_.max_step_m;
  }

  const JambEvidence& e_;
  const JambOptions& options_;
  std::vector<double> by_wall_, by_passed_;  // log-likelihood of the jamb in each bin
};

std::string JambOptions::Check() const {
  const std::pair<const char*, double> positive[] = {{"floor_sigma_m", floor_sigma_m},
                                                     {"max_sigma_m", max_sigma_m},
                                                     {"near_m", near_m},
                                                     {"max_step_m", max_step_m},
                                                     {"max_faces_apart_m", max_faces_apart_m}};
  for (const auto& [name, value] : positive) {
    if (!(value > 0 && std::isfinite(value))) return fmt::format("JambOptions.{} = {}; must be a positive number", name, value);
  }
  if (!(correlation >= 1)) return fmt::format("JambOptions.correlation = {}; must be >= 1", correlation);
  if (!(outliers > 0 && outliers < 1)) return fmt::format("JambOptions.outliers = {}; must be in (0, 1)", outliers);
  if (!(max_contradicted >= 0 && max_contradicted <= 1)) {
    return fmt::format("JambOptions.max_contradicted = {}; must be in [0, 1]", max_contradicted);
  }
  if (min_lines < 1) return fmt::format("JambOptions.min_lines = {}; must be >= 1", min_lines);
  if (min_keyframes < 1) return fmt::format("JambOptions.min_keyframes = {}; must be >= 1", min_keyframes);
  return {};
}

JambEstimate ConfirmJamb(const JambEvidence& evidence, double x_m, double sigma_m, const JambOptions& options) {
  return JambSearch(evidence, options).Confirm(x_m, sigma_m);
}

JambEstimate EstimateJamb(const JambEvidence& evidence, double planned_step_m, const JambOptions& options) {
  return JambSearch(evidence, options).Run(planned_step_m);
}

}  // namespace plumb::runtime
