// SPDX-License-Identifier: Apache-2.0
// Small setups shared by the soil tests: the laboratory's site, soils and shells.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/saved_state.h"
#include "device/device.h"
#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/soils.h"
#include "soil/particles/soil_table.h"
#include "values.h"

namespace navvy::soil::rig {

using lab::blade;
using lab::open_box;
using lab::SiteBox;

inline scene::Soil sand(double friction_degrees = 33) { return lab::clean_sand(friction_degrees); }

/// One flat site (surface at z = 0, bedrock 4 m below, corner at `origin`) with an optional pit
/// that particles will fill.
class Rig : public lab::Site {
 public:
  explicit Rig(const std::vector<scene::Soil>& soils, const SiteBox& pit = {}, double cell = 0.1,
               int cells = 200, const Vec2& origin = Vec2::Zero())
      : Site(device(), soils, cell, options(pit, cell * cells, origin)) {}

  /// Returns one device for all tests of a program: kernels build once.
  static device::Device& device() {
    static device::Device shared;
    return shared;
  }
  double datum() const { return ground().datum(); }
  /// Returns particles on a lattice of half a cell; `depth_stress`: with the stress of resting
  /// ground whose top is the box's.
  std::vector<Particle> fill(const SiteBox& box, bool depth_stress = false, int soil = 0) const {
    std::vector<Particle> out = Site::fill(box, {}, soil);
    if (depth_stress) rest(out, box.high.z());
    return out;
  }
  /// Steps without tools for `seconds` at the step limit; returns the step.
  double run(double seconds) {
    const std::uint64_t before = solver().stats().steps;
    Site::run(seconds);
    return seconds / static_cast<double>(solver().stats().steps - before);
  }
  std::uint64_t digest() const { return hash_of(solver()).digest(); }

 private:
  static lab::SiteOptions options(const SiteBox& pit, double size, const Vec2& origin) {
    lab::SiteOptions out;
    out.size = size;
    out.corner = origin;
    out.surface = lab::pit(pit);
    return out;
  }
};

}  // namespace navvy::soil::rig
