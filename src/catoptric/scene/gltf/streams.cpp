// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/streams.h"

#include <fmt/format.h>

#include <cmath>

namespace catoptric::scene::gltf {
namespace {

/// Vectors of N floats of an accessor; empty for -1. A VEC3 read as vec4 (colours) gets 1 as its last
/// component.
template <class Vector>
std::vector<Vector> readVectors(const Data& data, int accessor) {
  if (accessor < 0) return {};
  constexpr std::size_t kWanted = std::size_t(Vector::length());
  const std::size_t given = componentCount(data.model().accessors[std::size_t(accessor)].element);
  const std::vector<float> floats = data.readFloats(accessor);
  const std::size_t count = floats.size() / given;
  data.context().charge(count, sizeof(Vector), fmt::format("/accessors/{}", accessor));
  std::vector<Vector> out(count, Vector(1.0f));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < std::min(kWanted, given); ++c) out[i][int(c)] = floats[i * given + c];
  return out;
}

/// Step 2.
void addTarget(const Data& data, const Attributes& target, float weight, VertexStreams& streams) {
  const std::vector<vec3> positions = readVectors<vec3>(data, findAttribute(target, "POSITION"));
  for (std::size_t i = 0; i < positions.size(); ++i) streams.positions[i] += weight * positions[i];
  const std::vector<vec3> normals = readVectors<vec3>(data, findAttribute(target, "NORMAL"));
  for (std::size_t i = 0; i < normals.size(); ++i) streams.normals[i] += weight * normals[i];
  const std::vector<vec3> tangents = readVectors<vec3>(data, findAttribute(target, "TANGENT"));
  for (std::size_t i = 0; i < tangents.size(); ++i) streams.tangents[i] += vec4(weight * tangents[i], 0.0f);
}

/// Carries normals, up to a positive factor; works for singular matrices too.
dmat3 cofactors(const dmat3& m) {
  return dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
}

vec3 normalizedOrZero(const dvec3& v) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? vec3(v / length) : vec3(0.0f);
}

void transformVertex(const dmat4& matrix, std::size_t i, VertexStreams& streams) {
  streams.positions[i] = vec3(dvec3(matrix * dvec4(dvec3(streams.positions[i]), 1.0)));
  const dmat3 linear(matrix);
  const double sign = glm::determinant(linear) < 0 ? -1 : 1;
  if (!streams.normals.empty())
    streams.normals[i] = normalizedOrZero(sign * (cofactors(linear) * dvec3(streams.normals[i])));
  if (!streams.tangents.empty())
    streams.tangents[i] =
        vec4(normalizedOrZero(linear * dvec3(streams.tangents[i])), float(sign) * streams.tangents[i].w);
}

/// Joints and weights of all sets, side by side: `perVertex` of each for every vertex.
struct Influences {
  std::size_t perVertex = 0;
  std::vector<std::vector<std::uint32_t>> joints;
  std::vector<std::vector<float>> weights;
};

Influences readInfluences(const Data& data, const Primitive& primitive) {
  Influences out;
  for (int set = 0;; ++set) {
    const int joints = findAttribute(primitive.attributes, fmt::format("JOINTS_{}", set));
    const int weights = findAttribute(primitive.attributes, fmt::format("WEIGHTS_{}", set));
    if (joints < 0 || weights < 0) return out;
    out.joints.push_back(data.readIntegers(joints));
    out.weights.push_back(data.readFloats(weights));
  }
}

