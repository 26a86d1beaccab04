// SPDX-License-Identifier: Apache-2.0
// Crawlers in contact with bodies: kerbs, walls, decks, loose stones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <memory>
#include <string>

#include "core/saved_state.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "values.h"
#include "vehicle/machines.h"
#include "vehicle/stability.h"

namespace navvy::vehicle {
namespace {

using testing::digest;
using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

/// A block of one link with its middle at the origin.
scene::Machine block(const Vec3& size, double mass = 0) {
  scene::Machine m;
  m.name = "block";
  m.fixed_base = !(mass > 0);
  m.links.push_back(testing::box_link("block", Pose::Identity(), mass > 0 ? mass : 1000,
                                      Vec3::Zero(), mass > 0 ? size : Vec3(1, 1, 1)));
  scene::Collision collision;
  collision.name = "shape";
  collision.geometry.size = size;
  m.links[0].collisions.push_back(collision);
  return m;
}

class TrackBodies : public ::testing::TestWithParam<std::string> {
 protected:
  TrackBodies()
      : machine(
            scene_io::load_machine(navvy::source_dir() + "/vehicles/" + GetParam() + "/model.sdf")),
        excavator(GetParam() == "ex180_tracked") {
    for (const scene::Link& link : machine.links) weight += kGravity * link.mass;
  }

  std::unique_ptr<PhysicsEngine> put(const Pose& X_WM, const Vec3& gravity = kDown) const {
    auto engine = make_bullet_engine(gravity);
    engine->add_machine(machine, X_WM);
    return engine;
  }
  double top_speed() const { return scene::powertrain(machine.drive).max_speed; }
  static double height(const PhysicsEngine& engine) {
    return engine.link(0, 0).X_WL.translation().z();
  }
  static double x(const PhysicsEngine& engine) { return engine.link(0, 0).X_WL.translation().x(); }
  static double tilt(const PhysicsEngine& engine) {
    return std::acos(std::min(1.0, engine.link(0, 0).X_WL.linear()(2, 2)));
  }
  /// Distance from the machine's middle to the foremost point of the tracks [m].
  double reach() const {
    const scene::Track& track = *machine.wheels[0].track;
    return track.p_idler.x() + track.idler_radius + track.thickness;
  }

