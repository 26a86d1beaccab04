// SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <climits>
#include <limits>
#include <optional>

#include "python/bindings.h"
#include "python/buffer_view.h"
#include "python/runner.h"
#include "python/scene_data.h"

namespace nb = nanobind;

namespace navvy::python {
namespace {

/// Refuses a key that is neither a name nor an index.
[[noreturn]] void fail_key() {
  throw nb::type_error("an input or output is given by its name (str) or its index (int)");
}

/// Returns the index that a key gives: a name or an index. The list checks an index later.
template <class List>
int index_of(const List& list, nb::handle key) {
  if (PyLong_Check(key.ptr())) {
    const long index = PyLong_AsLong(key.ptr());
    // Beyond the range of int no index exists, and the list's message says so.
    if (index == -1 && PyErr_Occurred() != nullptr) PyErr_Clear();
    return index >= INT_MIN && index <= INT_MAX ? static_cast<int>(index) : -1;
  }
  if (PyUnicode_Check(key.ptr())) return list.index(nb::cast<std::string>(key));
  if (PyIndex_Check(key.ptr())) return index_of(list, nb::int_(nb::borrow(key)));
  fail_key();
}

/// Returns the indices of several keys; all of the list without keys.
template <class List>
std::vector<int> indices_of(const List& list, nb::handle keys) {
  std::vector<int> out;
  if (keys.is_none()) {
    for (std::size_t i = 0; i < list.size(); ++i) out.push_back(static_cast<int>(i));
    return out;
  }
  if (PyUnicode_Check(keys.ptr())) fail_key();
  for (const nb::handle key : keys) {
    out.push_back(index_of(list, key));
  }
  return out;
}

void step(Runner& runner, int n) {
  if (n < 0) throw nb::value_error("step: n must not be negative");
  const Runner::Use use(runner);
  {
    const nb::gil_scoped_release unlocked;
    runner.step(n, poll_signals);
  }
  log_messages();
}

void reset(Runner& runner, const std::optional<std::uint64_t>& seed) {
  const Runner::Use use(runner);
  {
    const nb::gil_scoped_release unlocked;
    runner.reset(seed ? &*seed : nullptr);
  }
  log_messages();
}

void order(Runner& runner, const std::string& machine, const std::string& steps, bool now) {
  const Runner::Use use(runner);
  {
    const nb::gil_scoped_release unlocked;
    runner.session().order(machine, steps, now);
  }
  log_messages();
}

void set(Runner& runner, nb::handle key, double value) {
  const Runner::Use use(runner);
  runner.session().set(index_of(runner.world().inputs(), key), value);
}

double get(Runner& runner, nb::handle key) {
  const Runner::Use use(runner);
  const sim::Outputs& outputs = runner.world().outputs();
  return outputs.get(index_of(outputs, key));
}

/// Writes outputs to an array of float64 that the caller owns.
void observe(Runner& runner, nb::handle out, nb::handle keys) {
  const Runner::Use use(runner);
  const sim::Outputs& outputs = runner.world().outputs();
  if (keys.is_none()) {
    const BufferView to(out, "out", {static_cast<Py_ssize_t>(outputs.size())}, true);
    for (std::size_t i = 0; i < outputs.size(); ++i)
      to.data()[i] = outputs.get(static_cast<int>(i));
    return;
  }
  const std::vector<int> chosen = indices_of(outputs, keys);
  const BufferView to(out, "out", {static_cast<Py_ssize_t>(chosen.size())}, true);
  for (std::size_t i = 0; i < chosen.size(); ++i) to.data()[i] = outputs.get(chosen[i]);
}

nb::bytes save(Runner& runner) {
  const Runner::Use use(runner);
  std::vector<char> bytes;
  {
    const nb::gil_scoped_release unlocked;
    bytes = runner.save();
  }
  return nb::bytes(bytes.data(), bytes.size());
}

std::vector<char> chars_of(const nb::bytes& bytes) {
  return std::vector<char>(bytes.c_str(), bytes.c_str() + bytes.size());
}

void load(Runner& runner, const nb::bytes& snapshot, bool anyway) {
  const std::vector<char> bytes = chars_of(snapshot);
  const Runner::Use use(runner);
  {
    const nb::gil_scoped_release unlocked;
    runner.load(bytes, anyway);
  }
  log_messages();
}

void copy_to(Runner& runner, Runner& other) {
  if (&runner == &other) return;
  const Runner::Use use(runner), use_other(other);
  const nb::gil_scoped_release unlocked;
  runner.copy_to(other);
}

/// Rolls out copies of a world; returns the failures as (member, row, message).
nb::list rollout(Runner& runner, nb::handle controls, nb::handle inputs, nb::handle results,
                 nb::handle outputs, int steps, int workers, const nb::list& states) {
  const Runner::Use use(runner);
  RolloutPlan plan;
  plan.inputs = indices_of(runner.world().inputs(), inputs);
  plan.outputs = indices_of(runner.world().outputs(), outputs);
  const BufferView from(controls, "controls", {-1, -1, static_cast<Py_ssize_t>(plan.inputs.size())},
                        false);
  const BufferView to(
      results, "results",
      {from.length(0), from.length(1), static_cast<Py_ssize_t>(plan.outputs.size())}, true);
  if (steps < 1 || workers < 0) throw nb::value_error("rollout: steps must be 1 or more");
  if (from.length(0) > INT_MAX || from.length(1) > INT_MAX)
    throw nb::value_error("rollout: too many controls");
  plan.members = static_cast<int>(from.length(0));
  plan.rows = static_cast<int>(from.length(1));
  plan.steps = steps;
  plan.workers = workers;
  plan.controls = from.data();
  plan.results = to.data();
  for (const nb::handle one : states) plan.states.push_back(chars_of(nb::cast<nb::bytes>(one)));
  if (!plan.states.empty() && plan.states.size() != static_cast<std::size_t>(plan.members))
    throw nb::value_error("rollout: states must hold one snapshot per member");
  std::vector<Failure> failures;
  {
    const nb::gil_scoped_release unlocked;
    failures = runner.rollout(plan, poll_signals);
  }
  log_messages();
  nb::list out;
  for (const Failure& one : failures)
    out.append(nb::make_tuple(one.member, one.row, nb::str(one.message.c_str())));
  return out;
}

/// Calls `read` while the world is held.
template <class Read>
auto reading(const Read& read) {
  return [read](Runner& runner) {
    const Runner::Use use(runner);
    return read(runner);
  };
}

std::string phase(Runner& runner, const std::string& machine) {
  const Runner::Use use(runner);
  return runner.session().phase(runner.world().machines().at(machine).index());
}

void bind_channel(nb::module_& module) {
  nb::class_<sim::Channel>(module, "Channel", "An input or output of a world.")
      .def_ro("name", &sim::Channel::name, "Name, such as 'excavator/boom_joint/position'.")
      .def_ro("unit", &sim::Channel::unit, "Unit; '1' for a number without one.")
      .def_ro("meaning", &sim::Channel::meaning, "One line that describes the number.")
      .def_ro("low", &sim::Channel::low, "Lower bound of an input; -inf without bounds.")
      .def_ro("high", &sim::Channel::high, "Upper bound of an input; inf without bounds.")
      .def_ro("clamped", &sim::Channel::clamped,
              "True if a value beyond the bounds acts like the nearer one; else it is refused.")
      .def("__repr__", [](const sim::Channel& one) {
        return "Channel('" + one.name + "', unit='" + one.unit + "')";
      });
}

void bind_state(nb::class_<Runner>& type) {
  type.def("save", &save)
      .def("load", &load, nb::arg("snapshot"), nb::arg("anyway") = false)
      .def("_copy_to", &copy_to, nb::arg("other"))
      .def("_rollout", &rollout, nb::arg("controls"), nb::arg("inputs").none(), nb::arg("results"),
           nb::arg("outputs").none(), nb::arg("steps"), nb::arg("workers"), nb::arg("states"))
      .def("close",
           [](Runner& runner) {
             const Runner::Use use(runner);
             runner.close();
           })
      .def("state_hash", reading([](Runner& runner) { return runner.session().state_hash(); }))
      .def("hash_parts", reading([](Runner& runner) {
             nb::dict out;
             for (const auto& [name, hash] : runner.session().hash_parts())
               out[name.c_str()] = hash;
             return out;
           }));
}

void bind_reports(nb::class_<Runner>& type) {
  type.def_prop_ro("time", reading([](Runner& r) { return r.world().time(); }))
      .def_prop_ro("dt", reading([](Runner& r) { return r.world().dt(); }))
      .def_prop_ro("steps", reading([](Runner& r) { return r.world().steps(); }))
      .def_prop_ro("seed", reading([](Runner& r) { return r.world().description().seed; }))
      .def_prop_ro("done", reading([](Runner& r) { return r.session().done(); }))
      .def_prop_ro("complete", reading([](Runner& r) { return r.session().complete(); }))
      .def_prop_ro("failure", reading([](Runner& r) { return r.failure(); }))
      .def_prop_ro("particle_count",
                   reading([](Runner& r) { return r.world().soil().counts().particles; }))
      .def_prop_ro("mass_error", reading([](Runner& r) {
                     return kilograms(r.world().soil().mass_ledger().error);
                   }))
      .def_prop_ro("cycles", reading([](Runner& r) { return r.session().cycles().size(); }))
      .def_prop_ro("device", reading([](Runner& r) { return r.session().device_name(); }))
      .def_prop_ro("energy", reading([](Runner& r) { return r.session().energy(); }))
      .def("phase", &phase, nb::arg("machine"));
}

}  // namespace

void bind_world(nb::module_& module) {
  bind_channel(module);
  nb::class_<Runner> type(module, "Runner",
                          "A world that is stepped; navvy.World derives from it.");
  type.def(
          "__init__",
          [](Runner* at, const SceneData& data, const std::string& device,
             const std::vector<std::string>& watch, bool programs) {
            {
              const nb::gil_scoped_release unlocked;
              new (at) Runner(data.scene, {device, watch}, programs);
            }
            log_messages();
          },
          nb::arg("scene"), nb::arg("device"), nb::arg("watch"), nb::arg("programs"))
      .def(
          "__init__",
          [](Runner* at, Runner& other) {
            const Runner::Use use(other);
            const nb::gil_scoped_release unlocked;
            new (at) Runner(other);
          },
          nb::arg("other"))
      .def("step", &step, nb::arg("n") = 1)
      .def("reset", &reset, nb::arg("seed") = nb::none())
      .def("set", &set, nb::arg("input"), nb::arg("value"))
      .def("order", &order, nb::arg("machine"), nb::arg("steps"), nb::arg("now") = false)
      .def("get", &get, nb::arg("output"))
      .def("__getitem__", &get)
      .def("__setitem__", &set)
      .def("_observe", &observe, nb::arg("out"), nb::arg("outputs") = nb::none())
      .def_prop_ro("inputs", reading([](Runner& r) { return r.world().inputs().channels(); }))
      .def_prop_ro("output_count", reading([](Runner& r) { return r.world().outputs().size(); }))
      .def_prop_ro("outputs", reading([](Runner& r) { return r.world().outputs().channels(); }))
      .def(
          "input",
          [](Runner& r, nb::handle key) {
            const Runner::Use use(r);
            return index_of(r.world().inputs(), key);
          },
          nb::arg("name"))
      .def(
          "output",
          [](Runner& r, nb::handle key) {
            const Runner::Use use(r);
            return index_of(r.world().outputs(), key);
          },
          nb::arg("name"));
  bind_state(type);
  bind_reports(type);
  bind_arrays(module, type);
}

}  // namespace navvy::python
