// SPDX-License-Identifier: Apache-2.0
#include "drawing.h"

#include <cmath>
#include <limits>

#include "catoptric/core/error.h"
#include "catoptric/core/parallel.h"
#include "catoptric/core/tone_map.h"
#include "catoptric/geometry/nearest_hit.h"
#include "catoptric/scene/hierarchy_triangles.h"

namespace catoptric::app {
namespace {

constexpr float kFading = 0.45f;

/// How far each pixel's ray goes: mirrors hide what is behind them, whatever they show.
sketch::DistanceImage traceDistances(const scene::WorldGeometry& world, const scene::CameraFrame& camera) {
  const geometry::TriangleHierarchy hierarchy(scene::listTriangles(world));
  sketch::DistanceImage distances(camera.widthPx, camera.heightPx, std::numeric_limits<float>::infinity());
  core::parallelFor(std::size_t(camera.heightPx), 8, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < camera.widthPx; ++x) {
        const dvec3 direction = glm::normalize(camera.rayDirection(x + 0.5, y + 0.5));
        if (const auto hit = geometry::findNearestHit(hierarchy, camera.eye, direction))
          distances.at(x, y) = float(hit->distance);
      }
  });
  return distances;
}

/// To the right of the line from the eye to the middle, and above it.
scene::Camera makeThirdEye(const Drawing& drawing, const dvec3& middle) {
  scene::Camera third;
  const dvec3 up = glm::normalize(drawing.camera.up), towards = middle - drawing.camera.eye;
  const dvec3 right = glm::normalize(glm::cross(towards, up));
  third.eye =
      drawing.options.from.value_or(middle - 0.5 * towards + glm::length(towards) * (1.1 * right + 0.9 * up));
  third.target = drawing.options.at.value_or(middle - 0.35 * towards);
  third.up =
      std::abs(glm::dot(glm::normalize(third.target - third.eye), up)) < 0.999 ? up : glm::normalize(towards);
  third.fovYRadians = glm::radians(drawing.options.fromFovDegrees);
  return third;
}

}  // namespace

const std::vector<DrawingKind>& drawingKinds() {
  static const std::string picture = "--samples --exposure --environment ";
  static const std::string aside = picture + "--from --at --from-fov ";
  static const std::vector<DrawingKind> kKinds{
      {"explosion-maps", "near, far and hidden map of a curved mirror", drawExplosionMaps, {}},
      {"subdivision", "the cells of its reflection subdivision, in a plane through the eye", drawSubdivision,
       "--count --point --width"},
      {"mapping", "how a reflected ray gets its place in an explosion map", drawMapping, "--width"},
      {"near-look-up", "what the near map says of a point", drawNearLookUp, "--point --width"},
      {"look-up", "what both maps say of a point, and their blend", drawLookUp, "--point --width"},
      {"cell", "a reflected and a hidden cell, from aside", drawCell, aside + "--point --width"},
      {"virtual-object", "virtual triangles, from aside", drawVirtualObject,
       aside + "--object --max-error --count --point"},
      {"camera-rays", "the rays of a camera over its mirrors", drawCameraRays, aside + "--count --bounces"},
      {"sampling-cell", "what the corners of a sampling cell know of a point", drawSamplingCell,
       aside + "--spacing --point"},
      {"ray-octree", "the ray octree of a sampling location", drawRayOctree, aside + "--spacing --point"},
      {"reflection-mesh", "the triangles that morphing draws, over its picture", drawReflectionMesh,
       picture + "--bounces --max-error --spacing"},
      {"reflection-cell", "the texels of an environment map", drawReflectionCell,
       aside + "--count --width --point"},
      {"mapped-rays", "what an environment map shows, and what it should", drawMappedRays,
       aside + "--count --point"},
      {"zexels", "zexels of a flat mirror, where they are in space", drawZexels,
       aside + "--count --bounces --zexel"},
      {"exposures", "mirror pixels that no zexel reached", drawExposures,
       picture + "--bounces --max-error --zexel"}};
  return kKinds;
}

std::uint32_t findReflector(const Drawing& drawing, bool flat) {
  const auto& reflectors = drawing.world().reflectors;
  for (std::uint32_t i = 0; i < reflectors.size(); ++i)
    if (reflectors[i].isPlanarMirror() == flat && !reflectors[i].isRefractor()) return i;
  throw core::Error("draw.no_reflector",
                    "'" + drawing.loaded.source + "' has no " + (flat ? "flat" : "curved") +
                        " mirror, which --show " + drawing.options.what + " needs",
                    {}, "catoptric info says what mirrors there are; --reflector picks one");
}

core::ImageRgba8 drawFromAside(Drawing& drawing, const sketch::Sketch& sketch, const dvec3& middle) {
  renderer::FrameOptions options = drawing.frame;
  options.method = renderer::Method::None;
  options.widthPx *= 2, options.heightPx *= 2;
  options.withSeen = false;
  const scene::Camera third = makeThirdEye(drawing, middle);
  const scene::CameraFrame camera = scene::makeCameraFrame(third, options.widthPx, options.heightPx);
  core::ImageRgba8 picture =
      core::toneMap(drawing.renderer.render(third, options).radiance, drawing.exposure);
  sketch::fade(picture, kFading);
  sketch::DistanceImage distances = traceDistances(drawing.world(), camera);
  sketch::Sketch whole = sketch;
  whole.addEye(drawing.viewer(), 0.12 * glm::length(middle - drawing.camera.eye));
  for (sketch::Line& line : whole.lines) line.widthPx *= 2;
  for (sketch::Dot& dot : whole.dots) dot.radiusPx *= 2;
  sketch::drawSketch(whole, camera, picture, distances);
  return sketch::halve(picture);
}

core::ImageRgba8 drawOverView(Drawing& drawing, const sketch::Sketch& sketch, renderer::Method method,
                              float fading) {
  renderer::FrameOptions options = drawing.frame;
  options.method = method;
  options.withSeen = false;
  core::ImageRgba8 picture =
      core::toneMap(drawing.renderer.render(drawing.camera, options).radiance, drawing.exposure);
  sketch::fade(picture, fading);
  sketch::DistanceImage distances(picture.width(), picture.height(), std::numeric_limits<float>::infinity());
  sketch::drawSketch(sketch, drawing.viewer(), picture, distances);
  return picture;
}

}  // namespace catoptric::app
