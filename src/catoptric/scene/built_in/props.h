// SPDX-License-Identifier: Apache-2.0
// Things that stand around in the built-in scenes. Each stands on y = 0 at the origin; metres. Each function
// returns the pieces of one mesh; materials are made in the builder on first use.
#pragma once

#include <vector>

#include "catoptric/scene/built_in/scene_builder.h"

namespace catoptric::scene::built_in {

/// Where a thing stands, how far it is turned around the vertical, and its size.
[[nodiscard]] dmat4 standAt(const dvec3& place, double turnDegrees = 0, double scale = 1);

/// The Utah teapot, 1 m high before scaling; the spout points to +x.
[[nodiscard]] std::vector<Piece> makeTeapotPieces(int material, int cellsPerPatch = 6);
/// A toy block of the given edge with three different symbols on opposite faces.
[[nodiscard]] std::vector<Piece> makeToyBlock(SceneBuilder& builder, double edge, const char symbols[3],
                                              const vec3& ground, const vec3& ink);
/// Desk lamp 0.5 m high with a cloth shade that glows.
[[nodiscard]] std::vector<Piece> makeDeskLamp(SceneBuilder& builder);
/// Traffic cone, 0.72 m high.
[[nodiscard]] std::vector<Piece> makeTrafficCone(SceneBuilder& builder);
/// Globe on a foot, 0.34 m high.
[[nodiscard]] std::vector<Piece> makeGlobe(SceneBuilder& builder);
/// Table of the given size and height; the top face takes a texture once over, legs and sides are wood.
[[nodiscard]] std::vector<Piece> makeTable(SceneBuilder& builder, const dvec3& size, int topMaterial);
/// Chair, seat 0.45 m high, looks to +z.
[[nodiscard]] std::vector<Piece> makeChair(SceneBuilder& builder);
/// Open shelf with books, its back at z = 0, opens to +z.
[[nodiscard]] std::vector<Piece> makeBookshelf(SceneBuilder& builder, const dvec3& size, int boards);
/// Pole with red and white stripes.
[[nodiscard]] std::vector<Piece> makeStripedPole(SceneBuilder& builder, double height, double radius);
/// Pot with a leafy bush.
[[nodiscard]] std::vector<Piece> makePottedPlant(SceneBuilder& builder, double height, std::uint32_t seed);
/// Broad-leaved tree.
/// `detail` is the number of facets along an edge of the crown's icosahedra.
[[nodiscard]] std::vector<Piece> makeTree(SceneBuilder& builder, double height, std::uint32_t seed,
                                          int detail = 5);
/// Sofa for two, looks to +z.
[[nodiscard]] std::vector<Piece> makeSofa(SceneBuilder& builder, const vec3& cloth);

/// Wood that several scenes use for furniture.
[[nodiscard]] int furnitureWood(SceneBuilder& builder);

}  // namespace catoptric::scene::built_in
