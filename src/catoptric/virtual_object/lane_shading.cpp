// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/lane_shading.h"

#include <algorithm>
#include <utility>

#include "catoptric/core/parallel.h"

namespace catoptric::virtual_object {

namespace {

constexpr int kBandsPerThread = 8;
constexpr std::size_t kPixelsPerBand = 4096;  // fewer leave more of the lanes empty, part by part

/// Step 1, of rows [begin, end).
void sortPixels(const LaneJob& job, std::size_t begin, std::size_t end, LaneBand& band) {
  const auto width = std::size_t(job.images.bounds.width);
  const std::uint32_t word = job.chain.parentWord();
  const auto sky = std::uint32_t(job.frame.scene.geometry().parts.size());
  const std::span<const uvec4> triangles = job.triangles.triangleTexels();
  band.counts.resize(sky + 1);  // all zero between frames
  band.partsSeen.clear();
  band.found.clear();
  for (std::size_t y = begin; y < end; ++y) {
    const uvec2* ids = job.ids + y * std::size_t(job.images.levelWidthPx);
    for (std::size_t x = 0; x < width; ++x) {
      if (ids[x].y != word) continue;
      const std::uint32_t number = job.hits.hits[y * width + x].x;
      const std::uint32_t part = number == 0 ? sky : triangles[number - 1].w >> 2u;
      band.found.emplace_back(part, std::uint32_t(x | y << 16u));
      if (band.counts[part]++ == 0) band.partsSeen.push_back(part);
    }
  }
  band.runs.clear();
  std::uint32_t first = 0;
  for (const std::uint32_t part : band.partsSeen) {
    band.runs.push_back({part, first, band.counts[part]});
    first += std::exchange(band.counts[part], first);
  }
  band.pixels.resize(first);
  for (const uvec2& of : band.found) band.pixels[band.counts[of.x]++] = of.y;
  for (const std::uint32_t part : band.partsSeen) band.counts[part] = 0;
}

}  // namespace

void LaneShading::readParent(const raster::Level& parent, const gl::Scissor& bounds) {
  images_.bounds = bounds;
  images_.levelWidthPx = parent.widthPx;
  int attachment = 0;
  for (std::vector<vec4>* image : {&images_.radiances, &images_.positions, &images_.weights}) {
    image->resize(std::max(image->size(), images_.pixelCount()));
    parent.surfaces.readPixels(attachment++, bounds, std::span<vec4>(*image));
  }
}

void LaneShading::readTarget(const raster::Level& target) {
  const std::size_t count = images_.pixelCount();
  const bool isMirrors = !target.isLast;
  const auto read = [&](int attachment, bool isWanted, auto& image) {
    image.resize(isWanted ? count : 0);
    if (isWanted) target.surfaces.readPixels(attachment, images_.bounds, std::span(image));
  };
  read(0, true, images_.nextRadiances);
  read(1, isMirrors || target.withSeen, images_.nextPositions);
  read(2, isMirrors, images_.nextWeights);
  read(3, isMirrors || target.withIds || target.withSeen, images_.nextIds);
}

void LaneShading::writeTarget(raster::Level& target) {
  const gl::Scissor& b = images_.bounds;
  const auto write = [&](gl::Texture& texture, const auto& image) {
    if (!image.empty()) texture.uploadRect(b.x, b.y, b.width, b.height, image.data());
  };
  write(target.radiance, images_.nextRadiances);
  write(target.position, images_.nextPositions);
  write(target.weight, images_.nextWeights);
  write(target.ids, images_.nextIds);
}

LaneJob LaneShading::makeJob(const raster::FrameContext& frame, const raster::Chain& chain,
                             const SceneTriangles& triangles, const LaneHits& hits, bool isLast) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  const gl::Scissor& b = images_.bounds;
  return {.frame = frame,
          .chain = chain,
          .triangles = triangles,
          .hits = hits,
          .images = images_,
          .ids = &frame.parentIds[std::size_t(b.y) * std::size_t(images_.levelWidthPx) + std::size_t(b.x)],
          .isLast = isLast,
          .hasSolids = std::any_of(world.reflectors.begin(), world.reflectors.end(),
                                   [](const scene::Reflector& r) { return r.isRefractor(); }),
          .environment = frame.scene.laneEnvironment(),
          .lights = frame.scene.packLights()};
}

void LaneShading::shade(const LaneJob& job) {
  const auto height = std::size_t(images_.bounds.height);
  const std::size_t bands =
      std::clamp<std::size_t>(height * std::size_t(images_.bounds.width) / kPixelsPerBand,
                              std::min<std::size_t>(height, core::threadCount()),
                              std::min(height, std::size_t(kBandsPerThread * core::threadCount())));
  bands_.resize(std::max(bands_.size(), bands));
  core::parallelFor(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      sortPixels(job, i * height / bands, (i + 1) * height / bands, bands_[i]);
    shadeBands(job, std::span(bands_).subspan(begin, end - begin));
  });
}

void LaneShading::shade(raster::FrameContext& frame, const raster::Chain& chain,
                        const SceneTriangles& triangles, const LaneHits& hits, raster::Level& target) {
  frame.hasAdded = frame.addsTo != nullptr;
  if (frame.addsTo) {
    add(frame, chain, triangles, hits);
    writeAdded(*frame.addsTo);
    return;
  }
  readTarget(target);
  shade(makeJob(frame, chain, triangles, hits, target.isLast));
  writeTarget(target);
}

void LaneShading::add(const raster::FrameContext& frame, const raster::Chain& chain,
                      const SceneTriangles& triangles, const LaneHits& hits) {
  shade(makeJob(frame, chain, triangles, hits, true));
}

void LaneShading::takeAdded(const LaneShading& other, std::span<const uvec2> parentIds,
                            std::uint32_t otherWord) {
  const gl::Scissor &a = images_.bounds, &b = other.images_.bounds;
  const int x0 = std::max(a.x, b.x), x1 = std::min(a.x + a.width, b.x + b.width);
  const int y1 = std::min(a.y + a.height, b.y + b.height);
  const auto place = [](const gl::Scissor& s, int x, int y) {
    return std::size_t(y - s.y) * std::size_t(s.width) + std::size_t(x - s.x);
  };
  for (int y = std::max(a.y, b.y); y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      if (parentIds[std::size_t(y) * std::size_t(images_.levelWidthPx) + std::size_t(x)].y == otherWord)
        images_.radiances[place(a, x, y)] = other.images_.radiances[place(b, x, y)];
}

void LaneShading::writeAdded(raster::Level& level) const {
  const gl::Scissor& b = images_.bounds;
  level.radiance.uploadRect(b.x, b.y, b.width, b.height, images_.radiances.data());
}

}  // namespace catoptric::virtual_object
