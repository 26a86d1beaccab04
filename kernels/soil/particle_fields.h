// SPDX-License-Identifier: Apache-2.0
// The fields of a particle, once: words of the store, the law's state, loads and stores of the
// kernels, records of the host and the double twin are made of these lists.
//
// MANY(NAME, member, count, rest) is an array of floats, ONE(NAME, member, rest) a single one;
// `rest` is what a lane without a particle holds: inside its tile, no mass, no stress. Adding a
// field: kernels/README.md.
#ifndef NAVVY_KERNELS_SOIL_PARTICLE_FIELDS_H
#define NAVVY_KERNELS_SOIL_PARTICLE_FIELDS_H

// x: offset from the home block's corner at the last transfer [cells]; v: velocity [m/s]; c:
// velocity gradient, row major, c[3 * i + j] = dv_i/dx_j [1/s]; moved: the way since the last
// transfer, which is added to x by the next one [cells] [docs/soil.md, transfer].
#define MOTION_FIELDS(ONE, MANY) \
  MANY(X, x, 3, 2.0f)            \
  MANY(V, v, 3, 0.0f)            \
  MANY(C, c, 9, 0.0f)            \
  MANY(MOVED, moved, 3, 0.0f)

// What the law advances. s: deviatoric stress xx yy zz xy yz xz [Pa], positive in tension; j:
// volume / bank volume; j0: density state, the volume ratio without pressure; shear: accumulated
// plastic shear.
#define LAW_STATE_FIELDS(ONE, MANY) \
  MANY(S, s, 6, 0.0f)               \
  ONE(J, j, 1.0f)                   \
  ONE(J0, j0, 1.0f)                 \
  ONE(SHEAR, shear, 0.0f)

#define FLOAT_FIELDS(ONE, MANY) \
  MOTION_FIELDS(ONE, MANY)      \
  LAW_STATE_FIELDS(ONE, MANY)

// Word of a field: field f of slot i is word f * capacity + i. After the floats three words of
// bits.
#define FIELD_ONE(NAME, member, rest) FIELD_##NAME,
#define FIELD_MANY(NAME, member, count, rest) FIELD_##NAME, FIELD_##NAME##_LAST = FIELD_##NAME + (count)-1,
enum {
  FLOAT_FIELDS(FIELD_ONE, FIELD_MANY)  //
  FIELD_MASS,                          // int, mass quanta
  // Int, soil | side << 16; side = 0: none, else 1 + 2 tool + (1 when behind)
  FIELD_TAG,
  FIELD_ID,                            // int, unique for life
  FIELD_COUNT
};
#undef FIELD_ONE
#undef FIELD_MANY

#endif  // NAVVY_KERNELS_SOIL_PARTICLE_FIELDS_H
