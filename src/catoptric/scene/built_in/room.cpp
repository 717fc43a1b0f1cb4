// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in/room.h"

#include <algorithm>
#include <set>

#include "catoptric/geometry/shapes.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::append;
using geometry::makeBox;
using geometry::makeQuad;
using geometry::Mesh;
using geometry::moveBy;
using geometry::transformed;
using geometry::turnAround;

constexpr double kHalfTurn = 3.141592653589793;

double wallLength(const dvec3& roomSize, Wall wall) {
  return wall == kBack || wall == kFront ? roomSize.x : roomSize.z;
}

bool isInHole(const dvec2& p, const std::vector<Opening>& openings) {
  return std::any_of(openings.begin(), openings.end(), [&](const Opening& o) {
    return p.x > o.lower.x && p.x < o.upper.x && p.y > o.lower.y && p.y < o.upper.y;
  });
}

/// A skirting board along a wall, broken where openings reach down to it.
Mesh makeSkirting(double length, double height, const std::vector<Opening>& openings) {
  constexpr double kThickness = 0.014;
  std::set<double> cuts = {0.0, length};
  for (const Opening& o : openings)
    if (o.lower.y < height) cuts.insert({o.lower.x, o.upper.x});
  Mesh mesh;
  for (auto from = cuts.begin(), to = std::next(from); to != cuts.end(); ++from, ++to) {
    if (isInHole({0.5 * (*from + *to), 0.5 * height}, openings)) continue;
    append(mesh, transformed(makeBox({*to - *from - 2 * kThickness, height, kThickness}),
                             moveBy({0.5 * (*from + *to), 0.5 * height + 0.001, 0.5 * kThickness + 0.001})));
  }
  return mesh;
}

}  // namespace

Mesh makeWall(const dvec2& size, const std::vector<Opening>& openings, double metresPerRepeat) {
  // A little more than the wall on every side: neighbours overlap, so that no crack shows the sky.
  constexpr double kOverlap = 0.02;
  std::set<double> xs = {-kOverlap, size.x + kOverlap}, ys = {-kOverlap, size.y + kOverlap};
  for (const Opening& o : openings) {
    xs.insert({o.lower.x, o.upper.x});
    ys.insert({o.lower.y, o.upper.y});
  }
  Mesh mesh;
  for (auto x0 = xs.begin(), x1 = std::next(x0); x1 != xs.end(); ++x0, ++x1)
    for (auto y0 = ys.begin(), y1 = std::next(y0); y1 != ys.end(); ++y0, ++y1) {
      if (isInHole({0.5 * (*x0 + *x1), 0.5 * (*y0 + *y1)}, openings)) continue;
      append(mesh, makeQuad({*x0, *y0, 0}, {*x1, *y0, 0}, {*x1, *y1, 0}, {*x0, *y1, 0}));
    }
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.uv[i] = vec2(mesh.positions[i].x, float(size.y) - mesh.positions[i].y) / float(metresPerRepeat);
  return geometry::withSmoothNormals(mesh, 0.1);
}

dmat4 worldFromWall(const dvec3& roomSize, Wall wall) {
  const dvec3 h(0.5 * roomSize.x, 0, 0.5 * roomSize.z);
  switch (wall) {
    case kBack:
      return moveBy({-h.x, 0, -h.z});
    case kFront:
      return moveBy({h.x, 0, h.z}) * turnAround({0, 1, 0}, kHalfTurn);
    case kLeft:
      return moveBy({-h.x, 0, h.z}) * turnAround({0, 1, 0}, 0.5 * kHalfTurn);
    case kRight:
      return moveBy({h.x, 0, -h.z}) * turnAround({0, 1, 0}, -0.5 * kHalfTurn);
  }
  return dmat4(1.0);
}

