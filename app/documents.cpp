// SPDX-License-Identifier: Apache-2.0
#include "documents.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include "catoptric/core/file.h"
#include "catoptric/core/parallel.h"
#include "catoptric/scene/world_geometry.h"
#include "terminal.h"
#include "version.h"

namespace catoptric::app {
namespace {

std::string describeSystem() {
  utsname system{};
  if (uname(&system) != 0) return "unknown";
  return fmt::format("{} {} {}", system.sysname, system.release, system.machine);
}

/// What is not there is no reason for --version or a document to fail.
std::string describeOr(const std::function<std::string()>& describe) {
  try {
    return describe();
  } catch (const core::Error& error) {
    return std::string("not available: ") + error.what();
  }
}

}  // namespace

std::string serialise(const Json& document) {
  return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void writeDocument(const std::string& file, const Json& document) {
  if (file.empty()) return;
  if (file == "-")
    printData(serialise(document));
  else
    core::writeFileAtomically(file, serialise(document));
}

Json makeErrorDocument(const core::Error& error) {
  return {{"schema", 1},
          {"error",
           {{"code", error.code()},
            {"message", error.message()},
            {"pointer", error.pointer()},
            {"hint", error.hint()}}}};
}

void addGl(renderer::Renderer& renderer, Json& environment) {
  environment["gl_renderer"] = describeOr([&] { return renderer.describeGl(); });
  environment["backend_auto"] =
      describeOr([&] { return std::string(renderer::backendName(renderer.chooseBackend())); });
}

Json makeDocument(const std::string& command, renderer::Renderer* renderer) {
  Json environment{{"version", kVersion},   {"commit", kCommit},          {"build", kBuildType},
                   {"compiler", kCompiler}, {"system", describeSystem()}, {"threads", core::threadCount()}};
  if (renderer != nullptr) {
    addGl(*renderer, environment);
    environment["embree"] = describeOr([&] { return renderer->describeRayTracer(); });
  }
  return {{"schema", 1}, {"command", command}, {"environment", environment}};
}

Json makeJson(const dvec3& vector) {
  return {vector.x, vector.y, vector.z};
}

Json makeJson(const scene::Camera& camera) {
  return {{"name", camera.name},
          {"eye", makeJson(camera.eye)},
          {"target", makeJson(camera.target)},
          {"up", makeJson(camera.up)},
          {"fov_degrees", glm::degrees(camera.fovYRadians)}};
}

Json makeSceneJson(const LoadedScene& loaded) {
  return {{"name", loaded.name},
          {"source", loaded.source},
          {"built_in", loaded.isBuiltIn},
          {"triangles", loaded.geometry.triangleCount()},
          {"reflectors", loaded.geometry.reflectors.size()},
          {"warnings", loaded.scene.warnings}};
}

std::string makeVersionText() {
  const scene::Scene nothing;
  const scene::WorldGeometry noGeometry;
  const scene::Environment black = scene::makeConstantEnvironment(vec3(0));
  renderer::Renderer renderer(nothing, noGeometry, black);
  return fmt::format("catoptric {} (commit {}, {}, {})\nOpenGL: {}\nray tracing: {}\n", kVersion, kCommit,
                     kBuildType, kCompiler, describeOr([&] { return renderer.describeGl(); }),
                     describeOr([&] { return renderer.describeRayTracer(); }));
}

}  // namespace catoptric::app
