// SPDX-License-Identifier: Apache-2.0
// Files of other simulators: one small file for each trap that public worlds and robots hold.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "core/error.h"
#include "folder.h"
#include "scene_io/loader.h"

namespace navvy::scene_io {
namespace {

constexpr const char* kBall =
    "<link name='b'><inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz>"
    "</inertia></inertial><collision name='c'><geometry><sphere><radius>0.1</radius></sphere>"
    "</geometry>@</collision></link>";

/// Returns a link of 2 kg with `more` inside its collision.
std::string ball(const std::string& more = "", const std::string& name = "b") {
  std::string text = kBall;
  text.replace(text.find("name='b'"), 8, "name='" + name + "'");
  return text.replace(text.find('@'), 1, more);
}

std::string model(const std::string& inner, const std::string& name = "m") {
  return "<model name='" + name + "'>\n" + inner + "\n</model>\n";
}

/// What a file gives: its content and all messages.
struct Read {
  std::optional<scene::Scene> world;
  std::optional<scene::Machine> machine;
  std::string messages;
  std::size_t errors = 0, warnings = 0;
};

class Import : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  Read read(const std::string& name, const std::string& text, const Overrides& overrides = {}) {
    Read out;
    FaultCount count;
    for (const Fault& fault : check(write(name, text), control::step_kinds(), &out.world, overrides,
                                    &out.machine, &count))
      out.messages += fault.text() + "\n";
    out.errors = count.errors;
    out.warnings = count.warnings;
    return out;
  }
  Read read_world(const std::string& inner, const std::string& version = "1.6",
                  const Overrides& overrides = {}) {
    return read("world.sdf",
                "<sdf version='" + version + "'>\n<world name='w'>\n" + inner + "</world></sdf>",
                overrides);
  }
  Read read_robot(const std::string& inner) {
    return read("robot.urdf", "<robot name='r'>\n" + inner + "</robot>");
  }

