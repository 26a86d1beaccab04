// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/track_body.h"

#include <algorithm>
#include <cmath>

#include "terramechanics/track_shear.h"
#include "terramechanics/tyre_strip.h"

namespace navvy::terramechanics {
namespace {

// Spacing of discs in radii: a body between two discs penetrates by R / 22 at most.
constexpr double kSpacing = 0.6;
// Largest number of pieces of a run between two wheels.
constexpr int kMostPieces = 32;

struct Circle {
  Vec3 p_C = Vec3::Zero();
  double radius = 0;
};

/// Returns the downward normal of the common lower tangent of two circles, the first ahead of the
/// second.
Vec3 lower_tangent(const Circle& a, const Circle& b) {
  Vec3 d = b.p_C - a.p_C;
  d.y() = 0;
  const double far = d.norm();
  const double slant = far > 0 ? (a.radius - b.radius) / far : 1;
  // A circle inside the other has no tangent.
  if (std::abs(slant) >= 1) return -Vec3::UnitZ();
  d /= far;
  return slant * d + std::sqrt(1 - slant * slant) * Vec3(-d.z(), 0, d.x());
}

/// Returns the share of each contact in the stiffness of the track: a roller's share for a single
/// contact, divided among contacts of its line that are nearer than two rollers and pressed in the
/// same direction.
std::vector<double> shares(const std::vector<TrackStation>& stations,
                           const std::vector<TrackTouch>& touches, double roller, double reach) {
  std::vector<double> out;
  for (const TrackTouch& one : touches) {
    double pressed = 0;
    for (const TrackTouch& other : touches) {
      if (other.line != one.line) continue;
      const double near =
          1 - std::abs(stations[other.station].along - stations[one.station].along) / reach;
      if (near > 0)
        pressed += near * std::max(0.0, other.at.normal.dot(one.at.normal)) * other.at.depth;
    }
    out.push_back(roller * one.at.depth / pressed);
  }
  return out;
}

/// Tangential plane of a contact: along the track and to the left. `runs` is the part of the
/// track's speed along it; zero for a contact from the side.
struct Plane {
  Vec3 ahead, left;
  double runs = 0;
};

// A contact from the side has no direction of its own, so use the carrier's x.
Plane plane_of(const TrackMotion& motion, const Vec3& normal) {
  Plane out;
  Vec3 ahead = motion.X_WC.linear().col(1).cross(normal);
  out.runs = ahead.norm();
  if (out.runs < 0.05) ahead = motion.X_WC.linear().col(0);
  out.ahead = (ahead - ahead.dot(normal) * normal).normalized();
  out.left = normal.cross(out.ahead);
  return out;
}

/// Returns the sum over the contacts of each body.
std::vector<double> sums(const std::vector<TrackTouch>& touches, const std::vector<double>& of) {
  std::vector<double> out;
  for (std::size_t t = 0; t < touches.size(); ++t) {
    out.resize(std::max(out.size(), touches[t].body + 1), 0.0);
    out[touches[t].body] += of[t];
  }
  return out;
}

/// One step of a track that touches bodies.
class Step {
 public:
  Step(const scene::Wheel& wheel, const std::vector<TrackStation>& stations,
       const TrackMotion& motion, const std::vector<TrackTouch>& touches, double dt)
      : wheel_(wheel),
        stations_(stations),
        motion_(motion),
        touches_(touches),
        dt_(dt),
        track_speed_(motion.spin * wheel.radius),
        track_mass_(motion.spin_inertia / (wheel.radius * wheel.radius)) {
    press();
  }

