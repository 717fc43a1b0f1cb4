// SPDX-License-Identifier: Apache-2.0
// One curved reflector as the solvers want it: triangles in double with their neighbours, and a skirt that
// continues an open reflector past its boundary. Depends on nothing but the reflector: build it once, again
// when it moves.
//
// The mirror is what the ray tracer sees: flat triangles P(u,v) with a normal N(u,v) interpolated linearly
// from the vertices and normalised. P and N are continuous across welded edges (also across texture seams,
// where vertices are duplicated), so a search may walk from triangle to triangle.
//
// The skirt is Blythe's rule for surfaces without back faces ("extend the actual edges of the reflector"):
// rings of triangles along every boundary edge, along which position and normal go on with the slope they
// have at the boundary. A reflection point in the skirt belongs to a point that is not reflected; it places a
// doubly virtual vertex just outside the mirror's image, continuous with what is inside.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::virtual_object {

inline constexpr std::uint32_t kNoNeighbour = 0xffffffffu;

/// A triangle as the per-vertex loop reads it: one record, so that a random access costs three cache lines.
struct alignas(64) MirrorTriangle {
  dvec3 position0, edge1, edge2;  ///< P = position0 + u edge1 + v edge2
  dvec3 normal0, normal1,
      normal2;                    ///< N ~ normal0 + u normal1 + v normal2 (normal1, normal2 are differences)
  double gram11, gram12, gram22;  ///< inverse of the Gram matrix of (edge1, edge2)
  /// Neighbour across edge k (from corner k to corner k+1), and which of its edges that is: id * 4 + edge.
  std::array<std::uint32_t, 3> neighbours;
  std::uint32_t flags;  ///< kSkirt
  static constexpr std::uint32_t kSkirt = 1;

  [[nodiscard]] bool isSkirt() const { return (flags & kSkirt) != 0; }
  [[nodiscard]] dvec3 position(double u, double v) const { return position0 + u * edge1 + v * edge2; }
  /// (u, v) of the foot of a point on the triangle's plane.
  [[nodiscard]] dvec2 project(const dvec3& point) const {
    const dvec3 d = point - position0;
    const double a = glm::dot(edge1, d), b = glm::dot(edge2, d);
    return {gram11 * a + gram12 * b, gram12 * a + gram22 * b};
  }
  /// Not normalised.
  [[nodiscard]] dvec3 normal(double u, double v) const { return normal0 + u * normal1 + v * normal2; }
};

struct ReflectorMeshOptions {
  double skirtWidth = 0.45;  ///< of the reflector's bounding radius; 0 = no skirt
  int skirtRings = 3;
  bool flipped = false;  ///< mirror on the back of the surface (double-sided reflectors seen from behind)
};

class ReflectorMesh {
 public:
  /// `reflector` is an index into geometry.reflectors. Triangles that are degenerate or not finite are left
  /// out; a mesh may end up empty, then nothing is reflected. The geometry is not kept.
  ReflectorMesh(const scene::WorldGeometry& geometry, std::uint32_t reflector,
                const ReflectorMeshOptions& options = {});
  /// From bare arrays, for tests and for other sources.
  ReflectorMesh(std::span<const vec3> positions, std::span<const vec3> normals,
                std::span<const std::uint32_t> indices, const ReflectorMeshOptions& options = {});

  /// Ordinary triangles first (in the order of the part, degenerate ones skipped), then the skirt.
  [[nodiscard]] std::span<const MirrorTriangle> triangles() const { return triangles_; }
  [[nodiscard]] std::size_t ordinaryCount() const { return ordinaryCount_; }
  /// Corners of the triangles as welded vertex numbers, three each.
  [[nodiscard]] std::span<const std::uint32_t> corners() const { return corners_; }
  [[nodiscard]] std::span<const dvec3> positions() const { return positions_; }  ///< welded
  [[nodiscard]] std::span<const dvec3> normals() const { return normals_; }      ///< welded, unit

  [[nodiscard]] bool isOpen() const { return ordinaryCount_ != triangles_.size() || boundaryEdges_ > 0; }
  /// Every edge bends outwards, to within rounding; skirt left out.
  [[nodiscard]] bool isConvex() const { return isConvex_; }
  /// The edges of one ordinary triangle.
  [[nodiscard]] bool isConvexAt(std::size_t triangle) const;
  [[nodiscard]] std::size_t boundaryEdges() const { return boundaryEdges_; }
  [[nodiscard]] dvec3 centre() const { return centre_; }           ///< of the bounding sphere, skirt included
  [[nodiscard]] double radius() const { return radius_; }          ///< tight, skirt included
  [[nodiscard]] double bodyRadius() const { return bodyRadius_; }  ///< around the same centre, skirt left out

 private:
  void build(std::span<const vec3> positions, std::span<const vec3> normals,
             std::span<const std::uint32_t> indices, const ReflectorMeshOptions& options);
  void addBody(std::span<const vec3> positions, std::span<const vec3> normals,
               std::span<const std::uint32_t> indices, bool flipped);
  void addSkirt(std::span<const std::uint32_t> boundary, const ReflectorMeshOptions& options);
  [[nodiscard]] bool findWhetherConvex() const;
  void addSkirtTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  std::vector<MirrorTriangle> triangles_;
  std::vector<std::uint32_t> corners_;
  std::vector<dvec3> positions_, normals_;
  std::size_t ordinaryCount_ = 0, boundaryEdges_ = 0;
  bool isConvex_ = true;
  dvec3 centre_{0};
  double radius_ = 0, bodyRadius_ = 0;
};

}  // namespace catoptric::virtual_object
