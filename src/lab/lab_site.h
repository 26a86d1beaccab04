// SPDX-License-Identifier: Apache-2.0
// The ground a rig stands on: columns, particles laid into them, tools that move through them, and
// the clock.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/math.h"
#include "core/stopwatch.h"
#include "heightfield/layered_ground.h"
#include "lab/rig.h"
#include "scene/machine.h"
#include "scene/scene.h"
#include "soil/particles/particle.h"
#include "soil/solver.h"

namespace navvy::lab {

/// An axis-parallel box in W [m].
struct SiteBox {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  bool contains(const Vec3& p) const {
    return (p.array() >= low.array()).all() && (p.array() < high.array()).all();
  }
};

/// A square piece of ground. Cells of its columns and of the soil's grid are the same, and nodes
/// lie at z = 0, so that a bed of whole cells begins and ends on planes of the grid.
struct SiteOptions {
  double size = 40;  ///< edge [m], rounded to whole cells
  /// W of its lower-left corner [m]; without, W's origin is its middle.
  std::optional<Vec2> corner;
  double depth = 4;  ///< from z = 0 down to bedrock [m]
  /// Of the resting ground [m]; empty: flat at 0.
  std::function<double(double x, double y)> surface;
  /// Tilt it for slopes, zero it for weightless cases.
  Vec3 gravity = Vec3(0, 0, -kGravity);
  /// Ground wakes and takes soil back by itself.
  bool exchange = false;
  /// Crowded particles are moved apart [docs/soil.md, crowding].
  bool crowding = true;
  double courant = 0.5;  ///< share of cell / sound speed
  bool energy = false;   ///< keeps an account of it, for the report
};

/// The least whole number of cells that holds `length`, as a length [m]; a billionth of a cell is
/// rounding.
double whole_cells(double length, double cell);

/// Flat ground with a pit that particles are to fill: for SiteOptions::surface.
std::function<double(double, double)> pit(const SiteBox& box);

/// A shell in the soil, moved by the site at every step. A mass of zero makes it scripted: it keeps
/// its twist. With a mass it is a free body whose centre of mass is its frame's origin: weight,
/// `force_W` and the soil move it.
struct Tool {
  soil::ToolMotion motion;       ///< pose and twist before the next step; set the twist here
  soil::ToolImpulse impulse;     ///< of the last step
  double mass = 0;               ///< [kg]
  Vec3 inertia = Vec3::Ones();   ///< principal, about the origin, axes of the shell [kg m2]
  Vec3 force_W = Vec3::Zero();   ///< from outside, weight not included [N]
  Vec3 torque_W = Vec3::Zero();  ///< from outside, about the origin [N m]
  bool lock_rotation = false;    ///< a free body that does not rotate
  /// Free along W's z alone; its other speeds and its turning are kept.
  bool only_sinks = false;
};

/// Soil, tools and clock of one experiment.
///
/// A rig makes one, inserts soil, adds tools, steps and reads; `finish` then writes the common
/// lines of the report. Particles live on the device: `solver().particles()` reads all of them back
/// and is no call for every step. Repeatable bit for bit on one device.
/// @throws InputError for a soil or cell that the solver refuses, SimulationError when the soil
/// stops itself.
class Site {
 public:
  Site(device::Device& device, std::vector<scene::Soil> soils, double cell,
       const SiteOptions& options = {});
  /// With the setup's device, soil, cell, step (`courant`) and progress.
  explicit Site(const Setup& setup, const SiteOptions& options = {});
  /// The same with soils of its own.
  Site(const Setup& setup, std::vector<scene::Soil> soils, const SiteOptions& options);

  // What it is made of; the solver is replaced by set_gravity, so keep no reference to it.
  soil::Solver& solver() { return *solver_; }
  const soil::Solver& solver() const { return *solver_; }
  heightfield::Ground& ground() { return ground_; }
  const heightfield::Ground& ground() const { return ground_; }
  const scene::Scene& world() const { return world_; }
  const scene::Soil& soil(std::size_t index = 0) const { return world_.soils[index]; }
  double cell() const { return world_.solver.cell; }
  double time() const { return time_; }  ///< simulated [s]

  // Particles, at rest and of bank density unless changed by the caller.
  /// A particle at p_W that stands for `volume` of bank soil [m3].
  soil::Particle particle(const Vec3& p_W, double volume, int soil = 0) const;
  /// Particles on a lattice of half a cell (eight a cell) whose middles lie in the box and where
  /// `keep` allows (may be empty). The lattice starts at the box's low corner.
  std::vector<soil::Particle> fill(const SiteBox& box,
                                   const std::function<bool(const Vec3&)>& keep = {},
                                   int soil = 0) const;
  /// Gives particles the stress of level ground at rest under `surface(x, y)` [m] plus `surcharge`
  /// [Pa]: sigma_x = K0 sigma_z with K0 = nu / (1 - nu), gravity's z component.
  void rest(std::vector<soil::Particle>& particles,
            const std::function<double(double, double)>& surface, double surcharge = 0) const;
  void rest(std::vector<soil::Particle>& particles, double surface, double surcharge = 0) const;
  Vec3 position(const soil::Particle& particle) const;  ///< in W [m]
  /// Pressure that the law carries at a particle's volume ratio, positive in compression [Pa].
  double pressure(const soil::Particle& particle) const;

  /// Puts a shell into the soil at a pose, at rest and scripted; returns its number for `tool`.
  int add_tool(const scene::Shell& shell, const Pose& X_WT);
  /// @throws std::out_of_range for a number that add_tool did not give.
  Tool& tool(int index) { return tools_.at(static_cast<std::size_t>(index)); }

  /// The stable step at the tools' present speed, or at `speed` when that is more [s].
  double step_limit(double speed = 0) const;
  /// One step [s] of soil and tools: free tools take up the impulses of the soil at its end.
  void step(double dt);
  /// Steps for `seconds` at the step limit (or at most `dt` when given); calls `each` after every
  /// step.
  void run(double seconds, const std::function<void()>& each = {}, double dt = 0);
  /// Turns or scales gravity; soil, tools and clock go on.
  void set_gravity(const Vec3& gravity);

  /// How long the whole experiment will take, for the progress report [s simulated].
  void expect(double seconds) { expected_ = seconds; }
  /// Of action and reaction, share of the scale.
  double worst_residual() const { return worst_residual_; }
  soil::EnergyAccount energy() const;  ///< all zero unless one is kept
  /// Of the soil's state, as `state_hash` of a report.
  std::string digest() const;
  /// Fills particles, steps, times, ledger and hash.
  void finish(Report& report) const;

 private:
  void make_solver();
  void push_tool(Tool& tool, double dt) const;  ///< weight and outside forces, before the soil
  // After the soil: its impulse, then the pose.
  static void move_tool(Tool& tool, double dt);

  device::Device* device_;
  scene::Scene world_;
  heightfield::Ground ground_;
  bool crowding_, energy_;
  soil::EnergyAccount energy_before_;  ///< of solvers that were replaced
  std::unique_ptr<soil::Solver> solver_;
  std::vector<scene::Shell> shells_;
  std::vector<Tool> tools_;
  std::vector<soil::ToolMotion> motions_;
  std::vector<soil::ToolImpulse> impulses_;
  std::function<void(double)> progress_;
  Stopwatch watch_;
  double time_ = 0, expected_ = 0;  ///< [s]
  double worst_residual_ = 0;
  double shown_ = 0;  ///< share that progress_ was told last
};

}  // namespace navvy::lab
