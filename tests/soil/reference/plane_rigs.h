// SPDX-License-Identifier: Apache-2.0
// Experiments on the plane-strain method: what a cure of the method is judged by before it is
// built.
#pragma once

#include "soil/reference/plane_strain.h"

namespace navvy::soil::reference {

/// An upright plate pushed along [docs/validation.md, speed and step].
struct PlaneBlade {
  double depth = 0.3, speed = 0.15;   ///< [m], [m/s]
  double from = 0.03, travel = 0.07;  ///< forces count from here to there [m]
  double friction = 0;                ///< tan of the friction angle on the plate
  double ramp = 0;                    ///< travel over which the plate comes up to speed [m]
};
struct BladeResult {
  double force = 0;         ///< mean over the window, for a metre of width [N]
  double over_rankine = 0;  ///< force / Rankine's passive force of a smooth wall, cohesion included
  double scatter = 0;       ///< standard deviation over mean
  /// (plastic + lost in transfers) / work of tool and gravity, from the start.
  double dissipated = 0;
  double transfer = 0;  ///< lost in transfers / work of the tool
  double crowding = 0;  ///< largest density in front of the plate / bank density
  double steps_a_transfer = 0;
};
BladeResult push_blade(const scene::Soil& soil, double cell, double courant,
                       const PlaneMethod& method, const PlaneBlade& blade);

/// Soil sheared between a fixed floor and a heavy rigid top, without gravity: mean of shear over
/// normal stress in the second half of `strain`.
double shear_ratio(const scene::Soil& soil, double cell, double courant, const PlaneMethod& method,
                   double speed, double normal_stress, double strain);

/// A bed at rest for `time` [s]: mean and scatter of the vertical stress over density x g x depth,
/// speed [m/s].
struct RestResult {
  double stress = 0, scatter = 0, speed = 0;
};
RestResult rest_bed(const scene::Soil& soil, double cell, double courant, const PlaneMethod& method,
                    double height, double time);

/// Share of its amplitude that a shear wave of `cells` keeps in one transfer; stiffness, gravity
/// and law left out.
double wave_kept_by_transfer(double cells);

}  // namespace navvy::soil::reference
