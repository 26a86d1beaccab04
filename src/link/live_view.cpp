// SPDX-License-Identifier: Apache-2.0
#include "link/live_view.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "report/live_page.h"

namespace navvy::link {
namespace {

using nlohmann::json;

constexpr const char* kOption = "--view";
/// Interval at which a waiting run looks for signals and new pages [s].
constexpr double kGlance = 0.05;
/// Longest time that the end of a run waits for slow pages [s].
constexpr double kGoodbye = 2;
/// A run that is behind its pace by more [s] does not catch up.
constexpr double kMostBehind = 0.2;

bool ends_with(const std::string& name, const std::string& end) {
  return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

/// Returns true for the inputs that the page has sliders for: targets of joints.
bool is_shown(const sim::Channel& input) {
  return input.machine >= 0 &&
         (ends_with(input.name, "/position") || ends_with(input.name, "/velocity"));
}

json bound(double value) { return std::isfinite(value) ? json(value) : json(); }

/// Returns what the page may command, and the outputs that a frame has values of.
json commands_of(const run::Simulation& simulation, bool inputs_allowed,
                 std::vector<int>& measured) {
  json inputs = json::array();
  for (const sim::Channel& input : simulation.inputs()) {
    const int output = simulation.world().outputs().find(input.name);
    if (!inputs_allowed || !is_shown(input) || output < 0) continue;
    measured.push_back(output);
    const auto machine = static_cast<std::size_t>(input.machine);
    inputs.push_back({{"name", input.name},
                      {"unit", input.unit},
                      {"machine", simulation.world().description().machines[machine].name},
                      {"low", bound(input.low)},
                      {"high", bound(input.high)}});
  }
  return {{"control", true}, {"inputs", inputs}, {"step_s", simulation.world().dt()}};
}

std::string page_of(const run::Simulation& simulation, const record::ReplayFrames& frames,
                    bool inputs_allowed, std::vector<int>& measured) {
  const std::string& name = simulation.world().description().name;
  const json live = commands_of(simulation, inputs_allowed, measured);
  const std::string header =
      frames.header(LiveView::kRate).dump(-1, ' ', false, json::error_handler_t::replace);
  return report::live_page(name.empty() ? "run" : name, header, live);
}

}  // namespace

LiveView::LiveView(run::Simulation& simulation, int port, const std::string& inputs_refused)
    : simulation_(simulation),
      frames_(simulation.session(), kMostParticles),
      commands_(simulation.world().inputs(), inputs_refused),
      page_(page_of(simulation, frames_, inputs_refused.empty(), measured_)),
      server_(kOption, port,
              {[this] { return page_; },
               [this] { return feed_; },
               [this](const std::string& text) { commands_.add(text); },
               {}}) {
  pace_time_ = speed_time_ = simulation.time();
}

LiveView::~LiveView() { finish(); }

void LiveView::require_port(int port) { ViewServer::require_port(kOption, port); }

void LiveView::before_step(const std::function<bool()>& stop) {
  for (;;) {
    obey();
    if (stop()) return;
    const double wait = waiting();
    if (wait <= 0) break;
    measure();
    // Pages that open while the run stands still get a frame, too.
    if (feed_->subscriptions() != subscriptions_ || changed_) publish(false);
    commands_.wait(std::min(wait, kGlance));
  }
  if (steps_ > 0) --steps_;
  // A run that cannot keep its pace does not hurry afterwards.
  if (waiting() < -kMostBehind) {
    pace_time_ = simulation_.time();
    pace_watch_.restart();
  }
}

double LiveView::waiting() const {
  if (paused_ && steps_ == 0) return kGlance;
  if (pace_ <= 0) return 0;
  return (simulation_.time() - pace_time_) / pace_ - pace_watch_.seconds();
}

void LiveView::obey() {
  const ViewCommands::Pending pending = commands_.take();
  changed_ = changed_ || pending.pause || pending.steps > 0 || pending.pace;
  if (pending.pause) {
    paused_ = *pending.pause;
    steps_ = 0;
  }
  if (pending.steps > 0) {
    paused_ = true;
    steps_ += pending.steps;
  }
  if (pending.pace) pace_ = *pending.pace;
  if (pending.pause || pending.steps > 0 || pending.pace) {
    pace_time_ = simulation_.time();
    pace_watch_.restart();
  }
  for (const auto& [input, value] : pending.inputs) {
    changed_ = true;
    try {
      simulation_.set(input, value);
      message_.clear();
    } catch (const InputError& error) {
      message_ = error.what();
    }
  }
}

void LiveView::after_step() {
  measure();
  // The last of the steps that were asked for is always shown.
  const bool stands = paused_ && steps_ == 0;
  const double interval = std::max(1 / kRate, cost_ / kShare);
  if (!stands && feed_->subscriptions() == subscriptions_ && since_frame_.seconds() < interval)
    return;
  if (feed_->subscribers() > 0) publish(false);
}

void LiveView::measure() {
  const double passed = speed_watch_.seconds();
  if (passed < 1) return;
  speed_ = (simulation_.time() - speed_time_) / passed;
  speed_time_ = simulation_.time();
  speed_watch_.restart();
}

void LiveView::publish(bool all) {
  const Stopwatch lap;
  changed_ = false;
  subscriptions_ = feed_->subscriptions();
  json frame = frames_.frame();
  json values = json::array();
  for (const int output : measured_) values.push_back(simulation_.get(output));
  frame["live"] = {{"paused", paused_},
                   {"pace", pace_},
                   {"step", simulation_.world().steps()},
                   {"speed", speed_},
                   {"particles", simulation_.world().soil().counts().particles},
                   {"values", std::move(values)},
                   {"message", message_}};
  feed_->add(frame, frames_.tiles(all));
  cost_ = lap.seconds();
  since_frame_.restart();
}

// The time may have gone back, so the pace begins anew.
void LiveView::restart() {
  pace_time_ = speed_time_ = simulation_.time();
  pace_watch_.restart();
  publish(true);
}

void LiveView::finish() {
  if (std::exchange(finished_, true)) return;
  if (feed_->subscribers() > 0) publish(false);
  const std::string folder = simulation_.results_folder();
  feed_->close("The run has ended." +
               (folder.empty() ? std::string() : " Its results are in " + folder + "."));
  // Each page gets the last frame and the end before its stream is cut.
  feed_->wait_until_left(kGoodbye);
  server_.close();
}

}  // namespace navvy::link
