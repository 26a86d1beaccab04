// SPDX-License-Identifier: Apache-2.0
// Scheme constants on the device, and the order in which a solver visits its state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "soil/rig.h"
#include "soil/scheme.h"

namespace navvy::soil {
namespace {

using rig::Rig;

/// Hash of a block of clay that falls onto the floor of a pit beside a blade, under these
/// constants. The floor is between two planes of nodes, so that the held margin decides which nodes
/// it holds.
std::string digest_with(const SchemeConstants& scheme) {
  const lab::SiteBox pit{Vec3(4, 4, -0.42), Vec3(5, 5, 0)};
  lab::SiteOptions options;
  options.size = 10;
  options.corner = Vec2::Zero();
  options.surface = lab::pit(pit);
  options.scheme = scheme;
  scene::Soil soil = lab::cohesive(25, 2000);
  soil.swell = 1.2;
  lab::Site site(Rig::device(), {soil}, 0.1, options);
  std::vector<Particle> block = site.fill({Vec3(4, 4, -0.3), Vec3(5, 5, 0.1)});
  for (Particle& p : block) p.v[2] = -1;
  site.solver().insert(block);
  const int tool = site.add_tool(rig::blade(0.6, 0.5), make_pose(4.2, 4.5, -0.2));
  site.tool(tool).motion.v_WT = Vec3(1, 0, 0);
  site.run(0.15);
  return site.digest();
}

TEST(SchemeConstants, ChangeTheSoilWhateverCarriesThemToTheKernels) {
  const std::string standard = digest_with({});
  EXPECT_EQ(digest_with(kScheme), standard);
  // A literal of the law, a kernel's argument, the host's, the contact's.
  const std::vector<std::pair<const char*, double>> changes = {
      {"volume_damping", 5},      {"mixing_strain", 0.05},  {"shear_damping", 0.1},
      {"transfer_length", 1},     {"held_margin", 0.1},     {"contact_reach", 0.9},
      {"min_free_fraction", 0.5}, {"contact_settling", 0.1}};
  for (const auto& [name, value] : changes) {
    SchemeConstants scheme;
    set_scheme_constant(scheme, name, value);
    EXPECT_NE(digest_with(scheme), standard) << name;
  }
}

/// Last names of the fields of a state, each once, in the order in which they are visited.
std::vector<std::string> field_order(const Solver& solver) {
  ByteMap map;
  saved(solver, &map);
  std::vector<std::string> out;
  for (const ByteMap::Field& field : map.fields) {
    std::string name = field.path.substr(field.path.rfind('/') + 1);
    name = name.substr(0, name.find('['));
    if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
  }
  return out;
}

TEST(SoilSolver, VisitsItsPartsInTheOrderOfTheFormat) {
  Rig rig({rig::sand()});
  rig.solver().insert(rig.fill({Vec3(5, 5, 0), Vec3(5.4, 5.4, 0.3)}));
  rig.add_tool(rig::blade(0.6, 0.5), make_pose(5.2, 5.2, 0.1));
  rig.step(0.001);
  // One field of each part and all of the solver's own; another order is another format and hash.
  const std::vector<std::string> expected = {"blocks_changed",
                                             "drift",
                                             "time",
                                             "since_check",
                                             "travel",
                                             "steps_since_check",
                                             "first_check",
                                             "next_id",
                                             "left_site",
                                             "inserted",
                                             "particle_steps",
                                             "X_listed",
                                             "still",
                                             "open",
                                             "motion",
                                             "front",
                                             "back"};
  std::vector<std::string> found;
  for (const std::string& name : field_order(rig.solver()))
    if (std::find(expected.begin(), expected.end(), name) != expected.end()) found.push_back(name);
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace navvy::soil
