// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in/surroundings.h"

#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"

namespace catoptric::scene::built_in {

void addPictureRoom(SceneBuilder& builder, const dvec3& size, const BakedLight& floorLight,
                    const RoomColours& colours) {
  RoomOptions room;
  room.size = size;
  const dvec2 half(0.5 * size.x, 0.5 * size.z);
  const auto contact = floorLight.bake(-half, half, 0, 160, 144, 0.8, 0.3);
  const auto corners = edgeShade({size.x, size.z}, 0.3, 0.35);
  const Pattern boards = repeated(woodPlanks(colours.floorLight, colours.floorDark, 12, 5), {2, 2});
  room.floor = builder.textured("floor boards", {1024, 1024},
                                shaded(boards, [=](dvec2 uv) { return contact(uv) * corners(uv); }), 0.6f, 1);
  room.walls = builder.textured("wall plaster", {512, 512}, plaster(colours.walls, 0.06, 2), 0.9f, 1);
  room.ceiling = builder.paint("ceiling", colour(0xE9E6DF), 0.95f);
  const int white = room.skirting = builder.paint("white paint", colour(0xECE9E2), 0.5f);
  const double middle = 0.5 * size.z, left = 0.5 * size.x;
  const Opening window{{middle - 0.8, 0.85}, {middle + 0.8, 2.2}}, rear{{left - 0.2, 0.9}, {left + 1.5, 2.2}};
  room.openings[kLeft] = {window};
  room.openings[kFront] = {rear};
  addRoom(builder, room);
  addWindow(builder, "left window", size, kLeft, window, white, 1, 1);
  addWindow(builder, "rear window", size, kFront, rear, white, 2, 1);
  const int frame = builder.paint("picture frame", colour(0x4A2F1B), 0.4f);
  addPicture(builder, "landscape", size, kRight, {{middle - 0.7, 1.1}, {middle + 0.7, 2.0}},
             builder.textured("landscape", {512, 256}, landscapePainting(), 0.5f), frame);
  addPicture(builder, "abstract", size, kFront, {{left - 1.5, 1.0}, {left - 0.7, 2.0}},
             builder.textured("abstract", {256, 512}, abstractPainting(), 0.5f), frame);
}

namespace {

void addParapets(SceneBuilder& builder, double edge) {
  const int brick =
      builder.textured("brick", {512, 512}, bricks(colour(0xA8573B), colour(0xB9AE9C), 4, 8, 12), 0.85f, 2);
  const int stone = builder.paint("coping", colour(0xC9C0AE), 0.8f);
  const dvec3 room(edge, 0.8, edge);
  constexpr const char* kNames[] = {"back parapet", "front parapet", "left parapet", "right parapet"};
  for (const Wall wall : {kBack, kFront, kLeft, kRight}) {
    const dmat4 place = worldFromWall(room, wall);
    builder.placeShell(kNames[wall], makeWall({edge, 0.8}, {}, 1.0), brick, place);
    builder.placeShell(std::string(kNames[wall]) + " coping", geometry::makeBox({edge, 0.07, 0.28}), stone,
                       place * geometry::moveBy({0.5 * edge, 0.836, -0.13}));
  }
}

}  // namespace

void addTerraceWithTrees(SceneBuilder& builder, double edge, const BakedLight& floorLight,
                         const Pattern& floor) {
  const double h = 0.5 * edge;
  const auto light = floorLight.bake(dvec2(-h), dvec2(h), 0, 224, 224, 0.8, 0.4);
  const auto corners = edgeShade(dvec2(edge), 0.2, 0.3);
  const int stone =
      builder.textured("terrace floor", {1024, 1024},
                       shaded(floor, [=](dvec2 uv) { return light(uv) * corners(uv); }), 0.6f, 1);
  builder.placeShell("floor", geometry::makePlane(edge, edge, 2, 2), stone);
  addParapets(builder, edge);
  const int tree = builder.addMesh("tree", makeTree(builder, 4.2, 2, 3));
  const dvec2 places[] = {{-1.55, -1.9}, {1.4, -2.2}, {-2.0, 0.6}, {2.0, 1.1}, {-0.9, 2.2}, {0.8, 2.5}};
  int count = 0;
  for (const dvec2& p : places) {
    builder.place("tree " + std::to_string(count + 1), tree,
                  standAt({h * p.x, -0.2, h * p.y}, 70.0 * count, 0.85 + 0.08 * count));
    ++count;
  }
}

}  // namespace catoptric::scene::built_in
