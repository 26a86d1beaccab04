// SPDX-License-Identifier: Apache-2.0
#include "scene_io/mesh_path.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "core/edit_distance.h"
#include "core/error.h"
#include "core/file.h"
#include "core/limits.h"
#include "geometry/read_mesh.h"
#include "scene_io/loader.h"

namespace navvy::scene_io {

namespace fs = std::filesystem;

std::vector<std::string> data_directories() {
  std::vector<std::string> directories;
  // The folder of the user comes first, so that it can replace shipped machines; the source tree is
  // last, for programs that were built and not installed.
  if (const char* own = std::getenv("NAVVY_DATA_DIR"); own && *own) directories.push_back(own);
  directories.push_back(NAVVY_INSTALLED_DATA);
  directories.push_back(NAVVY_SOURCE_DATA);
  return directories;
}

std::string find_data(const std::string& relative) {
  // An unreadable folder counts as empty.
  std::error_code ignored;
  for (const std::string& directory : data_directories()) {
    const fs::path path = fs::path(directory) / relative;
    if (fs::exists(path, ignored)) return path.string();
  }
  return "";
}

namespace {

/// Returns the folders of models and packages that the environment names, in the order of search.
std::vector<std::string> search_path() {
  std::vector<std::string> out;
  for (const char* name : {"NAVVY_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH",
                           "GAZEBO_MODEL_PATH", "ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"}) {
    const char* value = std::getenv(name);
    std::istringstream list(value != nullptr ? value : "");
    // Packages of ROS 2 are below share/ of each prefix.
    const std::string below = std::string(name) == "AMENT_PREFIX_PATH" ? "/share" : "";
    for (std::string one; std::getline(list, one, ':');)
      if (!one.empty()) out.push_back(one + below);
  }
  return out;
}

/// Returns the path of NAME/... below a folder of the search path, or below a folder that the file
/// of `uri` is in; empty if there is none.
std::string find_on_path(const Element& uri, const std::string& name) {
  std::error_code ignored;
  for (const std::string& folder : search_path())
    if (fs::exists(fs::path(folder) / name, ignored)) return (fs::path(folder) / name).string();
  // A copy of a whole repository is found without any setting.
  fs::path above =
      fs::weakly_canonical(fs::absolute(Document::of(uri).directory(), ignored), ignored);
  for (int level = 0; level < 8 && above.has_relative_path(); ++level, above = above.parent_path())
    if (fs::exists(above / name, ignored)) return (above / name).string();
  // ROS_PACKAGE_PATH may name the package itself.
  const std::size_t slash = name.find('/');
  for (const std::string& folder : search_path())
    if (slash != std::string::npos && fs::path(folder).filename() == name.substr(0, slash) &&
        fs::exists(fs::path(folder) / name.substr(slash + 1), ignored))
      return (fs::path(folder) / name.substr(slash + 1)).string();
  return "";
}

/// Returns the remedy for a file that was not found.
std::string way_to_find(const std::string& text) {
  if (text.rfind("http://", 0) == 0 || text.rfind("https://", 0) == 0)
    return "Navvy downloads nothing: fetch the model into a folder, name that folder in "
           "NAVVY_MODEL_PATH and write model://NAME";
  if (text.rfind("package://", 0) == 0 || text.rfind("model://", 0) == 0)
    return "set NAVVY_MODEL_PATH to the folder that holds '" +
           text.substr(text.find("://") + 3,
                       text.find('/', text.find("://") + 3) - text.find("://") - 3) +
           "'";
  return "paths count from the file that names them";
}

// Returns the path of `text`; empty if there is no such file or folder.
std::string locate(const Element& uri, const std::string& text) {
  std::error_code ignored;
  for (const std::string scheme : {"model://", "package://"}) {
    if (text.rfind(scheme, 0) != 0) continue;
    const std::string name = text.substr(scheme.size());
    // The name after the scheme counts from vehicles/, so that a scene can be sent to others.
    const std::string shipped = scheme == "model://" ? find_data("vehicles/" + name) : "";
    return shipped.empty() ? find_on_path(uri, name) : shipped;
  }
  fs::path path = text.rfind("file://", 0) == 0 ? fs::path(text.substr(7)) : fs::path(text);
  if (path.is_relative()) path = fs::path(Document::of(uri).directory()) / path;
  return fs::exists(path, ignored) ? path.string() : "";
}

/// "model://NAME" of each, for messages.
std::vector<std::string> shipped_models() {
  std::vector<std::string> out;
  std::error_code ignored;
  for (const std::string& directory : data_directories())
    for (const auto& entry : fs::directory_iterator(directory + "/vehicles", ignored))
      if (fs::exists(entry.path() / "model.sdf", ignored))
        out.push_back("model://" + entry.path().filename().string());
  std::sort(out.begin(), out.end());
  return out;
}

std::string absolute(const std::string& path) {
  std::error_code failed;
  // A failure leaves the path unchanged.
  const fs::path full = fs::weakly_canonical(fs::absolute(path, failed), failed);
  return failed ? path : full.string();
}

}  // namespace

std::string why_no_file(const std::string& path) {
  try {
    require_regular(path);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no such file";
}

bool resolve_mesh(const Element& uri, std::string& path, Faults& faults) {
  const std::string text = text_of(uri);
  std::error_code ignored;
  const std::string found = locate(uri, text);
  if (found.empty() || !fs::is_regular_file(found, ignored)) {
    faults.error(uri, text, found.empty() ? "no such mesh file" : why_no_file(found),
                 way_to_find(text));
    return false;
  }
  // Reading shows later whether the content fits the name.
  if (!geometry::is_mesh_file(found)) {
    std::string known;
    for (const std::string& ending : geometry::mesh_endings()) known += " " + ending;
    faults.error(uri, text, "meshes must be files of these formats:" + known,
                 "convert it, or correct the ending of its name");
    return false;
  }
  path = absolute(found);
  return true;
}

bool check_mesh(const Element& uri, const std::string& path, bool solid, Faults& faults) {
  const auto [at, is_new] = faults.work.meshes.try_emplace(path);
  Work::Mesh& mesh = at->second;
  if (is_new) {
    std::error_code unknown;
    const std::uintmax_t bytes = fs::file_size(path, unknown);
    faults.work.mesh_bytes += unknown ? 0 : bytes;
    if (faults.work.mesh_bytes > limits::kSceneMeshBytes) {
      mesh.fault = "the meshes of a scene may have at most " +
                   std::to_string(limits::kSceneMeshBytes) + " bytes together";
    } else if (faults.work.meshes.size() > limits::kSceneMeshes) {
      mesh.fault = "the shapes of a scene may name at most " +
                   std::to_string(limits::kSceneMeshes) + " mesh files";
    } else {
      try {
        mesh.vertices = geometry::read_mesh(path).vertices.size();
      } catch (const Error& error) {
        mesh.fault = error.what();
      }
    }
  }
  const std::size_t least = solid ? 4 : 1;
  if (!mesh.fault.empty()) {
    faults.error(uri, path, mesh.fault, "correct the mesh or name another");
  } else if (mesh.vertices < least) {
    faults.error(uri, std::to_string(mesh.vertices) + " vertices",
                 "the mesh needs at least " + std::to_string(least),
                 "correct the mesh or name another");
  } else if (solid && mesh.vertices > limits::kHullVertices) {
    faults.error(
        uri, std::to_string(mesh.vertices) + " vertices",
        "a mesh that collides may have at most " + std::to_string(limits::kHullVertices),
        "its hull is what collides: name a coarser mesh here, or give the model a <collision>");
  } else {
    return true;
  }
  return false;
}

bool resolve_model(const Element& uri, std::string& path, Faults& faults) {
  const std::string text = text_of(uri);
  std::error_code ignored;
  std::string found = locate(uri, text);
  if (!found.empty() && fs::is_directory(found, ignored))
    found = (fs::path(found) / "model.sdf").string();
  if (found.empty() || !fs::is_regular_file(found, ignored)) {
    const bool elsewhere = text.find("://") != std::string::npos && text.rfind("file://", 0) != 0;
    const std::string way = elsewhere && text.rfind("model://", 0) != 0
                                ? way_to_find(text)
                                : "give a path from this file to an SDF file or its directory, or "
                                  "model://NAME of a shipped "
                                  "machine";
    const std::string meant =
        text.rfind("model://", 0) == 0
            ? suggestion(text, shipped_models()) + "; " + way_to_find(text) + ", or "
            : "";
    faults.error(uri, text, "no such model", meant + way);
    return false;
  }
  // Messages name the path that the user knows, so links are not resolved.
  path = fs::path(found).lexically_normal().string();
  return true;
}

bool read_shell_mesh(const std::string& path, const Element& at, scene::Shell& shell,
                     Faults& faults) {
  // Each shell reads its mesh, so the bytes count each time.
  std::error_code unknown;
  const std::uintmax_t bytes = fs::file_size(path, unknown);
  faults.work.mesh_bytes += unknown ? 0 : bytes;
  if (faults.work.mesh_bytes > limits::kSceneMeshBytes) {
    faults.error(at, path,
                 "the meshes of a scene may have at most " +
                     std::to_string(limits::kSceneMeshBytes) +
                     " bytes together, a shell's counted each time it is named",
                 "name smaller meshes");
    return false;
  }
  try {
    static_cast<geometry::TriangleMesh&>(shell) = geometry::read_mesh(path);
    return true;
  } catch (const Error& error) {
    // The message holds file and line of the mesh.
    faults.error(at, path, error.what(), "correct the mesh or name another");
    return false;
  }
}

}  // namespace navvy::scene_io