  /// Advances the shear of one line, from the end where shoes enter, and adds its forces.
  void grip(std::size_t line, TrackBodyShear& shear, TrackBodyForce& out) const {
    Vec2 before = Vec2::Zero();
    for (std::size_t k = 0; k < stations_.size(); ++k) {
      const std::size_t s = track_speed_ >= 0 ? k : stations_.size() - 1 - k;
      Vec2& here = shear[s][line];
      const std::size_t t = gripping(s, line);
      if (t == touches_.size()) {
        here = before = Vec2::Zero();
        continue;
      }
      const BodyTouch& at = touches_[t].at;
      const Plane plane = plane_of(motion_, at.normal);
      const Vec3 v = velocity(at);
      const Vec2 slip(v.dot(plane.ahead) - plane.runs * track_speed_, v.dot(plane.left));
      const double mass = mass_of(t);
      const TrackGrip bears = track_grip(at.friction * load_[t], kFirmShear, mass, dt_);
      const Vec2 middle = carry_shear(before, slip, stations_[s].length, track_speed_,
                                      kMostShear * bears.K, dt_, here);
      before = here;
      const Vec2 f = track_shear_force(bears, middle, slip, track_speed_, mass, dt_);
      out.f_W[t] += f.x() * plane.ahead + f.y() * plane.left;
      out.torque -= wheel_.radius * plane.runs * f.x();
    }
  }

  /// Returns the resistance of rollers, links and bushings to the spin, as on ground.
  double resistance() const {
    const double inner = wheel_.rolling_resistance * total_;
    const double band = std::max(kTrackRoll, inner * dt_ / (0.15 * track_mass_));
    return -inner * wheel_.radius * std::tanh(track_speed_ / band);
  }
  double load(std::size_t touch) const { return load_[touch]; }

 private:
  /// Returns the velocity of the track's carrier against the body.
  Vec3 velocity(const BodyTouch& at) const {
    return motion_.v_W + motion_.w_W.cross(at.p_W - motion_.X_WC.translation()) - at.v_W;
  }

  void press() {
    const double rollers = static_cast<double>(wheel_.track->rollers.size());
    const double reach =
        (wheel_.track->rollers.front() - wheel_.track->rollers.back()).norm() / (rollers - 1);
    const std::vector<double> share =
        shares(stations_, touches_, 1 / (rollers * kTrackLines), reach);
    std::vector<double> depth;
    for (const TrackTouch& touch : touches_) depth.push_back(touch.at.depth);
    const std::vector<double> deep = sums(touches_, depth);
    for (std::size_t t = 0; t < touches_.size(); ++t) {
      const BodyTouch& at = touches_[t].at;
      // Body and track are in series, and the body's contacts share it: an explicit step is stable
      // while k dt^2 and c dt are below the mass that they move.
      scene::Wheel soft;
      soft.radius = wheel_.radius;
      soft.stiffness = wheel_.stiffness;
      soft.damping = wheel_.damping;
      if (at.inverse_mass > 0) {
        const double part = at.depth / deep[touches_[t].body] / (share[t] * at.inverse_mass * dt_);
        soft.stiffness = std::min(soft.stiffness, 0.2 * part / dt_);
        soft.damping = std::min(soft.damping, 0.3 * part);
      }
      const double deflection =
          std::min(at.depth, kMaxDeflection * stations_[touches_[t].station].radius);
      load_.push_back(radial_force(soft, share[t], deflection, -at.normal.dot(velocity(at))));
      total_ += load_.back();
    }
    on_body_ = sums(touches_, load_);
  }

  /// Returns the mass that the grip of a contact accelerates: its share by load of track or body
  /// [kg].
  double mass_of(std::size_t t) const {
    const double running_track = track_mass_ * load_[t] / total_;
    const double inverse = touches_[t].at.inverse_mass;
    return inverse > 0 ? std::min(running_track, load_[t] / (on_body_[touches_[t].body] * inverse))
                       : running_track;
  }

  /// Returns the contact of a station with the largest load; the number of contacts if there is
  /// none.
  std::size_t gripping(std::size_t station, std::size_t line) const {
    std::size_t best = touches_.size();
    for (std::size_t t = 0; t < touches_.size(); ++t) {
      if (touches_[t].station != station || touches_[t].line != line || !(load_[t] > 0)) continue;
      if (best == touches_.size() || load_[t] > load_[best]) best = t;
    }
    return best;
  }

