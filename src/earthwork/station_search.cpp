// SPDX-License-Identifier: Apache-2.0
#include "earthwork/station_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace navvy::earthwork {
namespace {

constexpr double kFront = 0.3;      // depth of the farthest soil that decides a station [m]
constexpr double kLeastBack = 0.3;  // a station is so far behind the one before it [m]
// Soil that is lower is no reason for a station [m]; in a shallow job this share of its depth.
constexpr double kLeastDepth = 0.1, kLeastShare = 0.3;

/// Search along one axis.
class AxisSearch {
 public:
  AxisSearch(const control::PitJob& job, const PitShape& pit, const Digger& digger,
             const RetreatAxis& axis, const SearchRules& rules)
      : pit_(pit),
        digger_(digger),
        axis_(axis),
        rules_(rules),
        cos_sector_(std::cos(rules.sector)),
        ahead_(std::cos(axis.heading), std::sin(axis.heading)),
        across_(-ahead_.y(), ahead_.x()),
        slope_(face_slope(job)),
        least_(std::min(kLeastDepth, kLeastShare * job.area.depth)) {}

  /// Moves the columns that the axis is for from `open` to its stations.
  void run(std::vector<PitColumn>& open, Stations& out) {
    const auto own = [&](const PitColumn& one) {
      const double aside = (one.p - axis_.through).dot(across_);
      return aside >= -axis_.right && aside <= axis_.left;
    };
    const auto middle =
        std::partition(open.begin(), open.end(), [&](const PitColumn& one) { return !own(one); });
    left_.assign(middle, open.end());
    open.erase(middle, open.end());
    double before = std::numeric_limits<double>::infinity();
    drop_thin();
    const double least = rules_.least_share * volume();
    for (; !left_.empty() && volume() > least; drop_thin()) {
      const double place = next_station(before);
      if (std::isnan(place)) {
        give_up_front(out);
        continue;
      }
      before = place - kLeastBack;
      take(place, out);
    }
  }

 private:
  double along(const PitColumn& one) const { return (one.p - axis_.through).dot(ahead_); }
  double farthest() const {
    double out = -std::numeric_limits<double>::infinity();
    for (const PitColumn& one : left_) out = std::max(out, along(one));
    return out;
  }
  /// Returns the volume of what is left [m3].
  double volume() const {
    double out = 0;
    for (const PitColumn& one : left_) out += (one.top - one.floor) * pit_.column_area();
    return out;
  }
  void drop_thin() {
    std::erase_if(left_, [this](const PitColumn& one) { return one.top - one.floor < least_; });
  }
  /// Returns true if a column is dug to its floor with the swing axis at `place`.
  bool covers(double place, const PitColumn& one) const {
    const Vec2 from = one.p - axis_.through - place * ahead_;
    const double reach = from.norm(), front = from.dot(ahead_);
    // The face ahead of the machine rises from its foot at the angle of the batter.
    return front >= reach * cos_sector_ && reach >= rules_.nearest &&
           one.top - one.floor <= (reach - kFaceBegins) * slope_ + kLeastDepth &&
           digger_.reach.contains(reach, one.floor - digger_.ring);
  }
  /// Returns the place farthest back, before `limit`, from which all of the farthest soil is dug;
  /// NaN if there is none.
  double next_station(double limit) const {
    const double far = farthest();
    if (rules_.nearest > 0 && std::isfinite(limit))
      if (const double last = last_station(limit, far); !std::isnan(last)) return last;
    std::vector<PitColumn> front;
    for (const PitColumn& one : left_)
      if (along(one) >= far - kFront) front.push_back(one);
    for (double place = far - digger_.reach.arm().longest() - 2; place < far;
         place += rules_.step) {
      if (place > limit) break;
      if (std::all_of(front.begin(), front.end(),
                      [&](const PitColumn& one) { return covers(place, one); }))
        return place;
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
  /// Returns the foremost place, before `limit`, from which all soil that is left is dug; NaN if
  /// there is none.
  double last_station(double limit, double far) const {
    for (double place = std::min(limit, far); place > far - digger_.reach.arm().longest() - 2;
         place -= rules_.step)
      if (std::all_of(left_.begin(), left_.end(),
                      [&](const PitColumn& one) { return covers(place, one); }))
        return place;
    return std::numeric_limits<double>::quiet_NaN();
  }
  /// Leaves the farthest soil out.
  void give_up_front(Stations& out) {
    const double far = farthest();
    std::erase_if(left_, [&](const PitColumn& one) {
      if (along(one) < far - kFront) return false;
      out.unreachable.push_back(one);
      out.lost += (one.top - one.floor) * pit_.column_area();
      return true;
    });
  }
  /// Adds the station at `place` and removes what it digs.
  void take(double place, Stations& out) {
    control::JobStation station;
    station.at = {axis_.through + (place - digger_.axle_ahead) * ahead_, axis_.heading};
    std::erase_if(left_, [&](const PitColumn& one) {
      if (!covers(place, one)) return false;
      station.volume += (one.top - one.floor) * pit_.column_area();
      return true;
    });
    // The upper part of the face is dug from here too.
    for (PitColumn& one : left_) {
      const Vec2 from = one.p - axis_.through - place * ahead_;
      const double reach = from.norm();
      if (reach < std::max(kFaceBegins, rules_.nearest) || from.dot(ahead_) < reach * cos_sector_)
        continue;
      const double down = std::max(one.floor, one.top - (reach - kFaceBegins) * slope_);
      if (!digger_.reach.contains(reach, down - digger_.ring)) continue;
      station.volume += (one.top - down) * pit_.column_area();
      one.top = down;
    }
    out.stations.push_back(station);
  }

  const PitShape& pit_;
  const Digger& digger_;
  const RetreatAxis& axis_;
  const SearchRules& rules_;
  const double cos_sector_;
  const Vec2 ahead_, across_;
  const double slope_, least_;
  std::vector<PitColumn> left_;
};

}  // namespace

double face_slope(const control::PitJob& job) {
  return std::min(1.0, std::tan(std::min(job.area.batter, radians(89))));
}

Stations find_stations(const control::PitJob& job, const PitShape& pit, const Digger& digger,
                       const std::vector<RetreatAxis>& axes, const SearchRules& rules) {
  Stations out;
  std::vector<PitColumn> open = pit.columns();
  for (const RetreatAxis& axis : axes) AxisSearch(job, pit, digger, axis, rules).run(open, out);
  return out;
}

}  // namespace navvy::earthwork
