// SPDX-License-Identifier: Apache-2.0
#include "scene/step_kind.h"

#include <cstdio>

namespace navvy::scene {
namespace {

std::string pair_text(const Vec2& v) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.2f, %.2f)", v.x(), v.y());
  return text;
}

}  // namespace

void StepSource::require(bool fulfilled, const char* rule) const {
  if (machine && !machine->links.empty() && !fulfilled) error("", machine->name, rule);
}

void StepSource::on_site(const char* name, const Vec2& place) const {
  if (!ground || !has(name)) return;
  const Vec2 low = ground->origin, high = ground->origin + ground->size;
  if ((place.array() >= low.array()).all() && (place.array() <= high.array()).all()) return;
  error(name, written(name),
        "must lie on the site, " + pair_text(low) + " to " + pair_text(high) + " m",
        "move it, or enlarge size_m of the ground");
}

}  // namespace navvy::scene
