#include "compiler/ir/plan_ir_json.h"

#include <nlohmann/json.hpp>

namespace plumb::compiler {
namespace {

using Json = nlohmann::ordered_json;

template <class Vector>
Json FromVector(const Vector& v) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < v.size(); ++i) out.push_back(v[i]);
  return out;
}

template <class Vector>
Vector ToVector(const Json& in) {
  Vector out;
  if (in.size() != static_cast<size_t>(out.size())) throw std::runtime_error("a vector has " + std::to_string(in.size()) + " components");
  for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = in.at(static_cast<size_t>(i)).get<typename Vector::Scalar>();
  return out;
}

// Writes `value` unless it is the default that Get() gives back.
template <class T>
void Put(Json& out, const char* key, const T& value, const T& fallback = {}) {
  if (value != fallback) out[key] = value;
}

template <class T>
T Get(const Json& in, const char* key, const T& fallback = {}) {
  return in.contains(key) ? in.at(key).get<T>() : fallback;
}

void PutOptional(Json& out, const char* key, const std::optional<double>& value) {
  if (value) out[key] = *value;
}

std::optional<double> GetOptional(const Json& in, const char* key) {
  return in.contains(key) ? std::optional<double>(in.at(key).get<double>()) : std::nullopt;
}

void PutLocation(Json& out, const SourceLocation& location) {
  Json entry = Json::object();
  Put(entry, "line", location.line);
  Put(entry, "step_id", location.step_id);
  Put(entry, "guid", location.guid);
  Put(entry, "type", location.type);
  if (!entry.empty()) out["location"] = std::move(entry);
}

SourceLocation GetLocation(const Json& in) {
  SourceLocation out;
  if (!in.contains("location")) return out;
  const Json& entry = in.at("location");
  out.line = Get<uint32_t>(entry, "line");
  out.step_id = Get<uint64_t>(entry, "step_id");
  out.guid = Get<std::string>(entry, "guid");
  out.type = Get<std::string>(entry, "type");
  return out;
}

void PutSolid(Json& out, const char* key, const Solid& solid) {
  if (solid.vertices.empty() && solid.triangles.empty()) return;
  Json entry;
  entry["vertices"] = Json::array();
  for (const auto& v : solid.vertices) entry["vertices"].push_back(FromVector(v));
  entry["triangles"] = Json::array();
  for (const auto& t : solid.triangles) entry["triangles"].push_back(FromVector(t));
  out[key] = std::move(entry);
}

Solid GetSolid(const Json& in, const char* key) {
  Solid out;
  if (!in.contains(key)) return out;
  for (const Json& v : in.at(key).at("vertices")) out.vertices.push_back(ToVector<Eigen::Vector3d>(v));
  for (const Json& t : in.at(key).at("triangles")) out.triangles.push_back(ToVector<Eigen::Vector3i>(t));
  return out;
}

Json FromElement(const PlanElement& e) {
  Json out = Json::object();
  Put(out, "kind", static_cast<int>(e.kind));
  Put(out, "material", static_cast<int>(e.material));
  Put(out, "guid", e.guid);
  Put(out, "name", e.name);
  Put(out, "type", e.type);
  PutLocation(out, e.location);
  Put(out, "storey", e.storey, kNoIndex);
  PutSolid(out, "body", e.body);
  PutSolid(out, "uncut", e.uncut);
  PutOptional(out, "thickness_m", e.thickness_m);
  if (e.axis) out["axis"] = Json::array({FromVector(e.axis->first), FromVector(e.axis->second)});
  for (const Arc& arc : e.arcs) {
    out["arcs"].push_back(
        {{"center", FromVector(arc.center)}, {"radius_m", arc.radius_m}, {"start_rad", arc.start_rad}, {"sweep_rad", arc.sweep_rad}});
  }
  Put(out, "external", e.external);
  for (const PlanLeaf& leaf : e.leaves) {
    out["leaves"].push_back({{"operation", static_cast<int>(leaf.operation)},
                             {"to_jamb", FromVector(leaf.to_jamb)},
                             {"opens_to", FromVector(leaf.opens_to)},
                             {"width_m", leaf.width_m}});
  }
  return out;
}

int GetEnum(const Json& in, const char* key, int last) {
  const int value = Get<int>(in, key);
  if (value < 0 || value > last) throw std::runtime_error(std::string("`") + key + "` is out of range");
  return value;
}

