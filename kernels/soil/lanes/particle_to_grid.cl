// SPDX-License-Identifier: Apache-2.0
// Stress update of each particle, then scatter of mass and momentum to its block's tile.
//
// In:  state (SoA words, layout.h), soils (SOIL_WORDS floats each), home blocks: start and count in slots, tile = first
//      tile of the block, near = 1 when it has three tiles (0 neutral, 1 front, 2 back of a shell).
// Out: used = bits of the tiles written, one int per home; tiles, float4 (p_x, p_y, p_z [kg m/s], m [kg]) of the nodes
//      -1..6 around the block; stress, J, J0 and plastic shear of the particles; REPORT_BAD.
// One work-item per home block; particles in stored order, so sums repeat bit for bit.
// Host: src/soil/particles/transfer.cpp. Reference: src/soil/reference/reference_solver.cpp.
#include "soil/lanes/lanes.h"
#include "soil/law.h"
#include "soil/opening.h"

#ifdef LAW_EXTENDED
#define LAW_WORDS SOIL_EXTENDED_WORDS
#else
#define LAW_WORDS SOIL_LAW_WORDS
#endif

static inline void load_soil(constant float* soils, int16 tag, int count, LawSoil* soil, real* inv_density) {
  float lanes[LAW_WORDS][16];
  const int first = tag.s0 & 0xffff;
  int kinds[16];
  vstore16(tag & 0xffff, 0, kinds);
  int mixed = 0;
  for (int l = 1; l < count; ++l) mixed |= kinds[l] ^ first;
  real value[LAW_WORDS];
  if (mixed == 0) {
    for (int k = 0; k < LAW_WORDS; ++k) value[k] = soils[first * SOIL_WORDS + k];
  } else {
    for (int l = 0; l < 16; ++l)
      for (int k = 0; k < LAW_WORDS; ++k) lanes[k][l] = soils[kinds[l] * SOIL_WORDS + k];
    for (int k = 0; k < LAW_WORDS; ++k) value[k] = vload16(0, lanes[k]);
  }
  soil->bulk = value[SOIL_BULK];
  soil->shear = value[SOIL_SHEAR];
  soil->alpha = value[SOIL_ALPHA];
  soil->k_residual = value[SOIL_K_RESIDUAL];
  soil->k_bond = value[SOIL_K_BOND];
  soil->inv_remould = value[SOIL_INV_REMOULD];
  soil->inv_opening = value[SOIL_INV_OPENING];
  soil->viscosity = value[SOIL_VISCOSITY];
  soil->swell = value[SOIL_SWELL];
  soil->loosening = value[SOIL_LOOSENING];
#ifdef LAW_EXTENDED
  soil->dilatancy = value[SOIL_DILATANCY];
  soil->inv_range = value[SOIL_INV_RANGE];
  soil->matched = value[SOIL_MATCHED];
  soil->alpha_fast = value[SOIL_ALPHA_FAST];
  soil->grain = value[SOIL_GRAIN];
  soil->inertial = value[SOIL_INERTIAL];
  soil->cap = value[SOIL_CAP];
  soil->cap_growth = value[SOIL_CAP_GROWTH];
#endif
  *inv_density = value[SOIL_INV_DENSITY];
}

INLINED void flush(global float* tile, int node, const Rows* sums) {
  UNROLL
  for (int k = 0; k < 3; ++k)
    UNROLL
    for (int j = 0; j < 3; ++j) {
      global float* at = tile + 4 * (node + 8 * j + 64 * k);
      vstore16(vload16(0, at) + sums->row[3 * k + j], 0, at);
    }
}

// Adds one particle's shares; its turned components are momentum at the base node and mass, then the change of momentum
// per node in x, y, z.
INLINED void scatter(Rows* sums, float4 start, float4 ax, float4 ay, float4 az, float4 wx, const float* wyz) {
  const float16 w = (float16)(wx.xxxx, wx.yyyy, wx.zzzz, (float4)(0.0f));
  const float4 next = start + ax;
  const float16 rx = w * (float16)(start, next, next + ax, (float4)(0.0f));
  const float16 ry = w * (float16)(ay, ay, ay, (float4)(0.0f));
  const float16 rz = w * (float16)(az, az, az, (float4)(0.0f));
  UNROLL
  for (int k = 0; k < 3; ++k) {
    float16 row = rx + (float)k * rz;
    UNROLL
    for (int j = 0; j < 3; ++j) {
      sums->row[3 * k + j] = fma((float16)(wyz[16 * (3 * k + j)]), row, sums->row[3 * k + j]);
      row += ry;
    }
  }
}

// Which of a home's tiles its particles need: bit 0 always, bits 1 and 2 where particles have a side.
static inline int tiles_used(global const float* state, int capacity, int start, int end) {
  int16 sides = 0;
  for (int at = start; at < end; at += 16) {
    const int16 side = as_int16(LOAD(FIELD_TAG)) >> 16;
    sides |= side > 0 ? 4 - 2 * (side & 1) : 0;
  }
  return 1 | (some(sides & 2) ? 2 : 0) | (some(sides & 4) ? 4 : 0);
}

