// SPDX-License-Identifier: Apache-2.0
// scene/scene.h: the one scene type: plain structs, a default for every field, references as
// typed handles. What scene_io reads, the generators make and the renderer plans from.
// Ranges of all numbers: scene/limits.h.
//
// World space is right-handed, +y up. All positions and lengths are doubles in world units and
// stay as the file has them; everything in float later on is relative to the camera.
// Colours are linear Rec. 709. Directional light: irradiance on a surface facing it. Point and
// spot: radiant intensity. All others and the background: radiance.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/image.h"
#include "base/vec.h"
#include "brdf/ggx.h"
#include "sampling/pixel_filter.h"
#include "texture/mapping.h"
#include "texture/sample.h"

namespace nacre {

// An index into one of the scene's arrays; kInvalid means none.
template <typename Tag>
struct Handle {
  static constexpr uint32_t kInvalid = 0xffffffffu;
  uint32_t index = kInvalid;

  bool valid() const { return index != kInvalid; }
  bool operator==(const Handle&) const = default;
};
using MaterialId = Handle<struct MaterialTag>;
using ImageId = Handle<struct ImageTag>;
using TextureId = Handle<struct TextureTag>;

// ---- Camera and image ---------------------------------------------------------------------------

enum class Projection : uint8_t { kPerspective, kOrthographic };

struct Camera {
  Projection projection = Projection::kPerspective;
  Vec3d position{0, 0, 10};
  Vec3d look_at{0, 0, 0};
  Vec3d up{0, 1, 0};
  double fov_y_deg = 30;  // perspective: full vertical field of view, in (0, 180)
  double height = 2;      // orthographic: height of the view in world units, > 0
};

struct ImageSettings {
  int width = 1280;  // in [1, 65536]
  int height = 720;  // in [1, 65536]
  int spp = 16;      // samples per pixel, in [1, 65536]; 1 is the pixel's centre
  PixelFilter filter;
  uint32_t seed = 0;    // of the sample pattern
  bool shadows = true;  // false: no light casts any
};

// ---- Textures -----------------------------------------------------------------------------------

// A decoded image file. Shared, so that scenes are copied without it.
struct SceneImage {
  std::string file;  // as the scene names it
  std::shared_ptr<const MipChain> texels;
  float middle = 0.5f;  // the value that stands for 0 in a normal map: 128/255 of 8-bit files
};

// An image on surfaces. (u, v) has its origin at the lower left corner of the image, v up. It comes
// from the mapping, is scaled, turned and then moved (as in glTF's KHR_texture_transform, but with
// v up), and then wrapped.
//
// Mappings but kUv see an object with its axis up: a sphere in units of its radius around its
// centre, a mesh in units of `size` around `center`. Longitudes begin behind the axis +y, at -z,
// and go to the right as seen from outside; v is 1 at the axis' end.
struct Texture {
  std::string name;
  ImageId image;
  SampleSettings sampling;
  MappingKind mapping = MappingKind::kUv;
  Vec3d axis{0, 1, 0};    // any length > 0
  double rotate_deg = 0;  // about the axis, right-handed
  Vec3d center{0, 0, 0};  // of meshes
  double size = 1;        // of meshes, > 0
  Vec2d scale{1, 1};
  double uv_rotate_deg = 0;  // counter-clockwise
  Vec2d offset{0, 0};
  bool second_uvs = false;  // kUv: on the meshes' second coordinates
};

// Tangent-space normals, x along growing u, y along growing v.
struct NormalMap {
  TextureId texture{};
  double scale = 1;  // of x and y
  // How a value c in [0, 1] is read.
  enum class Convention : uint8_t {
    kExactFlat,  // 8-bit files as (255 c - 128) / 127, so that 128 is exactly 0; others as 2 c - 1
    kLiteral,    // 2 c - 1: a flat 8-bit map, (128, 128, 255), leans by 0.3 degrees
  };
  Convention convention = Convention::kExactFlat;
};

// What the colours of a mesh's vertices multiply.
enum class VertexColors : uint8_t {
  kNone,
  kBase,      // the base colour, or albedo
  kEmission,  // of materials that are not lit
};

// Heights, whose slope turns the normal; the surface stays where it is.
struct BumpMap {
  TextureId texture{};
  double distance = 0.01;  // world units between the values 0 and 1; below 0: into the surface
};

// ---- Materials ----------------------------------------------------------------------------------

// How the Phong family's coefficients are read.
//   kClassic: the equations as the lessons write them: no 1/pi, no lobe normalisation; the
//     light's irradiance perpendicular to it takes the place of I_l.
//   kRadiometric: kd/pi, and lobes normalised so that ks is the reflectance at normal incidence;
//     comparable with the physical models under the same light.
enum class PhongConvention : uint8_t { kClassic, kRadiometric };

enum class PhongModel : uint8_t {
  kPhong,          // ks (r.v)^n where n.l > 0 (Phong 1975, gated), without n.l
  kModifiedPhong,  // ks (r.v)^n n.l (Lewis 1994)
  kBlinnPhong,     // ks (n.h)^n where n.l > 0 (Blinn 1977), without n.l
};

// Matte surfaces.

struct LambertMaterial {
  Rgb albedo{0.5, 0.5, 0.5};  // each in [0, 1]
  TextureId albedo_map{};
};

// Rough clay, plaster, the moon: as bright at its edge as in its middle. Keeps energy (brdf/eon.h).
struct OrenNayarMaterial {
  Rgb albedo{0.5, 0.5, 0.5};  // each in [0, 1]
  double roughness = 0.5;     // the model's own, in [0, 1]; 0: Lambert's
  TextureId albedo_map{};
};

// Disney's diffuse term (brdf/burley.h), fitted to measurements. Makes light at grazing angles.
struct BurleyMaterial {
  Rgb albedo{0.5, 0.5, 0.5};  // each in [0, 1]
  double roughness = 0.5;     // perceptual, in [0, 1]
  TextureId albedo_map{};
};

struct PhongMaterial {
  PhongModel model = PhongModel::kPhong;
  PhongConvention convention = PhongConvention::kRadiometric;
  Rgb color{1, 1, 1};  // multiplies ambient and diffuse
  Rgb ka{0.1, 0.1, 0.1};
  Rgb kd{0.7, 0.7, 0.7};
  Rgb ks{0.3, 0.3, 0.3};
  double shininess = 32;      // exponent n >= 0
  TextureId diffuse_map{};    // of color kd and color ka
  TextureId specular_map{};   // of ks
  TextureId shininess_map{};  // of the exponent
};

// The light that bounces more than once between microfacets, which a single-scattering lobe
// loses: 59 % of it at roughness 1.
enum class Compensation : uint8_t {
  kTurquin,     // scales the lobe to what the viewer lacks (Turquin 2019); not reciprocal
  kKullaConty,  // adds a diffuse-like lobe (Kulla and Conty 2017); reciprocal
  kNone,        // single scattering, energy lost
};

// How much light the diffuse base gets from under the specular lobe.
enum class DiffuseCoupling : uint8_t {
  kAlbedoScaled,     // what the lobe's albedo leaves: a white surface reflects exactly all
  kOneMinusFresnel,  // 1 - F(v.h), the lesson's; a white surface may reflect 1.8 times the light
  kNone,             // all of it
};

// How the diffuse base of a microfacet model reflects.
enum class DiffuseForm : uint8_t { kLambert, kOrenNayar, kBurley };

// The microfacet models have a GGX lobe each. Roughness is perceptual, in [0, 1]:
// alpha = roughness^2; 0 is a perfect mirror.

// Metallic-roughness as in glTF 2.0 with KHR_materials_ior and KHR_materials_specular: GGX and
// Schlick's Fresnel, from F0 = mix(specular dielectric_f0, base_color, metallic) to F90 =
// mix(specular, 1, metallic), over a diffuse base (1 - metallic) base_color / pi.
struct MetallicRoughnessMaterial {
  Rgb base_color{0.8, 0.8, 0.8};  // each in [0, 1]
  double metallic = 0;            // in [0, 1]
  // What it reflects at normal incidence where it is no metal; each in [0, 1].
  Rgb dielectric_f0{0.04, 0.04, 0.04};
  double specular = 1;  // in [0, 1]: how much of that there is, at all angles
  // What Schlick's reflectance at cosine 1/7 (81.8 degrees) is multiplied by (Kutz et al. 2021):
  // the dip of real metals just before grazing. 1: Schlick's curve itself.
  Rgb f82_tint{1, 1, 1};  // each in [0, 1]
  double roughness = 0.5;
  Shadowing shadowing = Shadowing::kHeightCorrelated;
  Compensation compensation = Compensation::kTurquin;
  DiffuseCoupling diffuse_coupling = DiffuseCoupling::kAlbedoScaled;
  DiffuseForm diffuse = DiffuseForm::kLambert;
  std::optional<double> diffuse_roughness{};  // of the base, in [0, 1]; none: the lobe's
  TextureId base_color_map{};
  TextureId metallic_roughness_map{};  // as in glTF: green multiplies roughness, blue metallic
  TextureId specular_map{};            // of `specular`
  TextureId specular_color_map{};      // of dielectric_f0
};

enum class ConductorFresnel : uint8_t {
  kExact,    // unpolarised, of the complex index eta - i k
  kF82Tint,  // through its values at normal incidence and at cosine 1/7
  kSchlick,  // through its value at normal incidence
};

// A bare metal of complex index of refraction eta - i k, per channel.
struct ConductorMaterial {
  Rgb eta{0.2, 0.2, 0.2};  // > 0; the defaults are a grey like silver's
  Rgb k{3, 3, 3};          // >= 0
  double roughness = 0.5;
  ConductorFresnel fresnel = ConductorFresnel::kExact;
  Shadowing shadowing = Shadowing::kHeightCorrelated;
  Compensation compensation = Compensation::kTurquin;
  TextureId roughness_map{};
};

enum class DielectricFresnel : uint8_t { kExact, kSchlick };

// A clear coat of index of refraction `ior` over a diffuse base; nothing is transmitted, so a
// black base shows the reflection of glass alone.
struct DielectricMaterial {
  Rgb base_color{0.8, 0.8, 0.8};  // each in [0, 1]
  double ior = 1.5;               // in [1, 10]
  double roughness = 0.5;
  DielectricFresnel fresnel = DielectricFresnel::kExact;
  Shadowing shadowing = Shadowing::kHeightCorrelated;
  Compensation compensation = Compensation::kTurquin;
  DiffuseCoupling diffuse_coupling = DiffuseCoupling::kAlbedoScaled;
  DiffuseForm diffuse = DiffuseForm::kLambert;
  std::optional<double> diffuse_roughness{};  // of the base, in [0, 1]; none: the lobe's
  TextureId base_color_map{};
  TextureId roughness_map{};
};

// Not a model of its own: chooses among other materials by where the sample lies on screen, in
// vertical bands. materials.size() == at.size() + 1; `at` ascends in (0, 1), as fractions of the
// image width.
struct SplitMaterial {
  std::vector<double> at;
  std::vector<MaterialId> materials;
};

struct Material {
  std::string name;
  Rgb emission{0, 0, 0};  // radiance, >= 0
  // Only spheres' outsides and triangles' fronts emit (from where their corners run
  // counter-clockwise).
  bool emits_in_front_only = false;
  std::variant<LambertMaterial, PhongMaterial, MetallicRoughnessMaterial, ConductorMaterial,
               DielectricMaterial, SplitMaterial, OrenNayarMaterial, BurleyMaterial>
      model;
  // Maps multiply the numbers beside them.
  TextureId emission_map{};
  NormalMap normal_map{};
  BumpMap bump_map{};
  VertexColors vertex_colors = VertexColors::kNone;
};

// ---- Lights -------------------------------------------------------------------------------------

// Fall-off with the distance d of a point or spot light: 1 / (constant + linear d + quadratic d^2).
struct Attenuation {
  double constant = 0;   // >= 0
  double linear = 0;     // >= 0
  double quadratic = 1;  // >= 0; not all three 0

