// SPDX-License-Identifier: Apache-2.0
// 1.4 t of soil in the excavator's bucket of 0.7 t, supported by a servo, at the default step and
// at half of it.
#include <gtest/gtest.h>

#include <cmath>

#include "soil/rig.h"
#include "soil/tools/shell_geometry.h"
#include "validation/report.h"
#include "validation/scenes.h"

namespace navvy::validation {
namespace {

constexpr const char* kSource =
    "1.4 t in the 0.7 t bucket [docs/validation.md, Buckets and carried loads]";
constexpr double kLoad = 1400;  ///< [kg]

/// The bucket as a free body on a servo that holds its position and attitude.
class HangingBucket {
 public:
  explicit HangingBucket(const scene::Machine& machine, double dt)
      : link_(machine.links.at(static_cast<std::size_t>(machine.link_index("bucket")))), dt_(dt) {
    const scene::Shell& shell = machine.shells.at(0);
    // The mouth faces -z of the link: upside down, the bucket holds its load.
    home_ = make_pose(10.03, 10.02, 2.0, kPi, 0, 0);
    const soil::ShellGeometry geometry(shell, 0.1);
    std::vector<Vec3> places;
    const double h = 0.05;
    for (double z = -1.5; z < 1.5; z += h)
      for (double y = -0.6; y < 0.6; y += h)
        for (double x = -0.5; x < 1.6; x += h) {
          const Vec3 p(x, y, z);
          // Level with the rim and 8 cm high; inside is +z of the link.
          if (z > -0.08 && x > 0.2 && x < 1.2 && geometry.holds(p) && geometry.distance(p) > 0.04)
            places.push_back(home_ * p);
        }
    scene::Soil soil = soil::rig::sand(35);
    soil.cohesion = soil.residual_cohesion = 3000;
    soil.bank_density = kLoad / (static_cast<double>(places.size()) * h * h * h);
    rig_ = std::make_unique<soil::rig::Rig>(std::vector<scene::Soil>{soil});
    motion_.tool = rig_->solver().add_tool(shell);
    motion_.X_WT = home_;
    std::vector<soil::Particle> load;
    load.reserve(places.size());
    for (const Vec3& p : places) load.push_back(rig_->particle(p, h * h * h));
    rig_->solver().insert(load);
    std::printf("%zu particles of %.0f kg/m3, %.0f kg\n", load.size(), soil.bank_density, kLoad);
  }

  /// Largest and rms acceleration of the bucket, and its energy, over a stretch.
  struct Stretch {
    double rms = 0, most_speed = 0, sag = 0, mean_force = 0;
  };
  /// `shift` moves the servo's target [m] while the load swings along.
  Stretch run(double seconds, const Vec3& velocity = Vec3::Zero()) {
    Stretch out;
    const int steps = static_cast<int>(std::lround(seconds / dt_));
    for (int i = 0; i < steps; ++i) {
      target_ += velocity * dt_;
      const Vec3 before = motion_.v_WT;
      step();
      out.rms += ((motion_.v_WT - before) / dt_).squaredNorm() / steps;
      out.most_speed = std::max(out.most_speed, motion_.v_WT.norm());
      out.mean_force -= impulse_.J_W.z() / dt_ / steps;
    }
    out.rms = std::sqrt(out.rms);
    out.sag = (motion_.X_WT.translation() - home_.translation() - target_).norm();
    return out;
  }
  double payload() const { return rig_->solver().payload(motion_.tool, motion_.X_WT); }
  const soil::Solver& solver() const { return rig_->solver(); }
  double worst() const { return worst_; }

