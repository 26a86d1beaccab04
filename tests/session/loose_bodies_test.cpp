// SPDX-License-Identifier: Apache-2.0
// Loose bodies of a scene as the check before a run and operators see them.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/program_check.h"

namespace navvy::session {
namespace {

/// A small tetrahedron: a body without a shell causes a warning.
const std::string kShell =
    "<navvy:shell name=\"s\"><link>body</link><vertices_m>0 0 0.1 0.2 0 0.1 0 0.2 0.1 0 0 0.3"
    "</vertices_m><triangles>0 2 1 0 1 3 0 3 2 1 2 3</triangles></navvy:shell>";

std::string block(const std::string& name, const std::string& pose, const std::string& size,
                  const std::string& more = "") {
  return "<model name=\"" + name + "\">" + more + "<pose>" + pose +
         "</pose><link name=\"body\"><navvy:density_kg_per_m3>2600</navvy:density_kg_per_m3>"
         "<collision name=\"c\"><pose>0 0 0.25 0 0 0</pose><geometry><box><size>" +
         size + "</size></box></geometry></collision></link>" + kShell + "</model>";
}

/// Returns the faults and notes of a crawler at (-3, 0) that clears an area ahead of it.
std::string check_of(const std::string& bodies, const std::string& polygon) {
  const scene::Scene scene = scene_io::load_scene_from_string(
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"c\"><navvy:soil ref=\"loam\"/>"
      "<navvy:ground><size_m>30 20</size_m></navvy:ground>" +
          bodies +
          "<include><uri>model://ex180_tracked</uri><name>digger</name><pose>-3 0 0 0 0 0</pose>"
          "<navvy:program><clear><polygon_m>" +
          polygon +
          "</polygon_m><dump_at_m>-1.5 5.5</dump_at_m></clear></navvy:program></include></world>"
          "</sdf>",
      navvy::source_dir() + "/scenarios/c.sdf", control::step_kinds());
  std::vector<std::string> notes;
  std::string all;
  for (const Fault& fault : check_programs(scene, {}, &notes)) all += fault.text() + "\n";
  for (const std::string& note : notes) all += note + "\n";
  return all;
}

const std::string kAhead = "1 -2 5 -2 5 2 1 2";

TEST(LooseBodies, AreThoseThatForcesMoveAndThatHaveNoJoints) {
  const std::string text =
      check_of(block("stone", "3 0 0 0 0 0.4", "0.5 0.4 0.5") +
                   block("wall", "3 1.5 0 0 0 0", "0.3 0.3 0.5", "<static>true</static>"),
               kAhead);
  EXPECT_EQ(text, "'digger', step 1 (clear): 1 body in the polygon\n");
}

TEST(LooseBodies, AreRefusedBeforeARunWhenTheyAreTooFarOrTooLargeOrTooHeavy) {
  EXPECT_NE(check_of(block("stone", "9 0 0 0 0 0", "0.5 0.5 0.5"), "1 -2 10 -2 10 2 1 2")
                .find("'stone' at (9.00 , 0.00 ): "),
            std::string::npos);
  EXPECT_NE(check_of(block("slab", "3 0 0 0 0 0", "1.4 0.5 0.5"), kAhead)
                .find("'slab' at (3.00 , 0.00 ): 1.40 m large"),
            std::string::npos);
  // 0.9 m of something as dense as lead.
  std::string lead = block("lead", "5 0 0 0 0 0", "0.9 0.9 0.5");
  lead.replace(lead.find("2600"), 4, "11300");
  const std::string heavy = check_of(lead, "1 -2 7 -2 7 2 1 2");
  EXPECT_NE(heavy.find("'lead' at (5.00 , 0.00 ): 4576.50 kg"), std::string::npos) << heavy;
  EXPECT_NE(heavy.find("the arm lifts at most "), std::string::npos) << heavy;
}

}  // namespace
}  // namespace navvy::session
