// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "catoptric/scene/gltf/attribute_repair.h"
#include "catoptric/scene/gltf/deformation_source.h"
#include "catoptric/scene/gltf/points_lines.h"

namespace catoptric::scene::gltf {
namespace {

using Indices = std::vector<std::uint32_t>;

/// The value that OpenGL could take for a primitive restart.
std::uint32_t restartValue(ComponentType type) {
  if (type == ComponentType::Uint8) return 0xFFu;
  if (type == ComponentType::Uint16) return 0xFFFFu;
  return 0xFFFFFFFFu;
}

/// Step 2. Without an index accessor the vertices count as they come.
Indices readIndices(const Data& data, const Primitive& primitive, std::size_t vertexCount,
                    const std::string& pointer) {
  if (primitive.indices < 0) {
    data.context().charge(vertexCount, sizeof(std::uint32_t), pointer);
    Indices indices(vertexCount);
    std::iota(indices.begin(), indices.end(), 0u);
    return indices;
  }
  Indices indices = data.readIntegers(primitive.indices);
  const std::uint32_t restart =
      restartValue(data.model().accessors[std::size_t(primitive.indices)].component);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] == restart)
      data.context().fail(
          "gltf.accessor_data",
          fmt::format("index {} is the primitive restart value {}, which glTF forbids", i, restart),
          pointer + "/indices");
    if (indices[i] >= vertexCount)
      data.context().fail(
          "gltf.index_out_of_range",
          fmt::format("index {} names vertex {} of a primitive that has {}", i, indices[i], vertexCount),
          pointer + "/indices");
  }
  return indices;
}

/// Step 3.
Indices makeTriangles(Context& context, const Indices& in, PrimitiveMode mode, const std::string& pointer) {
  if (mode == PrimitiveMode::Triangles) {
    if (in.size() % 3 != 0) context.count(Repair::LeftoverVertex, in.size() % 3);
    return {in.begin(), in.end() - std::ptrdiff_t(in.size() % 3)};
  }
  Indices out;
  if (in.size() < 3) {
    context.count(Repair::LeftoverVertex, in.size());
    return out;
  }
  context.charge(in.size() - 2, 3 * sizeof(std::uint32_t), pointer);
  out.reserve(3 * (in.size() - 2));
  for (std::size_t i = 0; i + 2 < in.size(); ++i) {
    if (mode == PrimitiveMode::TriangleStrip)
      out.insert(out.end(), {in[i], in[i + 1 + i % 2], in[i + 2 - i % 2]});
    else
      out.insert(out.end(), {in[i + 1], in[i + 2], in[0]});
  }
  return out;
}

/// Twice the area times the normal; exact enough for coordinates up to 1e15 and down to 1e-30.
dvec3 areaNormal(const VertexStreams& streams, const std::uint32_t* corner) {
  const dvec3 a(streams.positions[corner[0]]), b(streams.positions[corner[1]]),
      c(streams.positions[corner[2]]);
  return glm::cross(b - a, c - a);
}

/// Step 4, in place. `isStrip`: repeated indices join strips and are no fault.
void dropBadTriangles(Context& context, const VertexStreams& streams, bool isStrip, Indices& triangles) {
  std::size_t kept = 0, nonFinite = 0, huge = 0, degenerate = 0;
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const std::uint32_t* t = &triangles[i];
    const auto all = [&](auto&& test) {
      return test(streams.positions[t[0]]) && test(streams.positions[t[1]]) && test(streams.positions[t[2]]);
    };
    if (!all(isFinite)) {
      ++nonFinite;
    } else if (!all(isUsable)) {
      ++huge;
    } else if (const dvec3 n = areaNormal(streams, t); glm::dot(n, n) == 0) {
      const bool isJoin = isStrip && (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]);
      degenerate += isJoin ? 0 : 1;
    } else {
      for (std::size_t k = 0; k < 3; ++k) triangles[kept++] = t[k];
    }
  }
  triangles.resize(kept);
  context.count(Repair::NonFiniteTriangle, nonFinite);
  context.count(Repair::HugeTriangle, huge);
  context.count(Repair::DegenerateTriangle, degenerate);
}

/// Step 6: keeps the vertices that triangles use, in their order.
void removeUnusedVertices(Context& context, VertexStreams& streams, Indices& triangles,
                          const std::string& pointer) {
  constexpr std::uint32_t kUnused = 0xFFFFFFFFu;
  context.charge(streams.size(), sizeof(std::uint32_t), pointer);
  std::vector<std::uint32_t> newIndex(streams.size(), kUnused), order;
  for (const std::uint32_t i : triangles) newIndex[i] = 0;
  for (std::size_t i = 0; i < newIndex.size(); ++i)
    if (newIndex[i] != kUnused) {
      newIndex[i] = std::uint32_t(order.size());
      order.push_back(std::uint32_t(i));
    }
  if (order.size() == streams.size()) return;
  context.charge(order.size(), bytesPerVertex(streams), pointer);
  streams = reorder(streams, order);
  for (std::uint32_t& i : triangles) i = newIndex[i];
}

