// SPDX-License-Identifier: Apache-2.0
// Virtual triangles drawn as numbers: what is drawn is what is asked for, what is left out shows nowhere.
#include "catoptric/virtual_object/numbered_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "catoptric/virtual_object/part_rects.h"

namespace catoptric::virtual_object {
namespace {

using raster::TessellatedObjects;

/// A grid of cells x cells quads in a plane, every other triangle cut from one of three world triangles.
TessellatedObjects makeGrid(std::uint32_t cells, std::uint32_t sources) {
  TessellatedObjects objects;
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x) objects.positions.emplace_back(x, y, 0);
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
      for (const std::uint32_t v : {a, b, d, a, d, c}) objects.indices.push_back(v);
      for (int k = 0; k < 2; ++k)
        objects.sourceTriangles.push_back(std::uint32_t(objects.sourceTriangles.size()) % sources);
    }
  objects.parts = {{0, 0, std::uint32_t(objects.indices.size()), 0, std::uint32_t(objects.positions.size())}};
  return objects;
}

void expectTheSameTrianglesWithNumbers(const TessellatedObjects& objects) {
  const NumberedMesh mesh = makeNumberedMesh(objects);
  ASSERT_EQ(mesh.indices.size(), objects.indices.size());
  ASSERT_EQ(mesh.numbers.size(), mesh.vertices.size());
  for (std::size_t t = 0; t < objects.sourceTriangles.size(); ++t) {
    std::array<std::uint32_t, 3> is{}, was{};
    for (std::size_t k = 0; k < 3; ++k) {
      is[k] = mesh.vertices[mesh.indices[3 * t + k]];
      was[k] = objects.indices[3 * t + k];
    }
    EXPECT_EQ(mesh.numbers[mesh.indices[3 * t + 2]], objects.sourceTriangles[t]);
    std::rotate(was.begin(), std::find(was.begin(), was.end(), is[0]), was.end());
    EXPECT_EQ(is, was) << "turned, but not turned over";
  }
}

TEST(NumberedTriangles, LastCornerCarriesTheNumber) {
  expectTheSameTrianglesWithNumbers(makeGrid(12, 288));  // all different
  expectTheSameTrianglesWithNumbers(makeGrid(12, 3));
  expectTheSameTrianglesWithNumbers(makeGrid(12, 1));
  expectTheSameTrianglesWithNumbers({});
}

TEST(NumberedTriangles, VerticesAreDoubledOnlyWhereTheyMustBe) {
  EXPECT_EQ(makeNumberedMesh(makeGrid(12, 1)).vertices.size(), 169u);
  const std::size_t different = makeNumberedMesh(makeGrid(12, 288)).vertices.size();
  EXPECT_GE(different, 288u) << "one for each number at least";
  EXPECT_LT(different, 3u * 288u);
}

/// Random triangles of the unit square, about a pixel large.
struct Crumbs {
  TessellatedObjects objects;
  scene::WorldGeometry world;
  std::vector<vec3> positions;
  std::vector<std::uint8_t> isKept;
  // x and y are clip coordinates as they are.
  PictureView view{mat4(1.0f), 64, 48, false};
  gl::Scissor bounds{8, 4, 40, 36};

  explicit Crumbs(bool isSeenFromBehind) {
    std::mt19937 random(3);
    const auto uniform = [&] { return float(random() >> 8) / float(1u << 24); };
    for (std::uint32_t t = 0; t < 4000; ++t) {
      const vec2 centre = 2.2f * vec2(uniform(), uniform()) - 1.1f;
      for (int k = 0; k < 3; ++k) {
        positions.emplace_back(centre + 0.05f * (vec2(uniform(), uniform()) - 0.5f), 0.5f);
        objects.indices.push_back(3 * t + std::uint32_t(k));
      }
    }
    objects.positions = positions;
    objects.parts = {{0, 0, 12000, 0, 12000}};
    world.parts.resize(1);
    world.parts[0].isSeenFromBehind = isSeenFromBehind;
    isKept.assign(4000, 1);
  }

  std::size_t drop() {
    std::vector<vec3> screen;
    projectVertices(view, positions, screen);
    return dropUnseenTriangles(objects, world, view, bounds, screen, isKept);
  }

