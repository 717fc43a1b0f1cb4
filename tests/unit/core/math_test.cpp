// SPDX-License-Identifier: Apache-2.0
// The laws of the plane mirror, as properties.
#include "catoptric/core/math.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "catoptric/core/sample_pattern.h"

namespace catoptric::core {
namespace {

double anyCoordinate() {
  return *rc::gen::inRange(-1000000, 1000001) * 1e-4;
}

dvec3 anyPoint() {
  const double x = anyCoordinate(), y = anyCoordinate();
  return {x, y, anyCoordinate()};
}

dvec3 anyUnitVector() {
  const dvec3 v = anyPoint();
  RC_PRE(glm::length(v) > 1e-3);
  return glm::normalize(v);
}

Plane anyPlane() {
  Plane plane;
  plane.normal = anyUnitVector();
  plane.offset = anyCoordinate();
  return plane;
}

RC_GTEST_PROP(ReflectPoint, TwiceIsIdentity, ()) {
  const Plane plane = anyPlane();
  const dvec3 p = anyPoint();
  RC_ASSERT(glm::distance(reflectPoint(reflectPoint(p, plane), plane), p) < 1e-10);
}

RC_GTEST_PROP(ReflectPoint, ThePlaneHalvesTheWayAtARightAngle, ()) {
  const Plane plane = anyPlane();
  const dvec3 p = anyPoint(), image = reflectPoint(p, plane);
  RC_ASSERT(std::abs(plane.signedDistance(0.5 * (p + image))) < 1e-10);
  RC_ASSERT(glm::length(glm::cross(p - image, plane.normal)) < 1e-10);
  RC_ASSERT(std::abs(plane.signedDistance(p) + plane.signedDistance(image)) < 1e-10);
}

RC_GTEST_PROP(ReflectPoint, PointsOfThePlaneStay, ()) {
  const Plane plane = anyPlane();
  const dvec3 p = anyPoint(), foot = p - plane.signedDistance(p) * plane.normal;
  RC_ASSERT(glm::distance(reflectPoint(foot, plane), foot) < 1e-10);
}

RC_GTEST_PROP(ReflectionMatrix, IsReflectPoint, ()) {
  const Plane plane = anyPlane();
  const dvec3 p = anyPoint();
  const dvec4 image = makeReflectionMatrix(plane) * dvec4(p, 1.0);
  RC_ASSERT(glm::distance(dvec3(image), reflectPoint(p, plane)) < 1e-10);
  RC_ASSERT(image.w == 1.0);
}

RC_GTEST_PROP(ReflectionMatrix, FlipsOrientationAndKeepsLengths, ()) {
  const dmat4 m = makeReflectionMatrix(anyPlane());
  RC_ASSERT(std::abs(glm::determinant(m) + 1.0) < 1e-9);
  const dvec3 a = anyPoint(), b = anyPoint();
  RC_ASSERT(std::abs(glm::length(dvec3(m * dvec4(a - b, 0.0))) - glm::distance(a, b)) < 1e-9);
}

RC_GTEST_PROP(ReflectDirection, KeepsLengthAndTheTangent, ()) {
  const dvec3 n = anyUnitVector(), d = anyPoint(), r = reflectDirection(d, n);
  RC_ASSERT(std::abs(glm::length(r) - glm::length(d)) < 1e-10);
  RC_ASSERT(std::abs(glm::dot(r, n) + glm::dot(d, n)) < 1e-10);
  RC_ASSERT(glm::length(glm::cross(r - d, n)) < 1e-10);
  RC_ASSERT(glm::distance(reflectDirection(r, n), d) < 1e-10);
}

RC_GTEST_PROP(ReflectDirection, TheNormalBisects, ()) {
  const dvec3 n = anyUnitVector(), d = anyUnitVector();
  RC_PRE(std::abs(glm::dot(d, n)) > 1e-3);
  const dvec3 halfway = glm::normalize(reflectDirection(d, n) - d);  // to the eye and along the reflected ray
  RC_ASSERT(glm::length(glm::cross(halfway, n)) < 1e-9);
}

RC_GTEST_PROP(ReflectDirection, AgreesWithReflectedPoints, ()) {
  const Plane plane = anyPlane();
  const dvec3 a = anyPoint(), b = anyPoint();
  const dvec3 expected = reflectPoint(b, plane) - reflectPoint(a, plane);
  RC_ASSERT(glm::distance(reflectDirection(b - a, plane.normal), expected) < 1e-9);
}

TEST(Box, GrowsFromNothing) {
  Box box;
  EXPECT_TRUE(box.isEmpty());
  EXPECT_EQ(box.radius(), 0.0);
  Box other;
  other.add(box);
  EXPECT_TRUE(other.isEmpty());
  box.add(dvec3(1, 2, 3));
  EXPECT_FALSE(box.isEmpty());
  EXPECT_EQ(box.radius(), 0.0);
  box.add(dvec3(1, 2, -1));
  EXPECT_EQ(box.centre(), dvec3(1, 2, 1));
  EXPECT_EQ(box.radius(), 2.0);
  other.add(box);
  EXPECT_EQ(other.lower, box.lower);
  EXPECT_EQ(other.upper, box.upper);
}

TEST(SamplePattern, OneSampleIsTheCentreAndManyFillThePixel) {
  EXPECT_EQ(samplePosition(0, 1), dvec2(0.5, 0.5));
  dvec2 mean(0);
  constexpr int kCount = 64;
  for (int i = 0; i < kCount; ++i) {
    const dvec2 p = samplePosition(i, kCount);
    EXPECT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
    mean += p / double(kCount);
  }
  EXPECT_NEAR(mean.x, 0.5, 0.02);
  EXPECT_NEAR(mean.y, 0.5, 0.02);
}

/// eta and an incoming direction on the other side of the normal.
struct Incidence {
  dvec3 direction, normal;
  double eta;
};

Incidence anyIncidence() {
  Incidence in;
  in.normal = anyUnitVector();
  in.direction = anyUnitVector();
  const double along = glm::dot(in.direction, in.normal);
  RC_PRE(std::abs(along) > 1e-3);
  if (along > 0) in.direction = -in.direction;
  in.eta = *rc::gen::inRange(400, 2500) * 1e-3;
  return in;
}

RC_GTEST_PROP(RefractedDirection, ObeysSnellInThePlaneOfIncidence, ()) {
  const Incidence in = anyIncidence();
  const double sine = glm::length(glm::cross(in.direction, in.normal));
  const auto out = findRefractedDirection(in.direction, in.normal, in.eta);
  RC_ASSERT(out.has_value() == (in.eta * sine <= 1));
  if (!out) return;
  RC_ASSERT(std::abs(glm::length(*out) - 1) < 1e-12);
  RC_ASSERT(glm::dot(*out, in.normal) <= 0);
  RC_ASSERT(glm::length(glm::cross(*out, in.normal) - in.eta * glm::cross(in.direction, in.normal)) < 1e-12);
}

RC_GTEST_PROP(RefractedDirection, TheWayBackIsTheSame, ()) {
  const Incidence in = anyIncidence();
  const auto out = findRefractedDirection(in.direction, in.normal, in.eta);
  RC_PRE(out && std::abs(glm::dot(*out, in.normal)) > 1e-3);
  const auto back = findRefractedDirection(-*out, -in.normal, 1 / in.eta);
  RC_ASSERT(back.has_value());
  RC_ASSERT(glm::distance(*back, -in.direction) < 1e-9);
}

}  // namespace
}  // namespace catoptric::core