void addRoom(SceneBuilder& builder, const RoomOptions& room) {
  const dvec3 size = room.size;
  builder.placeShell("floor", geometry::makePlane(size.x, size.z, 1, 1), room.floor);
  Mesh ceiling = withScaledUv(geometry::makePlane(size.x, size.z, 1, 1),
                              vec2(size.x / room.metresPerRepeat, size.z / room.metresPerRepeat));
  builder.placeShell("ceiling", geometry::flipped(std::move(ceiling)), room.ceiling, moveBy({0, size.y, 0}));
  constexpr const char* kNames[] = {"back wall", "front wall", "left wall", "right wall"};
  for (const Wall wall : {kBack, kFront, kLeft, kRight}) {
    const double length = wallLength(size, wall);
    const dmat4 place = worldFromWall(size, wall);
    builder.placeShell(kNames[wall], makeWall({length, size.y}, room.openings[wall], room.metresPerRepeat),
                       room.walls, place);
    if (room.skirting >= 0)
      builder.placeShell(std::string(kNames[wall]) + " skirting",
                         makeSkirting(length, room.skirtingHeight, room.openings[wall]), room.skirting,
                         place);
  }
}

Mesh makeFrame(const dvec2& size, double barWidth, double depth) {
  // Mitred corners: eight points around, so that no two bars overlap.
  const dvec2 in = 0.5 * size, out = in + barWidth;
  const auto corner = [](const dvec2& h, int i, double z) {
    return dvec3(i == 0 || i == 3 ? -h.x : h.x, i < 2 ? -h.y : h.y, z);
  };
  Mesh mesh;
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    const dvec3 outA = corner(out, i, 0), outB = corner(out, j, 0), inA = corner(in, i, 0),
                inB = corner(in, j, 0);
    const dvec3 up(0, 0, depth);
    append(mesh, makeQuad(outA + up, outB + up, inB + up, inA + up));
    append(mesh, makeQuad(inA + up, inB + up, inB, inA));
    append(mesh, makeQuad(outA, outB, outB + up, outA + up));
    append(mesh, makeQuad(outB, outA, inA, inB));
  }
  return mesh;
}

void addWindow(SceneBuilder& builder, const std::string& name, const dvec3& roomSize, Wall wall,
               const Opening& opening, int material, int barsAcross, int barsUp) {
  constexpr double kBar = 0.05, kDepth = 0.09;
  const dvec2 clear = opening.upper - opening.lower, middle = 0.5 * (opening.lower + opening.upper);
  Mesh mesh = transformed(makeFrame(clear - 2 * kBar, kBar + 0.03, kDepth), moveBy({0, 0, -0.6 * kDepth}));
  const dvec2 inside = clear - 2 * kBar;
  for (int i = 1; i <= barsAcross; ++i)
    append(mesh, transformed(makeBox({0.035, inside.y, 0.04}),
                             moveBy({inside.x * (double(i) / (barsAcross + 1) - 0.5), 0, -0.02})));
  for (int i = 1; i <= barsUp; ++i)
    for (int k = 0; k <= barsAcross; ++k) {
      const double field = inside.x / (barsAcross + 1);
      append(mesh, transformed(makeBox({field - 0.036, 0.035, 0.04}),
                               moveBy({field * (k + 0.5) - 0.5 * inside.x,
                                       inside.y * (double(i) / (barsUp + 1) - 0.5), -0.02})));
    }
  append(mesh, transformed(makeBox({clear.x + 0.24, 0.035, 0.22}), moveBy({0, -0.5 * clear.y - 0.05, 0.1})));
  builder.place(name, std::move(mesh), material,
                worldFromWall(roomSize, wall) * moveBy(dvec3(middle, 0.012)));
}

void addPicture(SceneBuilder& builder, const std::string& name, const dvec3& roomSize, Wall wall,
                const Opening& place, int picture, int frame) {
  const dvec2 size = place.upper - place.lower, middle = 0.5 * (place.lower + place.upper);
  const dvec2 h = 0.5 * size;
  const Piece pieces[] = {
      {makeFrame(size, 0.055, 0.035), frame},
      {makeQuad({-h.x, -h.y, 0.012}, {h.x, -h.y, 0.012}, {h.x, h.y, 0.012}, {-h.x, h.y, 0.012}), picture}};
  builder.place(name, pieces, worldFromWall(roomSize, wall) * moveBy(dvec3(middle, 0.004)));
}

}  // namespace catoptric::scene::built_in
