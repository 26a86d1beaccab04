// SPDX-License-Identifier: Apache-2.0
// Ground of a laboratory rig: soil columns, particles placed in them, tools that move through them,
// and the simulated time.
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

/// Box with faces parallel to the axes of the world frame W.
struct SiteBox {
  /// Corners with the smallest and the largest coordinates [m].
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  /// Returns true if `p` [m] is inside the box or on one of the three faces through `low`.
  bool contains(const Vec3& p) const {
    return (p.array() >= low.array()).all() && (p.array() < high.array()).all();
  }
};

/// Options of a square piece of ground. The ground's columns and the soil's grid have the same cell
/// size, and a layer of grid nodes lies at z = 0. A bed of soil that is a whole number of cells
/// deep therefore begins and ends on planes of grid nodes.
struct SiteOptions {
  /// Edge length of the square [m]; it is rounded to an even number of cells.
  double size = 40;
  /// Corner with the smallest x and y, in W [m]. If empty, the square is centred on the origin of
  /// W.
  std::optional<Vec2> corner;
  /// Depth of the bedrock below z = 0 [m].
  double depth = 4;
  /// Function that returns the initial height of the ground at (x, y) in W [m]. If empty, the
  /// ground is flat at z = 0.
  std::function<double(double x, double y)> surface;
  /// Gravity vector in W [m/s2]. A tilted vector simulates a slope; zero gives weightless soil.
  Vec3 gravity = Vec3(0, 0, -kGravity);
  /// If true, disturbed ground becomes particles automatically, and particles at rest become ground
  /// again.
  bool exchange = false;
  /// If true, particles that lie too close together are moved apart [docs/soil.md, crowding].
  bool crowding = true;
  /// Courant number that limits the time step: step x sound speed / cell size.
  double courant = 2.0 / 3;
  /// If true, the soil's energy account is computed for the report.
  bool energy = false;
  /// Numerical constants of the particle method.
  soil::SchemeConstants scheme;
};

/// Returns `length` [m] rounded up to a whole number of cells of size `cell` [m]. An excess below
/// 1e-9 of a cell counts as a rounding error and is ignored.
double whole_cells(double length, double cell);

/// Returns a function of (x, y) for SiteOptions::surface: flat ground at z = 0 with a rectangular
/// pit as deep as the lowest face of `box` [m]. The caller fills the pit with particles.
std::function<double(double, double)> pit(const SiteBox& box);

/// A rigid shell in the soil, which the site moves in every step. If `mass` is 0, the tool keeps
/// its prescribed velocity. If `mass` is above 0, the tool is a free body: its weight, the external
/// force and torque below and the soil move it, and its centre of mass is the origin of its frame
/// T.
struct Tool {
  /// Pose and velocity at the start of the next step. Rigs set the velocity of a prescribed tool
  /// here.
  soil::ToolMotion motion;
  /// Impulse of the soil on the tool in the last step.
  soil::ToolImpulse impulse;
  /// Mass of a free body [kg]; 0 for a tool with a prescribed velocity.
  double mass = 0;
  /// Principal moments of inertia about the origin of T, along the axes of T [kg m2]; used for free
  /// bodies only.
  Vec3 inertia = Vec3::Ones();
  /// External force on a free body in addition to its weight, in axes of W [N].
  Vec3 force_W = Vec3::Zero();
  /// External torque on a free body about the origin of T, in axes of W [N m].
  Vec3 torque_W = Vec3::Zero();
  /// If true, a free body keeps its prescribed angular velocity (by default zero).
  bool lock_rotation = false;
  /// If true, a free body responds to forces along z of W only; its other velocities are prescribed
  /// in `motion`.
  bool only_sinks = false;
};

