// SPDX-License-Identifier: Apache-2.0
// The scene's triangles where shaders that meet them with rays need them: in textures, for GLSL ES 3.00
// (layout: shaders/virtual_object/exact_point.glsl).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "catoptric/gl/texture.h"
#include "catoptric/raster/scene_buffers.h"

namespace catoptric::virtual_object {

/// geometry::HierarchyTriangle::flags of solver `exact`; those that are not single-sided are
/// geometry::kTwoSided.
enum CoverFlag : std::uint32_t { kCoverMasked = 2, kCoverBlended = 4, kCoverSingleSided = 8 };

/// Of the triangles of a part.
[[nodiscard]] std::uint32_t findCoverFlags(const raster::SceneBuffers& scene, std::uint32_t part);

/// What else than position, normal, tangent and texture coordinates the vertices of a part have; numbered to
/// go with SceneBuffers::textureBits().
enum VertexAttribute : unsigned { kWithColors = 32, kWithSecondUv = 64 };

class SceneTriangles {
 public:
  /// Do the scene's vertices and triangles fit into textures of this GL?
  [[nodiscard]] static bool fits(const scene::WorldGeometry& world);
  /// Throws core::Error("gl.texture_size") for a scene that does not fit.
  explicit SceneTriangles(const raster::SceneBuffers& scene);

  [[nodiscard]] const gl::Texture& triangles() const { return *triangles_; }
  [[nodiscard]] const gl::Texture& vertices() const { return *vertices_; }

  /// Bits of VertexAttribute.
  [[nodiscard]] unsigned attributes(std::uint32_t part) const { return attributes_[part]; }

 private:
  std::vector<unsigned> attributes_;  ///< by part
  std::unique_ptr<gl::Texture> triangles_, vertices_;
};

}  // namespace catoptric::virtual_object
