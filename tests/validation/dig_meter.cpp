// SPDX-License-Identifier: Apache-2.0
#include "validation/dig_meter.h"

#include <algorithm>
#include <numeric>

namespace navvy::validation {
namespace {

/// Steps between two measurements of the payload, each of which costs a pass over all particles.
constexpr int kEvery = 25;

}  // namespace

DigMeter::DigMeter(const session::Session& session)
    : session_(session),
      bucket_(session.world().description().machines.at(0).machine.buckets.at(0)),
      gauge_(session.world().machines().at(0), bucket_),
      link_(session.world().machines().at(0).link(bucket_.link)) {}

void DigMeter::look() {
  const std::string phase = session_.phase(0);
  const double dt = session_.world().time() - time_;
  time_ += dt;
  const bool cuts = phase == "penetrate" || phase == "drag" || phase == "curl";
  const bool lifts = phase == "lift" || phase == "swing" || phase == "dump";
  if (phase == "lift" && last_ == "curl") {
    fullest_.push_back(most_);
    most_ = 0;
  }
  last_ = phase;
  if (!cuts && !lifts) return;
  if (start_work_ < 0) start_work_ = session_.world().machines().at(0).work();
  const vehicle::LinkState link = link_.state();
  const sim::ToolHandle& tool = gauge_.tool();
  const double power = -tool.force().dot(link.v_WL) - tool.moment().dot(link.w_WL);
  (cuts ? cutting_ : lifting_) += power * dt;
  if (!cuts) return;
  if (steps_++ % kEvery == 0) most_ = std::max(most_, tool.payload());
  const Vec3 edge = link.v_WL + link.w_WL.cross(link.X_WL.linear() * bucket_.p_tip);
  draft_work_ += gauge_.load().draft * edge.norm() * dt;
  edge_work_ -= tool.edge_force().dot(edge) * dt;
  edge_peak_ = std::max(edge_peak_, tool.edge_force().norm());
}

double DigMeter::lost() const {
  const std::vector<session::Cycle>& cycles = session_.cycles();
  const std::size_t count = std::min(cycles.size(), fullest_.size());
  double kept = 0;
  for (std::size_t i = 0; i < count; ++i) kept += cycles[i].payload_lift_out;
  const double most =
      std::accumulate(fullest_.begin(), fullest_.begin() + static_cast<std::ptrdiff_t>(count), 0.0);
  return most > 0 ? 1 - kept / most : 0;
}

double DigMeter::work() const {
  return start_work_ < 0 ? 0 : session_.world().machines().at(0).work() - start_work_;
}

}  // namespace navvy::validation
