// SPDX-License-Identifier: Apache-2.0
#include "scene_io/loader.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "control/activities/dig/dig.h"
#include "control/activities/trajectory.h"
#include "control/activities/wait.h"
#include "control/step_kinds.h"
#include "core/file.h"
#include "core/log.h"
#include "folder.h"
#include "paths.h"
#include "scene/parameters.h"

namespace navvy::scene_io {
namespace {

// Named only, never written
const std::string kScene = navvy::source_dir() + "/scenarios/mine.sdf";

std::string world_text(const std::string& body) {
  return "<sdf version=\"1.9\" xmlns:navvy=\"navvy\">\n<world name=\"w\">\n" + body +
         "\n</world>\n</sdf>\n";
}

const char* kBody = R"(<navvy:soil ref="loam"><cohesion_pa>7000</cohesion_pa></navvy:soil>
<navvy:soil name="fill"><friction_angle_deg>35</friction_angle_deg><cohesion_pa>0</cohesion_pa></navvy:soil>
<navvy:ground>
  <size_m>24 20</size_m>
  <surface_m>1.5</surface_m>
  <layer><soil>fill</soil><thickness_m>0.5</thickness_m></layer>
  <layer><soil>loam</soil></layer>
  <patch><min_m>1 2</min_m><max_m>3 4</max_m><layer><soil>loam</soil></layer></patch>
  <hills><height_m>0.4</height_m><wavelength_m>9</wavelength_m><seed>5</seed></hills>
  <bank><center_m>0 8</center_m><height_m>2</height_m><angle_deg>60</angle_deg></bank>
  <hills><height_m>0.1</height_m></hills>
</navvy:ground>
<navvy:solver><cell_m>0.2</cell_m></navvy:solver>
<include>
  <uri>model://test_bucket</uri><name>first</name><pose degrees="true">1 2 0.5 0 0 90</pose>
  <navvy:joint name="curl"><initial_deg>-30</initial_deg></navvy:joint>
  <navvy:program>
    <wait><duration_s>2</duration_s></wait>
    <trajectory>
      <times_s>0 1</times_s>
      <joint name="curl"><positions_deg>0 90</positions_deg></joint>
      <joint name="slide_x"><positions_m>1 2</positions_m></joint>
    </trajectory>
  </navvy:program>
</include>
<include><uri>model://test_bucket</uri><name>second</name><navvy:on_ground>false</navvy:on_ground></include>
<light name="sun" type="directional"><direction>0 0 -2</direction><diffuse>1 0.5 0.25 1</diffuse></light>
<navvy:camera name="still"><position_m>1 2 3</position_m></navvy:camera>
<navvy:camera name="follow"><machine>first</machine><fov_deg>90</fov_deg></navvy:camera>
<navvy:camera name="mounted"><machine>first</machine><link>bucket</link></navvy:camera>
<navvy:seed>42</navvy:seed>)";

scene::Scene load(const std::string& body, const Overrides& overrides = {}) {
  return load_scene_from_string(world_text(body), kScene, control::step_kinds(), overrides);
}

std::string failure(const std::string& body, const Overrides& overrides = {}) {
  try {
    load(body, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "loaded";
}

Overrides set(const std::string& setting) {
  Overrides overrides;
  overrides.set.push_back(parse_setting(setting));
  return overrides;
}

TEST(Loader, ReadsSoilsWithUnitsConvertedOnce) {
  const scene::Scene world = load(kBody);
  ASSERT_EQ(world.soils.size(), 2u);
  EXPECT_EQ(world.soils[0].name, "loam");
  EXPECT_EQ(world.soils[0].cohesion, 7000);
  EXPECT_EQ(world.soils[0].swell, 1.23);
  EXPECT_DOUBLE_EQ(world.soils[1].friction_angle, radians(35));
  // An implied residual cohesion must not exceed the cohesion.
  EXPECT_EQ(world.soils[1].residual_cohesion, 0);
}

TEST(Loader, ReadsGroundShapesInFileOrderAndLayersFromTheSurfaceDown) {
  const scene::StartGround ground = load(kBody).ground;
  EXPECT_EQ(ground.size, Vec2(24, 20));
  EXPECT_EQ(ground.origin, Vec2(-12, -10));
  EXPECT_EQ(ground.surface, 1.5);
  ASSERT_EQ(ground.features.size(), 3u);
  EXPECT_EQ(ground.features[0].kind, scene::GroundFeature::Kind::kHills);
  EXPECT_EQ(ground.features[0].length, 9);
  EXPECT_EQ(ground.features[0].seed, 5u);
  EXPECT_EQ(ground.features[1].kind, scene::GroundFeature::Kind::kBank);
  EXPECT_DOUBLE_EQ(ground.features[1].angle, radians(60));
  EXPECT_EQ(ground.features[2].height, 0.1);
  ASSERT_EQ(ground.layers.size(), 2u);
  EXPECT_EQ(ground.layers[0].soil, "fill");
  EXPECT_EQ(ground.layers[0].thickness, 0.5);
  ASSERT_EQ(ground.patches.size(), 1u);
  EXPECT_EQ(ground.patches[0].max, Vec2(3, 4));
}

TEST(Loader, ReadsMachinesWithPoseJointsAndProgram) {
  const scene::Scene world = load(kBody);
  ASSERT_EQ(world.machines.size(), 2u);
  const scene::MachineInWorld& first = world.machines[0];
  EXPECT_EQ(first.name, "first");
  EXPECT_TRUE(first.on_ground);
  EXPECT_FALSE(world.machines[1].on_ground);
  EXPECT_EQ(Vec3(first.X_WM.translation()), Vec3(1, 2, 0.5));
  // 1e-12: rounding of the rotation by 90 degrees.
  EXPECT_LT((first.X_WM.linear() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
  const int curl = first.machine.joint_index("curl");
  ASSERT_GE(curl, 0);
  EXPECT_DOUBLE_EQ(first.machine.joints[static_cast<std::size_t>(curl)].initial, radians(-30));
  ASSERT_EQ(first.program.steps.size(), 2u);
  EXPECT_EQ(first.program.steps[0].as<control::Wait>()->duration, 2);
  const auto& path = *first.program.steps[1].as<control::Trajectory>();
  ASSERT_EQ(path.positions.size(), 2u);
  EXPECT_DOUBLE_EQ(path.positions[1][0], radians(90));
  EXPECT_EQ(path.positions[1][1], 2);
  EXPECT_EQ(first.program.lines[0], 20);
}

TEST(Loader, ReadsCamerasLightAndSeed) {
  const scene::Scene world = load(kBody);
  ASSERT_EQ(world.cameras.size(), 3u);
  EXPECT_EQ(world.cameras[0].kind, scene::Camera::Kind::kFixed);
  EXPECT_EQ(world.cameras[1].kind, scene::Camera::Kind::kChase);
  EXPECT_DOUBLE_EQ(world.cameras[1].fov, radians(90));
  EXPECT_EQ(world.cameras[2].kind, scene::Camera::Kind::kOnLink);
  ASSERT_EQ(world.lights.size(), 1u);
  EXPECT_EQ(world.lights[0].direction, Vec3(0, 0, -1));
  EXPECT_EQ(world.lights[0].color.g, 0.5f);
  EXPECT_EQ(world.seed, 42u);
}

TEST(Loader, OrdersLinksBaseFirstAndJointsByTheirChildLinks) {
  const char* text = R"(<sdf version="1.9" xmlns:navvy="navvy"><model name="m">
<navvy:physics>kinematic</navvy:physics>
<link name="tip"><pose relative_to="hinge">0 0 0 0 0 0</pose></link>
<link name="arm"><pose>1 0 2 0 0 1.5707963267948966</pose></link>
<link name="base"/>
<joint name="hinge" type="revolute"><pose relative_to="arm">3 0 0 0 0 0</pose><parent>arm</parent><child>tip</child>
<axis><xyz expressed_in="__model__">0 0 1</xyz><limit><lower>-1</lower><upper>2</upper><effort>50</effort></limit></axis></joint>
<joint name="turn" type="continuous"><parent>base</parent><child>arm</child><axis><xyz>0 0 5</xyz></axis></joint>
</model></sdf>)";
  const std::string file = navvy::build_dir() + "/order_model.sdf";
  write_file_atomically(file, text);
  const scene::Machine machine = load_machine(file);
  ASSERT_EQ(machine.links.size(), 3u);
  EXPECT_EQ(machine.links[0].name, "base");
  EXPECT_EQ(machine.links[1].name, "arm");
  EXPECT_EQ(machine.links[2].name, "tip");
  EXPECT_EQ(machine.joints[0].name, "turn");
  EXPECT_EQ(machine.joints[1].parent, 1);
  EXPECT_EQ(machine.joints[1].child, 2);
  EXPECT_FALSE(machine.joints[0].has_limits);
  EXPECT_EQ(machine.joints[0].axis, Vec3::UnitZ());
  EXPECT_TRUE(machine.joints[1].has_limits);
  EXPECT_EQ(machine.joints[1].upper, 2);
  EXPECT_EQ(machine.joints[1].effort, 50);
  EXPECT_EQ(machine.joints[0].effort, scene::Joint().effort);
  // The arm is at (1, 0, 2) turned left; its hinge is 3 m along it. 1e-9: rounding of the rotation.
  EXPECT_LT((machine.links[2].X_ML.translation() - Vec3(1, 3, 2)).norm(), 1e-9);
}

TEST(Loader, WarningsAreLoggedAndDoNotStopLoading) {
  std::string logged;
  set_log_sink([&](LogLevel, const std::string& line) { logged += line + "\n"; });
  load(std::string(kBody) + "\n<physics name=\"p\" type=\"ode\"/>");
  set_log_sink({});
  EXPECT_NE(logged.find("warning: world/physics[p]: is ignored"), std::string::npos) << logged;
}

TEST(Loader, DigWidthDefaultsToThatOfTheBucket) {
  const std::string digger =
      R"(<navvy:soil ref="loam"/><navvy:ground/><model name="d">
<navvy:physics>kinematic</navvy:physics><link name="a"/><link name="b"/><link name="c"/><link name="e"/>
<joint name="boom" type="continuous"><parent>a</parent><child>b</child><axis><xyz>0 -1 0</xyz></axis></joint>
<joint name="stick" type="continuous"><parent>b</parent><child>c</child><axis><xyz>0 -1 0</xyz></axis></joint>
<joint name="bucket" type="continuous"><parent>c</parent><child>e</child><axis><xyz>0 -1 0</xyz></axis></joint>
<navvy:arm><boom_joint>boom</boom_joint><stick_joint>stick</stick_joint><bucket_joint>bucket</bucket_joint></navvy:arm>
<navvy:shell name="s"><link>e</link><vertices_m>0 0 0 1 0 0 0 1 0</vertices_m><triangles>0 1 2</triangles></navvy:shell>
<navvy:bucket><link>e</link><shell>s</shell><tip_m>1 0 0</tip_m><width_m>0.6</width_m><opening>0 0 -3</opening></navvy:bucket>
<navvy:cylinder name="c"><joint>boom</joint><base_link>a</base_link><rod_link>b</rod_link><base_pin_m>0 0 1</base_pin_m>
<linkage><rocker_pin_m>1 0 0</rocker_pin_m><rocker_to_rod_m>0.4</rocker_to_rod_m><rocker_to_coupler_m>0.5</rocker_to_coupler_m>
<coupler_length_m>0.6</coupler_length_m><coupler_pin_m>0 0 0.3</coupler_pin_m></linkage><count>2</count></navvy:cylinder>
<navvy:program><dig><from_m>3 0</from_m><to_m>5 0</to_m><depth_m>0.5</depth_m><dump_at_m>0 3</dump_at_m></dig></navvy:program>
</model>)";
  const scene::Scene world = load(digger);
  const auto& machine = world.machines.at(0);
  EXPECT_EQ(machine.program.steps.at(0).as<control::Dig>()->width, 0.6);
  EXPECT_EQ(machine.machine.buckets.at(0).opening, Vec3(0, 0, -1));
  const scene::Cylinder& cylinder = machine.machine.cylinders.at(0);
  EXPECT_TRUE(cylinder.has_linkage);
  EXPECT_EQ(cylinder.coupler, 0.6);
  EXPECT_EQ(cylinder.count, 2);
}

/// A two-wheeled robot with this drive element.
scene::Machine robot_with(const std::string& drive) {
  const scene::Scene world = load(R"(<navvy:soil ref="loam"/><navvy:ground/><model name="r">
<navvy:physics>kinematic</navvy:physics><link name="a"/><link name="l"><pose>0 0.2 0.1 0 0 0</pose></link>
<link name="r"><pose>0 -0.2 0.1 0 0 0</pose></link>
<joint name="left" type="continuous"><parent>a</parent><child>l</child><axis><xyz>0 1 0</xyz></axis></joint>
<joint name="right" type="continuous"><parent>a</parent><child>r</child><axis><xyz>0 1 0</xyz></axis></joint>
<navvy:wheel name="l"><joint>left</joint><driven>true</driven><radius_m>0.1</radius_m></navvy:wheel>
<navvy:wheel name="r"><joint>right</joint><driven>true</driven><radius_m>0.1</radius_m></navvy:wheel>
)" + drive + "</model>");
  return world.machines.at(0).machine;
}

TEST(Loader, ReadsTheKindOfADriveFromItsType) {
  const scene::Machine car =
      robot_with("<navvy:drive><max_steer_deg>20</max_steer_deg></navvy:drive>");
  EXPECT_EQ(std::get<scene::AckermannDrive>(car.drive).max_steer, radians(20));
  EXPECT_TRUE(std::holds_alternative<scene::AckermannDrive>(
      robot_with("<navvy:drive type='ackermann'/>").drive));
  const scene::Machine robot = robot_with(
      "<navvy:drive "
      "type='differential'><track_m>0.4</track_m><max_speed_m_per_s>1.2</max_speed_m_per_s></"
      "navvy:drive>");
  ASSERT_TRUE(robot.has_drive);
  EXPECT_EQ(std::get<scene::DifferentialDrive>(robot.drive).track, 0.4);
  EXPECT_EQ(scene::powertrain(robot.drive).max_speed, 1.2);
  EXPECT_STREQ(scene::steer_unit(robot.drive), "rad/s");
}

TEST(Loader, ADriveMayHaveAnEngineWithGears) {
  const scene::Machine car = robot_with(R"(<navvy:drive><engine><kind>torque_curve</kind>
<point><speed_rpm>600</speed_rpm><torque_nm>300</torque_nm></point>
<point><speed_rpm>1800</speed_rpm><torque_nm>350</torque_nm></point>
<braking_torque_nm>40</braking_torque_nm><gear_ratios>4 2 1</gear_ratios><final_ratio>12</final_ratio>
<efficiency>0.8</efficiency></engine></navvy:drive>)");
  const scene::CombustionEngine* engine = scene::drive_engine(car.drive);
  ASSERT_NE(engine, nullptr);
  ASSERT_EQ(engine->curve.size(), 2u);
  EXPECT_NEAR(engine->curve[1].speed, 60 * kPi, 1e-12);
  EXPECT_EQ(engine->curve[1].torque, 350);
  EXPECT_EQ(engine->gears, (std::vector<double>{4, 2, 1}));
  EXPECT_EQ(engine->final_ratio, 12);
  EXPECT_EQ(engine->efficiency, 0.8);
  EXPECT_EQ(scene::powertrain(car.drive).engine_power, 0) << "it has no engine";
  const scene::Machine robot = robot_with(R"(<navvy:drive><engine><kind>speed_source</kind>
<max_speed_rpm>3000</max_speed_rpm><max_torque_nm>2</max_torque_nm><gear_ratios>20</gear_ratios></engine></navvy:drive>)");
  EXPECT_EQ(scene::drive_engine(robot.drive)->kind, scene::CombustionEngine::Kind::kSpeedSource);
  EXPECT_NEAR(scene::drive_engine(robot.drive)->max_speed, 100 * kPi, 1e-12);
  EXPECT_EQ(scene::drive_engine(robot_with("<navvy:drive/>").drive), nullptr);
}

TEST(Loader, AnEngineIsAParameterThatMayBeAbsent) {
  const auto of = [](const scene::Drive& drive) {
    scene::Scene world;
    world.machines.resize(1);
    world.machines[0].machine.has_drive = true;
    world.machines[0].machine.drive = drive;
    return scene::parameters(world);
  };
  scene::AckermannDrive plain, geared;
  geared.engine.emplace();
  geared.engine->curve = {{100, 200}, {200, 300}};
  geared.engine->gears = {2, 1};
  for (const auto& [path, value] : of(plain))
    EXPECT_EQ(path.find("/engine/"), std::string::npos) << path;
  scene::AckermannDrive other = geared;
  EXPECT_EQ(of(other), of(geared));
  other.engine->gears[1] = 1.1;
  EXPECT_NE(of(other), of(geared));
  other = geared;
  other.engine->curve[1].torque = 301;
  EXPECT_NE(of(other), of(geared));
  other = geared;
  other.engine_power = 1e5;
  EXPECT_NE(of(other), of(geared));
}

/// Returns a shell with this geometry on a separate link.
scene::Shell shell_of(const std::string& geometry) {
  const scene::Scene world = load(R"(<navvy:soil ref="loam"/><navvy:ground/><model name="m">
<navvy:physics>kinematic</navvy:physics><link name="a"/>
<navvy:shell name="s"><link>a</link>)" +
                                  geometry + "</navvy:shell></model>");
  return world.machines.at(0).machine.shells.at(0);
}

TEST(Loader, AShellFromAnObjFileEqualsAnInlineShell) {
  // Quads, faces with texture and normal numbers, negative indices, comments and groups: features
  // that modellers export.
  const test::Folder folder;
  const std::string path = folder / "shell.obj";
  const std::string obj =
      "# a tray\no tray\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0.5\nv 1 0 0.5\nvt 0 0\nvn 0 0 "
      "1\ng floor\n"
      "f 1/1/1 2/1/1 3/1/1 4/1/1\ng back\nf -2//1 -1//1 2//1\nf 5 2 1\n";
  write_file_atomically(path, obj);
  const scene::Shell mesh = shell_of("<mesh>" + path + "</mesh>");
  const scene::Shell inline_shell = shell_of(
      "<vertices_m>0 0 0 1 0 0 1 1 0 0 1 0 0 0 0.5 1 0 0.5</vertices_m>"
      "<triangles>0 1 2 0 2 3 4 5 1 4 1 0</triangles>");
  ASSERT_EQ(mesh.triangles.size(), inline_shell.triangles.size());
  ASSERT_EQ(mesh.vertices.size(), inline_shell.vertices.size())
      << "shared corners are not duplicated";
  // The diagonal of a quad is the reader's choice, so directed areas are compared, above each level
  // and in total.
  const auto area = [](const scene::Shell& shell, double above) {
    Vec3 sum = Vec3::Zero();
    for (const auto& triangle : shell.triangles) {
      const auto corner = [&](std::size_t i) {
        return shell.vertices.at(static_cast<std::size_t>(triangle[i]));
      };
      if ((corner(0) + corner(1) + corner(2)).z() >= above)
        sum += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0));
    }
    return sum;
  };
  EXPECT_TRUE(area(mesh, 0).isApprox(area(inline_shell, 0), 1e-6));
  EXPECT_TRUE(area(mesh, 0.1).isApprox(Vec3(0, 0.5, 0), 1e-6)) << "the back looks inward";
  EXPECT_TRUE(area(inline_shell, 0.1).isApprox(Vec3(0, 0.5, 0), 1e-6));
}

