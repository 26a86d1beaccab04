// SPDX-License-Identifier: Apache-2.0
#include "coupling/hitching.h"

#include <array>
#include <cstdio>

#include "core/error.h"

namespace navvy::coupling {

// Checks the distance here, where file and line are known.
void add_hitches(const scene::Scene& scene, vehicle::PhysicsEngine& engine,
                 const std::function<int(int)>& index) {
  if (scene.hitches.empty()) return;
  vehicle::HitchCapability& hitches = vehicle::require_hitches(engine);
  for (const scene::Hitch& hitch : scene.hitches) {
    const int parent = index(hitch.parent), child = index(hitch.child);
    const Vec3 hook = engine.link(parent, hitch.parent_link).X_WL * hitch.hook;
    const Vec3 eye = engine.link(child, hitch.child_link).X_WL * hitch.eye;
    if (hitch.closed && (eye - hook).norm() > vehicle::kHitchReach) {
      std::array<char, 160> text{};
      std::snprintf(text.data(), text.size(),
                    "hook at %.3f %.3f %.3f, eye at %.3f %.3f %.3f m in W", hook.x(), hook.y(),
                    hook.z(), eye.x(), eye.y(), eye.z());
      std::array<char, 160> remedy{};
      std::snprintf(remedy.data(), remedy.size(),
                    "add %.3f %.3f to the <pose> of '%s', or start it with <closed>false</closed>",
                    (hook - eye).x(), (hook - eye).y(),
                    scene.machines[static_cast<std::size_t>(hitch.child)].name.c_str());
      throw InputError(Fault{Fault::Severity::kError, scene.file, hitch.line,
                             "navvy:hitch[" + hitch.name + "]", text.data(),
                             "a hitch that starts closed needs its eye within 0.1 m of the hook",
                             remedy.data()});
    }
    hitches.add_hitch(hitch, parent, child);
  }
}

}  // namespace navvy::coupling
