// SPDX-License-Identifier: Apache-2.0
// Springs of joints, fixed ratios between joints and closed loops, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/saved_state.h"
#include "scene/close_loops.h"
#include "values.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::box_link;
using testing::digest;
using testing::flat;
using testing::revolute;
using testing::run;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

scene::Joint slider(const std::string& name, int parent, int child, const Vec3& axis) {
  scene::Joint joint = revolute(name, parent, child, axis);
  joint.type = scene::Joint::Type::kPrismatic;
  return joint;
}

/// Returns a mass [kg] on a vertical spring [N/m] below a fixed base, with viscous damping
/// [N s/m].
scene::Machine hung(double mass, double stiffness, double damping) {
  scene::Machine m;
  m.name = "hung";
  m.fixed_base = true;
  m.links = {box_link("base", make_pose(0, 0, 3), 100, Vec3::Zero(), Vec3::Ones()),
             box_link("mass", make_pose(0, 0, 2), mass, Vec3::Zero(), Vec3(0.2, 0.2, 0.2))};
  m.joints = {slider("slide", 0, 1, Vec3::UnitZ())};
  m.joints[0].stiffness = stiffness;
  m.joints[0].damping = damping;
  m.joints[0].passive = true;
  return m;
}

TEST(JointSpring, SagsByWeightOverStiffnessAtAnyStiffness) {
  // The stiffest one has a period of 2 ms, 1.2 steps.
  for (const double stiffness : {2e3, 5e4, 1e9}) {
    constexpr double kMass = 100;
    // Near critical damping, at most what the step carries.
    const double damping = std::min(2 * std::sqrt(stiffness * kMass), 5e4);
    const auto engine = make_bullet_engine(kDown);
    engine->add_machine(hung(kMass, stiffness, damping), Pose::Identity());
    run(*engine, flat(), 8, kStep);
    const double sag = -engine->joint(0, 0).position, expected = kMass * kGravity / stiffness;
    print_value("sag of 100 kg on " + std::to_string(stiffness) + " N/m [m]", sag,
                std::to_string(expected) + " within 1 %", "m g / k");
    EXPECT_NEAR(sag, expected, 0.01 * expected);
    EXPECT_NEAR(engine->joint(0, 0).velocity, 0, 1e-6);
  }
}

TEST(JointSpring, SwingsWithItsPeriodAndLosesNoEnergy) {
  constexpr double kMass = 50, kStiffness = 5e3, kStart = 0.1;
  scene::Machine machine = hung(kMass, kStiffness, 0);
  machine.joints[0].rest = -kStart;
  const auto engine = make_bullet_engine(Vec3::Zero());
  engine->add_machine(machine, Pose::Identity());
  const double period = 2 * kPi * std::sqrt(kMass / kStiffness);
  double before = kStart, last = 0, most = 0;
  int passes = 0;
  run(*engine, flat(), 20.1 * period, kStep, [&](double t) {
    // Stretch against the relaxed position; the mass starts at +0.1 m.
    const double x = engine->joint(0, 0).position + kStart;
    if (before <= 0 && x > 0) last = t, ++passes;
    if (t > 19 * period) most = std::max(most, std::abs(x));
    before = x;
  });
  // The first upward pass is after three quarters of a period.
  const double measured = last / (passes - 0.25);
  print_value("period on the spring [s]", measured, std::to_string(period) + " within 0.5 %",
              "2 pi sqrt(m / k)");
  print_value("amplitude after 19 periods [m]", most, "0.1 within 2 %", "no damping");
  EXPECT_NEAR(measured, period, 0.005 * period);
  EXPECT_NEAR(most, kStart, 0.02 * kStart);
}

