// SPDX-License-Identifier: Apache-2.0
// A mirror and its explosion maps as textures, for the vertex shaders of the GPU backend.
//
// In:  a reflector's mesh; for an eye, explosion maps at radii evenly spaced in 1 / distance and the hidden
//      map. All are made on the processor: their exact ids, extension polygons and patches are those of the
//      CPU backend.
// Out: what shaders/virtual_object/mirror_maps.glsl reads; frame: world axes, origin at the mesh's centre.
// Five textures, at the units behind those of a level. A vertex shader of OpenGL ES 3.0 may read 16, and it
// and the fragment shader 32 together; here they are 5 and 16. Cost: 48 bytes a triangle and map, 4 a map
// pixel, sent once for each eye; a vertex fetches about 40 texels, one of `refined` 10 more a step.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "catoptric/gl/program.h"
#include "catoptric/gl/texture.h"
#include "catoptric/virtual_object/explosion_map.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::virtual_object {

/// Whether a vertex shader does what the solver does.
[[nodiscard]] constexpr bool hasVertexShader(Solver solver) {
  return solver == Solver::Explosion || solver == Solver::Layered || solver == Solver::Refined;
}
/// The define that makes shaders/virtual_object/virtual_vertex.glsl that solver; empty for Layered.
[[nodiscard]] std::vector<std::string> vertexShaderDefines(Solver solver);

class MirrorTextures {
 public:
  static constexpr int kMostLayers = 16;

  /// `mesh` must outlive the textures; `layers` from 2 to kMostLayers. Needs a current context.
  MirrorTextures(const ReflectorMesh& mesh, int layers);
  /// Whether a mesh fits into this GL's textures.
  [[nodiscard]] static bool fits(const ReflectorMesh& mesh, int layers);

  /// `view`: as a finder gets it; maps in the order of their radii, as many as `layers`, all of one size.
  void setEye(const EyeView& view, std::span<const ExplosionMap* const> maps, const HiddenMap& hidden);

  /// For a program in use that includes mirror_maps.glsl.
  void bind(gl::Program& program) const;

 private:
  void uploadTriangles();
  void fillMapTriangles(std::size_t layer, const ExplosionMap& map);

  const ReflectorMesh* mesh_;
  int layers_;
  std::unique_ptr<gl::Texture> triangles_, neighbours_, mapIds_, mapTriangles_, hiddenIds_;
  std::vector<vec4> texels_;  ///< of mapTriangles_
  MapFrame mapFrame_, hiddenFrame_;
  vec3 eye_{0}, mapLayers_{0};
  vec4 hiddenPixels_{0};
  vec2 hiddenCone_{0};
  std::array<vec4, kMostLayers> extensionCentres_{};
};

}  // namespace catoptric::virtual_object
