// SPDX-License-Identifier: Apache-2.0
// Events that a scene forbids: the first one ends a run as failed.
#pragma once

#include <optional>
#include <vector>

#include "core/limits.h"
#include "scene/fields.h"

namespace navvy::scene {

/// An area in which soil may come to rest, as a simple polygon.
struct SpillArea {
  /// Corners in W [m], in either winding; the last corner is connected to the first one.
  std::vector<Vec2> polygon;
  /// Coordinates of `polygon` as the file lists them: x y x y ...
  std::vector<double> polygon_numbers;

  /// Passes the fields of an <area> to the visitor `f`.
  void describe(Fields& f) {
    f("polygon_m", polygon_numbers, {-1e6, 1e6},
      "Coordinates x y in W of 3 to 1000 corners; edges must not cross.", kNeeded);
  }
};

/// Limit on the soil that comes to rest outside some areas.
struct SpillLimit {
  double mass = 0;               ///< largest allowed mass outside the areas [kg]
  std::vector<SpillArea> areas;  ///< areas in which soil may lie; none: the whole site

  /// Passes the fields of a <spill_outside> to the visitor `f`.
  void describe(Fields& f) {
    f("mass_kg", mass, {0.001, 1e9},
      "Largest mass that columns outside the areas gain and that leaves the site.", kNeeded);
    f("area", areas, limits::kDesignAreas, "Area in which soil may lie; none: the whole site.");
  }
};

/// Events that a scene forbids. They decide nothing that a run computes except its end.
struct Forbidden {
  bool collision = false;           ///< true: links of two machines must not touch
  bool off_site = false;            ///< true: no machine's base may leave the site
  bool tip = false;                 ///< true: no machine may tip over
  bool buried = false;              ///< true: no machine may be buried
  std::optional<SpillLimit> spill;  ///< limit on soil outside some areas; empty: none

  /// Returns true if the scene forbids any event.
  bool any() const { return collision || off_site || tip || buried || spill.has_value(); }
  /// Passes the fields of <navvy:forbid> to the visitor `f`.
  void describe(Fields& f) {
    f("collision", collision,
      "Links of two machines touch; bodies of one link that forces move, such as rocks, may.");
    f("off_site", off_site, "The base of a machine leaves the site.");
    f("tip", tip, "A machine tips over.");
    f("buried", buried, "Soil covers the wheels of a machine.");
    f("spill_outside", spill, "Soil comes to rest outside of areas, or leaves the site.");
  }
};

}  // namespace navvy::scene
