#include "compiler/geometry/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace plumb::compiler {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

int64_t CellOf(double x) { return static_cast<int64_t>(std::floor(std::clamp(x, -1e15, 1e15))); }

uint64_t CellKey(int64_t x, int64_t y, int64_t z) {
  const auto mix = [](int64_t v, uint64_t k) { return static_cast<uint64_t>(v) * k; };
  const uint64_t h = mix(x, 0x9e3779b97f4a7c15u) ^ mix(y, 0xc2b2ae3d27d4eb4fu) ^ mix(z, 0x165667b19e3779f9u);
  return h ^ h >> 29;
}

// A triangle's side from vertex a to vertex b, under the undirected key.
struct Side {
  int low, high;
  int triangle;
  bool forward;  // the triangle runs from low to high
};

// By low, high and triangle. O(n) for solids whose corners have few triangles each.
std::vector<Side> SortedSides(const Solid& solid) {
  std::vector<uint32_t> end_of(solid.vertices.size() + 1, 0);  // in the result, by the vertex `low`
  const auto for_each = [&solid](const auto& visit) {
    for (size_t t = 0; t < solid.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int a = solid.triangles[t][k], b = solid.triangles[t][(k + 1) % 3];
        visit(Side{std::min(a, b), std::max(a, b), static_cast<int>(t), a < b});
      }
    }
  };
  for_each([&](const Side& side) { ++end_of[static_cast<size_t>(side.low) + 1]; });
  std::partial_sum(end_of.begin(), end_of.end(), end_of.begin());
  std::vector<Side> sides(3 * solid.triangles.size());
  for_each([&](const Side& side) { sides[end_of[static_cast<size_t>(side.low)]++] = side; });
  auto first = sides.begin();
  for (const uint32_t end : end_of) {
    const auto last = sides.begin() + end;
    if (last - first > 1) {
      std::sort(first, last, [](const Side& a, const Side& b) { return a.high != b.high ? a.high < b.high : a.triangle < b.triangle; });
    }
    first = last;
  }
  return sides;
}

// Calls visit(first, last) for each group of sides on the same edge.
template <class Visit>
void ForEachEdge(const std::vector<Side>& sides, Visit visit) {
  for (size_t i = 0; i < sides.size();) {
    size_t j = i;
    while (j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high) ++j;
    visit(i, j);
    i = j;
  }
}

// A number for each edge that shares no pattern with those of others (the finalizer of splitmix64).
uint64_t Scrambled(uint64_t edge) {
  edge = (edge ^ edge >> 30) * 0xbf58476d1ce4e5b9u;
  edge = (edge ^ edge >> 27) * 0x94d049bb133111ebu;
  return edge ^ edge >> 31;
}

// Turns triangles so that neighbours across edges of two triangles run against each other.
void MakeConsistent(const std::vector<Side>& sides, Solid& solid) {
  struct Links {
    int count = 0;
    std::array<int, 3> to;
    std::array<bool, 3> same_direction;
    void Add(int triangle, bool same) {
      to[static_cast<size_t>(count)] = triangle;
      same_direction[static_cast<size_t>(count++)] = same;
    }
  };
  std::vector<Links> links(solid.triangles.size());
  ForEachEdge(sides, [&](size_t i, size_t j) {
    if (j - i != 2) return;
    const bool same = sides[i].forward == sides[i + 1].forward;
    links[static_cast<size_t>(sides[i].triangle)].Add(sides[i + 1].triangle, same);
    links[static_cast<size_t>(sides[i + 1].triangle)].Add(sides[i].triangle, same);
  });
  enum : char { kUnseen, kKeep, kTurn };
  std::vector<char> state(solid.triangles.size(), kUnseen);
  std::vector<int> stack;
  for (size_t seed = 0; seed < state.size(); ++seed) {
    if (state[seed] != kUnseen) continue;
    state[seed] = kKeep;
    stack.push_back(static_cast<int>(seed));
    while (!stack.empty()) {
      const auto t = static_cast<size_t>(stack.back());
      stack.pop_back();
      for (size_t k = 0; k < static_cast<size_t>(links[t].count); ++k) {
        char& other = state[static_cast<size_t>(links[t].to[k])];
        if (other != kUnseen) continue;
        other = links[t].same_direction[k] == (state[t] == kKeep) ? kTurn : kKeep;
        stack.push_back(links[t].to[k]);
      }
    }
  }
  for (size_t t = 0; t < state.size(); ++t) {
    if (state[t] == kTurn) std::swap(solid.triangles[t][1], solid.triangles[t][2]);
  }
}

