// SPDX-License-Identifier: Apache-2.0
// Random errors, balls in their grid and distances along beams, without a world.
#include "sensor/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sensor/ball_grid.h"
#include "sensor/beam_errors.h"
#include "sensor/shape_mesh.h"

namespace navvy::sensor {
namespace {

constexpr int kBeams = 100000;

struct Moments {
  double mean = 0, sigma = 0;
};

template <class Draw>
Moments moments_of(const Draw& draw) {
  double sum = 0, squares = 0;
  for (int i = 0; i < kBeams; ++i) {
    const double v = draw();
    sum += v;
    squares += v * v;
  }
  return {sum / kBeams, std::sqrt(squares / kBeams - sum * sum / kBeams / kBeams)};
}

TEST(Noise, HasTheMeanAndTheDeviationOfItsParameters) {
  Random random(7);
  scene::SensorNoise description;
  description.type = "gaussian";
  description.mean = 0.05;
  description.stddev = 0.02;
  const Noise noise(description, random);
  const Moments m = moments_of([&] { return noise.apply(3, random) - 3; });
  // 2 % of the parameters: 16 standard errors of the mean, 9 of the deviation.
  EXPECT_NEAR(m.mean, 0.05, 0.02 * 0.05);
  EXPECT_NEAR(m.sigma, 0.02, 0.02 * 0.02);
}

TEST(Noise, RoundsToItsPrecisionAndKeepsItsBias) {
  scene::SensorNoise description;
  description.type = "gaussian_quantized";
  description.stddev = 0.01;
  description.bias_mean = 0.3;
  description.precision = 0.25;
  Random random(3);
  const Noise noise(description, random);
  EXPECT_DOUBLE_EQ(std::abs(noise.bias()), 0.3);
  const double read = noise.apply(1, random);
  EXPECT_DOUBLE_EQ(read, 0.25 * std::round(read / 0.25));
  EXPECT_NEAR(read, 1 + noise.bias(), 0.125 + 5 * 0.01);
}

TEST(Noise, DriftsWithItsDeviationAndCorrelationTime) {
  scene::SensorNoise description;
  description.type = "gaussian";
  description.drift_stddev = 2;
  description.drift_time = 10;
  Random random(11);
  Noise noise(description, random);
  double sum = 0, squares = 0, products = 0, before = 0;
  for (int i = 0; i < kBeams; ++i) {
    noise.advance(10, random);
    sum += noise.bias();
    squares += noise.bias() * noise.bias();
    products += noise.bias() * before;
    before = noise.bias();
  }
  EXPECT_NEAR(std::sqrt(squares / kBeams), 2, 0.05);
  // After one correlation time 1 / e is left.
  EXPECT_NEAR(products / squares, std::exp(-1), 0.02);
}

TEST(BeamErrors, DropAndScatterTheirSharesOfBeams) {
  scene::BeamErrors shares;
  shares.dropped = 0.1;
  shares.outliers = 0.2;
  Random random(5);
  const BeamDisturbance errors({}, shares, 0.1, 20, 0, random);
  int dropped = 0, elsewhere = 0;
  for (int i = 0; i < kBeams; ++i) {
    const double read = errors.apply(4, random);
    if (std::isnan(read))
      ++dropped;
    else if (read != 4)
      ++elsewhere;
  }
  // Five standard deviations of a count of this share.
  EXPECT_NEAR(dropped / double(kBeams), 0.1, 5 * std::sqrt(0.1 * 0.9 / kBeams));
  EXPECT_NEAR(elsewhere / double(kBeams), 0.9 * 0.2, 5 * std::sqrt(0.18 * 0.82 / kBeams));
}

TEST(BeamErrors, MarkDistancesOutsideTheRange) {
  Random random(5);
  const BeamDisturbance errors({}, {}, 0.5, 8, 0.1, random);
  EXPECT_EQ(errors.apply(0.3, random), kTooNear);
  EXPECT_EQ(errors.apply(9, random), kTooFar);
  EXPECT_EQ(errors.apply(kTooFar, random), kTooFar);
  EXPECT_NEAR(errors.apply(4.04, random), 4.0, 1e-12);
}

TEST(BallGrid, FindsTheBallThatASearchOfAllFinds) {
  Random random(1);
  std::vector<sim::SoilBall> balls;
  const auto inside = [&] {
    return Vec3(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(0, 1));
  };
  for (int i = 0; i < 500; ++i)
    balls.push_back({inside().cast<float>(), static_cast<float>(random.uniform(0.02, 0.05))});
  const Vec3 origin(100, -50, 10);
  BallGrid grid;
  grid.build(origin, balls);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = origin + 2 * inside() + Vec3(0, 0, -1);
    const Vec3 d = (origin + inside() - p).normalized();
    double nearest = 10;
    for (const sim::SoilBall& ball : balls) {
      const Vec3 c = origin + ball.p_O.cast<double>() - p;
      const double r = static_cast<double>(ball.radius), along = c.dot(d);
      const double root = along * along - c.squaredNorm() + r * r;
      if (c.norm() <= r)
        nearest = 0;
      else if (root >= 0 && along > 0)
        nearest = std::min(nearest, along - std::sqrt(root));
    }
    const auto hit = grid.first_hit(p, d, 10);
    ASSERT_EQ(hit.has_value(), nearest < 10) << i;
    if (!hit) continue;
    ASSERT_NEAR(*hit, nearest, 1e-9) << i;
    ++hits;
  }
  EXPECT_GT(hits, 300);
}

TEST(BallGrid, IsEmptyWithoutBalls) {
  BallGrid grid;
  grid.build(Vec3::Zero(), {});
  EXPECT_FALSE(grid.first_hit(Vec3::Zero(), Vec3::UnitX(), 10));
}

TEST(ShapeMesh, IsClosedAndWithinItsRoundness) {
  scene::Geometry shape;
  shape.radius = 0.7;
  shape.length = 1.6;
  for (const auto kind : {scene::Geometry::Kind::kSphere, scene::Geometry::Kind::kCylinder,
                          scene::Geometry::Kind::kCapsule, scene::Geometry::Kind::kCone}) {
    shape.kind = kind;
    const geometry::TriangleMesh mesh = mesh_of(shape);
    // The volume by the divergence theorem is positive only if fronts are outwards.
    double volume = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      volume += mesh.corner(t, 0).dot(mesh.area_vector(t)) / 6;
    const double r = shape.radius, l = shape.length, ball = 4.0 / 3 * kPi * r * r * r;
    const double exact = kind == scene::Geometry::Kind::kSphere     ? ball
                         : kind == scene::Geometry::Kind::kCylinder ? kPi * r * r * l
                         : kind == scene::Geometry::Kind::kCapsule  ? kPi * r * r * l + ball
                                                                    : kPi * r * r * l / 3;
    // A gap of kRoundness all over the surface is 3 kRoundness / r of the volume at most.
    EXPECT_NEAR(volume, exact, exact * 3 * kRoundness / r) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace navvy::sensor
