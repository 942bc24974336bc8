#include "compiler/frontends/sdf/sdf_frontend.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "compiler/frontends/mesh/mesh_loader.h"
#include "compiler/frontends/mesh/mesh_plan.h"
#include "compiler/frontends/sdf/sdf_files.h"
#include "compiler/frontends/sdf/sdf_shapes.h"
#include "compiler/frontends/xml/xml.h"
#include "compiler/geometry/sweep.h"

namespace plumb::compiler {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using tinyxml2::XMLElement;
namespace fs = std::filesystem;

constexpr int kMaxNesting = 12;  // of models and includes in each other
constexpr size_t kMaxShapes = 200000;
constexpr size_t kMaxPoints = 100000;
constexpr double kMaxLength_m = 1e5;
constexpr double kMaxPlane_m = 200;  // planes stand for the ground; they reach no farther than a site

Isometry3d Pose(const Vector3d& t, const Vector3d& rpy) {
  return Eigen::Translation3d(t) * Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX());
}

// `relative_to` and the older `frame` name another frame by its name.
const char* FrameOf(const XMLElement& pose) {
  const char* frame = pose.Attribute("relative_to");
  return frame != nullptr ? frame : pose.Attribute("frame");
}

class WorldReader {
 public:
  WorldReader(const Source& source, const MeshOptions& options, DiagnosticSink& sink)
      : options_(options), sink_(sink), files_(source.path, options.model_path) {}

  MeshScene scene;

  // False: an error was said.
  bool ReadText(const std::string& text, const fs::path& path, const Isometry3d& T, const std::string& name, int depth) {
    tinyxml2::XMLDocument document;
    const XMLElement* sdf = ParseXml(text, path.filename().string(), "sdf", document, sink_);
    if (sdf == nullptr) return false;
    folder_ = path.parent_path();
    for (const XMLElement* e = sdf->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      if (std::string_view(e->Name()) == "world") ReadChildren(*e, T, "", depth);
      if (std::string_view(e->Name()) == "model") ReadModel(*e, T, name, depth);
    }
    return true;
  }

 private:
  void Emit(DiagnosticKind kind, const XMLElement& e, std::string message, std::string hint = {}) {
    SourceLocation where;
    where.line = static_cast<uint32_t>(std::max(0, e.GetLineNum()));
    where.type = "element";
    where.guid = PathOf(e);
    sink_.Emit(kind, where, std::move(message), std::move(hint));
  }

  static std::string PathOf(const XMLElement& e) {
    std::string out;
    for (const tinyxml2::XMLNode* n = &e; n != nullptr && n->ToElement() != nullptr; n = n->Parent()) {
      const char* name = n->ToElement()->Attribute("name");
      out = fmt::format("/{}{}{}", n->Value(), name != nullptr ? fmt::format("[{}]", name) : "", out);
    }
    return out;
  }

  std::vector<double> Numbers(const XMLElement* e, size_t count) {
    std::vector<double> out;
    if (e == nullptr) return out;
    std::istringstream in(e->GetText() == nullptr ? "" : e->GetText());
    in.imbue(std::locale::classic());
    for (double v = 0; in >> v;) out.push_back(v);
    const bool fine =
        out.size() == count && in.eof() && std::all_of(out.begin(), out.end(), [](double v) { return std::abs(v) < kMaxLength_m; });
    if (fine) return out;
    Emit(DiagnosticKind::kXmlBadValue, *e, fmt::format("<{}> is not {} finite numbers; it is left out", e->Name(), count));
    return {};
  }

  Isometry3d PoseOf(const XMLElement& e) {
    const XMLElement* pose = e.FirstChildElement("pose");
    if (pose == nullptr || pose->GetText() == nullptr) return Isometry3d::Identity();
    if (const char* frame = FrameOf(*pose); frame != nullptr && frame[0] != '\0' && std::string_view(frame) != "world") {
      Emit(DiagnosticKind::kXmlUnsupported, *pose,
           fmt::format("the pose is relative to `{}`; it is read as relative to its parent", frame));
    }
    const std::vector<double> v = Numbers(pose, 6);
    return v.empty() ? Isometry3d::Identity() : Pose({v[0], v[1], v[2]}, {v[3], v[4], v[5]});
  }

  void ReadChildren(const XMLElement& parent, const Isometry3d& T, const std::string& prefix, int depth) {
    for (const XMLElement* e = parent.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view kind = e->Name();
      if (kind == "model") ReadModel(*e, T, prefix, depth);
      if (kind == "include") ReadInclude(*e, T, prefix, depth);
      if (kind == "link") ReadLink(*e, T, prefix);
    }
  }

