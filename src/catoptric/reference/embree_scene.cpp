// SPDX-License-Identifier: Apache-2.0
#include "catoptric/reference/embree_scene.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "catoptric/core/error.h"
#include "catoptric/core/log.h"
#include "catoptric/core/parallel.h"

namespace catoptric::reference {
namespace {

enum Attribute : std::uint8_t { kSingleSided = 1, kMasked = 2 };

/// One Embree geometry: Embree's primitive number to ours.
struct TriangleSet {
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint8_t> attributes;
};

constexpr float kLargestCoordinate = 1e15f;

bool isUsable(const vec3& p) {
  return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate &&
         std::abs(p.z) <= kLargestCoordinate;  // false for NaN
}

bool isUsable(const TraceRequest& request) {
  const vec3 d(request.ray->direction);
  const float square = glm::dot(d, d);
  return isUsable(vec3(request.ray->origin)) && square > 0.5f && square < 2.0f &&
         std::isfinite(request.tNear);
}

struct QueryContext {
  RTCIntersectContext embree;  // first: Embree hands its address back
  const TraceRequest* requests;
  const scene::WorldGeometry* geometry;
  const SurfaceShader* shader;
};

bool isRejected(const QueryContext& query, const TriangleSet& set, const TraceRequest& request,
                unsigned primitive, float facing, float t, float u, float v) {
  const std::uint8_t attributes = set.attributes[primitive];
  if ((attributes & kSingleSided) != 0 && facing > 0) return true;
  const std::uint32_t triangle = set.triangles[primitive];
  if (triangle == request.ignoredTriangle || triangle == request.passedTriangle) return true;
  if (request.ignoredPart != core::kNoId && query.geometry->triangleParts[triangle] == request.ignoredPart)
    return true;
  // Blended layers at one distance are passed in the order of their numbers.
  if (request.passedTriangle != core::kNoId && t <= request.tNear && triangle < request.passedTriangle)
    return true;
  if ((attributes & kMasked) != 0)
    return !query.shader->passesAlphaMask(query.shader->computeHit(*request.ray, triangle, dvec2(u, v)));
  return false;
}

void filterHits(const RTCFilterFunctionNArguments* args) {
  const auto& query = *reinterpret_cast<const QueryContext*>(args->context);
  const auto& set = *static_cast<const TriangleSet*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    const TraceRequest& request = query.requests[RTCRayN_id(args->ray, args->N, i)];
    const float facing = RTCHitN_Ng_x(args->hit, args->N, i) * RTCRayN_dir_x(args->ray, args->N, i) +
                         RTCHitN_Ng_y(args->hit, args->N, i) * RTCRayN_dir_y(args->ray, args->N, i) +
                         RTCHitN_Ng_z(args->hit, args->N, i) * RTCRayN_dir_z(args->ray, args->N, i);
    if (isRejected(query, set, request, RTCHitN_primID(args->hit, args->N, i), facing,
                   RTCRayN_tfar(args->ray, args->N, i), RTCHitN_u(args->hit, args->N, i),
                   RTCHitN_v(args->hit, args->N, i)))
      args->valid[i] = 0;
  }
}

template <class Packet>
void fillLane(Packet& packet, unsigned lane, const TraceRequest& request, unsigned id) {
  const vec3 origin(request.ray->origin), direction(request.ray->direction);
  packet.ray.org_x[lane] = origin.x;
  packet.ray.org_y[lane] = origin.y;
  packet.ray.org_z[lane] = origin.z;
  packet.ray.dir_x[lane] = direction.x;
  packet.ray.dir_y[lane] = direction.y;
  packet.ray.dir_z[lane] = direction.z;
  packet.ray.tnear[lane] = request.tNear;
  packet.ray.tfar[lane] = std::numeric_limits<float>::infinity();
  packet.ray.time[lane] = 0;
  packet.ray.mask[lane] = 0xffffffffu;
  packet.ray.id[lane] = id;
  packet.ray.flags[lane] = 0;
  packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
  packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
}

void checkDevice(RTCDevice device, const char* what) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  const bool outOfMemory = error == RTC_ERROR_OUT_OF_MEMORY;
  throw core::Error(outOfMemory ? "embree.out_of_memory" : "embree.failed",
                    fmt::format("Embree failed while {} (error {})", what, int(error)), {},
                    outOfMemory ? "the scene is too large for this machine's memory" : "");
}

}  // namespace

