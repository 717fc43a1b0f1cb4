// SPDX-License-Identifier: Apache-2.0
// What reflectors are called, and which of them options mean.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catoptric/scene/world_geometry.h"
#include "catoptric/scene/world_primitive.h"

namespace catoptric::scene {

/// One name for each piece, in the order of primitives; "#k" where a name occurs more than once.
[[nodiscard]] std::vector<std::string> nameReflectors(const Scene& scene,
                                                      std::span<const WorldPrimitive> primitives);

/// --reflector: which pieces are kept; all without names. A name is that of a piece, an instance or a
/// material. Throws core::Error("reflector.unknown") for one that matches nothing.
[[nodiscard]] std::vector<bool> selectReflectors(const Scene& scene,
                                                 std::span<const WorldPrimitive> primitives,
                                                 std::span<const std::string> names,
                                                 std::span<const std::string> only);

/// --morphed and --mapped, which wins: sets Reflector::morphed of the pieces that are kept, which are
/// `reflectors` in the same order. Throws as selectReflectors().
void chooseMorphed(const Scene& scene, std::span<const WorldPrimitive> primitives,
                   std::span<const std::string> names, const std::vector<bool>& keep,
                   const ReflectorOptions& options, std::span<Reflector> reflectors);

}  // namespace catoptric::scene
