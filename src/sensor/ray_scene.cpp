// SPDX-License-Identifier: Apache-2.0
#include "sensor/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "sensor/ball_grid.h"
#include "sensor/ground_rays.h"
#include "sim/cylinder_shapes.h"
#include "sim/visible_soil.h"

namespace navvy::sensor {
namespace {

/// A round bar between two points.
struct Bar {
  Vec3 p, axis;   ///< one end, and the unit vector to the other
  double length;  ///< distance between the ends [m]
  double radius;  ///< [m]
  int machine;    ///< index of the machine
};

/// Returns true if a beam enters the box within `reach` [m]; `inverse` has finite components.
bool meets_box(const Vec3& low, const Vec3& high, const Vec3& p, const Vec3& inverse,
               double reach) {
  const Eigen::Array3d a = (low - p).array() * inverse.array(),
                       b = (high - p).array() * inverse.array();
  return std::max(0.0, a.min(b).maxCoeff()) <= std::min(reach, a.max(b).minCoeff());
}

/// Returns the inverse of each component, a large number instead of infinity: a product with 0 must
/// be 0, for beams in the plane of a box's face.
Vec3 finite_inverse(const Vec3& d) {
  constexpr double kSmall = 1e-30;
  return d.unaryExpr([](double x) { return 1 / (std::abs(x) < kSmall ? kSmall : x); });
}

/// A machine: ranges of its bodies and bars, and the box around them in W [m].
struct Group {
  std::size_t bodies_from = 0, bodies_to = 0;
  std::size_t bars_from = 0, bars_to = 0;
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);

  void include(const Vec3& a, const Vec3& b) {
    low = low.cwiseMin(a);
    high = high.cwiseMax(b);
  }
};

/// Returns the distance at which a beam meets the side of a bar; a negative number for a miss.
double meet(const Bar& bar, const Vec3& p, const Vec3& d) {
  // Components across the axis decide about the distance from it.
  const Vec3 q = p - bar.p;
  const Vec3 dq = d - d.dot(bar.axis) * bar.axis, qq = q - q.dot(bar.axis) * bar.axis;
  const double a = dq.squaredNorm(), b = dq.dot(qq), c = qq.squaredNorm() - bar.radius * bar.radius;
  const double root = b * b - a * c;
  if (a < 1e-12 || root < 0 || c <= 0) return -1;
  const double t = (-b - std::sqrt(root)) / a;
  const double along = (q + t * d).dot(bar.axis);
  return along >= 0 && along <= bar.length ? t : -1;
}

}  // namespace

struct RayScene::State {
  explicit State(const sim::World& w) : world(w), bodies(solid_bodies(w.description())) {
    for (const SolidBody& body : bodies)
      links.push_back(world.machines().at(body.machine).link(body.link));
    // The bodies of a machine stand together in the list.
    std::size_t at = 0;
    for (std::size_t m = 0; m < world.description().machines.size(); ++m) {
      Group group;
      group.bodies_from = at;
      while (at < bodies.size() && bodies[at].machine == static_cast<int>(m)) ++at;
      group.bodies_to = at;
      groups.push_back(group);
    }
  }

  void place_bodies() {
    bars.clear();
    for (std::size_t m = 0; m < groups.size(); ++m) {
      Group& group = groups[m];
      group.low.setConstant(1e300);
      group.high.setConstant(-1e300);
      for (std::size_t i = group.bodies_from; i < group.bodies_to; ++i) {
        bodies[i].place(links[i].pose());
        group.include(bodies[i].low, bodies[i].high);
      }
      group.bars_from = bars.size();
      add_bars(static_cast<int>(m), group);
      group.bars_to = bars.size();
    }
  }

