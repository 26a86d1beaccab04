// SPDX-License-Identifier: Apache-2.0
#include "earthwork/dig_lanes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/polygon.h"

namespace navvy::earthwork {
namespace {

/// A pit wider than this [m] is dug in lanes. With a reach of 7 to 8 m a machine in the middle of
/// its lane gets to both edges some metres ahead.
constexpr double kLane = 7;
// Sides that are steeper than this [rad] ask for straight lanes.
constexpr double kSteep = radians(75);
// A pit is wide if it is so many buckets wide square to its longest edge: shorter cuts fill none.
constexpr double kWide = 2.5;
// Straight lanes are at most so far apart [m]. Their cuts go on so far beyond half of that [m], and
// so far to both sides [rad].
constexpr double kStraightLane = 3, kOverlap = 0.1, kStraightSector = radians(32);
// Stations of straight lanes are looked for in steps of this [m], and a strip along the near side
// with this share of the soil of its lane is no reason for one.
constexpr double kStraightStep = 0.05, kStraightLeast = 0.02;
// Space for the end of a cut between the nearest soil and where the arm can dig [m].
constexpr double kStraightEnd = 0.5;
// The sides of the bucket may be so far outside of such a pit [m]: a strip that ends aslant at a
// side leaves a triangle inside or digs one outside. tuned: of 15 m3, 10 x 5 x 0.3 m in one wide
// lane, 0.1 / 0.4 leaves 2.4 / 1.4 and digs 0.1 / 0.6 outside.
constexpr double kOutside = 0.4;
// Least volume of a cut in the last layer / heaped capacity: what lies between lanes is taken too.
constexpr double kStraightWorth = 0.15;
// Deviation (rms) above which a strip is levelled at the end [m].
constexpr double kStraightTolerance = 0.04;
// An edge is parallel to a heading up to this sine.
constexpr double kParallel = 0.1;
// Stations of a lane are in one row if they are at most so far apart [m]: the machine then still
// stands on ground that no neighbour digs.
constexpr double kRow = 1.2;

/// Returns true for a wide pit with steep sides, which is dug, or levelled, up to these.
bool is_steep_and_wide(const control::PitJob& job, const PitShape& pit, double bucket_width) {
  return !job.heap && job.area.batter > kSteep && is_wide(pit, bucket_width);
}

/// Adds middles between lowest and highest so that none are more than kStraightLane apart.
std::vector<double> fill_in(const std::vector<double>& in) {
  std::vector<double> out;
  for (std::size_t i = 0; i < in.size(); ++i) {
    out.push_back(in[i]);
    if (i + 1 == in.size()) break;
    const double gap = in[i + 1] - in[i];
    const int n = std::max(1, static_cast<int>(std::ceil(gap / kStraightLane - 1e-9)));
    for (int k = 1; k < n; ++k) out.push_back(in[i] + gap * k / n);
  }
  return out;
}

/// Returns where lanes in line with the sides are, across a heading [m].
std::vector<double> in_line(const control::PitJob& job, const PitShape& pit, double bucket_width,
                            const Vec2& across) {
  const std::vector<Vec2>& corners = job.area.polygon;
  const auto [low, high] = pit.span(across);
  const double half = 0.5 * bucket_width, edge = 0.5 * pit.cell();
  std::vector<double> out = {low - edge + half, high + edge - half};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2& a = corners[i];
    const Vec2 side = corners[(i + 1) % corners.size()] - a;
    if (std::abs(side.dot(across)) > kParallel * side.norm()) continue;
    // The pit is on one side of the edge.
    const Vec2 middle = a + 0.5 * side;
    const bool above = !std::isnan(pit.floor(middle + 2 * pit.cell() * across));
    const double at = middle.dot(across) + (above ? half : -half);
    if (at > low && at < high) out.push_back(at);
  }
  std::sort(out.begin(), out.end());
  std::vector<double> apart;
  for (const double at : out)
    if (apart.empty() || at - apart.back() > half) apart.push_back(at);
  return fill_in(apart);
}

}  // namespace

