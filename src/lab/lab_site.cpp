// SPDX-License-Identifier: Apache-2.0
#include "lab/lab_site.h"

#include <algorithm>
#include <cmath>

#include "core/saved_state.h"
#include "soil/particles/soil_table.h"

namespace navvy::lab {
namespace {

/// Share of the experiment between two calls of the progress report.
constexpr double kProgressStep = 0.01;

/// Returns a world without machines, of the given soils.
scene::Scene make_world(std::vector<scene::Soil> soils, double cell, const SiteOptions& options) {
  scene::Scene world;
  world.name = "lab";
  world.soils = std::move(soils);
  world.gravity = options.gravity;
  world.solver.cell = cell;
  world.solver.courant = options.courant;
  // Rigs that measure particles alone switch the exchange with the ground off.
  world.solver.exchange = options.exchange;
  return world;
}

SiteOptions with_setup(SiteOptions options, const Setup& setup) {
  options.courant = setup["courant"];
  options.scheme = setup.scheme;
  return options;
}

/// Returns one layer of the first soil from the surface down to bedrock.
heightfield::Ground::Setup make_ground(const scene::Scene& world, const SiteOptions& options) {
  heightfield::Ground::Setup out;
  const double cell = world.solver.cell;
  // An even number, so that the origin of W is a corner of cells for any size.
  const int half = static_cast<int>(std::lround(options.size / cell / 2));
  // The centre, unless a test wants its coordinates to start at a corner.
  const Vec2 corner = options.corner.value_or(Vec2::Constant(-half * cell));
  out.nx = out.ny = 2 * half;
  out.cell = cell;
  out.origin = corner;
  // Whole cells of depth: nodes then lie at z = 0.
  out.datum = -std::ceil(options.depth / cell - 1e-9) * cell;
  out.soils = world.soils;
  // Bedrock lies under the layer, deeper than any rig reaches.
  out.layers = {{world.soils.front().name, options.depth}};
  out.surface = [surface = options.surface, corner, cell](int ix, int iy) {
    return surface ? surface(corner.x() + (ix + 0.5) * cell, corner.y() + (iy + 0.5) * cell) : 0.0;
  };
  return out;
}

/// Returns the pose after `dt` with this twist. The rotation is exact, so that a turning tool keeps
/// its shape.
Pose turned(const Pose& X, const Vec3& v, const Vec3& w, double dt) {
  Pose out = X;
  const double angle = w.norm() * dt;
  if (angle > 0) out.linear() = Eigen::AngleAxisd(angle, w.normalized()) * X.linear();
  out.translation() += v * dt;
  return out;
}

}  // namespace

double whole_cells(double length, double cell) { return cell * std::ceil(length / cell - 1e-9); }

std::function<double(double, double)> pit(const SiteBox& box) {
  return [box](double x, double y) {
    // Walls belong to the ground: a cell whose centre is on the border is not dug.
    const bool inside = x > box.low.x() && x < box.high.x() && y > box.low.y() && y < box.high.y();
    return inside ? box.low.z() : 0.0;
  };
}

Site::Site(device::Device& device, std::vector<scene::Soil> soils, double cell,
           const SiteOptions& options)
    : device_(&device),
      world_(make_world(std::move(soils), cell, options)),
      ground_(make_ground(world_, options)),
      crowding_(options.crowding),
      energy_(options.energy),
      scheme_(options.scheme) {
  make_solver();
}

/// Default case: the soil of the setup.
Site::Site(const Setup& setup, const SiteOptions& options) : Site(setup, {setup.soil}, options) {}

Site::Site(const Setup& setup, std::vector<scene::Soil> soils, const SiteOptions& options)
    : Site(*setup.device, std::move(soils), setup.cell, with_setup(options, setup)) {
  progress_ = setup.progress;
  energy_ = energy_ || setup.energy;
  solver_->record_energy(energy_);
}

void Site::make_solver() {
  // Tools first exist in the solver: their numbers follow the order in which they are added.
  solver_ = std::make_unique<soil::Solver>(*device_, world_, ground_, scheme_);
  for (const scene::Shell& shell : shells_) solver_->add_tool(shell);
  solver_->set_crowding(crowding_);
  solver_->record_energy(energy_);
}

soil::Particle Site::particle(const Vec3& p_W, double volume, int soil) const {
  soil::Particle p;
  // Positions are stored relative to a block of cells: a float then resolves micrometres anywhere
  // on the site.
  const Vec3 grid =
      (p_W - Vec3(ground_.origin().x(), ground_.origin().y(), ground_.datum())) / cell();
  for (int a = 0; a < 3; ++a) {
    p.block[a] = static_cast<int>(std::floor(grid[a] / soil::kBlockCells));
    p.x[a] = static_cast<float>(grid[a] - soil::kBlockCells * p.block[a]);
  }
  p.soil = static_cast<std::uint16_t>(soil);
  // Mass is counted in quanta, which makes the ledger exact.
  p.mass = static_cast<std::int32_t>(mass_units(world_.soils[p.soil].bank_density * volume));
  return p;
}

std::vector<soil::Particle> Site::fill(const SiteBox& box,
                                       const std::function<bool(const Vec3&)>& keep,
                                       int soil) const {
  std::vector<soil::Particle> out;
  const double h = cell() / 2;
  // Rounded: a box that is meant to have whole half cells has them despite rounding errors.
  const Vec3 count = (box.high - box.low) / h;
  const int nx = static_cast<int>(std::lround(count.x())),
            ny = static_cast<int>(std::lround(count.y())),
            nz = static_cast<int>(std::lround(count.z()));
  // x fastest, so that neighbours in memory are neighbours in the soil.
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const Vec3 p_W = box.low + h * Vec3(i + 0.5, j + 0.5, k + 0.5);
        if (!keep || keep(p_W)) out.push_back(particle(p_W, h * h * h, soil));
      }
  return out;
}

