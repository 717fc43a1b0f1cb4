// SPDX-License-Identifier: Apache-2.0
// How the built-in scenes are put together: materials, meshes, placed things, lights, cameras, then one .glb.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "catoptric/geometry/mesh.h"
#include "catoptric/scene/built_in/textures.h"
#include "catoptric/scene/scene.h"

namespace catoptric::scene::built_in {

/// Triangles of one material within a mesh.
struct Piece {
  geometry::Mesh mesh;
  int material;
};

class SceneBuilder {
 public:
  explicit SceneBuilder(std::string name) { scene_.name = std::move(name); }

  int addTexture(const std::string& name, core::ImageRgba8 image, Wrap wrap = Wrap::Repeat);

  /// Materials. A second call with the same name gives the first one back.
  int paint(const std::string& name, const vec3& linearColour, float roughness = 0.55f);
  int textured(const std::string& name, const ivec2& sizePx, const Pattern& pattern, float roughness = 0.6f,
               int samplesPerAxis = 1);
  int mirror(const std::string& name, const vec3& tint = vec3(0.95f));
  int metal(const std::string& name, const vec3& linearColour, float roughness);
  /// Shines by itself; not lit.
  int glow(const std::string& name, const vec3& radiance);
  /// To change what the makers above do not set.
  Material& material(int index) { return scene_.materials.at(std::size_t(index)); }
  /// Darkens sky light by a grey texture on the given set of texture coordinates.
  void setOcclusion(int material, const std::string& name, core::ImageRgba8 image, int uvSet);

  /// A mesh to be placed several times.
  int addMesh(const std::string& name, std::span<const Piece> pieces);
  Instance& place(const std::string& name, int mesh, const dmat4& worldFromMesh = dmat4(1.0));
  /// A mesh that is there once. Texture coordinates that the material does not need are left out.
  Instance& place(const std::string& name, geometry::Mesh mesh, int material,
                  const dmat4& worldFromMesh = dmat4(1.0));
  Instance& place(const std::string& name, std::span<const Piece> pieces,
                  const dmat4& worldFromMesh = dmat4(1.0));
  /// The same, marked as shell of the room (walls, floor, road).
  Instance& placeShell(const std::string& name, geometry::Mesh mesh, int material,
                       const dmat4& worldFromMesh = dmat4(1.0));

  /// Key frames of the place of an instance, which must have been put where it is by a translation and a turn
  /// around the vertical; linear between them.
  void moveAlong(Instance& instance, std::span<const float> timesS, std::span<const vec3> places,
                 double turnDegrees = 0);

  void addSun(const dvec3& towardsLight, const vec3& color);
  /// Candela.
  void addLamp(const dvec3& position, const vec3& color, double range = 0);
  void addCamera(const std::string& name, const dvec3& eye, const dvec3& target, double fovYDegrees);
  /// A camera that goes past all stations, on smooth curves, within the given time.
  struct Station {
    dvec3 eye, target;
  };
  void addWalk(const std::string& name, std::span<const Station> stations, double durationS,
               double fovYDegrees);

  [[nodiscard]] const Scene& scene() const { return scene_; }

 private:
  int addMaterial(const std::string& name, const vec3& linearColour, float metallic, float roughness);

  Scene scene_;
  std::map<std::string, int> materialByName_;
};

}  // namespace catoptric::scene::built_in