bool is_wide(const PitShape& pit, double bucket_width) {
  return pit.width() >= kWide * bucket_width;
}

bool digs_straight(const control::PitJob& job, const PitShape& pit, double bucket_width) {
  return job.tolerance <= 0 && is_steep_and_wide(job, pit, bucket_width);
}

std::vector<RetreatAxis> lanes(const control::PitJob& job, const PitShape& pit, double bucket_width,
                               double heading) {
  const Vec2 ahead(std::cos(heading), std::sin(heading)), across(-ahead.y(), ahead.x());
  const auto [low, high] = pit.span(across);
  Vec2 middle = Vec2::Zero();
  const std::vector<PitColumn> columns = pit.columns();
  for (const PitColumn& one : columns) middle += one.p / static_cast<double>(columns.size());
  std::vector<double> places;
  if (digs_straight(job, pit, bucket_width)) {
    places = in_line(job, pit, bucket_width, across);
  } else {
    const int n = std::max(1, static_cast<int>(std::ceil((high - low) / kLane - 1e-9)));
    for (int i = 0; i < n; ++i) places.push_back(low + (i + 0.5) * (high - low) / n);
  }
  std::vector<RetreatAxis> out;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double at = places[i];
    const double right = i == 0 ? low - pit.cell() : 0.5 * (places[i - 1] + at),
                 left = i + 1 == places.size() ? high + pit.cell() : 0.5 * (at + places[i + 1]);
    out.push_back({middle + (at - middle.dot(across)) * across, heading, at - right, left - at});
  }
  const double spoil = 0.5 * (job.dump_from + job.dump_to).dot(across);
  if (spoil < 0.5 * (low + high)) std::reverse(out.begin(), out.end());
  return out;
}

SearchRules search_rules(const control::PitJob& job, const PitShape& pit, double bucket_width) {
  SearchRules out;
  if (is_steep_and_wide(job, pit, bucket_width)) out.nearest = kFaceBegins + kStraightEnd;
  if (!digs_straight(job, pit, bucket_width)) return out;
  out.sector = kStraightSector;
  out.step = kStraightStep;
  out.least_share = kStraightLeast;
  return out;
}

FanLimits lane_limits(const control::PitJob& job, const PitShape& pit, double bucket_width) {
  FanLimits out;
  const bool straight = digs_straight(job, pit, bucket_width);
  // A trench with steep sides ends square, too.
  out.square = straight || (!job.heap && job.area.batter > kSteep && !is_wide(pit, bucket_width));
  if (is_steep_and_wide(job, pit, bucket_width)) {
    out.outside = kOutside;
    out.nearest = kFaceBegins + kStraightEnd;
    out.levels_beyond = true;
  }
  if (!straight) return out;
  out.sector = kStraightSector;
  out.aside = 0.5 * kStraightLane + kOverlap;
  out.worth_last = kStraightWorth;
  out.tolerance = kStraightTolerance;
  return out;
}

void sort_in_rows(double heading, std::vector<control::JobStation>& stations) {
  const Vec2 ahead(std::cos(heading), std::sin(heading)), across(-ahead.y(), ahead.x());
  std::vector<std::pair<int, control::JobStation>> rows;
  Vec2 first = Vec2::Zero();  // of the row in this lane
  for (const control::JobStation& one : stations) {
    const bool same_lane = !rows.empty() && std::abs((one.at.p - first).dot(across)) < 0.1;
    int row = same_lane ? rows.back().first : 0;
    if (same_lane && (first - one.at.p).dot(ahead) > kRow) ++row;
    if (!same_lane || row != rows.back().first) first = one.at.p;
    rows.emplace_back(row, one);
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::transform(rows.begin(), rows.end(), stations.begin(),
                 [](const auto& one) { return one.second; });
}

}  // namespace navvy::earthwork
