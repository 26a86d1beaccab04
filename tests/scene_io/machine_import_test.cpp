// SPDX-License-Identifier: Apache-2.0
// `navvy import`: wheels, drive, masses and starts of foreign machines.
#include "scene_io/machine_import.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "folder.h"
#include "scene_io/crawler.h"
#include "scene_io/loader.h"

namespace navvy::scene_io {
namespace {

std::string link(const std::string& name, double mass, const std::string& shape) {
  return "<link name='" + name + "'><inertial><mass value='" + std::to_string(mass) +
         "'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial>"
         "<collision><geometry>" +
         shape + "</geometry></collision></link>\n";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& xyz, const std::string& rpy,
                  const std::string& axis, const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + xyz + "' rpy='" + rpy +
         "'/><axis xyz='" + axis + "'/>" + more + "</joint>\n";
}

const std::string kTyre = "<cylinder radius='0.2' length='0.1'/>";
// Cylinders stand along z, so wheels are turned about x: z of the link points to -y or y.
const std::string kToRight = "1.5707963267948966 0 0", kToLeft = "-1.5707963267948966 0 0";
const std::string kMotor = "<limit effort='10' velocity='5'/>";

/// A body with two wheels at the back: the left axis points to the left, the right one to the
/// right.
std::string cart(double body_mass = 50) {
  return link("body", body_mass, "<box size='1 0.5 0.2'/>") + link("l", 2, kTyre) +
         link("r", 2, kTyre) +
         joint("spin_l", "continuous", "body", "l", "-0.4 0.3 0", kToLeft, "0 0 1", kMotor) +
         joint("spin_r", "continuous", "body", "r", "-0.4 -0.3 0", kToRight, "0 0 1", kMotor);
}

/// Wheels at the front, each on a carrier that steers it; the right one has no limits.
std::string front() {
  const std::string limits = "<limit lower='-0.5' upper='0.4' effort='5' velocity='1'/>";
  std::string out;
  for (const std::string side : {"l", "r"})
    out +=
        link("pin_" + side, 1, "<box size='0.05 0.05 0.05'/>") + link("f" + side, 2, kTyre) +
        joint("steer_" + side, side == "l" ? "revolute" : "continuous", "body", "pin_" + side,
              side == "l" ? "0.4 0.3 0" : "0.4 -0.3 0", "0 0 0", "0 0 1",
              side == "l" ? limits : "") +
        joint("roll_" + side, "continuous", "pin_" + side, "f" + side, "0 0 0", kToLeft, "0 0 1");
  return out;
}

class MachineImport : public ::testing::Test {
 protected:
  scene::Machine import(const std::string& robot, double density = 0) {
    std::ofstream(folder_ / "r.urdf") << "<robot name='r'>\n" << robot << "</robot>";
    report_.clear();
    std::filesystem::remove_all(folder_ / "out");
    for (const std::string& sentence :
         import_machine(folder_ / "r.urdf", {folder_ / "out", density, ""}))
      report_ += sentence + "\n";
    return load_machine(folder_ / "out/model.sdf");
  }
  bool says(const std::string& text) const { return report_.find(text) != std::string::npos; }

