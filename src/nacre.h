// SPDX-License-Identifier: Apache-2.0
// nacre.h: the C++17 interface of nacre. Installed as <nacre/nacre.h>, with the library libnacre.
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
// Errors are thrown as nacre::Error; exceptions of a callback are passed on unchanged. Functions
// may be called from several threads at once, and on the same object if it is const. The caller's
// floating-point modes (rounding, denormals, traps) neither affect results nor are changed. The
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

// The version of the binary interface. It is an inline namespace, so that users need not write it,
// except in the library's own sources, which have types with the same names.
#ifndef NACRE_OWN_SOURCE
inline
#endif
    namespace v0 {

using Vec3 = std::array<double, 3>;
using Rgb = std::array<double, 3>;

// ---- Errors -------------------------------------------------------------------------------------

// One error.
struct Fault {
  std::string where;  // file and JSON pointer, e.g. "grid.json: /materials/gold/roughness"
  std::string what;
  std::string hint;  // how to fix it; may be empty
};

// One or more faults, and the exit code for a program that ends because of them (as in sysexits.h):
// 2 images that cannot be compared, 64 wrong arguments, 65 bad input, 70 an internal error or out
// of memory, 74 output that cannot be written.
class NACRE_API Error : public std::exception {
 public:
  Error(int exit_code, std::vector<Fault> faults, std::string message);
  Error(const Error&);
  Error& operator=(const Error&);
  ~Error() override;

  int exit_code() const { return exit_code_; }
  const std::vector<Fault>& faults() const { return faults_; }
  // All faults as text, in lines "error: WHERE: WHAT" and "  hint: HINT".
  const char* what() const noexcept override;

 private:
  int exit_code_;
  std::vector<Fault> faults_;
  std::string message_;
};

// ---- This build and this machine ----------------------------------------------------------------

NACRE_API std::string Version();  // "0.2.0"

// The SIMD targets that this machine supports, slowest first: some of "scalar", "sse4", "avx2",
// "avx3".
NACRE_API std::vector<std::string> SupportedTargets();
// The target in use: the fastest one, unless SetTarget has chosen another.
NACRE_API std::string ActiveTarget();
// Chooses the target for the whole process; to be called before anything else. Pictures of
// different targets differ in their last digits.
NACRE_API void SetTarget(const std::string& target);

// The JSON Schema of scene files, which defines all names of the parameters below.
NACRE_API std::string SceneSchema();

// ---- Scenes -------------------------------------------------------------------------------------

struct Parameter;
using Parameters = std::vector<Parameter>;

// A value as in scene files.
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
  static Value Json(std::string text);       // any other value, as JSON text

  const std::string& json() const { return json_; }

 private:
  Value() = default;
  static std::string ToJson(double number);  // throws Error for NaN and infinities
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

// Triangles in world space. Without normals, faces are flat. `normals` and `uvs` each have one
// entry per position, or are empty.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<std::array<double, 2>> uvs;
  std::vector<uint32_t> triangles;  // three indices each, counter-clockwise from outside
};

// Unit vectors at `count` surface points, each as three arrays x, y, z. Does not own the arrays.
struct Directions {
  size_t count = 0;
  std::array<const double*, 3> normal{}, to_view{}, to_light{};
};

// A reflection model of your own. Its functions work on arrays of directions; renders call them
// with hundreds of points at a time, possibly from several threads at once. Light and viewer are
// above the surface at each point. An exception ends the render and is passed on. A result that is
// not finite is an Error that names the point.
struct UserBrdf {
  // Writes the BRDF f(l, v), in 1/sr, of point i to rgb[channel][i]. It must not include the factor
  // n.l, which nacre applies.
  std::function<void(const Directions&, const std::array<double*, 3>& rgb)> evaluate;
  // Set both or neither. Directions to environments are sampled by MIS of the light and a second
  // strategy: `sample` with `pdf`, or, without them, cosine-weighted directions. `sample` maps
  // points (u, v) in [0, 1)^2 to unit directions to light, distributed with `pdf` per solid angle;
  // directions below the surface count as zero. Its Directions have no to_light.
  std::function<void(const Directions&, const double* u, const double* v,
                     const std::array<double*, 3>& to_light)>
      sample;
  std::function<void(const Directions&, double* pdf)> pdf;
};

