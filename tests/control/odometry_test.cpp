// SPDX-License-Identifier: Apache-2.0
// Dead reckoning compared with a plain reference, and one controller that drives the same robot in
// both engines.
#include "control/odometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/error.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "terramechanics/grounds.h"
#include "values.h"
#include "vehicle/encoder.h"
#include "vehicle/physics_engine.h"

namespace navvy::control {
namespace {

scene::Machine shipped_robot() {
  return scene_io::load_machine(std::string(navvy::source_dir()) + "/vehicles/robot/model.sdf");
}

TEST(CountsBetween, TakeTheShorterArc) {
  EXPECT_EQ(counts_between(10, 15, 16), 5);
  EXPECT_EQ(counts_between(15, 10, 16), -5);
  EXPECT_EQ(counts_between(65530, 4, 16), 10);
  EXPECT_EQ(counts_between(4, 65530, 16), -10);
  EXPECT_EQ(counts_between(0, 32767, 16), 32767);
  EXPECT_EQ(counts_between(0, 32768, 16), -32768);
  EXPECT_EQ(counts_between(0xFFFFFFFF, 0, 32), 1);
  EXPECT_EQ(counts_between(3, 0, 2), 1);
}

TEST(DifferentialOdometry, RollsTheArcOfBothSides) {
  // 0.5 and 0.3 m/s on a track of 0.33 m: 0.4 m/s and -0.606 rad/s.
  const double track = 0.33, per_metre = 128e3;
  DifferentialOdometry odometry(track, {per_metre, 16}, {per_metre, 16});
  odometry.reset({Vec2(1, 2), 0.3}, 65000, 100);
  const auto at = [&](double metres, std::uint64_t start) {
    return (start + static_cast<std::uint64_t>(std::llround(metres * per_metre))) & 0xFFFF;
  };
  // Ten readings per second for 5 s: each wheel's register wraps after 512 mm, several times.
  for (int i = 1; i <= 50; ++i) odometry.update(at(0.05 * i, 65000), at(0.03 * i, 100));
  const double yaw_rate = (0.3 - 0.5) / track, radius = 0.4 / yaw_rate;
  EXPECT_NEAR(yaw_rate, -0.606, 5e-4);
  EXPECT_NEAR(odometry.distance(), 2.0, 1e-4);
  EXPECT_NEAR(odometry.pose().yaw, 0.3 + 5 * yaw_rate, 1e-4);
  // The closed form of the arc, which many short arcs must match as well as one long one: half a
  // count per reading.
  const double end = 0.3 + 5 * yaw_rate;
  EXPECT_NEAR(odometry.pose().p.x(), 1 + radius * (std::sin(end) - std::sin(0.3)), 1e-4);
  EXPECT_NEAR(odometry.pose().p.y(), 2 - radius * (std::cos(end) - std::cos(0.3)), 1e-4);
}

TEST(DifferentialOdometry, EqualsAPlainSumOfSmallStepsOnAPathThatTurnsLeftAndRight) {
  const double track = 0.4, per_metre = 1e6;
  DifferentialOdometry odometry(track, {per_metre, 32}, {per_metre, 32});
  odometry.reset({}, 0, 0);
  Vec2 p = Vec2::Zero();
  double yaw = 0, left = 0, right = 0;
  for (int i = 0; i < 40000; ++i) {
    // Steps of 0.1 ms; speeds that change, stop and go backwards.
    const double t = 1e-4 * i, v = 0.5 * std::cos(1.7 * t), w = 1.2 * std::sin(2.3 * t);
    p += 1e-4 * v * Vec2(std::cos(yaw), std::sin(yaw));
    yaw += 1e-4 * w;
    left += 1e-4 * (v - 0.5 * track * w);
    right += 1e-4 * (v + 0.5 * track * w);
    const auto counts = [&](double metres) {
      return static_cast<std::uint64_t>(std::llround(metres * per_metre)) & 0xFFFFFFFF;
    };
    if (i % 50 == 49) odometry.update(counts(left), counts(right));
  }
  // The reference is of first order: v and w change by about 1e-4 in one of its steps.
  EXPECT_LT((odometry.pose().p - p).norm(), 2e-4);
  EXPECT_NEAR(odometry.pose().yaw, yaw, 1e-4);
}

TEST(DifferentialOdometry, NeedsEncodersOnBothSides) {
  scene::Machine robot = shipped_robot();
  EXPECT_NO_THROW(DifferentialOdometry::of(robot));
  robot.encoders.pop_back();
  try {
    DifferentialOdometry::of(robot);
    FAIL() << "odometry of one wheel";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("on the right"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("navvy:encoder"), std::string::npos) << error.what();
  }
  robot.has_drive = false;
  EXPECT_THROW(DifferentialOdometry::of(robot), InputError);
}

/// Drives a square with edges of 1 m, turning on the spot at its corners, as a robot's own computer
/// does: it reads two registers and sets two wheel speeds.
class SquareDriver {
 public:
  static constexpr double kPeriod = 0.02;