TEST(Overrides, ChangeOneOrAllObjects) {
  EXPECT_EQ(load(kBody, set("soil.swell=1.5")).soils[1].swell, 1.5);
  const scene::Scene one = load(kBody, set("soil[loam].cohesion_pa=8000"));
  EXPECT_EQ(one.soils[0].cohesion, 8000);
  EXPECT_EQ(one.soils[1].cohesion, 0);
  EXPECT_EQ(load(kBody, set("soil[2].swell=1.4")).soils[1].swell, 1.4);
  EXPECT_EQ(load(kBody, set("solver.cell_m=0.05")).solver.cell, 0.05);
  EXPECT_EQ(load(kBody, set("recording.duration_s=3")).recording.duration, 3);
  EXPECT_EQ(load(kBody, set("ground.hills[2].height_m=0.7")).ground.features[2].height, 0.7);
  EXPECT_EQ(load(kBody, set("ground.layer[1].thickness_m=0.9")).ground.layers[0].thickness, 0.9);
  EXPECT_EQ(load(kBody, set("camera[follow].rate_hz=9")).cameras[1].rate, 9);
}

TEST(Overrides, GiveAFrictionAngleWithItsTest) {
  const auto phi = [](const char* setting) {
    return degrees(load(kBody, set(setting)).soils[0].friction_angle);
  };
  EXPECT_NEAR(phi("soil[loam].friction_angle_deg.triaxial=35"), 38.957, 1e-3);
  EXPECT_NEAR(phi("soil.friction_angle_deg.direct_shear=35"), 44.443, 1e-3);
  EXPECT_NEAR(phi("soil.friction_angle_deg=35"), 35, 1e-9);
  EXPECT_NE(failure(kBody, set("soil.friction_angle_deg.triax=35"))
                .find("unknown test 'triax' (did you mean 'triaxial'?)"),
            std::string::npos);
  // Elements elsewhere have no such attribute.
  EXPECT_NE(failure(kBody, set("ground.friction_angle_deg.triaxial=35")).find("unknown element"),
            std::string::npos);
  EXPECT_NE(failure(kBody, set("machine[first].program.wait.friction_angle_deg.triaxial=35"))
                .find("unknown element"),
            std::string::npos);
  EXPECT_NE(failure(kBody, set("soil.friction_angle_deg.triaxial=48"))
                .find("'48': is above the limit of 50 deg in plane strain"),
            std::string::npos);
}

