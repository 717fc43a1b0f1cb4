// SPDX-License-Identifier: Apache-2.0
// What a method works with, as something to look at: lines, faces and dots in world space, drawn over a
// picture from any eye. Functions of this folder turn the methods' own structures into sketches; they decide
// nothing and compute nothing that a method does not compute itself.
//
// drawSketch(): in goes a sketch, a camera, a picture of the scene from that camera and the distances of what
// it shows; out comes the picture with the sketch in it.
//   1. Faces are cut at a plane before the eye, then each covered pixel's own ray is met with the face's
//      plane: a distance, tested against those of the picture and kept.
//   2. Lines and dots are drawn over it, smoothed at their edges; what lies behind something shows faintly,
//      so that rays inside of a mirror can be followed.
// Not a renderer: no shading, one colour a face; 2 million pixels of faces a second are enough here.
#pragma once

#include <array>
#include <vector>

#include "catoptric/core/image.h"
#include "catoptric/core/math.h"
#include "catoptric/scene/camera_frame.h"

namespace catoptric::sketch {

using Colour = glm::u8vec4;  ///< sRGB; alpha 255 is opaque

inline constexpr Colour kRed{214, 39, 40, 255}, kBlue{31, 90, 200, 255}, kGreen{30, 140, 60, 255},
    kOrange{240, 130, 20, 255}, kViolet{140, 60, 190, 255}, kBlack{20, 20, 20, 255},
    kGrey{120, 120, 120, 255};

struct Line {
  vec3 from{0}, to{0};
  Colour colour{kBlack};
  float widthPx = 2;
};

/// Seen from both sides.
struct Face {
  std::array<vec3, 3> corners{};
  Colour colour{kGrey};
};

struct Dot {
  vec3 at{0};
  Colour colour{kBlack};
  float radiusPx = 4;
};

struct Sketch {
  std::vector<Face> faces;
  std::vector<Line> lines;
  std::vector<Dot> dots;

  void addLine(const dvec3& from, const dvec3& to, Colour colour, float widthPx = 2) {
    lines.push_back({vec3(from), vec3(to), colour, widthPx});
  }
  void addDot(const dvec3& at, Colour colour, float radiusPx = 4) {
    dots.push_back({vec3(at), colour, radiusPx});
  }
  void addFace(const dvec3& a, const dvec3& b, const dvec3& c, Colour colour) {
    faces.push_back({{vec3(a), vec3(b), vec3(c)}, colour});
  }
  void addBox(const core::Box& box, Colour colour, float widthPx = 1.5f);
  /// Circle around `centre` in the plane of two orthogonal unit vectors.
  void addCircle(const dvec3& centre, double radius, const dvec3& x, const dvec3& y, Colour colour);
  /// Broken into dashes of `dash` world units.
  void addDashes(const dvec3& from, const dvec3& to, double dash, Colour colour, float widthPx = 2);
  /// An eye: a dot and a small pyramid that looks along the camera's axis.
  void addEye(const scene::CameraFrame& camera, double size);
  void add(const Sketch& other);
};

/// Distance from the eye along each pixel's ray, world units; infinity where nothing is.
using DistanceImage = core::Image<float>;

/// `picture` and `distances` have the size of `camera`; both are changed (lines and dots leave distances as
/// they are).
void drawSketch(const Sketch& sketch, const scene::CameraFrame& camera, core::ImageRgba8& picture,
                DistanceImage& distances);

/// Half the size: each pixel the mean of four. A picture drawn at twice its size comes out smooth.
[[nodiscard]] core::ImageRgba8 halve(const core::ImageRgba8& picture);

/// Each pixel `factor` by `factor` times.
[[nodiscard]] core::ImageRgba8 enlarge(const core::ImageRgba8& picture, int factor);

/// Towards white by `share`, so that a sketch stands out.
void fade(core::ImageRgba8& picture, float share);

/// Colours of neighbouring numbers differ; `strength` 1 is full, less is darker.
[[nodiscard]] Colour colourOfNumber(std::uint32_t number, float strength = 1.0f);

/// Pictures of any size in a row, `gapPx` of white between them, each enlarged by a whole factor so that
/// heights are about equal.
[[nodiscard]] core::ImageRgba8 putSideBySide(const std::vector<core::ImageRgba8>& pictures, int gapPx = 8);

}  // namespace catoptric::sketch
