// SPDX-License-Identifier: Apache-2.0
// Include directions: the table of src/README.md, and the single place of every third-party
// library.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "style/sources.h"

namespace navvy::style {
namespace {

using Names = std::set<std::string>;

/// Direct arrows of src/README.md; core is open to all.
const std::map<std::string, Names>& arrows() {
  static const std::map<std::string, Names> table = {
      {"core", {}},
      {"device", {"core"}},
      {"geometry", {"core"}},
      {"scene", {"geometry"}},
      {"scene_io", {"scene"}},
      {"heightfield", {"device", "scene"}},
      {"soil", {"heightfield", "device", "scene"}},
      {"terramechanics", {"scene"}},
      {"lab", {"soil", "terramechanics"}},
      {"bench", {"lab", "soil"}},
      {"vehicle", {"scene", "terramechanics"}},
      {"control", {"vehicle", "heightfield"}},
      {"coupling", {"soil", "vehicle", "heightfield", "terramechanics"}},
      {"sim", {"coupling", "scene"}},
      {"session", {"sim", "control"}},
      {"render", {"scene", "geometry"}},
      {"map", {"heightfield", "scene"}},
      {"formats", {"map"}},
      {"planner", {"map", "control"}},
      {"earthwork", {"map", "control"}},
      {"sensor", {"sim", "geometry", "map"}},
      {"record", {"session", "formats", "render", "sensor"}},
      {"run", {"session", "record", "sensor", "planner", "earthwork"}},
      {"report", {}},
      {"link", {"run", "report", "lab", "bench", "scene_io"}},
      {"cli", {"link"}},
      {"python", {"link"}},
  };
  return table;
}

/// Folders that may include more than their module: a camera draws, no other sensor does.
const std::map<std::string, Names>& wings() {
  static const std::map<std::string, Names> table = {{"src/sensor/camera", {"render"}},
                                                     {"src/formats/ros", {"sensor"}}};
  return table;
}

/// Returns the modules that `module` may include: itself and those reachable by the arrows.
Names reachable(const std::string& module) {
  Names seen = {"core"};
  std::vector<std::string> open = {module};
  while (!open.empty()) {
    const std::string name = open.back();
    open.pop_back();
    if (!seen.insert(name).second && name != "core") continue;
    const auto it = arrows().find(name);
    if (it != arrows().end()) open.insert(open.end(), it->second.begin(), it->second.end());
  }
  return seen;
}

/// A third-party library: prefix of its headers, and the folders and single files that may include
/// them.
struct Library {
  std::string name;
  std::vector<std::string> prefixes;
  std::vector<std::string> places;
};

const std::vector<Library>& libraries() {
  static const std::vector<Library> table = {
      {"Eigen", {"Eigen/"}, {"src"}},
      {"OpenCL", {"CL/", "OpenCL/"}, {"src/device"}},
      {"Bullet", {"bt", "Bullet", "LinearMath/", "bullet/"}, {"src/vehicle/bullet"}},
      {"sdformat", {"sdf/", "ignition/", "gz/"}, {"src/scene_io"}},
      {"tinyxml2", {"tinyxml2.h"}, {"src/scene_io"}},
      {"GDAL", {"gdal", "ogr", "cpl_", "vrtdataset"}, {"src/heightfield/gdal"}},
      {"Coin, OpenGL, OSMesa",
       {"Inventor/", "GL/", "EGL/"},
       {"src/render", "src/geometry/formats/read_inventor.cpp"}},
      {"Assimp", {"assimp/"}, {"src/geometry/formats"}},
      {"tinyobjloader", {"tiny_obj_loader.h"}, {"src/geometry/obj"}},
      {"libpng",
       {"png.h"},
       {"src/render", "src/record", "src/formats", "src/heightfield/map_files"}},
      {"Fast-CDR", {"fastcdr/"}, {"src/formats/ros"}},
      {"SQLite", {"sqlite3.h"}, {"src/formats/ros"}},
      {"OMPL", {"ompl/"}, {"src/planner/ompl"}},
      {"libzip", {"zip.h"}, {"src/formats"}},
      {"zlib", {"zlib.h"}, {"src/report"}},
      {"cpp-httplib", {"httplib.h"}, {"src/link/http"}},
      {"nlohmann-json",
       {"nlohmann/"},
       {"src/formats", "src/record", "src/report", "src/cli", "src/link"}},
      {"CLI11", {"CLI/"}, {"src/cli"}},
      {"spdlog", {"spdlog/"}, {"src/cli"}},
      {"nanobind", {"nanobind/"}, {"src/python"}},
  };
  return table;
}

bool starts_with(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

bool is_system(const std::string& name) {
  // Standard C++ headers have neither folder nor suffix; POSIX headers for files, time and signals.
  static const Names posix = {"fcntl.h",    "spawn.h", "unistd.h",  "signal.h", "dlfcn.h",
                              "execinfo.h", "poll.h",  "pthread.h", "termios.h"};
  return name.find_first_of("./") == std::string::npos || posix.count(name) > 0 ||
         starts_with(name, "sys/") || starts_with(name, "netinet/") || starts_with(name, "arpa/");
}

std::string module_of(const std::string& path) {
  const std::size_t begin = path.find('/') + 1;
  return path.substr(begin, path.find('/', begin) - begin);
}

/// Violations of one file of src/.
std::vector<std::string> check(const SourceFile& file) {
  std::vector<std::string> found;
  const std::string module = module_of(file.path);
  Names allowed = reachable(module);
  for (const auto& [folder, more] : wings())
    if (file.under(folder)) allowed.insert(more.begin(), more.end());
  if (arrows().count(module) == 0)
    return {file.path + ": module " + module + " is not in the table"};
  for (const Include& include : includes(file.text)) {
    const std::string where = file.path + ":" + std::to_string(include.line) + ": ";
    const auto says = [&](const std::string& text) { found.push_back(where + text); };
    const auto library =
        std::find_if(libraries().begin(), libraries().end(), [&](const Library& l) {
          return std::any_of(l.prefixes.begin(), l.prefixes.end(), [&](const std::string& prefix) {
            return starts_with(include.name, prefix);
          });
        });
    if (include.angle && is_system(include.name)) continue;
    if (include.angle || (library != libraries().end() && !exists("src/" + include.name))) {
      const bool right_place = library != libraries().end() &&
                               std::any_of(library->places.begin(), library->places.end(),
                                           [&](const std::string& place) {
                                             return file.path == place || file.under(place);
                                           });
      if (library == libraries().end())
        says("<" + include.name + "> belongs to no library of the table");
      if (library != libraries().end() && !right_place)
        says(library->name + " is not allowed here: " + include.name);
      continue;
    }
    if (exists("src/" + include.name)) {
      const std::string target = include.name.substr(0, include.name.find('/'));
      if (allowed.count(target) == 0) says(module + " may not include " + include.name);
      if (include.name.find("_private.h") != std::string::npos && target != module) {
        says(include.name + " is private to " + target);
      }
    } else if (exists("kernels/" + include.name)) {
      // The native loop of `bench` is made of the headers of the kernels.
      static const Names sharing = {"device", "heightfield", "soil", "lab", "bench"};
      if (sharing.count(module) == 0)
        says("kernel header outside device, heightfield, soil, lab, bench: " + include.name);
    } else {
      says("\"" + include.name + "\" is neither below src/ nor below kernels/");
    }
  }
  return found;
}

/// Clients of a world, which use it through handles, channels and samplers.
const Names& clients() {
  static const Names table = {"src/map",     "src/formats", "src/planner", "src/earthwork",
                              "src/session", "src/record",  "src/control", "src/sensor",
                              "src/run",     "src/report",  "src/cli",     "src/python",
                              "src/link",    "examples"};
  return table;
}

/// Modules that clients may not include, not even through another header: the parts of a world and
/// their solvers.
const Names& inner() {
  static const Names table = {"coupling/",
                              "soil/",
                              "lab/",
                              "vehicle/physics_engine.h",
                              "vehicle/bullet/",
                              "vehicle/kinematic/",
                              "sim/world_parts.h"};
  return table;
}

/// Files of clients that must include internals, each with its reason.
const std::map<std::string, std::string>& insiders() {
  static const std::map<std::string, std::string> table = {
      {"src/cli/lab_command.cpp", "runs the laboratory, whose rigs are built of the solver itself"},
      {"src/cli/lab_output.h", "prints what the laboratory measured"},
      {"src/cli/lab_output.cpp", "prints what the laboratory measured"},
  };
  return table;
}

/// Returns how `file` reaches an inner header, "a -> b -> c"; empty if it does not. `read` returns
/// a header's text by its name below src/.
std::string path_inside(const SourceFile& file,
                        const std::function<std::string(const std::string&)>& read) {
  Names seen;
  std::vector<std::pair<std::string, std::string>> open;  // name below src/, the path to it
  const auto follow = [&](const std::string& text, const std::string& path) {
    for (const Include& include : includes(text))
      if (!include.angle && seen.insert(include.name).second)
        open.emplace_back(include.name, path + " -> " + include.name);
  };
  follow(file.text, file.path);
  while (!open.empty()) {
    const auto [name, path] = open.back();
    open.pop_back();
    for (const std::string& forbidden : inner())
      if (starts_with(name, forbidden)) return path;
    follow(read(name), path);
  }
  return "";
}

std::string header_text(const std::string& name) {
  static const std::map<std::string, std::string> texts = [] {
    std::map<std::string, std::string> out;
    for (const SourceFile& file : sources("src", {".h"})) out[file.path.substr(4)] = file.text;
    return out;
  }();
  const auto it = texts.find(name);
  return it == texts.end() ? "" : it->second;
}

TEST(Includes, ClientsNeverReachSoilExchangeOrEngines) {
  std::vector<std::string> found;
  Names pardoned;
  int files = 0;
  for (const std::string& folder : clients())
    for (const SourceFile& file : sources(folder, {".h", ".cpp"})) {
      ++files;
      const std::string path = path_inside(file, header_text);
      if (path.empty()) continue;
      if (insiders().count(file.path) > 0)
        pardoned.insert(file.path);
      else
        found.push_back(path);
    }
  ASSERT_GT(files, 20) << "the clients were not found";
  EXPECT_EQ(report(found), "");
  EXPECT_EQ(pardoned.size(), insiders().size()) << "an exception that is no longer needed";
}

TEST(Includes, ViolationsThroughOtherHeadersAreFound) {
  const std::map<std::string, std::string> headers = {
      {"sim/open.h", "#include \"sim/inside.h\"\n"},
      {"sim/inside.h", "#include \"soil/solver.h\"\n"},
      {"sim/closed.h", "#include \"scene/scene.h\"\n"}};
  const auto read = [&](const std::string& name) {
    const auto it = headers.find(name);
    return it == headers.end() ? std::string() : it->second;
  };
  const auto path = [&](const std::string& header) {
    return path_inside(SourceFile{"src/record/a.cpp", "#include \"" + header + "\"\n"}, read);
  };
  EXPECT_EQ(path("sim/open.h"), "src/record/a.cpp -> sim/open.h -> sim/inside.h -> soil/solver.h");
  EXPECT_EQ(path("sim/closed.h"), "");
  EXPECT_EQ(path("vehicle/machine_state.h"), "");
  EXPECT_NE(path("sim/world_parts.h"), "");
}

/// Returns the modules and their direct arrows from the table "Module map" of src/README.md. Notes
/// in brackets are ignored.
std::map<std::string, Names> map_of_readme(const std::string& page) {
  std::map<std::string, Names> out;
  static const std::regex row(R"(\n\| (\w+) \|[^\n|]*\| ([^\n|]*) \|)");
  for (std::sregex_iterator it(page.begin(), page.end(), row), end; it != end; ++it) {
    std::istringstream names((*it)[2].str());
    Names& to = out[(*it)[1].str()];
    for (std::string name; std::getline(names >> std::ws, name, ',');)
      if (name.front() != '(') to.insert(name);
  }
  return out;
}

TEST(Includes, ArrowsAreThoseOfTheModuleMap) {
  const std::string page = read_source("src/README.md").text;
  const std::size_t begin = page.find("## Module map"), end = page.find("\n## ", begin + 1);
  ASSERT_NE(end, std::string::npos);
  const std::map<std::string, Names> documented = map_of_readme(page.substr(begin, end - begin));
  for (const auto& [module, to] : arrows()) {
    if (!exists("src/" + module)) continue;  // planned: described below the table
    ASSERT_EQ(documented.count(module), 1u) << module << " has no row in src/README.md";
    if (documented.at(module) == Names{"everything"}) continue;
    Names here;
    for (const std::string& name : to)
      if (exists("src/" + name)) here.insert(name);
    Names open = documented.at(module);
    open.erase("core");  // open to all
    here.erase("core");
    EXPECT_EQ(open, here) << module;
  }
}

TEST(Includes, FollowTheArrowsOfTheModuleMap) {
  const std::vector<SourceFile> files = sources("src", {".h", ".cpp"});
  ASSERT_GT(files.size(), 20u) << "the sources were not found";
  std::vector<std::string> found;
  for (const SourceFile& file : files) {
    const std::vector<std::string> more = check(file);
    found.insert(found.end(), more.begin(), more.end());
  }
  EXPECT_EQ(report(found), "");
}

TEST(Includes, ViolationsAreFound) {
  const auto violations = [](const std::string& path, const std::string& text) {
    return check(SourceFile{path, text}).size();
  };
  EXPECT_EQ(violations("src/soil/a.cpp",
                       "#include \"soil/solver.h\"\n#include <vector>\n#include <Eigen/Core>\n"),
            0u);
  EXPECT_EQ(violations("src/core/a.cpp", "#include \"soil/solver.h\"\n"), 1u);
  EXPECT_EQ(violations("src/render/a.cpp", "#include \"soil/solver.h\"\n"), 1u);
  EXPECT_EQ(violations("src/soil/a.cpp", "#include <CL/cl.h>\n"), 1u);
  EXPECT_EQ(violations("src/soil/a.cpp", "#include <boost/any.hpp>\n"), 1u);
  EXPECT_EQ(violations("src/soil/a.cpp", "#include \"device/opencl_private.h\"\n"), 1u);
  EXPECT_EQ(violations("src/vehicle/a.cpp", "#include <btBulletDynamicsCommon.h>\n"), 1u);
  EXPECT_EQ(violations("src/vehicle/bullet/a.cpp", "#include <btBulletDynamicsCommon.h>\n"), 0u);
  EXPECT_EQ(violations("src/sim/a.cpp", "#include \"common/portable.h\"\n"), 1u);
  EXPECT_EQ(violations("src/sim/a.cpp", "#include \"control/operator.h\"\n"), 1u);
  EXPECT_EQ(violations("src/session/a.cpp", "#include \"control/operator.h\"\n"), 0u);
  EXPECT_EQ(violations("src/control/a.cpp", "#include <ompl/config.h>\n"), 1u);
  EXPECT_EQ(violations("src/planner/a.cpp", "#include <ompl/config.h>\n"), 1u);
  EXPECT_EQ(violations("src/planner/ompl/a.cpp", "#include <ompl/config.h>\n"), 0u);
  EXPECT_EQ(violations("src/sensor/a.cpp", "#include \"render/renderer.h\"\n"), 1u);
  EXPECT_EQ(violations("src/sensor/camera/a.cpp", "#include \"render/renderer.h\"\n"), 0u);
  EXPECT_EQ(violations("src/render/a.cpp", "#include <Inventor/SbBox.h>\n"), 0u);
  EXPECT_EQ(violations("src/geometry/formats/a.cpp", "#include <Inventor/SbBox.h>\n"), 1u);
  EXPECT_EQ(violations("src/geometry/formats/read_inventor.cpp", "#include <Inventor/SbBox.h>\n"),
            0u);
  EXPECT_EQ(violations("src/attic/a.cpp", ""), 1u);
}

TEST(Includes, SlowLibrariesStayOutOfHeaders) {
  std::vector<std::string> found;
  for (const SourceFile& file : sources("src", {".h"})) {
    if (file.ends_with("_private.h")) continue;
    for (const Include& include : includes(file.text)) {
      // 14 s to compile the three of them; sdformat 3 s.
      for (const char* slow :
           {"CLI/", "nlohmann/json.hpp", "spdlog/", "sdf/", "gdal", "Inventor/"}) {
        if (starts_with(include.name, slow))
          found.push_back(file.path + " includes " + include.name);
      }
    }
  }
  EXPECT_EQ(report(found), "");
}

TEST(Includes, TableNamesEveryModuleOfTheTree) {
  for (const SourceFile& file : sources("src", {"CMakeLists.txt"})) {
    if (file.path == "src/CMakeLists.txt") continue;
    EXPECT_EQ(arrows().count(module_of(file.path)), 1u) << file.path;
  }
}

}  // namespace
}  // namespace navvy::style
