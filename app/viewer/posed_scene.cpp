// SPDX-License-Identifier: Apache-2.0
// Steps from one state to the next: 1 materials, 2 the time, 3 shifts. A copy of its own for each thread:
// threads draw different moments, and a renderer wants what it draws to stay where it is.
#include "viewer/posed_scene.h"

#include <algorithm>
#include <utility>

#include "catoptric/core/error.h"

namespace catoptric::viewer {
namespace {

/// Of the mirrors that were picked by name those that an edit has made something else do not count.
scene::WorldGeometry makeGeometry(scene::Scene& scene, scene::ReflectorOptions options) {
  if (options.only.empty()) return scene::makeWorldGeometry(scene, options);
  const std::vector<std::string> wanted = std::exchange(options.only, {});
  const scene::WorldGeometry all = scene::makeWorldGeometry(scene, options);
  for (const std::string& name : wanted)
    if (std::any_of(all.reflectors.begin(), all.reflectors.end(), [&](const scene::Reflector& reflector) {
          return name == reflector.name || name == scene.instances[reflector.object].name ||
                 (reflector.material >= 0 && name == scene.materials[std::size_t(reflector.material)].name);
        }))
      options.only.push_back(name);
  if (options.only.empty())
    for (scene::Instance& instance : scene.instances) instance.hint.reflector = false;
  return scene::makeWorldGeometry(scene, options);
}

}  // namespace

PosedScene::PosedScene(ScenePointer base, const SceneState& state)
    : base_(std::move(base)), scene_(base_->scene) {
  if (state.materials.empty()) {
    geometry_ = base_->geometry;
  } else {
    for (const auto& [material, values] : state.materials)
      if (std::size_t(material) < scene_.materials.size())
        scene::writeMaterialValues(values, scene_.materials[std::size_t(material)]);
    geometry_ = makeGeometry(scene_, base_->reflectorOptions);
  }
  motion_ =
      std::make_unique<scene::WorldMotion>(scene_, geometry_, base_->reflectorOptions, base_->animation);
  state_.materials = state.materials;
  Change ignored;
  place(state, ignored);
}

void PosedScene::place(const SceneState& state, Change& change) {
  // 2
  if (state.timeS && state.timeS != state_.timeS) {
    motion_->setTime(*state.timeS);
    change.movedParts.assign(motion_->movingParts().begin(), motion_->movingParts().end());
    change.lights = !motion_->movesOnlyCameras();
  }
  // 3
  const auto shift = [&](std::uint32_t instance) {
    if (instance >= scene_.instances.size()) return;
    const auto parts = motion_->shiftInstance(instance, state.shiftOf(instance));
    change.movedParts.insert(change.movedParts.end(), parts.begin(), parts.end());
  };
  for (const auto& [instance, ignored] : state.shifts) shift(instance);
  for (const auto& [instance, ignored] : state_.shifts) shift(instance);
  std::sort(change.movedParts.begin(), change.movedParts.end());
  change.movedParts.erase(std::unique(change.movedParts.begin(), change.movedParts.end()),
                          change.movedParts.end());
  state_.timeS = state.timeS;
  state_.shifts = state.shifts;
}

std::optional<PosedScene::Change> PosedScene::bring(const SceneState& state) {
  if (state_.timeS && !state.timeS) return std::nullopt;
  Change change;
  // 1
  const auto setMaterial = [&](int material) {
    const scene::Material& original = base_->scene.materials[std::size_t(material)];
    const scene::MaterialValues wanted = state.valuesOf(material, original);
    if (wanted == state_.valuesOf(material, original)) return true;
    change.materials = true;
    return scene::changeMaterial(scene_, geometry_, base_->reflectorOptions, material, wanted);
  };
  for (const SceneState* some : {&state, static_cast<const SceneState*>(&state_)})
    for (const auto& [material, ignored] : some->materials)
      if (std::size_t(material) < scene_.materials.size() && !setMaterial(material)) return std::nullopt;
  state_.materials = state.materials;
  place(state, change);
  if (!change.isNothing()) snapshot_.reset();
  return change;
}

GeometryPointer PosedScene::snapshot() {
  if (!snapshot_)
    snapshot_ =
        state_ == SceneState{} ? geometryOf(base_) : std::make_shared<const scene::WorldGeometry>(geometry_);
  return snapshot_;
}

void KeptRenderer::warmUp() {
  try {
    context_ = renderer::makeSharedContext();
  } catch (const core::Error&) {
    context_.reset();
  }
}

renderer::Renderer& KeptRenderer::prepare(const ScenePointer& scene, const SceneState& state) {
  std::optional<PosedScene::Change> change;
  if (posed_ && posed_->base() == scene) change = posed_->bring(state);
  if (!change) {
    renderer_.reset();
    posed_.reset();  // before the next one is made: two copies at a time are enough
    posed_ = std::make_unique<PosedScene>(scene, state);
  }
  if (!renderer_)
    renderer_ = std::make_unique<renderer::Renderer>(posed_->scene(), posed_->geometry(), scene->environment,
                                                     context_);
  else if (change && !change->isNothing()) {
    if (change->materials) renderer_->updateMaterials();
    if (!change->movedParts.empty() || change->lights) renderer_->updateGeometry(change->movedParts);
  }
  return *renderer_;
}

}  // namespace catoptric::viewer
