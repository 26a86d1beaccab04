// SPDX-License-Identifier: Apache-2.0
// Names of the overlays that pictures can show: lines, labels and colors that explain a scene.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace navvy::scene {

/// Something that pictures show in addition to machines and soil.
enum class Overlay {
  kJoints,
  kHitches,
  kForces,
  kWheelLoads,
  kPayload,
  kDesign,
  kPath,
  kGrid,
  kPerson,
  kHud,
  kCutFill,
  kActive,
  kDensity,
  kSpeed,
};

/// Name and meaning of an overlay.
struct OverlayInfo {
  Overlay overlay;   ///< the overlay
  const char* name;  ///< name in scene files and in `--show`
  const char* text;  ///< what it shows, one sentence
  bool color;        ///< true if it replaces the color of soil; a picture can show one of these
};

/// Returns all overlays, in the order in which help texts list them.
const std::vector<OverlayInfo>& overlays();
/// Returns the overlay of this name; null if there is none.
const OverlayInfo* overlay_named(const std::string& name);
/// Returns the overlays whose names `names` lists, separated by blanks; unknown names are skipped.
std::set<Overlay> overlays_of(const std::string& names);

}  // namespace navvy::scene
