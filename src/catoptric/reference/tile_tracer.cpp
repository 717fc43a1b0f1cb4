// SPDX-License-Identifier: Apache-2.0
#include "catoptric/reference/tile_tracer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "catoptric/core/sample_pattern.h"

namespace catoptric::reference {
namespace {

/// Where a mirrored ray may begin to hit: the rounding of its origin to float, with some room. The triangle
/// it starts on is ignored anyway; this is for its neighbours.
float originTolerance(const dvec3& position) {
  return float(1e-6 * std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)}));
}

PerPixel<vec3> toFloat(const PerPixel<dvec3>& change) {
  return {vec3(change.dx), vec3(change.dy)};
}

/// The mirrored ray; the mirror law at the interpolated normal, normal-mapped unless it is a coat's.
Ray mirrorRay(const Ray& ray, const Hit& hit, const ShadingNormal& normal) {
  Ray mirrored;
  mirrored.origin = hit.position;
  mirrored.direction = glm::normalize(core::reflectDirection(ray.direction, normal.mirror));
  const PerPixel<dvec3>& change = ray.differential.direction;
  mirrored.differential.origin = hit.positionChange;
  mirrored.differential.direction = {
      reflectDerivative(ray.direction, change.dx, normal.mirror, normal.change.dx),
      reflectDerivative(ray.direction, change.dy, normal.mirror, normal.change.dy)};
  return mirrored;
}

/// The refracted ray, or the mirrored one where reflection is total; `isTotal` says which.
Ray refractRay(const Ray& ray, const Hit& hit, const ShadingNormal& normal, double ior, bool& isTotal) {
  const double eta = hit.isFront ? 1.0 / ior : ior;
  const auto direction = core::findRefractedDirection(ray.direction, normal.normal, eta);
  isTotal = !direction;
  if (isTotal) return mirrorRay(ray, hit, normal);
  Ray refracted;
  refracted.origin = hit.position;
  refracted.direction = glm::normalize(*direction);
  const PerPixel<dvec3>& change = ray.differential.direction;
  refracted.differential.origin = hit.positionChange;
  refracted.differential.direction = {
      refractDerivative(ray.direction, change.dx, normal.normal, normal.change.dx, eta),
      refractDerivative(ray.direction, change.dy, normal.normal, normal.change.dy, eta)};
  return refracted;
}

/// Column and row of the i-th pixel of a tile along a Z-curve: neighbours in a packet are neighbours in the
/// picture.
ivec2 alongZCurve(int i) {
  ivec2 p(0);
  for (int bit = 0; (1 << bit) < kTileEdgePx; ++bit) {
    p.x |= (i >> (2 * bit) & 1) << bit;
    p.y |= (i >> (2 * bit + 1) & 1) << bit;
  }
  return p;
}

}  // namespace

TileTracer::TileTracer(const TracedScene& scene, const scene::CameraFrame& camera,
                       const TraceOptions& options, TraceResult& result)
    : scene_(scene),
      camera_(camera),
      options_(options),
      result_(result),
      sampleWeight_(1.0f / float(std::max(options.samples, 1))),
      directionDx_(camera.rayDirectionDx()),
      directionDy_(camera.rayDirectionDy()) {
  constexpr int kPaths = kTileEdgePx * kTileEdgePx;
  paths_.reserve(kPaths);
  requests_.resize(kPaths);
  answers_.resize(kPaths);
  for (int i = 0; i < kPaths; ++i) pixelOrder_.push_back(alongZCurve(i));
}

TileTracer::Path TileTracer::startPath(int x, int y, const dvec3& direction) const {
  constexpr std::uint32_t kNone = core::kNoId;
  const double inverseLength = 1.0 / glm::length(direction);
  Path path;
  path.ray.origin = camera_.eye;
  path.ray.direction = direction * inverseLength;
  path.ray.differential.origin = {dvec3(0), dvec3(0)};
  path.ray.differential.direction = {
      differentiateNormalized(path.ray.direction, inverseLength, directionDx_),
      differentiateNormalized(path.ray.direction, inverseLength, directionDy_)};
  path.tNear = 0;
  path.ignoredTriangle = path.ignoredPart = path.passedTriangle = path.firstReflector = kNone;
  path.x = x;
  path.y = y;
  path.bounces = path.crossings = path.layers = 0;
  path.medium = kNone;
  path.throughput = vec3(1);
  path.length = 0;
  return path;
}

