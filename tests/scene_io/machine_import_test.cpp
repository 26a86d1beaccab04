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

class MachineImport : public testing::Test {
 protected:
  scene::Machine import(const std::string& robot, double density = 0) {
    std::ofstream(folder_ / "r.urdf") << "<robot name='r'>\n" << robot << "</robot>";
    report_.clear();
    std::filesystem::remove_all(folder_ / "out");
    for (const std::string& sentence :
         import_machine(folder_ / "r.urdf", {folder_ / "out", density}))
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
  EXPECT_TRUE(says("not recognised: arms, buckets")) << report_;
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
  EXPECT_THROW(import_machine(folder_ / "w.sdf", {folder_ / "o", 0}), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "o"));
  import(cart());
  EXPECT_THROW(import_machine(folder_ / "r.urdf", {folder_ / "out", 0}), InputError);
}

}  // namespace
}  // namespace navvy::scene_io
