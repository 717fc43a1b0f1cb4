// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/exact/exact_method.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "catoptric/scene/hierarchy_triangles.h"

namespace catoptric::virtual_object {
namespace {

std::vector<geometry::HierarchyTriangle> listCoverTriangles(const raster::SceneBuffers& scene) {
  const scene::WorldGeometry& world = scene.geometry();
  std::vector<std::uint32_t> flags;
  flags.reserve(world.parts.size());
  for (std::uint32_t p = 0; p < world.parts.size(); ++p) flags.push_back(findCoverFlags(scene, p));
  return scene::listTriangles(world, flags);
}

}  // namespace

void ExactMethod::prepareScene(const raster::FrameContext& frame) {
  if (hierarchy_) return;
  hierarchy_ = std::make_unique<TriangleHierarchy>(listCoverTriangles(frame.scene));
  tiles_.emplace(*hierarchy_);
  tileHits_.emplace(*hierarchy_);
}

void ExactMethod::readRays(const raster::Level& parent, const gl::Scissor& bounds) {
  rays_.widthPx = parent.widthPx;
  rays_.heightPx = parent.heightPx;
  const std::size_t count = std::size_t(parent.widthPx) * std::size_t(parent.heightPx);
  rays_.origins.resize(count);
  rays_.directions.resize(count);
  rays_.words.resize(count);
  if (testsByGl_) {
    shading_.drawRays(parent, bounds);
    shading_.readRays(bounds, rays_.origins, rays_.directions);
  } else {
    shading_.inLanes().readParent(parent, bounds);
    shading_.inLanes().writeRays(rays_.origins, rays_.directions);
  }
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

void ExactMethod::drawHits(raster::FrameContext& frame, const raster::Chain& chain,
                           const raster::Level& parent, PartImage* image) {
  if (testsByGl_) {
    shading_.beginHits(chain.bounds);
  } else {
    shading_.uploadHits(chain.bounds, hits_.hits, hits_.depths);
    if (cover_.masked.empty()) return;
    shading_.continueHits(chain.bounds);
  }
  if (image) image->closeDone(chain.bounds);
  gl::setDrawState({.depthTest = true, .depthWrite = true});
  if (testsByGl_) {
    if (!hitProgram_)
      hitProgram_ =
          std::make_unique<gl::Program>("virtual_object/exact_cover.vert", "virtual_object/exact_hit.frag");
    hitProgram_->use();
    shading_.bindInputs(*hitProgram_, parent, chain);
    hitProgram_->set("u_ownPart", query_.ownPart);
    shading_.drawRects(cover_.opaque);
  }
  const std::vector<std::uint32_t>& parts = frame.scene.geometry().triangleParts;
  std::stable_sort(cover_.masked.begin(), cover_.masked.end(),
                   [&](const CoverRect& s, const CoverRect& t) { return parts[s.item] < parts[t.item]; });
  shading_.drawParts(frame, chain, parent, HitShading::Pass::MaskedHits, cover_.masked);
}

void ExactMethod::shadeHits(raster::FrameContext& frame, const raster::Chain& chain,
                            const raster::Level& parent, const raster::Level& target) {
  std::stable_sort(cover_.parts.begin(), cover_.parts.end(),
                   [](const CoverRect& s, const CoverRect& t) { return s.item < t.item; });
  target.surfaces.bind();
  gl::setScissor(chain.bounds);
  gl::setDrawState({.depthTest = true, .depthWrite = true});
  shading_.drawParts(frame, chain, parent, HitShading::Pass::Shade, cover_.parts, target.isLast);
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
  gl::setDrawState({.depthTest = true, .depthWrite = false, .blend = gl::Blend::Premultiplied});
  shading_.drawParts(frame, chain, parent, HitShading::Pass::Blend, cover_.blended);
}

const RayImages& ExactMethod::findRays(const raster::FrameContext& frame, const raster::Chain& chain,
                                       const raster::Level& parent) {
  prepareScene(frame);
  shading_.prepare(frame.scene, parent);
  readRays(parent, chain.bounds);
  const auto width = std::size_t(parent.widthPx);
  for (int y = chain.bounds.y; y < chain.bounds.y + chain.bounds.height; ++y)
    std::copy_n(
        frame.parentIds.begin() + std::ptrdiff_t(std::size_t(y) * width + std::size_t(chain.bounds.x)),
        chain.bounds.width,
        rays_.words.begin() + std::ptrdiff_t(std::size_t(y) * width + std::size_t(chain.bounds.x)));
  return rays_;
}

void ExactMethod::findCover(raster::FrameContext& frame, const CoverQuery& query) {
  const auto start = std::chrono::steady_clock::now();
  shading_.setReach(query.reach);
  if (testsByGl_)
    tiles_->compute(rays_, query, cover_);
  else
    tileHits_->compute(rays_, query, shading_.depthFromDistance(), cover_, hits_);
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  frame.counters.coverMs += spent.count();
  frame.counters.virtualTriangles += cover_.opaque.size() + cover_.masked.size() + cover_.blended.size();
  frame.counters.fragmentTests += cover_.offeredPixels;
}

const HitImage* ExactMethod::findHits(raster::FrameContext& frame, const raster::Chain& chain,
                                      std::span<const std::uint8_t> isDone) {
  query_ = makeQuery(frame, chain);
  for (std::size_t i = 0; i < isDone.size(); ++i)  // no other chain has these pixels
    if (isDone[i] != 0)
      rays_
          .words[std::size_t(chain.bounds.y + int(i) / chain.bounds.width) * std::size_t(rays_.widthPx) +
                 std::size_t(chain.bounds.x + int(i) % chain.bounds.width)]
          .y = 0;
  findCover(frame, query_);
  const bool isComplete =
      !testsByGl_ && frame.merge == raster::Merge::Ids && cover_.masked.empty() && cover_.blended.empty();
  return isComplete ? &hits_ : nullptr;
}

void ExactMethod::drawRest(raster::FrameContext& frame, const raster::Chain& chain,
                           const raster::Level& parent, raster::Level& target, PartImage* image) {
  if (!testsByGl_) shading_.drawRays(parent, chain.bounds);
  drawHits(frame, chain, parent, image);
  shadeHits(frame, chain, parent, target);
  background_.draw(frame.scene, chain, parent, target);
  drawBlended(frame, chain, parent, target);
}

void ExactMethod::render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                         raster::Level& target) {
  // 1
  static_cast<void>(findRays(frame, chain, parent));
  // 2 to 5
  if (const HitImage* image = findHits(frame, chain, {})) {
    shading_.inLanes().shade(frame, chain, shading_.triangles(), {image->hits, false}, target);
    return;
  }
  drawRest(frame, chain, parent, target, nullptr);
}

}  // namespace catoptric::virtual_object
