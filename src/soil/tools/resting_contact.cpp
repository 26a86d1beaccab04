// SPDX-License-Identifier: Apache-2.0
#include "soil/tools/resting_contact.h"

#include <algorithm>
#include <cmath>

#include "core/archive.h"
#include "core/limits.h"

namespace navvy::soil {
namespace {

/// A tool stands while no corner of its shell is faster [m/s], for this long [s].
constexpr double kStill = 1e-3, kStillTime = 0.8;
/// Highest contact vertex above the lowest, along the ground's normal [cells]. Higher vertices
/// stand on other ground.
constexpr double kLevel = 0.25;
/// The same on a slope, where the lower edge carries more load and sinks deeper; no more than
/// contact reaches.
// Tuned by RestingContact.ABodyOnASlopeBelowItsFrictionAngleStandsOnColumns.
constexpr double kSloping = 0.5;
/// The contact ends when a corner has moved by this share of a cell (columns that return may lift a
/// body that has collision shapes, too), or when the load exceeds the initial one by this factor:
/// the ground has not carried more.
constexpr double kMoved = 0.25, kOverload = 1.25;
/// Loads are averaged over about this time [s].
constexpr double kLoadTime = 0.1;
/// Share of a penetration that is corrected in a step.
constexpr double kPressOut = 0.1;
/// Fastest correction [m/s].
constexpr double kSlowly = 0.01;
/// Iterations over the rows, of eight vertices at most.
constexpr int kSweeps = 60;
/// Share of the soil's wrench that the contact need not exert.
constexpr double kUncarried = 0.01;

struct Row {
  /// Wrench of a unit impulse, and its change of twist.
  Vec6 direction, change;
  /// Speed along it per unit impulse.
  double yields = 0;
  double impulse = 0;
};

Row row_of(const Vec3& arm, const Vec3& along, const Mat6& inverse_mass) {
  Row out;
  out.direction << arm.cross(along), along;
  out.change = inverse_mass * out.direction;
  out.yields = out.direction.dot(out.change);
  return out;
}

/// Changes the impulse so that the row's speed becomes `wanted`, within bounds.
void solve(Row& row, Vec6& twist, double wanted, double low, double high) {
  if (!(row.yields > 0)) return;
  const double next =
      std::clamp(row.impulse + (wanted - row.direction.dot(twist)) / row.yields, low, high);
  twist += (next - row.impulse) * row.change;
  row.impulse = next;
}

/// Returns the impulse (moment about the tool's origin, impulse) of contact vertices at `arms` [m]
/// that rise along `up` by at least `rise` [m/s] each. Updates `twist`.
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
  for (const auto& vertex : rows)
    for (const Row& row : vertex) out += row.impulse * row.direction;
  return out;
}

/// Returns the speed of the fastest corner under a twist.
double fastest(const scene::Shell& shell, const Pose& X_WT, const Vec6& twist) {
  double out = 0;
  for (const Vec3& v : shell.vertices)
    out = std::max(out, (twist.tail<3>() + twist.head<3>().cross(X_WT.linear() * v)).norm());
  return out;
}

/// Returns the largest distance of a corner from its place at another pose [m].
double farthest(const scene::Shell& shell, const Pose& X, const Pose& other) {
  double out = 0;
  for (const Vec3& v : shell.vertices) out = std::max(out, (X * v - other * v).norm());
  return out;
}

std::vector<Vec3> arms_of(const std::vector<Vec3>& vertices, const Pose& X_WT) {
  std::vector<Vec3> out;
  out.reserve(vertices.size());
  for (const Vec3& vertex : vertices) out.push_back(X_WT.linear() * vertex);
  return out;
}

}  // namespace

std::array<Vec3, 2> along_ground(const Vec3& up) {
  const Vec2 falls = up.head<2>();
  if (falls.isZero(0)) return {Vec3::UnitX(), Vec3::UnitY()};
  const Vec3 across = Vec3(-falls.y(), falls.x(), 0).normalized();
  return {across.cross(up), across};
}

std::vector<Vec3> contact_vertices(const scene::Shell& shell, const Pose& X_WT, double cell,
                                   const Vec3& up) {
  const std::array<Vec3, 2> along = along_ground(up);
  double lowest = HUGE_VAL;
  for (const Vec3& v : shell.vertices) lowest = std::min(lowest, up.dot(X_WT * v));
  const double highest = lowest + (up == Vec3::UnitZ() ? kLevel : kSloping) * cell;
  std::vector<Vec3> out;
  for (int direction = 0; direction < 8; ++direction) {
    const Vec2 towards(std::cos(direction * kPi / 4), std::sin(direction * kPi / 4));
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

bool RestingContact::has_settled(const scene::Shell& shell, const ToolMotion& motion,
                                 double seconds, const Vec3& force) {
  // Judged by the displacement: the velocity is that before the soil acts, which includes the
  // weight of a step.
  const bool is_still = farthest(shell, motion.X_WT, X_WT) < kStill * seconds && force.z() > 0;
  X_WT = motion.X_WT;
  still = is_still ? still + seconds : 0;
  return still >= kStillTime;
}

void RestingContact::start(const scene::Shell& shell, const ToolMotion& motion, const Vec3& force,
                           const Vec3& moment, double tangent, double cell, const Vec3& normal) {
  // Motion of the tool without the soil, which the contact must stop.
  Vec6 wrench;
  wrench << moment, force;
  const Vec6 free = -(motion.inverse_mass * wrench);
  Vec6 twist = free;
  const std::vector<Vec3> arms =
      arms_of(contact_vertices(shell, motion.X_WT, cell, normal), motion.X_WT);
  stand(arms, std::vector<double>(arms.size(), 0.0), normal, motion.inverse_mass, tangent, twist);
  if (!(fastest(shell, motion.X_WT, twist) < kUncarried * fastest(shell, motion.X_WT, free)))
    return;
  engaged = true;
  X_WT = motion.X_WT;
  up = normal;
  initial_load = load = up.dot(force);
  friction = tangent;
}

bool RestingContact::apply(const scene::Shell& shell, const ToolMotion& motion, double dt,
                           double cell, ToolImpulse& impulse) {
  if (!engaged) return false;
  const double moved = farthest(shell, motion.X_WT, X_WT);
  if (moved > kMoved * cell || load > kOverload * initial_load) {
    release();
    return true;
  }
  Vec6 got, twist;
  got << impulse.L_W, impulse.J_W;
  twist << motion.w_WT, motion.v_WT;
  twist += motion.inverse_mass * got;
  const std::vector<Vec3> standing = contact_vertices(shell, X_WT, cell, up);
  std::vector<double> rise;
  for (const Vec3& vertex : standing) {
    // A vertex above its place may come down to it, and no farther. One that sank by rounding is
    // pushed out slowly.
    const double above = up.dot(motion.X_WT * vertex) - up.dot(X_WT * vertex);
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
  a("engaged", engaged);
  a("X_WT", X_WT);
  a("up", up);
  a("initial_load", initial_load);
  a("load", load);
  a("friction", friction);
  a.require(std::isfinite(still + initial_load + load + friction) && still >= 0 &&
                initial_load >= 0 && friction >= 0,
            "still", "must be finite and not negative, as must the initial load and the friction");
  a.require(std::abs(up.norm() - 1) < 1e-9 && up.z() > 0, "up",
            "must be a direction that leads upward");
  a.require(std::isfinite(X_WT.matrix().sum()) && X_WT.translation().norm() < limits::kFarthest,
            "X_WT", "must be a place on the site");
}

}  // namespace navvy::soil
