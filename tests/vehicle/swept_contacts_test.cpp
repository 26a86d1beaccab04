// SPDX-License-Identifier: Apache-2.0
// Bodies that move by more than half of their thinnest side in a step do not pass others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/saved_state.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::flat;
using testing::run;

constexpr double kStep = 0.0017;  // about the base step of a scene [s]
const Vec3 kDown(0, 0, -kGravity);

/// Returns a solid box of steel.
scene::Machine plate(const Vec3& edges, bool fixed = false, double mass = 0) {
  if (mass == 0) mass = 7850 * edges.prod();
  scene::Machine out;
  out.name = "plate";
  out.fixed_base = fixed;
  out.links.push_back(testing::box_link("plate", Pose::Identity(), mass, Vec3::Zero(), edges));
  scene::Collision collision;
  collision.name = "shape";
  collision.geometry.size = edges;
  out.links[0].collisions.push_back(collision);
  return out;
}

double height(const PhysicsEngine& engine, int machine) {
  return engine.link(machine, 0).X_WL.translation().z();
}

/// Returns an engine with a deck of 20 mm that is fixed 5 m above the ground, and a plate of 5 mm
/// 0.3 m above it that falls at `speed` [m/s], tilted by `tilt` [rad].
std::unique_ptr<PhysicsEngine> plate_over_deck(double speed, double tilt, bool fixed = true) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(plate(Vec3(2, 2, 0.02), fixed), make_pose(0, 0, 5));
  engine->add_machine(plate(Vec3(0.5, 0.5, 0.005)), make_pose(0.1, 0.05, 5.3, tilt));
  engine->apply_impulse(1, 0, Vec3(0, 0, -speed * 7850 * 0.5 * 0.5 * 0.005), Vec3::Zero(),
                        engine->link(1, 0).X_WL.translation());
  return engine;
}

TEST(SweptContacts, AFastPlateDoesNotPassADeck) {
  for (const double speed : {3.0, 15.0, 29.0, 40.0})
    for (const double tilt : {0.0, 0.05, 0.4, 1.5}) {
      const auto engine = plate_over_deck(speed, tilt);
      double lowest = 10;
      run(*engine, flat(), 1, kStep, [&](double) {
        const Vec3 p = engine->link(1, 0).X_WL.translation();
        // A tilted plate slides over the deck's edge.
        if (p.head<2>().cwiseAbs().maxCoeff() < 0.95) lowest = std::min(lowest, p.z());
      });
      // The plate's middle stays above the deck's.
      EXPECT_GT(lowest, 5) << speed << " m/s, " << tilt << " rad";
      EXPECT_LT(lowest, 5.25) << speed << " m/s, " << tilt << " rad";
    }
}

TEST(SweptContacts, AFastPlateMovesALooseDeckAndDoesNotPassIt) {
  const auto engine = plate_over_deck(15, 0.05, false);
  double gap = 10;
  const Vec3 before = engine->accounts()->momentum(0) + engine->accounts()->momentum(1);
  double time = 0;
  run(*engine, flat(), 0.08, kStep, [&](double) {
    gap = std::min(gap, height(*engine, 1) - height(*engine, 0));
    time += kStep;
  });
  EXPECT_GT(gap, 0);
  EXPECT_LT(engine->link(0, 0).v_WL.z(), -0.5) << "the deck received the impulse";
  // Contacts conserve momentum: gravity alone adds to it.
  const Vec3 after = engine->accounts()->momentum(0) + engine->accounts()->momentum(1);
  const double mass = 7850 * (2 * 2 * 0.02 + 0.5 * 0.5 * 0.005);
  EXPECT_NEAR((after - before).z(), -mass * kGravity * time, 0.001 * mass * kGravity * time);
}

TEST(SweptContacts, AThinPlateDoesNotPassTheGround) {
  for (const double slope : {0.0, radians(20.0)})
    for (const double tilt : {0.0, 0.1}) {
      auto engine = make_bullet_engine(kDown);
      engine->add_machine(plate(Vec3(1, 1, 0.002)), make_pose(0, 0, 1, tilt));
      engine->apply_impulse(0, 0, Vec3(0, 0, -29 * 7850 * 0.002), Vec3::Zero(), Vec3(0, 0, 1));
      double lowest = 10;
      const auto ground = testing::slope(slope);
      run(*engine, ground, 1, kStep, [&](double) {
        const Vec3 p = engine->link(0, 0).X_WL.translation();
        lowest = std::min(lowest, p.z() - ground.height(p.x(), p.y()));
      });
      EXPECT_GT(lowest, -0.02) << slope << ", " << tilt;
    }
}

