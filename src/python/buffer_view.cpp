// SPDX-License-Identifier: Apache-2.0
#include "python/buffer_view.h"

#include <cstddef>
#include <string>

namespace nb = nanobind;

namespace navvy::python {
namespace {

/// Returns "(3, 5)" with "any" for -1.
std::string shape_text(const Py_ssize_t* shape, std::size_t axes) {
  std::string out = "(";
  for (std::size_t i = 0; i < axes; ++i)
    out += (i > 0 ? ", " : "") + (shape[i] < 0 ? std::string("any") : std::to_string(shape[i]));
  return out + ")";
}

}  // namespace

BufferView::BufferView(nb::handle object, const char* name, const std::vector<Py_ssize_t>& shape,
                       bool writable) {
  if (PyObject_GetBuffer(object.ptr(), &view_, PyBUF_FORMAT | PyBUF_STRIDES) != 0) {
    PyErr_Clear();
    throw nb::type_error((std::string(name) + " must be an array of float64").c_str());
  }
  try {
    check(name, shape, writable);
  } catch (...) {
    PyBuffer_Release(&view_);
    throw;
  }
}

void BufferView::check(const char* name, const std::vector<Py_ssize_t>& shape, bool writable) {
  const std::string text(name), format(view_.format != nullptr ? view_.format : "B");
  // A converted copy would be written in place of the caller's array.
  if (format != "d")
    throw nb::type_error((text + " must be an array of float64 (its format is '" + format +
                          "'); use dtype=numpy.float64")
                             .c_str());
  bool same = view_.ndim == static_cast<int>(shape.size());
  for (std::size_t i = 0; same && i < shape.size(); ++i)
    same = shape[i] < 0 || shape[i] == view_.shape[i];
  if (!same)
    throw nb::value_error((text + " has the shape " +
                           shape_text(view_.shape, static_cast<std::size_t>(view_.ndim)) +
                           ", expected " + shape_text(shape.data(), shape.size()))
                              .c_str());
  if (PyBuffer_IsContiguous(&view_, 'C') == 0)
    throw nb::value_error((text + " must be in row-major order without gaps").c_str());
  if (writable && view_.readonly != 0) throw nb::value_error((text + " is read-only").c_str());
}

}  // namespace navvy::python
