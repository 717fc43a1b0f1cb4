// SPDX-License-Identifier: Apache-2.0
// importGltf(): a glTF 2.0 file to a Scene.
//
//   1. Split the GLB, parse the JSON (container.h).
//   2. Read and validate the whole document into plain structs (model.h); nothing has looked at geometry yet.
//   3. Read the buffers, through the URI policy (uri.h, data.h).
//   4. Choose the scene, compute world matrices, place meshes, cameras and lights (placement.h, mesh.h).
//   5. Decode the images that materials use (textures.h).
//   6. Read the key frames of animations and what they drive (motion.h).
//
// Everything is charged to one memory budget before it is allocated; nothing recurses over the input; the
// result depends on the bytes of the file only. docs/gltf.md lists what is supported, refused and repaired.
// Source: Khronos, glTF 2.0 Specification, 2.0.1; the extensions' own specifications.
#include "catoptric/core/error.h"
#include "catoptric/core/file.h"
#include "catoptric/scene/gltf/container.h"
#include "catoptric/scene/gltf/data.h"
#include "catoptric/scene/gltf/model.h"
#include "catoptric/scene/gltf/motion.h"
#include "catoptric/scene/gltf/placement.h"
#include "catoptric/scene/gltf/textures.h"
#include "catoptric/scene/gltf_import.h"

namespace catoptric::scene {
namespace {

Scene importFrom(gltf::Context& context, std::span<const std::byte> bytes,
                 const std::filesystem::path& baseFolder) {
  const gltf::Container container = gltf::openContainer(context, bytes);
  gltf::Model model;
  {
    const gltf::Json json = gltf::parseJson(context, container.json);
    model = gltf::readModel(context, gltf::Element(context, json), container);
  }
  const gltf::Data data(context, model, baseFolder, container.binary);

  const gltf::SceneSource source = gltf::chooseScene(context, model);
  const std::vector<dmat4> worldFromNode = gltf::computeWorldMatrices(model);
  const std::vector<int> nodes = gltf::collectNodes(model, source);
  Scene scene;
  scene.name = !source.name.empty() ? source.name : std::filesystem::path(context.name()).stem().string();
  gltf::placeMeshes(data, nodes, worldFromNode, scene);
  gltf::placeCamerasAndLights(data, nodes, worldFromNode, scene);
  gltf::importMaterials(data, scene);
  gltf::importMotion(data, scene);
  if (scene.instances.empty()) context.warn("the scene has nothing to draw");
  scene.warnings = context.takeWarnings();
  return scene;
}

}  // namespace

Scene importGltf(std::span<const std::byte> bytes, const std::filesystem::path& baseFolder,
                 const std::string& name, const ImportOptions& options) {
  gltf::Context context(name, options);
  try {
    return importFrom(context, bytes, baseFolder);
  } catch (const std::bad_alloc&) {
    context.fail("gltf.memory", "the scene does not fit into memory");
  } catch (const std::filesystem::filesystem_error&) {
    context.fail("gltf.file", "a file that the scene needs cannot be read");
  }
}

Scene importGltf(const std::filesystem::path& path, const ImportOptions& options) {
  const std::vector<std::byte> bytes = core::readFile(path, options.maxMemoryBytes);
  const std::filesystem::path folder =
      path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  return importGltf(bytes, folder, path.filename().string(), options);
}

}  // namespace catoptric::scene
