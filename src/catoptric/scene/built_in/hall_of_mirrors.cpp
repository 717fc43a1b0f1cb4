// SPDX-License-Identifier: Apache-2.0
// A hall with large planar mirrors that face each other (recursive reflections, Ofek & Rappoport 1998, figure
// 18). The mirrors are thin, a little off the walls, and slightly green, so that each further image is
// darker.
#include "catoptric/geometry/shapes.h"
#include "catoptric/geometry/sweep.h"
#include "catoptric/scene/built_in/baked_light.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

const dvec3 kHall(4.4, 3.0, 8.0);
const dvec2 kMirrorSize(5.6, 2.05);
const dvec3 kStatue(-0.75, 0, -1.2);

void addShell(SceneBuilder& builder) {
  BakedLight light;
  light.addBox(kStatue + dvec3(0, 0.5, 0), {0.5, 1.0, 0.5});
  light.addBox({1.2, 0.22, -2.6}, {1.1, 0.44, 0.5});
  for (double z : {-3.55, 3.55})
    for (double x : {-1.75, 1.75}) light.addColumn({x, 0, z}, 0.2, 0.16, 2.9);
  light.addBox({0.95, 0.25, 0.6}, {0.55, 0.5, 0.55}, 0.5);
  light.setLamp({0, 3.6, -0.4}, 1.0);
  const dvec2 half(0.5 * kHall.x, 0.5 * kHall.z);
  const auto baked = light.bake(-half, half, 0, 160, 288, 0.85, 0.35);
  const auto corners = edgeShade({kHall.x, kHall.z}, 0.3, 0.35);
  const Pattern marble = repeated(checker(colour(0xE4DCCB), colour(0x33373D), 4, 8, 0.2), {2, 2});
  const Pattern carpet = rug(colour(0x8C1F28), colour(0xD8B25C), colour(0x3A1418));
  const Pattern floor = [=](dvec2 uv) {
    const dvec2 p = (uv - 0.5) * dvec2(kHall.x, kHall.z);
    return std::abs(p.x) < 0.65 && std::abs(p.y) < 3.3 ? carpet({(p.x + 0.65) / 1.3, (p.y + 3.3) / 6.6})
                                                       : marble(uv);
  };
  RoomOptions room;
  room.size = kHall;
  room.floor = builder.textured("marble floor", {1024, 2048},
                                shaded(floor, [=](dvec2 uv) { return baked(uv) * corners(uv); }), 0.5f, 1);
  room.walls = builder.textured("hall walls", {512, 512}, plaster(colour(0xC9B58F), 0.07, 6), 0.85f, 1);
  room.ceiling = builder.paint("ceiling", colour(0xE6E1D6), 0.95f);
  room.skirting = builder.paint("white paint", colour(0xECE9E2), 0.5f);
  room.skirtingHeight = 0.16;
  const Opening window{{1.45, 0.9}, {2.95, 2.55}};
  room.openings[kFront] = {window};
  addRoom(builder, room);
  addWindow(builder, "window", kHall, kFront, window, room.skirting, 1, 2);
}

void addMirrors(SceneBuilder& builder) {
  const int glass = builder.mirror("mirror glass", vec3(0.90f, 0.94f, 0.915f)),
            gilt = builder.paint("gilt", colour(0xB98F3E), 0.35f);
  const dvec2 h = 0.5 * kMirrorSize;
  const geometry::Mesh quad =
      geometry::makeQuad({-h.x, -h.y, 0}, {h.x, -h.y, 0}, {h.x, h.y, 0}, {-h.x, h.y, 0});
  const geometry::Mesh frame = makeFrame(kMirrorSize, 0.09, 0.06);
  for (const Wall wall : {kLeft, kRight}) {
    const std::string side = wall == kLeft ? "left" : "right";
    const dmat4 place = worldFromWall(kHall, wall) * moveBy({0.5 * kHall.z, 1.36, 0.0});
    builder.place(side + " mirror", quad, glass, place * moveBy({0, 0, 0.02}));
    builder.place(side + " mirror frame", frame, gilt, place * moveBy({0, 0, 0.003}));
  }
}

