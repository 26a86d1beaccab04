// SPDX-License-Identifier: Apache-2.0
// Lists of the constants of a soil. Several definitions are generated from these lists: the struct
// of the law, the constant table on the device, its loads in both schedules, the constants on the
// host and the double-precision twin. kernels/README.md describes how to add a constant.
#ifndef NAVVY_KERNELS_SOIL_LAW_CONSTANTS_H
#define NAVVY_KERNELS_SOIL_LAW_CONSTANTS_H

// Constants that every soil uses.
//
// bulk, shear: elastic bulk modulus K and shear modulus G [Pa]
//
// alpha: sine of the friction angle
//
// k_loose, k_dense, k_bond: terms of the cohesion, each times cos(friction angle) [Pa]: cohesion at
// loose density; residual cohesion minus that; intact cohesion minus residual cohesion
//
// dense_offset, inv_range: give the dense share (1 in bank state, 0 when loose) as dense_offset -
// J0 inv_range, limited to 0 .. 1. They are swell / (swell - 1) and 1 / (swell - 1), or 1 and 0 for
// soil without swell
//
// inv_remould, inv_opening: 1 / remoulding strain, 1 / opening strain
//
// static_share: relative increase of the yield stress at rest [docs/soil.md, static friction]
//
// viscosity: shear viscosity of soil that does not yield [Pa s] [docs/soil.md, viscosity]
//
// swell: largest J0
//
// loosening: increase of J0 per plastic shear, up to J
#define BASIC_LAW_CONSTANTS(X) \
  X(bulk)                      \
  X(shear)                     \
  X(alpha)                     \
  X(k_loose)                   \
  X(k_dense)                   \
  X(k_bond)                    \
  X(dense_offset)              \
  X(inv_range)                 \
  X(inv_remould)               \
  X(inv_opening)               \
  X(static_share)              \
  X(viscosity)                 \
  X(swell)                     \
  X(loosening)

// Constants that are used only if LAW_EXTENDED is defined.
//
// dilatancy: b, plastic volume strain per plastic shear in bank state
//
// matched: relative increase of the yield stress by which soil with dilatancy b matches
// Mohr-Coulomb in plane strain
//
// alpha_fast: increase of alpha from slow to fast flow
//
// grain: grain diameter x sqrt(grain density) [kg^0.5 m^-0.5]
//
// inertial: inertial number at which half of alpha_fast is reached
//
// cap: mean pressure that soil in bank state carries without compaction [Pa]
//
// cap_growth: relative increase of cap per volume strain
#define EXTENDED_LAW_CONSTANTS(X) \
  X(dilatancy)                    \
  X(matched)                      \
  X(alpha_fast)                   \
  X(grain)                        \
  X(inertial)                     \
  X(cap)                          \
  X(cap_growth)

// All constants of the extended law, basic ones first.
#define ALL_LAW_CONSTANTS(X) \
  BASIC_LAW_CONSTANTS(X)     \
  EXTENDED_LAW_CONSTANTS(X)

#ifdef __cplusplus
namespace navvy::soil {
#endif

// One soil in the constant table on the device.
#define SOIL_ROW_FLOAT(name) float name;
// Constants of one soil in the constant table on the device.
typedef struct SoilRow {
  ALL_LAW_CONSTANTS(SOIL_ROW_FLOAT)
  // 1 / bank density [m3/kg].
  float inv_density;
  // Friction coefficient between soil and tools.
  float tool_friction;
  // Adhesion of the soil to tools [Pa].
  float adhesion;
} SoilRow;
#undef SOIL_ROW_FLOAT

#ifdef __cplusplus
#define ONE_MORE(name) +1
static_assert(sizeof(SoilRow) == sizeof(float) * (3 ALL_LAW_CONSTANTS(ONE_MORE)),
              "floats without gaps: one per constant of the lists and three");
#undef ONE_MORE
}  // namespace navvy::soil
#endif

#endif  // NAVVY_KERNELS_SOIL_LAW_CONSTANTS_H
