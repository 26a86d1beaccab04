// SPDX-License-Identifier: Apache-2.0
#include "coupling/settling.h"

#include <algorithm>
#include <cmath>

#include "coupling/ground_view.h"
#include "coupling/hitching.h"
#include "coupling/machine_placing.h"
#include "coupling/ruts.h"
#include "coupling/track_ruts.h"
#include "vehicle/physics_engine.h"
#include "vehicle/stability.h"

namespace navvy::coupling {
namespace {

constexpr double kStep = 0.0017;  // about as long as in a run [s]

/// Heights of base links above those at the start.
class Risen {
 public:
  Risen(const vehicle::PhysicsEngine& engine, std::size_t machines)
      : engine_(engine), most_(machines, 0) {
    for (std::size_t i = 0; i < machines; ++i)
      start_.push_back(engine.link(static_cast<int>(i), 0).X_WL);
  }
  void look() {
    for (std::size_t i = 0; i < most_.size(); ++i) most_[i] = std::max(most_[i], lift(i));
  }
  double most(std::size_t machine) const { return most_[machine]; }
  double lift(std::size_t machine) const {
    return engine_.link(static_cast<int>(machine), 0).X_WL.translation().z() -
           start_[machine].translation().z();
  }
  double turn(std::size_t machine) const {
    const Mat3 R = engine_.link(static_cast<int>(machine), 0).X_WL.linear();
    return Eigen::AngleAxisd(Mat3(start_[machine].linear().transpose() * R)).angle();
  }

 private:
  const vehicle::PhysicsEngine& engine_;
  std::vector<Pose> start_;
  std::vector<double> most_;
};

}  // namespace

// Repeats the run's sequence of engine and ruts without the soil solver.
std::vector<Settled> settle(const scene::Scene& scene, heightfield::Ground& ground, double time) {
  std::vector<Settled> out(scene.machines.size());
  const auto engine = vehicle::make_bullet_engine(scene.gravity, scene.materials);
  std::vector<std::size_t> of;  // machine of the scene, by index in the engine
  for (std::size_t m = 0; m < scene.machines.size(); ++m) {
    const scene::MachineInWorld& placed = scene.machines[m];
    // Kinematic machines stand where they are placed, so they have nothing to settle.
    if (placed.machine.kinematic) continue;
    engine->add_machine(placed.machine, place(placed, ground));
    of.push_back(m);
  }
  if (of.empty()) return out;
  if (vehicle::RockCapability* rock = engine->rock()) rock->set_rock(ground.datum());
  // Hitches name machines of the scene; kinematic ones are refused when a scene is read.
  add_hitches(scene, *engine, [&of](int machine) {
    return static_cast<int>(std::find(of.begin(), of.end(), static_cast<std::size_t>(machine)) -
                            of.begin());
  });
  Ruts ruts(ground);
  TrackRuts track_ruts(ground, ruts);
  const GroundView view(ground, ground.setup().soils, &ruts);
  const double dt = std::min(kStep, scene.solver.max_step);
  const int steps = static_cast<int>(std::ceil(time / dt));
  Risen risen(*engine, of.size());
  for (int step = 0; step < steps; ++step) {
    engine->step(dt, view);
    risen.look();
    if (step % kRutInterval != 0) continue;
    std::vector<LoadedTyre> tyres;
    std::vector<terramechanics::TrackPatch> running_tracks;
    for (std::size_t i = 0; i < of.size(); ++i) {
      const std::vector<scene::Wheel>& wheels = scene.machines[of[i]].machine.wheels;
      for (std::size_t w = 0; w < wheels.size(); ++w) {
        const int machine = static_cast<int>(i), wheel = static_cast<int>(w);
        if (!wheels[w].track) {
          tyres.push_back({wheels[w], engine->wheel(machine, wheel)});
          continue;
        }
        for (const terramechanics::TrackPatch& patch :
             vehicle::track_patches(*engine, machine, wheel))
          running_tracks.push_back(patch);
      }
    }
    const double interval = kRutInterval * dt;
    ruts.press(tyres, interval);
    if (!running_tracks.empty())
      track_ruts.press(running_tracks, kSinkSpeed * interval, tyres.empty());
  }
  for (std::size_t i = 0; i < of.size(); ++i)
    out[of[i]] = {vehicle::stability(scene.machines[of[i]].machine, *engine, static_cast<int>(i)),
                  -engine->link(static_cast<int>(i), 0).v_WL.z(),
                  risen.most(i),
                  risen.lift(i),
                  risen.turn(i),
                  !scene.machines[of[i]].machine.fixed_base};
  return out;
}

}  // namespace navvy::coupling
