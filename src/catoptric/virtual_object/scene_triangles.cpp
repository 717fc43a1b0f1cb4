// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/scene_triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "catoptric/core/error.h"
#include "catoptric/geometry/nearest_hit.h"

namespace catoptric::virtual_object {
namespace {

constexpr std::size_t kVertexTexels = 5;

constexpr int kTableWidth = 2048;  // shaders/virtual_object/exact_ray.glsl

ivec2 findTableSize(std::size_t texels) {
  const std::size_t height = std::max<std::size_t>(1, (texels + kTableWidth - 1) / kTableWidth);
  return {kTableWidth, int(std::min<std::size_t>(height, std::numeric_limits<int>::max()))};
}

/// Filled up with zeros.
template <class Texel>
std::unique_ptr<gl::Texture> makeTable(gl::Format format, std::vector<Texel>& texels) {
  const ivec2 size = findTableSize(texels.size());
  if (size.y > gl::maxTextureSize())
    throw core::Error("gl.texture_size",
                      fmt::format("the scene's triangles need a texture of {}x{}, this GL takes {} at most",
                                  size.x, size.y, gl::maxTextureSize()),
                      {}, "use --solver refined");
  texels.resize(std::size_t(size.x) * std::size_t(size.y));
  auto texture =
      std::make_unique<gl::Texture>(gl::TextureKind::Flat, format, size.x, size.y, 1, 1, gl::SamplerState{});
  texture->upload(0, 0, texels.data());
  return texture;
}

}  // namespace

std::uint32_t findCoverFlags(const raster::SceneBuffers& scene, std::uint32_t part) {
  const scene::Material& material = scene.material(scene.geometry().parts[part].material);
  return (material.isSeenFromBehind() ? geometry::kTwoSided : kCoverSingleSided) |
         (material.alphaMode == scene::AlphaMode::Mask ? kCoverMasked : 0u) |
         (scene.isBlended(part) ? kCoverBlended : 0u);
}

bool SceneTriangles::fits(const scene::WorldGeometry& world) {
  constexpr std::size_t kWithLevels = 4;  // a level has at most 0.7 of the triangles of the one before
  const std::size_t most =
      std::max(kWithLevels * world.triangleCount(), kVertexTexels * world.positions.size());
  return findTableSize(most).y <= gl::maxTextureSize();
}

SceneTriangles::SceneTriangles(const raster::SceneBuffers& scene) : levels_(scene.levelsSoFar()) {
  const scene::WorldGeometry& world = scene.geometry();
  for (const scene::Part& part : world.parts) {
    unsigned bits = 0;
    for (std::uint32_t v = part.firstVertex; v < part.firstVertex + part.vertexCount; ++v)
      bits |=
          (world.colors[v] != vec4(1) ? kWithColors : 0u) | (world.uv1[v] != vec2(0) ? kWithSecondUv : 0u);
    attributes_.push_back(bits);
  }
  writeTriangles(scene);
  triangles_ = makeTable(gl::Format::Rgba32Ui, triangleTexels_);
  vertexTexels_.resize(kVertexTexels * world.positions.size());
  for (const scene::Part& part : world.parts) writeVertices(world, part);
  vertices_ = makeTable(gl::Format::Rgba32F, vertexTexels_);
}

void SceneTriangles::update(const raster::SceneBuffers& scene, std::span<const std::uint32_t> movedParts) {
  const scene::WorldGeometry& world = scene.geometry();
  bool hasTurned = false;
  for (const std::uint32_t p : movedParts) {
    const scene::Part& part = world.parts[p];
    writeVertices(world, part);
    hasTurned = hasTurned || (part.indexCount > 0 &&
                              triangleTexels_[part.firstIndex / 3].y != world.indices[part.firstIndex + 1]);
  }
  vertices_->upload(0, 0, vertexTexels_.data());
  if (!hasTurned) return;
  writeTriangles(scene);
  triangleTexels_.resize(std::size_t(triangles_->width()) * std::size_t(triangles_->height()));
  triangles_->upload(0, 0, triangleTexels_.data());
}

void SceneTriangles::writeTriangles(const raster::SceneBuffers& scene) {
  const scene::WorldGeometry& world = scene.geometry();
  std::vector<std::uint32_t> flags;
  for (std::uint32_t part = 0; part < world.parts.size(); ++part)
    flags.push_back(part * 4u + ((findCoverFlags(scene, part) & kCoverSingleSided) != 0 ? 1u : 0u));
  triangleTexels_.clear();
  const auto add = [&](std::span<const std::uint32_t> corners, std::span<const std::uint32_t> parts) {
    for (std::size_t i = 0; i < parts.size(); ++i)
      triangleTexels_.emplace_back(corners[3 * i], corners[3 * i + 1], corners[3 * i + 2], flags[parts[i]]);
  };
  add(world.indices, world.triangleParts);
  if (levels_) add(levels_->indices(), levels_->triangleParts().subspan(world.triangleCount()));
}

void SceneTriangles::writeVertices(const scene::WorldGeometry& world, const scene::Part& part) {
  for (std::size_t i = part.firstVertex; i < part.firstVertex + part.vertexCount; ++i) {
    vec4* texel = &vertexTexels_[kVertexTexels * i];
    texel[0] = vec4(world.positions[i], world.uv0[i].x);
    texel[1] = vec4(world.normals[i], world.uv0[i].y);
    texel[2] = world.tangents[i];
    texel[3] = world.colors[i];
    texel[4] = vec4(world.uv1[i], 0.0f, 0.0f);
  }
}

}  // namespace catoptric::virtual_object
