// SPDX-License-Identifier: Apache-2.0
// Files of unknown origin: their resources are counted, and anything but regular files is refused
// by name.
#include "core/limits.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>

#include "control/step_kinds.h"
#include "core/file.h"
#include "folder.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "scene_io/world_reader.h"

namespace navvy::scene_io {
namespace {

std::string world_text(const std::string& body) {
  return "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\"><navvy:soil ref=\"loam\"/>"
         "<navvy:ground><size_m>40 40</size_m></navvy:ground>\n" +
         body + "</world></sdf>";
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string out;
  for (std::size_t i = 0; i < times; ++i) out += text;
  return out;
}

std::string messages(const Faults& faults) {
  std::string all;
  for (const Fault& fault : faults.list()) all += fault.text() + "\n";
  return all;
}

/// Result of reading a text: faults and the scene.
Faults read(const std::string& text, scene::Scene* world = nullptr) {
  Faults faults;
  const auto document = Document::parse(text, navvy::source_dir() + "/scenarios/mine.sdf", faults);
  if (!document) return faults;
  scene::Scene read = read_world(*document, control::step_kinds(), faults);
  if (world != nullptr) *world = std::move(read);
  return faults;
}

::testing::AssertionResult refused(const std::string& text, const std::string& fragment) {
  const Faults faults = read(text);
  const std::string all = messages(faults);
  if (faults.has_errors() && all.find(fragment) != std::string::npos)
    return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "'" << fragment << "' not in " << all.substr(0, 2000);
}

std::string include(int i) {
  const std::string n = std::to_string(i);
  return "<include><uri>model://ew180</uri><name>m" + n + "</name></include>";
}

TEST(Limits, ReadsAFileOfFortyMachinesOnce) {
  std::string machines;
  for (int i = 0; i < 40; ++i) machines += include(i);
  scene::Scene world;
  const Faults faults = read(world_text(machines), &world);
  EXPECT_FALSE(faults.has_errors()) << messages(faults);
  ASSERT_EQ(world.machines.size(), 40u);
  EXPECT_EQ(world.machines[39].machine.links.size(), world.machines[0].machine.links.size());
  EXPECT_GT(world.machines[39].machine.links.size(), 3u);
  EXPECT_EQ(faults.work.models, 1u);
  EXPECT_EQ(faults.work.files, 2u) << "the machine's and the soil's";
}

TEST(Limits, AFaultInASharedFileIsReportedOnce) {
  const test::Folder folder;
  const std::string model = folder / "model.sdf";
  write_file_atomically(
      model,
      std::string("<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><model name=\"m\"><link name=\"a\"/>"
                  "</model></sdf>"));
  std::string machines;
  for (const char* name : {"a", "b", "c"})
    machines += "<include><uri>" + model + "</uri><name>" + name + "</name></include>";
  const Faults faults = read(world_text(machines));
  EXPECT_EQ(faults.error_count(), 1u) << messages(faults);
}

TEST(Limits, TenThousandUnknownElementsAreReportedInAHundredLines) {
  const Faults faults = read(world_text(repeated("<thing/>\n", 10'000)));
  EXPECT_EQ(faults.error_count(), 10'000u);
  EXPECT_EQ(faults.list().size(), limits::kFaultsShown + 1);
  EXPECT_NE(messages(faults).find("and 9900 more that are not shown"), std::string::npos);
}

/// Also for files on disk, where reading ends at the limit: the remedy must not be to search for
/// the file.
TEST(Limits, AFileThatIsTooLargeIsReportedWithARemedy) {
  const test::Folder folder;
  const std::string file = folder / "large.sdf";
  write_file_atomically(file, world_text(std::string(limits::kXmlBytes, ' ')));
  const std::vector<Fault> large = check(file, control::step_kinds());
  ASSERT_EQ(large.size(), 1u);
  EXPECT_NE(large[0].text().find("may have at most 16777216 (put meshes into OBJ files"),
            std::string::npos)
      << large[0].text();
  const std::vector<Fault> missing = check(folder / "none.sdf", control::step_kinds());
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_NE(missing[0].text().find("(check the path)"), std::string::npos) << missing[0].text();
}

TEST(Limits, CountsEveryFaultEvenIfFewAreReported) {
  const test::Folder folder;
  const std::string file = folder / "many.sdf";
  write_file_atomically(file, world_text(repeated("<thing/>\n", 10'000) +
                                         repeated("<light type=\"point\" name=\"l\"/>", 200)));
  FaultCount count;
  const std::vector<Fault> found = check(file, control::step_kinds(), nullptr, {}, nullptr, &count);
  EXPECT_LT(found.size(), 250u);
  EXPECT_EQ(count.errors, 10'000u);
  EXPECT_GE(count.warnings, 200u);
}

TEST(Limits, WarningsDoNotCrowdOutErrors) {
  const Faults faults =
      read(world_text(repeated("<light type=\"point\" name=\"l\"/>", 200) + "<thing/>"));
  EXPECT_EQ(faults.error_count(), 1u);
  EXPECT_NE(messages(faults).find("unknown element"), std::string::npos);
}

TEST(Limits, BytesElementsNestingAttributesAndNamesOfAFileAreBounded) {
  EXPECT_TRUE(
      refused(world_text(std::string(limits::kXmlBytes, ' ')), "may have at most 16777216"));
  EXPECT_TRUE(refused(world_text(repeated("<a/>", limits::kXmlElements)),
                      "a file may have at most 100000"));
  EXPECT_TRUE(refused(world_text("<!--" + repeated("<a/>", limits::kXmlElements) + "-->"),
                      "at most 100000"));
  EXPECT_TRUE(refused(
      world_text(repeated("<a>", limits::kXmlNesting) + repeated("</a>", limits::kXmlNesting)),
      "at most 64 elements inside each other"));
  // The XML reader's own limit applies before Navvy's.
  EXPECT_TRUE(refused(world_text(repeated("<a>", 50'000)), "DEPTH"));
  std::string attributes;
  for (std::size_t i = 0; i <= limits::kXmlAttributes; ++i)
    attributes += " a" + std::to_string(i) + "=\"\"";
  EXPECT_TRUE(refused(world_text("<light" + attributes + "/>"), "at most 32 attributes"));
  // Refused before parsing, which would take hours: each is compared with all others.
  std::string many;
  for (int i = 0; i < 1'000'000; ++i) many += " a" + std::to_string(i) + "='>'";
  EXPECT_TRUE(refused(world_text("<light" + many + "/>"), "at most 32 attributes"));
  EXPECT_FALSE(refused(world_text("<!-- <light" + many + "/> -->"), "attributes"));
  EXPECT_TRUE(refused(world_text("<" + std::string(300, 'a') + "/>"),
                      "at most 200 bytes in the name of an element"));
  EXPECT_TRUE(refused(world_text("<model name=\"" + std::string(300, 'a') + "\"/>"),
                      "a name may have at most 200"));
}

TEST(Limits, ListsOfASceneAreBounded) {
  std::string models;
  for (std::size_t i = 0; i <= limits::kMachines; ++i)
    models += "<model name=\"m" + std::to_string(i) + "\"/>";
  EXPECT_TRUE(refused(world_text(models), "at most 500 <model> in one <world>"));
  EXPECT_TRUE(refused(world_text(repeated("<navvy:soil ref=\"loam\"/>", limits::kSoils)),
                      "at most 255 <navvy:soil>"));
  EXPECT_TRUE(refused(world_text("<model name=\"m\">" +
                                 repeated("<link name=\"l\"/>", limits::kLinks + 1) + "</model>"),
                      "at most 300 <link> in one <model>"));
  EXPECT_TRUE(
      refused(world_text("<model name=\"m\"><link name=\"l\">" +
                         repeated("<visual name=\"v\"/>", limits::kShapes + 1) + "</link></model>"),
              "at most 200 <visual> in one <link>"));
  EXPECT_TRUE(refused(
      world_text("<model name=\"m\"><link name=\"l\">" +
                 repeated("<sensor name=\"s\"/>", scene::kMostSensors + 1) + "</link></model>"),
      "at most 100 <sensor> in one <link>"));
  EXPECT_TRUE(
      refused(world_text("<model name=\"m\"><navvy:program>" +
                         repeated("<wait><duration_s>1</duration_s></wait>", limits::kSteps + 1) +
                         "</navvy:program></model>"),
              "a program may have at most 2000 steps"));
}

TEST(Limits, AnIncludedFileCountsAtEachUse) {
  const test::Folder folder;
  const std::string model = folder / "model.sdf";
  write_file_atomically(
      model, "<sdf version=\"1.9\"><model name=\"m\"><static>1</static><link name=\"a\">" +
                 repeated("<light/>", 60'000) + "</link></model></sdf>");
  std::string machines;
  for (int i = 0; i < 9; ++i)
    machines +=
        "<include><uri>" + model + "</uri><name>m" + std::to_string(i) + "</name></include>";
  EXPECT_TRUE(refused(world_text(machines), "may have at most 400000 elements together"));
  const Faults faults = read(world_text(machines));
  EXPECT_EQ(faults.work.files, 2u);
  EXPECT_LE(faults.work.elements, limits::kSceneElements + 60'100);
}

TEST(Limits, AShellIsBoundedInTrianglesAndPieces) {
  const auto shell = [](const std::string& vertices, const std::string& triangles) {
    return "<model name=\"m\"><navvy:physics>kinematic</navvy:physics><link "
           "name=\"b\"/><navvy:shell "
           "name=\"s\"><link>b</link>"
           "<vertices_m>" +
           vertices + "</vertices_m><triangles>" + triangles + "</triangles></navvy:shell></model>";
  };
  // One triangle of 1000 m would be cut to some twenty million pieces of 0.3 m.
  EXPECT_TRUE(refused(world_text(shell("0 0 0 1000 0 0 0 1000 0", "0 1 2")),
                      "at most 1000000 pieces of three cells"));
  EXPECT_FALSE(read(world_text(shell("0 0 0 10 0 0 0 10 0", "0 1 2"))).has_errors());
  std::string vertices, triangles;
  for (std::size_t i = 0; i <= limits::kShellTriangles; ++i) {
    const std::string x = std::to_string(0.01 * static_cast<double>(i));
    vertices += x + " 0 0 " + x + " 0.01 0 " + x + " 0 0.01 ";
    triangles += std::to_string(3 * i) + " " + std::to_string(3 * i + 1) + " " +
                 std::to_string(3 * i + 2) + " ";
  }
  EXPECT_TRUE(refused(world_text(shell(vertices, triangles)), "a shell may have at most 5000"));
}

TEST(Limits, MeshesOfShapesAreReadOnceAndCheckedBeforeARun) {
  const test::Folder folder;
  const std::string stands = "<static>1</static><link name=\"l\">";
  const std::string moves =
      "<link "
      "name=\"l\"><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></"
      "inertial>";
  const auto model = [](const std::string& kind, const std::string& shape,
                        const std::string& mesh) {
    return "<model name=\"m\">" + kind + "<" + shape + " name=\"a\"><geometry><mesh><uri>" + mesh +
           "</uri></mesh></geometry></" + shape + "><" + shape +
           " name=\"b\"><geometry><mesh><uri>" + mesh + "</uri></mesh></geometry></" + shape +
           "></link></model>";
  };
  const std::string flat = folder / "flat.obj", bad = folder / "bad.obj",
                    empty = folder / "empty.obj";
  write_file_atomically(flat, std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  write_file_atomically(bad, std::string("v 0 0 x\n"));
  write_file_atomically(empty, std::string("\n"));
  const Faults drawn = read(world_text(model(stands, "visual", flat)));
  EXPECT_FALSE(drawn.has_errors()) << messages(drawn);
  EXPECT_EQ(drawn.work.meshes.size(), 1u);
  // Moving bodies collide by a hull, static ones by their triangles; one triangle is enough.
  EXPECT_TRUE(refused(world_text(model(moves, "collision", flat)), "the mesh needs at least 4"));
  const Faults standing = read(world_text(model(stands, "collision", flat)));
  EXPECT_FALSE(standing.has_errors()) << messages(standing);
  EXPECT_TRUE(refused(world_text(model(stands, "visual", empty)),
                      "'0 triangles': a mesh needs at least one triangle"));
  EXPECT_TRUE(refused(world_text(model(stands, "visual", bad)), "bad.obj:1: error"));
  std::string many;
  for (std::size_t i = 0; i <= limits::kHullVertices; ++i)
    many += "v 0 0 " + std::to_string(i) + "\n";
  many += "v 1 0 0\nf 1 2 -1\n";
  write_file_atomically(flat, many);
  EXPECT_TRUE(refused(world_text(model(moves, "collision", flat)), "may have at most 50000"));
  // Visuals collide if no collision is given.
  EXPECT_TRUE(refused(world_text(model(moves, "visual", flat)), "or give the model a <collision>"));
}

TEST(Limits, ACellWhoseParticlesAreTooHeavyIsRefused) {
  EXPECT_TRUE(refused(world_text("<navvy:solver><cell_m>1.5</cell_m></navvy:solver>"),
                      "would weigh more than 128 kg"));
}

TEST(Limits, NamesThatWouldBreakAHeaderAreRefused) {
  EXPECT_TRUE(refused(world_text("<model name=\"a,b\"/>"), "no comma"));
  EXPECT_TRUE(refused(world_text("<model name=\"a&#10;b\"/>"), "'a b': a name must hold no comma"));
  EXPECT_TRUE(refused(world_text("<model name='a\"b'/>"), "no quote"));
  EXPECT_TRUE(refused(world_text("<include><uri>model://ew180</uri><name>a,b</name></include>"),
                      "no comma"));
  EXPECT_TRUE(refused(world_text("<navvy:camera name=\"a,b\"/>"), "no comma"));
  EXPECT_TRUE(
      refused(world_text("<model name=\"m\"><navvy:shell name=\"a,b\"/></model>"), "no comma"));
}

TEST(Limits, RefusesInvalidUtf8WithItsLine) {
  EXPECT_TRUE(refused(world_text("\n<model name=\"caf\xE9\"/>"),
                      "mine.sdf:3: error: the file must be text in UTF-8"));
  EXPECT_TRUE(refused(world_text("<!-- caf\xE9 -->"), "UTF-8"));
  EXPECT_TRUE(refused(world_text("<model name=\"a&#xD800;\"/>"), "none of Unicode's"));
  EXPECT_FALSE(read(world_text("<!-- café -->")).has_errors());
  Overrides overrides;
  overrides.set.push_back({"soil.name\xFF", "1"});
  EXPECT_THROW(load_scene_from_string(world_text(""), "x.sdf", control::step_kinds(), overrides),
               InputError);
}

TEST(Limits, RefusesPipesAndDevicesByNameForEveryPath) {
  const test::Folder folder;
  const std::string pipe = folder / "pipe.sdf", mesh = folder / "pipe.obj";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ASSERT_EQ(::mkfifo(mesh.c_str(), 0600), 0);
  const auto faults = check(pipe, control::step_kinds());
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].text().find("it is a pipe"), std::string::npos) << faults[0].text();
  EXPECT_NE(check("/dev/zero", control::step_kinds())[0].text().find("it is a device"),
            std::string::npos);
  EXPECT_THROW(load_machine(pipe), InputError);
  EXPECT_THROW(load_soils(folder.path().string()), InputError);
  EXPECT_TRUE(refused(world_text("<include><uri>" + pipe + "</uri></include>"), "no such model"));
  EXPECT_TRUE(refused(
      world_text(
          "<model name=\"m\"><static>1</static><link name=\"l\"><visual name=\"v\"><geometry>"
          "<mesh><uri>" +
          mesh + "</uri></mesh></geometry></visual></link></model>"),
      "pipe.obj': it is a pipe, a plain file is needed"));
  EXPECT_TRUE(refused(world_text("<navvy:soil ref=\"" + pipe + "\"/>"), "no such soil"));
  for (const char* ending : {"xml", "npy", "tif"}) {
    const std::string design = folder / "pipe." + ending;
    ASSERT_EQ(::mkfifo(design.c_str(), 0600), 0);
    EXPECT_TRUE(refused(world_text("<navvy:design><file>" + design + "</file></navvy:design>"),
                        "it is a pipe"));
  }
  // A file list written by a run and edited by hand.
  Faults listed;
  const auto document =
      Document::parse(world_text("<navvy:resolved format=\"1\"><file hash=\"0\">" + mesh +
                                 "</file></navvy:resolved>"),
                      "x.sdf", listed);
  EXPECT_NO_THROW(load_scene_from_string(document->text(), "x.sdf", control::step_kinds()));
}

}  // namespace
}  // namespace navvy::scene_io
