// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in/vehicles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "catoptric/geometry/convex_edges.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/geometry/sweep.h"
#include "catoptric/scene/built_in/noise.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::append;
using geometry::Mesh;
using geometry::moveBy;
using geometry::transformed;
using geometry::turnAround;

constexpr double kQuarterTurn = 1.5707963267948966;

Mesh boxAt(const dvec3& centre, const dvec3& size) {
  return transformed(geometry::makeBox(size), moveBy(centre));
}

/// From a side view (x to the front, y up, extruded along z) to a vehicle that drives to -z.
dmat4 vehicleFromSideView() {
  return turnAround({0, 1, 0}, kQuarterTurn);
}

struct VehiclePaints {
  int glass, rubber, rim, tail, head, plate;
};

VehiclePaints vehiclePaints(SceneBuilder& builder) {
  return {builder.paint("window glass", colour(0x20282E), 0.12f),
          builder.paint("rubber", colour(0x1C1C1E), 0.85f),
          builder.metal("wheel rim", colour(0xB4B8BC), 0.35f),
          builder.glow("tail light", vec3(0.75f, 0.03f, 0.02f)),
          builder.glow("head light", vec3(1.0f, 0.97f, 0.88f)),
          builder.paint("number plate", colour(0xE8E6DE), 0.6f)};
}

void addWheels(std::vector<Piece>& pieces, const VehiclePaints& paints, double radius, double halfTrack,
               std::span<const double> axles) {
  const Mesh tyre =
      transformed(geometry::makeCylinder(radius, 0.22, 18), turnAround({0, 0, 1}, kQuarterTurn));
  for (double z : axles)
    for (double side : {-1.0, 1.0}) {
      const dmat4 place = moveBy({side * (halfTrack - 0.11), radius + 0.002, z});
      pieces.push_back({transformed(tyre, place), paints.rubber});
      const Mesh hub = transformed(geometry::makeDisc(0.6 * radius, 0.112, 14, true),
                                   turnAround({0, 0, 1}, -side * kQuarterTurn));
      pieces.push_back({transformed(hub, place), paints.rim});
    }
}

/// Ring of a horizontal rectangle, counter-clockwise seen from above: z from `front` (smaller) to `rear`.
std::vector<dvec3> levelRing(double front, double rear, double halfWidth, double y) {
  return {{-halfWidth, y, rear}, {halfWidth, y, rear}, {halfWidth, y, front}, {-halfWidth, y, front}};
}

Mesh capOf(const std::vector<dvec3>& ring) {
  return geometry::makeQuad(ring[0], ring[1], ring[2], ring[3]);
}

/// From the square [-1, 1]^2 to the outline of mirrors: a rectangle whose sides bulge and whose corners are
/// blunt.
dvec2 bulge(const dvec2& s) {
  constexpr double kRoundness = 0.56;  // 0: the square, 1: a circle
  return {s.x * std::sqrt(1 - 0.5 * kRoundness * s.y * s.y),
          s.y * std::sqrt(1 - 0.5 * kRoundness * s.x * s.x)};
}

/// The outline at height z, counter-clockwise.
std::vector<dvec3> outlineRing(double width, double height, double z) {
  constexpr int kSteps = 12;  // to a side
  std::vector<dvec3> ring;
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < kSteps; ++i) {
      const double t = 2.0 * i / kSteps - 1;
      const dvec2 square = side == 0   ? dvec2(1, t)
                           : side == 1 ? dvec2(-t, 1)
                           : side == 2 ? dvec2(-1, -t)
                                       : dvec2(t, -1);
      ring.emplace_back(0.5 * dvec2(width, height) * bulge(square), z);
    }
  return ring;
}

}  // namespace

