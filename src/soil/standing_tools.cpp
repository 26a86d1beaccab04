// SPDX-License-Identifier: Apache-2.0
#include "soil/standing_tools.h"

#include <algorithm>
#include <cmath>

#include "core/archive.h"
#include "soil/exchange/exchange_index.h"

namespace navvy::soil {
namespace {

/// Height over a tool's lowest point, along the ground's normal, above which soil lies on the tool
/// [cells]. Columns under the tool end below it, or their soil would be inside it later.
constexpr double kSoilOver = 0.5;

/// Height over a tool's lowest point, along the normal, up to which a vertex belongs to its lower
/// side [cells].
constexpr double kLowerSide = 1;

/// Returns whether the point lies in the region's box as seen from above.
bool in_plan(const ToolRegion& region, const Vec3& p_W) {
  const auto at = p_W.head<2>().array();
  return (at >= region.min.head<2>().array()).all() && (at <= region.max.head<2>().array()).all();
}

}  // namespace

// Gradient of the plane that fits columns and the soil on them best in a rectangle of the plan.
Vec2 StandingTools::ground_gradient(const Vec2& from, const Vec2& to,
                                    std::span<const Particle> all) const {
  // At least three columns each way: fewer define no plane.
  Vec2i low = ground_.column_at(from.x(), from.y()), high = ground_.column_at(to.x(), to.y());
  for (int a = 0; a < 2; ++a)
    if (high[a] - low[a] < 2) --low[a], ++high[a];
  const heightfield::CellRect rect =
      heightfield::CellRect{low.x(), low.y(), high.x() + 1, high.y() + 1}.cut(ground_.site_rect());
  // Only particles near the tool are indexed.
  std::vector<Particle> near;
  for (const Particle& p : all) {
    const Vec3 at = frame_.position(p);
    const Vec2i column = ground_.column_at(at.x(), at.y());
    if (rect.contains(column.x(), column.y())) near.push_back(p);
  }
  const ColumnIndex index(near, ground_, frame_.grid);
  // On a lattice about its middle the two slopes of the best plane are independent sums.
  const Vec2 middle(0.5 * (rect.x0 + rect.x1 - 1), 0.5 * (rect.y0 + rect.y1 - 1));
  Vec2 moment = Vec2::Zero(), square = Vec2::Zero();
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      const Vec2 arm = Vec2(ix, iy) - middle;
      moment += (ground_.height(ix, iy) / frame_.cell + index.pile_height(ix, iy)) * arm;
      square += arm.cwiseAbs2();
    }
  return {square.x() > 0 ? moment.x() / square.x() : 0,
          square.y() > 0 ? moment.y() / square.y() : 0};
}

// Normal of the ground under a tool: columns, and what lies on them.
Vec3 StandingTools::ground_normal(const scene::Shell& shell, const ToolMotion& motion,
                                  const ToolRegion& region, std::span<const Particle> all) const {
  const double across = (region.max - region.min).head<2>().maxCoeff();
  const Vec2 from = region.min.head<2>(), to = region.max.head<2>();
  const Vec3 first = normal_under(ground_gradient(from, to, all), across, frame_.cell);
  if (first == Vec3::UnitZ()) return first;
  // On a slope a tool overhangs ground that it does not stand on: only its lower side counts.
  double lowest = HUGE_VAL;
  for (const Vec3& v : shell.vertices) lowest = std::min(lowest, first.dot(motion.X_WT * v));
  Vec2 low = to, high = from;
  for (const Vec3& v : shell.vertices) {
    const Vec3 p = motion.X_WT * v;
    if (first.dot(p) > lowest + kLowerSide * frame_.cell) continue;
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  return normal_under(ground_gradient(low, high, all), across, frame_.cell);
}

bool StandingTools::soil_on_tool(const scene::Shell& shell, const ToolMotion& motion,
                                 const Vec3& up, std::span<const Particle> all) const {
  // The box of the tool as seen along the normal: on level ground its box in W.
  const std::array<Vec3, 2> along = along_ground(up);
  const auto seen = [&](const Vec3& p) {
    return Vec3(along[0].dot(p), along[1].dot(p), up.dot(p));
  };
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const Vec3& v : shell.vertices) {
    low = low.cwiseMin(seen(motion.X_WT * v));
    high = high.cwiseMax(seen(motion.X_WT * v));
  }
  return std::any_of(all.begin(), all.end(), [&](const Particle& p) {
    const Vec3 at = seen(frame_.position(p));
    return at.z() > low.z() + kSoilOver * frame_.cell && at.x() >= low.x() && at.x() <= high.x() &&
           at.y() >= low.y() && at.y() <= high.y();
  });
}

void StandingTools::update(double elapsed, std::span<const ToolMotion> motions,
                           std::span<const ToolRegion> regions, std::span<const Particle> all) {
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const ToolMotion& motion = motions[m];
    RestingContact& contact = contacts_[static_cast<std::size_t>(motion.tool)];
    // A scripted tool needs no support.
    if (motion.inverse_mass.isZero(0)) continue;
    const scene::Shell& shell = nodal_contact_.geometry(motion.tool).shell();
    const Vec3 &force = nodal_contact_.force(motion.tool),
               &moment = nodal_contact_.moment(motion.tool);
    if (!contact.engaged && !contact.has_settled(shell, motion, elapsed, force)) continue;
    const Vec3 up = contact.engaged ? contact.up : ground_normal(shell, motion, regions[m], all);
    if (soil_on_tool(shell, motion, up, all)) {
      // The particles on it now determine its load.
      contact.release();
      continue;
    }
    const Vec2i at =
        ground_.column_at(motion.X_WT.translation().x(), motion.X_WT.translation().y());
    if (contact.engaged || !ground_.contains(at.x(), at.y())) continue;
    const double angle = world_.soils[ground_.surface_soil(at.x(), at.y())].tool_friction_angle;
    // Friction of the column under the tool's origin, reduced by the shell's own share.
    contact.start(shell, motion, force, moment, shell.friction_share * std::tan(angle), frame_.cell,
                  up);
  }
}

void StandingTools::release(std::span<const ToolRegion> regions, std::span<const Particle> born) {
  for (const ToolRegion& region : regions)
    if (region.supported && std::any_of(born.begin(), born.end(), [&](const Particle& p) {
          return in_plan(region, frame_.position(p));
        }))
      contacts_[static_cast<std::size_t>(region.tool)].release();
}

bool StandingTools::apply(double dt, std::span<const ToolMotion> motions,
                          std::span<ToolImpulse> impulses) {
  bool ended = false;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const scene::Shell& shell = nodal_contact_.geometry(motions[m].tool).shell();
    RestingContact& contact = contacts_[static_cast<std::size_t>(motions[m].tool)];
    ended |= contact.apply(shell, motions[m], dt, frame_.cell, impulses[m]);
  }
  return ended;
}

void StandingTools::visit(Archive& a) { a.fixed("contacts", contacts_); }

}  // namespace navvy::soil
