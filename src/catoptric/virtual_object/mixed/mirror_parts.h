// SPDX-License-Identifier: Apache-2.0
// A mirror cut into parts that bend one way (1998, section 6; methods.md, section 1): one virtual object for
// each.
//
// In:  a mirror's mesh.
// Out: connected parts, each convex, hollow or a saddle, as meshes of their own, so that each has its own
//      maps, its own seeds and a skirt of its own past the line where the next part begins.
// Steps:
//   1. A triangle is convex where no neighbour rises above its plane (what makes ReflectorMesh::isConvex())
//      and neither principal curvature, that of the normals' change over it, is hollow.
//   2. Of the others, one is hollow where neither curvature bulges by more than kFlat of the larger, else a
//      saddle.
//   3. Connected triangles of one kind are a part; one with less than kLeastShare of the mirror's area is
//      left out.
// Why by curvature: the focal distances along reflected rays (view_forecast.h) have signs that go with those
// of the curvatures: both negative on a convex part, where one virtual object serves all distances from every
// eye; one root within reach on a saddle, two in a hollow. The cut depends on the mirror alone and is made
// once; what depends on the eye, whether things lie at a focus, is sampled there.
// Known failures: triangles left out belong to no part. Cost: linear, about 5 ms for 10,000 triangles.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

enum class Bend : std::uint8_t { Convex, Hollow, Saddle };

struct MirrorPart {
  Bend bend = Bend::Convex;
  std::unique_ptr<ReflectorMesh> mesh;
  std::vector<std::uint32_t> corners;  ///< its triangles, as welded vertices of the mirror's mesh
  double areaShare = 0;                ///< of the mirror
};

/// Principal curvatures of a triangle of the mirror, the larger first, per world unit: positive where it
/// bulges towards the bright side.
[[nodiscard]] std::array<double, 2> computeCurvatures(const MirrorTriangle& triangle);

struct CutMirror {
  std::vector<MirrorPart> parts;       ///< the largest first
  std::vector<std::uint32_t> leftOut;  ///< corners of triangles that belong to none
};

/// One part that is all of the mirror where it bends one way.
[[nodiscard]] CutMirror cutIntoParts(const ReflectorMesh& mesh);

}  // namespace catoptric::virtual_object
