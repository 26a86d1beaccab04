// SPDX-License-Identifier: Apache-2.0
// Goals of a scene: bounds on the score of a run.
#pragma once

#include "scene/fields.h"

namespace navvy::scene {

/// Bound on one value of a run's score.
struct Goal {
  double value = 0;    ///< the bound, in SI units
  bool given = false;  ///< true if the scene sets it
};

/// Goals that a scene sets. A run whose programs complete but that misses a goal does not count as
/// finished. Goals do not influence what a run computes.
struct Goals {
  Goal completion;     ///< least share of the commanded volume that is done [-]
  Goal coverage;       ///< least share of the commanded area that is done [-]
  Goal volume_error;   ///< largest error of the dug volume, relative to the design [-]
  Goal rms_error;      ///< largest rms difference between ground and design [m]
  Goal over_dig_rms;   ///< largest rms depth below the design [m]
  Goal over_dig_max;   ///< largest depth below the design [m]
  Goal under_dig_rms;  ///< largest rms height above the design [m]
  Goal batter_error;   ///< largest error of the angle of the sides [rad]
  Goal outside_cut;    ///< largest volume dug outside of the design [m3]
  Goal collisions;     ///< largest number of collisions [-]
  Goal work_time;      ///< longest time until the programs have ended [s]
  Goal load_error;     ///< largest error of a truck's load, relative to the wanted one [-]
  Goal load_passes;    ///< most passes of a load [-]
  Goal spilt;          ///< largest mass that fell beside the beds [kg]

  /// Returns true if the scene sets any goal.
  bool any() const {
    for (const Goal* one : {&completion, &coverage, &volume_error, &rms_error, &over_dig_rms,
                            &over_dig_max, &under_dig_rms, &batter_error, &outside_cut, &collisions,
                            &work_time, &load_error, &load_passes, &spilt})
      if (one->given) return true;
    return false;
  }
  /// Returns true if a goal concerns the design, which the scene must then have.
  bool need_design() const {
    for (const Goal* one : {&completion, &coverage, &volume_error, &rms_error, &over_dig_rms,
                            &over_dig_max, &under_dig_rms, &batter_error, &outside_cut})
      if (one->given) return true;
    return false;
  }
  /// Passes the fields of <navvy:goals> to the visitor `f`.
  void describe(Fields& f) {
    const auto goal = [&f](const char* name, Goal& one, Range range, const char* text) {
      f(name, one.value, range, text, kShown | scene::given(one.given));
    };
    goal("completion", completion, {0, 1}, "Least share of the commanded volume that is done.");
    goal("coverage", coverage, {0, 1}, "Least share of the commanded area that is done.");
    goal("volume_error", volume_error, {0, 1e3},
         "Largest difference of the dug from the commanded volume, relative to it.");
    goal("rms_error_m", rms_error, {0, 1e3}, "Largest rms difference of ground and design.");
    goal("over_dig_rms_m", over_dig_rms, {0, 1e3}, "Largest rms depth below the design.");
    goal("over_dig_max_m", over_dig_max, {0, 1e3}, "Largest depth below the design.");
    goal("under_dig_rms_m", under_dig_rms, {0, 1e3}, "Largest rms height above the design.");
    goal("batter_error_deg", batter_error, {0, 90}, "Largest error of the angle of the sides.");
    goal("outside_cut_m3", outside_cut, {0, 1e9}, "Largest volume dug outside of the design.");
    goal("collisions", collisions, {0, 1e9}, "Largest number of collisions.");
    goal("work_time_s", work_time, {0, 1e9}, "Longest time until the programs have ended.");
    goal("load_error", load_error, {0, 1e3},
         "Largest difference of a truck's load from load_kg, relative to it.");
    goal("load_passes", load_passes, {0, 1e6}, "Most passes of a load.");
    goal("spilt_kg", spilt, {0, 1e9}, "Largest mass that fell beside the beds.");
  }
};

}  // namespace navvy::scene
