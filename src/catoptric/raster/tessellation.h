// SPDX-License-Identifier: Apache-2.0
// What a curved reflector may reflect, cut finely enough that straight virtual edges stand for curved images.
//
// An edge is split at its middle while it is longer than k (d + c): d the distance of its middle to the
// reflector, c the reflector's focal length. The decision reads the two end positions only, so neighbours
// decide alike, even where vertices are duplicated: no cracks. (Where one plane goes on across an edge that
// two triangles share, both of them allow it more.) It depends on the eye only by the mirror's size on the
// screen, in steps of the root of two: nothing moves by more than the bound while the camera does. New
// attributes are means of the ends and are *not* renormalised: the fragment shader interpolates and
// normalises exactly as it does on the uncut triangle, so shading does not change. What the mirror shows so
// small that fewer triangles would do is cut from a coarser level (levels_of_detail.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/raster/levels_of_detail.h"
#include "catoptric/raster/part_cutter.h"
#include "catoptric/scene/camera_frame.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::raster {

/// Pieces of one part of the world geometry, in the order of the world's parts (so blending keeps its order).
struct TessellatedPart {
  std::uint32_t part = 0;  ///< index into WorldGeometry::parts
  std::uint32_t firstIndex = 0, indexCount = 0;
  std::uint32_t firstVertex = 0, vertexCount = 0;
};

/// Same element types as WorldGeometry.
struct TessellatedObjects {
  std::vector<vec3> positions, normals;
  std::vector<vec4> tangents;
  std::vector<vec2> uv0, uv1;
  std::vector<vec4> colors;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> sourceTriangles;  ///< world triangle that each triangle was cut from
  std::vector<TessellatedPart> parts;          ///< every part but the reflector's own; never empty ones
  double edgeFactor = 0;                ///< the k that was used (larger than asked for if the budget was hit)
  std::size_t simplifiedTriangles = 0;  ///< of the world, in whose place the fewer ones of a level were cut

  void clear();  ///< keeps the memory
};

/// All parts as they are: indices into the world's own vertices, sourceTriangles and parts; the rest is
/// empty.
[[nodiscard]] TessellatedObjects makeUncutObjects(const scene::WorldGeometry& world);

inline constexpr double kUncutPx = 1e6;  ///< from this maxErrorPx on nothing is cut at all

struct TessellationOptions {
  double maxErrorPx = 0.5;           ///< aim: how far the drawn image of an edge may be from the true one
  double reflectorDiameterPx = 700;  ///< at which size of the reflector on the screen (bounding sphere)
  /// No flat mirror stands between the reflector and the objects: triangles that turn their back to all of it
  /// are left out.
  bool isSeenDirectly = false;
  /// Flat mirrors stand behind the reflector: what lies behind it may be seen in it all the same.
  bool keepsBehind = false;
  std::size_t maxTriangles = 600000;      ///< budget; when hit, k is raised and one warning says so
  std::span<const std::uint8_t> parts{};  ///< by part: 0 leaves it out; empty: all parts
  /// By part: 1 where each pixel's own ray meets the triangle that is drawn there, so that only its outline
  /// has to be right; empty: nowhere.
  std::span<const std::uint8_t> shadedByRays{};
  /// There, and in a mirror that does not turn round: may edges across which a plane goes on be longer, and
  /// are outlines to be finer in return? For convex mirrors.
  bool coarseInPlanes = false;
  /// Parts that the mirror shows small are cut from the coarsest of these that misses them by no more than
  /// kLevelShare of maxErrorPx; null: from the world's own triangles.
  const LevelsOfDetail* levels = nullptr;
};

inline constexpr double kLevelShare = 0.5;  ///< of the error, that levels of detail may take up

/// For TessellationOptions::reflectorDiameterPx: the diameter of the reflector's bounding sphere as this
/// camera sees it from `eye` (which planar mirrors may have moved), rounded up to 2800 over a power of the
/// root of two, from 44 to 2800.
[[nodiscard]] double findTessellationSize(const scene::Reflector& reflector, const dvec3& eye,
                                          const scene::CameraFrame& camera);

/// The objects of one reflector, kept while things move: what has not moved is not cut again.
class ReflectorTessellation {
 public:
  /// `reflector` is an index into geometry.reflectors. Pieces that lie behind a single-sided mirror
  /// altogether are left out, unless another mirror may show them to it. (What that one shows is farther away
  /// than the thing itself, so that lengths of edges err on the fine side.) What `options` points to must
  /// outlive the object, except for the spans.
  ReflectorTessellation(const scene::WorldGeometry& geometry, std::uint32_t reflector,
                        const TessellationOptions& options);

  /// After vertices of these parts have moved, but not those of the reflector: the same objects as if made
  /// anew.
  void update(const scene::WorldGeometry& geometry, std::span<const std::uint32_t> movedParts);

  [[nodiscard]] const TessellatedObjects& objects() const { return objects_; }
  [[nodiscard]] TessellatedObjects takeObjects() && { return std::move(objects_); }

 private:
  [[nodiscard]] bool isCut(std::size_t part) const;
  [[nodiscard]] bool isShadedByRays(std::size_t part) const;
  [[nodiscard]] CutOrder makeOrder(const scene::WorldGeometry& geometry, std::uint32_t part) const;
  [[nodiscard]] const DetailLevel* findLevel(const scene::WorldGeometry& geometry, std::uint32_t part) const;
  void cutAll(const scene::WorldGeometry& geometry);
  void gatherObjects(const scene::WorldGeometry& geometry);

  std::uint32_t reflector_, own_;
  TessellationOptions options_;
  std::vector<std::uint8_t> wanted_, byRays_;  ///< the spans of options_
  ReflectorDistance distance_;
  double askedFactor_ = 0;  ///< k, before the budget was looked at
  double k_ = 0;
  std::size_t budget_ = 0;
  std::vector<PartPieces> pieces_;           ///< by part
  std::vector<std::uint32_t> cutTriangles_;  ///< by part: how many were cut
  TessellatedObjects objects_;
};

/// ReflectorTessellation::objects(), made once.
[[nodiscard]] TessellatedObjects tessellateForReflector(const scene::WorldGeometry& geometry,
                                                        std::uint32_t reflector,
                                                        const TessellationOptions& options = {});

/// About how many triangles that would make, and where few are cut about as many vertices, in a tenth of the
/// time: for a forecast of what it would cost. The budget is not asked for.
[[nodiscard]] std::size_t estimateTriangles(const scene::WorldGeometry& geometry, std::uint32_t reflector,
                                            const TessellationOptions& options = {});

}  // namespace catoptric::raster
