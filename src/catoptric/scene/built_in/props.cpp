// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in/props.h"

#include <array>
#include <cmath>

#include "catoptric/geometry/shapes.h"
#include "catoptric/geometry/sweep.h"
#include "catoptric/geometry/teapot.h"
#include "catoptric/scene/built_in/noise.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::append;
using geometry::makeBox;
using geometry::Mesh;
using geometry::moveBy;
using geometry::transformed;
using geometry::turnAround;

Mesh boxAt(const dvec3& centre, const dvec3& size) {
  return transformed(makeBox(size), moveBy(centre));
}

/// A box whose texture repeats every `repeat` metres.
Mesh clothBoxAt(const dvec3& centre, const dvec3& size, double repeat) {
  return transformed(geometry::makeBoxMetric(size, repeat), moveBy(centre));
}

/// A sphere with its surface pushed in and out: leaves from a distance.
Mesh makeLeafBall(double radius, int frequency, std::uint32_t seed) {
  Mesh ball = geometry::makeIcosphere(1.0, frequency);
  for (std::size_t i = 0; i < ball.positions.size(); ++i) {
    const double bump = hashToUnit(int(i), 3, seed);
    ball.positions[i] *= float(radius * (0.82 + 0.32 * bump));
  }
  ball = geometry::withSmoothNormals(ball, 0.9);
  for (std::size_t i = 0; i < ball.positions.size(); ++i) {
    // Darker below, where leaves shade leaves.
    const float light = glm::clamp(0.74f + 0.26f * ball.positions[i].y / float(radius), 0.0f, 1.0f);
    ball.colors.push_back(vec4(vec3(light), 1));
  }
  return ball;
}

int leafPaint(SceneBuilder& builder) {
  return builder.paint("leaves", colour(0x5C8240), 0.8f);
}

}  // namespace

dmat4 standAt(const dvec3& place, double turnDegrees, double scale) {
  return moveBy(place) * turnAround({0, 1, 0}, glm::radians(turnDegrees)) * geometry::scaleBy(dvec3(scale));
}

int furnitureWood(SceneBuilder& builder) {
  return builder.textured("furniture wood", {256, 256}, woodPlanks(colour(0xB98A58), colour(0x7C4F2A), 2, 3),
                          0.5f);
}

std::vector<Piece> makeTeapotPieces(int material, int cellsPerPatch) {
  return {{geometry::makeTeapot({.cellsPerPatch = cellsPerPatch, .withBottom = true}), material}};
}

std::vector<Piece> makeToyBlock(SceneBuilder& builder, double edge, const char symbols[3], const vec3& ground,
                                const vec3& ink) {
  const Mesh box = transformed(makeBox(dvec3(edge)), moveBy({0, 0.5 * edge, 0}));
  std::vector<Piece> pieces;
  for (int axis = 0; axis < 3; ++axis) {
    const char symbol = symbols[axis == 2 ? 0 : axis == 0 ? 1 : 2];
    Mesh faces;
    for (std::size_t t = 0; t < box.indices.size(); t += 6) {  // two triangles to a face
      const vec3 n = box.normals[box.indices[t]];
      if (std::abs(n[axis]) < 0.5f) continue;
      Mesh face = box;
      face.indices.assign(box.indices.begin() + std::ptrdiff_t(t),
                          box.indices.begin() + std::ptrdiff_t(t) + 6);
      const std::uint32_t first = *std::min_element(face.indices.begin(), face.indices.end());
      Mesh quad;
      for (std::uint32_t k = 0; k < 4; ++k) {
        quad.positions.push_back(box.positions[first + k]);
        quad.normals.push_back(box.normals[first + k]);
        quad.uv.push_back(box.uv[first + k]);
      }
      for (std::uint32_t index : face.indices) quad.indices.push_back(index - first);
      append(faces, quad);
    }
    const std::string name = std::string("block ") + symbol;
    pieces.push_back({faces, builder.textured(name, {256, 256}, blockFace(symbol, ground, ink), 0.5f)});
  }
  return pieces;
}

