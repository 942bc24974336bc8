#include "compiler/frontends/mesh/mesh_frontend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/frontends/mesh/mesh_frame.h"
#include "compiler/frontends/mesh/mesh_loader.h"
#include "compiler/frontends/mesh/mesh_origin.h"
#include "compiler/frontends/mesh/mesh_plan.h"

namespace plumb::compiler {
namespace {

constexpr double kMaxCoordinate = 1e9;

// The first face with a coordinate that is no number.
bool IsFinite(const MeshScene& scene, DiagnosticSink& diagnostics) {
  for (const MeshObject& o : scene.objects) {
    for (size_t t = 0; t < o.solid.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d& v = o.solid.vertices[static_cast<size_t>(o.solid.triangles[t][k])];
        if (v.allFinite() && v.cwiseAbs().maxCoeff() < kMaxCoordinate) continue;
        diagnostics.Emit(DiagnosticKind::kMeshNotFinite, o.location,
                         fmt::format("face {} of object `{}` has a corner at ({}, {}, {})", t + 1, o.name, v.x(), v.y(), v.z()));
        return false;
      }
    }
  }
  return true;
}

// The longest diagonal of an object.
double ExtentOf(const MeshScene& scene) {
  double out = 0;
  for (const MeshObject& o : scene.objects) out = std::max(out, Bounds(o.solid).diagonal().norm());
  return out;
}

void ReportOrigin(const MeshScene& scene, double blur_m, const MeshOptions& options, DiagnosticSink& diagnostics) {
  const Eigen::Vector3d& o = scene.origin;
  if (!o.isZero()) {
    diagnostics.Emit(
        DiagnosticKind::kFarOrigin, {},
        fmt::format("the plan lies {:.0f} km from its zero; it is compiled about ({:.0f}, {:.0f})", o.norm() / 1000, o.x(), o.y()));
  }
  if (blur_m <= options.line_tolerance_m) return;
  diagnostics.Emit(DiagnosticKind::kMeshBlurred, {},
                   fmt::format("its corners lie so far from zero that the numbers they are stored in are {:.3f} m apart", blur_m),
                   "move the model near its zero before it is exported");
}

}  // namespace

std::optional<PlanIr> ReadMesh(const Source& source, DiagnosticSink& diagnostics, const MeshOptions& options) {
  if (const std::string problem = options.Check(); !problem.empty()) {
    diagnostics.Emit(DiagnosticKind::kInternalError, {}, problem);
    return std::nullopt;
  }
  Expected<MeshScene> scene = LoadMesh(source, options);
  if (!scene) {
    const bool limits = scene.error().code == ErrorCode::kFileTooLarge;
    diagnostics.Emit(limits ? DiagnosticKind::kMeshTooLarge : DiagnosticKind::kMeshUnreadable, {},
                     fmt::format("{} is not read: {}", FormatName(source.format), scene.error().message));
    return std::nullopt;
  }
  if (!IsFinite(*scene, diagnostics)) return std::nullopt;
  const bool any = std::any_of(scene->objects.begin(), scene->objects.end(), [](const MeshObject& o) { return SurfaceArea(o.solid) > 0; });
  if (!any) {
    diagnostics.Emit(DiagnosticKind::kMeshWithoutTriangles, {}, "the mesh has no face with an area");
    return std::nullopt;
  }
  const double blur = BlurOf(*scene), extent = ExtentOf(*scene);  // in the file's unit; the frame shows which it is
  MoveSceneNearZero(*scene);
  MoveToPlanFrame(options, *scene, diagnostics);
  ReportOrigin(*scene, blur * ExtentOf(*scene) / extent, options, diagnostics);
  PlanIr plan = MakePlan(*scene, options, diagnostics);
  plan.source_path = source.path;
  plan.source_format = SchemaName(source.format);
  plan.source_sha256 = source.sha256;
  return plan;
}

}  // namespace plumb::compiler
