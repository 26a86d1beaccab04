// SPDX-License-Identifier: Apache-2.0
// What a soak claims, judged from its table.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "soak/phase.h"

namespace navvy::soak {

/// How far the most of the last three quarters may lie above the most of the first [bytes].
struct Allowance {
  // The state itself breathes: more or less sand lies awake at equal phases, in lists of its
  // number.
  std::int64_t heap = 256 * 1024;
  // Pages come and go by what else runs on the machine; a leak of a page a cycle shows within some
  // hundred cycles.
  std::int64_t resident = 1024 * 1024;
  // Buffers grow by halves of themselves: one more is no rounding.
  std::int64_t device = 0;
  /// Cycles of a process from which on it is judged: the first scoops meet everything for the first
  /// time.
  std::size_t cycles = 40;
};

/// Growth of each kind of bytes: the most of the last three quarters less the most of the first,
/// the worst of all processes of at least `cycles`, four or more; zeros when there is none.
Bytes growth(const std::vector<Phase>& phases, std::size_t cycles = Allowance().cycles);

/// What does not hold of a table, one sentence each; empty: bytes in use are flat after the first
/// quarter of each process and the ledger was closed in every phase.
std::vector<std::string> broken_claims(const std::vector<Phase>& phases,
                                       const Allowance& allowance = {});

}  // namespace navvy::soak