std::vector<Piece> makeDeskLamp(SceneBuilder& builder) {
  const int brass = builder.metal("brass", colour(0xC9A24B), 0.35f);
  const int shade = builder.paint("lamp shade", colour(0xF4E3BC), 0.9f);
  builder.material(shade).emissive = vec3(0.34f, 0.27f, 0.16f);
  builder.material(shade).doubleSided = true;
  const std::array<dvec2, 8> foot = {dvec2(0, 0),        dvec2(0.085, 0),    dvec2(0.085, 0.012),
                                     dvec2(0.05, 0.028), dvec2(0.014, 0.05), dvec2(0.011, 0.18),
                                     dvec2(0.011, 0.33), dvec2(0, 0.33)};
  const std::array<dvec2, 2> cloth = {dvec2(0.15, 0.28), dvec2(0.085, 0.48)};
  return {{geometry::makeLathe(foot, 24), brass}, {geometry::makeLathe(cloth, 32), shade}};
}

std::vector<Piece> makeTrafficCone(SceneBuilder& builder) {
  const vec3 orange = colour(0xF2641A), white = colour(0xF3F1EA);
  const Pattern bands = [=](dvec2 uv) {
    const bool isWhite = (uv.y > 0.2 && uv.y < 0.4) || (uv.y > 0.56 && uv.y < 0.74);
    return (isWhite ? white : orange) * float(0.96 + 0.08 * fractalNoise(uv * 12.0, ivec2(12), 3, 5));
  };
  const int cone = builder.textured("cone bands", {64, 256}, bands, 0.55f, 2);
  const int base = builder.paint("cone foot", colour(0x2B2B2D), 0.7f);
  return {{transformed(geometry::makeCone(0.155, 0.03, 0.68, 32, false), moveBy({0, 0.04, 0})), cone},
          {transformed(geometry::makeDisc(0.03, 0.72, 32, true), dmat4(1.0)), base},
          {boxAt({0, 0.0195, 0}, {0.4, 0.039, 0.4}), base}};
}

std::vector<Piece> makeGlobe(SceneBuilder& builder) {
  const int world = builder.textured("globe", {512, 256}, globe(), 0.45f);
  const int brass = builder.metal("brass", colour(0xC9A24B), 0.35f);
  const std::array<dvec2, 6> foot = {dvec2(0, 0),        dvec2(0.075, 0),    dvec2(0.07, 0.015),
                                     dvec2(0.02, 0.035), dvec2(0.012, 0.09), dvec2(0, 0.09)};
  const dmat4 tilted = moveBy({0, 0.205, 0}) * turnAround({0, 0, 1}, -0.41);
  return {{transformed(geometry::makeUvSphere(0.115, 40, 20), tilted), world},
          {geometry::makeLathe(foot, 24), brass},
          {transformed(geometry::makeTorus(0.128, 0.005, 40, 8), tilted * turnAround({1, 0, 0}, 1.5707963)),
           brass}};
}

std::vector<Piece> makeTable(SceneBuilder& builder, const dvec3& size, int topMaterial) {
  constexpr double kThickness = 0.045, kLeg = 0.07;
  const int wood = furnitureWood(builder);
  const double top = size.y;
  std::vector<Piece> pieces = {
      {transformed(geometry::makePlane(size.x, size.z, 1, 1), moveBy({0, top, 0})), topMaterial}};
  Mesh body = boxAt({0, top - 0.5 * kThickness, 0}, {size.x, kThickness, size.z});
  // The box's own top face lies where the textured one does: leave it out.
  Mesh open = body;
  open.indices.clear();
  for (std::size_t t = 0; t < body.indices.size(); t += 3)
    if (body.normals[body.indices[t]].y < 0.5f)
      open.indices.insert(open.indices.end(), body.indices.begin() + std::ptrdiff_t(t),
                          body.indices.begin() + std::ptrdiff_t(t) + 3);
  pieces.push_back({open, wood});
  const double legHeight = top - kThickness;
  for (double sx : {-1.0, 1.0})
    for (double sz : {-1.0, 1.0})
      pieces.push_back({boxAt({sx * (0.5 * size.x - kLeg), 0.5 * legHeight, sz * (0.5 * size.z - kLeg)},
                              {kLeg, legHeight - 0.002, kLeg}),
                        wood});
  return pieces;
}

