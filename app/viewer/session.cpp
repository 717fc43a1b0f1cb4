// SPDX-License-Identifier: Apache-2.0
#include "viewer/session.h"

#include <fmt/format.h>

#include "catoptric/core/error.h"

namespace catoptric::viewer {
namespace {

/// `what`: "object" or "material".
template <class Named>
void checkNames(const std::map<std::uint32_t, std::string>& names, const std::vector<Named>& things,
                const char* what) {
  for (const auto& [index, name] : names)
    if (index >= things.size() || things[index].name != name)
      throw core::Error("session.scene",
                        fmt::format("the session edits {} {} '{}', the scene has {} there", what, index, name,
                                    index < things.size() ? "'" + things[index].name + "'" : "nothing"),
                        {}, "the scene has changed since: take that edit out of the session file");
}

}  // namespace

void checkSession(const Session& session, const scene::Scene& scene) {
  checkNames(session.objectNames, scene.instances, "object");
  checkNames(session.materialNames, scene.materials, "material");
  if (session.sceneCamera && *session.sceneCamera >= scene.cameras.size())
    throw core::Error("session.scene",
                      fmt::format("the session follows camera {}, the scene has {}", *session.sceneCamera,
                                  scene.cameras.size()),
                      {}, "take \"scene_camera\" out of the session file");
}

Session makeSession(const Model& model, const ivec2& windowPx) {
  const ViewState& view = model.view;
  Session session;
  session.scene = model.loaded.request;
  session.scene.keepsCamera = false;
  session.sceneOptions = model.sceneOptions;
  session.animation = model.loaded.scene->animation;
  session.camera = view.camera;
  session.sceneCamera = view.sceneCamera;
  session.frame = app::withMethod(view.frame, model.variants[view.variant]);
  session.frame.widthPx = windowPx.x;
  session.frame.heightPx = windowPx.y;
  session.exposure = view.exposure;
  session.resolution = view.resolution;
  session.split = view.split;
  session.comparison = view.comparison;
  session.state = view.state;
  session.isPlaying = view.isPlaying;
  const scene::Scene& scene = model.loaded.scene->scene;
  for (const auto& [index, ignored] : view.state.shifts)
    session.objectNames[index] = scene.instances[index].name;
  for (const auto& [index, ignored] : view.state.materials)
    session.materialNames[std::uint32_t(index)] = scene.materials[std::size_t(index)].name;
  return session;
}

void restoreSession(const Session& session, ViewState& view) {
  view.camera = view.firstCamera = session.camera;
  view.sceneCamera = session.sceneCamera;
  view.resolution = session.resolution;
  view.split = session.split;
  view.comparison = session.comparison;
  view.state = session.state;
  view.isPlaying = session.isPlaying;
}

}  // namespace catoptric::viewer
