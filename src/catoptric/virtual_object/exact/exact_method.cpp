// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/exact/exact_method.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <string>
#include <tuple>

namespace catoptric::virtual_object {
namespace {

enum ExactUnit : int {
  kUnitParentIds = raster::kUnitFirstFree,
  kUnitOrigins,
  kUnitDirections,
  kUnitHits,
  kUnitTriangles,
  kUnitVertices
};

gl::Texture makeTarget(gl::Format format, int width, int height) {
  return gl::Texture(gl::TextureKind::Flat, format, width, height, 1, 1, gl::SamplerState{});
}

gl::Framebuffer makeFramebuffer(std::initializer_list<const gl::Texture*> colors, const gl::Texture* depth) {
  return gl::Framebuffer(std::span(colors.begin(), colors.size()), depth);
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

}  // namespace

ExactMethod::Targets::Targets(int width, int height)
    : widthPx(width),
      heightPx(height),
      origins(makeTarget(gl::Format::Rgba32F, width, height)),
      directions(makeTarget(gl::Format::Rgba32F, width, height)),
      hits(makeTarget(gl::Format::Rg32Ui, width, height)),
      depth(makeTarget(gl::Format::Depth32F, width, height)),
      rays(makeFramebuffer({&origins, &directions}, nullptr)),
      hitTests(makeFramebuffer({&hits}, &depth)) {}

ExactMethod::ExactMethod()
    : rayProgram_("raster/screen.vert", "virtual_object/exact_rays.frag"),
      hitProgram_("virtual_object/exact_cover.vert", "virtual_object/exact_hit.frag"),
      rectCorners_(gl::BufferKind::Vertex),
      rectIndices_(gl::BufferKind::Index) {
  rectArray_.setIndices(rectIndices_);
}

void ExactMethod::prepareScene(const raster::FrameContext& frame, const raster::Level& parent) {
  if (!triangles_) {
    triangles_ = std::make_unique<SceneTriangles>(frame.scene);
    tiles_.emplace(triangles_->hierarchy());
  }
  if (!targets_ || targets_->widthPx != parent.widthPx || targets_->heightPx != parent.heightPx) {
    targets_ = std::make_unique<Targets>(parent.widthPx, parent.heightPx);
    raysOf_ = nullptr;
  }
}

void ExactMethod::readRays(const raster::Level& parent) {
  if (raysOf_ == &parent) return;
  raysOf_ = &parent;
  targets_->rays.bind();
  gl::setDrawState({.depthTest = false, .depthWrite = false});
  rayProgram_.use();
  parent.bindAsParent(rayProgram_);
  nothing_.bind();
  gl::drawScreen();
  rays_.widthPx = parent.widthPx;
  rays_.heightPx = parent.heightPx;
  const std::size_t count = std::size_t(parent.widthPx) * std::size_t(parent.heightPx);
  rays_.origins.resize(count);
  rays_.directions.resize(count);
  rays_.words.resize(count);
  targets_->rays.readPixels(0, std::span<vec4>(rays_.origins));
  targets_->rays.readPixels(1, std::span<vec4>(rays_.directions));
  parent.surfaces.readPixels(3, std::span<uvec2>(rays_.words));
}

bool ExactMethod::showsBack(const scene::WorldGeometry& world, const scene::Part& part,
                            const CoverQuery& query) const {
  // A mirrored ray leaves on the side that is seen: compare it with the normal at the nearest vertex.
  int back = 0, front = 0;
  const int step = std::max(1, (query.width * query.height) / 256);
  for (int i = 0; i < query.width * query.height; i += step) {
    const std::size_t pixel = std::size_t(query.y + i / query.width) * std::size_t(rays_.widthPx) +
                              std::size_t(query.x + i % query.width);
    if (rays_.words[pixel].y != query.word) continue;
    const vec3 origin(rays_.origins[pixel]);
    std::uint32_t nearest = part.firstVertex;
    float least = std::numeric_limits<float>::infinity();
    for (std::uint32_t v = part.firstVertex; v < part.firstVertex + part.vertexCount; ++v) {
      const vec3 offset = world.positions[v] - origin;
      const float square = glm::dot(offset, offset);
      if (square < least) {
        least = square;
        nearest = v;
      }
    }
    (glm::dot(world.normals[nearest], vec3(rays_.directions[pixel])) < 0.0f ? back : front) += 1;
  }
  return back > front;
}

CoverQuery ExactMethod::makeQuery(const raster::FrameContext& frame, const raster::Chain& chain) const {
  const scene::WorldGeometry& world = frame.scene.geometry();
  const scene::Reflector& mirror = world.reflectors[chain.last];
  CoverQuery query{chain.bounds.x, chain.bounds.y, chain.bounds.width, chain.bounds.height,
                   chain.parentWord()};
  query.ownPart = mirror.part;
  query.reach = 2.0 * world.bounds.radius();
  // The ray tracer's rule: what leaves the front of a convex mirror, or a plane, never comes back to it.
  const bool leavesForGood = mirror.shape == scene::ReflectorShape::Plane ||
                             (mirror.isConvex && !mirror.isRefractor() &&
                              !(mirror.doubleSided && showsBack(world, world.parts[mirror.part], query)));
  if (leavesForGood) query.excludedPart = mirror.part;
  return query;
}

void ExactMethod::bindInputs(gl::Program& program, const raster::Level& parent,
                             const raster::Chain& chain) const {
  const std::array<std::tuple<const char*, const gl::Texture*, int>, 6> images{
      {{"u_parentIds", &parent.ids, kUnitParentIds},
       {"u_rayOrigins", &targets_->origins, kUnitOrigins},
       {"u_rayDirections", &targets_->directions, kUnitDirections},
       {"u_hits", &targets_->hits, kUnitHits},
       {"u_triangles", &triangles_->triangles(), kUnitTriangles},
       {"u_vertices", &triangles_->vertices(), kUnitVertices}}};
  for (const auto& [name, texture, unit] : images) {
    texture->bind(unit);
    program.set(name, unit);
  }
  program.set("u_targetSizePx", vec2(float(parent.widthPx), float(parent.heightPx)));
  program.set("u_parentWord", chain.parentWord());
  program.set("u_depthFromDistance", depthFromDistance_);
}

void ExactMethod::uploadRects(std::span<const CoverRect> rects, bool withItems) {
  corners_.clear();
  for (const CoverRect& r : rects) {
    const std::uint32_t item = withItems ? r.item : 0u;
    const vec2 number(float(item & 0xfffu), float(item >> 12u));
    for (int k = 0; k < 4; ++k)
      corners_.emplace_back(float(r.x + (k & 1) * r.width), float(r.y + (k >> 1) * r.height), number.x,
                            number.y);
  }
  rectCorners_.upload(std::span<const vec4>(corners_), true);
  if (indexedRects_ < rects.size()) {
    indexedRects_ = std::max(rects.size(), 2 * indexedRects_);
    indices_.clear();
    for (std::uint32_t i = 0; i < indexedRects_; ++i)
      for (const std::uint32_t k : {0u, 1u, 2u, 2u, 1u, 3u}) indices_.push_back(4 * i + k);
    rectIndices_.upload(std::span<const std::uint32_t>(indices_));
  }
  rectArray_.setAttribute(0, rectCorners_, 4);
}

void ExactMethod::drawRects(std::size_t first, std::size_t count) {
  gl::drawTriangles(std::uint32_t(6 * first), std::uint32_t(6 * count));
}

gl::Program& ExactMethod::findProgram(PartPass pass, unsigned textureBits) {
  std::unique_ptr<gl::Program>& program = partPrograms_[std::size_t(pass)][textureBits];
  if (!program) {
    std::vector<std::string> defines{"TEXTURES " + std::to_string(textureBits)};
    if (pass != PartPass::Shade) defines.emplace_back(pass == PartPass::Blend ? "OVERLAY" : "MASKED");
    const char* file =
        pass == PartPass::MaskedHits ? "virtual_object/exact_hit.frag" : "virtual_object/exact_shade.frag";
    program = std::make_unique<gl::Program>("virtual_object/exact_cover.vert", file, defines);
    program->bindBlock("Material", 0);
  }
  return *program;
}

void ExactMethod::drawParts(raster::FrameContext& frame, const raster::Chain& chain,
                            const raster::Level& parent, PartPass pass, std::span<const CoverRect> rects) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  const auto partOf = [&](const CoverRect& r) {
    return pass == PartPass::Shade ? r.item : world.triangleParts[r.item];
  };
  uploadRects(rects, pass != PartPass::Shade);
  std::uint32_t prepared = 0;  // bit k: the program for textures k knows this chain
  forRuns(rects, partOf, [&](std::uint32_t part, std::size_t first, std::size_t count) {
    const unsigned textures = frame.scene.textureBits(world.parts[part].material);
    gl::Program& program = findProgram(pass, textures);
    program.use();
    if ((prepared >> textures & 1u) == 0) {
      raster::bindSurfaceShading(program, frame.scene);
      bindInputs(program, parent, chain);
      program.set("u_ownPart", world.reflectors[chain.last].part);
      program.set("u_absorption", raster::findAbsorption(chain, world));
    }
    prepared |= 1u << textures;
    raster::bindPart(program, frame.scene, part, &chain);
    program.set("u_part", part);
    drawRects(first, count);
  });
}

void ExactMethod::drawHits(raster::FrameContext& frame, const raster::Chain& chain,
                           const raster::Level& parent, const CoverQuery& query) {
  targets_->hitTests.bind();
  gl::setScissor(chain.bounds);
  targets_->hitTests.clearColor(0, uvec4(0u));
  targets_->hitTests.clearDepth();
  gl::setDrawState({.depthTest = true, .depthWrite = true});
  hitProgram_.use();
  bindInputs(hitProgram_, parent, chain);
  hitProgram_.set("u_ownPart", query.ownPart);
  uploadRects(cover_.opaque, true);
  drawRects(0, cover_.opaque.size());
  const std::vector<std::uint32_t>& parts = frame.scene.geometry().triangleParts;
  std::stable_sort(cover_.masked.begin(), cover_.masked.end(),
                   [&](const CoverRect& s, const CoverRect& t) { return parts[s.item] < parts[t.item]; });
  drawParts(frame, chain, parent, PartPass::MaskedHits, cover_.masked);
}

void ExactMethod::shadeHits(raster::FrameContext& frame, const raster::Chain& chain,
                            const raster::Level& parent, const raster::Level& target) {
  std::stable_sort(cover_.parts.begin(), cover_.parts.end(),
                   [](const CoverRect& s, const CoverRect& t) { return s.item < t.item; });
  target.surfaces.bind();
  gl::setScissor(chain.bounds);
  gl::setDrawState({.depthTest = true, .depthWrite = true});
  drawParts(frame, chain, parent, PartPass::Shade, cover_.parts);
}

void ExactMethod::drawBlended(raster::FrameContext& frame, const raster::Chain& chain,
                              const raster::Level& parent, raster::Level& target) {
  if (cover_.blended.empty()) return;
  const scene::WorldGeometry& world = frame.scene.geometry();
  const vec3 centre(world.reflectors[chain.last].centre);
  const auto distance = [&](const CoverRect& r) {
    vec3 sum(0);
    for (std::size_t k = 0; k < 3; ++k) sum += world.positions[world.indices[3 * std::size_t(r.item) + k]];
    return glm::length(sum / 3.0f - centre);
  };
  std::stable_sort(cover_.blended.begin(), cover_.blended.end(),
                   [&](const CoverRect& s, const CoverRect& t) { return distance(s) > distance(t); });
  target.overlays.bind();
  if (!target.hasOverlay) target.overlays.clearColor(0, vec4(0.0f));
  target.hasOverlay = true;
  gl::setScissor(chain.bounds);
  gl::setDrawState({.depthTest = true, .depthWrite = false, .blendPremultiplied = true});
  drawParts(frame, chain, parent, PartPass::Blend, cover_.blended);
}

void ExactMethod::render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                         raster::Level& target) {
  // 1
  prepareScene(frame, parent);
  readRays(parent);
  // 2
  const auto start = std::chrono::steady_clock::now();
  const CoverQuery query = makeQuery(frame, chain);
  depthFromDistance_ = float(1.0 / (1.01 * std::max(query.reach, 1e-30)));
  tiles_->compute(rays_, query, cover_);
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  frame.counters.virtualVerticesMs += spent.count();
  frame.counters.virtualTriangles += cover_.opaque.size() + cover_.masked.size() + cover_.blended.size();
  frame.counters.fragmentTests += cover_.offeredPixels;
  // 3
  rectArray_.bind();
  drawHits(frame, chain, parent, query);
  // 4
  shadeHits(frame, chain, parent, target);
  // 5
  background_.draw(frame.scene, chain, parent, target);
  rectArray_.bind();
  drawBlended(frame, chain, parent, target);
}

}  // namespace catoptric::virtual_object