  static Attenuation None() { return {1, 0, 0}; }
  static Attenuation InverseSquare() { return {0, 0, 1}; }
  bool operator==(const Attenuation&) const = default;
};

struct AmbientLight {
  Rgb radiance{0, 0, 0};
};

struct DirectionalLight {
  Vec3d direction_of_travel{0, -1, 0};  // any length > 0
  Rgb irradiance{1, 1, 1};              // on a surface facing the light
};

struct PointLight {
  Vec3d position{0, 0, 0};
  Rgb intensity{1, 1, 1};
  Attenuation attenuation;
};

// Intensity times cos(a)^exponent within the cone (a: angle from the axis), dark at and beyond
// cutoff_deg; between inner_deg and cutoff_deg a smooth penumbra. inner_deg == cutoff_deg is the
// hard cone.
// The curve from cutoff to inner angle, over the cosine t scaled to [0, 1] in between.
enum class SpotEdge : uint8_t {
  kSmoothstep,  // t^2 (3 - 2 t)
  kSquare,      // t^2, as glTF's KHR_lights_punctual has it
};

struct SpotLight {
  Vec3d position{0, 0, 0};
  Vec3d direction_of_travel{0, -1, 0};  // the axis, any length > 0
  Rgb intensity{1, 1, 1};
  Attenuation attenuation;
  double cutoff_deg = 30;  // half-angle, in (0, 180]
  double inner_deg = 30;   // in [0, cutoff_deg]
  double exponent = 0;     // >= 0
  SpotEdge edge = SpotEdge::kSmoothstep;
};

// Surfaces that emit the same radiance everywhere and in all directions. `visible`: the camera sees
// them, and they block the light of others.

// Emits outwards.
struct SphereAreaLight {
  Vec3d center{0, 0, 0};
  double radius = 1;  // > 0
  Rgb radiance{1, 1, 1};
  bool visible = true;
};

struct RectangleAreaLight {
  Vec3d center{0, 0, 0};
  Vec3d facing{0, -1, 0};        // the side that emits, any length > 0
  Vec3d up{0, 0, -1};            // along its height, made perpendicular to `facing`
  double width = 1, height = 1;  // > 0
  Rgb radiance{1, 1, 1};
  bool two_sided = false;
  bool visible = true;
};

struct DiskAreaLight {
  Vec3d center{0, 0, 0};
  Vec3d facing{0, -1, 0};  // the side that emits, any length > 0
  double radius = 1;       // > 0
  Rgb radiance{1, 1, 1};
  bool two_sided = false;
  bool visible = true;
};

struct Mesh;

// Triangles that emit on the side where their corners run counter-clockwise. Along a direction the
// nearest of them is seen, by the camera and by what it shines on.
struct MeshAreaLight {
  // Its positions and triangles count. Shared by copies of the scene, never changed.
  std::shared_ptr<const Mesh> mesh;
  Rgb radiance{1, 1, 1};
  bool two_sided = false;
  bool visible = true;
};

// What an environment looks like. Directions are unit vectors; +y is up.
struct ConstantSky {
  Rgb radiance{1, 1, 1};
};

// From the horizon's colour to the zenith's with the height y of the direction, mix(horizon,
// zenith, y); below the horizon likewise to the ground's.
struct GradientSky {
  Rgb zenith{0.3, 0.5, 1}, horizon{1, 1, 1}, ground{0.2, 0.2, 0.2};
};

// radiance (constant + linear c + quadratic c^2), c the cosine of the angle from `axis`; >= 0 for
// every c in [-1, 1].
struct QuadraticSky {
  Rgb radiance{1, 1, 1};
  Vec3d axis{0, 1, 0};  // any length > 0
  double constant = 1, linear = 0, quadratic = 0;
};

// Linear radiance by direction, row by row from +y down to -y: the texel at (u, v) in [0, 1)^2 is
// seen in the direction (sin 2 pi u sin pi v, cos pi v, -cos 2 pi u sin pi v). A texel has one
// value all over.
struct SkyPicture {
  int width = 0, height = 0;
  std::vector<float> rgb;  // 3 width height, each >= 0
};

struct PictureSky {
  std::shared_ptr<const SkyPicture> picture;  // shared by copies of the scene, never changed
  Rgb scale{1, 1, 1};
};

// Light from infinitely far, all around.
struct EnvironmentLight {
  std::variant<ConstantSky, GradientSky, QuadraticSky, PictureSky> sky;
  double rotate_deg = 0;   // about +y, right-handed
  bool background = true;  // seen where nothing is hit, in place of Scene::background
};

struct Light {
  std::string name;  // unique; names the layer light.<name>
  bool shadows = true;
  bool fast = false;  // approximations, whose error is told, in the place of samples
  std::variant<AmbientLight, DirectionalLight, PointLight, SpotLight, SphereAreaLight,
               RectangleAreaLight, DiskAreaLight, EnvironmentLight, MeshAreaLight>
      kind;
};

// True for lights without extent, which reach a point from one direction.
inline bool IsPunctual(const Light& light) {
  return std::holds_alternative<DirectionalLight>(light.kind) ||
         std::holds_alternative<PointLight>(light.kind) ||
         std::holds_alternative<SpotLight>(light.kind);
}

// ---- Shapes -------------------------------------------------------------------------------------

struct Sphere {
  Vec3d center{0, 0, 0};
  double radius = 1;  // > 0
  MaterialId material;
};

// What is interpolated across a triangle.
enum class Interpolation : uint8_t {
  kPhong,    // the vertices' normals, renormalised at each point (Phong 1975)
  kGouraud,  // what the vertices reflect (Gouraud 1971), diffuse and specular apart
  kFlat,     // nothing: all of it reflects what its centroid does under the face normal
  kFaceted,  // nothing but the position: the face normal at each point
};

struct Mesh {
  std::string name;
  std::vector<Vec3d> positions;     // world space
  std::vector<Vec3d> normals;       // unit, one per position; empty: face normals
  std::vector<Vec2d> uvs;           // one per position, or empty; (0, 0) is an image's bottom left
  std::vector<Vec2d> second_uvs;    // likewise, of textures that ask for them
  std::vector<Vec3f> colors;        // linear, each in [0, 1], one per position, or empty
  std::vector<uint32_t> triangles;  // three indices each, counter-clockwise from outside
  MaterialId material;
  Interpolation interpolation = Interpolation::kPhong;
  // Shadow rays of smooth normals start on the surface that the normals tell of, not in the
  // triangle (Hanika 2021): no jagged shadows along the terminator of coarse meshes.
  bool smooth_terminator = true;
};

// Whether hits have normals of their own, interpolated from the vertices.
inline bool HasSmoothNormals(const Mesh& mesh) {
  return !mesh.normals.empty() && (mesh.interpolation == Interpolation::kPhong ||
                                   mesh.interpolation == Interpolation::kGouraud);
}

// Text that --labels writes into the PNG, beside the projection of a world point.
struct Label {
  enum class Side : uint8_t { kLeft, kAbove, kBelow };
  std::string text;
  Vec3d anchor;
  Side side = Side::kLeft;  // of the anchor
};

struct Scene {
  Camera camera;
  ImageSettings image;
  std::vector<SceneImage> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Light> lights;
  std::vector<Sphere> spheres;
  std::vector<Mesh> meshes;
  std::vector<Label> labels;
  Rgb background{0, 0, 0};
};

}  // namespace nacre
