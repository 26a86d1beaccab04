// SPDX-License-Identifier: Apache-2.0
// The shipped excavator compared with its data sheet (vehicles/ew180/SOURCE.md), measured in
// simulation.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "values.h"
#include "vehicle/kinematics.h"
#include "vehicle/machines.h"
#include "vehicle/rating/tool_force.h"

namespace navvy::vehicle {
namespace {

using testing::ew180;
using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

/// ISO 6015: the middle of the cutting edge is held by a strong spring, one cylinder works, all
/// others hold; returns the tip force perpendicular to the radius from the working joint [N].
/// Without gravity, as the standard considers the cylinder's force only; the base is fixed.
double locked_tip_force(double stick, double bucket, const std::string& role, double direction) {
  scene::Machine m = ew180(0.3, stick, bucket);
  m.fixed_base = true;
  auto engine = make_bullet_engine(Vec3::Zero());
  engine->add_machine(m, Pose::Identity());
  const auto ground = flat();
  const int link = m.link_index("bucket"), joint = m.joint_index(role);
  const Vec3 tip = m.buckets[0].p_tip;
  const Vec3 anchor = engine->link(0, link).X_WL * tip;
  Vec3 force = Vec3::Zero();
  engine->set_joint(0, joint, {JointMode::kVelocity, direction * 0.05});
  run(*engine, ground, 3, kStep, [&](double) {
    const LinkState state = engine->link(0, link);
    const Vec3 p = state.X_WL * tip,
               v = state.v_WL + state.w_WL.cross(p - state.X_WL.translation());
    force = -5e6 * (p - anchor) - 4e4 * v;
    engine->add_force(0, link, force, p);
  });
  EXPECT_TRUE(engine->joint(0, joint).stalled);
  const Vec3 pivot =
      engine->link(0, m.joints[static_cast<std::size_t>(joint)].child).X_WL.translation();
  const Vec3 arm = (engine->link(0, link).X_WL * tip - pivot).normalized();
  return (force - force.dot(arm) * arm).norm();
}

TEST(Ew180, BreakoutForceIs120kN) {
  const double measured = locked_tip_force(-1.5, -0.723, "bucket_joint", -1);
  print_value("breakout force, tip locked [N]", measured, "120e3 +-5 %",
              "ISO 6015; vehicles/ew180/SOURCE.md");
  EXPECT_NEAR(measured, 120e3, 0.05 * 120e3);
}

TEST(Ew180, TearOutForceIs90kN) {
  const double measured = locked_tip_force(-1.415, -0.723, "arm_joint", -1);
  print_value("tear-out force, tip locked [N]", measured, "90e3 +-5 %",
              "ISO 6015; vehicles/ew180/SOURCE.md");
  EXPECT_NEAR(measured, 90e3, 0.05 * 90e3);
}

TEST(Ew180, RatedToolForcesAreThoseMeasuredWithTheTipLocked) {
  const scene::Machine m = ew180();
  const RatedToolForce breakout = rate_tool_force(m, ToolForceKind::kBreakout).rated,
                       tear_out = rate_tool_force(m, ToolForceKind::kTearOut).rated;
  print_value("rated breakout force [N]", breakout.hydraulic, "120e3 +-5 %",
              "ISO 6015; vehicles/ew180/SOURCE.md");
  print_value("rated tear-out force [N]", tear_out.hydraulic, "90e3 +-5 %",
              "ISO 6015; vehicles/ew180/SOURCE.md");
  EXPECT_NEAR(breakout.hydraulic, 120e3, 0.05 * 120e3);
  EXPECT_NEAR(tear_out.hydraulic, 90e3, 0.05 * 90e3);
  // 1 %: the tip is held by a spring, so the joints yield by a degree.
  EXPECT_NEAR(locked_tip_force(breakout.stick, breakout.bucket, "bucket_joint", -1),
              breakout.hydraulic, 0.01 * breakout.hydraulic);
  EXPECT_NEAR(locked_tip_force(tear_out.stick, tear_out.bucket, "arm_joint", -1),
              tear_out.hydraulic, 0.01 * tear_out.hydraulic);
}

/// Pulls at the cutting edge against its digging direction, the machine standing with its brakes
/// on, until `over` returns true; returns the force [N]. The force grows to 0.8 of `expected`
/// within two seconds, then by 1 kN/s.
double pulled_until(scene::Machine m, const RatedToolForce& at, double expected,
                    const std::function<bool(const PhysicsEngine&)>& over) {
  const auto set = [&](const std::string& name, double q) {
    m.joints.at(static_cast<std::size_t>(m.joint_index(name))).initial = q;
  };
  set("boom_joint", at.boom);
  set("arm_joint", at.stick);
  set("bucket_joint", at.bucket);
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  DriveInput brake;
  brake.brake = true;
  engine->set_drive(0, brake);
  const auto ground = flat();
  run(*engine, ground, 2, kStep);
  const double pitch = at.boom + at.stick + at.bucket;
  const Vec3 direction(std::sin(pitch), 0, -std::cos(pitch));
  const int link = m.link_index("bucket");
  double force = 0, result = 0;
  run(*engine, ground, 60, kStep, [&](double) {
    if (result > 0) return;
    force += kStep * (force < 0.8 * expected ? 0.4 * expected : 1000);
    engine->add_force(0, link, -force * direction, engine->link(0, link).X_WL * m.buckets[0].p_tip);
    if (over(*engine)) result = force;
  });
  return result;
}

TEST(Ew180, TipsAtTheToolForceThatItsRatingGives) {
  // Far ahead, the edge pulls down: the front wheels lift. Its own cylinders would yield before.
  scene::Machine m = ew180();
  for (scene::Cylinder& cylinder : m.cylinders) cylinder.pressure *= 4;
  const RatedToolForce at = tool_force_at(m, ToolForceKind::kBreakout, 0.1, -0.8, 0.3);
  ASSERT_EQ(at.limit(), ForceLimit::kTipping);
  const double measured = pulled_until(m, at, at.tipping, [](const PhysicsEngine& engine) {
    return engine.wheel(0, 0).force_W.z() <= 0 && engine.wheel(0, 1).force_W.z() <= 0;
  });
  print_value("tool force that lifts the front wheels [N]", measured,
              std::to_string(at.tipping) + " +-5 %", "moment balance");
  // 5 %: the balance assumes rigid tyres.
  EXPECT_NEAR(measured, at.tipping, 0.05 * at.tipping);
}

TEST(Ew180, SlipsAtTheToolForceThatItsRatingGives) {
  // The edge below the stick pulls towards the machine. Wheels of low grip slip before it tips.
  const scene::Machine m = testing::with_grip(ew180(), 0.3);
  const RatedToolForce at = tool_force_at(m, ToolForceKind::kBreakout, 0.4, -1.6, -0.4);
  ASSERT_EQ(at.limit(), ForceLimit::kSlipping);
  double start = std::nan("");
  const double measured = pulled_until(m, at, at.slipping, [&](const PhysicsEngine& engine) {
    const double x = engine.link(0, 0).X_WL.translation().x();
    if (std::isnan(start)) start = x;
    // Tyres yield by a centimetre before.
    return x - start > 0.03;
  });
  print_value("tool force that makes the wheels slip [N]", measured,
              std::to_string(at.slipping) + " +-5 %", "friction of the tyres");
  EXPECT_NEAR(measured, at.slipping, 0.05 * at.slipping);
}

TEST(Ew180, SwingTorqueIs48kNm) {
  const scene::Machine m = ew180();
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  const auto ground = flat();
  run(*engine, ground, 1, kStep);
  const int swing = m.joint_index("swing_joint"), upper = m.link_index("upper");
  const Vec3 anchor = engine->link(0, upper).X_WL * Vec3(2, 0, 0.5);
  engine->set_joint(0, swing, {JointMode::kVelocity, 0.5});
  double moment = 0;
  run(*engine, ground, 3, kStep, [&](double) {
    const LinkState state = engine->link(0, upper);
    const Vec3 p = state.X_WL * Vec3(2, 0, 0.5),
               v = state.v_WL + state.w_WL.cross(p - state.X_WL.translation());
    Vec3 force = -3e5 * (p - anchor) - 1e5 * v;
    force.x() = force.z() = 0;
    engine->add_force(0, upper, force, p);
    moment = (p - state.X_WL.translation()).cross(force).z();
  });
  print_value("swing torque [N m]", std::abs(moment), "48e3 +-5 %, tolerance 2 %",
              "vehicles/ew180/SOURCE.md");
  EXPECT_NEAR(std::abs(moment), 48e3, 0.02 * 48e3);
  EXPECT_TRUE(engine->joint(0, swing).stalled);
}

TEST(Ew180, SwingsAQuarterTurnInThreeToFiveSecondsWithoutOvershoot) {
  const scene::Machine m = ew180();
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  const auto ground = flat();
  run(*engine, ground, 1, kStep);
  const int swing = m.joint_index("swing_joint");
  engine->set_joint(0, swing, {JointMode::kPosition, radians(90)});
  double arrived = 0, furthest = 0;
  run(*engine, ground, 8, kStep, [&](double t) {
    const double q = engine->joint(0, swing).position;
    furthest = std::max(furthest, q);
    if (std::abs(q - radians(90)) > radians(2)) arrived = t;
  });
  EXPECT_GT(arrived, 2);
  EXPECT_LT(arrived, 5);
  EXPECT_LT(furthest, radians(91));
}

/// Returns the mass moment about the tipping edge of everything except the load [kg m].
double righting_moment(const scene::Machine& m, double swing, double boom, double stick,
                       double bucket, double edge) {
  std::vector<double> q;
  for (const scene::Joint& joint : m.joints) q.push_back(joint.initial);
  q[static_cast<std::size_t>(m.joint_index("swing_joint"))] = swing;
  q[static_cast<std::size_t>(m.joint_index("boom_joint"))] = boom;
  q[static_cast<std::size_t>(m.joint_index("arm_joint"))] = stick;
  q[static_cast<std::size_t>(m.joint_index("bucket_joint"))] = bucket;
  const auto poses = forward_kinematics(m, Pose::Identity(), q);
  double sum = 0;
  for (std::size_t i = 0; i < m.links.size(); ++i)
    sum += m.links[i].mass * (edge - (poses[i] * m.links[i].p_LCom).y());
  return sum;
}

TEST(Ew180, TippingLoadAt7mOverTheSideIsTheMomentBalance) {
  // Arm to the left; angles that put the bucket's pin 7 m from the swing axis.
  const double swing = radians(90), boom = 0.55, bucket = -1.6;
  double stick = -0.6;
  const scene::Machine probe = ew180(boom, stick, bucket, swing);
  const auto reach = [&](double s) {
    return 0.25 + 5.1 * std::cos(boom) + 2.45 * std::cos(boom + s);
  };
  for (int i = 0; i < 60 && reach(stick) > 7; ++i) stick -= 0.01;
  const double lever = reach(stick);
  ASSERT_NEAR(lever, 7, 0.1);
  const scene::Machine m = ew180(boom, stick, bucket, swing);
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  const auto ground = flat();
  run(*engine, ground, 2, kStep);
  // The edge is the middle of the twin pair: when the far wheels lift, both tyres of the pair still
  // carry, and their stiffness against rolling (0.16^2 k, 120 kN m/rad for both pairs) is less than
  // the machine's weight times height.
  const double edge = 0.97;
  const double expected = righting_moment(m, swing, boom, stick, bucket, edge) / (lever - edge);
  double load = 0, tipped_at = 0;
  const int link = m.link_index("bucket");
  // The load grows by 100 kg/s; it tips when both right wheels carry nothing.
  run(*engine, ground, 30, 2 * kStep, [&](double) {
    if (tipped_at > 0) return;
    load += 100 * 2 * kStep;
    engine->add_force(0, link, load * kDown, engine->link(0, link).X_WL.translation());
    if (engine->wheel(0, 1).force_W.z() <= 0 && engine->wheel(0, 3).force_W.z() <= 0)
      tipped_at = load;
  });
  ASSERT_GT(tipped_at, 0);
  print_value("tipping load at 7 m over the side [kg]", tipped_at,
              std::to_string(expected) + " +-5 %", "moment balance");
  // 5 %: the balance assumes rigid tyres, while the machine leans on its own by a degree.
  EXPECT_NEAR(tipped_at, expected, 0.05 * expected);
  EXPECT_GT(expected, 1600);  // the class lifts about 2 t there
  EXPECT_LT(expected, 3000);
}

TEST(Ew180, Weighs18TonsAndItsCylindersLiftAFullBucketAtFullReach) {
  const scene::Machine m = ew180(0, -0.6, -1.5);
  double mass = 0;
  for (const scene::Link& link : m.links) mass += link.mass;
  EXPECT_DOUBLE_EQ(mass, 18000);
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  const auto ground = flat();
  const int boom = m.joint_index("boom_joint"), link = m.link_index("bucket");
  engine->set_joint(0, boom, {JointMode::kPosition, 0.5});
  run(*engine, ground, 4, kStep, [&](double) {
    engine->add_force(0, link, 1400 * kDown, engine->link(0, link).X_WL * Vec3(0.7, 0, 0.2));
  });
  EXPECT_NEAR(engine->joint(0, boom).position, 0.5, 0.01);
}

TEST(Ew180, LiftsItselfOnItsBoomWithinItsCylinderSpeeds) {
  // Boom rates are those of the pump: flow / (area x lever).
  const scene::Machine m = ew180(-0.3, -1.6, -1.0);
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  const auto ground = testing::FunctionGround([](double, double) { return 0.0; });
  const int boom = m.joint_index("boom_joint");
  engine->set_joint(0, boom, {JointMode::kPosition, 0.9});
  double most = 0;
  run(*engine, ground, 4, kStep, [&](double) {
    const JointState state = engine->joint(0, boom);
    const CylinderLimits limits = cylinder_limits(m, m.cylinders[0], state.position);
    most = std::max(most, state.velocity / limits.speed_positive);
  });
  // 1 %: the limit applies to the step's start.
  EXPECT_LE(most, 1.01);
  EXPECT_GT(most, 0.95);
}

TEST(Ew180, WorkOfTheCylindersEqualsThePotentialEnergyGained) {
  scene::Machine m = ew180(0, -1.2, -1.0);
  m.fixed_base = true;
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  const auto ground = flat();
  const auto height = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < m.links.size(); ++i)
      sum += m.links[i].mass * (engine->link(0, static_cast<int>(i)).X_WL * m.links[i].p_LCom).z();
    return sum;
  };
  run(*engine, ground, 1, kStep);
  const double before = engine->accounts()->work(0), low = height();
  engine->set_joint(0, m.joint_index("boom_joint"), {JointMode::kPosition, 0.7});
  run(*engine, ground, 5, kStep);
  const double expected = kGravity * (height() - low);
  EXPECT_GT(expected, 50e3);
  // 1 %: forces of the first order in the step.
  EXPECT_NEAR(engine->accounts()->work(0) - before, expected, 0.01 * expected);
}

