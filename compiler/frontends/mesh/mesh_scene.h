// A mesh as it is read: objects with triangles, and what the file says of its unit and its axes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/geometry/solid.h"

namespace plumb::compiler {

struct MeshObject {
  std::string name;
  SourceLocation location;
  Solid solid;
};

enum class UpAxis : uint8_t { kX, kY, kZ };

struct MeshScene {
  std::vector<MeshObject> objects;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // to be added to every corner
  std::optional<double> unit_m;  // length of the file's unit, where its format states one
  std::optional<UpAxis> up;      // as its format states
};

}  // namespace plumb::compiler
