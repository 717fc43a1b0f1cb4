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
  /// Do the scene's vertices and triangles, those of levels of detail included, fit into textures of this GL?
  [[nodiscard]] static bool fits(const scene::WorldGeometry& world);
  /// With those of SceneBuffers::levels(), if there are any by now. Throws core::Error("gl.texture_size") for
  /// a scene that does not fit.
  explicit SceneTriangles(const raster::SceneBuffers& scene);
  /// After vertices of these parts have moved, or turned their winding.
  void update(const raster::SceneBuffers& scene, std::span<const std::uint32_t> movedParts);

  [[nodiscard]] const gl::Texture& triangles() const { return *triangles_; }
  [[nodiscard]] const gl::Texture& vertices() const { return *vertices_; }

  /// What the textures hold.
  [[nodiscard]] std::span<const uvec4> triangleTexels() const { return triangleTexels_; }
  [[nodiscard]] std::span<const vec4> vertexTexels() const { return vertexTexels_; }

  /// The levels that are among them, null if none are.
  [[nodiscard]] const raster::LevelsOfDetail* levels() const { return levels_; }
  /// Bits of VertexAttribute.
  [[nodiscard]] unsigned attributes(std::uint32_t part) const { return attributes_[part]; }

 private:
  void writeTriangles(const raster::SceneBuffers& scene);
  void writeVertices(const scene::WorldGeometry& world, const scene::Part& part);

  const raster::LevelsOfDetail* levels_;
  std::vector<unsigned> attributes_;  ///< by part
  std::vector<uvec4> triangleTexels_;
  std::vector<vec4> vertexTexels_;
  std::unique_ptr<gl::Texture> triangles_, vertices_;
};

}  // namespace catoptric::virtual_object
