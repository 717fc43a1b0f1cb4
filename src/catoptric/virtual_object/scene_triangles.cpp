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
  const std::size_t most = std::max(world.triangleCount(), kVertexTexels * world.positions.size());
  return findTableSize(most).y <= gl::maxTextureSize();
}

SceneTriangles::SceneTriangles(const raster::SceneBuffers& scene) {
  const scene::WorldGeometry& world = scene.geometry();
  std::vector<uvec4> triangles(world.triangleCount());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t part = world.triangleParts[i];
    triangles[i] = {world.indices[3 * i], world.indices[3 * i + 1], world.indices[3 * i + 2],
                    part * 4u + ((findCoverFlags(scene, part) & kCoverSingleSided) != 0 ? 1u : 0u)};
  }
  for (const scene::Part& part : world.parts) {
    unsigned bits = 0;
    for (std::uint32_t v = part.firstVertex; v < part.firstVertex + part.vertexCount; ++v)
      bits |=
          (world.colors[v] != vec4(1) ? kWithColors : 0u) | (world.uv1[v] != vec2(0) ? kWithSecondUv : 0u);
    attributes_.push_back(bits);
  }
  triangles_ = makeTable(gl::Format::Rgba32Ui, triangles);
  std::vector<vec4> vertices(kVertexTexels * world.positions.size());
  for (std::size_t i = 0; i < world.positions.size(); ++i) {
    vec4* texel = &vertices[kVertexTexels * i];
    texel[0] = vec4(world.positions[i], world.uv0[i].x);
    texel[1] = vec4(world.normals[i], world.uv0[i].y);
    texel[2] = world.tangents[i];
    texel[3] = world.colors[i];
    texel[4] = vec4(world.uv1[i], 0.0f, 0.0f);
  }
  vertices_ = makeTable(gl::Format::Rgba32F, vertices);
}

}  // namespace catoptric::virtual_object
