// SPDX-License-Identifier: Apache-2.0
// Base step of a world, and the steps in which something is sampled at a given rate.
#pragma once

#include <cstdint>

namespace navvy::sim {

/// Returns the length of the base step [s]: the longest step of at most `longest` [s] of which a
/// whole number makes up `period` [s], that is period / ceil(period / longest). Returns `longest`
/// if `period` is 0.
double base_step(double longest, double period);

/// Returns the number of samples taken from the start up to and including step number `step`, at
/// `rate` samples per second (above 0) and with steps of `dt` [s]. Sample number n is taken in the
/// step nearest to the time n / rate, and sample 0 in step 0. A step takes several samples if the
/// rate is higher than the step rate.
///
/// The result depends only on the step number, not on a running sum, so sample times do not drift,
/// and a resumed run samples in the same steps. A sample is always within half a step of its ideal
/// time.
std::uint64_t samples_through(std::uint64_t step, double dt, double rate);

/// Returns true if at least one sample is taken in step number `step`, that is if
/// samples_through(step) exceeds the number of samples through the step before. `rate` is the
/// number of samples per second (above 0), `dt` the length of a step [s].
bool sample_due(std::uint64_t step, double dt, double rate);
/// Returns the number of the first sample, counted from 0, that is taken in step number `step` or,
/// if that step takes none, in a later one. `dt` is the length of a step [s], `rate` is in samples
/// per second (above 0).
std::uint64_t sample_number(std::uint64_t step, double dt, double rate);

}  // namespace navvy::sim
