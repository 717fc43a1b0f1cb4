// SPDX-License-Identifier: Apache-2.0
// Textures: 2-D, 2-D array and cube, of the few formats we use (all in GLSL ES 3.00's reach).
#pragma once

#include <cstddef>
#include <cstdint>

namespace catoptric::gl {

enum class Format : std::uint8_t {
  Rgba8,
  Srgb8Alpha8,
  Rgb16F,
  Rgba16F,
  Rgba32F,
  R32Ui,
  Rg32Ui,
  Rgba32Ui,
  Depth32F,
  Depth32FStencil8
};
enum class TextureKind : std::uint8_t { Flat, Array, Cube };
enum class TextureWrap : std::uint8_t { Repeat, MirroredRepeat, ClampToEdge };

struct SamplerState {
  TextureWrap wrapU = TextureWrap::ClampToEdge, wrapV = TextureWrap::ClampToEdge;
  bool magnifyNearest = true;
  bool minifyNearest = true;
  /// Levels are always picked one at a time: shaders blend two integer levels themselves (shaders/lib),
  /// because drivers differ in how they compute and round a level.
  bool hasMipmaps = false;
};

class Texture {
 public:
  /// Allocates all levels. `layers`: of an array (1 otherwise).
  Texture(TextureKind kind, Format format, int widthTexels, int heightTexels, int layers, int levels,
          const SamplerState& sampler);
  ~Texture();
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  /// Uploads one whole image: 8-bit formats from bytes (4 per texel), 16F formats from 32-bit floats (3 or 4
  /// per texel). `layer`: of an array, or the face of a cube in GL's order.
  void upload(int level, int layer, const void* texels);
  /// Flat textures: uploads the lower left part of level 0 from packed rows, 32-bit formats as stored.
  void uploadCorner(int widthTexels, int heightTexels, const void* texels);
  /// The same from texel (x, y) on; depths are floats.
  void uploadRect(int x, int y, int widthTexels, int heightTexels, const void* texels);
  void generateMipmaps();
  void bind(int unit) const;

  [[nodiscard]] unsigned id() const { return id_; }
  [[nodiscard]] Format format() const { return format_; }
  [[nodiscard]] TextureKind kind() const { return kind_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int levels() const { return levels_; }

 private:
  unsigned id_ = 0;
  TextureKind kind_;
  Format format_;
  int width_, height_, layers_, levels_;
};

/// Largest edge of a 2-D texture.
[[nodiscard]] int maxTextureSize();

}  // namespace catoptric::gl
