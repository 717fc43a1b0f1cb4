// SPDX-License-Identifier: Apache-2.0
// Procedural textures. A Pattern gives the linear colour at texture coordinates; patterns repeat with period
// 1 in u and v unless said otherwise. paintTexture() turns one into an image.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "catoptric/core/image.h"

namespace catoptric::scene::built_in {

using Pattern = std::function<vec3(dvec2 uv)>;

/// Linear colour of an sRGB triple such as 0xC08040.
[[nodiscard]] vec3 colour(std::uint32_t srgbHex);

/// 8-bit sRGB, one sample per pixel centre for `samplesPerAxis` 1, a box of samples otherwise.
[[nodiscard]] core::ImageRgba8 paintTexture(int widthPx, int heightPx, const Pattern& pattern,
                                            int samplesPerAxis = 1);

/// The pattern with u and v multiplied.
[[nodiscard]] Pattern repeated(Pattern pattern, const dvec2& times);
/// The pattern times a grey factor, for baked light.
[[nodiscard]] Pattern shaded(Pattern pattern, std::function<double(dvec2 uv)> factor);

[[nodiscard]] Pattern plain(const vec3& colour);
/// columns x rows fields in two colours, with soft wear; both counts even to repeat.
[[nodiscard]] Pattern checker(const vec3& first, const vec3& second, int columns, int rows,
                              double wear = 0.12);
/// Boards along u: `boards` of them across v, ends staggered.
[[nodiscard]] Pattern woodPlanks(const vec3& light, const vec3& dark, int boards, std::uint32_t seed);
/// Running bond, `columns` bricks wide and `rows` (even) high.
[[nodiscard]] Pattern bricks(const vec3& brick, const vec3& mortar, int columns, int rows,
                             std::uint32_t seed);
/// Square tiles with joints and slightly different shades.
[[nodiscard]] Pattern tiles(const vec3& tile, const vec3& joint, int count, std::uint32_t seed);
/// Almost one colour with soft blotches: plaster, concrete, paint.
[[nodiscard]] Pattern plaster(const vec3& colour, double contrast, std::uint32_t seed);
/// Fine speckle: asphalt, terrazzo, carpet.
[[nodiscard]] Pattern speckle(const vec3& dark, const vec3& light, int grains, std::uint32_t seed);
[[nodiscard]] Pattern grass(std::uint32_t seed);
/// A woven rug with a border and diamonds. Does not repeat.
[[nodiscard]] Pattern rug(const vec3& ground, const vec3& figure, const vec3& border);
/// A hilly landscape with a lake, a sun and trees. Does not repeat.
[[nodiscard]] Pattern landscapePainting();
/// An abstract picture of rectangles and a circle. Does not repeat.
[[nodiscard]] Pattern abstractPainting();
/// `count` slanted (slant 1) or level (0) stripes along v.
[[nodiscard]] Pattern stripes(const vec3& first, const vec3& second, int count, int slant);
/// One capital letter or digit (A-F, 1-6) in a frame, as on a toy block.
[[nodiscard]] Pattern blockFace(char symbol, const vec3& ground, const vec3& ink);
/// Stones of a world map's kind: continents on blue, for a globe; repeats in u.
[[nodiscard]] Pattern globe();

}  // namespace catoptric::scene::built_in
