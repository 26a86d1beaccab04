// SPDX-License-Identifier: Apache-2.0
// Scans of known shapes, compared with their geometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "sensor/ray_scene.h"
#include "sensor/scenes.h"
#include "sim/visible_soil.h"
#include "sim/world_terrain.h"

namespace navvy::sensor {
namespace {

using testing::body;
using testing::laser;
using testing::mast;
using testing::scene_of;
using testing::world_of;

// The bound of the issue on scans without noise [m].
constexpr double kTruth = 0.002;

class ScanTest : public ::testing::Test {
 protected:
  device::Device device_;
};

std::span<const float> ranges(const sim::World& world) {
  return world.arrays().view("mast/laser/ranges").values<float>();
}

double angle_of(int i, int samples, double half) { return -half + 2 * half * i / (samples - 1); }

TEST_F(ScanTest, SeesABoxAsItIs) {
  const int n = 181;
  const double half = 0.6;
  const auto world = world_of(scene_of(mast(laser("0 0 0.9 0 0 0", n, half)) +
                                       body("box", "5 0 1 0 0 0", "<box><size>2 3 2</size></box>")),
                              device_);
  int hits = 0;
  for (int i = 0; i < n; ++i) {
    const double a = angle_of(i, n, half), front = 4 / std::cos(a), y = 4 * std::tan(a);
    if (std::abs(std::abs(y) - 1.5) < 0.02) continue;
    if (std::abs(y) < 1.5) {
      ASSERT_NEAR(ranges(*world)[static_cast<std::size_t>(i)], front, kTruth) << i;
      ++hits;
    } else {
      // Level beams meet nothing else.
      ASSERT_TRUE(std::isinf(ranges(*world)[static_cast<std::size_t>(i)])) << i;
    }
  }
  EXPECT_GT(hits, 90);
}

TEST_F(ScanTest, SeesAConeAsItIs) {
  const int n = 121;
  const double half = 0.15;
  // 2 m high on a base of 1 m; at 1 m above its base the radius is 0.5 m.
  const auto world = world_of(
      scene_of(mast(laser("0 0 0.9 0 0 0", n, half)) +
               body("cone", "5 0 1 0 0 0", "<cone><radius>1</radius><length>2</length></cone>")),
      device_);
  int hits = 0;
  for (int i = 0; i < n; ++i) {
    const double a = angle_of(i, n, half), across = 5 * std::sin(a);
    const float read = ranges(*world)[static_cast<std::size_t>(i)];
    if (std::abs(std::abs(across) - 0.5) < 0.005) continue;
    if (std::abs(across) > 0.5) {
      ASSERT_TRUE(std::isinf(read)) << i;
      continue;
    }
    ASSERT_NEAR(read, 5 * std::cos(a) - std::sqrt(0.25 - across * across), kTruth) << i;
    ++hits;
  }
  EXPECT_GT(hits, 60);
}

TEST_F(ScanTest, SeesATrenchAsItIs) {
  // A trench from x = 2 to 4, 1 m deep. Its walls stand between the middles of two columns.
  const int n = 201;
  const double half = 0.5, height = 2;
  const auto world = world_of(
      scene_of(mast(laser("0 0 1.9 1.5707963267948966 0.7 0", n, half)),
               "<trench><center_m>3 0</center_m><yaw_deg>90</yaw_deg><length_m>12</length_m>"
               "<width_m>2</width_m><depth_m>1</depth_m></trench>"),
      device_);
  const heightfield::TerrainView ground =
      sim::terrain_view(*world, heightfield::SurfaceKind::kColumns);
  int surface = 0, floor = 0;
  for (int i = 0; i < n; ++i) {
    const double a = angle_of(i, n, half);
    // Rolled by 90 deg, the fan stands upright along x.
    const Vec3 d = make_pose(0, 0, 0, kPi / 2, 0.7, 0).linear() * Vec3(std::cos(a), std::sin(a), 0);
    const double top = height / -d.z(), x = top * d.x();
    const double bottom = (height + 1) / -d.z(), x_floor = bottom * d.x();
    const float read = ranges(*world)[static_cast<std::size_t>(i)];
    if (x < 1.85 || x > 4.15) {
      ASSERT_NEAR(read, top, kTruth) << i;
      ++surface;
    } else if (x_floor > 2.15 && x_floor < 3.85 && x > 2.15) {
      ASSERT_NEAR(read, bottom, kTruth) << i;
      ++floor;
    }
    // Walls are as the bilinear ground has them.
    ASSERT_NEAR(read, ground.ray(Vec3(0, 0, height), d, 15), kTruth) << i;
  }
  EXPECT_GT(surface, 5);
  EXPECT_GT(floor, 10);
}

TEST_F(ScanTest, AgreesWithTheGroundOnHills) {
  const auto world = world_of(
      scene_of("", "<hills><height_m>1.5</height_m><wavelength_m>4</wavelength_m></hills>"),
      device_);
  RayScene scene(*world);
  scene.update();
  const heightfield::TerrainView ground =
      sim::terrain_view(*world, heightfield::SurfaceKind::kColumns);
  Random random(2);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(2, 4));
    const Vec3 d =
        Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.8, 0.1)).normalized();
    const double expected = ground.ray(p, d, 12);
    const auto hit = scene.first_hit(p, d, 12);
    // Beyond its edge the ground goes on level for vehicles, and ends for beams.
    if (expected >= 0 && (p + expected * d).head<2>().cwiseAbs().maxCoeff() > 10) continue;
    ASSERT_EQ(hit.has_value(), expected >= 0) << i;
    if (!hit) continue;
    ASSERT_NEAR(hit->distance, expected, 1e-9) << i;
    EXPECT_EQ(hit->what, Met::kGround);
    ++hits;
  }
  EXPECT_GT(hits, 1000);
}

