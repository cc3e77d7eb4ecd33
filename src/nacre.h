// SPDX-License-Identifier: Apache-2.0
// nacre.h: nacre as a C++17 library. Installed as <nacre/nacre.h>, with the library libnacre.
//
//   nacre::Scene scene;
//   scene.AddMaterial("gold", {{"model", "conductor"}, {"preset", "gold"}, {"roughness", 0.2}});
//   scene.AddLight("key", {{"type", "point"}, {"position", {3, 4, 5}}, {"intensity", 100}});
//   scene.AddSphere({0, 0, 0}, 1, "gold");
//   nacre::Write(nacre::Render(scene, {.width = 640, .height = 360}), "gold.exr");  // C++20
//
// Units and conventions are those of scene files (share/nacre/scenes/nacre.schema.json):
// right-handed, +y up, linear Rec. 709 colours, unit directions that point away from the surface.
//
// Errors are thrown as nacre::Error; what a callback throws is passed on unchanged. Functions may
// be called from several threads at once, and on the same object if it is const. The caller's
// floating-point modes (rounding, denormals, traps) neither change any result nor are changed. The
// interface uses types of the standard library: build with the same one.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#define NACRE_API __attribute__((visibility("default")))

namespace nacre {

// The version of the binary interface. Inline, so that users need not write it; not so in the
// library's own sources, which have types of the same names.
#ifndef NACRE_OWN_SOURCE
inline
#endif
    namespace v0 {

using Vec3 = std::array<double, 3>;
using Rgb = std::array<double, 3>;

// ---- Errors -------------------------------------------------------------------------------------

// One thing that is wrong.
struct Fault {
  std::string where;  // file and JSON pointer, e.g. "grid.json: /materials/gold/roughness"
  std::string what;
  std::string hint;  // how to fix it; may be empty
};

// One or more faults, and the exit code for a program that ends because of them (sysexits.h): 2 for
// images that cannot be compared, 64 wrong arguments, 65 bad input, 70 an internal error or out of
// memory, 74 output that cannot be written.
class NACRE_API Error : public std::exception {
 public:
  Error(int exit_code, std::vector<Fault> faults, std::string message);
  Error(const Error&);
  Error& operator=(const Error&);
  ~Error() override;

  int exit_code() const { return exit_code_; }
  const std::vector<Fault>& faults() const { return faults_; }
  // All faults as text: "error: WHERE: WHAT" and "  hint: HINT" in lines.
  const char* what() const noexcept override;

 private:
  int exit_code_;
  std::vector<Fault> faults_;
  std::string message_;
};

// ---- This build and this machine ----------------------------------------------------------------

NACRE_API std::string Version();  // "0.2.0"

// The SIMD targets that this machine can run, slowest first, of "scalar", "sse4", "avx2", "avx3".
NACRE_API std::vector<std::string> SupportedTargets();
// The one that is used: the fastest, unless SetTarget chose another.
NACRE_API std::string ActiveTarget();
// For the whole process: call it before anything runs. Pictures differ in their last digits.
NACRE_API void SetTarget(const std::string& target);

// The JSON Schema of scene files: every name that the parameters below may have.
NACRE_API std::string SceneSchema();

// ---- Scenes -------------------------------------------------------------------------------------

struct Parameter;
using Parameters = std::vector<Parameter>;

// A value as scene files write it.
class NACRE_API Value {
 public:
  template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
  Value(Number number)  // NOLINT(google-explicit-constructor)
      : json_(ToJson(number)) {}
  Value(double x, double y, double z);       // a point or colour: {"center", {0, 1, 0}}
  Value(const Vec3& xyz);                    // NOLINT(google-explicit-constructor)
  Value(const char* text);                   // NOLINT(google-explicit-constructor)
  Value(const std::string& text);            // NOLINT(google-explicit-constructor)
  Value(const std::vector<double>& list);    // NOLINT(google-explicit-constructor)
  Value(const std::vector<std::string>& l);  // NOLINT(google-explicit-constructor)
  Value(const Parameters& object);           // NOLINT(google-explicit-constructor)
  static Value Json(std::string text);       // anything else, as JSON text

