// SPDX-License-Identifier: Apache-2.0
// The processor's numbers: each pixel shows the triangle that a ray through its centre meets first, whatever
// the triangles' sizes, before and behind the eye, and nothing before the mirror.
#include "catoptric/virtual_object/number_raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "catoptric/virtual_object/numbered_triangles.h"

namespace catoptric::virtual_object {
namespace {

constexpr int kWidth = 200, kHeight = 150;
constexpr gl::Scissor kBounds{30, 21, 77, 50};

/// An eye at the origin that looks along -z, and triangles all about it.
struct Cloud {
  raster::TessellatedObjects objects;
  std::vector<vec3> positions;
  std::vector<std::uint32_t> parts;
  std::vector<vec4> mirror;
  std::vector<uvec2> ids;
  std::vector<std::uint8_t> isKept, isWanted{1};
  PictureView view;

  /// Triangles of `size` at most, as far away as `farthest`, at either side of the eye's plane.
  Cloud(std::uint32_t count, float size, float farthest) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1, 1);
    const auto vector = [&] { return vec3(uniform(random), uniform(random), uniform(random)); };
    for (std::uint32_t t = 0; t < count; ++t) {
      const vec3 centre = farthest * vector();
      for (std::uint32_t k = 0; k < 3; ++k) {
        positions.push_back(centre + size * vector());
        objects.indices.push_back(3 * t + k);
      }
      objects.sourceTriangles.push_back(t);
    }
    objects.positions = positions;
    parts.assign(count, 0);
    isKept.assign(count, 1);
    mirror.assign(std::size_t(kBounds.width) * std::size_t(kBounds.height), vec4(0, 0, 0, 0.01f));
    ids.assign(std::size_t(kWidth) * kHeight, uvec2(0, 5));
    view.widthPx = kWidth, view.heightPx = kHeight;
    view.clipFromDraw = glm::infinitePerspective(1.0f, float(kWidth) / float(kHeight), 0.01f);
  }

  NumberImage draw(bool withDepths = true, bool withRivals = false) {
    std::vector<vec3> screen;
    projectVertices(view, positions, screen);
    const NumberPicture picture{.clipFromDraw = view.clipFromDraw,
                                .widthPx = kWidth,
                                .heightPx = kHeight,
                                .bounds = kBounds,
                                .mirror = mirror,
                                .parentIds = ids,
                                .parentWord = 5,
                                .screen = screen,
                                .virtualPositions = positions,
                                .isKept = isKept,
                                .isWanted = isWanted,
                                .triangleParts = parts,
                                .withDepths = withDepths,
                                .withRivals = withRivals};
    NumberImage image;
    NumberRaster().draw(objects, picture, image);
    return image;
  }

  /// Number + 1 of what the ray through a pixel's centre meets first beyond `least`; its distance.
  std::pair<std::uint32_t, double> meet(int x, int y, double least) const {
    const double tangent = std::tan(0.5);
    const dvec3 ray = glm::normalize(dvec3(tangent * kWidth / kHeight * (2 * (x + 0.5) / kWidth - 1),
                                           tangent * (2 * (y + 0.5) / kHeight - 1), -1));
    std::pair<std::uint32_t, double> first{0, std::numeric_limits<double>::infinity()};
    for (std::uint32_t t = 0; t < objects.sourceTriangles.size(); ++t) {
      const dvec3 a(positions[3 * t]), b(positions[3 * t + 1]), c(positions[3 * t + 2]);
      const double u = glm::dot(ray, glm::cross(b, c)), v = glm::dot(ray, glm::cross(c, a)),
                   w = glm::dot(ray, glm::cross(a, b));
      if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))) continue;
      const dvec3 normal = glm::cross(b - a, c - a);
      const double distance = glm::dot(a, normal) / glm::dot(ray, normal);
      if (distance > least && distance < first.second) first = {t + 1, distance};
    }
    return first;
  }
};

/// How many pixels show another triangle than they should, or the right one at a wrong distance.
int countWrong(Cloud& cloud, double least) {
  const NumberImage image = cloud.draw();
  int wrong = 0, shown = 0;
  for (int y = 0; y < kBounds.height; ++y)
    for (int x = 0; x < kBounds.width; ++x) {
      const auto [number, distance] = cloud.meet(kBounds.x + x, kBounds.y + y, least);
      const std::size_t at = std::size_t(y) * kBounds.width + std::size_t(x);
      const uvec2 hit = image.hits[at];
      shown += number != 0 ? 1 : 0;
      const bool isNear = number == 0 || std::abs(std::bit_cast<float>(hit.y) - distance) < 2e-3 * distance;
      wrong += hit.x == number && isNear ? 0 : 1;
    }
  EXPECT_GT(shown, kBounds.width * kBounds.height / 10);
  return wrong;
}