// A scene to render: a scene file, a model (glTF, OBJ, PLY), built in code, or a mix of these.
// Names, values and validation are those of scene files. The whole scene is validated when it is
// first rendered, or by Check().
class NACRE_API Scene {
 public:
  Scene();  // empty: black, with the default camera
  static Scene FromFile(const std::string& path);
  // `folder` is where files named in the text are looked for.
  static Scene FromJson(const std::string& text, const std::string& folder = ".");
  Scene(const Scene&);
  Scene& operator=(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  // Sets the value at a JSON pointer: Set("/materials/red/roughness", 0.2), Set("/image/spp", 64).
  // Missing objects on the way are created. Throws Error, and leaves the scene unchanged, for what
  // is not a pointer or not JSON, and for an element of a list, or a material, light or texture,
  // that does not exist.
  void Set(const std::string& pointer, const Value& value);
  // The value at a JSON pointer, as the file has it or as it was set since; nullopt if it is in
  // neither, so that a default applies. "" is the whole scene, without shapes added by AddSphere
  // and AddMesh. For a scene file, the time depends only on the size of the result. For a model
  // (glTF, OBJ, PLY), the values are camera, image, background, lights, and materials with numbers
  // of six digits, without meshes and maps; the model is read for that, which throws Error as Check
  // does.
  std::optional<Value> Get(const std::string& pointer) const;
  // Whether there is a value other than null at the pointer.
  bool Has(const std::string& pointer) const;
  // These set whole objects. An object with the same name is replaced.
  void SetCamera(const Parameters& camera);
  void SetBackground(const Rgb& radiance);
  void AddTexture(const std::string& name, const Parameters& texture);
  void AddMaterial(const std::string& name, const Parameters& material);
  // Adds a material that reflects light by `brdf`. `rest` is a material that supplies everything
  // but the lobes: the reflection of ambient light, emission, coats and layers, normal maps. Its
  // model is lambert unless it names another.
  void AddMaterial(const std::string& name, const UserBrdf& brdf, const Parameters& rest = {});
  void AddLight(const std::string& name, const Parameters& light);
  // Adds a shape of any type in the schema: sphere, mesh, icosphere, uv_sphere, grid, pair, cloud.
  void AddShape(const Parameters& shape);
  // Add shapes as numbers instead of text, which is faster for many of them. They come after all
  // others.
  void AddSphere(const Vec3& center, double radius, const std::string& material);
  void AddMesh(const Mesh& mesh, const std::string& material);

  // Validates the scene. Throws Error with everything that is wrong.
  void Check() const;

  // Serialises the scene to bytes, from which FromBytes restores it, also in another process. Files
  // that it refers to are not included. Throws Error for a scene with a UserBrdf.
  std::vector<uint8_t> ToBytes() const;
  // Restores a scene from unchanged bytes of ToBytes in the same version.
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

// Pixels x0 <= x < x1, y0 <= y < y1; y counts downwards from the top.
struct Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

enum class SampleType : uint8_t { kHalf, kFloat, kUint };

struct Channel {
  std::string name;                      // "R", "diffuse.G", "N.X", "Z", "id.object"
  SampleType type = SampleType::kFloat;  // in the file read, or the wanted type in a file written
  std::vector<float> samples;            // row by row over Image::data
};

struct Image {
  Window frame;  // the whole picture
  Window data;   // the pixels of the channels; smaller than the frame if only a region was rendered
  std::vector<Channel> channels;
  std::map<std::string, std::string> metadata;

  int width() const { return data.x1 - data.x0; }
  int height() const { return data.y1 - data.y0; }
  // The channel with this name, or nullptr.
  const Channel* Find(const std::string& name) const {
    for (const Channel& channel : channels) {
      if (channel.name == name) return &channel;
    }
    return nullptr;
  }
};

// Reads EXR, PNG, JPEG, TIFF, Radiance HDR and other formats of the program. TIFF needs
// OpenImageIO.
NACRE_API Image Read(const std::string& path);

struct WriteSettings {
  // EXR: write colours and normals in half precision; positions, depths and ids never are.
  bool half_floats = true;
  std::string compression = "zip";  // or none, zips, piz, dwaa
  bool small = false;               // EXR and PNG: smaller files, several times slower
  // PNG, which is made from the channels R, G and B:
  std::string tonemap = "neutral";  // or reinhard, reinhard_extended, aces, agx, none
  double exposure = 0;              // in stops
};

// Writes .exr (linear, all channels) or .png (tone-mapped). The file appears completely or not at
// all.
NACRE_API void Write(const Image& image, const std::string& path,
                     const WriteSettings& settings = {});

// ---- Pictures for a display ---------------------------------------------------------------------

struct ToneMapSettings {
  std::string layer;                // "diffuse", "light.key"; empty: the channels R, G and B
  std::string tonemap = "neutral";  // or reinhard, reinhard_extended, aces, agx, none
  double exposure = 0;              // in stops, -60 to 60
};

// A picture for a display: sRGB codes, row by row from the top, with R, G, B and A interleaved.
struct Picture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;  // A is always 255
};

// Computes the codes that Write puts into PNG files. Pixels with a NaN become magenta.
NACRE_API Picture ToneMap(const Image& image, const ToneMapSettings& settings = {});

// The bytes of a PNG file, or of a JPEG file with quality 1 to 100 and without chroma subsampling.
// Neither keeps A.
NACRE_API std::vector<uint8_t> EncodePng(const Picture& picture);
NACRE_API std::vector<uint8_t> EncodeJpeg(const Picture& picture, int quality = 90);

// ---- Rendering ----------------------------------------------------------------------------------

struct RenderSettings {
  int width = 0, height = 0;  // pixels; 0: the scene's
  int samples = 0;            // per pixel; 0: the scene's. With max_error, the maximum (0: 4096)
  double max_error = 0;       // > 0: adaptive sampling, as --max-error
  std::optional<uint32_t> seed{};  // of the sample pattern; nullopt: the scene's
  Window region{};                 // pixels to render, bit for bit as in the full frame; empty: all
  // Channels besides R G B A: diffuse, specular, ambient, emission, albedo, N, P, Z, id.object,
  // id.material, light.NAME, or all.
  std::vector<std::string> layers{};
  int threads = 0;                   // 0: as many as the machine has
  std::string intersector = "auto";  // or embree, tiles, shells, which give the same bits
  // Called with the finished fraction in (0, 1], from any thread, but one call at a time. It may
  // throw to end the render.
  std::function<void(double)> on_progress{};
  // Any thread may set it to true, which ends the render by Cancelled within some milliseconds;
  // before the first pixel, once the current tree, bin or table is built. May be null.
  const std::atomic<bool>* cancel = nullptr;
  // Settings by name, those of NamedSettings(). They win over the members of the same name.
  Parameters others{};
};

// The settings that RenderSettings::others may have, and their meanings.
NACRE_API std::map<std::string, std::string> NamedSettings();

struct RenderStats {
  uint64_t camera_rays = 0, shadow_rays = 0;
  double plan_seconds = 0, render_seconds = 0;
  int threads = 0;
  std::vector<std::string> notes;  // what the picture cannot show, and why
  // With max_error: pixels that have not converged within the samples, which a note reports, too.
  uint64_t unsettled_pixels = 0;
  uint32_t fewest_samples = 0, most_samples = 0;  // per pixel
  double mean_samples = 0;
  uint64_t hits = 0, shades = 0;  // a shade is the evaluation of a light at a hit
};

// Thrown by a render that RenderSettings::cancel or Session::Cancel has ended.
class NACRE_API Cancelled : public std::exception {
 public:
  ~Cancelled() override;
  const char* what() const noexcept override;
};

// Renders a picture, with all channels in float. `stats` may be null.
NACRE_API Image Render(const Scene& scene, const RenderSettings& settings = {},
                       RenderStats* stats = nullptr);

// ---- Sessions -----------------------------------------------------------------------------------

// A scene that is rendered repeatedly while it changes. Data that a change does not affect is not
// read or built again: files, trees, light tables. Pictures are bit for bit those of Render. Only
// one call may run at a time, except Cancel, which may come from any thread. Files are read when
// the session is made, and again by Reload, or when a change affects the objects that name them.
class NACRE_API Session {
 public:
  // Copies the scene. Throws Error as Scene::Check does.
  explicit Session(const Scene& scene);
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;
  ~Session();

