// SPDX-License-Identifier: Apache-2.0
#include "record/overlay_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "record/tool_point.h"
#include "scene/design.h"
#include "sim/occupied_areas.h"
#include "sim/world_terrain.h"

namespace navvy::record {
namespace {

using scene::Color;
using scene::FrameOverlay;
using scene::Overlay;

constexpr Color kGreen{0.10f, 0.85f, 0.20f, 1}, kOrange{1.0f, 0.60f, 0.10f, 1},
    kGrey{0.6f, 0.6f, 0.6f, 1}, kRed{0.95f, 0.20f, 0.15f, 1}, kBlue{0.25f, 0.55f, 1.0f, 1},
    kWhite{1, 1, 1, 1}, kYellow{1.0f, 0.9f, 0.2f, 1};
// Height of lines over the ground, which would hide them otherwise [m].
constexpr double kLift = 0.04;
// Forces below this share of a machine's weight are not drawn.
constexpr double kLeastForce = 0.002;

template <class... T>
std::string text(const char* format, T... values) {
  std::array<char, 256> out{};
  std::snprintf(out.data(), out.size(), format, values...);
  return out.data();
}

void add_line(FrameOverlay& out, std::vector<Vec3> points, const Color& color, double width = 2,
              bool hidden = false) {
  out.lines.push_back({std::move(points), color, width, hidden});
}

/// Adds an arrow that ends at `head`.
void add_arrow(FrameOverlay& out, const Vec3& from, const Vec3& head, const Color& color) {
  const Vec3 along = head - from;
  if (along.norm() < 1e-6) return;
  const Vec3 side = along.unitOrthogonal() * (0.12 * along.norm());
  const Vec3 neck = head - 0.25 * along;
  add_line(out, {from, head}, color, 3);
  add_line(out, {neck + side, head, neck - side}, color, 3);
}

double weight_of(const scene::Machine& machine) {
  return kGravity *
         std::accumulate(machine.links.begin(), machine.links.end(), 0.0,
                         [](double sum, const scene::Link& link) { return sum + link.mass; });
}

}  // namespace

OverlayBuilder::OverlayBuilder(const session::Session& session)
    : session_(session), shown_(scene::overlays_of(session.world().description().show)) {
  const scene::Scene& scene = session.world().description();
  for (std::size_t m = 0; m < scene.machines.size(); ++m) {
    std::vector<char> included(scene.machines.size(), 0);
    included[m] = 1;
    Vec3 low = Vec3::Constant(1e30), high = -low;
    for (const heightfield::OccupiedArea& area : sim::occupied_areas(session.world(), included))
      for (const Vec2& p : area.outline) {
        low = low.cwiseMin(Vec3(p.x(), p.y(), area.low));
        high = high.cwiseMax(Vec3(p.x(), p.y(), area.high));
      }
    size_.push_back(low.x() <= high.x() ? (high - low).norm() : 1.0);
  }
}

void OverlayBuilder::build(FrameOverlay& out) {
  out = {};
  if (shown_.empty()) return;
  terrain_ = sim::terrain_view(session_.world(), heightfield::SurfaceKind::kColumns);
  // From back to front: later lines cover earlier ones.
  if (shows(Overlay::kGrid)) add_grid(out);
  if (shows(Overlay::kDesign)) add_design(out);
  if (shows(Overlay::kPath)) add_paths(out);
  const scene::Scene& scene = session_.world().description();
  for (int m = 0; m < static_cast<int>(scene.machines.size()); ++m) {
    if (!sim::is_machine(scene.machines[static_cast<std::size_t>(m)])) continue;
    if (shows(Overlay::kPath)) add_stakes(m, out);
    if (shows(Overlay::kPerson)) add_person(m, out);
    if (shows(Overlay::kJoints)) add_joints(m, out);
    if (shows(Overlay::kWheelLoads)) add_wheel_loads(m, out);
    if (shows(Overlay::kForces)) add_forces(m, out);
    if (shows(Overlay::kPayload)) add_payloads(m, out);
  }
  if (shows(Overlay::kHitches)) add_hitches(out);
  if (shows(Overlay::kHud)) out.caption = caption();
}

double OverlayBuilder::ground(const Vec2& p_W) const { return terrain_->sample(p_W.x(), p_W.y()); }

// An axis through the joint; an arc or a bar spans its limits and a tick shows its position.
void OverlayBuilder::add_joints(int machine, FrameOverlay& out) const {
  const sim::MachineHandle handle = session_.world().machines().at(machine);
  const scene::Machine& described = handle.description();
  const double length = std::clamp(0.04 * size_[static_cast<std::size_t>(machine)], 0.03, 0.5);
  for (std::size_t j = 0; j < described.joints.size(); ++j) {
    const scene::Joint& joint = described.joints[j];
    if (joint.child < 0 || joint.type == scene::Joint::Type::kFixed) continue;
    const Pose X_WJ = handle.link(joint.child).pose() * joint.X_LcJ;
    const Vec3 at = X_WJ.translation(), axis = (X_WJ.linear() * joint.axis).normalized();
    add_line(out, {at - length * axis, at + length * axis}, kGreen);
    if (!joint.has_limits || joint.type == scene::Joint::Type::kBall) continue;
    const double q = handle.joint(static_cast<int>(j)).position();
    if (joint.type == scene::Joint::Type::kPrismatic) {
      const Vec3 tick = length * axis.unitOrthogonal();
      add_line(out, {at + (joint.lower - q) * axis, at + (joint.upper - q) * axis}, kGreen, 1);
      add_line(out, {at - tick, at + tick}, kGreen, 1);
      continue;
    }
    // The direction that position zero has now, turned back by the position.
    const Vec3 now = (X_WJ.linear() * joint.axis.unitOrthogonal()).normalized();
    const auto toward = [&](double position) {
      return Vec3(at + 1.5 * length * (Eigen::AngleAxisd(position - q, axis) * now));
    };
    std::vector<Vec3> arc;
    constexpr int kPieces = 24;
    for (int i = 0; i <= kPieces; ++i)
      arc.push_back(toward(joint.lower + i * (joint.upper - joint.lower) / kPieces));
    add_line(out, std::move(arc), kGreen, 1);
    add_line(out, {at, toward(q)}, kGreen, 1);
  }
}

void OverlayBuilder::add_hitches(FrameOverlay& out) const {
  const sim::World& world = session_.world();
  const std::vector<scene::Hitch>& hitches = world.description().hitches;
  for (std::size_t h = 0; h < hitches.size(); ++h) {
    const scene::Hitch& hitch = hitches[h];
    const bool closed = world.machines().hitch(static_cast<int>(h)).closed;
    const double arm = std::clamp(0.04 * size_[static_cast<std::size_t>(hitch.parent)], 0.05, 0.4);
    const Vec3 hook = world.machines().at(hitch.parent).link(hitch.parent_link).pose() * hitch.hook;
    for (int i = 0; i < 3; ++i) {
      const Vec3 half = arm * Vec3::Unit(i);
      add_line(out, {hook - half, hook + half}, closed ? kOrange : kGrey, 3);
    }
  }
}

// A force equal to the machine's weight is as long as the machine.
void OverlayBuilder::add_forces(int machine, FrameOverlay& out) const {
  const sim::MachineHandle handle = session_.world().machines().at(machine);
  const scene::Machine& described = handle.description();
  const double weight = weight_of(described), size = size_[static_cast<std::size_t>(machine)];
  for (std::size_t s = 0; s < described.shells.size(); ++s) {
    const Vec3 force = handle.tool(static_cast<int>(s)).smooth_force();
    if (force.norm() < kLeastForce * weight) continue;
    const int link = described.link_index(described.shells[s].link);
    const Vec3 at = handle.link(link).pose() * tool_point(described.shells[s]);
    add_arrow(out, at - size * force / weight, at, kRed);
    out.labels.push_back({at - size * force / weight, text("%.1f kN", force.norm() / 1e3), kRed});
  }
}

void OverlayBuilder::add_wheel_loads(int machine, FrameOverlay& out) const {
  const sim::MachineHandle handle = session_.world().machines().at(machine);
  const scene::Machine& described = handle.description();
  const double weight = weight_of(described), size = size_[static_cast<std::size_t>(machine)];
  for (std::size_t w = 0; w < described.wheels.size(); ++w) {
    const vehicle::WheelState state = handle.wheel(static_cast<int>(w)).state();
    if (state.force_W.norm() < kLeastForce * weight) continue;
    const Vec3 from = state.X_WWheel.translation();
    const Vec3 head = from + 0.5 * size * state.force_W / weight;
    add_arrow(out, from, head, kBlue);
    out.labels.push_back({head, text("%.2f kN", state.force_W.norm() / 1e3), kBlue});
  }
}

void OverlayBuilder::add_payloads(int machine, FrameOverlay& out) const {
  const sim::MachineHandle handle = session_.world().machines().at(machine);
  const scene::Machine& described = handle.description();
  for (std::size_t s = 0; s < described.shells.size(); ++s) {
    const sim::ToolHandle tool = handle.tool(static_cast<int>(s));
    if (!tool.is_bucket() && !tool.is_bed()) continue;
    const int link = described.link_index(described.shells[s].link);
    out.labels.push_back(
        {handle.link(link).pose().translation(), text("%.0f kg", tool.payload()), kYellow});
  }
}

// Stands beside the machine, to its right.
void OverlayBuilder::add_person(int machine, FrameOverlay& out) const {
  const sim::MachineHandle handle = session_.world().machines().at(machine);
  const Pose X_WB = handle.link(0).pose();
  const Vec3 right = -X_WB.linear().col(1);
  const double away = 0.35 * size_[static_cast<std::size_t>(machine)] + 0.6;
  Vec3 feet = X_WB.translation() + away * Vec3(right.x(), right.y(), 0).normalized();
  feet.z() = ground(feet.head<2>());
  // Neither along nor across the machine, as most cameras look in one of these directions.
  const Vec3 across =
      (Eigen::AngleAxisd(radians(45), Vec3::UnitZ()) * Vec3(right.x(), right.y(), 0).normalized());
  const auto at = [&](double side, double height) {
    return Vec3(feet + side * across + Vec3(0, 0, height));
  };
  add_line(out, {at(-0.16, 0), at(-0.1, 0.85), at(0.1, 0.85), at(0.16, 0)}, kOrange, 4, true);
  add_line(out, {at(0, 0.85), at(0, 1.5)}, kOrange, 6, true);
  add_line(out, {at(-0.3, 0.8), at(-0.2, 1.4), at(0.2, 1.4), at(0.3, 0.8)}, kOrange, 3, true);
  std::vector<Vec3> head;
  for (int i = 0; i <= 12; ++i)
    head.push_back(at(0.12 * std::sin(i * kPi / 6), 1.63 + 0.12 * std::cos(i * kPi / 6)));
  add_line(out, std::move(head), kOrange, 3, true);
}

/// Draws nothing for a machine with an ordered program, as the scene's places are no longer its
/// aims.
void OverlayBuilder::add_stakes(int machine, FrameOverlay& out) const {
  for (const session::ProgramReport& report : session_.programs())
    if (report.machine == machine && report.orders > 0) return;
  const scene::Program& program =
      session_.world().description().machines[static_cast<std::size_t>(machine)].program;
  const double height = std::clamp(0.1 * size_[static_cast<std::size_t>(machine)], 0.2, 1.0);
  for (std::size_t i = 0; i < program.steps.size(); ++i)
    for (const Vec2& place : program.steps[i]->places()) {
      const Vec3 foot(place.x(), place.y(), ground(place));
      const Vec3 top = foot + height * Vec3::UnitZ();
      add_line(out, {foot, top}, kYellow, 2, true);
      out.labels.push_back({top, text("%zu", i + 1), kYellow});
    }
}

namespace {

/// Returns the time at which the present program of a report began [s].
double begin_of(const session::ProgramReport& report) {
  double out = 0;
  for (const control::StepReport& one : report.list)
    if (one.step == 1) out = one.start;
  return out;
}

}  // namespace

void OverlayBuilder::add_paths(FrameOverlay& out) const {
  for (const session::ProgramReport& report : session_.programs()) {
    // Only the last plan is being followed, unless an order has replaced its program since.
    if (report.paths.empty() || report.paths.back().time < begin_of(report)) continue;
    std::vector<Vec3> points;
    const control::Path& path = report.paths.back().path;
    const int pieces = static_cast<int>(std::ceil(path.length() / 0.25));
    for (int i = 0; i <= pieces; ++i) {
      const Vec2 p = path.at(path.length() * i / std::max(pieces, 1)).p;
      points.push_back({p.x(), p.y(), ground(p) + kLift});
    }
    add_line(out, std::move(points), kBlue, 3, true);
  }
}

void OverlayBuilder::add_design(FrameOverlay& out) const {
  for (const scene::DesignArea& area : session_.world().description().commanded_design().areas) {
    std::vector<Vec3> edge;
    for (std::size_t i = 0; i <= area.polygon.size(); ++i) {
      const Vec2& p = area.polygon[i % area.polygon.size()];
      edge.push_back({p.x(), p.y(), ground(p) + kLift});
    }
    add_line(out, std::move(edge), kWhite, 3);
  }
}

// Lines of 1 m around the machines, and of 5 m, with coordinates, over the site near them.
void OverlayBuilder::add_grid(FrameOverlay& out) const {
  const heightfield::Ground& site = session_.world().ground();
  const Vec2 low_edge = site.origin();
  const Vec2 high_edge = low_edge + site.cell() * Vec2(site.nx(), site.ny());
  Vec2 low = 0.5 * (low_edge + high_edge), high = low;
  double size = 5;
  for (std::size_t m = 0; m < size_.size(); ++m) {
    const Vec2 p =
        session_.world().machines().at(static_cast<int>(m)).link(0).pose().translation().head<2>();
    low = m == 0 ? p : Vec2(low.cwiseMin(p));
    high = m == 0 ? p : Vec2(high.cwiseMax(p));
    size = std::max(size, size_[m]);
  }
  // Beyond 60 m lines of 5 m are too close to each other to be of use.
  const auto lines = [&](double spacing, double margin, const Color& color, double width) {
    const Vec2 from = (low - Vec2::Constant(margin)).cwiseMax(low_edge),
               to = (high + Vec2::Constant(margin)).cwiseMin(high_edge);
    for (const int along : {0, 1}) {
      const int across = 1 - along;
      for (double at = spacing * std::ceil(from[across] / spacing); at <= to[across];
           at += spacing) {
        std::vector<Vec3> line;
        const int pieces = static_cast<int>(std::ceil((to[along] - from[along]) / 0.25));
        for (int i = 0; i <= pieces; ++i) {
          Vec2 p;
          p[across] = at;
          p[along] = from[along] + (to[along] - from[along]) * i / pieces;
          line.push_back({p.x(), p.y(), ground(p) + kLift});
        }
        if (line.size() > 1) add_line(out, std::move(line), color, width, true);
      }
    }
  };
  lines(1, size, {0.75f, 0.75f, 0.72f, 1}, 1);
  lines(5, std::min(3 * size, 60.0), kWhite, 2);
  const Vec2 from = (low - Vec2::Constant(size)).cwiseMax(low_edge),
             to = (high + Vec2::Constant(size)).cwiseMin(high_edge);
  for (double x = 5 * std::ceil(from.x() / 5); x <= to.x(); x += 5)
    for (double y = 5 * std::ceil(from.y() / 5); y <= to.y(); y += 5)
      out.labels.push_back({{x, y, ground({x, y}) + kLift}, text("%g, %g", x, y), kWhite});
}

std::string OverlayBuilder::caption() const {
  const sim::World& world = session_.world();
  std::string out = text("%s  %.1f s", world.description().name.c_str(), world.time());
  for (int m = 0; m < world.machines().count(); ++m) {
    const scene::MachineInWorld& placed = world.description().machines[static_cast<std::size_t>(m)];
    if (!sim::is_machine(placed)) continue;
    out += text("  |  %s: %s", placed.name.c_str(), session_.phase(m).c_str());
    const sim::MachineHandle handle = world.machines().at(m);
    for (std::size_t s = 0; s < placed.machine.shells.size(); ++s) {
      const sim::ToolHandle tool = handle.tool(static_cast<int>(s));
      if (tool.is_bucket())
        out += text(", %.0f kg, %.1f kN", tool.payload(), tool.smooth_force().norm() / 1e3);
      else if (tool.is_bed())
        out += text(", %.0f kg", tool.payload());
    }
  }
  return out;
}

}  // namespace navvy::record
