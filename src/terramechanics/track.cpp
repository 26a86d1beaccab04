// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/track.h"

#include <algorithm>
#include <cmath>

#include "terramechanics/bearing.h"
#include "terramechanics/plate.h"
#include "terramechanics/track_shear.h"
#include "terramechanics/tyre_strip.h"

namespace navvy::terramechanics {
namespace {

// Rays of idler and sprocket, every 20 degrees from straight down outward.
constexpr int kRays = 5;
constexpr double kRayStep = radians(20);

/// Wheel of the running gear in contact with the ground.
struct RunningWheel {
  Vec3 p_C = Vec3::Zero();  // centre in the carrier [m]
  double radius = 0;        // to the outside of the track [m]
  double length = 0;        // of track under it [m]
  // 1: the foremost, which also looks ahead; -1: the last, which also looks back; 0: a roller.
  int out = 0;
};

/// Returns the wheels from front to rear.
std::vector<RunningWheel> running_gear(const scene::Wheel& wheel, const Vec3& p_sprocket) {
  const scene::Track& track = *wheel.track;
  std::vector<RunningWheel> out;
  const std::size_t n = track.rollers.size();
  for (std::size_t i = 0; i < n; ++i) {
    // Reach half way to the neighbours. The outer rollers carry as much track outside as inside.
    const double ahead = (track.rollers[i > 0 ? i - 1 : 0] - track.rollers[i > 0 ? i : 1]).norm();
    const double behind =
        (track.rollers[i + 1 < n ? i : n - 2] - track.rollers[i + 1 < n ? i + 1 : n - 1]).norm();
    out.push_back(
        {track.rollers[i], track.roller_radius + track.thickness, 0.5 * (ahead + behind), 0});
  }
  RunningWheel idler{track.p_idler, track.idler_radius + track.thickness, 0, 1};
  RunningWheel sprocket{p_sprocket, wheel.radius + track.thickness, 0, 1};
  idler.length = 0.5 * idler.radius;
  sprocket.length = 0.5 * sprocket.radius;
  const bool idler_ahead = idler.p_C.x() > sprocket.p_C.x();
  (idler_ahead ? sprocket : idler).out = -1;
  out.insert(out.begin(), idler_ahead ? idler : sprocket);
  out.push_back(idler_ahead ? sprocket : idler);
  return out;
}

/// Contact of one wheel with the ground.
struct Meeting {
  Vec3 p_W = Vec3::Zero(), normal = Vec3::UnitZ();
  // Penetration [m]; it touches if above 0.
  double depth = 0;
};

/// Finds the contact of a roller with a firm floor, which pushes along its own normal however the
/// machine leans on its rollers.
Meeting meet_floor(const RunningWheel& wheel, const Vec3& center, const GroundQuery& ground) {
  const Vec3 n = ground.normal(center.x(), center.y());
  const Vec3 p = center - wheel.radius * n;
  return {p, n, std::clamp(n.z() * (ground.height(p.x(), p.y()) - p.z()), 0.0, 0.5 * wheel.radius)};
}

/// Finds the contact along rays from the centre: a roller looks straight down, the outer wheels
/// also outward.
Meeting meet(const RunningWheel& wheel, const Pose& X_WC, const GroundQuery& ground) {
  const Vec3 ahead = X_WC.linear().col(0), up = X_WC.linear().col(2);
  const Vec3 center = X_WC * wheel.p_C;
  if (wheel.out == 0 && ground.soil(center.x(), center.y()).soil == nullptr)
    return meet_floor(wheel, center, ground);
  Meeting best;
  for (int i = 0; i < (wheel.out == 0 ? 1 : kRays); ++i) {
    const Vec3 ray = std::sin(kRayStep * i) * wheel.out * ahead - std::cos(kRayStep * i) * up;
    const Vec3 p = center + wheel.radius * ray;
    const double height = ground.height(p.x(), p.y());
    if (height <= p.z()) continue;
    const Vec3 n = ground.normal(p.x(), p.y());
    // Depth along the ray to the plane of the ground there; an overhanging plane counts as level.
    const double depth = n.z() * (height - p.z()) / std::max(-n.dot(ray), 0.3);
    if (depth > best.depth) best = {p, -ray, std::min(depth, 0.5 * wheel.radius)};
  }
  return best;
}

/// Data of one step, shared by all contacts.
struct Step {
  const scene::Wheel& wheel;
  const TrackMotion& motion;
  const GroundQuery& ground;
  double dt = 0, track_speed = 0, rim_mass = 0;

