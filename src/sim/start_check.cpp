// SPDX-License-Identifier: Apache-2.0
#include "sim/start_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "coupling/settling.h"
#include "geometry/oriented_box.h"
#include "heightfield/design_surface.h"
#include "heightfield/make_ground.h"
#include "sim/start_placing.h"
#include "vehicle/collision_box.h"
#include "vehicle/kinematics.h"

namespace navvy::sim {
namespace {

// [m] shapes are boxes here, and machines may stand side by side.
constexpr double kTouching = 0.02;
constexpr double kSettling = 1;  // [s]
constexpr double kFalling = 1;   // [m/s] downwards: it has not landed
constexpr double kTipped = radians(45);
constexpr double kThrown = 0.02;  // [m] more than a machine moves that finds its stand

struct LinkBox {
  geometry::OrientedBox box;
  const scene::Link* link = nullptr;
  bool as_commanded = false, stands = false;  // kinematic machine; fixed base
};

/// Kinematic machines pass through each other and through fixed ones.
bool may_meet(const LinkBox& a, const LinkBox& b) {
  return !(a.as_commanded && (b.as_commanded || b.stands)) && !(b.as_commanded && a.stands);
}

/// Hook and eye overlap, and so do the bodies around them.
bool are_hitched(const scene::Scene& scene, int a, int b) {
  return std::any_of(scene.hitches.begin(), scene.hitches.end(), [&](const scene::Hitch& hitch) {
    return hitch.closed &&
           ((hitch.parent == a && hitch.child == b) || (hitch.parent == b && hitch.child == a));
  });
}

std::string text(const char* format, double value) {
  std::array<char, 48> out{};
  std::snprintf(out.data(), out.size(), format, value);
  return out.data();
}

// Returns the boxes of all collision shapes at the initial joint positions, in W.
std::vector<LinkBox> boxes_of(const scene::MachineInWorld& placed, const Pose& X_WB) {
  std::vector<LinkBox> out;
  const scene::Machine& machine = placed.machine;
  std::vector<double> q;
  for (const scene::Joint& joint : machine.joints) q.push_back(joint.initial);
  const std::vector<Pose> X_WL = vehicle::forward_kinematics(machine, X_WB, q);
  for (std::size_t l = 0; l < machine.links.size(); ++l)
    for (const scene::Collision& collision : machine.links[l].collisions)
      if (std::optional<geometry::OrientedBox> box = vehicle::box_of(collision)) {
        box->X_WO = X_WL[l] * box->X_WO;
        out.push_back({*box, &machine.links[l], machine.kinematic, machine.fixed_base && l == 0});
      }
  return out;
}

// Returns an error at the line of the machine in the scene.
Fault error(const scene::Scene& scene, const scene::MachineInWorld& machine,
            const std::string& value, const std::string& rule, const std::string& remedy) {
  return {Fault::Severity::kError,
          scene.file,
          machine.line,
          "include[" + machine.name + "]",
          value,
          rule,
          remedy};
}

/// Returns true for a machine without joints that is fixed to the world.
bool stands_still(const scene::Machine& machine) {
  return machine.fixed_base &&
         std::all_of(machine.joints.begin(), machine.joints.end(), [](const scene::Joint& joint) {
           return joint.type == scene::Joint::Type::kFixed;
         });
}

}  // namespace

// Tests every pair of boxes of every pair of machines.
std::vector<Fault> check_overlaps(const scene::Scene& scene, const std::vector<Pose>& X_WB) {
  std::vector<std::vector<LinkBox>> boxes;
  for (std::size_t m = 0; m < scene.machines.size(); ++m)
    boxes.push_back(boxes_of(scene.machines[m], X_WB.at(m)));
  std::vector<Fault> faults;
  for (std::size_t a = 0; a < boxes.size(); ++a)
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      if (are_hitched(scene, static_cast<int>(a), static_cast<int>(b))) continue;
      // Nothing moves either of two that stand still, such as the parts of a building.
      if (stands_still(scene.machines[a].machine) && stands_still(scene.machines[b].machine))
        continue;
      // Report the deepest overlap of a pair: correcting it usually corrects the others.
      double deepest = kTouching;
      const scene::Link *of_a = nullptr, *of_b = nullptr;
      for (const LinkBox& one : boxes[a])
        for (const LinkBox& other : boxes[b]) {
          const double depth = may_meet(one, other) ? geometry::penetration(one.box, other.box) : 0;
          if (depth > deepest) deepest = depth, of_a = one.link, of_b = other.link;
        }
      if (!of_a) continue;
      const std::string& first = scene.machines[a].name;
      faults.push_back(error(scene, scene.machines[b], text("%.2f m", deepest),
                             "it overlaps '" + first + "' at the start: its link '" + of_b->name +
                                 "' reaches into '" + of_a->name + "' of '" + first + "'",
                             "move one of them by its <pose>"));
    }
  return faults;
}

