// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/attribute_repair.h"

#include <cmath>

namespace catoptric::scene::gltf {
namespace {

constexpr double kLengthTolerance = 0.1;  // 8-bit normals are 2 % off by themselves
constexpr float kLargestTexCoord = 1e15f;

}  // namespace

dvec3 anyPerpendicular(const dvec3& v) {
  const dvec3 axis = std::abs(v.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return glm::normalize(glm::cross(v, axis));
}

void repairNormals(Context& context, VertexStreams& streams, std::span<const std::uint32_t> triangles) {
  std::vector<bool> isBroken(streams.size(), false);
  std::size_t broken = 0;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const dvec3 normal(streams.normals[i]);
    const double length = glm::length(normal);
    if (!(length > 1e-20 && std::isfinite(length))) {
      isBroken[i] = true;
      ++broken;
      continue;
    }
    if (std::abs(length - 1) > kLengthTolerance) context.count(Repair::NormalLength);
    streams.normals[i] = vec3(normal / length);
  }
  if (broken == 0) return;
  context.count(Repair::Normal, broken);
  std::vector<dvec3> sums(streams.size(), dvec3(0));
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const dvec3 a(streams.positions[triangles[i]]), b(streams.positions[triangles[i + 1]]),
        c(streams.positions[triangles[i + 2]]);
    const dvec3 areaNormal = glm::cross(b - a, c - a);
    for (std::size_t k = 0; k < 3; ++k) sums[triangles[i + k]] += areaNormal;
  }
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (!isBroken[i]) continue;
    const double length = glm::length(sums[i]);
    streams.normals[i] = length > 0 ? vec3(sums[i] / length) : vec3(0, 1, 0);
  }
}

void repairTangents(Context& context, VertexStreams& streams) {
  for (std::size_t i = 0; i < streams.tangents.size(); ++i) {
    vec4& tangent = streams.tangents[i];
    const dvec3 direction = dvec3(vec3(tangent));
    const double length = glm::length(direction);
    const bool isBroken = !(length > 1e-20 && std::isfinite(length));
    const bool isUnsigned = tangent.w != 1.0f && tangent.w != -1.0f;
    if (isBroken || isUnsigned) context.count(Repair::Tangent);
    const dvec3 unit = isBroken ? anyPerpendicular(dvec3(streams.normals[i])) : direction / length;
    tangent = vec4(vec3(unit), tangent.w < 0 ? -1.0f : 1.0f);
  }
}

void repairTexCoords(Context& context, VertexStreams& streams) {
  for (std::vector<vec2>& coords : streams.uv)
    for (vec2& uv : coords)
      if (!(std::abs(uv.x) <= kLargestTexCoord && std::abs(uv.y) <= kLargestTexCoord)) {
        uv = vec2(0.0f);
        context.count(Repair::TexCoord);
      }
}

void repairColors(Context& context, VertexStreams& streams) {
  for (vec4& color : streams.colors) {
    bool isBroken = false;
    for (int c = 0; c < 4; ++c)
      if (!(color[c] >= 0.0f && color[c] <= 1.0f)) {
        color[c] = color[c] > 1.0f ? 1.0f : 0.0f;
        isBroken = true;
      }
    if (isBroken) context.count(Repair::Color);
  }
}

}  // namespace catoptric::scene::gltf