void Site::rest(std::vector<soil::Particle>& particles,
                const std::function<double(double, double)>& surface, double surcharge) const {
  for (soil::Particle& p : particles) {
    const scene::Soil& soil = world_.soils[p.soil];
    const Vec3 p_W = position(p);
    // There is no stress above the surface.
    const double depth = std::max(0.0, surface(p_W.x(), p_W.y()) - p_W.z());
    // Uniaxial strain of an elastic body.
    const double k0 = soil.poisson / (1 - soil.poisson);
    const double sz = soil.bank_density * world_.gravity.z() * depth - surcharge;
    const double mean = -(1 + 2 * k0) * sz / 3;
    // The pressure is stored in the volume ratio, the rest of the stress in the deviator s = (xx,
    // yy, zz, ...).
    p.j = static_cast<float>(p.j0 * (1 - mean / soil::law_constants(soil, cell()).bulk));
    p.s[0] = p.s[1] = static_cast<float>(k0 * sz + mean);
    p.s[2] = static_cast<float>(sz + mean);
  }
}

void Site::rest(std::vector<soil::Particle>& particles, double surface, double surcharge) const {
  rest(
      particles, [surface](double, double) { return surface; }, surcharge);
}

Vec3 Site::position(const soil::Particle& particle) const {
  Vec3 grid;
  for (int a = 0; a < 3; ++a)
    grid[a] = soil::kBlockCells * particle.block[a] + static_cast<double>(particle.x[a]);
  return grid * cell() + Vec3(ground_.origin().x(), ground_.origin().y(), ground_.datum());
}

double Site::pressure(const soil::Particle& particle) const {
  const double bulk = soil::law_constants(world_.soils[particle.soil], cell()).bulk;
  return bulk *
         std::max(0.0, 1.0 - static_cast<double>(particle.j) / static_cast<double>(particle.j0));
}

int Site::add_tool(const scene::Shell& shell, const Pose& X_WT) {
  // Stored beside the solver, for the step limit and for creating the solver again.
  shells_.push_back(shell);
  Tool tool;
  tool.motion.tool = solver_->add_tool(shell);
  tool.motion.X_WT = X_WT;
  tools_.push_back(tool);
  return tool.motion.tool;
}

double Site::step_limit(double speed) const {
  for (std::size_t i = 0; i < tools_.size(); ++i)
    // The fastest point of a shell is a vertex.
    for (const Vec3& v : shells_[i].vertices) {
      const soil::ToolMotion& motion = tools_[i].motion;
      speed = std::max(speed, (motion.v_WT + motion.w_WT.cross(motion.X_WT.linear() * v)).norm());
    }
  return solver_->step_limit(speed);
}

