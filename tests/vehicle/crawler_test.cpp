// SPDX-License-Identifier: Apache-2.0
// Crawlers: the shipped excavator on tracks and the shipped robot, compared with closed forms.
#include <gtest/gtest.h>

#include <cmath>
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

scene::Machine shipped(const std::string& name) {
  return scene_io::load_machine(navvy::source_dir() + "/vehicles/" + name + "/model.sdf");
}

class Crawlers : public ::testing::TestWithParam<std::string> {
 protected:
  Crawlers() : machine(shipped(GetParam())), engine(build()) {}

  std::unique_ptr<PhysicsEngine> build(const Pose& X_WM = Pose::Identity()) const {
    auto built = make_bullet_engine(kDown);
    built->add_machine(machine, X_WM);
    return built;
  }
  double gauge() const { return std::get<scene::DifferentialDrive>(machine.drive).track; }
  double friction() const { return machine.wheels[0].friction; }
  double top_speed() const { return scene::powertrain(machine.drive).max_speed; }
  double forward() const {
    const LinkState base = engine->link(0, 0);
    return base.X_WL.linear().col(0).dot(base.v_WL);
  }
  /// Speed of a track over its rollers, 0 left, 1 right.
  double running_track(int side) const {
    return engine->wheel(0, side).spin * machine.wheels[static_cast<std::size_t>(side)].radius;
  }

  scene::Machine machine;
  std::unique_ptr<PhysicsEngine> engine;
};

TEST_P(Crawlers, StandOnTheirRollersWithTheirWeight) {
  run(*engine, flat(), 3, kStep);
  double load = 0;
  for (int w = 0; w < 2; ++w) load += engine->wheel(0, w).force_W.z();
  EXPECT_NEAR(load, machine.total_mass() * kGravity, 0.002 * load);
  EXPECT_LT(engine->link(0, 0).v_WL.norm(), 1e-3);
  EXPECT_GT(stability(machine, *engine, 0).margin, 0.1 * gauge());
  for (int w = 0; w < 2; ++w) {
    double pressed = 0;
    for (const terramechanics::TrackPatch& patch : engine->tracks()->track_patches(0, w))
      pressed += patch.load;
    EXPECT_NEAR(pressed, engine->wheel(0, w).force_W.z(), 0.01 * pressed);
  }
}

TEST_P(Crawlers, GoStraightAtTheCommandedSpeedInBothDirections) {
  for (const double share : {0.6, -0.4}) {
    const double speed = share * top_speed();
    engine->set_drive(0, {speed, 0, false});
    run(*engine, flat(), 6, kStep);
    // 4 %: as for drives on tyres.
    EXPECT_NEAR(forward(), speed, 0.04 * std::abs(speed));
    EXPECT_NEAR(engine->link(0, 0).w_WL.z(), 0, 2e-3);
  }
  EXPECT_NEAR(engine->link(0, 0).X_WL.translation().y(), 0, 0.02);
}

TEST_P(Crawlers, TurnLessThanTheirTracksWouldWithoutSlip) {
  const double speed = 0.4 * top_speed();
  engine->set_drive(0, {speed, 0.5 * speed / gauge(), false});
  run(*engine, flat(), 5, kStep);
  double turned = 0, bound = 0;
  run(*engine, flat(), 5, kStep, [&](double) {
    turned += kStep * engine->link(0, 0).w_WL.z();
    bound += kStep * (running_track(1) - running_track(0)) / gauge();
  });
  print_value("turn of a crawler [deg]", degrees(turned), "below " + std::to_string(degrees(bound)),
              "(v_r - v_l) / B");
  EXPECT_LT(turned, bound);
  EXPECT_GT(turned, 0.4 * bound);
  // The kinematic engine gives the bound itself.
  const auto rolling = make_kinematic_engine();
  rolling->add_machine(machine, Pose::Identity());
  rolling->set_drive(0, {speed, 0.5 * speed / gauge(), false});
  run(*rolling, flat(), 1, kStep);
  EXPECT_NEAR(rolling->link(0, 0).w_WL.z(), 0.5 * speed / gauge(), 1e-9);
}

TEST_P(Crawlers, TurnOnTheSpotAgainstTheMomentOfTheirTracks) {
  const double rate = 0.5 * top_speed() / gauge();
  engine->set_drive(0, {0, rate, false});
  run(*engine, flat(), 4, kStep);
  const Vec3 before = engine->link(0, 0).X_WL.translation();
  double bound = 0, turned = 0;
  run(*engine, flat(), 6, kStep, [&](double) {
    turned += kStep * engine->link(0, 0).w_WL.z();
    bound += kStep * (running_track(1) - running_track(0)) / gauge();
  });
  EXPECT_LT(running_track(0), 0);
  EXPECT_GT(running_track(1), 0);
  EXPECT_GT(turned, 0.3 * bound);
  EXPECT_LT(turned, bound);
  print_value("pivot turn [deg]", degrees(turned), "below " + std::to_string(degrees(bound)),
              "(v_r - v_l) / B");
  EXPECT_LT((engine->link(0, 0).X_WL.translation() - before).head<2>().norm(), 0.25 * gauge());
}

