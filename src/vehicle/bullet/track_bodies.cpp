// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/track_bodies.h"

#include <LinearMath/btAabbUtil2.h>

#include <algorithm>

#include "vehicle/bullet/convert.h"

namespace navvy::vehicle {

TrackBodies::Track& TrackBodies::running_track(std::size_t machine, std::size_t wheel,
                                               const scene::Wheel& about, const Vec3& p_sprocket) {
  if (tracks_.size() <= machine) tracks_.resize(machine + 1);
  if (tracks_[machine].size() <= wheel) tracks_[machine].resize(wheel + 1);
  // The stations follow from the running gear, which does not change, so they are made once.
  Track& out = tracks_[machine][wheel];
  if (!out.stations.empty()) return out;
  out.width = about.width;
  out.stations = terramechanics::track_stations(about, p_sprocket);
  for (const terramechanics::TrackStation& station : out.stations)
    for (std::size_t line = 0; line < terramechanics::kTrackLines; ++line)
      // Half the width of a disc is a quarter of the track's, so that two lines cover it. The other
      // bound keeps small discs flat.
      out.discs.emplace_back(station.radius, std::min(0.25 * about.width, 0.45 * station.radius));
  return out;
}

// One box around the whole track excludes most bodies.
void TrackBodies::look_round(const BulletMachine& own, const Track& running_track, const Pose& X_WC,
                             const ContactCandidates& bodies) {
  near_.clear();
  btVector3 low(1e18, 1e18, 1e18), high(-1e18, -1e18, -1e18);
  for (std::size_t s = 0; s < running_track.stations.size(); ++s) {
    const btVector3 p = to_bt(Vec3(X_WC * running_track.stations[s].p_C));
    const btVector3 far =
        // The corner of a disc is at most its radius and half the width from the station.
        btVector3(1, 1, 1) * (running_track.stations[s].radius + 0.5 * running_track.width);
    low.setMin(p - far);
    high.setMax(p + far);
  }
  for (const MetBody& body : bodies.all())
    if (body.machine != &own && TestAabbAgainstAabb2(low, high, body.low, body.high))
      near_.push_back(&body);
}

// Tests every disc on both lines.
void TrackBodies::touch(Track& running_track, const Pose& X_WC, const scene::Wheel& about,
                        btCollisionWorld& world) {
  touches_.clear();
  for (std::size_t d = 0; d < running_track.discs.size(); ++d) {
    const std::size_t station = d / terramechanics::kTrackLines,
                      line = d % terramechanics::kTrackLines;
    Pose X = X_WC;
    X.translation() = X_WC * Vec3(running_track.stations[station].p_C +
                                  Vec3(0, (line == 0 ? 0.25 : -0.25) * about.width, 0));
    running_track.discs[d].place(X);
    for (std::size_t b = 0; b < near_.size(); ++b)
      if (const auto at =
              ContactCandidates::touch(running_track.discs[d], *near_[b], about.friction, world))
        touches_.push_back({*at, station, line, b});
  }
}

// Forces act on the carrier, the torque on the sprocket.
void TrackBodies::push(BulletMachine& own, std::size_t machine, std::size_t wheel,
                       const ContactCandidates& bodies, btCollisionWorld& world, double dt) {
  MachineWheel& at = own.wheels()[wheel];
  const scene::Wheel& about = own.wheels().about(wheel);
  const terramechanics::TrackMotion motion = own.wheels().track_motion(at);
  Track& path = running_track(machine, wheel, about, motion.p_sprocket);
  look_round(own, path, motion.X_WC, bodies);
  touches_.clear();
  if (!near_.empty()) touch(path, motion.X_WC, about, world);
  at.body_p_C.setZero();
  if (touches_.empty()) {
    // Shear belongs to a contact; without one it must not act on the next.
    for (auto& station : at.body_shear) station.fill(Vec2::Zero());
    return;
  }
  const terramechanics::TrackBodyForce force =
      terramechanics::track_body_force(about, path.stations, motion, touches_, dt, at.body_shear);
  double pressed = 0;
  for (std::size_t t = 0; t < touches_.size(); ++t) {
    // Apply to both at one point, so that no momentum is lost.
    const Vec3& p_W = touches_[t].at.p_W;
    own.tree().add_force(at.carrier_link, force.f_W[t], Vec3::Zero(), p_W);
    near_[touches_[t].body]->push(-force.f_W[t], p_W);
    at.body_W += force.f_W[t];
    pressed += force.f_W[t].norm();
    // body_p_C becomes the mean of the points, weighted by the magnitudes of their forces.
    at.body_p_C += force.f_W[t].norm() * (motion.X_WC.inverse() * p_W);
  }
  if (pressed > 0) at.body_p_C /= pressed;
  own.tree().multibody().addJointTorque(own.tree().bullet_of_joint(at.spin_joint), force.torque);
}

}  // namespace navvy::vehicle
