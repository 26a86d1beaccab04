// SPDX-License-Identifier: Apache-2.0
#include "session/collision.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "core/log.h"

namespace navvy::session {
namespace {

/// Break after which a contact is a collision of its own [s]: bodies that strike bounce.
constexpr double kBreak = 0.1;

/// Returns true for a body of one link that forces move.
bool is_loose(const scene::Machine& machine) {
  return !machine.fixed_base && !machine.kinematic && machine.joints.empty();
}

}  // namespace

std::string name_of_link(const sim::World& world, int machine, int link) {
  const sim::MachineHandle one = world.machines().at(machine);
  return "'" + one.name() + "' (" + one.description().links[static_cast<std::size_t>(link)].name +
         ")";
}

std::string text_of(const sim::LinkPair& links, const sim::World& world) {
  return name_of_link(world, links.machine, links.link) + " touches " +
         name_of_link(world, links.other_machine, links.other_link);
}

void MachineCollision::visit(Archive& a) {
  visit_links(a);
  a("start", start);
  a("end", end);
  a("force_peak", force_peak);
  a("depth_peak", depth_peak);
}

void CollisionWatch::look(const sim::World& world,
                          const std::vector<sim::MachineContact>& contacts) {
  touching_.reset();
  for (const sim::MachineContact& contact : contacts) {
    // Loose bodies, such as rocks in a bucket, touch machines in normal work.
    const auto& machines = world.description().machines;
    if (is_loose(machines[static_cast<std::size_t>(contact.machine)].machine) ||
        is_loose(machines[static_cast<std::size_t>(contact.other_machine)].machine))
      continue;
    const double now = world.time();
    // The newest collisions are at the end.
    const auto known = std::find_if(list_.rbegin(), list_.rend(), [&](const MachineCollision& one) {
      return one.is_of(contact) && now - one.end <= kBreak;
    });
    if (known != list_.rend()) {
      known->end = now;
      known->force_peak = std::max(known->force_peak, contact.force);
      known->depth_peak = std::max(known->depth_peak, contact.depth);
      if (!touching_) touching_ = *known;
      continue;
    }
    ++count_;
    const MachineCollision fresh{contact, now, now, contact.force, contact.depth};
    if (!touching_) touching_ = fresh;
    // The list is bounded, the count is not.
    if (list_.size() < kMost) list_.push_back(fresh);
    if (!logged_.insert({contact.machine, contact.other_machine}).second) continue;
    std::array<char, 32> when{};
    std::snprintf(when.data(), when.size(), "%.2f s", now);
    log_warning("collision: " + text_of(fresh, world) + " at " + when.data() +
                "; the summary lists all of them (logged once per pair of machines)");
  }
}

void CollisionWatch::visit(Archive& a) {
  a("collisions", list_);
  a("count", count_);
  a("logged", logged_);
}

}  // namespace navvy::session
