// SPDX-License-Identifier: Apache-2.0
// A machine on columns of one soil without particles: engine, tyres and ruts only, stepped as a
// world does.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "coupling/ground_view.h"
#include "coupling/machine_placing.h"
#include "coupling/ruts.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "vehicle/physics_engine.h"

namespace navvy::coupling::testing {

/// Columns of `soil` 2 m deep with their corner at (0, 0); the surface is a function of the place
/// [m].
inline heightfield::Ground bed(const scene::Soil& soil, double cell, const Vec2& size,
                               const std::function<double(double, double)>& height = {}) {
  heightfield::GroundSetup setup;
  setup.nx = static_cast<int>(std::lround(size.x() / cell));
  setup.ny = static_cast<int>(std::lround(size.y() / cell));
  setup.cell = cell;
  setup.datum = -20;
  setup.soils = {soil};
  setup.layers = {{soil.name, 100}};
  setup.surface = [height, cell](int ix, int iy) {
    return height ? height(cell * (ix + 0.5), cell * (iy + 0.5)) : 0;
  };
  return heightfield::Ground(std::move(setup));
}

inline scene::Soil shipped_soil(const std::string& name) {
  for (const scene::Soil& soil : scene_io::load_soils(navvy::source_dir() + "/terrain/soils"))
    if (soil.name == name) return soil;
  return {};
}

/// One machine on a bed, or on firm ground.
class Ride {
 public:
  Ride(const scene::Machine& machine, heightfield::Ground& ground, const Vec2& at,
       bool firm = false)
      : machine_(machine),
        ruts_(ground),
        view_(ground, ground.setup().soils, &ruts_),
        firm_(firm),
        engine_(vehicle::make_bullet_engine(Vec3(0, 0, -kGravity))) {
    scene::MachineInWorld placed;
    placed.machine = machine;
    placed.X_WM = make_pose(at.x(), at.y(), 0);
    engine_->add_machine(machine_, place(placed, ground));
  }

  void run(double seconds, const std::function<void()>& each = {}) {
    for (int n = static_cast<int>(std::lround(seconds / kStep)); n > 0; --n) {
      engine_->step(kStep, firm_ ? static_cast<const terramechanics::GroundQuery&>(floor_) : view_);
      if (steps_++ % kRutInterval == 0 && !firm_) press();
      if (each) each();
    }
  }

  vehicle::PhysicsEngine& engine() { return *engine_; }
  vehicle::WheelState wheel(int w) const { return engine_->wheel(0, w); }
  Vec3 place_of_base() const { return engine_->link(0, 0).X_WL.translation(); }

  static constexpr double kStep = 1.0 / 600;

 private:
  /// A floor at 0 without a soil.
  class Floor final : public terramechanics::GroundQuery {
   public:
    double height(double, double) const override { return 0; }
    Vec3 normal(double, double) const override { return Vec3::UnitZ(); }
  };

  void press() {
    std::vector<LoadedTyre> tyres;
    for (std::size_t w = 0; w < machine_.wheels.size(); ++w)
      tyres.push_back({machine_.wheels[w], engine_->wheel(0, static_cast<int>(w))});
    ruts_.press(tyres, kRutInterval * kStep);
  }

  scene::Machine machine_;
  Ruts ruts_;
  GroundView view_;
  bool firm_;
  Floor floor_;
  std::unique_ptr<vehicle::PhysicsEngine> engine_;
  int steps_ = 0;
};

inline scene::Machine shipped_machine(const std::string& name) {
  return scene_io::load_machine(navvy::source_dir() + "/vehicles/" + name + "/model.sdf");
}

}  // namespace navvy::coupling::testing
