// SPDX-License-Identifier: Apache-2.0
// From instances of shared meshes to one set of world-space arrays.
//
//   1. For every instance and primitive: positions to world space in double, stored as float; normals by the
//      inverse transpose; winding flipped where the transform mirrors; degenerate triangles dropped; bad
//      normals recomputed.
//   2. Decide whether its material is a mirror (reflector_finding.h); split a mirror into its pieces.
//   3. Name the reflectors, apply --reflector; what is not kept is drawn as an ordinary surface.
//   4. Emit parts in the order of instances and primitives: ordinary triangles, then the reflectors.
//   5. Mark the shell of the room: a node says so, or, where there are at least two instances, the box of the
//      instance spans 90 % of the scene's box along at least two axes (floor, road, room). Mirrors never make
//      an instance shell by themselves: `extras.catoptric` can.
//
// Cost: linear; 10^6 triangles in well under 2 s, mirrors included.
#include "catoptric/scene/world_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "catoptric/scene/reflector_names.h"
#include "catoptric/scene/world_primitive.h"

namespace catoptric::scene {
namespace {

constexpr double kShellShare = 0.9;

/// Copies triangles of primitives into the world arrays as parts with vertices of their own.
class PartWriter {
 public:
  explicit PartWriter(WorldGeometry& world) : world_(world) {}

  /// Appends a part made of the given triangles; vertices in the order of first use.
  Part& write(const WorldPrimitive& primitive, const dmat3& linear,
              std::span<const std::uint32_t> triangles) {
    if (localOf_.size() < primitive.positions.size())
      localOf_.resize(primitive.positions.size(), core::kNoId);
    Part part;
    part.firstIndex = static_cast<std::uint32_t>(world_.indices.size());
    part.firstVertex = static_cast<std::uint32_t>(world_.positions.size());
    part.material = primitive.material;
    part.object = primitive.instance;
    part.primitive = primitive.number;
    for (const std::uint32_t t : triangles) {
      world_.triangleParts.push_back(static_cast<std::uint32_t>(world_.parts.size()));
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = primitive.indices[3 * std::size_t(t) + k];
        if (localOf_[v] == core::kNoId) {
          localOf_[v] = static_cast<std::uint32_t>(world_.positions.size());
          appendVertex(primitive, linear, v);
        }
        world_.indices.push_back(localOf_[v]);
      }
    }
    for (const std::uint32_t t : triangles)
      for (int k = 0; k < 3; ++k) localOf_[primitive.indices[3 * std::size_t(t) + k]] = core::kNoId;
    part.indexCount = static_cast<std::uint32_t>(world_.indices.size()) - part.firstIndex;
    part.vertexCount = static_cast<std::uint32_t>(world_.positions.size()) - part.firstVertex;
    world_.parts.push_back(part);
    return world_.parts.back();
  }

 private:
  void appendVertex(const WorldPrimitive& primitive, const dmat3& linear, std::uint32_t v) {
    const MeshPrimitive& source = *primitive.source;
    world_.sourceVertices.push_back(v);
    world_.positions.push_back(primitive.positions[v]);
    world_.normals.push_back(primitive.normals[v]);
    vec4 tangent(0);
    if (v < source.tangents.size()) {
      const dvec3 t = linear * dvec3(source.tangents[v]);
      const double length = glm::length(t);
      if (length > 0 && std::isfinite(length))
        tangent = vec4(vec3(t / length), float(source.tangents[v].w * primitive.handedness));
    }
    world_.tangents.push_back(tangent);
    world_.uv0.push_back(v < source.uv[0].size() ? source.uv[0][v] : vec2(0));
    world_.uv1.push_back(v < source.uv[1].size() ? source.uv[1][v] : vec2(0));
    world_.colors.push_back(v < source.colors.size() ? source.colors[v] : vec4(1));
    world_.bounds.add(dvec3(primitive.positions[v]));
  }

