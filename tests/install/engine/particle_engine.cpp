// SPDX-License-Identifier: Apache-2.0
#include "particle_engine.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/error.h"
#include "vehicle/physics_engine.h"

namespace example {
namespace {

using namespace navvy;
using vehicle::DriveInput;
using vehicle::LinkState;

constexpr double kFriction = 0.5;

struct Body {
  double mass = 1;       // [kg]
  double clearance = 0;  // height of the base's origin above its lowest point [m]
  Pose X_WB = Pose::Identity();
  Vec3 v_W = Vec3::Zero();
  Vec3 force_W = Vec3::Zero();  // force in the next step [N]
  DriveInput drive;

  void visit(Archive& a) {
    a("X_WB", X_WB);
    a("v_W", v_W);
    a("force_W", force_W);
    a("drive", drive);
    a.require(X_WB.matrix().allFinite(), "X_WB", "a machine has no finite pose");
  }
};

class ParticleEngine final : public vehicle::PhysicsEngine {
 public:
  explicit ParticleEngine(const Vec3& gravity) : gravity_(gravity) {}

  int add_machine(const scene::Machine& machine, const Pose& X_WM) override {
    if (machine.links.size() != 1 || !machine.joints.empty())
      throw InputError(
          Fault{Fault::Severity::kError, machine.file, 0, "machine[" + machine.name + "]",
                std::to_string(machine.links.size()) + " links",
                "a particle engine moves machines of one link", "use the engine built on Bullet"});
    Body body;
    body.mass = machine.links[0].mass;
    body.X_WB = X_WM * machine.links[0].X_ML;
    for (const scene::Collision& collision : machine.links[0].collisions)
      body.clearance = std::max(
          body.clearance, 0.5 * collision.geometry.size.z() - collision.X_LC.translation().z());
    bodies_.push_back(body);
    return machine_count() - 1;
  }
  int machine_count() const override { return static_cast<int>(bodies_.size()); }

  // Only a drive can be commanded, which does not move a body of one link.
  void set_joint(int, int, const vehicle::JointInput&) override {}
  void set_drive(int machine, const DriveInput& input) override { at(machine).drive = input; }
  void set_brake(int, int, bool) override {}
  DriveInput drive(int machine) const override { return at(machine).drive; }

  void apply_impulse(int machine, int, const Vec3& J_W, const Vec3&, const Vec3&) override {
    at(machine).v_W += J_W / at(machine).mass;
  }
  void apply_impulse_of_step(int machine, int link, const Vec3& J_W, const Vec3& L_W,
                             const Vec3& p_W, double dt) override {
    apply_impulse(machine, link, J_W, L_W, p_W);
    at(machine).X_WB.translation() += dt * J_W / at(machine).mass;
  }
  void add_force(int machine, int, const Vec3& f_W, const Vec3&) override {
    at(machine).force_W += f_W;
  }

  void step(double dt, const vehicle::GroundQuery& ground) override {
    if (!(dt > 0))
      throw SimulationError("particle engine: the step must be positive, it is " +
                            std::to_string(dt));
    for (Body& body : bodies_) {
      body.v_W += dt * (gravity_ + body.force_W / body.mass);
      body.force_W.setZero();
      stop_at(body, ground, dt);
      body.X_WB.translation() += dt * body.v_W;
      if (!body.X_WB.matrix().allFinite())
        throw SimulationError("particle engine: a machine has no finite pose");
    }
  }

  vehicle::JointState joint(int, int) const override { return {}; }
  LinkState link(int machine, int) const override {
    return {at(machine).X_WB, at(machine).v_W, Vec3::Zero()};
  }
  vehicle::WheelState wheel(int, int) const override { return {}; }
  Mat6 inverse_mass(int machine, int) const override {
    Mat6 out = Mat6::Zero();
    out.bottomRightCorner<3, 3>() = Mat3::Identity() / at(machine).mass;
    return out;
  }

  void visit(Archive& a) override {
    a.section("particle", 1, [&] {
      a.constant("machines", bodies_.size(),
                 "the snapshot has another number of machines than the scene");
      for (std::size_t b = 0; b < bodies_.size(); ++b) a.item(b, [&] { bodies_[b].visit(a); });
    });
  }

 private:
  Body& at(int machine) { return bodies_.at(static_cast<std::size_t>(machine)); }
  const Body& at(int machine) const { return bodies_.at(static_cast<std::size_t>(machine)); }

  /// Removes the velocity into the ground, inelastically, and lets friction slow the body down.
  static void stop_at(Body& body, const vehicle::GroundQuery& ground, double dt) {
    const Vec3 p = body.X_WB.translation() + dt * body.v_W;
    const double depth = ground.height(p.x(), p.y()) - (p.z() - body.clearance);
    if (depth <= 0) return;
    const double stopped = depth / dt;
    body.v_W.z() += stopped;
    const Vec2 sliding = body.v_W.head<2>();
    const double speed = sliding.norm();
    if (speed > 0) body.v_W.head<2>() -= std::min(1.0, kFriction * stopped / speed) * sliding;
  }

  Vec3 gravity_;
  std::vector<Body> bodies_;
};

}  // namespace

std::unique_ptr<vehicle::PhysicsEngine> make_particle_engine(const Vec3& gravity,
                                                             const scene::Materials&) {
  return std::make_unique<ParticleEngine>(gravity);
}

}  // namespace example
