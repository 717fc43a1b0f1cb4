// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/make_point_finder.h"

#include "catoptric/core/log.h"
#include "catoptric/virtual_object/analytic_finder.h"
#include "catoptric/virtual_object/layered_finder.h"
#include "catoptric/virtual_object/reflection_subdivision.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kSkirt = 0.45;  // of the mirror's radius, as ReflectorMeshOptions

}  // namespace

std::unique_ptr<PointFinder> makePointFinder(Solver solver, const scene::WorldGeometry& world,
                                             std::uint32_t reflector, bool flipped,
                                             const ReflectorMesh& mesh) {
  switch (solver) {
    case Solver::Explosion:
    case Solver::Refined:
      break;
    case Solver::Analytic: {
      const scene::Reflector& mirror = world.reflectors[reflector];
      auto finder = makeAnalyticFinder(world, reflector, flipped, kSkirt * mirror.radius);
      if (!finder)
        core::logWarningOnce("\"" + mirror.name + "\": solver refined in place of analytic; " +
                             findAnalyticObstacle(mirror, flipped));
      return finder;
    }
    case Solver::Layered:
      return std::make_unique<LayeredFinder>(mesh);
    case Solver::Subdivision:
      return std::make_unique<SubdivisionFinder>(mesh);
  }
  return nullptr;
}

}  // namespace catoptric::virtual_object