struct EmbreeScene::Impl {
  const scene::WorldGeometry& geometry;
  const SurfaceShader& shader;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::array<TriangleSet, 2> sets;  // without and with the filter; the index is Embree's geometry number
  int packetWidth = 8;

  Impl(const scene::WorldGeometry& world, const SurfaceShader& shading) : geometry(world), shader(shading) {}
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
  void sortTriangles();
  void attach(unsigned id, RTCBuffer positions);

  /// The batch in packets of kWidth, each answered by `query(valid, packet)`.
  template <class Packet, unsigned kWidth, class Query>
  void intersectPackets(std::span<const TraceRequest> requests, std::span<TraceAnswer> answers,
                        const Query& query) const;
  template <class Packet>
  TraceAnswer readLane(const Packet& packet, unsigned lane) const {
    const unsigned id = packet.hit.geomID[lane];
    if (id == RTC_INVALID_GEOMETRY_ID) return {};
    return {sets[id].triangles[packet.hit.primID[lane]], packet.ray.tfar[lane], packet.hit.u[lane],
            packet.hit.v[lane]};
  }
};

void EmbreeScene::Impl::sortTriangles() {
  std::uint64_t leftOut = 0;
  for (const scene::Part& part : geometry.parts) {
    const scene::Material& material = shader.materialOf(part);
    const bool masked = material.alphaMode == scene::AlphaMode::Mask;
    const bool plain = material.isSeenFromBehind() && material.alphaMode == scene::AlphaMode::Opaque;
    TriangleSet& set = sets[plain && part.reflector == core::kNoId ? 0 : 1];
    const auto attributes =
        std::uint8_t((material.isSeenFromBehind() ? 0 : kSingleSided) | (masked ? kMasked : 0));
    for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3) {
      bool usable = true;
      for (int k = 0; k < 3; ++k) usable = usable && isUsable(geometry.positions[geometry.indices[i + k]]);
      if (!usable) {
        ++leftOut;
        continue;
      }
      set.triangles.push_back(i / 3);
      set.attributes.push_back(attributes);
    }
  }
  if (leftOut > 0)
    core::logWarningOnce(fmt::format("ray tracer: {} triangles with non-finite vertices left out", leftOut));
}

void EmbreeScene::Impl::attach(unsigned id, RTCBuffer positions) {
  const TriangleSet& set = sets[id];
  if (set.triangles.empty()) return;
  RTCGeometry embree = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuffer(embree, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions, 0, sizeof(vec3),
                       geometry.positions.size());
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      embree, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3), set.triangles.size()));
  if (indices != nullptr)
    for (std::size_t i = 0; i < set.triangles.size(); ++i)
      std::memcpy(indices + 3 * i, geometry.indices.data() + 3 * std::size_t(set.triangles[i]),
                  sizeof(uvec3));
  rtcSetGeometryMask(embree, 0xffffffffu);
  rtcSetGeometryBuildQuality(embree, RTC_BUILD_QUALITY_HIGH);
  if (id == 1) {
    rtcSetGeometryUserData(embree, const_cast<TriangleSet*>(&set));
    rtcSetGeometryIntersectFilterFunction(embree, filterHits);
  }
  rtcCommitGeometry(embree);
  rtcAttachGeometryByID(scene, embree, id);
  rtcReleaseGeometry(embree);
  checkDevice(device, "taking the triangles");
}

