// SPDX-License-Identifier: Apache-2.0
// Child processes made by fork(): OpenCL drivers have no threads there, so that their calls never
// return.
#pragma once

namespace navvy::device {

/// Notes that OpenCL has started in this process. From then on, a child made by fork() without
/// exec() knows that it must not call OpenCL.
void opencl_has_started();
/// Returns true in a child process that was forked after OpenCL had started.
bool forked_after_start();
/// Checks that this process may call OpenCL.
/// @throws DeviceError in a child process that was forked after OpenCL had started
void require_no_fork();

}  // namespace navvy::device
