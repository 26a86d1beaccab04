// SPDX-License-Identifier: Apache-2.0
#include "session/travel.h"

namespace navvy::session {

void Travel::visit(Archive& a) {
  a("place", place);
  a("distance", distance);
  a("known", known);
}

TravelLog::TravelLog(const sim::World& world)
    : machines_(static_cast<std::size_t>(world.machines().count())) {}

void TravelLog::look(const sim::World& world) {
  for (std::size_t m = 0; m < machines_.size(); ++m) {
    Travel& one = machines_[m];
    const Vec2 at = world.machines().at(static_cast<int>(m)).link(0).pose().translation().head<2>();
    if (one.known == 0) {
      one.place = at;
      one.known = 1;
    }
    const double gone = (at - one.place).norm();
    if (gone < kTravelChord) continue;
    one.distance += gone;
    one.place = at;
  }
}

void TravelLog::visit(Archive& a) { a.fixed("machines", machines_); }

}  // namespace navvy::session
