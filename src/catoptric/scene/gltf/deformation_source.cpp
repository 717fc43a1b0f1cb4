// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/deformation_source.h"

#include <fmt/format.h>

#include <cmath>

#include "catoptric/scene/gltf/streams.h"

namespace catoptric::scene::gltf {
namespace {

/// Differences of one attribute of a target, in the order of the made vertices; empty if the target has none.
std::vector<vec3> readDifferences(const Data& data, const Attributes& target, const char* semantic,
                                  std::span<const std::uint32_t> sources) {
  const int accessor = findAttribute(target, semantic);
  if (accessor < 0) return {};
  const std::vector<float> floats = data.readFloats(accessor);
  data.context().charge(sources.size(), sizeof(vec3));
  std::vector<vec3> out;
  for (const std::uint32_t v : sources) {
    vec3 d(floats[3 * std::size_t(v)], floats[3 * std::size_t(v) + 1], floats[3 * std::size_t(v) + 2]);
    if (!(std::abs(d.x) <= 1e15f && std::abs(d.y) <= 1e15f && std::abs(d.z) <= 1e15f)) {
      data.context().warn("numbers of morph targets that are not finite or beyond 1e15 were taken for zero");
      d = vec3(0);
    }
    out.push_back(d);
  }
  return out;
}

/// Joints and weights side by side. Joint indices were checked when the rest pose was made.
void readJoints(const Data& data, const Primitive& primitive, std::span<const std::uint32_t> sources,
                Deformation& out) {
  std::vector<std::vector<std::uint32_t>> joints;
  std::vector<std::vector<float>> weights;
  for (int set = 0;; ++set) {
    const int j = findAttribute(primitive.attributes, fmt::format("JOINTS_{}", set));
    const int w = findAttribute(primitive.attributes, fmt::format("WEIGHTS_{}", set));
    if (j < 0 || w < 0) break;
    joints.push_back(data.readIntegers(j));
    weights.push_back(data.readFloats(w));
  }
  out.influences = 4 * joints.size();
  data.context().charge(sources.size() * out.influences, sizeof(float) + sizeof(std::uint32_t));
  for (const std::uint32_t v : sources) {
    const std::size_t first = out.jointWeights.size();
    double total = 0;
    for (std::size_t set = 0; set < joints.size(); ++set)
      for (std::size_t k = 4 * std::size_t(v); k < 4 * std::size_t(v) + 4; ++k) {
        const float weight = weights[set][k] >= 0 && weights[set][k] <= 1e6f ? weights[set][k] : 0.0f;
        out.joints.push_back(weight > 0 ? joints[set][k] : 0u);
        out.jointWeights.push_back(weight);
        total += weight;
      }
    if (total <= 0 && out.influences > 0) out.jointWeights[first] = 1.0f, total = 1;
    for (std::size_t k = first; k < out.jointWeights.size(); ++k)
      out.jointWeights[k] = float(out.jointWeights[k] / total);
  }
}

}  // namespace

Deformation readDeformation(const Data& data, const Primitive& primitive,
                            std::span<const std::uint32_t> sources, bool isSkinned,
                            const MeshPrimitive& made) {
  VertexStreams base = readStreams(data, primitive, {}, nullptr, {});
  data.context().charge(sources.size(), bytesPerVertex(base));
  base = reorder(base, sources);
  Deformation out;
  out.positions = std::move(base.positions);
  out.normals = std::move(base.normals);
  out.tangents = std::move(base.tangents);
  for (std::size_t i = 0; i < out.normals.size(); ++i)  // what was repaired at rest is repaired here
    if (const float length = glm::length(out.normals[i]); !(length > 1e-20f && std::isfinite(length)))
      out.normals[i] = made.normals[i];
  for (std::size_t i = 0; i < out.tangents.size(); ++i)
    out.tangents[i].w = out.tangents[i].w < 0 ? -1.0f : 1.0f;
  for (const Attributes& target : primitive.targets)
    out.targets.push_back({readDifferences(data, target, "POSITION", sources),
                           readDifferences(data, target, "NORMAL", sources),
                           readDifferences(data, target, "TANGENT", sources)});
  if (isSkinned) readJoints(data, primitive, sources, out);
  return out;
}

}  // namespace catoptric::scene::gltf