/// Step 5, no normals: three vertices of their own for each triangle.
void makeFlat(Context& context, VertexStreams& streams, Indices& triangles, const std::string& pointer) {
  context.charge(triangles.size(), bytesPerVertex(streams) + sizeof(vec3), pointer);
  streams = reorder(streams, triangles);
  std::iota(triangles.begin(), triangles.end(), 0u);
  streams.normals.resize(streams.size());
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const vec3 normal(glm::normalize(areaNormal(streams, &triangles[i])));
    for (std::size_t k = 0; k < 3; ++k) streams.normals[i + k] = normal;
  }
}

MeshPrimitive finish(Context& context, VertexStreams&& streams, Indices&& triangles, int material) {
  repairNormals(context, streams, triangles);
  repairTangents(context, streams);
  repairTexCoords(context, streams);
  repairColors(context, streams);
  return {.positions = std::move(streams.positions),
          .normals = std::move(streams.normals),
          .tangents = std::move(streams.tangents),
          .uv = {std::move(streams.uv[0]), std::move(streams.uv[1])},
          .colors = std::move(streams.colors),
          .indices = std::move(triangles),
          .material = material};
}

MeshPrimitive makePrimitive(Context& context, VertexStreams&& streams, const Indices& indices,
                            PrimitiveMode mode, double meshRadius, int material, const std::string& pointer,
                            std::vector<std::uint32_t>& sources) {
  Indices triangles;
  if (mode == PrimitiveMode::Points) {
    streams = thickenPoints(context, streams, indices, meshRadius, pointer, triangles);
  } else if (mode <= PrimitiveMode::LineStrip) {
    streams = thickenLines(context, streams, indices, mode, meshRadius, pointer, triangles);
  } else {
    triangles = makeTriangles(context, indices, mode, pointer);
    dropBadTriangles(context, streams, mode == PrimitiveMode::TriangleStrip, triangles);
    if (streams.flipWinding)
      for (std::size_t i = 0; i < triangles.size(); i += 3) std::swap(triangles[i + 1], triangles[i + 2]);
    if (streams.normals.empty())
      makeFlat(context, streams, triangles, pointer);
    else
      removeUnusedVertices(context, streams, triangles, pointer);
  }
  sources = std::move(streams.sources);
  return finish(context, std::move(streams), std::move(triangles), material);
}

void numberSources(Context& context, VertexStreams& streams, const std::string& pointer) {
  context.charge(streams.size(), sizeof(std::uint32_t), pointer);
  streams.sources.resize(streams.size());
  std::iota(streams.sources.begin(), streams.sources.end(), 0u);
}

/// Of all vertices that can be drawn.
double boundingRadius(const std::vector<VertexStreams>& primitives) {
  core::Box box;
  for (const VertexStreams& streams : primitives)
    for (const vec3& p : streams.positions)
      if (isUsable(p)) box.add(dvec3(p));
  return box.radius();
}

}  // namespace

bool isFinite(const vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isUsable(const vec3& p) {
  return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate &&
         std::abs(p.z) <= kLargestCoordinate;
}

Mesh readMesh(const Data& data, int index, std::span<const float> weights, const SkinPose* skin,
              int defaultMaterial, bool keepsDeformation) {
  Context& context = data.context();
  const MeshSource& source = data.model().meshes[std::size_t(index)];
  const auto pointerTo = [&](std::size_t i) { return fmt::format("/meshes/{}/primitives/{}", index, i); };
  std::vector<VertexStreams> streams;
  for (std::size_t i = 0; i < source.primitives.size(); ++i)
    streams.push_back(readStreams(data, source.primitives[i], weights, skin, pointerTo(i)));
  const double radius = boundingRadius(streams);

  Mesh mesh{.name = source.name, .primitives = {}};
  for (std::size_t i = 0; i < source.primitives.size(); ++i) {
    const Primitive& primitive = source.primitives[i];
    if (streams[i].size() == 0) {
      context.warn("a mesh primitive has no POSITION and was left out");
      continue;
    }
    const Indices indices = readIndices(data, primitive, streams[i].size(), pointerTo(i));
    const int material = primitive.material >= 0 ? primitive.material : defaultMaterial;
    if (keepsDeformation) numberSources(context, streams[i], pointerTo(i));
    std::vector<std::uint32_t> sources;
    MeshPrimitive made = makePrimitive(context, std::move(streams[i]), indices, primitive.mode, radius,
                                       material, pointerTo(i), sources);
    if (keepsDeformation && !sources.empty())
      made.deformation = readDeformation(data, primitive, sources, skin != nullptr, made);
    if (!made.indices.empty()) mesh.primitives.push_back(std::move(made));
  }
  return mesh;
}

}  // namespace catoptric::scene::gltf
