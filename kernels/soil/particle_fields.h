// SPDX-License-Identifier: Apache-2.0
// Lists of the fields of a particle. The words of the store, the state of the law, loads and stores
// of the kernels, the records of the host and the double twin all follow from these lists.
//
// MANY(NAME, member, count, rest) is an array of floats, ONE(NAME, member, rest) a single one.
// `rest` is the value in a lane without a particle: inside its tile, no mass, no stress. Adding a
// field: kernels/README.md.
#ifndef NAVVY_KERNELS_SOIL_PARTICLE_FIELDS_H
#define NAVVY_KERNELS_SOIL_PARTICLE_FIELDS_H

// x: offset from the corner of the block at the last transfer [cells]
//
// v: velocity [m/s]
//
// c: velocity gradient, row major, c[3 * i + j] = dv_i/dx_j [1/s]
//
// moved: displacement since the last transfer; the next transfer adds it to x [cells]
// [docs/soil.md, transfer]
#define MOTION_FIELDS(ONE, MANY) \
  MANY(X, x, 3, 2.0f)            \
  MANY(V, v, 3, 0.0f)            \
  MANY(C, c, 9, 0.0f)            \
  MANY(MOVED, moved, 3, 0.0f)

// State that the law advances.
//
// s: deviatoric stress xx yy zz xy yz xz [Pa], positive in tension
//
// j: volume / bank volume
//
// j0: density state, the volume ratio without pressure
//
// shear: accumulated plastic shear
#define LAW_STATE_FIELDS(ONE, MANY) \
  MANY(S, s, 6, 0.0f)               \
  ONE(J, j, 1.0f)                   \
  ONE(J0, j0, 1.0f)                 \
  ONE(SHEAR, shear, 0.0f)

#define FLOAT_FIELDS(ONE, MANY) \
  MOTION_FIELDS(ONE, MANY)      \
  LAW_STATE_FIELDS(ONE, MANY)

// Index of a field: field f of slot i is word f * capacity + i. Three integer words follow the
// floats.
#define FIELD_ONE(NAME, member, rest) FIELD_##NAME,
#define FIELD_MANY(NAME, member, count, rest) \
  FIELD_##NAME, FIELD_##NAME##_LAST = FIELD_##NAME + (count)-1,
enum {
  FLOAT_FIELDS(FIELD_ONE, FIELD_MANY)  //
  // int, mass quanta.
  FIELD_MASS,
  // int, soil | side << 16; side = 0: none, else 1 + 2 tool + (1 when behind).
  FIELD_TAG,
  // int, unique for life.
  FIELD_ID,
  FIELD_COUNT
};
#undef FIELD_ONE
#undef FIELD_MANY

#endif  // NAVVY_KERNELS_SOIL_PARTICLE_FIELDS_H
