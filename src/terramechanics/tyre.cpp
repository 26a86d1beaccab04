// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/tyre.h"

#include <algorithm>
#include <cmath>

#include "terramechanics/bearing.h"
#include "terramechanics/shear.h"
#include "terramechanics/tyre_patch.h"
#include "terramechanics/tyre_strip.h"

namespace navvy::terramechanics {
namespace {

// Rays every 15 degrees over +-60: their spacing on the tread of a 1 m wheel is 0.14 m.
constexpr int kArcSamples = 9;
// Share of the radius: at 5 m/s a tyre of 0.5 m travels that far between two presses.
constexpr double kPressedAhead = 0.1;
// Fine enough to find cells of 0.1 m near the ground.
constexpr double kArcStep = radians(15);

struct Track {
  Vec3 normal = Vec3::UnitZ();
  double deflection = 0;  // 0: in the air
};

/// Ray from the centre, where the tread penetrates the ground.
struct Dip {
  Vec3 normal;
  double depth = 0;
};

/// Finds the dip of one ray: the plane of the ground at p if the wheel's deepest point agrees with
/// it, otherwise an edge on the ray itself.
Dip dip_at(const Vec3& center, const Vec3& spin_axis, double radius, const Vec3& ray,
           const Vec3& ground_point, const Vec3& normal, const GroundQuery& ground) {
  const Vec3 in_plane = normal - normal.dot(spin_axis) * spin_axis;
  const double tilt = in_plane.norm();
  const double away = normal.dot(center - ground_point);
  if (tilt > 0.05) {
    const Vec3 deepest = center - in_plane * (radius / tilt);
    // Height of the plane there. The ground must match that plane over the contact.
    const double plane = ground_point.z() - (normal.x() * (deepest.x() - ground_point.x()) +
                                             normal.y() * (deepest.y() - ground_point.y())) /
                                                std::max(normal.z(), 0.02);
    if (std::abs(ground.height(deepest.x(), deepest.y()) - plane) < 0.03)
      return {normal, radius * tilt - away};
  }
  const double facing = normal.dot(ray);
  const double reach = facing < -0.05 ? -away / facing : radius;
  return {-ray, std::clamp(radius - reach, 0.0, radius)};
}

/// Finds deflection and mean normal of one contact strip. Rays that hit the ground are weighted by
/// their dip squared, so that the deepest ray dominates and the normal changes continuously as the
/// wheel rolls over an edge.
Track find_contact(const Vec3& center, const Vec3& spin_axis, double radius,
                   const GroundQuery& ground) {
  Track track;
  const Vec3 forward = spin_axis.cross(Vec3::UnitZ());
  // The wheel is on its side: collision shapes hold it.
  if (forward.norm() < 0.1) return track;
  const Vec3 ahead = forward.normalized(), down = -ahead.cross(spin_axis);
  Vec3 normal = Vec3::Zero();
  constexpr int kMiddle = kArcSamples / 2;
  for (int i = 0; i < kArcSamples; ++i) {
    const double angle = kArcStep * (i - kMiddle);
    const Vec3 ray = std::cos(angle) * down + std::sin(angle) * ahead;
    const Vec3 p = center + radius * ray;
    const double height = ground.height(p.x(), p.y());
    if (height <= p.z()) continue;
    const Dip dip = dip_at(center, spin_axis, radius, ray, Vec3(p.x(), p.y(), height),
                           ground.normal(p.x(), p.y()), ground);
    if (dip.depth <= 0) continue;
    normal += dip.depth * dip.depth * dip.normal;
    track.deflection = std::max(track.deflection, dip.depth);
  }
  if (normal.norm() > 0) track.normal = normal.normalized();
  track.deflection = std::min(track.deflection, kMaxDeflection * radius);
  return track;
}

/// Returns the tangential force of one strip (forward, left) [N] under `normal_force` [N] on firm
/// ground or on soil.
Vec2 tangential_force(const scene::Wheel& tyre, const SoilState& ground, double normal_force,
                      const Vec2& slip, double rolling, double rim_mass, double dt, Vec2& bristle,
                      double& sheared) {
  if (ground.soil == nullptr)
    return bristle_force(tyre, 0.5, slip, rolling, tyre_friction(tyre, ground, 0) * normal_force,
                         rim_mass, dt, bristle);
  // The patch of a wheel whose two strips carry this load each.
  const TyrePatch patch = tyre_patch(tyre, *ground.soil, 2 * normal_force);
  if (!(patch.pressure > 0)) {
    bristle.setZero();
    sheared = 0;
    return Vec2::Zero();
  }
  const TrackShear soil{tyre_friction(tyre, ground, patch.pressure) * normal_force,
                        ground.soil->janosi_k, patch.half_length};
  return shear_force(tyre, 0.5, slip, rolling, soil, rim_mass, dt, bristle, sheared);
}

/// Motion of one contact strip.
struct Roll {
  Vec3 p_W = Vec3::Zero();        // position on the ground [m]
  Vec3 forward = Vec3::UnitX();   // unit, of the wheel
  double speed = 0, rolling = 0;  // along forward, of the wheel and of its rim there [m/s]
  double deflection = 0;          // [m]
};

/// Returns the depth [m] of soil that the tread meets ahead: the tyre's sinkage since it arrived,
/// unless the ground ahead, in the direction of the wheel, is as low. In its own rut it meets none.
/// Half of the depth is enough for the full resistance, since wheels are not exactly parallel to
/// the ground.
double depth_met(const scene::Wheel& tyre, const Roll& roll, double sunk, const GroundQuery& ground,
                 SoilState& met) {
  // Look beyond the columns that are pressed for the tread where it is and where it will be soon,
  // between their centres.
  const double beyond = 0.5 * chord_length(tyre.radius, roll.deflection + sunk) +
                        kPressedAhead * tyre.radius + 1.5 * ground.lattice().spacing;
  const Vec3 p = roll.p_W + (roll.speed > 0 ? beyond : -beyond) * roll.forward;
  met = ground.soil(p.x(), p.y());
  return std::clamp(2 * (ground.height(p.x(), p.y()) - p.z()), 0.0, sunk);
}

/// Returns the resistance of soil ahead of one strip [N]: compaction, R = b int p dz [Bekker 1969],
/// the work of sinking over further distance, plus bulldozing. Smooth through zero, within the
/// stability of an explicit step.
double soil_resistance(const scene::Wheel& tyre, const Roll& roll, const GroundQuery& ground,
                       double normal_force, double rim_mass, double dt) {
  const Sinkage sunk = ground.sinking(roll.p_W.x(), roll.p_W.y());
  if (!(sunk.work > 0)) return 0;
  const double width = tyre.twin_spacing > 0 ? tyre.width : 0.5 * tyre.width;
  SoilState met;
  const double depth = depth_met(tyre, roll, sunk.depth, ground, met);
  const double pushes = bulldozing(met, width, tyre.radius, depth, roll.speed / roll.rolling);
  const double resistance = std::min(width * sunk.work + pushes, normal_force);
  const double band = std::max(0.05, resistance * dt / (0.15 * rim_mass));
  return resistance * std::tanh(roll.speed / band);
}

/// Motion of a wheel over the ground at its contact.
struct Drift {
  Vec3 left = Vec3::UnitY();    // unit, in the plane of the ground
  double aside = 0, ahead = 0;  // velocity to the left and ahead [m/s]
};

/// Returns the resistance of the soil beside the leading side wall of a wheel that moves sideways
/// [N], to the left: negative for a wheel that moves to the left. The tyres stand in a rut of
/// `depth` [m] under `load` [N]. At most the load; smooth through zero, within the stability of an
/// explicit step.
double side_wall_force(const scene::Wheel& tyre, const Vec3& center, const Drift& drift,
                       const GroundQuery& ground, double depth, double load, double dt) {
  if (drift.aside == 0 || !(depth > 0)) return 0;
  // Over the middle of the first columns beyond those that are pressed with the tread.
  const double beyond = 0.5 * (tyre.twin_spacing + tyre.width) + 1.5 * ground.lattice().spacing;
  const Vec3 p = center + std::copysign(beyond, drift.aside) * drift.left;
  // One side of a wheel on a rut's edge may be free. The mean depth alone does not see that, and
  // the height of one side alone would take a slope for soil beside the wheel.
  const double wall =
      std::min(depth, ground.height(p.x(), p.y()) - ground.height(center.x(), center.y()));
  const double resistance =
      std::min(load, side_wall_resistance(ground.soil(p.x(), p.y()), tyre.radius, wall,
                                          drift.aside / std::abs(drift.ahead)));
  const double band = std::max(0.05, resistance * dt / (0.15 * load / kGravity));
  return -resistance * std::tanh(drift.aside / band);
}

/// Returns the depth of the ground under the tyres below the ground beside them [m]: the rut,
/// whatever pressed it.
double sinkage(const scene::Wheel& tyre, const Pose& X, const GroundQuery& ground) {
  const Vec3 p = X.translation(), left = X.linear().col(1);
  const double aside = 0.5 * tyre.twin_spacing + tyre.width;
  const Vec3 a = p + aside * left, b = p - aside * left;
  const double beside = 0.5 * (ground.height(a.x(), a.y()) + ground.height(b.x(), b.y()));
  const double offset = 0.5 * tyre.twin_spacing;
  const Vec3 c = p + offset * left, d = p - offset * left;
  const double under = 0.5 * (ground.height(c.x(), c.y()) + ground.height(d.x(), d.y()));
  return std::max(0.0, beside - under);
}

}  // namespace

double tyre_friction(const scene::Wheel& tyre, const SoilState& ground, double pressure) {
  if (ground.soil == nullptr || !(pressure > 0)) return tyre.friction;
  const ShearStrength strength = surface_strength(ground);
  return std::min(tyre.friction, strength.slope + strength.cohesion / pressure);
}

// Each strip has its own contact; the wheel's slip and sinkage are their mean.
TyreForce tyre_force(const scene::Wheel& tyre, const TyreMotion& motion, const GroundQuery& ground,
                     double dt, TyreState& state) {
  TyreForce out;
  const Vec3 center = motion.X_WWheel.translation(), axis = motion.X_WWheel.linear().col(1);
  const double offset = track_offset(tyre);
  const double rim_mass = motion.spin_inertia / (tyre.radius * tyre.radius);
  double rim_speed = 0, ground_speed = 0, load = 0;
  Drift drift;
  drift.left.setZero();
  Vec3 bottom = Vec3::Zero();  // mean contact from the centre, weighted by load
  for (int t = 0; t < 2; ++t) {
    const Vec3 arm = (t == 0 ? offset : -offset) * axis;
    const Track track = find_contact(center + arm, axis, tyre.radius, ground);
    Vec2& bristle = state.bristle[static_cast<std::size_t>(t)];
    const Vec3 in_plane = track.normal - track.normal.dot(axis) * axis;
    if (track.deflection <= 0 || in_plane.norm() < 0.05) {
      bristle.setZero();
      state.sheared[static_cast<std::size_t>(t)] = 0;
      continue;
    }
    // Velocities of the tread at the contact: of the carrier, and of the rim by its spin.
    const double loaded = tyre.radius - track.deflection;
    const Vec3 p = arm - loaded * in_plane.normalized();  // contact from the centre
    const Vec3 v_carrier = motion.v_W + motion.w_W.cross(p);
    const Vec3 v_rim = motion.spin * axis.cross(p);
    const double normal_force =
        radial_force(tyre, 0.5, track.deflection, -track.normal.dot(v_carrier));

    // Tangential forces act in the plane of the ground, forward and left.
    const Vec3 ahead = axis.cross(track.normal).normalized(), left = track.normal.cross(ahead);
    const Vec3 v_slip = v_carrier + v_rim;
    const SoilState soil = ground.soil(center.x() + p.x(), center.y() + p.y());
    const double rolling = -v_rim.dot(ahead);
    const Vec2 slip(v_slip.dot(ahead), v_slip.dot(left));
    const Vec2 f = tangential_force(tyre, soil, normal_force, slip, rolling, rim_mass, dt, bristle,
                                    state.sheared[static_cast<std::size_t>(t)]);
    const Vec3 force = normal_force * track.normal + f.x() * ahead + f.y() * left;
    const Roll roll{center + p, motion.X_WWheel.linear().col(0), v_carrier.dot(ahead), rolling,
                    track.deflection};
    // The soil's pressure points at the axle and exerts no torque.
    out.force_W += force - soil_resistance(tyre, roll, ground, normal_force, rim_mass, dt) * ahead;
    out.moment_W += p.cross(force);
    out.deflection = std::max(out.deflection, track.deflection);

    // Rolling resistance acts against the spin. It is smooth through zero, within the stability of
    // an explicit step.
    const double band =
        std::max(0.05, tyre.rolling_resistance * normal_force * dt / (0.15 * rim_mass));
    out.moment_W -=
        axis * (tyre.rolling_resistance * normal_force * loaded * std::tanh(rolling / band));
    rim_speed += normal_force * rolling;
    ground_speed += normal_force * v_carrier.dot(ahead);
    load += normal_force;
    drift.left += normal_force * left;
    drift.aside += normal_force * v_carrier.dot(left);
    bottom += normal_force * p;
  }
  // Slip of the whole wheel, weighted by the load of each strip.
  if (load > 0) {
    rim_speed /= load;
    ground_speed /= load;
    out.slip =
        (rim_speed - ground_speed) / std::max({std::abs(rim_speed), std::abs(ground_speed), 0.1});
    out.sinkage = sinkage(tyre, motion.X_WWheel, ground);
    drift.left.normalize();
    drift.aside /= load;
    drift.ahead = ground_speed;
    const Vec3 side =
        side_wall_force(tyre, center, drift, ground, out.sinkage, load, dt) * drift.left;
    out.force_W += side;
    out.moment_W += (bottom / load).cross(side);
  }
  return out;
}

void TyreState::visit(Archive& a) {
  a("bristle", bristle);
  a("sheared", sheared);
  for (const double one : sheared)
    a.require(one >= 0 && one < 1e6, "sheared",
              "the shear under a tyre must be finite and not negative");
}

void TyreForce::visit(Archive& a) {
  a("force_W", force_W);
  a("moment_W", moment_W);
  a("slip", slip);
  a("sinkage", sinkage);
  a("deflection", deflection);
}

}  // namespace navvy::terramechanics
