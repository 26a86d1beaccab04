// SPDX-License-Identifier: Apache-2.0
// The machines of a recorded bag against the world that was recorded: frames, descriptions and
// odometry, read by `rosbags` and ROS's parser of URDF (bag_machines.py, `./dev readers`).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "folder.h"
#include "heightfield/maps.h"
#include "paths.h"
#include "run/simulation.h"
#include "scene_io/loader.h"
#include "sim/world.h"

namespace navvy::run {
namespace {

using nlohmann::json;

/// Path of the readers' Python; empty if it is not installed.
std::string readers() {
  const std::string python = navvy::source_dir() + "/build/readers/bin/python3";
  return std::filesystem::exists(python) ? python : "";
}

/// A robot with a trailer that drives along an arc, one that rolls on it without slip, an excavator
/// that swings, and a frame whose joints have their axes beside the origins of their links.
const char* const kScene = R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w">
<navvy:soil ref="gravel"/>
<navvy:ground><size_m>40 20</size_m><depth_m>0.5</depth_m></navvy:ground>
<include><uri>model://robot_with_trailer</uri><name>robot</name><pose>-6 0 0 0 0 0.5</pose></include>
<include><uri>model://robot</uri><name>rolling</name><pose>-6 5 0 0 0 0.5</pose>
<navvy:physics>kinematic</navvy:physics></include>
<include><uri>model://ew180</uri><name>digger</name><pose>5 0 0 0 0 -1</pose></include>
<model name="odd"><pose>-12 0 0 0 0 0</pose><static>true</static>
<link name="base_link"><pose>0.5 0 1 0 0 0.3</pose></link>
<link name="odom"><pose>1 0 2 1.5707963267948966 0 0.2</pose>
<inertial><pose>0.1 0.2 0.3 0 0 0</pose><mass>3</mass><inertia><ixx>1</ixx><ixy>0.1</ixy><ixz>0.2</ixz>
<iyy>2</iyy><iyz>0.3</iyz><izz>2.5</izz></inertia></inertial>
<visual name="a &amp; b"><pose>0 0 1 0 1.5707963267948966 0</pose>
<geometry><capsule><radius>0.25</radius><length>1.5</length></capsule></geometry></visual>
<collision name="c"><geometry><box><size>0.25 0.5 0.75</size></box></geometry></collision></link>
<link name="slider"><pose>2 0 2 0 0 0</pose><inertial><mass>2</mass></inertial></link>
<link name="plate"><pose>2 1 2 0 0 0</pose><inertial><mass>2</mass></inertial></link>
<joint name="crank" type="revolute"><pose>0 0.25 -0.5 0.1 0 0</pose><parent>base_link</parent><child>odom</child>
<axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>2</upper><effort>50</effort><velocity>3</velocity></limit>
<dynamics><damping>4</damping><friction>5</friction></dynamics></axis></joint>
<joint name="slide" type="prismatic"><pose>0 0 1 0 0 0</pose><parent>odom</parent><child>slider</child>
<axis><xyz>0 1 1</xyz><limit><lower>-1</lower><upper>1</upper></limit></axis></joint>
<joint name="weld" type="fixed"><parent>slider</parent><child>plate</child></joint>
</model>
<navvy:record name="bag"><format>bag</format></navvy:record>
<navvy:record name="all"><format>mcap</format><machine_rate_hz>20</machine_rate_hz></navvy:record>
<navvy:recording><duration_s>3</duration_s><render>false</render></navvy:recording>
</world></sdf>)";

Pose pose_from(const json& numbers) {
  Pose X;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      X.matrix()(row, column) = numbers.at(static_cast<std::size_t>(4 * row + column));
  return X;
}

/// Largest difference of two poses, in metres or as an element of the rotation.
double difference(const Pose& a, const Pose& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

/// Checks bodies, joints and chains of a machine's URDF against its model and its poses.
void expect_description(const sim::MachineHandle& machine, const json& bag) {
  SCOPED_TRACE(machine.name());
  const scene::Machine& model = machine.description();
  const json& urdf = bag.at("machines").at(machine.name());
  EXPECT_EQ(urdf.at("root"), "base_link");
  const Pose X_WB = pose_from(bag.at("poses").at(machine.name() + "/base_link"));
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const scene::Link& link = model.links[i];
    const json& body = urdf.at("links").at(link.name);
    EXPECT_EQ(body.at("mass"), link.mass) << link.name;
    for (std::size_t k = 0; k < 9; ++k)
      EXPECT_EQ(body.at("inertia")[k],
                link.inertia(static_cast<int>(k / 3), static_cast<int>(k % 3)))
          << link.name << " " << k;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(body.at("centre")[k], link.p_LCom[static_cast<int>(k)]) << link.name;
    // Positions of joints give the same poses by URDF's rules.
    EXPECT_LT(difference(X_WB * pose_from(urdf.at("poses").at(link.name)),
                         machine.link(static_cast<int>(i)).pose()),
              1e-6)
        << link.name;
  }
  std::size_t with_position = 0;
  for (const scene::Joint& joint : model.joints) {
    const json& about = urdf.at("joints").at(joint.name);
    const bool turns = joint.type == scene::Joint::Type::kRevolute;
    if (turns) EXPECT_EQ(about.at("type"), joint.has_limits ? "revolute" : "continuous");
    if (joint.type == scene::Joint::Type::kFixed) EXPECT_EQ(about.at("type"), "fixed");
    if (joint.type == scene::Joint::Type::kBall) EXPECT_EQ(about.at("type"), "floating");
    if (turns || joint.type == scene::Joint::Type::kPrismatic) {
      ++with_position;
      EXPECT_EQ(about.at("limit")[2], joint.effort) << joint.name;
      EXPECT_EQ(about.at("limit")[3], joint.velocity) << joint.name;
    }
    if (joint.has_limits)
      EXPECT_EQ(json({about.at("limit")[0], about.at("limit")[1]}),
                json({joint.lower, joint.upper}))
          << joint.name;
  }
  EXPECT_EQ(urdf.at("states").size(), with_position);
}

/// Checks the shapes of the frame that was made for this: a capsule on its side, and a box.
void expect_shapes(const json& bag) {
  const json& link = bag.at("machines").at("odd").at("links").at("odom");
  const json& visuals = link.at("visuals");
  ASSERT_EQ(visuals.size(), 3u);
  EXPECT_EQ(visuals[0][0], "Cylinder");
  EXPECT_EQ(visuals[0][1], json({{"radius", 0.25}, {"length", 1.5}}));
  EXPECT_LT(difference(pose_from(visuals[0][2]), make_pose(0, 0, 1, 0, kPi / 2)), 1e-12);
  // The ends of the capsule along its axis, which is along x of the link.
  EXPECT_EQ(visuals[1][0], "Sphere");
  EXPECT_LT(difference(pose_from(visuals[1][2]), make_pose(0.75, 0, 1, 0, kPi / 2)), 1e-12);
  EXPECT_LT(difference(pose_from(visuals[2][2]), make_pose(-0.75, 0, 1, 0, kPi / 2)), 1e-12);
  EXPECT_EQ(link.at("collisions")[0][0], "Box");
  EXPECT_EQ(link.at("collisions")[0][1], json({{"size", {0.25, 0.5, 0.75}}}));
  // The mesh of the excavator's bucket is a file that exists.
  bool meshes = false;
  for (const json& visual :
       bag.at("machines").at("digger").at("links").at("bucket").at("visuals")) {
    if (visual[0] != "Mesh") continue;
    const std::string uri = visual[1].at("filename");
    EXPECT_EQ(uri.substr(0, 7), "file://");
    EXPECT_TRUE(std::filesystem::exists(uri.substr(7))) << uri;
    meshes = true;
  }
  EXPECT_TRUE(meshes);
}

/// Distance in the plane of the estimated and the true pose of a machine's base.
double error_of(const json& machine) {
  const Pose by_wheels = pose_from(machine.at("odom").at("pose"));
  return (by_wheels.translation() - pose_from(machine.at("truth").at("pose")).translation())
      .head<2>()
      .norm();
}

void expect_odometry(const json& bag) {
  const json &rolling = bag.at("machines").at("rolling"), &robot = bag.at("machines").at("robot");
  EXPECT_EQ(robot.at("odom").at("frames"), json({"robot/odom", "robot/base_link"}));
  EXPECT_EQ(robot.at("truth").at("frames"), json({"map", "robot/base_link"}));
  // Wheels without slip: what is left is the rounding to counts of 8e-6 m and to steps.
  const Vec3 at = pose_from(rolling.at("truth").at("pose")).translation();
  EXPECT_GT((at - Vec3(-6, 5, 0)).norm(), 0.5) << "it has driven";
  EXPECT_LT(error_of(rolling), 1e-3);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(rolling.at("odom").at("twist")[k].get<double>(),
                rolling.at("truth").at("twist")[k].get<double>(), 2e-3)
        << k;
  // Wheels that slip turn farther than they drive, and the estimate knows nothing else.
  EXPECT_GT(error_of(robot), 0.01);
  EXPECT_GT(robot.at("odom").at("twist")[0], robot.at("truth").at("twist")[0]);
  EXPECT_EQ(bag.at("parents").at("robot/odom"), "map");
  // A machine without encoders knows its pose.
  const json& odd = bag.at("machines").at("odd");
  EXPECT_EQ(odd.at("odom").at("pose"), odd.at("truth").at("pose"));
  EXPECT_EQ(odd.at("odom").at("frames"), json({"odd/odom_", "odd/base_link"}));
}

/// A run of 2 s with its recorded bags.
class BagMachines : public testing::Test {
 protected:
  struct Run {
    explicit Run(const std::string& folder)
        : simulation(scene_io::load_scene_from_string(kScene, "scene.sdf", control::step_kinds()),
                     [&] {
                       SimulationOptions options;
                       options.folder = folder;
                       return options;
                     }()) {
      for (const std::string robot : {"robot", "rolling"}) {
        simulation.set(robot + "/drive/speed", 0.6);
        simulation.set(robot + "/drive/steer", 0.5);
      }
      simulation.set("digger/swing_joint/velocity", 0.4);
      simulation.set("odd/crank/velocity", 0.3);
      simulation.set("odd/slide/velocity", -0.1);
      // The last step is one in which both bags are due.
      while (simulation.time() < 2.0 - 1e-9) simulation.step();
    }
    Simulation simulation;
  };

