// SPDX-License-Identifier: Apache-2.0
#include "soak/claims.h"

#include <algorithm>
#include <map>

namespace navvy::soak {
namespace {

/// Returns the largest values of each kind over rows [from, to).
Bytes most(const std::vector<Phase>& rows, std::size_t from, std::size_t to) {
  Bytes out;
  for (std::size_t i = from; i < to; ++i) {
    out.heap = std::max(out.heap, rows[i].bytes.heap);
    out.resident = std::max(out.resident, rows[i].bytes.resident);
    out.device = std::max(out.device, rows[i].bytes.device);
  }
  return out;
}

}  // namespace

Bytes growth(const std::vector<Phase>& phases, std::size_t cycles) {
  // Each process has its own memory.
  std::map<int, std::vector<Phase>> processes;
  for (const Phase& phase : phases) processes[phase.process].push_back(phase);
  Bytes worst{INT64_MIN, INT64_MIN, INT64_MIN};
  bool any = false;
  for (const auto& [process, rows] : processes) {
    if (rows.size() < std::max<std::size_t>(cycles, 4)) continue;
    any = true;
    const Bytes before = most(rows, 0, rows.size() / 4),
                after = most(rows, rows.size() / 4, rows.size());
    worst.heap = std::max(worst.heap, after.heap - before.heap);
    worst.resident = std::max(worst.resident, after.resident - before.resident);
    worst.device = std::max(worst.device, after.device - before.device);
  }
  return any ? worst : Bytes{};
}

std::vector<std::string> broken_claims(const std::vector<Phase>& phases,
                                       const Allowance& allowance) {
  std::vector<std::string> out;
  const Bytes grown = growth(phases, allowance.cycles);
  const auto judge = [&](const std::string& what, std::int64_t bytes, std::int64_t allowed) {
    if (bytes > allowed)
      out.push_back(what + " grew by " + std::to_string(bytes) +
                    " bytes after the first quarter, " + std::to_string(allowed) + " are allowed");
  };
  judge("memory allocated by malloc", grown.heap, allowance.heap);
  judge("resident memory", grown.resident, allowance.resident);
  judge("memory of the device's buffers", grown.device, allowance.device);
  for (const Phase& phase : phases) {
    if (phase.ledger == 0) continue;
    out.push_back("the mass ledger is off by " + std::to_string(phase.ledger) +
                  " units after cycle " + std::to_string(phase.cycle));
    break;
  }
  return out;
}

}  // namespace navvy::soak
