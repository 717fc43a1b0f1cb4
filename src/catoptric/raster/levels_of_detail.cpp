// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/levels_of_detail.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "catoptric/core/parallel.h"
#include "catoptric/geometry/simplified_levels.h"
#include "catoptric/geometry/symmetric_eigen.h"

namespace catoptric::raster {
namespace {

constexpr std::uint32_t kFewestTriangles = 256;  // a part with fewer costs next to nothing
constexpr double kLargestColor = 0.01;           // difference of a vertex colour that does not show

/// A part as it stands in its mesh.
struct LocalPart {
  std::vector<vec3> positions, normals;
  std::vector<vec4> tangents;
  std::span<const vec2> uv0, uv1;
  std::span<const vec4> colors;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> users;  ///< parts: all of this same shape
  std::vector<geometry::SimplifiedLevel> levels;
};

const scene::MeshPrimitive& findPrimitive(const scene::Scene& scene, const scene::Part& part) {
  const scene::Mesh& mesh = scene.meshes[std::size_t(scene.instances[part.object].mesh)];
  return mesh.primitives[part.primitive];
}

/// Which attributes the material looks at.
void findAttributes(const scene::Scene& scene, const scene::WorldGeometry& world, const scene::Part& part,
                    LocalPart& local) {
  if (part.material < 0) return;
  const scene::Material& m = scene.materials[std::size_t(part.material)];
  for (const scene::TextureSlot* slot : {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture,
                                         &m.occlusionTexture, &m.emissiveTexture}) {
    if (slot->texture < 0) continue;
    (slot->uvSet == 0 ? local.uv0 : local.uv1) =
        std::span(slot->uvSet == 0 ? world.uv0 : world.uv1).subspan(part.firstVertex, part.vertexCount);
  }
  const auto colors = std::span(world.colors).subspan(part.firstVertex, part.vertexCount);
  if (std::any_of(colors.begin(), colors.end(), [](const vec4& c) { return c != vec4(1); }))
    local.colors = colors;
  if (m.normalTexture.texture >= 0)
    local.tangents.assign(world.tangents.begin() + part.firstVertex,
                          world.tangents.begin() + part.firstVertex + part.vertexCount);
}

LocalPart makeLocalPart(const scene::Scene& scene, const scene::WorldGeometry& world, std::uint32_t p) {
  const scene::Part& part = world.parts[p];
  const scene::MeshPrimitive& primitive = findPrimitive(scene, part);
  LocalPart local;
  for (std::uint32_t v = part.firstVertex; v < part.firstVertex + part.vertexCount; ++v) {
    local.positions.push_back(primitive.positions[world.sourceVertices[v]]);
    local.normals.push_back(primitive.normals[world.sourceVertices[v]]);
  }
  for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; ++i)
    local.indices.push_back(world.indices[i] - part.firstVertex);
  findAttributes(scene, world, part, local);
  local.users = {p};
  return local;
}

bool isSame(const scene::WorldGeometry& world, const LocalPart& a, const LocalPart& b) {
  const scene::Part &pa = world.parts[a.users.front()], &pb = world.parts[b.users.front()];
  return pa.material == pb.material && a.indices == b.indices && a.positions == b.positions &&
         a.normals == b.normals;
}

std::vector<LocalPart> findShapes(const scene::Scene& scene, const scene::WorldGeometry& world) {
  std::vector<LocalPart> shapes;
  std::multimap<std::pair<int, std::uint32_t>, std::size_t> byPrimitive;
  for (std::uint32_t p = 0; p < world.parts.size(); ++p) {
    const scene::Part& part = world.parts[p];
    if (part.indexCount < 3 * kFewestTriangles || !maySimplify(scene, world, p)) continue;
    LocalPart local = makeLocalPart(scene, world, p);
    const auto [first, last] = byPrimitive.equal_range({scene.instances[part.object].mesh, part.primitive});
    const auto same = std::find_if(
        first, last, [&](const auto& entry) { return isSame(world, shapes[entry.second], local); });
    if (same != last) {
      shapes[same->second].users.push_back(p);
      continue;
    }
    byPrimitive.emplace(std::pair(scene.instances[part.object].mesh, part.primitive), shapes.size());
    shapes.push_back(std::move(local));
  }
  return shapes;
}

void simplify(LocalPart& part) {
  part.levels = geometry::makeSimplifiedLevels({.positions = part.positions,
                                                .normals = part.normals,
                                                .indices = part.indices,
                                                .uv0 = part.uv0,
                                                .uv1 = part.uv1,
                                                .tangents = part.tangents,
                                                .colors = part.colors});
  while (!part.levels.empty() && !(part.levels.back().color <= kLargestColor)) part.levels.pop_back();
}

}  // namespace