const Vector3d& Corner(const Solid& solid, const Vector3i& t, int k) { return solid.vertices[static_cast<size_t>(t[k])]; }

}  // namespace

VertexWelder::VertexWelder(double tolerance_m) : tolerance_m_(tolerance_m), cell_m_(16 * tolerance_m), cells_(32) {}

int VertexWelder::FindOrAdd(const Vector3d& p) {
  const Vector3d low = (p.array() - tolerance_m_) / cell_m_, high = (p.array() + tolerance_m_) / cell_m_;
  for (int64_t x = CellOf(low.x()); x <= CellOf(high.x()); ++x) {
    for (int64_t y = CellOf(low.y()); y <= CellOf(high.y()); ++y) {
      for (int64_t z = CellOf(low.z()); z <= CellOf(high.z()); ++z) {
        const int found = FindInCell(CellKey(x, y, z), p);
        if (found >= 0) return found;
      }
    }
  }
  const int index = static_cast<int>(points_.size());
  points_.push_back(p);
  if (2 * used_cells_ >= cells_.size()) Grow();
  const uint64_t key = CellKey(CellOf(p.x() / cell_m_), CellOf(p.y() / cell_m_), CellOf(p.z() / cell_m_));
  HashCell& cell = cells_[SlotOf(key)];
  if (cell.head < 0) ++used_cells_;
  next_.push_back(cell.head);
  cell = {key, index};
  return index;
}

int VertexWelder::FindInCell(uint64_t key, const Vector3d& p) const {
  for (int i = cells_[SlotOf(key)].head; i >= 0; i = next_[static_cast<size_t>(i)]) {
    if ((points_[static_cast<size_t>(i)] - p).squaredNorm() <= tolerance_m_ * tolerance_m_) return i;
  }
  return -1;
}

size_t VertexWelder::SlotOf(uint64_t key) const {
  const size_t mask = cells_.size() - 1;
  size_t at = key & mask;
  while (cells_[at].head >= 0 && cells_[at].key != key) at = (at + 1) & mask;
  return at;
}

void VertexWelder::Grow() {
  std::vector<HashCell> old(2 * cells_.size());
  old.swap(cells_);
  for (const HashCell& cell : old) {
    if (cell.head >= 0) cells_[SlotOf(cell.key)] = cell;
  }
}

double Volume(const Solid& solid) {
  if (solid.empty()) return 0;
  const Vector3d origin = Corner(solid, solid.triangles[0], 0);  // near the solid: far coordinates would cost digits
  double sum = 0;
  for (const Vector3i& t : solid.triangles) {
    const Vector3d a = Corner(solid, t, 0) - origin, b = Corner(solid, t, 1) - origin, c = Corner(solid, t, 2) - origin;
    sum += a.dot(b.cross(c));
  }
  return sum / 6;
}

double SurfaceArea(const Solid& solid) {
  double sum = 0;
  for (const Vector3i& t : solid.triangles) {
    sum += (Corner(solid, t, 1) - Corner(solid, t, 0)).cross(Corner(solid, t, 2) - Corner(solid, t, 0)).norm();
  }
  return sum / 2;
}

Eigen::AlignedBox3d Bounds(const Solid& solid) {
  std::vector<char> used(solid.vertices.size(), 0);  // each is looked at once, though six triangles or so share it
  for (const Vector3i& t : solid.triangles) {
    for (int k = 0; k < 3; ++k) used[static_cast<size_t>(t[k])] = 1;
  }
  Eigen::AlignedBox3d box;
  for (size_t v = 0; v < used.size(); ++v) {
    if (used[v] != 0) box.extend(solid.vertices[v]);
  }
  return box;
}

// Each side adds its edge's number one way and takes it away the other: nothing is left.
bool IsClosed(const Solid& solid) {
  uint64_t left = 0;
  for (const Vector3i& t : solid.triangles) {
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<uint32_t>(t[k]), b = static_cast<uint32_t>(t[(k + 1) % 3]);
      left += a < b ? Scrambled(uint64_t{a} << 32 | b) : ~Scrambled(uint64_t{b} << 32 | a) + 1;
    }
  }
  return !solid.empty() && left == 0;
}

