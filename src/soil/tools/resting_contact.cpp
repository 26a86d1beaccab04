// SPDX-License-Identifier: Apache-2.0
#include "soil/tools/resting_contact.h"

#include <algorithm>
#include <cmath>

#include "core/archive.h"
#include "core/limits.h"

namespace navvy::soil {
namespace {

/// A tool stands while no corner of its shell is faster [m/s], for so long [s].
constexpr double kStill = 1e-3, kStillTime = 0.8;
/// Feet lie no higher than this over the lowest, along the ground's normal [cells]: what stands
/// higher stands on other ground.
constexpr double kLevel = 0.25;
/// The same on a slope, where the lower edge bears more and sinks deeper; no more than contact
/// reaches.
constexpr double kSloping = 0.5;  // tuned: Seat.ABodyOnASlopeBelowItsFrictionAngleStandsOnColumns
/// A seat is left when a corner has moved by this share of a cell (columns that come back may lift
/// a body that has collision shapes besides), and under this much more than what it bore: more is
/// asked of the ground than it has shown.
constexpr double kMoved = 0.25, kOverload = 1.25;
constexpr double kLoadTime = 0.1;  ///< loads are means over about this time [s]
constexpr double kPressOut = 0.1;  ///< share of a sinking that is pressed out in a step,
constexpr double kSlowly = 0.01;   ///< no faster than [m/s]
constexpr int kSweeps = 60;        ///< of the rows, eight feet at most
constexpr double kUnborne = 0.01;  ///< share of the soil's wrench that feet need not give

struct Row {
  Vec6 direction, change;  ///< of a unit impulse: its wrench, and the change of twist
  double yields = 0;       ///< speed along it
  double impulse = 0;
};

Row row_of(const Vec3& arm, const Vec3& along, const Mat6& inverse_mass) {
  Row out;
  out.direction << arm.cross(along), along;
  out.change = inverse_mass * out.direction;
  out.yields = out.direction.dot(out.change);
  return out;
}

/// Adds impulse so that the row's speed becomes `wanted`, within bounds.
void solve(Row& row, Vec6& twist, double wanted, double low, double high) {
  if (!(row.yields > 0)) return;
  const double next =
      std::clamp(row.impulse + (wanted - row.direction.dot(twist)) / row.yields, low, high);
  twist += (next - row.impulse) * row.change;
  row.impulse = next;
}

/// Wrench impulse (moment about the tool's origin, impulse) of feet at `arms` [m] that come `up` by
/// at least `rise` [m/s] each; `twist` is changed by it.
Vec6 stand(const std::vector<Vec3>& arms, const std::vector<double>& rise, const Vec3& up,
           const Mat6& inverse_mass, double friction, Vec6& twist) {
  const std::array<Vec3, 2> along = along_ground(up);
  std::vector<std::array<Row, 3>> rows;
  rows.reserve(arms.size());
  for (const Vec3& arm : arms)
    rows.push_back({row_of(arm, up, inverse_mass), row_of(arm, along[0], inverse_mass),
                    row_of(arm, along[1], inverse_mass)});
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t i = 0; i < rows.size(); ++i) {
      solve(rows[i][0], twist, rise[i], 0, HUGE_VAL);
      const double bound = friction * rows[i][0].impulse;
      for (const std::size_t side : {1U, 2U}) solve(rows[i][side], twist, 0, -bound, bound);
    }
  Vec6 out = Vec6::Zero();
  for (const auto& foot : rows)
    for (const Row& row : foot) out += row.impulse * row.direction;
  return out;
}

/// Speed of the fastest corner under a twist.
double fastest(const scene::Shell& shell, const Pose& X_WT, const Vec6& twist) {
  double out = 0;
  for (const Vec3& v : shell.vertices)
    out = std::max(out, (twist.tail<3>() + twist.head<3>().cross(X_WT.linear() * v)).norm());
  return out;
}

/// The farthest that a corner is from where it would be at another pose [m].
double farthest(const scene::Shell& shell, const Pose& X, const Pose& other) {
  double out = 0;
  for (const Vec3& v : shell.vertices) out = std::max(out, (X * v - other * v).norm());
  return out;
}

std::vector<Vec3> arms_of(const std::vector<Vec3>& feet, const Pose& X_WT) {
  std::vector<Vec3> out;
  out.reserve(feet.size());
  for (const Vec3& foot : feet) out.push_back(X_WT.linear() * foot);
  return out;
}

}  // namespace

std::array<Vec3, 2> along_ground(const Vec3& up) {
  const Vec2 falls = up.head<2>();
  if (falls.isZero(0)) return {Vec3::UnitX(), Vec3::UnitY()};
  const Vec3 across = Vec3(-falls.y(), falls.x(), 0).normalized();
  return {across.cross(up), across};
}

