// SPDX-License-Identifier: Apache-2.0
#include "viewer/command_text.h"

#include <fmt/format.h>

#include <functional>
#include <utility>

namespace catoptric::viewer {
namespace {

std::string vectorText(const dvec3& v) {
  return fmt::format("{},{},{}", v.x, v.y, v.z);
}

using AddOption = std::function<void(const std::string& option, const std::string& value)>;

void addZexels(const depth_reflection_map::ZexelOptions& options, const AddOption& add) {
  using namespace depth_reflection_map;
  const ZexelOptions standard;
  if (options.references != standard.references)
    add("--zexel-references", fmt::format("{}", options.references));
  if (options.hemisphere != standard.hemisphere)
    add("--zexel-hemisphere", fmt::format("{}", options.hemisphere));
  if (options.size != standard.size) add("--zexel-size", fmt::format("{}", options.size));
  if (options.splat != standard.splat)
    add("--zexel-splat", options.splat == Splat::Point ? "point" : "square");
  if (options.visibility != standard.visibility) add("--zexel-visibility", "zbuffer");
  if (!options.cacheFile.empty()) add("--zexel-cache", options.cacheFile);
  std::string without;
  const std::pair<bool, const char*> parts[] = {{options.isHierarchical, "hierarchy"},
                                                {options.skipsRegions, "regions"},
                                                {options.isCoherent, "coherence"},
                                                {options.continuesSurfaces, "continuation"}};
  for (const auto& [isOn, name] : parts)
    if (!isOn) without.append(without.empty() ? "" : ",").append(name);
  if (!without.empty()) add("--zexel-without", without);
  if (options.marksExposures) add("--zexel-mark", "");
}

}  // namespace

std::string quoteForShell(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word)
    if (c == '\'')
      quoted += "'\\''";
    else
      quoted += c;
  quoted += '\'';
  return quoted;
}

std::string makeCommandText(const LoadRequest& scene, const scene::Camera& camera,
                            const renderer::FrameOptions& options, float exposure,
                            const std::vector<std::string>& sceneOptions) {
  const renderer::FrameOptions standard;
  std::string text = "catoptric render " + quoteForShell(scene.source) + " -o picture.png";
  const auto add = [&](const std::string& option, const std::string& value) {
    text.append(" ").append(option);
    if (!value.empty()) text.append("=").append(quoteForShell(value));
  };
  for (const std::string& word : sceneOptions) text.append(" ").append(quoteForShell(word));
  for (const std::string& name : scene.mirrors) add("--reflector", name);
  if (scene.noReflectors) add("--no-reflectors", "");
  add("--method", std::string(renderer::methodName(options.method)));
  if (renderer::hasSolvers(options.method) && options.solver != standard.solver)
    add("--solver", std::string(renderer::solverName(options.solver)));
  if (renderer::hasSolvers(options.method) && renderer::hasVertexShader(options.solver) &&
      options.backend != standard.backend)
    add("--backend", std::string(renderer::backendName(options.backend)));
  if (options.method == renderer::Method::Morphing && !options.bakedFile.empty())
    add("--baked", options.bakedFile);
  if (options.method == renderer::Method::Morphing && options.mappedBelowPixels != standard.mappedBelowPixels)
    add("--mapped-below", fmt::format("{}", options.mappedBelowPixels));
  if (!options.boxCorrected) add("--plain-environment-map", "");
  add("--size", fmt::format("{}x{}", options.widthPx, options.heightPx));
  add("--bounces", fmt::format("{}", options.bounces));
  if (options.samples != standard.samples) add("--samples", fmt::format("{}", options.samples));
  if (options.maxErrorPx != standard.maxErrorPx) add("--max-error", fmt::format("{}", options.maxErrorPx));
  const bool merges = renderer::hasMerges(options.method);
  if (merges && options.merge != standard.merge)
    add("--merge", std::string(renderer::mergeName(options.merge)));
  if (merges && options.merge == renderer::Merge::Texture && options.textureScale != standard.textureScale)
    add("--texture-scale", fmt::format("{}", options.textureScale));
  if (options.method == renderer::Method::Zexel) addZexels(options.zexel, add);
  if (!scene.environment.empty()) add("--environment", scene.environment);
  if (exposure != 1.0f) add("--exposure", fmt::format("{}", exposure));
  add("--eye", vectorText(camera.eye));
  add("--target", vectorText(camera.target));
  add("--up", vectorText(camera.up));
  add("--fov", fmt::format("{}", glm::degrees(camera.fovYRadians)));
  return text;
}

}  // namespace catoptric::viewer