std::vector<Piece> makeChair(SceneBuilder& builder) {
  const int wood = furnitureWood(builder);
  Mesh mesh = boxAt({0, 0.45, 0}, {0.42, 0.035, 0.42});
  for (double sx : {-0.18, 0.18}) {
    append(mesh, boxAt({sx, 0.215, 0.18}, {0.04, 0.43, 0.04}));
    append(mesh, boxAt({sx, 0.215, -0.18}, {0.04, 0.43, 0.04}));
    append(mesh, boxAt({sx, 0.69, -0.185}, {0.035, 0.44, 0.03}));
  }
  for (double y : {0.6, 0.72, 0.84}) append(mesh, boxAt({0, y, -0.185}, {0.324, 0.06, 0.02}));
  return {{mesh, wood}};
}

std::vector<Piece> makeBookshelf(SceneBuilder& builder, const dvec3& size, int boards) {
  constexpr double kBoard = 0.025;
  const int wood = furnitureWood(builder);
  Mesh frame;
  const double inside = size.x - 2 * kBoard, gap = (size.y - kBoard) / boards;
  append(frame, boxAt({-0.5 * (size.x - kBoard), 0.5 * size.y, 0.5 * size.z}, {kBoard, size.y, size.z}));
  append(frame, boxAt({0.5 * (size.x - kBoard), 0.5 * size.y, 0.5 * size.z}, {kBoard, size.y, size.z}));
  append(frame, boxAt({0, 0.5 * size.y, 0.006}, {inside - 0.001, size.y - 0.001, 0.01}));
  for (int i = 0; i <= boards; ++i)
    append(frame, boxAt({0, i * gap + 0.5 * kBoard, 0.5 * size.z + 0.006},
                        {inside - 0.001, kBoard, size.z - 0.012}));
  std::vector<Piece> pieces = {{frame, wood}};
  const std::array<std::uint32_t, 6> covers = {0x8C2F2B, 0x2C4E78, 0x3F6B45, 0xC79B3B, 0x5B3A6B, 0xD9CDB4};
  for (int shelf = 0; shelf < boards; ++shelf) {
    double x = -0.5 * inside + 0.01;
    for (int book = 0; x < 0.5 * inside - 0.08; ++book) {
      const double width = 0.022 + 0.03 * hashToUnit(book, shelf, 5),
                   height = gap * (0.62 + 0.25 * hashToUnit(book, shelf, 6));
      const auto pick = std::size_t(hashToUnit(book, shelf, 7) * covers.size());
      const bool isGap = hashToUnit(book, shelf, 8) > 0.9;
      if (!isGap)
        pieces.push_back({boxAt({x + 0.5 * width, shelf * gap + kBoard + 0.5 * height + 0.0005, 0.5 * size.z},
                                {width - 0.002, height, size.z * 0.75}),
                          builder.paint("book " + std::to_string(pick), colour(covers[pick]), 0.7f)});
      x += width + (isGap ? 0.05 : 0);
    }
  }
  return pieces;
}

std::vector<Piece> makeStripedPole(SceneBuilder& builder, double height, double radius) {
  const int bands =
      builder.textured("pole stripes", {64, 256}, stripes(colour(0xC8261F), colour(0xF2EFE8), 5, 0), 0.5f, 2);
  const int foot = builder.paint("pole foot", colour(0x39393C), 0.7f);
  return {{transformed(geometry::makeCylinderSide(radius, height, 24, 1, true),
                       moveBy({0, 0.5 * height + 0.03, 0})),
           bands},
          {geometry::makeDisc(radius, height + 0.03, 24, true), foot},
          {transformed(geometry::makeCylinder(3 * radius, 0.03, 24), moveBy({0, 0.0151, 0})), foot}};
}