  void ReadModel(const XMLElement& model, const Isometry3d& T, const std::string& prefix, int depth) {
    if (depth > kMaxNesting) {
      Emit(DiagnosticKind::kXmlTooDeep, model, fmt::format("models are nested deeper than {}", kMaxNesting));
      return;
    }
    const char* name = model.Attribute("name");
    ReadChildren(model, T * PoseOf(model), prefix.empty() ? (name == nullptr ? "model" : name) : prefix, depth + 1);
  }

  void ReadInclude(const XMLElement& include, const Isometry3d& T, const std::string& prefix, int depth) {
    const XMLElement* uri = include.FirstChildElement("uri");
    if (uri == nullptr || uri->GetText() == nullptr) {
      Emit(DiagnosticKind::kXmlBadValue, include, "an <include> has no <uri>; it is left out");
      return;
    }
    const std::optional<fs::path> found = Find(*uri);
    if (!found) return;
    fs::path file = *found;
    std::error_code error;
    if (fs::is_directory(file, error)) file /= "model.sdf";
    if (depth > kMaxNesting || std::find(open_.begin(), open_.end(), file) != open_.end()) {
      Emit(DiagnosticKind::kXmlTooDeep, include,
           fmt::format("`{}` includes itself, or models are nested deeper than {}", uri->GetText(), kMaxNesting));
      return;
    }
    const XMLElement* name = include.FirstChildElement("name");
    const std::string own = name != nullptr && name->GetText() != nullptr ? name->GetText() : prefix;
    const std::optional<Source> source = LoadSource(file.string(), sink_);
    if (!source) return;
    const fs::path back = folder_;
    open_.push_back(file);
    ReadText(source->bytes, file, T * PoseOf(include), own, depth + 1);
    open_.pop_back();
    folder_ = back;
  }

  std::optional<fs::path> Find(const XMLElement& uri) {
    const FoundFile found = files_.Find(uri.GetText(), folder_);
    if (found.path) return found.path;
    if (found.fault == UriFault::kOutside) {
      Emit(DiagnosticKind::kIncludeOutside, uri,
           fmt::format("`{}` lies on a network or above the world's folder; it is left out", uri.GetText()));
      return std::nullopt;
    }
    std::string folders = "the world's folder";
    for (const std::string& folder : options_.model_path) folders += fmt::format(", `{}`", folder);
    Emit(DiagnosticKind::kIncludeMissing, uri,
         fmt::format("`{}` is not found in {} (nor in `models` there); it is left out", uri.GetText(), folders),
         "name the folder that holds it: plumb compile --model-path FOLDER");
    return std::nullopt;
  }

  // A link is one object; its collisions are what is solid, its visuals where there are none.
  void ReadLink(const XMLElement& link, const Isometry3d& T_world_model, const std::string& prefix) {
    const Isometry3d T = T_world_model * PoseOf(link);
    MeshObject object;
    const char* name = link.Attribute("name");
    object.name = prefix.empty() ? (name == nullptr ? "link" : name) : fmt::format("{}/{}", prefix, name == nullptr ? "link" : name);
    object.location.line = static_cast<uint32_t>(std::max(0, link.GetLineNum()));
    object.location.guid = object.name;
    object.location.type = "link";
    const char* part = link.FirstChildElement("collision") != nullptr ? "collision" : "visual";
    for (const XMLElement* e = link.FirstChildElement(part); e != nullptr; e = e->NextSiblingElement(part)) {
      const XMLElement* geometry = e->FirstChildElement("geometry");
      if (geometry == nullptr || ++shapes_ > kMaxShapes) continue;
      Solid solid = ShapeOf(*geometry);
      TransformSolid(Eigen::Affine3d(T * PoseOf(*e)), solid);
      AppendSolid(std::move(solid), object.solid);
    }
    if (!object.solid.empty()) scene.objects.push_back(std::move(object));
  }

  Solid ShapeOf(const XMLElement& geometry) {
    const XMLElement* e = geometry.FirstChildElement();
    if (e == nullptr) return {};
    const std::string_view kind = e->Name();
    if (kind == "box") return Box(*e);
    if (kind == "cylinder") {
      const auto r = Numbers(e->FirstChildElement("radius"), 1), l = Numbers(e->FirstChildElement("length"), 1);
      return r.empty() || l.empty() || r[0] <= 0 || l[0] <= 0 ? Solid() : MakeCylinder(r[0], l[0]);
    }
    if (kind == "sphere") {
      const auto r = Numbers(e->FirstChildElement("radius"), 1);
      return r.empty() || r[0] <= 0 ? Solid() : MakeSphere(r[0]);
    }
    if (kind == "plane") return Plane(*e);
    if (kind == "polyline") return Polyline(geometry);
    if (kind == "mesh") return Mesh(*e);
    if (kind != "empty") Emit(DiagnosticKind::kXmlUnsupported, *e, fmt::format("shapes of kind <{}> are not read; it is left out", kind));
    return {};
  }

