// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/surface_pass.h"

#include <algorithm>
#include <string>
#include <vector>

#include "catoptric/gl/context.h"

namespace catoptric::raster {

void addConstantsDefines(const SceneBuffers& scene, std::vector<std::string>& defines) {
  defines.push_back("LIGHTS " + std::to_string(scene.lightCount()));
  constexpr int kVaryingComponents = 4 * 31;  // of virtual_object/virtual_surface.vert, which has the most
  if (gl::isSoftwareContext() && gl::maxVaryingComponents() >= kVaryingComponents)
    defines.emplace_back("FLAT_CONSTANTS");
}

void bindSurfaceShading(gl::Program& program, const SceneBuffers& scene) {
  scene.bindEnvironment(program);
  scene.bindLights(program);
  const char* samplers[5] = {"u_baseColor", "u_metallicRoughness", "u_normalMap", "u_occlusion",
                             "u_emissive"};
  for (int unit = 0; unit < 5; ++unit) program.set(samplers[unit], unit);
}

PartConstants findPartConstants(const SceneBuffers& scene, std::uint32_t index, const Chain* chain) {
  const scene::WorldGeometry& world = scene.geometry();
  const scene::Part& part = world.parts[index];
  const bool isReflector = part.reflector != core::kNoId;
  PartConstants constants;
  constants.objectWord = (part.object + 1u) | (part.shell ? 0x80000000u : 0u);
  constants.reflectorWord = (isReflector ? part.reflector + 1u : 0u) | (chain ? chain->id << 16 : 0u);
  const float transmission = scene.material(part.material).transmission;
  constants.lobes = vec4(0, 0, 0, transmission);
  if (isReflector) {
    const scene::Reflector& reflector = world.reflectors[part.reflector];
    constants.lobes = vec4(reflector.reflectivity, reflector.clearcoat, reflector.ior, transmission);
  }
  return constants;
}

void bindPart(gl::Program& program, const SceneBuffers& scene, std::uint32_t index, const Chain* chain) {
  const PartConstants constants = findPartConstants(scene, index, chain);
  program.set("u_objectWord", constants.objectWord);
  program.set("u_reflectorWord", constants.reflectorWord);
  program.set("u_lobes", constants.lobes);
  scene.bindMaterial(scene.geometry().parts[index].material);
}

namespace {

/// What all parts that a program draws in one go share.
void setView(gl::Program& program, const SceneBuffers& scene, const SurfaceView& view) {
  program.use();
  bindSurfaceShading(program, scene);
  program.set("u_clipFromDraw", mat4(view.clipFromDraw));
  program.set("u_eye", vec3(view.eye));
  program.set("u_drawEye", vec3(view.drawEye));
  program.set("u_windingFlipped", view.windingFlipped ? 1 : 0);
  vec4 planes[ClipPlanes::kMost];
  std::fill(std::begin(planes), std::end(planes), vec4(0, 0, 0, 1));  // cuts nothing
  std::copy_n(view.clip.planes.begin(), view.clip.count, planes);
  program.set("u_clipPlanes", planes);
  if (view.parent) view.parent->bindAsParent(program);
  program.set("u_parentWord", view.chain ? view.chain->parentWord() : 0u);
  if (view.bindVertexShader) view.bindVertexShader(program);
}

}  // namespace

gl::Program& SurfacePass::findProgram(const SceneBuffers& scene, unsigned features) {
  std::unique_ptr<gl::Program>& program = programs_[features];
  if (!program) {
    std::vector<std::string> defines{"TEXTURES " + std::to_string(features & 31u)};
    const std::pair<Feature, const char*> names[] = {
        {kOverlay, "OVERLAY"},        {kMirror, "MIRROR"}, {kSeen, "SEEN"},
        {kParent, "PARENT"},          {kIds, "MASK"},      {kClip, "CLIP"},
        {kEnvironment, "ENVIRONMENT"}};
    for (const auto& [feature, name] : names)
      if ((features & feature) != 0) defines.emplace_back(name);
    addConstantsDefines(scene, defines);
    defines.insert(defines.end(), vertexDefines_.begin(), vertexDefines_.end());
    program = std::make_unique<gl::Program>(vertexFile_, "raster/surface.frag", defines);
    program->bindBlock("Material", 0);
  }
  return *program;
}

void SurfacePass::draw(const SceneBuffers& scene, const VertexStreams& streams,
                       std::span<const DrawRange> ranges, const SurfaceView& view, const Level& target) {
  mirrors_.clear();
  others_.clear();
  for (const DrawRange& range : ranges)
    (scene.geometry().parts[range.part].reflector != core::kNoId ? mirrors_ : others_).push_back(range);
  const auto drawInto = [&](const gl::Framebuffer& framebuffer, std::span<const DrawRange> some,
                            unsigned features) {
    if (some.empty()) return;
    framebuffer.bind();
    if (view.chain) gl::setScissor(view.chain->bounds);
    drawRanges(scene, streams, some, view, features);
  };
  const unsigned plain = target.withSeen ? kSeen : 0u;
  if (target.isLast)
    drawInto(target.plainTarget(), mirrors_, plain | kEnvironment);
  else
    drawInto(target.surfaces, mirrors_, kMirror);
  drawInto(target.plainTarget(), others_, plain);
}

void SurfacePass::drawBlended(const SceneBuffers& scene, const VertexStreams& streams,
                              std::span<const DrawRange> ranges, const SurfaceView& view, Level& target) {
  if (ranges.empty()) return;
  target.bindOverlay();
  if (view.chain) gl::setScissor(view.chain->bounds);
  drawRanges(scene, streams, ranges, view, kOverlay);
}

void SurfacePass::drawRanges(const SceneBuffers& scene, const VertexStreams& streams,
                             std::span<const DrawRange> ranges, const SurfaceView& view, unsigned features) {
  if (view.parent) features |= view.masking.testsIds ? kParent | kIds : kParent;
  const bool clipsInVertexShader = !view.parent && view.clip.count > 0;
  if (clipsInVertexShader) features |= kClip;
  const bool blended = (features & kOverlay) != 0;
  const scene::WorldGeometry& world = scene.geometry();
  std::uint32_t prepared = 0;  // bit k: the program for textures k knows this view
  streams.bind();
  for (const DrawRange& range : ranges) {
    const scene::Part& part = world.parts[range.part];
    if (range.indexCount == 0 || (part.reflector != core::kNoId && part.reflector == view.excludedReflector))
      continue;
    const scene::Material& material = scene.material(part.material);
    const unsigned textures = scene.textureBits(part.material);
    gl::Program& program = findProgram(scene, textures | features);
    if ((prepared >> textures & 1u) == 0)
      setView(program, scene, view);
    else
      program.use();
    prepared |= 1u << textures;
    const gl::Cull hidden = view.windingFlipped ? gl::Cull::Front : gl::Cull::Back;
    gl::setDrawState({.depthTest = true,
                      .depthWrite = !blended,
                      .stencil = view.masking.stencil,
                      .stencilValue = view.masking.stencilValue,
                      .clipDistances = clipsInVertexShader ? view.clip.count : 0,
                      .cull = material.isSeenFromBehind() ? gl::Cull::None : hidden,
                      .blend = blended ? gl::Blend::Premultiplied : gl::Blend::None});
    bindPart(program, scene, range.part, view.chain);
    gl::drawTriangles(range.firstIndex, range.indexCount);
  }
}

void sortNearFirst(const SceneBuffers& scene, const dvec3& from, std::vector<DrawRange>& ranges) {
  const auto distance = [&](const DrawRange& range) {
    const core::Box& box = scene.partBox(range.part);
    return glm::length(from - glm::clamp(from, box.lower, box.upper));
  };
  std::stable_sort(ranges.begin(), ranges.end(),
                   [&](const DrawRange& a, const DrawRange& b) { return distance(a) < distance(b); });
}

void sortBlendedTriangles(std::span<const DrawRange> ranges, std::span<const std::uint32_t> indices,
                          std::span<const vec3> drawPositions, const dvec3& eye,
                          std::vector<std::uint32_t>& sortedIndices, std::vector<DrawRange>& sortedRanges) {
  struct Item {
    double distance;
    std::uint32_t part, firstIndex;
  };
  std::vector<Item> items;
  for (const DrawRange& range : ranges)
    for (std::uint32_t i = range.firstIndex; i < range.firstIndex + range.indexCount; i += 3) {
      const dvec3 sum = dvec3(drawPositions[indices[i]]) + dvec3(drawPositions[indices[i + 1]]) +
                        dvec3(drawPositions[indices[i + 2]]);
      items.push_back({glm::length(sum / 3.0 - eye), range.part, i});
    }
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.distance > b.distance; });
  sortedIndices.clear();
  sortedRanges.clear();
  for (const Item& item : items) {
    if (sortedRanges.empty() || sortedRanges.back().part != item.part)
      sortedRanges.push_back({item.part, std::uint32_t(sortedIndices.size()), 0});
    for (std::uint32_t k = 0; k < 3; ++k) sortedIndices.push_back(indices[item.firstIndex + k]);
    sortedRanges.back().indexCount += 3;
  }
}

