// SPDX-License-Identifier: Apache-2.0
// Energy account of the particle soil, as Solver::energy returns it.
#pragma once

namespace navvy::soil {

/// Energies of the particle soil [J]. All members are sums since recording began, except `kinetic`
/// and `elastic`, which are current values. They cover particles only; resting columns have no
/// energy account. [docs/soil.md, energy] defines how each member is computed.
struct EnergyAccount {
  /// Supplied: work done by tools on the soil.
  double tools = 0;
  /// Supplied: work done by gravity on the particles.
  double gravity = 0;
  /// Supplied: kinetic and elastic energy of soil that was activated or inserted, minus that of
  /// soil that was deposited or left the site.
  double exchanged = 0;
  /// Stored: current kinetic energy of the nodes.
  double kinetic = 0;
  /// Stored: current elastic energy of shear and of compression.
  double elastic = 0;
  /// Dissipated: plastic work, by yielding in shear and by permanent compaction.
  double plastic = 0;
  /// Dissipated: work of the shear and bulk viscosities of the soil law.
  double viscous = 0;
  /// Dissipated: friction of soil that slides along tools, and impacts of tools.
  double contact = 0;
  /// Dissipated: soil displaced by the edges of plates, which are thinner than a cell.
  double edge = 0;
  /// Dissipated: kinetic energy of the velocity components that are lost when velocities pass from
  /// particles to nodes and back.
  double transfer = 0;
  /// Dissipated: elastic energy lost when the volume ratios of the particles in a cell are
  /// averaged, in cells with open particles (J > J0).
  double mixing = 0;
  /// Outside the balance: potential energy gained when crowded particles are moved apart. No force
  /// does this work.
  double apart = 0;

  /// Returns the energy supplied to the particles since recording began [J].
  double supplied() const { return tools + gravity + exchanged; }
  /// Returns the energy dissipated since recording began [J].
  double dissipated() const { return plastic + viscous + contact + edge + transfer + mixing; }
  /// Returns the error of the balance, supplied - stored - dissipated [J]. It is not zero because
  /// stresses and velocities of a step belong to slightly different times.
  double residual() const { return supplied() - kinetic - elastic - dissipated(); }

  /// Adds the members of another account, for example that of a second site.
  EnergyAccount& operator+=(const EnergyAccount& other);
};

/// Calls visit(name, member pointer) for each member of EnergyAccount, in the order of their
/// declaration.
template <class Visit>
void each_energy(const Visit& visit) {
  visit("tools", &EnergyAccount::tools);
  visit("gravity", &EnergyAccount::gravity);
  visit("exchanged", &EnergyAccount::exchanged);
  visit("kinetic", &EnergyAccount::kinetic);
  visit("elastic", &EnergyAccount::elastic);
  visit("plastic", &EnergyAccount::plastic);
  visit("viscous", &EnergyAccount::viscous);
  visit("contact", &EnergyAccount::contact);
  visit("edge", &EnergyAccount::edge);
  visit("transfer", &EnergyAccount::transfer);
  visit("mixing", &EnergyAccount::mixing);
  visit("apart", &EnergyAccount::apart);
}

/// Reports the account for output: calls report(name, value [J]) for each member and then for
/// "residual".
template <class Sink>
void report_energy(const EnergyAccount& account, const Sink& report) {
  each_energy(
      [&](const char* name, double EnergyAccount::*member) { report(name, account.*member); });
  report("residual", account.residual());
}

/// Adds member by member, through each_energy.
inline EnergyAccount& EnergyAccount::operator+=(const EnergyAccount& other) {
  each_energy([&](const char*, double EnergyAccount::*member) { this->*member += other.*member; });
  return *this;
}

}  // namespace navvy::soil
