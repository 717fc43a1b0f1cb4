// SPDX-License-Identifier: Apache-2.0
// Step 2 of lane_shading.h: eight pixels of one part at a time, from the ray to the light.
#include <algorithm>
#include <bit>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/lane_shader.h"
#include "catoptric/virtual_object/lane_shading.h"

namespace catoptric::virtual_object {

namespace lanes = core::lanes;
using core::kLanes;

namespace {

constexpr std::uint32_t kInsideBit = 0x40000000u;  // shaders/raster/level_pixels.glsl
constexpr float kSkyPath = 1.0e30f;

void setUniforms(const LaneJob& job, LaneShader& s) {
  s.u_environment = &job.environment;
  s.u_prefiltered = {&job.environment};
  s.u_environmentMaxLod = job.environment.lastLevel();
  s.u_prefilteredLast = job.environment.lastLayer();
  for (std::size_t i = 0; i < 9; ++i) s.u_irradiance[i] = job.frame.scene.environment().irradiance[i];
  s.u_vertices = job.triangles.vertexTexels().data();
  for (std::size_t i = 0; i + 3 < job.lights.size(); i += 4) {
    const vec4 *light = &job.lights[i], &a = light[0], &b = light[1], &c = light[2];
    LaneShader::PunctualLight& to = s.lights[std::size_t(s.lightCount++)];
    to.color = vec3(a), to.position = vec3(b), to.direction = vec3(c);
    to.kind = int(a.w);
    to.range = b.w, to.cosInner = c.w, to.cosOuter = light[3].x;
  }
}

void setPart(const LaneJob& job, std::uint32_t index, LaneShader& s) {
  const raster::SceneBuffers& scene = job.frame.scene;
  const scene::WorldGeometry& world = scene.geometry();
  const scene::Part& part = world.parts[index];
  const raster::MaterialBlock block = scene.materialBlock(part.material);
  s.m_baseColor = block.baseColor, s.m_emissive = block.emissive, s.m_factors = block.factors;
  s.m_more = block.more;
  std::copy_n(block.uvRows, s.m_uvRows.size(), s.m_uvRows.begin());
  const auto maps = scene.laneTextures(part.material);
  s.u_baseColor = maps[0], s.u_metallicRoughness = maps[1], s.u_normalMap = maps[2];
  s.u_occlusion = maps[3], s.u_emissive = maps[4];
  s.textures = 0;
  for (unsigned slot = 0; slot < maps.size(); ++slot) s.textures |= maps[slot] ? 1u << slot : 0u;
  s.blurred = maps[1] ? nullptr : job.environment.findBlurred(block.factors.x);
  const unsigned attributes = job.triangles.attributes(index);
  s.isColored = (attributes & kWithColors) != 0;
  s.isTwiceMapped = (attributes & kWithSecondUv) != 0;
  s.isLastMirror = job.isLast && part.reflector != core::kNoId;
  const raster::PartConstants constants = raster::findPartConstants(scene, index, &job.chain);
  s.u_objectWord = constants.objectWord, s.u_reflectorWord = constants.reflectorWord;
  s.u_lobes = constants.lobes;
}

CATOPTRIC_INLINE lanes::Vec4 load(const std::vector<vec4>& image, const std::uint32_t (&at)[kLanes]) {
  const vec4* rows[kLanes];
  for (int i = 0; i < kLanes; ++i) rows[i] = image.data() + at[i];
  return lanes::loadRows(rows);
}

CATOPTRIC_INLINE lanes::Float loadLast(const std::vector<vec4>& image, const std::uint32_t (&at)[kLanes]) {
  lanes::Float w;
  for (int i = 0; i < kLanes; ++i) w.v[i] = image[at[i]].w;
  return w;
}

CATOPTRIC_INLINE lanes::Vec3 loadDirection(LaneShader& s, const LaneImages& images,
                                           const std::uint32_t (&at)[kLanes]) {
  return s.directionFromOctahedral({loadLast(images.radiances, at), loadLast(images.weights, at)});
}

/// The pixels of one band.
struct ShadeBand {
  const LaneJob& job;
  LaneImages& images;
  LaneShader& s;
  vec3 absorption;

  /// Eight pixels and their neighbours on the same mirror.
  struct Pixels {
    std::uint32_t at[kLanes], besideX[kLanes], besideY[kLanes];
    lanes::Float signX, signY;
    int count;
  };

