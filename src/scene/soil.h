// SPDX-License-Identifier: Apache-2.0
// One soil, as described by a scene or by a file in terrain/soils/.
#pragma once

#include <string>

#include "scene/fields.h"
#include "scene/friction.h"

namespace navvy::scene {

/// Parameters of one soil in SI units, with angles in radians. They are constant during a run. The
/// constitutive law that uses them is described in [docs/soil.md, law].
struct Soil {
  std::string name;    ///< unique name of the soil in its scene
  std::string ref;     ///< shipped soil or soil file from which the values were taken; empty: none
  std::string source;  ///< origin of the values, for people
  double bank_density = 1540;      ///< density of undisturbed, moist soil [kg/m3]
  double swell = 1.23;             ///< loose volume / bank volume [-]
  double friction_angle = 0.5236;  ///< internal friction angle phi in plane strain [rad]
  /// Test whose result was given; `friction_angle` follows from it and from the dilatancy angle.
  FrictionTest friction_test = FrictionTest::kPlaneStrain;
  double tested_friction_angle = 0;  ///< result of that test [rad]; unused in plane strain
  double repose_angle = 0;           ///< angle of repose [rad], if given
  bool has_repose_angle = false;     ///< true: `repose_angle` was given, a result of kRepose
  /// Relative increase in strength of soil that is at rest or sheared at less than 0.1 /s, compared
  /// with flowing soil [-].
  double static_friction_share = 0.1;
  double cohesion = 5000;           ///< cohesion of intact soil [Pa]
  double residual_cohesion = 1000;  ///< cohesion after remoulding [Pa]
  double loose_cohesion = 200;      ///< cohesion of remoulded soil at its loose density [Pa]
  /// Plastic shear after which a quarter of the difference between `cohesion` and
  /// `residual_cohesion` is left [-].
  double remoulding_strain = 0.5;
  double loosening_strain = 0.3;  ///< plastic shear over which the swell develops [-]
  /// Relative increase in volume above the closed state at which cohesion is zero [-].
  double opening_strain = 0.05;
  double young_modulus = 1.0e6;  ///< Young's modulus [Pa]
  double poisson = 0.3;          ///< Poisson's ratio [-]
  /// Dilatancy angle psi at bank density [rad]; decreases to 0 at the loose density.
  double dilatancy_angle = 0;
  /// Friction angle of fast flow in the mu(I) law [rad]; at or below `friction_angle`, friction is
  /// independent of the rate.
  double fast_friction_angle = 0;
  double grain_diameter = 0.001;  ///< grain diameter d in the inertial number I [m]
  /// Inertial number at half of the increase from phi to the fast angle [-].
  double inertial_number = 0.279;
  /// Mean pressure above which bank soil compacts permanently [Pa]; 0: only tyres compact it.
  double compaction_pressure = 0;
  /// Volume strain over which the compaction pressure doubles [-].
  double compaction_strain = 0.05;
  double tool_friction_angle = 0.349;  ///< friction angle of soil on steel [rad]
  double adhesion = 0;  ///< shear strength of soil on steel without pressure [Pa]; never a tension
  double bekker_kc = 5270;  ///< cohesive modulus of Bekker's pressure-sinkage law [N/m^(n+1)]
  /// Frictional modulus of Bekker's pressure-sinkage law [N/m^(n+2)].
  double bekker_kphi = 1515040;
  double bekker_n = 0.7;  ///< exponent n of Bekker's pressure-sinkage law [-]
  /// Exponent a of repeated passes: n passes of one tyre sink n^(1/a) times as deep as the first
  /// [-], 1 to 20; 0: only the first pass sinks [docs/machines.md, ruts].
  double multi_pass_exponent = 0;
  /// Shear displacement at which soil below tyres and tracks has reached 63 % of its strength [m].
  double janosi_k = 0.02;
  float color[3] = {0.45f, 0.33f, 0.22f};  ///< linear red, green and blue, 0 to 1
  bool moist = false;  ///< true: pictures show freshly dug faces darker, as they are still moist

