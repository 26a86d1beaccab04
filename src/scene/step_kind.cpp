// SPDX-License-Identifier: Apache-2.0
#include "scene/step_kind.h"

namespace navvy::scene {
namespace {

/// A place as "(x, y)" with two digits after the point.
std::string pair(const Vec2& v) {
  const std::string x = std::to_string(v.x()), y = std::to_string(v.y());
  return "(" + x.substr(0, x.find('.') + 3) + ", " + y.substr(0, y.find('.') + 3) + ")";
}

}  // namespace

void StepSource::require(bool fulfilled, const char* rule) const {
  if (machine && !machine->links.empty() && !fulfilled) fields.error("", machine->name, rule);
}

void StepSource::on_site(const char* name, const Vec2& place) const {
  if (!ground || !fields.has(name)) return;
  const Vec2 low = ground->origin, high = ground->origin + ground->size;
  if ((place.array() >= low.array()).all() && (place.array() <= high.array()).all()) return;
  fields.error(name, fields.written(name), "must lie on the site, " + pair(low) + " to " + pair(high) + " m",
               "move it, or enlarge size_m of the ground");
}

}  // namespace navvy::scene
