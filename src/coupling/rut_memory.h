// SPDX-License-Identifier: Apache-2.0
// What a column remembers of wheels and belts.
#pragma once

#include <limits>

#include "core/archive.h"
#include "scene/soil.h"

namespace navvy::coupling {

/// The largest pressure a column has borne, and where its surface lay then: standing still or a
/// second pass at the same load adds nothing, a heavier one what it presses more.
///
/// Soil that came onto it since is fresh, and is pressed from its own surface on; but what lies
/// below has borne what it has. So a rut into which its walls slide is pressed to its old floor and
/// not as deep again. Where ground was taken off below that floor, nothing is remembered.
struct RutMemory {
  double pressure = 0;        ///< largest borne by the surface [Pa]
  double height = 0;          ///< of that surface [m]
  double floor_pressure = 0;  ///< borne by ground below fresh soil, 0 where there is none [Pa]
  double floor_height = 0;    ///< [m]

  /// Takes note of the column's `surface` [m] as it lies now.
  void find(double surface);

  /// How far the column goes down [m], `at_most`, under a plate of `width` [m] that presses with
  /// `borne` [Pa], and the plate's sinkage in its soil before. Remembers it; the caller tells the
  /// new surface by `height`.
  struct Sinking {
    double before = 0, drop = 0;
  };
  Sinking press(const scene::Soil& soil, double width, double surface, double borne,
                double at_most = std::numeric_limits<double>::infinity());

  void visit(Archive& a);
};

}  // namespace navvy::coupling
