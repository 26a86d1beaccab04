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
}

void ToolDriver::step(double dt) {
  const Vec3 before = pose().translation();
  site_->step(dt);
  const soil::ToolImpulse& impulse = site_->tool(tool_).impulse;
  travelled_ += (pose().translation() - before).norm();
  trace_.time.push_back(site_->time());
  trace_.travel.push_back(travelled_);
  trace_.force.push_back(impulse.J_W / dt);
  trace_.moment.push_back(impulse.L_W / dt);
}

Vec3 ToolDriver::run(double seconds, double dt) {
  double limit = site_->step_limit();
  if (dt > 0) limit = std::min(limit, dt);
  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / limit - 1e-9)));
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < steps; ++i) {
    step(seconds / steps);
    sum += trace_.force.back();
  }
  return sum / steps;
}

Vec3 ToolDriver::advance(double distance, const Vec3& v_W, double dt) {
  set_twist(v_W);
  return run(distance / v_W.norm(), dt);
}

void ToolDriver::write(Report& report, double cutoff, const std::string& prefix) const {
  report.series.push_back({prefix + "time", "s", trace_.time});
  report.series.push_back({prefix + "travel", "m", trace_.travel});
  const char* const names[] = {"force_x", "force_y", "force_z"};
  for (int a = 0; a < 3; ++a) {
    std::vector<double> values;
    for (const Vec3& force : trace_.force) values.push_back(force[a]);
    if (cutoff > 0) values = low_pass(trace_.time, values, cutoff);
    report.series.push_back({prefix + names[a], "N", std::move(values)});
  }
}

Vec3 mean_force(const Trace& trace, double from, double to) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t i = 0; i < trace.travel.size(); ++i) {
    if (trace.travel[i] < from || trace.travel[i] >= to) continue;
    sum += trace.force[i];
    ++count;
  }
  return count > 0 ? Vec3(sum / count) : Vec3::Constant(kNone);
}

Vec3 force_scatter(const Trace& trace, double from, double to) {
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

std::vector<double> low_pass(const std::vector<double>& time, const std::vector<double>& values, double cutoff) {
  std::vector<double> out = values;
  const auto follow = [&](std::size_t to, std::size_t from) {
    const double step = 2 * kPi * cutoff * std::abs(time[to] - time[from]);
    out[to] = out[from] + (out[to] - out[from]) * step / (1 + step);
  };
  for (std::size_t i = 1; i < out.size(); ++i) follow(i, i - 1);
  for (std::size_t i = out.size(); i-- > 1;) follow(i - 1, i);
  return out;
}

}  // namespace navvy::lab
