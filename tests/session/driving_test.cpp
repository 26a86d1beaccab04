// SPDX-License-Identifier: Apache-2.0
// One drive_to with the target 45 deg aside, by forces: shipped vehicles and six-wheeled rovers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "device/device.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/session.h"

namespace navvy::session {
namespace {

/// Returns a link with the mass and inertia of a small box, at `pose` "x y z" in the model.
std::string link(const std::string& name, const std::string& pose, double mass, double inertia) {
  const std::string i = std::to_string(inertia);
  return "<link name=\"" + name + "\"><pose>" + pose + " 0 0 0</pose><inertial><mass>" +
         std::to_string(mass) + "</mass><inertia><ixx>" + i + "</ixx><iyy>" + i + "</iyy><izz>" +
         i + "</izz></inertia></inertial></link>\n";
}

std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& axis, const std::string& limit) {
  return "<joint name=\"" + name + "\" type=\"" + (limit.empty() ? "continuous" : "revolute") +
         "\"><parent>" + parent + "</parent><child>" + child + "</child><axis><xyz>" + axis +
         "</xyz>" + (limit.empty() ? "" : "<limit>" + limit + "</limit>") + "</axis></joint>\n";
}

/// Returns a rover of 53 kg (56 kg if steered) on six driven wheels, whose rear two pairs are on
/// bogies. With `steered`, the front and the rear wheels steer; otherwise the wheels of a side are
/// `side_wheels`.
std::string rover(bool steered, const std::string& side_wheels) {
  std::string out = link("body", "0 0 0.35", 40, 1.5), wheels;
  for (const char* side : {"l", "r"}) {
    const std::string s = side, y = s == "l" ? "0.35" : "-0.35";
    out += link("bogie_" + s, "-0.225 " + y + " 0.25", 2, 0.04);
    out += joint("pivot_" + s, "body", "bogie_" + s, "0 1 0",
                 "<lower>-0.5</lower><upper>0.5</upper><effort>0</effort>");
    for (const auto& [at, x] : {std::pair{"f", "0.45"}, {"m", "0"}, {"b", "-0.45"}}) {
      const std::string wheel = at + s, place = std::string(x) + " " + y + " 0.12";
      std::string carrier = *at == 'f' ? "body" : "bogie_" + s, steer;
      if (steered && *at != 'm') {
        out += link("fork_" + wheel, place, 0.8, 0.003);
        out += joint("steer_" + wheel, carrier, "fork_" + wheel, "0 0 1",
                     "<lower>-1.2</lower><upper>1.2</upper><effort>40</effort>");
        carrier = "fork_" + wheel;
        steer = "<steer_joint>steer_" + wheel + "</steer_joint>";
      }
      out += link("wheel_" + wheel, place, 1.5, 0.01);
      out += joint("spin_" + wheel, carrier, "wheel_" + wheel, "0 1 0", "");
      wheels += "<navvy:wheel name=\"" + wheel + "\"><joint>spin_" + wheel + "</joint>" + steer +
                "<driven>true</driven><radius_m>0.12</radius_m><width_m>0.1</width_m>"
                "<stiffness_n_per_m>40000</stiffness_n_per_m>"
                "<damping_n_s_per_m>400</damping_n_s_per_m><friction>0.9</friction>"
                "</navvy:wheel>\n";
    }
  }
  return out + wheels + "<navvy:drive type=\"" + (steered ? "ackermann" : "differential") +
         "\"><max_speed_m_per_s>1.2</max_speed_m_per_s><tractive_force_n>400</tractive_force_n>"
         "<power_w>400</power_w><brake_force_n>400</brake_force_n><track_m>0.7</track_m>" +
         (steered ? "<max_steer_deg>35</max_steer_deg><wheelbase_m>0.45</wheelbase_m>"
                    "<steer_rate_deg_per_s>60</steer_rate_deg_per_s>"
                  : "<side_wheels>" + side_wheels + "</side_wheels>") +
         "</navvy:drive>\n";
}

struct Case {
  const char* machine;
  const char* soil;
  double slope;     // [deg], uphill in the direction of the start
  double distance;  // [m]
  double speed;     // [m/s]
};

void PrintTo(const Case& one, std::ostream* out) {
  *out << one.machine << " on " << one.soil << ", " << one.slope << " deg";
}

/// Returns a scene in which the machine starts along x and has its target 45 deg to the left.
scene::Scene beside(const Case& one) {
  const std::string half = std::to_string(0.5 * std::sqrt(0.5) * one.distance),
                    size = std::to_string(2.2 * one.distance + 6), name = one.machine,
                    pose = "<pose>-" + half + " -" + half + " 0 0 " +
                           std::to_string(-radians(one.slope)) + " 0</pose>",
                    program = "<navvy:program><drive_to><target_m>" + half + " " + half +
                              "</target_m><speed_m_per_s>" + std::to_string(one.speed) +
                              "</speed_m_per_s></drive_to></navvy:program>";
  const bool own = name.find("rover") == 0;
  const std::string machine =
      own ? "<model name=\"" + name + "\">" + pose +
                rover(name == "rover_steered",
                      name == "rover_independent" ? "independent" : "locked") +
                program + "</model>"
          : "<include><uri>model://" + name + "</uri>" + pose + program + "</include>";
  const std::string slope =
      one.slope == 0 ? ""
                     : "<slope><angle_deg>" + std::to_string(one.slope) + "</angle_deg></slope>";
  return scene_io::load_scene_from_string(
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"beside\"><navvy:soil ref=\"" +
          std::string(one.soil) + "\"/>\n<navvy:ground><size_m>" + size + " " + size +
          "</size_m><depth_m>1</depth_m>" + slope + "</navvy:ground>\n" + machine +
          "<navvy:recording><duration_s>90</duration_s><render>false</render></navvy:recording>"
          "</world></sdf>",
      navvy::source_dir() + "/scenarios/beside.sdf", control::step_kinds());
}

class Driving : public testing::TestWithParam<Case> {};

TEST_P(Driving, ArrivesBesideItsStart) {
  device::Device device;
  Session session(beside(GetParam()), device);
  while (!session.done()) session.step();
  EXPECT_TRUE(session.complete()) << session.programs().at(0).last().reason;
  const double half = 0.5 * std::sqrt(0.5) * GetParam().distance;
  const Vec3 at = session.world().machines().at(0).link(0).pose().translation();
  const double miss = (at.head<2>() - Vec2(half, half)).norm();
  std::printf("%s on %s, %g deg: miss %.3f m\n", GetParam().machine, GetParam().soil,
              GetParam().slope, miss);
  EXPECT_LT(miss, 0.15);  // the default tolerance of drive_to
}

// On gravel, loam and dry sand, and up 6 deg of loam, as far as the motors go.
INSTANTIATE_TEST_SUITE_P(
    Robots, Driving,
    testing::Values(
        Case{"robot", "gravel", 0, 4, 0.6}, Case{"robot", "gravel", 0, 2, 0.6},
        Case{"robot", "loam", 0, 4, 0.6}, Case{"robot", "loam", 6, 4, 0.6},
        Case{"robot_inventor", "gravel", 0, 4, 0.6}, Case{"robot_inventor", "loam", 0, 4, 0.6},
        Case{"robot_inventor", "loam", 6, 4, 0.6}, Case{"robot_vrml", "gravel", 0, 4, 0.6},
        Case{"robot_vrml", "loam", 0, 4, 0.6}, Case{"robot_vrml", "loam", 6, 4, 0.6},
        Case{"robot_with_trailer", "gravel", 0, 2.5, 0.6},
        Case{"robot_with_trailer", "loam", 0, 4, 0.6}, Case{"steered_robot", "gravel", 0, 2.5, 0.6},
        Case{"steered_robot", "loam", 0, 4, 0.6}, Case{"steered_robot", "loam", 6, 4, 0.6},
        Case{"tracked_robot", "gravel", 0, 4, 0.5}, Case{"tracked_robot", "loam", 0, 4, 0.5},
        Case{"tracked_robot", "loam", 6, 4, 0.5}, Case{"tracked_robot", "sand_dry", 0, 4, 0.5},
        Case{"tracked_robot", "sand_dry", 6, 4, 0.5}));
INSTANTIATE_TEST_SUITE_P(
    Vehicles, Driving,
    testing::Values(
        Case{"light_truck", "gravel", 0, 7, 1.5}, Case{"light_truck", "loam", 0, 8, 1.5},
        Case{"light_truck", "loam", 6, 8, 1.5}, Case{"light_truck", "sand_dry", 0, 8, 1.5},
        Case{"light_truck", "sand_dry", 6, 10, 1.5}, Case{"dumper", "gravel", 0, 14, 1.5},
        Case{"dumper", "loam", 0, 14, 1.5}, Case{"dumper", "loam", 6, 14, 1.5},
        Case{"dumper", "sand_dry", 0, 14, 1.5}, Case{"ew180", "gravel", 0, 14, 1.2},
        Case{"ew180", "loam", 0, 14, 1.2}, Case{"ew180", "loam", 6, 14, 1.2},
        Case{"ew180", "sand_dry", 0, 14, 1.2}, Case{"ex180_tracked", "gravel", 0, 12, 0.8},
        Case{"ex180_tracked", "loam", 0, 12, 0.8}, Case{"ex180_tracked", "loam", 6, 12, 0.8},
        Case{"ex180_tracked", "sand_dry", 0, 12, 0.8}));
INSTANTIATE_TEST_SUITE_P(
    Rovers, Driving,
    testing::Values(
        Case{"rover_skid", "gravel", 0, 4, 0.5}, Case{"rover_skid", "gravel", 0, 2.5, 0.5},
        Case{"rover_skid", "loam", 0, 4, 0.5}, Case{"rover_skid", "loam", 6, 4, 0.5},
        Case{"rover_skid", "sand_dry", 0, 4, 0.5}, Case{"rover_independent", "gravel", 0, 4, 0.5},
        Case{"rover_independent", "loam", 0, 4, 0.5}, Case{"rover_independent", "loam", 6, 4, 0.5},
        Case{"rover_independent", "sand_dry", 0, 4, 0.5},
        Case{"rover_steered", "gravel", 0, 2.5, 0.5}, Case{"rover_steered", "loam", 0, 4, 0.5},
        Case{"rover_steered", "loam", 6, 4, 0.5}, Case{"rover_steered", "sand_dry", 0, 4, 0.5}));

class DrivingStuck : public testing::TestWithParam<Case> {};

TEST_P(DrivingStuck, SaysThatItStandsAndHowFarFromTheTarget) {
  device::Device device;
  Session session(beside(GetParam()), device);
  while (!session.done()) session.step();
  EXPECT_TRUE(session.fell_short());
  const control::StepReport last = session.programs().at(0).last();
  EXPECT_EQ(last.reason.find("it has stood for 5.00 s, "), 0u) << last.reason;
  EXPECT_NE(last.reason.find(" m from the target: "), std::string::npos) << last.reason;
}

// Small wheels sink into dry sand, and the robot's motors do not pull the trailer up 6 deg of loam.
INSTANTIATE_TEST_SUITE_P(Robots, DrivingStuck,
                         testing::Values(Case{"robot", "sand_dry", 0, 4, 0.6},
                                         Case{"robot_inventor", "sand_dry", 0, 4, 0.6},
                                         Case{"robot_vrml", "sand_dry", 0, 4, 0.6},
                                         Case{"robot_with_trailer", "sand_dry", 0, 4, 0.6},
                                         Case{"robot_with_trailer", "loam", 6, 4, 0.6},
                                         Case{"steered_robot", "sand_dry", 0, 4, 0.6}));

}  // namespace
}  // namespace navvy::session
