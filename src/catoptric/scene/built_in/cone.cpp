// SPDX-License-Identifier: Apache-2.0
// A chrome cone on a table top of rings and rays: a special reflector that mirrors straight rays from its
// axis straight and turns its surroundings upside down along itself. Its tip is cut off and carries a painted
// ball.
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

const dvec3 kRoomSize(5.0, 2.6, 4.6);
const dvec3 kTableSize(1.5, 0.74, 1.3);
constexpr double kBase = 0.26, kTop = 0.05, kHeight = 0.52;
constexpr double kOnTable = 0.742 + 0.0006;

/// Rings and rays around the middle of the table.
Pattern tableTop() {
  const Pattern wood = woodPlanks(colour(0xA97848), colour(0x70431F), 6, 3);
  return [=](dvec2 uv) {
    const dvec2 p = (uv - 0.5) * dvec2(kTableSize.x, kTableSize.z);
    const double r = glm::length(p);
    if (r > 0.6) return wood(uv);
    if (r > 0.585) return colour(0x2A1710);
    const int ring = int(std::floor(r / 0.085)),
              ray = int(std::floor((std::atan2(p.y, p.x) + 7) * 24 / 6.2831853));
    return (ring + ray) % 2 == 0 ? colour(0xEBDDBD) : ring % 2 == 0 ? colour(0x2C5A86) : colour(0x8E2F2A);
  };
}

void addCone(SceneBuilder& builder) {
  const double slope = (kTop - kBase) / kHeight;
  const auto radius = [=](double y) { return geometry::RadiusSample{kBase + slope * y, slope}; };
  builder.place("chrome cone", geometry::makeRevolvedSide(kHeight, 144, 20, radius), builder.mirror("chrome"),
                moveBy({0, kOnTable + 0.012, 0}));
  const int brass = builder.paint("brass paint", colour(0xC9A24B), 0.35f);
  builder.place("foot", geometry::makeCylinder(kBase + 0.012, 0.011, 96), brass,
                moveBy({0, kOnTable + 0.0055, 0}));
  builder.place("knob", geometry::makeUvSphere(0.058, 32, 16),
                builder.paint("knob paint", colour(0xC2302A), 0.3f),
                moveBy({0, kOnTable + kHeight + 0.045, 0}));
}

void addThings(SceneBuilder& builder) {
  const double y = kOnTable;
  const vec3 pine = colour(0xE8D3A6);
  builder.place("red block", makeToyBlock(builder, 0.12, "ABC", pine, colour(0xB8322A)),
                standAt({-0.37, y, 0.22}, 20));
  builder.place("green block", makeToyBlock(builder, 0.09, "123", pine, colour(0x2E7A45)),
                standAt({0.1, y, 0.42}, 34));
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0x2F6F9F), 0.25f)),
                standAt({0.45, y, 0.18}, -30, 0.18));
  builder.place("orange cone", geometry::makeCone(0.05, 0, 0.18, 32, true),
                builder.paint("orange paint", colour(0xE8761C), 0.4f), standAt({-0.14, y, 0.47}));
  builder.place("globe", makeGlobe(builder), standAt({-0.52, y, -0.28}, 40, 0.9));
  builder.place("desk lamp", makeDeskLamp(builder), standAt({0.58, y, -0.38}));
  builder.place(
      "ball", geometry::makeUvSphere(0.09, 40, 20),
      builder.textured("ball", {256, 128}, stripes(colour(0xF2C230), colour(0x2C6FB0), 1, 6), 0.35f),
      standAt({0.36, y + 0.09, 0.45}, 25));
  builder.place("bookshelf", makeBookshelf(builder, {1.2, 1.8, 0.32}, 5), standAt({2.48, 0.002, -0.6}, -90));
  builder.place("sofa", makeSofa(builder, colour(0x3F5A44)), standAt({-0.6, 0.002, 1.8}, 180));
  const int chair = builder.addMesh("chair", makeChair(builder));
  builder.place("chair 1", chair, standAt({1.25, 0.002, 0.4}, -75));
  builder.place("chair 2", chair, standAt({-1.25, 0.002, 0.3}, 100));
  builder.place("plant", makePottedPlant(builder, 1.4, 3), standAt({-2.1, 0.002, -1.8}));
}

}  // namespace

Scene makeCone() {
  SceneBuilder builder("cone");
  builder.addCamera("front", {0.2, 1.72, 1.25}, {0.0, 0.93, 0.02}, 41);
  builder.addCamera("above", {-0.35, 2.3, 0.55}, {0, 0.85, 0}, 45);
  BakedLight light;
  light.addBox({0, 0.71, 0}, {kTableSize.x, 0.05, kTableSize.z});
  light.addBox({-0.6, 0.3, 1.8}, {1.6, 0.5, 0.8});
  light.addBox({2.3, 0.9, -0.6}, {0.32, 1.8, 1.2});
  light.addColumn({-2.1, 0, -1.8}, 0.3, 0.3, 0.4);
  light.setLamp({0.8, 2.3, 0.6}, 0.4);
  addPictureRoom(builder, kRoomSize, light, {colour(0xAFC0CC), colour(0xC79D6A), colour(0x93673C)});
  BakedLight onTable;
  onTable.addColumn({0, kOnTable, 0}, kBase, kTop, kHeight);
  onTable.addBox({-0.37, kOnTable + 0.06, 0.22}, dvec3(0.12), 0.35);
  onTable.addBox({0.1, kOnTable + 0.045, 0.42}, dvec3(0.09), 0.6);
  onTable.addBall({0.45, kOnTable + 0.08, 0.18}, 0.1);
  onTable.addColumn({-0.14, kOnTable, 0.47}, 0.05, 0.004, 0.18);
  onTable.addBall({0.36, kOnTable + 0.09, 0.45}, 0.09);
  onTable.addColumn({0.58, kOnTable, -0.38}, 0.07, 0.05, 0.06);
  onTable.setLamp({-1.6, 3.4, 0.9}, 0.55);
  const dvec2 half(0.5 * kTableSize.x, 0.5 * kTableSize.z);
  const auto baked = onTable.bake(-half, half, kOnTable, 224, 192, 0.9, 0.5);
  const int top = builder.textured("table top", {1024, 1024}, shaded(tableTop(), baked), 0.45f, 1);
  builder.place("table", makeTable(builder, kTableSize, top), moveBy({0, 0.002, 0}));
  addCone(builder);
  addThings(builder);
  builder.addLamp({-1.4, 2.35, 0.7}, vec3(1.7f, 1.6f, 1.45f));
  builder.addLamp({1.5, 2.3, -0.6}, vec3(1.0f, 0.95f, 0.85f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
