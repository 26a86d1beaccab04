// SPDX-License-Identifier: Apache-2.0
#include "python/scene_values.h"

#include <string>
#include <string_view>
#include <type_traits>

#include "scene/fields.h"

namespace nb = nanobind;

namespace navvy::python {
namespace {

/// Returns a name without the prefix of extension elements.
nb::str key_of(const char* name) {
  constexpr std::string_view kPrefix = "navvy:";
  std::string_view text(name);
  if (text.starts_with(kPrefix)) text.remove_prefix(kPrefix.size());
  return nb::str(text.data(), text.size());
}

nb::tuple tuple_of(const double* values, std::size_t size, double factor) {
  nb::list out;
  for (std::size_t i = 0; i < size; ++i) out.append(values[i] / factor);
  return nb::tuple(out);
}

/// Returns the value of a field as a Python object, in the unit of the file.
struct ToPython {
  double factor;

  nb::object operator()(const bool* v) const { return nb::bool_(*v); }
  nb::object operator()(const int* v) const { return nb::int_(*v); }
  nb::object operator()(const std::uint64_t* v) const { return nb::int_(*v); }
  nb::object operator()(const double* v) const { return nb::float_(*v / factor); }
  nb::object operator()(const std::string* v) const { return nb::str(v->c_str(), v->size()); }
  nb::object operator()(const Vec2* v) const { return tuple_of(v->data(), 2, factor); }
  nb::object operator()(const Vec3* v) const { return tuple_of(v->data(), 3, factor); }
  nb::object operator()(const Mat3* v) const { return tuple_of(v->data(), 9, factor); }
  nb::object operator()(const std::vector<double>* v) const {
    return tuple_of(v->data(), v->size(), factor);
  }
  nb::object operator()(const std::vector<Vec3>* v) const {
    nb::list out;
    for (const Vec3& one : *v) out.append(tuple_of(one.data(), 3, factor));
    return nb::tuple(out);
  }
  nb::object operator()(const std::optional<int>* v) const {
    return *v ? nb::object(nb::int_(**v)) : nb::none();
  }
  nb::object operator()(const scene::Direction& v) const {
    return tuple_of(v.value->data(), 3, factor);
  }
  nb::object operator()(const scene::Rgb& v) const {
    const Vec3 color(v.value[0], v.value[1], v.value[2]);
    return tuple_of(color.data(), 3, 1);
  }
  nb::object operator()(const scene::NamedChoice& v) const { return nb::str(v.names.at(v.get())); }
  nb::object operator()(const scene::Computed& v) const { return nb::str(v().c_str()); }
  // As a file writes it: x y z [m] roll pitch yaw [rad].
  nb::object operator()(const Pose* v) const {
    Vec6 all;
    all << v->translation(), fixed_angles(v->linear());
    return tuple_of(all.data(), 6, 1);
  }
};

/// Collects the fields of a struct in a dictionary.
class Collector final : public scene::Fields {
 public:
  void field(const scene::Field& field) override {
    // A value without an element cannot be set.
    if (field.mark.has(scene::Mark::kDerived)) return;
    values[key_of(field.name)] =
        std::visit(ToPython{scene::unit_of(field.name).factor}, field.value);
  }
  void group(const scene::Group& group,
             const std::function<void(scene::Fields&)>& describe) override {
    Collector inner;
    if (group.present) describe(inner);
    values[key_of(group.name)] = group.present ? nb::object(inner.values) : nb::none();
  }
  void list(const scene::List& list) override {
    nb::list out;
    for (std::size_t i = 0; i < list.size; ++i) {
      Collector item;
      list.item(i, item);
      const std::string name = scene::name_of([&](scene::Fields& f) { list.item(i, f); });
      if (!item.values.contains("name")) item.values["name"] = nb::str(name.c_str());
      out.append(item.values);
    }
    values[key_of(list.name)] = out;
  }
  void types(const scene::Types& types) override {
    values[types.attribute] = nb::str(types.names.at(types.index));
    types.describe(types.index, *this);
  }

  nb::dict values;
};

}  // namespace

nb::dict scene_values(scene::Scene& scene) {
  Collector all;
  scene.describe(all);
  return all.values;
}

}  // namespace navvy::python