  Solid Box(const XMLElement& e) {
    const auto size = Numbers(e.FirstChildElement("size"), 3);
    if (size.empty()) return {};
    const Vector3d half = 0.5 * Vector3d(size[0], size[1], size[2]).cwiseAbs();
    return half.minCoeff() > 0 ? MakeBox(-half, half) : Solid();
  }

  Solid Plane(const XMLElement& e) {
    const auto normal = Numbers(e.FirstChildElement("normal"), 3);
    auto size = Numbers(e.FirstChildElement("size"), 2);
    if (size.empty()) size = {kMaxPlane_m, kMaxPlane_m};
    const Vector3d n = normal.empty() ? Vector3d::UnitZ() : Vector3d(normal[0], normal[1], normal[2]);
    return n.norm() > 0 ? MakePlane(n.normalized(), {std::min(size[0], kMaxPlane_m), std::min(size[1], kMaxPlane_m)}) : Solid();
  }

  // All polylines of one geometry make one profile, its holes among them.
  Solid Polyline(const XMLElement& geometry) {
    Area area;
    double height_m = 0;
    size_t points = 0;
    for (const XMLElement* line = geometry.FirstChildElement("polyline"); line != nullptr; line = line->NextSiblingElement("polyline")) {
      if (const auto h = Numbers(line->FirstChildElement("height"), 1); !h.empty()) height_m = h[0];
      Ring2 ring;
      for (const XMLElement* p = line->FirstChildElement("point"); p != nullptr && ++points < kMaxPoints;
           p = p->NextSiblingElement("point")) {
        if (const auto v = Numbers(p, 2); !v.empty()) ring.emplace_back(v[0], v[1]);
      }
      DropRepeatedPoints(1e-6, ring);
      if (ring.size() >= 3) area.push_back(std::move(ring));
    }
    return area.empty() || !(height_m > 0) ? Solid() : Extrude(area, {0, 0, height_m});
  }

  // Gazebo takes a mesh's own axes: COLLADA turned z up, others as they are.
  Solid Mesh(const XMLElement& e) {
    const XMLElement* uri = e.FirstChildElement("uri");
    if (uri == nullptr || uri->GetText() == nullptr) return {};
    const std::optional<fs::path> path = Find(*uri);
    const std::optional<Source> source = path ? LoadSource(path->string(), sink_) : std::nullopt;
    if (!source) return {};
    if (!IsMesh(source->format)) {
      Emit(DiagnosticKind::kXmlUnsupported, e, fmt::format("`{}` is no mesh that is read; it is left out", uri->GetText()));
      return {};
    }
    const Expected<MeshScene> mesh = LoadMesh(*source, options_);
    if (!mesh) {
      Emit(DiagnosticKind::kXmlUnsupported, e, fmt::format("`{}` is not read: {}", uri->GetText(), mesh.error().message));
      return {};
    }
    Solid out;
    for (const MeshObject& o : mesh->objects) AppendSolid(o.solid, out);
    const auto scale = Numbers(e.FirstChildElement("scale"), 3);
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    if (!scale.empty()) T.linear() = Vector3d(scale[0], scale[1], scale[2]).asDiagonal();
    if (mesh->up == UpAxis::kY) T = T * Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX());
    const bool finite = std::all_of(out.vertices.begin(), out.vertices.end(),
                                    [](const Vector3d& v) { return v.allFinite() && v.cwiseAbs().maxCoeff() < kMaxLength_m; });
    if (!finite) {
      Emit(DiagnosticKind::kXmlBadValue, e, fmt::format("`{}` has coordinates that are no numbers; it is left out", uri->GetText()));
      return {};
    }
    TransformSolid(T * Eigen::Translation3d(mesh->origin), out);
    return out;
  }

  const MeshOptions& options_;
  DiagnosticSink& sink_;
  ModelFiles files_;
  fs::path folder_;             // of the document that is read
  std::vector<fs::path> open_;  // documents that include each other down to here
  size_t shapes_ = 0;
};

}  // namespace

std::optional<PlanIr> ReadSdf(const Source& source, DiagnosticSink& diagnostics, const MeshOptions& options) {
  if (const std::string problem = options.Check(); !problem.empty()) {
    diagnostics.Emit(DiagnosticKind::kInternalError, {}, problem);
    return std::nullopt;
  }
  WorldReader reader(source, options, diagnostics);
  if (!reader.ReadText(source.bytes, source.path, Isometry3d::Identity(), "", 0)) return std::nullopt;
  if (reader.scene.objects.empty()) {
    diagnostics.Emit(DiagnosticKind::kSdfWithoutShapes, {}, "no link of the world or model has a shape that could be read",
                     "give the folders of its models: plumb compile --model-path");
    return std::nullopt;
  }
  PlanIr plan = MakePlan(reader.scene, options, diagnostics);
  plan.source_path = source.path;
  plan.source_format = SchemaName(source.format);
  plan.source_sha256 = source.sha256;
  return plan;
}

}  // namespace plumb::compiler
