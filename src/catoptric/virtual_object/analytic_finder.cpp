// SPDX-License-Identifier: Apache-2.0
// Steps: 1 refit the shape that scene/reflector_finding recognised or was told, 2 all reflection points on
// the whole shape (of an implicit surface those on the mirror, or else some past its boundary), 3 the one
// that lies on the mirror, or else the nearest one, which makes a doubly virtual vertex: a shape goes on past
// the mirror's boundary by itself.
//
// Inside a shape the other answers lie anywhere on it, also where the mirror was left out for the light to
// come in, so only those near the mirror count.
//
// Departures: where several points lie on the mirror (concave, near a focus) the one nearest to its middle is
// taken, for one vertex has one image. "On the mirror" is taken generously, by its bounding sphere: a vertex
// taken for reflected draws outside the mirror's image and is masked.
#include "catoptric/virtual_object/analytic_finder.h"

#include <utility>

#include "catoptric/geometry/aspheric_mirror.h"
#include "catoptric/geometry/extrusion.h"
#include "catoptric/geometry/quadric.h"
#include "catoptric/geometry/shape_recognition.h"
#include "catoptric/geometry/torus.h"
#include "catoptric/virtual_object/extruded_reflector.h"
#include "catoptric/virtual_object/implicit_reflector.h"
#include "catoptric/virtual_object/special_reflector.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kSlack = 1 + 1e-6;  // of the bounding sphere's radius
constexpr double kBeyond = 1.45;     // of it: how far outside a concave mirror a point still belongs to it

/// Step 3. `mayBeAnywhere`: the outside of a shape that has one reflection at most.
struct Chooser {
  dvec3 centre;
  double radius;

  template <class Reflections>
  [[nodiscard]] std::optional<FoundPoint> choose(const Reflections& reflections, bool mayBeAnywhere) const {
    std::optional<FoundPoint> best;
    double bestDistance = 0;
    for (const Reflection& r : reflections) {
      const double distance = glm::distance(r.position, centre);
      if (best && distance >= bestDistance) continue;
      if (!mayBeAnywhere && distance > kBeyond * radius) continue;
      best = FoundPoint{};
      best->position = r.position;
      best->normal = r.normal;
      best->isPastBoundary = distance > radius;
      bestDistance = distance;
    }
    return best;
  }
};

class SpecialFinder : public PointFinder {
 public:
  SpecialFinder(const SpecialReflector& shape, const scene::Reflector& reflector)
      : shape_(shape), chooser_{reflector.centre, reflector.radius * kSlack} {}

  void setEye(const EyeView& view) override { eye_ = view.eye; }
  [[nodiscard]] bool knowsHiddenPoints() const override { return !shape_.isInside; }

  [[nodiscard]] std::optional<FoundPoint> find(const dvec3& scenePoint) const override {
    return chooser_.choose(findReflections(shape_, eye_, scenePoint), !shape_.isInside);
  }

 private:
  SpecialReflector shape_;
  Chooser chooser_;
  dvec3 eye_{0};
};

class ImplicitFinder : public PointFinder {
 public:
  ImplicitFinder(std::shared_ptr<const geometry::ImplicitSurface> surface, bool isTurned,
                 const geometry::MeshView& mesh, const scene::Reflector& reflector)
      : reflector_(std::move(surface), isTurned, mesh, reflector.radius),
        chooser_{reflector.centre, reflector.radius * kSlack} {}
  void setEye(const EyeView& view) override { eye_ = view.eye; }
  [[nodiscard]] bool knowsHiddenPoints() const override { return false; }
  [[nodiscard]] std::optional<FoundPoint> find(const dvec3& scenePoint) const override {
    return chooser_.choose(reflector_.findReflections(eye_, scenePoint), false);
  }

 private:
  ImplicitReflector reflector_;
  Chooser chooser_;
  dvec3 eye_{0};
};

class ExtrudedFinder : public PointFinder {
 public:
  ExtrudedFinder(const geometry::ExtrusionFit& profile, double skirt) : reflector_(profile, skirt) {}
  void setEye(const EyeView& view) override { reflector_.setEye(view.eye); }
  [[nodiscard]] bool knowsHiddenPoints() const override { return true; }
  [[nodiscard]] std::optional<FoundPoint> find(const dvec3& scenePoint) const override {
    return reflector_.find(scenePoint);
  }

 private:
  ExtrudedReflector reflector_;
};

