// SPDX-License-Identifier: Apache-2.0
#include "catoptric/renderer/choose_method.h"

#include <fmt/format.h>

#include <algorithm>

#include "catoptric/raster/tessellation.h"
#include "catoptric/renderer/expected_cost.h"
#include "catoptric/renderer/expected_error.h"
#include "catoptric/virtual_object/analytic_finder.h"

namespace catoptric::renderer {
namespace {

constexpr std::size_t kSamples = 400;
/// Of --max-error: the 95th percentile that refined is measured to have (virtual_object/README.md).
constexpr double kRefinedShare = 0.05;
constexpr double kVerticesPerTriangle = 0.7;  // of a tessellation, measured
constexpr double kWorthIt = 0.8, kMargin = 0.8;

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

/// Sums over the parts, weighted by pixels.
ViewForecast addUp(std::span<const virtual_object::PartForecast> parts) {
  ViewForecast sum;
  sum.parts = parts.size();
  for (const virtual_object::PartForecast& part : parts) {
    sum.pixels += part.pixels;
    sum.oneToOne += part.pixels * part.oneToOne();
    sum.nearFocus += part.pixels * part.nearFocus;
    sum.self += part.pixels * part.self;
  }
  if (sum.pixels > 0)
    for (double* share : {&sum.oneToOne, &sum.nearFocus, &sum.self}) *share /= sum.pixels;
  return sum;
}

std::string describe(const MethodCandidate& picked, std::span<const MethodCandidate> candidates,
                     double maxErrorPx) {
  const bool isCheapest = std::all_of(candidates.begin(), candidates.end(),
                                      [&](const MethodCandidate& c) { return c.ms >= picked.ms; });
  return fmt::format("of the ways below it is the cheapest{} is within --max-error {:.3g}",
                     isCheapest ? " and its expected error" : " whose expected error", maxErrorPx);
}

}  // namespace

MethodChoice Renderer::chooseMethod(const scene::Reflector& reflector) {
  MethodChoice choice = chooseByShape(reflector);
  choice.analytic = virtual_object::findAnalyticObstacle(reflector);
  return choice;
}

/// What depends on a mirror alone, and on the side of it that is seen.
struct MethodChooser::Mirror {
  Mirror(const scene::WorldGeometry& world, std::uint32_t index, bool isFromBehind)
      : reflector(index),
        mesh(world, index, {.flipped = isFromBehind}),
        cut(virtual_object::cutIntoParts(mesh)) {}
  std::uint32_t reflector;
  virtual_object::ReflectorMesh mesh;
  virtual_object::CutMirror cut;
  std::map<std::pair<double, double>, double>
      triangles;  ///< by size on the screen, bound: of the tessellation
};

MethodChooser::MethodChooser(const scene::WorldGeometry& geometry,
                             const geometry::TriangleHierarchy& triangles)
    : geometry_(geometry), triangles_(triangles) {}
MethodChooser::~MethodChooser() = default;

MethodChooser::Mirror& MethodChooser::findMirror(std::uint32_t reflector, const dvec3& eye) {
  const bool isFromBehind = virtual_object::isSeenFromBehind(geometry_, reflector, eye);
  std::unique_ptr<Mirror>& mirror = mirrors_[{reflector, isFromBehind}];
  if (!mirror) mirror = std::make_unique<Mirror>(geometry_, reflector, isFromBehind);
  return *mirror;
}

double MethodChooser::findTriangles(Mirror& mirror, const scene::CameraFrame& camera,
                                    const ChoiceOptions& options) const {
  const double size =
      raster::findTessellationSize(geometry_.reflectors[mirror.reflector], camera.eye, camera);
  const auto [entry, isNew] = mirror.triangles.try_emplace({size, options.maxErrorPx}, 0);
  if (isNew) {
    const std::vector<std::uint8_t> byRays(geometry_.parts.size(), 1);
    entry->second = double(raster::estimateTriangles(geometry_, mirror.reflector,
                                                     {.maxErrorPx = std::min(options.maxErrorPx, kCoarsestPx),
                                                      .reflectorDiameterPx = size,
                                                      .isSeenDirectly = true,
                                                      .shadedByRays = byRays,
                                                      .levels = options.levels}));
  }
  return entry->second;
}

/// Which parts virtual objects would show, as VirtualObjectMethod::forecastParts() does.
ViewForecast MethodChooser::forecastParts(Mirror& mirror, const scene::CameraFrame& camera,
                                          const ChoiceOptions& options, const virtual_object::SceneRays& rays,
                                          MirrorLoad& load) const {
  std::vector<const virtual_object::MirrorPart*> parts;
  for (const virtual_object::MirrorPart& part : mirror.cut.parts) parts.push_back(&part);
  const double pixelsPerTangent = 0.5 * camera.heightPx / camera.tanHalfFovY;
  const auto forecasts = virtual_object::forecastView(parts, rays, camera.eye, pixelsPerTangent);
  ViewForecast sum = addUp(forecasts);
  const bool anySuits =
      std::any_of(forecasts.begin(), forecasts.end(),
                  [](const virtual_object::PartForecast& f) { return f.suitsVirtualObjects(); });
  if (anySuits) load.triangles = findTriangles(mirror, camera, options);
  const auto vertices = std::size_t(kVerticesPerTriangle * load.triangles);
  const auto isChosen = virtual_object::chooseParts(parts, forecasts, vertices, false);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (isChosen[k] == 0) continue;
    load.partsMs += virtual_object::expectCosts(forecasts[k], parts[k]->bend, vertices).virtualMs;
    load.virtualShare += forecasts[k].pixels * forecasts[k].oneToOne() / sum.pixels;
  }
  return sum;
}