  /// Passes the fields of <navvy:soil> to the visitor `f`. The ranges include every soil, even snow
  /// and lunar dust.
  void describe(Fields& f) {  // A list of fields. NOLINT(readability-function-size)
    f.attribute("name", name, "Name by which layers, loads and results refer to the soil.");
    f.attribute("ref", ref,
                "Shipped soil, or *.sdf file with one soil, whose values the elements replace.",
                kShown);
    f("source", source, "Origin of the values.", kShown);
    f("bank_density_kg_per_m3", bank_density, {50, 20000}, "Density of undisturbed, moist soil.");
    f("swell", swell, {1, 2}, "Loose volume / bank volume.");
    f("friction_angle_deg", friction_angle, {0, kMostFrictionDegrees},
      "Internal friction angle: phi in plane strain unless `test` names another test, from whose "
      "result and psi the loader computes phi.",
      friction_test_attribute(friction_test));
    f("repose_angle_deg", repose_angle, {0, 44},
      "Angle of repose t, to give instead of friction_angle_deg: the same as there with "
      "test=\"repose\", sin phi = tan t.",
      kShown | given(has_repose_angle));
    f("static_friction_share", static_friction_share, {0, 0.1},
      "Share by which soil at rest, or sheared slower than 0.1 /s, is stronger than flowing soil.");
    f("cohesion_pa", cohesion, {0, 1e6}, "Cohesion of intact soil.");
    f("residual_cohesion_pa", residual_cohesion, {0, 1e6},
      "Cohesion after remoulding; at most the cohesion, which it follows down if it is not given.");
    f("loose_cohesion_pa", loose_cohesion, {0, 1e6},
      "Cohesion of remoulded soil at its loose density; by default a fifth of the residual one.");
    f("remoulding_strain", remoulding_strain, {1e-3, 100},
      "Plastic shear after which a quarter of the cohesion that remoulding takes is left.");
    f("loosening_strain", loosening_strain, {1e-3, 100},
      "Plastic shear over which the swell develops.");
    f("opening_strain", opening_strain, {1e-4, 1},
      "Volume ratio above closed at which cohesion is gone.");
    f("young_modulus_pa", young_modulus, {1e4, 1e9},
      "Stiffness, softened for longer time steps; by default 200 times the cohesion or 1 MPa, "
      "whichever is more. Below 100 times the cohesion a warning reports the loss of strength.");
    f("poisson", poisson, {0, 0.49}, "Poisson's ratio.");
    f("dilatancy_angle_deg", dilatancy_angle, {0, 30},
      "Dilatancy angle psi in the bank state, at most phi; it fades to 0 at the loose density, so "
      "it needs a swell.");
    f("fast_friction_angle_deg", fast_friction_angle, {0, 60},
      "Friction angle of fast flow in mu(I); up to phi, friction does not depend on the rate.");
    f("grain_diameter_m", grain_diameter, {1e-6, 0.5},
      "Grain diameter in I = shear rate x diameter x sqrt(2650 kg/m3 / pressure).");
    f("inertial_number", inertial_number, {1e-3, 10},
      "Inertial number I at half the increase from phi to the angle of fast flow.");
    f("compaction_pressure_pa", compaction_pressure, {0, 1e8},
      "Mean pressure above which bank soil compacts for good; 0: only tyres compact. A value below "
      "the pressure of the ground's own weight makes ground settle where it becomes active.");
    f("compaction_strain", compaction_strain, {1e-3, 1},
      "Volume strain over which the compaction pressure grows by its own value.");
    f("tool_friction_angle_deg", tool_friction_angle, {0, 60}, "Friction angle of soil on steel.");
    f("adhesion_pa", adhesion, {0, 1e5},
      "Shear stress of soil on steel without pressure; it never pulls.");
    f("bekker_kc_n_per_m_n1", bekker_kc, {-1e9, 1e9},
      "Cohesive modulus of Bekker's pressure-sinkage law, for tyres.");
    f("bekker_kphi_n_per_m_n2", bekker_kphi, {1, 1e9},
      "Frictional modulus of Bekker's pressure-sinkage law.");
    f("bekker_n", bekker_n, {0.05, 3}, "Exponent of Bekker's pressure-sinkage law.");
    f("multi_pass_exponent", multi_pass_exponent, {0, 20},
      "n passes of a tyre sink n^(1/a) times as deep as the first, a this exponent, at least 1: 2 "
      "to 3 loose, 3 to 4 medium, 4 to 5 firm soil; 0: repeated passes add nothing.");
    f("janosi_k_m", janosi_k, {1e-4, 1},
      "Shear displacement at which soil under tyres and tracks has 63 % of its strength.");
    f("color", Rgb{color}, "Linear red, green and blue.", kShown);
    f("moist", moist,
      "Whether the soil is moist below its surface: pictures then show freshly dug "
      "faces darker.",
      kShown);
  }
};

}  // namespace navvy::scene
