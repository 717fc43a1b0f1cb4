// SPDX-License-Identifier: Apache-2.0
// Draws the virtual object of one reflector: the tessellated scene with its vertices moved to where a method
// says that they are seen (1998, fig. 1 step 5). What is kept from frame to frame, so that a frame allocates
// nothing.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catoptric/raster/reflection_method.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/raster/virtual_triangles.h"

namespace catoptric::raster {

class VirtualObjectPass {
 public:
  /// `objects` must outlive the pass.
  explicit VirtualObjectPass(const TessellatedObjects& objects) : objects_(objects) {}
  /// The objects are others now.
  void objectsChanged() {
    streams_.reset();
    blendedStreams_.reset();
  }

  /// Arguments as of selectVirtualTriangles(); `view` says how virtual vertices get to the screen.
  void draw(FrameContext& frame, const SurfaceView& view, std::span<const vec3> virtualPositions,
            std::span<const VertexKind> kinds, std::span<const vec3> reflectionPoints,
            std::span<const vec3> scenePoints, Level& target);
  /// Draws triangles selected by the caller, with corners from objects.indices.
  void drawSelected(FrameContext& frame, const SurfaceView& view, std::span<const vec3> virtualPositions,
                    const VirtualTriangles& triangles, Level& target);

 private:
  const TessellatedObjects& objects_;
  std::unique_ptr<VertexStreams> streams_, blendedStreams_;  ///< made when first needed
  VirtualTriangles triangles_;
  std::vector<DrawRange> opaque_, blended_, sorted_;
  std::vector<std::uint32_t> sortedIndices_;
};

/// Cuts the view at a flat mirror that is seen in a curved one, whose middle tells which side of it is meant.
void clipAtLastMirror(const scene::Reflector& mirror, std::uint32_t index, const dvec3& mirrorBefore,
                      SurfaceView& view);

}  // namespace catoptric::raster