TEST(JointSpring, OfTorsionHoldsALeverWhereMomentsBalance) {
  constexpr double kMass = 20, kLever = 0.8, kStiffness = 400;
  scene::Machine m;
  m.name = "lever";
  m.fixed_base = true;
  m.links = {box_link("base", make_pose(0, 0, 2), 100, Vec3::Zero(), Vec3::Ones()),
             box_link("lever", make_pose(0, 0, 2), kMass, Vec3(kLever, 0, 0), Vec3(1, 0.1, 0.1))};
  m.joints = {revolute("hinge", 0, 1, -Vec3::UnitY())};
  m.joints[0].stiffness = kStiffness;
  m.joints[0].damping = 60;
  m.joints[0].passive = true;
  const auto engine = make_bullet_engine(kDown);
  engine->add_machine(m, Pose::Identity());
  run(*engine, flat(), 10, kStep);
  const double q = engine->joint(0, 0).position;
  print_value("moment of the torsion spring [N m]", -kStiffness * q,
              std::to_string(kMass * kGravity * kLever * std::cos(q)) + " within 1 %",
              "m g r cos q");
  EXPECT_NEAR(-kStiffness * q, kMass * kGravity * kLever * std::cos(q),
              0.01 * kMass * kGravity * kLever);
}

// A crank-rocker in the plane x-z, of 1 m between its fixed pivots.
constexpr double kCrank = 0.3, kCoupler = 0.9, kRocker = 0.7;

/// Returns the end of the rocker where the crank has turned by `angle` from x towards z [rad].
Vec3 rocker_end(double angle) {
  const Vec3 B(kCrank * std::cos(angle), 0, kCrank * std::sin(angle)), D(1, 0, 0);
  const Vec3 way = D - B;
  const double d = way.norm(), along = (d * d + kCoupler * kCoupler - kRocker * kRocker) / (2 * d),
               up = std::sqrt(kCoupler * kCoupler - along * along);
  const Vec3 left(-way.z() / d, 0, way.x() / d);
  return B + along / d * way + up * left;
}

/// Returns the rocker's angle from x towards z [rad].
double rocker_angle(double crank) {
  const Vec3 arm = rocker_end(crank) - Vec3(1, 0, 0);
  return std::atan2(arm.z(), arm.x());
}

/// Returns the four-bar with the crank upright, its links' frames in their pivots, all axes -y. The
/// closing joint's axis is turned by `skew` [rad] about x.
scene::Machine four_bar(double skew = 0) {
  const Vec3 up(0, 0, 2), B = Vec3(0, 0, kCrank), C = rocker_end(kPi / 2), D(1, 0, 0);
  const auto at = [&](const Vec3& p) { return Pose(Eigen::Translation3d(p + up)); };
  scene::Machine m;
  m.name = "four_bar";
  m.fixed_base = true;
  m.links = {
      box_link("base", at(Vec3::Zero()), 50, Vec3::Zero(), Vec3::Ones()),
      box_link("crank", at(Vec3::Zero()), 5, 0.5 * B, Vec3(0.05, 0.05, kCrank)),
      box_link("rocker", at(D), 8, 0.5 * (C - D), Vec3(0.05, 0.05, kRocker)),
      box_link("coupler", at(B), 10, 0.5 * (C - B), Vec3(kCoupler, 0.05, 0.05)),
  };
  const Vec3 axis = -Vec3::UnitY();
  m.joints = {revolute("motor", 0, 1, axis), revolute("rocker_pivot", 0, 2, axis),
              revolute("crank_pin", 1, 3, axis)};
  m.joints[1].passive = m.joints[2].passive = true;
  scene::LoopJoint loop;
  loop.name = "rocker_pin";
  loop.type = scene::LoopJoint::Type::kRevolute;
  loop.parent = 2;
  loop.child = 3;
  loop.axis = Eigen::AngleAxisd(skew, Vec3::UnitX()) * axis;
  loop.X_LpJ.translation() = C - D;
  loop.X_LcJ.translation() = C - B;
  m.loops = {loop};
  return m;
}

double gap_of(const PhysicsEngine& engine, const scene::Machine& machine) {
  const scene::LoopJoint& loop = machine.loops[0];
  const Pose X_WP = engine.link(0, loop.parent).X_WL, X_WC = engine.link(0, loop.child).X_WL;
  return scene::loop_gap(loop, X_WP, X_WC).head<3>().norm();
}

