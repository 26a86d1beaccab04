// SPDX-License-Identifier: Apache-2.0
#include "vehicle/physics_engine.h"

#include <string>

#include "core/error.h"

namespace navvy::vehicle {

BaseInput base_target(PhysicsEngine& engine, int machine) {
  if (const PlacementCapability* placement = engine.placement()) return placement->base(machine);
  const Pose X = engine.link(machine, 0).X_WL;
  BaseInput out;
  out.p_W = X.translation();
  out.angles = fixed_angles(X.linear());
  return out;
}

PlacementCapability& require_placement(PhysicsEngine& engine, int machine) {
  if (PlacementCapability* placement = engine.placement()) return *placement;
  throw InputError(
      Fault{Fault::Severity::kError, "", 0, "machine", std::to_string(machine),
            "forces move this machine, so its base cannot be placed",
            "set <navvy:physics>kinematic</navvy:physics>, or command its joints and drive"});
}

HitchCapability& require_hitches(PhysicsEngine& engine) {
  if (HitchCapability* hitches = engine.hitches()) return *hitches;
  throw InputError(
      Fault{Fault::Severity::kError, "", 0, "hitch", "",
            "this physics engine cannot couple machines: a hitch needs dynamic machines",
            "set <navvy:physics>dynamic</navvy:physics>, or place the machine by its pose"});
}

std::vector<terramechanics::TrackPatch> track_patches(const PhysicsEngine& engine, int machine,
                                                      int wheel) {
  const TrackCapability* tracks = engine.tracks();
  if (tracks == nullptr) return {};
  return tracks->track_patches(machine, wheel);
}

}  // namespace navvy::vehicle
