#include "runtime/numerics/distance_transform.h"

#include <algorithm>
#include <limits>

namespace plumb::runtime {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr size_t kColumns = 16;  // gathered at a time: a cache line

// Along one row: a sweep each way.
void TransformRow(const uint8_t* marked, size_t width, float* squared) {
  float cells = kFar;
  for (size_t x = 0; x < width; ++x) {
    cells = marked[x] != 0 ? 0 : cells + 1;
    squared[x] = cells * cells;
  }
  cells = kFar;
  for (size_t x = width; x-- > 0;) {
    cells = marked[x] != 0 ? 0 : cells + 1;
    squared[x] = std::min(squared[x], cells * cells);
  }
}

// Lower envelope of the parabolas that stand on one line's distances so far.
class LineTransform {
 public:
  explicit LineTransform(size_t length) : site_(length), from_(length), out_(length) {}

  void Apply(std::vector<float>& f) {
    const size_t n = f.size();
    size_t count = 0;
    for (size_t q = 0; q < n; ++q) {
      if (f[q] == kFar) continue;
      double at = -std::numeric_limits<double>::infinity();
      while (count > 0) {
        const size_t p = site_[count - 1];
        at = (Height(f, q) - Height(f, p)) / (2.0 * static_cast<double>(q - p));
        if (at > from_[count - 1]) break;
        --count;
      }
      site_[count] = q;
      from_[count] = count == 0 ? -std::numeric_limits<double>::infinity() : at;
      ++count;
    }
    if (count == 0) return;
    for (size_t q = 0, k = 0; q < n; ++q) {
      while (k + 1 < count && from_[k + 1] < static_cast<double>(q)) ++k;
      const double step = static_cast<double>(q) - static_cast<double>(site_[k]);
      out_[q] = static_cast<float>(step * step + static_cast<double>(f[site_[k]]));
    }
    f.swap(out_);
  }

 private:
  static double Height(const std::vector<float>& f, size_t q) {
    return static_cast<double>(f[q]) + static_cast<double>(q) * static_cast<double>(q);
  }

  std::vector<size_t> site_;
  std::vector<double> from_;
  std::vector<float> out_;
};

}  // namespace

std::vector<float> SquaredCellDistances(const std::vector<uint8_t>& marked, size_t width) {
  std::vector<float> squared(marked.size());
  if (width == 0) return squared;
  const size_t height = marked.size() / width;
  for (size_t y = 0; y < height; ++y) TransformRow(&marked[y * width], width, &squared[y * width]);
  LineTransform transform(height);
  std::vector<std::vector<float>> columns(kColumns, std::vector<float>(height));
  for (size_t x = 0; x < width; x += kColumns) {
    const size_t count = std::min(kColumns, width - x);
    for (size_t y = 0; y < height; ++y) {
      for (size_t k = 0; k < count; ++k) columns[k][y] = squared[y * width + x + k];
    }
    for (size_t k = 0; k < count; ++k) transform.Apply(columns[k]);
    for (size_t y = 0; y < height; ++y) {
      for (size_t k = 0; k < count; ++k) squared[y * width + x + k] = columns[k][y];
    }
  }
  return squared;
}

}  // namespace plumb::runtime
