// SPDX-License-Identifier: Apache-2.0
#include "sim/world_hashes.h"

#include <algorithm>

#include "core/hash.h"
#include "core/saved_state.h"
#include "sim/world_parts.h"

namespace navvy::sim {

std::uint64_t WorldHashes::start() const { return parts_->start_hash; }

/// Hashes the world alone; a session's hash includes its operators.
std::string WorldHashes::state() const {
  StateHash sum;
  sum.value(parts_->start_hash);
  add_to_hash(sum, *parts_);
  return sum.hex();
}

// Two runs compared row by row show which part differs first.
std::vector<std::pair<std::string, std::string>> WorldHashes::parts() const {
  std::vector<std::pair<std::string, std::string>> out;
  // Each part starts a sum of its own.
  const auto add = [&out](const char* name, const auto& part) {
    out.emplace_back(name, hash_of(part).hex());
  };
  StateHash start;
  start.value(parts_->start_hash);
  out.emplace_back("start", start.hex());
  add("ground", parts_->ground);
  add("soil", parts_->soil);
  add("dynamic_machines", *parts_->dynamic);
  add("kinematic_machines", *parts_->kinematic);
  add("coupling", parts_->coupling);
  if (parts_->has_encoders()) {
    StateHash sum;
    for (const vehicle::Encoders& encoders : parts_->encoders) add_to_hash(sum, encoders);
    out.emplace_back("encoders", sum.hex());
  }
  const auto& samplers = parts_->samplers;
  if (std::any_of(samplers.begin(), samplers.end(),
                  [](const auto& slot) { return slot->hashed(); }))
    add("arrays", parts_->arrays);
  for (const auto& slot : parts_->samplers) add(slot->name().c_str(), *slot);
  return out;
}

}  // namespace navvy::sim
