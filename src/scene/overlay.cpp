// SPDX-License-Identifier: Apache-2.0
#include "scene/overlay.h"

#include <sstream>

namespace navvy::scene {

const std::vector<OverlayInfo>& overlays() {
  static const std::vector<OverlayInfo> all = {
      {Overlay::kJoints, "joints", "Axes of all joints, with arcs or bars between their limits.",
       false},
      {Overlay::kHitches, "hitches", "Couplings between machines; grey where they are open.",
       false},
      {Overlay::kForces, "forces", "Force of the soil on each tool, at its tip [kN].", false},
      {Overlay::kWheelLoads, "wheel_loads", "Force of the ground on each wheel [kN].", false},
      {Overlay::kPayload, "payload", "Mass of the soil in each bucket and bed [kg].", false},
      {Overlay::kDesign, "design", "Edges of the areas to be dug or filled.", false},
      {Overlay::kPath, "path", "Planned paths, and stakes at the places of each program.", false},
      {Overlay::kGrid, "grid", "Lines on the ground every 1 m and 5 m, with coordinates.", false},
      {Overlay::kPerson, "person", "A person of 1.75 m beside each machine, for scale.", false},
      {Overlay::kHud, "hud", "One line: scene, time, phase, payload, force.", false},
      {Overlay::kCutFill, "cut_fill", "Cut in red and fill in blue, in full color at 0.5 m.", true},
      {Overlay::kActive, "active", "Active soil in orange.", true},
      {Overlay::kDensity, "density", "Active soil from bank state (blue) to loose (red).", true},
      {Overlay::kSpeed, "speed", "Active soil by speed, from 0 (blue) to 1 m/s (red).", true},
  };
  return all;
}

const OverlayInfo* overlay_named(const std::string& name) {
  for (const OverlayInfo& one : overlays())
    if (name == one.name) return &one;
  return nullptr;
}

std::set<Overlay> overlays_of(const std::string& names) {
  std::set<Overlay> out;
  std::istringstream words(names);
  for (std::string word; words >> word;)
    if (const OverlayInfo* one = overlay_named(word)) out.insert(one->overlay);
  return out;
}

}  // namespace navvy::scene
