// SPDX-License-Identifier: Apache-2.0
// catoptric draw SCENE --show WHAT -o FILE: what a method works with, as a picture.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "catoptric/core/file.h"
#include "catoptric/core/image_io.h"
#include "command_line.h"
#include "commands.h"
#include "drawing.h"
#include "option_values.h"
#include "pictures.h"
#include "shared_options.h"
#include "terminal.h"
#include "zexel_options.h"

namespace catoptric::app {
namespace {

struct Options {
  std::string source, picture;
  DrawingOptions drawing;
  SceneOptions scene;
  CameraOptions camera;
  PictureOptions frame;
  OutputOptions output;
};

std::string listKinds() {
  std::string names;
  for (const DrawingKind& kind : drawingKinds())
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  return names;
}

const DrawingKind& findKind(const std::string& name) {
  if (name.empty()) throw UsageError("what to draw is missing", "add --show, one of " + listKinds());
  const auto& kinds = drawingKinds();
  const auto kind =
      std::find_if(kinds.begin(), kinds.end(), [&](const DrawingKind& k) { return k.name == name; });
  if (kind == kinds.end()) throw UsageError("--show: there is no '" + name + "'", "one of " + listKinds());
  return *kind;
}

/// An option that the drawing has no use for is a mistake.
void checkUses(const DrawingKind& kind, const Options& options) {
  const DrawingOptions standard;
  const DrawingOptions& drawing = options.drawing;
  const renderer::FrameOptions plain, &frame = options.frame.frame;
  const std::pair<std::string_view, bool> given[] = {
      {"--from", drawing.from.has_value()},
      {"--at", drawing.at.has_value()},
      {"--from-fov", drawing.fromFovDegrees != standard.fromFovDegrees},
      {"--point", !drawing.points.empty()},
      {"--object", !drawing.objects.empty()},
      {"--count", drawing.count != standard.count},
      {"--width", drawing.width != standard.width},
      {"--spacing", drawing.spacing != standard.spacing},
      {"--samples", frame.samples != plain.samples},
      {"--bounces", frame.bounces != plain.bounces},
      {"--max-error", frame.maxErrorPx != plain.maxErrorPx},
      {"--environment", !options.frame.environment.empty()},
      {"--exposure", options.frame.exposure != PictureOptions{}.exposure},
      {"--zexel", frame.zexel != plain.zexel}};
  for (const auto& [name, isGiven] : given)
    if (isGiven && (" " + kind.uses + " ").find(fmt::format(" {} ", name)) == std::string::npos)
      throw UsageError(
          fmt::format("{}{}: --show {} has no use for it", name, name == "--zexel" ? "-..." : "", kind.name),
          "leave it out");
}

void writeDrawing(const std::string& file, PictureFormat format, const core::ImageRgba8& picture) {
  if (file == "-" || format == PictureFormat::Png) return writePng(file, picture);
  core::writeFileAtomically(file, std::span<const std::byte>(core::encodeJpeg(picture)));
}

int run(const Options& options) {
  applyOutput(options.output);
  const DrawingKind& kind = findKind(options.drawing.what);
  checkUses(kind, options);
  if (options.picture.empty()) throw UsageError("where to write to is missing", "add -o picture.png");
  const PictureFormat format = findPictureFormat("-o", options.picture);
  if (format == PictureFormat::Exr)
    throw UsageError("-o: a drawing has no radiance for an .exr", "use .png or .jpg");
  const auto loaded = loadScene(options.source, options.scene);
  const scene::Camera camera = chooseCamera(*loaded, options.camera);
  loadEnvironment(*loaded, options.frame.environment);
  renderer::Renderer renderer(loaded->scene, loaded->geometry, loaded->environment);
  Drawing drawing{*loaded, renderer, camera, options.frame.frame, options.frame.exposure, options.drawing};
  const core::ImageRgba8 picture = kind.draw(drawing);
  writeDrawing(options.picture, format, picture);
  say(fmt::format("wrote {} ({}x{}, {})", options.picture, picture.width(), picture.height(), kind.name));
  if (!options.output.json.empty()) {
    Json document = makeDocument("draw", &renderer);
    document["scene"] = makeSceneJson(*loaded);
    document["camera"] = makeJson(camera);
    document["show"] = std::string(kind.name);
    document["facts"] = drawing.facts;
    writeDocument(options.output.json, document);
  }
  return kDone;
}

void declareDrawing(Arguments& arguments, DrawingOptions& drawing) {
  arguments.group("Drawing");
  arguments.option("--show", "WHAT", "What to draw, one of " + listKinds(), setText(drawing.what));
  arguments.option("--from", "X,Y,Z", "Where the third eye stands; default: aside and above",
                   [&drawing](const std::string& text) { drawing.from = parseVector("--from", text); });
  arguments.option("--at", "X,Y,Z", "Where it looks",
                   [&drawing](const std::string& text) { drawing.at = parseVector("--at", text); });
  arguments.option("--from-fov", "DEG", "Its field of view; default 40", [&drawing](const std::string& text) {
    drawing.fromFovDegrees = parseNumber("--from-fov", text, 1, 160);
  });
  arguments.repeatable(
      "--point", "X,Y,Z", "Scene point to ask about; may be given several times",
      [&drawing](const std::string& text) { drawing.points.push_back(parseVector("--point", text)); });
  arguments.repeatable("--object", "NAME", "Only this object's virtual one; may be given several times",
                       [&drawing](const std::string& text) { drawing.objects.push_back(text); });
  arguments.option("--count", "N", "How many rays, or texels along an edge; default 12",
                   setInteger("--count", drawing.count, 1, 1000));
  arguments.option(
      "--width", "M", "Metres that are shown, or of a cell; default: what is fit",
      [&drawing](const std::string& text) { drawing.width = parseNumber("--width", text, 1e-6, 1e9); });
  arguments.option(
      "--spacing", "M", "Metres between sampling locations; default 0.3",
      [&drawing](const std::string& text) { drawing.spacing = parseNumber("--spacing", text, 1e-6, 1e9); });
}

}  // namespace

Command makeDrawCommand() {
  const auto options = std::make_shared<Options>();
  return {.name = "draw",
          .summary = "What a method works with, as a picture: maps, cells, virtual objects, zexels",
          .examples =
              "  catoptric draw four-spheres -o maps.png --show explosion-maps\n"
              "  catoptric draw columns -o cells.png --show subdivision --point 0.5,0.5,0.6\n"
              "  catoptric draw checker-box -o exposures.png --show exposures --zexel-splat point\n",
          .declare =
              [options](Arguments& arguments) {
                arguments.positional("SCENE", "A .gltf or .glb file, '-', or a built-in scene",
                                     Arguments::Count::ExactlyOne, setText(options->source));
                arguments.group("Files");
                arguments.option("-o,--output", "FILE", "Picture to write: .png, .jpg, or '-' (PNG)",
                                 setText(options->picture));
                declareDrawing(arguments, options->drawing);
                declareMotion(arguments, options->scene);
                declarePicture(arguments, options->frame);
                declareZexels(arguments, options->frame.frame.zexel);
                declareCamera(arguments, options->camera);
                declareScene(arguments, options->scene);
                declareOutput(arguments, options->output);
              },
          .run = [options](const std::vector<std::string>&) { return run(*options); }};
}

}  // namespace catoptric::app
