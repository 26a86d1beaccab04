// SPDX-License-Identifier: Apache-2.0
// The kernel dialect of kernels/README.md in double precision: the types and built-in functions
// with which kernels/soil headers compile on the host as the double-precision twin.
#pragma once

#include <cmath>

#include "core/math.h"
#include "soil/layout.h"
#include "soil/tool.h"

namespace navvy::soil::reference {

// Types of the dialect: values of a particle, uniform values, vectors, and integers or conditions.
using real = double;
using scalar = double;
using scalar3 = Vec3;
using ints = int;
/// Values for the columns around a node: one number, because the twin's ground is level around a
/// node.
using columns = double;
#define INLINED inline

// Built-in functions of OpenCL for one double.
using std::fabs;
using std::floor;
using std::fmax;
using std::fmin;
using std::isfinite;
using std::sqrt;
/// Returns the smaller of two values, and `b` if either is NaN, like the dialect's function.
inline double smaller(double a, double b) { return a < b ? a : b; }
/// Returns the larger of two values, and `b` if either is NaN, like the dialect's function.
inline double larger(double a, double b) { return a > b ? a : b; }
/// Returns the largest whole number that is not above x.
inline double floored(double x) { return floor(x); }
/// Returns x limited to low .. high, like the OpenCL built-in.
inline double clamp(double x, double low, double high) { return fmin(fmax(x, low), high); }
/// Returns 0 if x < edge, else 1, like the OpenCL built-in.
inline double step(double edge, double x) { return x < edge ? 0.0 : 1.0; }
/// Returns the mean over the columns around a node. The twin has one column, so the result is that
/// column's value.
inline double mean_of(columns t) { return t; }
/// Returns true if the condition holds for all columns around a node. The twin has one column.
inline bool all(bool of_columns) { return of_columns; }
/// Returns the scalar product, like the OpenCL built-in.
inline double dot(const Vec3& a, const Vec3& b) { return a.dot(b); }
/// Returns the vector product, like the OpenCL built-in.
inline Vec3 cross(const Vec3& a, const Vec3& b) { return a.cross(b); }

}  // namespace navvy::soil::reference
