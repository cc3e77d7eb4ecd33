// SPDX-License-Identifier: Apache-2.0
// python/scene.cc: the Python bindings of scenes, sessions and renders.
#include <chrono>
#include <memory>

#include <pybind11/stl.h>

#include "python/module.h"

namespace nacre_python {
namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<uint32_t, py::array::c_style | py::array::forcecast>;

// Converts an array of shape (count, columns).
template <size_t kColumns>
std::vector<std::array<double, kColumns>> Rows(const Doubles& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != static_cast<py::ssize_t>(kColumns)) {
    throw py::value_error(std::string(name) + " has the shape (count, " + std::to_string(kColumns) +
                          ")");
  }
  std::vector<std::array<double, kColumns>> rows(static_cast<size_t>(array.shape(0)));
  for (size_t i = 0; i < rows.size(); ++i) {
    for (size_t c = 0; c < kColumns; ++c) rows[i][c] = array.data()[kColumns * i + c];
  }
  return rows;
}

}  // namespace

nacre::Parameters ParametersOf(const Members& members) {
  nacre::Parameters parameters;
  for (const auto& [name, json] : members) parameters.push_back({name, nacre::Value::Json(json)});
  return parameters;
}

namespace {

// Makes on_progress of a render, which takes the interpreter lock for `callback` no more often than
// the eye can follow.
std::function<void(double)> Progress(const py::object& callback) {
  if (callback.is_none()) return {};
  auto last = std::chrono::steady_clock::now();
  PyObject* const function = callback.ptr();
  return [=](double share) mutable {
    const auto now = std::chrono::steady_clock::now();
    if (share < 1 && now - last < std::chrono::milliseconds(30)) return;
    last = now;
    const py::gil_scoped_acquire acquire;
    const py::handle callable(function);
    callable(share);
  };
}

nacre::RenderSettings SettingsOf(const py::dict& dict) {
  nacre::RenderSettings settings;
  settings.width = dict["width"].cast<int>();
  settings.height = dict["height"].cast<int>();
  settings.samples = dict["samples"].cast<int>();
  settings.max_error = dict["max_error"].cast<double>();
  settings.seed = dict["seed"].cast<std::optional<uint32_t>>();
  const auto [x0, y0, x1, y1] = dict["region"].cast<std::tuple<int, int, int, int>>();
  settings.region = {x0, y0, x1, y1};
  settings.layers = dict["layers"].cast<std::vector<std::string>>();
  settings.threads = dict["threads"].cast<int>();
  settings.intersector = dict["intersector"].cast<std::string>();
  settings.others = ParametersOf(dict["others"].cast<Members>());
  return settings;
}

py::dict ToDict(const nacre::RenderStats& stats) {
  using namespace py::literals;
  const py::dict samples("min"_a = stats.fewest_samples, "mean"_a = stats.mean_samples,
                         "max"_a = stats.most_samples);
  return py::dict("camera_rays"_a = stats.camera_rays, "shadow_rays"_a = stats.shadow_rays,
                  "plan_seconds"_a = stats.plan_seconds, "render_seconds"_a = stats.render_seconds,
                  "threads"_a = stats.threads, "notes"_a = stats.notes,
                  "unsettled_pixels"_a = stats.unsettled_pixels, "samples_per_pixel"_a = samples,
                  "hits"_a = stats.hits, "shades"_a = stats.shades);
}

// The image that render() makes, with its statistics. A signal calls stop().
py::object RenderWith(const std::function<void()>& stop,
                      const std::function<nacre::Image(nacre::RenderStats*)>& render) {
  nacre::RenderStats stats;
  py::object image = ToPython(Interruptibly(stop, [&] { return render(&stats); }));
  image.attr("stats") = ToDict(stats);
  return image;
}

py::object Render(const Scene& scene, const py::dict& dict, const py::object& on_progress) {
  nacre::RenderSettings settings = SettingsOf(dict);
  std::atomic<bool> stopped = false;
  settings.on_progress = Progress(on_progress);
  settings.cancel = &stopped;
  const Use use(&scene.users, Use::kShared, "Scene");
  return RenderWith(
      [&] { stopped = true; },
      [&](nacre::RenderStats* stats) { return nacre::Render(scene.scene, settings, stats); });
}

class Session {
 public:
  explicit Session(const Scene& scene) {
    const Use use(&scene.users, Use::kShared, "Scene");
    const py::gil_scoped_release release;
    session_ = std::make_unique<nacre::Session>(scene.scene);
  }

  void Set(const std::string& pointer, const std::string& json) {
    const Use use(&users_, Use::kAlone, "Session");
    Open();
    const py::gil_scoped_release release;
    session_->Set(pointer, nacre::Value::Json(json));
  }

  std::optional<std::string> Get(const std::string& pointer) const {
    const Use use(&users_, Use::kShared, "Session");
    Open();
    const std::optional<nacre::Value> value = session_->Get(pointer);
    if (!value) return std::nullopt;
    return value->json();
  }

  bool Has(const std::string& pointer) const {
    const Use use(&users_, Use::kShared, "Session");
    Open();
    return session_->Has(pointer);
  }

  bool Reload() {
    const Use use(&users_, Use::kAlone, "Session");
    Open();
    const py::gil_scoped_release release;
    return session_->Reload();
  }