  // Like Scene::Set, but validates immediately: throws Error with what is wrong, and then leaves
  // the scene unchanged.
  void Set(const std::string& pointer, const Value& value);
  // Like Scene::Get and Scene::Has.
  std::optional<Value> Get(const std::string& pointer) const;
  bool Has(const std::string& pointer) const;

  // Reads again those files that have changed on disk and that the scene refers to: textures,
  // models, skies. Returns whether there were any. The values of the scene stay unchanged: only
  // Scene::FromFile reads the scene's own file. Throws Error if a file is now invalid; then the
  // scene stays unchanged, and the next Reload tries again.
  bool Reload();

  // Renders a picture. Throws Error as the function Render does, and Cancelled.
  Image Render(const RenderSettings& settings = {}, RenderStats* stats = nullptr);

  // Renders the same picture, and passes the means of the first 1, 2, 4, ... samples to `show` on
  // the way, and finally the picture itself, with the number of samples. With max_error, only the
  // final picture is shown. An exception of `show` ends the render.
  Image RenderProgressively(const RenderSettings& settings,
                            const std::function<void(const Image&, int samples)>& show,
                            RenderStats* stats = nullptr);

  // Ends the current render within some milliseconds, or, if there is none, the next one as it
  // begins. Has no effect on a render whose settings have a `cancel` of their own.
  void Cancel();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// ---- Comparing ----------------------------------------------------------------------------------

struct CompareSettings {
  std::vector<std::string> layers;  // empty: all; then both images must have the same channels
  // Samples may differ by max_abs + max_rel |reference|, except in this fraction of the pixels.
  double max_abs = 0, max_rel = 0, exceeding_fraction = 0;
  // The maximum for any layer. If it is the only tolerance, single samples may differ by any
  // amount.
  double max_rmse = std::numeric_limits<double>::infinity();
  bool perceptual = false;  // measure SSIM and FLIP, too
  // Compare only the pixels that both images have. If false, different frames or data windows are a
  // difference.
  bool crop = false;
};

struct LayerMetrics {
  std::string layer;  // "" is the beauty, R G B
  size_t samples = 0;
  double rmse = 0;
  double rel_mse = 0;  // the mean of difference^2 / (reference^2 + 1e-4)
  double psnr_db = 0;  // relative to the reference's largest magnitude
  double max_abs = 0;
  double max_rel = 0;          // the maximum of |difference| / |reference| where the reference is
                               // not 0
  size_t zero_mismatches = 0;  // samples that differ where the reference is 0
  double mean = 0, mean_reference = 0;
  std::optional<double> ssim, flip, hdr_flip;  // if perceptual, for layers of colours
};

struct Comparison {
  bool match = false;
  std::string reason;  // the verdict in one line
  size_t pixels = 0, exceeding_pixels = 0;
  std::vector<LayerMetrics> layers;
};

NACRE_API Comparison Compare(const Image& image, const Image& reference,
                             const CompareSettings& settings = {});

struct HeatMapSettings {
  std::string layer;      // empty: the channels R, G and B
  bool relative = false;  // errors relative to the reference's magnitude
  // The errors that are shown as the darkest and the brightest colour; the scale is logarithmic.
  double low = 1e-6, high = 1;
};

// Shows the largest error of each pixel over the layer's channels as a colour from dark violet to
// yellow, for the pixels that both images have. Equal pixels are black; pixels that are not finite
// in only one image are magenta.
NACRE_API Picture HeatMap(const Image& image, const Image& reference,
                          const HeatMapSettings& settings = {});

// ---- Reflection models --------------------------------------------------------------------------

// The BRDF times n.l: the radiance towards the viewer for an irradiance of 1 on a surface that
// faces the light. Unlike the BRDF itself, it is finite for every model.
struct Reflection {
  Rgb diffuse{}, specular{};
};

// The reflection at `count` points, by channel.
struct Reflections {
  std::array<std::vector<float>, 3> diffuse, specular;
};

// The reflection at `count` points, by channel, in double.
struct ExactReflections {
  std::array<std::vector<double>, 3> diffuse, specular;
};

// The terms of a microfacet lobe at `count` points: D(h), G(l, v), F(v.h) by channel, and Smith's
// Lambda of both directions, so that the lobe is D G F / (4 n.l n.v), without compensation.
struct MicrofacetTerms {
  std::vector<double> d, g, lambda_view, lambda_light;
  std::array<std::vector<double>, 3> f;
};

// Numbers with named columns, row by row: the values of a BRDF over pairs of directions, of nacre
// or of another program.
struct Table {
  std::string header;  // a JSON object that says what the numbers depend on; may be empty
  std::vector<std::string> columns;
  std::vector<double> values;  // columns.size() for each row
};

// Angles in degrees: of light and view from the normal +z, and of the light about it, counted from
// the view, which itself is at an azimuth from the tangent +x.
struct TableGrid {
  std::vector<double> light{0, 15, 30, 45, 60, 75, 85, 89};
  std::vector<double> view{0, 15, 30, 45, 60, 75, 85, 89};
  std::vector<double> phi{0, 45, 90, 135, 165, 175, 180};
  double view_phi = 30;
};

// All pairs of directions of a grid: the columns light_x, light_y, light_z, view_x, view_y, view_z.
NACRE_API Table TableDirections(const TableGrid& grid = {});

// A table as a file: .csv, .json or .npy. Each double is read as it was written. The header of a
// .npy file is in a second one, FILE.npy.json. ReadTable takes the files of other programs as well.
NACRE_API Table ReadTable(const std::string& path);
NACRE_API void WriteTable(const Table& table, const std::string& path);

// What is wrong with the table of another program.
struct TableCheck {
  bool ok = false;   // all values are finite and within the tolerance
  std::string page;  // for people: where it differs, by how much, and what explains it
  std::string json;  // the same for programs
};

// A material without maps, emission and ambient light, for measurements and for other renderers.
// The lobe of a perfect mirror (roughness below 2^-20) is omitted.
class NACRE_API Brdf {
 public:
  // With parameters as in scene files: Brdf("conductor", {{"preset", "gold"}, {"roughness", 0.2}}).
  explicit Brdf(const std::string& model, const Parameters& parameters = {});
  Brdf(const Scene& scene, const std::string& material);
  explicit Brdf(const UserBrdf& brdf);

