// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/shapes.h"

#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <map>

namespace catoptric::geometry {
namespace {

constexpr double kTwoPi = 6.283185307179586;

struct GridVertex {
  dvec3 position, normal;
  dvec2 uv;
};

void addVertex(Mesh& mesh, const GridVertex& v) {
  mesh.positions.push_back(vec3(v.position));
  mesh.normals.push_back(vec3(v.normal));
  mesh.uv.push_back(vec2(v.uv));
}

/// (columns + 1) x (rows + 1) vertices; column to the right, row downwards as seen from the front. Cells are
/// cut along alternating diagonals nowhere: all along the same one, so that neighbours of equal grids match.
Mesh makeGrid(int columns, int rows, const std::function<GridVertex(int, int)>& vertex) {
  Mesh mesh;
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column) addVertex(mesh, vertex(column, row));
  const auto at = [&](int column, int row) { return std::uint32_t(row * (columns + 1) + column); };
  const auto differ = [&](std::uint32_t a, std::uint32_t b) {
    return mesh.positions[a] != mesh.positions[b];
  };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (differ(a, b) && differ(b, c) && differ(c, a)) mesh.indices.insert(mesh.indices.end(), {a, b, c});
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      add(at(column, row), at(column, row + 1), at(column + 1, row + 1));
      add(at(column, row), at(column + 1, row + 1), at(column + 1, row));
    }
  return mesh;
}

/// Direction on the unit circle for step `i` of `n`; exactly periodic, so that seams close.
dvec2 circlePoint(int i, int n) {
  const double angle = kTwoPi * double(i % n) / n;
  return {std::cos(angle), std::sin(angle)};
}

const double kGolden = 0.5 * (1.0 + std::sqrt(5.0));

const std::array<dvec3, 12>& icosahedronCorners() {
  static const std::array<dvec3, 12> corners = {
      dvec3(-1, kGolden, 0), dvec3(1, kGolden, 0), dvec3(-1, -kGolden, 0), dvec3(1, -kGolden, 0),
      dvec3(0, -1, kGolden), dvec3(0, 1, kGolden), dvec3(0, -1, -kGolden), dvec3(0, 1, -kGolden),
      dvec3(kGolden, 0, -1), dvec3(kGolden, 0, 1), dvec3(-kGolden, 0, -1), dvec3(-kGolden, 0, 1)};
  return corners;
}

constexpr int kIcosahedronFaces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                          {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                          {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                          {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};

/// Vertices of the subdivided icosahedron by their integer weights on its corners, so that edges share
/// theirs.
class IcosphereBuilder {
 public:
  IcosphereBuilder(double radius, int frequency) : radius_(radius), frequency_(frequency) {}

  Mesh build() {
    for (const auto& face : kIcosahedronFaces)
      for (int i = 0; i < frequency_; ++i)
        for (int j = 0; j < frequency_ - i; ++j) {
          addTriangle(vertex(face, i, j), vertex(face, i + 1, j), vertex(face, i, j + 1));
          if (i + j + 2 <= frequency_)
            addTriangle(vertex(face, i + 1, j), vertex(face, i + 1, j + 1), vertex(face, i, j + 1));
        }
    return std::move(mesh_);
  }

 private:
  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
  }

  std::uint32_t vertex(const int (&face)[3], int i, int j) {
    const int weights[3] = {frequency_ - i - j, i, j};
    std::array<int, 12> key{};
    for (int k = 0; k < 3; ++k) key[std::size_t(face[k])] = weights[k];
    const auto [entry, isNew] = made_.try_emplace(key, std::uint32_t(mesh_.positions.size()));
    if (isNew) {
      dvec3 sum(0);
      for (std::size_t k = 0; k < 12; ++k) sum += double(key[k]) * icosahedronCorners()[k];
      const dvec3 n = glm::normalize(sum);
      mesh_.positions.push_back(vec3(radius_ * n));
      mesh_.normals.push_back(vec3(n));
    }
    return entry->second;
  }

  double radius_;
  int frequency_;
  Mesh mesh_;
  std::map<std::array<int, 12>, std::uint32_t> made_;
};

}  // namespace

