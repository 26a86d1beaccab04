// SPDX-License-Identifier: Apache-2.0
// Packages and models are found above the file that names them, and on the search paths that other
// simulators and ROS read from the environment.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "control/step_kinds.h"
#include "core/error.h"
#include "folder.h"
#include "scene_io/loader.h"

namespace navvy::scene_io {
namespace {

constexpr const char* kMesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n";

/// Sets a variable of the environment for a while.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

class SearchPath : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  /// Returns the number of errors of a file; `world_` and `messages_` are what it gives.
  std::size_t errors_of(const std::string& file) {
    FaultCount count;
    messages_.clear();
    for (const Fault& fault : check(file, control::step_kinds(), &world_, {}, nullptr, &count))
      messages_ += fault.text() + "\n";
    return count.errors;
  }
  /// Returns the number of errors of a robot in the package near_pack that draws the mesh `uri`.
  std::size_t errors_of_mesh(const std::string& uri) {
    return errors_of(write("near_pack/urdf/r.urdf",
                           "<robot name='r'>\n<link name='a'><inertial><mass value='3'/><inertia "
                           "ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>"
                           "<visual><geometry><mesh filename='" +
                               uri + "'/></geometry></visual></link></robot>"));
  }

  test::Folder folder_;
  std::optional<scene::Scene> world_;
  std::string messages_;
};

TEST_F(SearchPath, PackagesAreFoundAboveTheFileAndOnTheSearchPath) {
  write("near_pack/meshes/a.obj", kMesh);
  write("elsewhere/far_pack/a.obj", kMesh);
  write("prefix/share/far_pack/a.obj", kMesh);
  EXPECT_EQ(errors_of_mesh("package://near_pack/meshes/a.obj"), 0u) << messages_;
  const auto errors_of_far = [&] { return errors_of_mesh("package://far_pack/a.obj"); };
  EXPECT_EQ(errors_of_far(), 1u);
  EXPECT_NE(messages_.find("set NAVVY_MODEL_PATH to the folder that holds 'far_pack'"),
            std::string::npos)
      << messages_;
  const auto errors_with = [&](const char* name, const std::string& folder) {
    const Variable set(name, "/nowhere:" + (folder_ / folder));
    return errors_of_far();
  };
  for (const char* name : {"NAVVY_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH",
                           "GAZEBO_MODEL_PATH", "ROS_PACKAGE_PATH"})
    EXPECT_EQ(errors_with(name, "elsewhere"), 0u) << name << "\n" << messages_;
  // It may name the package itself.
  EXPECT_EQ(errors_with("ROS_PACKAGE_PATH", "elsewhere/far_pack"), 0u) << messages_;
  // Packages of ROS 2 are below share/ of each prefix.
  EXPECT_EQ(errors_with("AMENT_PREFIX_PATH", "prefix"), 0u) << messages_;
  EXPECT_EQ(errors_with("AMENT_PREFIX_PATH", "elsewhere"), 1u);
  EXPECT_EQ(errors_of_far(), 1u);
}

TEST_F(SearchPath, ModelsAreFoundOnTheSearchPathToo) {
  write("elsewhere/far_ball/model.sdf",
        "<sdf version='1.6'><model name='m'>\n<link name='far'><inertial><mass>2</mass><inertia>"
        "<ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial><collision name='c'>"
        "<geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>\n</model>"
        "</sdf>");
  const std::string world = write("world.sdf",
                                  "<sdf version='1.6'>\n<world name='w'>\n<include><uri>"
                                  "model://far_ball</uri></include></world></sdf>");
  EXPECT_EQ(errors_of(world), 1u);
  for (const char* part :
       {"world.sdf:3: error", "set NAVVY_MODEL_PATH to the folder that holds 'far_ball'"})
    EXPECT_NE(messages_.find(part), std::string::npos) << part << "\nnot in\n" << messages_;
  const Variable set("NAVVY_MODEL_PATH", "/nowhere:" + (folder_ / "elsewhere"));
  ASSERT_EQ(errors_of(world), 0u) << messages_;
  EXPECT_EQ(world_->machines.at(0).machine.links.at(0).name, "far");
}

}  // namespace
}  // namespace navvy::scene_io
