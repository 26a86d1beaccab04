// SPDX-License-Identifier: Apache-2.0
// Relation of steps to time: the base step, and the steps at which something is sampled at a rate.
#pragma once

#include <cstdint>

namespace navvy::sim {

/// Returns the base step [s], at most `longest`, such that a whole number of steps makes up
/// `period` [s]: period / ceil(period / longest). Without a period (0) it is `longest`.
double base_step(double longest, double period);

/// Returns the number of samples of `rate` [1/s, above 0] up to and including step `step` of `dt`
/// [s]. Sample n belongs to the step nearest to time n / rate, sample 0 to step 0; one step may
/// take several samples.
///
/// It depends on the step's number alone: nothing is summed, so nothing drifts, and a resumed run
/// samples the same steps. The error is at most half a step at any time.
std::uint64_t samples_through(std::uint64_t step, double dt, double rate);

/// Returns whether a sample belongs to this step.
bool sample_due(std::uint64_t step, double dt, double rate);
/// Returns the number of the first sample that belongs to `step`, or to a later step if none does.
std::uint64_t sample_number(std::uint64_t step, double dt, double rate);

}  // namespace navvy::sim