  CATOPTRIC_INLINE void findNeighbours(const std::uint32_t* list, std::size_t count, Pixels& p) const {
    p.count = int(std::min<std::size_t>(count, kLanes));
    const std::uint32_t word = job.chain.parentWord();
    const int width = images.bounds.width, height = images.bounds.height;
    const auto stride = std::size_t(images.levelWidthPx);
    for (int i = 0; i < kLanes; ++i) {
      const std::uint32_t pixel = list[std::min(i, p.count - 1)];
      const int x = int(pixel & 0xffffu), y = int(pixel >> 16u);
      const auto at = std::uint32_t(y * width + x);
      const uvec2* id = job.ids + std::size_t(y) * stride + x;
      p.at[i] = p.besideX[i] = p.besideY[i] = at;
      p.signX.v[i] = p.signY.v[i] = 1.0f;
      if (x + 1 < width && id[1].y == word)
        p.besideX[i] = at + 1;
      else if (x > 0 && id[-1].y == word)
        p.besideX[i] = at - 1, p.signX.v[i] = -1.0f;
      if (y + 1 < height && id[stride].y == word)
        p.besideY[i] = at + std::uint32_t(width);
      else if (y > 0 && (id - stride)->y == word)
        p.besideY[i] = at - std::uint32_t(width), p.signY.v[i] = -1.0f;
    }
  }

  CATOPTRIC_INLINE lanes::Mask loadInside(const Pixels& p) const {
    lanes::Mask isInside;
    for (int i = 0; i < kLanes; ++i) {
      const auto width = std::uint32_t(images.bounds.width), y = p.at[i] / width, x = p.at[i] - y * width;
      isInside.v[i] =
          (job.ids[std::size_t(y) * std::size_t(images.levelWidthPx) + x].x & kInsideBit) != 0 ? -1 : 0;
    }
    return isInside;
  }

  struct Seen {
    lanes::Vec3 radiance, position, weight{1.0f}, direction{0.0f};
    lanes::Float path;
    lanes::Mask isInside{false};
  };

  CATOPTRIC_INLINE void store(const Pixels& p, const Seen& seen, bool isMirror, uvec2 word) {
    if (job.frame.addsTo) {
      const lanes::Vec4 before = load(images.radiances, p.at), weight = load(images.weights, p.at);
      const lanes::Vec3 sum = lanes::Vec3(before) + lanes::Vec3(weight) * seen.radiance;
      for (int i = 0; i < p.count; ++i) {
        vec4& pixel = images.radiances[p.at[i]];
        pixel.x = sum.x.v[i], pixel.y = sum.y.v[i], pixel.z = sum.z.v[i];
      }
      return;
    }
    lanes::Vec2 octahedral(0.0f);
    if (isMirror) octahedral = s.octahedralFromDirection(seen.direction);
    const unsigned inside = core::toBits(seen.isInside.v);
    for (int i = 0; i < p.count; ++i) {
      const std::uint32_t at = p.at[i];
      images.nextRadiances[at] =
          vec4(seen.radiance.x.v[i], seen.radiance.y.v[i], seen.radiance.z.v[i], octahedral.x.v[i]);
      if (!images.nextPositions.empty())
        images.nextPositions[at] =
            vec4(seen.position.x.v[i], seen.position.y.v[i], seen.position.z.v[i], seen.path.v[i]);
      if (isMirror && !images.nextWeights.empty())
        images.nextWeights[at] =
            vec4(seen.weight.x.v[i], seen.weight.y.v[i], seen.weight.z.v[i], octahedral.y.v[i]);
      if (!images.nextIds.empty())
        images.nextIds[at] = uvec2(word.x | ((inside >> i & 1u) != 0 ? kInsideBit : 0u), word.y);
    }
  }

  CATOPTRIC_INLINE void shadeSky(const Pixels& p) {
    const lanes::Vec3 d = loadDirection(s, images, p.at);
    Seen seen;
    seen.radiance = s.lookUpEnvironment(d, (loadDirection(s, images, p.besideX) - d) * p.signX,
                                        (loadDirection(s, images, p.besideY) - d) * p.signY);
    seen.position = d;
    seen.path = kSkyPath;
    store(p, seen, false, uvec2(0u, job.chain.id << 16u));
  }