/// Returns a dumper with a load whose bed is tipped by `angle` [deg].
std::string dumper(int angle) {
  return "<include><uri>model://dumper</uri><name>dumper</name><pose>0 0 0 0 0 0</pose>"
         "<navvy:joint name=\"tip_joint\"><initial_deg>" +
         std::to_string(angle) +
         "</initial_deg></navvy:joint><navvy:load><soil>loam</soil><mass_kg>600</mass_kg>"
         "</navvy:load></include>";
}

TEST_F(ScanTest, SeesTheHeapInABed) {
  const auto world = world_of(scene_of(dumper(0)), device_);
  RayScene scene(*world);
  scene.update();
  const auto heap = scene.first_hit(Vec3(1.2, 0, 3), -Vec3::UnitZ(), 5);
  ASSERT_TRUE(heap);
  EXPECT_EQ(heap->what, Met::kSoil);
  // The truth: the highest of the balls that the beam passes through.
  sim::VisibleSoil soil(*world);
  soil.update();
  double top = -10;
  for (const sim::SoilBall& ball : soil.balls()) {
    const Vec3 c = soil.origin() + ball.p_O.cast<double>();
    const double across2 = (c.head<2>() - Vec2(1.2, 0)).squaredNorm();
    const double r = static_cast<double>(ball.radius);
    if (across2 < r * r) top = std::max(top, c.z() + std::sqrt(r * r - across2));
  }
  EXPECT_NEAR(heap->distance, 3 - top, kTruth);
  // Well above the floor of the bed, which is at 0.3 m there.
  EXPECT_GT(top, 0.5);
}

TEST_F(ScanTest, SeesSoilThatFalls) {
  const auto world = world_of(scene_of(dumper(65)), device_);
  RayScene scene(*world);
  // Across the way down from the tail, which is at x = -1.1 then.
  const auto across = [&] {
    scene.update();
    for (const double x : {-1.8, -2.0, -2.2, -2.4})
      if (const auto hit = scene.first_hit(Vec3(x, -2.5, 0.35), Vec3::UnitY(), 5))
        if (hit->what == Met::kSoil) return hit->distance;
    return 10.0;
  };
  EXPECT_EQ(across(), 10);
  double distance = 10;
  while (distance == 10 && world->time() < 2) {
    for (int i = 0; i < 20; ++i) world->step();
    distance = across();
  }
  // Beams of 5 m return early: the curtain is about as wide as the bed.
  EXPECT_GT(distance, 1);
  EXPECT_LT(distance, 4);
}

