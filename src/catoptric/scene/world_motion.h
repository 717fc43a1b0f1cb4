// SPDX-License-Identifier: Apache-2.0
// Moves a scene and its world geometry to a time: instances, cameras and lights follow their nodes, meshes
// are morphed and skinned, reflectors are measured anew (plane, shape, extent). Instances can be shifted by
// hand from where that puts them. Vertices and triangles keep their places in the world arrays; nothing is
// computed ahead.
//
// Departures: which triangles are mirrors, how they fall into pieces and what belongs to the shell stays as
// it was at rest. Cost: linear in what moves, on all cores; nothing is allocated after the first call, but
// for the measures of moving reflectors.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "catoptric/scene/deformation.h"
#include "catoptric/scene/pose.h"
#include "catoptric/scene/scene.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::scene {

class WorldMotion {
 public:
  /// `world` was made from `scene` in its rest pose with `options`; both must outlive the object.
  /// `animation`: see chooseAnimations().
  WorldMotion(Scene& scene, WorldGeometry& world, const ReflectorOptions& options,
              const std::string& animation = {});

  /// Before the first and after the last key frame everything stands still.
  void setTime(double timeS);

  /// Places an instance this far from where its node or the file puts it, metres, at this time and all
  /// others; zero undoes it. Returns the parts whose vertices have moved, valid until the next call.
  std::span<const std::uint32_t> shiftInstance(std::uint32_t instance, const dvec3& shift);

  /// Parts whose vertices setTime() writes, ascending: the same at each time.
  [[nodiscard]] std::span<const std::uint32_t> movingParts() const { return movingParts_; }
  /// What is seen stays as it is, wherever from.
  [[nodiscard]] bool movesOnlyCameras() const;
  [[nodiscard]] const MotionChoice& choice() const { return choice_; }

 private:
  struct RestCamera {
    Camera camera;
    dmat4 nodeFromWorld;
  };
  struct RestLight {
    Light light;
    dmat4 nodeFromWorld;
  };
  void findMovingNodes();
  [[nodiscard]] bool moves(int node) const { return node >= 0 && nodeMoves_[std::size_t(node)]; }
  [[nodiscard]] bool isDeformed(const Mesh& mesh) const;
  void placeInstances();
  void placeCamerasAndLights();
  void deformMeshes();
  void writePart(const Part& part);
  void measureParts(std::span<const std::uint32_t> parts);
  void turnWinding(const Part& part);

  Scene& scene_;
  WorldGeometry& world_;
  ReflectorOptions options_;
  MotionChoice choice_;
  Pose pose_;
  std::vector<bool> nodeMoves_, meshDeforms_;
  std::vector<std::uint32_t> movingParts_, shiftedParts_;
  std::vector<dmat4> placements_;  ///< of each instance, without its shift
  std::vector<dvec3> shifts_;      ///< of each instance
  bool isPosed_ = false;           ///< setTime() was called: deformed_ holds what is drawn
  std::vector<std::vector<DeformedVertices>> deformed_;  ///< by mesh and primitive
  std::vector<dmat4> worldFromVertex_;                   ///< of the joints of one skin
  std::vector<bool> wasMirroring_;                       ///< of each instance, at the time before
  std::vector<RestCamera> restCameras_;
  std::vector<RestLight> restLights_;
};

}  // namespace catoptric::scene