  void add_bars(int m, Group& group) {
    shapes.clear();
    sim::add_cylinder_shapes(world, m, shapes);
    for (const scene::FrameCylinder& one : shapes) {
      const Vec3 d = one.p_rod - one.p_base;
      const double barrel = std::min(one.barrel_length, d.norm());
      // The rod is thinner than the barrel that it leaves, as in pictures.
      bars.push_back({one.p_base, d.normalized(), barrel, one.radius, m});
      bars.push_back({one.p_base, d.normalized(), d.norm(), 0.6 * one.radius, m});
      const Vec3 around = Vec3::Constant(one.radius);
      group.include(one.p_base.cwiseMin(one.p_rod) - around,
                    one.p_base.cwiseMax(one.p_rod) + around);
    }
  }

  const sim::World& world;
  std::vector<SolidBody> bodies;
  std::vector<sim::LinkHandle> links;  ///< link of each body, for its pose
  std::vector<Bar> bars;
  std::vector<Group> groups;                 ///< one per machine of the scene
  std::vector<scene::FrameCylinder> shapes;  ///< memory of `add_bars`
  sim::VisibleSoil soil{world};
  GroundRays ground;
  BallGrid balls;
  bool fresh = false;       ///< false before the first update and after `forget`
  std::uint64_t steps = 0;  ///< step of the last update
};

RayScene::RayScene(const sim::World& world) : state_(std::make_unique<State>(world)) {}
RayScene::~RayScene() = default;

void RayScene::forget() { state_->fresh = false; }

void RayScene::update() {
  State& s = *state_;
  if (s.fresh && s.steps == s.world.steps()) return;
  s.soil.update();
  s.ground.update(s.soil.surface());
  s.balls.build(s.soil.origin(), s.soil.balls());
  s.place_bodies();
  s.steps = s.world.steps();
  s.fresh = true;
}

std::optional<BeamHit> RayScene::first_hit(const Vec3& p_W, const Vec3& direction_W,
                                           double reach) const {
  const State& s = *state_;
  if (!p_W.allFinite() || !direction_W.allFinite()) return std::nullopt;
  std::optional<BeamHit> best;
  double limit = reach;
  const auto take = [&](double distance, Met what, int machine, int link) {
    limit = distance;
    best = BeamHit{distance, what, machine, link};
  };
  const Vec3 inverse = finite_inverse(direction_W);
  for (const Group& group : s.groups) {
    if (!meets_box(group.low, group.high, p_W, inverse, limit)) continue;
    for (std::size_t i = group.bodies_from; i < group.bodies_to; ++i) {
      const SolidBody& body = s.bodies[i];
      if (!meets_box(body.low, body.high, p_W, inverse, limit)) continue;
      const auto hit =
          body.tree.first_hit(body.X_LW * p_W, body.X_LW.linear() * direction_W, limit);
      if (hit) take(hit->distance, Met::kBody, body.machine, body.link);
    }
    for (std::size_t i = group.bars_from; i < group.bars_to; ++i)
      if (const double t = meet(s.bars[i], p_W, direction_W); t >= 0 && t < limit)
        take(t, Met::kBody, s.bars[i].machine, -1);
  }
  if (const auto t = s.balls.first_hit(p_W, direction_W, limit); t && *t < limit)
    take(*t, Met::kSoil, -1, -1);
  if (const auto t = s.ground.first_hit(p_W, direction_W, limit); t && *t < limit)
    take(*t, Met::kGround, -1, -1);
  return best;
}

bool RayScene::on_machine(int machine, const Vec3& p_W, double margin) const {
  for (const SolidBody& body : state_->bodies) {
    if (body.machine != machine) continue;
    const Vec3 p = (body.X_LW * p_W - body.middle).cwiseAbs();
    if ((p.array() <= body.half.array() + margin).all()) return true;
  }
  for (const Bar& bar : state_->bars) {
    if (bar.machine != machine) continue;
    const double along = std::clamp((p_W - bar.p).dot(bar.axis), 0.0, bar.length);
    if ((p_W - bar.p - along * bar.axis).norm() <= bar.radius + margin) return true;
  }
  return false;
}

Enclosure RayScene::around(const Vec3& p_W) const {
  const State& s = *state_;
  return sensor::around(s.world.description(), s.ground.surface(), s.bodies, p_W);
}

}  // namespace navvy::sensor
