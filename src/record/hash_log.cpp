// SPDX-License-Identifier: Apache-2.0
#include "record/hash_log.h"

#include <cmath>
#include <cstdio>
#include <utility>

namespace navvy::record {
namespace {

/// Tolerance [intervals] for the rounding of time = steps x dt.
constexpr double kHair = 1e-9;

/// Returns the column names. A scene with sensors has more parts.
std::string header_of(const session::Session& session) {
  std::string header = "step,time_s,state";
  for (const auto& [part, hash] : session.hash_parts()) header += "," + part;
  return header;
}

}  // namespace

HashLog::HashLog(const session::Session& session, std::string path, double every)
    : session_(session), file_(std::move(path), header_of(session)), every_(every) {
  const sim::World& world = session_.world();
  // A resumed run continues at the next interval, so that its rows equal those of the whole run.
  if (world.steps() > 0)
    next_ = static_cast<std::uint64_t>(std::floor(world.time() / every_ + kHair)) + 1;
  observe();
}

void HashLog::row() {
  const sim::World& world = session_.world();
  // The step is exact; six digits of time are for people.
  char start[64];
  std::snprintf(start, sizeof start, "%llu,%.6f,", static_cast<unsigned long long>(world.steps()),
                world.time());
  std::string text = start + session_.state_hash();
  for (const auto& [part, hash] : session_.hash_parts()) text += "," + hash;
  last_step_ = world.steps();
  file_.add(text);
  // A row is expensive, so a kill in the next step must not lose it.
  file_.flush();
}

void HashLog::observe() {
  const double count = session_.world().time() / every_ + kHair;
  if (count < static_cast<double>(next_)) return;
  row();
  next_ = static_cast<std::uint64_t>(std::floor(count)) + 1;
}

void HashLog::finish() {
  // The final state has a row even between two intervals.
  if (file_.rows() == 0 || last_step_ != session_.world().steps()) row();
  file_.sync();
}

}  // namespace navvy::record
