// SPDX-License-Identifier: Apache-2.0
#include "control/activities/dig/landing.h"

#include <numeric>

#include "control/reach.h"

namespace navvy::control {
namespace {

/// Share of a bucket's load that must land: a full bed sheds some of it.
constexpr double kLeast = 0.5;

}  // namespace

void Landing::start(const Observation& seen) {
  dumping_ = !into_.empty() && seen.load_of;
  if (!dumping_) return;
  dumped_ = seen.payload;
  before_ = seen.load_of(into_);
}

std::string Landing::end(const Observation& seen) {
  if (!dumping_) return "";
  dumping_ = false;
  landed_.push_back(seen.load_of(into_) - before_);
  if (landed_.back() >= kLeast * dumped_) return "";
  return "of the " + number_text(dumped_, "kg") + " in the bucket of cycle " +
         std::to_string(landed_.size()) + " only " + number_text(landed_.back(), "kg") +
         " landed in '" + into_ + "'";
}

std::vector<Measurement> Landing::account() const {
  if (into_.empty()) return {};
  std::vector<Measurement> out = {
      {"landed_kg", std::accumulate(landed_.begin(), landed_.end(), 0.0)}};
  for (std::size_t i = 0; i < landed_.size(); ++i)
    out.push_back({"landed_in_cycle_" + std::to_string(i + 1) + "_kg", landed_[i]});
  return out;
}

void Landing::visit(Archive& a) {
  // Digs without a receiver keep their states.
  if (into_.empty()) return;
  a("dumping", dumping_);
  a("dumped", dumped_);
  a("before", before_);
  a("landed", landed_);
}

}  // namespace navvy::control
