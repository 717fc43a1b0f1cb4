// SPDX-License-Identifier: Apache-2.0
// Four chrome spheres on a table in a room (Ofek & Rappoport 1998, figures 15 and 16: checkerboard to show
// the reflections, real textures, shadows baked into the table's texture, a window).
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/baked_light.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"

namespace catoptric::scene::built_in {
namespace {

constexpr double kTableHeight = 0.75;
const dvec3 kRoomSize(5.4, 2.7, 4.6);
const dvec3 kTableSize(1.9, kTableHeight, 1.25);

struct ChromeSphere {
  const char* name;
  double x, z, radius;
  vec3 tint;
};

const ChromeSphere kSpheres[] = {{"large sphere", -0.30, -0.16, 0.25, vec3(0.95f)},
                                 {"gold sphere", 0.27, -0.20, 0.18, vec3(0.97f, 0.90f, 0.78f)},
                                 {"blue sphere", 0.04, 0.20, 0.125, vec3(0.84f, 0.91f, 0.97f)},
                                 {"rose sphere", 0.45, 0.14, 0.09, vec3(0.97f, 0.86f, 0.85f)}};

/// Chessboard inlaid in the middle of a wooden top.
Pattern tableTop() {
  const Pattern wood = woodPlanks(colour(0xA97848), colour(0x70431F), 6, 3);
  const Pattern board = checker(colour(0xEBDDBD), colour(0x45281A), 8, 8);
  return [=](dvec2 uv) {
    const dvec2 place = (uv - 0.5) * dvec2(kTableSize.x, kTableSize.z);  // metres from the middle
    const double fromMiddle = std::max(std::abs(place.x), std::abs(place.y));
    if (fromMiddle < 0.48) return board(place / 0.96 + 0.5);
    if (fromMiddle < 0.5) return colour(0x2A1710);
    return wood(uv);
  };
}

BakedLight tableLight() {
  BakedLight light;
  for (const ChromeSphere& s : kSpheres) light.addBall({s.x, kTableHeight + s.radius, s.z}, s.radius);
  light.addBall({-0.66, kTableHeight + 0.09, 0.27}, 0.11);            // teapot
  light.addBox({0.0, kTableHeight + 0.05, -0.42}, dvec3(0.1), 0.35);  // blocks
  light.addBox({0.22, kTableHeight + 0.04, 0.36}, dvec3(0.08), 0.6);
  light.addBox({-0.16, kTableHeight + 0.04, 0.42}, dvec3(0.08), -0.3);
  light.addColumn({0.66, kTableHeight, 0.36}, 0.06, 0.005, 0.16);  // cones
  light.addColumn({-0.36, kTableHeight, 0.33}, 0.05, 0.005, 0.13);
  light.addColumn({0.74, kTableHeight, -0.34}, 0.07, 0.05, 0.06);  // lamp
  light.addBall({-0.72, kTableHeight + 0.2, -0.36}, 0.115);        // globe
  light.setLamp({-1.6, 3.4, 0.9}, 0.55);
  return light;
}

void addTable(SceneBuilder& builder) {
  const dvec2 half(0.5 * kTableSize.x, 0.5 * kTableSize.z);
  const auto light = tableLight().bake(-half, half, kTableHeight, 288, 192, 0.95, 0.5);
  const int top = builder.textured("table top", {1024, 1024}, shaded(tableTop(), light), 0.45f, 1);
  builder.place("table", makeTable(builder, kTableSize, top));
}

void addSpheres(SceneBuilder& builder) {
  for (const ChromeSphere& s : kSpheres)
    builder.place(s.name, geometry::makeIcosphere(s.radius, s.radius > 0.15 ? 25 : 23),
                  builder.mirror(std::string(s.name) + " chrome", s.tint),
                  geometry::moveBy({s.x, kTableHeight + s.radius + 0.0005, s.z}));
}

void addThingsOnTable(SceneBuilder& builder) {
  const double y = kTableHeight + 0.0006;
  const int glaze = builder.paint("teapot glaze", colour(0x2F6F9F), 0.25f);
  builder.place("teapot", makeTeapotPieces(glaze), standAt({-0.66, y, 0.27}, -30, 0.19));
  const vec3 pine = colour(0xE8D3A6);
  builder.place("red block", makeToyBlock(builder, 0.1, "ABC", pine, colour(0xB8322A)),
                standAt({0, y, -0.42}, 20));
  builder.place("green block", makeToyBlock(builder, 0.08, "123", pine, colour(0x2E7A45)),
                standAt({0.22, y, 0.36}, 34));
  builder.place("blue block", makeToyBlock(builder, 0.08, "DEF", pine, colour(0x2B4FA0)),
                standAt({-0.16, y, 0.42}, -17));
  const int orange = builder.paint("orange paint", colour(0xE8761C), 0.4f),
            green = builder.paint("green paint", colour(0x3E9A4F), 0.4f);
  builder.place("orange cone", geometry::makeCone(0.06, 0, 0.16, 32, true), orange, standAt({0.66, y, 0.36}));
  builder.place("green cone", geometry::makeCone(0.05, 0, 0.13, 32, true), green, standAt({-0.36, y, 0.33}));
  builder.place("desk lamp", makeDeskLamp(builder), standAt({0.74, y, -0.34}));
  builder.place("globe", makeGlobe(builder), standAt({-0.72, y, -0.36}, 40));
  builder.place("ring", geometry::makeTorus(0.06, 0.02, 32, 16),
                builder.paint("yellow paint", colour(0xEBC12F), 0.35f), standAt({0.82, y + 0.02, 0.1}));
}

void addRoomAround(SceneBuilder& builder) {
  RoomOptions room;
  room.size = kRoomSize;
  BakedLight light;
  light.addBox({0, kTableHeight - 0.03, 0}, {kTableSize.x, 0.05, kTableSize.z});
  light.addBox({2.45, 0.9, -0.6}, {0.4, 1.8, 1.2});
  light.addBox({-1.5, 0.3, -1.8}, {1.7, 0.6, 0.8});
  const dvec2 half(0.5 * kRoomSize.x, 0.5 * kRoomSize.z);
  const auto contact = light.bake(-half, half, 0, 160, 128, 0.75, 0);
  const auto corners = edgeShade({kRoomSize.x, kRoomSize.z}, 0.3, 0.35);
  const Pattern boards = repeated(woodPlanks(colour(0xC79D6A), colour(0x93673C), 12, 5), {2, 2});
  room.floor = builder.textured("floor boards", {1024, 1024},
                                shaded(boards, [=](dvec2 uv) { return contact(uv) * corners(uv); }), 0.6f, 1);
  room.walls = builder.textured("wall plaster", {512, 512}, plaster(colour(0xD9CDB6), 0.06, 2), 0.9f, 1);
  room.ceiling = builder.paint("ceiling", colour(0xE9E6DF), 0.95f);
  const int white = room.skirting = builder.paint("white paint", colour(0xECE9E2), 0.5f);
  const Opening window{{1.3, 0.85}, {3.1, 2.3}}, rear{{1.7, 0.9}, {3.7, 2.3}};
  room.openings[kLeft] = {window};
  room.openings[kFront] = {rear};
  addRoom(builder, room);
  addWindow(builder, "left window", kRoomSize, kLeft, window, white, 1, 1);
  addWindow(builder, "rear window", kRoomSize, kFront, rear, white, 2, 1);
  const int frame = builder.paint("picture frame", colour(0x4A2F1B), 0.4f);
  addPicture(builder, "landscape", kRoomSize, kBack, {{1.2, 1.15}, {2.5, 2.0}},
             builder.textured("landscape", {512, 256}, landscapePainting(), 0.5f), frame);
  addPicture(builder, "abstract", kRoomSize, kBack, {{3.4, 1.1}, {4.2, 2.1}},
             builder.textured("abstract", {256, 512}, abstractPainting(), 0.5f), frame);
}

void addFurniture(SceneBuilder& builder) {
  builder.place("bookshelf", makeBookshelf(builder, {1.2, 1.8, 0.32}, 5), standAt({2.68, 0.002, -0.6}, -90));
  builder.place("sofa", makeSofa(builder, colour(0x7A3B3B)), standAt({-1.5, 0.002, -1.75}, 12));
  const int chair = builder.addMesh("chair", makeChair(builder));
  builder.place("chair 1", chair, standAt({1.35, 0.002, 0.5}, -75));
  builder.place("chair 2", chair, standAt({-1.4, 0.002, 0.6}, 100));
  builder.place("plant", makePottedPlant(builder, 1.3, 3), standAt({-2.3, 0.002, 1.8}));
}

}  // namespace

Scene makeFourSpheres() {
  SceneBuilder builder("four-spheres");
  builder.addCamera("front", {0.14, 1.44, 1.42}, {0.03, 0.87, 0.0}, 37);
  builder.addCamera("above", {-0.5, 2.1, 1.2}, {0, 0.85, 0}, 45);
  addRoomAround(builder);
  addFurniture(builder);
  addTable(builder);
  addThingsOnTable(builder);
  addSpheres(builder);
  builder.addLamp({-1.6, 2.4, 0.9}, vec3(1.7f, 1.6f, 1.45f));
  builder.addLamp({1.6, 2.3, -0.6}, vec3(0.9f, 0.85f, 0.75f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
