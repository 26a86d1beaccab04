// SPDX-License-Identifier: Apache-2.0
// Arrays of float64 that Python passes, through its buffer protocol.
#pragma once

#include <nanobind/nanobind.h>

#include <vector>

namespace navvy::python {

/// The memory of an array of float64 in row-major order, without a copy, while this object lives.
/// The caller holds Python's lock when it is made and destroyed.
class BufferView {
 public:
  /// Takes the memory of `object`, which must have this shape; -1 stands for any length. `name`
  /// stands for the array in messages. @throws TypeError or ValueError of Python for another type,
  /// shape or order, and for a read-only array if `writable`.
  BufferView(nanobind::handle object, const char* name, const std::vector<Py_ssize_t>& shape,
             bool writable);
  ~BufferView() { PyBuffer_Release(&view_); }
  BufferView(const BufferView&) = delete;
  BufferView& operator=(const BufferView&) = delete;

  /// Returns the first number.
  double* data() const { return static_cast<double*>(view_.buf); }
  /// Returns the length of an axis.
  Py_ssize_t length(int axis) const { return view_.shape[axis]; }

 private:
  /// Checks type, shape and order; releases the memory if they are wrong.
  void check(const char* name, const std::vector<Py_ssize_t>& shape, bool writable);

  Py_buffer view_{};
};

}  // namespace navvy::python