  Vec3 velocity(const Vec3& p_W) const {
    return motion.v_W + motion.w_W.cross(p_W - motion.X_WC.translation());
  }
};

TrackGrip grip_of(const Step& step, double length, double load, const SoilState& soil) {
  const ShearStrength strength = track_strength(step.wheel, soil);
  const double most = step.wheel.width * length * strength.cohesion + load * strength.slope;
  const double K = soil.soil != nullptr ? soil.soil->janosi_k : kFirmShear;
  // Not too stiff for an explicit step with the mass of the track alone.
  return track_grip(most, K, step.rim_mass, step.dt);
}

/// Computes the resistance [N] of soil ahead of the track: the work of pressing soil that it has
/// not pressed yet, and the bulldozing of its foremost wheel.
double soil_resistance(const Step& step, const std::vector<RunningWheel>& gear,
                       const std::vector<Meeting>& met, const TrackState& state) {
  const bool forward = step.track_speed >= 0;
  const std::size_t n = gear.size();
  const std::size_t lead = forward ? 1 : n - 2;
  const double load = state.contacts[lead].load;
  if (!(load > 0)) return 0;
  const SoilState under = step.ground.soil(met[lead].p_W.x(), met[lead].p_W.y());
  if (under.soil == nullptr) return 0;
  const double beyond = 0.5 * gear[lead].length + 1.5 * step.ground.lattice().spacing;
  const Vec3 p = met[lead].p_W + (forward ? beyond : -beyond) * step.motion.X_WC.linear().col(0);
  const double up = step.motion.X_WC.linear()(2, 2);
  const double above = up * (step.ground.height(p.x(), p.y()) - p.z()) - met[lead].depth;
  // Ground that rises ahead may be a slope: it counts no deeper than this load presses.
  const double b = step.wheel.width;
  const double deepest = plate_sinkage(*under.soil, load / (b * gear[lead].length), b);
  const double z = std::clamp(above, 0.0, deepest);
  const double speed = step.velocity(met[lead].p_W).dot(step.motion.X_WC.linear().col(0));
  const double pushes =
      bulldozing(under, b, gear[forward ? 0 : n - 1].radius, z, speed / step.track_speed);
  const double resistance =
      b * plate_pressure(*under.soil, z, b) * z / (under.soil->bekker_n + 1) + pushes;
  return -resistance * std::tanh(step.track_speed / kTrackRoll);
}

/// Advances the shear of all contacts. Shoes enter unsheared at the leading end, segment by
/// segment; the update is implicit and stable at any speed.
/// @return the shear of the soil under the middle of each contact.
std::vector<Vec2> carry_on(const Step& step, const std::vector<RunningWheel>& gear,
                           const std::vector<Meeting>& met, const std::vector<Vec2>& slip,
                           TrackState& state) {
  const std::size_t n = gear.size();
  std::vector<Vec2> middle(n, Vec2::Zero());
  Vec2 before = Vec2::Zero();
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = step.track_speed >= 0 ? k : n - 1 - k;
    TrackContact& contact = state.contacts[i];
    if (!(contact.load > 0)) {
      contact.shear = before = Vec2::Zero();
      continue;
    }
    const SoilState soil = step.ground.soil(met[i].p_W.x(), met[i].p_W.y());
    const double most = kMostShear * grip_of(step, gear[i].length, contact.load, soil).K;
    middle[i] = carry_shear(before, slip[i], gear[i].length, step.track_speed, most, step.dt,
                            contact.shear);
    before = contact.shear;
  }
  return middle;
}

// Averages the depth below the ground beside the track, weighted by load.
double rut_depth(const Step& step, const std::vector<Meeting>& met, const TrackState& state) {
  double depth = 0, load = 0;
  for (std::size_t i = 0; i < met.size(); ++i) {
    if (!(state.contacts[i].load > 0)) continue;
    const Vec3& p = met[i].p_W;
    const Vec3 aside = (0.5 * step.wheel.width + 1.5 * step.ground.lattice().spacing) *
                       step.motion.X_WC.linear().col(1);
    const double beside = 0.5 * (step.ground.height(p.x() + aside.x(), p.y() + aside.y()) +
                                 step.ground.height(p.x() - aside.x(), p.y() - aside.y()));
    depth += state.contacts[i].load * (beside - step.ground.height(p.x(), p.y()));
    load += state.contacts[i].load;
  }
  return load > 0 ? std::max(0.0, depth / load) : 0;
}

}  // namespace

