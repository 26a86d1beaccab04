// SPDX-License-Identifier: Apache-2.0
// Errors of the use of a world from Python, beside those of the simulation (core/error.h).
#pragma once

#include "core/error.h"

namespace navvy::python {

/// Exception for a call while another thread is inside the same world.
class BusyError : public Error {
 public:
  using Error::Error;
};

/// Exception for a call on a world that was closed.
class ClosedError : public Error {
 public:
  using Error::Error;
};

}  // namespace navvy::python