 private:
  void step() {
    // A stiff servo, like an arm with closed valves: 4 Hz for bucket and load together, with their
    // weight compensated.
    const double omega = 2 * kPi * 4, total = link_.mass + kLoad;
    const double stiffness = total * omega * omega, damping = 2 * 0.7 * total * omega,
                 gyration2 = 0.4;
    const Mat3 R = motion_.X_WT.linear();
    const Vec3 arm = R * link_.p_LCom;
    const Eigen::AngleAxisd turn(R * home_.linear().transpose());
    const Vec3 force = -stiffness * (motion_.X_WT.translation() - home_.translation() - target_) -
                       damping * motion_.v_WT + Vec3(0, 0, kLoad * kGravity);
    const Vec3 torque =
        -gyration2 * (stiffness * turn.angle() * turn.axis() + damping * motion_.w_WT) +
        kLoad * kGravity * arm.cross(Vec3::UnitZ());
    // Inertia about the link's origin; the body rotates slowly, so gyroscopic terms are omitted.
    Mat3 cross;
    cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
    Mat6 inertia;
    inertia.topLeftCorner<3, 3>() = R * link_.inertia * R.transpose() - link_.mass * cross * cross;
    inertia.topRightCorner<3, 3>() = link_.mass * cross;
    inertia.bottomLeftCorner<3, 3>() = -link_.mass * cross;
    inertia.bottomRightCorner<3, 3>() = link_.mass * Mat3::Identity();
    motion_.inverse_mass = inertia.inverse();
    Vec6 wrench;
    wrench << torque, force;
    kick(wrench * dt_);
    rig_->solver().step(dt_, std::span(&motion_, 1), std::span(&impulse_, 1));
    worst_ = std::max(worst_, impulse_.residual.norm() / std::max(impulse_.scale, 1e-9));
    Vec6 impulse;
    impulse << impulse_.L_W, impulse_.J_W;
    kick(impulse);
    const double angle = motion_.w_WT.norm() * dt_;
    if (angle > 0) motion_.X_WT.linear() = Eigen::AngleAxisd(angle, motion_.w_WT.normalized()) * R;
    motion_.X_WT.translation() += motion_.v_WT * dt_;
  }
  void kick(const Vec6& impulse) {
    const Vec6 change = motion_.inverse_mass * impulse;
    motion_.w_WT += change.head<3>();
    motion_.v_WT += change.tail<3>();
  }

  scene::Link link_;
  double dt_;
  Pose home_;
  Vec3 target_ = Vec3::Zero();
  std::unique_ptr<soil::rig::Rig> rig_;
  soil::ToolMotion motion_;
  soil::ToolImpulse impulse_;
  double worst_ = 0;
};

class HeavyBucket : public testing::TestWithParam<double> {};

TEST_P(HeavyBucket, CarriesTwiceItsMassWithoutChatter) {
  const scene::Scene world = load_scene("trench.sdf");
  HangingBucket bucket(world.machines.at(0).machine, world.solver.max_step * GetParam());
  bucket.run(1.2);
  const auto rest = bucket.run(1.0);
  const auto swing = bucket.run(0.8, Vec3(0.8, 0.3, 0.4));
  bucket.run(1.0);
  const auto again = bucket.run(0.5);
  // Explicit exchange of impulses rings at 15 to 29 m/s2.
  expect_between("rms acceleration at rest [m/s2]", rest.rms, 0, 1.5, kSource);
  expect_between("force of the load / weight", rest.mean_force / (kLoad * kGravity), 0.98, 1.02,
                 kSource);
  expect_between("fastest while its servo moves at 0.94 m/s", swing.most_speed, 0.8, 1.5, kSource);
  expect_between("rms acceleration at rest again [m/s2]", again.rms, 0, 1.5, kSource);
  expect_between("off its servo's target [m]", again.sag, 0, 0.05, kSource);
  expect_between("payload / load", bucket.payload() / kLoad, 0.95, 1.001, kSource);
  expect_between("shell crossings", static_cast<double>(bucket.solver().stats().shell_crossings), 0,
                 0, kSource);
  expect_between("nodal solve: residual / scale", bucket.worst(), 0, 1e-5, kSource);
}

INSTANTIATE_TEST_SUITE_P(Step, HeavyBucket, testing::Values(1.0, 0.5),
                         [](const auto& share) { return share.param == 1 ? "Default" : "Half"; });

}  // namespace
}  // namespace navvy::validation