void TrackContact::visit(Archive& a) {
  a.ranged("load", load, 0.0, 1e12);
  a("shear", shear);
  a.require(shear.allFinite(), "shear", "the shear under a track must be finite");
}

TrackState TrackState::of(const scene::Track& track) {
  TrackState state;
  state.contacts.resize(track.rollers.size() + 2);
  return state;
}

ShearStrength track_strength(const scene::Wheel& wheel, const SoilState& ground) {
  return ground.soil != nullptr ? surface_strength(ground) : ShearStrength{0, wheel.friction};
}

// Finds all contacts first: the shear of each depends on those ahead of it.
TrackForce track_force(const scene::Wheel& wheel, const TrackMotion& motion,
                       const GroundQuery& ground, double dt, TrackState& state) {
  TrackForce out;
  const std::vector<RunningWheel> gear = running_gear(wheel, motion.p_sprocket);
  const double rollers = static_cast<double>(wheel.track->rollers.size());
  const Step step{wheel,
                  motion,
                  ground,
                  dt,
                  motion.spin * wheel.radius,
                  motion.spin_inertia / (wheel.radius * wheel.radius) / rollers};
  const Vec3 left = motion.X_WC.linear().col(1);
  std::vector<Meeting> met;
  std::vector<Vec2> slip;
  double load = 0, ground_speed = 0;
  for (std::size_t i = 0; i < gear.size(); ++i) {
    met.push_back(meet(gear[i], motion.X_WC, ground));
    const Meeting& at = met.back();
    const Vec3 v = step.velocity(at.p_W), ahead = left.cross(at.normal);
    state.contacts[i].load =
        at.depth > 0 ? radial_force(wheel, 1 / rollers, at.depth, -at.normal.dot(v)) : 0;
    slip.emplace_back(v.dot(ahead) - step.track_speed, v.dot(left));
    load += state.contacts[i].load;
    ground_speed += state.contacts[i].load * v.dot(ahead);
  }
  if (!(load > 0)) {
    for (TrackContact& contact : state.contacts) contact.shear.setZero();
    return out;
  }
  const std::vector<Vec2> shear = carry_on(step, gear, met, slip, state);
  for (std::size_t i = 0; i < gear.size(); ++i) {
    const TrackContact& contact = state.contacts[i];
    if (!(contact.load > 0)) continue;
    const SoilState soil = ground.soil(met[i].p_W.x(), met[i].p_W.y());
    const Vec2 f = track_shear_force(grip_of(step, gear[i].length, contact.load, soil), shear[i],
                                     slip[i], step.track_speed, step.rim_mass, dt);
    const Vec3 ahead = left.cross(met[i].normal);
    out.pushes.push_back({contact.load * met[i].normal + f.x() * ahead + f.y() * left, met[i].p_W});
    // The force acts on the lower run, which moves backwards under the machine as the sprocket
    // turns.
    out.torque -= wheel.radius * f.x();
  }
  const std::size_t lead = step.track_speed >= 0 ? 1 : gear.size() - 2;
  const double resistance = soil_resistance(step, gear, met, state);
  if (resistance != 0)
    out.pushes.push_back({resistance * motion.X_WC.linear().col(0), met[lead].p_W});
  for (const TrackForce::Push& push : out.pushes) out.force_W += push.f_W;
  // Rollers, links and bushings resist the spin. The resistance is smooth through zero, within the
  // stability of an explicit step.
  const double inner = wheel.rolling_resistance * load;
  const double band = std::max(kTrackRoll, inner * dt / (0.15 * step.rim_mass * rollers));
  out.torque -= inner * wheel.radius * std::tanh(step.track_speed / band);
  ground_speed /= load;
  out.slip = (step.track_speed - ground_speed) /
             std::max({std::abs(step.track_speed), std::abs(ground_speed), 0.1});
  out.sinkage = rut_depth(step, met, state);
  return out;
}

// Places the rectangle of each loaded contact below its wheel, at the present pose.
std::vector<TrackPatch> track_patches(const scene::Wheel& wheel, const TrackMotion& motion,
                                      const TrackState& state) {
  std::vector<TrackPatch> out;
  const std::vector<RunningWheel> gear = running_gear(wheel, motion.p_sprocket);
  const Mat3& R = motion.X_WC.linear();
  for (std::size_t i = 0; i < gear.size(); ++i)
    if (state.contacts[i].load > 0)
      out.push_back({motion.X_WC * gear[i].p_C - gear[i].radius * R.col(2), R.col(0),
                     gear[i].length, wheel.width, state.contacts[i].load});
  return out;
}

}  // namespace navvy::terramechanics
