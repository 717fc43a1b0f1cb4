// SPDX-License-Identifier: Apache-2.0
#include "shared_options.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "catoptric/core/parallel.h"
#include "option_values.h"
#include "suggest.h"
#include "terminal.h"

namespace catoptric::app {
namespace {

constexpr int kMostBounces = 16, kMostSamples = 1024, kMostThreads = 1024;

const std::vector<renderer::Method> kMethods{renderer::Method::Auto,        renderer::Method::None,
                                             renderer::Method::Environment, renderer::Method::Virtual,
                                             renderer::Method::Morphing,    renderer::Method::Zexel,
                                             renderer::Method::RayTrace};
const std::vector<renderer::Solver> kSolvers{renderer::Solver::Auto,     renderer::Solver::Explosion,
                                             renderer::Solver::Layered,  renderer::Solver::Refined,
                                             renderer::Solver::Analytic, renderer::Solver::Subdivision,
                                             renderer::Solver::Exact};

const std::vector<renderer::Backend> kBackends{renderer::Backend::Auto, renderer::Backend::Cpu,
                                               renderer::Backend::Gpu};

const std::vector<renderer::Merge> kMerges{renderer::Merge::Ids,   renderer::Merge::Stencil,
                                           renderer::Merge::Erase, renderer::Merge::Depth,
                                           renderer::Merge::Clip,  renderer::Merge::Texture};

/// The value whose name was typed.
template <class Value>
Value choose(const std::string& option, const std::string& text, const std::vector<Value>& values,
             std::string_view (*nameOf)(Value)) {
  std::vector<std::string> names;
  std::string all;
  for (const Value value : values) {
    names.emplace_back(nameOf(value));
    all.append(all.empty() ? "there are " : ", ").append(names.back());
    if (names.back() == text) return value;
  }
  throw UsageError(fmt::format("{}: there is no '{}'", option, text), makeSuggestion(text, names, all));
}

Setter setVector(const std::string& option, std::optional<dvec3>& target) {
  return [option, &target](const std::string& text) { target = parseVector(option, text); };
}

Setter setDegrees(const std::string& option, std::optional<double>& target, double least, double most) {
  return [=, &target](const std::string& text) { target = parseNumber(option, text, least, most); };
}

}  // namespace

renderer::Merge parseMerge(const std::string& option, const std::string& text) {
  return choose(option, text, kMerges, renderer::mergeName);
}

void declareOutput(Arguments& arguments, OutputOptions& options) {
  arguments.group("Output");
  arguments.option("--json", "FILE", "Also write a JSON document; '-' writes it to standard output",
                   setText(options.json));
  arguments.flag("-q,--quiet", "Print errors only", options.quiet);
  arguments.flag("-v,--verbose", "Print details", options.verbose);
  arguments.option("--threads", "N", "Threads to use; default: all",
                   setInteger("--threads", options.threads, 1, kMostThreads));
}

void declareScene(Arguments& arguments, SceneOptions& options) {
  arguments.group("Scene");
  arguments.option("--scene", "NAME|INDEX", "Which scene of the file; default: its default scene",
                   [&](const std::string& text) { options.import.sceneName = text; });
  arguments.repeatable("--reflector", "NAME", "Only this reflector, object or material is a mirror",
                       [&](const std::string& text) { options.reflectors.only.push_back(text); });
  arguments.option("--reflector-metallic", "X", "Least metallic factor of a mirror; default 0.9",
                   [&](const std::string& text) {
                     options.reflectors.minMetallic = float(parseNumber("--reflector-metallic", text, 0, 1));
                   });
  arguments.option("--reflector-roughness", "X", "Largest roughness of a mirror; default 0.05",
                   [&](const std::string& text) {
                     options.reflectors.maxRoughness =
                         float(parseNumber("--reflector-roughness", text, 0, 1));
                   });
  arguments.repeatable("--morphed", "NAME", "Reflection morphing always draws this reflector itself",
                       [&](const std::string& text) { options.reflectors.morphed.push_back(text); });
  arguments.repeatable("--mapped", "NAME", "... draws it by an environment map and does not bake it",
                       [&](const std::string& text) { options.reflectors.mapped.push_back(text); });
  arguments.flag("--no-reflectors", "Nothing is a mirror", options.noReflectors);
  arguments.option(
      "--max-memory", "BYTES", "Refuse scenes that need more, as in 512M; default 4G",
      [&](const std::string& text) { options.import.maxMemoryBytes = parseByteCount("--max-memory", text); });
  arguments.option(
      "--max-pixels", "N", "Refuse textures with more pixels, as in 16M; default 64M",
      [&](const std::string& text) { options.import.maxPixels = parseByteCount("--max-pixels", text); });
}

void declareMotion(Arguments& arguments, SceneOptions& options) {
  arguments.group("Animation");
  arguments.option("--time", "S", "Show the scene at this time, seconds; default: its rest pose",
                   [&](const std::string& text) { options.timeS = parseNumber("--time", text, 0, 1e6); });
  arguments.option("--animation", "NAME|INDEX", "Which one plays; default: all that go together",
                   setText(options.animation));
}

void declareCamera(Arguments& arguments, CameraOptions& options) {
  arguments.group("Camera (default: the first of the scene, or one that sees all of it)");
  arguments.option("--camera", "NAME|INDEX", "A camera of the scene",
                   [&](const std::string& text) { options.camera = text; });
  arguments.option("--eye", "X,Y,Z", "Where the eye is, metres", setVector("--eye", options.eye));
  arguments.option("--target", "X,Y,Z", "Where it looks; default: the middle of the scene",
                   setVector("--target", options.target));
  arguments.option("--up", "X,Y,Z", "Which way is up; default 0,1,0", setVector("--up", options.up));
  arguments.option("--fov", "DEG", "Field of view from top to bottom",
                   setDegrees("--fov", options.fovDegrees, 0.1, 170));
  arguments.option("--azimuth", "DEG", "See all from this side; 0 = from +z, 90 = from +x",
                   setDegrees("--azimuth", options.azimuthDegrees, -360, 360));
  arguments.option("--elevation", "DEG", "See all from this height; 90 = from above",
                   setDegrees("--elevation", options.elevationDegrees, -90, 90));
}

void declareFrame(Arguments& arguments, renderer::FrameOptions& frame) {
  arguments.option("--size", "WxH", "Pixels; default 960x720", [&](const std::string& text) {
    const ivec2 size = parseSize("--size", text);
    frame.widthPx = size.x;
    frame.heightPx = size.y;
  });
  arguments.option("--bounces", "N",
                   "Mirrors in mirrors, to this depth; default 1. Light goes through up to 6 surfaces of "
                   "glass besides",
                   setInteger("--bounces", frame.bounces, 0, kMostBounces));
  arguments.option(
      "--max-error", "PX",
      "How far things may be off: for the tessellation of reflected objects, and for what auto picks; "
      "default 0.5",
      [&](const std::string& text) { frame.maxErrorPx = parseNumber("--max-error", text, 0.01, 1e6); });
}

void declarePicture(Arguments& arguments, PictureOptions& options) {
  renderer::FrameOptions& frame = options.frame;
  arguments.group("Picture");
  declareFrame(arguments, frame);
  arguments.option("--samples", "N", "Samples a pixel; default 1",
                   setInteger("--samples", frame.samples, 1, kMostSamples));
  arguments.option("--environment", "FILE", "Surroundings, .hdr or .exr; default: a built-in sky",
                   setText(options.environment));
  arguments.option(
      "--exposure", "X", "Factor on radiance in PNG and JPEG; default 1",
      [&](const std::string& text) { options.exposure = float(parseNumber("--exposure", text, 1e-6, 1e6)); });
}

void declareMerge(Arguments& arguments, renderer::FrameOptions& frame) {
  arguments.group("Merging");
  arguments.option(
      "--merge", "NAME",
      "How what mirrors show is kept within them: ids (default), stencil, erase, depth, clip, texture",
      [&](const std::string& text) { frame.merge = parseMerge("--merge", text); });
  arguments.option(
      "--texture-scale", "X", "Of --merge texture: its resolution, against the picture's; default 1",
      [&](const std::string& text) { frame.textureScale = parseNumber("--texture-scale", text, 0.01, 1); });
}

void declareBackend(Arguments& arguments, renderer::FrameOptions& options) {
  arguments.option(
      "--backend", "NAME",
      "Where the solvers explosion, layered and refined find virtual vertices: auto (default; gpu unless "
      "OpenGL runs in software), cpu, gpu",
      [&](const std::string& text) {
        options.backend = choose("--backend", text, kBackends, renderer::backendName);
      });
  arguments.option(
      "--parts", "NAME",
      "Of solver refined, which parts of mirrors that are not convex get virtual objects: those where they "
      "are "
      "expected to be right and faster than solver exact (cheapest, the default), or right (all)",
      [&](const std::string& text) {
        if (text != "all" && text != "cheapest")
          throw UsageError(fmt::format("--parts: there is no '{}'", text), "use cheapest or all");
        options.allParts = text == "all";
      });
}

void declareBaked(Arguments& arguments, renderer::FrameOptions& options) {
  arguments.option("--baked", "FILE",
                   "Of the morphing method: file of 'catoptric bake'; default: bake at the eye",
                   setText(options.bakedFile));
  arguments.option("--mapped-below", "PIXELS",
                   "Of the morphing method: mirrors that cover fewer get environment maps; default 1024",
                   setInteger("--mapped-below", options.mappedBelowPixels, 0, 1 << 30));
}

void declareMethod(Arguments& arguments, renderer::FrameOptions& options, bool& plainMap) {
  arguments.group("Method");
  arguments.option("--method", "NAME",
                   "auto (default), none, environment, virtual, morphing, zexel, raytrace",
                   [&](const std::string& text) {
                     options.method = choose("--method", text, kMethods, renderer::methodName);
                   });
  arguments.option(
      "--solver", "NAME",
      "Of the virtual method: auto (default), explosion, layered, refined, exact, analytic, subdivision",
      [&](const std::string& text) {
        options.solver = choose("--solver", text, kSolvers, renderer::solverName);
      });
  declareBackend(arguments, options);
  declareBaked(arguments, options);
  arguments.flag("--plain-environment-map", "No parallax correction by the box of the room", plainMap);
}

void checkMerge(const renderer::FrameOptions& options, bool usesTexture) {
  if (options.textureScale != 1 && !usesTexture)
    throw UsageError("--texture-scale: there is no texture", "add --merge texture");
}

void checkMethod(const renderer::FrameOptions& options) {
  if (options.merge != renderer::Merge::Ids && !renderer::hasMerges(options.method))
    throw UsageError(
        fmt::format("--merge: the method '{}' has no use for it", renderer::methodName(options.method)),
        "leave it out, or add --method virtual");
  checkMerge(options, options.merge == renderer::Merge::Texture);
  if (options.solver != renderer::Solver::Auto && !renderer::hasSolvers(options.method))
    throw UsageError(fmt::format("--solver: the method '{}' has none", renderer::methodName(options.method)),
                     "leave it out, or add --method virtual");
  if (options.backend != renderer::Backend::Auto && !renderer::hasSolvers(options.method))
    throw UsageError(fmt::format("--backend: the method '{}' has no virtual vertices",
                                 renderer::methodName(options.method)),
                     "leave it out, or add --method virtual");
  if (options.backend != renderer::Backend::Auto && !renderer::hasVertexShader(options.solver))
    throw UsageError(
        fmt::format("--backend: the solver '{}' has no vertex shader", renderer::solverName(options.solver)),
        "leave it out, or add --solver explosion, layered or refined");
  if (!options.bakedFile.empty() && options.method != renderer::Method::Morphing)
    throw UsageError(
        fmt::format("--baked: the method '{}' has no use for it", renderer::methodName(options.method)),
        "add --method morphing");
  if (!options.zexel.cacheFile.empty() && options.method != renderer::Method::Zexel)
    throw UsageError(
        fmt::format("--zexel-cache: the method '{}' has no use for it", renderer::methodName(options.method)),
        "add --method zexel");
}

void applyOutput(const OutputOptions& options) {
  if (options.quiet && options.verbose) throw UsageError("--quiet and --verbose exclude each other");
  setVerbosity(options.quiet ? Verbosity::Quiet : options.verbose ? Verbosity::Verbose : Verbosity::Normal);
  if (options.threads > 0) core::setThreadCount(options.threads);
}

}  // namespace catoptric::app
