// SPDX-License-Identifier: Apache-2.0
#include "bench/cost_model.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"

namespace navvy::bench {
namespace {

constexpr int kParts = 4;

/// Solves the least squares with the parts whose bit in `chosen` is set; the others are 0. Returns
/// the sum of squares, infinity if a part is negative.
double solve(const Eigen::MatrixXd& all, const Eigen::VectorXd& ones, int chosen,
             Eigen::Vector4d& out) {
  std::vector<int> parts;
  for (int part = 0; part < kParts; ++part)
    if ((chosen >> part & 1) != 0) parts.push_back(part);
  const Eigen::MatrixXd some = all(Eigen::all, parts);
  const Eigen::VectorXd found = some.colPivHouseholderQr().solve(ones);
  out.setZero();
  for (std::size_t i = 0; i < parts.size(); ++i)
    out[parts[i]] = found[static_cast<Eigen::Index>(i)];
  // Written so that NaN is refused, too.
  if (!(out.minCoeff() >= 0)) return std::numeric_limits<double>::infinity();
  return (some * found - ones).squaredNorm();
}

}  // namespace

double measured_step_seconds(const Row& row) {
  return row.timing.processor / static_cast<double>(row.steps);
}

// Relative errors: otherwise the largest row alone would decide.
CostModel fit_cost(const std::vector<Row>& rows) {
  std::vector<Row> used;
  for (const Row& row : rows)
    if (row.timing.processor > 0 && row.active_blocks > 0 && row.steps > 0) used.push_back(row);
  if (used.size() < kParts)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--model",
                           std::to_string(used.size()) + " rows",
                           "the cost of a step is fitted to at least 4 rows with particles",
                           "measure more cases: without a name all of them run"});
  const auto count = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd all(count, kParts);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Row& row = used[static_cast<std::size_t>(i)];
    all.row(i) << 1, row.active_blocks, static_cast<double>(row.particles), row.contact_nodes;
    all.row(i) /= measured_step_seconds(row);
  }
  // Four parts have fifteen subsets, so the best without a negative part is found by trying.
  Eigen::Vector4d best = Eigen::Vector4d::Zero(), each;
  double least = std::numeric_limits<double>::infinity();
  for (int chosen = 1; chosen < 1 << kParts; ++chosen) {
    const double sum = solve(all, Eigen::VectorXd::Ones(count), chosen, each);
    if (sum < least) {
      least = sum;
      best = each;
    }
  }
  CostModel out{best[0], best[1], best[2], best[3]};
  for (const Row& row : used)
    out.worst =
        std::max(out.worst, std::abs(out.step_seconds(row) / measured_step_seconds(row) - 1));
  return out;
}

double wall_share(const std::vector<Row>& rows, double least, double most) {
  std::vector<double> shares;
  for (const Row& row : rows) {
    const auto particles = static_cast<double>(row.particles);
    if (row.timing.processor > 0 && particles >= least && particles < most)
      shares.push_back(row.timing.best / row.timing.processor);
  }
  if (shares.empty()) return 1;
  std::sort(shares.begin(), shares.end());
  return shares[shares.size() / 2];
}

}  // namespace navvy::bench
