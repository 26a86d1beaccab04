// SPDX-License-Identifier: Apache-2.0
// Sensors of a joint and of its cylinder.
#include <algorithm>
#include <array>

#include "sensor/instrument.h"

namespace navvy::sensor {
namespace {

class JointInstrument final : public Instrument {
 public:
  JointInstrument(const scene::JointGauge& kind, const Mounting& at, Random& random)
      : joint_(at.machine_handle().joint(kind.joint)),
        noise_{Noise(kind.position.noise, random), Noise(kind.velocity.noise, random),
               Noise(kind.effort.noise, random)} {}

  std::vector<MeasuredQuantity> quantities() const override {
    return {{"state",
             "rad|m, rad/s|m/s, N m|N",
             "position, velocity and effort of the joint",
             sim::ElementType::kFloat64,
             {3}}};
  }
  void measure(int, const Pose&, Values& out) override {
    const vehicle::JointState state = joint_.state();
    out[0] = {state.position, state.velocity, state.effort};
  }
  void finish(Values& out, double dt, Random& random) override {
    for (std::size_t i = 0; i < noise_.size(); ++i) {
      noise_[i].advance(dt, random);
      out[0][i] = noise_[i].apply(out[0][i], random);
    }
  }
  void visit(Archive& a) override { a("noise", noise_); }

 private:
  sim::JointHandle joint_;
  std::array<Noise, 3> noise_;
};

/// Returns the cylinder with this name; the reader has checked that it exists.
const scene::Cylinder& cylinder_of(const Mounting& at, const std::string& name) {
  const auto& cylinders = at.machine_handle().description().cylinders;
  return *std::find_if(cylinders.begin(), cylinders.end(),
                       [&](const scene::Cylinder& one) { return one.name == name; });
}

class PressureInstrument final : public Instrument {
 public:
  PressureInstrument(const scene::CylinderPressure& kind, const Mounting& at, Random& random)
      : joint_(at.machine_handle().joint(cylinder_of(at, kind.cylinder).joint)),
        head_(kind.pressure, random),
        rod_(kind.pressure, random),
        length_(kind.length, random) {
    const scene::Cylinder& cylinder = cylinder_of(at, kind.cylinder);
    const double bore2 = cylinder.bore * cylinder.bore;
    head_area_ = 0.25 * kPi * cylinder.count * bore2;
    rod_area_ = 0.25 * kPi * cylinder.count * (bore2 - cylinder.rod * cylinder.rod);
  }

  std::vector<MeasuredQuantity> quantities() const override {
    return {{"pressure",
             "Pa",
             "pressure on the head side and on the rod side",
             sim::ElementType::kFloat64,
             {2}},
            {"length", "m", "distance between the pins", sim::ElementType::kFloat64, {1}}};
  }
  // The side that carries the load has its pressure; the other side drains to the tank.
  void measure(int, const Pose&, Values& out) override {
    const vehicle::JointState state = joint_.state();
    out[0] = {std::max(0.0, state.cylinder_force) / head_area_,
              std::max(0.0, -state.cylinder_force) / rod_area_};
    out[1] = {state.cylinder_length};
  }
  void finish(Values& out, double dt, Random& random) override {
    const auto apply = [&](Noise& noise, double& value) {
      noise.advance(dt, random);
      value = noise.apply(value, random);
    };
    apply(head_, out[0][0]);
    apply(rod_, out[0][1]);
    apply(length_, out[1][0]);
  }
  void visit(Archive& a) override {
    a("head", head_);
    a("rod", rod_);
    a("length", length_);
  }

 private:
  sim::JointHandle joint_;
  Noise head_, rod_, length_;
  double head_area_, rod_area_;  ///< areas of all cylinders side by side [m2]
};

}  // namespace

std::unique_ptr<Instrument> make(const scene::JointGauge& kind, const Mounting& at,
                                 Random& random) {
  return std::make_unique<JointInstrument>(kind, at, random);
}

std::unique_ptr<Instrument> make(const scene::CylinderPressure& kind, const Mounting& at,
                                 Random& random) {
  return std::make_unique<PressureInstrument>(kind, at, random);
}

}  // namespace navvy::sensor
