// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/mesh.h"

#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

namespace catoptric::geometry {
namespace {

template <class Value>
void appendAttribute(std::vector<Value>& target, std::size_t targetCount, const std::vector<Value>& addition,
                     std::size_t additionCount, const Value& filler) {
  if (target.empty() && addition.empty()) return;
  target.resize(targetCount, filler);
  target.insert(target.end(), addition.begin(), addition.end());
  target.resize(targetCount + additionCount, filler);
}

std::uint64_t cellKey(std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = 1469598103934665603ull;
  for (std::int64_t v : {x, y, z}) h = (h ^ std::uint64_t(v)) * 1099511628211ull;
  return h;
}

/// Points to buckets of a grid, so that neighbours within the tolerance are found in the 27 cells around.
class PointGrid {
 public:
  explicit PointGrid(double cell) : cell_(cell > 0 ? cell : 1e-12) {}

  template <class Accept>
  std::uint32_t findOrAdd(const vec3& p, std::uint32_t candidate, const Accept& accept) {
    const std::int64_t x = coordinate(p.x), y = coordinate(p.y), z = coordinate(p.z);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto found = buckets_.find(cellKey(x + dx, y + dy, z + dz));
          if (found == buckets_.end()) continue;
          for (std::uint32_t index : found->second)
            if (accept(index)) return index;
        }
    buckets_[cellKey(x, y, z)].push_back(candidate);
    return candidate;
  }

 private:
  [[nodiscard]] std::int64_t coordinate(float v) const { return std::int64_t(std::floor(double(v) / cell_)); }
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> buckets_;
};

double cornerAngle(const dvec3& a, const dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// For each vertex the first vertex at the same place.
std::vector<std::uint32_t> findSamePositions(const Mesh& mesh, double tolerance) {
  std::vector<std::uint32_t> representative(mesh.positions.size());
  PointGrid grid(tolerance);
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i)
    representative[i] = grid.findOrAdd(mesh.positions[i], i, [&](std::uint32_t j) {
      return glm::distance(dvec3(mesh.positions[i]), dvec3(mesh.positions[j])) <= tolerance;
    });
  return representative;
}

}  // namespace

void append(Mesh& target, const Mesh& addition) {
  const std::size_t before = target.positions.size(), added = addition.positions.size();
  appendAttribute(target.uv, before, addition.uv, added, vec2(0.0f));
  appendAttribute(target.uv1, before, addition.uv1, added, vec2(0.0f));
  appendAttribute(target.colors, before, addition.colors, added, vec4(1.0f));
  target.positions.insert(target.positions.end(), addition.positions.begin(), addition.positions.end());
  target.normals.insert(target.normals.end(), addition.normals.begin(), addition.normals.end());
  for (std::uint32_t index : addition.indices) target.indices.push_back(index + std::uint32_t(before));
}

Mesh transformed(Mesh mesh, const dmat4& targetFromMesh) {
  const dmat3 linear(targetFromMesh);
  const dmat3 normalMap = glm::transpose(glm::inverse(linear));
  for (vec3& p : mesh.positions) p = vec3(dvec3(targetFromMesh * dvec4(dvec3(p), 1.0)));
  for (vec3& n : mesh.normals) n = vec3(glm::normalize(normalMap * dvec3(n)));
  if (glm::determinant(linear) < 0)
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  return mesh;
}

Mesh flipped(Mesh mesh) {
  for (vec3& n : mesh.normals) n = -n;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  return mesh;
}

Mesh withScaledUv(Mesh mesh, const vec2& scale) {
  for (vec2& t : mesh.uv) t *= scale;
  return mesh;
}

Mesh welded(const Mesh& mesh, double positionTolerance, double normalToleranceRadians) {
  Mesh result;
  PointGrid grid(positionTolerance);
  std::vector<std::uint32_t> newIndex(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto candidate = std::uint32_t(result.positions.size());
    newIndex[i] = grid.findOrAdd(mesh.positions[i], candidate, [&](std::uint32_t j) {
      return glm::distance(dvec3(mesh.positions[i]), dvec3(result.positions[j])) <= positionTolerance &&
             glm::distance(dvec3(mesh.normals[i]), dvec3(result.normals[j])) <= normalToleranceRadians;
    });
    if (newIndex[i] != candidate) continue;
    result.positions.push_back(mesh.positions[i]);
    result.normals.push_back(mesh.normals[i]);
  }
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const std::uint32_t a = newIndex[mesh.indices[3 * t]], b = newIndex[mesh.indices[3 * t + 1]],
                        c = newIndex[mesh.indices[3 * t + 2]];
    if (a == b || b == c || c == a) continue;
    result.indices.insert(result.indices.end(), {a, b, c});
  }
  return result;
}

Mesh withSmoothNormals(const Mesh& mesh, double creaseAngleRadians) {
  const std::vector<std::uint32_t> place = findSamePositions(mesh, 1e-6);
  struct Corner {
    std::uint32_t face;
    dvec3 faceNormal;
    double angle;
  };
  std::vector<std::vector<Corner>> cornersAt(mesh.positions.size());
  for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
    std::array<dvec3, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = mesh.positions[mesh.indices[3 * t + k]];
    const dvec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
    if (!(glm::length(cross) > 0)) continue;
    for (int k = 0; k < 3; ++k)
      cornersAt[place[mesh.indices[3 * t + k]]].push_back(
          {t, glm::normalize(cross), cornerAngle(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k])});
  }
  Mesh result;
  const double minCosine = std::cos(creaseAngleRadians);
  std::map<std::pair<std::uint32_t, std::array<std::int64_t, 3>>, std::uint32_t> made;
  for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.indices[3 * t + k];
      dvec3 own(0), sum(0);
      for (const Corner& c : cornersAt[place[vertex]])
        if (c.face == t) own = c.faceNormal;
      for (const Corner& c : cornersAt[place[vertex]])
        if (glm::dot(c.faceNormal, own) >= minCosine) sum += c.angle * c.faceNormal;
      const dvec3 n = glm::length(sum) > 0 ? glm::normalize(sum) : dvec3(mesh.normals[vertex]);
      const std::array<std::int64_t, 3> rounded{std::llround(n.x * 1e6), std::llround(n.y * 1e6),
                                                std::llround(n.z * 1e6)};
      const auto [entry, isNew] = made.try_emplace({vertex, rounded}, std::uint32_t(result.positions.size()));
      if (isNew) {
        result.positions.push_back(mesh.positions[vertex]);
        result.normals.push_back(vec3(n));
        if (!mesh.uv.empty()) result.uv.push_back(mesh.uv[vertex]);
        if (!mesh.uv1.empty()) result.uv1.push_back(mesh.uv1[vertex]);
        if (!mesh.colors.empty()) result.colors.push_back(mesh.colors[vertex]);
      }
      result.indices.push_back(entry->second);
    }
  }
  return result;
}

}  // namespace catoptric::geometry
