// SPDX-License-Identifier: Apache-2.0
#include "earthwork/part_done.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "control/reach.h"
#include "core/error.h"
#include "core/math.h"
#include "core/random.h"
#include "earthwork/pit_checks.h"
#include "earthwork/pit_planner.h"
#include "earthwork/pit_shape.h"
#include "earthwork/spoil_place.h"
#include "earthwork/station_search.h"

namespace navvy::earthwork {
namespace {

// The spoil lies at this share of the slope at which its friction holds it, so that it is at rest.
constexpr double kResting = 0.95;
constexpr double kBend = 0.1;         // of the face [m]
constexpr double kUnderBody = 0.2;    // of a body over the ground on which it stands [m]
constexpr double kLeastShare = 0.01;  // of the job
// Plastic shear of spoil, in remoulding strains: less than a hundredth of its bonds is left.
constexpr float kRemoulded = 4;
constexpr int kBisections = 60;

[[noreturn]] void refuse(const std::string& part, const std::string& value, const std::string& rule,
                         const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, part, value, rule, remedy});
}

/// Returns the argument at which an increasing function reaches `wanted`.
template <class Function>
double solve(double low, double high, double wanted, const Function& function) {
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// The pit ahead of a face that moves along the axis of the first station.
class Face {
 public:
  Face(const control::PitJob& job, const PitShape& pit, double heading, std::uint64_t seed)
      : columns_(pit.columns()),
        area_(pit.column_area()),
        lowest_(pit.lowest()),
        slope_(face_slope(job)),
        ahead_(std::cos(heading), std::sin(heading)),
        across_(-ahead_.y(), ahead_.x()) {
    Random random(seed);
    for (double& phase : phases_) phase = random.uniform(0, 2 * kPi);
    for (const PitColumn& one : columns_) {
      near_ = std::min(near_, one.p.dot(ahead_));
      far_ = std::max(far_, one.p.dot(ahead_));
      deepest_ = std::max(deepest_, one.top - one.floor);
    }
  }

  /// Returns the height down to which a column is dug with the foot of the face at `foot` [m].
  double down_to(const PitColumn& one, double foot) const {
    // Two waves: the face of no machine is straight.
    const double y = one.p.dot(across_);
    const double bend =
        0.5 * kBend *
        (std::sin(2 * kPi * y / 3.1 + phases_[0]) + std::sin(2 * kPi * y / 1.9 + phases_[1]));
    const double behind = foot + bend - one.p.dot(ahead_);
    return std::max(one.floor, lowest_ + std::max(0.0, behind) * slope_);
  }
  double volume(double foot) const {
    double out = 0;
    for (const PitColumn& one : columns_)
      out += std::max(0.0, one.top - down_to(one, foot)) * area_;
    return out;
  }
  /// Returns the place of the foot at which so much is dug.
  double foot_for(double volume) const {
    return -solve(-(far_ + kBend), -(near_ - kBend - deepest_ / slope_), volume,
                  [&](double back) { return this->volume(-back); });
  }
  const std::vector<PitColumn>& columns() const { return columns_; }

 private:
  const std::vector<PitColumn> columns_;
  const double area_, lowest_, slope_;
  const Vec2 ahead_, across_;
  double phases_[2] = {0, 0};
  double near_ = std::numeric_limits<double>::infinity(), far_ = -near_, deepest_ = 0;
};

/// Returns the points of the windrow at which the stations of the first part of a job dump.
std::vector<Vec2> dump_points(const control::PitJob& job, const control::JobPlan& plan,
                              const control::ArmKinematics& arm, double rise, double share,
                              const control::SurfaceView& surface) {
  std::vector<Vec2> out;
  double before = 0;
  for (const control::JobStation& one : plan.stations) {
    if (before >= share * plan.volume) break;
    before += one.volume;
    const Pose X_WS = station_pose(one.at, rise, surface) * arm.X_BS();
    for (const Vec2& p : reachable_spoil(job, arm, X_WS, surface))
      if (std::find(out.begin(), out.end(), p) == out.end()) out.push_back(p);
  }
  if (out.empty())
    refuse("dump_at_m", control::place_text(job.dump_from),
           "no station of the first part of the job can dump there",
           "dump nearer, or in a windrow beside the pit");
  return out;
}

/// A ridge of loose soil around points, on a site.
class Ridge {
 public:
  /// `reach` bounds the distance of the ridge from the points [m].
  Ridge(const std::vector<Vec2>& points, double slope, double reach,
        const heightfield::Ground& ground)
      : slope_(slope), cell_(ground.cell()) {
    Vec2 low = points.front(), high = low;
    for (const Vec2& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const Vec2i from = ground.column_at(low.x() - reach, low.y() - reach),
                to = ground.column_at(high.x() + reach, high.y() + reach);
    const Vec2i first = from.cwiseMax(0),
                last = to.cwiseMin(Vec2i(ground.nx(), ground.ny()) - Vec2i::Ones());
    for (int iy = first.y(); iy <= last.y(); ++iy)
      for (int ix = first.x(); ix <= last.x(); ++ix) {
        const Vec2 p = ground.origin() + cell_ * Vec2(ix + 0.5, iy + 0.5);
        double away = std::numeric_limits<double>::infinity();
        for (const Vec2& q : points) away = std::min(away, (p - q).norm());
        places_.push_back({ix, iy, p, away, ground.height(ix, iy)});
        lowest_ = std::min(lowest_, places_.back().base);
        highest_ = std::max(highest_, places_.back().base);
      }
  }

  /// One column under the ridge.
  struct Place {
    int ix = 0, iy = 0;
    Vec2 p;            // its centre in W [m]
    double away = 0;   // distance from the nearest point [m]
    double base = 0;   // height of the ground [m]
    double thick = 0;  // of the spoil [m]
  };
  /// Returns the columns that hold `volume`, with the thickness of the spoil on each.
  std::vector<Place> columns(double volume) const {
    const auto thick = [&](const Place& one, double crest) {
      return std::max(0.0, crest - one.away * slope_ - one.base);
    };
    const double crest = solve(lowest_, highest_ + 50, volume, [&](double height) {
      double sum = 0;
      for (const Place& one : places_) sum += thick(one, height) * cell_ * cell_;
      return sum;
    });
    std::vector<Place> out;
    for (Place one : places_)
      if ((one.thick = thick(one, crest)) > 0) out.push_back(one);
    return out;
  }

 private:
  const double slope_, cell_;
  std::vector<Place> places_;
  double lowest_ = std::numeric_limits<double>::infinity(), highest_ = -lowest_;
};

/// Refuses a change of a column on which a body stands. `top` is the height of the ground there, or
/// of the spoil [m].
void check_bodies(const std::vector<heightfield::OccupiedArea>& bodies, const Vec2& p, double top,
                  double cell) {
  const Vec2 half = Vec2::Constant(0.5 * cell);
  for (const heightfield::OccupiedArea& one : bodies)
    if (one.low < top + kUnderBody && heightfield::meets(one, p - half, p + half))
      refuse("pose", control::place_text(p), "a body stands where the pit or its spoil would be",
             "place machines where they would stand by then");
}

/// Refuses spoil in the pit, under a body, or at the border.
void check_ridge(const std::vector<Ridge::Place>& ridge, const PitShape& pit,
                 const std::vector<heightfield::OccupiedArea>& bodies,
                 const heightfield::Ground& ground) {
  if (ridge.empty()) refuse("--done", "", "there would be no spoil", "dig more of the job");
  for (const Ridge::Place& one : ridge) {
    const std::string place = control::place_text(one.p);
    if (!std::isnan(pit.floor(one.p)))
      refuse("dump_at_m", place, "the spoil would be in the pit", "dump farther aside");
    check_bodies(bodies, one.p, one.base + one.thick, ground.cell());
    if (one.ix == 0 || one.iy == 0 || one.ix + 1 == ground.nx() || one.iy + 1 == ground.ny())
      refuse("size_m", place, "the spoil would reach the border of the site",
             "make the site larger");
  }
}

/// Moves the soil above the face onto the ridge, loose.
class Move {
 public:
  explicit Move(heightfield::Ground& ground) : ground_(ground) {}

  void take(const Vec2i& column, double down_to) {
    ground_.take_above(column.x(), column.y(), down_to, taken_);
  }
  /// Puts spoil of the given thickness on a column, as far as there is some.
  void put(const Ridge::Place& place) {
    double left = place.thick;
    while (left > 0 && next_ < taken_.size()) {
      heightfield::SoilLayer layer = loose(taken_[next_]);
      const double unit = thickness_of(layer) / static_cast<double>(layer.mass);
      const auto most = static_cast<std::int64_t>(std::max(1.0, std::round(left / unit)));
      layer.mass = std::min(layer.mass, most);
      taken_[next_].mass -= layer.mass;
      if (taken_[next_].mass == 0) ++next_;
      left -= unit * static_cast<double>(layer.mass);
      ground_.put(place.ix, place.iy, layer);
    }
  }
  /// Puts what rounding has left on a column.
  void put_rest(const Ridge::Place& place) {
    for (; next_ < taken_.size(); ++next_) ground_.put(place.ix, place.iy, loose(taken_[next_]));
  }
  /// Returns the volume of a layer in the loose state [m3].
  double loose_volume(const heightfield::SoilLayer& layer) const {
    return thickness_of(loose(layer)) * ground_.cell() * ground_.cell();
  }
  /// Returns the thickness of a layer in its column [m].
  double thickness_of(const heightfield::SoilLayer& layer) const {
    return kilograms(layer.mass) * static_cast<double>(layer.specific_volume) /
           (ground_.setup().soils[layer.soil].bank_density * ground_.cell() * ground_.cell());
  }

 private:
  heightfield::SoilLayer loose(heightfield::SoilLayer layer) const {
    const scene::Soil& soil = ground_.setup().soils[layer.soil];
    layer.specific_volume = static_cast<float>(soil.swell);
    layer.plastic_shear = kRemoulded * static_cast<float>(soil.remoulding_strain);
    return layer;
  }

  heightfield::Ground& ground_;
  std::vector<heightfield::SoilLayer> taken_;
  std::size_t next_ = 0;
};

/// Soil above a face in its loose state: its volume [m3], and the slope at which it is at rest [-].
struct Spoil {
  double volume = 0, slope = 0;
};
Spoil spoil_of(const Face& face, double foot, const Move& move, const heightfield::Ground& ground) {
  Spoil out;
  double flattest = kPi / 2;
  std::vector<heightfield::SoilLayer> layers;
  for (const PitColumn& one : face.columns()) {
    const Vec2i at = ground.column_at(one.p.x(), one.p.y());
    double depth = one.top - face.down_to(one, foot);
    ground.column(at.x(), at.y(), layers);
    for (auto layer = layers.rbegin(); layer != layers.rend() && depth > 0; ++layer) {
      const double thick = move.thickness_of(*layer);
      out.volume += move.loose_volume(*layer) * std::min(1.0, depth / thick);
      flattest = std::min(flattest, ground.setup().soils[layer->soil].friction_angle);
      depth -= thick;
    }
  }
  out.slope = kResting * std::tan(flattest);
  if (!(out.slope > 0))
    refuse("friction_angle_deg", "0", "soil without friction makes no heap", "use another soil");
  return out;
}

/// Returns the plan of a job that can be done. @throws InputError with its faults, or if there is
/// nothing to dig.
control::JobPlan plan_of(const control::PitJob& job, const scene::Machine& machine,
                         const Pose& X_WB, const control::SurfaceView& surface) {
  control::JobPlan plan = job_planners()(machine)->plan(job, X_WB, surface);
  std::vector<Fault> faults;
  for (const control::JobFault& one : plan.faults)
    if (one.error)
      faults.push_back({Fault::Severity::kError, "", 0, one.part, one.value, one.rule, one.remedy});
  if (!faults.empty()) throw InputError(std::move(faults));
  if (plan.stations.empty())
    refuse("polygon_m", control::place_text(job.area.polygon.front()), "nothing is to be dug here",
           "look at the shape: navvy check SCENE");
  return plan;
}

}  // namespace

PartDone stage(const control::PitJob& job, const scene::Machine& machine, const Pose& X_WB,
               double share, std::uint64_t seed,
               const std::vector<heightfield::OccupiedArea>& bodies, heightfield::Ground& ground) {
  if (!(share >= kLeastShare) || share > 1)
    refuse("--done", control::number_text(share, ""), "must be from 0.01 to 1", "e.g. 0.5");
  const control::GroundSurfaceView surface(ground);
  const control::JobPlan plan = plan_of(job, machine, X_WB, surface);
  const PitShape pit(job.area, surface);
  const Face face(job, pit, plan.stations.front().at.yaw, seed);
  const double foot = face.foot_for(share * face.volume(-std::numeric_limits<double>::max()));
  PartDone out;
  out.volume = face.volume(foot);
  out.share = out.volume / pit.volume().design;
  // All checks come before the first change, so the soil is counted before it is taken.
  Move move(ground);
  const Spoil spoil = spoil_of(face, foot, move, ground);
  const control::ArmKinematics arm(machine);
  const double rise =
      X_WB.translation().z() - surface.height(X_WB.translation().x(), X_WB.translation().y());
  const Ridge ridge(dump_points(job, plan, arm, rise, share, surface), spoil.slope,
                    2 * std::cbrt(spoil.volume / spoil.slope) + 1, ground);
  const std::vector<Ridge::Place> places = ridge.columns(spoil.volume);
  check_ridge(places, pit, bodies, ground);
  for (const PitColumn& one : face.columns())
    if (face.down_to(one, foot) < one.top) check_bodies(bodies, one.p, one.top, pit.cell());
  for (const PitColumn& one : face.columns()) {
    const double down = face.down_to(one, foot);
    if (down < one.top) move.take(ground.column_at(one.p.x(), one.p.y()), down);
  }
  const Ridge::Place* highest = &places.front();
  for (const Ridge::Place& one : places) {
    move.put(one);
    if (one.thick > highest->thick) highest = &one;
  }
  move.put_rest(*highest);
  out.heap = highest->thick;
  return out;
}

}  // namespace navvy::earthwork
