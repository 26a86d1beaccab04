// SPDX-License-Identifier: Apache-2.0
// Lists of the constants of a soil. The struct of the law, the table on the device, its loads in
// both schedules, the table of the host and the double twin all follow from these lists. Adding
// one: kernels/README.md.
#ifndef NAVVY_KERNELS_SOIL_LAW_CONSTANTS_H
#define NAVVY_KERNELS_SOIL_LAW_CONSTANTS_H

// bulk, shear: elastic moduli K, G [Pa]
//
// alpha: sin(friction angle)
//
// k_loose, k_dense, k_bond: cohesion at the loose density, residual minus loose cohesion, intact
// minus residual cohesion, each times cos(friction angle) [Pa]
//
// dense_offset, inv_range: the dense share is dense_offset - J0 inv_range, limited to 0 .. 1. They
// are swell / (swell - 1) and 1 / (swell - 1), or 1 and 0 without swell
//
// inv_remould, inv_opening: 1 / remoulding strain, 1 / opening strain
//
// static_share: relative growth of the yield stress at rest [docs/soil.md, static friction]
//
// viscosity: shear viscosity of soil that does not yield [Pa s] [docs/soil.md, viscosity]
//
// swell: largest J0
//
// loosening: growth of J0 per plastic shear, limited by J
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

// Used only if LAW_EXTENDED is defined.
//
// dilatancy: b, plastic volume strain per plastic shear in bank state
//
// matched: yield stress that plane strain needs at b / yield stress without dilatancy - 1
//
// alpha_fast: growth of alpha from slow to fast flow
//
// grain: diameter x sqrt(density) of the grains
//
// inertial: inertial number at half that growth
//
// cap: mean pressure that bank soil carries without compaction [Pa]
//
// cap_growth: relative growth of cap per volume strain
#define EXTENDED_LAW_CONSTANTS(X) \
  X(dilatancy)                    \
  X(matched)                      \
  X(alpha_fast)                   \
  X(grain)                        \
  X(inertial)                     \
  X(cap)                          \
  X(cap_growth)

#define ALL_LAW_CONSTANTS(X) \
  BASIC_LAW_CONSTANTS(X)     \
  EXTENDED_LAW_CONSTANTS(X)

#ifdef __cplusplus
namespace navvy::soil {
#endif

// One soil in the constant table on the device.
#define SOIL_ROW_FLOAT(name) float name;
typedef struct SoilRow {
  ALL_LAW_CONSTANTS(SOIL_ROW_FLOAT)
  // 1 / bank density [m3/kg].
  float inv_density;
  // Tangent of the friction angle on tools.
  float tool_friction;
  // Adhesion on tools [Pa].
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
