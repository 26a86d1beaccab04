// SPDX-License-Identifier: Apache-2.0
#include "soil/reference/plane_strain.h"

#include <algorithm>
#include <cmath>

#include "soil/host_law/double_contact.h"
#include "soil/particles/floor.h"
#include "soil/reference/impulse_on.h"
#include "soil/reference/law_soil.h"

namespace navvy::soil::reference {
namespace {

// Reach of the contact from a plate's face. The lattice of particles begins an eighth of a cell
// behind the face. The edge is that of the solver [docs/tools.md, contact shares]. If an edge has
// fractional shares, it lies 0.2 cells further in.
constexpr double kReach = 0.875, kRamp = 1, kEdge = 0.6, kEdgeRamp = 1, kFractionEdge = 0.8;
constexpr double kFarInside = 1e3;         // from a plate's edges [cells]
constexpr double kReferenceCourant = 0.4;  // of the step that weights are made independent of
constexpr double kClosingTime = 0.1;       // over which J closes where particles crowd [s]
constexpr double kEmpty = 1e-9;            // lighter nodes have no velocity [kg]

struct Weights {
  int i = 0, k = 0;
  double fx = 0, fz = 0, wx[3], wz[3];
  explicit Weights(const PlanePoint& p)
      : i(static_cast<int>(std::floor(p.x - 0.5))), k(static_cast<int>(std::floor(p.z - 0.5))) {
    fx = p.x - i;
    fz = p.z - k;
    spline(fx, wx);
    spline(fz, wz);
  }
};

/// Calls visit(node, weight, along x, along z) for the nine nodes around a particle, the last two
/// from its base node.
template <class Visit>
void for_nodes(PlaneStrain& plane, const Weights& at, const Visit& visit) {
  for (int b = 0; b < 3; ++b)
    for (int a = 0; a < 3; ++a) visit(plane.node(at.i + a, at.k + b), at.wx[a] * at.wz[b], a, b);
}

/// Weight of a fractional contact, n = dt / reference step: 1 - (1 - b)^n is replaced by b n / (1 +
/// (n - 1) b), equal at b = 0 (with slope n), at b = 1 and for n = 1.
double fraction_weight(double clearance, double inset, double n, const Reach* reach) {
  const double b = contact_share(clearance, kFarInside, reach) * contact_along(inset, reach);
  return b * n / (1 + (n - 1) * b);
}

}  // namespace

PlaneStrain::PlaneStrain(const scene::Soil& soil, double cell, int nx, int nz,
                         const PlaneMethod& method, bool periodic)
    : soil_(soil),
      law_(law_soil(soil, cell)),
      cell_(cell),
      sound_(sound_speed(soil)),
      nx_(nx),
      nz_(nz),
      method_(method),
      periodic_(periodic),
      nodes_(static_cast<std::size_t>(nx * nz)) {}

void PlaneStrain::fill(double x0, double x1, double z0, double z1,
                       const std::function<bool(double, double)>& inside, int per_side) {
  const double apart = 1.0 / per_side;
  const auto across = static_cast<int>(std::lround((x1 - x0) / apart));
  const auto rows = static_cast<int>(std::lround((z1 - z0) / apart));
  for (int k = 0; k < rows; ++k)
    for (int i = 0; i < across; ++i) {
      PlanePoint p;
      p.x = x0 + (i + 0.5) * apart;
      p.z = z0 + (k + 0.5) * apart;
      if (inside && !inside(p.x, p.z)) continue;
      p.j = p.j0 = 1;
      p.mass = soil_.bank_density * std::pow(cell_, 3) * apart * apart;
      points.push_back(p);
    }
}

void PlaneStrain::settle(const std::function<double(double)>& top) {
  const double k0 = soil_.poisson / (1 - soil_.poisson);
  for (PlanePoint& p : points) {
    const double down = soil_.bank_density * gravity.y() * std::max(top(p.x) - p.z, 0.0) * cell_,
                 side = k0 * down;
    const double pressure = -(down + 2 * side) / 3;
    p.j = 1 - pressure / law_.bulk;
    p.s[0] = p.s[1] = side + pressure;
    p.s[2] = down + pressure;
    p.pressure = pressure;
  }
}

double PlaneStrain::longest_step(double courant) const { return courant * cell_ / sound_; }

void PlaneStrain::mix(double dt) {
  struct Sums {
    double volume = 0, bank = 0, open = 0;
  };
  std::vector<Sums> cells(nodes_.size());
  const auto sums = [&](const PlanePoint& p) -> Sums& {
    const Weights at(p);
    return cells[static_cast<std::size_t>(wrap(at.i) + nx_ * at.k)];
  };
  for (const PlanePoint& p : points) {
    Sums& s = sums(p);
    s.volume += p.mass / kMassQuantum * p.j;
    s.bank += p.mass / kMassQuantum * p.j0;
    s.open += p.j > p.j0 ? 1 : 0;
  }
  for (PlanePoint& p : points) {
    const Sums& s = sums(p);
    const double share = std::min(dt / kScheme.mixing_strain * strain_rate(p.c), most_mixing(dt));
    p.j = mixed(p.j, p.j0, mean_opening(s.volume, s.bank, s.open), share);
  }
}

void PlaneStrain::advance_law(PlanePoint& p, double dt, double* sigma) {
  const double slipped = p.shear;
  law_update(p.c, dt, &law_, &p, sigma);
  const double volume = p.mass / soil_.bank_density * p.j;
  const double q =
      std::sqrt(0.5 * (p.s[0] * p.s[0] + p.s[1] * p.s[1] + p.s[2] * p.s[2]) + p.s[5] * p.s[5]);
  energy_.plastic += volume * q * (p.shear - slipped);
  p.pressure = -(sigma[0] + sigma[1] + sigma[2]) / 3;
}

void PlaneStrain::scatter(double dt, bool first) {
  for (Node& node : nodes_) {
    if (first) node = Node{};
    node.fx = node.fz = 0;
  }
  double moving = 0;
  for (PlanePoint& p : points) {
    double sigma[6], start[3], a[9];
    advance_law(p, dt, sigma);
    const Weights at(p);
    // The force alone is what the shared arithmetic makes of no velocity and no gradient.
    const double none[9] = {0}, still[3] = {0, 0, 0}, f[3] = {at.fx, 0, at.fz};
    affine_momentum(none, sigma, still, f, p.mass, p.mass / soil_.bank_density, p.j, 1, dt, cell_,
                    start, a);
    const double cx = cell_ * p.c[0], cxz = cell_ * p.c[2], czx = cell_ * p.c[6],
                 cz = cell_ * p.c[8];
    moving += 0.5 * p.mass *
              (p.vx * p.vx + p.vz * p.vz + 0.25 * (cx * cx + cxz * cxz + czx * czx + cz * cz));
    for_nodes(*this, at, [&](Node& node, double w, int i, int k) {
      if (first) {
        const double rx = i - at.fx, rz = k - at.fz;
        node.mass += w * p.mass;
        node.vx += w * p.mass * (p.vx + cx * rx + cxz * rz);
        node.vz += w * p.mass * (p.vz + czx * rx + cz * rz);
      }
      node.fx += w * (start[0] + a[0] * i + a[2] * k);
      node.fz += w * (start[2] + a[6] * i + a[8] * k);
    });
  }
  kinetic_before_ = moving;
}

double PlaneStrain::free_fraction_at(int i, int k) const {
  double fraction = kernel_share(k - floor);
  if (has_plate && k > plate.tip) fraction *= kernel_share(i - plate.x);
  if (wall_x0 >= 0) fraction *= kernel_share(i - wall_x0);
  if (wall_x1 >= 0) fraction *= kernel_share(wall_x1 - i);
  return std::max(fraction, kScheme.min_free_fraction);
}

void PlaneStrain::meet_plate(Node& node, int i, int k, double dt) {
  const bool fraction = method_.contact == PlaneMethod::Contact::kFraction;
  const Reach reach{kReach, kRamp, fraction ? kFractionEdge : kEdge, kEdgeRamp, 0, 0, 0, 0, 0, 0,
                    0,      0};
  const double clearance = i - plate.x, inset = k - plate.tip;
  if (clearance < -3) return;
  ContactNode at{Vec3(node.vx, 0, node.vz),
                 Vec3::Zero(),
                 Vec3::UnitX(),
                 node.mass,
                 1,
                 0,
                 plate.friction,
                 0,
                 0,
                 0};
  double weight = 1;
  if (fraction)
    weight = fraction_weight(clearance, inset, dt / longest_step(kReferenceCourant), &reach);
  if (!fraction) at.share = contact_share(clearance, inset, &reach);
  if (!(weight > 0 && at.share > 0)) return;
  const Vec3 impulse = weight * impulse_on(at, 0, Vec3(plate.speed, 0, 0));
  node.vx += impulse.x() / node.mass;
  node.vz += impulse.z() / node.mass;
  plate.impulse += impulse.x();
  energy_.tool += impulse.x() * plate.speed;
}

void PlaneStrain::update_nodes(double dt, bool first) {
  double moving = 0;
  for (Node& node : nodes_) {
    if (node.mass <= kEmpty) {
      node = Node{};
      continue;
    }
    if (first) {
      node.vx /= node.mass;
      node.vz /= node.mass;
    }
    moving += 0.5 * node.mass * (node.vx * node.vx + node.vz * node.vz);
    node.vx += node.fx / node.mass + dt * gravity.x();
    node.vz += node.fz / node.mass + dt * gravity.y();
  }
  if (first) energy_.transfer += kinetic_before_ - moving;
  if (on_nodes) on_nodes(*this, dt);
  plate.impulse = 0;
  for (int k = 0; k < nz_; ++k)
    for (int i = 0; i < nx_; ++i) {
      Node& node = nodes_[static_cast<std::size_t>(i + nx_ * k)];
      if (node.mass <= kEmpty) continue;
      energy_.gravity += dt * node.mass * (gravity.x() * node.vx + gravity.y() * node.vz);
      if (has_plate) meet_plate(node, i, k, dt);
      if (wall_x0 >= 0 && i <= wall_x0 + kScheme.held_margin && (!has_plate || k <= plate.tip))
        node.vx = 0;
      if (wall_x1 >= 0 && i >= wall_x1 - kScheme.held_margin) node.vx = 0;
      if (k <= floor + kScheme.held_margin) node.vx = node.vz = 0;
      node.moved_x += dt * node.vx;
      node.moved_z += dt * node.vz;
      if (first) node.free_fraction_mass = node.mass / free_fraction_at(i, k);
    }
}

void PlaneStrain::spread(PlanePoint& p, double dt_interval) {
  const double share =
      crowding(p.c, p.j, p.j0, p.density, packed_mass(1, 1), dt_interval / kScheme.crowding_strain);
  if (!(share > 0)) return;
  const Weights at(p);
  double mass = 0, lean_x = 0, lean_z = 0;
  for_nodes(*this, at, [&](Node& node, double w, int i, int k) {
    mass += w * node.free_fraction_mass;
    lean_x += w * node.free_fraction_mass * (i - at.fx);
    lean_z += w * node.free_fraction_mass * (k - at.fz);
  });
  p.x += crowding_displacement(share, lean_x, mass, kScheme.max_crowding_displacement);
  p.z += crowding_displacement(share, lean_z, mass, kScheme.max_crowding_displacement);
}

void PlaneStrain::gather(double dt, bool last) {
  const double full = packed_mass(soil_.bank_density, cell_),
               filled = filled_mass(soil_.bank_density, cell_);
  const double closing = std::min(1.0, dt / kClosingTime);
  double on_grid = 0, moving = 0, fastest = 0;
  if (last)
    for (const Node& node : nodes_)
      on_grid += 0.5 * node.mass * (node.vx * node.vx + node.vz * node.vz);
  for (PlanePoint& p : points) {
    const Weights at(p);
    double v[2] = {0, 0}, moment[4] = {0, 0, 0, 0}, moved[2] = {0, 0}, local_mass = 0;
    for_nodes(*this, at, [&](Node& node, double w, int i, int k) {
      local_mass += w * node.free_fraction_mass;
      v[0] += w * node.vx;
      v[1] += w * node.vz;
      moment[0] += w * node.vx * i;
      moment[1] += w * node.vx * k;
      moment[2] += w * node.vz * i;
      moment[3] += w * node.vz * k;
      moved[0] += w * node.moved_x;
      moved[1] += w * node.moved_z;
    });
    p.c[0] = velocity_gradient(moment[0], at.fx, v[0], cell_);
    p.c[2] = velocity_gradient(moment[1], at.fz, v[0], cell_);
    p.c[6] = velocity_gradient(moment[2], at.fx, v[1], cell_);
    p.c[8] = velocity_gradient(moment[3], at.fz, v[1], cell_);
    p.density = local_mass / (soil_.bank_density * std::pow(cell_, 3));
    if (method_.crowding == PlaneMethod::Crowding::kClosing) {
      const double packed = full / std::max(local_mass, kEmpty);
      p.j -= closing * std::max(std::min(p.j, p.j0) - packed, 0.0);
    }
    if (method_.opening == PlaneMethod::Opening::kSeen)
      p.j = close_noise(p.j, p.j0, local_mass, filled, kScheme.closing_share / method_.hold);
    fastest = std::max({fastest, std::abs(v[0]), std::abs(v[1])});
    if (!last) continue;
    p.vx = v[0];
    p.vz = v[1];
    if (method_.crowding == PlaneMethod::Crowding::kShear) spread(p, held_time_);
    p.x += moved[0] / cell_;
    p.z += moved[1] / cell_;
    if (periodic_) p.x -= nx_ * std::floor(p.x / nx_);
  }
  fastest_ = fastest;
  if (!last) return;
  for (const PlanePoint& p : points) moving += 0.5 * p.mass * (p.vx * p.vx + p.vz * p.vz);
  energy_.transfer += on_grid - moving;
  for (const PlanePoint& p : points)
    for (const int i : {0, 2, 6, 8})
      energy_.transfer -= 0.125 * p.mass * cell_ * cell_ * p.c[i] * p.c[i];
}

void PlaneStrain::step(double dt) {
  const bool first = held_ == 0;
  if (first) held_time_ = held_motion_ = 0;
  if (method_.mixing) mix(dt);
  scatter(dt, first);
  update_nodes(dt, first);
  ++held_;
  held_time_ += dt;
  // What the next step would add must still fit; free fall is the least that has to be expected.
  held_motion_ += dt * (fastest_ + std::abs(gravity.y()) * held_time_) / cell_;
  const double next = dt * (fastest_ + std::abs(gravity.y()) * (held_time_ + dt)) / cell_;
  const bool last = held_ >= method_.hold || held_motion_ + next > method_.most_motion;
  gather(dt, last);
  if (last) {
    held_ = 0;
    ++transfers_;
  }
}

}  // namespace navvy::soil::reference
