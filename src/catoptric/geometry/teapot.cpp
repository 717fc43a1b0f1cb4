// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/teapot.h"

#include <vector>

#include "catoptric/geometry/shapes.h"
#include "catoptric/geometry/teapot_data.h"

namespace catoptric::geometry {
namespace {

constexpr std::size_t kNewellPatches = 28;

/// A point inside the part of the teapot to which patch `i` belongs, near the middle of the patch: what its
/// normals must point away from. Body, lid and bottom surround the axis; handle and spout are tubes around a
/// curve that runs through the mean of their two halves.
dvec3 findInnerPoint(const std::vector<BicubicPatch>& patches, std::size_t i) {
  const dvec3 middle = evaluatePatch(patches[i], 0.5, 0.5).position;
  const bool isTube =
      i >= 12 && i < 20;  // pairs of halves: (12, 13), (14, 15) handle, (16, 17), (18, 19) spout
  if (isTube) return 0.5 * (middle + evaluatePatch(patches[i ^ 1], 0.5, 0.5).position);
  const double inside =
      i >= kNewellPatches ? 0.6 : -0.2;  // the bottom faces down, lid and body up or sideways
  return {0, 0, middle.z + inside};
}

std::vector<BicubicPatch> makePatches() {
  std::vector<BicubicPatch> patches;
  for (const auto& indices : kTeapotIndices) {
    BicubicPatch patch;
    for (std::size_t k = 0; k < 16; ++k) {
      const auto& p = kTeapotPoints[indices[k]];
      patch.control[k] = {p[0], p[1], p[2]};
    }
    patches.push_back(patch);
  }
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const PatchPoint middle = evaluatePatch(patches[i], 0.5, 0.5);
    if (glm::dot(middle.normal, middle.position - findInnerPoint(patches, i)) > 0) continue;
    const BicubicPatch turned = patches[i];
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t column = 0; column < 4; ++column)
        patches[i].control[4 * row + column] = turned.control[4 * row + 3 - column];
  }
  return patches;
}

/// In Newell's order: rim and body, handle, spout, lid; then the bottom.
TeapotPart partOf(std::size_t patch) {
  if (patch < 12 || patch >= kNewellPatches) return TeapotPart::Body;
  if (patch < 16) return TeapotPart::Handle;
  return patch < 20 ? TeapotPart::Spout : TeapotPart::Lid;
}

}  // namespace

std::span<const BicubicPatch> teapotPatches() {
  static const std::vector<BicubicPatch> patches = makePatches();
  return patches;
}

Mesh makeTeapot(const TeapotOptions& options) {
  Mesh all;
  const std::span<const BicubicPatch> patches = teapotPatches();
  const std::size_t count = options.withBottom ? patches.size() : kNewellPatches;
  for (std::size_t i = 0; i < count; ++i) {
    if (options.part != TeapotPart::All && options.part != partOf(i)) continue;
    append(all, tessellatePatch(patches[i], options.cellsPerPatch, options.cellsPerPatch));
  }
  constexpr double kTopOfKnob = 3.15;  // Newell's units
  const dmat4 yUpFromZUp = turnAround({1, 0, 0}, -0.5 * glm::pi<double>());
  const Mesh upright = transformed(all, scaleBy(dvec3(1.0 / kTopOfKnob)) * yUpFromZUp);
  return welded(upright, 1e-6, 0.02);
}

}  // namespace catoptric::geometry
