// SPDX-License-Identifier: Apache-2.0
// The excavator's bucket on level rock below the soil.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/saved_state.h"
#include "values.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::digest;
using testing::ew180;
using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;
constexpr double kRock = -0.4;  // [m]
const Vec3 kDown(0, 0, -kGravity);

/// The excavator with its bucket over the rock.
struct OverRock {
  explicit OverRock(bool fixed) : machine(ew180(0.4, -1.5, -1.3)) {
    machine.fixed_base = fixed;
    engine = make_bullet_engine(kDown);
    engine->add_machine(machine, Pose::Identity());
    engine->rock()->set_rock(kRock);
    bucket = machine.link_index("bucket");
  }
  int joint(const std::string& name) const { return machine.joint_index(name); }
  void turn(const std::string& name, double velocity) {
    engine->set_joint(0, joint(name), {JointMode::kVelocity, velocity});
  }
  double lowest() const {
    double z = 1e9;
    for (const Vec3& v : machine.shells.at(0).vertices)
      z = std::min(z, (engine->link(0, bucket).X_WL * v).z());
    return z;
  }
  Vec3 rock_force() const { return engine->rock()->rock_impulse(0, 0) / kStep; }

  scene::Machine machine;
  std::unique_ptr<PhysicsEngine> engine;
  int bucket = -1;
};

TEST(BulletRock, ABoomStallsWithTheForceOfItsCylinder) {
  OverRock dig(true);
  const int boom = dig.joint(dig.machine.arm.boom);
  dig.turn(dig.machine.arm.boom, -0.3);
  double lowest = 1e9, bounce = 0;
  bool touched = false;
  run(*dig.engine, flat(), 5, kStep, [&](double) {
    lowest = std::min(lowest, dig.lowest());
    touched = touched || dig.rock_force().z() > 0;
    if (touched) bounce = std::max(bounce, dig.lowest() - kRock);
  });
  print_value("bucket pressed on rock, deepest corner [mm]", 1e3 * (kRock - lowest), "1, tolerance",
              "coupling of the rock");
  EXPECT_GT(lowest, kRock - 1e-3);
  EXPECT_LT(dig.lowest(), kRock + 1e-3) << "it does not hover";
  print_value("highest rebound [mm]", 1e3 * bounce, "<= 5", "test");
  EXPECT_LT(bounce, 5e-3);
  const JointState state = dig.engine->joint(0, boom);
  EXPECT_TRUE(state.stalled);
  EXPECT_NEAR(state.velocity, 0, 1e-4);
  EXPECT_NEAR(state.effort, -state.effort_limit, 1e-3 * state.effort_limit);
  // Moments about the boom's pivot: cylinder, weight outward of it, rock.
  const Vec3 foot = dig.engine->link(0, dig.machine.link_index("boom")).X_WL.translation();
  double weight = 0;
  for (const char* name : {"boom", "stick", "bucket"}) {
    const int link = dig.machine.link_index(name);
    const scene::Link& about = dig.machine.links[static_cast<std::size_t>(link)];
    weight +=
        about.mass * kGravity * ((dig.engine->link(0, link).X_WL * about.p_LCom).x() - foot.x());
  }
  double nearest = 1e9, farthest = 0;  // corners that touch; how they share the force is open
  for (const Vec3& v : dig.machine.shells.at(0).vertices) {
    const Vec3 p = dig.engine->link(0, dig.bucket).X_WL * v;
    if (p.z() > kRock + 1e-3) continue;
    nearest = std::min(nearest, p.x() - foot.x());
    farthest = std::max(farthest, p.x() - foot.x());
  }
  ASSERT_GT(farthest, 0);
  const Vec3 force = dig.rock_force();
  const double lifts = -state.effort + weight + (kRock - foot.z()) * force.x();
  EXPECT_GT(force.z() * farthest, 0.999 * lifts);
  EXPECT_LT(force.z() * nearest, 1.001 * lifts);
}

TEST(BulletRock, AMachineLiftsItselfOnItsBucket) {
  OverRock dig(false);
  run(*dig.engine, flat(), 1, kStep);
  dig.turn(dig.machine.arm.boom, -0.3);
  double lowest = 1e9, fastest = 0;
  run(*dig.engine, flat(), 6, kStep, [&](double) {
    lowest = std::min(lowest, dig.lowest());
    fastest = std::max(fastest, dig.engine->link(0, 0).v_WL.z());
  });
  EXPECT_GT(lowest, kRock - 5e-3);
  EXPECT_LT(fastest, 1.0) << "the machine is not launched";
  double front = 0;
  for (std::size_t w = 0; w < dig.machine.wheels.size(); ++w)
    if (dig.machine.wheels[w].joint.find("front") != std::string::npos)
      front += dig.engine->wheel(0, static_cast<int>(w)).force_W.z();
  print_value("force of the rock [N]", dig.rock_force().z(), "lifts the front wheels", "test");
  EXPECT_EQ(front, 0);
  EXPECT_GT(dig.rock_force().z(), 15e3);
  // At rest, ground and rock carry the weight.
  Vec3 sum = Vec3::Zero();
  run(*dig.engine, flat(), 1, kStep,
      [&](double) { sum += dig.engine->accounts()->ground_impulse(0); });
  EXPECT_NEAR(sum.z(), 18000 * kGravity, 0.01 * 18000 * kGravity);
}

TEST(BulletRock, SteelSlidesOnItWithFriction) {
  OverRock dig(true);
  dig.turn(dig.machine.arm.boom, -0.3);
  run(*dig.engine, flat(), 4, kStep);
  dig.turn(dig.machine.arm.stick, -0.1);
  run(*dig.engine, flat(), 1, kStep);
  const double before = dig.engine->link(0, dig.bucket).X_WL.translation().x();
  double along = 0, up = 0, lowest = 1e9;
  run(*dig.engine, flat(), 1, kStep, [&](double) {
    along += dig.rock_force().x();
    up += dig.rock_force().z();
    lowest = std::min(lowest, dig.lowest());
  });
  EXPECT_LT(dig.engine->link(0, dig.bucket).X_WL.translation().x(), before - 0.02)
      << "the stick pulls it along";
  EXPECT_GT(lowest, kRock - 2e-3);
  EXPECT_NEAR(along / up, 0.5, 0.02) << "against the motion";
}

TEST(BulletRock, AResumedRunPressesEqually) {
  OverRock dig(false), again(false);
  for (OverRock* rig : {&dig, &again}) {
    rig->turn(rig->machine.arm.boom, -0.3);
    rig->turn(rig->machine.arm.stick, -0.1);
  }
  run(*dig.engine, flat(), 5, kStep);
  ASSERT_GT(dig.rock_force().z(), 1e3);
  const std::vector<char> bytes = saved(*dig.engine);
  load_saved(bytes, *again.engine);
  EXPECT_EQ(digest(*again.engine), digest(*dig.engine));
  run(*dig.engine, flat(), 0.5, kStep);
  run(*again.engine, flat(), 0.5, kStep);
  EXPECT_EQ(digest(*again.engine), digest(*dig.engine));
  // A bucket with another number of corners is another machine.
  scene::Machine other = dig.machine;
  other.shells.at(0).vertices.push_back(other.shells.at(0).vertices.front());
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(other, Pose::Identity());
  EXPECT_THROW(load_saved(bytes, *engine), InputError);
}

}  // namespace
}  // namespace navvy::vehicle
