// SPDX-License-Identifier: Apache-2.0
// The dialect of kernels/README.md in doubles: what law, particle and node arithmetic of
// kernels/soil need to compile as the double twin.
#pragma once

#include <cmath>

#include "core/math.h"
#include "soil/layout.h"
#include "soil/tool.h"

namespace navvy::soil::reference {

// Types of the dialect.
using real = double;
using scalar = double;
using scalar3 = Vec3;
using ints = int;
// The twin's ground is level around a node.
using columns = double;
#define INLINED inline

// Built-ins of OpenCL for one double.
using std::fabs;
using std::floor;
using std::fmax;
using std::fmin;
using std::isfinite;
using std::sqrt;
inline double clamp(double x, double low, double high) { return fmin(fmax(x, low), high); }
inline double step(double edge, double x) { return x < edge ? 0.0 : 1.0; }
// The twin has one column around a node, so the mean is the column itself.
inline double mean_of(columns t) { return t; }
inline bool all(bool of_columns) { return of_columns; }
inline double dot(const Vec3& a, const Vec3& b) { return a.dot(b); }
inline Vec3 cross(const Vec3& a, const Vec3& b) { return a.cross(b); }

}  // namespace navvy::soil::reference