std::vector<Piece> makePottedPlant(SceneBuilder& builder, double height, std::uint32_t seed) {
  const int clay = builder.paint("clay", colour(0xB5623A), 0.8f),
            earth = builder.paint("earth", colour(0x3B2A1E), 1.0f);
  const int wood = builder.paint("stem", colour(0x6B4A2E), 0.9f);
  const double pot = 0.28 * height;
  const std::array<dvec2, 5> profile = {dvec2(0, 0.002), dvec2(0.55 * pot, 0.002),
                                        dvec2(0.72 * pot, 0.9 * pot), dvec2(0.8 * pot, 0.9 * pot),
                                        dvec2(0.8 * pot, pot)};
  std::vector<Piece> pieces = {
      {geometry::makeLathe(profile, 24), clay},
      {geometry::makeDisc(0.8 * pot, pot, 24, true), earth},
      {geometry::makeRod({0, pot, 0}, {0, 0.75 * height, 0}, 0.02 * height, 8), wood}};
  for (int i = 0; i < 7; ++i) {
    const double angle = 2.4 * i, out = 0.14 * height * std::sqrt(i / 6.0);
    const dvec3 centre(out * std::sin(angle), height * (0.62 + 0.2 * hashToUnit(i, 1, seed)),
                       out * std::cos(angle));
    pieces.push_back({transformed(makeLeafBall(0.17 * height, 4, seed + std::uint32_t(i)), moveBy(centre)),
                      leafPaint(builder)});
  }
  return pieces;
}

std::vector<Piece> makeTree(SceneBuilder& builder, double height, std::uint32_t seed, int detail) {
  const int bark = builder.paint("bark", colour(0x5E4A38), 0.95f);
  std::vector<Piece> pieces = {
      {geometry::makeCone(0.045 * height, 0.025 * height, 0.55 * height, 12, false), bark}};
  for (int i = 0; i < 6; ++i) {
    const double angle = 2.4 * i + double(seed), out = 0.16 * height * std::sqrt(i / 5.0);
    const double level = height * (0.58 + 0.24 * hashToUnit(i, 2, seed));
    const double radius = height * (0.17 + 0.07 * hashToUnit(i, 4, seed));
    pieces.push_back({transformed(makeLeafBall(radius, detail, seed + std::uint32_t(i)),
                                  moveBy({out * std::sin(angle), level, out * std::cos(angle)})),
                      leafPaint(builder)});
  }
  return pieces;
}

std::vector<Piece> makeSofa(SceneBuilder& builder, const vec3& cloth) {
  const int fabric =
      builder.textured("sofa cloth", {256, 256}, speckle(cloth * 0.75f, cloth * 1.1f, 64, 9), 0.9f);
  const int foot = builder.paint("sofa foot", colour(0x2A211A), 0.6f);
  Mesh body = clothBoxAt({0, 0.24, 0.02}, {1.36, 0.24, 0.72}, 0.4);
  append(body, clothBoxAt({0, 0.44, -0.36}, {1.68, 0.64, 0.16}, 0.4));
  for (double side : {-1.0, 1.0})
    append(body, clothBoxAt({side * 0.76, 0.36, 0.05}, {0.155, 0.48, 0.655}, 0.4));
  for (double side : {-0.335, 0.335}) append(body, clothBoxAt({side, 0.421, 0.06}, {0.64, 0.12, 0.63}, 0.4));
  std::vector<Piece> pieces = {{body, fabric}};
  for (double sx : {-0.6, 0.6})
    for (double sz : {-0.25, 0.3}) pieces.push_back({boxAt({sx, 0.06, sz}, {0.05, 0.118, 0.05}), foot});
  return pieces;
}

}  // namespace catoptric::scene::built_in