constexpr int kPixels = kBounds.width * kBounds.height;

TEST(NumberRaster, SmallTriangles) {
  Cloud cloud(4000, 0.12f, 2);
  EXPECT_LT(countWrong(cloud, 0.01), kPixels / 100);  // centres on an edge that is rounded to 1/256 px
}

TEST(NumberRaster, TrianglesWiderThanThePictureAndAroundTheEye) {
  Cloud cloud(60, 5, 4);
  EXPECT_LT(countWrong(cloud, 0.01), kPixels / 100);
}

TEST(NumberRaster, NothingLiesBeforeTheMirror) {
  Cloud cloud(4000, 0.12f, 2);
  for (vec4& p : cloud.mirror) p.w = 1.2f;
  EXPECT_LT(countWrong(cloud, 1.2), kPixels / 100);
  EXPECT_GT(countWrong(cloud, 0.01), kPixels / 100);
}

TEST(NumberRaster, DepthsMayBeLeftOut) {
  Cloud cloud(4000, 0.12f, 2);
  const NumberImage with = cloud.draw(), without = cloud.draw(false);
  EXPECT_EQ(with.depths.size(), std::size_t(kPixels));
  EXPECT_TRUE(without.depths.empty());
  EXPECT_EQ(with.hits, without.hits);
}

/// Quads that fill the picture, each two triangles of one number; as far away as `distances`, in this order.
Cloud makeWalls(std::span<const float> distances, float halfWidth) {
  Cloud cloud(0, 0, 0);
  for (std::uint32_t k = 0; k < distances.size(); ++k) {
    for (const vec2 corner : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)})
      cloud.positions.emplace_back(distances[k] * (vec2(0, -0.15f) + halfWidth * corner), -distances[k]);
    for (const std::uint32_t corner : {0, 1, 2, 0, 2, 3}) cloud.objects.indices.push_back(4 * k + corner);
    cloud.objects.sourceTriangles.insert(cloud.objects.sourceTriangles.end(), {k, k});
  }
  cloud.objects.positions = cloud.positions;
  cloud.parts.assign(distances.size(), 0);
  cloud.isKept.assign(2 * distances.size(), 1);
  return cloud;
}

/// The pixels at which the triangle of this number + 1 is a rival; its distance must be right.
std::size_t countRivals(const NumberImage& image, std::uint32_t number, float distance) {
  std::size_t count = 0;
  for (const std::vector<Rival>& rivals : image.rivals)
    for (const Rival& rival : rivals) {
      if (rival.number != number || image.hits[rival.pixel].x == 0) continue;
      ++count;
      const dvec2 px(rival.pixel % kBounds.width + kBounds.x, rival.pixel / kBounds.width + kBounds.y);
      const double tangent = std::tan(0.5);
      const dvec3 ray(tangent * kWidth / kHeight * (2 * (px.x + 0.5) / kWidth - 1),
                      tangent * (2 * (px.y + 0.5) / kHeight - 1), -1);
      EXPECT_NEAR(rival.length, distance * glm::length(ray), 1e-4 * distance);
    }
  return count;
}

TEST(NumberRaster, TheSecondIsKeptWhereItIsAboutAsNearInWhateverOrderTheyCome) {
  for (const float halfWidth : {2.0f, 0.1f, 0.02f})  // wider than 64 pixels, than 8, smaller
    for (const bool isTurned : {false, true}) {
      std::vector<float> distances{1.5f, 1.506f, 1.503f, 1.6f};
      std::vector<std::uint32_t> numbers{1, 2, 3, 4};
      if (isTurned)
        std::reverse(distances.begin(), distances.end()), std::reverse(numbers.begin(), numbers.end());
      Cloud cloud = makeWalls(distances, halfWidth);
      const NumberImage image = cloud.draw(true, true);
      const std::uint32_t first = isTurned ? 4 : 1, second = isTurned ? 2 : 3;
      const auto shown = std::size_t(std::count_if(image.hits.begin(), image.hits.end(),
                                                   [&](const uvec2& hit) { return hit.x == first; }));
      EXPECT_GT(shown, 4u);
      EXPECT_EQ(countRivals(image, second, 1.503f), shown);
      EXPECT_EQ(countRivals(image, isTurned ? 3 : 2, 1.506f), 0u);  // third
      EXPECT_EQ(countRivals(image, isTurned ? 1 : 4, 1.6f), 0u);    // too far
      EXPECT_EQ(countRivals(image, first, 1.5f), 0u);               // itself: both halves of the quad
      const NumberImage without = cloud.draw();
      EXPECT_TRUE(without.rivals.empty());
      EXPECT_EQ(without.hits, image.hits);
    }
}

