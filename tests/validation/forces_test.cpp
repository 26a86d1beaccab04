// SPDX-License-Identifier: Apache-2.0
// Forces come from the soil: the scoop of bucket_path.sdf compared with the wedge, with other
// soils, and without soil.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lab/theory/formulas.h"
#include "validation/report.h"
#include "validation/scenes.h"
#include "values.h"

namespace navvy::validation {
namespace {

constexpr const char* kSource = "forces come from the soil [docs/validation.md, Whole digs]";
// Times of the path [s]: dragged level at 0.3 m of depth; then curled; lifted clear.
constexpr double kDragStart = 2.0, kDragEnd = 3.6, kLifted = 7.0;
constexpr double kDepth = 0.3;
// Half of the loam's 1540.
const char* const kHalfDensity = "soil.bank_density_kg_per_m3=770";

/// Forces on the bucket along the path.
struct Scooped {
  /// Mean resistance during the level drag, and the part of it on the edges of plates [N].
  double drag = 0, edges = 0;
  double most = 0;     ///< largest |force| of a step [N]
  double payload = 0;  ///< at the end [kg]
};

Scooped scoop(const std::vector<std::string>& settings, double until) {
  session::Session session(load_scene("bucket_path.sdf", settings), shared_device());
  Scooped out;
  double steps = 0;
  while (session.world().time() < until) {
    session.step();
    const sim::ToolHandle tool = session.world().machines().tools().at(0);
    const Vec3 force = tool.force();
    out.most = std::max(out.most, force.norm());
    if (session.world().time() < kDragStart || session.world().time() > kDragEnd) continue;
    out.drag -= force.x();
    out.edges -= tool.edge_force().x();
    steps += 1;
  }
  out.drag /= std::max(steps, 1.0);
  out.edges /= std::max(steps, 1.0);
  out.payload = session.world().machines().tools().at(0).payload();
  return out;
}

/// Resistance along the path of a blade like the bucket's floor: 70 to 62 degrees of curl incline
/// it by 17 to 25 degrees.
double wedge(const scene::Scene& world) {
  const scene::Soil& soil = world.soils.at(0);
  lab::BladeCase blade;
  blade.phi = soil.friction_angle;
  blade.delta = soil.tool_friction_angle;
  blade.rake = radians(21);
  blade.depth = kDepth;
  blade.width = world.machines.at(0).machine.buckets.at(0).width;
  blade.unit_weight = soil.bank_density * kGravity;
  blade.cohesion = soil.cohesion;
  return lab::mckyes_ali(blade).horizontal;
}

TEST(ScoopForce, MatchesTheWedgeWithinAFactorOfTwo) {
  const Scooped loam = scoop({}, kLifted);
  const double expected = wedge(load_scene("bucket_path.sdf"));
  // The theory's blade is sharp: what the edges of floor, sides and teeth meet is no part of it.
  print_value("resistance of edges / drag", loam.edges / loam.drag, "no tolerance", kSource);
  expect_between("drag on the faces / McKyes and Ali", (loam.drag - loam.edges) / expected, 0.5, 2,
                 "[McKyes 1977] [docs/validation.md, Whole digs]");
  // Half the bank density with all else equal. Its cohesion then holds twice the height, so it
  // heaps higher.
  const Scooped light = scoop({kHalfDensity}, kLifted);
  expect_between("payload at half the density / payload, loam", light.payload / loam.payload, 0.45,
                 0.55, kSource);
}

TEST(ScoopForce, LoadsTheBucketInProportionToTheDensityOfSand) {
  const std::vector<std::string> sand = {"soil.cohesion_pa=0", "soil.residual_cohesion_pa=0"};
  std::vector<std::string> light = sand;
  light.push_back(kHalfDensity);
  expect_between("payload at half the density / payload, c = 0",
                 scoop(light, kLifted).payload / scoop(sand, kLifted).payload, 0.45, 0.55, kSource);
}

TEST(ScoopForce, GrowsWithTheCohesion) {
  const Scooped weak = scoop({}, kDragEnd);
  const Scooped strong =
      scoop({"soil.cohesion_pa=24000", "soil.residual_cohesion_pa=6000"}, kDragEnd);
  // The wedge's cohesive part is 2/3 of the force: 4 x c makes it 3 x. Softening and the load
  // reduce that.
  expect_between("drag at 4 c / drag", strong.drag / weak.drag, 1.2, 4, kSource);
}

TEST(ScoopForce, IsExactlyZeroWithoutSoil) {
  // The same path 3 m above the ground.
  const Scooped air = scoop({"ground.surface_m=-3"}, kLifted);
  expect_between("largest force in the air [N]", air.most, 0, 0, kSource);
  expect_between("payload in the air [kg]", air.payload, 0, 0, kSource);
}

/// Returns the mean upward force on the bucket over 0.2 s before `until` [N].
double support(session::Session& session, double until) {
  run_to(session, until - 0.2);
  double sum = 0, steps = 0;
  for (; session.world().time() < until; ++steps) {
    session.step();
    sum += session.world().machines().tools().at(0).force().z();
  }
  return sum / steps;
}

TEST(PressedBucket, IsSupportedByItsSoilWhileItIsHeld) {
  session::Session session(load_scene("pressed_bucket.sdf", {}, "tests/validation/digs"),
                           shared_device());
  // It stops at 0.9 s; the excess from fast pressing vanishes soon after.
  const double stopped = support(session, 1.4), later = support(session, 4.9);
  print_value("pressed bucket: supporting force half a second after it stopped [N]", stopped,
              "no tolerance", kSource);
  expect_between("pressed bucket: force after 4 s / after 0.5 s", later / stopped, 0.9, 1.02,
                 "soil at rest stays at rest [docs/tools.md, stand-off]");
}

}  // namespace
}  // namespace navvy::validation
