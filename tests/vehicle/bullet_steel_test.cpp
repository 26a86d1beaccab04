// SPDX-License-Identifier: Apache-2.0
// Buckets and beds touch bodies with the plates of their shells.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <vector>

#include "folder.h"
#include "geometry/pieces.h"
#include "scene_io/loader.h"
#include "values.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

using testing::flat;
using testing::run;

constexpr double kStep = 1.0 / 600;
const Vec3 kDown(0, 0, -kGravity);

scene::Machine body(double mass, const scene::Geometry& geometry) {
  scene::Machine m;
  m.name = "stone";
  m.links.push_back(
      testing::box_link("stone", Pose::Identity(), mass, Vec3::Zero(), Vec3(0.58, 0.58, 0.58)));
  scene::Collision collision;
  collision.name = "shape";
  collision.geometry = geometry;
  m.links[0].collisions.push_back(collision);
  return m;
}

scene::Machine block(const Vec3& size, double mass) {
  scene::Geometry geometry;
  geometry.size = size;
  return body(mass, geometry);
}

scene::Machine stone_ball(double radius, double mass) {
  scene::Geometry geometry;
  geometry.kind = scene::Geometry::Kind::kSphere;
  geometry.radius = radius;
  return body(mass, geometry);
}

/// Writes a boulder of 80 faces, the corners of an icosahedron and the midpoints of its edges on a
/// sphere, as an OBJ file.
std::string boulder_mesh(const test::Folder& folder, double radius) {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  std::vector<Vec3> corners;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-g, g})
      for (int turn = 0; turn < 3; ++turn) {
        Vec3 p;
        p[turn] = 0, p[(turn + 1) % 3] = a, p[(turn + 2) % 3] = b;
        corners.push_back(p);
      }
  const std::size_t count = corners.size();
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j)
      if ((corners[i] - corners[j]).norm() < 2.1)
        corners.push_back(0.5 * (corners[i] + corners[j]));
  std::ofstream file(folder / "boulder.obj");
  for (const Vec3& p : corners) {
    const Vec3 on = radius * p.normalized();
    file << "v " << on.x() << " " << on.y() << " " << on.z() << "\n";
  }
  file << "f 1 2 3\n";
  return folder / "boulder.obj";
}

TEST(BulletSteel, MomentumOfTwoTouchingMachinesIsConserved) {
  const scene::Machine digger = testing::ew180();
  auto engine = make_bullet_engine(Vec3::Zero());
  engine->add_machine(digger, make_pose(0, 0, 50));
  const geometry::Box box = geometry::bounds(digger.shells.at(0));
  const Vec3 side = engine->link(0, digger.link_index("bucket")).X_WL *
                    Vec3(0.5 * (box.low.x() + box.high.x()), box.high.y() + 0.5,
                         0.5 * (box.low.z() + box.high.z()));
  engine->add_machine(stone_ball(0.3, 500), make_pose(side.x(), side.y(), side.z()));
  const Vec3 thrown(0, -1500, 0);
  engine->apply_impulse(1, 0, thrown, Vec3::Zero(), side);
  run(*engine, flat(), 1, kStep);
  // Only the side of the bucket can have stopped it.
  EXPECT_GT(engine->accounts()->momentum(0).norm(), 0.3 * thrown.norm());
  const double lost =
      (engine->accounts()->momentum(0) + engine->accounts()->momentum(1) - thrown).norm() /
      thrown.norm();
  print_value("momentum of a bucket and a stone that hits it, change", lost, "<= 1e-3", "kept");
  EXPECT_LT(lost, 1e-3);
}

TEST(BulletSteel, AMovingBedHoldsAStone) {
  const scene::Machine truck = testing::dumper();
  auto engine = make_bullet_engine(kDown);
  engine->add_machine(truck, Pose::Identity());
  run(*engine, flat(), 1, kStep);
  const int bed = truck.link_index("bed");
  const geometry::Box box = geometry::bounds(truck.shells.at(0));
  const Pose X_WL = engine->link(0, bed).X_WL;
  const Vec3 start = X_WL * Vec3(0.5 * (box.low.x() + box.high.x()), 0, box.low.z() + 0.36);
  engine->add_machine(block(Vec3(0.58, 0.58, 0.58), 500),
                      make_pose(start.x(), start.y(), start.z()));
  const auto in_bed = [&] {
    return Vec3(engine->link(0, bed).X_WL.inverse() * engine->link(1, 0).X_WL.translation());
  };
  run(*engine, flat(), 1, kStep);
  const Vec3 before = in_bed();
  EXPECT_NEAR(before.z() - box.low.z(), 0.29 + truck.shells[0].half_thickness, 0.03);
  // Departure, a bend, and a stop by the governor: 1.5 m/s2, a third of the limit that holds the
  // stone.
  double farthest = 0;
  const auto look = [&](double) { farthest = std::max(farthest, (in_bed() - before).norm()); };
  engine->set_drive(0, {2.5, 0, false});
  run(*engine, flat(), 4, kStep, look);
  engine->set_drive(0, {2.5, 0.3, false});
  run(*engine, flat(), 3, kStep, look);
  EXPECT_GT((engine->link(0, bed).X_WL.translation() - X_WL.translation()).norm(), 8);
  engine->set_drive(0, {0, 0, false});
  run(*engine, flat(), 3, kStep, look);
  print_value("a stone in a bed that drives and brakes, travel in it", farthest, "<= 0.1 m",
              "friction 0.48");
  EXPECT_LT(farthest, 0.1);
}

