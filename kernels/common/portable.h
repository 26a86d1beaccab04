// SPDX-License-Identifier: Apache-2.0
// Included first by every kernel: the same float arithmetic on every device.
//
// Contraction (a * b + c as one rounding) is the compiler's choice unless switched off; with it two
// devices, or two versions of one driver, disagree in the last bit. Use fma() where the single
// rounding is wanted.
#ifndef NAVVY_COMMON_PORTABLE_H
#define NAVVY_COMMON_PORTABLE_H

#pragma OPENCL FP_CONTRACT OFF

#endif
