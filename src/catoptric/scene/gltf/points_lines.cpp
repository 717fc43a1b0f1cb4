// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/points_lines.h"

#include <array>
#include <cmath>

#include "catoptric/scene/gltf/attribute_repair.h"
#include "catoptric/scene/gltf/mesh.h"

namespace catoptric::scene::gltf {
namespace {

constexpr double kRelativeRadius = 0.002;
constexpr std::size_t kVerticesEach = 6, kTrianglesEach = 8;  // both solids have six corners and eight faces

double solidRadius(double meshRadius) {
  return kRelativeRadius * (meshRadius > 0 ? meshRadius : 1.0);
}

/// Collects the corners of the solids; `source` is the vertex whose colour and coordinates a corner takes.
class Builder {
 public:
  Builder(Context& context, const VertexStreams& streams, std::size_t solids, const std::string& pointer,
          std::vector<std::uint32_t>& triangles)
      : triangles_(triangles) {
    const std::size_t vertexBytes = bytesPerVertex(streams) + 3 * sizeof(vec3) + sizeof(std::uint32_t);
    context.charge(solids, kVerticesEach * vertexBytes + kTrianglesEach * 3 * sizeof(std::uint32_t), pointer);
    if (solids > 0xFFFFFFFFu / kVerticesEach)
      context.fail("gltf.memory", "too many points or lines", pointer);
  }

  void addCorner(std::uint32_t source, const dvec3& position, const dvec3& normal) {
    sources_.push_back(source);
    positions_.push_back(vec3(position));
    normals_.push_back(vec3(normal));
  }

  /// Faces in terms of the six corners added last.
  void addFaces(const std::array<std::array<std::uint32_t, 3>, kTrianglesEach>& faces) {
    const auto first = std::uint32_t(positions_.size() - kVerticesEach);
    for (const auto& face : faces)
      for (const std::uint32_t corner : face) triangles_.push_back(first + corner);
  }

  VertexStreams finish(const VertexStreams& streams) {
    VertexStreams source = streams;
    source.normals.clear();
    source.tangents.clear();
    VertexStreams out = reorder(source, sources_);
    out.positions = std::move(positions_);
    out.normals = std::move(normals_);
    return out;
  }

 private:
  std::vector<std::uint32_t>& triangles_;
  std::vector<std::uint32_t> sources_;
  std::vector<vec3> positions_, normals_;
};

/// Counts and says why a position cannot be drawn.
bool checkPosition(Context& context, const vec3& position) {
  if (isUsable(position)) return true;
  context.count(isFinite(position) ? Repair::HugeTriangle : Repair::NonFiniteTriangle);
  return false;
}

void addPrism(Context& context, const VertexStreams& streams, std::uint32_t ia, std::uint32_t ib,
              double radius, Builder& builder) {
  if (!checkPosition(context, streams.positions[ia]) || !checkPosition(context, streams.positions[ib]))
    return;
  const dvec3 a(streams.positions[ia]), b(streams.positions[ib]);
  const double length = glm::length(b - a);
  if (!(length > 0)) {
    context.count(Repair::DegenerateTriangle);
    return;
  }
  const dvec3 along = (b - a) / length, u = anyPerpendicular(along), v = glm::cross(along, u);
  for (const auto& [index, end] : {std::pair(ia, a), std::pair(ib, b)})
    for (int k = 0; k < 3; ++k) {
      const double angle = 2.0 * glm::pi<double>() * k / 3.0;
      const dvec3 outward = std::cos(angle) * u + std::sin(angle) * v;
      builder.addCorner(index, end + radius * outward, outward);
    }
  builder.addFaces(
      {{{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}, {0, 2, 1}, {3, 4, 5}}});
}

}  // namespace

VertexStreams thickenPoints(Context& context, const VertexStreams& streams,
                            std::span<const std::uint32_t> indices, double meshRadius,
                            const std::string& pointer, std::vector<std::uint32_t>& triangles) {
  Builder builder(context, streams, indices.size(), pointer, triangles);
  const double radius = solidRadius(meshRadius);
  for (const std::uint32_t i : indices) {
    if (!checkPosition(context, streams.positions[i])) continue;
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        dvec3 outward(0.0);
        outward[axis] = sign;
        builder.addCorner(i, dvec3(streams.positions[i]) + radius * outward, outward);
      }
    // Corners: +x -x +y -y +z -z.
    builder.addFaces(
        {{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}});
  }
  return builder.finish(streams);
}

VertexStreams thickenLines(Context& context, const VertexStreams& streams,
                           std::span<const std::uint32_t> indices, PrimitiveMode mode, double meshRadius,
                           const std::string& pointer, std::vector<std::uint32_t>& triangles) {
  const bool isList = mode == PrimitiveMode::Lines;
  if (isList && indices.size() % 2 != 0) context.count(Repair::LeftoverVertex);
  const std::size_t segments = isList ? indices.size() / 2 : indices.size();
  Builder builder(context, streams, segments, pointer, triangles);
  const double radius = solidRadius(meshRadius);
  for (std::size_t i = 0; i + 1 < indices.size(); i += isList ? 2 : 1)
    addPrism(context, streams, indices[i], indices[i + 1], radius, builder);
  if (mode == PrimitiveMode::LineLoop && indices.size() > 2)
    addPrism(context, streams, indices.back(), indices.front(), radius, builder);
  return builder.finish(streams);
}

}  // namespace catoptric::scene::gltf