void TileTracer::startPaths(int x0, int y0, const dvec2& samplePosition) {
  paths_.clear();
  for (const ivec2& offset : pixelOrder_) {
    const int x = x0 + offset.x, y = y0 + offset.y;
    if (x < camera_.widthPx && y < camera_.heightPx)
      paths_.push_back(startPath(x, y, camera_.rayDirection(x + samplePosition.x, y + samplePosition.y)));
  }
}

void TileTracer::clearTile(int x0, int y0) {
  const int x1 = std::min(x0 + kTileEdgePx, camera_.widthPx),
            y1 = std::min(y0 + kTileEdgePx, camera_.heightPx);
  for (int y = y0; y < y1; ++y)
    std::fill(&result_.radiance.at(x0, y), &result_.radiance.at(x0, y) + (x1 - x0), vec4(0, 0, 0, 1));
}

void TileTracer::traceTile(int x0, int y0) {
  const int samples = std::max(options_.samples, 1);
  clearTile(x0, y0);
  for (int sample = 0; sample < samples; ++sample) {
    startPaths(x0, y0, core::samplePosition(sample, samples));
    tracePaths(samples == 1 ? Purpose::Both : Purpose::Radiance);
  }
  if (samples > 1 && (options_.withSeen || options_.withFootprints)) {
    startPaths(x0, y0, core::samplePosition(0, 1));
    tracePaths(Purpose::Seen);
  }
}

void TileTracer::tracePaths(Purpose purpose) {
  const auto isOfEye = [](const Path& path) { return path.bounces == 0; };
  do traceRays(purpose);
  while (std::any_of(paths_.begin(), paths_.end(), isOfEye));  // rays of the eye behind blended surfaces
  if (paths_.empty()) return;
  const auto start = std::chrono::steady_clock::now();
  while (!paths_.empty()) traceRays(purpose);
  reflectionSeconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void TileTracer::traceRays(Purpose purpose) {
  const std::size_t count = paths_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Path& path = paths_[i];
    requests_[i] = {&path.ray, path.tNear, path.ignoredTriangle, path.ignoredPart, path.passedTriangle};
  }
  scene_.embree.intersect({requests_.data(), count}, {answers_.data(), count});
  rays_ += count;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (follow(paths_[i], answers_[i], purpose)) {
      if (kept != i) paths_[kept] = paths_[i];
      ++kept;
    }
  paths_.resize(kept);
}

bool TileTracer::follow(Path& path, const TraceAnswer& answer, Purpose purpose) {
  if (answer.triangle == core::kNoId) {
    finishInSky(path, purpose);
    return false;
  }
  const Hit hit = scene_.shader.computeHit(path.ray, answer.triangle, dvec2(answer.u, answer.v));
  const scene::Part& part = scene_.geometry.parts[hit.part];
  const bool isMirror = part.reflector != core::kNoId;
  const bool isBlended = !isMirror && scene_.shader.materialOf(part).alphaMode == scene::AlphaMode::Blend;
  if (isBlended && path.layers < kMaxBlendLayers) return passBlended(path, answer, hit, purpose);

  if (path.medium != core::kNoId)
    path.throughput *=
        scene::glsl::absorbLight(scene_.geometry.reflectors[path.medium].absorption, float(hit.t));
  const bool wantsRadiance = purpose != Purpose::Seen;
  ShadingNormal normal;
  if (isMirror || wantsRadiance) normal = scene_.shader.computeNormal(hit);
  Shaded shaded;
  if (wantsRadiance) {
    shaded = scene_.shader.shade(path.ray, hit, normal);
    addRadiance(path, shaded.radiance);
  }
  if (isMirror) return followMirror(path, hit, normal, shaded, purpose);
  if (purpose != Purpose::Radiance) recordSeen(path, hit);
  return false;
}

