// SPDX-License-Identifier: Apache-2.0
// Claims of a soak, judged from its table.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "soak/phase.h"

namespace navvy::soak {

/// Largest excess of the maximum over the last three quarters above that of the first quarter
/// [bytes].
struct Allowance {
  // The state varies by itself: more or less sand is active at equal phases, in lists of this size.
  std::int64_t heap = 256 * 1024;
  // Pages vary with other processes; a leak of a page per cycle shows within some hundred cycles.
  std::int64_t resident = 1024 * 1024;
  // Buffers grow by half of their size, so one more is not a rounding effect.
  std::int64_t device = 0;
  /// Cycles of a process before it is judged: the first scoops meet all cases for the first time.
  std::size_t cycles = 40;
};

/// Returns the growth of each kind of bytes: the maximum over the last three quarters minus that of
/// the first, the worst of all processes with at least `cycles` cycles, four or more; zeros if
/// there is none.
Bytes growth(const std::vector<Phase>& phases, std::size_t cycles = Allowance().cycles);

/// Returns the violated claims, one sentence each; empty if bytes in use are flat after the first
/// quarter of each process and the ledger was balanced in every phase.
std::vector<std::string> broken_claims(const std::vector<Phase>& phases,
                                       const Allowance& allowance = {});

}  // namespace navvy::soak