TEST_F(ScanTest, BeamsThroughFallingSoilReturnEarly) {
  // 361 level beams across the way down from the tail, which is at x = -1.1: they meet nothing
  // else.
  const auto world =
      world_of(scene_of(dumper(65) + body("mast", "-2.1 -3 0.1 0 0 1.5707963267948966",
                                          "<box><size>0.2 0.2 0.2</size></box>",
                                          laser("0 0 0.25 0 0 0", 361, 0.1))),
               device_);
  for (const float r : ranges(*world)) ASSERT_TRUE(std::isinf(r));
  int early = 0, scans = 0;
  std::uint64_t seen = world->arrays().view("mast/laser/ranges").sequence();
  while (world->time() < 2 && scans < 5) {
    world->step();
    const sim::ArrayView view = world->arrays().view("mast/laser/ranges");
    if (view.sequence() == seen) continue;
    seen = view.sequence();
    sim::VisibleSoil soil(*world);
    soil.update();
    const Vec3 p = view.X_WF().translation();
    int hits = 0;
    for (int i = 0; i < 361; ++i) {
      const double a = angle_of(i, 361, 0.1);
      const Vec3 d = view.X_WF().linear() * Vec3(std::cos(a), std::sin(a), 0);
      // The truth: the first ball that the beam enters, of all, or the heap below.
      const double ground = soil.surface().ray(p, d, 15);
      double first = ground < 0 ? 15 : ground;
      for (const sim::SoilBall& ball : soil.balls()) {
        const Vec3 c = soil.origin() + ball.p_O.cast<double>() - p;
        const double along = c.dot(d), r = static_cast<double>(ball.radius),
                     root = r * r - (c - along * d).squaredNorm();
        if (root > 0 && along > 0) first = std::min(first, along - std::sqrt(root));
      }
      const double read = ranges(*world)[static_cast<std::size_t>(i)];
      if (first == 15) {
        EXPECT_TRUE(std::isinf(read)) << i;
        continue;
      }
      EXPECT_NEAR(read, first, kTruth) << i;
      ++hits;
    }
    early += hits;
    scans += hits > 0 ? 1 : 0;
  }
  EXPECT_EQ(scans, 5);
  EXPECT_GT(early, 100);
}

TEST_F(ScanTest, MeasuresDepthsAndLabelsOfTheGround) {
  const std::string camera =
      "<pose>0 0 3 0 1.5707963 0</pose><update_rate>10</update_rate><camera><horizontal_fov>1"
      "</horizontal_fov><image><width>16</width><height>12</height></image></camera>";
  const auto world =
      world_of(scene_of(body("mast", "3 0 0.1 0 0 0", "<box><size>0.2 0.2 0.2</size></box>",
                             "<sensor name=\"depth\" type=\"depth_camera\">" + camera +
                                 "</sensor><sensor name=\"labels\" type=\"segmentation\">" +
                                 camera + "</sensor>"),
                        "<slope><angle_deg>10</angle_deg></slope>"),
               device_);
  const auto depth = world->arrays().view("mast/depth/depth");
  const auto labels = world->arrays().view("mast/labels/labels");
  EXPECT_EQ(depth.channel().type_text(), "float32[12,16]");
  // The upper left pixel looks ahead and to the left of a camera that looks down: along x and y.
  const double scale = 2 * std::tan(0.5) / 16;
  for (int row = 0; row < 12; ++row)
    for (int column = 0; column < 16; ++column) {
      const std::size_t i = static_cast<std::size_t>(16 * row + column);
      if (labels.values<std::uint16_t>()[i] == 3) continue;  // the mast below
      ASSERT_EQ(labels.values<std::uint16_t>()[i], 1);
      const double z = depth.values<float>()[i];
      const Vec3 p =
          depth.X_WF() * (z * Vec3(1, (8 - column - 0.5) * scale, (6 - row - 0.5) * scale));
      // 1 mm is the bound of the issue.
      ASSERT_NEAR(p.z(), world->ground().sample(p.x(), p.y()), 0.001) << row << ' ' << column;
    }
}

TEST_F(ScanTest, FoldsDistancesOfATimeOfFlightCameraAndMixesAtEdges) {
  const std::string camera =
      "<sensor name=\"pmd\" type=\"navvy:time_of_flight\"><pose>0 0 0.9 0 0 0</pose>"
      "<update_rate>10</update_rate><navvy:time_of_flight><width>40</width><height>1</height>"
      "<horizontal_fov_deg>40</horizontal_fov_deg><modulation_hz>20e6</modulation_hz>"
      "<range><min>0.1</min><max>14</max></range><rays>4</rays></navvy:time_of_flight></sensor>";
  const auto world = world_of(
      scene_of(mast(camera) + body("near", "3.05 2 1 0 0 0", "<box><size>0.1 4.05 2</size></box>") +
               body("far", "9.05 0 1.5 0 0 0", "<box><size>0.1 18 3</size></box>")),
      device_);
  const auto read = world->arrays().view("mast/pmd/distances").values<float>();
  const double period = 299792458 / 40e6;
  EXPECT_NEAR(read[0], 3 / std::cos(radians(19.5)), 0.02);
  // 9 m is beyond the period of 7.49 m.
  EXPECT_NEAR(read[39], 9 / std::cos(radians(19.5)) - period, 0.05);
  bool flying = false;
  // Between the folded far wall, up to 2.1 m, and the near one, from 3 m.
  for (const float r : read) flying = flying || (r > 2.2f && r < 2.95f);
  EXPECT_TRUE(flying);
}

/// Returns the faults as texts.
std::vector<std::string> texts(const std::vector<Fault>& faults) {
  std::vector<std::string> out;
  out.reserve(faults.size());
  for (const Fault& fault : faults) out.push_back(fault.text());
  return out;
}

