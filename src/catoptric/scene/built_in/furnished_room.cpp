// SPDX-License-Identifier: Apache-2.0
// A furnished room of about 190,000 polygons with two large flat mirrors (Bastos & Stuerzlinger 1998,
// figure 7; theirs is a music room). The mirrors hang on the back and the left wall, so each also shows the
// other. What makes the number are plants, rings of beads and finely cut teapots and balls.
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/baked_light.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"

namespace catoptric::scene::built_in {
namespace {

const dvec3 kSize(8.0, 3.0, 6.4);
constexpr double kTableHeight = 0.75;

void addShell(SceneBuilder& builder) {
  BakedLight light;
  light.addBox({0.4, kTableHeight - 0.03, -0.3}, {2.2, 0.05, 1.1});
  light.addBox({2.2, 0.3, 1.9}, {1.7, 0.6, 0.8}, -0.5);
  light.addBox({3.7, 0.9, -1.2}, {0.4, 1.8, 1.4});
  const dvec2 half(0.5 * kSize.x, 0.5 * kSize.z);
  const auto contact = light.bake(-half, half, 0, 160, 128, 0.75, 0);
  const auto corners = edgeShade({kSize.x, kSize.z}, 0.3, 0.35);
  const Pattern boards = repeated(woodPlanks(colour(0xB98A58), colour(0x7C5230), 14, 9), {2, 2});
  RoomOptions room;
  room.size = kSize;
  room.floor = builder.textured("parquet", {1024, 1024},
                                shaded(boards, [=](dvec2 uv) { return contact(uv) * corners(uv); }), 0.6f, 1);
  room.walls = builder.textured("green plaster", {512, 512}, plaster(colour(0xBFCBB8), 0.06, 8), 0.9f, 1);
  room.ceiling = builder.paint("ceiling", colour(0xE9E6DF), 0.95f);
  const int white = room.skirting = builder.paint("white paint", colour(0xECE9E2), 0.5f);
  const Opening right{{1.2, 0.85}, {3.0, 2.4}}, left{{3.6, 0.85}, {5.4, 2.4}};
  room.openings[kRight] = {right, left};
  addRoom(builder, room);
  addWindow(builder, "first window", kSize, kRight, right, white, 1, 1);
  addWindow(builder, "second window", kSize, kRight, left, white, 1, 1);
  const int frame = builder.paint("picture frame", colour(0x4A2F1B), 0.4f);
  addPicture(builder, "landscape", kSize, kFront, {{1.4, 1.2}, {3.2, 2.2}},
             builder.textured("landscape", {512, 256}, landscapePainting(), 0.5f), frame);
  addPicture(builder, "abstract", kSize, kFront, {{4.6, 1.0}, {5.5, 2.2}},
             builder.textured("abstract", {256, 512}, abstractPainting(), 0.5f), frame);
}

void addMirror(SceneBuilder& builder, const std::string& name, Wall wall, const dvec2& size, double across) {
  const dvec2 h = 0.5 * size;
  const dmat4 place = worldFromWall(kSize, wall) * geometry::moveBy({across, 1.45, 0.0});
  builder.place(name, geometry::makeQuad({-h.x, -h.y, 0}, {h.x, -h.y, 0}, {h.x, h.y, 0}, {-h.x, h.y, 0}),
                builder.mirror("mirror glass", vec3(0.93f, 0.95f, 0.94f)),
                place * geometry::moveBy({0, 0, 0.012}));
  builder.place(name + " frame", makeFrame(size, 0.07, 0.04), builder.paint("gilt", colour(0xB98F3E), 0.35f),
                place * geometry::moveBy({0, 0, 0.002}));
}

void addFurniture(SceneBuilder& builder) {
  const int wood = furnitureWood(builder);
  builder.place("table", makeTable(builder, {2.2, kTableHeight, 1.1}, wood), standAt({0.4, 0.002, -0.3}));
  const int chair = builder.addMesh("chair", makeChair(builder));
  const dvec3 chairs[] = {
      {-0.2, -1.15, 0}, {1.0, -1.2, 8}, {-0.3, 0.6, 185}, {0.9, 0.62, 172}, {-1.1, -0.2, 95}};
  for (std::size_t i = 0; i < std::size(chairs); ++i)
    builder.place("chair " + std::to_string(i + 1), chair,
                  standAt({chairs[i].x, 0.002, chairs[i].y}, chairs[i].z));
  builder.place("sofa", makeSofa(builder, colour(0x35506B)), standAt({2.2, 0.002, 1.9}, 210));
  builder.place("red sofa", makeSofa(builder, colour(0x8A3B33)), standAt({-2.6, 0.002, 2.4}, 165));
  builder.place("bookshelf", makeBookshelf(builder, {1.4, 2.0, 0.32}, 6), standAt({1.9, 0.002, 3.0}, 180));
}

/// What is finely cut: on the table a tea service, beads in rings, balls; plants along the walls.
void addFineThings(SceneBuilder& builder) {
  const double y = kTableHeight + 0.001;
  const int blue = builder.paint("blue glaze", colour(0x2F6F9F), 0.25f),
            orange = builder.paint("orange glaze", colour(0xC7682A), 0.25f),
            ivory = builder.paint("ivory", colour(0xE8DFC8), 0.4f);
  const int teapot = builder.addMesh("teapot", makeTeapotPieces(blue, 20));
  builder.place("teapot", teapot, standAt({0.1, y, -0.25}, 20, 0.24));
  builder.place("second teapot", teapot, standAt({0.85, y, -0.4}, -60, 0.2));
  const int ball = builder.addMesh("ball", std::vector<Piece>{{geometry::makeIcosphere(0.07, 24), ivory}});
  const int ring =
      builder.addMesh("ring", std::vector<Piece>{{geometry::makeTorus(0.09, 0.028, 96, 48), orange}});
  for (int i = 0; i < 6; ++i) {
    const double x = -0.5 + 0.36 * i;
    builder.place("ball " + std::to_string(i + 1), ball, geometry::moveBy({x, y + 0.07, 0.12}));
    builder.place("ring " + std::to_string(i + 1), ring, geometry::moveBy({x + 0.18, y + 0.028, -0.02}));
  }
  const dvec3 plants[] = {
      {-3.4, -2.6, 1.5}, {3.4, -2.7, 1.8}, {3.5, 0.3, 1.2}, {-3.4, 1.2, 1.1}, {0.2, 2.7, 1.4}};
  const int plant = builder.addMesh("plant", makePottedPlant(builder, 1.0, 11));
  for (std::size_t i = 0; i < std::size(plants); ++i)
    builder.place("plant " + std::to_string(i + 1), plant,
                  standAt({plants[i].x, 0.002, plants[i].y}, 50.0 * double(i), plants[i].z));
}

}  // namespace

Scene makeFurnishedRoom() {
  SceneBuilder builder("furnished-room");
  builder.addCamera("to the back mirror", {1.6, 1.62, 2.1}, {-0.6, 1.25, -3.2}, 58);
  builder.addCamera("to both mirrors", {2.3, 1.65, 1.6}, {-2.6, 1.2, -1.8}, 62);
  const SceneBuilder::Station walk[] = {
      {{2.9, 1.62, 1.3}, {-0.6, 1.25, -3.2}}, {{2.0, 1.62, 2.2}, {-0.8, 1.25, -3.2}},
      {{0.6, 1.65, 2.4}, {-1.2, 1.25, -3.0}}, {{-0.9, 1.65, 1.7}, {-1.6, 1.2, -3.0}},
      {{-1.7, 1.62, 0.9}, {-3.0, 1.2, -2.0}}, {{-1.6, 1.6, 0.1}, {-4.0, 1.3, -0.6}}};
  builder.addWalk("walk", walk, 8.0, 58);
  addShell(builder);
  addMirror(builder, "back mirror", kBack, {3.6, 1.9}, 0.5 * kSize.x);
  addMirror(builder, "left mirror", kLeft, {2.8, 1.9}, 0.5 * kSize.z);
  addFurniture(builder);
  addFineThings(builder);
  builder.addLamp({-1.6, 2.7, 0.9}, vec3(2.4f, 2.3f, 2.1f));
  builder.addLamp({1.8, 2.6, -0.9}, vec3(2.0f, 1.9f, 1.7f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
