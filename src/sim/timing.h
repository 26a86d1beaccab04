// SPDX-License-Identifier: Apache-2.0
// Which step belongs to which time: the base step, and the steps at which something is sampled at a
// rate.
#pragma once

#include <cstdint>

namespace navvy::sim {

/// Length of the base step [s] when it may be at most `longest` and a whole number of steps shall
/// make up `period` [s]: period / ceil(period / longest). `longest` itself without a period (0).
double base_step(double longest, double period);

/// How many samples of `rate` [1/s, above 0] fall on step `step` of `dt` [s] or before it. Sample n
/// belongs to the step nearest to time n / rate, sample 0 to step 0; a step that is nearest to
/// several takes all of them.
///
/// A function of the step's number alone: nothing is summed up, so nothing drifts, and a resumed
/// run samples the same steps. Off by half a step at most, at any time.
std::uint64_t samples_through(std::uint64_t step, double dt, double rate);

/// Whether a sample belongs to this very step.
bool sample_due(std::uint64_t step, double dt, double rate);
/// Number of the first sample that belongs to `step`, or that comes after it when none does.
std::uint64_t sample_number(std::uint64_t step, double dt, double rate);

}  // namespace navvy::sim
