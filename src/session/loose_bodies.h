// SPDX-License-Identifier: Apache-2.0
// Loose bodies of a world, such as stones, as operators see them. Private to the session.
#pragma once

#include <functional>
#include <vector>

#include "control/body_view.h"
#include "core/math.h"
#include "scene/scene.h"
#include "sim/world.h"

namespace navvy::session {

/// Lists the loose bodies of a scene once, with the boxes around their shapes, and shows where they
/// are. A body is loose if it is one link without joints, drive, program or hitch that forces move.
class LooseBodies {
 public:
  /// Finds the loose bodies; meshes are read once.
  explicit LooseBodies(const scene::Scene& scene);

  /// Returns the bodies with their base links at the poses `X_WB` in W, one per machine of the
  /// scene.
  std::vector<control::BodyView> at(const std::vector<Pose>& X_WB) const;
  /// Returns the bodies of a running world at present.
  std::vector<control::BodyView> in(const sim::World& world) const;

 private:
  // A loose body in the frame of its link L.
  struct Body {
    // Index in scene::Scene::machines.
    std::size_t machine = 0;
    // Middle of the box around its shapes [m].
    Vec3 middle_L = Vec3::Zero();
    // Name, size and mass.
    control::BodyView view;
  };
  std::vector<Body> bodies_;
};

}  // namespace navvy::session