/// Step 3.
void MethodChooser::addCandidates(Mirror& mirror, const scene::CameraFrame& camera,
                                  const ChoiceOptions& options, MethodChoice& choice) const {
  const scene::Reflector& reflector = geometry_.reflectors[mirror.reflector];
  const virtual_object::SceneRays rays{triangles_, geometry_.triangleParts, reflector.part};
  const auto samples = virtual_object::sampleMirror(mirror.mesh, rays, camera, kSamples);
  MirrorLoad load = measureLoad(mirror.mesh, rays, geometry_, camera.eye, samples);
  // Before its triangles are counted, which takes long where a scene has many.
  const bool mayRefine =
      mirror.mesh.isConvex() && (!options.isForFrame || expectRefinedMs(load) < expectExactMs(load));
  if (!options.isForFrame || mayRefine) load.triangles = findTriangles(mirror, camera, options);
  ViewForecast forecast = forecastParts(mirror, camera, options, rays, load);
  forecast.pixels = load.pixels, forecast.offered = load.offered, forecast.triangles = load.triangles;
  choice.forecast = forecast;
  if (samples.empty()) return;
  const environment_map::MapView map(geometry_, triangles_, mirror.reflector, options.boxCorrected);
  const MapError error = expectMapError(
      {geometry_, mirror.reflector, mirror.mesh, rays, map, camera, options.mapTexels, options.bounces},
      samples, options.isForFrame ? options.maxErrorPx : kLostPx);
  choice.candidates.push_back(
      {Method::Environment, Solver::Auto, error.worstPx(), error.isAtLeast, expectMapMs(load)});
  if (mayRefine)
    choice.candidates.push_back({Method::Virtual, Solver::Refined,
                                 kRefinedShare * std::min(options.maxErrorPx, kCoarsestPx), false,
                                 expectRefinedMs(load)});
  else if (load.virtualShare > 0)
    choice.candidates.push_back({Method::Virtual, Solver::Refined, 0, false, expectPartsMs(load)});
  choice.candidates.push_back({Method::Virtual, Solver::Exact, 0, false, expectExactMs(load)});
}

MethodChoice MethodChooser::choose(std::uint32_t reflector, const scene::CameraFrame& camera,
                                   const ChoiceOptions& options, const MethodChoice* last) {
  const scene::Reflector& mirror = geometry_.reflectors[reflector];
  MethodChoice choice = Renderer::chooseMethod(mirror);
  // 1
  if (mirror.isPlanarMirror() || mirror.isRefractor()) return choice;
  addCandidates(findMirror(reflector, camera.eye), camera, options, choice);
  const double pixels = choice.forecast->pixels;
  if (choice.candidates.empty()) {
    choice.reason += "; this camera does not see it";
  } else if (!options.isForFrame && pixels < kFewPixels) {  // 2
    choice.method = Method::Environment;
    choice.solver = Solver::Auto;
    choice.reason = fmt::format("it covers about {:.0f} pixels, fewer than {}, and nothing has moved", pixels,
                                kFewPixels);
  } else {  // 4
    const MethodCandidate& picked =
        choice.candidates[pickCandidate(choice.candidates, options.maxErrorPx, last)];
    choice.method = picked.method;
    choice.solver = picked.solver;
    choice.reason = describe(picked, choice.candidates, options.maxErrorPx);
  }
  return choice;
}

std::size_t pickCandidate(std::span<const MethodCandidate> candidates, double maxErrorPx,
                          const MethodChoice* last) {
  const auto findCheapest = [&](double bound) {
    std::size_t best = candidates.size();
    for (std::size_t i = 0; i < candidates.size(); ++i)
      if (candidates[i].errorPx <= bound && !candidates[i].isErrorAtLeast &&
          (best == candidates.size() || candidates[i].ms < candidates[best].ms))
        best = i;
    return best;
  };
  const auto kept = std::find_if(candidates.begin(), candidates.end(), [&](const MethodCandidate& c) {
    return last && c.method == last->method && c.solver == last->solver && c.errorPx <= maxErrorPx &&
           !c.isErrorAtLeast;
  });
  if (kept == candidates.end()) return findCheapest(maxErrorPx);
  const std::size_t better = findCheapest(kMargin * maxErrorPx);
  const auto index = std::size_t(kept - candidates.begin());
  return better < candidates.size() && candidates[better].ms < kWorthIt * kept->ms ? better : index;
}

}  // namespace catoptric::renderer
