// SPDX-License-Identifier: Apache-2.0
// Builds the mirror's triangles, welds them, finds neighbours, and adds the skirt.
//
//   1. Weld corners that are one point of one smooth surface (equal position, nearly equal normal): texture
//      seams vanish, creases stay.
//   2. One record for each usable triangle: flat position, linear normal, inverse Gram matrix.
//   3. Neighbours across edges that exactly two triangles share in opposite directions; others are boundary.
//   4. Skirt: at every boundary vertex the outward direction b in the tangent plane and the change of the
//      normal along b, both from the triangles there. Ring by ring the point moves along b while b and the
//      normal turn at that rate, so a sphere's skirt stays on the sphere and a cylinder's on the cylinder.
//   5. Bounding sphere by Badoiu & Clarkson's iteration (2003), centre from the body alone.
//
// Departures: a mitred corner of the boundary moves farther so that rings keep their width, at most twice.
// Failures: where the boundary's outline is concave, skirts overlap; where triangles disagree about the
// winding, they are not neighbours and a skirt grows between them (unseen: it lies behind the surface's
// edge). Cost: linear; 10,000 triangles in about 5 ms.
#include "catoptric/virtual_object/reflector_mesh.h"

#include <algorithm>
#include <cmath>

#include "catoptric/geometry/vertex_weld.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kWeldPositionTolerance = 1e-6;  // of the reflector's size
constexpr double kWeldNormalTolerance = 0.01;    // 8-bit normals of one corner differ by up to 0.008
constexpr double kConvexTolerance = 1e-4;        // sine; slivers of float meshes reach 1e-5
constexpr double kMaxSkirtTurn = 1.2;            // radians, in all

bool isFinite(const vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// False for a triangle without area.
bool makeTriangle(const std::array<dvec3, 3>& p, const std::array<dvec3, 3>& n, std::uint32_t flags,
                  MirrorTriangle& t) {
  t.position0 = p[0];
  t.edge1 = p[1] - p[0];
  t.edge2 = p[2] - p[0];
  t.normal0 = n[0];
  t.normal1 = n[1] - n[0];
  t.normal2 = n[2] - n[0];
  const double g11 = glm::dot(t.edge1, t.edge1), g12 = glm::dot(t.edge1, t.edge2),
               g22 = glm::dot(t.edge2, t.edge2);
  const double determinant = g11 * g22 - g12 * g12;
  if (!(determinant > 1e-20 * g11 * g22) || !std::isfinite(determinant)) return false;
  t.gram11 = g22 / determinant;
  t.gram12 = -g12 / determinant;
  t.gram22 = g11 / determinant;
  t.neighbours = {kNoNeighbour, kNoNeighbour, kNoNeighbour};
  t.flags = flags;
  return true;
}

/// Half edges sorted by their two vertices; equal neighbours in the list belong together.
struct HalfEdge {
  std::uint64_t key;           // smaller vertex, larger vertex
  std::uint32_t triangleEdge;  // triangle * 4 + edge
  bool forward;                // from the smaller to the larger
};

std::vector<HalfEdge> sortHalfEdges(std::span<const std::uint32_t> corners) {
  std::vector<HalfEdge> edges;
  edges.reserve(corners.size());
  for (std::uint32_t t = 0; t < corners.size() / 3; ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[3 * t + k], b = corners[3 * t + (k + 1) % 3];
      const std::uint64_t low = std::min(a, b), high = std::max(a, b);
      edges.push_back({low << 32 | high, t * 4 + k, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.key != b.key ? a.key < b.key : a.triangleEdge < b.triangleEdge;
  });
  return edges;
}

/// Step 3. Returns the half edges (triangle * 4 + edge) without a neighbour.
std::vector<std::uint32_t> linkNeighbours(std::vector<MirrorTriangle>& triangles,
                                          std::span<const std::uint32_t> corners) {
  const std::vector<HalfEdge> edges = sortHalfEdges(corners);
  std::vector<std::uint32_t> boundary;
  for (auto& t : triangles) t.neighbours = {kNoNeighbour, kNoNeighbour, kNoNeighbour};
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t last = first;
    while (last < edges.size() && edges[last].key == edges[first].key) ++last;
    if (last - first == 2 && edges[first].forward != edges[first + 1].forward) {
      const std::uint32_t a = edges[first].triangleEdge, b = edges[first + 1].triangleEdge;
      triangles[a / 4].neighbours[a % 4] = b;
      triangles[b / 4].neighbours[b % 4] = a;
    } else {
      for (std::size_t i = first; i < last; ++i) boundary.push_back(edges[i].triangleEdge);
    }
    first = last;
  }
  std::sort(boundary.begin(), boundary.end());
  return boundary;
}

/// How a boundary vertex goes on outwards.
struct SkirtRoot {
  dvec3 outward{0};       // unit, in the tangent plane
  dvec3 normalChange{0};  // per unit length along outward, in the tangent plane
  double mitre = 1;       // how much farther than the ring's width it goes
  double weight = 0;
};

/// Change of the (unnormalised) normal of a triangle per unit length along a direction.
dvec3 computeNormalChange(const MirrorTriangle& t, const dvec3& direction) {
  const double a = glm::dot(t.edge1, direction), b = glm::dot(t.edge2, direction);
  return (t.gram11 * a + t.gram12 * b) * t.normal1 + (t.gram12 * a + t.gram22 * b) * t.normal2;
}

/// Turns `vector` in the plane of the unit vectors from, to by an angle (from towards to).
dvec3 turnInPlane(const dvec3& vector, const dvec3& from, const dvec3& to, double radians) {
  const double x = glm::dot(vector, from), y = glm::dot(vector, to);
  const double c = std::cos(radians) - 1.0, s = std::sin(radians);
  return vector + (x * c - y * s) * from + (x * s + y * c) * to;
}

/// Smallest sphere around points, centre to about 1 % of the radius.
dvec3 findSphereCentre(std::span<const dvec3> points) {
  core::Box box;
  for (const dvec3& p : points) box.add(p);
  dvec3 centre = box.centre();
  for (int i = 1; i <= 60; ++i) {
    const dvec3* farthest = &points[0];
    double best = -1;
    for (const dvec3& p : points)
      if (const double d = glm::dot(p - centre, p - centre); d > best) best = d, farthest = &p;
    centre += (*farthest - centre) / double(i + 3);
  }
  return centre;
}

double findRadius(std::span<const dvec3> points, const dvec3& centre) {
  double squared = 0;
  for (const dvec3& p : points) squared = std::max(squared, glm::dot(p - centre, p - centre));
  return std::sqrt(squared);
}

}  // namespace