std::vector<Piece> makeCar(SceneBuilder& builder, const std::string& paintName, const vec3& paintColour) {
  const VehiclePaints paints = vehiclePaints(builder);
  const int paint = builder.paint(paintName, paintColour, 0.25f);
  const std::array<dvec2, 11> side = {dvec2(-2.08, 0.26), dvec2(2.06, 0.26),  dvec2(2.15, 0.40),
                                      dvec2(2.16, 0.58),  dvec2(2.05, 0.71),  dvec2(1.55, 0.82),
                                      dvec2(0.95, 0.87),  dvec2(-1.60, 0.92), dvec2(-2.08, 0.88),
                                      dvec2(-2.16, 0.62), dvec2(-2.15, 0.38)};
  std::vector<Piece> pieces = {
      {transformed(geometry::makeExtrusion(side, 1.68, 0.7), vehicleFromSideView()), paint}};
  const std::vector<dvec3> belt = levelRing(-1.08, 1.78, 0.79, 0.86), top = levelRing(-0.28, 1.12, 0.6, 1.36);
  const std::vector<dvec3> roofLow = levelRing(-0.33, 1.17, 0.615, 1.355),
                           roofHigh = levelRing(-0.2, 1.02, 0.54, 1.42);
  pieces.push_back({geometry::makeLoft(std::array{belt, top}, 0.1), paints.glass});
  Mesh roof = geometry::makeLoft(std::array{roofLow, roofHigh}, 0.1);
  append(roof, capOf(roofHigh));
  pieces.push_back({roof, paint});
  for (double x : {-0.62, 0.62}) {
    pieces.push_back({boxAt({x, 0.73, 2.125}, {0.34, 0.12, 0.06}), paints.tail});
    pieces.push_back({boxAt({x, 0.6, -2.135}, {0.32, 0.11, 0.07}), paints.head});
  }
  pieces.push_back({boxAt({0, 0.6, 2.16}, {0.5, 0.11, 0.03}), paints.plate});
  pieces.push_back({boxAt({0, 0.44, -2.165}, {0.5, 0.1, 0.03}), paints.plate});
  pieces.push_back({boxAt({0, 0.36, 2.14}, {1.5, 0.1, 0.08}), paints.rubber});
  pieces.push_back({boxAt({0, 0.58, -2.15}, {0.72, 0.1, 0.05}), paints.rubber});
  addWheels(pieces, paints, 0.31, 0.865, std::array{-1.32, 1.3});
  return pieces;
}

std::vector<Piece> makeTruck(SceneBuilder& builder, const std::string& paintName, const vec3& paintColour) {
  const VehiclePaints paints = vehiclePaints(builder);
  const int paint = builder.paint(paintName, paintColour, 0.3f),
            box = builder.paint("truck box", colour(0xE3E1DA), 0.5f);
  const std::array<dvec2, 7> cab = {dvec2(2.2, 0.45),  dvec2(4.0, 0.45), dvec2(4.06, 0.9), dvec2(4.02, 1.5),
                                    dvec2(3.72, 2.55), dvec2(3.5, 2.68), dvec2(2.2, 2.68)};
  std::vector<Piece> pieces = {
      {transformed(geometry::makeExtrusion(cab, 2.3, 0.5), vehicleFromSideView()), paint}};
  pieces.push_back({boxAt({0, 2.05, 1.02}, {2.45, 2.6, 5.9}), box});
  pieces.push_back({boxAt({0, 0.62, 0.9}, {1.0, 0.24, 6.0}), paints.rubber});
  // Windscreen a little in front of the cab's slanted face, side windows beside it.
  pieces.push_back({geometry::makeQuad({1.02, 1.56, -4.015}, {-1.02, 1.56, -4.015}, {-1.02, 2.4, -3.775},
                                       {1.02, 2.4, -3.775}),
                    paints.glass});
  pieces.push_back({boxAt({0, 1.95, -3.2}, {2.32, 0.7, 0.75}), paints.glass});
  for (double x : {-0.85, 0.85}) {
    pieces.push_back({boxAt({x, 0.72, -4.04}, {0.36, 0.18, 0.08}), paints.head});
    pieces.push_back({boxAt({x, 0.66, 3.96}, {0.3, 0.16, 0.06}), paints.tail});
  }
  pieces.push_back({boxAt({0, 1.18, -4.05}, {1.5, 0.34, 0.05}), paints.rubber});
  pieces.push_back({boxAt({0, 2.05, 0.6}, {2.47, 0.5, 3.6}), paint});  // stripe along the box
  addWheels(pieces, paints, 0.48, 1.16, std::array{-3.0, 2.0, 3.1});
  return pieces;
}

