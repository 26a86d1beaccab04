// SPDX-License-Identifier: Apache-2.0
// Sensors of tools and contacts: soil forces, payload, contact switch.
#include <algorithm>
#include <array>

#include "sensor/instrument.h"

namespace navvy::sensor {
namespace {

class ToolForceInstrument final : public Instrument {
 public:
  ToolForceInstrument(const scene::ToolForce& kind, const Mounting& at, Random& random)
      : tool_(at.machine_handle().tool(kind.shell)), carrier_(carrier_of(kind, at)) {
    for (Noise& noise : force_) noise = Noise(kind.force, random);
    for (Noise& noise : moment_) noise = Noise(kind.moment, random);
  }

  std::vector<MeasuredQuantity> quantities() const override {
    return {{"wrench",
             "N, N m",
             "force of the soil on the tool and its moment about the sensor, in its axes",
             sim::ElementType::kFloat64,
             {6}}};
  }
  void measure(int, const Pose& X_WS, Values& out) override {
    const Vec3 f_W = tool_.force();
    // The tool's moment is about the origin of its own link.
    const Vec3 p_SL_W = carrier_.pose().translation() - X_WS.translation();
    const Mat3 R_SW = X_WS.linear().transpose();
    const Vec3 f = R_SW * f_W, m = R_SW * (tool_.moment() + p_SL_W.cross(f_W));
    out[0] = {f.x(), f.y(), f.z(), m.x(), m.y(), m.z()};
  }
  void finish(Values& out, double dt, Random& random) override {
    for (std::size_t i = 0; i < 6; ++i) {
      Noise& noise = i < 3 ? force_[i] : moment_[i - 3];
      noise.advance(dt, random);
      out[0][i] = noise.apply(out[0][i], random);
    }
  }
  void visit(Archive& a) override {
    a("force", force_);
    a("moment", moment_);
  }

 private:
  static sim::LinkHandle carrier_of(const scene::ToolForce& kind, const Mounting& at) {
    const auto& shells = at.machine_handle().description().shells;
    const auto shell = std::find_if(shells.begin(), shells.end(), [&](const scene::Shell& one) {
      return one.name == kind.shell;
    });
    return at.machine_handle().link(shell->link);
  }

  sim::ToolHandle tool_;
  sim::LinkHandle carrier_;  ///< link of the tool
  std::array<Noise, 3> force_, moment_;
};

class PayloadInstrument final : public Instrument {
 public:
  PayloadInstrument(const scene::PayloadScale& kind, const Mounting& at, Random& random)
      : tool_(at.machine_handle().tool(kind.shell)),
        factor_(1 + kind.scale_error * gaussian(random)),
        noise_(kind.noise, random) {}

  std::vector<MeasuredQuantity> quantities() const override {
    return {{"mass", "kg", "mass of the soil in the tool", sim::ElementType::kFloat64, {1}}};
  }
  void measure(int, const Pose&, Values& out) override { out[0] = {tool_.payload()}; }
  void finish(Values& out, double dt, Random& random) override {
    noise_.advance(dt, random);
    out[0][0] = noise_.apply(factor_ * out[0][0], random);
  }
  void visit(Archive& a) override {
    a("factor", factor_);
    a("noise", noise_);
  }

 private:
  sim::ToolHandle tool_;
  double factor_;  ///< reading / mass without noise
  Noise noise_;
};

class ContactInstrument final : public Instrument {
 public:
  ContactInstrument(const scene::ContactSwitch& kind, const Mounting& at)
      : threshold_(kind.threshold), at_(at) {}

  std::vector<MeasuredQuantity> quantities() const override {
    return {{"contact",
             "1, N",
             "1 if the switch was closed since the last reading, and the largest normal force",
             sim::ElementType::kFloat64,
             {2}}};
  }
  // A touch between two readings must not be missed.
  void follow() override {
    double sum = 0;
    bool touched = false;
    for (const sim::MachineContact& contact : at_.world.machines().contacts()) {
      const bool first = contact.machine == at_.machine && contact.link == at_.link;
      const bool second = contact.other_machine == at_.machine && contact.other_link == at_.link;
      if (!first && !second) continue;
      sum += contact.force;
      touched = true;
    }
    largest_ = std::max(largest_, sum);
    closed_ = closed_ || (touched && sum >= threshold_);
  }
  void measure(int, const Pose&, Values& out) override {
    out[0] = {closed_ ? 1.0 : 0.0, largest_};
    closed_ = false;
    largest_ = 0;
  }
  void finish(Values&, double, Random&) override {}
  void visit(Archive& a) override {
    a("closed", closed_);
    a("largest", largest_);
  }

 private:
  double threshold_;
  Mounting at_;
  bool closed_ = false;  ///< true if the switch was closed since the last reading
  double largest_ = 0;   ///< largest sum of normal forces since then [N]
};

}  // namespace

std::unique_ptr<Instrument> make(const scene::ToolForce& kind, const Mounting& at, Random& random) {
  return std::make_unique<ToolForceInstrument>(kind, at, random);
}

std::unique_ptr<Instrument> make(const scene::PayloadScale& kind, const Mounting& at,
                                 Random& random) {
  return std::make_unique<PayloadInstrument>(kind, at, random);
}

std::unique_ptr<Instrument> make(const scene::ContactSwitch& kind, const Mounting& at, Random&) {
  return std::make_unique<ContactInstrument>(kind, at);
}

}  // namespace navvy::sensor
