// SPDX-License-Identifier: Apache-2.0
// Every member is optional but "schema" and "scene"; what is there must be of the right type and within the
// limits of the command line's option of that name. Members that are not known are refused: a slip in a name
// would otherwise change nothing, silently.
#include "session_file.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "catoptric/core/file.h"
#include "documents.h"
#include "session_value.h"

namespace catoptric::app {
namespace {

constexpr int kMostNumber = 1 << 30;
constexpr std::size_t kMostBytes = std::size_t(64) << 20;

std::string_view comparisonName(viewer::Comparison comparison) {
  constexpr std::string_view kNames[]{"none", "split", "difference", "displacement"};
  return kNames[int(comparison)];
}

/// A file's name as seen from the folder of the session, and back; built-in scenes have no file.
std::string nameFrom(const std::filesystem::path& folder, const std::string& name) {
  std::error_code failed;
  if (name.empty() || !std::filesystem::exists(name, failed)) return name;
  const auto relative = std::filesystem::proximate(name, folder.empty() ? "." : folder, failed);
  return failed ? name : relative.string();
}

std::string nameTo(const std::filesystem::path& folder, const std::string& name) {
  std::error_code failed;
  const std::filesystem::path inFolder = folder / name;
  return !name.empty() && std::filesystem::exists(inFolder, failed) ? inFolder.string() : name;
}

void readCamera(const SessionValue& value, viewer::Session& session) {
  scene::Camera& camera = session.camera;
  value.forMembers([&](const std::string& name, const SessionValue& member) {
    if (name == "name")
      camera.name = member.text();
    else if (name == "eye")
      camera.eye = member.vector();
    else if (name == "target")
      camera.target = member.vector();
    else if (name == "up")
      camera.up = member.vector();
    else if (name == "fov_degrees")
      camera.fovYRadians = glm::radians(member.number(0.1, 170));
    else if (name == "scene_camera")
      session.sceneCamera = std::size_t(member.integer(0, kMostNumber));
    else
      member.refuse("a member of a camera");
  });
  if (glm::length(camera.target - camera.eye) < 1e-9 || glm::length(camera.up) < 1e-9)
    value.refuse("a camera: its eye is its target, or its up has no length");
}

std::string_view splatName(depth_reflection_map::Splat splat) {
  constexpr std::array<std::string_view, 3> kNames{"point", "square", "footprint"};
  return kNames[std::size_t(splat)];
}

std::string_view visibilityName(depth_reflection_map::Visibility visibility) {
  return visibility == depth_reflection_map::Visibility::Ordered ? "ordered" : "zbuffer";
}

/// Of the method zexel. Bounds as on the command line.
void readZexels(const SessionValue& value, depth_reflection_map::ZexelOptions& zexel) {
  value.forMembers([&](const std::string& name, const SessionValue& member) {
    if (name == "references")
      zexel.references = member.integer(1, 2);
    else if (name == "hemisphere")
      zexel.hemisphere = member.integer(1, 4096);
    else if (name == "size")
      zexel.size = member.integer(8, 8192);
    else if (name == "splat")
      zexel.splat = member.choice(depth_reflection_map::Splat::Footprint, splatName);
    else if (name == "visibility")
      zexel.visibility = member.choice(depth_reflection_map::Visibility::ZBuffer, visibilityName);
    else if (name == "hierarchy")
      zexel.isHierarchical = member.flag();
    else if (name == "regions")
      zexel.skipsRegions = member.flag();
    else if (name == "coherence")
      zexel.isCoherent = member.flag();
    else if (name == "continuation")
      zexel.continuesSurfaces = member.flag();
    else if (name == "mark")
      zexel.marksExposures = member.flag();
    else
      member.refuse("an option of zexels");
  });
}

Json makeZexelsJson(const depth_reflection_map::ZexelOptions& zexel) {
  return {{"references", zexel.references},
          {"hemisphere", zexel.hemisphere},
          {"size", zexel.size},
          {"splat", splatName(zexel.splat)},
          {"visibility", visibilityName(zexel.visibility)},
          {"hierarchy", zexel.isHierarchical},
          {"regions", zexel.skipsRegions},
          {"coherence", zexel.isCoherent},
          {"continuation", zexel.continuesSurfaces},
          {"mark", zexel.marksExposures}};
}

void readOptions(const SessionValue& value, viewer::Session& session) {
  renderer::FrameOptions& frame = session.frame;
  value.forMembers([&](const std::string& name, const SessionValue& member) {
    if (name == "method")
      frame.method = member.choice(renderer::Method::RayTrace, renderer::methodName);
    else if (name == "solver")
      frame.solver = member.choice(renderer::Solver::Subdivision, renderer::solverName);
    else if (name == "backend")
      frame.backend = member.choice(renderer::Backend::Gpu, renderer::backendName);
    else if (name == "box_corrected")
      frame.boxCorrected = member.flag();
    else if (name == "baked")
      frame.bakedFile = member.text();
    else if (name == "width")
      frame.widthPx = member.integer(1, 16384);
    else if (name == "height")
      frame.heightPx = member.integer(1, 16384);
    else if (name == "bounces")
      frame.bounces = member.integer(0, 16);
    else if (name == "samples")
      frame.samples = member.integer(1, 1024);
    else if (name == "max_error_px")
      frame.maxErrorPx = member.number(0.01, 1e6);
    else if (name == "mapped_below")
      frame.mappedBelowPixels = member.integer(0, 1 << 30);
    else if (name == "all_parts")
      frame.allParts = member.flag();
    else if (name == "merge")
      frame.merge = member.choice(renderer::Merge::Texture, renderer::mergeName);
    else if (name == "texture_scale")
      frame.textureScale = member.number(0.01, 1);
    else if (name == "zexels")
      readZexels(member, frame.zexel);
    else if (name == "exposure")
      session.exposure = float(member.number(1e-6, 1e6));
    else if (name == "resolution")
      session.resolution = float(member.number(0.1, 1));
    else if (name == "comparison")
      session.comparison = member.choice(viewer::Comparison::Displacement, comparisonName);
    else if (name == "split")
      session.split = float(member.number(0, 1));
    else if (name == "playing")
      session.isPlaying = member.flag();
    else
      member.refuse("an option");
  });
}

void readShift(const SessionValue& value, viewer::Session& session) {
  std::uint32_t object = 0;
  dvec3 shift(0);
  std::string name;
  value.forMembers([&](const std::string& key, const SessionValue& member) {
    if (key == "object")
      object = std::uint32_t(member.integer(0, kMostNumber));
    else if (key == "name")
      name = member.text();
    else if (key == "moved")
      shift = member.vector(-1e6, 1e6);
    else
      member.refuse("a member of an edit");
  });
  session.state.setShift(object, shift);
  session.objectNames[object] = name;
}

void readMaterial(const SessionValue& value, viewer::Session& session) {
  int material = 0;
  scene::MaterialValues values;
  std::string name;
  value.forMembers([&](const std::string& key, const SessionValue& member) {
    if (key == "material")
      material = member.integer(0, kMostNumber);
    else if (key == "name")
      name = member.text();
    else if (key == "tint")
      values.tint = vec3(member.vector(0, 1));
    else if (key == "metallic")
      values.metallic = float(member.number(0, 1));
    else if (key == "roughness")
      values.roughness = float(member.number(0, 1));
    else if (key == "reflectivity")
      values.reflectivity = float(member.number(0, 1));
    else
      member.refuse("a member of an edit");
  });
  session.state.materials[material] = values;
  session.materialNames[std::uint32_t(material)] = name;
}

void readMembers(const SessionValue& value, const std::filesystem::path& folder, viewer::Session& session) {
  bool hasSchema = false;
  value.forMembers([&](const std::string& name, const SessionValue& member) {
    if (name == "schema")
      hasSchema = member.integer(1, 1) == 1;
    else if (name == "scene")
      session.scene.source = nameTo(folder, member.text());
    else if (name == "environment")
      session.scene.environment = nameTo(folder, member.text());
    else if (name == "mirrors")
      session.scene.mirrors = member.texts();
    else if (name == "no_reflectors")
      session.scene.noReflectors = member.flag();
    else if (name == "scene_options")
      session.sceneOptions = member.texts();
    else if (name == "animation")
      session.animation = member.text();
    else if (name == "time_s")
      session.state.timeS = member.number(0, 1e6);
    else if (name == "camera")
      readCamera(member, session);
    else if (name == "options")
      readOptions(member, session);
    else if (name == "moved")
      member.forElements([&](const SessionValue& element) { readShift(element, session); });
    else if (name == "materials")
      member.forElements([&](const SessionValue& element) { readMaterial(element, session); });
    else
      member.refuse("a member of a session");
  });
  if (!hasSchema || session.scene.source.empty())
    value.refuse("a session: \"schema\" or \"scene\" is missing");
}

Json makeOptionsJson(const viewer::Session& session) {
  const renderer::FrameOptions& frame = session.frame;
  Json options{{"method", std::string(renderer::methodName(frame.method))},
               {"solver", std::string(renderer::solverName(frame.solver))},
               {"backend", renderer::backendName(frame.backend)},
               {"box_corrected", frame.boxCorrected},
               {"width", frame.widthPx},
               {"height", frame.heightPx},
               {"bounces", frame.bounces},
               {"samples", frame.samples},
               {"max_error_px", frame.maxErrorPx},
               {"mapped_below", frame.mappedBelowPixels},
               {"all_parts", frame.allParts},
               {"merge", renderer::mergeName(frame.merge)},
               {"texture_scale", frame.textureScale},
               {"exposure", session.exposure},
               {"resolution", session.resolution},
               {"comparison", std::string(comparisonName(session.comparison))},
               {"split", session.split},
               {"playing", session.isPlaying}};
  if (frame.method == renderer::Method::Zexel) options["zexels"] = makeZexelsJson(frame.zexel);
  if (!frame.bakedFile.empty()) options["baked"] = frame.bakedFile;
  return options;
}

void addEdits(const viewer::Session& session, Json& json) {
  for (const auto& [object, shift] : session.state.shifts)
    json["moved"].push_back(
        {{"object", object}, {"name", session.objectNames.at(object)}, {"moved", makeJson(shift)}});
  for (const auto& [material, values] : session.state.materials)
    json["materials"].push_back({{"material", material},
                                 {"name", session.materialNames.at(std::uint32_t(material))},
                                 {"tint", makeJson(dvec3(values.tint))},
                                 {"metallic", values.metallic},
                                 {"roughness", values.roughness},
                                 {"reflectivity", values.reflectivity}});
}

}  // namespace

void writeSession(const std::string& file, const viewer::Session& session) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  Json json{{"schema", 1}, {"scene", nameFrom(folder, session.scene.source)}};
  if (!session.scene.environment.empty()) json["environment"] = nameFrom(folder, session.scene.environment);
  if (!session.scene.mirrors.empty()) json["mirrors"] = session.scene.mirrors;
  if (session.scene.noReflectors) json["no_reflectors"] = true;
  if (!session.sceneOptions.empty()) json["scene_options"] = session.sceneOptions;
  if (!session.animation.empty()) json["animation"] = session.animation;
  if (session.state.timeS) json["time_s"] = *session.state.timeS;
  json["camera"] = makeJson(session.camera);
  if (session.sceneCamera) json["camera"]["scene_camera"] = *session.sceneCamera;
  json["options"] = makeOptionsJson(session);
  addEdits(session, json);
  core::writeFileAtomically(file, serialise(json));
}

viewer::Session readSession(const std::string& file) {
  const std::vector<std::byte> bytes = core::readFile(file, kMostBytes);
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  const Json json = Json::parse(text, text + bytes.size(), nullptr, false);
  const SessionValue whole(file, json, "");
  if (json.is_discarded()) whole.refuse("JSON");
  viewer::Session session;
  session.camera.fovYRadians = 0.7;
  readMembers(whole, std::filesystem::path(file).parent_path(), session);
  return session;
}

}  // namespace catoptric::app