// Tests wheels by their centres and links by the middle of their shapes.
std::vector<Fault> check_buried(const scene::Scene& scene, const std::vector<Pose>& X_WB,
                                const heightfield::Terrain& ground) {
  std::vector<Fault> faults;
  for (std::size_t m = 0; m < scene.machines.size(); ++m) {
    const scene::MachineInWorld& placed = scene.machines[m];
    if (placed.machine.kinematic) continue;
    // A part placed exactly on the ground is not below it by rounding.
    double deepest = kTouching;
    std::string what;
    const auto look = [&](const Vec3& p, const std::string& name) {
      const double depth = ground.sample(p.x(), p.y()) - p.z();
      if (depth > deepest) deepest = depth, what = name;
    };
    for (const LinkBox& one : boxes_of(placed, X_WB.at(m)))
      // A fixed machine may have its foot in the ground.
      if (!placed.machine.fixed_base || one.link != &placed.machine.links[0])
        look(one.box.X_WO.translation(), "link '" + one.link->name + "'");
    std::vector<double> q;
    for (const scene::Joint& joint : placed.machine.joints) q.push_back(joint.initial);
    const std::vector<Pose> X_WL = vehicle::forward_kinematics(placed.machine, X_WB.at(m), q);
    for (const scene::Wheel& wheel : placed.machine.wheels) {
      const int joint = placed.machine.joint_index(wheel.joint);
      if (joint < 0) continue;
      const scene::Joint& spin = placed.machine.joints[static_cast<std::size_t>(joint)];
      look(X_WL[static_cast<std::size_t>(spin.child)] * Vec3(spin.X_LcJ.translation()),
           "wheel '" + wheel.joint + "'");
    }
    if (what.empty()) continue;
    faults.push_back(
        error(scene, placed, text("%.2f m", deepest),
              "its " + what + " starts with its centre that far below the ground",
              "raise it by its <pose>, or set <navvy:on_ground>true</navvy:on_ground>"));
  }
  return faults;
}

namespace {

/// Largest gap between bodies of which one counts as resting on the other [m].
constexpr double kResting = 0.05;

/// Returns true if one of `boxes` would meet one of `below` when it sank a little, and is above it.
bool rests_on(std::vector<LinkBox> boxes, const std::vector<LinkBox>& below) {
  for (LinkBox& one : boxes) {
    one.box.X_WO.translation().z() -= kResting;
    for (const LinkBox& other : below)
      if (one.box.X_WO.translation().z() > other.box.X_WO.translation().z() &&
          geometry::penetration(one.box, other.box) > 0)
        return true;
  }
  return false;
}

Fault warning(Fault fault) {
  fault.severity = Fault::Severity::kWarning;
  return fault;
}

/// Returns a warning for each link whose inertia does not fit its shape.
void check_inertias(const scene::Scene& scene, const scene::MachineInWorld& placed,
                    std::vector<Fault>& faults) {
  if (placed.machine.kinematic) return;
  for (std::size_t l = placed.machine.fixed_base ? 1 : 0; l < placed.machine.links.size(); ++l) {
    const scene::Link& link = placed.machine.links[l];
    const vehicle::InertiaShare inertia = vehicle::inertia_share(link);
    if (inertia.share >= vehicle::kLeastInertiaShare) continue;
    faults.push_back(warning(error(
        scene, placed, text("%.3g kg m2", inertia.inertia),
        "the inertia of its link '" + link.name + "' is " + text("%.2g %%", 100 * inertia.share) +
            " of that of a solid body of its collision shapes and mass, " +
            text("%.3g kg m2", inertia.expected) + ": forces will spin it beyond any time step",
        "correct <inertia> in its file, or give navvy:density_kg_per_m3")));
  }
}

}  // namespace

std::vector<Fault> check_bodies(const scene::Scene& scene, const std::vector<Pose>& X_WB) {
  std::vector<Fault> faults;
  const auto is_movable = [](const scene::Machine& machine) {
    return !machine.kinematic && !machine.fixed_base;
  };
  std::vector<double> masses;
  for (const scene::MachineInWorld& placed : scene.machines) {
    check_inertias(scene, placed, faults);
    masses.push_back(placed.machine.total_mass());
  }
  for (std::size_t a = 0; a < scene.machines.size(); ++a)
    for (std::size_t b = 0; b < scene.machines.size(); ++b) {
      const scene::MachineInWorld &upper = scene.machines[a], &lower = scene.machines[b];
      const double ratio = masses[a] / masses[b];
      // Masses first: they are cheap and nearly always decide.
      if (!(ratio > vehicle::kMostMassRatio) || !is_movable(upper.machine) ||
          !is_movable(lower.machine) ||
          !rests_on(boxes_of(upper, X_WB.at(a)), boxes_of(lower, X_WB.at(b))))
        continue;
      faults.push_back(warning(error(
          scene, upper, text("%.4g kg", masses[a]),
          "it rests on '" + lower.name + "' of " + text("%.4g kg", masses[b]) + ", a ratio of " +
              text("%.3g", ratio) + ": contacts carry ratios up to " +
              text("%.0f", vehicle::kMostMassRatio) + ", beyond that bodies sink into each other",
          "give '" + lower.name + "' more mass, or fix it to the other one")));
    }
  return faults;
}

