// SPDX-License-Identifier: Apache-2.0
// Names and files of unknown origin, and what the program prints about them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cli/program_run.h"
#include "core/printable.h"

namespace navvy {
namespace {

/// A sequence that a terminal obeys, C1 in UTF-8, bidi, a forged line, and bytes that are not
/// UTF-8.
const std::vector<std::string> kHostile = {"\x1B]0;x\x07\x1B[31m", "\u009B31m", "\u202Etxt.exe",
                                           "x\nerror: forged", "\xFF\xFE"};

class CleanOutput : public test::ProgramRun {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    const std::string path = (directory_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  /// A flat scene with an own ground and further elements.
  std::string scene(const std::string& ground, const std::string& body,
                    const std::string& name = "w") {
    return write("scene.sdf", "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"" + name +
                                  "\"><navvy:soil ref=\"loam\"/>\n<navvy:ground>" + ground +
                                  "<size_m>8 8</size_m></navvy:ground>\n" + body +
                                  "</world></sdf>\n");
  }
  /// Runs the program, which must refuse its input, and counts the attack.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& hostile) {
    const int status = run(arguments);
    EXPECT_GE(status, 2) << printable(hostile);
    EXPECT_LE(status, 4) << printable(hostile);
    expect_clean(hostile);
  }
  void expect_clean(const std::string& hostile) {
    for (const std::string& text : {said(), complained()}) {
      EXPECT_EQ(printable_lines(text), text) << "after " << printable(hostile);
      EXPECT_EQ(text.find("\nerror: forged"), std::string::npos) << text;
    }
    EXPECT_FALSE(said().empty() && complained().empty()) << printable(hostile);
    ++attacks_;
  }

  int attacks_ = 0;
};

TEST_F(CleanOutput, OfArgumentsAndFileNames) {
  for (const std::string& hostile : kHostile) {
    expect_refused({hostile}, hostile);
    expect_refused({"run", hostile}, hostile);
    expect_refused({"check", hostile + ".sdf"}, hostile);
    expect_refused({"run", "trench", "--" + hostile}, hostile);
    expect_refused({"run", "trench", "--seed", hostile}, hostile);
    expect_refused({"run", "trench", "--set", hostile + "=1"}, hostile);
    expect_refused({"run", "trench", "--set", "soil.cohesion_pa=" + hostile}, hostile);
    expect_refused({"run", "trench", "--device", hostile}, hostile);
    expect_refused({"run", "trench", "--resume", hostile}, hostile);
    expect_refused({"map", hostile, "--format", "nav2", "--out", out()}, hostile);
    expect_refused({"map", "trench", "--format", hostile, "--out", out()}, hostile);
    expect_refused({"machines", hostile}, hostile);
    expect_refused({"soils", hostile}, hostile);
    expect_refused({"lab", hostile}, hostile);
    expect_refused({"check", write(hostile.substr(0, 4) + ".sdf", "<sdf version=\"1\"/>")},
                   hostile);
  }
  EXPECT_EQ(attacks_, 15 * 5);
}

TEST_F(CleanOutput, OfMeshesDesignsMapsAndScenes) {
  for (const std::string& hostile : kHostile) {
    write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 " + hostile + "\n");
    expect_refused({"check", scene("",
                                   "<model name=\"m\"><link name=\"a\"><inertial><mass>1</mass>"
                                   "</inertial><collision name=\"c\"><geometry><mesh><uri>"
                                   "m.obj</uri></mesh></geometry></collision></link></model>")},
                   hostile);
    write("d.xml", "<LandXML><Surfaces><Surface name=\"" + hostile +
                       "\"><Definition surfType=\"TIN\"><Pnts><P id=\"1\">" + hostile +
                       "</P></Pnts></Definition></Surface></Surfaces></LandXML>");
    expect_refused({"check", scene("", "<navvy:design><file>d.xml</file></navvy:design>")},
                   hostile);
    write("g.asc", "ncols 4\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 1 1 1\n1 1 " +
                       hostile + " 1\n1 1 1 1\n1 1 1 1\n");
    expect_refused({"check", scene("<file>g.asc</file>", "")}, hostile);
    expect_refused({"check", scene("<cell_m>" + hostile + "</cell_m>", "")}, hostile);
    expect_refused({"check", scene("", "<navvy:camera name=\"" + hostile + "\"/>")}, hostile);
  }
  EXPECT_EQ(attacks_, 5 * 5);
}

TEST_F(CleanOutput, OfARunWhoseFolderHasAHostileName) {
  const std::string file = scene("", "");
  for (const std::string& hostile : kHostile) {
    EXPECT_EQ(run({"run", file, "--no-render", "--duration", "0.01", "--out",
                   (directory_ / hostile).string()}),
              0)
        << complained();
    EXPECT_NE(said().find("results: "), std::string::npos) << said();
    expect_clean(hostile);
  }
}

TEST_F(CleanOutput, NamesThatBecomeFormulasOrUnsafeFoldersAreRefused) {
  for (const std::string name : {"=cmd|calc", "+1", "-1+1", "@SUM(A1)", " x"}) {
    EXPECT_EQ(run({"check", scene("",
                                  "<include><uri>model://test_bucket</uri><name>b</name>"
                                  "</include><model name=\"" +
                                      name + "\"/>")}),
              2);
    EXPECT_NE(said().find("a name must not begin with"), std::string::npos) << said();
  }
  for (const std::string name : {"~", "-rf", "$(id)", "`id`", "a;b", "a&amp;b", "x|y", ".hidden",
                                 "a/b", "..", "a\\b", "x ", "*", "a&gt;b"}) {
    EXPECT_EQ(run({"run", scene("", "", name), "--no-render", "--duration", "0.01"}), 2) << name;
    EXPECT_NE(complained().find("a name must not begin with") != std::string::npos ||
                  complained().find("folders of results are named after it") != std::string::npos,
              false)
        << complained();
  }
  EXPECT_EQ(run({"check", scene("", "", "Gr\u00FCne Wiese-2.1_b")}), 0) << said();
}

}  // namespace
}  // namespace navvy