  const std::string& json() const { return json_; }

 private:
  Value() = default;
  static std::string ToJson(double number);  // throws Error unless it is finite
  static std::string ToJson(bool truth);
  template <class Number>
  static std::string ToJson(Number number) {
    return ToJson(static_cast<double>(number));
  }

  std::string json_;
};

struct Parameter {
  std::string name;
  Value value;
};

// Triangles in world space. Without normals faces are flat; both normals and uvs have one entry per
// position, or none.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<std::array<double, 2>> uvs;
  std::vector<uint32_t> triangles;  // three indices each, counter-clockwise from outside
};

// Unit vectors of `count` surface points, each as three arrays x, y, z.
struct Directions {
  size_t count = 0;
  std::array<const double*, 3> normal{}, to_view{}, to_light{};
};

// A reflection model of your own: functions over arrays of directions, which renders call with
// hundreds of points at a time. Light and viewer are above the surface of each. They may be called
// from several threads at once; what they throw ends the render and is passed on. A result that is
// not finite is an Error that names the point.
struct UserBrdf {
  // Writes the BRDF f(l, v) itself, in 1/sr, of point i to rgb[channel][i]. n.l is not part of it:
  // nacre multiplies by it.
  std::function<void(const Directions&, const std::array<double*, 3>& rgb)> evaluate;
  // Both or neither. Without them, directions to environments are sampled by the cosine law as
  // well as by the light; with them, by these in the cosine law's place. `sample` writes unit
  // directions to light made of points (u, v) in [0, 1)^2, as often as `pdf` says per solid angle;
  // those below the surface are light that is lost. Its Directions have no to_light.
  std::function<void(const Directions&, const double* u, const double* v,
                     const std::array<double*, 3>& to_light)>
      sample;
  std::function<void(const Directions&, double* pdf)> pdf;
};

// What is rendered: a scene file, a model (glTF, OBJ, PLY), or built in code, or both. Names and
// values are those of scene files, and so are the checks. These run, on all of it at once, when the
// scene is first rendered, or by Check().
class NACRE_API Scene {
 public:
  Scene();  // empty: black, with the default camera
  static Scene FromFile(const std::string& path);
  // `folder` is where files that the text names are looked for.
  static Scene FromJson(const std::string& text, const std::string& folder = ".");
  Scene(const Scene&);
  Scene& operator=(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  // Sets the value at a JSON pointer: Set("/materials/red/roughness", 0.2), Set("/image/spp", 64).
  // Missing objects on the way are created; for what is no pointer or no JSON, an element of a list
  // or a material, light or texture that is not there, it throws Error, and nothing changes.
  void Set(const std::string& pointer, const Value& value);
  // The value at a JSON pointer, as the file and what was set since say it; none where neither
  // says anything and a default holds. "" is the whole scene, without what AddSphere and AddMesh
  // have added. Of a model (glTF, OBJ, PLY) all but its meshes and maps: camera, image, background,
  // lights, and materials, whose numbers have six digits; it is read for that, which throws Error
  // as Check does. Of a scene file it takes as long as what it returns is large, however much was
  // set.
  std::optional<Value> Get(const std::string& pointer) const;
  // Whether that is something else than null.
  bool Has(const std::string& pointer) const;
  // The same for whole objects. One of the same name is replaced.
  void SetCamera(const Parameters& camera);
  void SetBackground(const Rgb& radiance);
  void AddTexture(const std::string& name, const Parameters& texture);
  void AddMaterial(const std::string& name, const Parameters& material);
  // A material that reflects light by `brdf`. `rest` is a material of which all but the lobes
  // holds: what it reflects of ambient light, emission, coat, sheen, normal maps; of the model
  // lambert unless it names another.
  void AddMaterial(const std::string& name, const UserBrdf& brdf, const Parameters& rest = {});
  void AddLight(const std::string& name, const Parameters& light);
  // Any of the schema's: sphere, mesh, icosphere, uv_sphere, grid, pair, cloud.
  void AddShape(const Parameters& shape);
  // Shapes as numbers, not text, for many of them. They come after all others.
  void AddSphere(const Vec3& center, double radius, const std::string& material);
  void AddMesh(const Mesh& mesh, const std::string& material);

  // Throws Error with everything that is wrong.
  void Check() const;

  // The scene as bytes, of which FromBytes makes it again, in another process as well. Files that
  // it names are not part of them. Throws Error for a scene that has a UserBrdf.
  std::vector<uint8_t> ToBytes() const;
  // Of bytes that ToBytes of the same version has made, and nobody has changed.
  static Scene FromBytes(const std::vector<uint8_t>& bytes);

  size_t sphere_count() const;
  size_t mesh_count() const;
  std::vector<std::string> material_names() const;
  std::vector<std::string> light_names() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// ---- Images -------------------------------------------------------------------------------------

// Pixels x0 <= x < x1, y0 <= y < y1, y downwards from the top.
struct Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

enum class SampleType : uint8_t { kHalf, kFloat, kUint };

struct Channel {
  std::string name;                      // "R", "diffuse.G", "N.X", "Z", "id.object"
  SampleType type = SampleType::kFloat;  // in the file read, or wanted in the file written
  std::vector<float> samples;            // row by row over Image::data
};

struct Image {
  Window frame;  // the whole picture
  Window data;   // the part that the channels cover; smaller than the frame in renders of a region
  std::vector<Channel> channels;
  std::map<std::string, std::string> metadata;

  int width() const { return data.x1 - data.x0; }
  int height() const { return data.y1 - data.y0; }
  // The channel of this name, or nullptr.
  const Channel* Find(const std::string& name) const {
    for (const Channel& channel : channels) {
      if (channel.name == name) return &channel;
    }
    return nullptr;
  }
};

// EXR, PNG, JPEG, TIFF, Radiance HDR and others, as the program. TIFF loads OpenImageIO.
NACRE_API Image Read(const std::string& path);

struct WriteSettings {
  // EXR: colours and normals in half precision; positions, depths and ids always in full.
  bool half_floats = true;
  std::string compression = "zip";  // or none, zips, piz, dwaa
  bool small = false;               // EXR and PNG: smaller, several times slower
  // PNG, of the channels R, G and B.
  std::string tonemap = "neutral";  // or reinhard, reinhard_extended, aces, agx, none
  double exposure = 0;              // in stops
};

// To .exr (linear, all channels) or .png (tone-mapped). The file appears whole or not at all.
NACRE_API void Write(const Image& image, const std::string& path,
                     const WriteSettings& settings = {});

// ---- Pictures for a display ---------------------------------------------------------------------

struct ToneMapSettings {
  std::string layer;                // "diffuse", "light.key"; empty: the channels R, G and B
  std::string tonemap = "neutral";  // or reinhard, reinhard_extended, aces, agx, none
  double exposure = 0;              // in stops, -60 to 60
};

// What a display shows: sRGB codes, row by row from the top, R, G, B and A of a pixel side by side.
struct Picture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;  // A is 255
};

// The codes that Write puts into PNG files. Pixels that hold a NaN are magenta.
NACRE_API Picture ToneMap(const Image& image, const ToneMapSettings& settings = {});

// The bytes of a PNG file, and of a JPEG file with quality 1 to 100 and colours at full resolution.
// Neither keeps A.
NACRE_API std::vector<uint8_t> EncodePng(const Picture& picture);
NACRE_API std::vector<uint8_t> EncodeJpeg(const Picture& picture, int quality = 90);

// ---- Rendering ----------------------------------------------------------------------------------

struct RenderSettings {
  int width = 0, height = 0;     // pixels; 0: the scene's
  int samples = 0;               // a pixel; 0: the scene's. With max_error, the most (0: 4096)
  double max_error = 0;          // > 0: adaptive, as --max-error
  std::optional<uint32_t> seed;  // of the sample pattern; none: the scene's
  Window region;                 // pixels to render; empty: all. The bits of the full frame
  // Besides R G B A: diffuse, specular, ambient, emission, albedo, N, P, Z, id.object, id.material,
  // light.NAME, or all.
  std::vector<std::string> layers;
  int threads = 0;                   // 0: as many as the machine has
  std::string intersector = "auto";  // or embree, tiles, shells; the same bits
  // Told the share done in (0, 1], from any thread, one call at a time. Throwing ends the render.
  std::function<void(double)> on_progress;
  // Set to true by any thread, it ends the render by Cancelled within some milliseconds; before
  // the first pixel, between trees, bins and tables. May be null.
  const std::atomic<bool>* cancel = nullptr;
};

struct RenderStats {
  uint64_t camera_rays = 0, shadow_rays = 0;
  double plan_seconds = 0, render_seconds = 0;
  int threads = 0;
  std::vector<std::string> notes;  // what the picture cannot show, and why
  // Under max_error: pixels that have not converged within the samples, which a note tells as well.
  uint64_t unsettled_pixels = 0;
  uint32_t fewest_samples = 0, most_samples = 0;  // of a pixel
  double mean_samples = 0;
  uint64_t hits = 0, shades = 0;  // a shade is an evaluation of a light at a hit
};

// Thrown by a render that was ended by RenderSettings::cancel or Session::Cancel.
class NACRE_API Cancelled : public std::exception {
 public:
  ~Cancelled() override;
  const char* what() const noexcept override;
};

// All channels in float. `stats` may be null.
NACRE_API Image Render(const Scene& scene, const RenderSettings& settings = {},
                       RenderStats* stats = nullptr);

// ---- Sessions -----------------------------------------------------------------------------------

// A scene that is rendered again and again while it changes. What a change does not touch is not
// read or made again: files, trees, tables of lights. Pictures have the bits that Render would give
// them. One call at a time; Cancel alone may come from any thread. Files are read when the session
// is made, and again by Reload, or where a change touches what they are named in.
class NACRE_API Session {
 public:
  // Of a copy of the scene. Throws Error as Scene::Check does.
  explicit Session(const Scene& scene);
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;
  ~Session();

