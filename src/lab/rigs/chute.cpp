// SPDX-License-Identifier: Apache-2.0
#include "lab/rigs/chute.h"

#include <cmath>

#include "lab/soils.h"

namespace navvy::lab {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// Appends a side plate: triangles over vertices that alternate between y = 0 (even) and y = gap
/// (odd). `corners` are those at y = 0, in an order whose normal faces +y.
void add_sides(scene::Shell& s, const Triangles& corners) {
  for (const auto& t : corners) {
    s.triangles.push_back({2 * t[0], 2 * t[1], 2 * t[2]});
    s.triangles.push_back({2 * t[0] + 1, 2 * t[2] + 1, 2 * t[1] + 1});
  }
}

/// Adds one corner of both side plates. They are offset by half their thickness: faces, not
/// mid-planes, bound the soil.
void add_pair(scene::Shell& s, const ChuteShape& c, double x, double z) {
  s.vertices.emplace_back(x, -c.half, z);
  s.vertices.emplace_back(x, c.gap + c.half, z);
}

/// Adds the strip between corners a and b of both sides; its normal follows from their order.
void add_strip(scene::Shell& s, int a, int b) {
  s.triangles.push_back({2 * a, 2 * a + 1, 2 * b + 1});
  s.triangles.push_back({2 * a, 2 * b + 1, 2 * b});
}

// Four blocks are enough for the middle to be plane; a block on either side separates it from the
// plates.
/// In the middle of a chute with friction.
constexpr double kRoughBlocks = 4;

}  // namespace

scene::Shell blade_chute(const ChuteShape& c) {
  scene::Shell s;
  s.name = "chute";
  s.half_thickness = c.half;
  // The plates stand on the blade's ends, so that blade and plates form one surface without a gap.
  const double lean = -c.height / std::tan(c.rake);
  // Of the edge's mid-plane.
  const double x = -c.half / std::sin(c.rake);
  // 0: cutting edge.
  add_pair(s, c, x, 0);
  // 1: the blade's upper edge.
  add_pair(s, c, x + lean, c.height);
  add_pair(s, c, c.ahead, c.top);
  add_pair(s, c, c.ahead, c.bottom);
  add_pair(s, c, -c.back, c.bottom);
  add_pair(s, c, -c.back, 0.25 * c.height);
  add_sides(s, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}});
  add_strip(s, 0, 1);
  return s;
}

scene::Shell chute_sides(const ChuteShape& c) {
  scene::Shell s;
  s.name = "sides";
  s.half_thickness = c.half;
  // Smooth for any soil: the force on the blade's shell along its face is then that of the blade
  // alone.
  s.friction_share = s.adhesion_share = 0;
  add_pair(s, c, -c.back, c.bottom);
  add_pair(s, c, -c.back, c.top);
  add_pair(s, c, c.ahead, c.top);
  add_pair(s, c, c.ahead, c.bottom);
  add_sides(s, {{0, 1, 2}, {0, 2, 3}});
  return s;
}

scene::Shell chute_blade(const ChuteShape& c) {
  scene::Shell s;
  // From plate mid-plane to plate mid-plane, so that no soil passes its ends.
  s.name = "blade";
  s.half_thickness = c.half;
  const double x = -c.half / std::sin(c.rake);
  add_pair(s, c, x, 0);
  add_pair(s, c, x - c.height / std::tan(c.rake), c.height);
  add_strip(s, 0, 1);
  return s;
}

scene::Shell footing_chute(const ChuteShape& c, double breadth) {
  scene::Shell s;
  s.name = "footing";
  s.half_thickness = c.half;
  // Four corners of the stem and four of the pit; the sides are a fan around the footing.
  const double half = breadth / 2;
  add_pair(s, c, -half, 0);
  add_pair(s, c, half, 0);
  add_pair(s, c, half, c.top);
  add_pair(s, c, c.ahead, c.top);
  add_pair(s, c, c.ahead, c.bottom);
  add_pair(s, c, -c.ahead, c.bottom);
  add_pair(s, c, -c.ahead, c.top);
  add_pair(s, c, -half, c.top);
  add_sides(s, {{1, 2, 3}, {1, 3, 4}, {1, 4, 0}, {0, 4, 5}, {0, 5, 6}, {0, 6, 7}});
  // The sole, then both flanks of the stem.
  // Faces down.
  add_strip(s, 0, 1);
  add_strip(s, 1, 2);
  add_strip(s, 7, 0);
  return s;
}

double chute_offset(double cell) { return 0.07 * cell; }

// Measured, see the header: the force does not depend on it any more.
double chute_width(double cell) { return 8 * cell; }

double chute_half(double cell) { return 0.25 * cell; }

double chute_gap(const Setup& setup, double& share) {
  const bool rough = setup.soil.tool_friction_angle > 0 || setup.soil.adhesion > 0;
  const double block = soil::kBlockCells * setup.cell;
  // Share of the width that carries tool friction; none for a smooth tool.
  share = rough ? kRoughBlocks / (kRoughBlocks + 2) : 0;
  // Smooth plates need only a few cells: nothing varies across them.
  return rough ? (kRoughBlocks + 2) * block : 5 * setup.cell;
}

std::vector<scene::Soil> chute_soils(const scene::Soil& soil) {
  scene::Soil smooth = without_tool_friction(soil);
  smooth.name += "-smooth";
  return {soil, smooth};
}

SiteOptions chute_site(const Setup& setup, const ChuteBed& bed, double gap) {
  const double cell = setup.cell, margin = 2 * cell;
  SiteOptions out;
  out.energy = setup.energy;
  // Twice a whole number of blocks: a block begins at y = 0.
  const double block = soil::kBlockCells * cell;
  out.size =
      2 * block * std::ceil((std::max(bed.back, std::max(bed.ahead, gap)) + 2 * block) / block);
  out.depth = bed.below + 8 * cell;
  out.surface = pit({Vec3(-bed.back, -margin, -bed.below), Vec3(bed.ahead, gap + margin, 0)});
  return out;
}

std::vector<soil::Particle> chute_fill(const Site& site, const ChuteBed& bed, double gap,
                                       bool rough, const std::function<bool(const Vec3&)>& keep,
                                       const std::function<double(double, double)>& surface) {
  const double cell = site.cell(), inset = chute_offset(cell), block = soil::kBlockCells * cell;
  // Soil fills only the chute; the margin outside the plates stays empty.
  const SiteBox box{Vec3(-bed.back, inset, -bed.below), Vec3(bed.ahead, inset + gap, 0)};
  auto out = site.fill(box, keep, rough ? 0 : 1);
  if (rough)
    for (soil::Particle& p : out) {
      const double y = site.position(p).y();
      // The smooth variant of the same soil lies against the plates.
      if (y < block || y > gap - block) p.soil = 1;
    }
  // Both variants have the same weight: one stress at rest for all.
  site.rest(out, surface);
  return out;
}

}  // namespace navvy::lab
