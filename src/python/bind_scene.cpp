// SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>

#include "control/step_kinds.h"
#include "python/bindings.h"
#include "python/scene_data.h"
#include "python/scene_values.h"
#include "scene_io/loader.h"
#include "scene_io/schema.h"
#include "scene_io/shipped.h"

namespace nb = nanobind;

namespace navvy::python {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

SceneData load(const std::string& file, const Settings& settings,
               const std::optional<std::uint64_t>& seed) {
  SceneData out;
  {
    const nb::gil_scoped_release unlocked;
    scene_io::Overrides overrides;
    overrides.set = settings;
    overrides.seed = seed;
    out.scene = scene_io::load_scene(scene_io::find_scene(file), control::step_kinds(), overrides);
  }
  log_messages();
  return out;
}

}  // namespace

void bind_scene(nb::module_& module) {
  nb::class_<SceneData>(module, "SceneData", "A scene as it was read.")
      .def_prop_ro("name", [](const SceneData& data) { return data.scene.name; })
      .def_prop_ro("file", [](const SceneData& data) { return data.scene.file; })
      .def(
          "values", [](SceneData& data) { return scene_values(data.scene); },
          "Returns all values by the names of the schema, in the units of the file.");
  module.def("load_scene", &load, nb::arg("file"), nb::arg("settings") = Settings(),
             nb::arg("seed") = nb::none(),
             "Reads a scene file, or a shipped scene by its name, with changes.");
  module.def(
      "scenes",
      [] {
        std::vector<std::string> out;
        for (const auto& [name, file] : scene_io::shipped_scenes()) out.push_back(name);
        return out;
      },
      "Returns the names of the shipped scenes.");
  module.def(
      "schema", [] { return scene_io::schema_json(scene_io::schema().root()); },
      "Returns the schema of scene files as JSON.");
}

}  // namespace navvy::python