/// Largest gap [m] and largest error of the rocker's angle [rad] of a run.
struct Errors {
  double gap = 0, angle = 0;
};

Errors turn_crank(PhysicsEngine& engine, const scene::Machine& machine, double speed,
                  double duration) {
  Errors out;
  engine.set_joint(0, 0, {JointMode::kVelocity, speed});
  run(engine, flat(), duration, kStep, [&](double) {
    const double crank = kPi / 2 + engine.joint(0, 0).position;
    const double rocker = rocker_angle(kPi / 2) + engine.joint(0, 1).position;
    out.gap = std::max(out.gap, gap_of(engine, machine));
    out.angle = std::max(out.angle, std::abs(rocker - rocker_angle(crank)));
  });
  return out;
}

TEST(ClosedLoop, FourBarStaysClosedAndMovesAsComputed) {
  const scene::Machine machine = four_bar();
  const auto engine = make_bullet_engine(kDown);
  engine->add_machine(machine, Pose::Identity());
  const Errors errors = turn_crank(*engine, machine, 3, 10);
  print_value("gap of a four-bar at 3 rad/s [m]", errors.gap, "at most 1e-4", "closed loop");
  print_value("error of its rocker's angle [rad]", errors.angle, "at most 1e-3", "closed form");
  print_value("turns of its crank [-]", engine->joint(0, 0).position / (2 * kPi), "4.7 or more",
              "velocity servo");
  EXPECT_LT(errors.gap, 1e-4);
  EXPECT_LT(errors.angle, 1e-3);
  EXPECT_GT(engine->joint(0, 0).position, 29);
}

TEST(ClosedLoop, HoldsItsLoadAtRest) {
  // The crank holds all three links by virtual work: the torque is the change of the potential
  // energy per angle, here by a central difference over the closed form.
  const scene::Machine machine = four_bar();
  const auto engine = make_bullet_engine(kDown);
  engine->add_machine(machine, Pose::Identity());
  run(*engine, flat(), 3, kStep);
  const auto energy = [](double crank) {
    const double B = kCrank * std::sin(crank), C = rocker_end(crank).z();
    return kGravity * (5 * 0.5 * B + 8 * 0.5 * C + 10 * 0.5 * (B + C));
  };
  const double crank = kPi / 2 + engine->joint(0, 0).position, d = 1e-5;
  const double expected = (energy(crank + d) - energy(crank - d)) / (2 * d);
  print_value("torque that holds a four-bar [N m]", engine->joint(0, 0).effort,
              std::to_string(expected) + " within 1 %", "virtual work");
  EXPECT_NEAR(engine->joint(0, 0).effort, expected, 0.01 * std::abs(expected));
  EXPECT_LT(gap_of(*engine, machine), 1e-4);
}

TEST(ClosedLoop, WithAxesParallelButForRoundingDoesNotLock) {
  const scene::Machine machine = four_bar(1e-3);
  const auto engine = make_bullet_engine(kDown);
  engine->add_machine(machine, Pose::Identity());
  const Errors errors = turn_crank(*engine, machine, 3, 5);
  EXPECT_GT(engine->joint(0, 0).position, 14);
  EXPECT_LT(errors.gap, 2e-3);
}

TEST(ClosedLoop, OfAFreeMachineKeepsItsMomentum) {
  scene::Machine machine = four_bar();
  machine.fixed_base = false;
  const auto engine = make_bullet_engine(Vec3::Zero());
  engine->add_machine(machine, Pose::Identity());
  const Errors errors = turn_crank(*engine, machine, 3, 3);
  EXPECT_LT(errors.gap, 1e-3);
  EXPECT_LT(errors.angle, 1e-2);
  // 23 kg move at up to 1 m/s.
  EXPECT_LT(engine->accounts()->momentum(0).norm(), 0.02);
}