  // As Scene::Set, but checked at once: throws Error with what is wrong, and the scene is then the
  // one before.
  void Set(const std::string& pointer, const Value& value);
  // As Scene::Get and Scene::Has.
  std::optional<Value> Get(const std::string& pointer) const;
  bool Has(const std::string& pointer) const;

  // Reads the files again that have changed on disk of those that the scene names: textures,
  // models, skies. Returns whether there were any. Values stay what they are; those of the scene's
  // own file are read by Scene::FromFile alone. Throws Error where a file is wrong now: the scene
  // is then the one before, and the next Reload tries again.
  bool Reload();

  // Throws Error as Render does, and Cancelled.
  Image Render(const RenderSettings& settings = {}, RenderStats* stats = nullptr);

  // The same picture, but the means of the first 1, 2, 4, ... samples are shown on the way, and it
  // itself last, with the number of samples. Under max_error there is no other. What `show` throws
  // ends it.
  Image RenderProgressively(const RenderSettings& settings,
                            const std::function<void(const Image&, int samples)>& show,
                            RenderStats* stats = nullptr);

  // Ends a render that runs, within some milliseconds, or else the next one as it begins; not one
  // whose settings have a `cancel` of their own.
  void Cancel();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// ---- Comparing ----------------------------------------------------------------------------------

struct CompareSettings {
  std::vector<std::string> layers;  // empty: all, and then both must have the same channels
  // Samples may differ by max_abs + max_rel |reference|, in all but this fraction of the pixels.
  double max_abs = 0, max_rel = 0, exceeding_fraction = 0;
  // Of any layer. If it is the only tolerance, single samples may differ by any amount.
  double max_rmse = std::numeric_limits<double>::infinity();
  bool perceptual = false;  // measure SSIM and FLIP, too
  // Compare only the pixels that both images have; if false, frames or data windows that differ are
  // a difference.
  bool crop = false;
};

struct LayerMetrics {
  std::string layer;  // "" is the beauty, R G B
  size_t samples = 0;
  double rmse = 0;
  double rel_mse = 0;  // the mean of difference^2 / (reference^2 + 1e-4)
  double psnr_db = 0;  // relative to the reference's largest magnitude
  double max_abs = 0;
  double max_rel = 0;          // of |difference| / |reference|, where the reference is not 0
  size_t zero_mismatches = 0;  // samples that differ where the reference is 0
  double mean = 0, mean_reference = 0;
  std::optional<double> ssim, flip, hdr_flip;  // perceptual, of layers that are colours
};

struct Comparison {
  bool match = false;
  std::string reason;  // in words
  size_t pixels = 0, exceeding_pixels = 0;
  std::vector<LayerMetrics> layers;
};

NACRE_API Comparison Compare(const Image& image, const Image& reference,
                             const CompareSettings& settings = {});

struct HeatMapSettings {
  std::string layer;      // empty: the channels R, G and B
  bool relative = false;  // errors relative to the reference's magnitude
  // The errors at the dark and at the bright end of the colours, which go by the logarithm.
  double low = 1e-6, high = 1;
};

// The largest error of each pixel over the layer's channels, as a colour from dark violet to
// yellow, over the pixels that both images have. Equal pixels are black; magenta are those that are
// not finite in one image only.
NACRE_API Picture HeatMap(const Image& image, const Image& reference,
                          const HeatMapSettings& settings = {});

// ---- Reflection models --------------------------------------------------------------------------

// The BRDF times n.l: radiance towards the viewer per irradiance of a surface that faces the light.
// Unlike the BRDF itself it is finite for every model.
struct Reflection {
  Rgb diffuse{}, specular{};
};

// What `count` points reflect, by channel.
struct Reflections {
  std::array<std::vector<float>, 3> diffuse, specular;
};

// The same in double.
struct ExactReflections {
  std::array<std::vector<double>, 3> diffuse, specular;
};

// The terms of a microfacet lobe at `count` points: D(h), G(l, v), F(v.h) by channel, and Smith's
// Lambda of both directions, so that the lobe is D G F / (4 n.l n.v), without compensation.
struct MicrofacetTerms {
  std::vector<double> d, g, lambda_view, lambda_light;
  std::array<std::vector<double>, 3> f;
};

// A material without maps, emission and ambient light, for measurements and for other renderers.
// The lobe of a perfect mirror (roughness below 2^-20) is left out.
class NACRE_API Brdf {
 public:
  // As in scene files: Brdf("conductor", {{"preset", "gold"}, {"roughness", 0.2}}).
  explicit Brdf(const std::string& model, const Parameters& parameters = {});
  Brdf(const Scene& scene, const std::string& material);
  explicit Brdf(const UserBrdf& brdf);