dmat4 makeClipFromWorld(const scene::CameraFrame& camera, double nearPlane, const dvec2& jitterPx) {
  dmat4 shift(1.0);
  shift[3] =
      dvec4((1.0 - 2.0 * jitterPx.x) / camera.widthPx, (2.0 * jitterPx.y - 1.0) / camera.heightPx, 0.0, 1.0);
  return shift * camera.clipFromView(nearPlane) * camera.viewFromWorld();
}

PrimaryPass::PrimaryPass(SurfacePass& surfaces)
    : surfaces_(surfaces),
      background_("raster/screen.vert", "raster/background.frag"),
      backgroundSeen_("raster/screen.vert", "raster/background.frag", {"SEEN"}) {}

PinholeView makePinholeView(const scene::CameraFrame& camera, double nearPlane, const dvec2& jitterPx) {
  // gl_FragCoord counts from the lower left corner and points at pixel centres.
  const dvec2 offset = jitterPx - 0.5;
  return {camera.eye,
          camera.rayDirection(offset.x, camera.heightPx + offset.y),
          camera.rayDirectionDx(),
          -camera.rayDirectionDy(),
          makeClipFromWorld(camera, nearPlane, jitterPx),
          false,
          {}};
}

void PrimaryPass::draw(const SceneBuffers& scene, const scene::CameraFrame& camera, double nearPlane,
                       const dvec2& jitterPx, Level& target, std::uint32_t excludedReflector) {
  draw(scene, makePinholeView(camera, nearPlane, jitterPx), target, excludedReflector);
}

