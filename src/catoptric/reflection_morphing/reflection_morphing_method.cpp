// SPDX-License-Identifier: Apache-2.0
// Steps: 1 morph the vertices, 2 draw the triangles where the level before shows the mirror, 3 the
// environment in the mirror direction behind them.
#include "catoptric/reflection_morphing/reflection_morphing_method.h"

#include <algorithm>
#include <chrono>

#include "catoptric/core/log.h"
#include "catoptric/core/parallel.h"

namespace catoptric::reflection_morphing {
namespace {

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

ReflectionMorphingMethod::Objects::Objects(const scene::WorldGeometry& world, std::uint32_t reflector,
                                           const raster::TessellationOptions& options)
    : maxErrorPx(options.maxErrorPx),
      objects(raster::tessellateForReflector(world, reflector, options)),
      pass(objects),
      virtualPositions(objects.positions.size()),
      mirrorPoints(objects.positions.size()) {}

void ReflectionMorphingMethod::setSource(std::shared_ptr<const LocationSource> source) {
  source_ = std::move(source);
  cell_.reset();
  locations_.clear();
  corners_.clear();
}

void ReflectionMorphingMethod::partsMoved(const scene::WorldGeometry& world,
                                          std::span<const std::uint32_t> parts) {
  const auto isMirror = [&](std::uint32_t part) { return world.parts[part].reflector != core::kNoId; };
  if (std::any_of(parts.begin(), parts.end(), isMirror)) {
    geometryChanged();
    return;
  }
  isMoving_.resize(world.parts.size(), 0);
  bool isNew = false;
  for (const std::uint32_t part : parts) {
    isNew = isNew || isMoving_[part] == 0;
    isMoving_[part] = 1;
  }
  std::erase_if(objects_, [&](const auto& entry) { return isNew || entry.first.areMoving; });
  std::erase_if(corners_, [&](const auto& entry) { return isNew || entry.first.second.areMoving; });
}

void ReflectionMorphingMethod::prepare(raster::FrameContext& frame) {
  if (!source_) return;
  const std::optional<SamplingCell> cell = source_->grid().findCell(frame.camera.eye);
  if (!cell)
    core::logWarningOnce(
        "the eye is outside the grid of sampling locations; curved mirrors show environment maps");
  if (cell && cell_ && cell->locations == cell_->locations) {
    cell_ = cell;
    return;
  }
  corners_.clear();
  std::map<std::uint32_t, std::shared_ptr<const SamplingLocation>> kept;
  std::vector<std::pair<std::uint32_t, std::shared_ptr<const SamplingLocation>>> missing;
  if (cell)
    for (const std::uint32_t index : cell->locations) {
      const auto at = locations_.find(index);
      if (at == locations_.end())
        missing.emplace_back(index, nullptr);
      else
        kept.insert(*at);
    }
  core::parallelFor(missing.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) missing[i].second = source_->load(missing[i].first);
  });
  kept.insert(missing.begin(), missing.end());
  locations_ = std::move(kept);
  cell_ = cell;
}

CellTrace ReflectionMorphingMethod::findCellTrace(const std::vector<std::uint32_t>& trace) const {
  CellTrace found{};
  if (!cell_) return found;
  for (std::size_t k = 0; k < 8; ++k) found[k] = locations_.at(cell_->locations[k])->findTrace(trace);
  return found;
}

bool ReflectionMorphingMethod::supports(const raster::Chain& chain) const {
  if (!chain.curved || !cell_) return false;
  const auto weights = weighTrace(findCellTrace(chain.mirrors), cell_->weights);
  return std::any_of(weights.begin(), weights.end(), [](float weight) { return weight > 0; });
}

