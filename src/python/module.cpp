// SPDX-License-Identifier: Apache-2.0
// The extension module navvy._navvy.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "device/device.h"
#include "python/bindings.h"
#include "python/kept_messages.h"

namespace nb = nanobind;

NB_MODULE(_navvy, module) {
  using namespace navvy;
  module.doc() = "Worlds of Navvy: excavation with soil, machines and sensors.";
  module.attr("__version__") = NAVVY_VERSION;
  python::keep_messages();
  python::bind_errors();
  python::bind_scene(module);
  python::bind_world(module);
  module.def(
      "devices",
      [] {
        std::vector<std::string> out;
        for (const device::DeviceInfo& one : device::list_devices()) out.push_back(one.text());
        return out;
      },
      "Returns the OpenCL devices, one text each.");
}
