// SPDX-License-Identifier: Apache-2.0
// The particle method in plane strain, in doubles and on the host, with ingredients that can be
// changed one by one.
//
// A cure of the method is tried here in seconds before it is built into two schedules and the twin.
// Law, particle and contact arithmetic are the kernels' own; what a cure adds stands in
// plane_strain.cpp until it proves itself.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "core/math.h"
#include "scene/soil.h"
#include "soil/host_law/double_law.h"

namespace navvy::soil::reference {

/// What of the method may be changed; as it stands here it is the one that the cures began from.
struct PlaneMethod {
  /// kKinematic: full impulse, but a node that the plate covers in part need only keep up with its
  /// share of the plate's speed [docs/tools.md, contact shares]. kFraction: the share is one of the
  /// impulse, made independent of the step, as the kernels once had it; a slow plate leaks.
  enum class Contact { kFraction, kKinematic };
  /// Where particles crowd: kClosing takes it out of J, which pumps energy; kShear moves them apart
  /// by their shear rate and leaves J alone [docs/soil.md, crowding]; kNone does nothing.
  enum class Crowding { kNone, kClosing, kShear };

  /// Where soil is open: kIntegrated goes by J alone, which noise opens; kSeen closes what noise
  /// opens where the nodes around it hold a closed soil's mass [docs/soil.md, opening].
  enum class Opening { kIntegrated, kSeen };

  Contact contact = Contact::kKinematic;
  Crowding crowding = Crowding::kClosing;
  Opening opening = Opening::kIntegrated;
  bool mixing = true;
  /// Steps from transfer to transfer: positions, weights and masses are held meanwhile; 1: every
  /// step.
  int hold = 1;
  /// A transfer comes early when the fastest particle has moved this far [cells].
  double most_motion = 0.2;
};

/// A particle: the law's state, place [cells], velocity [m/s], gradient as in kernels/soil/point.h
/// (x and z only).
struct PlanePoint : LawState {
  PlanePoint() : LawState{} {}
  double x = 0, z = 0, vx = 0, vz = 0;
  double c[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  double mass = 0;      ///< of a slice one cell thick [kg]
  double pressure = 0;  ///< of the last step [Pa]
  double density = 0;   ///< local density of the last transfer / bank density [-]
};

/// A plate standing upright, with soil on its +x side above its tip.
struct PlanePlate {
  double x = 0, tip = 0;  ///< [cells]
  double speed = 0;       ///< along +x [m/s]
  double friction = 0;    ///< tan of the friction angle
  double impulse = 0;     ///< on the soil by the last step, along x [N s], of the slice
};

/// Work since the start [J] of a slice one cell thick.
struct PlaneEnergy {
  double tool = 0, gravity = 0, plastic = 0, transfer = 0;
};

/// Soil over a rigid floor (nodes at or below `floor` are held) in a box of nodes.
class PlaneStrain {
 public:
  /// `periodic`: what leaves at one end in x comes in at the other.
  PlaneStrain(const scene::Soil& soil, double cell, int nx, int nz, const PlaneMethod& method,
              bool periodic = false);

  std::vector<PlanePoint> points;
  PlanePlate plate;
  bool has_plate = false;
  double floor = 3;  ///< [cells]
  /// Smooth walls [cells]; < 0: none. The first ends at the plate's tip.
  double wall_x0 = -1, wall_x1 = -1;
  Vec2 gravity{0, -kGravity};  ///< along x and z [m/s2]
  /// Called with node velocities after forces, before contact; for rigs that hold nodes themselves.
  std::function<void(PlaneStrain&, double dt)> on_nodes;

  /// Particles on a lattice of `per_side` a cell in a box [cells], of those where `inside(x, z)`
  /// [cells].
  void fill(double x0, double x1, double z0, double z1,
            const std::function<bool(double, double)>& inside, int per_side = 2);
  /// Stress of rest below a level surface `top(x)` [cells].
  void settle(const std::function<double(double)>& top);

  double longest_step(double courant) const;
  void step(double dt);

  double cell() const { return cell_; }
  const LawSoil& law() const { return law_; }
  const scene::Soil& soil() const { return soil_; }
  int nx() const { return nx_; }
  int nz() const { return nz_; }
  struct Node {
    double mass = 0, vx = 0, vz = 0, fx = 0, fz = 0, moved_x = 0, moved_z = 0;
    double free_fraction_mass = 1;  ///< mass / free fraction [kg]
  };
  Node& node(int i, int k) { return nodes_[static_cast<std::size_t>(wrap(i) + nx_ * k)]; }
  const PlaneEnergy& energy() const { return energy_; }
  int transfers() const { return transfers_; }

 private:
  int wrap(int i) const { return periodic_ ? ((i % nx_) + nx_) % nx_ : i; }
  void mix(double dt);
  void advance_law(PlanePoint& p, double dt, double* sigma);
  void scatter(double dt, bool first);
  void update_nodes(double dt, bool first);
  void meet_plate(Node& node, int i, int k, double dt);
  void gather(double dt, bool last);
  void spread(PlanePoint& p, double dt_interval);
  double free_fraction_at(int i, int k) const;

  scene::Soil soil_;
  LawSoil law_;
  double cell_, sound_;
  int nx_, nz_;
  PlaneMethod method_;
  bool periodic_;
  std::vector<Node> nodes_;
  PlaneEnergy energy_;
  double kinetic_before_ = 0;
  int held_ = 0, transfers_ = 0;
  double held_time_ = 0, held_motion_ = 0, fastest_ = 0;
};

}  // namespace navvy::soil::reference