namespace {

/// Returns a comparison of the design with this site, so that a wrong unit or position shows. A
/// design that cannot be built is an error elsewhere.
std::string reported_design(const scene::Scene& scene, const heightfield::Ground& ground) try {
  const std::optional<heightfield::DesignSurface> design = heightfield::make_design(scene, ground);
  if (!design) return "";
  // The design is compared with the ground as it starts, so cut and fill are those of the whole
  // job.
  const heightfield::DesignComparison comparison = heightfield::against_design(ground, *design);
  double least = INFINITY, most = -INFINITY;
  for (const float z : design->z) {
    least = std::fmin(least, static_cast<double>(z));
    most = std::fmax(most, static_cast<double>(z));
  }
  const std::size_t areas = scene.commanded_design().areas.size();
  const std::string what =
      scene.design.file.empty() ? std::to_string(areas) + (areas == 1 ? " area" : " areas")
      : scene.design.tin        ? scene.design.file + ", surface '" + scene.design.tin->name + "'"
                                : scene.design.file;
  std::array<char, 160> out{};
  std::snprintf(
      out.data(), out.size(),
      ": %.4g m2 of the site, heights %.3f .. %.3f m in W, %.4g m3 to cut, %.4g m3 to fill\n",
      comparison.area, least, most, comparison.design_cut, comparison.design_fill);
  return "design " + what + out.data();
} catch (const InputError&) {
  return "";
}

/// Returns true for a machine that stands on its links. Stones and other single bodies are no
/// machines: they may start in the ground to their middle, as wheels may.
bool has_feet(const scene::Machine& machine) {
  return machine.links.size() > 1 && machine.wheels.empty();
}

/// Returns how a machine without wheels stands; empty for other machines.
std::string stands_without_wheels(const scene::Machine& machine, const coupling::Settled& one) {
  if (!one.movable || !has_feet(machine)) return "";
  if (one.fall_speed > kFalling) return "does not stand after a second: it is still falling";
  std::array<char, 160> out{};
  std::snprintf(out.data(), out.size(),
                "stands without wheels: after a second its base is %.3f m %s and has turned by "
                "%.1f deg; highest %.3f m up",
                std::abs(one.lift), one.lift < 0 ? "lower" : "higher", degrees(one.turn), one.rise);
  return out.data();
}

/// Returns a warning for a machine without wheels that leaves the ground upwards, as overlapping
/// shapes, a start beyond limits or placeholders of masses make it.
std::optional<Fault> thrown(const scene::Scene& scene, const scene::MachineInWorld& placed,
                            const coupling::Settled& one) {
  if (!one.movable || !has_feet(placed.machine) || !(one.rise > kThrown)) return {};
  return warning(
      error(scene, placed, text("%.2f m", one.rise),
            "its base is thrown up by that much within its first second",
            "look for shapes that overlap the ground or each other at the start, joints "
            "that start beyond their limits, springs that are stretched, and masses that "
            "are placeholders"));
}

}  // namespace

// Skips the settling if a machine starts inside the ground.
StartCheck check_start(const scene::Scene& scene) {
  StartCheck out;
  try {
    heightfield::Ground ground = heightfield::make_ground(scene, &out.terrain);
    out.design = reported_design(scene, ground);
    const std::vector<Pose> X_WB = starting_poses(scene, ground);
    out.faults = check_overlaps(scene, X_WB);
    for (Fault& fault : check_bodies(scene, X_WB)) out.faults.push_back(std::move(fault));
    std::vector<Fault> buried = check_buried(scene, X_WB, ground);
    const bool falls = !buried.empty();
    for (Fault& fault : buried) out.faults.push_back(std::move(fault));
    // Report a machine inside the ground once: settling would only let it fall.
    if (falls) return out;
    for (const coupling::Settled& one : coupling::settle(scene, ground, kSettling)) {
      const scene::MachineInWorld& placed = scene.machines[out.standing.size()];
      out.standing.push_back(one.stability);
      out.falling.push_back(one.fall_speed > kFalling);
      out.without_wheels.push_back(stands_without_wheels(placed.machine, one));
      if (std::optional<Fault> up = thrown(scene, placed, one)) out.faults.push_back(*up);
    }
    // settle() returns one entry per machine of the scene, empty ones for kinematic machines.
    for (std::size_t m = 0; m < out.standing.size(); ++m) {
      const vehicle::Stability& stands = out.standing[m];
      // A machine in the air has no ground to tip on yet.
      if (!stands.free || out.falling[m] || (stands.margin >= 0 && stands.tilt < kTipped)) continue;
      const std::string tilt = text("%.1f deg", degrees(stands.tilt));
      out.faults.push_back(error(
          scene, scene.machines[m], tilt,
          std::string("the machine tips over within its first second") +
              (stands.margin < 0 ? ": its centre of mass is " + text("%.2f m", -stands.margin) +
                                       " outside its support polygon"
                                 : ""),
          "place it on flatter ground, or turn it along the slope"));
    }
  } catch (const InputError& fault) {
    for (const Fault& one : fault.faults()) out.faults.push_back(one);
  }
  return out;
}

}  // namespace navvy::sim