void TileTracer::finishInSky(const Path& path, Purpose purpose) {
  if (purpose != Purpose::Seen)
    addRadiance(path, sampleEnvironment(scene_.environment, vec3(path.ray.direction),
                                        toFloat(path.ray.differential.direction)));
  if (purpose == Purpose::Radiance) return;
  if (options_.withSeen) {
    core::SeenPixel& seen = result_.seen.at(path.x, path.y);
    seen = {};
    seen.point = vec3(path.ray.direction);
    seen.firstReflector = path.firstReflector;
    seen.bounces = std::uint32_t(path.bounces);
    seen.pathLength = std::numeric_limits<float>::infinity();
  }
  if (options_.withFootprints)
    result_.footprints.at(path.x, path.y) = {vec3(path.ray.differential.direction.dx),
                                             vec3(path.ray.differential.direction.dy)};
}

/// Adds the layer and lets the same ray go on behind it.
bool TileTracer::passBlended(Path& path, const TraceAnswer& answer, const Hit& hit, Purpose purpose) {
  if (purpose != Purpose::Seen) {
    const Shaded shaded = scene_.shader.shade(path.ray, hit, scene_.shader.computeNormal(hit));
    const float alpha = std::clamp(shaded.alpha, 0.0f, 1.0f);
    addRadiance(path, shaded.radiance * alpha);
    path.throughput *= 1.0f - alpha;
  }
  path.tNear = answer.t;
  path.passedTriangle = answer.triangle;
  ++path.layers;
  return true;
}

bool TileTracer::followMirror(Path& path, const Hit& hit, const ShadingNormal& normal, const Shaded& shaded,
                              Purpose purpose) {
  const scene::Part& part = scene_.geometry.parts[hit.part];
  if (path.firstReflector == core::kNoId) path.firstReflector = part.reflector;
  const scene::Reflector& reflector = scene_.geometry.reflectors[part.reflector];
  bool isTotal = false;
  const Ray mirrored = reflector.isRefractor() ? refractRay(path.ray, hit, normal, reflector.ior, isTotal)
                                               : mirrorRay(path.ray, hit, normal);
  const bool isLast = reflector.isRefractor() ? path.crossings >= scene::kMostCrossings
                                              : path.bounces - path.crossings >= options_.bounces;
  if (isLast) {  // it shows the environment
    if (purpose != Purpose::Seen) {
      const vec3 shown = sampleEnvironment(scene_.environment, vec3(mirrored.direction),
                                           toFloat(mirrored.differential.direction));
      addRadiance(path, shaded.mirrorWeight * shown);
    }
    if (purpose != Purpose::Radiance) recordSeen(path, hit);
    return false;
  }
  path.throughput *= shaded.mirrorWeight;
  path.length += hit.t;
  path.ray = mirrored;
  path.tNear = originTolerance(hit.position);
  path.ignoredTriangle = hit.triangle;
  // A ray that leaves the front of a convex mirror never meets it again; but interpolated normals can send a
  // grazing one slightly below its own facet, where it would hit the neighbours from inside. The smooth
  // surface has no such hits.
  const bool leavesForGood = reflector.shape == scene::ReflectorShape::Plane ||
                             (reflector.isConvex && !reflector.isRefractor() && hit.isFront);
  path.ignoredPart = leavesForGood ? hit.part : core::kNoId;
  path.passedTriangle = core::kNoId;
  if (reflector.isRefractor()) ++path.crossings;
  if (reflector.isRefractor()) path.medium = hit.isFront != isTotal ? part.reflector : core::kNoId;
  ++path.bounces;
  return true;
}

void TileTracer::recordSeen(const Path& path, const Hit& hit) {
  if (options_.withSeen) {
    const scene::Part& part = scene_.geometry.parts[hit.part];
    core::SeenPixel& seen = result_.seen.at(path.x, path.y);
    seen.point = vec3(hit.position);
    seen.object = part.object;
    seen.triangle = hit.triangle;
    seen.firstReflector = path.firstReflector;
    seen.bounces = std::uint32_t(path.bounces);
    seen.shell = part.shell ? 1 : 0;
    seen.pathLength = float(path.length + hit.t);
  }
  if (options_.withFootprints)
    result_.footprints.at(path.x, path.y) = {vec3(hit.positionChange.dx), vec3(hit.positionChange.dy)};
}

void TileTracer::addRadiance(const Path& path, const vec3& radiance) {
  result_.radiance.at(path.x, path.y) += vec4(path.throughput * radiance * sampleWeight_, 0.0f);
}

}  // namespace catoptric::reference
