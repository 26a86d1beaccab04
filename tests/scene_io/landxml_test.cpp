// SPDX-License-Identifier: Apache-2.0
#include "scene_io/landxml.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "control/step_kinds.h"
#include "core/file.h"
#include "folder.h"
#include "scene_io/loader.h"

namespace navvy::scene_io {
namespace {

/// Returns a file of one surface; `points` and `faces` begin on lines 8 and 10.
std::string landxml(const std::string& units, const std::string& points, const std::string& faces,
                    const std::string& kind = "TIN") {
  return R"(<?xml version="1.0"?>
<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" version="1.2" date="2026-01-01" time="00:00:00">
)" + units +
         R"(
<CoordinateSystem epsgCode="25832"/>
<Surfaces>
<Surface name="pit"><Definition surfType=")" +
         kind + "\">\n<Pnts>\n" + points + "\n</Pnts><Faces>\n" + faces +
         "\n</Faces></Definition></Surface>\n</Surfaces>\n</LandXML>\n";
}

const std::string kMetres = "<Units><Metric linearUnit=\"meter\"/></Units>";
const std::string kFour =
    "<P id=\"1\">100 10 5</P><P id=\"2\">100 20 5</P>\n<P id=\"7\">130 20 6.5</P><P id=\"9\">130 "
    "10 6</P>";
const std::string kFaces = "<F>1 2 7</F>\n<F i=\"1\">1 7 9</F>";

struct Read {
  std::shared_ptr<const scene::Tin> tin;
  std::string faults;
};

Read read(const std::string& text, const std::string& surface = "") {
  const test::Folder folder;
  write_file_atomically(folder / "pit.xml", text);
  Faults faults;
  Read out{read_landxml(folder / "pit.xml", surface, faults), ""};
  for (const Fault& fault : faults.list()) out.faults += fault.text() + "\n";
  return out;
}

TEST(LandXml, IsReadAsEastingNorthingElevationWithoutInvisibleFaces) {
  const Read out = read(landxml(kMetres, kFour, kFaces));
  ASSERT_TRUE(out.tin) << out.faults;
  EXPECT_EQ(out.faults, "");
  EXPECT_EQ(out.tin->name, "pit");
  EXPECT_EQ(out.tin->epsg, 25832);
  ASSERT_EQ(out.tin->points.size(), 4u);
  EXPECT_EQ(out.tin->points[2], Vec3(20, 130, 6.5));
  ASSERT_EQ(out.tin->faces.size(), 1u);
  EXPECT_EQ(out.tin->faces[0], (std::array<int, 3>{0, 1, 2}));
}

TEST(LandXml, ConvertsItsUnitToMetres) {
  const auto easting = [](const std::string& units) {
    const Read out = read(landxml("<Units>" + units + "</Units>", kFour, kFaces));
    return out.tin ? out.tin->points[2].x() : -1;
  };
  EXPECT_DOUBLE_EQ(easting("<Imperial linearUnit=\"foot\"/>"), 20 * 0.3048);
  EXPECT_DOUBLE_EQ(easting("<Imperial linearUnit=\"USSurveyFoot\"/>"), 20 * 1200.0 / 3937);
  EXPECT_EQ(
      read(landxml("<Units><Imperial linearUnit=\"foot\"/></Units>", kFour, kFaces)).tin->metres,
      0.3048);
  EXPECT_DOUBLE_EQ(easting("<Metric linearUnit=\"millimeter\"/>"), 0.02);
}

TEST(LandXml, IsRefusedWithFileLineValueAndRemedy) {
  const auto expect = [](const Read& out, const std::vector<std::string>& parts) {
    EXPECT_FALSE(out.tin);
    for (const std::string& part : parts)
      EXPECT_NE(out.faults.find(part), std::string::npos) << part << " in: " << out.faults;
  };
  expect(read(landxml("", kFour, kFaces)), {"pit.xml:2", "no unit", "linearUnit=\"meter\""});
  expect(read(landxml("<Units><Metric/></Units>", kFour, kFaces)),
         {"pit.xml:3", "Metric", "no unit"});
  expect(read(landxml("<Units><Imperial linearUnit=\"feet\"/></Units>", kFour, kFaces)),
         {"'feet'", "foot"});
  expect(read(landxml(kMetres, kFour, "<F>1 2 8</F>")),
         {"pit.xml:11", "F", "'8'", "no point of this id"});
  expect(read(landxml(kMetres, kFour, "<F>1 2</F>")), {"'1 2'", "three points"});
  expect(read(landxml(kMetres, kFour, "<F i=\"1\">1 2 7</F>")), {"no visible face"});
  expect(read(landxml(kMetres, kFour + "<P id=\"2\">1 2 3</P>", kFaces)),
         {"pit.xml:9", "'2'", "id of its own"});
  expect(read(landxml(kMetres, kFour + "<P>1 2 3</P>", kFaces)), {"id of its own"});
  expect(read(landxml(kMetres, kFour + "<P id=\"3\">1 2</P>", kFaces)),
         {"'1 2'", "northing easting elevation"});
  expect(read(landxml(kMetres, kFour + "<P id=\"3\">1 nan 2</P>", kFaces)), {"'1 nan 2'"});
  expect(read(landxml(kMetres, kFour, kFaces, "grid")), {"'grid'", "no TIN"});
  expect(read(landxml(kMetres, kFour, kFaces), "pitt"), {"'pitt'", "pit"});
  expect(read("<Other/>"), {"'Other'", "<LandXML>"});
  expect(read("<LandXML><"), {"no sound XML"});
  expect(read(""), {"is empty"});
}

TEST(LandXml, ReportsAFaultyPointOnceAndNotByItsFaces) {
  const std::string face = "<F>1 2 3</F><F>1 2 4</F>";
  const auto faults = [&](const std::string& point, const std::string& faces) {
    return read(landxml(kMetres, kFour + point, faces)).faults;
  };
  const auto lines = [](const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
  };
  // Only the second of points 3 and 4 has no place.
  const std::string bad = faults("<P id=\"3\">1 2</P>", face);
  EXPECT_EQ(lines(bad), 2) << bad;
  EXPECT_NE(bad.find("'1 2'"), std::string::npos) << bad;
  EXPECT_EQ(bad.find("'3'"), std::string::npos) << bad;
  EXPECT_NE(bad.find("'4'"), std::string::npos) << bad;
  // Any of the points may be the one with the missing id.
  EXPECT_EQ(lines(faults("<P>1 2 3</P>", face)), 1) << faults("<P>1 2 3</P>", face);
  EXPECT_EQ(lines(faults("<P id=\"2\">1 2</P>", "<F>1 2 7</F>")), 1);
}

TEST(Design, OfASceneIsReadFromLandXmlInItsFolder) {
  const test::Folder folder;
  write_file_atomically(folder / "pit.xml", landxml(kMetres, kFour, kFaces));
  const auto load = [&](const std::string& design) {
    write_file_atomically(
        folder / "s.sdf",
        "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\"><navvy:soil ref=\"loam\"/>"
        "<navvy:ground><size_m>20 20</size_m></navvy:ground><navvy:design>" +
            design + "</navvy:design></world></sdf>");
    std::string resolved;
    const scene::Scene scene = load_scene(folder / "s.sdf", control::step_kinds(), {}, &resolved);
    // In the resolved scene it is found from any folder and identified by its hash.
    if (!scene.design.file.empty())
      EXPECT_NE(resolved.find("<file>" + (folder / "pit.xml") + "</file>"), std::string::npos);
    return scene.design;
  };
  const scene::Design tin = load("<file>pit.xml</file><surface>pit</surface>");
  ASSERT_TRUE(tin.tin);
  EXPECT_EQ(tin.tin->faces.size(), 1u);
  const scene::Design area = load(
      "<area><polygon_m>0 0 4 0 4 2</polygon_m><depth_m>1.5</depth_m><fall_deg>2</fall_deg>"
      "<fall_yaw_deg>90</fall_yaw_deg><batter_deg>45</batter_deg></area>");
  ASSERT_EQ(area.areas.size(), 1u);
  EXPECT_EQ(area.areas[0].polygon[2], Vec2(4, 2));
  EXPECT_DOUBLE_EQ(area.areas[0].batter, radians(45));
  EXPECT_EQ(area.areas[0].depth, 1.5);
}

}  // namespace
}  // namespace navvy::scene_io
