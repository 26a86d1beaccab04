// SPDX-License-Identifier: Apache-2.0
// Lists of the fields of a particle. Several definitions are generated from these lists: the words
// of the particle store, the state of the soil law, the loads and stores of the kernels, the host
// records and the double-precision twin.
//
// MANY(NAME, member, count, rest) describes an array of floats, ONE(NAME, member, rest) a single
// float. `rest` is the value in an unused lane: a position inside the tile, no mass, no stress.
// kernels/README.md describes how to add a field.
#ifndef NAVVY_KERNELS_SOIL_PARTICLE_FIELDS_H
#define NAVVY_KERNELS_SOIL_PARTICLE_FIELDS_H

// Fields of the particle's motion.
//
// x: offset from the corner of the block at the last transfer [cells]
//
// v: velocity [m/s]
//
// c: velocity gradient, row by row: c[3 * i + j] = dv_i/dx_j [1/s]
//
// moved: displacement since the last transfer, which the end of the transfer adds to x [cells]
// [docs/soil.md, transfer]
#define MOTION_FIELDS(ONE, MANY) \
  MANY(X, x, 3, 2.0f)            \
  MANY(V, v, 3, 0.0f)            \
  MANY(C, c, 9, 0.0f)            \
  MANY(MOVED, moved, 3, 0.0f)

// Fields that the soil law advances.
//
// s: deviatoric stress xx, yy, zz, xy, yz, xz [Pa], positive in tension
//
// j: volume ratio J = volume / bank volume
//
// j0: density state J0, the volume ratio at which the soil carries no pressure
//
// shear: accumulated plastic shear strain [-]
#define LAW_STATE_FIELDS(ONE, MANY) \
  MANY(S, s, 6, 0.0f)               \
  ONE(J, j, 1.0f)                   \
  ONE(J0, j0, 1.0f)                 \
  ONE(SHEAR, shear, 0.0f)

// All fields that are floats.
#define FLOAT_FIELDS(ONE, MANY) \
  MOTION_FIELDS(ONE, MANY)      \
  LAW_STATE_FIELDS(ONE, MANY)

// Index FIELD_* of each field: the word of field f in slot i is at f * capacity + i. Three integer
// words follow the floats.
#define FIELD_ONE(NAME, member, rest) FIELD_##NAME,
#define FIELD_MANY(NAME, member, count, rest) \
  FIELD_##NAME, FIELD_##NAME##_LAST = FIELD_##NAME + (count)-1,
enum {
  FLOAT_FIELDS(FIELD_ONE, FIELD_MANY)  //
  // Mass as an int [kMassQuantum].
  FIELD_MASS,
  // Soil and side as one int, soil | side << 16. side: 0 if no shell is near, else 1 + 2 * tool
  // index, plus 1 if behind the shell.
  FIELD_TAG,
  // Particle ID as an int, unique in a run.
  FIELD_ID,
  // Number of words of a particle.
  FIELD_COUNT
};
#undef FIELD_ONE
#undef FIELD_MANY

#endif  // NAVVY_KERNELS_SOIL_PARTICLE_FIELDS_H
