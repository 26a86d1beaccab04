// SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>

#include "core/error.h"
#include "device/device_error.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/kept_messages.h"

namespace nb = nanobind;

namespace navvy::python {
namespace {

/// Returns a class of navvy._errors.
nb::object error_class(const char* name) {
  return nb::module_::import_("navvy._errors").attr(name);
}

/// Makes `name` of navvy._errors the present exception.
void raise(const char* name, const char* text) { PyErr_SetString(error_class(name).ptr(), text); }

/// Raises an InputError with its faults.
void raise_faults(const InputError& error) {
  const nb::object make = error_class("Fault");
  nb::list faults;
  for (const Fault& fault : error.faults())
    faults.append(make(fault.severity == Fault::Severity::kError ? "error" : "warning",
                       nb::str(fault.file.c_str()), fault.line, nb::str(fault.element.c_str()),
                       nb::str(fault.value.c_str()), nb::str(fault.rule.c_str()),
                       nb::str(fault.remedy.c_str())));
  const nb::object type = error_class("InputError");
  const nb::object value = type(nb::str(error.what()), nb::tuple(faults));
  PyErr_SetObject(type.ptr(), value.ptr());
}

}  // namespace

void bind_errors() {
  // Derived classes first: the first handler that fits is used.
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      raise_faults(error);
    } catch (const FileError& error) {
      raise("FileError", error.what());
    } catch (const SimulationError& error) {
      raise("SimulationError", error.what());
    } catch (const device::DeviceError& error) {
      raise("DeviceError", error.what());
    } catch (const BusyError& error) {
      raise("BusyError", error.what());
    } catch (const ClosedError& error) {
      raise("ClosedError", error.what());
    } catch (const Error& error) {
      raise("Error", error.what());
    }
  });
}

void log_messages() {
  const auto messages = take_messages();
  if (messages.empty()) return;
  const nb::object logger = nb::module_::import_("logging").attr("getLogger")("navvy");
  for (const auto& [level, text] : messages) {
    const char* name = level == LogLevel::kInfo      ? "info"
                       : level == LogLevel::kWarning ? "warning"
                                                     : "error";
    logger.attr(name)("%s", nb::str(text.c_str()));
  }
}

void poll_signals() {
  const nb::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

}  // namespace navvy::python
