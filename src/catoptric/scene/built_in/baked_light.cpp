// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in/baked_light.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "catoptric/core/parallel.h"

namespace catoptric::scene::built_in {
namespace {

constexpr double kPi = 3.141592653589793;

/// Lambert's form factor of a polygon seen from `point` with normal +y; positive when it is wound
/// counter-clockwise seen from the point.
double polygonFormFactor(const dvec3& point, std::span<const dvec3> polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec3 a = polygon[i] - point, b = polygon[(i + 1) % polygon.size()] - point;
    const dvec3 cross = glm::cross(a, b);
    const double length = glm::length(cross);
    if (length < 1e-12) continue;
    sum += std::atan2(length, glm::dot(a, b)) * cross.y / length;
  }
  return sum / (2 * kPi);
}

/// No more of the hemisphere than this is worth the exact formula.
constexpr double kNegligibleShare = 0.001;

double coveredShare(const dvec3& point, const FacedSolid& solid) {
  const dvec3 d = solid.bounds.centre - point;
  if (solid.bounds.radius * solid.bounds.radius < kNegligibleShare * glm::dot(d, d)) return 0;
  double sum = 0;
  bool isInside = true;
  for (std::size_t i = 0; i < solid.faces.size(); ++i) {
    const std::vector<dvec3>& face = solid.faces[i];
    if (glm::dot(point - face[0], solid.normals[i]) <= 0) continue;
    isInside = false;
    sum += std::abs(polygonFormFactor(point, face));
  }
  return isInside ? 1.0 : std::clamp(sum, 0.0, 1.0);
}

double coveredShare(const dvec3& point, const BallSolid& ball) {
  const dvec3 d = ball.centre - point;
  const double distance = glm::length(d);
  if (distance <= ball.radius * 1.0001) return 0.5;
  const double sine = ball.radius / distance;
  return std::clamp(d.y / distance * sine * sine, 0.0, 1.0);
}

bool isHidden(const dvec3& from, const dvec3& to, const BallSolid& ball) {
  const dvec3 d = to - from, m = ball.centre - from;
  const double t = std::clamp(glm::dot(m, d) / glm::dot(d, d), 0.0, 1.0);
  return glm::length(m - t * d) < ball.radius;
}

bool isHidden(const dvec3& from, const dvec3& to, const FacedSolid& solid) {
  if (!isHidden(from, to, solid.bounds)) return false;
  double enter = 1e-6, leave = 1;
  for (std::size_t i = 0; i < solid.faces.size(); ++i) {
    const dvec3& n = solid.normals[i];
    const double height = glm::dot(from - solid.faces[i][0], n), rate = glm::dot(to - from, n);
    if (std::abs(rate) < 1e-15) {
      if (height > 0) return false;
    } else if (rate < 0) {
      enter = std::max(enter, -height / rate);
    } else {
      leave = std::min(leave, -height / rate);
    }
    if (enter >= leave) return false;
  }
  return true;
}

double sampleGrid(const core::Image<float>& grid, dvec2 uv) {
  const double x = std::clamp(uv.x * grid.width() - 0.5, 0.0, grid.width() - 1.0);
  const double y = std::clamp(uv.y * grid.height() - 0.5, 0.0, grid.height() - 1.0);
  const int x0 = int(x), y0 = int(y), x1 = std::min(x0 + 1, grid.width() - 1),
            y1 = std::min(y0 + 1, grid.height() - 1);
  const double fx = x - x0, fy = y - y0;
  return glm::mix(glm::mix(double(grid.at(x0, y0)), double(grid.at(x1, y0)), fx),
                  glm::mix(double(grid.at(x0, y1)), double(grid.at(x1, y1)), fx), fy);
}

}  // namespace

void BakedLight::addRings(const std::vector<dvec3>& bottom, const std::vector<dvec3>& top) {
  FacedSolid solid;
  const bool isPointed = glm::distance(top[0], top[1]) < 1e-9;
  for (std::size_t i = 0; i < bottom.size(); ++i) {
    const std::size_t j = (i + 1) % bottom.size();
    solid.faces.push_back({bottom[i], bottom[j], top[j]});
    if (!isPointed) solid.faces.back().push_back(top[i]);
  }
  solid.faces.emplace_back(bottom.rbegin(), bottom.rend());
  if (!isPointed) solid.faces.push_back(top);
  core::Box box;
  for (const auto& face : solid.faces) {
    solid.normals.push_back(glm::cross(face[1] - face[0], face[2] - face[0]));
    for (const dvec3& p : face) box.add(p);
  }
  solid.bounds = {box.centre(), box.radius()};
  solids_.push_back(std::move(solid));
}

