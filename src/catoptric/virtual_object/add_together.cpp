// SPDX-License-Identifier: Apache-2.0
// Several mirrors at once, where the processor draws their numbers and shades them: GL, which one thread may
// talk to, reads all of them first and takes all of them at the end, and in between no core waits for a
// mirror to be done before the next one begins. As many at a time as have no more pixels than the picture: in
// facing mirrors chains are many, and each has its own images.
#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/virtual_object_method.h"

namespace catoptric::virtual_object {

bool VirtualObjectMethod::drawsFlat(const raster::FrameContext& frame) const {
  return !numbersByGl_ && frame.merge == raster::Merge::Ids && SceneTriangles::fits(frame.scene.geometry()) &&
         !hasCutOuts(frame.scene);
}

/// Puts a mirror's virtual vertices where they belong, if it is one that can be added: all it shows are
/// numbers. Later: a mirror that was begun before it uses the same arrays.
VirtualObjectMethod::Begun VirtualObjectMethod::beginAdding(raster::FrameContext& frame,
                                                            const raster::Chain& chain,
                                                            const raster::Level& parent, std::size_t index) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  const dvec3 drawEye = findDrawEye(frame, chain);
  if (!chain.curved) {
    beginMirror(index, frame, chain, makeView(frame, chain, drawEye, parent), nullptr);
    return Begun::Yes;
  }
  if (onGpu_ || numbersByGl_ || findDrawing(chain, world) != Drawing::Numbered) return Begun::No;
  Prepared& p = prepareReflector(frame, chain, drawEye);
  if (p.objects.indices.empty() || isInParts(p, world) || hasSurfaces(p)) return Begun::No;
  for (std::size_t i = 0; i < index; ++i)
    if (numberedMirrors_[i]->prepared == &p) return Begun::Later;
  noteShown(chain, p, drawEye);
  if (!findVertices(frame, chain, p)) return Begun::No;
  beginMirror(index, frame, chain, makeView(frame, chain, drawEye, parent), &p);
  return Begun::Yes;
}

void VirtualObjectMethod::addBegun(raster::FrameContext& frame, const raster::Level& parent,
                                   std::size_t count) {
  shading_.prepare(frame.scene, parent);
  static_cast<void>(frame.scene.laneEnvironment());  // made once, and not by two threads
  const std::span mirrors(numberedMirrors_.data(), count);
  const auto forAll = [&](const auto& body) {
    core::parallelFor(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(*mirrors[i]);
    });
  };
  core::runBeside([&] { forAll([&](NumberedMirror& m) { markTriangles(frame, m); }); },
                  [&] {
                    for (const auto& m : mirrors) m->inLanes.readParent(parent, m->chain->bounds);
                  });
  forAll([&](NumberedMirror& m) {
    drawNumbersHere(frame, m, false);
    m.inLanes.add(frame, *m.chain, shading_.triangles(), {m.numbers.hits, true});
  });
  for (std::size_t i = 0; i < count; ++i) {
    NumberedMirror& m = *mirrors[i];
    for (std::size_t k = 0; k < i; ++k)
      m.inLanes.takeAdded(mirrors[k]->inLanes, frame.parentIds, mirrors[k]->chain->parentWord());
    m.inLanes.writeAdded(*frame.addsTo);
    countTriangles(frame, m);
  }
}

std::vector<const raster::Chain*> VirtualObjectMethod::addTogether(raster::FrameContext& frame,
                                                                   std::vector<const raster::Chain*> chains,
                                                                   const raster::Level& parent) {
  const std::size_t most = std::size_t(parent.widthPx) * std::size_t(parent.heightPx);
  std::vector<const raster::Chain*> others, later;
  for (; !chains.empty(); chains.swap(later)) {
    later.clear();
    std::size_t count = 0, pixels = 0;
    bool hasRoom =
        true;  // those of one mirror stay in their order, for searches begin where the last one ended
    for (const raster::Chain* chain : chains) {
      const std::size_t area = std::size_t(chain->bounds.width) * std::size_t(chain->bounds.height);
      hasRoom = hasRoom && (count == 0 || pixels + area <= most);
      const Begun begun = hasRoom ? beginAdding(frame, *chain, parent, count) : Begun::Later;
      if (begun == Begun::Yes) ++count, pixels += area;
      if (begun == Begun::Later) later.push_back(chain);
      if (begun == Begun::No) others.push_back(chain);
    }
    if (count > 0) addBegun(frame, parent, count);
  }
  return others;
}

}  // namespace catoptric::virtual_object
