// SPDX-License-Identifier: Apache-2.0
// Energy account of a solver, computed on the host from the device's arrays before and after each
// step.
//
// Kernels are not involved, so a run that records energy is bit-identical to a run that does not.
// The cost is that the host processes all particles and nodes in every step, in double precision
// and in one thread, which takes longer than the step itself.
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

/// Computes the energy account of one solver. Energies are summed in double precision and in a
/// fixed order.
///
/// Kinetic energy is that of the nodes, elastic energy that of the particles. The work of tools and
/// gravity is force x displacement over the step. Plastic and viscous work follow from the change
/// of stress and plastic shear of each particle. Kinetic energy that the nodes had and the
/// particles did not receive at the end of a transfer counts as `transfer`.
///
/// The solver calls begin_step before it queues the kernels of a step, and end_step after it has
/// read the impulses of that step. Between the two calls the host must not change particles.
class EnergyLedger {
 public:
  /// Starts an account of zero. `cell`: edge of a cell [m]; `gravity` in W [m/s2]; `scheme`: the
  /// constants that the kernels were built with.
  EnergyLedger(const std::vector<scene::Soil>& soils, double cell, const Vec3& gravity,
               const SchemeConstants& scheme = kScheme);

  /// Copies the particles before the kernels of a step are queued. `hold`: true for every step of a
  /// transfer except the first. Requires at least one particle.
  void begin_step(const ParticleStore& store, bool hold);
  /// Adds the energies of a step of dt [s], after its impulses are known. `hold` as in begin_step.
  /// `motions` and `impulses` are parallel, one entry per tool in the step.
  void end_step(const ParticleStore& store, Transfer& transfer, Contact& contact, double dt,
                bool hold, std::span<const ToolMotion> motions,
                std::span<const ToolImpulse> impulses);

  /// Returns the sums since this ledger was created.
  const EnergyAccount& account() const { return account_; }

 private:
  /// Mass and velocity of one node in one velocity field. `scatter` first sums momentum, then
  /// divides it by the mass.
  struct Node {
    /// Mass at the node [kg].
    double mass = 0;
    /// Momentum [kg m/s] while `scatter` sums, afterwards velocity [m/s].
    Vec3 v = Vec3::Zero();
  };
  /// Host copy of the device's particle array at one moment: all slots of field 0, then all slots
  /// of field 1, and so on (particle_fields.h).
  struct Words {
    /// FIELD_COUNT x capacity words.
    std::vector<float> values;
    /// Number of slots per field.
    std::size_t capacity = 0;
    /// Returns the value of a float field of the particle in `slot`.
    double at(int field, std::size_t slot) const {
      return static_cast<double>(values[static_cast<std::size_t>(field) * capacity + slot]);
    }
    /// Returns the value of an integer field (mass, tag, ID) of the particle in `slot`.
    int bits(int field, std::size_t slot) const;
  };
  /// Copies the particle array from the device; waits for the device.
  static Words words_of(const ParticleStore& store);
  /// Calls visit(block index, slot) for each particle, in stored order.
  template <class Visit>
  static void for_particles(const ParticleStore& store, const Visit& visit);
  /// Returns the kinetic energy of the particles, including that of their velocity gradients [J].
  double moving_energy(const ParticleStore& store, const Words& now) const;
  /// Returns the elastic energy of the particles, of shear and of compression [J].
  double elastic_energy(const ParticleStore& store, const Words& now) const;
  /// Adds the plastic work, viscous work, mixing loss and `apart` energy of a step of dt [s].
  /// `now`: the particles after the step; those before it are in before_.
  void record_law(const ParticleStore& store, const Words& now, double dt);
  /// Computes masses and velocities of the nodes at the start of a transfer into nodes_, from the
  /// velocities before the step and the positions and sides in `now`.
  void scatter(const ParticleStore& store, const Words& now, Contact& contact);
  /// Returns the kinetic energy of nodes_ [J].
  double nodes_energy() const;
  /// Returns the velocities of all nodes after the step, read from the device, in the order of
  /// nodes_ [m/s].
  std::vector<Vec3> velocities(Transfer& transfer, Contact& contact) const;
  /// Adds the work of the tools and the energy that contact dissipates. `after`: node velocities
  /// after the step, in the order of nodes_ [m/s].
  void record_tools(Contact& contact, const std::vector<Vec3>& after,
                    std::span<const ToolMotion> motions, std::span<const ToolImpulse> impulses);

  /// Soil constants as the kernels use them, by soil index.
  std::vector<SoilRow> soils_;
  /// Scheme constants that the kernels were built with.
  SchemeConstants scheme_;
  /// Edge of a cell [m].
  double cell_;
  /// Gravity in W [m/s2].
  Vec3 gravity_;
  /// Sums so far.
  EnergyAccount account_;
  /// Particles before the current step.
  Words before_;
  /// Nodes of all active blocks: first the front velocity field of every node, then the back
  /// velocity field of every node, in the same order.
  std::vector<Node> nodes_;
  /// Kinetic energy of the particles after the last step [J].
  double moving_ = 0;
};

}  // namespace navvy::soil
