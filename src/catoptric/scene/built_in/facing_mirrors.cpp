// SPDX-License-Identifier: Apache-2.0
// Two curved mirrors that face each other, and between them a toy block that moves: reflections of higher
// order (Martin & Popescu 2004, section 9), of something that no preprocessing can know.
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

const dvec3 kRoomSize(4.8, 2.6, 4.6);
const dvec2 kHalf(1.15, 0.75);                 // of a mirror: metres along the wall and up
constexpr double kAcross = 3.2, kUp = 4.5;     // radii of curvature, metres
constexpr double kApart = 1.9, kHeight = 1.2;  // the mirrors' middles

void addMirrors(SceneBuilder& builder) {
  const auto bulge = [](dvec2 p) {
    return geometry::HeightSample{-0.5 * (p.x * p.x / kAcross + p.y * p.y / kUp), -p.x / kAcross, -p.y / kUp};
  };
  const geometry::Mesh sheet = geometry::makeHeightField(
      92, 60, [](dvec2 s) { return kHalf * s; }, bulge);
  const int chrome = builder.mirror("chrome", vec3(0.93f, 0.94f, 0.95f));
  for (const double side : {-1.0, 1.0}) {
    const dmat4 worldFromSheet = geometry::moveBy({0.5 * side * kApart, kHeight, 0}) *
                                 geometry::turnAround({0, 1, 0}, -side * 0.5 * glm::pi<double>());
    const std::string name = side < 0 ? "left mirror" : "right mirror";
    builder.place(name, sheet, chrome, worldFromSheet);
    const auto back = [=](dvec2 p) {
      geometry::HeightSample at = bulge(p);
      at.z -= 0.02;
      return at;
    };
    builder.place(name + " back",
                  geometry::makeHeightField(
                      24, 16, [](dvec2 s) { return 1.03 * kHalf * s; }, back),
                  builder.paint("dark wood", colour(0x3A2A20), 0.6f), worldFromSheet);
  }
}

void addThings(SceneBuilder& builder) {
  builder.place("table", makeTable(builder, {0.7, 0.72, 1.2}, furnitureWood(builder)),
                standAt({0, 0.002, -0.2}));
  const double y = 0.7235;
  const vec3 pine = colour(0xE8D3A6);
  Instance& block = builder.place("moving block", makeToyBlock(builder, 0.2, "ABC", pine, colour(0xB8322A)),
                                  standAt({-0.18, y, 0.2}, 30));
  const float times[] = {0, 1, 2};
  const vec3 places[] = {
      {-0.18f, float(y), 0.2f}, {0.16f, float(y + 0.25), -0.15f}, {-0.1f, float(y), -0.55f}};
  builder.moveAlong(block, times, places, 30);
  builder.place("globe", makeGlobe(builder), standAt({0.2, y, -0.5}, 40));
  builder.place("pole", makeStripedPole(builder, 1.9, 0.03), standAt({0.1, 0.002, -1.1}));
  builder.place("sofa", makeSofa(builder, colour(0x6B2F3A)), standAt({0.0, 0.002, 1.95}, 180));
  builder.place("plant", makePottedPlant(builder, 1.6, 3), standAt({-0.1, 0.002, -1.7}));
}

}  // namespace

Scene makeFacingMirrors() {
  SceneBuilder builder("facing-mirrors");
  builder.addCamera("between", {0.5, 1.45, 1.95}, {-0.42, 1.1, -0.1}, 54);
  BakedLight light;
  light.addBox({0, 0.7, -0.2}, {0.7, 0.05, 1.2});
  light.addBox({0.0, 0.3, 1.95}, {1.6, 0.5, 0.8});
  light.addColumn({-0.1, 0, -1.7}, 0.3, 0.3, 0.4);
  light.addColumn({0.1, 0, -1.1}, 0.05, 0.03, 1.9);
  light.setLamp({0.8, 2.3, 0.6}, 0.4);
  addPictureRoom(builder, kRoomSize, light, {colour(0xB9C4B0), colour(0xB98A58), colour(0x7C4F2A)});
  addMirrors(builder);
  addThings(builder);
  builder.addLamp({-0.3, 2.4, 0.8}, vec3(1.7f, 1.6f, 1.4f));
  builder.addLamp({0.3, 2.4, -0.9}, vec3(1.3f, 1.25f, 1.15f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
