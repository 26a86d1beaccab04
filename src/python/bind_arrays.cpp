// SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <array>
#include <cstddef>
#include <memory>
#include <utility>

#include "heightfield/design_surface.h"
#include "map/map_maker.h"
#include "python/bindings.h"
#include "python/runner.h"
#include "sim/read_particles.h"
#include "sim/world_terrain.h"

namespace nb = nanobind;

namespace navvy::python {
namespace {

/// Returns a Python object that keeps `owner` alive.
template <class T>
nb::capsule keep(std::shared_ptr<T> owner) {
  return nb::capsule(new std::shared_ptr<T>(std::move(owner)),
                     [](void* at) noexcept { delete static_cast<std::shared_ptr<T>*>(at); });
}

/// Returns heights as a read-only array of shape (ny, nx).
nb::object array_of(const HeightView& view) {
  const std::size_t shape[] = {static_cast<std::size_t>(view.ny()),
                               static_cast<std::size_t>(view.nx())};
  return nb::cast(nb::ndarray<nb::numpy, const float, nb::ndim<2>>(view.values()->data(), 2, shape,
                                                                   keep(view.values())));
}

nb::object heights(Runner& runner) {
  const Runner::Use use(runner);
  {
    const nb::gil_scoped_release unlocked;
    runner.refresh_heights();
  }
  return array_of(runner.heights());
}

nb::object columns(Runner& runner) {
  const Runner::Use use(runner);
  runner.refresh_columns();
  return array_of(runner.columns());
}

/// Returns one layer of the terrain map as an array of shape (ny, nx).
nb::object layer(Runner& runner, const std::string& name) {
  const Runner::Use use(runner);
  const map::MapLayer which = map::layer_named(name);
  std::shared_ptr<std::vector<float>> values;
  int nx = 0, ny = 0;
  {
    const nb::gil_scoped_release unlocked;
    const heightfield::TerrainView view =
        sim::terrain_view(runner.world(), heightfield::SurfaceKind::kMapped);
    nx = view.nx();
    ny = view.ny();
    map::MapOptions options;
    if (const heightfield::DesignSurface* design = runner.session().design())
      options.target = design->over(nx, ny);
    values = std::make_shared<std::vector<float>>(
        map::layer_values(view, which, view.site_rect(), options));
  }
  const std::size_t shape[] = {static_cast<std::size_t>(ny), static_cast<std::size_t>(nx)};
  return nb::cast(
      nb::ndarray<nb::numpy, float, nb::ndim<2>>(values->data(), 2, shape, keep(values)));
}

nb::dlpack::dtype dtype_of(scene::ParticleElement type) {
  switch (type) {
    case scene::ParticleElement::kUint16:
      return nb::dtype<std::uint16_t>();
    case scene::ParticleElement::kUint32:
      return nb::dtype<std::uint32_t>();
    case scene::ParticleElement::kFloat32:
      return nb::dtype<float>();
    case scene::ParticleElement::kFloat64:
      break;
  }
  return nb::dtype<double>();
}

/// Returns the active particles as arrays by name, which keep the table that they are part of.
nb::dict particles(Runner& runner) {
  const Runner::Use use(runner);
  std::shared_ptr<scene::ParticleTable> table;
  {
    const nb::gil_scoped_release unlocked;
    table = std::make_shared<scene::ParticleTable>(sim::read_particles(runner.world()));
  }
  nb::dict out;
  for (const scene::ParticleArray& one : table->arrays()) {
    std::vector<std::size_t> shape = {table->count()};
    for (const int length : one.shape) shape.push_back(static_cast<std::size_t>(length));
    // The table belongs to the arrays alone, so they may be written to. An empty one has no memory,
    // but an array needs an address.
    static std::byte nothing[8];
    std::byte* data = one.bytes.empty() ? nothing : const_cast<std::byte*>(one.bytes.data());
    out[one.name.c_str()] = nb::cast(nb::ndarray<nb::numpy>(
        data, shape.size(), shape.data(), keep(table), nullptr, dtype_of(one.type)));
  }
  return out;
}

/// Returns the names of the soils, in which the particles' `soil` counts.
nb::list soils(Runner& runner) {
  const Runner::Use use(runner);
  nb::list out;
  for (const scene::Soil& one : runner.world().description().soils)
    out.append(nb::str(one.name.c_str()));
  return out;
}

nb::dlpack::dtype dtype_of(sim::ElementType type) {
  switch (type) {
    case sim::ElementType::kUint8:
      return nb::dtype<std::uint8_t>();
    case sim::ElementType::kUint16:
      return nb::dtype<std::uint16_t>();
    case sim::ElementType::kInt32:
      return nb::dtype<std::int32_t>();
    case sim::ElementType::kFloat32:
      return nb::dtype<float>();
    case sim::ElementType::kFloat64:
      return nb::dtype<double>();
  }
  return nb::dtype<double>();
}

/// Returns the latest value of a sensor's array, read-only and without a copy.
nb::object array(Runner& runner, const std::string& name) {
  const Runner::Use use(runner);
  const sim::ArrayView view = runner.world().arrays().view(name);
  std::vector<std::size_t> shape;
  for (const int length : view.channel().shape) shape.push_back(static_cast<std::size_t>(length));
  // The array's flags say that it is read-only, so the cast gives nobody a way to write.
  return nb::cast(nb::ndarray<nb::numpy, nb::ro>(const_cast<std::byte*>(view.bytes().data()),
                                                 shape.size(), shape.data(), keep(runner.live()),
                                                 nullptr, dtype_of(view.channel().type)));
}

nb::dict array_info(Runner& runner, const std::string& name) {
  const Runner::Use use(runner);
  const sim::ArrayView view = runner.world().arrays().view(name);
  nb::dict out;
  out["unit"] = view.channel().unit;
  out["meaning"] = view.channel().meaning;
  out["frame"] = view.channel().frame;
  out["sequence"] = view.sequence();
  out["time"] = view.time();
  out["delivered"] = view.delivered();
  return out;
}

nb::list arrays(Runner& runner) {
  const Runner::Use use(runner);
  nb::list out;
  for (const sim::ArrayChannel& one : runner.world().arrays().channels())
    out.append(nb::str(one.name.c_str()));
  return out;
}

nb::dict grid(Runner& runner) {
  const Runner::Use use(runner);
  const heightfield::Ground& ground = runner.world().ground();
  nb::dict out;
  out["nx"] = ground.nx();
  out["ny"] = ground.ny();
  out["cell"] = ground.cell();
  out["origin"] = nb::make_tuple(ground.origin().x(), ground.origin().y());
  return out;
}

nb::list layers() {
  nb::list out;
  for (const map::LayerInfo& one : map::layers()) out.append(nb::str(one.name.c_str()));
  return out;
}

}  // namespace

void bind_arrays(nb::module_& module, nb::class_<Runner>& type) {
  type.def_prop_ro("heights", &heights)
      .def_prop_ro("columns", &columns)
      .def("layer", &layer, nb::arg("name"))
      .def("particles", &particles)
      .def_prop_ro("soils", &soils)
      .def("array", &array, nb::arg("name"))
      .def("array_info", &array_info, nb::arg("name"))
      .def_prop_ro("arrays", &arrays)
      .def_prop_ro("grid", &grid);
  module.def("layers", &layers, "Returns the names of the layers of a terrain map.");
}

}  // namespace navvy::python
