// SPDX-License-Identifier: Apache-2.0
// Tools that stand on the ground: when their resting contact starts and ends
// [docs/tools.md, resting contact].
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

/// Manages the resting contacts of all tools of a solver.
///
/// A resting contact starts when a tool that is not scripted has stood still long enough on
/// particles that carry it, with no soil on top of it. From then on the ground under the tool may
/// become columns, which exert no force on tools; the contact carries the tool instead. The contact
/// ends when the tool moves, is overloaded or gets soil on top, or when the ground under it becomes
/// particles again.
class StandingTools {
 public:
  /// Starts without tools. All arguments are only read and must outlive this object.
  StandingTools(const scene::Scene& world, const heightfield::Ground& ground,
                const GridFrame& frame, const Contact& contact)
      : world_(world), ground_(ground), frame_(frame), nodal_contact_(contact) {}

  /// Adds one tool. Tools must be added in the same order as with Contact::add_tool.
  void add_tool() { contacts_.emplace_back(); }
  /// Starts the contact of tools that have come to rest, and ends the contact of tools with soil on
  /// top. `elapsed`: simulated time since the last call [s]; `regions`: parallel to `motions`;
  /// `all`: all particles, each in the block that contains its position.
  void update(double elapsed, std::span<const ToolMotion> motions,
              std::span<const ToolRegion> regions, std::span<const Particle> all);
  /// Returns true while the resting contact of tool `tool` is engaged.
  bool supports(int tool) const { return contacts_[static_cast<std::size_t>(tool)].engaged; }
  /// Ends the contact of every supported tool whose box contains, in plan, one of the new particles
  /// `born`.
  void release(std::span<const ToolRegion> regions, std::span<const Particle> born);
  /// Adds the impulses of the resting contacts in a step of dt [s] to `impulses`. Call it after the
  /// impulses of the soil have been added. Returns true when a contact ended; the exchange must
  /// then be checked as soon as possible.
  bool apply(double dt, std::span<const ToolMotion> motions, std::span<ToolImpulse> impulses);

  /// Visits the resting contact of each tool.
  void visit(Archive& a);

 private:
  /// Returns the unit normal in W of the ground under a tool. The ground is the surface of the
  /// columns with the particles on them.
  Vec3 ground_normal(const scene::Shell& shell, const ToolMotion& motion, const ToolRegion& region,
                     std::span<const Particle> all) const;
  /// Returns the gradient (dz/dx, dz/dy) of the plane that best fits the ground in the rectangle
  /// `from` .. `to` of W [m].
  Vec2 ground_gradient(const Vec2& from, const Vec2& to, std::span<const Particle> all) const;
  /// Returns true if a particle is on top of the tool, as seen along the ground normal `up`.
  bool soil_on_tool(const scene::Shell& shell, const ToolMotion& motion, const Vec3& up,
                    std::span<const Particle> all) const;

  /// Scene, for the friction of soil on tools.
  const scene::Scene& world_;
  /// Columns of the site.
  const heightfield::Ground& ground_;
  /// Grid frame of the particles.
  const GridFrame& frame_;
  /// Contact with the soil's nodes, for shells and reported forces.
  const Contact& nodal_contact_;
  /// One resting contact per tool, by tool index.
  std::vector<RestingContact> contacts_;
};

}  // namespace navvy::soil
