// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/revolution_axis.h"

#include <algorithm>
#include <cmath>

#include "catoptric/geometry/symmetric_eigen.h"

namespace catoptric::geometry {
namespace {

constexpr double kMiss = 0.03;  // three times what a recognised shape's normals may be off

AxisFrame makeFrame(const dvec3& origin, const dvec3& axis) {
  const dvec3 z = glm::normalize(axis), helper = std::abs(z.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 x = glm::normalize(glm::cross(helper, z));
  return {origin, dmat3(x, glm::cross(z, x), z)};
}

/// The inverse of a symmetric matrix, where an eigenvalue is all but zero without it.
dmat3 invertWhereItCan(const dmat3& symmetric) {
  const Eigen3 eigen = computeEigen(symmetric);
  dmat3 inverse(0.0);
  for (int i = 0; i < 3; ++i)
    if (eigen.values[i] > 1e-12 * eigen.values[2])
      inverse += glm::outerProduct(eigen.vectors[i], eigen.vectors[i]) / eigen.values[i];
  return inverse;
}

/// By how much the normals miss the axis, times the sine between both: the root of the mean square, in sizes.
double measureMiss(const MeshView& mesh, const MeshScale& scale, const AxisFrame& frame) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 p = (dvec3(mesh.positions[i]) - frame.origin) / scale.size;
    const double miss = glm::dot(frame.axes[2], glm::cross(p, dvec3(mesh.normals[i])));
    sum += miss * miss;
  }
  return std::sqrt(sum / double(mesh.positions.size()));
}

}  // namespace

AxisFrame AxisFrame::moved(const dvec2& turn, const dvec3& move) const {
  return makeFrame(origin + axes * move, axes[2] + axes[0] * turn.y - axes[1] * turn.x);
}

MeshScale measureScale(const MeshView& mesh) {
  MeshScale scale;
  const double count = double(std::max<std::size_t>(mesh.positions.size(), 1));
  for (const vec3& p : mesh.positions) scale.centre += dvec3(p) / count;
  for (const vec3& p : mesh.positions) {
    const dvec3 d = dvec3(p) - scale.centre;
    scale.size += glm::dot(d, d) / count;
  }
  scale.size = std::sqrt(scale.size);
  return scale;
}

std::vector<AxisFrame> findRevolutionAxes(const MeshView& mesh) {
  const MeshScale scale = measureScale(mesh);
  if (!(scale.size > 0)) return {};
  // 1
  dmat3 a(0.0), b(0.0), c(0.0);
  dvec3 meanNormal(0);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 n(mesh.normals[i]);
    const dvec3 moment = glm::cross((dvec3(mesh.positions[i]) - scale.centre) / scale.size, n);
    a += glm::outerProduct(moment, moment);
    b += glm::outerProduct(moment, n);
    c += glm::outerProduct(n, n);
    meanNormal += n;
  }
  const dmat3 inverse = invertWhereItCan(c);
  dmat3 reduced = a - b * inverse * glm::transpose(b);
  reduced = 0.5 * (reduced + glm::transpose(reduced));
  dvec3 axis = computeEigen(reduced).vectors[0];
  if (glm::dot(axis, meanNormal) < 0) axis = -axis;
  const dvec3 axisMoment = -(inverse * (glm::transpose(b) * axis));
  std::vector<AxisFrame> frames{makeFrame(scale.centre + scale.size * glm::cross(axis, axisMoment), axis)};
  // 2
  if (glm::length(meanNormal) > 0.3 * double(mesh.positions.size()))
    frames.push_back(makeFrame(scale.centre, meanNormal));
  // 3
  std::erase_if(frames, [&](const AxisFrame& frame) { return !(measureMiss(mesh, scale, frame) < kMiss); });
  return frames;
}

}  // namespace catoptric::geometry
