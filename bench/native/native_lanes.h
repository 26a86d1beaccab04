// SPDX-License-Identifier: Apache-2.0
// Sixteen floats at a time through the compiler's vectors, and the soil law compiled for them.
#pragma once

#include <cmath>
#include <cstddef>

namespace navvy::bench {

using Lanes = float __attribute__((vector_size(64)));
using Four = float __attribute__((vector_size(16)));

inline Lanes load(const float* at) { return *reinterpret_cast<const Lanes*>(at); }
inline void store(const Lanes& value, float* at) { *reinterpret_cast<Lanes*>(at) = value; }
inline Lanes least(const Lanes& a, const Lanes& b) { return a < b ? a : b; }
inline Lanes largest(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
inline Lanes root(const Lanes& a) {
  Lanes out;
  for (int l = 0; l < 16; ++l) out[l] = std::sqrt(a[l]);
  return out;
}

#define LAW_T Lanes
#define LAW_LIT(x) (static_cast<float>(x))
#define LAW_MIN(a, b) least(a, Lanes{} + (b))
#define LAW_MAX(a, b) largest(a, Lanes{} + (b))
#define LAW_SQRT(a) root(a)
#define LAW_STEP(edge, x) ((x) < (Lanes{} + (edge)) ? Lanes{} : Lanes{} + 1.0f)
#define LAW_FN inline
#include "soil/law.h"  // NOLINT: on purpose inside the namespace
#undef LAW_T
#undef LAW_LIT
#undef LAW_MIN
#undef LAW_MAX
#undef LAW_SQRT
#undef LAW_STEP
#undef LAW_FN

/// Base node and quadratic weights of sixteen particles; offsets in cells from their home's corner.
struct Weights {
  Weights(const float* x, const float* y, const float* z) {
    const float* at[3] = {x, y, z};
    for (int a = 0; a < 3; ++a) {
      for (int l = 0; l < 16; ++l) base[a][l] = static_cast<int>(std::floor(at[a][l] - 0.5f));
      for (int l = 0; l < 16; ++l) f[a][l] = at[a][l] - static_cast<float>(base[a][l]);
      const Lanes p = 1.5f - f[a], q = f[a] - 1.0f, r = f[a] - 0.5f;
      store(0.5f * p * p, w[a][0]);
      store(0.75f - q * q, w[a][1]);
      store(0.5f * r * r, w[a][2]);
    }
  }
  Lanes f[3];  ///< offset from the base node
  int base[3][16];
  alignas(64) float w[3][3][16];
};

/// Cell of the base node among the 6^3 of a home that may have drifted by one cell.
inline std::size_t cell_of(float x, float y, float z) {
  const auto i = [](float v) { return static_cast<std::size_t>(static_cast<int>(std::floor(v - 0.5f)) + 1); };
  return i(x) + 6 * i(y) + 36 * i(z);
}

/// Rows a, b, c, d of sixteen to sixteen of four, and back.
inline void turn(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& d, Four* out) {
  for (int l = 0; l < 16; ++l) out[l] = Four{a[l], b[l], c[l], d[l]};
}
inline void unturn(const Four* in, Lanes* out) {
  for (int k = 0; k < 4; ++k)
    for (int l = 0; l < 16; ++l) out[k][l] = in[l][k];
}

}  // namespace navvy::bench