  const scene::Wheel& wheel_;
  const std::vector<TrackStation>& stations_;
  const TrackMotion& motion_;
  const std::vector<TrackTouch>& touches_;
  double dt_, track_speed_, track_mass_;
  std::vector<double> load_, on_body_;  // by contact; by body
  double total_ = 0;
};

}  // namespace

// Divides the runs between wheels into pieces, and adds up positions and lengths along the path.
std::vector<TrackStation> track_stations(const scene::Wheel& wheel, const Vec3& p_sprocket) {
  const scene::Track& track = *wheel.track;
  std::vector<Circle> gear;
  for (const Vec3& roller : track.rollers)
    gear.push_back({roller, track.roller_radius + track.thickness});
  const Circle idler{track.p_idler, track.idler_radius + track.thickness};
  const Circle sprocket{p_sprocket, wheel.radius + track.thickness};
  const bool idler_ahead = idler.p_C.x() > sprocket.p_C.x();
  gear.insert(gear.begin(), idler_ahead ? idler : sprocket);
  gear.push_back(idler_ahead ? sprocket : idler);
  // The discs are as large as fits inside the track's loop.
  const double large = std::max(gear[1].radius, std::min(idler.radius, sprocket.radius));

  std::vector<TrackStation> out;
  const auto touching = [&](const Vec3& point, const Vec3& down) {
    out.push_back({point - large * down, large, 0, 0});
  };
  std::vector<Vec3> lowest;
  for (std::size_t i = 0; i < gear.size(); ++i) {
    const bool outer = i == 0 || i + 1 == gear.size();
    const Vec3 ahead =
        i > 0 ? lower_tangent(gear[i - 1], gear[i]) : lower_tangent(gear[0], gear[1]);
    const Vec3 behind = i + 1 < gear.size() ? lower_tangent(gear[i], gear[i + 1]) : ahead;
    const Vec3 down = (ahead + behind).normalized();
    lowest.push_back(gear[i].p_C + gear[i].radius * down);
    if (outer)
      out.push_back({gear[i].p_C, gear[i].radius, 0, 0});
    else
      touching(lowest.back(), down);
    if (i + 1 == gear.size()) break;
    // The run to the next wheel.
    const Vec3 from = gear[i].p_C + gear[i].radius * behind,
               to = gear[i + 1].p_C + gear[i + 1].radius * behind;
    const double pieces =
        std::clamp(std::ceil((to - from).norm() / (kSpacing * large)), 1.0, double{kMostPieces});
    for (double k = 1; k < pieces; ++k) {
      lowest.emplace_back(from + k / pieces * (to - from));
      touching(lowest.back(), behind);
    }
  }
  for (std::size_t s = 1; s < out.size(); ++s) {
    const double step = (lowest[s] - lowest[s - 1]).norm();
    out[s].along = out[s - 1].along + step;
    out[s - 1].length += 0.5 * step;
    out[s].length += 0.5 * step;
  }
  out.front().length += 0.5 * out.front().radius;
  out.back().length += 0.5 * out.back().radius;
  return out;
}

// Grip couples the contacts of a line; the pressure of each depends on its own depth.
TrackBodyForce track_body_force(const scene::Wheel& wheel,
                                const std::vector<TrackStation>& stations,
                                const TrackMotion& motion, const std::vector<TrackTouch>& touches,
                                double dt, TrackBodyShear& shear) {
  TrackBodyForce out;
  const Step step(wheel, stations, motion, touches, dt);
  for (std::size_t t = 0; t < touches.size(); ++t)
    out.f_W.emplace_back(step.load(t) * touches[t].at.normal);
  for (std::size_t line = 0; line < kTrackLines; ++line) step.grip(line, shear, out);
  out.torque += step.resistance();
  return out;
}

}  // namespace navvy::terramechanics
