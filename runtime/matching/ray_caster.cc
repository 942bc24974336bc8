#include "runtime/matching/ray_caster.h"

#include <embree3/rtcore.h>

#include <limits>

namespace plumb::runtime {

struct RayCaster::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<uint32_t> triangle_of_primitive;

  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayCaster::RayCaster(const Mesh& mesh, const std::vector<bool>& keep) {
  const auto impl = std::make_shared<Impl>();
  impl_ = impl;
  // One thread builds: the tree, and so the order of equal hits, must not depend on the machine.
  impl->device = rtcNewDevice("threads=1,set_affinity=0");
  impl->scene = rtcNewScene(impl->device);
  rtcSetSceneFlags(impl->scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT));
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (keep.empty() || keep[i]) impl->triangle_of_primitive.push_back(i);
  }
  RTCGeometry geometry = rtcNewGeometry(impl->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices.size()));
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) vertices[3 * i + k] = mesh.vertices[i][k];
  }
  auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(uint32_t), impl->triangle_of_primitive.size()));
  for (size_t i = 0; i < impl->triangle_of_primitive.size(); ++i) {
    const Triangle& t = mesh.triangles[impl->triangle_of_primitive[i]];
    indices[3 * i] = t.a;
    indices[3 * i + 1] = t.b;
    indices[3 * i + 2] = t.c;
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(impl->scene);
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

RayCaster RayCaster::Mirrored() const {
  RayCaster out(impl_);
  out.mirrored_ = !mirrored_;
  return out;
}

RayHit RayCaster::Cast(const Ray& ray) const {
  const float x = mirrored_ ? -1.0f : 1.0f;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray.org_x = x * ray.origin.x();
  query.ray.org_y = ray.origin.y();
  query.ray.org_z = ray.origin.z();
  query.ray.dir_x = x * ray.direction.x();
  query.ray.dir_y = ray.direction.y();
  query.ray.dir_z = ray.direction.z();
  query.ray.tnear = 0.0f;
  query.ray.tfar = ray.max_range_m;
  query.ray.mask = 0xffffffffu;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  RayHit hit;
  hit.range_m = query.ray.tfar;
  hit.triangle = impl_->triangle_of_primitive[query.hit.primID];
  hit.normal = Eigen::Vector3f(x * query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
  if (hit.normal.dot(ray.direction) > 0) hit.normal = -hit.normal;
  return hit;
}

void RayCaster::Cast(std::span<const Ray> rays, std::span<RayHit> hits) const {
  for (size_t i = 0; i < rays.size(); ++i) hits[i] = Cast(rays[i]);
}

}  // namespace plumb::runtime
