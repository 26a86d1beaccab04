// SPDX-License-Identifier: Apache-2.0
#include "lab/tool_driver.h"

#include <cmath>

namespace navvy::lab {

ToolDriver::ToolDriver(Site& site, const scene::Shell& shell, const Pose& X_WT)
    : site_(&site), tool_(site.add_tool(shell, X_WT)) {}

const Pose& ToolDriver::pose() const { return site_->tool(tool_).motion.X_WT; }

void ToolDriver::set_twist(const Vec3& v_W, const Vec3& w_W) {
  site_->tool(tool_).motion.v_WT = v_W;
  site_->tool(tool_).motion.w_WT = w_W;
  // Shells of one rig share one frame.
  for (const int other : carried_)
    site_->tool(other).motion.v_WT = v_W, site_->tool(other).motion.w_WT = w_W;
}

void ToolDriver::step(double dt) {
  const Vec3 before = pose().translation();
  // Every tool of the site moves; this driver records its own.
  site_->step(dt);
  const soil::ToolImpulse& impulse = site_->tool(tool_).impulse;
  // Length of the path of the frame's origin, in any direction.
  travelled_ += (pose().translation() - before).norm();
  trace_.time.push_back(site_->time());
  trace_.travel.push_back(travelled_);
  trace_.force.push_back(impulse.force_W);
  trace_.edge.push_back(impulse.edge_force_W);
  trace_.moment.push_back(impulse.moment_W);
}

Vec3 ToolDriver::run(double seconds, double dt) {
  // At the speed set before.
  double limit = site_->step_limit();
  if (dt > 0) limit = std::min(limit, dt);
  // Equal steps, so that the plain mean over entries is the mean over time.
  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / limit - 1e-9)));
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < steps; ++i) {
    step(seconds / steps);
    // Impulses over time are the mean force: nothing is lost between two intervals.
    sum += site_->tool(tool_).impulse.J_W;
  }
  return sum / seconds;
}

Vec3 ToolDriver::advance(double distance, const Vec3& v_W, double dt) {
  // The origin moves straight; use set_twist and run for a turning tool.
  set_twist(v_W);
  return run(distance / v_W.norm(), dt);
}

Vec3 ToolDriver::start(double distance, const Vec3& v_W, double ramp) {
  const double speed = v_W.norm(), rise = std::min(ramp, distance);
  if (!(rise > 0)) return advance(distance, v_W);
  // The stable step of the full speed is valid for lower speeds, too.
  set_twist(v_W);
  const double limit = site_->step_limit(), seconds = 2 * rise / speed;
  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / limit - 1e-9)));
  Vec3 impulse = Vec3::Zero();
  for (int i = 0; i < steps; ++i) {
    // The speed at mid-step: the path is then exactly that of constant acceleration.
    set_twist((i + 0.5) / steps * v_W);
    step(seconds / steps);
    impulse += trace_.force.back() * seconds / steps;
  }
  if (distance - rise < 1e-12) return impulse / seconds;
  const double rest = (distance - rise) / speed;
  return (impulse + advance(distance - rise, v_W) * rest) / (seconds + rest);
}

void ToolDriver::write(Report& report, double cutoff, const std::string& prefix) const {
  report.series.push_back({prefix + "time", "s", trace_.time});
  report.series.push_back({prefix + "travel", "m", trace_.travel});
  // Components in W, also for a tool that turns.
  const char* const names[] = {"force_x", "force_y", "force_z", "edge_x", "edge_y", "edge_z"};
  for (int a = 0; a < 6; ++a) {
    std::vector<double> values;
    for (const Vec3& force : a < 3 ? trace_.force : trace_.edge) values.push_back(force[a % 3]);
    // Only the written series is smoothed; results are means of the raw forces.
    if (cutoff > 0) values = low_pass(trace_.time, values, cutoff);
    report.series.push_back({prefix + names[a], "N", std::move(values)});
  }
}

// By travel, not by time: windows of experiments are given along the path.
Vec3 mean_force(const Trace& trace, double from, double to) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t i = 0; i < trace.travel.size(); ++i) {
    if (trace.travel[i] < from || trace.travel[i] >= to) continue;
    sum += trace.force[i];
    ++count;
  }
  // Not zero where nothing was measured: a missing window must not look like a free blade.
  return count > 0 ? Vec3(sum / count) : Vec3::Constant(kNone);
}

Vec3 force_scatter(const Trace& trace, double from, double to) {
  // Two passes: the mean may be a hundred times the scatter.
  const Vec3 mean = mean_force(trace, from, to);
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t i = 0; i < trace.travel.size(); ++i) {
    if (trace.travel[i] < from || trace.travel[i] >= to) continue;
    sum += (trace.force[i] - mean).cwiseAbs2();
    ++count;
  }
  return count > 0 ? Vec3((sum / count).cwiseSqrt()) : Vec3::Constant(kNone);
}

std::vector<double> low_pass(const std::vector<double>& time, const std::vector<double>& values,
                             double cutoff) {
  std::vector<double> out = values;
  const auto follow = [&](std::size_t to, std::size_t from) {
    // Backward Euler of a first-order filter, stable for any spacing of the samples.
    const double step = 2 * kPi * cutoff * std::abs(time[to] - time[from]);
    out[to] = out[from] + (out[to] - out[from]) * step / (1 + step);
  };
  // Forward and backward: the lags cancel.
  for (std::size_t i = 1; i < out.size(); ++i) follow(i, i - 1);
  for (std::size_t i = out.size(); i-- > 1;) follow(i - 1, i);
  return out;
}

}  // namespace navvy::lab
