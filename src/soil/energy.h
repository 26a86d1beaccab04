// SPDX-License-Identifier: Apache-2.0
// Energy account of the particle soil, as Solver::energy returns it.
#pragma once

namespace navvy::soil {

/// Sums since the account was opened [J], except `kinetic` and `elastic`, which are current values.
/// All of them refer to particles: ground at rest has no account. docs/soil.md says how each is
/// computed [docs/soil.md, energy].
struct EnergyAccount {
  // Supplied.
  /// Work of tools on soil.
  double tools = 0;
  /// Work of gravity.
  double gravity = 0;
  /// Kinetic and elastic energy of soil that was activated or put in, minus that of soil that left.
  double exchanged = 0;
  // Stored.
  /// Kinetic energy of the nodes.
  double kinetic = 0;
  /// Elastic energy of shear and volume.
  double elastic = 0;
  // Dissipated.
  /// Yield, and volume that compaction keeps.
  double plastic = 0;
  /// The viscosities of the law.
  double viscous = 0;
  /// Sliding along tools, and impacts of tools.
  double contact = 0;
  /// Velocity components that the transfer between particles and nodes filters out.
  double transfer = 0;
  /// Volume that mixing evens out in cells with open particles.
  double mixing = 0;
  // Outside the balance.
  /// Potential energy gained by separating crowded particles; no force does that work.
  double apart = 0;

  /// Returns the energy that came in [J].
  double supplied() const { return tools + gravity + exchanged; }
  /// Returns the energy that was spent [J].
  double dissipated() const { return plastic + viscous + contact + transfer + mixing; }
  /// Returns what the sums do not explain: stresses and velocities of a step belong to different
  /// moments.
  double residual() const { return supplied() - kinetic - elastic - dissipated(); }

  /// Adds another account, as of a second site.
  EnergyAccount& operator+=(const EnergyAccount& other);
};

/// Calls visit(name, member pointer) for every member.
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
  visit("transfer", &EnergyAccount::transfer);
  visit("mixing", &EnergyAccount::mixing);
  visit("apart", &EnergyAccount::apart);
}

/// Reports the account as people and files get it: report(name, [J]) for every member, then for the
/// residual.
template <class Sink>
void report_energy(const EnergyAccount& account, const Sink& report) {
  each_energy(
      [&](const char* name, double EnergyAccount::*member) { report(name, account.*member); });
  report("residual", account.residual());
}

inline EnergyAccount& EnergyAccount::operator+=(const EnergyAccount& other) {
  each_energy([&](const char*, double EnergyAccount::*member) { this->*member += other.*member; });
  return *this;
}

}  // namespace navvy::soil