  explicit SquareDriver(const scene::Machine& robot)
      : odometry_(DifferentialOdometry::of(robot)),
        track_(std::get<scene::DifferentialDrive>(robot.drive).track),
        radius_(robot.wheels[0].radius) {
    odometry_.reset({}, 0, 0);
  }

  /// @returns wheel speeds, left and right [rad/s].
  Vec2 update(std::uint64_t left, std::uint64_t right) {
    odometry_.update(left, right);
    trace_.push_back(odometry_.pose());
    if (edge_ == 4) return Vec2::Zero();
    // Ramps that the motors can follow: the engines then differ by the ground and not by the motor.
    const double heading = kPi / 2 * edge_;
    double speed = 0, turn = 0;
    if (turning_) {
      const double left_to_turn = heading - odometry_.pose().yaw;
      turn = ramped(left_to_turn, 1.0, 1.5);
      if (std::abs(left_to_turn) < 1e-3)
        turning_ = false, start_ = odometry_.distance(), before_ = 0;
    } else {
      const double left_to_go = start_ + 1 - odometry_.distance();
      speed = ramped(left_to_go, 0.4, 0.5);
      turn = 2 * (heading - odometry_.pose().yaw);
      if (left_to_go < 1e-3) ++edge_, turning_ = true, before_ = 0;
    }
    return Vec2(speed - 0.5 * track_ * turn, speed + 0.5 * track_ * turn) / radius_;
  }
  bool done() const { return edge_ == 4; }
  const std::vector<PlanePose>& trace() const { return trace_; }

 private:
  /// Returns the speed towards a place `left` away: at most `most`, with ramps of `rate` per
  /// second.
  double ramped(double left, double most, double rate) {
    const double stop = std::min(std::sqrt(2 * 0.7 * rate * std::abs(left)), 5 * std::abs(left));
    before_ = std::min({most, stop, before_ + rate * kPeriod});
    return std::copysign(before_, left);
  }

