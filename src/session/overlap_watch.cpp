// SPDX-License-Identifier: Apache-2.0
#include "session/overlap_watch.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/log.h"
#include "session/collision.h"
#include "vehicle/collision_box.h"

namespace navvy::session {
namespace {

/// Depth that counts, as a share of the smaller body's smallest side [-], and the time for which it
/// must last [s]. Impacts are deeper for a few steps.
constexpr double kDeep = 0.1, kLasting = 0.2;
/// Shallowest depth that counts [m]: contacts yield by millimetres under tonnes.
constexpr double kLeast = 0.005;
/// Break that does not end an overlap [s]: contacts come and go while bodies are pushed apart.
constexpr double kBreak = 0.02;

/// Returns true if a force can move the link.
bool is_movable(const sim::World& world, int machine, int link) {
  const scene::Machine& one = world.machines().at(machine).description();
  return !one.kinematic && (!one.fixed_base || link != 0);
}

/// Returns the likely cause with its remedy.
std::string cause_of(const BodyOverlap& overlap, const sim::World& world) {
  const scene::Machine& one = world.machines().at(overlap.machine).description();
  const scene::Machine& other = world.machines().at(overlap.other_machine).description();
  const double a = one.total_mass(), b = other.total_mass(),
               ratio = std::max(a, b) / std::min(a, b);
  if (!is_movable(world, overlap.machine, overlap.link) ||
      !is_movable(world, overlap.other_machine, overlap.other_link) ||
      !(ratio > vehicle::kMostMassRatio))
    return "after an impact, by a larger force than contacts carry, or because one started inside "
           "the other";
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "their masses are %.3g and %.3g kg, a ratio of %.3g: contacts carry ratios up to "
                "%.0f; give the light one more mass, or fix it to the heavy one",
                a, b, ratio, vehicle::kMostMassRatio);
  return text.data();
}

}  // namespace

void BodyOverlap::visit(Archive& a) {
  visit_links(a);
  a("start", start);
  a("end", end);
  a("depth_peak", depth_peak);
  a("share_peak", share_peak);
}

void OverlapWatch::Open::visit(Archive& a) {
  a("overlap", overlap);
  a("number", number);
}

void OverlapWatch::look(const sim::World& world, const std::vector<sim::MachineContact>& contacts) {
  const double now = world.time();
  for (const sim::MachineContact& contact : contacts) {
    if (!(contact.depth > std::max(kLeast, kDeep * contact.size))) continue;
    if (!is_movable(world, contact.machine, contact.link) &&
        !is_movable(world, contact.other_machine, contact.other_link))
      continue;
    auto known = std::find_if(open_.begin(), open_.end(),
                              [&](const Open& one) { return one.overlap.is_of(contact); });
    if (known == open_.end()) {
      open_.push_back({{contact, now, now, 0, 0}, -1});
      known = open_.end() - 1;
    }
    BodyOverlap& overlap = known->overlap;
    overlap.end = now;
    overlap.depth_peak = std::max(overlap.depth_peak, contact.depth);
    overlap.share_peak = std::max(overlap.share_peak, contact.depth / contact.size);
    if (known->number < 0 && overlap.end - overlap.start >= kLasting) note(*known, world);
    if (known->number >= 0 && known->number < static_cast<std::int64_t>(list_.size()))
      list_[static_cast<std::size_t>(known->number)] = overlap;
  }
  std::erase_if(open_, [&](const Open& one) { return now - one.overlap.end > kBreak; });
}

void OverlapWatch::note(Open& one, const sim::World& world) {
  one.number = count_++;
  const BodyOverlap& fresh = one.overlap;
  const bool logged = std::any_of(list_.begin(), list_.end(), [&](const BodyOverlap& before) {
    return before.machine == fresh.machine && before.other_machine == fresh.other_machine;
  });
  const bool full = list_.size() == kMost;
  if (!full) list_.push_back(fresh);
  // Pairs that the full list lacks would be logged at each of their overlaps.
  if (logged || full) return;
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(),
                "%.3f m deep for %.2f s, %.0f %% of the smaller one's smallest side, at %.2f s: ",
                fresh.depth_peak, fresh.end - fresh.start, 100 * fresh.share_peak, fresh.end);
  log_warning("overlap: " + name_of_link(world, fresh.machine, fresh.link) + " and " +
              name_of_link(world, fresh.other_machine, fresh.other_link) + " are in each other, " +
              text.data() + cause_of(fresh, world) +
              "; the summary lists all of them (logged once per pair of machines)");
}

void OverlapWatch::visit(Archive& a) {
  a("open", open_);
  a("overlaps", list_);
  a("count", count_);
  const auto known = [&](const Open& one) { return one.number >= -1 && one.number < count_; };
  a.require(std::all_of(open_.begin(), open_.end(), known), "open",
            "refers to an overlap that is not listed");
  a.require(count_ >= static_cast<std::int64_t>(list_.size()), "count",
            "is smaller than the number of overlaps");
}

}  // namespace navvy::session