  test::Folder folder_;
  std::string report_;
};

TEST_F(MachineImport, CylindersOnJointsWithoutEndBecomeWheelsWithADrive) {
  const scene::Machine machine = import(cart());
  ASSERT_EQ(machine.wheels.size(), 2u) << report_;
  for (const scene::Wheel& wheel : machine.wheels) {
    EXPECT_DOUBLE_EQ(wheel.radius, 0.2);
    EXPECT_DOUBLE_EQ(wheel.width, 0.1);
    EXPECT_TRUE(wheel.driven);
    const scene::Joint& spin =
        machine.joints[static_cast<std::size_t>(machine.joint_index(wheel.joint))];
    const scene::Link& link = machine.links[static_cast<std::size_t>(spin.child)];
    // Both axes point to the left now, so a positive speed drives ahead.
    EXPECT_GT(((link.X_ML * spin.X_LcJ).linear() * spin.axis).y(), 0.999);
    // A tyre and a collision would touch twice.
    EXPECT_TRUE(link.collisions.empty());
  }
  ASSERT_TRUE(machine.has_drive);
  const auto& drive = std::get<scene::DifferentialDrive>(machine.drive);
  EXPECT_NEAR(drive.track, 0.6, 1e-9);
  EXPECT_NEAR(drive.max_speed, 1, 1e-9);
  EXPECT_NEAR(drive.tractive_force, 100, 1e-9);
  EXPECT_TRUE(says("the axis of joint 'spin_r' pointed to the right")) << report_;
  EXPECT_FALSE(says("to correct")) << report_;
  EXPECT_TRUE(says("not recognised: no three joints in a row")) << report_;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/IMPORT.md"));
}

TEST_F(MachineImport, SteeredWheelsMakeAnAckermannDrive) {
  const scene::Machine machine = import(cart() + front());
  ASSERT_EQ(machine.wheels.size(), 4u) << report_;
  const auto& drive = std::get<scene::AckermannDrive>(machine.drive);
  EXPECT_NEAR(drive.wheelbase, 0.8, 1e-9);
  EXPECT_NEAR(drive.track, 0.6, 1e-9);
  EXPECT_NEAR(drive.max_steer, 0.5, 1e-8);
  int steered = 0;
  for (const scene::Wheel& wheel : machine.wheels) steered += wheel.steer_joint.empty() ? 0 : 1;
  EXPECT_EQ(steered, 2) << report_;
  EXPECT_FALSE(says("to correct")) << report_;
}

TEST_F(MachineImport, WhatTheReaderDropsIsNamedWithItsLine) {
  import(cart());
  EXPECT_FALSE(says("is ignored")) << report_;
  // The robot's first line is that of <robot>, and each link and joint has one.
  import(cart() + "<gazebo><plugin name='p' filename='f'/></gazebo>");
  EXPECT_TRUE(says("dropped or assumed by the reader: " + (folder_ / "r.urdf") +
                   ":7: warning: robot[r]/gazebo: is ignored (plugins of Gazebo are not run)"))
      << report_;
  std::ofstream(folder_ / "m.sdf")
      << "<sdf version='1.6'>\n<model name='m'>\n<link name='a'><inertial><mass>9</mass></inertial>"
         "</link>\n<plugin name='p' filename='f'/></model></sdf>";
  std::string report;
  for (const std::string& sentence : import_machine(folder_ / "m.sdf", {folder_ / "sdf", 0, ""}))
    report += sentence + "\n";
  EXPECT_NE(report.find("dropped or assumed by the reader: " + (folder_ / "m.sdf") +
                        ":4: warning: model[m]/plugin[p]: "),
            std::string::npos)
      << report;
}

TEST_F(MachineImport, WhatTheDriveAssumesIsMarked) {
  const auto with_motor = [](const std::string& motor) {
    std::string robot = cart();
    for (std::size_t at = robot.find(kMotor); at != std::string::npos; at = robot.find(kMotor, at))
      robot.replace(at, kMotor.size(), motor);
    return robot;
  };
  const std::string made = "made: a drive by the difference of sides, ";
  import(cart());
  EXPECT_TRUE(says(made + "1 m/s, 100 N\n")) << report_;
  import(with_motor("<limit effort='10' velocity='0'/>"));
  EXPECT_TRUE(says(made + "1 m/s (assumed), 100 N\n")) << report_;
  // Half the weight of 54 kg.
  import(with_motor("<limit effort='0' velocity='10'/>"));
  EXPECT_TRUE(says(made + "2 m/s, 264.87 N (assumed)\n")) << report_;
  const scene::Machine machine = import(with_motor(""));
  EXPECT_TRUE(says(made + "1 m/s (assumed), 264.87 N (assumed)\n")) << report_;
  const auto& drive = std::get<scene::DifferentialDrive>(machine.drive);
  EXPECT_NEAR(drive.max_speed, 1, 1e-9);
  EXPECT_NEAR(drive.tractive_force, 0.5 * 54 * kGravity, 1e-3);
}

TEST_F(MachineImport, AWheelThatSwivelsAloneIsACaster) {
  const scene::Machine machine =
      import(cart() + link("fork", 1, "<box size='0.05 0.05 0.05'/>") + link("third", 2, kTyre) +
             joint("swivel", "continuous", "body", "fork", "0.4 0 0", "0 0 0", "0 0 1") +
             joint("roll", "continuous", "fork", "third", "0 0 0", kToLeft, "0 0 1"));
  ASSERT_EQ(machine.wheels.size(), 3u) << report_;
  EXPECT_TRUE(says("made: wheel 'third' on joint 'roll', radius 0.2 m, width 0.1 m, a caster; "))
      << report_;
  EXPECT_TRUE(says("made: wheel 'l' on joint 'spin_l', radius 0.2 m, width 0.1 m, driven; "))
      << report_;
  for (const scene::Wheel& wheel : machine.wheels) {
    EXPECT_EQ(wheel.driven, wheel.joint != "roll") << wheel.joint;
    EXPECT_TRUE(wheel.steer_joint.empty()) << wheel.joint;
  }
  EXPECT_TRUE(std::holds_alternative<scene::DifferentialDrive>(machine.drive)) << report_;
  EXPECT_FALSE(says("to correct")) << report_;
}

TEST_F(MachineImport, PlaceholdersOfMassAreNamedOrReplaced) {
  const scene::Machine kept = import(cart(0.03));
  EXPECT_NEAR(kept.links[0].mass, 0.03, 1e-9);
  EXPECT_TRUE(says("kept: link 'body' has 0.03 kg in shapes of 0.1 m3")) << report_;
  const scene::Machine replaced = import(cart(0.03), 800);
  EXPECT_NEAR(replaced.links[0].mass, 80, 1e-6);
  // A box of 1 x 0.5 x 0.2 m.
  EXPECT_NEAR(replaced.links[0].inertia(0, 0), 80 * (0.25 + 0.04) / 12, 1e-6);
  EXPECT_TRUE(says("replaced: link 'body'")) << report_;
  // The wheels have masses of their own.
  EXPECT_EQ(replaced.links[1].mass, 2);
}

TEST_F(MachineImport, LightLinksOfAHeavyMachineArePlaceholders) {
  const auto with_lamp = [](double body_mass) {
    return cart(body_mass) + link("lamp", 0.2, "<box size='0.05 0.05 0.05'/>") +
           joint("on", "fixed", "body", "lamp", "0 0 0.2", "0 0 0", "1 0 0");
  };
  import(with_lamp(900));
  EXPECT_FALSE(says("'lamp' has")) << report_;
  import(with_lamp(2000));
  EXPECT_TRUE(says("kept: link 'lamp' has 0.2 kg in a machine of 2004 kg, a placeholder"))
      << report_;
  std::ifstream list(folder_ / "out/masses.csv");
  const std::string text(std::istreambuf_iterator<char>(list), {});
  EXPECT_NE(text.find("link,mass_kg\nlamp,0.2\n"), std::string::npos) << text;
  const scene::Machine replaced = import(with_lamp(2000), 800);
  EXPECT_NEAR(replaced.links[static_cast<std::size_t>(replaced.link_index("lamp"))].mass, 0.1,
              1e-9);
}

TEST_F(MachineImport, PlanesOverlapNothing) {
  std::ofstream(folder_ / "m.sdf")
      << "<sdf version='1.6'><model name='m'><link name='a'><inertial><mass>9</mass></inertial>"
         "<collision name='c'><geometry><plane><normal>0 0 1</normal><size>1 1</size></plane>"
         "</geometry></collision></link><link name='b'><inertial><mass>9</mass></inertial></link>"
         "<link name='d'><inertial><mass>9</mass></inertial><collision name='c'><geometry><box>"
         "<size>1 1 1</size></box></geometry></collision></link><joint name='w' type='fixed'>"
         "<parent>world</parent><child>a</child></joint><joint name='i' type='fixed'>"
         "<parent>a</parent><child>b</child></joint><joint name='j' type='fixed'>"
         "<parent>b</parent><child>d</child></joint></model></sdf>";
  std::string report;
  for (const std::string& sentence : import_machine(folder_ / "m.sdf", {folder_ / "out", 0, ""}))
    report += sentence + "\n";
  EXPECT_EQ(report.find("overlapping"), std::string::npos) << report;
}

TEST_F(MachineImport, ABucketOfPlatesIsKeptWithTheValuesOfItsFile) {
  std::ofstream(folder_ / "mine.sdf")
      << "<sdf version='1.9' xmlns:navvy='navvy'><navvy:bucket name='mine'><width_m>0.4</width_m>"
         "<capacity_m3>0.06</capacity_m3><plate_m>0.015</plate_m></navvy:bucket></sdf>";
  const auto part = [](const std::string& name, const std::string& x, const std::string& box) {
    return "<link name='" + name + "'><pose>" + x +
           " 0 1 0 0 0</pose><inertial><mass>90</mass><inertia><ixx>9</ixx><iyy>9</iyy><izz>9"
           "</izz></inertia></inertial><collision name='c'><geometry><box><size>" +
           box + "</size></box></geometry></collision></link>";
  };
  const auto turns = [](const std::string& name, const std::string& parent,
                        const std::string& child, const std::string& lower,
                        const std::string& upper) {
    return "<joint name='" + name + "' type='revolute'><parent>" + parent + "</parent><child>" +
           child + "</child><axis><xyz>0 1 0</xyz><limit><lower>" + lower + "</lower><upper>" +
           upper + "</upper></limit></axis></joint>";
  };
  std::ofstream(folder_ / "m.sdf")
      << "<sdf version='1.9' xmlns:navvy='navvy'><model name='m'>" << part("a", "0", "1 1 0.4")
      << part("b", "0.2", "0.2 0.2 0.2") << part("s", "2.2", "0.2 0.2 0.2")
      << "<link name='k'><pose>3.4 0 1 0 0 0</pose></link>" << turns("j1", "a", "b", "-1", "0.8")
      << turns("j2", "b", "s", "-0.5", "1.6") << turns("j3", "s", "k", "-0.4", "2.6")
      << "<navvy:bucket ref='mine.sdf'><link>k</link><tip_m>0.7 0 0</tip_m><opening>0 0 -1"
         "</opening></navvy:bucket></model></sdf>";
  std::string report;
  for (const std::string& sentence :
       import_machine(folder_ / "m.sdf", {folder_ / "far/out", 0, ""}))
    report += sentence + "\n";
  EXPECT_NE(report.find("kept: the bucket of link 'k'"), std::string::npos) << report;
  EXPECT_EQ(report.find("to correct"), std::string::npos) << report;
  std::ifstream file(folder_ / "far/out/model.sdf");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_EQ(text.find(" ref="), std::string::npos) << text;
  const scene::Machine before = load_machine(folder_ / "m.sdf"),
                       after = load_machine(folder_ / "far/out/model.sdf");
  ASSERT_EQ(after.buckets.size(), 1u);
  EXPECT_EQ(after.buckets[0].name, "mine");
  EXPECT_EQ(after.buckets[0].capacity, 0.06);
  EXPECT_EQ(after.shells.size(), 1u);
  EXPECT_EQ(after.arm.bucket, "j3");
  EXPECT_NEAR(after.links[static_cast<std::size_t>(after.link_index("k"))].mass,
              before.links[static_cast<std::size_t>(before.link_index("k"))].mass, 1e-9);
}

TEST_F(MachineImport, JointStartsWithinItsLimits) {
  const scene::Machine machine =
      import(link("a", 5, "<sphere radius='0.1'/>") + link("b", 5, "<sphere radius='0.1'/>") +
             joint("j", "revolute", "a", "b", "1 0 0", "0 0 0", "0 1 0",
                   "<limit lower='0.5' upper='1' effort='9' velocity='9'/>"));
  EXPECT_NEAR(machine.joints[0].initial, 0.5, 1e-12);
  EXPECT_TRUE(says("joint 'j' would start beyond its limits")) << report_;
  EXPECT_TRUE(says("no link rolls on the ground")) << report_;
}

TEST_F(MachineImport, MeshesAreCopiedBesideTheMachine) {
  std::ofstream(folder_ / "m.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n";
  const scene::Machine machine = import(link("a", 5, "<mesh filename='m.obj'/>"));
  EXPECT_EQ(machine.links[0].collisions.at(0).geometry.mesh_file,
            std::filesystem::canonical(folder_ / "out/meshes/m.obj").string());
}

TEST_F(MachineImport, RefusesWorldsAndFoldersThatHoldAMachine) {
  std::ofstream(folder_ / "w.sdf") << "<sdf version='1.6'>\n<world name='w'/></sdf>";
  EXPECT_THROW(import_machine(folder_ / "w.sdf", {folder_ / "o", 0, ""}), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "o"));
  import(cart());
  EXPECT_THROW(import_machine(folder_ / "r.urdf", {folder_ / "out", 0, ""}), InputError);
}

/// Imports the excavator of crawler.h with the text of a file of masses; empty: without one.
class CrawlerImport : public ::testing::Test {
 protected:
  void SetUp() override { scene_io::testing::write_crawler(folder_); }
  scene::Machine import(const std::string& masses) {
    std::ofstream(folder_ / "masses.csv") << masses;
    report_.clear();
    std::filesystem::remove_all(folder_ / "out");
    for (const std::string& sentence :
         import_machine(folder_ / "crawler.urdf",
                        {folder_ / "out", 0, masses.empty() ? "" : folder_ / "masses.csv"}))
      report_ += sentence + "\n";
    return load_machine(folder_ / "out/model.sdf");
  }
  std::string refused(const std::string& masses) {
    try {
      import(masses);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  bool says(const std::string& text) const { return report_.find(text) != std::string::npos; }

  test::Folder folder_;
  std::string report_;
};

TEST_F(CrawlerImport, NamesTheRolesOfTheArmAndTurnsItsAxes) {
  const scene::Machine machine = import(scene_io::testing::kCrawlerMasses);
  EXPECT_EQ(machine.arm.swing, "turn");
  EXPECT_EQ(machine.arm.boom, "j1");
  EXPECT_EQ(machine.arm.stick, "j2");
  EXPECT_EQ(machine.arm.bucket, "j3");
  for (const char* name : {"j1", "j2", "j3"}) {
    const scene::Joint& joint = machine.joints[static_cast<std::size_t>(machine.joint_index(name))];
    const Pose X_MJ = machine.links[static_cast<std::size_t>(joint.child)].X_ML * joint.X_LcJ;
    // A positive angle lifts the arm, in a frame with x forward and z up.
    EXPECT_NEAR((X_MJ.linear() * joint.axis - Vec3(0, -1, 0)).norm(), 0, 1e-9) << name;
    EXPECT_NEAR((X_MJ.linear() - Mat3::Identity()).norm(), 0, 1e-9) << name;
  }
  const scene::Joint& boom = machine.joints[static_cast<std::size_t>(machine.joint_index("j1"))];
  EXPECT_NEAR(boom.lower, -0.85, 1e-12);
  EXPECT_NEAR(boom.upper, 1.05, 1e-12);
  // Zero was beyond the limits of the stick.
  const scene::Joint& stick = machine.joints[static_cast<std::size_t>(machine.joint_index("j2"))];
  EXPECT_NEAR(stick.initial, -0.6, 1e-9);
  EXPECT_TRUE(says("the axis of joint 'j1' was turned with its limits")) << report_;
  EXPECT_TRUE(says("joint 'j2' would start beyond its limits")) << report_;
  EXPECT_FALSE(says("to correct")) << report_;
}

TEST_F(CrawlerImport, FindsShellAndEdgeInTheMeshOfTheBucket) {
  const scene::Machine machine = import(scene_io::testing::kCrawlerMasses);
  ASSERT_EQ(machine.buckets.size(), 1u) << report_;
  const scene::Bucket& bucket = machine.buckets[0];
  const scene::Link& link =
      machine.links[static_cast<std::size_t>(machine.link_index(bucket.link))];
  EXPECT_EQ(bucket.link, "scoop");
  // In the axes of the machine the edge is 1.4 m ahead of the pin; the bar on it is 3 cm thick.
  const Vec3 tip = link.X_ML.linear() * bucket.p_tip;
  EXPECT_NEAR(tip.x(), 1.4, 0.03);
  EXPECT_NEAR(tip.y(), 0, 1e-6);
  EXPECT_NEAR(tip.z(), 0, 0.03);
  EXPECT_NEAR(bucket.width, 1.05, 0.01);
  const double made = geometry::heaped_capacity({1.05, 1.4, 0.03, 0.035}, 1);
  // The section is that of the outer faces, so it holds more than the space between the plates.
  EXPECT_GT(bucket.capacity, made);
  EXPECT_LT(bucket.capacity, 1.25 * made);
  // The mouth opens downwards, and the floor falls away from the edge.
  EXPECT_LT((link.X_ML.linear() * bucket.opening).z(), -0.9);
  const Vec3 cut = link.X_ML.linear() * bucket.cut_direction;
  EXPECT_GT(cut.x(), 0.5);
  EXPECT_LT(cut.z(), -0.5);
  ASSERT_EQ(machine.shells.size(), 1u);
  EXPECT_TRUE(link.collisions.empty());
  EXPECT_TRUE(says("made: bucket 'scoop'")) << report_;
}

TEST_F(CrawlerImport, FillsInMassesWithCentreAndInertia) {
  const scene::Machine machine = import(scene_io::testing::kCrawlerMasses);
  EXPECT_NEAR(machine.total_mass(), 18000, 1e-6);
  const scene::Link& house = machine.links[static_cast<std::size_t>(machine.link_index("house"))];
  EXPECT_NEAR((house.p_LCom - Vec3(-0.6, 0, 0.8)).norm(), 0, 1e-9);
  EXPECT_NEAR(house.inertia(2, 2), 7000 * (2.9 * 2.9 + 2.4 * 2.4) / 12, 1e-6);
  EXPECT_TRUE(says("filled in: link 'house' weighs 7000 kg, not 0.03")) << report_;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/masses.csv"));
}

TEST_F(CrawlerImport, TorquesAndCylindersFitTheMasses) {
  const scene::Machine machine = import(scene_io::testing::kCrawlerMasses);
  // 1000 N m cannot hold a boom of a tonne.
  EXPECT_TRUE(says("1000 N m of the file cannot hold the arm")) << report_;
  const auto joint = [&](const char* name) {
    return machine.joints[static_cast<std::size_t>(machine.joint_index(name))];
  };
  EXPECT_GT(joint("j1").effort, 2e5);
  EXPECT_GT(joint("j3").effort, 5e4);
  // The bucket turns by 172 deg, for which a cylinder needs a linkage.
  ASSERT_EQ(machine.cylinders.size(), 2u) << report_;
  EXPECT_EQ(machine.cylinders[0].joint, "j1");
  EXPECT_EQ(machine.cylinders[1].joint, "j2");
  EXPECT_TRUE(says("joint 'j3' keeps a motor")) << report_;
}

TEST_F(CrawlerImport, WithoutMassesListsWhatToFillIn) {
  const scene::Machine machine = import("");
  EXPECT_EQ(machine.buckets.size(), 1u) << report_;
  EXPECT_TRUE(machine.cylinders.empty());
  EXPECT_TRUE(says("left out: torques, speeds and cylinders")) << report_;
  std::ifstream list(folder_ / "out/masses.csv");
  const std::string text(std::istreambuf_iterator<char>(list), {});
  EXPECT_NE(text.find("link,mass_kg\nbase_link,0.03\n"), std::string::npos) << text;
  // The list is a file of masses itself.
  EXPECT_EQ(refused(text), "");
}

TEST_F(CrawlerImport, NamesLinksThatOverlap) {
  import(scene_io::testing::kCrawlerMasses);
  // The boom starts in the house, but a joint connects them.
  EXPECT_FALSE(says("overlapping: the hulls of links 'house' and 'arm_1'")) << report_;
  std::ifstream urdf(folder_ / "crawler.urdf");
  std::string text(std::istreambuf_iterator<char>(urdf), {});
  // The house then reaches over the boom to the stick.
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"2.9 2.4 1.3", "8.9 2.4 1.3"},
                                 std::pair<std::string, std::string>{"-0.6 0 0.8", "3.0 0 0.8"}})
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from))
      text.replace(at, from.size(), to);
  std::ofstream(folder_ / "crawler.urdf") << text;
  import(scene_io::testing::kCrawlerMasses);
  EXPECT_TRUE(says("overlapping: the hulls of links 'house' and 'arm_2'")) << report_;
}

TEST_F(CrawlerImport, RefusesFaultyFilesOfMasses) {
  EXPECT_NE(refused("boom 3\n").find("masses.csv:1"), std::string::npos);
  EXPECT_NE(refused("# x\nhous,3\n").find("did you mean 'house'"), std::string::npos);
  EXPECT_NE(refused("house,nan\n").find("'nan'"), std::string::npos);
  EXPECT_NE(refused("house,0\n").find("1e-06 to 100000000"), std::string::npos);
  EXPECT_NE(refused("house,7\nhouse,8\n").find("masses.csv:2"), std::string::npos);
}

}  // namespace
}  // namespace navvy::scene_io