  void SetUp() override {
    if (readers().empty()) GTEST_SKIP() << "mcap, rosbags and urdf_parser_py are missing";
    run_.emplace(folder_ / "out");
    for (const sim::MachineHandle& machine : machines())
      for (std::size_t i = 0; i < machine.description().links.size(); ++i) {
        const sim::LinkHandle link = machine.link(static_cast<int>(i));
        truth_[machine.name() + "/" + link.name()] = link.pose();
      }
  }
  std::vector<sim::MachineHandle> machines() {
    const sim::Machines all = run_->simulation.world().machines();
    std::vector<sim::MachineHandle> out;
    for (int i = 0; i < all.count(); ++i) out.push_back(all.at(i));
    return out;
  }
  json read(const std::string& bag) const {
    const std::string script = navvy::source_dir() + "/tests/run/bag_machines.py";
    return json::parse(
        heightfield::testing::output_of("'" + readers() + "' '" + script + "' '" +
                                        folder_ / "out/" + bag + "' robot rolling digger odd"),
        nullptr, false);
  }

  const test::Folder folder_;
  std::optional<Run> run_;
  std::map<std::string, Pose> truth_;
};

// One test, because it needs one world and one reading of each bag.
TEST_F(BagMachines, AgreeWithTheWorldInFramesDescriptionsAndOdometry) {
  run_->simulation.finish();
  for (const char* name : {"bag", "all.mcap"}) {
    SCOPED_TRACE(name);
    const json bag = read(name);
    ASSERT_FALSE(bag.is_discarded()) << "the reader failed";
    for (const auto& [topic, about] : bag.at("topics").items()) {
      const bool latched = topic == "/tf_static" || topic.ends_with("/robot_description");
      EXPECT_EQ(about[1], latched ? "TRANSIENT_LOCAL" : "") << topic;
      if (latched) EXPECT_EQ(about[0], 1) << topic;
    }
    // The tree of REP 105: links below links, not a star.
    const json& parents = bag.at("parents");
    EXPECT_EQ(parents.at("digger/odom"), "map");
    EXPECT_EQ(parents.at("digger/base_link"), "digger/odom");
    EXPECT_EQ(parents.at("digger/chassis"), "digger/base_link");
    EXPECT_EQ(parents.at("digger/bucket"), "digger/stick");
    EXPECT_EQ(parents.at("robot/robot_trailer::chassis"), "robot/robot::chassis");
    EXPECT_EQ(parents.at("odd/base_link"), "odd/odom_") << "its base link is called base_link";
    EXPECT_EQ(parents.at("odd/odom"), "odd/crank_axis");
    for (const auto& [frame, X_WL] : truth_)
      EXPECT_LT(difference(pose_from(bag.at("poses").at(frame)), X_WL), 1e-9) << frame;
    for (const sim::MachineHandle& machine : machines()) expect_description(machine, bag);
    expect_shapes(bag);
    expect_odometry(bag);
  }
}

}  // namespace
}  // namespace navvy::run
