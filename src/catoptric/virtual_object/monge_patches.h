// SPDX-License-Identifier: Apache-2.0
// A mirror f = 0 covered with Monge patches, halved down to small ones: what root_isolation.h leaves out or
// searches.
//
// World space in and out, double; each patch has a frame of its own. Steps, once a mirror:
//   1. its triangles are cut until they are small and bend little, their corners projected onto f = 0,
//   2. where the normals of a set of them stay within kWidest of one, it gets a patch: the surface as a
//      height over the tangent plane at its middle, along the principal directions, over a rectangle that
//      holds all corners; other sets are halved, along the axis of position or normal in which they are
//      longest, and so are patches, along their longer side, with bends counted,
//   3. at the middle the height with its first and second derivatives, by implicit differentiation of f;
//      how fast the second ones change is bounded by their differences over a grid of nine: measured with
//      a margin, not proven.
// Smaller rectangles are made when they are asked for. No rectangle where the surface has no height.
// Cost: 5 to 35 ms. Sources: do Carmo 1976, section 3-3, for Monge patches; Walter et al. 2009 for
// hierarchies by position and normal.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/geometry/implicit_surface.h"

namespace catoptric::virtual_object {

/// x and y along the tangent plane at the origin, z along the bright normal there.
struct PatchFrame {
  dvec3 origin{0};
  dmat3 axes{1};

  [[nodiscard]] dvec3 toLocal(const dvec3& world) const { return (world - origin) * axes; }
  [[nodiscard]] dvec3 toWorld(const dvec3& local) const { return origin + axes * local; }
};

/// A rectangle in a frame, and the surface at its middle.
struct MongePatch {
  dvec2 middle{0}, half{0};  ///< half: of its sides
  double height = 0;
  dvec2 slope{0};
  double bendXx = 0, bendXy = 0, bendYy = 0;
  dvec2 third{0};  ///< bounds the derivatives of the bend along x and y, in units of half (root_isolation.h)
  std::uint32_t frame = 0;
  std::uint32_t firstHalf = 0;  ///< of two made beforehand; 0: none

  [[nodiscard]] dvec2 applyBend(const dvec2& v) const {
    return {bendXx * v.x + bendXy * v.y, bendXy * v.x + bendYy * v.y};
  }
};

class MongePatches {
 public:
  /// `side`: -1 where f is bright against its gradient. `radius`: of the mirror's bounding sphere.
  MongePatches(std::shared_ptr<const geometry::ImplicitSurface> surface, double side, double radius,
               std::span<const vec3> points, std::span<const std::uint32_t> triangles);

  [[nodiscard]] std::span<const MongePatch> largest() const { return largest_; }
  /// Adds the patches that it is cut into, two or four.
  void split(const MongePatch& patch, std::vector<MongePatch>& parts) const;
  [[nodiscard]] double radius() const { return radius_; }
  [[nodiscard]] const PatchFrame& frameOf(const MongePatch& patch) const { return frames_[patch.frame]; }

  /// The surface over another rectangle of the same frame, near the given one.
  [[nodiscard]] std::optional<MongePatch> move(const MongePatch& near, const dvec2& middle,
                                               const dvec2& half) const {
    return moveIn(frameOf(near), near, middle, half);
  }

 private:
  struct Facet;
  [[nodiscard]] dvec3 findNormal(const dvec3& at) const;
  void cut(const std::array<dvec3, 3>& corners, int depth, std::vector<Facet>& facets) const;
  void divide(std::span<Facet> facets);
  void divideBelow(MongePatch& patch, std::span<Facet> facets);
  [[nodiscard]] std::optional<MongePatch> cover(std::span<const Facet> facets);
  [[nodiscard]] std::optional<PatchFrame> findFrame(std::span<const Facet> facets) const;
  [[nodiscard]] std::optional<MongePatch> moveIn(const PatchFrame& frame, const MongePatch& near,
                                                 const dvec2& middle, const dvec2& half) const;
  bool boundThird(const PatchFrame& frame, MongePatch& patch) const;

  std::shared_ptr<const geometry::ImplicitSurface> surface_;
  double side_, radius_;
  std::vector<PatchFrame> frames_;
  std::vector<MongePatch> largest_, halves_;
};

}  // namespace catoptric::virtual_object
