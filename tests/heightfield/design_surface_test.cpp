// SPDX-License-Identifier: Apache-2.0
#include "heightfield/design_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/log.h"
#include "heightfield/make_ground.h"
#include "heightfield/maps.h"

namespace navvy::heightfield {
namespace {

using testing::folder;
using testing::write_text;

/// Returns a flat site of 24 m x 20 m in columns of 0.1 m, centred at W (0, 0).
scene::Scene flat() {
  scene::Scene world;
  world.soils.resize(1);
  world.soils[0].name = "loam";
  world.ground.layers = {{"loam", 1}};
  world.ground.size = Vec2(24, 20);
  world.ground.origin = Vec2(-12, -10);
  return world;
}

scene::DesignArea box(double length, double width, double depth, double batter_deg) {
  scene::DesignArea area;
  area.polygon = {{-length / 2, -width / 2},
                  {length / 2, -width / 2},
                  {length / 2, width / 2},
                  {-length / 2, width / 2}};
  area.depth = depth;
  area.batter = radians(batter_deg);
  return area;
}

DesignComparison comparison(const scene::Scene& world) {
  const Ground ground = make_ground(world);
  return against_design(ground, make_design(world, ground).value());
}

std::string message_of(const scene::Scene& world) {
  try {
    make_design(world, make_ground(world));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// Tolerance of volumes compared with closed forms.
constexpr double kShare = 0.005;

TEST(DesignArea, OfAPrismHasItsVolume) {
  scene::Scene world = flat();
  world.design.areas = {box(6, 4, 1.5, 90)};
  const DesignComparison f = comparison(world);
  EXPECT_NEAR(f.design_cut, 36, kShare * 36);
  EXPECT_NEAR(f.under_dig, f.design_cut, 1e-9);
  EXPECT_NEAR(f.area, 24, kShare * 24);
  EXPECT_EQ(f.design_fill, 0);
  EXPECT_EQ(f.over_dig, 0);
  EXPECT_EQ(f.cut, 0);
  // Heights of columns are whole quanta of mass.
  EXPECT_NEAR(f.largest_error, 1.5, 1e-6);
  EXPECT_NEAR(f.mean_error, 1.5, 1e-6);
}

TEST(DesignArea, OfABatteredPitHasTheVolumeOfItsFrustumWithRoundCorners) {
  scene::Scene world = flat();
  world.design.areas = {box(6, 4, 1.5, 45)};
  // Prism, four wedges, and a cone made of the four corners.
  const double volume = 36 + (6 + 4) * 1.5 * 1.5 + kPi * std::pow(1.5, 3) / 3;
  EXPECT_NEAR(comparison(world).design_cut, volume, kShare * volume);
  // A pad is the same shape upside down.
  world.design.areas = {box(6, 4, -1.5, 45)};
  EXPECT_NEAR(comparison(world).design_fill, volume, kShare * volume);
}

TEST(DesignArea, OfAConesFrustumHasItsVolume) {
  scene::Scene world = flat();
  scene::DesignArea area;
  constexpr int kCorners = 256;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * kPi * i / kCorners;
    area.polygon.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle));
  }
  area.depth = 2;
  area.batter = std::atan(0.5);
  world.design.areas = {area};
  const double volume = kPi * 2 / 3 * (0.25 + 0.5 * 4.5 + 4.5 * 4.5);
  EXPECT_NEAR(comparison(world).design_cut, volume, kShare * volume);
}

TEST(DesignArea, FallsAlongItsDirectionAndEndsAtTheGround) {
  scene::Scene world = flat();
  scene::GroundFeature slope;
  slope.angle = std::atan(0.1);
  world.ground.features = {slope};
  world.design.areas = {box(6, 4, 1, 63.434948822922)};  // rises 2 in 1
  world.design.areas[0].fall = std::atan(0.05);
  world.design.areas[0].fall_yaw = kPi / 2;
  const Ground ground = make_ground(world);
  const DesignSurface design = make_design(world, ground).value();
  const auto at = [&](double x, double y) {
    const Vec2i c = ground.column_at(x, y);
    return design.rect.contains(c.x(), c.y()) ? static_cast<double>(design.at(c.x(), c.y())) : NAN;
  };
  // The first corner, (-3, -2), is 1 m below the ground there; from it the floor falls by 5 %
  // towards y.
  const double corner =
      ground.height(ground.column_at(-2.99, -1.99).x(), ground.column_at(-2.99, -1.99).y()) - 1;
  EXPECT_NEAR(at(0.05, -1.95), corner - 0.05 * 0.05, 1e-5);
  EXPECT_NEAR(at(0.05, 1.95), corner - 0.05 * 3.95, 1e-5);
  // Beyond the edge the side rises and ends at the ground.
  EXPECT_NEAR(at(3.25, 0.05), corner - 0.05 * 2.05 + 2 * 0.25, 1e-5);
  EXPECT_TRUE(std::isnan(at(3.85 + 0.3, 0.05)));
  EXPECT_TRUE(std::isnan(at(-3.75, 0.05)));
}

TEST(DesignArea, LaterFloorsReplaceEarlierOnesAndSidesOnlyWhereTheyCutDeeper) {
  scene::Scene world = flat();
  world.design.areas = {box(8, 8, 2, 45), box(4, 4, 1, 45)};
  const Ground ground = make_ground(world);
  const DesignSurface design = make_design(world, ground).value();
  const auto at = [&](double x, double y) {
    const Vec2i c = ground.column_at(x, y);
    return static_cast<double>(design.at(c.x(), c.y()));
  };
  EXPECT_NEAR(at(0.05, 0.05), -1, 1e-5);
  EXPECT_NEAR(at(2.55, 0.05), -2, 1e-5);
}

TEST(Design, ReportsOverAndUnderDigOfADugSite) {
  scene::Scene world = flat();
  world.design.areas = {box(4, 4, 1, 90)};
  Ground ground = make_ground(world);
  const DesignSurface design = make_design(world, ground).value();
  std::vector<SoilLayer> taken;
  // Half of the pit 0.2 m too deep, the other half untouched.
  for (int iy = 80; iy < 120; ++iy)
    for (int ix = 100; ix < 120; ++ix) ground.take_above(ix, iy, -1.2, taken);
  const DesignComparison f = against_design(ground, design);
  EXPECT_NEAR(f.cut, 8 * 1.2, 1e-4);
  EXPECT_NEAR(f.over_dig, 8 * 0.2, 1e-4);
  EXPECT_NEAR(f.under_dig, 8 * 1.0, 1e-4);
  EXPECT_NEAR(f.mean_error, (1 - 0.2) / 2, 1e-5);
  EXPECT_NEAR(f.mean_size, (1 + 0.2) / 2, 1e-5);
  EXPECT_NEAR(f.largest_error, 1, 1e-5);
}

/// Returns a pyramid's frustum: floor 6 x 4, top 10 x 8, 2 m deep, in coordinates of W.
std::shared_ptr<scene::Tin> frustum() {
  auto tin = std::make_shared<scene::Tin>();
  tin->file = "pit.xml";
  tin->name = "pit";
  for (const double r : {0.0, 2.0})
    for (const Vec2& c : {Vec2(-3, -2), Vec2(3, -2), Vec2(3, 2), Vec2(-3, 2)})
      tin->points.emplace_back(c.x() + (c.x() > 0 ? r : -r), c.y() + (c.y() > 0 ? r : -r), r - 2);
  tin->faces = {{0, 1, 2}, {0, 2, 3}};
  for (int i = 0; i < 4; ++i) {
    const int k = (i + 1) % 4;
    tin->faces.push_back({i, 4 + i, 4 + k});
    tin->faces.push_back({i, 4 + k, k});
  }
  return tin;
}

TEST(DesignTin, OfAFrustumHasItsVolume) {
  scene::Scene world = flat();
  world.design.file = "pit.xml";
  world.design.tin = frustum();
  // Prismatoid: 2/6 (floor + 4 middle + top).
  const double volume = 2.0 / 6 * (24 + 4 * 8 * 6 + 80);
  const DesignComparison f = comparison(world);
  EXPECT_NEAR(f.design_cut, volume, kShare * volume);
  EXPECT_NEAR(f.area, 80, kShare * 80);
}

TEST(DesignTin, IsRefusedOffTheSiteAndSwappedAxesAreNamed) {
  scene::Scene world = flat();
  auto tin = frustum();
  for (Vec3& p : tin->points) p += Vec3(200, 0, 0);
  world.design.file = "pit.xml";
  world.design.tin = tin;
  std::string message = message_of(world);
  for (const char* part :
       {"pit.xml", "'pit'", "covers no column", "x 195.000 .. 205.000", "same coordinates"})
    EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
  world.ground.has_origin = true;
  world.ground.origin = Vec2(-12, 190);
  message = message_of(world);
  EXPECT_NE(message.find("northing and easting are swapped"), std::string::npos) << message;
  // At its place, but in millimetres: with or without swapped axes it is on the site.
  world = flat();
  tin = frustum();
  for (Vec3& p : tin->points) p.head<2>() *= 1e-4;
  for (Vec3& p : tin->points) p.head<2>() += Vec2(0.013, 0.013);
  world.design.file = "pit.xml";
  world.design.tin = tin;
  message = message_of(world);
  EXPECT_EQ(message.find("swapped"), std::string::npos) << message;
  EXPECT_NE(message.find("smaller than a column: look at linearUnit"), std::string::npos)
      << message;
}

/// Returns what is logged when the frustum is placed on a site of that CRS and unit, or the text of
/// a refusal.
std::string said_of(const std::string& crs, double site_unit, int epsg, double unit) {
  GroundSetup setup = make_ground(flat()).setup();
  setup.crs_wkt = crs;
  setup.file_unit = site_unit;
  // File coordinates of a real site, in the millions.
  setup.easting = 2000000;
  setup.northing = 500000;
  auto tin = frustum();
  tin->epsg = epsg;
  tin->metres = unit;
  for (Vec3& p : tin->points) p += Vec3(2000000 * site_unit + 12, 500000 * site_unit + 10, 0);
  scene::Scene world = flat();
  world.design.file = "pit.xml";
  world.design.tin = tin;
  std::string out;
  set_log_sink([&](LogLevel, const std::string& line) { out += line + "\n"; });
  try {
    make_design(world, Ground(setup));
  } catch (const InputError& error) {
    out += error.what();
  }
  set_log_sink({});
  return out;
}

const std::string kZone =
    "PROJCRS[\"WGS 84 / UTM zone 32N\",BASEGEOGCRS[\"WGS 84\",ID[\"EPSG\",4326]],CONVERSION[\"UTM "
    "zone 32N\","
    "METHOD[\"Transverse "
    "Mercator\",ID[\"EPSG\",9807]]],CS[Cartesian,2],LENGTHUNIT[\"metre\",1,ID[\"EPSG\",9001]]";
const std::string kOwnCode = kZone + ",ID[\"EPSG\",32632]]";
const std::string kCompound =
    "COMPOUNDCRS[\"zone \"\"[32]\"\" and heights\"," + kOwnCode +
    ",VERTCRS[\"EGM96 height\",CS[vertical,1],ID[\"EPSG\",5773]],ID[\"EPSG\",9999]]";

TEST(DesignTin, OfAnotherCrsIsRefusedEvenInACompoundCrs) {
  for (const std::string& crs : {kOwnCode, kCompound}) {
    const std::string said = said_of(crs, 1, 25832, 1);
    EXPECT_NE(said.find("EPSG:25832"), std::string::npos) << said;
    EXPECT_NE(said.find("the site's map is in EPSG:32632"), std::string::npos) << said;
    EXPECT_EQ(said_of(crs, 1, 32632, 1), "");
  }
  EXPECT_EQ(said_of(kCompound, 1, 9999, 1), "") << "the compound's own code names its plane, too";
  // The code of the CRS, not of its base, method or unit.
  const std::string said = said_of(kZone + "]", 1, 9001, 1);
  EXPECT_EQ(said.find("error"), std::string::npos) << said;
}

TEST(DesignTin, WarnsIfOnlyOneSideHasACode) {
  EXPECT_EQ(said_of("", 1, 0, 1), "");
  EXPECT_NE(said_of("", 1, 25832, 1)
                .find("pit.xml: warning: navvy:design: 'EPSG:25832': the site has no CRS"),
            std::string::npos)
      << said_of("", 1, 25832, 1);
  EXPECT_NE(said_of(kZone + "]", 1, 32632, 1).find("has no EPSG code to compare with"),
            std::string::npos);
  EXPECT_NE(said_of(kCompound, 1, 0, 1).find("<CoordinateSystem epsgCode=\"32632\"/>"),
            std::string::npos);
}

TEST(DesignTin, DistinguishesInternationalFromSurveyFeet) {
  const double survey = 1200.0 / 3937.0;
  // Two millionths of 2.06 million feet.
  const std::string said = said_of("", survey, 0, 0.3048);
  EXPECT_NE(said.find("counts in 0.3048 m, the site's map in 0.3048006096 m"), std::string::npos)
      << said;
  EXPECT_NE(said.find("are 1.3 m apart here"), std::string::npos) << said;
  EXPECT_NE(said_of("", 0.3048, 0, survey).find("correct linearUnit"), std::string::npos);
  EXPECT_EQ(said_of("", survey, 0, survey), "");
  EXPECT_EQ(said_of("", survey, 0, 1), "") << "metres are converted";
}

TEST(DesignArea, OffTheSiteIsRefusedWithItsLine) {
  scene::Scene world = flat();
  world.file = "s.sdf";
  world.design.areas = {box(40, 4, 1, 45)};
  world.design.areas[0].line = 17;
  const std::string message = message_of(world);
  EXPECT_NE(message.find("s.sdf:17"), std::string::npos) << message;
  EXPECT_NE(message.find("first corner"), std::string::npos) << message;
}

#ifdef NAVVY_WITH_GDAL
/// Writes a cone 2 m deep with radius 4 about the middle of a map of 96 x 80 cells; NODATA outside.
std::string cone_map(const std::string& path, const std::string& corner) {
  return write_text(
      path,
      testing::ascii_grid(96, 80, corner + "cellsize 0.1\nNODATA_value -9999\n", [](int c, int r) {
        const double d = std::hypot(0.1 * (c - 47.5), 0.1 * (r - 39.5));
        return d < 4 ? std::to_string(100 - 2 + d / 2) : "-9999";
      }));
}

TEST(DesignRaster, OfAConeHasItsVolumeAndPlaceOnAMap) {
  const std::string dir = folder();
  write_text(dir + "ground.asc",
             testing::ascii_grid(40, 40, "xllcorner 5000\nyllcorner 80000\ncellsize 1\n",
                                 [](int, int) { return "100"; }));
  scene::Scene world = testing::map_world(dir + "ground.asc", 0.1, Vec2(24, 20));
  world.design.file = cone_map(dir + "cone.asc", "xllcorner 5017\nyllcorner 80015\n");
  const Ground ground = make_ground(world);
  const DesignSurface design = make_design(world, ground).value();
  const double volume = kPi * 16 * 2 / 3;
  EXPECT_NEAR(against_design(ground, design).design_cut, volume, kShare * volume);
  // The tip is at 5021.8, 80019, a corner of columns; the site begins at 5008, 80010. Text of six
  // digits.
  EXPECT_NEAR(static_cast<double>(design.at(137, 89)), -2 + std::hypot(0.05, 0.05) / 2, 2e-6);
  EXPECT_NEAR(static_cast<double>(design.at(157, 89)), -2 + std::hypot(1.95, 0.05) / 2, 2e-6);
  EXPECT_NEAR(static_cast<double>(design.at(137, 99)), -2 + std::hypot(0.05, 0.95) / 2, 2e-6);
  // At another place it is refused with both places.
  world.design.file = cone_map(dir + "far.asc", "xllcorner 17\nyllcorner 80015\n");
  const std::string message = message_of(world);
  for (const char* part : {"far.asc", "does not overlap", "x 5008.000", "x 17.000"})
    EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
}

TEST(DesignRaster, OfAnotherCrsOrUnitIsRefused) {
  if (!testing::has_tool("gdal_translate")) GTEST_SKIP() << "gdal_translate (gdal-bin) is missing";
  const std::string dir = folder();
  write_text(dir + "ground.asc",
             testing::ascii_grid(40, 40, "xllcorner 5000\nyllcorner 80000\ncellsize 1\n",
                                 [](int, int) { return "100"; }));
  cone_map(dir + "cone.asc", "xllcorner 5017\nyllcorner 80015\n");
  for (const std::string zone : {"32632", "32633", "2248"})
    for (const std::string map : {"ground", "cone"})
      testing::output_of("gdal_translate -a_srs EPSG:" + zone + " '" + dir + map + ".asc' '" + dir +
                         map + zone + ".tif'");
  const auto message = [&](const std::string& ground, const std::string& design) {
    scene::Scene world = testing::map_world(dir + ground, 0.1, Vec2(8, 8));
    world.ground.has_at = true;
    world.ground.at = Vec2(5021.8, 80019);
    world.design.file = dir + design;
    return message_of(world);
  };
  EXPECT_EQ(message("ground32632.tif", "cone32632.tif"), "");
  EXPECT_EQ(message("ground32632.tif", "cone.asc"), "")
      << "without a CRS that of the site is assumed";
  std::string refused = message("ground32632.tif", "cone32633.tif");
  EXPECT_NE(refused.find("UTM zone 33N"), std::string::npos) << refused;
  EXPECT_NE(refused.find("UTM zone 32N"), std::string::npos) << refused;
  refused = message("ground.asc", "cone32633.tif");
  EXPECT_NE(refused.find("the site has no CRS"), std::string::npos) << refused;
  // Maryland uses US survey feet.
  refused = message("ground2248.tif", "cone.asc");
  EXPECT_NE(refused.find("units of 0.3048006096 m"), std::string::npos) << refused;
}
#endif

}  // namespace
}  // namespace navvy::heightfield