void Site::push_tool(Tool& tool, double dt) const {
  soil::ToolMotion& motion = tool.motion;
  // A tool without mass does not respond to impulses: infinitely heavy for the solver, driven by
  // its twist.
  motion.inverse_mass = Mat6::Zero();
  if (!(tool.mass > 0)) return;
  // One free direction; the carriage prescribes the others.
  if (tool.only_sinks) {
    motion.inverse_mass(5, 5) = 1 / tool.mass;
    motion.v_WT.z() += (world_.gravity.z() + tool.force_W.z() / tool.mass) * dt;
    return;
  }
  // Rows as in a twist: rotation first, then translation.
  motion.inverse_mass.bottomRightCorner<3, 3>() = Mat3::Identity() / tool.mass;
  motion.v_WT += (world_.gravity + tool.force_W / tool.mass) * dt;
  if (tool.lock_rotation) return;
  // Inertia is given in the shell's axes and turns with it.
  const Mat3 R = motion.X_WT.linear();
  const Mat3 inverse = R * tool.inertia.cwiseInverse().asDiagonal() * R.transpose();
  motion.inverse_mass.topLeftCorner<3, 3>() = inverse;
  motion.w_WT += inverse * tool.torque_W * dt;
}

void Site::move_tool(Tool& tool, double dt) {
  soil::ToolMotion& motion = tool.motion;
  Vec6 impulse;
  impulse << tool.impulse.L_W, tool.impulse.J_W;
  // The solver returns an impulse; a free tool receives it at once, a scripted one not at all.
  const Vec6 change = motion.inverse_mass * impulse;
  motion.w_WT += change.head<3>();
  motion.v_WT += change.tail<3>();
  // Velocities first, then positions: semi-implicit Euler.
  motion.X_WT = turned(motion.X_WT, motion.v_WT, motion.w_WT, dt);
}

void Site::step(double dt) {
  motions_.clear();
  impulses_.resize(tools_.size());
  // External forces act first: contact then sees the velocity that it must change.
  for (Tool& tool : tools_) {
    push_tool(tool, dt);
    motions_.push_back(tool.motion);
  }
  solver_->step(dt, motions_, impulses_);
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const soil::ToolImpulse& impulse = impulses_[i];
    tools_[i].impulse = impulse;
    // Action and reaction: impulses on tools and nodes must cancel, relative to what was exchanged.
    if (impulse.scale > 0)
      worst_residual_ = std::max(worst_residual_, impulse.residual.norm() / impulse.scale);
    if (impulse.scale_moment > 0)
      worst_residual_ =
          std::max(worst_residual_, impulse.residual_moment.norm() / impulse.scale_moment);
    move_tool(tools_[i], dt);
  }
  time_ += dt;
  if (!progress_ || !(expected_ > 0)) return;
  // A terminal needs at most a hundred lines of progress.
  const double share = std::min(1.0, time_ / expected_);
  if (share - shown_ < kProgressStep) return;
  shown_ = share;
  progress_(share);
}

void Site::run(double seconds, const std::function<void()>& each, double dt) {
  double limit = step_limit();
  if (dt > 0) limit = std::min(limit, dt);
  // Equal steps that end exactly at `seconds`.
  const int steps = static_cast<int>(std::ceil(seconds / limit - 1e-9));
  for (int i = 0; i < steps; ++i) {
    // The limit is that of the speeds at the start; a rig that accelerates calls again.
    step(seconds / steps);
    if (each) each();
  }
}

void Site::set_gravity(const Vec3& gravity) {
  // A solver keeps the world it was created with; its snapshot holds no gravity.
  const std::vector<char> state = saved(*solver_);
  // The next account starts with the present energy as its first exchange.
  energy_before_ = energy();
  energy_before_.exchanged -= energy_before_.kinetic + energy_before_.elastic;
  energy_before_.kinetic = energy_before_.elastic = 0;
  world_.gravity = gravity;
  make_solver();
  // Particles, clocks and ledger as before.
  load_saved(state, *solver_);
}

soil::EnergyAccount Site::energy() const {
  soil::EnergyAccount out = energy_before_;
  if (const soil::EnergyAccount* now = solver_->energy()) out += *now;
  return out;
}

// Of the soil alone: tools are prescribed or follow from it.
std::string Site::digest() const { return hash_of(*solver_).hex(); }

void Site::finish(Report& report) const {
  const soil::SolverStats& stats = solver_->stats();
  // A rig may run several sites for one report: counts and times add up, the hash is that of the
  // last.
  report.particles_peak = std::max(report.particles_peak, stats.particles_peak);
  report.steps += stats.steps;
  report.simulated_time += time_;
  report.wall_time += watch_.seconds();
  report.ledger_error += solver_->ledger().error();
  report.state_hash = digest();
  if (!energy_) return;
  if (!report.energy) report.energy.emplace();
  *report.energy += energy();
}

}  // namespace navvy::lab