  test::Folder folder_;
};

void expect_in(const std::string& messages, const std::vector<std::string>& fragments) {
  for (const std::string& fragment : fragments)
    EXPECT_NE(messages.find(fragment), std::string::npos) << fragment << "\nnot in\n" << messages;
}

std::string urdf_link(const std::string& name, const std::string& more = "") {
  return "<link name='" + name +
         "'><inertial><mass value='3'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
         "</inertial>" +
         more + "</link>\n";
}

std::string urdf_joint(const std::string& name, const std::string& type, const std::string& parent,
                       const std::string& child, const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + more + "</joint>\n";
}

TEST_F(Import, WorldOfAnyVersionWithoutSoilStandsOnFirmGround) {
  for (const char* version : {"1.4", "1.5", "1.6", "1.7", "1.8", "1.9", "1.10", "1.11", "1.12"}) {
    const Read got = read_world(model(ball()), version);
    ASSERT_EQ(got.errors, 0u) << version << "\n" << got.messages;
    EXPECT_EQ(got.warnings, 1u) << got.messages;
    EXPECT_NE(got.messages.find("firm gravel (--soil NAME gives it another"), std::string::npos)
        << got.messages;
    EXPECT_EQ(got.world->soils.at(0).name, "gravel");
    EXPECT_EQ(got.world->machines.at(0).machine.links.at(0).mass, 2);
    EXPECT_FALSE(got.world->machines.at(0).on_ground);
  }
  EXPECT_NE(read_world(model(ball()), "2.0").messages.find("1.3 to 1.12"), std::string::npos);
}

TEST_F(Import, SoilAndSizeComeFromTheCommandLine) {
  Overrides overrides;
  overrides.soil = "loam";
  overrides.size = Vec2(40, 30);
  const Read got = read_world(model(ball()), "1.6", overrides);
  ASSERT_EQ(got.errors, 0u) << got.messages;
  EXPECT_EQ(got.warnings, 0u) << got.messages;
  EXPECT_EQ(got.world->soils.at(0).name, "loam");
  EXPECT_EQ(got.world->ground.size, Vec2(40, 30));
}

TEST_F(Import, WhatHasNoEffectIsSilent) {
  const Read got = read_world(
      "<gui/><scene/><wind/>" +
          model(
              "<self_collide>0</self_collide><enable_wind>false</enable_wind>"
              "<link name='a'><gravity>true</gravity><kinematic>0</kinematic>"
              "<velocity_decay><linear>0</linear></velocity_decay></link>" +
              ball("<laser_retro>0</laser_retro><max_contacts>0</max_contacts><surface><bounce>"
                   "<restitution_coefficient>0</restitution_coefficient></bounce><friction><ode>"
                   "<mu>1</mu><mu2>1</mu2><fdir1>0 0 0</fdir1><slip1>0</slip1><slip2>0</slip2>"
                   "</ode></friction></surface>") +
              "<joint name='j' type='revolute'><parent>a</parent><child>b</child><axis>"
              "<xyz>0 0 1</xyz><limit><lower>-1.79769e+308</lower><upper>1.8e308</upper><effort>-1"
              "</effort><stiffness>1e8</stiffness><dissipation>1</dissipation></limit><dynamics>"
              "<spring_reference>0</spring_reference><spring_stiffness>0</spring_stiffness>"
              "</dynamics></axis></joint>"),
      "1.6", [] {
        Overrides soil;
        soil.soil = "loam";
        return soil;
      }());
  ASSERT_EQ(got.errors, 0u) << got.messages;
  // The link `a` has no mass, and <gui> is no look; nothing else is worth a word.
  EXPECT_EQ(got.warnings, 2u) << got.messages;
  const scene::Machine& machine = got.world->machines.at(0).machine;
  EXPECT_FALSE(machine.joints.at(0).has_limits);
  EXPECT_EQ(machine.joints.at(0).effort, 1e9);
}

TEST_F(Import, MissingMassIsTheDefaultOfSdf) {
  const Read got = read_world(model("<link name='a'/>"), "1.7");
  ASSERT_EQ(got.errors, 0u) << got.messages;
  const scene::Link& link = got.world->machines.at(0).machine.links.at(0);
  EXPECT_EQ(link.mass, 1);
  EXPECT_EQ(link.inertia, Mat3::Identity());
  EXPECT_NE(got.messages.find("SDF's default of 1 kg"), std::string::npos) << got.messages;
}

TEST_F(Import, EachIgnoredKindIsReportedOnceWithItsNumber) {
  std::string models;
  for (const char* name : {"m1", "m2", "m3"})
    models += model(ball() + "<plugin name='p' filename='f'/>", name);
  const Read got = read_world(models);
  ASSERT_EQ(got.errors, 0u) << got.messages;
  EXPECT_EQ(got.warnings, 2u) << got.messages;
  EXPECT_NE(got.messages.find("world.sdf:4: warning: world/model[m1]/plugin[p]"), std::string::npos)
      << got.messages;
  EXPECT_NE(got.messages.find("here and in 2 more places"), std::string::npos) << got.messages;
}

TEST_F(Import, WhatChangesTheMotionIsStillRefused) {
  const Read got = read_world(model("<link name='a'><gravity>false</gravity></link>"), "1.6");
  EXPECT_NE(got.messages.find("world.sdf:4: error: world/model[m]/link[a]/gravity: 'false'"),
            std::string::npos)
      << got.messages;
}

TEST_F(Import, ShapeThatNavvyLacksIsRefusedAsCollisionOnly) {
  const std::string shape = "<geometry><ellipsoid><radii>1 1 2</radii></ellipsoid></geometry>";
  const Read drawn = read_world(
      model("<static>1</static><link name='a'><visual name='v'>" + shape + "</visual></link>"));
  EXPECT_EQ(drawn.errors, 0u) << drawn.messages;
  EXPECT_NE(drawn.messages.find("it is not drawn"), std::string::npos) << drawn.messages;
  const Read solid = read_world(model("<static>1</static><link name='a'>\n<collision name='c'>" +
                                      shape + "</collision></link>"));
  EXPECT_NE(solid.messages.find("world.sdf:5: error"), std::string::npos) << solid.messages;
  EXPECT_NE(solid.messages.find("ellipsoid: is not supported"), std::string::npos);
}

TEST_F(Import, StaticPlaneIsTheGround) {
  const std::string plane =
      "<static>1</static><pose>0 0 0.5 0 @ 0</pose><link name='l'><collision name='c'><geometry>"
      "<plane><normal>0 0 1</normal><size>100 100</size></plane></geometry></collision></link>";
  std::string level = plane, tilted = plane;
  level.replace(level.find('@'), 1, "0");
  tilted.replace(tilted.find('@'), 1, "0.1");
  const Read flat = read_world(model(level, "plane") + model("<pose>0 0 2 0 0 0</pose>" + ball()));
  ASSERT_EQ(flat.errors, 0u) << flat.messages;
  EXPECT_EQ(flat.world->machines.size(), 1u);
  EXPECT_EQ(flat.world->ground.surface, 0.5);
  EXPECT_TRUE(flat.world->ground.features.empty());
  const Read slope =
      read_world(model(tilted, "plane") + model("<pose>0 0 2 0 0 0</pose>" + ball()));
  ASSERT_EQ(slope.errors, 0u) << slope.messages;
  // Turned about y by 0.1, the plane falls towards +x: its way up is -x.
  EXPECT_NEAR(slope.world->ground.features.at(0).angle, 0.1, 1e-9);
  EXPECT_NEAR(std::abs(slope.world->ground.features.at(0).yaw), kPi, 1e-9);
}

TEST_F(Import, AxesOfOldVersionsAreInTheFrameTheyMean) {
  const std::string arm = model(
      "<link name='a'/><link name='b'><pose>0 0 0 0 0 1.5707963267948966</pose></link>"
      "<joint name='j' type='revolute'><parent>a</parent><child>b</child><axis>@"
      "<xyz>1 0 0</xyz></axis></joint>");
  const auto axis = [&](const std::string& version, const std::string& more) {
    std::string text = arm;
    const Read got = read_world(text.replace(text.find('@'), 1, more), version);
    EXPECT_EQ(got.errors, 0u) << got.messages;
    return got.world->machines.at(0).machine.joints.at(0).axis;
  };
  // The child is turned by 90 degrees: the model's x is minus its y.
  EXPECT_LT((axis("1.4", "") - Vec3(0, -1, 0)).norm(), 1e-9);
  EXPECT_LT((axis("1.6", "") - Vec3(1, 0, 0)).norm(), 1e-9);
  EXPECT_LT(
      (axis("1.6", "<use_parent_model_frame>1</use_parent_model_frame>") - Vec3(0, -1, 0)).norm(),
      1e-9);
  EXPECT_LT((axis("1.9", "") - Vec3(1, 0, 0)).norm(), 1e-9);
}

TEST_F(Import, LinksWithoutJointsAreBodiesOfTheirOwn) {
  const Read got = read_world(model(ball("", "one") + ball("", "two")));
  ASSERT_EQ(got.errors, 0u) << got.messages;
  ASSERT_EQ(got.world->machines.size(), 2u);
  EXPECT_EQ(got.world->machines[1].name, "m::two");
  const Read fixed = read_world(model("<static>1</static>" + ball("", "one") + ball("", "two")));
  ASSERT_EQ(fixed.errors, 0u) << fixed.messages;
  EXPECT_EQ(fixed.world->machines.at(0).machine.links.size(), 2u);
}

TEST_F(Import, JointToTheWorldGetsAnAnchor) {
  const Read got = read_world(
      model(ball() + "<joint name='j' type='revolute'><parent>world</parent><child>b</child>"
                     "<axis><xyz>0 0 1</xyz></axis></joint>"));
  ASSERT_EQ(got.errors, 0u) << got.messages;
  const scene::Machine& machine = got.world->machines.at(0).machine;
  EXPECT_TRUE(machine.fixed_base);
  EXPECT_EQ(machine.joints.at(0).type, scene::Joint::Type::kRevolute);
}

TEST_F(Import, PosesCountFromFramesOfTheWorld) {
  const Read got = read_world("<frame name='f'><pose>1 2 0 0 0 1.5707963267948966</pose></frame>" +
                                  model("<pose relative_to='f'>1 0 3 0 0 0</pose>" + ball()),
                              "1.9");
  ASSERT_EQ(got.errors, 0u) << got.messages;
  EXPECT_LT((got.world->machines.at(0).X_WM.translation() - Vec3(1, 3, 3)).norm(), 1e-9);
}

TEST_F(Import, ModelOnAServerIsNamedAsSuch) {
  const Read got = read_world("<include><uri>https://server/model</uri></include>");
  EXPECT_NE(got.messages.find("world.sdf:3: error"), std::string::npos) << got.messages;
  EXPECT_NE(got.messages.find("Navvy downloads nothing"), std::string::npos) << got.messages;
}

TEST_F(Import, ModelThatIncludesItselfIsRefused) {
  const std::string file = folder_ / "loop.sdf";
  const Read got = read("loop.sdf", "<sdf version='1.7'>\n<model name='m'>\n<include><uri>" + file +
                                        "</uri></include></model></sdf>");
  expect_in(got.messages, {"loop.sdf:3: error", "'" + file + "'",
                           "a model cannot be a part of itself", "(name another file)"});
}

TEST_F(Import, WorldThatIncludesItselfIsRefused) {
  const std::string file = folder_ / "loop.sdf";
  const Read got = read("loop.sdf", "<sdf version='1.7'>\n<world name='w'>\n<include><uri>" + file +
                                        "</uri></include></world></sdf>");
  expect_in(got.messages, {"loop.sdf:3: error", "'" + file + "'",
                           "a world cannot be a part of itself", "remove the <include>"});
  write("other.sdf", "<sdf version='1.7'><world name='v'/></sdf>");
  const Read other = read_world("<include><uri>other.sdf</uri></include>");
  expect_in(other.messages, {"'v'", "name the file of a machine"});
}

TEST_F(Import, TextThatAToolOfRosShouldReplaceIsNamedInSdf) {
  const auto expect = [&](const std::string& inner, const std::vector<std::string>& fragments) {
    const Read got = read_world(inner);
    EXPECT_GT(got.errors, 0u);
    expect_in(got.messages, fragments);
  };
  const std::string remedy = "run `xacro FILE > robot.sdf` and load its result";
  expect("<include><uri>$(optenv HOME)/a</uri></include>",
         {"world.sdf:3: error", "'$(optenv HOME)/a'", "$(optenv ...)", remedy});
  expect(model(ball("", "${x}")), {"world.sdf:4: error", "'${x}'", "${...}", remedy});
  expect("<xacro:macro name='x'/>",
         {"world.sdf:3: error", "'xacro:macro'", "xacro that was not expanded", remedy});
  // A plugin is not run, whatever its settings mean.
  const Read plugin =
      read_world(model(ball() + "<plugin name='p' filename='f'><path>$(find a)/b</path></plugin>"));
  EXPECT_EQ(plugin.errors, 0u) << plugin.messages;
}

TEST_F(Import, RobotOfUrdfIsAMachine) {
  const Read got = read_robot(
      "<material name='red'><color rgba='1 0 0 1'/></material>" +
      urdf_link("base",
                "<visual><geometry><box size='1 2 3'/></geometry><material name='red'/>"
                "</visual>") +
      urdf_link("arm") + "<link name='tip'/><link name='root'/>" +
      urdf_joint("on", "fixed", "root", "base", "<origin xyz='0 0 0.5'/>") +
      urdf_joint("j", "revolute", "base", "arm",
                 "<origin xyz='1 0 0' rpy='0 0 1.5707963267948966'/><axis xyz='0 1 0'/>"
                 "<limit lower='-1' upper='2' effort='30' velocity='4'/><dynamics damping='5'/>") +
      urdf_joint("end", "fixed", "arm", "tip", "<origin xyz='0 0 1'/>"));
  ASSERT_EQ(got.errors, 0u) << got.messages;
  const scene::Machine& machine = *got.machine;
  ASSERT_EQ(machine.links.size(), 2u);
  EXPECT_EQ(machine.links[0].name, "base");
  EXPECT_EQ(machine.links[0].visuals.at(0).color.r, 1);
  EXPECT_EQ(machine.links[0].visuals.at(0).color.g, 0);
  // The frame of the massless root is that of the machine.
  EXPECT_LT((machine.links[0].X_ML.translation() - Vec3(0, 0, 0.5)).norm(), 1e-12);
  EXPECT_LT((machine.links[1].X_ML.translation() - Vec3(1, 0, 0.5)).norm(), 1e-12);
  EXPECT_LT((machine.links[1].X_ML.linear() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
  const scene::Joint& joint = machine.joints.at(0);
  EXPECT_EQ(joint.axis, Vec3::UnitY());
  EXPECT_EQ(joint.lower, -1);
  EXPECT_EQ(joint.upper, 2);
  EXPECT_EQ(joint.effort, 30);
  EXPECT_EQ(joint.damping, 5);
}

TEST_F(Import, RobotAloneRunsAsASceneThatItStandsIn) {
  const std::string file = write(
      "stand.urdf",
      "<robot name='r'>" +
          urdf_link("base", "<collision><geometry><sphere radius='0.3'/></geometry></collision>") +
          "</robot>");
  std::string resolved;
  const scene::Scene world = load_scene(file, control::step_kinds(), {}, &resolved);
  ASSERT_EQ(world.machines.size(), 1u);
  EXPECT_EQ(world.name, "stand");
  EXPECT_NEAR(world.machines[0].X_WM.translation().z(), 0.3, 1e-12);
  EXPECT_EQ(world.cameras.size(), 1u);
  // The run's folder holds the scene as our own, which gives the same machine.
  const scene::Scene again =
      load_scene_from_string(resolved, folder_ / "again.sdf", control::step_kinds());
  EXPECT_EQ(again.machines.at(0).machine.links.at(0).mass, 3);
  EXPECT_EQ(again.soils.at(0).name, "gravel");
}

TEST_F(Import, WheelsWithoutTyresAreNamed) {
  const std::string tyre =
      "<collision><geometry><cylinder radius='0.2' length='0.1'/></geometry></collision>";
  const Read got =
      read_robot(urdf_link("body") + urdf_link("wheel", tyre) +
                 urdf_joint("spin", "continuous", "body", "wheel",
                            "<origin rpy='-1.5707963267948966 0 0'/><axis xyz='0 0 1'/>"));
  ASSERT_EQ(got.errors, 0u) << got.messages;
  EXPECT_EQ(got.warnings, 1u) << got.messages;
  EXPECT_NE(got.messages.find("robot.urdf:1: warning: model[r]: '1 wheels': roll as rigid bodies"),
            std::string::npos)
      << got.messages;
}

TEST_F(Import, RootNamedWorldHoldsTheRobot) {
  const Read got = read_robot("<link name='world'/>" + urdf_link("base") +
                              urdf_joint("on", "fixed", "world", "base"));
  ASSERT_EQ(got.errors, 0u) << got.messages;
  EXPECT_TRUE(got.machine->fixed_base);
}

TEST_F(Import, MimicAndSpringsOfARobotAreSimulated) {
  const Read got = read_robot(
      urdf_link("a") + urdf_link("b") + urdf_link("c") + urdf_link("d") +
      urdf_joint("j", "continuous", "a", "b") +
      urdf_joint("k", "continuous", "a", "c", "<mimic joint='j' multiplier='-2' offset='0.5'/>") +
      urdf_joint("l", "continuous", "a", "d", "<dynamics damping='3'/>") +
      "<gazebo reference='l'><springStiffness>70</springStiffness>"
      "<springReference value='0.2'/></gazebo>");
  ASSERT_EQ(got.errors, 0u) << got.messages;
  EXPECT_EQ(got.messages.find("mimic"), std::string::npos) << got.messages;
  const scene::Machine& m = *got.machine;
  ASSERT_EQ(m.gears.size(), 1u);
  EXPECT_EQ(m.joints.at(static_cast<std::size_t>(m.gears[0].follower)).name, "k");
  EXPECT_EQ(m.joints.at(static_cast<std::size_t>(m.gears[0].leader)).name, "j");
  EXPECT_EQ(m.gears[0].ratio, -2);
  EXPECT_EQ(m.gears[0].offset, 0.5);
  const auto joint = [&](const std::string& name) {
    return m.joints.at(static_cast<std::size_t>(m.joint_index(name)));
  };
  // The follower starts where its leader puts it.
  EXPECT_EQ(joint("k").initial, 0.5);
  EXPECT_TRUE(joint("k").passive);
  EXPECT_FALSE(joint("j").passive);
  EXPECT_EQ(joint("l").stiffness, 70);
  EXPECT_EQ(joint("l").rest, 0.2);
  EXPECT_EQ(joint("l").damping, 3);
  EXPECT_TRUE(joint("l").passive);
}

/// A four-bar above the ground in the plane x-z: its two fixed pivots are 1 m apart.
std::string bars() {
  return "<link name='a'><inertial><mass>9</mass></inertial></link>"
         "<link name='b'><inertial><mass>1</mass></inertial></link>"
         "<link name='c'><pose>0 0 0.5 0 0 0</pose><inertial><mass>1</mass></inertial></link>"
         "<link name='d'><pose>1 0 0 0 0 0</pose><inertial><mass>1</mass></inertial></link>";
}
std::string bar_joint(const std::string& name, const std::string& parent, const std::string& child,
                      const std::string& more = "", const std::string& inside = "") {
  return "<joint name='" + name + "' type='revolute'>" + more + "<parent>" + parent +
         "</parent><child>" + child + "</child><axis><xyz>0 -1 0</xyz>" + inside +
         "</axis></joint>\n";
}

TEST_F(Import, JointIntoALinkThatIsMovedAlreadyClosesALoop) {
  const std::string pose = "<pose>1 0 0 0 0 0</pose>";
  const Read got = read_world(
      model(bars() + bar_joint("motor", "a", "b", "", "<limit><effort>50</effort></limit>") +
            bar_joint("pin", "b", "c") + bar_joint("swing", "a", "d") +
            bar_joint("last", "d", "c", pose)));
  ASSERT_EQ(got.errors, 0u) << got.messages;
  const scene::Machine& m = got.world->machines.at(0).machine;
  EXPECT_EQ(m.joints.size(), 3u);
  ASSERT_EQ(m.loops.size(), 1u);
  EXPECT_EQ(m.loops[0].name, "last");
  EXPECT_EQ(m.links.at(static_cast<std::size_t>(m.loops[0].parent)).name, "d");
  EXPECT_EQ(m.links.at(static_cast<std::size_t>(m.loops[0].child)).name, "c");
  EXPECT_LT((m.loops[0].X_LpJ.translation() - Vec3(0, 0, 0.5)).norm(), 1e-12);
  // A joint with a motor holds; the others of the loop are free.
  for (const scene::Joint& joint : m.joints)
    EXPECT_EQ(joint.passive, joint.name != "motor") << joint.name;
}

TEST_F(Import, RingHeldByTheWorldHasItsBaseThere) {
  const Read got = read_world(model(
      bars() + "<joint name='held' type='fixed'><parent>world</parent><child>a</child></joint>" +
      bar_joint("one", "a", "b") + bar_joint("two", "b", "c") +
      bar_joint("three", "c", "d", "<pose>0 0 0.5 0 0 0</pose>") +
      bar_joint("four", "d", "a", "<pose>1 0 0 0 0 0</pose>")));
  ASSERT_EQ(got.errors, 0u) << got.messages;
  const scene::Machine& m = got.world->machines.at(0).machine;
  EXPECT_TRUE(m.fixed_base);
  EXPECT_EQ(m.links.at(0).name, "a");
  ASSERT_EQ(m.loops.size(), 1u);
  EXPECT_EQ(m.loops[0].name, "four");
}

TEST_F(Import, RingWithoutABaseNamesItsJoints) {
  const Read got =
      read_world(model(bars() + bar_joint("one", "a", "b") + bar_joint("two", "b", "c") +
                       bar_joint("three", "c", "d") + bar_joint("four", "d", "a")));
  expect_in(got.messages,
            {"world.sdf:7: error: world/model[m]/joint[four]: 'four'",
             "the joints 'one', 'two', 'three', 'four' form a loop: no link is the base",
             "fix one of its links to the world"});
}

TEST_F(Import, PassiveJointsOfALoopStartWhereItsMotorPutsThem) {
  const std::string text =
      "<sdf version='1.9' xmlns:navvy='navvy'>" +
      model(bars() + bar_joint("motor", "a", "b", "", "<limit><effort>50</effort></limit>") +
            bar_joint("pin", "b", "c") + bar_joint("swing", "a", "d") +
            bar_joint("last", "d", "c", "<pose>1 0 0 0 0 0</pose>") +
            "<navvy:joint name='motor'><initial_deg>@</initial_deg></navvy:joint>") +
      "</sdf>";
  const auto start = [&](const std::string& angle) {
    std::string one = text;
    return read("bars.sdf", one.replace(one.find('@'), 1, angle));
  };
  const Read got = start("20");
  ASSERT_EQ(got.errors, 0u) << got.messages;
  const scene::Machine& m = *got.machine;
  const auto at = [&](const std::string& name) {
    return m.joints.at(static_cast<std::size_t>(m.joint_index(name))).initial;
  };
  // A parallelogram: opposite bars stay parallel.
  EXPECT_NEAR(at("motor"), 20 * kPi / 180, 1e-12);
  EXPECT_NEAR(at("swing"), at("motor"), 1e-6);
  EXPECT_NEAR(at("pin"), -at("motor"), 1e-6);
}

TEST_F(Import, LoopOfARobotIsClosedByAJointOfGazebo) {
  const Read got = read_robot(
      urdf_link("a") + urdf_link("b") + urdf_link("c") + urdf_link("d") +
      urdf_joint("j", "continuous", "a", "b", "<axis xyz='0 1 0'/>") +
      urdf_joint("k", "continuous", "b", "c", "<origin xyz='0 0 1'/><axis xyz='0 1 0'/>") +
      urdf_joint("l", "continuous", "a", "d", "<origin xyz='1 0 0'/><axis xyz='0 1 0'/>") +
      "<gazebo><joint name='m' type='revolute'><parent>d</parent><child>c</child>"
      "<pose>1 0 0 0 0 0</pose><axis><xyz>0 1 0</xyz></axis></joint></gazebo>");
  ASSERT_EQ(got.errors, 0u) << got.messages;
  ASSERT_EQ(got.machine->loops.size(), 1u);
  EXPECT_EQ(got.machine->loops[0].name, "m");
  EXPECT_LT((got.machine->loops[0].X_LpJ.translation() - Vec3(0, 0, 1)).norm(), 1e-12);
}

TEST_F(Import, GearboxTurnsItsChildAgainstItsParent) {
  const auto gearbox = [&](const std::string& axis2) {
    return read_world(model(
        bars() + bar_joint("j", "a", "b") + bar_joint("k", "a", "d") + bar_joint("l", "a", "c") +
        "<joint name='g' type='gearbox'><parent>b</parent><child>d</child>"
        "<gearbox_reference_body>a</gearbox_reference_body><gearbox_ratio>3</gearbox_ratio>"
        "<axis><xyz>0 -1 0</xyz></axis><axis2><xyz>" +
        axis2 + "</xyz></axis2></joint>"));
  };
  for (const double sign : {1.0, -1.0}) {
    const Read got = gearbox(sign > 0 ? "0 -1 0" : "0 1 0");
    ASSERT_EQ(got.errors, 0u) << got.messages;
    const scene::Machine& m = got.world->machines.at(0).machine;
    EXPECT_EQ(m.joints.size(), 3u);
    ASSERT_EQ(m.gears.size(), 1u);
    EXPECT_EQ(m.joints.at(static_cast<std::size_t>(m.gears[0].leader)).name, "j");
    EXPECT_EQ(m.joints.at(static_cast<std::size_t>(m.gears[0].follower)).name, "k");
    EXPECT_EQ(m.gears[0].ratio, -3 * sign);
  }
}

TEST_F(Import, MimicOfSdfCountsFromItsReference) {
  const Read got = read_world(
      model(bars() + bar_joint("j", "a", "b") + bar_joint("l", "a", "c") +
            bar_joint("k", "a", "d", "",
                      "<mimic joint='j' axis='axis'><multiplier>2</multiplier><offset>1</offset>"
                      "<reference>0.25</reference></mimic>")),
      "1.11");
  ASSERT_EQ(got.errors, 0u) << got.messages;
  const scene::Machine& m = got.world->machines.at(0).machine;
  ASSERT_EQ(m.gears.size(), 1u);
  EXPECT_EQ(m.gears[0].ratio, 2);
  EXPECT_EQ(m.gears[0].offset, 0.5);
}

TEST_F(Import, BadRobotsAreRefusedWithLineValueAndRemedy) {
  const auto expect = [&](const std::string& inner, const std::vector<std::string>& fragments) {
    const Read got = read_robot(inner);
    EXPECT_GT(got.errors, 0u);
    expect_in(got.messages, fragments);
  };
  expect(urdf_link("a") + urdf_link("b"),
         {"robot.urdf:3: error", "'b'", "one root link, here 'a'", "type fixed"});
  expect(urdf_link("a") + urdf_link("b") + urdf_joint("j", "fixed", "a", "b") +
             urdf_joint("k", "fixed", "b", "a"),
         {"robot.urdf:1: error", "form a loop", "remove the joint"});
  expect(urdf_link("a") + urdf_link("b") + urdf_link("c") + urdf_joint("j", "fixed", "a", "b") +
             urdf_joint("k", "fixed", "a", "c") + urdf_joint("l", "fixed", "c", "b"),
         {"robot.urdf:7: error", "'b'", "child of one joint only", "as <gazebo><joint name=..."});
  const auto mimic = [](const std::string& attributes) {
    return urdf_link("a") + urdf_link("b") + urdf_link("c") +
           urdf_joint("j", "continuous", "a", "b") +
           urdf_joint("k", "continuous", "a", "c", "<mimic " + attributes + "/>");
  };
  expect(mimic("joint='k'"), {"robot.urdf:6: error", "'k'", "follow itself", "name another"});
  expect(mimic("joint='jj'"), {"robot.urdf:6: error", "'jj'", "did you mean 'j'"});
  expect(mimic("joint='j' multiplier='0'"), {"robot.urdf:6: error", "'0'", "type fixed"});
  expect(mimic("joint='j' multiplier='NaN'"), {"robot.urdf:6: error", "'NaN'", "must be"});
  expect(urdf_link("a") + urdf_link("b") + urdf_joint("j", "continuous", "a", "b") +
             "<gazebo reference='j'><springStiffness>-3</springStiffness></gazebo>",
         {"robot.urdf:5: error", "'-3'", "must not be negative", "give its magnitude"});
  expect(urdf_link("a") + urdf_joint("j", "fixed", "a", "aa"), {"robot.urdf:3: error", "'aa'"});
  expect("<xacro:macro name='x'/>", {"robot.urdf:2: error", "xacro that was not expanded"});
  expect(urdf_link("a",
                   "<visual><geometry><mesh filename='$(optenv HOME)/a.stl'/></geometry>"
                   "</visual>"),
         {"robot.urdf:2: error", "$(optenv ...)", "run `xacro FILE"});
  expect(urdf_link("${name}"), {"robot.urdf:2: error", "${...}"});
  expect("", {"robot.urdf:1: error", "needs at least one <link>"});
}

}  // namespace
}  // namespace navvy::scene_io