TEST(Loader, ConvertsATestedFrictionAngleByTheDilatancyOfTheSoilThatUsesIt) {
  const test::Folder folder;
  write_file_atomically(
      folder / "tested.sdf",
      std::string("<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><navvy:soil name=\"tested\">"
                  "<friction_angle_deg test=\"direct_shear\">35</friction_angle_deg>"
                  "</navvy:soil></sdf>"));
  const std::string ref = "ref=\"" + (folder / "tested.sdf") + "\"";
  const std::string body =
      "<navvy:soil name=\"a\" " + ref + "/><navvy:soil name=\"b\" " + ref +
      "><dilatancy_angle_deg>10</dilatancy_angle_deg></navvy:soil><navvy:soil name=\"c\" " + ref +
      "><friction_angle_deg>35</friction_angle_deg></navvy:soil><navvy:soil name=\"d\" " + ref +
      "><repose_angle_deg>29</repose_angle_deg></navvy:soil>"
      "<navvy:ground><layer><soil>a</soil></layer></navvy:ground>";
  const scene::Scene world = load(body);
  const double expected[] = {44.443, 39.262, 35, 33.663};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(degrees(world.soils.at(i).friction_angle), expected[i], 1e-3);
}

TEST(Overrides, MoveMachinesAndChangeTheirPrograms) {
  const scene::Scene moved = load(kBody, set("machine[first].x_m=-3.25"));
  EXPECT_EQ(Vec3(moved.machines[0].X_WM.translation()), Vec3(-3.25, 2, 0.5));
  EXPECT_EQ(Vec3(moved.machines[1].X_WM.translation()), Vec3(0, 0, 0));
  const scene::Scene turned = load(kBody, set("machine[second].yaw_deg=180"));
  // 1e-12: rounding of the rotation by 180 degrees.
  EXPECT_LT((turned.machines[1].X_WM.linear() * Vec3::UnitX() + Vec3::UnitX()).norm(), 1e-12);
  const scene::Scene longer = load(kBody, set("machine[first].program.wait.duration_s=9"));
  EXPECT_EQ(longer.machines[0].program.steps[0].as<control::Wait>()->duration, 9);
}

