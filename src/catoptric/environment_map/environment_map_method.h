// SPDX-License-Identifier: Apache-2.0
// Environment maps (methods.md, section 4): a cube of pictures taken at the mirror's centroid without the
// mirror, looked up in the mirror direction; plain, or corrected by the box of the room. The baseline
// everyone has.
#pragma once

#include "catoptric/raster/scene_cube.h"

namespace catoptric::environment_map {

class EnvironmentMapMethod : public raster::ReflectionMethod {
 public:
  EnvironmentMapMethod();
  [[nodiscard]] std::string_view name() const override { return "environment"; }
  [[nodiscard]] bool supports(const raster::Chain&) const override { return true; }
  void setOptions(int sizeTexels, bool boxCorrected);
  void prepare(raster::FrameContext&) override {}
  void geometryChanged() override { cubes_.geometryChanged(); }
  void materialsChanged() override { cubes_.geometryChanged(); }
  void render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
              raster::Level& target) override;

 private:
  gl::Program program_;
  gl::VertexArray nothing_;
  bool boxCorrected_ = true;
  raster::SceneCubeCache cubes_;
};

/// The box of the room: bounds of the shell if it holds the point, else of the whole scene.
[[nodiscard]] core::Box findRoomBox(const scene::WorldGeometry& world, const dvec3& point);

}  // namespace catoptric::environment_map
