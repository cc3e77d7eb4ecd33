// SPDX-License-Identifier: Apache-2.0
// visibility/film_test-inl.h: the test of spheres by their place on the film, on SIMD vectors.
// Scalar twin, with the derivation: visibility/film_test.h.
#if defined(NACRE_VISIBILITY_FILM_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_FILM_TEST_INL_H_
#undef NACRE_VISIBILITY_FILM_TEST_INL_H_
#else
#define NACRE_VISIBILITY_FILM_TEST_INL_H_
#endif

#include "base/geometry-inl.h"
#include "visibility/film_test.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// One sphere for all lanes, or one each.
template <class V>
struct FilmSphereV {
  Vec3V<V> center;
  Vec3V<V> rest;
  V scale;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE FilmSphereV<V> SetFilmSphere(D d, const FilmSphere& film) {
  return {SetVec3(d, film.center), SetVec3(d, film.rest), hn::Set(d, film.scale)};
}

template <class V>
struct FilmHitV {
  Vec3V<V> offset;
  V back;          // offset . backward
  V discriminant;  // the ray's line meets the sphere if this is not below 0
};

// `backward`: minus the direction, and dd the square of its length. As the twin's bit for bit, but
// for signs.
template <class D, class V = hn::Vec<D>>
HWY_INLINE FilmHitV<V> TestOnFilm(D d, const FilmSphereV<V>& film, const Vec3V<V>& backward, V dd) {
  const auto offset = [&](V component, V center, V rest) HWY_ATTR {
    return hn::NegMulAdd(hn::Add(component, center), film.scale, rest);
  };
  FilmHitV<V> hit;
  hit.offset = {offset(backward.x, film.center.x, film.rest.x),
                offset(backward.y, film.center.y, film.rest.y),
                offset(backward.z, film.center.z, film.rest.z)};
  const auto& [x, y, z] = hit.offset;
  const V within = hn::NegMulAdd(z, z, hn::NegMulAdd(y, y, hn::NegMulAdd(x, x, hn::Set(d, 1.0))));
  hit.back = FusedDot(hit.offset, backward);
  hit.discriminant = hn::MulAdd(dd, within, hn::Mul(hit.back, hit.back));
  return hit;
}

// From the point at the centre's depth to the hit, by |direction|: `root` is that of the
// discriminant.
template <class V>
HWY_INLINE V BackToHit(V root, V back) {
  return hn::Sub(root, back);
}

template <class V>
HWY_INLINE Vec3V<V> FilmNormal(const Vec3V<V>& offset, V back_to_hit, const Vec3V<V>& to_view,
                               V inverse_length) {
  return MulAdd3(to_view, hn::Mul(back_to_hit, inverse_length), offset);
}

// The hit's t.
template <class V>
HWY_INLINE V FilmDepth(const Vec3V<V>& center, V radius, const Vec3V<V>& backward, V root) {
  const V product = hn::Sub(FusedDot(center, center), hn::Mul(radius, radius));
  return hn::Div(product, hn::MulSub(radius, root, FusedDot(center, backward)));
}

template <class D>
struct FilmDepthV {
  hn::Mask<D> hit;
  hn::Vec<D> t;
};

// The test for the depth alone.
template <class D, class V = hn::Vec<D>>
HWY_INLINE FilmDepthV<D> DepthOnFilm(D d, const FilmSphere& film, const TraceSphere& sphere,
                                     const Vec3V<V>& direction) {
  const Vec3V<V> backward = Negated(direction);
  const auto hit = TestOnFilm(d, SetFilmSphere(d, film), backward, FusedDot(direction, direction));
  return {hn::Ge(hit.discriminant, hn::Zero(d)),
          FilmDepth(SetVec3(d, sphere.center), hn::Set(d, sphere.radius), backward,
                    hn::Sqrt(hit.discriminant))};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
