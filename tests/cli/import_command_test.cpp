// SPDX-License-Identifier: Apache-2.0
// `navvy import` as a process: its report, the files that it writes, and what it refuses.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "cli/program_run.h"

namespace navvy {
namespace {

class ImportCommand : public test::ProgramRun {
 protected:
  /// A cart with two wheels at the back, whose lamp of 0.1 m3 has a placeholder for a mass.
  std::string cart() {
    const auto link = [](const std::string& name, const std::string& mass,
                         const std::string& shape) {
      return "<link name='" + name + "'><inertial><mass value='" + mass +
             "'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial>"
             "<collision><geometry>" +
             shape + "</geometry></collision></link>\n";
    };
    const auto joint = [](const std::string& name, const std::string& child,
                          const std::string& more) {
      return "<joint name='" + name + "' type='continuous'><parent link='body'/><child link='" +
             child + "'/>" + more + "</joint>\n";
    };
    const std::string tyre = "<cylinder radius='0.2' length='0.1'/>",
                      box = "<box size='1 0.5 0.2'/>",
                      turned =
                          " 0' rpy='-1.5707963267948966 0 0'/><axis xyz='0 0 1'/>"
                          "<limit effort='10' velocity='5'/>";
    return write("cart.urdf",
                 "<robot name='cart'>\n" + link("body", "50", box) + link("lamp", "0.03", box) +
                     link("l", "2", tyre) + link("r", "2", tyre) +
                     joint("spin_l", "l", "<origin xyz='-0.4 0.3" + turned) +
                     joint("spin_r", "r", "<origin xyz='-0.4 -0.3" + turned) +
                     joint("turn", "lamp", "<origin xyz='0 0 1'/><axis xyz='0 0 1'/>") +
                     "<gazebo><plugin name='p' filename='f'/></gazebo></robot>\n");
  }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(directory_ / name) << text;
    return (directory_ / name).string();
  }
  void expect_said(const std::string& part) const {
    EXPECT_NE(said().find(part), std::string::npos) << "'" << part << "' is not in:\n"
                                                    << said() << complained();
  }
};

TEST_F(ImportCommand, PrintsItsReportAndWritesItBesideTheMachine) {
  const std::string file = cart();
  ASSERT_EQ(run({"import", file, "--out", out()}), 0) << complained();
  expect_said("made: wheel 'l' on joint 'spin_l', radius 0.2 m, width 0.1 m, driven; ");
  expect_said("made: a drive by the difference of sides, 1 m/s, 100 N\n");
  expect_said("kept: link 'lamp' has 0.03 kg in shapes of 0.1 m3, a placeholder; ");
  expect_said("dropped or assumed by the reader: " + file + ":9: warning: robot[cart]/gazebo: ");
  const std::string last = "machine: " + out() + "/model.sdf\n";
  expect_said(last);
  // IMPORT.md holds the same sentences, as a list.
  std::string list = "# Import of cart.urdf\n";
  std::istringstream sentences(said().substr(0, said().size() - last.size()));
  for (std::string one; std::getline(sentences, one);) list += "- " + one + "\n";
  EXPECT_EQ(test::text_of(out() + "/IMPORT.md"), list);
  EXPECT_NE(test::text_of(out() + "/masses.csv").find("lamp,0.03\n"), std::string::npos);
  EXPECT_EQ(run({"check", out() + "/model.sdf"}), 0) << said();
  expect_said("1 file checked: 0 errors");
}

TEST_F(ImportCommand, ReplacesPlaceholdersOfMassByADensity) {
  ASSERT_EQ(run({"import", cart(), "--out", out(), "--mass-from-density", "800"}), 0)
      << complained();
  expect_said("replaced: link 'lamp' has 0.03 kg in shapes of 0.1 m3, a placeholder: 80 kg by ");
  EXPECT_FALSE(std::filesystem::exists(out() + "/masses.csv"));
  EXPECT_NE(test::text_of(out() + "/model.sdf").find("<mass>80"), std::string::npos);
  EXPECT_EQ(run({"import", cart(), "--out", out(), "--mass-from-density", "0"}), 2);
  expect_complained("--mass-from-density");
}

TEST_F(ImportCommand, RefusesWorldsAndFoldersThatHoldAMachine) {
  const std::string world = write("world.sdf", "<sdf version='1.6'>\n<world name='w'/></sdf>\n");
  EXPECT_EQ(run({"import", world, "--out", out()}), 2);
  expect_complained(world +
                    ":1: error: sdf: 'sdf': only a file with one machine can be imported "
                    "(name the file of the model that a world includes)");
  EXPECT_FALSE(std::filesystem::exists(out()));
  ASSERT_EQ(run({"import", cart(), "--out", out()}), 0) << complained();
  const std::string before = test::text_of(out() + "/model.sdf");
  EXPECT_EQ(run({"import", cart(), "--out", out(), "--mass-from-density", "800"}), 2);
  expect_complained(out() +
                    "/model.sdf: error: --out: there is a machine already (name another "
                    "folder, or remove it)");
  EXPECT_EQ(test::text_of(out() + "/model.sdf"), before);
}

}  // namespace
}  // namespace navvy