TEST(Ew180, BucketShellIsWoundInwardAndHoldsItsVolume) {
  const scene::Machine m = ew180();
  ASSERT_EQ(m.shells.size(), 1u);
  ASSERT_EQ(m.buckets.size(), 1u);
  const scene::Shell& shell = m.shells[0];
  const scene::Bucket& bucket = m.buckets[0];
  const Vec3 inside(0.65, 0, 0.25);
  double volume = 0;
  for (const auto& t : shell.triangles) {
    const Vec3 a = shell.vertices[static_cast<std::size_t>(t[0])],
               b = shell.vertices[static_cast<std::size_t>(t[1])],
               c = shell.vertices[static_cast<std::size_t>(t[2])];
    EXPECT_GT((b - a).cross(c - a).dot(inside - a), 0);
    volume += (b - a).cross(c - a).dot(inside - a) / 6;
  }
  // The pyramid over the mouth is missing: its area times its height over 3.
  const Vec3 tip(1.4, 0, 0), top(0.08, 0, 0.1);
  const double away = std::abs((tip - top).normalized().cross(inside - top).y());
  // 1.05 m wide at the tip, 0.98 m from the heel on; 1.002 m is the mean along the mouth.
  const double l = (tip - top).norm(), w = 1.002;
  volume += l * w * away / 3;
  EXPECT_NEAR(volume, 0.523, 0.002);
  // With a heap of 1:1 on the mouth it is the bucket's capacity, within 5 %.
  EXPECT_NEAR(volume + w * w * l / 4 - w * w * w / 12, bucket.capacity, 0.05 * bucket.capacity);
  EXPECT_TRUE(bucket.p_tip.isApprox(tip));
  EXPECT_GT(bucket.cut_direction.x(), 0);
  EXPECT_LT(bucket.cut_direction.z(), 0);
  EXPECT_NEAR(bucket.cut_direction.norm(), 1, 1e-9);
}

