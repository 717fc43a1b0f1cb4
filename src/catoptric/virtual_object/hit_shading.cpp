// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/hit_shading.h"

#include <algorithm>
#include <bitset>
#include <initializer_list>
#include <string>

namespace catoptric::virtual_object {
namespace {

enum HitUnit : int {
  kUnitParentIds = raster::kUnitFirstFree,
  kUnitOrigins,
  kUnitDirections,
  kUnitHits,
  kUnitHitDepth,
  kUnitTriangles,
  kUnitVertices,
  kUnitParentPosition,
  kUnitParentRadiance = kUnitOrigins,  // no program reads rays from both
  kUnitParentWeight = kUnitDirections
};

gl::Texture makeTarget(gl::Format format, int width, int height) {
  return gl::Texture(gl::TextureKind::Flat, format, width, height, 1, 1, gl::SamplerState{});
}

gl::Framebuffer makeFramebuffer(std::initializer_list<const gl::Texture*> colors, const gl::Texture* depth) {
  return gl::Framebuffer(std::span(colors.begin(), colors.size()), depth);
}

struct BoundImage {
  const char* name;
  const gl::Texture* texture;
  int unit;
};

void bindImages(gl::Program& program, std::initializer_list<BoundImage> images) {
  for (const BoundImage& image : images) {
    image.texture->bind(image.unit);
    program.set(image.name, image.unit);
  }
}

/// Calls draw(part, first, count) for each run of rectangles of one part; `partOf` tells it.
template <class PartOf, class Draw>
void forRuns(std::span<const CoverRect> rects, const PartOf& partOf, const Draw& draw) {
  for (std::size_t first = 0; first < rects.size();) {
    const std::uint32_t part = partOf(rects[first]);
    std::size_t last = first + 1;
    while (last < rects.size() && partOf(rects[last]) == part) ++last;
    draw(part, first, last - first);
    first = last;
  }
}

bool isVirtual(HitShading::Pass pass) {
  return pass == HitShading::Pass::ShadeVirtual || pass == HitShading::Pass::ShadeVirtualEdge;
}

void drawRange(std::size_t first, std::size_t count) {
  gl::drawTriangles(std::uint32_t(6 * first), std::uint32_t(6 * count));
}

}  // namespace

HitShading::Targets::Targets(int width, int height)
    : widthPx(width),
      heightPx(height),
      origins(makeTarget(gl::Format::Rgba32F, width, height)),
      directions(makeTarget(gl::Format::Rgba32F, width, height)),
      hits(makeTarget(gl::Format::Rg32Ui, width, height)),
      depth(makeTarget(gl::Format::Depth32F, width, height)),
      rays(makeFramebuffer({&origins, &directions}, nullptr)),
      hitTests(makeFramebuffer({&hits}, &depth)) {}

HitShading::HitShading()
    : rayProgram_("raster/screen.vert", "virtual_object/exact_rays.frag"),
      rectCorners_(gl::BufferKind::Vertex),
      rectIndices_(gl::BufferKind::Index) {
  rectArray_.setIndices(rectIndices_);
}

void HitShading::prepare(const raster::SceneBuffers& scene, const raster::Level& parent) {
  if (!triangles_ || triangles_->levels() != scene.levelsSoFar())
    triangles_ = std::make_unique<SceneTriangles>(scene);
  if (targets_ && targets_->widthPx == parent.widthPx && targets_->heightPx == parent.heightPx) return;
  targets_ = std::make_unique<Targets>(parent.widthPx, parent.heightPx);
}

void HitShading::drawRays(const raster::Level& parent, const gl::Scissor& bounds) {
  targets_->rays.bind();
  gl::setScissor(bounds);
  gl::setDrawState({.depthTest = false, .depthWrite = false});
  rayProgram_.use();
  parent.bindAsParent(rayProgram_);
  nothing_.bind();
  gl::drawScreen();
}

void HitShading::readRays(const gl::Scissor& bounds, std::span<vec4> origins,
                          std::span<vec4> directions) const {
  targets_->rays.readPixelsInPlace(0, bounds, origins);
  targets_->rays.readPixelsInPlace(1, bounds, directions);
}

void HitShading::continueHits(const gl::Scissor& bounds) const {
  targets_->hitTests.bind();
  gl::setScissor(bounds);
}

void HitShading::beginHits(const gl::Scissor& bounds) const {
  continueHits(bounds);
  targets_->hitTests.clearColor(0, uvec4(0u));
  targets_->hitTests.clearDepth();
}

void HitShading::readHits(const gl::Scissor& bounds, std::vector<uvec2>& hits) const {
  hits.resize(std::size_t(bounds.width) * std::size_t(bounds.height));
  targets_->hitTests.readPixels(0, bounds, std::span<uvec2>(hits));
}

void HitShading::uploadHits(const gl::Scissor& bounds, std::span<const uvec2> hits,
                            std::span<const float> depths) {
  targets_->hits.uploadRect(bounds.x, bounds.y, bounds.width, bounds.height, hits.data());
  if (!depths.empty())
    targets_->depth.uploadRect(bounds.x, bounds.y, bounds.width, bounds.height, depths.data());
}

void HitShading::bindInputs(gl::Program& program, const raster::Level& parent,
                            const raster::Chain& chain) const {
  bindImages(program, {{"u_parentIds", &parent.ids, kUnitParentIds},
                       {"u_rayOrigins", &targets_->origins, kUnitOrigins},
                       {"u_rayDirections", &targets_->directions, kUnitDirections}});
  bindHits(program, parent, chain);
  program.set("u_depthFromDistance", depthFromDistance_);
}

void HitShading::bindVirtualInputs(gl::Program& program, const raster::Level& parent,
                                   const raster::Chain& chain) const {
  bindImages(program, {{"u_parentIds", &parent.ids, kUnitParentIds},
                       {"u_parentPosition", &parent.position, kUnitParentPosition},
                       {"u_parentRadiance", &parent.radiance, kUnitParentRadiance},
                       {"u_parentWeight", &parent.weight, kUnitParentWeight},
                       {"u_hitDepth", &targets_->depth, kUnitHitDepth}});
  bindHits(program, parent, chain);
}

void HitShading::bindHits(gl::Program& program, const raster::Level& parent,
                          const raster::Chain& chain) const {
  bindImages(program, {{"u_hits", &targets_->hits, kUnitHits},
                       {"u_triangles", &triangles_->triangles(), kUnitTriangles},
                       {"u_vertices", &triangles_->vertices(), kUnitVertices}});
  program.set("u_targetSizePx", vec2(float(parent.widthPx), float(parent.heightPx)));
  program.set("u_parentWord", chain.parentWord());
}

void HitShading::setReach(double reach) {
  depthFromDistance_ = float(1.0 / (1.01 * std::max(reach, 1e-30)));
}

void HitShading::uploadRects(std::span<const CoverRect> rects, bool withItems) {
  corners_.clear();
  for (const CoverRect& r : rects) {
    const std::uint32_t item = withItems ? r.item : 0u;
    const vec2 number(float(item & 0xfffu), float(item >> 12u));
    for (int k = 0; k < 4; ++k)
      corners_.emplace_back(float(r.x + (k & 1) * r.width), float(r.y + (k >> 1) * r.height), number.x,
                            number.y);
  }
  rectCorners_.upload(std::span<const vec4>(corners_), true);
  rectArray_.bind();
  if (indexedRects_ < rects.size()) {
    indexedRects_ = std::max(rects.size(), 2 * indexedRects_);
    indices_.clear();
    for (std::uint32_t i = 0; i < indexedRects_; ++i)
      for (const std::uint32_t k : {0u, 1u, 2u, 2u, 1u, 3u}) indices_.push_back(4 * i + k);
    rectIndices_.upload(std::span<const std::uint32_t>(indices_));
  }
  rectArray_.setAttribute(0, rectCorners_, 4);
}

void HitShading::drawRects(std::span<const CoverRect> rects) {
  uploadRects(rects, true);
  drawRange(0, rects.size());
}

gl::Program& HitShading::findProgram(const raster::SceneBuffers& scene, Pass pass, unsigned variant) {
  std::unique_ptr<gl::Program>& program = partPrograms_[std::size_t(pass)][variant];
  if (!program) {
    std::vector<std::string> defines{"TEXTURES " + std::to_string(variant & 31u)};
    if ((variant & kWithColors) != 0) defines.emplace_back("COLORS");
    if ((variant & kWithSecondUv) != 0) defines.emplace_back("SECOND_UV");
    if (pass == Pass::MaskedHits) defines.emplace_back("MASKED");
    if (pass == Pass::Blend) defines.emplace_back("OVERLAY");
    if ((variant & kMirror) != 0) defines.emplace_back("MIRROR");
    if ((variant & kSeen) != 0) defines.emplace_back("SEEN");
    if ((variant & kEnvironment) != 0) defines.emplace_back("ENVIRONMENT");
    if ((variant & kDepth) != 0) defines.emplace_back("DEPTH");
    if (pass == Pass::ShadeVirtualEdge) defines.emplace_back("EDGE");
    const char* file = pass == Pass::MaskedHits ? "virtual_object/exact_hit.frag"
                       : isVirtual(pass)        ? "virtual_object/virtual_shade.frag"
                                                : "virtual_object/exact_shade.frag";
    raster::addConstantsDefines(scene, defines);
    program = std::make_unique<gl::Program>("virtual_object/exact_cover.vert", file, defines);
    program->bindBlock("Material", 0);
  }
  return *program;
}

void HitShading::shadeVirtual(raster::FrameContext& frame, const raster::Chain& chain,
                              const raster::Level& parent, const raster::Level& target, bool isEdge,
                              std::span<const CoverRect> rects, bool withDepths) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  const auto isMirror = [&](const CoverRect& r) { return world.parts[r.item].reflector != core::kNoId; };
  mirrorRects_.clear();
  otherRects_.clear();
  for (const CoverRect& r : rects) (isMirror(r) ? mirrorRects_ : otherRects_).push_back(r);
  const auto drawInto = [&](const gl::Framebuffer& framebuffer, unsigned output,
                            const std::vector<CoverRect>& some) {
    if (some.empty()) return;
    framebuffer.bind();
    gl::setScissor(chain.bounds);
    gl::setDrawState({.depthTest = withDepths, .depthWrite = withDepths});
    drawVariants(frame, chain, parent, isEdge ? Pass::ShadeVirtualEdge : Pass::ShadeVirtual, some, output);
  };
  const unsigned depth = withDepths ? kDepth : 0u, plain = depth | (target.withSeen ? kSeen : 0u);
  if (target.isLast)
    drawInto(target.plainTarget(), plain | kEnvironment, mirrorRects_);
  else
    drawInto(target.surfaces, depth | kMirror, mirrorRects_);
  drawInto(target.plainTarget(), plain, otherRects_);
}