  WorldGeometry& world_;
  std::vector<std::uint32_t> localOf_;
};

/// All triangles of a primitive: a solid is one refractor, whatever edges it has.
MirrorPiece wholePiece(std::size_t triangles) {
  MirrorPiece piece;
  piece.triangles.resize(triangles);
  std::iota(piece.triangles.begin(), piece.triangles.end(), 0u);
  return piece;
}

/// Steps 1 and 2 for the whole scene.
std::vector<WorldPrimitive> collectPrimitives(const Scene& scene, const ReflectorOptions& options,
                                              std::uint64_t& dropped) {
  const ReflectorRule rule(scene, options);
  std::vector<WorldPrimitive> primitives;
  std::size_t pieces = 0;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (instance.mesh < 0) continue;
    std::uint32_t number = 0;
    for (const MeshPrimitive& source : scene.meshes[std::size_t(instance.mesh)].primitives) {
      WorldPrimitive primitive;
      primitive.instance = i;
      primitive.number = number++;
      primitive.source = &source;
      primitive.material = source.material >= 0 ? source.material : int(scene.materials.size()) - 1;
      dropped += transformPrimitive(primitive, instance.worldFromMesh);
      if (primitive.indices.empty()) continue;
      primitive.decision = rule.decide(primitive.material, instance.hint);
      if (primitive.decision.isRefractor)
        primitive.pieces = {wholePiece(primitive.indices.size() / 3)};
      else if (primitive.decision.isReflector)
        primitive.pieces =
            findMirrorPieces({primitive.positions, primitive.normals, primitive.indices}, options);
      primitive.firstReflector = pieces;
      pieces += primitive.pieces.size();
      primitives.push_back(std::move(primitive));
    }
  }
  return primitives;
}

/// Shape and measures, from the vertices of the part as a mesh of its own; indices start at 0.
void measurePart(const Scene& scene, const WorldGeometry& world, const Part& part,
                 const ReflectorOptions& options, Reflector& reflector) {
  const Instance& instance = scene.instances[part.object];
  const Material none, &material = part.material < 0 ? none : scene.materials[std::size_t(part.material)];
  std::vector<std::uint32_t> indices(world.indices.begin() + part.firstIndex,
                                     world.indices.begin() + part.firstIndex + part.indexCount);
  for (std::uint32_t& index : indices) index -= part.firstVertex;
  const geometry::MeshView mesh{std::span(world.positions).subspan(part.firstVertex, part.vertexCount),
                                std::span(world.normals).subspan(part.firstVertex, part.vertexCount),
                                indices};
  measureReflector(reflector, mesh, instance.hint.shape ? instance.hint.shape : material.hint.shape,
                   material.normalTexture.texture >= 0 && !(reflector.clearcoat > 0), options);
}

/// extras.catoptric.morphed of the node, else of the material.
void readMorphedHint(const Scene& scene, Reflector& reflector) {
  const std::optional<bool> byNode = scene.instances[reflector.object].hint.morphed;
  const std::optional<bool> byMaterial =
      reflector.material < 0 ? std::nullopt : scene.materials[std::size_t(reflector.material)].hint.morphed;
  reflector.morphed = byNode ? byNode : byMaterial;
  if (!reflector.morphed) return;
  reflector.morphedReason = byNode ? "extras.catoptric of the node" : "extras.catoptric of the material";
}

Reflector makeReflector(const Scene& scene, const WorldGeometry& world, const Part& part,
                        const ReflectorDecision& decision, const std::string& name,
                        const ReflectorOptions& options) {
  Reflector reflector;
  reflector.name = name;
  reflector.reason = decision.reason;
  reflector.reflectivity = decision.reflectivity;
  reflector.clearcoat = decision.clearcoat;
  reflector.object = part.object;
  reflector.material = part.material;
  if (decision.isRefractor) {
    const Material& material = scene.materials[std::size_t(part.material)];
    reflector.ior = material.ior;
    if (material.attenuationDistance > 0)
      reflector.absorption =
          -glm::log(glm::max(material.attenuationColor, vec3(1e-6f))) / material.attenuationDistance;
  }
  reflector.doubleSided = part.material >= 0 && scene.materials[std::size_t(part.material)].doubleSided;
  readMorphedHint(scene, reflector);
  measurePart(scene, world, part, options, reflector);
  return reflector;
}

