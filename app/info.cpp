// SPDX-License-Identifier: Apache-2.0
// catoptric info SCENE: what is in it, which surfaces are mirrors and why, and how auto would draw each.
#include <fmt/format.h>

#include <memory>
#include <span>
#include <vector>

#include "catoptric/renderer/choose_method.h"
#include "catoptric/renderer/expected_error.h"
#include "catoptric/scene/hierarchy_triangles.h"
#include "commands.h"
#include "documents.h"
#include "option_values.h"
#include "shared_options.h"
#include "terminal.h"

namespace catoptric::app {
namespace {

struct Options {
  std::string source;
  SceneOptions scene;
  CameraOptions camera;
  renderer::FrameOptions frame;
  OutputOptions output;
};

std::string wayText(renderer::Method method, renderer::Solver solver) {
  const std::string text(renderer::methodName(method));
  const bool isCurved = method == renderer::Method::Virtual && solver != renderer::Solver::Auto;
  return isCurved ? text + "/" + std::string(renderer::solverName(solver)) : text;
}

std::string methodText(const renderer::MethodChoice& choice) {
  return wayText(choice.method, choice.solver);
}

/// What auto picks for each mirror in the view.
std::vector<renderer::MethodChoice> chooseMethods(const LoadedScene& loaded, const scene::Camera& camera,
                                                  const renderer::FrameOptions& frame) {
  const geometry::TriangleHierarchy triangles(scene::listTriangles(loaded.geometry));
  renderer::MethodChooser chooser(loaded.geometry, triangles);
  const scene::CameraFrame view = scene::makeCameraFrame(camera, frame.widthPx, frame.heightPx);
  const raster::LevelsOfDetail levels(loaded.scene, loaded.geometry);  // as drawing would use them
  std::vector<renderer::MethodChoice> choices;
  for (std::uint32_t i = 0; i < loaded.geometry.reflectors.size(); ++i)
    choices.push_back(chooser.choose(
        i, view, {.maxErrorPx = frame.maxErrorPx, .bounces = frame.bounces, .levels = &levels}));
  return choices;
}

Json describeForecast(const renderer::MethodChoice& choice) {
  if (!choice.forecast) return {};
  const renderer::ViewForecast& f = *choice.forecast;
  return {{"parts", f.parts},
          {"pixels", f.pixels},
          {"offered", f.offered},
          {"triangles", f.triangles},
          {"one_to_one_share", f.oneToOne},
          {"near_focus_share", f.nearFocus},
          {"self_share", f.self}};
}

Json describeCandidates(const renderer::MethodChoice& choice) {
  Json rows = Json::array();
  for (const renderer::MethodCandidate& c : choice.candidates)
    rows.push_back({{"method", renderer::methodName(c.method)},
                    {"solver", renderer::solverName(c.solver)},
                    {"expected_error_px", c.errorPx},
                    {"expected_ms", c.ms}});
  return rows;
}

Json describeReflector(const LoadedScene& loaded, const scene::Reflector& reflector,
                       const renderer::MethodChoice& choice) {
  const bool hasMaterial =
      reflector.material >= 0 && std::size_t(reflector.material) < loaded.scene.materials.size();
  return {{"name", reflector.name},
          {"shape", std::string(scene::shapeName(reflector.shape))},
          {"fit_error", reflector.fitError},
          {"convex", reflector.isConvex},
          {"double_sided", reflector.doubleSided},
          {"ior", reflector.isRefractor() ? Json(reflector.ior) : Json()},
          {"triangles", loaded.geometry.parts.at(reflector.part).indexCount / 3},
          {"centre", makeJson(reflector.centre)},
          {"radius", reflector.radius},
          {"area", reflector.areaWorld},
          {"material", hasMaterial ? loaded.scene.materials[std::size_t(reflector.material)].name : ""},
          {"reason", reflector.reason},
          {"morphed", reflector.morphed ? Json(*reflector.morphed) : Json()},
          {"morphed_reason", reflector.morphedReason},
          {"analytic", {{"supported", choice.analytic.empty()}, {"reason", choice.analytic}}},
          {"auto",
           {{"method", std::string(renderer::methodName(choice.method))},
            {"solver", std::string(renderer::solverName(choice.solver))},
            {"reason", choice.reason},
            {"view", describeForecast(choice)},
            {"candidates", describeCandidates(choice)}}}};
}

Json describeScene(const LoadedScene& loaded, std::span<const renderer::MethodChoice> choices) {
  const scene::Scene& scene = loaded.scene;
  const scene::WorldGeometry& geometry = loaded.geometry;
  Json json{{"name", loaded.name},
            {"source", loaded.source},
            {"built_in", loaded.isBuiltIn},
            {"scene", scene.name},
            {"objects", scene.instances.size()},
            {"meshes", scene.meshes.size()},
            {"materials", scene.materials.size()},
            {"textures", scene.textures.size()},
            {"lights", scene.lights.size()},
            {"triangles", geometry.triangleCount()},
            {"vertices", geometry.positions.size()},
            {"dropped_triangles", geometry.droppedTriangles}};
  if (!geometry.bounds.isEmpty())
    json["bounds"] = {{"lower", makeJson(geometry.bounds.lower)}, {"upper", makeJson(geometry.bounds.upper)}};
  json["cameras"] = Json::array();
  for (const scene::Camera& camera : scene.cameras) json["cameras"].push_back(makeJson(camera));
  json["animations"] = Json::array();
  for (const scene::Animation& animation : scene.motion.animations)
    json["animations"].push_back({{"name", animation.name}, {"duration_s", animation.durationS}});
  json["reflectors"] = Json::array();
  for (std::size_t i = 0; i < geometry.reflectors.size(); ++i)
    json["reflectors"].push_back(describeReflector(loaded, geometry.reflectors[i], choices[i]));
  json["warnings"] = scene.warnings;
  return json;
}

std::string makeSummary(const LoadedScene& loaded) {
  const scene::Scene& scene = loaded.scene;
  const scene::WorldGeometry& geometry = loaded.geometry;
  std::string text =
      fmt::format("{}{}\n", loaded.source,
                  scene.name.empty() ? "" : "  scene \"" + withoutControlCharacters(scene.name) + "\"");
  text += fmt::format("  {} objects, {} meshes, {} triangles, {} vertices{}\n", scene.instances.size(),
                      scene.meshes.size(), geometry.triangleCount(), geometry.positions.size(),
                      geometry.droppedTriangles == 0
                          ? ""
                          : fmt::format(" ({} degenerate triangles dropped)", geometry.droppedTriangles));
  text += fmt::format("  {} materials, {} textures, {} lights\n", scene.materials.size(),
                      scene.textures.size(), scene.lights.size());
  if (!geometry.bounds.isEmpty()) {
    const dvec3 low = geometry.bounds.lower, high = geometry.bounds.upper;
    text += fmt::format("  from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m\n", low.x, low.y,
                        low.z, high.x, high.y, high.z);
  }
  for (std::size_t i = 0; i < scene.cameras.size(); ++i)
    text += fmt::format("  camera {} \"{}\", {:.1f} degrees\n", i,
                        withoutControlCharacters(scene.cameras[i].name),
                        glm::degrees(scene.cameras[i].fovYRadians));
  for (std::size_t i = 0; i < scene.motion.animations.size(); ++i)
    text += fmt::format("  animation {} \"{}\", {:.4g} s\n", i,
                        withoutControlCharacters(scene.motion.animations[i].name),
                        scene.motion.animations[i].durationS);
  return text;
}

/// How reflection morphing draws a curved mirror, and why.
std::string describeMorphing(const scene::Reflector& reflector) {
  if (reflector.isRefractor() && !reflector.morphed.value_or(false))
    return "by solver exact, unless --morphed or extras.catoptric.morphed says otherwise";
  if (!reflector.morphed)
    return fmt::format(
        "itself where it covers {} pixels or more (--mapped-below), else by an environment map",
        renderer::FrameOptions{}.mappedBelowPixels);
  return fmt::format("{}, by {}", *reflector.morphed ? "itself" : "by an environment map",
                     reflector.morphedReason);
}

std::string makeReflectorTable(const LoadedScene& loaded, std::span<const renderer::MethodChoice> choices) {
  const auto& reflectors = loaded.geometry.reflectors;
  if (reflectors.empty())
    return "\nno reflectors: no material is a mirror (metallic >= 0.9 and roughness <= 0.05, clearcoat, or "
           "extras.catoptric)\n";
  std::vector<std::vector<std::string>> rows{
      {"reflector", "shape", "fit error", "convex", "radius m", "area m2", "triangles", "auto picks"}};
  std::string reasons;
  for (std::size_t i = 0; i < reflectors.size(); ++i) {
    const scene::Reflector& reflector = reflectors[i];
    const renderer::MethodChoice& choice = choices[i];
    rows.push_back({reflector.name, std::string(scene::shapeName(reflector.shape)),
                    fmt::format("{:.2g}", reflector.fitError), reflector.isConvex ? "yes" : "no",
                    fmt::format("{:.4g}", reflector.radius), fmt::format("{:.4g}", reflector.areaWorld),
                    std::to_string(loaded.geometry.parts.at(reflector.part).indexCount / 3),
                    methodText(choice)});
    reasons += fmt::format("{}: a {} by {}; {} because {}\n", withoutControlCharacters(reflector.name),
                           reflector.isRefractor() ? "refractor" : "mirror", reflector.reason,
                           methodText(choice), choice.reason);
    if (reflector.isRefractor())
      reasons += fmt::format("  method morphing: drawn {}\n", describeMorphing(reflector));
    if (reflector.shape == scene::ReflectorShape::Plane || reflector.isRefractor()) continue;
    reasons += choice.analytic.empty()
                   ? fmt::format("  solver analytic: the {} that its vertices leave by at most {:.2g} m\n",
                                 scene::shapeName(reflector.shape), reflector.fitError)
                   : fmt::format("  solver analytic: not possible, {}; refined is used\n", choice.analytic);
    reasons += fmt::format("  method morphing: drawn {}\n", describeMorphing(reflector));
  }
  return "\n" + formatTable(rows, usesColour(stdout)) + "\n" + reasons;
}

std::string describeError(const renderer::MethodCandidate& candidate) {
  return candidate.errorPx >= renderer::kLostPx ? fmt::format("{:.0f} or more", renderer::kLostPx)
                                                : fmt::format("{:.3f}", candidate.errorPx);
}

/// The ways of drawing each curved mirror, with what is expected of them.
std::string makeWaysTable(const LoadedScene& loaded, std::span<const renderer::MethodChoice> choices,
                          const renderer::FrameOptions& frame) {
  std::vector<std::vector<std::string>> rows{
      {"reflector", "pixels", "way", "expected error px", "expected ms", "picked"}};
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const renderer::MethodChoice& choice = choices[i];
    for (const renderer::MethodCandidate& c : choice.candidates) {
      const bool isPicked = c.method == choice.method && c.solver == choice.solver;
      rows.push_back({loaded.geometry.reflectors[i].name, fmt::format("{:.0f}", choice.forecast->pixels),
                      wayText(c.method, c.solver), describeError(c), fmt::format("{:.1f}", c.ms),
                      isPicked ? "yes" : ""});
    }
  }
  if (rows.size() == 1) return "";
  return fmt::format(
             "\nways of drawing them, {}x{}, {} bounce{}, --max-error {:.3g}: error of 95 % of the pixels; "
             "ms "
             "of a frame where nothing moves, with OpenGL in software\n",
             frame.widthPx, frame.heightPx, frame.bounces, frame.bounces == 1 ? "" : "s", frame.maxErrorPx) +
         formatTable(rows, usesColour(stdout)) + "\n";
}

std::string describeBackend(renderer::Renderer& renderer) {
  Json gl;
  addGl(renderer, gl);
  return fmt::format("  virtual vertices: --backend auto is {} on {}\n",
                     gl["backend_auto"].get<std::string>(), gl["gl_renderer"].get<std::string>());
}

int run(const Options& options) {
  applyOutput(options.output);
  if (isBakedFile(options.source)) {
    describeBakedFile(options.source, options.output.json);
    return 0;
  }
  const auto loaded = loadScene(options.source, options.scene);
  renderer::Renderer renderer(loaded->scene, loaded->geometry, loaded->environment);
  const scene::Camera camera = chooseCamera(*loaded, options.camera);
  const std::vector<renderer::MethodChoice> choices = chooseMethods(*loaded, camera, options.frame);
  if (!options.output.json.empty()) {
    Json document = makeDocument("info", nullptr);
    addGl(renderer, document["environment"]);
    document.update(describeScene(*loaded, choices));
    writeDocument(options.output.json, document);
  }
  if (options.output.json != "-")
    printData(makeSummary(*loaded) + describeBackend(renderer) + makeReflectorTable(*loaded, choices) +
              makeWaysTable(*loaded, choices, options.frame));
  return 0;
}

}  // namespace

Command makeInfoCommand() {
  const auto options = std::make_shared<Options>();
  return {.name = "info",
          .summary = "Say what is in a scene: its mirrors, their shape, how each would be drawn and why",
          .examples =
              "  catoptric info scene.glb\n"
              "  catoptric info drivers-view --json -\n"
              "  catoptric info scene.glb --reflector-roughness 0.1\n",
          .declare =
              [options](Arguments& arguments) {
                arguments.positional("SCENE",
                                     "A .gltf or .glb file, '-', a built-in scene, or a file of bake",
                                     Arguments::Count::ExactlyOne, setText(options->source));
                arguments.group("View that auto is asked for");
                declareFrame(arguments, options->frame);
                declareCamera(arguments, options->camera);
                declareScene(arguments, options->scene);
                declareOutput(arguments, options->output);
              },
          .run = [options](const std::vector<std::string>&) { return run(*options); }};
}

}  // namespace catoptric::app