/// Returns the message with which a world refuses the sensors of a scene; empty if it does not. The
/// check without a world must have the same faults.
std::string refusal(const scene::Scene& scene, device::Device& device) {
  const std::vector<std::string> checked = texts(check_sensors(scene));
  try {
    world_of(scene, device);
  } catch (const InputError& error) {
    EXPECT_EQ(checked, texts(error.faults()));
    return error.what();
  }
  // A world is not refused for warnings.
  for (const std::string& text : checked)
    EXPECT_EQ(text.find(": error: "), std::string::npos) << text;
  return "";
}

TEST_F(ScanTest, RefusesASensorInABodyAndARateAboveTheSteps) {
  const auto refused = [&](const std::string& sensors, const std::string& others) {
    return refusal(scene_of(mast(sensors) + others), device_);
  };
  const std::string inside = refused(laser("0 0 0.9 0 0 0", 3, 0.1),
                                     body("block", "0 0 1 0 0 0", "<box><size>1 1 1</size></box>"));
  EXPECT_NE(inside.find("test.sdf:"), std::string::npos) << inside;
  EXPECT_NE(inside.find("link 'base' of 'block'"), std::string::npos) << inside;
  std::string fast = laser("0 0 0.9 0 0 0", 3, 0.1);
  fast.replace(fast.find("<update_rate>50"), 15, "<update_rate>50000");
  EXPECT_NE(refused(fast, "").find("at most once in a step"), std::string::npos);
  EXPECT_NE(refused(laser("0 0 -0.5 0 0 0", 3, 0.1), "").find("inside the ground"),
            std::string::npos);
  EXPECT_NE(refused(laser("0 0 0.9 0 0 0", 3, 0.1, "<navvy:sweep_s>0.1</navvy:sweep_s>"), "")
                .find("a sweep must end"),
            std::string::npos);
  EXPECT_EQ(refused(laser("0 0 0.9 0 0 0", 3, 0.1), ""), "");
}

TEST_F(ScanTest, WarnsOfASensorInItsOwnMachine) {
  // A file of another simulator: with an element of `navvy:`, the reader would refuse it.
  const scene::Scene scene = scene_io::load_scene_from_string(
      R"(<sdf version="1.9"><world name="w"><model name="m"><static>true</static>
<pose>0 0 1 0 0 0</pose><link name="l"><visual name="v"><geometry><box><size>0.4 0.4 0.4</size></box>
</geometry></visual><sensor name="eye" type="lidar"><update_rate>10</update_rate><lidar><scan>
<horizontal><samples>3</samples></horizontal></scan></lidar></sensor></link></model></world></sdf>)",
      "test.sdf", control::step_kinds());
  EXPECT_EQ(refusal(scene, device_), "");
  const std::vector<std::string> checked = texts(check_sensors(scene));
  ASSERT_EQ(checked.size(), 1u);
  EXPECT_NE(
      checked[0].find("warning: sensor[eye]: '0 0 1 m': the sensor is inside link 'l' of 'm'"),
      std::string::npos)
      << checked[0];
}

TEST_F(ScanTest, ChecksSensorsWhereTheirMachineStandsAtTheStart) {
  // The dumper stands on a slope, with its bed tipped: the sensor moves with both.
  const auto with = [&](const std::string& pose, const std::string& rate) {
    return "<include><uri>model://dumper</uri><name>dumper</name><pose>2 1 0 0 0 0.7</pose>"
           "<navvy:joint name=\"tip_joint\"><initial_deg>50</initial_deg></navvy:joint>"
           "<navvy:sensor name=\"eye\" link=\"bed\" type=\"lidar\"><pose>" +
           pose + "</pose><update_rate>" + rate +
           "</update_rate><lidar><scan><horizontal><samples>3</samples></horizontal></scan></lidar>"
           "</navvy:sensor></include>";
  };
  const auto refused = [&](const std::string& pose, const std::string& rate) {
    return refusal(
        scene_of(with(pose, rate), "<slope><angle_deg>8</angle_deg><yaw_deg>30</yaw_deg></slope>"),
        device_);
  };
  EXPECT_EQ(refused("0 0 3 0 0 0", "20"), "");
  EXPECT_NE(refused("0 0 -3 0 0 0", "20").find("the sensor is inside the ground at the start"),
            std::string::npos);
  // The longest step that the soil allows also limits a rate, without a device.
  EXPECT_NE(refused("0 0 3 0 0 0", "1200").find("a sensor reads at most once in a step of"),
            std::string::npos);
}

}  // namespace
}  // namespace navvy::sensor