/// Soil, tools and simulated time of one experiment.
///
/// A rig creates a site, inserts soil, adds tools, steps the site and reads measurements. At the
/// end, `finish` adds the general properties of the run to the report. Particles live on the
/// device: `solver().particles()` copies all of them, so do not call it in every step. Results are
/// bit-identical when an experiment is repeated on the same device.
/// @throws InputError for a soil or cell size that the solver rejects.
/// @throws SimulationError when the solver finds a value that is not finite, or lost mass.
class Site {
 public:
  /// Creates a site on `device`. `soils` holds the soils of the site, of which the first one fills
  /// the ground; `cell` is the cell size [m].
  Site(device::Device& device, std::vector<scene::Soil> soils, double cell,
       const SiteOptions& options = {});
  /// Creates a site with the device, soil, cell size, Courant number, scheme constants and progress
  /// callback of `setup`. The Courant number and scheme constants in `options` are ignored.
  explicit Site(const Setup& setup, const SiteOptions& options = {});
  /// Creates a site as the constructor above, but with `soils` instead of the soil of `setup`.
  Site(const Setup& setup, std::vector<scene::Soil> soils, const SiteOptions& options);

  /// Returns the soil solver. `set_gravity` replaces the solver, so a reference is valid only until
  /// then.
  soil::Solver& solver() { return *solver_; }
  /// Returns the soil solver for reading; the reference is valid until `set_gravity` is called.
  const soil::Solver& solver() const { return *solver_; }
  /// Returns the ground columns.
  heightfield::Ground& ground() { return ground_; }
  /// Returns the ground columns for reading.
  const heightfield::Ground& ground() const { return ground_; }
  /// Returns the scene that the site was built from: soils, gravity and solver settings, without
  /// machines.
  const scene::Scene& world() const { return world_; }
  /// Returns the soil with the given index in the site's list of soils; the index is not checked.
  const scene::Soil& soil(std::size_t index = 0) const { return world_.soils[index]; }
  /// Returns the cell size [m].
  double cell() const { return world_.solver.cell; }
  /// Returns the simulated time since the site was created [s].
  double time() const { return time_; }

  /// Returns a new particle at the position `p_W` [m] that holds the volume `volume` [m3] of bank
  /// soil, at rest and without stress. `soil` is an index into the site's soils. The particle is
  /// not inserted into the solver.
  soil::Particle particle(const Vec3& p_W, double volume, int soil = 0) const;
  /// Returns new particles that fill `box`, at rest and at bank density. They lie on a regular
  /// lattice with a spacing of half a cell (eight per cell) that starts at the box's low corner.
  /// `keep` returns true for positions that get a particle; if empty, all do. `soil` is an index
  /// into the site's soils. The particles are not inserted into the solver.
  std::vector<soil::Particle> fill(const SiteBox& box,
                                   const std::function<bool(const Vec3&)>& keep = {},
                                   int soil = 0) const;
  /// Sets the stress of each particle to that of level ground at rest under the height `surface(x,
  /// y)` [m], loaded with `surcharge` [Pa]. The horizontal stress is K0 times the vertical stress,
  /// with K0 = nu / (1 - nu) from Poisson's ratio nu. Only the z component of gravity counts.
  void rest(std::vector<soil::Particle>& particles,
            const std::function<double(double, double)>& surface, double surcharge = 0) const;
  /// Sets the stress of each particle to that of ground at rest under a flat surface at the height
  /// `surface` [m], loaded with `surcharge` [Pa].
  void rest(std::vector<soil::Particle>& particles, double surface, double surcharge = 0) const;
  /// Returns the position of a particle in W [m].
  Vec3 position(const soil::Particle& particle) const;
  /// Returns the pressure that the soil's elastic law gives for the particle's volume [Pa]; 0 for a
  /// particle that is stretched beyond its density state.
  double pressure(const soil::Particle& particle) const;

  /// Adds a tool with this shell at the pose `X_WT`, at rest and with a prescribed velocity of
  /// zero. Returns the tool's index, for `tool`.
  int add_tool(const scene::Shell& shell, const Pose& X_WT);
  /// Returns the tool with the given index, which add_tool returned. The reference is valid until
  /// the next call of add_tool.
  /// @throws std::out_of_range for an index that add_tool did not return.
  Tool& tool(int index) { return tools_.at(static_cast<std::size_t>(index)); }

