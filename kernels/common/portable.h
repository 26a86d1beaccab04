// SPDX-License-Identifier: Apache-2.0
// Makes float arithmetic the same on every device. Every kernel includes this file first.
//
// Contraction (a * b + c with one rounding) is the compiler's choice unless it is switched off.
// With contraction, two devices or two versions of one driver would differ in the last bit. Kernels
// call fma() where they need a single rounding.
#ifndef NAVVY_COMMON_PORTABLE_H
#define NAVVY_COMMON_PORTABLE_H

#pragma OPENCL FP_CONTRACT OFF

#endif
