// SPDX-License-Identifier: Apache-2.0
// The whole scene on the GPU: world geometry, materials with their textures, lights, environment.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "catoptric/gl/program.h"
#include "catoptric/gl/texture.h"
#include "catoptric/raster/lane_textures.h"
#include "catoptric/raster/levels_of_detail.h"
#include "catoptric/raster/vertex_streams.h"
#include "catoptric/scene/environment.h"
#include "catoptric/scene/scene.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::raster {

/// Texture units; samplers of shaders/raster/*.glsl.
enum Unit : int {
  kUnitBaseColor,
  kUnitMetallicRoughness,
  kUnitNormal,
  kUnitOcclusion,
  kUnitEmissive,
  kUnitEnvironment,
  kUnitPrefiltered,
  kUnitFirstFree,  ///< level images and what else a pass reads
};

inline constexpr int kMaxLights = 16;  ///< what is beyond is left out, with a warning

/// std140 image of the block in shaders/raster/material_block.glsl.
struct MaterialBlock {
  vec4 baseColor, emissive, factors, more;
  vec4 uvRows[10];
};

class SceneBuffers {
 public:
  /// Arguments must outlive the object. Needs a current GL context.
  SceneBuffers(const scene::Scene& scene, const scene::WorldGeometry& geometry,
               const scene::Environment& environment);

  /// After vertices of these parts of the geometry have moved, or turned their winding.
  void updateGeometry(std::span<const std::uint32_t> movedParts);

  /// After values of materials have changed; their textures stay.
  void updateMaterials();

  /// Sets what every shader that includes raster/environment_lookup.glsl needs; the program must be in use.
  void bindEnvironment(gl::Program& program) const;
  [[nodiscard]] int lightCount() const;  ///< of those that are used
  void bindLights(gl::Program& program) const;
  void bindMaterial(int material) const;
  /// Bit k: the material has its k-th texture (order of Unit).
  [[nodiscard]] unsigned textureBits(int material) const;

  // The same for shading by the processor; textures are there where GL is software.
  [[nodiscard]] MaterialBlock materialBlock(int material) const;
  /// Null: the material has none, or textures are not there.
  [[nodiscard]] std::array<const LaneTexture*, 5> laneTextures(int material) const;
  /// Rows of u_lights (shaders/raster/material_block.glsl), four a light.
  [[nodiscard]] std::vector<vec4> packLights() const;
  [[nodiscard]] const scene::Environment& environment() const { return environment_; }
  /// With what materials ask for; made when first asked for.
  [[nodiscard]] const LaneEnvironment& laneEnvironment() const;

  [[nodiscard]] const scene::Material& material(int index) const;
  [[nodiscard]] const scene::WorldGeometry& geometry() const { return geometry_; }
  [[nodiscard]] const VertexStreams& world() const { return world_; }
  /// Parts drawn opaquely, and those that are blended over the picture afterwards.
  [[nodiscard]] const std::vector<DrawRange>& opaqueRanges() const { return opaque_; }
  [[nodiscard]] const std::vector<DrawRange>& blendedRanges() const { return blended_; }
  [[nodiscard]] bool isBlended(std::uint32_t part) const;
  /// Made when first asked for.
  [[nodiscard]] const LevelsOfDetail& levels() const;
  /// Null until then.
  [[nodiscard]] const LevelsOfDetail* levelsSoFar() const { return levels_.get(); }
  /// Around the vertices of a part, world.
  [[nodiscard]] const core::Box& partBox(std::uint32_t part) const { return boxes_[part]; }

 private:
  void uploadTextures();
  void uploadEnvironment(const scene::Environment& environment);
  const gl::Texture* findTexture(const scene::TextureSlot& slot, bool srgb);

  const scene::Scene& scene_;
  const scene::WorldGeometry& geometry_;
  const scene::Environment& environment_;
  VertexStreams world_;
  gl::Buffer materialBlocks_;
  std::size_t blockStride_ = 0;
  std::vector<scene::Material> materials_;                ///< the scene's, then the default one
  std::vector<std::array<const gl::Texture*, 5>> slots_;  ///< per material, null = none
  std::map<std::pair<int, bool>, std::unique_ptr<gl::Texture>> textures_;
  std::map<std::pair<int, bool>, LaneTexture> laneTextures_;
  std::unique_ptr<gl::Texture> white_, radiance_, prefiltered_;
  std::vector<vec3> irradiance_;
  std::vector<DrawRange> opaque_, blended_;
  std::vector<core::Box> boxes_;  ///< by part
  mutable std::unique_ptr<LevelsOfDetail> levels_;
  mutable std::unique_ptr<LaneEnvironment> laneEnvironment_;
};

}  // namespace catoptric::raster
