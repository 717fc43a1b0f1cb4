// SPDX-License-Identifier: Apache-2.0
// A chain of mirrors: eye -> first -> ... -> last -> scene. Flat links are removed by mirroring, so a chain
// with at most one curved mirror needs one virtual object (methods.md, "Chains").
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/gl/framebuffer.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::raster {

struct Chain {
  std::uint32_t id = 0;                 ///< 1, 2, ... within a frame; 0 is the eye itself
  std::uint32_t parent = 0;             ///< id of the chain without its last mirror
  int level = 0;                        ///< number of mirrors and refractors
  int crossings = 0;                    ///< of which refractors
  std::uint32_t last = core::kNoId;     ///< reflector
  std::vector<std::uint32_t> mirrors;   ///< all of its reflectors, from the eye on
  std::optional<std::uint32_t> curved;  ///< the one curved reflector, if any
  bool hasSecondCurved = false;         ///< then only solver `exact` or an environment map can show it
  dmat4 screenFromDraw{1.0};  ///< planar mirrors before the curved one (all of them if there is none)
  dmat4 drawFromWorld{1.0};   ///< planar mirrors behind the curved one, applied to the scene
  gl::Scissor bounds;         ///< of the last mirror's pixels in the level before
  std::uint64_t pixels = 0;   ///< how many

  /// Likewise; a refractor counts as curved, even if it is flat.
  [[nodiscard]] bool hasRefractor() const { return crossings > 0; }
  /// ids.g that the parent level stores at the last mirror's pixels.
  [[nodiscard]] std::uint32_t parentWord() const { return (last + 1u) | (parent << 16); }
};

/// The chain that ends at the eye.
[[nodiscard]] inline Chain makeEyeChain() {
  return {};
}

/// `chain` with one more mirror at its end.
[[nodiscard]] inline Chain extendChain(const Chain& chain, std::uint32_t reflector,
                                       const scene::WorldGeometry& world) {
  Chain next = chain;
  next.parent = chain.id;
  next.level = chain.level + 1;
  next.last = reflector;
  next.mirrors.push_back(reflector);
  const scene::Reflector& mirror = world.reflectors[reflector];
  if (mirror.isRefractor()) ++next.crossings;
  if (mirror.isPlanarMirror()) {
    const dmat4 m = core::makeReflectionMatrix(mirror.plane);
    if (chain.curved)
      next.drawFromWorld = chain.drawFromWorld * m;
    else
      next.screenFromDraw = chain.screenFromDraw * m;
  } else if (chain.curved) {
    next.hasSecondCurved = true;
  } else {
    next.curved = reflector;
  }
  return next;
}

/// How the light of a leg behind the chain's last refractor falls with its length, if it stays inside.
[[nodiscard]] inline vec3 findAbsorption(const Chain& chain, const scene::WorldGeometry& world) {
  for (auto i = chain.mirrors.rbegin(); i != chain.mirrors.rend(); ++i)
    if (world.reflectors[*i].isRefractor()) return world.reflectors[*i].absorption;
  return vec3(0);
}

}  // namespace catoptric::raster
