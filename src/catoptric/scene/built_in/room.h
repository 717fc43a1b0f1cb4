// SPDX-License-Identifier: Apache-2.0
// Rectangular rooms with openings, and what belongs to their walls.
#pragma once

#include <array>
#include <vector>

#include "catoptric/scene/built_in/scene_builder.h"

namespace catoptric::scene::built_in {

/// A hole in a wall: metres from the wall's lower left corner, seen from inside the room.
struct Opening {
  dvec2 lower, upper;
};

enum Wall : std::size_t { kBack, kFront, kLeft, kRight };  ///< at -z, +z, -x, +x

struct RoomOptions {
  dvec3 size{5, 2.7, 4};                     ///< inside; centred on x = z = 0, floor at y = 0
  int floor = -1, walls = -1, ceiling = -1;  ///< materials; the floor's texture covers it once
  int skirting = -1;                         ///< material of a skirting board; -1: none
  double metresPerRepeat = 2.5;              ///< of walls and ceiling
  std::array<std::vector<Opening>, 4> openings{};
  double skirtingHeight = 0.09;
};

/// Floor, ceiling and walls, all marked as shell, facing inwards. Openings show the sky.
void addRoom(SceneBuilder& builder, const RoomOptions& room);

/// A wall in the plane z = 0 that faces +z, lower left corner at the origin, with holes; no T-junctions. It
/// reaches 2 cm past its size on all sides.
[[nodiscard]] geometry::Mesh makeWall(const dvec2& size, const std::vector<Opening>& openings,
                                      double metresPerRepeat);

/// From the frame of makeWall() to the room.
[[nodiscard]] dmat4 worldFromWall(const dvec3& roomSize, Wall wall);

/// Frame, cross bars and sill for an opening of a wall; stands in the wall's plane.
void addWindow(SceneBuilder& builder, const std::string& name, const dvec3& roomSize, Wall wall,
               const Opening& opening, int material, int barsAcross, int barsUp);

/// A framed picture that hangs on a wall; the picture's material has a texture that covers it once.
void addPicture(SceneBuilder& builder, const std::string& name, const dvec3& roomSize, Wall wall,
                const Opening& place, int picture, int frame);

/// A frame of four bars around a rectangle in the plane z = 0, between z = 0 and z = depth, centred on the
/// origin; `size` is the clear inside.
[[nodiscard]] geometry::Mesh makeFrame(const dvec2& size, double barWidth, double depth);

}  // namespace catoptric::scene::built_in
