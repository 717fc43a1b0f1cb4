// SPDX-License-Identifier: Apache-2.0
// catoptric render SCENE -o FILE: one picture by one method.
#include <fmt/format.h>

#include <memory>

#include "catoptric/core/file.h"
#include "commands.h"
#include "documents.h"
#include "frame_sequence.h"
#include "option_values.h"
#include "pictures.h"
#include "shared_options.h"
#include "terminal.h"
#include "zexel_options.h"

namespace catoptric::app {
namespace {

struct Options {
  std::string source, picture, aov;
  bool plainMap = false;
  SequenceOptions sequence;
  SceneOptions scene;
  CameraOptions camera;
  PictureOptions frame;
  OutputOptions output;
};

/// What the result of the command line is, before any work is done on it.
PictureFormat checkOutputs(const Options& options) {
  if (options.picture.empty() && options.aov.empty())
    throw UsageError("where to write to is missing", "add -o picture.png");
  if (!options.aov.empty() &&
      (options.aov == "-" || findPictureFormat("--aov", options.aov) != PictureFormat::Exr))
    throw UsageError("--aov: '" + options.aov + "' is no .exr file");
  if (options.picture == "-" && options.output.json == "-")
    throw UsageError("the picture and --json cannot both go to standard output");
  return options.picture.empty() ? PictureFormat::Png : findPictureFormat("-o", options.picture);
}

Json makeFrameJson(const renderer::FrameOptions& options, const renderer::Frame& frame) {
  const renderer::FrameTimings& times = frame.timings;
  const renderer::FrameCounters& counters = frame.counters;
  return {{"method", std::string(renderer::methodName(options.method))},
          {"solver", std::string(renderer::solverName(options.solver))},
          {"backend", renderer::backendName(options.backend)},
          {"box_corrected", options.boxCorrected},
          {"width", options.widthPx},
          {"height", options.heightPx},
          {"bounces", options.bounces},
          {"merge", renderer::mergeName(options.merge)},
          {"samples", options.samples},
          {"timings",
           {{"total_ms", times.totalMs},
            {"primary_ms", times.primaryMs},
            {"reflection_ms", times.reflectionMs},
            {"virtual_vertices_ms", times.virtualVerticesMs},
            {"cover_ms", times.coverMs},
            {"warp_ms", times.warpMs},
            {"capture_ms", times.captureMs}}},
          {"counters",
           {{"virtual_vertices", counters.virtualVertices},
            {"culled_vertices", counters.culledVertices},
            {"culled_triangles", counters.culledTriangles},
            {"simplified_triangles", counters.simplifiedTriangles},
            {"virtual_triangles", counters.virtualTriangles},
            {"looked_up_vertices", counters.lookedUpVertices},
            {"fragment_tests", counters.fragmentTests},
            {"virtual_pixels", counters.virtualPixels},
            {"bounded_pixels", counters.boundedPixels},
            {"reflectors_drawn", counters.reflectorsDrawn},
            {"reflectors_culled", counters.reflectorsCulled},
            {"zexels", counters.zexels},
            {"zexel_pixels", counters.zexelPixels},
            {"uncovered_pixels", counters.uncoveredPixels},
            {"zexel_captures", counters.zexelCaptures},
            {"rays", counters.rays}}}};
}

/// Draws and writes one picture; the files' names are those of the frame.
renderer::Frame renderFrame(renderer::Renderer& renderer, const scene::Camera& camera, const Options& options,
                            PictureFormat format) {
  const renderer::FrameOptions& frameOptions = options.frame.frame;
  renderer::Frame frame = renderer.render(camera, frameOptions);
  if (!options.picture.empty()) {
    writePicture(options.picture, format, frame.radiance, options.frame.exposure);
    say(fmt::format("wrote {} ({}x{}, {}, {:.0f} ms)",
                    options.picture == "-" ? "standard output" : options.picture, frameOptions.widthPx,
                    frameOptions.heightPx, renderer::methodName(frameOptions.method), frame.timings.totalMs));
  }
  if (!options.aov.empty()) {
    core::writeFileAtomically(options.aov, std::span<const std::byte>(encodeAov(frame)));
    say("wrote " + options.aov);
  }
  return frame;
}

Json makeFilesJson(const Options& options) {
  Json files = Json::object();
  if (!options.picture.empty()) files["picture"] = options.picture;
  if (!options.aov.empty()) files["aov"] = options.aov;
  return files;
}

/// The scene moves from frame to frame; a camera of the scene moves with it, any other stays.
Json renderSequence(LoadedScene& loaded, renderer::Renderer& renderer, const scene::Camera& first,
                    const Options& options, PictureFormat format) {
  Json frames = Json::array();
  for (int i = 0; i < options.sequence.frames; ++i) {
    Options one = options;
    if (!one.picture.empty()) one.picture = numberFile("-o", options.picture, i);
    if (!one.aov.empty()) one.aov = numberFile("--aov", options.aov, i);
    const double timeS = options.scene.timeS.value_or(0.0) + i / options.sequence.framesPerS;
    loaded.motion->setTime(timeS);
    if (!loaded.motion->movesOnlyCameras()) renderer.updateGeometry(loaded.motion->movingParts());
    const scene::Camera camera = first.node >= 0 ? chooseCamera(loaded, options.camera) : first;
    const renderer::Frame frame = renderFrame(renderer, camera, one, format);
    Json json = makeFrameJson(one.frame.frame, frame);
    json["time_s"] = timeS;
    json["files"] = makeFilesJson(one);
    frames.push_back(std::move(json));
  }
  return frames;
}

/// A sequence is numbered files of a scene that moves.
void checkSequence(Options& options) {
  if (options.sequence.frames == 0) return;
  if (options.picture == "-") throw UsageError("--frames: a sequence cannot go to standard output");
  if (!options.picture.empty()) (void)numberFile("-o", options.picture, 0);
  if (!options.aov.empty()) (void)numberFile("--aov", options.aov, 0);
  options.scene.timeS = options.scene.timeS.value_or(0.0);
}

int run(Options options) {
  applyOutput(options.output);
  const PictureFormat format = checkOutputs(options);
  checkSequence(options);
  checkMethod(options.frame.frame);
  renderer::FrameOptions& frameOptions = options.frame.frame;
  frameOptions.boxCorrected = !options.plainMap;
  frameOptions.withSeen = !options.aov.empty();

  const auto loaded = loadScene(options.source, options.scene);
  const scene::Camera camera = chooseCamera(*loaded, options.camera);
  loadEnvironment(*loaded, options.frame.environment);
  renderer::Renderer renderer(loaded->scene, loaded->geometry, loaded->environment);
  Json result;
  if (options.sequence.frames > 0) {
    result["frames"] = renderSequence(*loaded, renderer, camera, options, format);
  } else {
    result = makeFrameJson(frameOptions, renderFrame(renderer, camera, options, format));
    result["files"] = makeFilesJson(options);
  }
  renderer.saveReferenceImages();
  if (!options.output.json.empty()) {
    Json document = makeDocument("render", &renderer);
    document["scene"] = makeSceneJson(*loaded);
    document["camera"] = makeJson(camera);
    document.update(result);
    writeDocument(options.output.json, document);
  }
  return 0;
}

}  // namespace

Command makeRenderCommand() {
  const auto options = std::make_shared<Options>();
  return {.name = "render",
          .summary = "Draw one picture",
          .examples =
              "  catoptric render scene.glb -o picture.png\n"
              "  catoptric render four-spheres -o truth.exr --method raytrace --bounces 4\n"
              "  catoptric render drivers-view -o mirrors.png --size 1280x720 --samples 8\n"
              "  catoptric render fender -o fender.png --aov seen.exr --json -\n"
              "  catoptric render walk.glb -o walk_####.png --frames 50 --fps 25\n",
          .declare =
              [options](Arguments& arguments) {
                arguments.positional("SCENE", "A .gltf or .glb file, '-', or a built-in scene",
                                     Arguments::Count::ExactlyOne, setText(options->source));
                arguments.group("Files");
                arguments.option("-o,--output", "FILE", "Picture to write: .png, .jpg, .exr, or '-' (PNG)",
                                 setText(options->picture));
                arguments.option("--aov", "FILE", "Also write what is seen at each pixel, as .exr",
                                 setText(options->aov));
                arguments.group("Sequence");
                arguments.option("--frames", "N",
                                 "Write N pictures of a scene that moves, as in -o out_####.png",
                                 setInteger("--frames", options->sequence.frames, 1, 1000000));
                arguments.option("--fps", "F", "Frames in a second of the scene's time; default 25",
                                 [options](const std::string& text) {
                                   options->sequence.framesPerS = parseNumber("--fps", text, 0.001, 100000);
                                 });
                declareMotion(arguments, options->scene);
                declareMethod(arguments, options->frame.frame, options->plainMap);
                declarePicture(arguments, options->frame);
                declareMerge(arguments, options->frame.frame);
                declareZexels(arguments, options->frame.frame.zexel);
                declareCamera(arguments, options->camera);
                declareScene(arguments, options->scene);
                declareOutput(arguments, options->output);
              },
          .run = [options](const std::vector<std::string>&) { return run(*options); }};
}

}  // namespace catoptric::app
