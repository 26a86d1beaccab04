// SPDX-License-Identifier: Apache-2.0
// One soil, as a scene or terrain/soils/*.sdf gives it. All angles [rad].
#pragma once

#include <string>

namespace navvy::scene {

/// Plain numbers in SI units, each within the range of soil_values.h. The law that uses them is in
/// [docs/soil.md, law]; a soil changes nothing about itself during a run.
struct Soil {
  std::string name;
  std::string source;              ///< where the numbers come from
  double bank_density = 1540;      ///< undisturbed [kg/m3]
  double swell = 1.23;             ///< loose volume / bank volume [-], >= 1
  double friction_angle = 0.5236;  ///< plane-strain internal friction angle phi [rad]
  /// By which soil that hardly shears is stronger than soil that flows [-].
  double static_friction_share = 0.1;
  double cohesion = 5000;           ///< c of intact soil [Pa]
  double residual_cohesion = 1000;  ///< c_r after remoulding [Pa]
  /// c_l of remoulded soil at its loose density, at most c_r [Pa].
  double loose_cohesion = 200;
  /// gamma_c: plastic shear at which (c - c_r) has fallen to a quarter [-].
  double remoulding_strain = 0.5;
  double loosening_strain = 0.3;  ///< plastic shear over which the swell develops [-]
  /// eps: volume ratio above closed at which cohesion is gone [-].
  double opening_strain = 0.05;
  /// Softened for speed [Pa]; default_stiffness(cohesion) where none is given.
  double young_modulus = 1.0e6;
  double poisson = 0.3;
  double dilatancy_angle = 0;  ///< psi in bank state, fades to 0 at the loose density [rad]
  /// That of fast flow in mu(I) [rad]; not above phi: friction knows no rate.
  double fast_friction_angle = 0;
  /// For the inertial number I = shear rate x diameter x sqrt(grain density / p) [m].
  double grain_diameter = 0.001;
  /// I at which half the way from phi to the fast angle is done [-].
  double inertial_number = 0.279;
  /// Mean pressure above which bank soil gets denser for good; 0: never [Pa].
  double compaction_pressure = 0;
  double compaction_strain = 0.05;  ///< volume strain over which that pressure grows by itself [-]
  double tool_friction_angle = 0.349;  ///< delta [rad]
  double adhesion = 0;                 ///< soil on steel [Pa]
  // Bekker-Wong plate and Janosi-Hanamoto shear, for tyres on resting ground.
  double bekker_kc = 5270;       ///< [N/m^(n+1)]
  double bekker_kphi = 1515040;  ///< [N/m^(n+2)]
  double bekker_n = 0.7;
  double janosi_k = 0.02;                  ///< [m]
  float color[3] = {0.45f, 0.33f, 0.22f};  ///< linear RGB 0..1
};

}  // namespace navvy::scene