void addColumns(SceneBuilder& builder) {
  const std::vector<dvec2> profile = {{0, 0.001},    {0.22, 0.001}, {0.22, 0.1}, {0.18, 0.13}, {0.2, 0.17},
                                      {0.165, 0.22}, {0.16, 1.2},   {0.14, 2.6}, {0.16, 2.63}, {0.15, 2.68},
                                      {0.21, 2.8},   {0.21, 2.999}, {0, 2.999}};
  const Piece pieces[] = {
      {geometry::makeLathe(profile, 32, 0.5),
       builder.textured("column stone", {256, 256}, plaster(colour(0xD6CBB4), 0.12, 31), 0.6f, 1)}};
  const int column = builder.addMesh("column", pieces);
  int count = 0;
  for (double z : {-3.55, 3.55})
    for (double x : {-1.75, 1.75})
      builder.place("column " + std::to_string(++count), column, standAt({x, 0, z}));
}

void addFurniture(SceneBuilder& builder) {
  const double y = 0.002;
  const int stone =
      builder.textured("plinth stone", {256, 256}, plaster(colour(0x8E9AA0), 0.14, 17), 0.6f, 1);
  const dvec3 s = kStatue;
  builder.place("plinth", geometry::makeBox({0.46, 0.94, 0.46}), stone, moveBy(s + dvec3(0, 0.47 + y, 0)));
  builder.place("plinth cap", geometry::makeBox({0.54, 0.05, 0.54}), stone,
                moveBy(s + dvec3(0, 0.967 + y, 0)));
  builder.place("teapot statue", makeTeapotPieces(builder.paint("copper glaze", colour(0xB5562B), 0.25f), 8),
                standAt(s + dvec3(0, 0.994, 0), 35, 0.44));
  const int cloth =
      builder.textured("bench cloth", {256, 256}, speckle(colour(0x2A4A6E), colour(0x3E6693), 64, 9), 0.9f);
  const int wood = furnitureWood(builder);
  std::vector<Piece> bench = {
      {geometry::transformed(geometry::makeBoxMetric({1.1, 0.1, 0.46}, 0.4), moveBy({0, 0.42, 0})), cloth}};
  for (double x : {-0.48, 0.48})
    for (double z : {-0.17, 0.17})
      bench.push_back(
          {geometry::transformed(geometry::makeBox({0.06, 0.367, 0.06}), moveBy({x, 0.185, z})), wood});
  builder.place("bench", bench, standAt({1.2, 0.001, -2.6}, -8));
  const vec3 pine = colour(0xE8D3A6);
  builder.place("large block", makeToyBlock(builder, 0.5, "ABC", pine, colour(0xB8322A)),
                standAt({0.95, y, 0.6}, 29));
  builder.place("small block", makeToyBlock(builder, 0.26, "123", pine, colour(0x2B4FA0)),
                standAt({0.92, 0.503, 0.62}, 55));
  builder.place("plant", makePottedPlant(builder, 1.4, 4), standAt({1.35, y, -3.2}));
  builder.place("chair", makeChair(builder), standAt({-1.3, y, 1.3}, 75));
  const int frame = builder.paint("picture frame", colour(0x3A281A), 0.4f);
  addPicture(builder, "landscape", kHall, kBack, {{1.35, 1.1}, {3.05, 2.2}},
             builder.textured("landscape", {512, 256}, landscapePainting(), 0.5f), frame);
}

/// Globes on rods that hang from the ceiling, where the point lights are.
void addLamps(SceneBuilder& builder) {
  const int opal = builder.glow("lamp opal", vec3(0.95f, 0.88f, 0.72f)),
            brass = builder.metal("brass", colour(0xC9A24B), 0.35f);
  const Piece pieces[] = {{geometry::makeIcosphere(0.14, 8), opal},
                          {geometry::makeRod({0, 0.13, 0}, {0, 0.48, 0}, 0.012, 10), brass}};
  const int lamp = builder.addMesh("lamp", pieces);
  int count = 0;
  for (double z : {-2.2, 0.0, 2.2}) {
    builder.place("lamp " + std::to_string(++count), lamp, moveBy({0, 2.5, z}));
    builder.addLamp({0, 2.3, z}, vec3(1.0f, 0.92f, 0.76f));
  }
}

}  // namespace

Scene makeHallOfMirrors() {
  SceneBuilder builder("hall-of-mirrors");
  builder.addCamera("visitor", {1.2, 1.6, 2.7}, {-1.55, 1.2, -0.5}, 62);
  builder.addCamera("along", {0.0, 1.6, 3.6}, {0.0, 1.3, -1.0}, 65);
  addShell(builder);
  addMirrors(builder);
  addColumns(builder);
  addFurniture(builder);
  addLamps(builder);
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
