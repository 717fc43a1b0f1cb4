// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/layered_finder.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "catoptric/core/parallel.h"

namespace catoptric::virtual_object {

LayeredFinder::LayeredFinder(const ReflectorMesh& mesh, int layers, int mapResolution)
    : mesh_(&mesh), layers_(std::size_t(layers)), scratch_(std::size_t(layers)) {
  assert(layers >= 2);
  for (ExplosionMap& map : layers_)
    map.ids = core::Image<std::uint32_t>(mapResolution, mapResolution, core::kNoId);
}

/// Step 1.
void LayeredFinder::setEye(const EyeView& view) {
  const auto steps = double(layers_.size() - 1);
  inverseNear_ = 1.0 / view.nearRadius;
  const double inverseFar = 1.0 / view.farRadius;
  layersPerInverse_ = steps / (inverseFar - inverseNear_);
  core::parallelFor(layers_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double share = double(i) / steps;
      const double radius = 1.0 / ((1.0 - share) * inverseNear_ + share * inverseFar);
      fillExplosionMap(*mesh_, view.eye, radius, *view.rays, scratch_[i], layers_[i]);
    }
  });
}

std::optional<FoundPoint> LayeredFinder::find(const dvec3& scenePoint) const {
  // 2
  const dvec3 fromCentre = scenePoint - layers_[0].centre;
  const double distance = glm::length(fromCentre);
  if (!(distance > 0)) return std::nullopt;
  const dvec2 coords = computeMapCoords(layers_[0].frame, fromCentre * (1.0 / distance));
  const double last = double(layers_.size() - 1);
  const double layer = formulas::mapLayerOf(distance, inverseNear_, layersPerInverse_, last);
  const std::size_t lower = std::min(std::size_t(layer), layers_.size() - 2);
  const double share = layer - double(lower);
  // 3
  const MapAnswer inner = lookUpMap(*mesh_, layers_[lower], coords),
                  outer = lookUpMap(*mesh_, layers_[lower + 1], coords);
  const MirrorTriangle &a = mesh_->triangles()[inner.at.triangle], &b = mesh_->triangles()[outer.at.triangle];
  const MapAnswer& heavier = share < 0.5 ? inner : outer;
  FoundPoint found;
  found.position = glm::mix(a.position(inner.at.u, inner.at.v), b.position(outer.at.u, outer.at.v), share);
  found.normal = glm::normalize(glm::mix(glm::normalize(a.normal(inner.at.u, inner.at.v)),
                                         glm::normalize(b.normal(outer.at.u, outer.at.v)), share));
  found.at = heavier.at;
  found.isPastBoundary = heavier.isExtension;
  return found;
}

}  // namespace catoptric::virtual_object