/// The vertices of one part, renumbered.
struct PartMesh {
  std::span<const vec3> positions, normals;
  std::vector<std::uint32_t> indices;
  [[nodiscard]] geometry::MeshView view() const { return {positions, normals, indices}; }
};

PartMesh extractPart(const scene::WorldGeometry& world, const scene::Part& part) {
  PartMesh mesh;
  mesh.positions = std::span(world.positions).subspan(part.firstVertex, part.vertexCount);
  mesh.normals = std::span(world.normals).subspan(part.firstVertex, part.vertexCount);
  for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; ++i)
    mesh.indices.push_back(world.indices[i] - part.firstVertex);
  return mesh;
}

std::shared_ptr<const geometry::ImplicitSurface> fitImplicit(scene::ReflectorShape shape,
                                                             const geometry::MeshView& mesh) {
  if (shape == scene::ReflectorShape::Quadric)
    if (const auto fit = geometry::fitQuadric(mesh)) return std::make_shared<geometry::Quadric>(fit->quadric);
  if (shape == scene::ReflectorShape::Torus)
    if (const auto fit = geometry::fitTorus(mesh)) return std::make_shared<geometry::Torus>(fit->torus);
  if (shape == scene::ReflectorShape::Aspheric)
    if (const auto fit = geometry::fitAsphericMirror(mesh))
      return std::make_shared<geometry::AsphericMirror>(fit->mirror);
  return nullptr;
}

std::optional<SpecialReflector> fitSpecial(scene::ReflectorShape shape, const geometry::MeshView& mesh) {
  if (shape == scene::ReflectorShape::Sphere)
    if (const auto fit = geometry::fitSphere(mesh))
      return SpecialReflector{SpecialShape::Sphere, fit->centre, {0, 0, 1}, fit->radius, 0, fit->isInside};
  if (shape == scene::ReflectorShape::Cylinder)
    if (const auto fit = geometry::fitCylinder(mesh))
      return SpecialReflector{SpecialShape::Cylinder, fit->point, fit->axis, fit->radius, 0, fit->isInside};
  if (shape == scene::ReflectorShape::Cone)
    if (const auto fit = geometry::fitCone(mesh))
      return SpecialReflector{SpecialShape::Cone,    fit->apex,    fit->axis, 0,
                              fit->halfAngleRadians, fit->isInside};
  return std::nullopt;
}

}  // namespace

std::string findAnalyticObstacle(const scene::Reflector& reflector, bool flipped) {
  if (reflector.isRefractor()) return "light goes through: no reflection points are sought";
  switch (reflector.shape) {
    case scene::ReflectorShape::Plane:
      return "flat: mirrored as a whole, no reflection points are sought";
    case scene::ReflectorShape::Sphere:
    case scene::ReflectorShape::Cylinder:
    case scene::ReflectorShape::Cone:
    case scene::ReflectorShape::Quadric:
    case scene::ReflectorShape::Torus:
    case scene::ReflectorShape::Aspheric:
      return {};
    case scene::ReflectorShape::Extrusion:
      if (reflector.isConvex && !flipped) return {};
      return "an extrusion that is not convex: a point may have several reflections";
    case scene::ReflectorShape::Mesh:
      break;
  }
  return "no sphere, cylinder, cone, extrusion, quadric, torus or aspheric mirror fits its vertices";
}

std::unique_ptr<PointFinder> makeAnalyticFinder(const scene::WorldGeometry& world, std::uint32_t reflector,
                                                bool flipped, double skirt) {
  const scene::Reflector& mirror = world.reflectors[reflector];
  if (!findAnalyticObstacle(mirror, flipped).empty()) return nullptr;
  const PartMesh mesh = extractPart(world, world.parts[mirror.part]);
  if (mirror.shape == scene::ReflectorShape::Extrusion) {
    const auto profile = geometry::fitExtrusion(mesh.view());
    return profile ? std::make_unique<ExtrudedFinder>(*profile, skirt) : nullptr;
  }
  if (auto surface = fitImplicit(mirror.shape, mesh.view()))
    return std::make_unique<ImplicitFinder>(std::move(surface), flipped, mesh.view(), mirror);
  auto special = fitSpecial(mirror.shape, mesh.view());
  if (!special) return nullptr;
  if (flipped) special->isInside = !special->isInside;
  return std::make_unique<SpecialFinder>(*special, mirror);
}

}  // namespace catoptric::virtual_object
