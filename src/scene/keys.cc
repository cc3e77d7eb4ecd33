// SPDX-License-Identifier: Apache-2.0
#include "scene/keys.h"

#include <algorithm>
#include <array>
#include <type_traits>

namespace nacre {
namespace {

using Words = std::span<const std::string_view>;

template <class Struct, class Field>
Struct OwnerOf(Field Struct::*);

// Follows pointers to members from struct to struct, and returns the field that they lead to.
template <auto kMember, auto... kMembers, class Struct>
auto& MemberOf(Struct& owner) {
  auto& field = owner.*kMember;
  if constexpr (sizeof...(kMembers) == 0) {
    return field;
  } else {
    return MemberOf<kMembers...>(field);
  }
}

// Makes a key of the struct that the first of the members belongs to.
template <auto kMember, auto... kMembers>
constexpr auto KeyOf(std::string_view name, KeyForm form, const Range& range, Words options,
                     std::string_view meaning, KeyUse use) {
  using Owner = decltype(OwnerOf(kMember));
  return SceneKey<Owner>{
      name,
      form,
      use,
      range,
      options,
      meaning,
      [](const Owner& owner) {
        const auto& field = MemberOf<kMember, kMembers...>(owner);
        using Field = std::remove_cvref_t<decltype(field)>;
        if constexpr (std::is_same_v<Field, Vec3d> || std::is_same_v<Field, Rgb>) {
          return Vec3d(field);
        } else {
          return Vec3d(static_cast<double>(field), 0, 0);
        }
      },
      [](Owner& owner, const Vec3d& value) {
        auto& field = MemberOf<kMember, kMembers...>(owner);
        using Field = std::remove_cvref_t<decltype(field)>;
        if constexpr (std::is_same_v<Field, Vec3d> || std::is_same_v<Field, Rgb>) {
          field = Field(value);
        } else if constexpr (std::is_enum_v<Field>) {
          field = static_cast<Field>(static_cast<int>(value.x));
        } else {
          field = static_cast<Field>(value.x);
        }
      }};
}

template <auto... kMembers>
constexpr auto NumberKey(std::string_view name, const Range& range, std::string_view meaning,
                         KeyUse use = KeyUse::kOptional) {
  return KeyOf<kMembers...>(name, KeyForm::kNumber, range, {}, meaning, use);
}
template <auto... kMembers>
constexpr auto WholeKey(std::string_view name, const Range& range, std::string_view meaning) {
  return KeyOf<kMembers...>(name, KeyForm::kWhole, range, {}, meaning, KeyUse::kOptional);
}
template <auto... kMembers>
constexpr auto ColorKey(std::string_view name, std::string_view meaning,
                        KeyUse use = KeyUse::kRequired) {
  return KeyOf<kMembers...>(name, KeyForm::kColor, limits::kRadiance, {}, meaning, use);
}
template <auto... kMembers>
constexpr auto PointKey(std::string_view name, std::string_view meaning,
                        KeyUse use = KeyUse::kRequired) {
  return KeyOf<kMembers...>(name, KeyForm::kPoint, limits::kCoordinate, {}, meaning, use);
}
template <auto... kMembers>
constexpr auto DirectionKey(std::string_view name, std::string_view meaning,
                            KeyUse use = KeyUse::kRequired) {
  return KeyOf<kMembers...>(name, KeyForm::kDirection, limits::kCoordinate, {}, meaning, use);
}
template <auto... kMembers>
constexpr auto BooleanKey(std::string_view name, std::string_view meaning) {
  return KeyOf<kMembers...>(name, KeyForm::kBoolean, {}, {}, meaning, KeyUse::kOptional);
}
// `options` are in the order of the enumeration.
template <auto... kMembers>
constexpr auto ChoiceKey(std::string_view name, Words options, std::string_view meaning,
                         KeyUse use = KeyUse::kOptional) {
  return KeyOf<kMembers...>(name, KeyForm::kChoice, {}, options, meaning, use);
}

// --- The camera and its picture. ---

constexpr std::array<std::string_view, 2> kProjections = {"perspective", "orthographic"};
constexpr auto kProjection = ChoiceKey<&Camera::projection>("type", kProjections, "");
constexpr auto kEye = PointKey<&Camera::position>("position", "", KeyUse::kOptional);
constexpr auto kLookAt = PointKey<&Camera::look_at>(
    "look_at", "The point that is seen in the middle of the image.", KeyUse::kOptional);
constexpr auto kUp = DirectionKey<&Camera::up>(
    "up", "Direction that points up in the image; not parallel to the view.", KeyUse::kOptional);

constexpr std::array kPerspectiveKeys = {
    kProjection,
    kEye,
    kLookAt,
    kUp,
    NumberKey<&Camera::fov_y_deg>("fov_y_deg", limits::kFovYDeg,
                                  "Full vertical field of view in degrees."),
};
constexpr std::array kOrthographicKeys = {
    kProjection,
    kEye,
    kLookAt,
    kUp,
    NumberKey<&Camera::height>("height", limits::kLength, "Height of the view in world units."),
};

constexpr std::array<std::string_view, 4> kFilters = {"box", "gaussian", "blackman_harris",
                                                      "mitchell"};
constexpr std::array kImageKeys = {
    WholeKey<&ImageSettings::width>("width", limits::kImageSide, "In pixels."),
    WholeKey<&ImageSettings::height>("height", limits::kImageSide, "In pixels."),
    WholeKey<&ImageSettings::spp>(
        "spp", limits::kSpp, "Samples per pixel. A single sample goes through the pixel's centre."),
    ChoiceKey<&ImageSettings::filter, &PixelFilter::kind>("filter/type", kFilters, "",
                                                          KeyUse::kRequired),
    NumberKey<&ImageSettings::filter, &PixelFilter::width>(
        "filter/width", limits::kFilterWidth,
        "Full support in pixels. Default: box 1, gaussian 3 (six standard deviations), "
        "blackman_harris 3.3, mitchell 4.",
        KeyUse::kDerived),
    WholeKey<&ImageSettings::seed>("seed", limits::kSeed, "Seed of the sample pattern."),
    BooleanKey<&ImageSettings::shadows>("shadows",
                                        "Whether lights cast shadows. false: no light does."),
    BooleanKey<&ImageSettings::culling>(
        "culling",
        "Whether single-sided materials are left out where they are seen, or lit, from behind. "
        "false: all are double-sided."),
};

// --- Lights without extent. ---

constexpr std::array kAmbientKeys = {
    ColorKey<&AmbientLight::radiance>("radiance", "From every direction."),
};

constexpr std::string_view kTravelMeaning =
    "[x, y, z] from the light towards the scene, of any length but 0.";
constexpr std::array kDirectionalKeys = {
    DirectionKey<&DirectionalLight::direction_of_travel>("direction_of_travel", kTravelMeaning),
    ColorKey<&DirectionalLight::irradiance>("irradiance",
                                            "Irradiance of a surface that faces the light."),
};

constexpr std::string_view kIntensityMeaning = "Radiant intensity: irradiance at distance 1.";
template <class Positional>
constexpr auto kFallOff = std::array{
    NumberKey<&Positional::attenuation, &Attenuation::constant>("attenuation/constant",
                                                                limits::kAttenuation, ""),
    NumberKey<&Positional::attenuation, &Attenuation::linear>(
        "attenuation/linear", limits::kAttenuation, "Linear term, per world unit."),
    NumberKey<&Positional::attenuation, &Attenuation::quadratic>(
        "attenuation/quadratic", limits::kAttenuation, "Quadratic term, per world unit squared."),
};

constexpr std::array kPointKeys = {
    PointKey<&PointLight::position>("position", ""),
    ColorKey<&PointLight::intensity>("intensity", kIntensityMeaning),
    kFallOff<PointLight>[0],
    kFallOff<PointLight>[1],
    kFallOff<PointLight>[2],
};

constexpr std::array<std::string_view, 2> kEdges = {"smoothstep", "square"};
constexpr std::array kSpotKeys = {
    PointKey<&SpotLight::position>("position", ""),
    DirectionKey<&SpotLight::direction_of_travel>("direction_of_travel", kTravelMeaning),
    ColorKey<&SpotLight::intensity>("intensity", kIntensityMeaning),
    kFallOff<SpotLight>[0],
    kFallOff<SpotLight>[1],
    kFallOff<SpotLight>[2],
    NumberKey<&SpotLight::cutoff_deg>("cutoff_deg", limits::kCutoffDeg,
                                      "Half-angle in degrees at and beyond which it is dark."),
    NumberKey<&SpotLight::inner_deg>(
        "inner_deg", limits::kInnerDeg,
        "Half-angle in degrees where the penumbra begins; at most cutoff_deg, and equal to it (a "
        "hard edge) without this key.",
        KeyUse::kDerived),
    NumberKey<&SpotLight::exponent>(
        "exponent", limits::kExponent,
        "Exponent of the cosine. 0: the same intensity all over the cone."),
    ChoiceKey<&SpotLight::edge>(
        "edge", kEdges,
        "The penumbra over the cosine, scaled to t from 0 at cutoff_deg to 1 at inner_deg: t^2 (3 "
        "- 2 t), or t^2 as in glTF's KHR_lights_punctual."),
};

// --- Lights with an extent. ---

constexpr std::string_view kRadianceMeaning = "Radiance, the same all over and in all directions.";
constexpr std::string_view kTwoSidedMeaning = "Whether the back emits, too.";
constexpr std::string_view kVisibleMeaning =
    "Whether the camera sees the light, and it occludes other lights.";
constexpr std::string_view kFacingMeaning =
    "[x, y, z] from the light to what it shines on, of any length but 0.";

constexpr std::array kSphereKeys = {
    PointKey<&SphereAreaLight::center>("center", ""),
    NumberKey<&SphereAreaLight::radius>("radius", limits::kLength, "", KeyUse::kRequired),
    ColorKey<&SphereAreaLight::radiance>("radiance", kRadianceMeaning),
    BooleanKey<&SphereAreaLight::visible>("visible", kVisibleMeaning),
};
constexpr std::array kRectangleKeys = {
    PointKey<&RectangleAreaLight::center>("center", ""),
    DirectionKey<&RectangleAreaLight::facing>("facing", kFacingMeaning),
    DirectionKey<&RectangleAreaLight::up>(
        "up",
        "[x, y, z] along its height, made perpendicular to facing. "
        "Default: +y, or -z for a light that faces up or down.",
        KeyUse::kDerived),
    NumberKey<&RectangleAreaLight::width>("width", limits::kLength, "", KeyUse::kRequired),
    NumberKey<&RectangleAreaLight::height>("height", limits::kLength, "", KeyUse::kRequired),
    ColorKey<&RectangleAreaLight::radiance>("radiance", kRadianceMeaning),
    BooleanKey<&RectangleAreaLight::two_sided>("two_sided", kTwoSidedMeaning),
    BooleanKey<&RectangleAreaLight::visible>("visible", kVisibleMeaning),
};
constexpr std::array kDiskKeys = {
    PointKey<&DiskAreaLight::center>("center", ""),
    DirectionKey<&DiskAreaLight::facing>("facing", kFacingMeaning),
    NumberKey<&DiskAreaLight::radius>("radius", limits::kLength, "", KeyUse::kRequired),
    ColorKey<&DiskAreaLight::radiance>("radiance", kRadianceMeaning),
    BooleanKey<&DiskAreaLight::two_sided>("two_sided", kTwoSidedMeaning),
    BooleanKey<&DiskAreaLight::visible>("visible", kVisibleMeaning),
};
constexpr std::array kMeshKeys = {
    ColorKey<&MeshAreaLight::radiance>("radiance", kRadianceMeaning),
    BooleanKey<&MeshAreaLight::two_sided>("two_sided", kTwoSidedMeaning),
    BooleanKey<&MeshAreaLight::visible>("visible", kVisibleMeaning),
};

// --- Environments. ---

constexpr std::array kEnvironmentKeys = {
    NumberKey<&EnvironmentLight::rotate_deg>("rotate_deg", limits::kCoordinate,
                                             "Rotation about +y, right-handed."),
    BooleanKey<&EnvironmentLight::background>(
        "background",
        "Whether it is seen where nothing is hit, in place of the scene's background."),
};
constexpr std::array kConstantSkyKeys = {
    ColorKey<&ConstantSky::radiance>("radiance", "Radiance, the same from every direction.",
                                     KeyUse::kOptional),
};
constexpr std::array kGradientSkyKeys = {
    ColorKey<&GradientSky::zenith>("zenith", "", KeyUse::kOptional),
    ColorKey<&GradientSky::horizon>("horizon", "", KeyUse::kOptional),
    ColorKey<&GradientSky::ground>("ground", "", KeyUse::kOptional),
};
constexpr std::array kQuadraticSkyKeys = {
    ColorKey<&QuadraticSky::radiance>("radiance", "What the quadratic scales."),
    DirectionKey<&QuadraticSky::axis>("axis", "", KeyUse::kOptional),
    NumberKey<&QuadraticSky::constant>("constant", limits::kSkyTerm, ""),
    NumberKey<&QuadraticSky::linear>("linear", limits::kSkyTerm, ""),
    NumberKey<&QuadraticSky::quadratic>("quadratic", limits::kSkyTerm, ""),
};
constexpr std::array kPictureSkyKeys = {
    ColorKey<&PictureSky::scale>("scale", "Factor on the image's radiance.", KeyUse::kOptional),
};

template <class Kind>
constexpr LightKind KindNamed(std::string_view name) {
  return {name, [] { return decltype(Light::kind)(Kind{}); }};
}

constexpr std::array kLightKinds = {
    KindNamed<AmbientLight>("ambient"),
    KindNamed<DirectionalLight>("directional"),
    KindNamed<PointLight>("point"),
    KindNamed<SpotLight>("spot"),
    KindNamed<SphereAreaLight>("sphere"),
    KindNamed<RectangleAreaLight>("rectangle"),
    KindNamed<DiskAreaLight>("disk"),
    KindNamed<MeshAreaLight>("mesh"),
    KindNamed<EnvironmentLight>("environment"),
};

}  // namespace

SceneKeys<Camera> KeysFor(const Camera& camera) {
  if (camera.projection == Projection::kPerspective) return kPerspectiveKeys;
  return kOrthographicKeys;
}
SceneKeys<ImageSettings> KeysFor(const ImageSettings&) { return kImageKeys; }
SceneKeys<AmbientLight> KeysFor(const AmbientLight&) { return kAmbientKeys; }
SceneKeys<DirectionalLight> KeysFor(const DirectionalLight&) { return kDirectionalKeys; }
SceneKeys<PointLight> KeysFor(const PointLight&) { return kPointKeys; }
SceneKeys<SpotLight> KeysFor(const SpotLight&) { return kSpotKeys; }
SceneKeys<SphereAreaLight> KeysFor(const SphereAreaLight&) { return kSphereKeys; }
SceneKeys<RectangleAreaLight> KeysFor(const RectangleAreaLight&) { return kRectangleKeys; }
SceneKeys<DiskAreaLight> KeysFor(const DiskAreaLight&) { return kDiskKeys; }
SceneKeys<MeshAreaLight> KeysFor(const MeshAreaLight&) { return kMeshKeys; }
SceneKeys<EnvironmentLight> KeysFor(const EnvironmentLight&) { return kEnvironmentKeys; }
SceneKeys<ConstantSky> KeysFor(const ConstantSky&) { return kConstantSkyKeys; }
SceneKeys<GradientSky> KeysFor(const GradientSky&) { return kGradientSkyKeys; }
SceneKeys<QuadraticSky> KeysFor(const QuadraticSky&) { return kQuadraticSkyKeys; }
SceneKeys<PictureSky> KeysFor(const PictureSky&) { return kPictureSkyKeys; }

std::span<const LightKind> LightKinds() { return kLightKinds; }

const LightKind& KindOf(const Light& light) {
  return *std::find_if(kLightKinds.begin(), kLightKinds.end(), [&](const LightKind& kind) {
    return kind.make().index() == light.kind.index();
  });
}

}  // namespace nacre
