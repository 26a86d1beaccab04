// SPDX-License-Identifier: Apache-2.0
// Energy account of a solver, computed on the host from the device's arrays before and after each
// step.
//
// Kernels are not involved: a run with an account is bit-identical to the run without. In return
// the host visits all particles and nodes in every step, in doubles and in one thread, which takes
// longer than the step itself.
#pragma once

#include <span>
#include <vector>

#include "core/math.h"
#include "scene/soil.h"
#include "soil/energy.h"
#include "soil/particles/particle_store.h"
#include "soil/particles/transfer.h"
#include "soil/tools/contact.h"

namespace navvy::soil {

/// Energy account of one solver. Energies are sums in doubles, in a fixed order.
///
/// Kinetic energy is that of the nodes, elastic energy that of the particles. Work of tools and
/// gravity is force x displacement over the step; plastic and viscous work come from the change of
/// stress and plastic shear of each particle. Whatever nodes had and particles did not take up at
/// the end of a transfer counts as `transfer`.
///
/// Calls come in pairs: begin_step before the kernels of a step are queued, end_step after its
/// impulses are known. Between the two the host must not change particles.
class EnergyLedger {
 public:
  EnergyLedger(const std::vector<scene::Soil>& soils, double cell, const Vec3& gravity,
               const SchemeConstants& scheme = kScheme);

  /// Reads the state before a step's kernels are queued; there must be at least one particle.
  /// `hold`: not the first step of a transfer.
  void begin_step(const ParticleStore& store, bool hold);
  /// Adds the energies of the step, after its impulses are known.
  void end_step(const ParticleStore& store, Transfer& transfer, Contact& contact, double dt,
                bool hold, std::span<const ToolMotion> motions,
                std::span<const ToolImpulse> impulses);

  /// Returns the sums since the account was opened.
  const EnergyAccount& account() const { return account_; }

 private:
  /// Mass and velocity of a node field, during and after the scatter.
  struct Node {
    double mass = 0;
    /// Momentum while it is summed, then velocity [m/s].
    Vec3 v = Vec3::Zero();
  };
  /// Words of all particles at one moment, field after field.
  struct Words {
    std::vector<float> values;
    std::size_t capacity = 0;
    double at(int field, std::size_t slot) const {
      return static_cast<double>(values[static_cast<std::size_t>(field) * capacity + slot]);
    }
    int bits(int field, std::size_t slot) const;
  };
  /// Copies the words of all particles from the device; waits.
  static Words words_of(const ParticleStore& store);
  template <class Visit>
  static void for_particles(const ParticleStore& store, const Visit& visit);
  /// Returns the kinetic energy of the particles, with that of their velocity gradients [J].
  double moving_energy(const ParticleStore& store, const Words& now) const;
  /// Returns the elastic energy of shear and volume [J].
  double elastic_energy(const ParticleStore& store, const Words& now) const;
  /// Adds plastic work, viscous work and mixing of a step of dt [s].
  void record_law(const ParticleStore& store, const Words& now, double dt);
  /// Computes the nodes at the start of a transfer from the state before it.
  void scatter(const ParticleStore& store, const Words& now, Contact& contact);
  /// Returns the kinetic energy of the nodes [J].
  double nodes_energy() const;
  /// Returns the velocities of the nodes after the step, and keeps them for the next one.
  std::vector<Vec3> velocities(Transfer& transfer, Contact& contact) const;
  /// Adds the work of tools, and what contact dissipates.
  void record_tools(Contact& contact, const std::vector<Vec3>& after,
                    std::span<const ToolMotion> motions, std::span<const ToolImpulse> impulses);

  std::vector<SoilRow> soils_;
  SchemeConstants scheme_;
  double cell_;
  Vec3 gravity_;
  EnergyAccount account_;
  Words before_;
  /// Front field of every active node, then the back field.
  std::vector<Node> nodes_;
  /// Kinetic energy of the particles after the last step [J].
  double moving_ = 0;
};

}  // namespace navvy::soil
