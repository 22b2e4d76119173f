#include "slam/sensor/ray_caster.hpp"

#include <algorithm>

#include <Eigen/Geometry>
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

void check_mesh(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!mesh.vertices[i].allFinite())
      throw Error(fmt::format("vertex {} of the model is not finite", i));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i])
      if (vertex >= mesh.vertices.size())
        throw Error(fmt::format("triangle {} of the model uses vertex {} of {}", i, vertex,
                                mesh.vertices.size()));
}

template <typename Element>
void* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Element), count);
  if (!buffer) throw Error("not enough memory for ray casting", ErrorKind::environment);
  return buffer;
}

}  // namespace

struct RayCaster::Scene {
  // One thread builds the tree: with several its shape, and so which of two triangles wins at their
  // common edge, would depend on timing.
  RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
  RTCScene scene = nullptr;

  Scene() {
    if (!device) throw Error("ray casting does not start (Embree)", ErrorKind::environment);
    scene = rtcNewScene(device);
  }
  ~Scene() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
};

RayCaster::RayCaster(const TriangleMesh& mesh) : scene_(std::make_unique<Scene>()) {
  check_mesh(mesh);
  // Without this a ray may slip through the edge between two triangles.
  rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
  if (!mesh.triangles.empty()) {
    RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcAttachGeometry(scene_->scene, geometry);
    rtcReleaseGeometry(geometry);
    std::copy(mesh.vertices.begin(), mesh.vertices.end(),
              static_cast<Eigen::Vector3f*>(new_buffer<Eigen::Vector3f>(
                  geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices.size())));
    using Triangle = std::array<std::uint32_t, 3>;
    std::copy(mesh.triangles.begin(), mesh.triangles.end(),
              static_cast<Triangle*>(new_buffer<Triangle>(
                  geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles.size())));
    rtcCommitGeometry(geometry);
  }
  rtcCommitScene(scene_->scene);
  if (rtcGetDeviceError(scene_->device) != RTC_ERROR_NONE)
    throw Error("ray casting cannot take the model (Embree)", ErrorKind::environment);
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

std::optional<RayHit> RayCaster::cast(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction, double max_distance) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  const Eigen::Vector3f from = origin.cast<float>();
  const Eigen::Vector3f along = direction.cast<float>();
  query.ray.org_x = from.x();
  query.ray.org_y = from.y();
  query.ray.org_z = from.z();
  query.ray.dir_x = along.x();
  query.ray.dir_y = along.y();
  query.ray.dir_z = along.z();
  query.ray.tfar = static_cast<float>(max_distance);
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Eigen::Vector3f normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
  return RayHit{static_cast<double>(query.ray.tfar), query.hit.primID, normal.normalized()};
}

}  // namespace planum