  // Evaluates in double, by the formulas of the papers in their numerically stable form. Black if
  // light or viewer is not above the surface. Throws Error for a vector that is not finite, or
  // whose |v|^2 differs from 1 by more than 9.5e-7, which allows for vectors normalised in float.
  Reflection Evaluate(const Vec3& normal, const Vec3& to_view, const Vec3& to_light) const;

  // Evaluates in float with the renderer's SIMD kernels, in this thread. Throws as Evaluate does,
  // and names the first invalid vector.
  Reflections Shade(const Directions& directions) const;

  // Evaluates arrays in double. Throws as Shade does, as do Sample, Pdf and Terms.
  ExactReflections Evaluate(const Directions& directions) const;

  // Sample maps points (u, v) in [0, 1)^2 to unit directions to light, as arrays x, y and z,
  // distributed approximately like the reflected light; Pdf is their pdf per solid angle. Sample
  // does not read `to_light`. Directions below the surface count as zero.
  std::array<std::vector<double>, 3> Sample(const Directions& directions, const double* u,
                                            const double* v) const;
  std::vector<double> Pdf(const Directions& directions) const;

  // The directional albedo at n.v in (0, 1], computed by quadrature: the radiance that is reflected
  // under a uniform radiance of 1. It includes perfect mirrors.
  Rgb Albedo(double n_dot_v) const;

  // Throws Error for models without a microfacet lobe. Below the surface, all terms are 0.
  MicrofacetTerms Terms(const Directions& directions) const;

  // Evaluates the pairs of directions of a table, whose other columns are not read. The columns
  // are these directions, f in 1/sr without n.l, what each lobe contributes to it, the pdf of
  // Sample, and the directional albedo, unless it is left out. The normal is +z. Throws Error for
  // directions that are not unit vectors.
  Table Tabulate(const Table& directions, bool albedo = true) const;

  // Compares a table of another program, with columns light_x ... view_z and f_r, f_g, f_b, with
  // the values of this model. Tries the mistakes that implementers make, and says which one
  // explains the differences. `name` is the table's name in messages. The tolerance is that of a
  // difference relative to the larger of both values. Throws Error for what is no such table.
  TableCheck CheckTable(const Table& theirs, double tolerance = 1e-3,
                        const std::string& name = "table") const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace v0
}  // namespace nacre
