// SPDX-License-Identifier: Apache-2.0
// Inertial measurement unit. It moves with its link: a turning base accelerates it by its lever
// arm.
#include <array>

#include "sensor/instrument.h"

namespace navvy::sensor {
namespace {

/// Errors of three components.
class VectorNoise {
 public:
  VectorNoise(const scene::NoiseOfVector& noise, Random& random)
      : part_{Noise(noise.x.noise, random), Noise(noise.y.noise, random),
              Noise(noise.z.noise, random)} {}
  void apply(std::vector<double>& values, double dt, Random& random) {
    for (std::size_t i = 0; i < part_.size(); ++i) {
      part_[i].advance(dt, random);
      values[i] = part_[i].apply(values[i], random);
    }
  }
  void visit(Archive& a) { a("part", part_); }

 private:
  std::array<Noise, 3> part_;
};

class ImuInstrument final : public Instrument {
 public:
  ImuInstrument(const scene::Imu& kind, const Mounting& at, Random& random)
      : world_(at.world),
        link_(at.link_handle()),
        p_LS_(at.description.X_LS.translation()),
        rate_noise_(kind.angular_velocity, random),
        force_noise_(kind.linear_acceleration, random) {}

  std::vector<MeasuredQuantity> quantities() const override {
    return {{"angular_velocity",
             "rad/s",
             "angular velocity in axes of the sensor",
             sim::ElementType::kFloat64,
             {3}},
            {"linear_acceleration",
             "m/s2",
             "specific force in axes of the sensor",
             sim::ElementType::kFloat64,
             {3}},
            {"orientation",
             "1",
             "quaternion w x y z from the sensor to the world, without errors",
             sim::ElementType::kFloat64,
             {4}}};
  }
  // The mean acceleration since the last reading: what an IMU integrates and reports.
  void measure(int, const Pose& X_WS, Values& out) override {
    const vehicle::LinkState state = link_.state();
    const Vec3 v_WS = state.v_WL + state.w_WL.cross(state.X_WL.linear() * p_LS_);
    const double now = world_.time();
    Vec3 a_W = Vec3::Zero();
    if (time_ >= 0 && now > time_) a_W = (v_WS - v_WS_) / (now - time_);
    v_WS_ = v_WS;
    time_ = now;
    const Mat3 R_SW = X_WS.linear().transpose();
    put(R_SW * state.w_WL, out[0]);
    put(R_SW * (a_W - world_.description().gravity), out[1]);
    const Eigen::Quaterniond q(X_WS.linear());
    out[2] = {q.w(), q.x(), q.y(), q.z()};
  }
  void finish(Values& out, double dt, Random& random) override {
    rate_noise_.apply(out[0], dt, random);
    force_noise_.apply(out[1], dt, random);
  }
  void visit(Archive& a) override {
    a("rate_noise", rate_noise_);
    a("force_noise", force_noise_);
    a("v_WS", v_WS_);
    a("time", time_);
  }

 private:
  static void put(const Vec3& v, std::vector<double>& out) { out = {v.x(), v.y(), v.z()}; }

  const sim::World& world_;
  sim::LinkHandle link_;
  Vec3 p_LS_;  ///< lever arm: place of the sensor in its link [m]
  VectorNoise rate_noise_, force_noise_;
  Vec3 v_WS_ = Vec3::Zero();  ///< velocity of the sensor at the last reading [m/s]
  double time_ = -1;          ///< time of the last reading [s]; -1: none
};

}  // namespace

std::unique_ptr<Instrument> make(const scene::Imu& kind, const Mounting& at, Random& random) {
  return std::make_unique<ImuInstrument>(kind, at, random);
}

}  // namespace navvy::sensor
