// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/virtual_object_pass.h"

namespace catoptric::raster {

void VirtualObjectPass::draw(FrameContext& frame, const SurfaceView& view,
                             std::span<const vec3> virtualPositions, std::span<const VertexKind> kinds,
                             std::span<const vec3> reflectionPoints, std::span<const vec3> scenePoints,
                             Level& target) {
  selectVirtualTriangles(objects_, view.drawEye, virtualPositions, kinds, reflectionPoints, triangles_,
                         scenePoints);
  frame.counters.virtualTriangles += triangles_.indices.size() / 3;
  drawSelected(frame, view, virtualPositions, triangles_, target);
}

void VirtualObjectPass::drawSelected(FrameContext& frame, const SurfaceView& view,
                                     std::span<const vec3> virtualPositions,
                                     const VirtualTriangles& triangles, Level& target) {
  opaque_.clear();
  blended_.clear();
  for (const TessellatedPart& part : triangles.parts)
    if (part.indexCount > 0)
      (frame.scene.isBlended(part.part) ? blended_ : opaque_)
          .push_back({part.part, part.firstIndex, part.indexCount});
  if (!opaque_.empty()) {
    if (!streams_) streams_ = std::make_unique<VertexStreams>(objects_);
    streams_->setDrawPositions(virtualPositions);
    streams_->setIndices(triangles.indices, true);
    sortNearFirst(frame.scene, frame.scene.geometry().reflectors[view.chain->last].centre, opaque_);
    frame.surfaces.draw(frame.scene, *streams_, opaque_, view, target);
  }
  if (blended_.empty()) return;
  if (!blendedStreams_) blendedStreams_ = std::make_unique<VertexStreams>(objects_);
  sortBlendedTriangles(blended_, triangles.indices, virtualPositions, view.drawEye, sortedIndices_, sorted_);
  blendedStreams_->setDrawPositions(virtualPositions);
  blendedStreams_->setIndices(sortedIndices_, true);
  frame.surfaces.drawBlended(frame.scene, *blendedStreams_, sorted_, view, target);
}

void clipAtLastMirror(const scene::Reflector& mirror, std::uint32_t index, const dvec3& mirrorBefore,
                      SurfaceView& view) {
  const double side = mirror.plane.signedDistance(mirrorBefore) > 0.0 ? 1.0 : -1.0;
  view.clip.add(vec4(vec3(side * mirror.plane.normal), float(side * mirror.plane.offset)));
  view.excludedReflector = index;
}

}  // namespace catoptric::raster
