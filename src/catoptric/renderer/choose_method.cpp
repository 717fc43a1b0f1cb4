// SPDX-License-Identifier: Apache-2.0
// What `auto` picks for a mirror, and why (docs/decisions.md, "What auto picks").
//
//   1. Flat: mirrored, exact at every pixel. A refractor: solver exact, the only one that knows Snell's law.
//   2. A mirror of a few pixels: an environment map, where nothing moves. No error there is wider than the
//      mirror.
//   3. Convex: refined. One reflection point for every scene point, so that the error is the tessellation's,
//      which --max-error bounds.
//   4. Else: exact. The forecast (view_forecast.h) says how much of the mirror virtual objects would show
//      right.
#include <fmt/format.h>

#include <algorithm>

#include "catoptric/geometry/nearest_hit.h"
#include "catoptric/renderer/frame.h"
#include "catoptric/virtual_object/analytic_finder.h"
#include "catoptric/virtual_object/mixed/view_forecast.h"

namespace catoptric::renderer {
namespace {

MethodChoice chooseByShape(const scene::Reflector& reflector) {
  if (reflector.isRefractor())
    return {.solver = Solver::Exact,
            .reason = "light goes through: each pixel's refracted ray meets the real triangles"};
  if (reflector.shape == scene::ReflectorShape::Plane)
    return {.solver = Solver::Auto, .reason = "flat: the scene is mirrored, exact at every pixel"};
  if (reflector.isConvex)
    return {.solver = Solver::Refined, .reason = "convex: one reflection point for every scene point"};
  return {.solver = Solver::Exact,
          .reason =
              "not convex: a point may have several reflections, each pixel's ray meets the real triangles"};
}

geometry::TriangleHierarchy makeHierarchy(const scene::WorldGeometry& world) {
  std::vector<geometry::HierarchyTriangle> triangles;
  triangles.reserve(world.triangleCount());
  for (std::uint32_t t = 0; t < world.triangleCount(); ++t) {
    const std::uint32_t part = world.triangleParts[t];
    const std::uint32_t* v = &world.indices[3 * std::size_t(t)];
    triangles.push_back({world.positions[v[0]], world.positions[v[1]], world.positions[v[2]], t, part,
                         world.parts[part].isSeenFromBehind ? geometry::kTwoSided : 0u});
  }
  return geometry::TriangleHierarchy(triangles);
}

/// Sums over the parts, weighted by pixels.
ViewForecast addUp(std::span<const virtual_object::PartForecast> parts) {
  ViewForecast sum;
  sum.parts = parts.size();
  for (const virtual_object::PartForecast& part : parts) {
    sum.pixels += part.pixels;
    sum.oneToOne += part.pixels * part.oneToOne;
    sum.nearFocus += part.pixels * part.nearFocus;
    sum.self += part.pixels * part.self;
  }
  if (sum.pixels > 0)
    for (double* share : {&sum.oneToOne, &sum.nearFocus, &sum.self}) *share /= sum.pixels;
  return sum;
}

std::string describe(const ViewForecast& f) {
  return fmt::format(
      "; virtual objects, one for each of its {} parts, would show about {:.0f} % of what is seen in it, "
      "{:.0f} % lies near "
      "a focus and {:.0f} % is the mirror itself",
      f.parts, 100 * f.oneToOne, 100 * f.nearFocus, 100 * f.self);
}

}  // namespace

MethodChoice Renderer::chooseMethod(const scene::Reflector& reflector) {
  MethodChoice choice = chooseByShape(reflector);
  choice.analytic = virtual_object::findAnalyticObstacle(reflector);
  return choice;
}

MethodChooser::MethodChooser(const scene::WorldGeometry& geometry)
    : geometry_(geometry), hierarchy_(makeHierarchy(geometry)) {}

MethodChoice MethodChooser::choose(std::uint32_t reflector, const scene::CameraFrame& camera) const {
  const scene::Reflector& mirror = geometry_.reflectors[reflector];
  MethodChoice choice = Renderer::chooseMethod(mirror);
  if (mirror.isPlanarMirror() || mirror.isRefractor()) return choice;
  virtual_object::ReflectorMesh mesh(geometry_, reflector);
  const virtual_object::CutMirror cut = virtual_object::cutIntoParts(mesh);
  std::vector<const virtual_object::MirrorPart*> parts;
  for (const virtual_object::MirrorPart& part : cut.parts) parts.push_back(&part);
  const double pixelsPerTangent = 0.5 * camera.heightPx / camera.tanHalfFovY;
  choice.forecast = addUp(virtual_object::forecastView(
      parts, {hierarchy_, geometry_.triangleParts, mirror.part}, camera.eye, pixelsPerTangent));
  const ViewForecast& forecast = *choice.forecast;
  if (forecast.pixels > 0 && forecast.pixels < kFewPixels) {
    choice.method = Method::Environment;
    choice.solver = Solver::Auto;
    choice.reason = fmt::format("it covers about {:.0f} pixels, fewer than {}, and nothing has moved",
                                forecast.pixels, kFewPixels);
  } else if (!mirror.isConvex && forecast.pixels > 0) {
    choice.reason += describe(forecast);
  }
  return choice;
}

}  // namespace catoptric::renderer
