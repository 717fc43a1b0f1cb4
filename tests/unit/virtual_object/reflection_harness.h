// SPDX-License-Identifier: Apache-2.0
// A reflection drawn twice without any GL: once through virtual triangles and a small point-sampling
// rasterizer, once by tracing a ray through every mirror pixel against the uncut scene. The difference is the
// error of the method.
#pragma once

#include <string>
#include <vector>

#include "catoptric/core/seen.h"
#include "catoptric/geometry/mesh.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/raster/virtual_triangles.h"
#include "catoptric/scene/camera_frame.h"
#include "catoptric/scene/world_geometry.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::virtual_object::test {

using namespace raster;

/// A hand-made world: one mirror (reflector 0, part 0) and things to be reflected.
class TestWorld {
 public:
  explicit TestWorld(const geometry::Mesh& mirror, scene::ReflectorShape shape = scene::ReflectorShape::Mesh);
  void add(const geometry::Mesh& mesh, bool shell);

  [[nodiscard]] const scene::WorldGeometry& geometry() const { return geometry_; }
  /// Radius around a point that holds everything.
  [[nodiscard]] double farRadius(const dvec3& centre) const;

 private:
  std::uint32_t append(const geometry::Mesh& mesh, bool shell, std::uint32_t reflector);
  scene::WorldGeometry geometry_;
};

struct ErrorStatistics {
  std::size_t pixels = 0;
  double medianPx = 0, p95Px = 0, within1 = 0, lost = 0;
};

struct HarnessResult {
  ErrorStatistics mirror, objects;
  std::size_t triangles = 0, vertices = 0, drawn = 0;
  double solveSeconds = 0;
};

/// Draws and compares. The virtual objects are made from `solvedGeometry` if given, the truth always from the
/// world. `name` labels pictures, which are written as .ppm to the directory in CATOPTRIC_TEST_PICTURES when
/// that is set.
[[nodiscard]] HarnessResult measureReflection(const TestWorld& world, const scene::CameraFrame& camera,
                                              Solver solver, const TessellationOptions& tessellation,
                                              const std::string& name,
                                              const scene::WorldGeometry* solvedGeometry = nullptr);

}  // namespace catoptric::virtual_object::test
