// SPDX-License-Identifier: Apache-2.0
// Tools that stand on the ground: start and end of their contact [docs/tools.md, resting contact].
#pragma once

#include <span>
#include <vector>

#include "scene/scene.h"
#include "soil/grid_frame.h"
#include "soil/tools/contact.h"
#include "soil/tools/resting_contact.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

/// The resting contacts of all tools of a solver.
///
/// A contact starts when a tool that yields has stood still for long enough on particles that carry
/// it, and no soil lies on it. From then on the ground under it may become columns, which do not
/// push on tools. It ends when the tool moves, is overloaded, gets soil on top, or the ground below
/// becomes particles again.
class StandingTools {
 public:
  /// Observes the ground; all arguments must outlive it.
  StandingTools(const scene::Scene& world, const heightfield::Ground& ground,
                const GridFrame& frame, const Contact& contact)
      : world_(world), ground_(ground), frame_(frame), nodal_contact_(contact) {}

  /// Adds one more tool, in the order of Contact::add_tool.
  void add_tool() { contacts_.emplace_back(); }
  /// Begins the contact of tools that have come to rest, and ends it where soil lies on the tool.
  /// `elapsed`: since the last call [s]; `regions` parallel to the motions; `all`: every particle,
  /// by cell.
  void update(double elapsed, std::span<const ToolMotion> motions,
              std::span<const ToolRegion> regions, std::span<const Particle> all);
  /// Returns true while the ground supports the tool.
  bool supports(int tool) const { return contacts_[static_cast<std::size_t>(tool)].engaged; }
  /// Ends the contact of tools under which ground became particles (`born`).
  void release(std::span<const ToolRegion> regions, std::span<const Particle> born);
  /// Adds the impulses of the contacts to `impulses`, after all else has acted in a step of dt [s].
  /// Returns true when a contact ended, so that the exchange must be checked at once.
  bool apply(double dt, std::span<const ToolMotion> motions, std::span<ToolImpulse> impulses);

  /// Visits the contacts, one per tool.
  void visit(Archive& a);

 private:
  /// Returns the normal of the ground under a tool: columns, and soil on them.
  Vec3 ground_normal(const scene::Shell& shell, const ToolMotion& motion, const ToolRegion& region,
                     std::span<const Particle> all) const;
  /// Returns the gradient of the plane that fits the ground best in a rectangle of the plan.
  Vec2 ground_gradient(const Vec2& from, const Vec2& to, std::span<const Particle> all) const;
  /// Returns true if a particle lies on the tool, seen along the normal `up`.
  bool soil_on_tool(const scene::Shell& shell, const ToolMotion& motion, const Vec3& up,
                    std::span<const Particle> all) const;

  const scene::Scene& world_;
  const heightfield::Ground& ground_;
  const GridFrame& frame_;
  const Contact& nodal_contact_;
  /// Contacts by tool.
  std::vector<RestingContact> contacts_;
};

}  // namespace navvy::soil
