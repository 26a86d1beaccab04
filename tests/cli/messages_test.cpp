// SPDX-License-Identifier: Apache-2.0
// Messages of the program about mistakes on its command line and in scenes, and about shipped data.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "cli/program_run.h"

namespace navvy {
namespace {

class Messages : public test::ProgramRun {
 protected:
  /// A scene of flat loam with `machines` in it.
  std::string scene(const std::string& ground, const std::string& machines) {
    const std::string path = (directory_ / "scene.sdf").string();
    std::ofstream(path) << "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world "
                           "name=\"w\"><navvy:soil ref=\"loam\"/>\n"
                        << "<navvy:ground><size_m>40 20</size_m>" << ground << "</navvy:ground>\n"
                        << machines << "</world></sdf>\n";
    return path;
  }
  static std::string machine(const std::string& name, const std::string& pose) {
    return "<include><uri>model://ew180</uri><name>" + name + "</name><pose>" + pose +
           "</pose></include>\n";
  }
  void expect_said(const std::string& part) const {
    EXPECT_NE(said().find(part), std::string::npos) << "'" << part << "' is not in:\n"
                                                    << said() << complained();
  }
};

TEST_F(Messages, ListShippedDataWithOneLineEach) {
  EXPECT_EQ(run({"scenes"}), 0);
  expect_said("trench");
  expect_said("An 18 t wheeled excavator drives 5 m to its place");
  EXPECT_EQ(run({"machines"}), 0);
  expect_said("\new180  ");
  expect_said("  Wheeled excavator of the 18 t class.");
  EXPECT_EQ(run({"soils"}), 0);
  expect_said("loam");
}

TEST_F(Messages, ReportEveryValueOfASoilWithItsUnit) {
  EXPECT_EQ(run({"soils", "loam"}), 0);
  expect_said("bank_density_kg_per_m3");
  expect_said("friction_angle_deg");
  expect_said("janosi_k_m");
  // Each test on loam with phi 30 deg, and phi if that test had measured 30 deg.
  expect_said("    direct_shear         26.6   35.3\n");
  expect_said("    triaxial             26.6   33.7\n");
  expect_said("    repose               26.6   35.3\n");
  EXPECT_EQ(run({"soils", "loem"}), 2);
  expect_complained("did you mean 'loam'?");
  EXPECT_EQ(run({"soils", "dry_sand"}), 2);
  expect_complained("did you mean 'sand_dry'?");
}

TEST_F(Messages, ListTheComponentsOfAMachine) {
  EXPECT_EQ(run({"machines", "ew180"}), 0) << complained();
  expect_said("Wheeled excavator of the 18 t class.");
  expect_said("vehicles/ew180/model.sdf\n");
  expect_said("  mass: 1");  // 10 to 19 t
  expect_said("  links: ");
  expect_said("  joints: ");
  expect_said("revolute, ");
  expect_said(" deg\n");
  expect_said("m3 heaped, cuts ");
  expect_said("  wheels: ");
  expect_said("  drive: ackermann, ");
  expect_said(" kW\n");
  EXPECT_EQ(run({"machines", "ew81"}), 2);
  expect_complained("no such shipped machine");
  expect_complained("did you mean 'ew180'?");
}

TEST_F(Messages, StateTheArgumentsThatACommandNeeds) {
  EXPECT_EQ(run({"check"}), 2);
  expect_complained(
      "`navvy check` needs files: SDF files, or names of shipped scenes (navvy check --help)");
  EXPECT_EQ(run({"run"}), 2);
  expect_complained("`navvy run` needs ");
}

TEST_F(Messages, NameTheSeverityOfAWarningOnce) {
  const std::string file = scene("<slope><angle_deg>0.2618</angle_deg></slope>", "");
  EXPECT_EQ(run({"run", file, "--no-render", "--duration", "0.01", "--out", out()}), 0)
      << complained();
  // Editors expect file and line first.
  expect_complained(file + ":2: warning: ");
  EXPECT_EQ(complained().find("warning: " + file), std::string::npos) << complained();
  // A message without a severity also begins with the file.
  EXPECT_EQ(run({"check", file}), 0);
  expect_said(file + ":2: warning: ");
  EXPECT_EQ(said().find("warning: " + file), std::string::npos) << said();
}

TEST_F(Messages, CountEveryFault) {
  std::string things;
  for (int i = 0; i < 3000; ++i) things += "<thing/>\n";
  EXPECT_EQ(run({"check", scene("", things)}), 2);
  expect_said("and 2900 more that are not shown");
  expect_said("1 file checked: 3000 errors, 0 warnings");
}

TEST_F(Messages, SuggestTheNearestName) {
  EXPECT_EQ(run({"chekc", "trench"}), 2);
  expect_complained("did you mean 'check'?");
  EXPECT_EQ(run({"run", "trnch"}), 2);
  expect_complained("did you mean 'trench'?");
  EXPECT_EQ(run({"check", "trnch"}), 2);
  expect_said("did you mean 'trench'?");
  EXPECT_EQ(run({"run", "trench", "--durration", "5"}), 2);
  expect_complained("'--durration'");
  expect_complained("did you mean '--duration'?");
  EXPECT_EQ(run({"check", scene("", "<include><uri>model://ew18</uri></include>")}), 2);
  expect_said("did you mean 'model://ew180'?");
}

TEST_F(Messages, ReportAWrongSeedInOneLine) {
  for (const std::string wrong : {"abc", "-1", "1.5"}) {
    EXPECT_EQ(run({"run", "trench", "--seed", wrong}), 2);
    const std::string text = complained();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    expect_complained("--seed");
    expect_complained(wrong);
    expect_complained("whole number");
  }
}

TEST_F(Messages, ALoopOfLinksIsNoInternalError) {
  const std::string loop = (directory_ / "loop.sdf").string();
  std::filesystem::create_symlink("loop.sdf", loop);
  EXPECT_EQ(run({"run", loop}), 2);
  expect_complained("loop.sdf: error: cannot be read: ");
  expect_complained("Too many levels of symbolic links");
  EXPECT_EQ(run({"check", loop}), 2);
  expect_said("Too many levels of symbolic links");
  EXPECT_EQ(run({"map", loop, "--format", "nav2", "--out", out()}), 2);
  expect_complained("Too many levels of symbolic links");
}

TEST_F(Messages, NumbersOfOptionsAreFinite) {
  for (const std::string wrong : {"nan", "inf", "0", "-1", "1e9", "1x"}) {
    EXPECT_EQ(run({"run", "trench", "--publish", out(), "--publish-rate", wrong}), 2) << wrong;
    expect_complained("must be a number from 0.001 to 10000");
    EXPECT_EQ(run({"run", "trench", "--control", "stdio", "--control-rate", wrong}), 2) << wrong;
    expect_complained("must be a number from 0.001 to 100000");
  }
  for (const std::string wrong : {"nan,1", "1,inf", "1e400,1"}) {
    EXPECT_EQ(run({"run", "trench", "--size", wrong}), 2) << wrong;
    expect_complained("two numbers in metres");
  }
}

TEST_F(Messages, CheckStatesTheCostOfALargeSite) {
  const std::string large = (directory_ / "large.sdf").string();
  std::ofstream(large) << "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\">"
                          "<navvy:soil ref=\"loam\"/><navvy:ground><size_m>3200 3200</size_m>"
                          "</navvy:ground></world></sdf>";
  EXPECT_EQ(run({"check", large}), 0) << said();
  expect_said("the site has 1.02e+09 columns: each of terrain_start.tif and terrain_end.tif takes");
  expect_said("up to 4.1 GB");
  EXPECT_EQ(run({"check", "trench"}), 0);
  EXPECT_EQ(said().find("columns"), std::string::npos) << said();
}

TEST_F(Messages, CheckFindsShippedScenesByName) {
  EXPECT_EQ(run({"check", "trench", "bucket_path.sdf"}), 0) << said();
  expect_said("2 files checked: 0 errors");
  // `check` reports how the excavator stands without a device.
  expect_said("'excavator' stands: tilt 0.");
  expect_said("within its support polygon");
}

TEST_F(Messages, CheckWarnsOfNothingInThePapersScenes) {
  std::vector<std::string> command = {"check"};
  for (const auto& entry :
       std::filesystem::directory_iterator(navvy::source_dir() + "/scenarios/paper"))
    if (entry.path().extension() == ".sdf") command.push_back(entry.path().string());
  ASSERT_GT(command.size(), 10u);
  EXPECT_EQ(run(command), 0) << said();
  expect_said(std::to_string(command.size() - 1) + " files checked: 0 errors, 0 warnings");
}

TEST_F(Messages, CheckDoesNotReportAFallingMachineAsStanding) {
  EXPECT_EQ(
      run({"check",
           scene("",
                 "<include><uri>model://ew180</uri><name>digger</name><pose>0 0 8 0 0 0</pose>"
                 "<navvy:on_ground>false</navvy:on_ground></include>")}),
      0)
      << said();
  expect_said("'digger' does not stand after a second: it is still falling");
}

TEST_F(Messages, CheckOfAMachineAloneReportsHowItStands) {
  const std::string vehicles = navvy::source_dir() + "/vehicles/";
  EXPECT_EQ(run({"check", vehicles + "ew180/model.sdf"}), 0) << said();
  expect_said("' stands: tilt 0.");
  expect_said("1 file checked: 0 errors, 0 warnings");
  EXPECT_EQ(run({"check", vehicles + "ew180/model.sdf", "--soil", "loam", "--size", "30,30"}), 0)
      << said();
  expect_said("' stands: tilt ");
  // Its drawbar has no wheel below it; in a scene a hitch holds it.
  EXPECT_EQ(run({"check", vehicles + "robot_trailer/model.sdf"}), 0) << said();
  expect_said("0 errors");
  EXPECT_EQ(run({"check", vehicles + "ew180/model.sdf", "--soil", "lom"}), 2) << said();
  expect_said("loam");
}

TEST_F(Messages, CheckOfAForeignRobotReportsHowItStands) {
  const std::string file = (directory_ / "walker.urdf").string();
  const auto link = [](const std::string& name, const std::string& size) {
    return "<link name=\"" + name +
           "\"><inertial><mass value=\"5\"/><inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.1\" "
           "iyz=\"0\" izz=\"0.1\"/></inertial><collision><geometry><box size=\"" +
           size + "\"/></geometry></collision></link>";
  };
  std::ofstream(file) << "<robot name=\"walker\">" << link("body", "0.6 0.4 0.3")
                      << link("head", "0.2 0.2 0.2")
                      << "<joint name=\"neck\" type=\"revolute\"><parent link=\"body\"/><child "
                         "link=\"head\"/><origin xyz=\"0 0 0.3\"/><axis xyz=\"0 1 0\"/><limit "
                         "lower=\"-1\" upper=\"1\" effort=\"50\" velocity=\"1\"/></joint></robot>";
  EXPECT_EQ(run({"check", file}), 0) << said();
  expect_said("'walker' stands without wheels: after a second its base is 0.0");
}

TEST_F(Messages, CheckRefusesMachinesThatOverlap) {
  EXPECT_EQ(
      run({"check", scene("", machine("one", "0 0 0 0 0 0") + machine("other", "1 1.5 0 0 0 0"))}),
      2);
  expect_said("include[other]");
  expect_said("it overlaps 'one' at the start");
  EXPECT_EQ(
      run({"check", scene("", machine("one", "0 0 0 0 0 0") + machine("other", "0 6 0 0 0 0"))}), 0)
      << said();
}

TEST_F(Messages, RunRefusesMachinesThatOverlapAsCheckDoes) {
  const std::string file =
      scene("", machine("one", "0 0 0 0 0 0") + machine("other", "1 1.5 0 0 0 0"));
  EXPECT_EQ(run({"check", file}), 2);
  // The messages are identical.
  const std::size_t begin = said().find(file), end = said().find('\n', begin);
  ASSERT_NE(end, std::string::npos) << said();
  const std::string message = said().substr(begin, end - begin);
  EXPECT_NE(message.find("it overlaps 'one' at the start"), std::string::npos) << message;
  EXPECT_EQ(run({"run", file, "--no-render", "--duration", "0.1", "--out", out()}), 2);
  expect_complained(message);
  EXPECT_FALSE(std::filesystem::exists(out() + "/summary.json"));
}

TEST_F(Messages, RunRefusesSensorsAsCheckDoes) {
  const auto body = [](const std::string& name, const std::string& pose, const std::string& size,
                       const std::string& sensor) {
    return "<model name=\"" + name + "\"><static>true</static><pose>" + pose +
           "</pose><navvy:on_ground>false</navvy:on_ground><link name=\"base\"><visual name=\"v\">"
           "<geometry><box><size>" +
           size + "</size></box></geometry></visual>" + sensor + "</link></model>\n";
  };
  const auto with = [&](const std::string& rate, const std::string& place_of_block) {
    return scene("", body("mast", "0 0 0.1 0 0 0", "0.2 0.2 0.2",
                          "<sensor name=\"eye\" type=\"lidar\"><pose>0 0 0.9 0 0 0</pose>"
                          "<update_rate>" +
                              rate +
                              "</update_rate><lidar><scan><horizontal><samples>3</samples>"
                              "</horizontal></scan></lidar></sensor>") +
                         body("block", place_of_block, "1 1 1", ""));
  };
  EXPECT_EQ(run({"check", with("20", "4 0 1 0 0 0")}), 0) << said();
  const std::string file = with("50000", "0 0 1 0 0 0");
  EXPECT_EQ(run({"check", file}), 2) << said();
  std::vector<std::string> faults;
  std::istringstream lines(said());
  for (std::string line; std::getline(lines, line);)
    if (line.find(": error: ") != std::string::npos) faults.push_back(line);
  ASSERT_EQ(faults.size(), 2u) << said();
  EXPECT_NE(faults[0].find("scene.sdf:3: error: sensor[eye]: '50000': a sensor reads at most once"),
            std::string::npos)
      << faults[0];
  EXPECT_NE(faults[0].find("give update_rate of at most"), std::string::npos) << faults[0];
  EXPECT_NE(faults[1].find("scene.sdf:3: error: sensor[eye]: '0 0 1 m'"), std::string::npos)
      << faults[1];
  EXPECT_NE(faults[1].find("move it out with its <pose>"), std::string::npos) << faults[1];
  EXPECT_NE(faults[1].find("the sensor is inside link 'base' of 'block' at the start"),
            std::string::npos)
      << faults[1];
  EXPECT_EQ(run({"run", file, "--no-render", "--duration", "0.1", "--out", out()}), 2);
  for (const std::string& fault : faults) expect_complained(fault);
}

TEST_F(Messages, ARunWithoutADeviceLeavesNoFolderBehind) {
  const std::string place = (directory_ / "results/of/today").string();
  EXPECT_EQ(run({"run", "trench", "--device", "no such device", "--out", place}), 3);
  expect_complained("no such device");
  EXPECT_FALSE(std::filesystem::exists(directory_ / "results"));
}

TEST_F(Messages, CheckAndRunRefuseMachinesThatStartBelowTheGround) {
  const std::string file =
      scene("",
            "<include><uri>model://ew180</uri><name>digger</name><pose>0 0 -0.8 0 0 0</pose>"
            "<navvy:on_ground>false</navvy:on_ground></include>");
  EXPECT_EQ(run({"check", file}), 2);
  expect_said("include[digger]");
  expect_said("starts with its centre that far below the ground");
  EXPECT_EQ(run({"run", file, "--no-render", "--duration", "0.1", "--out", out()}), 2);
  expect_complained("starts with its centre that far below the ground");
  EXPECT_FALSE(std::filesystem::exists(out() + "/summary.json"));
}

TEST_F(Messages, CheckReportsDerivedPropertiesOfAMachine) {
  const std::string crate =
      "<model name=\"crate\"><pose>3 0 0.5 0 0 0</pose><link name=\"a\">"
      "<navvy:density_kg_per_m3>500</navvy:density_kg_per_m3><visual "
      "name=\"body\"><geometry><box><size>0.5 0.4 0.2"
      "</size></box></geometry></visual></link></model>\n";
  EXPECT_EQ(run({"check", scene("", crate)}), 0) << said();
  expect_said("'crate': link 'a' collides as its visuals: box 'body'\n");
  expect_said("20 kg");
}

TEST_F(Messages, CheckRefusesAMachineThatTipsOver) {
  const std::string slope = "<slope><angle_deg>38</angle_deg><yaw_deg>90</yaw_deg></slope>";
  EXPECT_EQ(run({"check", scene(slope, machine("digger", "0 0 0 0 0 0"))}), 2);
  expect_said("include[digger]");
  expect_said("tips over within its first second");
  // On a gentle slope it stands.
  const std::string gentle = "<slope><angle_deg>15</angle_deg></slope>";
  EXPECT_EQ(run({"check", scene(gentle, machine("digger", "0 0 0 0 0 0"))}), 0) << said();
  expect_said("'digger' stands: tilt 1");
}

TEST_F(Messages, WarnOfAnglesThatLookLikeTheOtherUnit) {
  EXPECT_EQ(run({"check", scene("", machine("digger", "0 0 0 0 0 90"))}), 0) << said();
  expect_said("warning");
  expect_said(
      "the angles of a pose are in radians: 90 is more than a whole turn; were degrees meant? "
      "(write <pose "
      "degrees=\"true\">");
  EXPECT_EQ(run({"check", scene("<slope><angle_deg>0.2618</angle_deg></slope>", "")}), 0);
  expect_said("is 15 deg in radians; were radians meant? (this element is in degrees");
  // No false alarm for one and a half turns in radians, or for small angles in degrees.
  EXPECT_EQ(run({"check", scene("<slope><angle_deg>0.25</angle_deg></slope>",
                                machine("digger", "0 0 0 0 0 -4.7124"))}),
            0);
  expect_said("0 warnings");
}

}  // namespace
}  // namespace navvy