ReflectorMesh::ReflectorMesh(const scene::WorldGeometry& geometry, std::uint32_t reflector,
                             const ReflectorMeshOptions& options) {
  const scene::Part& part = geometry.parts[geometry.reflectors[reflector].part];
  std::vector<std::uint32_t> local(part.indexCount);
  for (std::uint32_t i = 0; i < part.indexCount; ++i)
    local[i] = geometry.indices[part.firstIndex + i] - part.firstVertex;
  build(std::span(geometry.positions).subspan(part.firstVertex, part.vertexCount),
        std::span(geometry.normals).subspan(part.firstVertex, part.vertexCount), local, options);
}

ReflectorMesh::ReflectorMesh(std::span<const vec3> positions, std::span<const vec3> normals,
                             std::span<const std::uint32_t> indices, const ReflectorMeshOptions& options) {
  build(positions, normals, indices, options);
}

void ReflectorMesh::build(std::span<const vec3> positions, std::span<const vec3> normals,
                          std::span<const std::uint32_t> indices, const ReflectorMeshOptions& options) {
  addBody(positions, normals, indices, options.flipped);
  if (triangles_.empty()) return;
  centre_ = findSphereCentre(positions_);
  bodyRadius_ = findRadius(positions_, centre_);
  const std::vector<std::uint32_t> boundary = linkNeighbours(triangles_, corners_);
  boundaryEdges_ = boundary.size();
  isConvex_ = findWhetherConvex();
  if (options.skirtWidth > 0 && options.skirtRings > 0 && !boundary.empty()) {
    addSkirt(boundary, options);
    linkNeighbours(triangles_, corners_);
  }
  radius_ = findRadius(positions_, centre_);
}

// Steps 1 and 2.
void ReflectorMesh::addBody(std::span<const vec3> positions, std::span<const vec3> normals,
                            std::span<const std::uint32_t> indices, bool flipped) {
  core::Box box;
  std::vector<vec3> usable(positions.begin(), positions.end()), usableNormals(normals.begin(), normals.end());
  std::vector<bool> isUsable(positions.size());
  for (std::size_t v = 0; v < usable.size(); ++v) {
    isUsable[v] = isFinite(usable[v]) && isFinite(usableNormals[v]) && glm::length(usableNormals[v]) > 0;
    if (!isUsable[v]) usable[v] = vec3(0), usableNormals[v] = vec3(0, 1, 0);
    usableNormals[v] = glm::normalize(usableNormals[v]);
    if (isUsable[v]) box.add(dvec3(usable[v]));
  }
  if (box.isEmpty()) return;
  const double tolerance = std::max(box.radius() * kWeldPositionTolerance, 1e-12);
  const std::vector<std::uint32_t> welded =
      geometry::weldVertices(usable, usableNormals, {tolerance, kWeldNormalTolerance});

  const double side = flipped ? -1.0 : 1.0;
  std::vector<std::uint32_t> numberOf(positions.size(), core::kNoId);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    std::array<std::uint32_t, 3> v{indices[i], indices[i + 1], indices[i + 2]};
    if (!isUsable[v[0]] || !isUsable[v[1]] || !isUsable[v[2]]) continue;
    if (flipped) std::swap(v[1], v[2]);
    std::array<dvec3, 3> p, n;
    for (int k = 0; k < 3; ++k) p[k] = dvec3(usable[v[k]]), n[k] = side * dvec3(normals[v[k]]);
    MirrorTriangle triangle;
    if (!makeTriangle(p, n, 0, triangle)) continue;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& number = numberOf[welded[v[k]]];
      if (number == core::kNoId) {
        number = static_cast<std::uint32_t>(positions_.size());
        positions_.push_back(p[k]);
        normals_.push_back(glm::normalize(n[k]));
      }
      corners_.push_back(number);
    }
    triangles_.push_back(triangle);
  }
  ordinaryCount_ = triangles_.size();
}

