// SPDX-License-Identifier: Apache-2.0
// Machines moved by another engine push bodies in their path and are not pushed back.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/saved_state.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::box;
using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;

/// A kinematic engine with one machine beside a Bullet engine that collides with it, stepped as the
/// coupling does.
struct BothEngines {
  explicit BothEngines(scene::Machine machine, const Pose& X_WM) {
    machine.kinematic = true;
    links = machine.links.size();
    kinematic->add_machine(machine, X_WM);
    mover = bullet->obstacles()->add_obstacle(machine);
  }
  void go(double duration, const GroundQuery& ground = flat()) {
    for (int i = 0; i < std::lround(duration / kStep); ++i) {
      std::vector<LinkState> states;
      for (std::size_t l = 0; l < links; ++l)
        states.push_back(kinematic->link(0, static_cast<int>(l)));
      bullet->obstacles()->move_obstacle(mover, states);
      bullet->step(kStep, ground);
      kinematic->step(kStep, ground);
    }
  }
  /// Moves to x in so many seconds.
  void send(const Vec3& p_W, double seconds) {
    kinematic->placement()->set_base(0, {p_W, Vec3::Zero(), seconds});
  }
  Vec3 place(int machine) const { return bullet->link(machine, 0).X_WL.translation(); }
  Vec3 speed(int machine) const { return bullet->link(machine, 0).v_WL; }

  std::unique_ptr<PhysicsEngine> bullet = make_bullet_engine(Vec3(0, 0, -kGravity)),
                                 kinematic = make_kinematic_engine();
  std::size_t links = 0;
  int mover = 0;
};

TEST(Mover, PushesAtItsSpeedAndReleasesWhenItStops) {
  BothEngines both(box(), make_pose(0, 0, 0.5));
  both.bullet->add_machine(box(), make_pose(1.2, 0, 0.5));
  both.send(Vec3(2, 0, 0.5), 4);
  both.go(1);
  // 0.5 m/s, 0.4 s of which are needed for the gap.
  EXPECT_NEAR(both.speed(0).x(), 0.5, 0.01);
  EXPECT_NEAR(both.place(0).x(), 1.5, 0.005);
  both.go(3.5);
  // Friction stops it within v^2 / (2 mu g) = 25 mm, and it is not drawn back.
  EXPECT_LT(std::abs(both.speed(0).x()), 1e-3);
  EXPECT_GT(both.place(0).x(), 2.995);
  EXPECT_LT(both.place(0).x(), 3.04);
  EXPECT_NEAR(both.place(0).y(), 0, 0.002);
  // It reached its target despite the obstacle.
  EXPECT_NEAR(both.kinematic->link(0, 0).X_WL.translation().x(), 2, 1e-9);
}

TEST(Mover, CarriesBodiesOnTopOfIt) {
  BothEngines lift(box(), make_pose(0, 0, 0.5));
  lift.bullet->add_machine(box(), make_pose(0.1, 0.05, 1.5));
  lift.go(0.5);
  lift.send(Vec3(0.6, 0, 1.5), 5);
  lift.go(5);
  // Up by a metre and along by 0.6 m, by friction.
  EXPECT_NEAR(lift.place(0).x(), 0.7, 0.01);
  EXPECT_NEAR(lift.place(0).y(), 0.05, 0.01);
  EXPECT_NEAR(lift.place(0).z(), 2.5, 0.01);
}

TEST(Mover, WakesSleepingBodiesOnlyWhenItMoves) {
  BothEngines both(box(), make_pose(0, 0, 0.5));
  both.bullet->add_machine(box(), make_pose(1.02, 0, 0.5));
  both.go(2);
  ASSERT_TRUE(both.speed(0).isZero(0));
  const Vec3 before = both.place(0);
  both.go(1);
  EXPECT_TRUE(both.place(0) == before);
  both.send(Vec3(0.3, 0, 0.5), 1);
  both.go(1.2);
  EXPECT_NEAR(both.place(0).x(), 1.3, 0.01);
}

TEST(Mover, PushesByTheSteelOfItsShells) {
  // A blade across its path: no collision shape, one plate.
  scene::Machine blade;
  blade.links.push_back(
      testing::box_link("blade", Pose::Identity(), 1, Vec3::Zero(), Vec3(0.1, 2, 1)));
  scene::Shell shell;
  shell.name = "plate";
  shell.link = "blade";
  shell.vertices = {Vec3(0, -1, -0.5), Vec3(0, 1, -0.5), Vec3(0, 1, 0.5), Vec3(0, -1, 0.5)};
  shell.triangles = {{0, 1, 2}, {0, 2, 3}};
  blade.shells = {shell};
  BothEngines both(blade, make_pose(0, 0, 0.6));
  both.bullet->add_machine(box(), make_pose(0.8, 0, 0.5));
  both.send(Vec3(1, 0, 0.6), 2);
  both.go(2);
  EXPECT_NEAR(both.place(0).x(), 1.5, 0.03);
}

TEST(Mover, StopsAWheelThatHitsIt) {
  scene::Machine wall = box();
  wall.links[0].collisions.at(0).geometry.size.y() = 4;
  // Its face is 0.9 m ahead of the front tyres.
  BothEngines both(wall, make_pose(4.725, 0, 0.5));
  both.bullet->add_machine(testing::cart(), make_pose(0, 0, 0));
  both.bullet->set_drive(0, {1, 0, false});
  both.go(4);
  const double stopped = both.place(0).x();
  both.go(2);
  EXPECT_NEAR(both.place(0).x(), stopped, 0.1);
  EXPECT_NEAR(both.place(0).x(), 0.9, 0.1);
}

TEST(Mover, CollidesAfterALoad) {
  const auto make = [] {
    auto both = std::make_unique<BothEngines>(box(), make_pose(0, 0, 0.5));
    both->bullet->add_machine(box(), make_pose(1.2, 0.1, 0.5));
    both->send(Vec3(2, 0, 0.5), 4);
    return both;
  };
  const auto one = make(), other = make();
  one->go(1.5);
  load_saved(saved(*one->bullet), *other->bullet);
  load_saved(saved(*one->kinematic), *other->kinematic);
  one->go(1);
  other->go(1);
  EXPECT_TRUE(one->place(0) == other->place(0));
  EXPECT_EQ(testing::digest(*one->bullet), testing::digest(*other->bullet));
}

}  // namespace
}  // namespace navvy::vehicle
