// SPDX-License-Identifier: Apache-2.0
// Virtual triangles that are drawn as numbers: which triangle of the scene is seen at each mirror pixel.
//
// In:  virtual vertices of the tessellated scene, and which triangles are worth drawing.
// Out: HitShading's image of hits, and the rectangles of pixels in which each part is seen.
// Steps:
//   1. Once: a mesh whose triangles' last corners carry the number of the triangle, of the world or of a
//      level of detail, that each was cut from. Most vertices can serve one triangle; where none of a
//      triangle's corners is free, one is doubled.
//   2. Each frame: triangles dropped that no pixel's centre lies in (most of them, where they are smaller
//      than pixels: a rasterizer would take ten times as long to find out); virtual vertices copied to their
//      doubles, numbers drawn with depth
//   (virtual_triangle.frag).
//   3. The image of numbers is read back and cut into small rectangles by part.
// Why: virtual triangles are small, often smaller than a pixel, and shading them costs four pixels each at
// least. A number costs next to nothing; shading is then done once a pixel, by the pixel's own ray against
// the real triangle (hit_shading.h), so that tessellation only has to get the triangles' edges right.
// gl_PrimitiveID would need no doubles, but GLSL ES 3.00 has none.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "catoptric/raster/tessellation.h"
#include "catoptric/raster/virtual_triangles.h"
#include "catoptric/virtual_object/culling.h"
#include "catoptric/virtual_object/hit_shading.h"

namespace catoptric::virtual_object {

/// Step 1.
struct NumberedMesh {
  std::vector<std::uint32_t> indices;   ///< parallel to TessellatedObjects::indices, each triangle turned
  std::vector<std::uint32_t> vertices;  ///< of TessellatedObjects: the original ones, then doubles
  std::vector<std::uint32_t> numbers;   ///< of the triangles that end in the vertex; kNoId: none
};
[[nodiscard]] NumberedMesh makeNumberedMesh(const raster::TessellatedObjects& objects);

/// How virtual vertices get to the pixels of a picture.
struct PictureView {
  mat4 clipFromDraw{1.0f};
  int widthPx = 0, heightPx = 0;
  bool windingFlipped = false;  ///< fronts turn clockwise
};

/// Virtual vertices: pixels and 1 / w; NaN where they do not lie before the eye, and those of runs that have
/// no bit in `mayReflect` (VertexRuns::findReflected(); may be empty for all ones).
void projectVertices(const PictureView& view, std::span<const vec3> virtualPositions,
                     std::vector<vec3>& screen, std::span<const VertexBits> mayReflect = {});

/// Clears `isKept` of triangles in which no pixel of `bounds` has its centre, and of those that turn their
/// back to the eye (where their part has none). How many there were. `screen`: projectVertices().
std::size_t dropUnseenTriangles(const raster::TessellatedObjects& objects, const scene::WorldGeometry& world,
                                const PictureView& view, const gl::Scissor& bounds,
                                std::span<const vec3> screen, std::span<std::uint8_t> isKept);

class NumberedTriangles {
 public:
  explicit NumberedTriangles(const raster::TessellatedObjects& objects);
  /// For selectVirtualTriangles().
  [[nodiscard]] std::span<const std::uint32_t> indices() const { return mesh_.indices; }

  /// Step 2, into the bound target of hits, with the program of virtual_triangle.frag: the runs of `ranges`,
  /// which lie in `triangles`.
  void draw(const raster::FrameContext& frame, const raster::SurfaceView& view, gl::Program& program,
            std::span<const vec3> virtualPositions, std::span<const std::uint32_t> triangles,
            std::span<const raster::DrawRange> ranges);

 private:
  NumberedMesh mesh_;
  gl::Buffer positions_, numbers_, indices_;
  gl::VertexArray array_;
  std::vector<vec3> drawPositions_;
};

}  // namespace catoptric::virtual_object