  DifferentialOdometry odometry_;
  double track_, radius_;
  int edge_ = 0;
  bool turning_ = false;
  double start_ = 0, before_ = 0;
  std::vector<PlanePose> trace_;
};

struct Drive {
  std::vector<PlanePose> trace;  ///< dead-reckoned poses
  PlanePose truth;
  double turned = 0, rolled = 0;  ///< travel of the rims and of the middle [m]
};

/// Drives the whole square in an engine; `slip` may falsify the encoders of the kinematic one.
Drive drive_square(const scene::Machine& robot, std::unique_ptr<vehicle::PhysicsEngine> engine,
                   double slip = 0) {
  constexpr double kStep = SquareDriver::kPeriod / 16;
  engine->add_machine(robot, Pose::Identity());
  vehicle::Encoders encoders(robot, *engine, 0, 1);
  for (std::size_t e = 0; e < 2; ++e) encoders[e].set_slip(slip);
  const int left = robot.joint_index(robot.encoders[0].joint),
            right = robot.joint_index(robot.encoders[1].joint);
  Drive out;
  SquareDriver driver(robot);
  for (int i = 0; i < 3000 && !driver.done(); ++i) {
    const Vec2 speeds = driver.update(encoders[0].counts(), encoders[1].counts());
    engine->set_joint(0, left, {vehicle::JointMode::kVelocity, speeds[0]});
    engine->set_joint(0, right, {vehicle::JointMode::kVelocity, speeds[1]});
    for (int k = 0; k < 16; ++k) {
      engine->step(kStep, terramechanics::flat());
      encoders.advance(*engine, 0);
      const vehicle::LinkState base = engine->link(0, 0);
      out.rolled += kStep * base.v_WL.dot(base.X_WL.linear().col(0));
      out.turned += kStep * 0.5 * robot.wheels[0].radius *
                    (engine->wheel(0, 0).spin + engine->wheel(0, 1).spin);
    }
  }
  EXPECT_TRUE(driver.done());
  out.trace = driver.trace();
  out.truth = plane_pose(engine->link(0, 0).X_WL);
  return out;
}

/// Largest distance between the dead-reckoned poses of the two controllers at the same time [m].
double largest_difference(const std::vector<PlanePose>& a, const std::vector<PlanePose>& b) {
  double most = 0;
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i)
    most = std::max(most, (a[std::min(i, a.size() - 1)].p - b[std::min(i, b.size() - 1)].p).norm());
  return most;
}

TEST(OneController, DrivesBothPhysicsEnginesWithSlipAsTheOnlyDifference) {
  const scene::Machine robot = shipped_robot();
  const Drive exact = drive_square(robot, vehicle::make_kinematic_engine());
  const Drive rolling = drive_square(robot, vehicle::make_bullet_engine(Vec3(0, 0, -kGravity)));
  // The controller sees and sets the same in both: the ramps are those of the motors, so its poses
  // are equal at any time except for the solver's residual. 1 mm is an eighth of the travel between
  // two readings.
  const double apart = largest_difference(exact.trace, rolling.trace);
  print_value("distance of both controllers' poses [m]", apart, "0", "");
  EXPECT_LT(apart, 1e-3);
  // Both controllers estimate that they are back at the start.
  for (const Drive& each : {exact, rolling}) EXPECT_LT(each.trace.back().p.norm(), 0.02);
  // In the kinematic engine this is true: half a count per reading, and the chord of a step.
  print_value("odometry off, kinematic [m]", (exact.truth.p - exact.trace.back().p).norm(), "0",
              "");
  EXPECT_LT((exact.truth.p - exact.trace.back().p).norm(), 1e-3);
  EXPECT_NEAR(exact.truth.yaw, std::remainder(exact.trace.back().yaw, 2 * kPi), 1e-3);
  // In the dynamic engine the wheels turn by more than they roll: smaller under load, and slipping.
  const double slip = 1 - rolling.rolled / rolling.turned,
               off = (rolling.truth.p - rolling.trace.back().p).norm();
  print_value("slip with tyres [1]", slip, "0.03 to 0.06", "4 mm of 100 under load, and the tread");
  print_value("odometry off, with tyres [m]", off, "", "");
  EXPECT_GT(slip, 0.02);
  EXPECT_LT(slip, 0.07);
  EXPECT_GT(off, 0.02);
  // With that slip applied, the kinematic robot ends where the dynamic one did.
  const Drive falsified = drive_square(robot, vehicle::make_kinematic_engine(), slip);
  const double left = (falsified.truth.p - rolling.truth.p).norm();
  print_value("falsified kinematics to tyres [m]", left, "0", "");
  // A quarter: slip differs between corners and edges, while one number stands for the whole path.
  EXPECT_LT(left, 0.25 * off);
  EXPECT_LT((falsified.trace.back().p - rolling.trace.back().p).norm(), 0.02);
}

/// A machine of four wheels with encoders; the front ones are steered.
scene::Machine car() {
  scene::Machine out;
  out.links.resize(1);
  const auto add = [&](const char* name, double x, double y, bool steered) {
    scene::Link link;
    link.name = name;
    link.X_ML.translation() = Vec3(x, y, 0.3);
    scene::Joint joint;
    joint.name = name;
    joint.type = scene::Joint::Type::kRevolute;
    joint.parent = 0;
    joint.child = static_cast<int>(out.links.size());
    scene::Wheel wheel;
    wheel.joint = name;
    wheel.radius = 0.3;
    if (steered) wheel.steer_joint = "steering";
    scene::Encoder encoder;
    encoder.joint = name;
    encoder.counts_per_turn = 1000;
    out.links.push_back(link);
    out.joints.push_back(joint);
    out.wheels.push_back(wheel);
    out.encoders.push_back(encoder);
  };
  add("front_left", 2, 0.7, true);
  add("front_right", 2, -0.7, true);
  add("rear_left", -0.5, 0.8, false);
  add("rear_right", -0.5, -0.8, false);
  return out;
}

TEST(WheelOdometry, OfACarRollsOnTheAxleThatIsNotSteered) {
  const scene::Machine machine = car();
  auto odometry = wheel_odometry(machine);
  ASSERT_TRUE(odometry);
  EXPECT_EQ(machine.joints[static_cast<std::size_t>(odometry->left)].name, "rear_left");
  EXPECT_EQ(machine.joints[static_cast<std::size_t>(odometry->right)].name, "rear_right");
  EXPECT_TRUE(odometry->p_M.isApprox(Vec2(-0.5, 0)));
  // The right wheel alone turns once: 0.6 pi metres about the left one, 1.6 m away.
  odometry->estimate.reset({}, 0, 0);
  odometry->estimate.update(0, 1000);
  EXPECT_NEAR(odometry->estimate.pose().yaw, 0.6 * kPi / 1.6, 1e-12);
  EXPECT_NEAR(odometry->estimate.distance(), 0.3 * kPi, 1e-12);
}

TEST(WheelOdometry, NeedsEncodersOnBothWheelsOfAnAxle) {
  scene::Machine machine = car();
  machine.encoders.pop_back();
  EXPECT_FALSE(wheel_odometry(machine));
  machine.encoders.clear();
  EXPECT_FALSE(wheel_odometry(machine));
  // The wheels of two axles are no pair.
  machine = car();
  machine.links[4].X_ML.translation().x() = -1;
  EXPECT_FALSE(wheel_odometry(machine));
}

TEST(WheelOdometry, OfShippedRobotsUsesTheTrackWidthOfTheirDrives) {
  const auto robot = wheel_odometry(shipped_robot());
  ASSERT_TRUE(robot);
  EXPECT_LT(robot->p_M.norm(), 1e-12);
  // Tracks turn about the middle of their rollers, not about the sprockets.
  const auto tracked = wheel_odometry(scene_io::load_machine(std::string(navvy::source_dir()) +
                                                             "/vehicles/tracked_robot/model.sdf"));
  ASSERT_TRUE(tracked);
  EXPECT_LT(tracked->p_M.norm(), 0.05);
}

}  // namespace
}  // namespace navvy::control
