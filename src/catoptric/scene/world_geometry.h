// SPDX-License-Identifier: Apache-2.0
// The whole scene as one set of contiguous world-space arrays. The rasterizer, the ray tracer and the virtual
// objects all read these same floats, so that their pictures can agree to the pixel.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/core/seen.h"
#include "catoptric/scene/scene.h"

namespace catoptric::scene {

/// How a reflector is treated. `Plane` is a planar mirror; everything else goes by its mesh.
enum class ReflectorShape : std::uint8_t {
  Plane,
  Sphere,
  Cylinder,
  Cone,
  Extrusion,
  Quadric,
  Torus,
  Aspheric,  ///< a surface of revolution, geometry/aspheric_mirror.h
  Mesh
};
/// The word for it in extras.catoptric.shape, in `info` and in the viewer: "plane", "sphere", ...
[[nodiscard]] std::string_view shapeName(ReflectorShape shape);

/// A mirror surface: one flat facet, or one smoothly connected curved piece of an instance. Or, with Snell's
/// law in place of the mirror law, a refractor: the whole surface of a solid that light goes through.
struct Reflector {
  std::string name;  ///< instance name, "#k" appended when the instance has several
  ReflectorShape shape = ReflectorShape::Mesh;
  std::string reason;  ///< why it is one: "material: metallic 1, roughness 0", "extras.catoptric", ...
  core::Plane plane;   ///< valid when shape == Plane; normal on the bright side
  bool doubleSided = false;
  float reflectivity = 1;  ///< Surface::reflectivity for its mirror lobe; 0 when it mirrors by clearcoat
  float clearcoat = 0;     ///< Surface::clearcoat; 0 unless it mirrors by clearcoat
  float ior = 0;           ///< index of refraction of the solid behind a refractor's front; 0 for a mirror
  vec3 absorption{0};      ///< of a refractor: light falls by exp(-absorption * way inside), per world unit
  std::optional<bool>
      morphed;                ///< the user's choice for reflection morphing: always, never (environment map)
  std::string morphedReason;  ///< whose choice: "--mapped", "extras.catoptric of the node", ...
  std::uint32_t object = core::kNoId;  ///< index of the instance
  int material = -1;
  std::uint32_t part = 0;  ///< index into WorldGeometry::parts: its triangles
  dvec3 centre{0};         ///< centre of its bounding sphere
  double radius = 0;
  double areaWorld = 0;
  double fitError = 0;    ///< largest distance of a vertex from the recognised shape, world units
  bool isConvex = false;  ///< convex seen from its bright side (to within tessellation)

  [[nodiscard]] bool isRefractor() const { return ior > 0.0f; }
  [[nodiscard]] bool isPlanarMirror() const { return shape == ReflectorShape::Plane && !isRefractor(); }
};

/// How many surfaces of refractors light goes through on its way from the eye, besides the mirrors of
/// --bounces; the next one shows the environment in the refracted direction. A solid takes two, and one more
/// for each total reflection inside.
inline constexpr int kMostCrossings = 6;

/// A run of triangles with one material, one object and at most one reflector.
struct Part {
  std::uint32_t firstIndex = 0, indexCount = 0;    ///< into WorldGeometry::indices
  std::uint32_t firstVertex = 0, vertexCount = 0;  ///< its vertices; not shared with other parts
  int material = -1;
  std::uint32_t object = 0;               ///< index into Scene::instances
  std::uint32_t primitive = 0;            ///< of that instance's mesh
  std::uint32_t reflector = core::kNoId;  ///< index into WorldGeometry::reflectors
  bool shell = false;                     ///< shell of the room, see methods.md section 6
  bool isSeenFromBehind = false;          ///< Material::isSeenFromBehind()
};

struct WorldGeometry {
  std::vector<vec3> positions;
  std::vector<vec3> normals;
  std::vector<vec4> tangents;                 ///< zero where absent
  std::vector<vec2> uv0, uv1;                 ///< zero where absent
  std::vector<vec4> colors;                   ///< one where absent
  std::vector<std::uint32_t> indices;         ///< winding already flipped for negative scales
  std::vector<std::uint32_t> triangleParts;   ///< part of each triangle
  std::vector<std::uint32_t> sourceVertices;  ///< vertex of the mesh primitive that each vertex was made from
  std::vector<Part> parts;
  std::vector<Reflector> reflectors;
  core::Box bounds;
  std::uint64_t droppedTriangles = 0;  ///< degenerate ones

  [[nodiscard]] std::size_t triangleCount() const { return indices.size() / 3; }
};

struct ReflectorOptions {
  float minMetallic = 0.9f;    ///< --reflector-metallic
  float maxRoughness = 0.05f;  ///< --reflector-roughness
  double planeTolerance =
      1e-4;  ///< flat if no vertex leaves the plane by more than this times the radius and ...
  double normalTolerance = 2e-3;  ///< ... no vertex normal by more than this angle, radians
  std::vector<std::string>
      only{};  ///< if not empty: names (of reflectors, instances or materials) to keep (--reflector)
  std::vector<std::string> morphed{}, mapped{};  ///< names for Reflector::morphed (--morphed, --mapped)
};

/// Flattens instances into world space, splits off the reflectors and recognises their shape. Triangles of
/// zero area, with a non-finite vertex or a coordinate beyond 1e15 are dropped and counted. Part::material is
/// never -1 unless the scene has no materials. Deterministic. Throws core::Error("reflector.unknown") when a
/// name in `options` matches nothing.
[[nodiscard]] WorldGeometry makeWorldGeometry(const Scene& scene, const ReflectorOptions& options = {});

/// Recognises a reflector's shape anew and measures it, after its vertices have moved.
void measureReflectorAgain(const Scene& scene, WorldGeometry& world, std::uint32_t reflector,
                           const ReflectorOptions& options);

}  // namespace catoptric::scene