  py::object Render(const py::dict& dict, const py::object& on_progress, const py::object& show) {
    nacre::RenderSettings settings = SettingsOf(dict);
    const Use use(&users_, Use::kAlone, "Session");
    Open();
    settings.on_progress = Progress(on_progress);
    settings.cancel = &cancelled_;
    std::function<void(const nacre::Image&, int)> shown;
    if (!show.is_none()) {
      shown = [&](const nacre::Image& image, int samples) {
        const py::gil_scoped_acquire acquire;
        show(ToPython(nacre::Image(image)), samples);
      };
    }
    try {
      return RenderWith([&] { cancelled_ = true; },
                        [&](nacre::RenderStats* stats) {
                          return session_->RenderProgressively(settings, shown, stats);
                        });
    } catch (...) {
      cancelled_ = false;  // the request has been served
      throw;
    }
  }

  void Cancel() {
    Open();
    cancelled_ = true;
  }

  void Close() {
    const Use use(&users_, Use::kAlone, "Session");
    session_.reset();
  }

 private:
  void Open() const {
    if (!session_) Refuse("Session", "is closed", "open another of the scene");
  }

  std::unique_ptr<nacre::Session> session_;
  std::atomic<bool> cancelled_ = false;
  mutable Users users_;
};

}  // namespace

void BindScenes(py::module_* module) {
  module->def("named_settings", &nacre::NamedSettings);
  py::class_<Scene> scene(*module, "Scene");
  scene.def_static("empty",
                   [] {
                     return Scene{nacre::Scene(), {}};
                   })
      .def_static("from_file",
                  [](const std::string& path) {
                    return Scene{Unlocked([&] { return nacre::Scene::FromFile(path); }), {}};
                  })
      .def_static(
          "from_json",
          [](const std::string& text, const std::string& folder) {
            return Scene{Unlocked([&] { return nacre::Scene::FromJson(text, folder); }), {}};
          })
      .def_static("from_bytes",
                  [](const py::bytes& bytes) {
                    const std::string text = bytes;
                    const py::gil_scoped_release release;
                    return Scene{nacre::Scene::FromBytes({text.begin(), text.end()}), {}};
                  })
      .def("to_bytes",
           [](const Scene& self) {
             const Use use(&self.users, Use::kShared, "Scene");
             const std::vector<uint8_t> bytes = self.scene.ToBytes();
             return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
           })
      .def("copy",
           [](const Scene& self) {
             return Scene{self.scene, {}};
           })
      .def("set",
           [](Scene& self, const std::string& pointer, const std::string& json) {
             const Use use(&self.users, Use::kAlone, "Scene");
             self.scene.Set(pointer, nacre::Value::Json(json));
           })
      .def("get",
           [](const Scene& self, const std::string& pointer) -> std::optional<std::string> {
             const std::optional<nacre::Value> value = self.scene.Get(pointer);
             if (!value) return std::nullopt;
             return value->json();
           })
      .def("has",
           [](const Scene& self, const std::string& pointer) { return self.scene.Has(pointer); })
      .def("add_user_material",
           [](Scene& self, const std::string& name, const py::object& evaluate,
              const py::object& sample, const py::object& pdf, const Members& members) {
             const Use use(&self.users, Use::kAlone, "Scene");
             self.scene.AddMaterial(name, UserBrdfOf(evaluate, sample, pdf), ParametersOf(members));
           })
      .def("add_shape",
           [](Scene& self, const Members& members) {
             const Use use(&self.users, Use::kAlone, "Scene");
             self.scene.AddShape(ParametersOf(members));
           })
      .def("add_spheres",
           [](Scene& self, const Doubles& centers, const Doubles& radii,
              const std::string& material) {
             const auto rows = Rows<3>(centers, "centers");
             if (radii.ndim() != 1 || static_cast<size_t>(radii.shape(0)) != rows.size()) {
               throw py::value_error("radii has one number for each of centers");
             }
             const Use use(&self.users, Use::kAlone, "Scene");
             for (size_t i = 0; i < rows.size(); ++i) {
               self.scene.AddSphere(rows[i], radii.data()[i], material);
             }
           })
      .def("add_mesh",
           [](Scene& self, const Doubles& positions, const Indices& triangles,
              const std::string& material, const std::optional<Doubles>& normals,
              const std::optional<Doubles>& uvs) {
             nacre::Mesh mesh;
             mesh.positions = Rows<3>(positions, "positions");
             if (normals) mesh.normals = Rows<3>(*normals, "normals");
             if (uvs) mesh.uvs = Rows<2>(*uvs, "uvs");
             if (triangles.ndim() != 2 || triangles.shape(1) != 3) {
               throw py::value_error("triangles has the shape (count, 3)");
             }
             mesh.triangles.assign(triangles.data(), triangles.data() + triangles.size());
             const Use use(&self.users, Use::kAlone, "Scene");
             self.scene.AddMesh(mesh, material);
           })
      .def("check",
           [](const Scene& self) {
             const Use use(&self.users, Use::kShared, "Scene");
             const py::gil_scoped_release release;
             self.scene.Check();
           })
      .def("sphere_count", [](const Scene& self) { return self.scene.sphere_count(); })
      .def("mesh_count", [](const Scene& self) { return self.scene.mesh_count(); })
      .def("material_names", [](const Scene& self) { return self.scene.material_names(); })
      .def("light_names", [](const Scene& self) { return self.scene.light_names(); })
      .def("render", &Render);
  Seal(scene);
  py::class_<Session> session(*module, "Session");
  session.def_static("of", [](const Scene& of) { return std::make_unique<Session>(of); })
      .def("set", &Session::Set)
      .def("get", &Session::Get)
      .def("has", &Session::Has)
      .def("reload", &Session::Reload)
      .def("render", &Session::Render)
      .def("cancel", &Session::Cancel)
      .def("close", &Session::Close);
  Seal(session);
}

}  // namespace nacre_python
