// SPDX-License-Identifier: Apache-2.0
// python/brdf.cc: the Python bindings of reflection models, which work on arrays.
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include <pybind11/stl.h>

#include "python/module.h"
#include "python/table.h"

namespace nacre_python {
namespace {

// An array of shape (count, 3) with x, y and z of each vector, with any strides.
using Rows = py::array_t<double, py::array::forcecast>;

std::array<const double*, 3> VectorsOf(const Planes& planes) {
  const auto count = static_cast<size_t>(planes.shape(1));
  return {planes.data(), planes.data() + count, planes.data() + 2 * count};
}

nacre::Directions DirectionsOf(const Planes& normal, const Planes& to_view,
                               const Planes& to_light) {
  if (normal.ndim() != 2) throw py::value_error("nacre: an array has not two axes");
  for (const Planes* const planes : {&normal, &to_view, &to_light}) {
    RequireShape(*planes, 3, static_cast<size_t>(normal.shape(1)));
  }
  return {static_cast<size_t>(normal.shape(1)), VectorsOf(normal), VectorsOf(to_view),
          VectorsOf(to_light)};
}

template <class Number>
py::array_t<Number> ArrayOf(const std::vector<Number>& values) {
  return py::array_t<Number>(static_cast<py::ssize_t>(values.size()), values.data());
}

template <class Number>
py::array_t<Number> ArrayOf(const std::array<std::vector<Number>, 3>& planes) {
  const size_t count = planes[0].size();
  py::array_t<Number> array({size_t{3}, count});
  for (size_t c = 0; c < 3; ++c) {
    std::copy(planes[c].begin(), planes[c].end(), array.mutable_data() + c * count);
  }
  return array;
}

// Reads a number that may be unaligned.
double NumberAt(const char* place) {
  double number;
  std::memcpy(&number, place, sizeof number);
  return number;
}

// Copies rows [begin, begin + count) to planes that are `stride` apart.
void CopyRows(const Rows& rows, size_t begin, size_t count, double* planes, size_t stride) {
  const auto step = rows.strides(0), across = rows.strides(1);
  const char* row =
      reinterpret_cast<const char*>(rows.data()) + static_cast<py::ssize_t>(begin) * step;
  for (size_t i = 0; i < count; ++i, row += step) {
    planes[i] = NumberAt(row);
    planes[stride + i] = NumberAt(row + across);
    planes[2 * stride + i] = NumberAt(row + 2 * across);
  }
}

// Calls Brdf::Shade for rows of vectors, in pieces, which bounds memory and lets Ctrl-C interrupt.
// Returns the sum, or both components.
py::object ShadeRows(const nacre::Brdf& brdf, const Rows& normal, const Rows& to_view,
                     const Rows& to_light, bool components) {
  if (normal.ndim() != 2) throw py::value_error("nacre: an array has not two axes");
  const auto count = static_cast<size_t>(normal.shape(0));
  for (const Rows* const rows : {&normal, &to_view, &to_light}) RequireShape(*rows, count, 3);
  const size_t stride = std::min<size_t>(50000, count);
  py::array_t<float> sum({count, size_t{3}}), specular({components ? count : 0, size_t{3}});
  float* const to = sum.mutable_data();
  float* const to_specular = specular.mutable_data();
  {
    const py::gil_scoped_release release;
    std::vector<double> planes(9 * stride);
    const auto vectors = [&](size_t first) {
      const double* const x = planes.data() + first * stride;
      return std::array<const double*, 3>{x, x + stride, x + 2 * stride};
    };
    for (size_t begin = 0; begin < count; begin += stride) {
      if (begin != 0) {
        const py::gil_scoped_acquire acquire;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      }
      const size_t size = std::min(stride, count - begin);
      CopyRows(normal, begin, size, planes.data(), stride);
      CopyRows(to_view, begin, size, planes.data() + 3 * stride, stride);
      CopyRows(to_light, begin, size, planes.data() + 6 * stride, stride);
      const nacre::Reflections found = brdf.Shade({size, vectors(0), vectors(3), vectors(6)});
      for (size_t c = 0; c < 3; ++c) {
        const float* const diffuse = found.diffuse[c].data();
        const float* const lobe = found.specular[c].data();
        float* const rows = to + 3 * begin + c;
        if (components) {
          float* const specular_rows = to_specular + 3 * begin + c;
          for (size_t i = 0; i < size; ++i) {
            rows[3 * i] = diffuse[i];
            specular_rows[3 * i] = lobe[i];
          }
        } else {
          for (size_t i = 0; i < size; ++i) rows[3 * i] = diffuse[i] + lobe[i];
        }
      }
    }
  }
  if (components) return py::make_tuple(sum, specular);
  return sum;
}

}  // namespace

void BindBrdfs(py::module_* module) {
  py::class_<nacre::Brdf> brdfs(*module, "Brdf");
  brdfs
      .def_static("of_model",
                  [](const std::string& model, const Members& members) {
                    return nacre::Brdf(model, ParametersOf(members));
                  })
      .def_static("of_material",
                  [](const Scene& scene, const std::string& material) {
                    const Use use(&scene.users, Use::kShared, "Scene");
                    return nacre::Brdf(scene.scene, material);
                  })
      .def("evaluate",
           [](const nacre::Brdf& brdf, const Planes& n, const Planes& v, const Planes& l) {
             const nacre::Directions directions = DirectionsOf(n, v, l);
             const nacre::ExactReflections result =
                 Unlocked([&] { return brdf.Evaluate(directions); });
             return py::make_tuple(ArrayOf(result.diffuse), ArrayOf(result.specular));
           })
      .def("shade", &ShadeRows)
      .def("sample",
           [](const nacre::Brdf& brdf, const Planes& n, const Planes& v, const Planes& points) {
             const nacre::Directions directions = DirectionsOf(n, v, v);
             RequireShape(points, 2, directions.count);
             const double* const u = points.data();
             return ArrayOf(
                 Unlocked([&] { return brdf.Sample(directions, u, u + directions.count); }));
           })
      .def("pdf",
           [](const nacre::Brdf& brdf, const Planes& n, const Planes& v, const Planes& l) {
             const nacre::Directions directions = DirectionsOf(n, v, l);
             return ArrayOf(Unlocked([&] { return brdf.Pdf(directions); }));
           })
      .def("albedo",
           [](const nacre::Brdf& brdf, const std::vector<double>& n_dot_v) {
             std::array<std::vector<double>, 3> result;
             {
               const py::gil_scoped_release release;
               for (const double cosine : n_dot_v) {
                 const nacre::Rgb albedo = brdf.Albedo(cosine);
                 for (size_t c = 0; c < 3; ++c) result[c].push_back(albedo[c]);
               }
             }
             return ArrayOf(result);
           })
      .def("tabulate",
           [](const nacre::Brdf& brdf, const std::vector<std::string>& columns,
              const TableRows& values, bool albedo) {
             const nacre::Table directions = TableOf("", columns, values);
             return ToPython(Unlocked([&] { return brdf.Tabulate(directions, albedo); }));
           })
      .def("check_table",
           [](const nacre::Brdf& brdf, const std::string& header,
              const std::vector<std::string>& columns, const TableRows& values, double tolerance,
              const std::string& name) {
             const nacre::Table theirs = TableOf(header, columns, values);
             const nacre::TableCheck found =
                 Unlocked([&] { return brdf.CheckTable(theirs, tolerance, name); });
             return py::make_tuple(found.ok, TextOf(found.page), TextOf(found.json));
           })
      .def("terms", [](const nacre::Brdf& brdf, const Planes& n, const Planes& v, const Planes& l) {
        const nacre::Directions directions = DirectionsOf(n, v, l);
        const nacre::MicrofacetTerms terms = Unlocked([&] { return brdf.Terms(directions); });
        return py::make_tuple(ArrayOf(terms.d), ArrayOf(terms.g), ArrayOf(terms.f),
                              ArrayOf(terms.lambda_view), ArrayOf(terms.lambda_light));
      });
  Seal(brdfs);
}

}  // namespace nacre_python