void HitShading::drawVariants(raster::FrameContext& frame, const raster::Chain& chain,
                              const raster::Level& parent, Pass pass, std::span<const CoverRect> rects,
                              unsigned output) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  const bool isByPart = pass == Pass::Shade || isVirtual(pass);
  const auto partOf = [&](const CoverRect& r) { return isByPart ? r.item : world.triangleParts[r.item]; };
  uploadRects(rects, !isByPart);
  std::bitset<kVariants> prepared;  // whose program knows this chain
  forRuns(rects, partOf, [&](std::uint32_t part, std::size_t first, std::size_t count) {
    unsigned variant =
        frame.scene.textureBits(world.parts[part].material) | triangles_->attributes(part) | output;
    if (world.parts[part].reflector == core::kNoId) variant &= ~unsigned(kEnvironment);
    gl::Program& program = findProgram(frame.scene, pass, variant);
    program.use();
    if (!prepared[variant]) {
      raster::bindSurfaceShading(program, frame.scene);
      if (isVirtual(pass))
        bindVirtualInputs(program, parent, chain);
      else
        bindInputs(program, parent, chain);
      program.set("u_ownPart", world.reflectors[chain.last].part);
      program.set("u_absorption", raster::findAbsorption(chain, world));
    }
    prepared[variant] = true;
    raster::bindPart(program, frame.scene, part, &chain);
    program.set("u_part", part);
    drawRange(first, count);
  });
}

}  // namespace catoptric::virtual_object
