// SPDX-License-Identifier: Apache-2.0
// Several mirrors at once, where the processor draws their numbers and shades them: GL, which one thread may
// talk to, reads all of them first and takes all of them at the end, and in between no core waits for a
// mirror to be done before the next one begins.
#include <algorithm>
#include <chrono>
#include <future>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/virtual_object_method.h"

namespace catoptric::virtual_object {

bool VirtualObjectMethod::drawsFlat(const raster::FrameContext& frame, const raster::Chain& chain) const {
  return !numbersByGl_ && !chain.curved && !chain.hasRefractor() && frame.merge == raster::Merge::Ids &&
         SceneTriangles::fits(frame.scene.geometry()) && !hasCutOuts(frame.scene);
}

/// Puts a mirror's virtual vertices where they belong, if it is one that can be added: all it shows are
/// numbers, and no mirror of this frame before it uses the same arrays.
bool VirtualObjectMethod::beginAdding(raster::FrameContext& frame, const raster::Chain& chain,
                                      const raster::Level& parent, std::size_t index) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  if (!chain.curved) {
    beginMirror(index, frame, chain, makeView(frame, chain, findDrawEye(frame, chain), parent), nullptr);
    return true;
  }
  if (onGpu_ || numbersByGl_ || findDrawing(chain, world) != Drawing::Numbered) return false;
  const dvec3 drawEye = findDrawEye(frame, chain);
  Prepared& p = prepareReflector(frame, chain, drawEye);
  if (p.objects.indices.empty() || isInParts(p, world) || hasSurfaces(p)) return false;
  for (std::size_t i = 0; i < index; ++i)
    if (numberedMirrors_[i]->prepared == &p) return false;
  noteShown(chain, p, drawEye);
  if (!findVertices(frame, chain, p)) return false;
  beginMirror(index, frame, chain, makeView(frame, chain, drawEye, parent), &p);
  return true;
}

std::vector<const raster::Chain*> VirtualObjectMethod::addTogether(raster::FrameContext& frame,
                                                                   std::vector<const raster::Chain*> chains,
                                                                   const raster::Level& parent) {
  std::size_t count = 0;
  std::erase_if(chains, [&](const raster::Chain* chain) {
    const bool isAdded = beginAdding(frame, *chain, parent, count);
    count += isAdded ? 1 : 0;
    return isAdded;
  });
  if (count == 0) return chains;
  shading_.prepare(frame.scene, parent);
  static_cast<void>(frame.scene.laneEnvironment());  // made once, and not by two threads
  const std::span mirrors(numberedMirrors_.data(), count);
  const auto forAll = [&](const auto& body) {
    core::parallelFor(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(*mirrors[i]);
    });
  };
  auto marks =
      std::async(std::launch::async, [&] { forAll([&](NumberedMirror& m) { markTriangles(frame, m); }); });
  for (const auto& m : mirrors) m->inLanes.readParent(parent, m->chain->bounds);
  marks.get();
  forAll([&](NumberedMirror& m) {
    drawNumbersHere(frame, m, false);
    m.inLanes.add(frame, *m.chain, shading_.triangles(), {m.numbers.hits, true});
  });
  for (std::size_t i = 0; i < count; ++i) {
    NumberedMirror& m = *mirrors[i];
    for (std::size_t k = 0; k < i; ++k)
      m.inLanes.takeAdded(mirrors[k]->inLanes, frame.parentIds, mirrors[k]->chain->parentWord());
    m.inLanes.writeAdded(*frame.addsTo);
    this->count(frame, m);
  }
  return chains;
}

}  // namespace catoptric::virtual_object
