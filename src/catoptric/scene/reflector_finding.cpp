// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/reflector_finding.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "catoptric/core/log.h"
#include "catoptric/geometry/aspheric_mirror.h"
#include "catoptric/geometry/extrusion.h"
#include "catoptric/geometry/mesh_measures.h"
#include "catoptric/geometry/quadric.h"
#include "catoptric/geometry/torus.h"
#include "catoptric/geometry/vertex_weld.h"

namespace catoptric::scene {
namespace {

// A recognised curved shape is looser in its normals than a plane: exporters compute them from the facets.
constexpr double kCurvedNormalTolerance = 1e-2;  // radians

/// In the order of ReflectorShape.
constexpr std::array<std::string_view, 9> kShapeNames{"plane",   "sphere", "cylinder", "cone", "extrusion",
                                                      "quadric", "torus",  "aspheric", "mesh"};

/// Disjoint sets of vertices.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

struct Extent {
  double radius = 0, noise = 0;  // noise: rounding of a coordinate
};

Extent measureExtent(std::span<const vec3> positions) {
  core::Box box;
  double largest = 0;
  for (const vec3& p : positions) {
    box.add(dvec3(p));
    for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(double(p[i])));
  }
  return {box.radius(), 1.2e-7 * largest};
}

/// The vertices and triangles of one piece as a mesh of its own.
struct PieceMesh {
  std::vector<vec3> positions, normals;
  std::vector<std::uint32_t> indices;
  [[nodiscard]] geometry::MeshView view() const { return {positions, normals, indices}; }
};

PieceMesh extractPiece(const geometry::MeshView& mesh, std::span<const std::uint32_t> triangles,
                       std::vector<std::uint32_t>& localOf) {
  constexpr std::uint32_t kNone = core::kNoId;
  PieceMesh piece;
  for (const std::uint32_t t : triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.indices[3 * std::size_t(t) + k];
      if (localOf[v] == kNone) {
        localOf[v] = static_cast<std::uint32_t>(piece.positions.size());
        piece.positions.push_back(mesh.positions[v]);
        piece.normals.push_back(mesh.normals[v]);
      }
      piece.indices.push_back(localOf[v]);
    }
  for (const std::uint32_t t : triangles)
    for (int k = 0; k < 3; ++k) localOf[mesh.indices[3 * std::size_t(t) + k]] = kNone;
  return piece;
}

bool isFlat(const geometry::PlaneFit& fit, const Extent& extent, const ReflectorOptions& options) {
  return fit.deviation.distance <= options.planeTolerance * extent.radius + 2 * extent.noise &&
         fit.deviation.angleRadians <= options.normalTolerance;
}

/// Joins the flat pieces that lie in one plane.
std::vector<MirrorPiece> mergeCoplanar(const geometry::MeshView& mesh, std::vector<MirrorPiece> pieces,
                                       const ReflectorOptions& options, const Extent& whole) {
  std::vector<std::uint32_t> localOf(mesh.positions.size(), core::kNoId), flat;
  std::vector<core::Plane> planes;
  const dvec3 origin(mesh.positions[mesh.indices[0]]);
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    const PieceMesh piece = extractPiece(mesh, pieces[i].triangles, localOf);
    auto fit = geometry::fitPlane(piece.view());
    if (!fit || !isFlat(*fit, measureExtent(piece.positions), options)) continue;
    fit->plane.offset =
        fit->plane.signedDistance(origin);  // near the mesh, so that the normal's rounding is harmless
    flat.push_back(i);
    planes.push_back(fit->plane);
  }
  const double offsetTolerance = options.planeTolerance * whole.radius + 2 * whole.noise + 1e-300;
  const auto same = geometry::weldPlanes(planes, 0.1 * options.normalTolerance, offsetTolerance);
  for (std::uint32_t k = 0; k < flat.size(); ++k) {
    if (same[k] == k) continue;
    auto &target = pieces[flat[same[k]]].triangles, &source = pieces[flat[k]].triangles;
    target.insert(target.end(), source.begin(), source.end());
    source.clear();
  }
  std::erase_if(pieces, [](const MirrorPiece& piece) { return piece.triangles.empty(); });
  for (MirrorPiece& piece : pieces) std::sort(piece.triangles.begin(), piece.triangles.end());
  return pieces;
}

std::optional<ReflectorShape> parseShape(const std::optional<std::string>& name) {
  if (!name) return std::nullopt;
  const auto at = std::find(kShapeNames.begin(), kShapeNames.end(), *name);
  if (at != kShapeNames.end()) return ReflectorShape(at - kShapeNames.begin());
  core::logWarningOnce(
      fmt::format("extras.catoptric.shape \"{}\" is none of {}; the shape is recognised instead", *name,
                  fmt::join(kShapeNames, ", ")));
  return std::nullopt;
}

struct Candidate {
  ReflectorShape shape;
  geometry::FitDeviation deviation;
  core::Plane plane;
  bool isInside = false;  // normals point to the hollow side
};

