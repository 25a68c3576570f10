#include "timbre/cli/render/ray_scene.h"

#include <embree3/rtcore.h>

#include <limits>
#include <new>
#include <stdexcept>

namespace timbre::cli {
namespace {

// One thread builds the tree: no pool of threads stays behind, and the same triangles
// always give the same tree.
constexpr const char* kDeviceOptions = "threads=1";

[[noreturn]] void fail(RTCError code) {
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error("the ray caster failed with code " + std::to_string(code));
}

template <typename Element>
Element* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t stride,
                    std::size_t count) {
  void* const buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count);
  if (buffer == nullptr) throw std::bad_alloc();
  return static_cast<Element*>(buffer);
}

void attach(RTCScene scene, RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
}

// Geometries belong to the scene once attached; this gives back the maker's share.
struct ReleaseGeometry {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using OwnedGeometry = std::unique_ptr<RTCGeometryTy, ReleaseGeometry>;

void add_triangles(RTCDevice device, RTCScene scene, const Points& points, const Faces& faces) {
  const OwnedGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* const corners =
      new_buffer<float>(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                        3 * sizeof(float), static_cast<std::size_t>(points.rows()));
  Eigen::Map<Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>>(corners, points.rows(), 3) =
      points.cast<float>();
  auto* const indices =
      new_buffer<std::int32_t>(geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                               3 * sizeof(std::int32_t), static_cast<std::size_t>(faces.rows()));
  Eigen::Map<Faces>(indices, faces.rows(), 3) = faces;
  attach(scene, geometry.get());
}

void add_balls(RTCDevice device, RTCScene scene, const std::vector<Ball>& balls) {
  const OwnedGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT));
  auto* const to = new_buffer<float>(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                     4 * sizeof(float), balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    Eigen::Map<Eigen::Vector4f>(to + 4 * i) << balls[i].centre, balls[i].radius;
  }
  attach(scene, geometry.get());
}

void place(RTCRay& ray, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
           float far) {
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.tnear = 0.0F;
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.time = 0.0F;
  ray.tfar = far;
  ray.mask = ~0U;
  ray.id = 0;
  ray.flags = 0;
}

}  // namespace

struct RayScene::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayScene::RayScene(const Points& points, const Faces& faces, const std::vector<Ball>& balls)
    : impl_(std::make_unique<Impl>()) {
  impl_->device = rtcNewDevice(kDeviceOptions);
  if (impl_->device == nullptr) fail(rtcGetDeviceError(nullptr));
  impl_->scene = rtcNewScene(impl_->device);
  if (impl_->scene == nullptr) fail(rtcGetDeviceError(impl_->device));
  // Rays must not slip through between two triangles.
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  add_triangles(impl_->device, impl_->scene, points, faces);
  if (!balls.empty()) add_balls(impl_->device, impl_->scene, balls);
  rtcCommitScene(impl_->scene);
  const RTCError code = rtcGetDeviceError(impl_->device);
  if (code != RTC_ERROR_NONE) fail(code);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

RayHit RayScene::first_hit(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit cast{};
  place(cast.ray, origin, direction, std::numeric_limits<float>::infinity());
  cast.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &cast);
  RayHit hit;
  if (cast.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  (cast.hit.geomID == 0 ? hit.face : hit.ball) = static_cast<std::int32_t>(cast.hit.primID);
  hit.depth = cast.ray.tfar;
  hit.u = cast.hit.u;
  hit.v = cast.hit.v;
  return hit;
}

bool RayScene::is_blocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                          float far) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  place(ray, origin, direction, far);
  rtcOccluded1(impl_->scene, &context, &ray);
  return ray.tfar < 0.0F;
}

}  // namespace timbre::cli
