// SPDX-License-Identifier: Apache-2.0
// Where the energy of the particle soil came from and went: what `Solver::energy` tells.
#pragma once

namespace navvy::soil {

/// Sums since the account was opened [J], but `kinetic` and `elastic`, which are what there is now.
/// All of them are of particles: ground at rest has no account. How each is taken:
/// [docs/soil.md, energy].
struct EnergyAccount {
  // Supplied.
  double tools = 0;    ///< work of tools on soil
  double gravity = 0;  ///< work of gravity
  /// Kinetic and elastic energy of soil that woke or was put in, less that of what left.
  double exchanged = 0;
  // Kept.
  double kinetic = 0;  ///< of the nodes
  double elastic = 0;  ///< of shear and volume
  // Spent.
  double plastic = 0;   ///< yield, and volume that compaction keeps
  double viscous = 0;   ///< of the law's viscosities
  double contact = 0;   ///< sliding along tools, and what a tool strikes
  double transfer = 0;  ///< velocities that particles and nodes do not hand on
  double mixing = 0;    ///< volume that is evened out in cells with open particles
  // Beside the balance.
  /// Potential energy that moving crowded particles apart made; no force did that work.
  double apart = 0;

  double supplied() const { return tools + gravity + exchanged; }
  double dissipated() const { return plastic + viscous + contact + transfer + mixing; }
  /// What the sums do not explain: stresses and velocities of a step are not of one moment.
  double residual() const { return supplied() - kinetic - elastic - dissipated(); }

  /// Two soils' accounts together.
  EnergyAccount& operator+=(const EnergyAccount& other);
};

/// Every member under its name: visit(name, member pointer).
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

/// The account as people and files get it: tell(name, [J]) for every member, then for the residual.
template <class Tell>
void report_energy(const EnergyAccount& account, const Tell& tell) {
  each_energy(
      [&](const char* name, double EnergyAccount::*member) { tell(name, account.*member); });
  tell("residual", account.residual());
}

inline EnergyAccount& EnergyAccount::operator+=(const EnergyAccount& other) {
  each_energy([&](const char*, double EnergyAccount::*member) { this->*member += other.*member; });
  return *this;
}

}  // namespace navvy::soil
