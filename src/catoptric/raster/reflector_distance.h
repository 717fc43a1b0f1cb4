// SPDX-License-Identifier: Apache-2.0
// How far away a mirror is, on which scale it bends, and whether a point lies behind all of it: what the
// tessellation asks for every vertex. All answers are functions of the point alone and err on the safe side.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::raster {

class ReflectorDistance {
 public:
  /// `reflectsBehind`: no point counts as lying behind it.
  ReflectorDistance(const scene::WorldGeometry& geometry, const scene::Part& part, bool reflectsBehind) {
    std::vector<vec3> surface, normals;
    std::vector<std::uint8_t> isListed(part.vertexCount, 0);
    vec3 sum(0);
    const std::uint32_t* corner = geometry.indices.data() + part.firstIndex;
    for (std::uint32_t i = 0; i < part.indexCount; ++i) {
      const std::uint32_t v = corner[i];
      sum += geometry.normals[v];
      if (std::exchange(isListed[v - part.firstVertex], 1) != 0) continue;
      surface.push_back(geometry.positions[v]);
      normals.push_back(geometry.normals[v]);
    }
    if (surface.empty()) return;
    for (std::uint32_t i = 0; i + 2 < part.indexCount; i += 3) {
      const vec3 &a = geometry.positions[corner[i]], &b = geometry.positions[corner[i + 1]],
                 &c = geometry.positions[corner[i + 2]];
      longestEdge_ = std::max({longestEdge_, glm::length(b - a), glm::length(c - b), glm::length(a - c)});
      surface.push_back((a + b + c) / 3.0f);
      normals.push_back(
          (geometry.normals[corner[i]] + geometry.normals[corner[i + 1]] + geometry.normals[corner[i + 2]]) /
          3.0f);
      sum += normals.back();
    }
    const std::uint32_t triangleCount = part.indexCount / 3;
    turnsRound_ = glm::length(sum) < kTurned * float(part.indexCount + triangleCount);
    pickSamples(surface, normals);
    focalLength_ = float(findFocalLength(geometry, part));
    hasBack_ = !reflectsBehind;
  }

  [[nodiscard]] float focalLength() const { return focalLength_; }
  /// Its normals point all around, as a ball's do: some of it is always seen edge-on.
  [[nodiscard]] bool turnsRound() const { return turnsRound_; }

  /// True where the point lies behind the tangent planes of all of the mirror, which then never reflects it.
  [[nodiscard]] bool isBehind(const vec3& p) const {
    if (!hasBack_) return false;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const vec3 d(p.x - x_[i], p.y - y_[i], p.z - z_[i]);
      // Between the samples the planes tilt by up to normalSpread_ and shift by up to coverRadius_.
      if (glm::dot(d, normals_[i]) > -(coverRadius_ + normalSpread_ * std::sqrt(glm::dot(d, d))))
        return false;
    }
    return true;
  }

  /// A lower bound, a function of the position alone.
  [[nodiscard]] float operator()(const vec3& p) const {
    float best = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const float dx = p.x - x_[i], dy = p.y - y_[i], dz = p.z - z_[i];
      const float squared = dx * dx + dy * dy + dz * dz;
      best = squared < best ? squared : best;
    }
    return std::max(0.0f, std::sqrt(best) - coverRadius_);
  }

 private:
  void pickSamples(const std::vector<vec3>& surface, const std::vector<vec3>& normals) {
    std::vector<float> squared(surface.size(), std::numeric_limits<float>::infinity());
    std::vector<std::size_t> nearest(surface.size(), 0);
    std::size_t farthest = 0;
    while (x_.size() < kSamples) {
      const vec3 sample = surface[farthest];
      x_.push_back(sample.x), y_.push_back(sample.y), z_.push_back(sample.z);
      normals_.push_back(normals[farthest]);
      farthest = 0;
      for (std::size_t i = 0; i < surface.size(); ++i) {
        const vec3 d = surface[i] - sample;
        if (glm::dot(d, d) < squared[i]) squared[i] = glm::dot(d, d), nearest[i] = x_.size() - 1;
        if (squared[i] > squared[farthest]) farthest = i;
      }
      coverRadius_ = std::sqrt(squared[farthest]);
      if (coverRadius_ == 0) break;
    }
    coverRadius_ += kInTriangle * longestEdge_;
    for (std::size_t i = 0; i < surface.size(); ++i)
      normalSpread_ = std::max(normalSpread_, glm::length(normals[i] - normals_[nearest[i]]));
  }

  /// Half the median radius of curvature, at most kFlattest times the size of the reflector.
  [[nodiscard]] static double findFocalLength(const scene::WorldGeometry& geometry, const scene::Part& part) {
    core::Box box;
    std::vector<double> curvatures;
    for (std::uint32_t i = part.firstIndex; i + 2 < part.firstIndex + part.indexCount; i += 3) {
      double curvature = 0;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = geometry.indices[i + k], b = geometry.indices[i + (k + 1) % 3];
        const dvec3 edge = dvec3(geometry.positions[b]) - dvec3(geometry.positions[a]);
        box.add(dvec3(geometry.positions[a]));
        const double length = glm::length(edge);
        if (length > 0)
          curvature = std::max(curvature,
                               glm::length(dvec3(geometry.normals[b]) - dvec3(geometry.normals[a])) / length);
      }
      curvatures.push_back(curvature);
    }
    std::nth_element(curvatures.begin(), curvatures.begin() + curvatures.size() / 2, curvatures.end());
    const double median = curvatures[curvatures.size() / 2], size = box.radius() / std::sqrt(3.0);
    return 0.5 / std::max(median, 0.5 / (kFlattest * size));
  }

  static constexpr std::size_t kSamples = 64;
  static constexpr double kFlattest = 8;
  static constexpr float kTurned = 0.5f;  // length of the mean normal: 0 for a ball, a half for half of it
  static constexpr float kInTriangle = 0.3f;  // of the longest edge: farthest from both corners and centroid

  std::vector<float> x_, y_, z_;
  std::vector<vec3> normals_;
  float coverRadius_ = 0, focalLength_ = 1, normalSpread_ = 0, longestEdge_ = 0;
  bool hasBack_ = false, turnsRound_ = false;
};

}  // namespace catoptric::raster
