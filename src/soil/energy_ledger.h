// SPDX-License-Identifier: Apache-2.0
// Keeps a solver's energy account on the host, from what stands in the device's arrays before and
// after each step.
//
// Kernels know nothing of it: a run with an account is the run without, to the bit. In return the
// host goes through all particles and nodes in every step, in doubles and one thread, which takes
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

class EnergyLedger {
 public:
  EnergyLedger(const std::vector<scene::Soil>& soils, double cell, const Vec3& gravity);

  /// Before a step's kernels are queued, with at least one particle. `hold`: not the first step of
  /// a transfer.
  void begin_step(const ParticleStore& store, bool hold);
  /// After its impulses were booked.
  void end_step(const ParticleStore& store, Transfer& transfer, Contact& contact, double dt,
                bool hold, std::span<const ToolMotion> motions,
                std::span<const ToolImpulse> impulses);

  const EnergyAccount& account() const { return account_; }

 private:
  struct Node {
    double mass = 0;
    Vec3 v = Vec3::Zero();  ///< momentum while it is summed [m/s]
  };
  /// Particles' words of one moment, field after field.
  struct Words {
    std::vector<float> values;
    std::size_t capacity = 0;
    double at(int field, std::size_t slot) const {
      return static_cast<double>(values[static_cast<std::size_t>(field) * capacity + slot]);
    }
    int bits(int field, std::size_t slot) const;
  };
  static Words words_of(const ParticleStore& store);
  template <class Visit>
  static void for_particles(const ParticleStore& store, const Visit& visit);
  double moving_energy(const ParticleStore& store, const Words& now) const;
  double elastic_energy(const ParticleStore& store, const Words& now) const;
  void record_law(const ParticleStore& store, const Words& now, double dt);
  void scatter(const ParticleStore& store, const Words& now, Contact& contact);
  double nodes_energy() const;
  /// Velocities of the nodes after the step; takes the place of those before.
  std::vector<Vec3> velocities(Transfer& transfer, Contact& contact) const;
  void record_tools(Contact& contact, const std::vector<Vec3>& after,
                    std::span<const ToolMotion> motions, std::span<const ToolImpulse> impulses);

  std::vector<SoilRow> soils_;
  double cell_;
  Vec3 gravity_;
  EnergyAccount account_;
  Words before_;
  std::vector<Node> nodes_;  ///< front field of every active node, then the back field
  double moving_ = 0;        ///< kinetic energy of the particles after the last step
};

}  // namespace navvy::soil