Mesh makeIcosphere(double radius, int frequency) {
  assert(radius > 0 && frequency >= 1);
  return IcosphereBuilder(radius, frequency).build();
}

Mesh makeUvSphere(double radius, int segmentsAround, int rings) {
  return makeGrid(segmentsAround, rings, [&](int column, int row) {
    const double latitude = 0.5 * kTwoPi * row / rings;  // from the north pole
    const double ring = row == 0 || row == rings ? 0.0 : std::sin(latitude);
    const dvec2 c = circlePoint(column, segmentsAround);
    const dvec3 n(ring * c.y, row == 0 ? 1.0 : row == rings ? -1.0 : std::cos(latitude), ring * c.x);
    return GridVertex{radius * n, n, {double(column) / segmentsAround, double(row) / rings}};
  });
}

Mesh makeCylinderSide(double radius, double height, int segmentsAround, int rows, bool withUv) {
  Mesh mesh = makeGrid(segmentsAround, rows, [&](int column, int row) {
    const dvec2 c = circlePoint(column, segmentsAround);
    const dvec3 n(c.y, 0, c.x);
    return GridVertex{dvec3(radius * n.x, height * (0.5 - double(row) / rows), radius * n.z),
                      n,
                      {double(column) / segmentsAround, double(row) / rows}};
  });
  return withUv ? mesh : welded(mesh, 1e-7 * (radius + height), 1e-4);
}

Mesh makeDisc(double radius, double y, int segmentsAround, bool facesUp) {
  Mesh mesh;
  const dvec3 n(0, facesUp ? 1 : -1, 0);
  addVertex(mesh, {dvec3(0, y, 0), n, {0.5, 0.5}});
  for (int i = 0; i < segmentsAround; ++i) {
    const dvec2 c = circlePoint(i, segmentsAround);
    addVertex(
        mesh,
        {dvec3(radius * c.y, y, radius * c.x), n, {0.5 + 0.5 * c.y, 0.5 + 0.5 * (facesUp ? c.x : -c.x)}});
  }
  for (int i = 0; i < segmentsAround; ++i) {
    auto a = std::uint32_t(1 + i), b = std::uint32_t(1 + (i + 1) % segmentsAround);
    if (!facesUp) std::swap(a, b);
    mesh.indices.insert(mesh.indices.end(), {0u, a, b});
  }
  return mesh;
}

Mesh makeCylinder(double radius, double height, int segmentsAround) {
  Mesh mesh = makeCylinderSide(radius, height, segmentsAround, 1, true);
  append(mesh, makeDisc(radius, 0.5 * height, segmentsAround, true));
  append(mesh, makeDisc(radius, -0.5 * height, segmentsAround, false));
  return mesh;
}

Mesh makeCone(double bottomRadius, double topRadius, double height, int segmentsAround, bool capped) {
  const double slope = (bottomRadius - topRadius) / height;  // outward tilt of the normal
  const int rows =
      topRadius > 0 ? 1 : 6;  // towards a tip the normals turn fast: several rows keep them apart
  Mesh mesh = makeGrid(segmentsAround, rows, [&](int column, int row) {
    const double t = double(row) / rows, radius = topRadius + (bottomRadius - topRadius) * t;
    const dvec2 c = circlePoint(column, segmentsAround);
    // At a tip each wedge takes the normal of its own middle, for there is no single one.
    const double angle = kTwoPi * (column + (radius > 0 ? 0.0 : 0.5)) / segmentsAround;
    const dvec3 n = glm::normalize(dvec3(std::sin(angle), slope, std::cos(angle)));
    return GridVertex{
        dvec3(radius * c.y, height * (1 - t), radius * c.x), n, {double(column) / segmentsAround, t}};
  });
  if (!capped) return mesh;
  append(mesh, makeDisc(bottomRadius, 0, segmentsAround, false));
  if (topRadius > 0) append(mesh, makeDisc(topRadius, height, segmentsAround, true));
  return mesh;
}

