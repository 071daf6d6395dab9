// Plain arguments of the interface's functions: arrays, lists, and dictionaries of numbers.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include <nanobind/nanobind.h>

#include <Eigen/Geometry>

namespace native {

namespace nb = nanobind;

// An array's buffer while it is read.
struct Buffer {
  Py_buffer view{};
  bool held = false;

  explicit Buffer(PyObject* object) noexcept {
    held = PyObject_CheckBuffer(object) && PyObject_GetBuffer(object, &view, PyBUF_FORMAT | PyBUF_STRIDES) == 0;
    if (!held) PyErr_Clear();
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() {
    if (held) PyBuffer_Release(&view);
  }
  bool doubles() const noexcept { return held && view.format && view.format[0] == 'd' && view.format[1] == 0; }
  double at(Py_ssize_t offset) const noexcept {
    double out;
    std::memcpy(&out, static_cast<const char*>(view.buf) + offset, sizeof(out));
    return out;
  }
};

inline bool truth(nb::handle value) {
  const int out = PyObject_IsTrue(value.ptr());
  if (out < 0) throw nb::python_error();
  return out != 0;
}

// What follows reads arguments that are plain arrays, and says whether they are.

inline bool read_pose(nb::handle pose, Eigen::Isometry3d& out) noexcept {
  const Buffer b(pose.ptr());
  if (!b.doubles() || b.view.ndim != 2 || b.view.shape[0] != 4 || b.view.shape[1] != 4) return false;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) out.matrix().data()[4 * c + r] = b.at(r * b.view.strides[0] + c * b.view.strides[1]);
  return true;
}

// A finite number of Python's, and of NumPy's that are one.
inline bool read_number(PyObject* value, double& out) noexcept {
  if (!PyFloat_Check(value)) return false;
  out = PyFloat_AS_DOUBLE(value);
  return std::isfinite(out);
}

// n finite numbers: an array, a list or a tuple.
inline bool read_row(nb::handle values, double* out, std::size_t n) noexcept {
  PyObject* given = values.ptr();
  if (PyList_CheckExact(given) || PyTuple_CheckExact(given)) {
    if (static_cast<std::size_t>(PySequence_Fast_GET_SIZE(given)) != n) return false;
    for (std::size_t i = 0; i < n; ++i)
      if (!read_number(PySequence_Fast_GET_ITEM(given, static_cast<Py_ssize_t>(i)), out[i])) return false;
    return true;
  }
  const Buffer b(given);
  if (!b.doubles() || b.view.ndim != 1 || b.view.shape[0] != static_cast<Py_ssize_t>(n)) return false;
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = b.at(static_cast<Py_ssize_t>(i) * b.view.strides[0]);
    if (!std::isfinite(out[i])) return false;
  }
  return true;
}

// Values of all that is held: a dictionary by name, or a row.
template <std::size_t N>
inline bool read_free(nb::handle free, const char* const* names, std::array<double, N>& out) noexcept {
  if (!PyDict_CheckExact(free.ptr())) return read_row(free, out.data(), N);
  if (static_cast<std::size_t>(PyDict_Size(free.ptr())) != N) return false;
  for (std::size_t i = 0; i < N; ++i) {
    PyObject* value = PyDict_GetItemString(free.ptr(), names[i]);
    if (!value || !read_number(value, out.data()[i])) return false;
  }
  return true;
}

}  // namespace native