void BakedLight::addBox(const dvec3& centre, const dvec3& size, double turnRadians) {
  std::vector<dvec3> bottom, top;
  const dvec3 h = 0.5 * size;
  const double c = std::cos(turnRadians), s = std::sin(turnRadians);
  for (const dvec2& corner : {dvec2(h.x, h.z), dvec2(h.x, -h.z), dvec2(-h.x, -h.z), dvec2(-h.x, h.z)}) {
    const dvec3 turned(c * corner.x + s * corner.y, 0, -s * corner.x + c * corner.y);
    bottom.push_back(centre + turned - dvec3(0, h.y, 0));
    top.push_back(centre + turned + dvec3(0, h.y, 0));
  }
  addRings(bottom, top);
}

void BakedLight::addColumn(const dvec3& base, double bottomRadius, double topRadius, double height) {
  std::vector<dvec3> bottom, top;
  constexpr int kSides = 12;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * kPi * i / kSides;
    const dvec3 out(std::sin(angle), 0, std::cos(angle));
    bottom.push_back(base + bottomRadius * out);
    top.push_back(base + dvec3(0, height, 0) + topRadius * out);
  }
  addRings(bottom, top);
}

double BakedLight::openness(const dvec3& point) const {
  double open = 1;
  for (const BallSolid& ball : balls_) open *= 1 - coveredShare(point, ball);
  for (const FacedSolid& solid : solids_) open *= 1 - coveredShare(point, solid);
  return open;
}

void BakedLight::setLamp(const dvec3& position, double radius) {
  lamp_ = position;
  lampRadius_ = radius;
  for (int i = 0; i < kLampSamples; ++i) {
    // Vogel's spiral over a disc that lies level: good enough for lamps overhead.
    const double away = radius * std::sqrt((i + 0.5) / kLampSamples), angle = 2.399963 * i;
    lampSamples_[std::size_t(i)] = lamp_ + dvec3(away * std::cos(angle), 0, away * std::sin(angle));
  }
}

/// False only where the ball meets no line from the point to a sample: at share t of the way these lie within
/// t lampRadius_ of the line to the lamp's centre.
bool BakedLight::mayHideLamp(const dvec3& point, const BallSolid& ball) const {
  const double lampDistance = glm::distance(lamp_, point) - lampRadius_;
  if (lampDistance <= 0) return true;
  const double farthest = std::min(1.0, glm::distance(ball.centre, point) / lampDistance);
  return isHidden(point, lamp_, BallSolid{ball.centre, 1.0001 * (ball.radius + farthest * lampRadius_)});
}

double BakedLight::lampShare(const dvec3& point) const {
  std::array<bool, kLampSamples> isDark{};
  const auto hide = [&](const auto& solid) {
    for (std::size_t i = 0; i < isDark.size(); ++i)
      isDark[i] = isDark[i] || isHidden(point, lampSamples_[i], solid);
  };
  for (const BallSolid& ball : balls_)
    if (mayHideLamp(point, ball)) hide(ball);
  for (const FacedSolid& solid : solids_)
    if (mayHideLamp(point, solid.bounds)) hide(solid);
  return double(std::count(isDark.begin(), isDark.end(), false)) / kLampSamples;
}

std::function<double(dvec2)> BakedLight::bake(const dvec2& lower, const dvec2& upper, double height,
                                              int cellsX, int cellsZ, double skyStrength,
                                              double lampStrength) const {
  auto grid = std::make_shared<core::Image<float>>(cellsX, cellsZ);
  core::parallelFor(std::size_t(cellsZ), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int column = 0; column < cellsX; ++column) {
        const dvec2 t((column + 0.5) / cellsX, (double(row) + 0.5) / cellsZ);
        const dvec2 place = glm::mix(lower, upper, t);
        const dvec3 point(place.x, height, place.y);
        const double sky = 1 - skyStrength * (1 - openness(point));
        const double lamp = lampStrength > 0 ? 1 - lampStrength * (1 - lampShare(point)) : 1;
        grid->at(column, int(row)) = float(sky * lamp);
      }
  });
  return [grid](dvec2 uv) { return sampleGrid(*grid, uv); };
}

std::function<double(dvec2)> edgeShade(const dvec2& size, double reach, double strength) {
  return [=](dvec2 uv) {
    const dvec2 toEdge = glm::min(uv, 1.0 - uv) * size;
    return (1 - strength * std::exp(-toEdge.x / reach)) * (1 - strength * std::exp(-toEdge.y / reach));
  };
}

core::ImageRgba8 paintOcclusion(int widthPx, int heightPx, const std::function<double(dvec2)>& factor) {
  core::ImageRgba8 image(widthPx, heightPx);
  for (int y = 0; y < heightPx; ++y)
    for (int x = 0; x < widthPx; ++x) {
      const double value = std::clamp(factor({(x + 0.5) / widthPx, (y + 0.5) / heightPx}), 0.0, 1.0);
      const auto byte = std::uint8_t(std::lround(255 * value));
      image.at(x, y) = {byte, byte, byte, 255};
    }
  return image;
}

}  // namespace catoptric::scene::built_in
