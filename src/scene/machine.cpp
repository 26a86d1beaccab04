// SPDX-License-Identifier: Apache-2.0
#include "scene/machine.h"

#include <algorithm>

#include "core/hash.h"

namespace navvy::scene {
namespace {

// A shell that no bucket or bed names holds nothing that counts as a load.
template <class Container>
bool names_shell(const std::vector<Container>& containers, const Shell& shell) {
  return std::any_of(containers.begin(), containers.end(),
                     [&](const Container& c) { return c.shell == shell.name; });
}

}  // namespace

std::string Shell::surface_hash() const {
  StateHash sum;
  for (const Vec3& vertex : vertices) sum.bytes(vertex.data(), sizeof vertex);
  for (const auto& triangle : triangles) sum.bytes(triangle.data(), sizeof triangle);
  return sum.hex();
}

Shell Machine::with_teeth(const Shell& shell) const {
  Shell out = shell;
  for (const Bucket& bucket : buckets)
    if (bucket.shell == shell.name) {
      // A straight edge is one tooth as wide as the bucket.
      const Teeth straight{1, bucket.width, 0, shell.edge_bevel};
      out.toothed = ToothedEdge{bucket.teeth.value_or(straight), bucket.p_tip, bucket.cut_direction,
                                bucket.width};
    }
  return out;
}

double Machine::total_mass() const {
  double sum = 0;
  for (const Link& link : links) sum += link.mass;
  return sum;
}

int Machine::link_index(const std::string& name_of_link) const {
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i].name == name_of_link) return static_cast<int>(i);
  return -1;
}

bool Machine::has_sensors() const {
  return std::any_of(links.begin(), links.end(),
                     [](const Link& link) { return !link.sensors.empty(); });
}

bool Machine::is_bucket(int shell) const {
  return names_shell(buckets, shells.at(static_cast<std::size_t>(shell)));
}
bool Machine::is_bed(int shell) const {
  return names_shell(beds, shells.at(static_cast<std::size_t>(shell)));
}

int Machine::joint_index(const std::string& name_of_joint) const {
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i].name == name_of_joint) return static_cast<int>(i);
  return -1;
}

}  // namespace navvy::scene
