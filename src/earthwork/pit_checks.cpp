// SPDX-License-Identifier: Apache-2.0
#include "earthwork/pit_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "control/reach.h"
#include "earthwork/spoil_place.h"

namespace navvy::earthwork {
namespace {

using control::metres;
using control::number_text;
using control::place_text;

constexpr double kAroundStation = 2;  // from the site's border to a station [m]
// Half the length and width of a machine, and of the foot of a windrow [m].
constexpr double kHalfLength = 2.4, kHalfWidth = 1.3, kHalfWindrow = 1.8;
constexpr double kLeastLost = 0.05;  // volume out of reach that is a fault [m3]

/// Reports sides that are steeper than the soil stands.
void check_batter(const control::PitJob& job, const PitShape& pit,
                  const control::SurfaceView& surface, std::vector<control::JobFault>& faults) {
  const heightfield::Terrain& site = surface.terrain();
  const Vec2 corner = job.area.polygon.front();
  const Vec2i column = site.column_at(corner.x(), corner.y());
  const std::size_t kind = site.surface_soil(column.x(), column.y());
  if (kind >= site.setup().soils.size()) return;
  const scene::Soil& soil = site.setup().soils[kind];
  const double height = standing_height(soil, job.area.batter);
  const double depth = pit.ground() - pit.lowest();
  if (depth <= height) return;
  double flatter = job.area.batter;
  while (flatter > soil.friction_angle && standing_height(soil, flatter) < depth)
    flatter -= radians(1);
  faults.push_back({"batter_deg", number_text(degrees(job.area.batter), "deg"),
                    "'" + soil.name + "' stands at that angle up to " + metres(height) + ", at " +
                        place_text(corner) + " the pit is " + metres(depth) + " deep",
                    "at most " + number_text(std::floor(degrees(flatter)), "deg")});
}

/// Returns true if a machine at `at`, whose swing axis is `axle_ahead` [m] ahead, about its middle,
/// stands on a windrow through the point `p`.
bool stands_on(const control::PlanePose& at, double axle_ahead, const Vec2& p) {
  const Vec2 ahead(std::cos(at.yaw), std::sin(at.yaw)), line = p - at.p - axle_ahead * ahead;
  return std::abs(line.dot(ahead)) < kHalfLength + kHalfWindrow &&
         std::abs(ahead.x() * line.y() - ahead.y() * line.x()) < kHalfWidth + kHalfWindrow;
}

}  // namespace

Pose station_pose(const control::PlanePose& at, double rise, const control::SurfaceView& surface) {
  return make_pose(at.p.x(), at.p.y(), surface.height(at.p.x(), at.p.y()) + rise, 0, 0, at.yaw);
}

double standing_height(const scene::Soil& soil, double batter) {
  const double phi = soil.friction_angle;
  if (batter <= phi) return std::numeric_limits<double>::infinity();
  // A wedge on the most dangerous plane through the foot [Taylor 1948].
  return 4 * soil.cohesion / (soil.bank_density * kGravity) * std::sin(batter) * std::cos(phi) /
         (1 - std::cos(batter - phi));
}

std::vector<control::JobFault> check_pit(const control::PitJob& job, const PitShape& pit,
                                         const control::SurfaceView& surface) {
  std::vector<control::JobFault> faults;
  check_batter(job, pit, surface, faults);
  for (const Vec2& p : spoil_points(job)) {
    if (!pit.is_near(p, kSpoilClear)) continue;
    faults.push_back({"dump_at_m", place_text(p),
                      "spoil must fall " + metres(kSpoilClear) + " clear of the edge of the pit",
                      "dump farther aside"});
    break;
  }
  return faults;
}

void check_on_site(const std::vector<control::JobStation>& stations,
                   const control::SurfaceView& surface, std::vector<control::JobFault>& faults) {
  const heightfield::Terrain& site = surface.terrain();
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Vec2& p = stations[i].at.p;
    const Vec2 low = p - Vec2::Constant(kAroundStation) - site.origin();
    const Vec2 high = p + Vec2::Constant(kAroundStation) - site.origin();
    if (low.minCoeff() < 0 || high.x() > site.nx() * site.cell() ||
        high.y() > site.ny() * site.cell())
      faults.push_back({"polygon_m", "station " + std::to_string(i + 1) + " at " + place_text(p),
                        "the machine must stand " + metres(kAroundStation) + " within the site",
                        "make the site larger, or move the job"});
  }
}

void check_stations(const control::PitJob& job, const Stations& found, const StandingArm& machine,
                    const control::SurfaceView& surface, std::vector<control::JobFault>& faults) {
  if (found.lost > kLeastLost) {
    const auto deepest = std::max_element(
        found.unreachable.begin(), found.unreachable.end(),
        [](const PitColumn& a, const PitColumn& b) { return a.top - a.floor < b.top - b.floor; });
    faults.push_back({"polygon_m", place_text(deepest->p),
                      "no station reaches " + number_text(found.lost, "m3") +
                          " of the pit, the deepest of it here, " +
                          metres(deepest->top - deepest->floor) + " deep",
                      "make the pit less deep or its sides flatter, or divide it"});
  }
  check_on_site(found.stations, surface, faults);
  for (std::size_t i = 0; i < found.stations.size(); ++i) {
    const control::JobStation& one = found.stations[i];
    const std::string name = "station " + std::to_string(i + 1);
    for (const Vec2& p : spoil_points(job)) {
      if (job.into_beds || !stands_on(one.at, machine.arm.X_BS().translation().x(), p)) continue;
      faults.push_back(
          {"dump_at_m", place_text(p),
           "the spoil would lie where the machine stands at " + name + ", " + place_text(one.at.p),
           "dump " + metres(kHalfWidth + kHalfWindrow) + " beside it, or " +
               metres(kHalfLength + kHalfWindrow) + " behind it"});
      break;
    }
    const Pose X_WS = station_pose(one.at, machine.rise, surface) * machine.arm.X_BS();
    if (!reachable_spoil(job, machine.arm, X_WS, surface).empty()) continue;
    const double away = (job.dump_from - X_WS.translation().head<2>()).norm();
    faults.push_back({"dump_at_m", place_text(job.dump_from),
                      "from " + name + " at " + place_text(one.at.p) +
                          " the bucket can be opened nowhere on the windrow; its beginning is " +
                          metres(away) + " from the swing axis",
                      "dump nearer, or in a windrow beside the pit (dump_to_m)"});
  }
}

}  // namespace navvy::earthwork
