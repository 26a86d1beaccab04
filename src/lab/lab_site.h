// SPDX-License-Identifier: Apache-2.0
// Ground of a rig: columns, particles placed in them, tools that move through them, and the clock.
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

/// Axis-parallel box in W [m].
struct SiteBox {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  /// Returns true for a point inside or on the low faces.
  bool contains(const Vec3& p) const {
    return (p.array() >= low.array()).all() && (p.array() < high.array()).all();
  }
};

/// Options of a square piece of ground. Its columns and the soil's grid have the same cells, and
/// nodes lie at z = 0, so that a bed of whole cells begins and ends on planes of the grid.
struct SiteOptions {
  /// Edge [m], rounded to whole cells.
  double size = 40;
  /// Lower-left corner in W [m]; without it, the origin of W is the centre.
  std::optional<Vec2> corner;
  /// Depth of bedrock below z = 0 [m].
  double depth = 4;
  /// Height of the resting ground [m]; empty: flat at 0.
  std::function<double(double x, double y)> surface;
  /// Tilted for slopes, zero for weightless cases.
  Vec3 gravity = Vec3(0, 0, -kGravity);
  /// Ground becomes particles and takes soil back by itself.
  bool exchange = false;
  /// Crowded particles separate [docs/soil.md, crowding].
  bool crowding = true;
  /// Courant number: step x sound speed / cell.
  double courant = 0.5;
  /// Keeps an energy account for the report.
  bool energy = false;
  /// Constants of the particle method.
  soil::SchemeConstants scheme;
};

/// Returns the smallest whole number of cells that covers `length`, as a length [m]. A billionth of
/// a cell counts as rounding.
double whole_cells(double length, double cell);

/// Returns flat ground with a pit to be filled with particles, for SiteOptions::surface.
std::function<double(double, double)> pit(const SiteBox& box);

/// A shell in the soil, moved by the site in every step. With zero mass it is scripted and keeps
/// its twist. With a mass it is a free body whose centre of mass is the origin of its frame;
/// weight, `force_W` and the soil move it.
struct Tool {
  /// Pose and twist before the next step; set the twist here.
  soil::ToolMotion motion;
  /// Impulse of the last step.
  soil::ToolImpulse impulse;
  /// [kg].
  double mass = 0;
  /// Principal moments about the origin, axes of the shell [kg m2].
  Vec3 inertia = Vec3::Ones();
  /// External force without weight [N].
  Vec3 force_W = Vec3::Zero();
  /// External torque about the origin [N m].
  Vec3 torque_W = Vec3::Zero();
  /// A free body that does not rotate.
  bool lock_rotation = false;
  /// Free along W's z alone; its other velocities are prescribed.
  bool only_sinks = false;
};

/// Soil, tools and clock of one experiment.
///
/// A rig creates a site, inserts soil, adds tools, steps and reads; `finish` then writes the common
/// lines of the report. Particles live on the device: `solver().particles()` copies all of them, so
/// it should not be called in every step. Results are bit-repeatable on one device.
/// @throws InputError for a soil or cell that the solver rejects.
/// @throws SimulationError when the soil stops itself.
class Site {
 public:
  Site(device::Device& device, std::vector<scene::Soil> soils, double cell,
       const SiteOptions& options = {});
  /// Uses device, soil, cell, step (`courant`), scheme and progress of the setup.
  explicit Site(const Setup& setup, const SiteOptions& options = {});
  /// Does the same with other soils.
  Site(const Setup& setup, std::vector<scene::Soil> soils, const SiteOptions& options);

  // Access to the parts. set_gravity replaces the solver, so keep no reference to it.
  soil::Solver& solver() { return *solver_; }
  const soil::Solver& solver() const { return *solver_; }
  heightfield::Ground& ground() { return ground_; }
  const heightfield::Ground& ground() const { return ground_; }
  const scene::Scene& world() const { return world_; }
  /// Returns a soil of the site.
  const scene::Soil& soil(std::size_t index = 0) const { return world_.soils[index]; }
  /// Returns the edge of a cell [m].
  double cell() const { return world_.solver.cell; }
  /// Simulated time [s].
  double time() const { return time_; }

