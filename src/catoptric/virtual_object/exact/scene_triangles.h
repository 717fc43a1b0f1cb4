// SPDX-License-Identifier: Apache-2.0
// The scene's triangles where solver `exact` needs them: in textures for its shaders (layout:
// shaders/virtual_object/exact_point.glsl), in a hierarchy for culling.
#pragma once

#include <memory>

#include "catoptric/geometry/triangle_hierarchy.h"
#include "catoptric/gl/texture.h"
#include "catoptric/raster/scene_buffers.h"

namespace catoptric::virtual_object {

class SceneTriangles {
 public:
  /// Throws core::Error("gl.texture_size") for a scene that does not fit into a texture.
  explicit SceneTriangles(const raster::SceneBuffers& scene);

  [[nodiscard]] const geometry::TriangleHierarchy& hierarchy() const { return hierarchy_; }
  [[nodiscard]] const gl::Texture& triangles() const { return *triangles_; }
  [[nodiscard]] const gl::Texture& vertices() const { return *vertices_; }

 private:
  geometry::TriangleHierarchy hierarchy_;
  std::unique_ptr<gl::Texture> triangles_, vertices_;
};

}  // namespace catoptric::virtual_object