std::vector<Vec3> feet(const scene::Shell& shell, const Pose& X_WT, double cell, const Vec3& up) {
  const std::array<Vec3, 2> along = along_ground(up);
  double lowest = HUGE_VAL;
  for (const Vec3& v : shell.vertices) lowest = std::min(lowest, up.dot(X_WT * v));
  const double highest = lowest + (up == Vec3::UnitZ() ? kLevel : kSloping) * cell;
  std::vector<Vec3> out;
  for (int way = 0; way < 8; ++way) {
    const Vec2 towards(std::cos(way * kPi / 4), std::sin(way * kPi / 4));
    const Vec3* farthest = nullptr;
    for (const Vec3& v : shell.vertices) {
      if (up.dot(X_WT * v) > highest) continue;
      const auto reach = [&](const Vec3& p) {
        const Vec3 arm = X_WT.linear() * p;
        return towards.dot(Vec2(along[0].dot(arm), along[1].dot(arm)));
      };
      if (farthest == nullptr || reach(v) > reach(*farthest)) farthest = &v;
    }
    if (farthest != nullptr && std::find(out.begin(), out.end(), *farthest) == out.end())
      out.push_back(*farthest);
  }
  return out;
}

Vec3 normal_under(const Vec2& gradient, double across, double cell) {
  if (gradient.norm() * across <= kLevel * cell) return Vec3::UnitZ();
  return Vec3(-gradient.x(), -gradient.y(), 1).normalized();
}

bool RestingContact::stands(const scene::Shell& shell, const ToolMotion& motion, double seconds,
                            const Vec3& force) {
  // By the way it went: its velocity is the one before the soil acts, with the weight of a step.
  const bool stands = farthest(shell, motion.X_WT, X_WT) < kStill * seconds && force.z() > 0;
  X_WT = motion.X_WT;
  still = stands ? still + seconds : 0;
  return still >= kStillTime;
}

void RestingContact::take(const scene::Shell& shell, const ToolMotion& motion, const Vec3& force,
                          const Vec3& moment, double tangent, double cell, const Vec3& normal) {
  // The tool as it would go without the soil; its feet must stop that.
  Vec6 wrench;
  wrench << moment, force;
  const Vec6 free = -(motion.inverse_mass * wrench);
  Vec6 twist = free;
  const std::vector<Vec3> arms = arms_of(feet(shell, motion.X_WT, cell, normal), motion.X_WT);
  stand(arms, std::vector<double>(arms.size(), 0.0), normal, motion.inverse_mass, tangent, twist);
  if (!(fastest(shell, motion.X_WT, twist) < kUnborne * fastest(shell, motion.X_WT, free))) return;
  taken = true;
  X_WT = motion.X_WT;
  up = normal;
  bears = load = up.dot(force);
  friction = tangent;
}

bool RestingContact::hold(const scene::Shell& shell, const ToolMotion& motion, double dt,
                          double cell, ToolImpulse& impulse) {
  if (!taken) return false;
  const double moved = farthest(shell, motion.X_WT, X_WT);
  if (moved > kMoved * cell || load > kOverload * bears) {
    let_go();
    return true;
  }
  Vec6 got, twist;
  got << impulse.L_W, impulse.J_W;
  twist << motion.w_WT, motion.v_WT;
  twist += motion.inverse_mass * got;
  const std::vector<Vec3> standing = feet(shell, X_WT, cell, up);
  std::vector<double> rise;
  for (const Vec3& foot : standing) {
    // A foot above its place may come down to it and no farther; one that sank by rounding is
    // pressed out slowly.
    const double above = up.dot(motion.X_WT * foot) - up.dot(X_WT * foot);
    rise.push_back(above > 0 ? -above / dt : std::min(-kPressOut * above / dt, kSlowly));
  }
  const Vec6 given =
      stand(arms_of(standing, motion.X_WT), rise, up, motion.inverse_mass, friction, twist);
  impulse.L_W += given.head<3>();
  impulse.J_W += given.tail<3>();
  load += std::min(1.0, dt / kLoadTime) * (up.dot(impulse.J_W) / dt - load);
  return false;
}

void RestingContact::visit(Archive& a) {
  a("still", still);
  a("taken", taken);
  a("X_WT", X_WT);
  a("up", up);
  a("bears", bears);
  a("load", load);
  a("friction", friction);
  a.require(
      std::isfinite(still + bears + load + friction) && still >= 0 && bears >= 0 && friction >= 0,
      "still", "must be finite and not negative, as must the load that is borne and the friction");
  a.require(std::abs(up.norm() - 1) < 1e-9 && up.z() > 0, "up",
            "must be a direction that leads upward");
  a.require(std::isfinite(X_WT.matrix().sum()) && X_WT.translation().norm() < limits::kFarthest,
            "X_WT", "must be a place on the site");
}

}  // namespace navvy::soil