/// The test bucket, 1.4 times as large, on a swinging column: its joints follow their targets
/// exactly.
struct Crane {
  explicit Crane(PhysicsEngine& in) : engine(in) {
    machine = scene_io::load_machine(scene_io::find_data("vehicles/test_bucket/model.sdf"));
    machine.kinematic = false;
    for (Vec3& v : machine.shells.at(0).vertices) v *= 1.4;
    // Inserted between base and carriage.
    machine.links.insert(
        machine.links.begin() + 1,
        testing::box_link("column", Pose::Identity(), 1000, Vec3::Zero(), Vec3(1, 1, 1)));
    for (scene::Joint& joint : machine.joints) {
      if (joint.parent > 0) ++joint.parent;
      ++joint.child;
    }
    machine.joints.insert(machine.joints.begin(), testing::revolute("swing", 0, 1, Vec3::UnitZ()));
    machine.joints[1].parent = 1;
    machine.fixed_base = true;
    const std::vector<double> q = {0, 0, 0.7, radians(-53)};
    for (std::size_t j = 0; j < q.size(); ++j) machine.joints.at(j).initial = now[j] = q[j];
    engine.add_machine(machine, Pose::Identity());
  }
  /// Moves all joints (swing, x, z, curl) evenly.
  void go(const std::array<double, 4>& to, double time) {
    const std::array<double, 4> from = now;
    double at = 0;
    run(engine, flat(), time, kStep, [&](double) {
      at = std::min(1.0, at + kStep / time);
      for (std::size_t j = 0; j < now.size(); ++j) {
        now[j] = from[j] + at * (to[j] - from[j]);
        engine.set_joint(0, static_cast<int>(j), {JointMode::kPosition, now[j]});
      }
    });
  }
  PhysicsEngine& engine;
  scene::Machine machine;
  std::array<double, 4> now{};
};

TEST(BulletSteel, ABucketPicksUpCarriesAndSetsDownAStone) {
  const test::Folder folder;
  auto engine = make_bullet_engine(kDown);
  Crane crane(*engine);
  scene::Geometry mesh;
  mesh.kind = scene::Geometry::Kind::kMesh;
  mesh.mesh_file = boulder_mesh(folder, 0.34);
  engine->add_machine(body(500, mesh), make_pose(3, 0, 0.36));
  // A low kerb, against which the cutting edge is driven under the stone.
  scene::Machine kerb = block(Vec3(0.3, 2, 0.16), 1000);
  kerb.fixed_base = true;
  engine->add_machine(kerb, make_pose(3 + 0.29 + 0.15, 0, 0.08));
  const auto stone = [&] { return Vec3(engine->link(1, 0).X_WL.translation()); };
  const auto in_bucket = [&] { return Vec3(engine->link(0, 4).X_WL.inverse() * stone()); };
  const double flat_curl = radians(-56);
  // The cutting edge is 0.756 m ahead of the hinge and 0.31 m below it: down on the ground, under
  // the stone, curled, up.
  crane.go({0, 1.6, 0.345, flat_curl}, 1);
  crane.go({0, 2.3, 0.345, flat_curl}, 3);
  crane.go({0, 2.3, 0.5, radians(-20)}, 2);
  crane.go({0, 2.2, 1.6, radians(0)}, 2);
  const Vec3 lifted = stone(), held = in_bucket();
  EXPECT_GT(lifted.z(), 1.0) << "picked up";
  crane.go({radians(90), 2.2, 1.6, radians(0)}, 4);
  const auto bearing = [](const Vec3& p) { return std::atan2(p.y(), p.x()); };
  EXPECT_LT((in_bucket() - held).norm(), 0.1) << "carried in the bucket";
  EXPECT_NEAR(bearing(stone()) - bearing(lifted), radians(90), radians(5));
  crane.go({radians(90), 2.2, 0.75, radians(0)}, 2);
  crane.go({radians(90), 2.0, 0.75, radians(-95)}, 3);
  crane.go({radians(90), 1.2, 0.9, radians(-95)}, 3);
  run(*engine, flat(), 8, kStep);
  print_value("a stone that was set down: height of its middle", stone().z(), "0.3 .. 0.37 m",
              "on the ground");
  EXPECT_NEAR(stone().z(), 0.34, 0.04);
  EXPECT_LT(engine->link(1, 0).v_WL.norm(), 0.05);
  EXPECT_NEAR(bearing(stone()), radians(90), radians(20));
}

}  // namespace
}  // namespace navvy::vehicle