std::optional<Candidate> fitShape(ReflectorShape shape, const geometry::MeshView& mesh) {
  switch (shape) {
    case ReflectorShape::Plane:
      if (const auto fit = geometry::fitPlane(mesh))
        return Candidate{shape, fit->deviation, fit->plane, false};
      break;
    case ReflectorShape::Sphere:
      if (const auto fit = geometry::fitSphere(mesh))
        return Candidate{shape, fit->deviation, {}, fit->isInside};
      break;
    case ReflectorShape::Cylinder:
      if (const auto fit = geometry::fitCylinder(mesh))
        return Candidate{shape, fit->deviation, {}, fit->isInside};
      break;
    case ReflectorShape::Cone:
      if (const auto fit = geometry::fitCone(mesh))
        return Candidate{shape, fit->deviation, {}, fit->isInside};
      break;
    case ReflectorShape::Extrusion:
      if (const auto fit = geometry::fitExtrusion(mesh)) return Candidate{shape, fit->deviation, {}, false};
      break;
    case ReflectorShape::Quadric:
      if (const auto fit = geometry::fitQuadric(mesh)) return Candidate{shape, fit->deviation, {}, false};
      break;
    case ReflectorShape::Torus:
      if (const auto fit = geometry::fitTorus(mesh)) return Candidate{shape, fit->deviation, {}, false};
      break;
    case ReflectorShape::Aspheric:
      if (const auto fit = geometry::fitAsphericMirror(mesh))
        return Candidate{shape, fit->deviation, {}, false};
      break;
    case ReflectorShape::Mesh:
      break;
  }
  return std::nullopt;
}

/// Do all triangles turn their front to where their normals point?
bool frontsFollowNormals(const geometry::MeshView& mesh) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto [a, b, c] = std::array{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    const dvec3 p(mesh.positions[a]);
    const dvec3 front = glm::cross(dvec3(mesh.positions[b]) - p, dvec3(mesh.positions[c]) - p);
    if (glm::dot(front, dvec3(mesh.normals[a]) + dvec3(mesh.normals[b]) + dvec3(mesh.normals[c])) <= 0)
      return false;
  }
  return true;
}

}  // namespace

std::vector<MirrorPiece> findMirrorPieces(const geometry::MeshView& mesh, const ReflectorOptions& options) {
  if (mesh.indices.empty()) return {};
  const Extent whole = measureExtent(mesh.positions);
  const auto welded = geometry::weldVertices(
      mesh.positions, mesh.normals,
      {.positionTolerance = 1e-6 * whole.radius + 2 * whole.noise + 1e-300, .normalTolerance = 1e-4});
  UnionFind sets(mesh.positions.size());
  const std::size_t triangles = mesh.indices.size() / 3;
  for (std::size_t t = 0; t < triangles; ++t) {
    sets.join(welded[mesh.indices[3 * t]], welded[mesh.indices[3 * t + 1]]);
    sets.join(welded[mesh.indices[3 * t]], welded[mesh.indices[3 * t + 2]]);
  }
  std::vector<std::uint32_t> pieceOf(mesh.positions.size(), core::kNoId);
  std::vector<MirrorPiece> pieces;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    std::uint32_t& piece = pieceOf[sets.find(welded[mesh.indices[3 * std::size_t(t)]])];
    if (piece == core::kNoId) {
      piece = static_cast<std::uint32_t>(pieces.size());
      pieces.emplace_back();
    }
    pieces[piece].triangles.push_back(t);
  }
  return pieces.size() > 1 ? mergeCoplanar(mesh, std::move(pieces), options, whole) : pieces;
}

void measureReflector(Reflector& reflector, const geometry::MeshView& mesh,
                      const std::optional<std::string>& declaredShape, bool hasNormalMap,
                      const ReflectorOptions& options) {
  const geometry::BoundingSphere sphere = geometry::computeBoundingSphere(mesh.positions);
  reflector.centre = sphere.centre;
  reflector.radius = sphere.radius;
  reflector.areaWorld = geometry::computeArea(mesh);
  reflector.isConvex = geometry::isConvexMesh(mesh);
  reflector.shape = ReflectorShape::Mesh;
  const Extent extent{sphere.radius, measureExtent(mesh.positions).noise};
  const double distanceLimit = options.planeTolerance * extent.radius + 2 * extent.noise;
  const auto accept = [&](const Candidate& fit) {
    reflector.shape = fit.shape;
    reflector.plane = fit.plane;
    reflector.fitError = fit.deviation.distance;
  };

  auto declared = parseShape(declaredShape);
  if (declared == ReflectorShape::Mesh) return;
  if (declared == ReflectorShape::Plane && hasNormalMap) {
    core::logWarningOnce("\"" + reflector.name +
                         "\": a normal-mapped mirror is no plane; declared shape ignored");
    declared.reset();
  }
  if (declared) {
    const auto fit = fitShape(*declared, mesh);
    if (fit && fit->deviation.distance > distanceLimit)
      core::logWarningOnce(fmt::format("\"{}\": its vertices leave the declared {} by up to {:.3g}",
                                       reflector.name, *declaredShape, fit->deviation.distance));
    if (fit) return accept(*fit);
    core::logWarningOnce(
        fmt::format("\"{}\": no {} fits, declared shape ignored", reflector.name, *declaredShape));
  }
  for (const ReflectorShape shape : {ReflectorShape::Plane, ReflectorShape::Sphere, ReflectorShape::Cylinder,
                                     ReflectorShape::Cone, ReflectorShape::Extrusion, ReflectorShape::Quadric,
                                     ReflectorShape::Torus, ReflectorShape::Aspheric}) {
    if (shape == ReflectorShape::Plane && hasNormalMap) continue;
    const double angleLimit =
        shape == ReflectorShape::Plane ? options.normalTolerance : kCurvedNormalTolerance;
    const auto fit = fitShape(shape, mesh);
    if (!fit || fit->deviation.distance > distanceLimit || fit->deviation.angleRadians > angleLimit) continue;
    accept(*fit);
    // The outside of a recognised shape is convex, whatever rounding does to the slivers at a sphere's poles.
    const bool isRound =
        shape == ReflectorShape::Sphere || shape == ReflectorShape::Cylinder || shape == ReflectorShape::Cone;
    if (isRound && !fit->isInside && frontsFollowNormals(mesh)) reflector.isConvex = true;
    return;
  }
}

std::string_view shapeName(ReflectorShape shape) {
  return kShapeNames[std::size_t(shape)];
}

}  // namespace catoptric::scene