/// No neighbour rises above its plane, by more than what float positions and flat quads bring about.
bool ReflectorMesh::isConvexAt(std::size_t triangle) const {
  const MirrorTriangle& t = triangles_[triangle];
  const dvec3 facet = glm::normalize(glm::cross(t.edge1, t.edge2));
  for (const std::uint32_t link : t.neighbours) {
    if (link == kNoNeighbour || link / 4 >= ordinaryCount_) continue;
    const dvec3 opposite = positions_[corners_[3 * (link / 4) + (link % 4 + 2) % 3]] - t.position0;
    if (glm::dot(facet, opposite) > kConvexTolerance * glm::length(opposite)) return false;
  }
  return true;
}

bool ReflectorMesh::findWhetherConvex() const {
  for (std::size_t i = 0; i < ordinaryCount_; ++i)
    if (!isConvexAt(i)) return false;
  return true;
}

// Step 4.
void ReflectorMesh::addSkirt(std::span<const std::uint32_t> boundary, const ReflectorMeshOptions& options) {
  const std::size_t bodyVertices = positions_.size();
  std::vector<SkirtRoot> roots(bodyVertices);
  for (const std::uint32_t half : boundary) {
    const std::uint32_t t = half / 4, k = half % 4;
    const std::uint32_t a = corners_[3 * t + k], b = corners_[3 * t + (k + 1) % 3];
    for (const std::uint32_t v : {a, b})
      roots[v].outward += glm::normalize(glm::cross(positions_[b] - positions_[a], normals_[v]));
  }
  for (std::size_t v = 0; v < bodyVertices; ++v) {
    const double length = glm::length(roots[v].outward);
    if (length < 1e-6) continue;
    roots[v].mitre = std::min(2.0 / length, 2.0);  // two unit vectors: length is 2 cos(half the angle)
    roots[v].outward /= length;
  }
  for (std::size_t t = 0; t < ordinaryCount_; ++t)
    for (int k = 0; k < 3; ++k) {
      SkirtRoot& root = roots[corners_[3 * t + k]];
      if (glm::dot(root.outward, root.outward) == 0) continue;
      const double area = glm::length(glm::cross(triangles_[t].edge1, triangles_[t].edge2));
      root.normalChange += area * computeNormalChange(triangles_[t], root.outward);
      root.weight += area;
    }

  // Rings widen outwards: fine where virtual triangles straddle the boundary.
  const int rings = options.skirtRings;
  std::vector<std::vector<std::uint32_t>> ringVertices(rings + 1, std::vector<std::uint32_t>(bodyVertices));
  for (std::size_t v = 0; v < bodyVertices; ++v) {
    SkirtRoot& root = roots[v];
    ringVertices[0][v] = static_cast<std::uint32_t>(v);
    if (root.weight == 0) continue;
    const dvec3 n0 = normals_[v];
    dvec3 change = root.normalChange / root.weight;
    change -= glm::dot(change, n0) * n0;
    const double rate = glm::length(change);
    const dvec3 towards = rate > 0 ? change / rate : dvec3(0);
    dvec3 p = positions_[v];
    double turned = 0;
    for (int ring = 1; ring <= rings; ++ring) {
      const double width =
          options.skirtWidth * bodyRadius_ * root.mitre * (2.0 * ring) / (rings * (rings + 1));
      const double turn = std::min(rate * width, kMaxSkirtTurn - turned);
      p += width * turnInPlane(root.outward, n0, towards, turned + 0.5 * turn);
      turned += turn;
      ringVertices[ring][v] = static_cast<std::uint32_t>(positions_.size());
      positions_.push_back(p);
      normals_.push_back(turnInPlane(n0, n0, towards, turned));
    }
  }
  for (const std::uint32_t half : boundary) {
    const std::uint32_t t = half / 4, k = half % 4;
    const std::uint32_t a = corners_[3 * t + k], b = corners_[3 * t + (k + 1) % 3];
    for (int ring = 1; ring <= rings; ++ring) {
      const auto& inner = ringVertices[ring - 1];
      const auto& outer = ringVertices[ring];
      addSkirtTriangle(inner[b], inner[a], outer[a]);
      addSkirtTriangle(inner[b], outer[a], outer[b]);
    }
  }
}

void ReflectorMesh::addSkirtTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  MirrorTriangle triangle;
  if (!makeTriangle({positions_[a], positions_[b], positions_[c]}, {normals_[a], normals_[b], normals_[c]},
                    MirrorTriangle::kSkirt, triangle))
    return;
  triangles_.push_back(triangle);
  corners_.insert(corners_.end(), {a, b, c});
}

}  // namespace catoptric::virtual_object