  // Particles, at rest and at bank density unless the caller changes them.
  /// Returns a particle at p_W [m] for `volume` of bank soil [m3].
  soil::Particle particle(const Vec3& p_W, double volume, int soil = 0) const;
  /// Returns particles on a lattice of half a cell (eight per cell) whose centres lie in the box
  /// and where `keep` allows (may be empty). The lattice starts at the box's low corner.
  std::vector<soil::Particle> fill(const SiteBox& box,
                                   const std::function<bool(const Vec3&)>& keep = {},
                                   int soil = 0) const;
  /// Sets the stress of level ground at rest under `surface(x, y)` [m] plus `surcharge` [Pa]:
  /// sigma_x = K0 sigma_z with K0 = nu / (1 - nu), for the z component of gravity.
  void rest(std::vector<soil::Particle>& particles,
            const std::function<double(double, double)>& surface, double surcharge = 0) const;
  void rest(std::vector<soil::Particle>& particles, double surface, double surcharge = 0) const;
  /// Returns the position in W [m].
  Vec3 position(const soil::Particle& particle) const;
  /// Returns the pressure of the law at a particle's volume ratio, positive in compression [Pa].
  double pressure(const soil::Particle& particle) const;

  /// Adds a shell at a pose, at rest and scripted; returns its number for `tool`.
  int add_tool(const scene::Shell& shell, const Pose& X_WT);
  /// Returns a tool.
  /// @throws std::out_of_range for a number that add_tool did not return.
  Tool& tool(int index) { return tools_.at(static_cast<std::size_t>(index)); }

  /// Returns the stable step at the tools' present speed, or at `speed` if that is higher [s].
  double step_limit(double speed = 0) const;
  /// Advances soil and tools by dt [s]; free tools receive the impulses of the soil at its end.
  void step(double dt);
  /// Advances by `seconds` with the step limit (or at most `dt` if given); calls `each` after every
  /// step.
  void run(double seconds, const std::function<void()>& each = {}, double dt = 0);
  /// Turns or scales gravity; soil, tools and clock continue.
  void set_gravity(const Vec3& gravity);

  /// Sets the length of the whole experiment, for the progress report [s simulated].
  void expect(double seconds) { expected_ = seconds; }
  /// Returns the largest error of action and reaction, as a share of their scale.
  double worst_residual() const { return worst_residual_; }
  /// Returns the energy account, all zero unless one is kept.
  soil::EnergyAccount energy() const;
  /// Returns the hash of the soil's state, the `state_hash` of a report.
  std::string digest() const;
  /// Writes particles, steps, times, ledger and hash.
  void finish(Report& report) const;

 private:
  /// Creates the solver with all tools added so far.
  void make_solver();
  /// Applies weight and external forces, before the soil.
  void push_tool(Tool& tool, double dt) const;
  // Applies the soil's impulse, then moves the pose.
  static void move_tool(Tool& tool, double dt);

  device::Device* device_;
  scene::Scene world_;
  heightfield::Ground ground_;
  bool crowding_, energy_;
  soil::SchemeConstants scheme_;
  /// Account of solvers that were replaced.
  soil::EnergyAccount energy_before_;
  std::unique_ptr<soil::Solver> solver_;
  std::vector<scene::Shell> shells_;
  std::vector<Tool> tools_;
  std::vector<soil::ToolMotion> motions_;
  std::vector<soil::ToolImpulse> impulses_;
  std::function<void(double)> progress_;
  Stopwatch watch_;
  /// [s].
  double time_ = 0, expected_ = 0;
  double worst_residual_ = 0;
  /// Last share that progress_ got.
  double shown_ = 0;
};

}  // namespace navvy::lab