TEST(NumberRaster, WhereNothingIsShownWhatIsBesideIsKept) {
  Cloud cloud = makeWalls(std::vector<float>{1.5f}, 0.1f);
  for (std::size_t i = 0; i < cloud.ids.size(); i += 5) cloud.ids[i].y = 6;  // no mirror
  const NumberImage image = cloud.draw(true, true);
  std::vector<int> kept(image.hits.size(), 0);
  for (const std::vector<Rival>& rivals : image.rivals)
    for (const Rival& rival : rivals) {
      EXPECT_EQ(rival.number, 1u);
      EXPECT_GT(rival.depth, 0.0f);
      ++kept[rival.pixel];
    }
  int wanted = 0;
  for (int y = 0; y < kBounds.height; ++y)
    for (int x = 0; x < kBounds.width; ++x) {
      const auto isShown = [&](int i, int j) {
        return i >= 0 && j >= 0 && i < kBounds.width && j < kBounds.height &&
               image.hits[std::size_t(j * kBounds.width + i)].x != 0;
      };
      const bool isMirror = (std::size_t(kBounds.y + y) * kWidth + std::size_t(kBounds.x + x)) % 5 != 0;
      const bool isWanted =
          isMirror && !isShown(x, y) &&
          (isShown(x - 1, y) || isShown(x + 1, y) || isShown(x, y - 1) || isShown(x, y + 1));
      EXPECT_EQ(kept[std::size_t(y * kBounds.width + x)] > 0, isWanted) << x << ' ' << y;
      wanted += isWanted ? 1 : 0;
    }
  EXPECT_GT(wanted, 30);
}

TEST(NumberRaster, HalfAPixelOffIsTold) {
  Cloud cloud(4000, 0.12f, 2);
  cloud.view.clipFromDraw = glm::translate(mat4(1), vec3(1.0f / kWidth, 0, 0)) * cloud.view.clipFromDraw;
  EXPECT_GT(countWrong(cloud, 0.01), kPixels / 100);
}

TEST(NumberRaster, OtherPixelsAndOtherPartsShowNothing) {
  Cloud cloud(2000, 0.3f, 2);
  for (std::size_t i = 0; i < cloud.ids.size(); i += 3) cloud.ids[i].y = 6;
  const NumberImage image = cloud.draw();
  for (int y = 0; y < kBounds.height; ++y)
    for (int x = 0; x < kBounds.width; ++x)
      if ((std::size_t(kBounds.y + y) * kWidth + std::size_t(kBounds.x + x)) % 3 == 0) {
        EXPECT_EQ(image.hits[std::size_t(y) * kBounds.width + std::size_t(x)].x, 0u);
      }
  cloud.isWanted[0] = 0;
  for (const uvec2& hit : cloud.draw().hits) EXPECT_EQ(hit.x, 0u);
}

TEST(NumberRaster, NeighboursLeaveNoGap) {
  Cloud cloud(0, 0, 0);
  // A fan about a pixel's centre, whose edges run through many more.
  const vec3 centre(0, 0, -1);
  constexpr std::uint32_t kSpokes = 96;
  cloud.positions.push_back(centre);
  for (std::uint32_t k = 0; k < kSpokes; ++k) {
    const float angle = float(k) * 6.2831853f / float(kSpokes);
    cloud.positions.emplace_back(0.5f * std::cos(angle), 0.5f * std::sin(angle), -1);
    cloud.objects.indices.insert(cloud.objects.indices.end(), {0, 1 + k, 1 + (k + 1) % kSpokes});
    cloud.objects.sourceTriangles.push_back(k);
  }
  cloud.objects.positions = cloud.positions;
  cloud.parts.assign(kSpokes, 0);
  cloud.isKept.assign(kSpokes, 1);
  const NumberImage image = cloud.draw();
  for (int y = 60; y < 70; ++y)
    for (int x = 80; x < 105; ++x)
      EXPECT_NE(image.hits[std::size_t(y - kBounds.y) * kBounds.width + std::size_t(x - kBounds.x)].x, 0u)
          << x << ' ' << y;
}

}  // namespace
}  // namespace catoptric::virtual_object
