// SPDX-License-Identifier: Apache-2.0
#include "catoptric/gl/texture.h"

#include <glad/gl.h>

#include <algorithm>

namespace catoptric::gl {
namespace {

struct FormatInfo {
  GLint internal;
  GLenum format, type;
};

FormatInfo infoOf(Format format) {
  switch (format) {
    case Format::Rgba8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case Format::Srgb8Alpha8:
      return {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case Format::Rgb16F:
      return {GL_RGB16F, GL_RGB, GL_FLOAT};
    case Format::Rgba16F:
      return {GL_RGBA16F, GL_RGBA, GL_FLOAT};
    case Format::Rgba32F:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    case Format::R32Ui:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
    case Format::Rg32Ui:
      return {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT};
    case Format::Rgba32Ui:
      return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT};
    case Format::Depth32F:
      return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT};
    case Format::Depth32FStencil8:
      return {GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV};
  }
  return {};
}

GLenum targetOf(TextureKind kind) {
  return kind == TextureKind::Flat    ? GL_TEXTURE_2D
         : kind == TextureKind::Array ? GL_TEXTURE_2D_ARRAY
                                      : GL_TEXTURE_CUBE_MAP;
}

GLint wrapOf(TextureWrap wrap) {
  return wrap == TextureWrap::Repeat           ? GL_REPEAT
         : wrap == TextureWrap::MirroredRepeat ? GL_MIRRORED_REPEAT
                                               : GL_CLAMP_TO_EDGE;
}

}  // namespace

Texture::Texture(TextureKind kind, Format format, int widthTexels, int heightTexels, int layers, int levels,
                 const SamplerState& sampler)
    : kind_(kind),
      format_(format),
      width_(widthTexels),
      height_(heightTexels),
      layers_(layers),
      levels_(levels) {
  const GLenum target = targetOf(kind);
  const FormatInfo info = infoOf(format);
  glGenTextures(1, &id_);
  glBindTexture(target, id_);
  for (int level = 0; level < levels; ++level) {
    const int w = std::max(1, widthTexels >> level), h = std::max(1, heightTexels >> level);
    if (kind == TextureKind::Array) {
      glTexImage3D(target, level, info.internal, w, h, layers, 0, info.format, info.type, nullptr);
    } else if (kind == TextureKind::Cube) {
      for (unsigned face = 0; face < 6; ++face)
        glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, level, info.internal, w, h, 0, info.format,
                     info.type, nullptr);
    } else {
      glTexImage2D(target, level, info.internal, w, h, 0, info.format, info.type, nullptr);
    }
  }
  const bool nearest = sampler.minifyNearest;
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER,
                  sampler.hasMipmaps ? (nearest ? GL_NEAREST_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_NEAREST)
                                     : (nearest ? GL_NEAREST : GL_LINEAR));
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, sampler.magnifyNearest ? GL_NEAREST : GL_LINEAR);
  glTexParameteri(target, GL_TEXTURE_WRAP_S, wrapOf(sampler.wrapU));
  glTexParameteri(target, GL_TEXTURE_WRAP_T, wrapOf(sampler.wrapV));
  glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, levels - 1);
}

Texture::~Texture() {
  glDeleteTextures(1, &id_);
}

void Texture::upload(int level, int layer, const void* texels) {
  const GLenum target = targetOf(kind_);
  const FormatInfo info = infoOf(format_);
  const int w = std::max(1, width_ >> level), h = std::max(1, height_ >> level);
  glBindTexture(target, id_);
  if (kind_ == TextureKind::Array) {
    glTexSubImage3D(target, level, 0, 0, layer, w, h, 1, info.format, info.type, texels);
  } else {
    const GLenum face =
        kind_ == TextureKind::Cube ? GL_TEXTURE_CUBE_MAP_POSITIVE_X + unsigned(layer) : target;
    glTexSubImage2D(face, level, 0, 0, w, h, info.format, info.type, texels);
  }
}

void Texture::uploadCorner(int widthTexels, int heightTexels, const void* texels) {
  uploadRect(0, 0, widthTexels, heightTexels, texels);
}

void Texture::uploadRect(int x, int y, int widthTexels, int heightTexels, const void* texels) {
  const FormatInfo info = infoOf(format_);
  glBindTexture(GL_TEXTURE_2D, id_);
  glTexSubImage2D(GL_TEXTURE_2D, 0, x, y, widthTexels, heightTexels, info.format, info.type, texels);
}

void Texture::generateMipmaps() {
  glBindTexture(targetOf(kind_), id_);
  glGenerateMipmap(targetOf(kind_));
}

void Texture::bind(int unit) const {
  glActiveTexture(GL_TEXTURE0 + unsigned(unit));
  glBindTexture(targetOf(kind_), id_);
}

int maxTextureSize() {
  GLint size = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &size);
  return size;
}

}  // namespace catoptric::gl