PlanElement ToElement(const Json& in) {
  PlanElement out;
  out.kind = static_cast<ElementKind>(GetEnum(in, "kind", static_cast<int>(ElementKind::kGround)));
  out.material = static_cast<Material>(GetEnum(in, "material", static_cast<int>(Material::kGlass)));
  out.guid = Get<std::string>(in, "guid");
  out.name = Get<std::string>(in, "name");
  out.type = Get<std::string>(in, "type");
  out.location = GetLocation(in);
  out.storey = Get<uint32_t>(in, "storey", kNoIndex);
  out.body = GetSolid(in, "body");
  out.uncut = GetSolid(in, "uncut");
  out.thickness_m = GetOptional(in, "thickness_m");
  if (in.contains("axis")) out.axis = {ToVector<Eigen::Vector2d>(in.at("axis").at(0)), ToVector<Eigen::Vector2d>(in.at("axis").at(1))};
  if (in.contains("arcs")) {
    for (const Json& arc : in.at("arcs")) {
      out.arcs.push_back({ToVector<Eigen::Vector2d>(arc.at("center")), arc.at("radius_m").get<double>(), arc.at("start_rad").get<double>(),
                          arc.at("sweep_rad").get<double>()});
    }
  }
  out.external = Get<bool>(in, "external");
  if (in.contains("leaves")) {
    for (const Json& leaf : in.at("leaves")) {
      out.leaves.push_back({static_cast<LeafOperation>(GetEnum(leaf, "operation", static_cast<int>(LeafOperation::kFixed))),
                            ToVector<Eigen::Vector2d>(leaf.at("to_jamb")), ToVector<Eigen::Vector2d>(leaf.at("opens_to")),
                            Get<double>(leaf, "width_m")});
    }
  }
  return out;
}

Json FromOpening(const PlanOpening& o) {
  Json out = Json::object();
  Put(out, "guid", o.guid);
  Put(out, "name", o.name);
  PutLocation(out, o.location);
  Put(out, "wall", o.wall, kNoIndex);
  Put(out, "filling", o.filling, kNoIndex);
  PutSolid(out, "body", o.body);
  PutOptional(out, "width_m", o.width_m);
  PutOptional(out, "height_m", o.height_m);
  return out;
}

PlanOpening ToOpening(const Json& in) {
  PlanOpening out;
  out.guid = Get<std::string>(in, "guid");
  out.name = Get<std::string>(in, "name");
  out.location = GetLocation(in);
  out.wall = Get<uint32_t>(in, "wall", kNoIndex);
  out.filling = Get<uint32_t>(in, "filling", kNoIndex);
  out.body = GetSolid(in, "body");
  out.width_m = GetOptional(in, "width_m");
  out.height_m = GetOptional(in, "height_m");
  return out;
}

Json FromStorey(const PlanStorey& s) {
  Json out = Json::object();
  Put(out, "guid", s.guid);
  Put(out, "name", s.name);
  PutLocation(out, s.location);
  out["elevation_m"] = s.elevation_m;
  return out;
}

Json FromSpace(const PlanSpace& s) {
  Json out = Json::object();
  Put(out, "guid", s.guid);
  Put(out, "name", s.name);
  Put(out, "long_name", s.long_name);
  PutLocation(out, s.location);
  Put(out, "storey", s.storey, kNoIndex);
  PutSolid(out, "body", s.body);
  return out;
}

PlanIr ToPlan(const Json& in) {
  PlanIr out;
  out.source_path = Get<std::string>(in, "source_path");
  out.source_format = Get<std::string>(in, "source_format");
  out.source_sha256 = Get<std::string>(in, "source_sha256");
  if (in.contains("true_north_rad")) out.true_north_rad = in.at("true_north_rad").get<double>();
  if (in.contains("origin")) out.origin = ToVector<Eigen::Vector3d>(in.at("origin"));
  for (const Json& s : in.at("storeys")) {
    out.storeys.push_back({Get<std::string>(s, "guid"), Get<std::string>(s, "name"), GetLocation(s), s.at("elevation_m").get<double>()});
  }
  for (const Json& e : in.at("elements")) out.elements.push_back(ToElement(e));
  for (const Json& o : in.at("openings")) out.openings.push_back(ToOpening(o));
  for (const Json& s : in.at("spaces")) {
    out.spaces.push_back({Get<std::string>(s, "guid"), Get<std::string>(s, "name"), Get<std::string>(s, "long_name"), GetLocation(s),
                          Get<uint32_t>(s, "storey", kNoIndex), GetSolid(s, "body")});
  }
  return out;
}

}  // namespace

std::string PlanIrToJson(const PlanIr& plan) {
  Json out;
  Put(out, "source_path", plan.source_path);
  Put(out, "source_format", plan.source_format);
  Put(out, "source_sha256", plan.source_sha256);
  if (!plan.origin.isZero(0)) out["origin"] = FromVector(plan.origin);
  if (plan.true_north_rad) out["true_north_rad"] = *plan.true_north_rad;
  for (const char* key : {"storeys", "elements", "openings", "spaces"}) out[key] = Json::array();
  for (const PlanStorey& s : plan.storeys) out["storeys"].push_back(FromStorey(s));
  for (const PlanElement& e : plan.elements) out["elements"].push_back(FromElement(e));
  for (const PlanOpening& o : plan.openings) out["openings"].push_back(FromOpening(o));
  for (const PlanSpace& s : plan.spaces) out["spaces"].push_back(FromSpace(s));
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Expected<PlanIr> PlanIrFromJson(const std::string& text) {
  try {
    return ToPlan(Json::parse(text));
  } catch (const std::exception& e) {
    return Fail(ErrorCode::kFileUnreadable, std::string("not a PlanIr in JSON: ") + e.what());
  }
}

}  // namespace plumb::compiler