bool maySimplify(const scene::Scene& scene, const scene::WorldGeometry& world, std::uint32_t p) {
  const scene::Part& part = world.parts[p];
  if (part.object >= scene.instances.size() || scene.instances[part.object].mesh < 0) return false;
  if (findPrimitive(scene, part).deformation) return false;
  if (part.reflector == core::kNoId) return true;
  const scene::Reflector& mirror = world.reflectors[part.reflector];
  return mirror.isConvex && !mirror.doubleSided && !mirror.isRefractor() && !mirror.isPlanarMirror();
}

LevelsOfDetail::LevelsOfDetail(const scene::Scene& scene, const scene::WorldGeometry& world)
    : worldTriangles_(std::uint32_t(world.triangleCount())),
      runs_(world.parts.size()),
      triangleParts_(world.triangleParts) {
  std::vector<LocalPart> shapes = findShapes(scene, world);
  core::parallelFor(shapes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) simplify(shapes[i]);
  });
  for (const LocalPart& shape : shapes)
    for (const std::uint32_t p : shape.users) {
      const scene::Part& part = world.parts[p];
      Run& run = runs_[p];
      run.first = std::uint32_t(levels_.size());
      run.count = std::uint32_t(shape.levels.size());
      run.secondCorner = world.indices[part.firstIndex + 1];
      measureScale(scene, part, run);
      for (const geometry::SimplifiedLevel& level : shape.levels) {
        const auto count = std::uint32_t(level.indices.size() / 3);
        levels_.push_back({std::uint32_t(triangleParts_.size()), count, level.distance, level.normalRadians});
        for (const std::uint32_t v : level.indices) indices_.push_back(part.firstVertex + v);
        triangleParts_.insert(triangleParts_.end(), count, p);
      }
    }
}

void LevelsOfDetail::measureScale(const scene::Scene& scene, const scene::Part& part, Run& run) {
  const dmat3 linear(scene.instances[part.object].worldFromMesh);
  const dvec3 squares = geometry::computeEigen(glm::transpose(linear) * linear).values;
  run.largestScale = std::sqrt(std::max(squares.z, 0.0));
  run.leastScale = std::sqrt(std::max(squares.x, 0.0));
}

void LevelsOfDetail::update(const scene::Scene& scene, const scene::WorldGeometry& world,
                            std::span<const std::uint32_t> movedParts) {
  for (const std::uint32_t p : movedParts) {
    Run& run = runs_[p];
    if (run.count == 0) continue;
    measureScale(scene, world.parts[p], run);
    const std::uint32_t second = world.indices[world.parts[p].firstIndex + 1];
    if (std::exchange(run.secondCorner, second) == second) continue;
    const std::size_t begin = 3 * std::size_t(levels_[run.first].firstTriangle - worldTriangles_);
    const DetailLevel& last = levels_[run.first + run.count - 1];
    const std::size_t end = 3 * std::size_t(last.firstTriangle + last.triangleCount - worldTriangles_);
    for (std::size_t i = begin; i < end; i += 3) std::swap(indices_[i + 1], indices_[i + 2]);
  }
}

}  // namespace catoptric::raster
