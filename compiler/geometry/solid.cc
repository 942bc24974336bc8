#include "compiler/geometry/solid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

namespace plumb::compiler {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

int64_t Cell(double x) { return static_cast<int64_t>(std::floor(std::clamp(x, -1e15, 1e15))); }

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

std::vector<Side> SortedSides(const Solid& solid) {
  std::vector<Side> sides;
  sides.reserve(3 * solid.triangles.size());
  for (size_t t = 0; t < solid.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = solid.triangles[t][k], b = solid.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), a < b});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle); });
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

// Turns triangles so that neighbours across edges of two triangles run against each other.
void MakeConsistent(Solid& solid) {
  const std::vector<Side> sides = SortedSides(solid);
  struct Link {
    int to;
    bool same_direction;
  };
  std::vector<std::vector<Link>> links(solid.triangles.size());
  ForEachEdge(sides, [&](size_t i, size_t j) {
    if (j - i != 2) return;
    const bool same = sides[i].forward == sides[i + 1].forward;
    links[static_cast<size_t>(sides[i].triangle)].push_back({sides[i + 1].triangle, same});
    links[static_cast<size_t>(sides[i + 1].triangle)].push_back({sides[i].triangle, same});
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
      for (const Link& link : links[t]) {
        char& other = state[static_cast<size_t>(link.to)];
        if (other != kUnseen) continue;
        other = link.same_direction == (state[t] == kKeep) ? kTurn : kKeep;
        stack.push_back(link.to);
      }
    }
  }
  for (size_t t = 0; t < state.size(); ++t) {
    if (state[t] == kTurn) std::swap(solid.triangles[t][1], solid.triangles[t][2]);
  }
}

const Vector3d& Corner(const Solid& solid, const Vector3i& t, int k) { return solid.vertices[static_cast<size_t>(t[k])]; }

}  // namespace

VertexWelder::VertexWelder(double tolerance_m) : tolerance_m_(tolerance_m), cell_m_(16 * tolerance_m) {}

int VertexWelder::FindOrAdd(const Vector3d& p) {
  const Vector3d low = (p.array() - tolerance_m_) / cell_m_, high = (p.array() + tolerance_m_) / cell_m_;
  for (int64_t x = Cell(low.x()); x <= Cell(high.x()); ++x) {
    for (int64_t y = Cell(low.y()); y <= Cell(high.y()); ++y) {
      for (int64_t z = Cell(low.z()); z <= Cell(high.z()); ++z) {
        const int found = FindInCell(CellKey(x, y, z), p);
        if (found >= 0) return found;
      }
    }
  }
  const int index = static_cast<int>(points_.size());
  points_.push_back(p);
  int& head = heads_.try_emplace(CellKey(Cell(p.x() / cell_m_), Cell(p.y() / cell_m_), Cell(p.z() / cell_m_)), -1).first->second;
  next_.push_back(head);
  head = index;
  return index;
}

int VertexWelder::FindInCell(uint64_t key, const Vector3d& p) const {
  const auto it = heads_.find(key);
  if (it == heads_.end()) return -1;
  for (int i = it->second; i >= 0; i = next_[static_cast<size_t>(i)]) {
    if ((points_[static_cast<size_t>(i)] - p).squaredNorm() <= tolerance_m_ * tolerance_m_) return i;
  }
  return -1;
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
  Eigen::AlignedBox3d box;
  for (const Vector3i& t : solid.triangles) {
    for (int k = 0; k < 3; ++k) box.extend(Corner(solid, t, k));
  }
  return box;
}

bool IsClosed(const Solid& solid) {
  if (solid.empty()) return false;
  bool closed = true;
  const std::vector<Side> sides = SortedSides(solid);
  ForEachEdge(sides, [&](size_t i, size_t j) {
    const auto forward = std::count_if(sides.begin() + static_cast<std::ptrdiff_t>(i), sides.begin() + static_cast<std::ptrdiff_t>(j),
                                       [](const Side& s) { return s.forward; });
    closed &= 2 * static_cast<size_t>(forward) == j - i;
  });
  return closed;
}

void TransformSolid(const Eigen::Affine3d& T_out_in, Solid& solid) {
  for (Vector3d& v : solid.vertices) v = T_out_in * v;
  if (T_out_in.linear().determinant() < 0) FlipSolid(solid);
}

void FlipSolid(Solid& solid) {
  for (Vector3i& t : solid.triangles) std::swap(t[1], t[2]);
}

void AppendSolid(const Solid& from, Solid& into) {
  const int base = static_cast<int>(into.vertices.size());
  const size_t first = into.triangles.size();
  into.vertices.insert(into.vertices.end(), from.vertices.begin(), from.vertices.end());
  // Not reserved to the last triangle: many small solids would each move all that is there.
  into.triangles.insert(into.triangles.end(), from.triangles.begin(), from.triangles.end());
  for (size_t i = first; i < into.triangles.size(); ++i) into.triangles[i].array() += base;
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
  if (!IsClosed(solid)) {
    MakeConsistent(solid);
    // Each piece was turned to an orientation of its own.
    Solid turned;
    for (Solid& piece : ConnectedPieces(solid)) {
      if (Volume(piece) < 0) FlipSolid(piece);
      AppendSolid(piece, turned);
    }
    solid = std::move(turned);
  } else if (Volume(solid) < 0) {
    FlipSolid(solid);
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