/// Returns a crank of 0.3 m that moves a slider along x through a rod of 0.8 m. A joint of `type`
/// between slider and base closes the loop: prismatic, or ball and fixed, which lock it.
scene::Machine slider_crank(scene::LoopJoint::Type type) {
  const auto at = [&](double x) { return Pose(Eigen::Translation3d(x, 0, 2)); };
  scene::Machine m;
  m.name = "slider_crank";
  m.fixed_base = true;
  m.links = {box_link("base", at(0), 50, Vec3::Zero(), Vec3::Ones()),
             box_link("crank", at(0), 4, Vec3(0.15, 0, 0), Vec3(0.3, 0.05, 0.05)),
             box_link("rod", at(0.3), 4, Vec3(0.4, 0, 0), Vec3(0.8, 0.05, 0.05)),
             box_link("slider", at(1.1), 6, Vec3::Zero(), Vec3(0.1, 0.1, 0.1))};
  m.joints = {revolute("motor", 0, 1, -Vec3::UnitY()), revolute("crank_pin", 1, 2, -Vec3::UnitY()),
              revolute("slider_pin", 2, 3, -Vec3::UnitY())};
  m.joints[1].passive = m.joints[2].passive = true;
  scene::LoopJoint loop;
  loop.name = "guide";
  loop.type = type;
  loop.parent = 0;
  loop.child = 3;
  loop.axis = Vec3::UnitX();
  loop.X_LpJ.translation() = Vec3(1.1, 0, 0);
  m.loops = {loop};
  return m;
}

TEST(ClosedLoop, SliderCrankFollowsTheClosedForm) {
  const scene::Machine machine = slider_crank(scene::LoopJoint::Type::kPrismatic);
  const auto engine = make_bullet_engine(kDown);
  engine->add_machine(machine, Pose::Identity());
  engine->set_joint(0, 0, {JointMode::kVelocity, 3});
  double worst = 0, tilt = 0;
  run(*engine, flat(), 6, kStep, [&](double) {
    const double q = engine->joint(0, 0).position, s = 0.3 * std::sin(q);
    const Pose X = engine->link(0, 3).X_WL;
    worst = std::max(worst,
                     std::abs(X.translation().x() - 0.3 * std::cos(q) - std::sqrt(0.64 - s * s)));
    worst = std::max(worst, std::abs(X.translation().z() - 2));
    tilt = std::max(tilt, std::acos(std::min(1.0, X.linear()(2, 2))));
  });
  print_value("error of a slider-crank [m]", worst, "at most 2e-4", "closed form");
  EXPECT_LT(worst, 2e-4);
  EXPECT_LT(tilt, 1e-3);
  EXPECT_GT(engine->joint(0, 0).position, 17);
}

TEST(ClosedLoop, ByABallOrAWeldHoldsTheMechanism) {
  for (const auto type : {scene::LoopJoint::Type::kBall, scene::LoopJoint::Type::kFixed}) {
    scene::Machine machine = slider_crank(type);
    machine.joints[0].passive = true;
    const auto engine = make_bullet_engine(kDown);
    engine->add_machine(machine, Pose::Identity());
    run(*engine, flat(), 3, kStep);
    const double away = (engine->link(0, 3).X_WL.translation() - Vec3(1.1, 0, 2)).norm();
    EXPECT_LT(away, type == scene::LoopJoint::Type::kBall ? 2e-3 : 1e-3);
    // At its dead centre the chain sags until the loop is tight: 1.1 m is its full length.
    EXPECT_LT(std::abs(engine->joint(0, 0).position), 0.1);
  }
}

TEST(ClosedLoop, OfAKinematicMachineFollowsItsCrank) {
  const scene::Machine machine = four_bar();
  const auto engine = make_kinematic_engine();
  engine->add_machine(machine, Pose::Identity());
  const Errors errors = turn_crank(*engine, machine, 3, 5);
  EXPECT_LT(errors.gap, 1e-6);
  EXPECT_LT(errors.angle, 1e-6);
  EXPECT_NEAR(engine->joint(0, 0).position, 15, 1e-6);
}