ReflectionMorphingMethod::Objects& ReflectionMorphingMethod::getObjects(const raster::FrameContext& frame,
                                                                        const ObjectsKey& key) {
  std::unique_ptr<Objects>& slot = objects_[key];
  if (!slot || slot->maxErrorPx != frame.maxErrorPx) {
    std::vector<std::uint8_t> wanted = isMoving_;
    for (std::uint8_t& part : wanted) part = (part != 0) == key.areMoving ? 1 : 0;
    slot = std::make_unique<Objects>(frame.scene.geometry(), key.reflector,
                                     raster::TessellationOptions{.maxErrorPx = frame.maxErrorPx,
                                                                 .reflectorDiameterPx = key.sizePx,
                                                                 .keepsBehind = !key.isLast,
                                                                 .parts = wanted});
    std::erase_if(corners_, [&](const auto& entry) { return entry.first.second == key; });
  }
  return *slot;
}

CornerPoints& ReflectionMorphingMethod::morph(raster::FrameContext& frame, const raster::Chain& chain,
                                              const ObjectsKey& key, Objects& objects) {
  const CellTrace trace = findCellTrace(chain.mirrors);
  const auto [at, isNew] = corners_.try_emplace({chain.mirrors, key});
  CornerPoints& corners = at->second;
  const std::size_t count = objects.objects.positions.size();
  auto start = std::chrono::steady_clock::now();
  if (dynamic_ || isNew) {
    lookUpCorners(trace, objects.objects.positions, objects.objects.indices, corners);
    frame.counters.lookedUpVertices += count;
    frame.counters.lookUpMs += millisecondsSince(start);
  }
  start = std::chrono::steady_clock::now();
  morphVertices(vec3(frame.camera.eye), weighTrace(trace, cell_->weights), corners, objects.virtualPositions,
                objects.mirrorPoints);
  frame.counters.virtualVertices += count;
  frame.counters.virtualVerticesMs += millisecondsSince(start);
  return corners;
}

void ReflectionMorphingMethod::drawObjects(raster::FrameContext& frame, const raster::Chain& chain,
                                           const raster::Level& parent, bool areMoving,
                                           raster::Level& target) {
  // 1
  const auto& reflectors = frame.scene.geometry().reflectors;
  const auto lastCurved = std::find_if(chain.mirrors.rbegin(), chain.mirrors.rend(),
                                       [&](std::uint32_t r) { return !reflectors[r].isPlanarMirror(); });
  const ObjectsKey key{*lastCurved,
                       raster::findTessellationSize(reflectors[*lastCurved], frame.camera.eye, frame.camera),
                       areMoving, *lastCurved == chain.last};
  Objects& objects = getObjects(frame, key);
  if (objects.objects.indices.empty()) return;
  const CornerPoints& corners = morph(frame, chain, key, objects);

  // 2
  // After several mirrors the first mirror point says nothing about orientation: points that coincide with
  // theirs are not judged.
  const std::span<const vec3> scenePoints =
      chain.mirrors.size() > 1 ? std::span<const vec3>(objects.mirrorPoints) : std::span<const vec3>();
  raster::SurfaceView view;
  view.clipFromDraw = raster::makeClipFromWorld(frame.camera, frame.nearPlane, frame.jitterPx);
  view.eye = view.drawEye = frame.camera.eye;
  view.windingFlipped = (chain.level - chain.crossings) % 2 == 1;
  view.chain = &chain;
  view.parent = &parent;
  view.masking = frame.masking;
  if (reflectors[chain.last].isPlanarMirror())
    raster::clipAtLastMirror(reflectors[chain.last], chain.last,
                             reflectors[chain.mirrors[chain.mirrors.size() - 2]].centre, view);
  objects.pass.draw(frame, view, objects.virtualPositions, corners.kinds, objects.mirrorPoints, scenePoints,
                    target);
}

void ReflectionMorphingMethod::render(raster::FrameContext& frame, const raster::Chain& chain,
                                      const raster::Level& parent, raster::Level& target) {
  ++frame.counters.morphedTraces;
  drawObjects(frame, chain, parent, false, target);
  if (!isMoving_.empty()) drawObjects(frame, chain, parent, true, target);
  // 3
  background_.draw(frame.scene, chain, parent, target);
}

}  // namespace catoptric::reflection_morphing