/// Weighted sum of joint matrices of vertex i; weights are made non-negative with the sum 1.
dmat4 blendMatrices(const Data& data, const Influences& influences, const SkinPose& skin, std::size_t i,
                    const std::string& pointer) {
  dmat4 sum(0.0);
  double total = 0;
  bool isRepaired = false;
  for (std::size_t set = 0; set < influences.joints.size(); ++set)
    for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
      double weight = influences.weights[set][k];
      const std::size_t joint = influences.joints[set][k];
      if (!(weight >= 0) || weight > 1e6) {
        weight = 0;
        isRepaired = true;
      }
      if (weight == 0) continue;
      if (joint >= skin.worldFromVertex.size())
        data.context().fail("gltf.index_out_of_range",
                            fmt::format("vertex {} hangs on joint {} of a skin with {}", i, joint,
                                        skin.worldFromVertex.size()),
                            fmt::format("{}/attributes/JOINTS_{}", pointer, set));
      sum += weight * skin.worldFromVertex[joint];
      total += weight;
    }
  if (isRepaired || std::abs(total - 1) > 0.02) data.context().count(Repair::SkinWeights);
  if (total > 0) return sum / total;
  return skin.worldFromVertex.empty() ? skin.worldFromNode : skin.worldFromVertex[0];
}

/// Step 3.
void applySkin(const Data& data, const Primitive& primitive, const SkinPose& skin, const std::string& pointer,
               VertexStreams& streams) {
  const Influences influences = readInfluences(data, primitive);
  std::size_t mirrored = 0;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const dmat4 matrix =
        influences.joints.empty() ? skin.worldFromNode : blendMatrices(data, influences, skin, i, pointer);
    mirrored += glm::determinant(dmat3(matrix)) < 0 ? 1 : 0;
    transformVertex(matrix, i, streams);
  }
  streams.flipWinding = 2 * mirrored > streams.size();
}

template <class Value>
std::vector<Value> pick(const std::vector<Value>& from, std::span<const std::uint32_t> order) {
  std::vector<Value> out;
  if (from.empty()) return out;
  out.reserve(order.size());
  for (const std::uint32_t i : order) out.push_back(from[i]);
  return out;
}

}  // namespace

VertexStreams readStreams(const Data& data, const Primitive& primitive, std::span<const float> weights,
                          const SkinPose* skin, const std::string& pointer) {
  VertexStreams streams;
  const auto accessor = [&](const char* semantic) { return findAttribute(primitive.attributes, semantic); };
  streams.positions = readVectors<vec3>(data, accessor("POSITION"));
  streams.normals = readVectors<vec3>(data, accessor("NORMAL"));
  // Without normals the tangents must be ignored (glTF 2.0 section 3.7.2.1).
  if (!streams.normals.empty()) streams.tangents = readVectors<vec4>(data, accessor("TANGENT"));
  streams.uv[0] = readVectors<vec2>(data, accessor("TEXCOORD_0"));
  streams.uv[1] = readVectors<vec2>(data, accessor("TEXCOORD_1"));
  streams.colors = readVectors<vec4>(data, accessor("COLOR_0"));
  for (std::size_t i = 0; i < weights.size() && i < primitive.targets.size(); ++i)
    if (weights[i] != 0) {
      Attributes target = primitive.targets[i];
      if (streams.tangents.empty())
        std::erase_if(target, [](const auto& entry) { return entry.first == "TANGENT"; });
      addTarget(data, target, weights[i], streams);
    }
  if (skin != nullptr) applySkin(data, primitive, *skin, pointer, streams);
  return streams;
}

VertexStreams reorder(const VertexStreams& streams, std::span<const std::uint32_t> order) {
  return {.positions = pick(streams.positions, order),
          .normals = pick(streams.normals, order),
          .tangents = pick(streams.tangents, order),
          .uv = {pick(streams.uv[0], order), pick(streams.uv[1], order)},
          .colors = pick(streams.colors, order),
          .sources = pick(streams.sources, order),
          .flipWinding = streams.flipWinding};
}

std::size_t bytesPerVertex(const VertexStreams& streams) {
  std::size_t bytes = sizeof(vec3);
  if (!streams.normals.empty()) bytes += sizeof(vec3);
  if (!streams.tangents.empty()) bytes += sizeof(vec4);
  for (const auto& uv : streams.uv)
    if (!uv.empty()) bytes += sizeof(vec2);
  if (!streams.colors.empty()) bytes += sizeof(vec4);
  if (!streams.sources.empty()) bytes += sizeof(std::uint32_t);
  return bytes;
}

}  // namespace catoptric::scene::gltf
