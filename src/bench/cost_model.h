// SPDX-License-Identifier: Apache-2.0
// Cost of a soil step as a sum of four parts, fitted to measured rows.
#pragma once

#include <vector>

#include "bench/row.h"

namespace navvy::bench {

/// Processor time of a soil step: a fixed part, and parts proportional to the active blocks, the
/// particles and the nodes near tools. No part is negative.
struct CostModel {
  /// Cost of a step, of an active block, of a particle and of a contact node in a step [s].
  double step = 0, block = 0, particle = 0, node = 0;
  /// Largest relative error of the model among the rows that it was fitted to.
  double worst = 0;

  /// Returns the processor time of a step [s].
  double step_seconds(double blocks, double particles, double nodes) const {
    return step + block * blocks + particle * particles + node * nodes;
  }
  /// Returns the processor time of a step with the particles, blocks and nodes of a row [s].
  double step_seconds(const Row& row) const {
    return step_seconds(row.active_blocks, static_cast<double>(row.particles), row.contact_nodes);
  }
};

/// Returns the measured processor time of a step of a row [s].
double measured_step_seconds(const Row& row);

/// Returns the model with the least sum of squared relative errors over `rows`. Rows without
/// processor time or active blocks are left out. Parts that the rows cannot separate are 0.
/// @throws InputError if fewer than four rows are left.
CostModel fit_cost(const std::vector<Row>& rows);

/// Returns wall time over processor time, the median over those of `rows` that have at least
/// `least` and fewer than `most` particles; 1 if there are none.
double wall_share(const std::vector<Row>& rows, double least, double most);

}  // namespace navvy::bench
