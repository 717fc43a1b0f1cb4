// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: whatever the bytes are, the importer throws core::Error or returns a scene that keeps all
// promises of scene.h. Good seeds: any small .glb and .gltf files. No file is ever opened: there is no base
// folder.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "catoptric/core/error.h"
#include "catoptric/scene/gltf_import.h"
#include "gltf_scene_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  catoptric::scene::ImportOptions options;
  options.maxMemoryBytes = std::size_t(64) << 20;
  options.maxPixels = std::size_t(1) << 18;
  options.maxNodes = 10000;
  try {
    const auto scene =
        catoptric::scene::importGltf({reinterpret_cast<const std::byte*>(data), size}, {}, "fuzz", options);
    const std::string fault = catoptric::scene::gltf_test::checkScene(scene);
    if (!fault.empty()) {
      std::fprintf(stderr, "the scene is broken: %s\n", fault.c_str());
      std::abort();
    }
  } catch (const catoptric::core::Error&) {
  }
  return 0;
}
