// SPDX-License-Identifier: Apache-2.0
// Buckets made of plates by their numbers, and bucket files.
#include "scene_io/bucket_reader.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"
#include "folder.h"
#include "geometry/plate_properties.h"
#include "scene/parameters.h"
#include "scene_io/loader.h"

namespace navvy::scene_io {
namespace {

std::string scene_text(const std::string& in_include) {
  return "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\"><navvy:soil ref=\"loam\"/>\n"
         "<navvy:ground><size_m>40 40</size_m></navvy:ground>\n"
         "<include><uri>model://ew180</uri><name>e</name>\n" +
         in_include + "\n</include></world></sdf>";
}

scene::Scene scene_with(const std::string& in_include, std::string* resolved = nullptr) {
  return load_scene_from_string(scene_text(in_include), "w.sdf", scene::StepKinds{}, {}, resolved);
}

scene::Machine machine_with(const std::string& in_include) {
  return scene_with(in_include).machines.at(0).machine;
}

/// Returns the message with which a scene is refused; empty if it is read.
std::string refused(const std::string& in_include) {
  try {
    scene_with(in_include);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string bucket(const std::string& values) {
  return "<navvy:bucket>" + values + "</navvy:bucket>";
}

const scene::Link& bucket_link(const scene::Machine& machine) {
  return machine.links.at(static_cast<std::size_t>(machine.link_index("bucket")));
}

TEST(BucketReader, OneLineOfASceneSwapsTheBucket) {
  const scene::Machine before = machine_with("");
  const scene::Machine after = machine_with("<navvy:bucket ref=\"trenching_0_60\"/>");
  ASSERT_EQ(after.buckets.size(), 1u);
  const scene::Bucket& fitted = after.buckets[0];
  EXPECT_EQ(fitted.name, "trenching_0_60");
  EXPECT_EQ(fitted.link, "bucket");
  EXPECT_EQ(fitted.width, 0.6);
  EXPECT_EQ(fitted.capacity, 0.4);
  ASSERT_TRUE(fitted.teeth);
  EXPECT_EQ(fitted.teeth->number, 3);
  // The edge stays where it was, on the same radius.
  EXPECT_NEAR((fitted.p_tip - before.buckets[0].p_tip).norm(), 0, 1e-12);
  EXPECT_NEAR((fitted.opening - before.buckets[0].opening).norm(), 0, 1e-12);
  ASSERT_EQ(after.shells.size(), 1u);
  EXPECT_EQ(after.shells[0].name, "bucket");
  const geometry::Box box = geometry::bounds(after.shells[0]);
  EXPECT_NEAR(box.high.y() - box.low.y(), 0.6 - 0.025, 1e-12);
  // A narrower bucket is lighter, and its picture is no file's.
  EXPECT_LT(bucket_link(after).mass, bucket_link(before).mass);
  EXPECT_LT(bucket_link(after).inertia.trace(), bucket_link(before).inertia.trace());
  ASSERT_EQ(bucket_link(after).visuals.size(), 1u);
  EXPECT_TRUE(bucket_link(after).visuals[0].geometry.made);
  EXPECT_EQ(after.derived.back().substr(0, 50),
            "bucket 'trenching_0_60' is made of plates: 0.4 m3 ");
  // Nothing else changes.
  EXPECT_NEAR(after.total_mass() - bucket_link(after).mass,
              before.total_mass() - bucket_link(before).mass, 1e-9);
}

TEST(BucketReader, MassAndInertiaAreThoseOfThePlates) {
  const scene::Machine machine =
      machine_with(bucket("<width_m>0.9</width_m><capacity_m3>0.6</capacity_m3>"));
  const scene::Link& link = bucket_link(machine);
  const geometry::SolidProperties plates =
      geometry::plate_properties(machine.shells.at(0), 2 * machine.shells[0].half_thickness);
  EXPECT_NEAR(link.mass, 7850 * plates.volume, 1e-9);
  EXPECT_NEAR((link.p_LCom - plates.p_BCom).norm(), 0, 1e-12);
  EXPECT_NEAR((link.inertia - 7850 * plates.inertia).norm(), 0, 1e-9);
  // A given mass keeps the shape's centre and scales its inertia.
  const scene::Machine heavier = machine_with(
      bucket("<width_m>0.9</width_m><capacity_m3>0.6</capacity_m3><mass_kg>1000</mass_kg>"));
  EXPECT_EQ(bucket_link(heavier).mass, 1000);
  EXPECT_NEAR((bucket_link(heavier).inertia - 1000 / link.mass * link.inertia).norm(), 0, 1e-9);
}

TEST(BucketReader, ValuesBesideARefReplaceThoseOfTheFile) {
  const scene::Machine machine = machine_with(
      "<navvy:bucket ref=\"trenching_0_60\"><capacity_m3>0.35</capacity_m3>"
      "<teeth><number>2</number></teeth></navvy:bucket>");
  EXPECT_EQ(machine.buckets[0].capacity, 0.35);
  EXPECT_EQ(machine.buckets[0].width, 0.6);
  EXPECT_EQ(machine.buckets[0].teeth->number, 2);
  EXPECT_EQ(machine.buckets[0].teeth->width, 0.08);
}

TEST(BucketReader, TipRadiusMovesTheEdge) {
  const scene::Machine machine = machine_with("<navvy:bucket ref=\"ditching_1_80\"/>");
  EXPECT_NEAR((machine.buckets[0].p_tip - Vec3(1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_FALSE(machine.buckets[0].teeth);
}

TEST(BucketReader, ResolvedSceneHasTheSameMachine) {
  for (const char* given :
       {"<navvy:bucket ref=\"trenching_0_60\"/>",
        "<navvy:bucket><width_m>0.9</width_m><capacity_m3>0.6</capacity_m3></navvy:bucket>"}) {
    std::string text;
    const scene::Scene first = scene_with(given, &text);
    EXPECT_EQ(text.find("ref=\"trenching"), std::string::npos);
    const scene::Scene again = load_scene_from_string(text, "resolved.sdf", scene::StepKinds{}, {});
    EXPECT_EQ(scene::differences(scene::parameters(first), scene::parameters(again)), "");
  }
}

TEST(BucketReader, TheBucketIsAParameterOfTheScene) {
  const std::string changed =
      scene::differences(scene::parameters(scene_with("")),
                         scene::parameters(scene_with("<navvy:bucket ref=\"trenching_0_60\"/>")));
  EXPECT_NE(changed.find("capacity_m3"), std::string::npos) << changed;
}

TEST(BucketReader, AMachineFileReadsABucketFileBesideIt) {
  const test::Folder folder;
  std::ofstream(folder / "small.sdf")
      << "<sdf version='1.9' xmlns:navvy='navvy'><navvy:bucket name='small'><width_m>0.4</width_m>"
         "<capacity_m3>0.06</capacity_m3><plate_m>0.015</plate_m></navvy:bucket></sdf>";
  std::ofstream(folder / "m.sdf")
      << "<sdf version='1.9' xmlns:navvy='navvy'><model name='m'><link name='a'><inertial><mass>9"
         "</mass></inertial></link><link name='b'/><joint name='j' type='revolute'><parent>a"
         "</parent><child>b</child><axis><xyz>0 1 0</xyz></axis></joint>"
         "<navvy:bucket ref='small.sdf'><link>b</link><tip_m>0 0 -0.7</tip_m>"
         "<opening>1 0 0</opening></navvy:bucket></model></sdf>";
  const scene::Machine machine = load_machine(folder / "m.sdf");
  ASSERT_EQ(machine.shells.size(), 1u);
  EXPECT_EQ(machine.shells[0].name, "small");
  const scene::Link& link = machine.links.at(1);
  EXPECT_GT(link.mass, 20);
  // The mouth opens ahead, so the bucket is behind the line from the pin to its edge.
  EXPECT_LT(link.p_LCom.x(), -0.05);
  EXPECT_LT(link.p_LCom.z(), -0.1);
  EXPECT_NEAR((machine.buckets.at(0).opening - Vec3(1, 0, 0)).norm(), 0, 1e-12);
  // It can be checked alone.
  EXPECT_TRUE(check(folder / "small.sdf", scene::StepKinds{}).empty());
}

TEST(BucketReader, RefusesNumbersThatMakeNoBucket) {
  const std::string wide = "<width_m>0.6</width_m>";
  struct Case {
    std::string values;
    std::vector<std::string> says;
  };
  for (const Case& one : std::vector<Case>{
           {wide + "<capacity_m3>0</capacity_m3>", {"w.sdf:4", "capacity_m3", "'0'", "0.0001"}},
           {wide + "<capacity_m3>nan</capacity_m3>", {"w.sdf:4", "capacity_m3", "'nan'"}},
           {wide + "<capacity_m3>2</capacity_m3>",
            {"w.sdf:4", "capacity_m3", "'2'", "0.6 m wide", "1.4 m from the pin", "holds",
             "give another capacity_m3"}},
           {wide + "<capacity_m3>0.01</capacity_m3>", {"w.sdf:4", "'0.01'", "holds"}},
           {wide, {"w.sdf:4", "needs an element <capacity_m3>", "trenching_0_60"}},
           {wide + "<capacity_m3>0.4</capacity_m3><teeth><number>8</number><width_m>0.1</width_m>"
                   "</teeth>",
            {"w.sdf:4", "8 teeth of 0.1 m", "at most as wide as the bucket, 0.6 m", "fewer"}},
           {wide + "<capacity_m3>0.4</capacity_m3><plate_m>0.1</plate_m>",
            {"w.sdf:4", "plate_m", "a tenth", "thinner"}},
           {wide + "<capacity_m3>0.4</capacity_m3><side_clearance_m>0.2</side_clearance_m>",
            {"w.sdf:4", "side_clearance_m", "a fifth"}},
           {wide + "<capacity_m3>0.4</capacity_m3><opening>1 0 0</opening><tip_m>1 0 0</tip_m>",
            {"w.sdf:4", "opening", "must not open along"}},
           {wide + "<capacity_m3>0.4</capacity_m3><tip_m>0 0 0</tip_m>",
            {"w.sdf:4", "tip_m", "at least 0.05 m"}},
           {wide + "<capacity_m3>0.4</capacity_m3><cut_direction>1 0 0</cut_direction>",
            {"w.sdf:4", "cut_direction", "follows from the shape"}},
           {"<shell>bucket</shell>", {"w.sdf:4", "shell", "is made of plates"}}}) {
    const std::string message = refused(bucket(one.values));
    for (const std::string& part : one.says)
      EXPECT_NE(message.find(part), std::string::npos)
          << one.values << " lacks '" << part << "': " << message;
  }
}

TEST(BucketReader, RefusesFilesThatAreNoBuckets) {
  const test::Folder folder;
  const auto file = [&](const std::string& text) {
    std::ofstream(folder / "b.sdf") << "<sdf version='1.9' xmlns:navvy='navvy'>\n"
                                    << text << "</sdf>";
    return refused("<navvy:bucket ref=\"" + (folder / "b.sdf") + "\"/>");
  };
  EXPECT_NE(file("<navvy:soil name='s'/>").find("a bucket file needs a <navvy:bucket>"),
            std::string::npos);
  EXPECT_NE(file("<navvy:bucket><width_m>1</width_m></navvy:bucket>").find("b.sdf:2"),
            std::string::npos);
  EXPECT_NE(file("<navvy:bucket><width_m>1</width_m><capacity_m3>1</capacity_m3><link>x</link>"
                 "</navvy:bucket>")
                .find("belongs to the machine that carries the bucket"),
            std::string::npos);
  EXPECT_NE(file("<navvy:bucket ref='c'><width_m>1</width_m><capacity_m3>1</capacity_m3>"
                 "</navvy:bucket>")
                .find("ref is for machines and scenes"),
            std::string::npos);
  EXPECT_NE(refused("<navvy:bucket ref=\"trenching_0_6\"/>").find("did you mean 'trenching_0_60'"),
            std::string::npos);
}

TEST(BucketReader, SettingsOfTheCommandLineChangeTheBucket) {
  Overrides overrides;
  overrides.set.push_back(parse_setting("machine[e].bucket.capacity_m3=0.35"));
  const scene::Scene scene = load_scene_from_string(
      scene_text("<navvy:bucket ref=\"trenching_0_60\"/>"), "w.sdf", scene::StepKinds{}, overrides);
  EXPECT_EQ(scene.machines.at(0).machine.buckets.at(0).capacity, 0.35);
}

}  // namespace
}  // namespace navvy::scene_io