  CATOPTRIC_INLINE void shadePart(const Pixels& p, bool isMirror) {
    LaneShader::PixelRay ray;
    const lanes::Vec4 place = load(images.positions, p.at);
    ray.origin = lanes::Vec3(place);
    ray.originDx = (lanes::Vec3(load(images.positions, p.besideX)) - ray.origin) * p.signX;
    ray.originDy = (lanes::Vec3(load(images.positions, p.besideY)) - ray.origin) * p.signY;
    ray.direction = loadDirection(s, images, p.at);
    ray.directionDx = (loadDirection(s, images, p.besideX) - ray.direction) * p.signX;
    ray.directionDy = (loadDirection(s, images, p.besideY) - ray.direction) * p.signY;

    LaneShader::Corners corners;
    lanes::Float drawn;
    for (int i = 0; i < kLanes; ++i) {
      const uvec2 hit = job.hits.hits[p.at[i]];
      const uvec4& triangle = job.triangles.triangleTexels()[hit.x - 1u];
      corners.x[i] = std::int32_t(triangle.x), corners.y[i] = std::int32_t(triangle.y);
      corners.z[i] = std::int32_t(triangle.z), corners.w[i] = std::int32_t(triangle.w);
      drawn.v[i] = std::bit_cast<float>(hit.y);
    }
    using lanes::Vec3;
    Vec3 a(s.readVertex(corners.x, 0));
    const Vec3 e1 = Vec3(s.readVertex(corners.y, 0)) - a, e2 = Vec3(s.readVertex(corners.z, 0)) - a;
    a -= ray.origin;
    LaneShader::RayHit hit = s.meetTriangle(ray.direction, 0.0f, a, a + e1, a + e2, cross(e1, e2));
    if (job.hits.fromEye) drawn = drawn - place.w;
    hit = s.keepNear(hit, max(drawn, 0.0f));
    hit.isFront = hit.isFront || lanes::Mask((corners.w & 1) != 0);
    const LaneShader::SurfacePoint point = s.makeSurfacePoint(ray, corners, hit, e1, e2);
    const lanes::Vec4 base = s.readBaseColor(point);
    const LaneShader::ShadedPoint shaded = s.shadePoint(point, s.shadingNormal(point), Vec3(base));
    Seen seen;
    seen.radiance = shaded.radiance;
    seen.position = point.position;
    seen.path = place.w + hit.t;
    lanes::Mask isInside(false);
    if (job.hasSolids) {
      isInside = loadInside(p);
      const Vec3 left = choose(isInside, s.absorbLight(absorption, hit.t), Vec3(1.0f));
      seen.radiance *= left;
      seen.weight = left;
    }
    if (isMirror) {
      seen.weight *= shaded.weight;
      seen.direction = shaded.mirrorDirection;
      seen.isInside = s.isInsideBehind(shaded, point.isFront, isInside);
    }
    store(p, seen, isMirror, uvec2(s.u_objectWord, s.u_reflectorWord));
  }

  static CATOPTRIC_INLINE void run(ShadeBand& self, const LaneBand& band) {
    const scene::WorldGeometry& world = self.job.frame.scene.geometry();
    for (const LaneBand::Run& run : band.runs) {
      const bool isSky = run.part == world.parts.size();
      const bool isMirror = !isSky && !self.job.isLast && world.parts[run.part].reflector != core::kNoId;
      if (!isSky) setPart(self.job, run.part, self.s);
      for (std::size_t i = 0; i < run.count; i += std::size_t(kLanes)) {
        Pixels pixels;
        self.findNeighbours(band.pixels.data() + run.first + i, run.count - i, pixels);
        if (isSky)
          self.shadeSky(pixels);
        else
          self.shadePart(pixels, isMirror);
      }
    }
  }
};

/// Rays of rows [begin, end) of the bounds, into images of the whole level.
struct WriteRays {
  const LaneImages& images;
  std::size_t begin, end;
  vec4 *origins, *directions;

  static CATOPTRIC_INLINE void run(const WriteRays& self) {
    const LaneImages& images = self.images;
    const auto width = std::size_t(images.bounds.width);
    LaneShader s;
    for (std::size_t y = self.begin; y < self.end; ++y) {
      const std::size_t to = (std::size_t(images.bounds.y) + y) * std::size_t(images.levelWidthPx) +
                             std::size_t(images.bounds.x);
      std::copy_n(images.positions.begin() + std::ptrdiff_t(y * width), width, self.origins + to);
      for (std::size_t x = 0; x < width; x += std::size_t(kLanes)) {
        std::uint32_t at[kLanes];
        const std::size_t count = std::min(width - x, std::size_t(kLanes));
        for (std::size_t i = 0; i < std::size_t(kLanes); ++i)
          at[i] = std::uint32_t(y * width + x + std::min(i, count - 1));
        const lanes::Vec3 d = loadDirection(s, images, at);
        const lanes::Float least = s.findRayBegin(lanes::Vec3(load(images.positions, at)));
        for (std::size_t i = 0; i < count; ++i)
          self.directions[to + x + i] = vec4(d.x.v[i], d.y.v[i], d.z.v[i], least.v[i]);
      }
    }
  }
};

}  // namespace

void LaneShading::writeRays(std::span<vec4> origins, std::span<vec4> directions) const {
  core::parallelFor(std::size_t(images_.bounds.height), 32, [&](std::size_t begin, std::size_t end) {
    const WriteRays rows{images_, begin, end, origins.data(), directions.data()};
    core::runOnWidestVectors<WriteRays>(rows);
  });
}

void shadeBands(const LaneJob& job, std::span<const LaneBand> bands) {
  LaneShader shader;
  setUniforms(job, shader);
  ShadeBand self{job, job.images, shader, raster::findAbsorption(job.chain, job.frame.scene.geometry())};
  for (const LaneBand& band : bands) core::runOnWidestVectors<ShadeBand>(self, band);
}

}  // namespace catoptric::virtual_object
