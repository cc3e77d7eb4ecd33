// SPDX-License-Identifier: Apache-2.0
// python/text.h: converts texts and file names, which may be in any encoding.
#pragma once

#include <string>

#include <pybind11/pybind11.h>

namespace nacre_python {

// Like os.fsdecode: bytes that are not UTF-8 become surrogates, which convert back to the same
// bytes.
inline pybind11::str TextOf(const std::string& bytes) {
  PyObject* const text =
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "surrogateescape");
  if (text == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::str>(text);
}

inline std::string BytesOf(const pybind11::handle& text) {
  PyObject* const bytes = PyUnicode_AsEncodedString(text.ptr(), "utf-8", "surrogateescape");
  if (bytes == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::bytes>(bytes);
}

}  // namespace nacre_python