TEST_P(Crawlers, PullOnAFloorWithTheGripOfTheirTracks) {
  run(*engine, flat(), 2, kStep);
  engine->set_drive(0, {0.5 * top_speed(), 0, false});
  const double weight = machine.total_mass() * kGravity;
  // A tether at ground level, so that the load distribution does not change; 2 % of the weight per
  // centimetre.
  double pull = 0;
  run(*engine, flat(), 8, kStep, [&](double) {
    const LinkState base = engine->link(0, 0);
    const Vec3 p = base.X_WL * Vec3(0, 0, 0.01);
    pull = std::max(0.0, 2 * weight * p.x() + 0.5 * weight * base.v_WL.x());
    engine->add_force(0, 0, Vec3(-pull, 0, 0), p);
  });
  const double most =
      std::min(friction() * weight, scene::powertrain(machine.drive).tractive_force);
  print_value("pull on a firm floor / weight [-]", pull / weight,
              std::to_string(most / weight) + " +-3 %", "Coulomb");
  // 3 %: the tracks' own resistance reduces the motors' torque, not the grip.
  EXPECT_NEAR(pull, most, (most < friction() * weight ? 0.06 : 0.03) * most);
}

TEST_P(Crawlers, PullOnSoilByItsCohesionAndFriction) {
  scene::Soil soil;
  soil.cohesion = 4000;
  soil.residual_cohesion = 4000;
  soil.friction_angle = radians(20);
  soil.bekker_kphi = 1e9;  // hardly sinks: the pull is the shear's alone
  auto ground = flat();
  ground.set_soil([&soil](double, double) { return terramechanics::SoilState{&soil, 1.0}; });
  // Motors that do not limit the pull.
  auto& drive = std::get<scene::DifferentialDrive>(machine.drive);
  drive.tractive_force = 3 * machine.total_mass() * kGravity;
  drive.power *= 10;
  engine = build();
  run(*engine, ground, 2, kStep);
  engine->set_drive(0, {0.5 * top_speed(), 0, false});
  const double weight = machine.total_mass() * kGravity;
  double pull = 0;
  run(*engine, ground, 8, kStep, [&](double) {
    const LinkState base = engine->link(0, 0);
    const Vec3 p = base.X_WL * Vec3(0, 0, 0.01);
    pull = std::max(0.0, 2 * weight * p.x() + 0.5 * weight * base.v_WL.x());
    engine->add_force(0, 0, Vec3(-pull, 0, 0), p);
  });
  double area = 0, length = 0;
  for (int w = 0; w < 2; ++w)
    for (const terramechanics::TrackPatch& patch : engine->tracks()->track_patches(0, w)) {
      area += patch.length * patch.width;
      length += 0.5 * patch.length;
    }
  // All shoes slip: i = 1 over the length of the run [Wong 2008].
  const double mobilised = 1 - soil.janosi_k / length * (1 - std::exp(-length / soil.janosi_k));
  const double most = mobilised * (area * soil.cohesion + weight * std::tan(soil.friction_angle));
  print_value("pull on soil / weight [-]", pull / weight, std::to_string(most / weight) + " +-4 %",
              "A c + W tan phi, mobilised");
  EXPECT_NEAR(pull, most, 0.04 * most);
}

TEST_P(Crawlers, StandOnASlopeUpToTheirFriction) {
  const double limit = std::atan(friction());
  for (const double beside : {-radians(3), radians(3)}) {
    // Braked beyond the limit of the brakes, which are not tested here.
    scene::Machine strong = machine;
    std::get<scene::DifferentialDrive>(strong.drive).brake_force = 1e6;
    const double angle = limit + beside;
    const auto built = make_bullet_engine(kDown);
    built->add_machine(strong, make_pose(0, 0, 0, 0, -angle, 0));
    const auto hill = testing::slope(angle);
    // It is set down and slides until its rollers carry weight, and oscillates until they have
    // settled.
    run(*built, hill, 20, kStep);
    const Vec3 before = built->link(0, 0).X_WL.translation();
    run(*built, hill, 2, kStep);
    const double slid = (built->link(0, 0).X_WL.translation() - before).norm();
    print_value("slip distance in 2 s [m]", slid, beside < 0 ? "below 1 mm" : "more than 0.1 m",
                "atan of its friction");
    if (beside < 0)
      EXPECT_LT(slid, 1e-3);
    else
      EXPECT_GT(slid, 0.1);
  }
}

TEST_P(Crawlers, ResumeEqualInTheMiddleOfATurn) {
  engine->set_drive(0, {0.4 * top_speed(), 0.2, false});
  run(*engine, flat(), 1, kStep);
  const auto resumed = build();
  load_saved(saved(*engine), *resumed);
  EXPECT_EQ(digest(*resumed), digest(*engine));
  run(*engine, flat(), 1, kStep);
  run(*resumed, flat(), 1, kStep);
  EXPECT_EQ(digest(*resumed), digest(*engine));
}

INSTANTIATE_TEST_SUITE_P(Shipped, Crawlers, ::testing::Values("ex180_tracked", "tracked_robot"),
                         [](const ::testing::TestParamInfo<std::string>& about) {
                           return about.param;
                         });

}  // namespace
}  // namespace navvy::vehicle
