// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/simplified_levels.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "catoptric/geometry/level_error.h"

namespace catoptric::geometry {
namespace {

constexpr float kLeastGain = 0.7f;     // a level that is longer than this, of the one before, is the last
constexpr float kLargestError = 0.1f;  // of the mesh's extent, by the simplifier's own estimate

/// Step 1: corners by the first of all vertices that are the same.
std::vector<std::uint32_t> joinVertices(const SimplifiableMesh& mesh) {
  std::vector<meshopt_Stream> streams;
  const auto add = [&streams](const auto& values) {
    if (!values.empty()) streams.push_back({values.data(), sizeof(values[0]), sizeof(values[0])});
  };
  add(mesh.positions), add(mesh.normals), add(mesh.uv0), add(mesh.uv1), add(mesh.tangents), add(mesh.colors);
  std::vector<std::uint32_t> joined(mesh.indices.size());
  meshopt_generateShadowIndexBufferMulti(joined.data(), mesh.indices.data(), mesh.indices.size(),
                                         mesh.positions.size(), streams.data(), streams.size());
  return joined;
}

/// Step 2: positions of which no two that are used are equal.
std::vector<vec3> parted(std::span<const vec3> positions, const std::vector<std::uint32_t>& indices) {
  std::vector<std::uint32_t> used(indices);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const auto key = [&positions](std::uint32_t v) {
    return std::array<float, 3>{positions[v].x, positions[v].y, positions[v].z};
  };
  std::stable_sort(used.begin(), used.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<vec3> result(positions.begin(), positions.end());
  for (std::size_t i = 1, same = 0; i < used.size(); ++i) {
    same = key(used[i]) == key(used[i - 1]) ? same + 1 : 0;
    float& x = result[used[i]].x;
    for (std::size_t k = 0; k < same; ++k) x = std::nextafter(x, std::numeric_limits<float>::infinity());
  }
  return result;
}

double findRadius(std::span<const vec3> positions) {
  core::Box box;
  for (const vec3& p : positions) box.add(dvec3(p));
  return box.radius();
}

}  // namespace

std::vector<SimplifiedLevel> makeSimplifiedLevels(const SimplifiableMesh& mesh,
                                                  const SimplificationOptions& options) {
  assert(mesh.normals.size() == mesh.positions.size() && mesh.indices.size() % 3 == 0);
  std::vector<SimplifiedLevel> levels;
  if (mesh.indices.size() < 6 * options.fewestTriangles) return levels;
  // 1, 2
  std::vector<std::uint32_t> before = joinVertices(mesh);
  const std::vector<vec3> positions = parted(mesh.positions, before);
  const double radius = findRadius(mesh.positions);
  const LevelJudge judge(mesh, before);
  while (before.size() >= 6 * options.fewestTriangles) {
    // 3
    SimplifiedLevel level;
    level.indices.resize(before.size());
    level.indices.resize(meshopt_simplify(
        level.indices.data(), before.data(), before.size(), &positions.data()->x, positions.size(),
        sizeof(vec3), before.size() / 9 * 3, kLargestError, meshopt_SimplifyLockBorder, nullptr));
    if (float(level.indices.size()) > kLeastGain * float(before.size())) break;
    // 4
    judge.measure(level);
    if (!(level.distance <= options.largestDistance * radius && level.normalRadians <= options.largestTurn))
      break;
    before = level.indices;
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace catoptric::geometry