  /// Does a rasterizer draw the triangle at a pixel of the bounds?
  [[nodiscard]] bool shows(std::size_t t, bool isTwoSided) const {
    std::array<dvec2, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = (dvec2(vec2(positions[3 * t + k])) + 1.0) * 0.5 * dvec2(view.widthPx, view.heightPx);
    const auto side = [](const dvec2& a, const dvec2& b, const dvec2& q) {
      return (b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x);
    };
    const double turn = side(p[0], p[1], p[2]) > 0 ? 1 : -1;
    if (!isTwoSided && (turn < 0) != view.windingFlipped) return false;
    for (int y = bounds.y; y < bounds.y + bounds.height; ++y)
      for (int x = bounds.x; x < bounds.x + bounds.width; ++x) {
        const dvec2 q(x + 0.5, y + 0.5);
        if (turn * side(p[0], p[1], q) >= 0 && turn * side(p[1], p[2], q) >= 0 &&
            turn * side(p[2], p[0], q) >= 0)
          return true;
      }
    return false;
  }
};

TEST(NumberedTriangles, WhatIsDroppedShowsNowhere) {
  for (const bool isTwoSided : {false, true})
    for (const bool isFlipped : {false, true}) {
      Crumbs crumbs(isTwoSided);
      crumbs.view.windingFlipped = isFlipped;
      const std::size_t dropped = crumbs.drop();
      std::size_t seen = 0, kept = 0;
      for (std::size_t t = 0; t < crumbs.isKept.size(); ++t) {
        const bool shows = crumbs.shows(t, isTwoSided);
        seen += shows ? 1 : 0;
        kept += crumbs.isKept[t];
        EXPECT_TRUE(crumbs.isKept[t] || !shows);
      }
      EXPECT_EQ(kept + dropped, crumbs.isKept.size());
      EXPECT_GT(seen, 100u);
      EXPECT_LT(kept - seen, (crumbs.isKept.size() - seen) / 4) << "most of what shows nowhere is dropped";
    }
}

TEST(NumberedTriangles, WhatReachesBehindTheEyeIsKept) {
  Crumbs crumbs(true);
  crumbs.view.clipFromDraw[3].w = 0.0f;  // w = 0 for all
  EXPECT_EQ(crumbs.drop(), 0u);
}

TEST(NumberedTriangles, RectanglesHoldEachPartsPixels) {
  scene::WorldGeometry world;
  world.triangleParts = {0, 0, 1, 2};
  const gl::Scissor bounds{3, 5, 70, 41};
  constexpr int kWidth = 90;
  std::mt19937 random(5);
  std::vector<uvec2> hits, ids(std::size_t(kWidth) * 60, uvec2(0, 7));
  for (int i = 0; i < bounds.width * bounds.height; ++i) hits.emplace_back(random() % 5, 0);
  ids[20 * kWidth + 40].y = 8;  // another mirror's
  PartRects rects;
  findPartRects(world.triangleParts, bounds, hits, ids, kWidth, 7, rects);
  EXPECT_FALSE(rects.inner.empty());
  std::vector<int> covered(hits.size(), 0);
  for (const auto* list : {&rects.inner, &rects.edges})
    for (const CoverRect& r : *list)
      for (int y = r.y; y < r.y + r.height; ++y)
        for (int x = r.x; x < r.x + r.width; ++x) {
          ASSERT_TRUE(x >= bounds.x && y >= bounds.y && x < bounds.x + 70 && y < bounds.y + 41);
          const std::size_t i = std::size_t(y - bounds.y) * 70 + std::size_t(x - bounds.x);
          if (hits[i].x != 0 && world.triangleParts[hits[i].x - 1] == r.item) ++covered[i];
          const bool isOfMirror = ids[std::size_t(y) * kWidth + std::size_t(x)].y == 7;
          EXPECT_TRUE(isOfMirror || list == &rects.edges);
        }
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::size_t at = (5 + i / 70) * kWidth + 3 + i % 70;
    EXPECT_EQ(covered[i], hits[i].x != 0 && ids[at].y == 7 ? 1 : covered[i] & 1);
  }
}

}  // namespace
}  // namespace catoptric::virtual_object