std::vector<Piece> makeHouse(SceneBuilder& builder, const dvec3& size, const std::string& wallName,
                             const vec3& wall) {
  const vec3 glass = colour(0x33434F), trim = colour(0xF0EDE4), door = colour(0x6B3F2A);
  const Pattern facade = [=](dvec2 uv) {
    const double grain = fractalNoise(uv * 8.0, ivec2(8), 4, 6);
    const dvec2 cell(uv.x * 4 - std::floor(uv.x * 4), uv.y * 2 - std::floor(uv.y * 2));
    const dvec2 p = glm::abs(cell - dvec2(0.5, 0.45));
    const bool isDoor = uv.y > 0.5 && uv.x > 0.25 && uv.x < 0.5;
    if (isDoor && p.x < 0.2 && cell.y > 0.22) return p.x < 0.16 && cell.y > 0.28 ? door : trim;
    if (!isDoor && p.x < 0.25 && p.y < 0.26) return p.x < 0.21 && p.y < 0.22 && p.x > 0.015 ? glass : trim;
    return wall * float(0.9 + 0.2 * grain);
  };
  const int front = builder.textured(wallName, {256, 256}, facade, 0.9f);
  const int roof = builder.textured("roof tiles", {256, 256},
                                    bricks(colour(0x8A4632), colour(0x5A2F24), 8, 16, 21), 0.85f);
  const double eaves = size.y, ridge = size.y + 0.45 * size.z, halfZ = 0.5 * size.z, over = 0.4;
  Mesh body = boxAt({0, 0.5 * eaves + 0.01, 0}, {size.x, eaves, size.z});
  for (double sx : {-1.0, 1.0}) {  // gables
    const dvec3 a(sx * 0.5 * size.x, eaves, sx * halfZ), b(sx * 0.5 * size.x, eaves, -sx * halfZ),
        c(sx * 0.5 * size.x, ridge, 0);
    Mesh gable;
    gable.positions = {vec3(a), vec3(b), vec3(c)};
    gable.normals.assign(3, vec3(float(sx), 0, 0));
    gable.uv = {{0.02f, 0.04f}, {0.1f, 0.04f}, {0.06f, 0.01f}};
    gable.indices = {0, 1, 2};
    append(body, gable);
  }
  const double slope = (ridge - eaves) / halfZ, low = eaves - slope * over, outX = 0.5 * size.x + over;
  Mesh slopes = geometry::makeQuad({-outX, low, halfZ + over}, {outX, low, halfZ + over},
                                   {outX, ridge + 0.05, 0}, {-outX, ridge + 0.05, 0});
  append(slopes, geometry::makeQuad({outX, low, -halfZ - over}, {-outX, low, -halfZ - over},
                                    {-outX, ridge + 0.05, 0}, {outX, ridge + 0.05, 0}));
  builder.material(roof).doubleSided = true;
  return {{body, front}, {withScaledUv(slopes, {4, 2}), roof}};
}

Mesh makeWingMirrorGlass(const WingMirrorOptions& o) {
  const dvec2 half(0.5 * o.widthMetres, 0.5 * o.heightMetres);
  const double big = o.radiusOfCurvature, outward = o.isOuterLeft ? -1 : 1, start = o.asphericFrom * half.x;
  Mesh mesh;
  for (int row = 0; row <= o.cells; ++row)
    for (int column = 0; column <= o.cells; ++column) {
      const dvec2 p = half * bulge({2.0 * column / o.cells - 1, 1 - 2.0 * row / o.cells});
      const double root = std::sqrt(big * big - glm::dot(p, p)),
                   beyond = std::max(0.0, outward * p.x - start);
      const double z = root - big - o.asphericCubic * beyond * beyond * beyond;
      const double dzdx = -p.x / root - outward * 3 * o.asphericCubic * beyond * beyond, dzdy = -p.y / root;
      mesh.positions.push_back(vec3(dvec3(p, z)));
      mesh.normals.push_back(vec3(glm::normalize(dvec3(-dzdx, -dzdy, 1))));
    }
  const auto at = [&](int column, int row) { return std::uint32_t(row * (o.cells + 1) + column); };
  for (int row = 0; row < o.cells; ++row)
    for (int column = 0; column < o.cells; ++column) {
      const std::uint32_t a = at(column, row), b = at(column, row + 1), c = at(column + 1, row + 1),
                          d = at(column + 1, row);
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  return geometry::withConvexEdges(std::move(mesh));
}

Mesh makeFlatMirrorGlass(double width, double height) {
  Mesh mesh;
  mesh.positions.push_back(vec3(0));
  for (const dvec3& p : outlineRing(width, height, 0)) mesh.positions.push_back(vec3(p));
  mesh.normals.assign(mesh.positions.size(), vec3(0, 0, 1));
  const auto n = std::uint32_t(mesh.positions.size() - 1);
  for (std::uint32_t i = 0; i < n; ++i) mesh.indices.insert(mesh.indices.end(), {0u, 1 + i, 1 + (i + 1) % n});
  return mesh;
}

Mesh makeMirrorHousing(double width, double height, double depth) {
  constexpr double kGap = 0.004, kWall = 0.009, kFront = 0.008, kFloor = -0.03;
  const auto ring = [&](double grow, double z) {
    return outlineRing(width + 2 * grow, height + 2 * grow, z);
  };
  const double small = -0.25 * std::min(width, height);
  const std::vector<std::vector<dvec3>> rings = {ring(small, -depth),
                                                 ring(0.3 * small, -0.85 * depth),
                                                 ring(kGap + kWall, -0.3 * depth),
                                                 ring(kGap + kWall, 0.6 * kFront),
                                                 ring(kGap + 0.5 * kWall, kFront),
                                                 ring(kGap, 0.6 * kFront),
                                                 ring(kGap, kFloor)};
  Mesh mesh = geometry::makeLoft(rings, 0.9);
  const Mesh back =
      transformed(makeFlatMirrorGlass(width + 2 * small, height + 2 * small), moveBy({0, 0, -depth}));
  append(mesh, geometry::flipped(back));
  // The floor of the bowl, behind the glass.
  append(mesh, transformed(makeFlatMirrorGlass(width + 2 * kGap, height + 2 * kGap), moveBy({0, 0, kFloor})));
  return mesh;
}

}  // namespace catoptric::scene::built_in
