// SPDX-License-Identifier: Apache-2.0
#include "control/load_change.h"

#include "control/reach.h"

namespace navvy::control {
namespace {

/// Share of the load that must leave: single particles that roll off are no success.
constexpr double kLeast = 0.01;

}  // namespace

std::string LoadChange::shortfall(const Load& load, const std::string& container) const {
  if (start_ == kUnknown || !load) return "";
  if (start_ <= 0) return "the " + container + " was empty: nothing could leave it";
  const double left = start_ - load();
  if (left >= kLeast * start_) return "";
  return "of the " + number_text(start_, "kg") + " in the " + container + " nothing has left it";
}

std::vector<Measurement> LoadChange::account(const Load& load, const char* left) const {
  if (start_ == kUnknown || !load) return {};
  return {{"payload_at_start_kg", start_}, {left, start_ - load()}};
}

}  // namespace navvy::control
