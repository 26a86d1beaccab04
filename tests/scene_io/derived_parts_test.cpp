// SPDX-License-Identifier: Apache-2.0
// Collision shapes and masses derived from the rest of a model, and planes that stand for the rock.
#include <gtest/gtest.h>

#include "control/step_kinds.h"
#include "heightfield/make_ground.h"
#include "scene_io/loader.h"

namespace navvy::scene_io {
namespace {

using Kind = scene::Geometry::Kind;

/// Returns a scene on flat soil, with its surface at 0.5 m and these elements in the world.
scene::Scene scene_with(const std::string& elements, const std::string& ground = "") {
  return load_scene_from_string(
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\"><navvy:soil ref=\"loam\"/>"
      "<navvy:ground><size_m>20 20</size_m><surface_m>0.5</surface_m>" +
          ground + "</navvy:ground>" + elements + "</world></sdf>",
      "w.sdf", control::step_kinds());
}

std::string visual(const std::string& name, const std::string& shape,
                   const std::string& pose = "0 0 0 0 0 0") {
  return "<visual name=\"" + name + "\"><pose>" + pose + "</pose><geometry>" + shape +
         "</geometry></visual>";
}

const std::string kBody =
    visual("body", "<box><size>0.5 0.3 0.2</size></box>", "0 0 0.1 0 0 0") +
    visual("dome", "<sphere><radius>0.1</radius></sphere>", "0 0 0.3 0 0 0") +
    visual("mast", "<capsule><radius>0.02</radius><length>0.3</length></capsule>") +
    visual("hat", "<cone><radius>0.1</radius><length>0.2</length></cone>");

TEST(DerivedParts, CollideLikeVisualsAndWeighByDensity) {
  const scene::Scene scene = scene_with(
      "<model name=\"r\"><link name=\"a\"><navvy:density_kg_per_m3>1000</navvy:density_kg_per_m3>" +
      visual("body", "<box><size>0.5 0.3 0.2</size></box>", "0 0 0.1 0 0 0") + "</link></model>");
  const scene::Machine& machine = scene.machines.at(0).machine;
  const scene::Link& link = machine.links.at(0);
  ASSERT_EQ(link.collisions.size(), 1u);
  EXPECT_TRUE(link.collisions[0].derived);
  EXPECT_EQ(link.collisions[0].geometry.kind, Kind::kBox);
  EXPECT_NEAR(link.collisions[0].X_LC.translation().z(), 0.1, 1e-12);
  EXPECT_NEAR(link.mass, 30, 1e-9);
  EXPECT_NEAR(link.p_LCom.z(), 0.1, 1e-12);
  EXPECT_NEAR(link.inertia(2, 2), 30 * (0.25 + 0.09) / 12, 1e-9);
  ASSERT_EQ(machine.derived.size(), 2u);
  EXPECT_NE(machine.derived[0].find("box 'body'"), std::string::npos) << machine.derived[0];
  EXPECT_NE(machine.derived[1].find("30 kg"), std::string::npos) << machine.derived[1];
}

TEST(DerivedParts, EveryShapeHasACollisionOfItsKind) {
  const scene::Scene scene = scene_with(
      "<model name=\"r\"><link name=\"a\"><navvy:density_kg_per_m3>500</navvy:density_kg_per_m3>" +
      kBody + "</link></model>");
  const scene::Link& link = scene.machines.at(0).machine.links.at(0);
  ASSERT_EQ(link.collisions.size(), 4u);
  EXPECT_EQ(link.collisions[1].geometry.kind, Kind::kSphere);
  EXPECT_EQ(link.collisions[2].geometry.kind, Kind::kCapsule);
  EXPECT_EQ(link.collisions[2].geometry.length, 0.3);
  EXPECT_EQ(link.collisions[3].geometry.kind, Kind::kCone);
  EXPECT_EQ(link.collisions[3].geometry.radius, 0.1);
}

TEST(DerivedParts, VisualsDoNotCollideIfACollisionIsGivenOrDisabled) {
  const std::string inertial =
      "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>";
  const scene::Scene given =
      scene_with("<model name=\"r\"><link name=\"a\">" + inertial + kBody +
                 "<collision name=\"c\"><geometry><sphere><radius>1</radius></sphere></geometry>"
                 "</collision></link></model>");
  EXPECT_EQ(given.machines.at(0).machine.links.at(0).collisions.size(), 1u);
  const scene::Scene none = scene_with(
      "<model name=\"r\"><navvy:derive_collisions>false</navvy:derive_collisions>"
      "<link name=\"a\">" +
      inertial + kBody + "</link></model>");
  EXPECT_TRUE(none.machines.at(0).machine.links.at(0).collisions.empty());
  EXPECT_TRUE(none.machines.at(0).machine.derived.empty());
}

TEST(DerivedParts, ADensityOfAShapeOverridesThatOfItsLink) {
  const scene::Scene scene = scene_with(
      "<model name=\"r\"><link name=\"a\"><navvy:density_kg_per_m3>1000</navvy:density_kg_per_m3>"
      "<collision name=\"wood\"><geometry><box><size>1 1 1</size></box></geometry></collision>"
      "<collision name=\"lead\"><pose>1 0 0 0 0 "
      "0</pose><navvy:density_kg_per_m3>3000</navvy:density_kg_per_m3>"
      "<geometry><box><size>1 1 1</size></box></geometry></collision></link></model>");
  const scene::Link& link = scene.machines.at(0).machine.links.at(0);
  EXPECT_NEAR(link.mass, 4000, 1e-9);
  EXPECT_NEAR(link.p_LCom.x(), 0.75, 1e-12);
  EXPECT_NEAR(link.inertia(1, 1), 4000.0 / 6 + 1000 * 0.75 * 0.75 + 3000 * 0.25 * 0.25, 1e-6);
}

// As shipped with Gazebo, but without its texture; its friction values are placeholders.
const std::string kGroundPlane =
    "<model name=\"ground_plane\"><static>true</static><link name=\"link\"><collision "
    "name=\"collision\"><geometry>"
    "<plane><normal>0 0 1</normal><size>100 "
    "100</size></plane></geometry><surface><contact/><friction><ode>"
    "<mu>100</mu><mu2>50</mu2></ode></friction><bounce/></surface></collision><visual "
    "name=\"visual\"><cast_shadows>"
    "false</cast_shadows><geometry><plane><normal>0 0 1</normal><size>100 "
    "100</size></plane></geometry></visual>"
    "</link></model>";

TEST(GroundPlane, OfGazeboBecomesTheRockUnderTheSoil) {
  const scene::Scene scene = scene_with(kGroundPlane);
  EXPECT_TRUE(scene.machines.at(0).machine.links.at(0).collisions.empty());
  ASSERT_TRUE(scene.ground.has_rock);
  EXPECT_EQ(heightfield::make_ground(scene).datum(), 0.0);
}

TEST(GroundPlane, AboveTheSoilReportsTheRemedy) {
  try {
    scene_with(kGroundPlane,
               "<trench><center_m>0 0</center_m><length_m>4</length_m><width_m>2</width_m>"
               "<depth_m>1</depth_m></trench>");
    heightfield::make_ground(scene_with(kGroundPlane,
                                        "<trench><center_m>0 0</center_m><length_m>4</length_m>"
                                        "<width_m>2</width_m><depth_m>1</depth_m></trench>"));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("lower the plane"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace navvy::scene_io
