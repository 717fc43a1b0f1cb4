// SPDX-License-Identifier: Apache-2.0
// A chrome teapot on a table (Martin & Popescu 2004, figure 8): a hybrid reflector. Its body is to be
// morphed; spout, handle and lid, small and turned all ways, are marked to be drawn by environment maps. So
// are the narrow rim and the foot, where the profile turns hollow: what is morphed shows each point once.
#include "catoptric/geometry/teapot.h"

#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::TeapotPart;

const dvec3 kRoomSize(4.8, 2.6, 4.6);
constexpr double kTable = 0.76, kHeight = 0.42;

/// The triangles of the mesh whose middle lies between two heights.
geometry::Mesh cutOut(const geometry::Mesh& mesh, float lower, float upper) {
  constexpr std::uint32_t kDropped = ~0u;
  geometry::Mesh cut;
  std::vector<std::uint32_t> numberOf(mesh.positions.size(), kDropped);
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    float height = 0;
    for (std::size_t k = 0; k < 3; ++k) height += mesh.positions[mesh.indices[t + k]].y / 3;
    if (!(height >= lower && height < upper)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.indices[t + k];
      if (numberOf[v] == kDropped) {
        numberOf[v] = std::uint32_t(cut.positions.size());
        cut.positions.push_back(mesh.positions[v]);
        cut.normals.push_back(mesh.normals[v]);
        if (!mesh.uv.empty()) cut.uv.push_back(mesh.uv[v]);
      }
      cut.indices.push_back(numberOf[v]);
    }
  }
  return cut;
}

void addTeapot(SceneBuilder& builder) {
  const int chrome = builder.mirror("chrome", vec3(0.94f));
  constexpr float kFoot = 0.083f, kRim = 0.76f;  // where the body turns hollow, and where the lip begins
  const struct {
    const char* name;
    TeapotPart part;
    float lower, upper;
    bool isMorphed;
  } parts[] = {{"teapot body", TeapotPart::Body, kFoot, kRim, true},
               {"teapot foot", TeapotPart::Body, -1, kFoot, false},
               {"teapot rim", TeapotPart::Body, kRim, 2, false},
               {"teapot handle", TeapotPart::Handle, -1, 2, false},
               {"teapot spout", TeapotPart::Spout, -1, 2, false},
               {"teapot lid", TeapotPart::Lid, -1, 2, false}};
  for (const auto& p : parts) {
    const geometry::Mesh whole =
        geometry::makeTeapot({.cellsPerPatch = p.isMorphed ? 40 : 14, .part = p.part});
    Instance& instance = builder.place(p.name, cutOut(whole, p.lower, p.upper), chrome,
                                       standAt({0, kTable + 0.002, 0}, -20, kHeight));
    if (!p.isMorphed) instance.hint.morphed = false;
  }
}

void addThings(SceneBuilder& builder) {
  builder.place("table", makeTable(builder, {2.0, kTable, 1.1}, furnitureWood(builder)),
                standAt({0, 0.002, 0.1}));
  const double y = kTable + 0.003;
  const vec3 pine = colour(0xE8D3A6);
  builder.place("block 1", makeToyBlock(builder, 0.13, "ABC", pine, colour(0xB8322A)),
                standAt({-0.3, y, 0.43}, 25));
  builder.place("block 2", makeToyBlock(builder, 0.1, "DEF", pine, colour(0x2B4FA0)),
                standAt({0.34, y, 0.48}, -30));
  builder.place("globe", makeGlobe(builder), standAt({-0.66, y, 0.16}, 40, 0.9));
  builder.place("red cup", geometry::makeCylinderSide(0.045, 0.11, 40, 6, true),
                builder.paint("red glaze", colour(0xB7352B), 0.3f),
                geometry::moveBy({0.07, y + 0.055, 0.55}));
  builder.place("sofa", makeSofa(builder, colour(0x2F4F6B)), standAt({0.4, 0.002, 1.9}, 180));
  builder.place("plant", makePottedPlant(builder, 1.5, 5), standAt({-1.8, 0.002, 1.2}));
  builder.place("chair", makeChair(builder), standAt({1.6, 0.002, 0.9}, -120));
}

}  // namespace

Scene makeTeapotScene() {
  SceneBuilder builder("teapot");
  builder.addCamera("front", {0.18, 1.25, 1.35}, {0.0, 0.93, 0.0}, 38);
  BakedLight light;
  light.addBox({0, 0.74, 0.1}, {2.0, 0.05, 1.1});
  light.addBox({0.4, 0.3, 1.9}, {1.6, 0.5, 0.8});
  light.addColumn({-1.8, 0, 1.2}, 0.3, 0.3, 0.4);
  light.addBox({1.6, 0.3, 0.9}, {0.45, 0.5, 0.45}, 0.5);
  light.setLamp({0.8, 2.3, 0.6}, 0.4);
  addPictureRoom(builder, kRoomSize, light, {colour(0xCFC3A9), colour(0xB98A58), colour(0x7C4F2A)});
  addTeapot(builder);
  addThings(builder);
  builder.addLamp({-1.3, 2.3, 0.8}, vec3(1.6f, 1.5f, 1.35f));
  builder.addLamp({1.3, 2.3, -0.6}, vec3(1.2f, 1.15f, 1.05f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