TEST(Overrides, APoseWithAQuaternionKeepsItsRotation) {
  std::string body = kBody;
  const std::string old = "<pose degrees=\"true\">1 2 0.5 0 0 90</pose>";
  // Turned by 90 deg about z, then pitched by none: the same pose as before.
  body.replace(body.find(old), old.size(),
               "<pose rotation_format=\"quat_xyzw\">1 2 0.5 0 0 0.7071067811865476 "
               "0.7071067811865476</pose>");
  const Pose before = load(body).machines[0].X_WM;
  const Pose moved = load(body, set("machine[first].x_m=-3.25")).machines[0].X_WM;
  EXPECT_EQ(Vec3(moved.translation()), Vec3(-3.25, 2, 0.5));
  EXPECT_EQ(Mat3(moved.linear()), Mat3(before.linear())) << "exactly equal";
  const Pose turned = load(body, set("machine[first].yaw_deg=180")).machines[0].X_WM;
  EXPECT_EQ(Vec3(turned.translation()), Vec3(1, 2, 0.5));
  // 1e-12: rounding of the rotation by 180 degrees.
  EXPECT_LT((turned.linear() * Vec3::UnitX() + Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((turned.linear() * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 1e-12);
}

TEST(Overrides, SelectAMachineByItsWholeName) {
  std::string body = kBody;
  const std::string named = "<uri>model://test_bucket</uri><name>second</name>";
  body.replace(body.find(named), named.size(), "<uri>model://test_bucket</uri>");
  EXPECT_EQ(load(body, set("machine[test_bucket].x_m=1")).machines[1].X_WM.translation().x(), 1);
  EXPECT_NE(failure(body, set("machine[test].x_m=1")).find("no 'machine[test]'"),
            std::string::npos);
  EXPECT_NE(failure(body, set("machine[test_buck].x_m=1")).find("no 'machine[test_buck]'"),
            std::string::npos);
}

TEST(Loader, ADirectionsFaultIsReportedOnce) {
  for (const char* direction : {"0 0 0", "0 0 x", "0 0"}) {
    const std::string message = failure(
        "<navvy:soil ref=\"loam\"/><navvy:ground/><light name=\"sun\" "
        "type=\"directional\"><direction>" +
        std::string(direction) + "</direction></light>");
    EXPECT_NE(message.find("direction"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(Overrides, SetSeedDurationRenderTerrainAndSize) {
  Overrides overrides;
  overrides.seed = 7;
  overrides.duration = 12.5;
  overrides.render = false;
  overrides.terrain = navvy::source_dir() + "/LICENSE";  // any file: the loader does not open maps
  overrides.at = Vec2(410000.25, 5100000.5);
  overrides.size = Vec2(30, 26);
  const scene::Scene world = load(kBody, overrides);
  EXPECT_EQ(world.seed, 7u);
  EXPECT_EQ(world.recording.duration, 12.5);
  EXPECT_FALSE(world.recording.render);
  EXPECT_EQ(world.ground.file, *overrides.terrain);
  EXPECT_TRUE(world.ground.has_at);
  EXPECT_EQ(world.ground.at, *overrides.at);
  EXPECT_EQ(world.ground.origin, Vec2(-15, -13));
  EXPECT_TRUE(world.ground.features.empty());
}

TEST(Overrides, ReachReferencesFilesAndPoses) {
  const scene::Scene sand = load(kBody, set("soil[loam].ref=sand_dry"));
  const scene::Scene shipped = load("<navvy:soil ref=\"sand_dry\"/><navvy:ground/>");
  EXPECT_EQ(sand.soils[0].source, shipped.soils[0].source);
  EXPECT_EQ(sand.soils[0].name, "loam") << "layers refer to it";
  EXPECT_EQ(sand.soils[0].cohesion, 7000) << "the scene's own values stay";
  const scene::Scene moved = load(kBody, set("machine.first.pose=3 1 0 0 0 0"));
  EXPECT_EQ(Vec3(moved.machines[0].X_WM.translation()), Vec3(3, 1, 0));
  EXPECT_EQ(Vec3(moved.machines[1].X_WM.translation()), Vec3(0, 0, 0));
  const scene::Scene other = load(kBody, set("machine.second.uri=model://ew180"));
  EXPECT_EQ(other.machines[1].machine.name, "ew180");
  EXPECT_EQ(other.machines[1].name, "second");
  EXPECT_FALSE(load(kBody, set("machine.first.on_ground=false")).machines[0].on_ground);
}

/// Returns what loading a scene logs.
std::string logged_by(const Overrides& overrides) {
  std::string logged;
  set_log_sink([&](LogLevel, const std::string& line) { logged += line + "\n"; });
  load(kBody, overrides);
  set_log_sink({});
  return logged;
}

TEST(Overrides, WithoutEffectGiveWarnings) {
  EXPECT_EQ(logged_by(set("soil[fill].swell=1.3")), "");
  EXPECT_EQ(logged_by(set("soil[fill].friction_angle_deg.triaxial=35")), "");
  // Equal to the file's value, to that of the shipped soil, and to the default.
  for (const char* setting : {"soil[loam].cohesion_pa=7e3", "soil[loam].swell=1.23",
                              "soil[loam].friction_angle_deg.plane_strain=30",
                              "recording.settle_s=1", "machine[first].x_m=1"})
    EXPECT_NE(logged_by(set(setting)).find("has no effect: the scene has this value already"),
              std::string::npos)
        << setting;
  Overrides twice = set("solver.cell_m=0.1");
  twice.set.emplace_back("solver.cell_m", "0.15");
  EXPECT_NE(logged_by(twice).find("a later setting gives the value"), std::string::npos);
  Overrides seed;
  seed.seed = 7;
  EXPECT_EQ(logged_by(seed), "") << "the second hills have no seed";
  seed.set.emplace_back("ground.hills.seed", "3");
  EXPECT_NE(logged_by(seed).find("--seed"), std::string::npos);
}

TEST(Loader, ReadsElementsByTheirNamesOfEarlierReleases) {
  const std::string body = std::string(kBody) +
                           "<model name=\"old\"><navvy:"
                           "engine>kinematic</navvy:"
                           "engine><link name=\"a\"/></model>";
  EXPECT_TRUE(load(body).machines.at(2).machine.kinematic);
}

TEST(Overrides, NameTheCommandLineKeyAndTheNearestNameInFaults) {
  const std::string unknown = failure(kBody, set("soil.cohesion=8000"));
  EXPECT_NE(unknown.find("command line: error: world/navvy:soil[loam]/cohesion"), std::string::npos)
      << unknown;
  EXPECT_NE(unknown.find("did you mean 'cohesion_pa'?"), std::string::npos) << unknown;
  EXPECT_NE(failure(kBody, set("solver.cell_m=0")).find("'0': must be a number from 0.005"),
            std::string::npos);
  EXPECT_NE(failure(kBody, set("sole.swell=1")).find("did you mean 'soil'?"), std::string::npos);
  EXPECT_NE(failure(kBody, set("soil[clay].swell=1")).find("no 'soil[clay]'"), std::string::npos);
  EXPECT_NE(failure(kBody, set("machine[first].xm=1")).find("did you mean 'x_m'?"),
            std::string::npos);
  EXPECT_NE(failure(kBody, set("soil=1")).find("object.element=value"), std::string::npos);
  EXPECT_NE(failure(kBody, set("machine[first].x_m=900")).find("must stand on the site"),
            std::string::npos);
  // It would be written into the resolved scene of a run, where XML cannot hold it.
  EXPECT_NE(failure(kBody, set("machine[first].z_m=1\v")).find("no control characters"),
            std::string::npos);
  EXPECT_THROW(parse_setting("soil.swell"), InputError);
}

TEST(Loader, ReadsPairsOfMaterialsFromTheirFileAndFromTheScene) {
  const scene::Scene world = load_scene_from_string(
      R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w"><navvy:soil ref="loam"/><navvy:ground/>
<navvy:materials><file>materials.sdf</file><ground>earth</ground>
<pair materials="ice earth"><static_friction>0.1</static_friction><restitution>0.2</restitution>
<softness_m_per_n>1e-7</softness_m_per_n></pair></navvy:materials>
<model name="m"><static>true</static><link name="a"><navvy:material>ice</navvy:material></link></model></world></sdf>)",
      "here/scene.sdf", control::step_kinds());
  EXPECT_EQ(world.machines.at(0).machine.links.at(0).material.name, "ice");
  EXPECT_EQ(world.materials.ground, "earth");
  const scene::MaterialPair* shipped = world.materials.pair("stone", "steel");
  ASSERT_NE(shipped, nullptr);
  EXPECT_GT(shipped->static_friction, shipped->kinetic_friction);
  const scene::MaterialPair* own = world.materials.pair("earth", "ice");
  ASSERT_NE(own, nullptr);
  EXPECT_EQ(own->static_friction, 0.1);
  EXPECT_EQ(own->kinetic_friction, 0.1) << "one number applies to both";
  EXPECT_EQ(own->restitution, 0.2);
  EXPECT_EQ(own->softness, 1e-7);
  EXPECT_EQ(world.materials.pair("ice", "stone"), nullptr);
}

}  // namespace
}  // namespace navvy::scene_io
