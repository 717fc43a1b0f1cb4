// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/reflector_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "catoptric/core/error.h"

namespace catoptric::scene {
namespace {

std::string baseName(const Scene& scene, const WorldPrimitive& primitive) {
  const std::string& instance = scene.instances[primitive.instance].name;
  if (!instance.empty()) return instance;
  if (primitive.material >= 0 && !scene.materials[std::size_t(primitive.material)].name.empty())
    return scene.materials[std::size_t(primitive.material)].name;
  return fmt::format("object {}", primitive.instance);
}

/// Which pieces one of the names means; a name that matches nothing is an error.
std::vector<bool> findNamed(const Scene& scene, std::span<const WorldPrimitive> primitives,
                            std::span<const std::string> names, std::span<const std::string> wanted) {
  std::vector<bool> isNamed(names.size(), false);
  for (const std::string& name : wanted) {
    bool found = false;
    for (const WorldPrimitive& primitive : primitives)
      for (std::size_t i = 0; i < primitive.pieces.size(); ++i) {
        const std::size_t piece = primitive.firstReflector + i;
        const bool matches =
            names[piece] == name || scene.instances[primitive.instance].name == name ||
            (primitive.material >= 0 && scene.materials[std::size_t(primitive.material)].name == name);
        if (matches) isNamed[piece] = found = true;
      }
    if (found) continue;
    const std::size_t shown = std::min<std::size_t>(names.size(), 8);
    throw core::Error("reflector.unknown", "no reflector is called \"" + name + "\"", {},
                      names.empty()
                          ? "the scene has no reflectors"
                          : fmt::format("the scene has: {}{}",
                                        fmt::join(names.begin(), names.begin() + std::ptrdiff_t(shown), ", "),
                                        shown < names.size() ? ", ..." : ""));
  }
  return isNamed;
}

}  // namespace

std::vector<std::string> nameReflectors(const Scene& scene, std::span<const WorldPrimitive> primitives) {
  std::vector<std::string> names;
  std::map<std::string, int> total, used;
  for (const WorldPrimitive& primitive : primitives)
    for (std::size_t i = 0; i < primitive.pieces.size(); ++i) {
      names.push_back(baseName(scene, primitive));
      ++total[names.back()];
    }
  for (std::string& name : names)
    if (total[name] > 1) {
      const std::string base = name;
      do name = fmt::format("{} #{}", base, ++used[base]);
      while (total.count(name) != 0);  // an instance may be called "mirror #2" itself
    }
  return names;
}

std::vector<bool> selectReflectors(const Scene& scene, std::span<const WorldPrimitive> primitives,
                                   std::span<const std::string> names, std::span<const std::string> only) {
  return only.empty() ? std::vector<bool>(names.size(), true) : findNamed(scene, primitives, names, only);
}

void chooseMorphed(const Scene& scene, std::span<const WorldPrimitive> primitives,
                   std::span<const std::string> names, const std::vector<bool>& keep,
                   const ReflectorOptions& options, std::span<Reflector> reflectors) {
  const std::vector<bool> morphed = findNamed(scene, primitives, names, options.morphed),
                          mapped = findNamed(scene, primitives, names, options.mapped);
  std::size_t reflector = 0;
  for (std::size_t piece = 0; piece < names.size(); ++piece) {
    if (!keep[piece]) continue;
    Reflector& r = reflectors[reflector++];
    if (!morphed[piece] && !mapped[piece]) continue;
    r.morphed = !mapped[piece];
    r.morphedReason = mapped[piece] ? "--mapped" : "--morphed";
  }
}

}  // namespace catoptric::scene