__attribute__((reqd_work_group_size(1, 1, 1))) kernel void particle_to_grid(
    global float* restrict state, const int capacity, constant float* soils, global const int4* restrict homes,
    global float* restrict tiles, global int* restrict used, global float* restrict report, const float dt,
    const float dx, const float mixing) {
  const int block = get_global_id(0);
  const int4 home = homes[block];  // start, count, first tile, near
  global float* tile = tiles + (size_t)home.z * (4 * TILE_NODES);
  const int mask = home.w ? tiles_used(state, capacity, home.x, home.x + home.y) : 1;
  used[block] = mask;
  for (int t = 0; mask >> t; ++t) {
    if (!(mask >> t & 1)) continue;
    for (int i = 0; i < TILE_NODES / 4; ++i) vstore16((float16)(0.0f), i, tile + 4 * TILE_NODES * t);
  }

  float openings[4 * CELLS];
  const bool open = cell_openings(state, capacity, home.x, home.x + home.y, openings);
  float wxs[4 * 16], wyz[9 * 16], turned_parts[4][64];
  int nodes[16];
  Rows sums;
  int cell = -1;
  int broken = 0;
  for (int at = home.x; at < home.x + home.y; at += 16) {
    const int count = min(16, home.x + home.y - at);
    UNROLL
    for (int f = 0; f < FIELD_ID; ++f) SOON(f);
    int16 tag = as_int16(LOAD(FIELD_TAG));
    if (!home.w) {  // far from every shell nobody has a side
      tag &= 0xffff;
      STORE(FIELD_TAG, as_float16(tag));
    }
    LawSoil soil;
    real inv_density;
    load_soil(soils, tag, count, &soil, &inv_density);

    // Law.
    real c[9], s[6], sigma[6];
    for (int k = 0; k < 9; ++k) c[k] = LOAD(FIELD_C + k);
    for (int k = 0; k < 6; ++k) s[k] = LOAD(FIELD_S + k);
    real j = LOAD(FIELD_J), j0 = LOAD(FIELD_J0), shear = LOAD(FIELD_SHEAR);
    const int16 lost = !isfinite(j);  // the law's floor would hide it
    const real x = LOAD(FIELD_X), y = LOAD(FIELD_X + 1), z = LOAD(FIELD_X + 2);
    if (open) {
      const real opening = opening_of(openings, cell_of(x, y, z));
      j = opening > 0.0f ? j + mixing * (j0 * opening - j) : j;
    }
    law_update(c, dt, &soil, s, &j, &j0, &shear, sigma);
    j = select(j, (real)(NAN), lost);
    for (int k = 0; k < 6; ++k) STORE(FIELD_S + k, s[k]);
    STORE(FIELD_J, j);
    STORE(FIELD_J0, j0);
    STORE(FIELD_SHEAR, shear);

    // Weights and the affine momentum field A = (m C dx - dt 4/dx V sigma) per node step.
    const real vx = LOAD(FIELD_V), vy = LOAD(FIELD_V + 1), vz = LOAD(FIELD_V + 2);
    const real bx = base_node(x), by = base_node(y), bz = base_node(z);
    const real fx = x - bx, fy = y - by, fz = z - bz;
    const real mass = convert_float16(as_int16(LOAD(FIELD_MASS))) * MASS_QUANTUM;
    const real cm = mass * dx, sv = (4.0f * dt / dx) * (mass * inv_density) * j;
    const real axx = cm * c[0] - sv * sigma[0], axy = cm * c[1] - sv * sigma[3], axz = cm * c[2] - sv * sigma[5];
    const real ayx = cm * c[3] - sv * sigma[3], ayy = cm * c[4] - sv * sigma[1], ayz = cm * c[5] - sv * sigma[4];
    const real azx = cm * c[6] - sv * sigma[5], azy = cm * c[7] - sv * sigma[4], azz = cm * c[8] - sv * sigma[2];
    const real px = mass * vx - (axx * fx + axy * fy + axz * fz);
    const real py = mass * vy - (ayx * fx + ayy * fy + ayz * fz);
    const real pz = mass * vz - (azx * fx + azy * fy + azz * fz);

    // A sum is finite only if each term is; lanes past the count hold zeros.
    const real sum = (x + y + z) + (px + py + pz) + (axx + ayy + azz) + (j + j0 + shear) + (s[3] + s[4] + s[5]);
    broken |= some(!isfinite(sum));

    real w0, w1, w2, wy[3], wz[3];
    spline(fy, &wy[0], &wy[1], &wy[2]);
    spline(fz, &wz[0], &wz[1], &wz[2]);
    UNROLL
    for (int i = 0; i < 9; ++i) vstore16(wz[i / 3] * wy[i % 3], i, wyz);
    spline(fx, &w0, &w1, &w2);
    const real zero = 0.0f;
    TURN(wxs, w0, w1, w2, zero);
    TURN(turned_parts[0], px, py, pz, mass);
    TURN(turned_parts[1], axx, ayx, azx, zero);
    TURN(turned_parts[2], axy, ayy, azy, zero);
    TURN(turned_parts[3], axz, ayz, azz, zero);
    // Which tile: neutral, front or back (side = 1 + 2 tool + behind).
    const int16 side = tag >> 16;
    const int16 which = side > 0 ? 2 - (side & 1) : 0;
    vstore16(convert_int16(bx) + 1 + 8 * (convert_int16(by) + 1) + 64 * (convert_int16(bz) + 1) + which * TILE_NODES, 0,
             nodes);
    for (int l = 0; l < count; ++l) {
      const int t = turned(l);
      if (nodes[l] != cell) {
        if (cell >= 0) flush(tile, cell, &sums);
        UNROLL
        for (int i = 0; i < 9; ++i) sums.row[i] = 0.0f;
        cell = nodes[l];
      }
      scatter(&sums, vload4(t, turned_parts[0]), vload4(t, turned_parts[1]), vload4(t, turned_parts[2]),
              vload4(t, turned_parts[3]), vload4(t, wxs), wyz + l);
    }
  }
  if (cell >= 0) flush(tile, cell, &sums);
  report[REPORT_WORDS * block + REPORT_BAD] = broken ? 1.0f : 0.0f;
  if (!home.w) report[REPORT_WORDS * block + REPORT_PUSH] = report[REPORT_WORDS * block + REPORT_CROSSED] = 0.0f;
}