  // In double, by the formulas of the papers in their stable form. Black where light or viewer is
  // not above the surface. Throws Error for a vector that is not finite, or whose |v|^2 differs
  // from 1 by more than 9.5e-7, which allows for vectors normalised in float.
  Reflection Evaluate(const Vec3& normal, const Vec3& to_view, const Vec3& to_light) const;

  // The same in float through the SIMD kernels of the renderer, in this thread. Throws likewise,
  // and names the first such vector.
  Reflections Shade(const Directions& directions) const;

  // Evaluate for arrays, and likewise of those below.
  ExactReflections Evaluate(const Directions& directions) const;

  // Unit directions to light by points (u, v) in [0, 1)^2, chosen about as often as light is
  // reflected from there, as x, y and z; and the pdf of that per solid angle. `to_light` is not
  // read by Sample. Directions below the surface are light that is lost.
  std::array<std::vector<double>, 3> Sample(const Directions& directions, const double* u,
                                            const double* v) const;
  std::vector<double> Pdf(const Directions& directions) const;

  // What is seen at n.v, in (0, 1], of light of radiance 1 from everywhere, by quadrature: the
  // directional albedo. Perfect mirrors are part of it.
  Rgb Albedo(double n_dot_v) const;

  // Throws Error for models that have no microfacet lobe. Below the surface all terms are 0.
  MicrofacetTerms Terms(const Directions& directions) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace v0
}  // namespace nacre
