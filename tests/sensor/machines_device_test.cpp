// SPDX-License-Identifier: Apache-2.0
// Beams on the hydraulic cylinders of a machine, and labels of a load below the sky.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "sensor/ray_scene.h"
#include "sensor/scenes.h"
#include "sensor/shape_mesh.h"
#include "sim/cylinder_shapes.h"
#include "sim/visible_soil.h"

namespace navvy::sensor {
namespace {

using testing::scene_of;
using testing::world_of;

// The bound of the issue on scans without noise [m].
constexpr double kTruth = 0.002;

/// Returns the ends of a machine's bars, the pins of its boom cylinders among them.
std::vector<scene::FrameCylinder> bars_of(const sim::World& world) {
  std::vector<scene::FrameCylinder> out;
  sim::add_cylinder_shapes(world, 0, out);
  return out;
}

TEST(BeamsOnMachines, MeetTheCylindersOfARaisedBoom) {
  device::Device device;
  const auto world = world_of(
      scene_of(R"(<include><uri>model://ew180</uri><name>digger</name><pose>0 0 0 0 0 0</pose>
<navvy:joint name="boom_joint"><initial_deg>40</initial_deg></navvy:joint></include>)"),
      device);
  RayScene scene(*world);
  scene.update();
  const sim::MachineHandle digger = world->machines().at("digger");
  const scene::Cylinder& boom = digger.description().cylinders[0];
  ASSERT_EQ(boom.name, "boom_cylinder");
  ASSERT_EQ(boom.count, 2);
  const std::vector<scene::FrameCylinder> bars = bars_of(*world);
  // One on each side of the boom, between the pins of its links.
  for (const std::size_t side : {0u, 1u}) {
    const scene::FrameCylinder& bar = bars[side];
    const Vec3 aside(0, (side == 0 ? -0.5 : 0.5) * boom.spacing, 0);
    const Vec3 p_base = digger.link(boom.base_link).pose() * boom.p_base + aside,
               p_rod = digger.link(boom.rod_link).pose() * boom.p_rod + aside;
    ASSERT_LT((bar.p_base - p_base).norm(), 1e-6);
    ASSERT_LT((bar.p_rod - p_rod).norm(), 1e-6);
    // Beams from 1 m ahead of the bar and at right angles to it: on its barrel, then on its rod.
    const Vec3 along = p_rod - p_base, ahead = Vec3::UnitY().cross(along).normalized();
    ASSERT_GT(along.normalized().z(), 0.5) << "the boom is not raised";
    for (const double share : {0.3, 0.4, 0.5, 0.65, 0.75, 0.85}) {
      const double radius = (share * along.norm() < bar.barrel_length ? 1 : 0.6) * bar.radius;
      for (const double off : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
        const Vec3 p = p_base + share * along + ahead + Vec3(0, off * radius, 0);
        const auto hit = scene.first_hit(p, -ahead, 5);
        ASSERT_TRUE(hit) << side << ' ' << share << ' ' << off;
        EXPECT_EQ(hit->what, Met::kBody);
        EXPECT_EQ(hit->machine, 0);
        EXPECT_EQ(hit->link, -1) << "not a bar: " << side << ' ' << share << ' ' << off;
        EXPECT_NEAR(hit->distance, 1 - radius * std::sqrt(1 - off * off), kTruth)
            << side << ' ' << share << ' ' << off;
      }
    }
    // Beside the bar a beam goes on.
    const auto past =
        scene.first_hit(p_base + 0.75 * along + ahead + Vec3(0, 0.62 * bar.radius, 0), -ahead, 5);
    EXPECT_TRUE(!past || past->distance > 1 + bar.radius);
  }
}

/// What a camera's pixels must show, found by a plain search of everything.
class Truth {
 public:
  explicit Truth(const sim::World& world)
      : soil_(world), bodies_(solid_bodies(world.description())) {
    soil_.update();
    for (SolidBody& body : bodies_)
      body.place(world.machines().at(body.machine).link(body.link).pose());
  }

  /// Returns the label of the first thing along a beam; machines without their cylinders.
  int label(const Vec3& p, const Vec3& d) const {
    double first = 20;
    int out = 0;
    // Beyond its edge, 10 m from the middle, the ground goes on level for vehicles only.
    const double ground = soil_.surface().ray(p, d, first);
    if (ground >= 0 && (p + ground * d).head<2>().cwiseAbs().maxCoeff() < 10) {
      first = ground;
      out = 1;
    }
    for (const sim::SoilBall& ball : soil_.balls()) {
      const Vec3 c = soil_.origin() + ball.p_O.cast<double>() - p;
      const double along = c.dot(d), r = static_cast<double>(ball.radius),
                   root = r * r - (c - along * d).squaredNorm();
      if (root <= 0 || along <= 0 || along - std::sqrt(root) >= first) continue;
      first = along - std::sqrt(root);
      out = 2;
    }
    for (const SolidBody& body : bodies_)
      if (const auto hit = body.tree.first_hit(body.X_LW * p, body.X_LW.linear() * d, first)) {
        first = hit->distance;
        out = 3 + body.machine;
      }
    return out;
  }

 private:
  sim::VisibleSoil soil_;
  std::vector<SolidBody> bodies_;
};

TEST(LabelCamera, ShowsTheSkyAndTheLoadOfABed) {
  constexpr int kWidth = 64, kHeight = 48;
  // Beside the tail of a loaded dumper and above it, looking at its bed and a little down, with the
  // sky above and ground around it.
  device::Device device;
  const auto world = world_of(
      scene_of(R"(<include><uri>model://dumper</uri><name>dumper</name><pose>0 0 0 0 0 0</pose>
<navvy:load><soil>loam</soil><mass_kg>600</mass_kg></navvy:load>
<navvy:sensor name="labels" link="chassis" type="segmentation"><pose>-2 -2.5 2.2 0 0.35 0.6</pose>
<update_rate>10</update_rate><camera><horizontal_fov>1.2</horizontal_fov><image><width>64</width>
<height>48</height></image></camera></navvy:sensor></include>)"),
      device);
  const Truth truth(*world);
  const sim::ArrayView view = world->arrays().view("dumper/labels/labels");
  ASSERT_EQ(view.channel().type_text(), "uint16[48,64]");
  const auto labels = view.values<std::uint16_t>();
  const double scale = 2 * std::tan(0.6) / kWidth;
  std::array<int, 4> counts{};
  for (int row = 0; row < kHeight; ++row)
    for (int column = 0; column < kWidth; ++column) {
      const Vec3 d_S =
          Vec3(1, (0.5 * kWidth - column - 0.5) * scale, (0.5 * kHeight - row - 0.5) * scale)
              .normalized();
      const int expected = truth.label(view.X_WF().translation(), view.X_WF().linear() * d_S);
      const int label = labels[static_cast<std::size_t>(row * kWidth + column)];
      ASSERT_EQ(label, expected) << row << ' ' << column;
      ++counts[static_cast<std::size_t>(label)];
    }
  // Nothing, ground, loose soil, the dumper.
  EXPECT_GT(counts[0], 200);
  EXPECT_GT(counts[1], 200);
  EXPECT_GT(counts[2], 50);
  EXPECT_GT(counts[3], 200);
}

}  // namespace
}  // namespace navvy::sensor