  /// Returns the longest stable time step [s] at the current speed of the fastest tool, or at
  /// `speed` [m/s] if that is higher.
  double step_limit(double speed = 0) const;
  /// Advances soil and tools by one time step `dt` [s]. Free bodies receive the soil's impulses at
  /// the end of the step.
  void step(double dt);
  /// Advances by `seconds` in equal time steps, which are at most `step_limit()` and, if `dt` is
  /// above 0, at most `dt` [s]. Calls `each` after every step, unless it is empty.
  void run(double seconds, const std::function<void()>& each = {}, double dt = 0);
  /// Replaces the gravity vector [m/s2], in W. Soil, tools and simulated time continue from their
  /// current state.
  void set_gravity(const Vec3& gravity);

  /// Sets the simulated duration of the whole experiment [s], from which the completed share for
  /// the progress callback is computed.
  void expect(double seconds) { expected_ = seconds; }
  /// Returns the largest relative error of momentum conservation between tools and soil in any step
  /// so far: the sum of the impulses on tool and soil, which should cancel, divided by the sum of
  /// their magnitudes [-].
  double worst_residual() const { return worst_residual_; }
  /// Returns the soil's energy account since the site was created. All terms are 0 unless
  /// SiteOptions::energy or Setup::energy is set.
  soil::EnergyAccount energy() const;
  /// Returns the hash of the soil's current state [hex], for Report::state_hash.
  std::string digest() const;
  /// Adds the general properties of this site's run to `report`. Steps, simulated time, wall time,
  /// ledger error and energy account are added to the values in the report, because a rig may run
  /// several sites. The peak number of particles becomes the maximum over the sites. The state hash
  /// replaces that in the report.
  void finish(Report& report) const;

 private:
  /// Creates the solver and gives it all tools added so far.
  void make_solver();
  /// Applies weight and external forces to a free body over `dt` [s], before the soil acts on it.
  void push_tool(Tool& tool, double dt) const;
  /// Applies the soil's impulse to a free body, then moves the tool's pose by its velocity over
  /// `dt` [s].
  static void move_tool(Tool& tool, double dt);

  /// Device of the solver; not owned.
  device::Device* device_;
  /// Soils, gravity and solver settings from which the solver is created.
  scene::Scene world_;
  /// Ground columns, which the solver exchanges soil with.
  heightfield::Ground ground_;
  /// SiteOptions::crowding, and whether the energy account is computed.
  bool crowding_, energy_;
  /// SiteOptions::scheme.
  soil::SchemeConstants scheme_;
  /// Sum of the energy accounts of solvers that set_gravity replaced.
  soil::EnergyAccount energy_before_;
  /// Soil solver; never null.
  std::unique_ptr<soil::Solver> solver_;
  /// Shells of all tools, in the order of `tools_`.
  std::vector<scene::Shell> shells_;
  /// Tools in the order in which they were added.
  std::vector<Tool> tools_;
  /// Motions of all tools in the current step, in the order of `tools_`; passed to the solver.
  std::vector<soil::ToolMotion> motions_;
  /// Impulses on all tools in the current step, in the order of `tools_`; filled by the solver.
  std::vector<soil::ToolImpulse> impulses_;
  /// Callback of Setup::progress; may be empty.
  std::function<void(double)> progress_;
  /// Wall time since the site was created.
  Stopwatch watch_;
  /// Simulated time so far, and that of the whole experiment [s]; `expected_` is 0 if unknown.
  double time_ = 0, expected_ = 0;
  /// Largest relative error of momentum conservation so far [-].
  double worst_residual_ = 0;
  /// Completed share of the experiment that was last passed to `progress_`, 0 to 1.
  double shown_ = 0;
};

}  // namespace navvy::lab