void PrimaryPass::draw(const SceneBuffers& scene, const PinholeView& pinhole, Level& target,
                       std::uint32_t excludedReflector, const std::vector<DrawRange>* opaque) {
  target.clearDepths();
  SurfaceView view;
  view.clipFromDraw = pinhole.clipFromWorld;
  view.eye = view.drawEye = pinhole.eye;
  view.windingFlipped = pinhole.windingFlipped;
  view.clip = pinhole.clip;
  view.excludedReflector = excludedReflector;
  sortedRanges_ = opaque ? *opaque : scene.opaqueRanges();
  sortNearFirst(scene, pinhole.eye, sortedRanges_);
  surfaces_.draw(scene, scene.world(), sortedRanges_, view, target);

  target.plainTarget().bind();
  gl::setDrawState({.depthTest = true, .depthEqual = true, .depthWrite = false});
  gl::Program& background = target.withSeen ? backgroundSeen_ : background_;
  background.use();
  scene.bindEnvironment(background);
  background.set("u_rayOrigin", vec3(pinhole.rayOrigin));
  background.set("u_rayDx", vec3(pinhole.rayDx));
  background.set("u_rayDy", vec3(pinhole.rayDy));
  nothing_.bind();
  gl::drawScreen();
  if (scene.blendedRanges().empty()) return;
  if (!blendedStreams_) blendedStreams_ = std::make_unique<VertexStreams>(scene.geometry());
  sortBlendedTriangles(scene.blendedRanges(), scene.geometry().indices, scene.geometry().positions,
                       pinhole.eye, sortedIndices_, sortedRanges_);
  blendedStreams_->setIndices(sortedIndices_, true);
  surfaces_.drawBlended(scene, *blendedStreams_, sortedRanges_, view, target);
}

}  // namespace catoptric::raster
