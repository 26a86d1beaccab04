// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/tyre_bodies.h"

#include <algorithm>

#include "core/limits.h"
#include "terramechanics/tyre_strip.h"

namespace navvy::vehicle {
namespace {

bool meets_nobody(const TyreBodies::Machines& machines, const std::vector<Mover>& movers) {
  // A machine does not touch itself, so a single one has nobody to meet.
  return machines.size() + movers.size() < 2;
}

}  // namespace

Disc& TyreBodies::disc(std::size_t machine, std::size_t wheel, const scene::Wheel& about) {
  if (discs_.size() <= machine) discs_.resize(machine + 1);
  if (discs_[machine].size() <= wheel) discs_[machine].resize(wheel + 1);
  std::optional<Disc>& out = discs_[machine][wheel];
  // The disc is as wide as the contact strip and as large as the tyre.
  if (!out) {
    const double half = std::min(about.twin_spacing > 0 ? 0.5 * about.width : 0.25 * about.width,
                                 0.45 * about.radius);
    out.emplace(about.radius, half);
  }
  return *out;
}

void TyreBodies::touch(const BulletMachine& own, Disc& disc, double friction,
                       btCollisionWorld& world) {
  touches_.clear();
  for (const MetBody& body : bodies_.all()) {
    if (body.machine == &own) continue;
    if (const auto at = ContactCandidates::touch(disc, body, friction, world))
      touches_.push_back({*at, &body});
  }
}

// Only the deepest contact of a strip grips.
void TyreBodies::push_track(BulletMachine& own, std::size_t wheel, std::size_t track, double dt) {
  MachineWheel& at = own.wheels()[wheel];
  if (touches_.empty()) {
    at.body_bristle[track].setZero();
    return;
  }
  const terramechanics::TyreMotion motion = own.wheels().motion(at);
  const auto deepest =
      std::max_element(touches_.begin(), touches_.end(),
                       [](const Touch& a, const Touch& b) { return a.at.depth < b.at.depth; });
  for (auto one = touches_.begin(); one != touches_.end(); ++one) {
    Vec2* bristle = one == deepest ? &at.body_bristle[track] : nullptr;
    const Vec3 f =
        terramechanics::tyre_body_force(own.wheels().about(wheel), motion, one->at, dt, bristle);
    // Apply to both at one point, so that no momentum is lost.
    own.tree().add_force(at.wheel_link, f, Vec3::Zero(), one->at.p_W);
    one->body->push(-f, one->at.p_W);
    at.body_W += f;
  }
}

// Both strips of the wheel, at their offsets along the axle.
void TyreBodies::push_tyre(BulletMachine& own, std::size_t machine, std::size_t wheel,
                           btCollisionWorld& world, double dt) {
  const scene::Wheel& about = own.wheels().about(wheel);
  const Pose X_WWheel = own.wheels().motion(own.wheels()[wheel]).X_WWheel;
  const double offset = terramechanics::track_offset(about);
  Disc& at = disc(machine, wheel, about);
  for (std::size_t track = 0; track < 2; ++track) {
    Pose X = X_WWheel;
    X.translation() += (track == 0 ? offset : -offset) * X.linear().col(1);
    at.place(X);
    touch(own, at, about.friction, world);
    push_track(own, wheel, track, dt);
  }
}

// Collects all bodies once, then visits every wheel.
void TyreBodies::push(Machines& machines, const std::vector<Mover>& movers, btCollisionWorld& world,
                      double dt) {
  if (meets_nobody(machines, movers)) return;
  bodies_.gather(machines, movers);
  for (std::size_t m = 0; m < machines.size(); ++m)
    for (std::size_t w = 0; w < machines[m]->wheels().size(); ++w) {
      machines[m]->wheels()[w].body_W.setZero();
      if (machines[m]->wheels().about(w).track)
        tracks_.push(*machines[m], m, w, bodies_, world, dt);
      else
        push_tyre(*machines[m], m, w, world, dt);
    }
}

// A machine alone has no bodies to touch, and keeps its old hash.
void TyreBodies::visit(Archive& a, Machines& machines, const std::vector<Mover>& movers) {
  if (meets_nobody(machines, movers)) return;
  for (std::size_t m = 0; m < machines.size(); ++m)
    for (std::size_t w = 0; w < machines[m]->wheels().size(); ++w)
      a.item(m * limits::kLinks + w, [&] {
        MachineWheel& wheel = machines[m]->wheels()[w];
        a("body_bristle", wheel.body_bristle);
        a("body_W", wheel.body_W);
        if (wheel.body_shear.empty()) return;
        a.fixed("body_shear", wheel.body_shear);
        a("body_p_C", wheel.body_p_C);
      });
}

}  // namespace navvy::vehicle
