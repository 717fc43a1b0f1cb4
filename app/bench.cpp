// SPDX-License-Identifier: Apache-2.0
// catoptric bench SCENE: how long each method takes, timed in turn in one run.
#include <fmt/format.h>

#include <memory>

#include "catoptric/core/progress.h"
#include "commands.h"
#include "documents.h"
#include "method_variant.h"
#include "option_values.h"
#include "shared_options.h"
#include "terminal.h"
#include "zexel_options.h"

namespace catoptric::app {
namespace {

constexpr int kMostRepeats = 10000;

struct Options {
  std::string source;
  std::vector<MethodVariant> variants = defaultVariants();
  int repeats = 10;
  SceneOptions scene;
  CameraOptions camera;
  PictureOptions picture;
  OutputOptions output;
};

/// null where there is none.
Json rate(double perSecond) {
  return perSecond > 0 ? Json(perSecond) : Json(nullptr);
}

/// null where there is nothing to have a share of.
Json share(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? Json(double(part) / double(whole)) : Json(nullptr);
}

Json makeRow(const MethodVariant& variant, const renderer::FrameOptions& frame, const FrameTimes& times) {
  return {{"name", variant.name},
          {"method", std::string(renderer::methodName(variant.method))},
          {"solver", std::string(renderer::solverName(variant.solver))},
          {"backend", renderer::backendName(withMethod(frame, variant).backend)},
          {"box_corrected", variant.boxCorrected},
          {"width", frame.widthPx},
          {"height", frame.heightPx},
          {"bounces", frame.bounces},
          {"merge", renderer::mergeName(variant.merge.value_or(frame.merge))},
          {"samples", frame.samples},
          {"frames", times.frames},
          {"median_ms", times.medianMs},
          {"p95_ms", times.p95Ms},
          {"primary_ms", times.primaryMs},
          {"reflection_ms", times.reflectionMs},
          {"virtual_vertices", times.counters.virtualVertices},
          {"culled_vertices", times.counters.culledVertices},
          {"culled_triangles", times.counters.culledTriangles},
          {"simplified_triangles", times.counters.simplifiedTriangles},
          {"virtual_triangles", times.counters.virtualTriangles},
          {"fragment_tests", times.counters.fragmentTests},
          {"virtual_pixels", times.counters.virtualPixels},
          {"bounded_pixels", times.counters.boundedPixels},
          {"virtual_vertices_per_s", rate(times.virtualVerticesPerS)},
          {"morphed_traces", times.counters.morphedTraces},
          {"dynamic_vertices_per_s", rate(times.dynamicVerticesPerS)},
          {"static_vertices_per_s", rate(times.staticVerticesPerS)},
          {"zexels", times.counters.zexels},
          {"zexels_per_s", rate(times.zexelsPerS)},
          {"warp_ms", times.warpMs},
          {"uncovered_share", share(times.counters.uncoveredPixels, times.counters.zexelPixels)},
          {"rays", times.counters.rays},
          {"rays_per_s", rate(times.raysPerS)}};
}

std::string millions(double perSecond) {
  return perSecond > 0 ? fmt::format("{:.2f}", perSecond / 1e6) : "-";
}

std::string makeTable(const std::vector<MethodVariant>& variants, const std::vector<FrameTimes>& times) {
  std::vector<std::vector<std::string>> rows{{"method", "median ms", "p95 ms", "primary ms", "reflection ms",
                                              "virtual vertices", "Mvertices/s", "Mzexels/s", "Mrays/s"}};
  for (std::size_t i = 0; i < variants.size(); ++i)
    rows.push_back({variants[i].name, fmt::format("{:.1f}", times[i].medianMs),
                    fmt::format("{:.1f}", times[i].p95Ms), fmt::format("{:.1f}", times[i].primaryMs),
                    fmt::format("{:.1f}", times[i].reflectionMs),
                    std::to_string(times[i].counters.virtualVertices), millions(times[i].virtualVerticesPerS),
                    millions(times[i].zexelsPerS), millions(times[i].raysPerS)});
  return formatTable(rows, usesColour(stdout));
}

int run(const Options& options) {
  applyOutput(options.output);
  checkVariants(options.picture.frame, options.variants);
  const auto loaded = loadScene(options.source, options.scene);
  const scene::Camera camera = chooseCamera(*loaded, options.camera);
  loadEnvironment(*loaded, options.picture.environment);
  renderer::Renderer renderer(loaded->scene, loaded->geometry, loaded->environment);
  const renderer::FrameOptions& frame = options.picture.frame;

  std::vector<FrameTimes> times;
  {
    core::Progress progress("timing", options.variants.size() * std::size_t(options.repeats + 1));
    progress.describe("warm-up");
    static_cast<void>(timeInTurn(renderer, camera, frame, options.variants, 1, progress));
    progress.describe(fmt::format("{} frames each", options.repeats));
    times = timeInTurn(renderer, camera, frame, options.variants, options.repeats, progress);
  }

  renderer.saveReferenceImages();
  Json document = makeDocument("bench", &renderer);
  if (options.output.json != "-") {
    printData(fmt::format("{}, {}x{}, {} bounces, {} samples, {} frames each, in turn\n{}\n{}\n\n",
                          loaded->name, frame.widthPx, frame.heightPx, frame.bounces, frame.samples,
                          options.repeats, document["environment"]["gl_renderer"].get<std::string>(),
                          document["environment"]["embree"].get<std::string>()));
    printData(makeTable(options.variants, times));
  }
  document["scene"] = makeSceneJson(*loaded);
  document["camera"] = makeJson(camera);
  document["results"] = Json::array();
  for (std::size_t i = 0; i < options.variants.size(); ++i)
    document["results"].push_back(makeRow(options.variants[i], frame, times[i]));
  writeDocument(options.output.json, document);
  return 0;
}

}  // namespace

Command makeBenchCommand() {
  const auto options = std::make_shared<Options>();
  return {
      .name = "bench",
      .summary = "Time the methods, in turn, in one run",
      .examples =
          "  catoptric bench four-spheres\n"
          "  catoptric bench scene.glb --methods virtual-refined,raytrace --repeat 30 --json bench.json\n",
      .declare =
          [options](Arguments& arguments) {
            arguments.positional("SCENE", "A .gltf or .glb file, '-', or a built-in scene",
                                 Arguments::Count::ExactlyOne, setText(options->source));
            arguments.group("Timing");
            arguments.option(
                "--methods", "A,B,C", "Which ones: " + listMethodNames() + "; default: all but morphing",
                [options](const std::string& text) { options->variants = parseMethodList(text); });
            arguments.option("--repeat", "N", "Frames of each method; default 10",
                             setInteger("--repeat", options->repeats, 1, kMostRepeats));
            declareBaked(arguments, options->picture.frame);
            declarePicture(arguments, options->picture);
            declareBackend(arguments, options->picture.frame);
            declareMerge(arguments, options->picture.frame);
            declareZexels(arguments, options->picture.frame.zexel);
            declareCamera(arguments, options->camera);
            declareScene(arguments, options->scene);
            declareMotion(arguments, options->scene);
            declareOutput(arguments, options->output);
          },
      .run = [options](const std::vector<std::string>&) { return run(*options); }};
}

}  // namespace catoptric::app