TEST(SweptContacts, AFastObstacleCarriesABodyAlong) {
  // A wall of 10 mm that another engine moves at 12 m/s, that is 20 mm in a step.
  auto engine = make_bullet_engine(Vec3::Zero());
  engine->add_machine(plate(Vec3(0.01, 0.4, 0.4)), make_pose(0, 0, 5));
  const int wall = engine->obstacles()->add_obstacle(plate(Vec3(0.01, 1, 1)));
  LinkState state;
  state.v_WL = Vec3(12, 0, 0);
  const auto ground = flat();
  for (int i = 0; i < 100; ++i) {
    state.X_WL = make_pose(-0.513 + i * kStep * 12, 0, 5);
    engine->obstacles()->move_obstacle(wall, {state});
    engine->step(kStep, ground);
  }
  EXPECT_GT(engine->link(0, 0).X_WL.translation().x(), state.X_WL.translation().x());
  EXPECT_GT(engine->link(0, 0).v_WL.x(), 10);
}

/// Returns the angle of a thin flap that swings through a link of its own machine, as a thin bucket
/// through its stick, 0.3 s after an impulse. `solid`: the link has a shape to collide with.
double angle_of_flap(bool solid) {
  scene::Machine machine = plate(Vec3(0.2, 0.2, 0.2), true);
  machine.links.push_back(plate(Vec3(0.4, 0.4, 0.005)).links[0]);
  machine.links[1].name = "flap";
  if (!solid) machine.links[0].collisions.clear();
  machine.joints.push_back(testing::revolute("hinge", 0, 1, Vec3::UnitX()));
  auto engine = make_bullet_engine(Vec3::Zero());
  engine->add_machine(machine, make_pose(0, 0, 5));
  engine->set_joint(0, 0, {JointMode::kFree});
  engine->apply_impulse(0, 1, Vec3(0, 0, 5), Vec3::Zero(), Vec3(0, 0.15, 5));
  run(*engine, flat(), 0.3, kStep);
  return engine->joint(0, 0).position;
}

TEST(SweptContacts, LeaveLinksOfOneMachineAlone) {
  const double free = angle_of_flap(false);
  EXPECT_GT(std::abs(free), 1e-3);
  EXPECT_NEAR(angle_of_flap(true), free, 1e-9);
}

TEST(SweptContacts, ContinueFromASnapshotBitIdentically) {
  const auto engine = plate_over_deck(15, 0.05, false);
  run(*engine, flat(), 0.02, kStep);
  const std::vector<char> state = saved(*engine);
  run(*engine, flat(), 0.1, kStep);
  const auto resumed = plate_over_deck(15, 0.05, false);
  load_saved(state, *resumed);
  run(*resumed, flat(), 0.1, kStep);
  EXPECT_EQ(testing::digest(*resumed), testing::digest(*engine));
}

/// Returns the message with which the engine stops; empty if it does not.
std::string message_of(PhysicsEngine& engine, double time) {
  try {
    run(engine, flat(), time, kStep);
  } catch (const SimulationError& error) {
    return error.what();
  }
  return "";
}

TEST(LostMachine, OfAnImplausibleInertiaNamesIt) {
  scene::Machine tiny = plate(Vec3(0.3, 0.2, 0.1), false, 10);
  tiny.links[0].inertia = 1e-9 * Mat3::Identity();
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(tiny, make_pose(0, 0, 1, 0.3, 0.2));
  const std::string message = message_of(*engine, 3);
  EXPECT_NE(message.find("the inertia of its link 'plate' is 1e-09 kg m2"), std::string::npos)
      << message;
}

TEST(LostMachine, UnderATooHeavyLoadNamesIt) {
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(plate(Vec3(0.3, 0.3, 0.3), false, 0.5), make_pose(0, 0, 0.15));
  scene::Machine heavy = plate(Vec3(1, 1, 1), false, 5000);
  heavy.name = "heavy";
  engine->add_machine(heavy, make_pose(0, 0, 0.8));
  const std::string message = message_of(*engine, 8);
  EXPECT_NE(message.find("'heavy' of 5000 kg has pressed on it, and it has 0.5 kg"),
            std::string::npos)
      << message;
}

}  // namespace
}  // namespace navvy::vehicle
