// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/sweep.h"

#include <cassert>
#include <cmath>

#include "catoptric/geometry/shapes.h"

namespace catoptric::geometry {
namespace {

constexpr double kTwoPi = 6.283185307179586;

double cross2(const dvec2& a, const dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

bool isInside(const dvec2& p, const dvec2& a, const dvec2& b, const dvec2& c) {
  return cross2(b - a, p - a) >= 0 && cross2(c - b, p - b) >= 0 && cross2(a - c, p - c) >= 0;
}

/// Whether the corner at place `i` of the remaining polygon can be cut off.
bool isEar(std::span<const dvec2> points, const std::vector<std::uint32_t>& rest, std::size_t i) {
  const std::size_t n = rest.size();
  const dvec2 a = points[rest[(i + n - 1) % n]], b = points[rest[i]], c = points[rest[(i + 1) % n]];
  if (cross2(b - a, c - b) <= 0) return false;
  for (std::size_t k = 0; k < n; ++k) {
    if (k == i || k == (i + 1) % n || k == (i + n - 1) % n) continue;
    if (isInside(points[rest[k]], a, b, c)) return false;
  }
  return true;
}

Mesh makeCap(std::span<const dvec2> outline, double z, bool facesFront) {
  Mesh mesh;
  for (const dvec2& p : outline) {
    mesh.positions.push_back(vec3(float(p.x), float(p.y), float(z)));
    mesh.normals.push_back(vec3(0, 0, facesFront ? 1 : -1));
    mesh.uv.push_back(vec2(facesFront ? p.x : -p.x, -p.y));
  }
  mesh.indices = triangulate(outline);
  if (!facesFront)
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  return mesh;
}

}  // namespace

std::vector<std::uint32_t> triangulate(std::span<const dvec2> outline) {
  std::vector<std::uint32_t> rest, triangles;
  for (std::uint32_t i = 0; i < outline.size(); ++i) rest.push_back(i);
  while (rest.size() > 2) {
    std::size_t ear = 0;
    while (ear < rest.size() && !isEar(outline, rest, ear)) ++ear;
    if (ear == rest.size()) ear = 0;  // only collinear corners are left: any cut closes the polygon
    const std::size_t n = rest.size();
    triangles.insert(triangles.end(), {rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]});
    rest.erase(rest.begin() + std::ptrdiff_t(ear));
  }
  return triangles;
}

Mesh makeExtrusion(std::span<const dvec2> outline, double depth, double creaseAngleRadians) {
  assert(outline.size() >= 3);
  Mesh side;
  double along = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    const double z = 0.5 * depth;
    Mesh quad =
        makeQuad(dvec3(a, -z), dvec3(b, -z), dvec3(b, z), dvec3(a, z));  // outside is to the right of a -> b
    const double length = glm::distance(a, b);
    for (vec2& t : quad.uv) t = vec2(float(along + t.x * length), float(t.y * depth));
    along += length;
    append(side, quad);
  }
  if (creaseAngleRadians > 0) side = withSmoothNormals(side, creaseAngleRadians);
  append(side, makeCap(outline, 0.5 * depth, true));
  append(side, makeCap(outline, -0.5 * depth, false));
  return side;
}

Mesh makeLathe(std::span<const dvec2> profile, int segmentsAround, double creaseAngleRadians) {
  assert(profile.size() >= 2 && segmentsAround >= 3);
  Mesh mesh;
  const auto rows = std::uint32_t(profile.size());
  const double bottom = profile.front().y, height = std::max(1e-9, std::abs(profile.back().y - bottom));
  for (int column = 0; column <= segmentsAround; ++column)
    for (const dvec2& p : profile) {
      const double angle = kTwoPi * double(column % segmentsAround) / segmentsAround;
      mesh.positions.push_back(vec3(dvec3(p.x * std::sin(angle), p.y, p.x * std::cos(angle))));
      mesh.normals.push_back(vec3(0, 1, 0));
      mesh.uv.push_back(vec2(float(column) / float(segmentsAround), float(1 - (p.y - bottom) / height)));
    }
  for (int column = 0; column < segmentsAround; ++column)
    for (std::uint32_t row = 0; row + 1 < rows; ++row) {
      const std::uint32_t a = std::uint32_t(column) * rows + row, b = a + rows;
      if (profile[row].x > 0) mesh.indices.insert(mesh.indices.end(), {a, b, b + 1});
      if (profile[row + 1].x > 0) mesh.indices.insert(mesh.indices.end(), {a, b + 1, a + 1});
    }
  return withSmoothNormals(mesh, creaseAngleRadians);
}

Mesh makeLoft(std::span<const std::vector<dvec3>> rings, double creaseAngleRadians) {
  assert(rings.size() >= 2);
  Mesh mesh;
  const auto around = std::uint32_t(rings[0].size());
  for (const std::vector<dvec3>& ring : rings) {
    assert(ring.size() == around);
    for (const dvec3& p : ring) {
      mesh.positions.push_back(vec3(p));
      mesh.normals.push_back(vec3(0, 1, 0));
    }
  }
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r)
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t a = r * around + i, b = r * around + (i + 1) % around;
      mesh.indices.insert(mesh.indices.end(), {a, b, b + around, a, b + around, a + around});
    }
  return withSmoothNormals(mesh, creaseAngleRadians);
}

}  // namespace catoptric::geometry
