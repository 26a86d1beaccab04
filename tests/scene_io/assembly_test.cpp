// SPDX-License-Identifier: Apache-2.0
// Models inside models: one machine, names with ::, poses through frames, faults with the line of
// the part.
#include "scene_io/assembly.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "core/error.h"
#include "folder.h"
#include "scene_io/loader.h"
#include "scene_io/world_reader.h"

namespace navvy::scene_io {
namespace {

std::string sdf(const std::string& inner) {
  return "<sdf version=\"1.9\" xmlns:navvy=\"navvy\">\n" + inner + "\n</sdf>\n";
}

std::string link(const std::string& name, const std::string& more = "") {
  return "<link name=\"" + name + "\">" + more +
         "<inertial><mass>100</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></"
         "inertial></link>\n";
}

std::string hinge(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"revolute\">" + more + "<parent>" + parent +
         "</parent><child>" + child + "</child><axis><xyz>0 1 0</xyz></axis></joint>\n";
}

/// A cart: bed, axle 1 m behind it, a wheel on it, and one mesh in its folder.
const std::string kCart =
    "<model name=\"cart\"><pose>9 9 9 0 0 0</pose>\n" + link("bed") +
    link("axle",
         "<pose>-1 0 0.3 0 0 0</pose><visual "
         "name=\"v\"><geometry><mesh><uri>axle.obj</uri></mesh></geometry>"
         "</visual>") +
    hinge("spin", "bed", "axle", "<pose relative_to=\"hub\"/>") +
    "<frame name=\"hub\"><pose relative_to=\"axle\">0 0.5 0 0 0 0</pose></frame>\n"
    "<frame name=\"nose\" attached_to=\"bed\"><pose>2 0 0 0 0 0</pose></frame>\n"
    "<navvy:wheel><joint>spin</joint><radius_m>0.3</radius_m><width_m>0.2</width_m></navvy:wheel>\n"
    "</model>";

/// A trailer hitched as in the guide: two parts and a joint.
const std::string kTrain =
    "<model name=\"train\">\n<include><uri>cart</uri><name>first</name></include>\n"
    "<include><uri>cart/model.sdf</uri><name>second</name><pose>-4 0 0 0 0 "
    "3.141592653589793</pose></include>\n"
    "<joint name=\"hitch\" "
    "type=\"ball\"><parent>first::axle</parent><child>second::nose</child></joint>\n</model>";

class Assembly : public testing::Test {
 protected:
  Assembly() {
    write("cart/model.sdf", sdf(kCart));
    write("cart/axle.obj",
          "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
  }
  std::string write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }
  /// Returns the fault of reading the file, or "".
  std::string fault_of(const std::string& file) const {
    try {
      load_machine(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  test::Folder folder_;
};

TEST_F(Assembly, IsOneMachineWithNamesOfItsParts) {
  const scene::Machine train = load_machine(write("train.sdf", sdf(kTrain)));
  std::vector<std::string> links, joints;
  for (const scene::Link& each : train.links) links.push_back(each.name);
  for (const scene::Joint& each : train.joints) joints.push_back(each.name);
  EXPECT_EQ(links,
            (std::vector<std::string>{"first::bed", "first::axle", "second::bed", "second::axle"}));
  EXPECT_EQ(joints, (std::vector<std::string>{"first::spin", "hitch", "second::spin"}));
  ASSERT_EQ(train.wheels.size(), 2u);
  EXPECT_EQ(train.wheels[1].joint, "second::spin");
  // Rotated by half a turn 4 m behind: its axle is 1 m ahead of its bed. The part's own pose in a
  // world does not count.
  EXPECT_LT((train.links[1].X_ML.translation() - Vec3(-1, 0, 0.3)).norm(), 1e-12);
  EXPECT_LT((train.links[3].X_ML.translation() - Vec3(-3, 0, 0.3)).norm(), 1e-12);
  // The joint's pose goes through a frame of the part; the hitch's child is the link that carries
  // the part's frame.
  EXPECT_LT((train.joints[2].X_LcJ.translation() - Vec3(0, 0.5, 0)).norm(), 1e-12);
  EXPECT_EQ(train.links[static_cast<std::size_t>(train.joints[1].child)].name, "second::bed");
  // Mesh paths are relative to the part's own file.
  EXPECT_EQ(train.links[3].visuals.at(0).geometry.mesh_file,
            std::filesystem::weakly_canonical(folder_ / "cart/axle.obj").string());
}

TEST_F(Assembly, NamesNestedPartsThroughAllLevels) {
  write("train.sdf", sdf(kTrain));
  const scene::Machine pair = load_machine(write(
      "pair.sdf",
      sdf("<model name=\"pair\">" + link("rope") +
          "<include><uri>train.sdf</uri><pose>0 5 0 0 0 0</pose></include>"
          "<model name=\"weight\"><pose relative_to=\"train::second::hub\">1 0 0 0 0 0</pose>" +
          link("block") + "</model>" + hinge("a", "rope", "train::first::bed") +
          hinge("b", "rope", "weight::block") +
          "<navvy:joint name=\"train::second::spin\"><initial_deg>30</initial_deg></navvy:joint>"
          "</model>")));
  const int block = pair.link_index("weight::block");
  ASSERT_GE(block, 0);
  // Hub of the second cart: 3 m behind, 5 m to the side, half a metre to its left, which is turned
  // round; the block is 1 m ahead in its rotated frame.
  EXPECT_LT(
      (pair.links[static_cast<std::size_t>(block)].X_ML.translation() - Vec3(-4, 4.5, 0.3)).norm(),
      1e-9);
  EXPECT_NEAR(
      pair.joints[static_cast<std::size_t>(pair.joint_index("train::second::spin"))].initial,
      kPi / 6, 1e-12);
}

TEST_F(Assembly, ReadsTheSameFromAResolvedScene) {
  write("train.sdf", sdf(kTrain));
  const std::string world =
      "<world name=\"w\"><navvy:soil ref=\"loam\"/><navvy:ground><size_m>20 20</size_m>"
      "</navvy:ground><include><uri>train.sdf</uri></include><model name=\"here\">" +
      link("rope") + "<include><uri>cart</uri></include>" + hinge("a", "rope", "cart::bed") +
      "</model></world>";
  std::string resolved;
  const scene::Scene read =
      load_scene(write("scene.sdf", sdf(world)), control::step_kinds(), {}, &resolved);
  const scene::Scene again =
      load_scene_from_string(resolved, "/no_such_folder/scene.sdf", control::step_kinds());
  EXPECT_EQ(resolved.find("<include>"), std::string::npos);
  ASSERT_EQ(read.machines.size(), 2u);
  ASSERT_EQ(again.machines.size(), 2u);
  for (std::size_t m = 0; m < 2; ++m) {
    const scene::Machine &a = read.machines[m].machine, &b = again.machines[m].machine;
    ASSERT_EQ(a.links.size(), b.links.size());
    for (std::size_t l = 0; l < a.links.size(); ++l) {
      EXPECT_EQ(a.links[l].name, b.links[l].name);
      EXPECT_EQ(a.links[l].X_ML.matrix(), b.links[l].X_ML.matrix());
    }
    EXPECT_EQ(a.wheels.size(), b.wheels.size());
  }
}

TEST_F(Assembly, ReportsFileAndLineOfThePart) {
  // A fault that only the assembled machine shows: a wheel on a missing joint, in the part's
  // seventh line.
  std::string cart = kCart;
  cart.replace(cart.find("<joint>spin"), 11, "<joint>spun");
  write("bad/model.sdf", sdf(cart));
  write("bad/axle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string words = fault_of(
      write("whole.sdf", sdf("<model name=\"m\">\n<include><uri>bad</uri></include></model>")));
  EXPECT_NE(words.find("bad/model.sdf:8"), std::string::npos) << words;
  EXPECT_NE(words.find("spun"), std::string::npos) << words;
}

TEST_F(Assembly, RefusesRecursionAndNameClashes) {
  const auto including = [&](const std::string& what) {
    return sdf("<model name=\"m\">" + link("l") + "\n<include>" + what + "</include></model>");
  };
  write("self.sdf", including("<uri>self.sdf</uri>"));
  EXPECT_NE(fault_of(folder_ / "self.sdf").find("cannot be a part of itself"), std::string::npos);
  write("a.sdf", including("<uri>b.sdf</uri>"));
  write("b.sdf", including("<uri>a.sdf</uri>"));
  EXPECT_NE(fault_of(folder_ / "a.sdf").find("b.sdf:4"), std::string::npos)
      << fault_of(folder_ / "a.sdf");
  EXPECT_NE(fault_of(write("none.sdf", including(""))).find("needs <uri>"), std::string::npos);
  EXPECT_NE(fault_of(write("gone.sdf", including("<uri>gone</uri>"))).find("no such model"),
            std::string::npos);
  EXPECT_NE(fault_of(write("more.sdf", including("<uri>cart</uri><static>1</static>")))
                .find("has no place"),
            std::string::npos);
  // Two parts with one name, and a link with the name of a part's frame.
  const std::string twice =
      fault_of(write("twice.sdf", sdf("<model name=\"m\"><include><uri>cart</uri></include>\n"
                                      "<include><uri>cart</uri></include></model>")));
  EXPECT_NE(twice.find("cart"), std::string::npos) << twice;
  // Ten parts nested in each other.
  for (int i = 0; i < 10; ++i)
    write("deep" + std::to_string(i) + ".sdf",
          including("<uri>deep" + std::to_string(i + 1) + ".sdf</uri>"));
  write("deep10.sdf", sdf("<model name=\"m\">" + link("l") + "</model>"));
  EXPECT_NE(fault_of(folder_ / "deep0.sdf").find("at most 8 deep"), std::string::npos)
      << fault_of(folder_ / "deep0.sdf");
}

TEST_F(Assembly, IsLimitedInLinksLikeAMachine) {
  std::string many;
  for (int i = 0; i < 200; ++i) many += link("l" + std::to_string(i));
  write("many.sdf", sdf("<model name=\"many\">" + many + "</model>"));
  const std::string words = fault_of(write(
      "twice.sdf", sdf("<model name=\"m\"><include><uri>many.sdf</uri><name>a</name></include>"
                       "<include><uri>many.sdf</uri><name>b</name></include></model>")));
  EXPECT_NE(words.find("at most 300"), std::string::npos) << words.substr(0, 400);
}

}  // namespace
}  // namespace navvy::scene_io
