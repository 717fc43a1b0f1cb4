// SPDX-License-Identifier: Apache-2.0
// One tile of the picture, all its paths at once: intersect them all, shade them all, follow the mirrors,
// again.
#pragma once

#include <cstdint>
#include <vector>

#include "catoptric/reference/embree_scene.h"
#include "catoptric/reference/ray_tracer.h"
#include "catoptric/reference/surface_shading.h"

namespace catoptric::reference {

inline constexpr int kTileEdgePx = 16;
inline constexpr int kMaxBlendLayers = 64;  ///< the next one counts as opaque

/// What all tiles of a picture share.
struct TracedScene {
  const scene::WorldGeometry& geometry;
  const scene::Environment& environment;
  const SurfaceShader& shader;
  const EmbreeScene& embree;
};

/// Not thread-safe: one per thread of work.
class TileTracer {
 public:
  TileTracer(const TracedScene& scene, const scene::CameraFrame& camera, const TraceOptions& options,
             TraceResult& result);

  /// Fills the tile whose top left pixel is (x0, y0).
  void traceTile(int x0, int y0);
  [[nodiscard]] std::uint64_t rays() const { return rays_; }
  /// Spent on what goes on from mirrors and through glass: intersecting and shading.
  [[nodiscard]] double reflectionSeconds() const { return reflectionSeconds_; }

 private:
  struct Path {
    Ray ray;
    float tNear;
    std::uint32_t ignoredTriangle, ignoredPart, passedTriangle;
    std::uint32_t firstReflector;
    std::uint32_t medium;                  // the refractor inside which the ray goes
    int x, y, bounces, crossings, layers;  // bounces: crossings of refractors' surfaces included
    vec3 throughput;
    double length;  // of the legs before this ray
  };
  enum class Purpose { Radiance, Seen, Both };

  void clearTile(int x0, int y0);
  void startPaths(int x0, int y0, const dvec2& samplePosition);
  [[nodiscard]] Path startPath(int x, int y, const dvec3& direction) const;
  void tracePaths(Purpose purpose);
  /// Intersects and shades what the paths meet next, and keeps those that go on.
  void traceRays(Purpose purpose);
  /// True while the path goes on.
  bool follow(Path& path, const TraceAnswer& answer, Purpose purpose);
  void finishInSky(const Path& path, Purpose purpose);
  bool passBlended(Path& path, const TraceAnswer& answer, const Hit& hit, Purpose purpose);
  bool followMirror(Path& path, const Hit& hit, const ShadingNormal& normal, const Shaded& shaded,
                    Purpose purpose);
  void recordSeen(const Path& path, const Hit& hit);
  void addRadiance(const Path& path, const vec3& radiance);

  const TracedScene& scene_;
  const scene::CameraFrame& camera_;
  const TraceOptions& options_;
  TraceResult& result_;
  const float sampleWeight_;
  const dvec3 directionDx_, directionDy_;  // change of the camera's ray direction per pixel
  std::vector<ivec2> pixelOrder_;          // of a tile
  std::vector<Path> paths_;
  std::vector<TraceRequest> requests_;
  std::vector<TraceAnswer> answers_;
  std::uint64_t rays_ = 0;
  double reflectionSeconds_ = 0;
};

}  // namespace catoptric::reference
