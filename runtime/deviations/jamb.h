// Where one side of an opening in a wall is, from what was seen about it.
//
// One coordinate: x, along the wall, 0 where the plan has the jamb, + into the opening. The jamb at e is where wall ends: what is seen on
// the wall's faces lies at x <= e, what is seen through the opening passes at x >= e, and what is seen inside the wall's thickness is the
// jamb's own face, or a frame that stands back from it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace plumb::runtime {

struct JambOptions {
  double correlation = 4;           // lines of one sweep share their errors: so many count as one
  double outliers = 0.05;           // share of lines that say nothing
  double floor_sigma_m = 0.005;     // no number of lines makes a jamb better known than that
  double max_sigma_m = 0.02;        // known worse, it is not known
  double near_m = 0.15;             // wall must be seen so near to the jamb, and something through the opening, ...
  int min_lines = 8;                // ... by so many lines ...
  int min_keyframes = 2;            // ... from so many keyframes
  double max_contradicted = 0.2;    // of the lines about the jamb those on its wrong side: it is no clear edge
  double max_step_m = 0.025;        // between the end of the wall's face and the jamb: more is a lining, or something in the opening
  double max_faces_apart_m = 0.04;  // the two faces of a wall end at the same jamb
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

// Histograms along x, whose size does not grow with what is seen.
class JambEvidence {
 public:
  static constexpr double kBin_m = 0.002;
  static constexpr int kSides = 2, kClasses = 4;

  // Of a jamb that may be from `outward_m` within the wall to `inward_m` within the opening.
  JambEvidence(double outward_m, double inward_m);

  // Seen on the face of one side (0 or 1), inside the thickness, through the opening; sigma_m: of x. Keyframes come in order.
  void AddFace(int side, double x_m, double sigma_m, uint32_t keyframe);
  void AddInside(double x_m, double sigma_m, uint32_t keyframe);
  void AddPassed(double x_m, double sigma_m, uint32_t keyframe);

 private:
  friend class JambSearch;
  using Histogram = std::array<std::vector<uint32_t>, kClasses>;  // by class of sigma
  struct Seen {
    int keyframes = 0;
    uint32_t last = 0xffffffffu;
  };

  // False: too far off, or too coarse to tell anything.
  bool Add(Histogram& histogram, double x_m, double sigma_m) const;
  static void Count(Seen& seen, uint32_t keyframe);

  double outward_m_, inward_m_;
  size_t bins_;
  std::array<Histogram, kSides> faces_;
  Histogram inside_, passed_;
  Seen wall_seen_, passed_seen_;
};

struct JambEstimate {
  bool known = false;
  double x_m = 0, sigma_m = 0;
  bool on_reveal = false;  // something inside the wall's thickness was seen there, and not mostly farther back
};

// `planned_step_m`: how far the plan's frame stands into the opening beyond the wall's end. O(bins^2).
[[nodiscard]] JambEstimate EstimateJamb(const JambEvidence& evidence, double planned_step_m, const JambOptions& options = {});

// A jamb that is known from elsewhere to be at x_m: `known` if lines pass up to there and not beyond. O(bins).
[[nodiscard]] JambEstimate ConfirmJamb(const JambEvidence& evidence, double x_m, double sigma_m, const JambOptions& options = {});

}  // namespace plumb::runtime