  scene::Machine machine;
  bool excavator;
  double weight = 0;  // [N]
};

TEST_P(TrackBodies, ACrawlerClimbsAKerb) {
  const double kerb = excavator ? 0.15 : 0.03, length = 3 * reach();
  auto engine = put(Pose::Identity());
  engine->add_machine(block(Vec3(2 * length, 8, kerb)),
                      make_pose(1.2 * reach() + length, 0, 0.5 * kerb));
  run(*engine, flat(), 1, kStep);
  const double before = height(*engine);
  const double speed = 0.6 * top_speed();
  engine->set_drive(0, {speed, 0, false});
  double most = 0;
  run(*engine, flat(), 3.2 * reach() / speed, kStep,
      [&](double) { most = std::max(most, tilt(*engine)); });
  print_value("rise on a kerb [m]", height(*engine) - before, std::to_string(kerb), "its height");
  EXPECT_GT(x(*engine), 2.3 * reach());
  EXPECT_NEAR(height(*engine) - before, kerb, excavator ? 0.02 : 0.004);
  EXPECT_LT(tilt(*engine), radians(1));
  // Over the edge it leans with its rollers, and is not thrown.
  EXPECT_LT(most, radians(15));
}

TEST_P(TrackBodies, ACrawlerDrivesOffAKerbAndAcrossABeam) {
  // A beam shorter than the track: for a while both ends overhang it.
  const double kerb = excavator ? 0.15 : 0.03, length = 0.4 * reach();
  auto engine = put(Pose::Identity());
  engine->add_machine(block(Vec3(length, 8, kerb)), make_pose(1.5 * reach(), 0, 0.5 * kerb));
  const double speed = 0.6 * top_speed();
  engine->set_drive(0, {speed, 0, false});
  double highest = 0;
  run(*engine, flat(), 4 * reach() / speed, kStep,
      [&](double) { highest = std::max(highest, height(*engine)); });
  EXPECT_GT(highest, 0.6 * kerb);
  EXPECT_GT(x(*engine), 2.9 * reach());
  EXPECT_NEAR(height(*engine), 0, excavator ? 0.02 : 0.006);
  EXPECT_LT(tilt(*engine), radians(1));
}

TEST_P(TrackBodies, ACrawlerStopsAtAWall) {
  // Only the tracks collide: no link has a shape. Their grip is too low for the robot to rear up.
  for (scene::Link& link : machine.links) link.collisions.clear();
  for (scene::Wheel& wheel : machine.wheels) wheel.friction = 0.4;
  auto engine = put(Pose::Identity());
  const double wall = 1.5 * reach();
  engine->add_machine(block(Vec3(2, 8, 0.8)), make_pose(wall + 1, 0, 0.4));
  engine->set_drive(0, {0.3 * top_speed(), 0, false});
  double farthest = 0, most = 0;
  run(*engine, flat(), 4, kStep, [&](double) {
    farthest = std::max(farthest, x(*engine));
    most = std::max(most, tilt(*engine));
  });
  print_value("reach at a wall [m]", farthest, std::to_string(wall - reach()),
              "the idler's front touches");
  // Deflection of the springs of two tracks under the thrust.
  EXPECT_NEAR(farthest, wall - reach(), 0.15 * reach());
  EXPECT_LT(most, radians(15));
}

TEST_P(TrackBodies, ACrawlerWithMoreGripDoesNotPassAWallEither) {
  // With friction m it pushes m / (1 + m^2) of its weight at the wall and lifts its front by m
  // times that: it rears up.
  for (scene::Link& link : machine.links) link.collisions.clear();
  for (scene::Wheel& wheel : machine.wheels) wheel.friction = 0.9;
  auto engine = put(Pose::Identity());
  const double wall = 1.5 * reach();
  engine->add_machine(block(Vec3(2, 8, 5)), make_pose(wall + 1, 0, 2.5));
  engine->set_drive(0, {0.3 * top_speed(), 0, false});
  double farthest = 0, most = 0;
  run(*engine, flat(), 3, kStep, [&](double) {
    farthest = std::max(farthest, x(*engine));
    most = std::max(most, tilt(*engine));
  });
  print_value("lean at a wall [deg]", degrees(most), "above 0", "friction lifts the nose");
  EXPECT_LT(farthest, wall);
}

TEST_P(TrackBodies, ACrawlerStandsOnADeckAndDrivesOnIt) {
  auto engine = put(make_pose(0, 0, 0.5));
  engine->add_machine(block(Vec3(40, 8, 0.5)), make_pose(15, 0, 0.25));
  run(*engine, flat(), 3, kStep);
  double load = 0;
  Vec3 body = Vec3::Zero();
  for (int w = 0; w < 2; ++w) {
    load += engine->wheel(0, w).force_W.z();
    body += engine->wheel(0, w).body_W;
  }
  EXPECT_NEAR(load, weight, 0.002 * weight);
  EXPECT_NEAR(body.z(), load, 1e-9 * load);
  EXPECT_NEAR(height(*engine), 0.5, excavator ? 0.02 : 0.006);
  EXPECT_LT(tilt(*engine), radians(1));
  EXPECT_LT(engine->link(0, 0).v_WL.norm(), 1e-3);
  // The deck carries it like the ground.
  const auto on_ground = put(Pose::Identity());
  run(*on_ground, flat(), 3, kStep);
  EXPECT_NEAR(stability(machine, *engine, 0).loaded_margin,
              stability(machine, *on_ground, 0).loaded_margin, 0.03 * reach());
  for (const double share : {0.6, -0.4}) {
    const double speed = share * top_speed();
    engine->set_drive(0, {speed, 0, false});
    run(*engine, flat(), 5, kStep);
    double mean = x(*engine);
    run(*engine, flat(), 1, kStep);
    mean = x(*engine) - mean;
    print_value("speed on a deck [m/s]", mean, std::to_string(speed) + " +-5 %", "as commanded");
    EXPECT_NEAR(mean, speed, 0.05 * std::abs(speed));
    EXPECT_NEAR(engine->link(0, 0).w_WL.z(), 0, 2e-3);
  }
  EXPECT_NEAR(height(*engine), 0.5, excavator ? 0.02 : 0.006);
}

TEST_P(TrackBodies, ACrawlerTurnsOnADeckLikeOnAFloor) {
  const auto turned = [&](bool deck) {
    auto engine = put(make_pose(0, 0, deck ? 0.5 : 0));
    if (deck) engine->add_machine(block(Vec3(40, 40, 0.5)), make_pose(0, 0, 0.25));
    engine->set_drive(0, {0.3 * top_speed(), 0.15, false});
    double angle = 0;
    run(*engine, flat(), 6, kStep, [&](double) { angle += kStep * engine->link(0, 0).w_WL.z(); });
    return angle;
  };
  const double deck = turned(true), floor = turned(false);
  print_value("turn on a deck [deg]", degrees(deck), std::to_string(degrees(floor)) + " +-15 %",
              "on a floor");
  // Its tracks end elsewhere: discs between the rollers carry load, too.
  EXPECT_NEAR(deck, floor, 0.15 * floor);
}

TEST_P(TrackBodies, ATrackTouchesABodyBetweenTwoRollers) {
  // A transverse bar narrower than the gap between two rollers, in the middle between them.
  const scene::Track& track = *machine.wheels[0].track;
  const double gap = track.rollers[0].x() - track.rollers[1].x(), bar = 0.3 * gap;
  auto engine = put(make_pose(0, 0, 2 * bar));
  engine->add_machine(block(Vec3(bar, 8, 4 * bar)),
                      make_pose(0.5 * (track.rollers[2].x() + track.rollers[3].x()), 0, 0));
  double load = 0;
  run(*engine, flat(), 0.3, kStep, [&](double) {
    double now = 0;
    for (int w = 0; w < 2; ++w) now += engine->wheel(0, w).body_W.z();
    load = std::max(load, now);
  });
  EXPECT_GT(load, 0.5 * weight);
  // A roller's spring under most of the weight.
  EXPECT_GT(height(*engine), bar);
}

TEST_P(TrackBodies, TrackAndBodyConserveMomentum) {
  // Without weight and ground: a crawler flies against a free crate with its tracks running.
  for (scene::Link& link : machine.links) link.collisions.clear();
  const double size = 1.2 * reach(), mass = weight / kGravity;
  auto engine = put(make_pose(0, 0, 50), Vec3::Zero());
  engine->add_machine(block(Vec3(size, 4, size), 0.2 * mass),
                      make_pose(1.1 * reach() + 0.5 * size, 0, 50.2));
  const double push = 0.3 * mass;
  engine->apply_impulse(0, 0, Vec3(push, 0, 0), Vec3::Zero(),
                        engine->link(0, 0).X_WL.translation());
  engine->set_drive(0, {0.4 * top_speed(), 0, false});
  run(*engine, flat(), 1.5, kStep);
  EXPECT_GT(engine->accounts()->momentum(1).x(), 0.05 * push);
  const double lost =
      (engine->accounts()->momentum(0) + engine->accounts()->momentum(1) - Vec3(push, 0, 0))
          .norm() /
      push;
  print_value("momentum lost [-]", lost, "below 1e-3", "action and reaction");
  EXPECT_LT(lost, 1e-3);
}

TEST_P(TrackBodies, ALightBodyThatATrackDrivesOntoIsNotThrown) {
  const double side = 0.1 * reach(), y = machine.wheels[0].track->p_idler.y();
  auto engine = put(Pose::Identity());
  engine->add_machine(block(Vec3(side, side, side), weight / kGravity / 1000),
                      make_pose(1.5 * reach(), y, 0.5 * side));
  engine->set_drive(0, {0.5 * top_speed(), 0, false});
  double fastest = 0, highest = 0;
  run(*engine, flat(), 4, kStep, [&](double) {
    fastest = std::max(fastest, engine->link(1, 0).v_WL.norm());
    highest = std::max(highest, tilt(*engine));
  });
  print_value("speed of a stone under a track [m/s]", fastest, "below 8",
              "some times the machine's");
  EXPECT_LT(fastest, 8.0);
  EXPECT_LT(highest, radians(10));
}

TEST_P(TrackBodies, ARunAcrossAKerbIsBitIdenticalResumedAndInParallel) {
  const auto build = [&] {
    auto engine = put(make_pose(0, 0, 0.1 * reach()));
    engine->add_machine(block(Vec3(6, 8, 0.1 * reach())), make_pose(0, 0, 0.05 * reach()));
    engine->add_machine(block(Vec3(0.2, 8, 0.06), weight / kGravity / 50),
                        make_pose(1.2 * reach(), 0, 0.13 * reach()));
    engine->set_drive(0, {0.4 * top_speed(), 0.1, false});
    return engine;
  };
  auto whole = build();
  run(*whole, flat(), 1, kStep);
  const std::vector<char> bytes = saved(*whole);
  auto resumed = build();
  load_saved(bytes, *resumed);
  EXPECT_EQ(digest(*resumed), digest(*whole));
  EXPECT_EQ(resumed->wheel(0, 0).force_W, whole->wheel(0, 0).force_W);
  // One in a separate thread, while the other continues here.
  auto other = std::async(std::launch::async, [&] {
    run(*resumed, flat(), 1, kStep);
    return digest(*resumed);
  });
  run(*whole, flat(), 1, kStep);
  EXPECT_EQ(other.get(), digest(*whole));
}

INSTANTIATE_TEST_SUITE_P(Shipped, TrackBodies, ::testing::Values("ex180_tracked", "tracked_robot"),
                         [](const ::testing::TestParamInfo<std::string>& about) {
                           return about.param;
                         });

}  // namespace
}  // namespace navvy::vehicle