/// Step 4 for one primitive.
void emitPrimitive(const Scene& scene, const WorldPrimitive& primitive, std::span<const std::string> names,
                   const std::vector<bool>& keep, const ReflectorOptions& options, PartWriter& writer,
                   WorldGeometry& world) {
  const dmat3 linear(scene.instances[primitive.instance].worldFromMesh);
  std::vector<std::uint32_t> ordinary;
  if (primitive.pieces.empty()) {
    ordinary.resize(primitive.indices.size() / 3);
    std::iota(ordinary.begin(), ordinary.end(), 0u);
  }
  for (std::size_t i = 0; i < primitive.pieces.size(); ++i)
    if (!keep[primitive.firstReflector + i])
      ordinary.insert(ordinary.end(), primitive.pieces[i].triangles.begin(),
                      primitive.pieces[i].triangles.end());
  if (!ordinary.empty()) writer.write(primitive, linear, ordinary);
  for (std::size_t i = 0; i < primitive.pieces.size(); ++i) {
    if (!keep[primitive.firstReflector + i]) continue;
    Part& part = writer.write(primitive, linear, primitive.pieces[i].triangles);
    part.reflector = static_cast<std::uint32_t>(world.reflectors.size());
    world.reflectors.push_back(
        makeReflector(scene, world, part, primitive.decision, names[primitive.firstReflector + i], options));
    world.reflectors.back().part = static_cast<std::uint32_t>(world.parts.size() - 1);
  }
}

/// Step 5.
void markShell(const Scene& scene, WorldGeometry& world) {
  std::map<std::uint32_t, core::Box> boxes;  // of the ordinary parts; mirrors do not make a shell
  std::map<std::uint32_t, bool> present;
  for (const Part& part : world.parts) {
    present[part.object] = true;
    if (part.reflector != core::kNoId) continue;
    for (std::uint32_t v = 0; v < part.vertexCount; ++v)
      boxes[part.object].add(dvec3(world.positions[part.firstVertex + v]));
  }
  const dvec3 size = world.bounds.upper - world.bounds.lower;
  const auto coversTwoAxes = [&](const core::Box& box) {
    int axes = 0;
    for (int i = 0; i < 3; ++i)
      axes += size[i] > 0 && box.upper[i] - box.lower[i] >= kShellShare * size[i] ? 1 : 0;
    return axes >= 2;
  };
  for (Part& part : world.parts) {
    const auto box = boxes.find(part.object);
    const bool automatic = present.size() > 1 && box != boxes.end() && coversTwoAxes(box->second);
    part.shell = scene.instances[part.object].hint.shell.value_or(automatic);
  }
}

}  // namespace

WorldGeometry makeWorldGeometry(const Scene& scene, const ReflectorOptions& options) {
  WorldGeometry world;
  const std::vector<WorldPrimitive> primitives = collectPrimitives(scene, options, world.droppedTriangles);
  const std::vector<std::string> names = nameReflectors(scene, primitives);
  const std::vector<bool> keep = selectReflectors(scene, primitives, names, options.only);
  PartWriter writer(world);
  for (const WorldPrimitive& primitive : primitives)
    emitPrimitive(scene, primitive, names, keep, options, writer, world);
  for (Part& part : world.parts)
    part.isSeenFromBehind =
        part.material >= 0 && scene.materials[std::size_t(part.material)].isSeenFromBehind();
  chooseMorphed(scene, primitives, names, keep, options, world.reflectors);
  markShell(scene, world);
  return world;
}

void measureReflectorAgain(const Scene& scene, WorldGeometry& world, std::uint32_t reflector,
                           const ReflectorOptions& options) {
  Reflector& r = world.reflectors[reflector];
  measurePart(scene, world, world.parts[r.part], options, r);
}

}  // namespace catoptric::scene
