// SPDX-License-Identifier: Apache-2.0
#include "lab/report.h"

#include <algorithm>
#include <cmath>

namespace navvy::lab {

bool Quantity::has_tolerance() const { return !std::isnan(low) || !std::isnan(high); }

bool Quantity::outside_tolerance() const {
  if (!judged()) return false;
  // Written so that a measured NaN is outside.
  const bool above = std::isnan(low) || measured >= low,
             below = std::isnan(high) || measured <= high;
  return !(above && below) || std::isnan(measured);
}

Quantity& Report::add(const std::string& name, double measured, const std::string& unit,
                      double expected, double low, double high, const std::string& source) {
  // Results print in the order in which they were added.
  results.push_back({name, measured, unit, expected, low, high, source});
  return results.back();
}

void Report::note(const std::string& name, double measured, const std::string& unit,
                  const std::string& source) {
  results.push_back({name, measured, unit, kNone, kNone, kNone, source});
}

bool Report::outside_tolerance() const {
  return std::any_of(results.begin(), results.end(),
                     [](const Quantity& q) { return q.outside_tolerance(); });
}

const Quantity* Report::find(const std::string& name) const {
  // A dozen results: a search by name is cheap and keeps their order.
  for (const Quantity& quantity : results)
    if (quantity.name == name) return &quantity;
  return nullptr;
}

}  // namespace navvy::lab
