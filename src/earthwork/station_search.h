// SPDX-License-Identifier: Apache-2.0
// Stations of a pit along one axis. Private to earthwork.
#pragma once

#include <vector>

#include "control/job_planner.h"
#include "earthwork/arm_reach.h"
#include "earthwork/pit_shape.h"

namespace navvy::earthwork {

/// Distance from the swing axis at which the face ahead of a machine begins [m].
inline constexpr double kFaceBegins = control::kNearestDig + 0.3;
/// Sector ahead of the machine in which it digs, to both sides [rad].
inline constexpr double kSector = radians(75);

/// Returns the slope of the face that is left ahead of a machine [-]: that of the batter, at most
/// 1:1.
double face_slope(const control::PitJob& job);

/// A line along which a machine backs while it digs.
struct RetreatAxis {
  Vec2 through = Vec2::Zero();  ///< a point of the line in W [m]
  double heading = 0;           ///< heading of the machine, which faces the soil [rad]
  double right = 0, left = 0;   ///< columns farther aside belong to other axes [m]
};

/// Stations along axes, with the columns that none of them reaches.
struct Stations {
  std::vector<control::JobStation> stations;
  std::vector<PitColumn> unreachable;
  double lost = 0;  ///< volume of `unreachable` [m3]
};

/// Machine of a search.
struct Digger {
  const ArmReach& reach;
  double ring = 0;        ///< height of the swing ring in W on the ground of the pit [m]
  double axle_ahead = 0;  ///< distance of the swing axis ahead of the rear axle [m]
};

/// Rules of a search.
struct SearchRules {
  double sector = kSector;  ///< sector in which a machine digs, to both sides [rad]
  double step = 0.25;       ///< between candidates for stations [m]
  /// Soil that is less than this share of what belongs to an axis is no reason for a station [-].
  double least_share = 0;
  /// Distance from the swing axis at which soil is dug, at least [m]. If it is above 0, the last
  /// station of an axis with several stands as near to its soil as this allows.
  double nearest = 0;
};

/// Returns the stations from which all columns of a pit are dug, one axis after the other. At each
/// station the machine stands as far back as the farthest soil that is left allows, so that few
/// stations suffice.
Stations find_stations(const control::PitJob& job, const PitShape& pit, const Digger& digger,
                       const std::vector<RetreatAxis>& axes, const SearchRules& rules = {});

}  // namespace navvy::earthwork
