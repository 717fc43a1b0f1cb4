// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/mixed/mirror_parts.h"

#include <algorithm>
#include <cmath>

namespace catoptric::virtual_object {
namespace {

constexpr double kFlat = 0.02;         // of the larger curvature: less is no bulge
constexpr double kLeastShare = 0.004;  // of the mirror's area

double areaOf(const MirrorTriangle& t) {
  return 0.5 * glm::length(glm::cross(t.edge1, t.edge2));
}

Bend findBend(const ReflectorMesh& mesh, std::size_t triangle) {
  const auto [most, least] = computeCurvatures(mesh.triangles()[triangle]);
  // 1
  if (mesh.isConvexAt(triangle) && least >= -kFlat * std::abs(most)) return Bend::Convex;
  // 2
  return most <= kFlat * std::abs(least) ? Bend::Hollow : Bend::Saddle;
}

/// The triangles of one kind that hang together with the first; `bends` loses them.
std::vector<std::uint32_t> takeConnected(const ReflectorMesh& mesh, std::uint32_t first,
                                         const std::vector<Bend>& bends, std::vector<std::uint8_t>& isTaken) {
  std::vector<std::uint32_t> found{first};
  isTaken[first] = 1;
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const std::uint32_t link : mesh.triangles()[found[i]].neighbours) {
      const std::uint32_t next = link / 4;
      if (link == kNoNeighbour || next >= mesh.ordinaryCount() || isTaken[next] != 0) continue;
      if (bends[next] != bends[first]) continue;
      isTaken[next] = 1;
      found.push_back(next);
    }
  std::sort(found.begin(), found.end());
  return found;
}

MirrorPart makePart(const ReflectorMesh& mesh, Bend bend, const std::vector<std::uint32_t>& triangles) {
  MirrorPart part;
  part.bend = bend;
  std::vector<std::uint32_t> numberOf(mesh.positions().size(), core::kNoId), indices;
  std::vector<vec3> positions, normals;
  for (const std::uint32_t t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.corners()[3 * t + k];
      part.corners.push_back(v);
      if (numberOf[v] == core::kNoId) {
        numberOf[v] = std::uint32_t(positions.size());
        positions.emplace_back(mesh.positions()[v]);
        normals.emplace_back(mesh.normals()[v]);
      }
      indices.push_back(numberOf[v]);
    }
  part.mesh = std::make_unique<ReflectorMesh>(positions, normals, indices);
  return part;
}

}  // namespace

std::array<double, 2> computeCurvatures(const MirrorTriangle& t) {
  // The second fundamental form in the basis of the edges, the normals' lengths divided out.
  const dvec3 n = t.normal0 + (t.normal1 + t.normal2) / 3.0;
  const double scale = 1.0 / glm::length(n);
  const double b11 = scale * glm::dot(t.edge1, t.normal1), b22 = scale * glm::dot(t.edge2, t.normal2),
               b12 = scale * 0.5 * (glm::dot(t.edge1, t.normal2) + glm::dot(t.edge2, t.normal1));
  // Eigenvalues of (inverse Gram) B by trace and determinant.
  const double trace = t.gram11 * b11 + 2.0 * t.gram12 * b12 + t.gram22 * b22;
  const double determinant = (t.gram11 * t.gram22 - t.gram12 * t.gram12) * (b11 * b22 - b12 * b12);
  const double root = std::sqrt(std::max(0.25 * trace * trace - determinant, 0.0));
  return {0.5 * trace + root, 0.5 * trace - root};
}

CutMirror cutIntoParts(const ReflectorMesh& mesh) {
  std::vector<Bend> bends(mesh.ordinaryCount());
  std::vector<std::uint8_t> isTaken(mesh.ordinaryCount(), 0);
  double area = 0;
  for (std::size_t t = 0; t < bends.size(); ++t) {
    bends[t] = findBend(mesh, t);
    area += areaOf(mesh.triangles()[t]);
  }
  // 3
  CutMirror cut;
  for (std::uint32_t t = 0; t < bends.size(); ++t) {
    if (isTaken[t] != 0) continue;
    const std::vector<std::uint32_t> triangles = takeConnected(mesh, t, bends, isTaken);
    double share = 0;
    for (const std::uint32_t i : triangles) share += areaOf(mesh.triangles()[i]) / area;
    if (share < kLeastShare) {
      for (const std::uint32_t i : triangles)
        for (std::size_t k = 0; k < 3; ++k) cut.leftOut.push_back(mesh.corners()[3 * std::size_t(i) + k]);
      continue;
    }
    cut.parts.push_back(makePart(mesh, bends[t], triangles));
    cut.parts.back().areaShare = share;
  }
  std::stable_sort(cut.parts.begin(), cut.parts.end(),
                   [](const MirrorPart& a, const MirrorPart& b) { return a.areaShare > b.areaShare; });
  return cut;
}

}  // namespace catoptric::virtual_object