TEST(Ew180, ReachMatchesTheDataSheet) {
  const scene::Machine m = ew180();
  double depth = 0, reach = 0;
  const auto joint = [&](const std::string& name) -> const scene::Joint& {
    return m.joints.at(static_cast<std::size_t>(m.joint_index(name)));
  };
  std::vector<double> q(m.joints.size(), 0.0);
  for (int i = 0; i <= 40; ++i)
    for (int k = 0; k <= 40; ++k) {
      const scene::Joint &boom = joint("boom_joint"), &stick = joint("arm_joint");
      q[static_cast<std::size_t>(m.joint_index("boom_joint"))] =
          boom.lower + (boom.upper - boom.lower) * i / 40;
      q[static_cast<std::size_t>(m.joint_index("arm_joint"))] =
          stick.lower + (stick.upper - stick.lower) * k / 40;
      for (const double b : {-1.2, -0.8, -0.4, 0.0, 0.4}) {
        q[static_cast<std::size_t>(m.joint_index("bucket_joint"))] = b;
        const auto poses = forward_kinematics(m, Pose::Identity(), q);
        const Vec3 tip =
            poses[static_cast<std::size_t>(m.link_index("bucket"))] * m.buckets[0].p_tip;
        depth = std::min(depth, tip.z());
        if (std::abs(tip.z()) < 0.2) reach = std::max(reach, tip.x() - 1.25);
      }
    }
  // Data sheet: 5.7 m and 9.3 m from the swing axis; 5 %, its boom is bent and its ranges are
  // unverified.
  EXPECT_NEAR(-depth, 5.7, 0.05 * 5.7);
  EXPECT_NEAR(reach, 9.3, 0.10 * 9.3);
}

}  // namespace
}  // namespace navvy::vehicle
