// SPDX-License-Identifier: Apache-2.0
#include "control/curvature_feedback.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace navvy::control::testing {
namespace {

constexpr double kStep = 0.002;  // [s]

scene::AckermannDrive two_sides() {
  scene::AckermannDrive out;
  out.wheelbase = 0.7;
  out.max_steer = std::atan(2);
  out.steer_rate = std::numeric_limits<double>::infinity();
  return out;
}

/// A machine on two sides whose yaw rate follows a share of its command, with a lag of 0.2 s.
struct Skid {
  CurvatureFeedback feedback;
  CurvatureFeedback::Steering steering;
  PlanePose at;
  double rate = 0;

  void run(double seconds, double share, double curvature, double speed) {
    const scene::AckermannDrive bicycle = two_sides();
    for (double t = 0; t < seconds; t += kStep) {
      steering = feedback.correct(bicycle, at, std::atan(curvature * bicycle.wheelbase), speed,
                                  speed, kStep);
      const double commanded = std::tan(steering.angle) / bicycle.wheelbase * speed;
      rate += kStep / 0.2 * (share * commanded - rate);
      at.yaw += kStep * rate;
    }
  }
};

TEST(CurvatureFeedback, MakesASkiddingMachineTurnAtTheWantedRate) {
  for (const double share : {0.4, 0.7, 1.0})
    for (const double speed : {0.5, -0.5}) {
      Skid skid;
      skid.feedback.begin(skid.at);
      skid.run(20, share, 0.8, speed);
      // Three wheelbases of distance settle it to a percent.
      EXPECT_NEAR(skid.rate, 0.8 * speed, 0.01 * 0.4) << share << " " << speed;
      EXPECT_NEAR(skid.steering.ease, 1, 0.01);
    }
}

TEST(CurvatureFeedback, SlowsDownAMachineThatDoesNotTurn) {
  Skid skid;
  skid.feedback.begin(skid.at);
  skid.run(10, 0, 0.8, 0.5);
  EXPECT_NEAR(skid.steering.ease, 0.3, 0.05);
  // The correction is at most twice the wanted curvature and a little more.
  EXPECT_LT(std::tan(skid.steering.angle) / 0.7, 3.4 * 0.8);
  // Asked to go straight, nothing but that little is left.
  skid.run(0.1, 0, 0, 0.5);
  EXPECT_LT(std::abs(std::tan(skid.steering.angle) / 0.7), 0.3);
}

TEST(CurvatureFeedback, DoesNotCorrectASteeredMachineThatStandsOrTurnsItsWheels) {
  scene::AckermannDrive bicycle;
  CurvatureFeedback feedback;
  PlanePose at;
  feedback.begin(at);
  CurvatureFeedback::Steering steering;
  for (int i = 0; i < 1000; ++i) steering = feedback.correct(bicycle, at, 0.3, 1, 0, kStep);
  EXPECT_DOUBLE_EQ(steering.angle, std::atan(std::tan(0.3)));
  EXPECT_EQ(steering.ease, 1);
  // Rolling: the bicycle follows its wheels, which turn at the drive's rate.
  double turned = 0;
  feedback.begin(at);
  for (int i = 0; i < 3000; ++i) {
    steering = feedback.correct(bicycle, at, 0.3, 1, 1, kStep);
    turned += std::min(steering.angle - turned, bicycle.steer_rate * kStep);
    at.yaw += kStep * std::tan(turned) / bicycle.wheelbase;
  }
  // The filter of the yaw rate lags by 0.1 s, in which the wheels turn by 0.05 rad.
  EXPECT_NEAR(steering.angle, 0.3, 0.01);
}

}  // namespace
}  // namespace navvy::control::testing