Mesh makeQuad(const dvec3& lowerLeft, const dvec3& lowerRight, const dvec3& upperRight,
              const dvec3& upperLeft) {
  const dvec3 n = glm::normalize(glm::cross(lowerRight - lowerLeft, upperLeft - lowerLeft));
  Mesh mesh;
  addVertex(mesh, {lowerLeft, n, {0, 1}});
  addVertex(mesh, {lowerRight, n, {1, 1}});
  addVertex(mesh, {upperRight, n, {1, 0}});
  addVertex(mesh, {upperLeft, n, {0, 0}});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

Mesh makeBoxMetric(const dvec3& size, double metresPerRepeat) {
  const dvec3 h = 0.5 * size;
  struct Face {
    dvec3 normal, right, up;
  };
  const Face faces[6] = {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}},
                         {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                         {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
  Mesh mesh;
  for (const Face& f : faces) {
    const dvec3 n = f.normal * h, r = f.right * h, u = f.up * h;
    Mesh quad = makeQuad(n - r - u, n + r - u, n + r + u, n - r + u);
    if (metresPerRepeat > 0) {
      const vec2 scale(2 * glm::length(r) / metresPerRepeat, 2 * glm::length(u) / metresPerRepeat);
      quad = withScaledUv(std::move(quad), scale);
    }
    append(mesh, quad);
  }
  return mesh;
}

Mesh makeBox(const dvec3& size) {
  return makeBoxMetric(size, 0);
}

Mesh makePlane(double sizeX, double sizeZ, int cellsX, int cellsZ) {
  return makeGrid(cellsX, cellsZ, [&](int column, int row) {
    const double s = double(column) / cellsX, t = double(row) / cellsZ;
    return GridVertex{dvec3((s - 0.5) * sizeX, 0, (t - 0.5) * sizeZ), dvec3(0, 1, 0), {s, t}};
  });
}

Mesh makeTorus(double majorRadius, double minorRadius, int segmentsAround, int segmentsTube) {
  return makeGrid(segmentsAround, segmentsTube, [&](int column, int row) {
    const dvec2 around = circlePoint(column, segmentsAround),
                tube = circlePoint(segmentsTube - row, segmentsTube);
    const dvec3 out(around.y, 0, around.x), n = tube.x * out + dvec3(0, tube.y, 0);
    return GridVertex{majorRadius * out + minorRadius * n,
                      n,
                      {double(column) / segmentsAround, double(row) / segmentsTube}};
  });
}

Mesh makeRod(const dvec3& a, const dvec3& b, double radius, int segmentsAround) {
  const dvec3 axis = b - a, up = glm::normalize(axis);
  const dvec3 helper = std::abs(up.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 0, 1);
  const dvec3 side = glm::normalize(glm::cross(helper, up)), other = glm::cross(side, up);
  dmat4 targetFromMesh(1.0);
  targetFromMesh[0] = dvec4(side, 0);
  targetFromMesh[1] = dvec4(up, 0);
  targetFromMesh[2] = dvec4(other, 0);
  targetFromMesh[3] = dvec4(0.5 * (a + b), 1);
  return transformed(makeCylinder(radius, glm::length(axis), segmentsAround), targetFromMesh);
}

dmat4 moveBy(const dvec3& offset) {
  return glm::translate(dmat4(1.0), offset);
}
dmat4 turnAround(const dvec3& axis, double radians) {
  return glm::rotate(dmat4(1.0), radians, glm::normalize(axis));
}
dmat4 scaleBy(const dvec3& factors) {
  return glm::scale(dmat4(1.0), factors);
}

}  // namespace catoptric::geometry