void TransformSolid(const Eigen::Affine3d& T_out_in, Solid& solid) {
  for (Vector3d& v : solid.vertices) v = T_out_in * v;
  if (T_out_in.linear().determinant() < 0) FlipSolid(solid);
}

void FlipSolid(Solid& solid) {
  for (Vector3i& t : solid.triangles) std::swap(t[1], t[2]);
}

void ShrinkSolid(Solid& solid) {
  const auto shrink = [](auto& items) {
    if (items.capacity() > items.size() + items.size() / 8) items.shrink_to_fit();
  };
  shrink(solid.vertices);
  shrink(solid.triangles);
}

void AppendSolid(const Solid& from, Solid& into) {
  const int base = static_cast<int>(into.vertices.size());
  const size_t first = into.triangles.size();
  into.vertices.insert(into.vertices.end(), from.vertices.begin(), from.vertices.end());
  // Not reserved to the last triangle: many small solids would each move all that is there.
  into.triangles.insert(into.triangles.end(), from.triangles.begin(), from.triangles.end());
  for (size_t i = first; i < into.triangles.size(); ++i) into.triangles[i].array() += base;
}

void AppendSolid(Solid&& from, Solid& into) {
  if (into.vertices.empty() && into.triangles.empty())
    into = std::move(from);
  else
    AppendSolid(std::as_const(from), into);
}

void WeldSolid(double tolerance_m, Solid& solid) {
  VertexWelder index(tolerance_m);
  std::vector<int> renamed(solid.vertices.size(), -1);
  std::vector<Vector3i> kept;
  kept.reserve(solid.triangles.size());
  for (Vector3i t : solid.triangles) {
    for (int k = 0; k < 3; ++k) {
      int& name = renamed[static_cast<size_t>(t[k])];
      if (name < 0) name = index.FindOrAdd(solid.vertices[static_cast<size_t>(t[k])]);
      t[k] = name;
    }
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) kept.push_back(t);
  }
  solid.vertices = index.Take();
  solid.triangles = std::move(kept);
}

void OrientOutward(Solid& solid) {
  if (solid.empty()) return;
  if (IsClosed(solid)) {
    if (Volume(solid) < 0) FlipSolid(solid);
    return;
  }
  MakeConsistent(SortedSides(solid), solid);
  // Each piece was turned to an orientation of its own.
  std::vector<Solid> pieces = ConnectedPieces(solid);
  solid = {};
  for (Solid& piece : pieces) {
    if (Volume(piece) < 0) FlipSolid(piece);
    AppendSolid(std::move(piece), solid);
  }
}

std::vector<Solid> ConnectedPieces(const Solid& solid) {
  std::vector<int> parent(solid.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int v) {
    while (parent[static_cast<size_t>(v)] != v) {
      int& up = parent[static_cast<size_t>(v)];
      up = parent[static_cast<size_t>(up)];
      v = up;
    }
    return v;
  };
  for (const Vector3i& t : solid.triangles) {
    parent[static_cast<size_t>(root(t[1]))] = root(t[0]);
    parent[static_cast<size_t>(root(t[2]))] = root(t[0]);
  }
  std::vector<int> piece_of(solid.vertices.size(), -1), renamed(solid.vertices.size(), -1);
  std::vector<Solid> pieces;
  for (const Vector3i& t : solid.triangles) {
    int& piece = piece_of[static_cast<size_t>(root(t[0]))];
    if (piece < 0) {
      piece = static_cast<int>(pieces.size());
      pieces.emplace_back();
    }
    Solid& out = pieces[static_cast<size_t>(piece)];
    Vector3i moved;
    for (int k = 0; k < 3; ++k) {
      int& name = renamed[static_cast<size_t>(t[k])];
      if (name < 0) {
        name = static_cast<int>(out.vertices.size());
        out.vertices.push_back(solid.vertices[static_cast<size_t>(t[k])]);
      }
      moved[k] = name;
    }
    out.triangles.push_back(moved);
  }
  return pieces;
}

Solid MakeBox(const Vector3d& low, const Vector3d& high, const Eigen::Affine3d& T_out_box) {
  Solid box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(), (i & 4) != 0 ? high.z() : low.z());
  }
  constexpr int kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : kQuads) {
    box.triangles.emplace_back(q[0], q[1], q[2]);
    box.triangles.emplace_back(q[0], q[2], q[3]);
  }
  TransformSolid(T_out_box, box);
  return box;
}

}  // namespace plumb::compiler
