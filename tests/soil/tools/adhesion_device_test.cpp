// SPDX-License-Identifier: Apache-2.0
// Adhesion of soil on tools: comparison of the kernel with its double twin, and of a plate that
// slides on soil with the closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lab/rig_shapes.h"
#include "soil/host_law/double_contact.h"
#include "soil/reference/impulse_on.h"
#include "soil/reference/reference_solver.h"
#include "soil/rig.h"
#include "soil/tools/contact.h"

namespace navvy::soil {
namespace {

using rig::Rig;
using rig::SiteBox;

constexpr double kDt = 1.6e-3;

scene::Soil sticky(double adhesion, double delta_degrees) {
  scene::Soil soil = rig::sand(30);
  soil.cohesion = soil.residual_cohesion = 20e3;
  soil.adhesion = adhesion;
  soil.tool_friction_angle = radians(delta_degrees);
  return soil;
}

using lab::plate;

/// Returns the contact's lengths and speeds of the scheme for the twin, as Contact::solve gives
/// them to the kernels.
reference::Reach reach_of(double cell) {
  const SchemeConstants s;
  const double speed = std::sqrt(kGravity * cell);
  return {s.contact_reach,
          s.contact_ramp,
          s.contact_edge,
          s.contact_edge_ramp,
          kDt * cell * cell,
          s.contact_opening * speed,
          s.contact_settling * speed,
          s.contact_falling * speed,
          s.edge_slow * speed,
          0,
          0,
          -1};
}

TEST(Adhesion, KernelGivesTheImpulsesOfItsDoubleTwin) {
  // A block flies onto a wide plate, slides and sticks; all soil is in front, no free edge is near.
  const scene::Soil soil = sticky(2000, 20);
  Rig rig({soil});
  const double plate_z = 1.03, cell = rig.cell();
  ToolMotion motion;
  motion.tool = rig.solver().add_tool(plate(3, 3));
  motion.X_WT = make_pose(10, 10, plate_z);
  auto block = rig.fill({Vec3(9.7, 9.7, 1.05), Vec3(10.3, 10.3, 1.55)});
  for (std::size_t i = 0; i < block.size(); ++i) {
    block[i].v[0] = 0.2f + 0.3f * static_cast<float>(i % 7);
    block[i].v[2] = -0.5f;
  }
  rig.solver().insert(block);
  block = rig.solver().particles();

  reference::ReferenceSolver twin({soil}, cell, Vec3(0, 0, -kGravity),
                                  [](int, int) { return -10.0; });
  for (const Particle& p : block) twin.points.push_back(reference::from_particle(p));
  const reference::Reach reach = reach_of(cell);
  const double factor = plate_area_factor(ShellGeometry(plate(3, 3), cell), cell);
  Vec3 on_soil = Vec3::Zero();
  twin.contact = [&](const std::array<int, 3>& at, double mass, const Vec3& v) {
    const double clearance = at[2] - (plate_z - rig.ground().datum() + 0.015) / cell, inset = 10;
    reference::ContactNode node{v, Vec3::Zero(), Vec3::UnitZ(), mass, 0, 0, 0, 0, 0, 0};
    node.mu = std::tan(soil.tool_friction_angle);
    node.share = reference::contact_share(clearance, inset, &reach);
    if (!(node.share > 0)) return Vec3(Vec3::Zero());
    const double fill =
        mass / (soil.bank_density * cell * cell * cell * reference::free_fraction_above(clearance));
    node.settling = reference::contact_settling(clearance, fill, -node.n.z(), &reach);
    const double area =
        factor * reference::contact_touch(fill) * reference::contact_area(clearance, inset, &reach);
    node.stick = reference::contact_stick(soil.adhesion, area, &reach);
    const Vec3 j = reference::impulse_on(node, reach.opening);
    on_soil += j;
    return j;
  };
  twin.step(kDt);
  ToolImpulse impulse;
  rig.solver().step(kDt, std::span(&motion, 1), std::span(&impulse, 1));
  print_value("impulse along the plate, kernel / twin", impulse.J_W.x() / -on_soil.x(), "1 +-1e-4",
              "double twin");
  // Float sums of some hundred nodes; a node between sticking and sliding does not change the
  // force.
  EXPECT_NEAR(impulse.J_W.x(), -on_soil.x(), 1e-4 * on_soil.norm());
  EXPECT_NEAR(impulse.J_W.z(), -on_soil.z(), 1e-4 * on_soil.norm());
  const auto after = rig.solver().particles();
  double worst = 0;
  for (std::size_t i = 0; i < after.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      worst =
          std::max(worst, std::abs(static_cast<double>(after[i].v[axis]) - twin.points[i].v[axis]));
  // [m/s], float rounding of speeds of 2 m/s.
  EXPECT_LT(worst, 1e-5);
}

struct Slid {
  /// Mean forces on the plate [N].
  double shear = 0, push = 0;
  double residual = 0;
};

/// Slides a plate of 0.8 x 0.6 m at 0.3 m/s over a bed under `pressure` [Pa].
Slid slide(const scene::Soil& soil, double pressure, double share = 1) {
  const SiteBox bed{Vec3(9, 9.2, -0.5), Vec3(11.4, 10.8, 0)};
  Rig rig({soil}, bed);
  scene::Shell shell = plate(0.8, 0.6);
  shell.friction_share = shell.adhesion_share = share;
  ToolMotion motion;
  motion.tool = rig.solver().add_tool(shell);
  motion.X_WT = make_pose(9.7, 10.01, 0.017);
  rig.solver().insert(rig.fill(bed, true));
  // Free in height, driven along.
  const double mass = pressure * 0.48 / kGravity;
  motion.inverse_mass(5, 5) = 1 / mass;
  Slid out;
  const int steps = 600, from = 300;
  for (int i = 0; i < steps; ++i) {
    ToolImpulse impulse;
    motion.v_WT.x() = 0.3;
    motion.v_WT.z() -= kGravity * kDt;
    rig.solver().step(kDt, std::span(&motion, 1), std::span(&impulse, 1));
    motion.v_WT.z() += impulse.J_W.z() / mass;
    motion.X_WT.translation() += kDt * motion.v_WT;
    if (impulse.scale > 0)
      out.residual = std::max(out.residual, impulse.residual.norm() / impulse.scale);
    if (i < from) continue;
    out.shear -= impulse.J_W.x() / (kDt * (steps - from));
    out.push += impulse.J_W.z() / (kDt * (steps - from));
  }
  return out;
}

TEST(Adhesion, APlateSlidOnSoilFeelsAdhesionTimesAreaPlusCoulomb) {
  struct Case {
    double adhesion, delta, pressure;
  };
  for (const Case& c :
       {Case{1000, 0, 2000}, Case{1000, 20, 2000}, Case{3000, 20, 2000}, Case{1000, 20, 500}}) {
    const Slid slid = slide(sticky(c.adhesion, c.delta), c.pressure);
    const double expected = c.adhesion * 0.48 + std::tan(radians(c.delta)) * slid.push;
    print_value("plate on soil, a " + std::to_string(c.adhesion) + " Pa, delta " +
                    std::to_string(c.delta) + ", pressure " + std::to_string(c.pressure) +
                    ", shear",
                slid.shear, std::to_string(expected) + " N +-5 %", "a A + N tan delta");
    // 5 %: the last rows of nodes at the plate's edges come and go as it slides.
    EXPECT_NEAR(slid.shear / expected, 1, 0.05);
    EXPECT_NEAR(slid.push / (c.pressure * 0.48), 1, 0.05);
    EXPECT_LT(slid.residual, 1e-5);
  }
}

TEST(Adhesion, ASmoothPlateFeelsNoShear) {
  const Slid slid = slide(sticky(3000, 20), 2000, 0);
  EXPECT_LT(std::abs(slid.shear), 1e-3 * slid.push);
}

}  // namespace
}  // namespace navvy::soil
