// SPDX-License-Identifier: Apache-2.0
// A television that is switched off (Ofek & Rappoport 1998, figure 17: the linear extrusion of a convex
// planar curve). The screen is straight from top to bottom and bends more and more towards its sides.
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

const dvec3 kRoomSize(4.8, 2.6, 4.8);
const dvec2 kHalf(0.46, 0.34);
constexpr double kCabinet = 0.5;
const dvec3 kCentre(0, kCabinet + 0.46, -1.5);

geometry::HeightSample screenAt(dvec2 p) {
  const double x2 = p.x * p.x;
  return {-0.35 * x2 - 0.9 * x2 * x2, -0.7 * p.x - 3.6 * x2 * p.x, 0};
}

void addTelevision(SceneBuilder& builder) {
  const auto place = [](dvec2 s) { return kHalf * s; };
  builder.place("screen", geometry::makeHeightField(80, 16, place, screenAt),
                builder.mirror("screen glass", vec3(0.80f, 0.83f, 0.86f)), moveBy(kCentre));
  const int shell = builder.paint("television", colour(0x3B3D42), 0.45f),
            black = builder.paint("knob", colour(0x17181A), 0.4f);
  const Piece pieces[] = {
      {transformed(makeFrame(2.0 * kHalf + 0.004, 0.075, 0.15), moveBy({0, 0, -0.13})), shell},
      {transformed(geometry::makeBox({1.05, 0.8, 0.4}), moveBy({0, 0, -0.34})), shell},
      {transformed(geometry::makeBox({0.4, 0.045, 0.3}), moveBy({0, -0.436, -0.3})), black}};
  builder.place("television", pieces, moveBy(kCentre));
}

void addFurniture(SceneBuilder& builder) {
  builder.place("cabinet", geometry::makeBoxMetric({1.7, kCabinet, 0.5}, 0.8), furnitureWood(builder),
                moveBy({0, 0.5 * kCabinet + 0.001, -1.72}));
  builder.place("desk lamp", makeDeskLamp(builder), standAt({-0.7, kCabinet + 0.002, -1.66}));
  builder.place("globe", makeGlobe(builder), standAt({0.7, kCabinet + 0.002, -1.64}, 40));
  builder.place("sofa", makeSofa(builder, colour(0x7A3B3B)), standAt({0.15, 0.002, 1.75}, 180));
  builder.place("low table",
                makeTable(builder, {1.1, 0.42, 0.55},
                          builder.textured("table top", {512, 256},
                                           checker(colour(0xE6DCC4), colour(0x3E5A6B), 8, 4), 0.4f)),
                standAt({0.05, 0.002, -0.55}));
  const double y = 0.4235;
  const vec3 pine = colour(0xE8D3A6);
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0x2F6F9F), 0.25f)),
                standAt({0.2, y, -0.55}, 25, 0.24));
  builder.place("red block", makeToyBlock(builder, 0.16, "ABC", pine, colour(0xB8322A)),
                standAt({-0.3, y, -0.5}, 20));
  builder.place("blue block", makeToyBlock(builder, 0.12, "123", pine, colour(0x2B4FA0)),
                standAt({-0.32, y + 0.161, -0.5}, 50));
  builder.place(
      "ball", geometry::makeUvSphere(0.16, 40, 20),
      builder.textured("ball", {256, 128}, stripes(colour(0xF2C230), colour(0x2E7A45), 1, 6), 0.35f),
      standAt({0.85, 0.162, -0.8}, 25));
  builder.place("traffic cone", makeTrafficCone(builder), standAt({-0.95, 0.002, -0.75}, 15));
  builder.place("plant", makePottedPlant(builder, 1.5, 3), standAt({-1.8, 0.002, 0.9}));
  builder.place("bookshelf", makeBookshelf(builder, {1.2, 1.8, 0.3}, 5), standAt({2.38, 0.002, 0.6}, -90));
  builder.place("chair", makeChair(builder), standAt({-1.2, 0.002, 0.1}, 160));
}

}  // namespace

Scene makeTv() {
  SceneBuilder builder("tv");
  builder.addCamera("front", {0.3, 1.3, 0.75}, {0.0, 0.86, -1.5}, 42);
  builder.addCamera("near", {-0.45, 1.15, -0.55}, {0.0, 0.92, -1.5}, 52);
  BakedLight light;
  light.addBox({0, 0.25, -1.72}, {1.7, 0.5, 0.5});
  light.addBox({0.15, 0.3, 1.75}, {1.6, 0.5, 0.8});
  light.addBox({0.05, 0.4, -0.55}, {1.1, 0.05, 0.55});
  light.addBox({2.22, 0.9, 0.6}, {0.3, 1.8, 1.2});
  light.addBall({0.85, 0.16, -0.8}, 0.16);
  light.addColumn({-0.95, 0, -0.75}, 0.17, 0.03, 0.7);
  light.addColumn({-1.8, 0, 0.9}, 0.3, 0.3, 0.4);
  light.addBox({-1.2, 0.3, 0.1}, {0.45, 0.5, 0.45}, 0.4);
  light.setLamp({0.8, 2.3, 0.6}, 0.4);
  addPictureRoom(builder, kRoomSize, light, {colour(0xC8B7A8), colour(0xC79D6A), colour(0x93673C)});
  addTelevision(builder);
  addFurniture(builder);
  builder.addLamp({-1.3, 2.3, 0.4}, vec3(1.6f, 1.5f, 1.35f));
  builder.addLamp({1.3, 2.3, -0.6}, vec3(1.2f, 1.15f, 1.05f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