EmbreeScene::EmbreeScene(const scene::WorldGeometry& geometry, const SurfaceShader& shader, int packetWidth)
    : impl_(std::make_unique<Impl>(geometry, shader)) {
  Impl& impl = *impl_;
  impl.sortTriangles();
  impl.device = rtcNewDevice(nullptr);
  if (impl.device == nullptr)
    throw core::Error("embree.device",
                      fmt::format("Embree cannot be started (error {})", int(rtcGetDeviceError(nullptr))));
  const bool hasPackets8 = rtcGetDeviceProperty(impl.device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0;
  impl.packetWidth = packetWidth != 0 ? packetWidth : (hasPackets8 ? 8 : 4);
  impl.scene = rtcNewScene(impl.device);
  rtcSetSceneBuildQuality(impl.scene, RTC_BUILD_QUALITY_HIGH);
  rtcSetSceneFlags(impl.scene, RTC_SCENE_FLAG_ROBUST);  // no gaps between neighbouring triangles
  if (!geometry.positions.empty()) {
    // A copy, because Embree reads 16 bytes at each vertex and the shared array ends after 12. Unusable
    // vertices belong to no triangle here, but must not be seen either.
    RTCBuffer buffer = rtcNewBuffer(impl.device, geometry.positions.size() * sizeof(vec3) + 16);
    checkDevice(impl.device, "allocating vertices");
    auto* positions = static_cast<vec3*>(rtcGetBufferData(buffer));
    for (std::size_t i = 0; i < geometry.positions.size(); ++i)
      positions[i] = isUsable(geometry.positions[i]) ? geometry.positions[i] : vec3(0);
    for (unsigned id = 0; id < 2; ++id) impl.attach(id, buffer);
    rtcReleaseBuffer(buffer);
  }
  rtcCommitScene(impl.scene);
  checkDevice(impl.device, "building the hierarchy");
}

EmbreeScene::~EmbreeScene() = default;

template <class Packet, unsigned kWidth, class Query>
void EmbreeScene::Impl::intersectPackets(std::span<const TraceRequest> requests,
                                         std::span<TraceAnswer> answers, const Query& query) const {
  const auto count = static_cast<unsigned>(requests.size());
  for (unsigned first = 0; first < count; first += kWidth) {
    Packet packet;
    alignas(64) int valid[kWidth];
    for (unsigned lane = 0; lane < kWidth; ++lane) {
      const unsigned i = std::min(first + lane, count - 1);
      valid[lane] = first + lane < count && isUsable(requests[i]) ? -1 : 0;
      fillLane(packet, lane, requests[i], i);
    }
    query(valid, packet);
    for (unsigned lane = 0; lane < kWidth && first + lane < count; ++lane)
      answers[first + lane] = valid[lane] != 0 ? readLane(packet, lane) : TraceAnswer{};
  }
}

void EmbreeScene::intersect(std::span<const TraceRequest> requests, std::span<TraceAnswer> answers) const {
  const Impl& impl = *impl_;
  QueryContext context{};
  rtcInitIntersectContext(&context.embree);
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.requests = requests.data();
  context.geometry = &impl.geometry;
  context.shader = &impl.shader;
  if (impl.packetWidth == 8)
    impl.intersectPackets<RTCRayHit8, 8>(requests, answers, [&](const int* valid, RTCRayHit8& packet) {
      rtcIntersect8(valid, impl.scene, &context.embree, &packet);
    });
  else
    impl.intersectPackets<RTCRayHit4, 4>(requests, answers, [&](const int* valid, RTCRayHit4& packet) {
      rtcIntersect4(valid, impl.scene, &context.embree, &packet);
    });
}

std::string EmbreeScene::describe() const {
  const auto version = rtcGetDeviceProperty(impl_->device, RTC_DEVICE_PROPERTY_VERSION);
  return fmt::format("Embree {}.{}.{} (Debian build, asserts on), packets of {}, {} threads", version / 10000,
                     version / 100 % 100, version % 100, impl_->packetWidth, core::threadCount());
}

}  // namespace catoptric::reference