/// Returns two fingers of 2 kg that slide along y, the second one at `ratio` times the first.
scene::Machine gripper(double ratio, double offset) {
  scene::Machine m;
  m.name = "gripper";
  m.fixed_base = true;
  m.links = {box_link("palm", make_pose(0, 0, 2), 20, Vec3::Zero(), Vec3::Ones()),
             box_link("one", make_pose(0, 0.1, 2), 2, Vec3::Zero(), Vec3(0.1, 0.02, 0.2)),
             box_link("two", make_pose(0, -0.1, 2), 2, Vec3::Zero(), Vec3(0.1, 0.02, 0.2))};
  m.joints = {slider("lead", 0, 1, Vec3::UnitY()), slider("follow", 0, 2, Vec3::UnitY())};
  m.joints[1].passive = true;
  m.joints[1].initial = offset;
  m.gears = {{"follow", 1, 0, ratio, offset}};
  return m;
}

TEST(JointGear, KeepsItsRatioUnderLoad) {
  for (const double ratio : {-1.0, 0.5, 12.0}) {
    constexpr double kLoad = 5000, kOffset = 0.02;
    const auto engine = make_bullet_engine(kDown);
    engine->add_machine(gripper(ratio, kOffset), Pose::Identity());
    engine->set_joint(0, 0, {JointMode::kPosition, 0.05});
    double worst = 0;
    run(*engine, flat(), 4, kStep, [&](double) {
      engine->add_force(0, 2, Vec3(0, kLoad, 0), engine->link(0, 2).X_WL.translation());
      worst = std::max(worst, std::abs(engine->joint(0, 1).position -
                                       ratio * engine->joint(0, 0).position - kOffset));
    });
    print_value("error of a ratio of " + std::to_string(ratio) + " under 5 kN [m]", worst,
                "at most 1e-4", "gear");
    EXPECT_LT(worst, 1e-4);
    EXPECT_NEAR(engine->joint(0, 0).position, 0.05, 1e-3);
    // By virtual work the leader carries the load times the ratio.
    EXPECT_NEAR(engine->joint(0, 0).effort, -ratio * kLoad, 0.01 * std::abs(ratio) * kLoad);
  }
}

TEST(JointGear, MovesAKinematicFollower) {
  const auto engine = make_kinematic_engine();
  engine->add_machine(gripper(-2, 0.02), Pose::Identity());
  engine->set_joint(0, 0, {JointMode::kVelocity, 0.1});
  run(*engine, flat(), 1, kStep);
  EXPECT_NEAR(engine->joint(0, 0).position, 0.1, 1e-3);
  EXPECT_NEAR(engine->joint(0, 1).position, 0.02 - 2 * engine->joint(0, 0).position, 1e-9);
  EXPECT_NEAR(engine->joint(0, 1).velocity, -0.2, 1e-6);
}

TEST(JointGear, OfZeroOrOnItselfIsRefused) {
  for (const scene::JointGear& gear :
       {scene::JointGear{"follow", 1, 0, 0, 0}, scene::JointGear{"follow", 1, 1, 2, 0},
        scene::JointGear{"follow", 1, 0, std::nan(""), 0}}) {
    scene::Machine machine = gripper(1, 0);
    machine.gears = {gear};
    EXPECT_THROW(make_bullet_engine(kDown)->add_machine(machine, Pose::Identity()), InputError);
  }
}

TEST(Mechanism, ContinuesFromASnapshotBitIdentically) {
  for (const scene::Machine& machine : {four_bar(), gripper(12, 0.02), hung(100, 5e4, 500)}) {
    const auto engine = make_bullet_engine(kDown), resumed = make_bullet_engine(kDown);
    for (PhysicsEngine* each : {engine.get(), resumed.get()})
      each->add_machine(machine, Pose::Identity());
    engine->set_joint(0, 0, {JointMode::kVelocity, 0.5});
    run(*engine, flat(), 0.5, kStep);
    load_saved(saved(*engine), *resumed);
    for (PhysicsEngine* each : {engine.get(), resumed.get()}) run(*each, flat(), 0.5, kStep);
    EXPECT_EQ(digest(*engine), digest(*resumed)) << machine.name;
  }
}

}  // namespace
}  // namespace navvy::vehicle
