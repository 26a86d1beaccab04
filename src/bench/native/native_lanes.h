// SPDX-License-Identifier: Apache-2.0
// Sixteen floats at a time in compiler vectors, and the arithmetic of kernels/soil compiled for
// them in the dialect of kernels/README.md.
#pragma once

#include <cmath>
#include <cstddef>

#include "soil/layout.h"

namespace navvy::bench {

using Lanes = float __attribute__((vector_size(64)));
using Four = float __attribute__((vector_size(16)));

inline Lanes load(const float* at) { return *reinterpret_cast<const Lanes*>(at); }
inline void store(const Lanes& value, float* at) { *reinterpret_cast<Lanes*>(at) = value; }

using real = Lanes;
using ints = int __attribute__((vector_size(64)));
using scalar = float;
/// The ground is level around a node.
using columns = float;
#define INLINED inline

inline Lanes fmin(const Lanes& a, const Lanes& b) { return a < b ? a : b; }
inline Lanes fmax(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
inline Lanes fmin(const Lanes& a, float b) { return fmin(a, Lanes{} + b); }
inline Lanes fmax(const Lanes& a, float b) { return fmax(a, Lanes{} + b); }
inline float fmax(float a, float b) { return a > b ? a : b; }
inline Lanes smaller(const Lanes& a, const Lanes& b) { return a < b ? a : b; }
inline Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
inline Lanes smaller(const Lanes& a, float b) { return smaller(a, Lanes{} + b); }
inline Lanes larger(const Lanes& a, float b) { return larger(a, Lanes{} + b); }
inline float smaller(float a, float b) { return a < b ? a : b; }
inline float larger(float a, float b) { return a > b ? a : b; }
inline Lanes fabs(const Lanes& a) { return fmax(a, -a); }
inline Lanes sqrt(const Lanes& a) {
  Lanes out;
  for (int l = 0; l < 16; ++l) out[l] = std::sqrt(a[l]);
  return out;
}
inline Lanes floor(const Lanes& a) {
  Lanes out;
  for (int l = 0; l < 16; ++l) out[l] = std::floor(a[l]);
  return out;
}
inline float largest(const Lanes& of) {
  float out = of[0];
  for (int l = 1; l < 16; ++l) out = fmax(out, of[l]);
  return out;
}
inline Lanes step(float edge, const Lanes& x) {
  return x < Lanes{} + edge ? Lanes{} : Lanes{} + 1.0f;
}
inline ints isfinite(const Lanes& a) {
  return a - a == Lanes{};  // NOLINT(misc-redundant-expression): not so for infinity and NaN
}
inline float clamp(float x, float low, float high) { return x < low ? low : x > high ? high : x; }
inline float mean_of(columns t) { return t; }
inline bool all(bool of_columns) { return of_columns; }
inline Lanes floored(const Lanes& a) { return floor(a); }

#include "soil/node.h"   // NOLINT: on purpose inside the namespace
#include "soil/point.h"  // NOLINT: the same

/// Base node and quadratic weights of sixteen particles; offsets in cells from the corner of their
/// block.
struct Weights {
  Weights(const float* x, const float* y, const float* z) {
    const float* at[3] = {x, y, z};
    for (int a = 0; a < 3; ++a) {
      for (int l = 0; l < 16; ++l) base[a][l] = static_cast<int>(std::floor(at[a][l] - 0.5f));
      for (int l = 0; l < 16; ++l) f[a][l] = at[a][l] - static_cast<float>(base[a][l]);
      Lanes weight[3];
      spline(f[a], weight);
      for (int i = 0; i < 3; ++i) store(weight[i], w[a][i]);
    }
  }
  /// Offset from the base node.
  Lanes f[3];
  int base[3][16];
  alignas(64) float w[3][3][16];
};

/// Returns the cell of the base node among the 6^3 of a block whose particles may have drifted by
/// one cell.
inline std::size_t cell_of(float x, float y, float z) {
  const auto i = [](float v) {
    return static_cast<std::size_t>(static_cast<int>(std::floor(v - 0.5f)) + 1);
  };
  return i(x) + 6 * i(y) + 36 * i(z);
}

/// Transposes rows a, b, c, d of sixteen to sixteen of four, and back.
inline void turn(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& d, Four* out) {
  for (int l = 0; l < 16; ++l) out[l] = Four{a[l], b[l], c[l], d[l]};
}
inline void unturn(const Four* in, Lanes* out) {
  for (int k = 0; k < 4; ++k)
    for (int l = 0; l < 16; ++l) out[k][l] = in[l][k];
}

}  // namespace navvy::bench
