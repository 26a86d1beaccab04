// SPDX-License-Identifier: Apache-2.0
// Mean opening J / J0 of the soil in each cell, for sixteen particles at a time.
#ifndef NAVVY_KERNELS_SOIL_LANES_OPENING_H
#define NAVVY_KERNELS_SOIL_LANES_OPENING_H

#include "soil/lanes/lanes.h"
#include "soil/point.h"

// Number of cells in a block that can contain a base node: -1 .. 4 along each axis, x fastest.
#define CELLS 216
// Returns the cells of the base nodes of 16 particles (x fastest, 0 .. CELLS - 1), from the
// positions relative to the corner of their block [cells].
static inline int16 cell_of(real x, real y, real z) {
  return convert_int16(base_node(x)) + 1 + 6 * (convert_int16(base_node(y)) + 1) +
         36 * (convert_int16(base_node(z)) + 1);
}

// Sums over the particles in slots start .. end - 1, cell by cell, into `openings`: one float4 per
// cell with volume, volume in the density state (both in mass quanta), number of open particles (J
// > J0), and 0. Returns false and leaves `openings` undefined if no particle is open.
INLINED bool cell_openings(global const float* state, int capacity, int start, int end,
                           float* openings) {
  // Most blocks have no open particle. This test reads two fields; the sums read six.
  bool open = false;
  for (int slot = start; slot < end && !open; slot += 16)
    open = some(LOAD(FIELD_J) > LOAD(FIELD_J0));
  if (!open) return false;
  for (int i = 0; i < CELLS / 4; ++i) vstore16((float16)(0.0f), i, openings);
  // Particles are sorted by cell, so the sum of a cell stays in a register until the cell changes.
  // Particles that have drifted since the last re-bin cost a load and a store.
  int cell = 0;
  float4 sum = 0.0f;
  for (int slot = start; slot < end; slot += 16) {
    int cells[16];
    float parts[64];
    // Masses in quanta, as stored: openings are ratios of sums.
    const real mass = convert_float16(as_int16(LOAD(FIELD_MASS))), zero = 0.0f;
    vstore16(cell_of(LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2)), 0, cells);
    const real volume = mass * LOAD(FIELD_J), bank = mass * LOAD(FIELD_J0);
    const real opened = volume > bank ? (real)(1.0f) : zero;
    TURN(parts, volume, bank, opened, zero);
    for (int l = 0; l < min(16, end - slot); ++l) {
      if (cells[l] != cell) {
        vstore4(sum, cell, openings);
        cell = cells[l];
        sum = vload4(cell, openings);
      }
      sum += vload4(turned(l), parts);
    }
  }
  vstore4(sum, cell, openings);
  return true;
}

// Returns the mean J / J0 of the cells in which 16 particles are; 0 for a cell without open
// particles. openings: from cell_openings; cell: from cell_of.
INLINED real opening_of(const float* openings, int16 cell) {
  int cells[16];
  float parts[64];
  vstore16(cell, 0, cells);
  // Gathers the float4s of 16 cells and transposes them into lanes.
  for (int l = 0; l < 16; ++l) vstore4(vload4(cells[l], openings), turned(l), parts);
  real volume, bank, opened, unused;
  UNTURN(parts, volume, bank, opened, unused);
  return mean_opening(volume, bank, opened);
}

#endif  // NAVVY_KERNELS_SOIL_LANES_OPENING_H
