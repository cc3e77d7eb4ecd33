// SPDX-License-Identifier: Apache-2.0
// tests/queries-inl.h: asks SIMD functions query by query, a vector of queries at a time.
#if defined(NACRE_TESTS_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_TESTS_QUERIES_INL_H_
#undef NACRE_TESTS_QUERIES_INL_H_
#else
#define NACRE_TESTS_QUERIES_INL_H_
#endif

#include <algorithm>
#include <functional>
#include <vector>

#include "base/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Up to a whole vector of queries from `first` on; the last query fills the lanes that are left.
template <class Query, class Answer, typename T>
struct QueryPacket {
  using D = hn::ScalableTag<T>;
  using V = hn::Vec<D>;
  static constexpr size_t kMaxLanes = 32;

  const std::vector<Query>& queries;
  std::vector<Answer>* answers;
  size_t first;

  const Query& At(size_t lane) const { return queries[std::min(first + lane, queries.size() - 1)]; }
  // `get`: a member of the query, or a function of it.
  template <class Get>
  V Number(const Get& get) const {
    alignas(64) T lanes[kMaxLanes];
    for (size_t i = 0; i < hn::Lanes(D()); ++i) lanes[i] = std::invoke(get, At(i));
    return hn::Load(D(), lanes);
  }
  template <class Get>
  Vec3V<V> Vector(const Get& get) const {
    return {Number([&](const Query& query) { return std::invoke(get, query).x; }),
            Number([&](const Query& query) { return std::invoke(get, query).y; }),
            Number([&](const Query& query) { return std::invoke(get, query).z; })};
  }
  // `place`: a member of the answer, or a function that returns a reference to one.
  template <class Place>
  void Store(V value, const Place& place) const {
    alignas(64) T lanes[kMaxLanes];
    hn::Store(value, D(), lanes);
    for (size_t i = 0; i < hn::Lanes(D()) && first + i < queries.size(); ++i) {
      std::invoke(place, (*answers)[first + i]) = lanes[i];
    }
  }
  template <class Place>
  void Store3(const Vec3V<V>& value, const Place& place) const {
    Store(value.x, [&](Answer& answer) -> T& { return std::invoke(place, answer).x; });
    Store(value.y, [&](Answer& answer) -> T& { return std::invoke(place, answer).y; });
    Store(value.z, [&](Answer& answer) -> T& { return std::invoke(place, answer).z; });
  }
};

// The answers to all queries, as many, which ask(packet) stores.
template <typename T, class Answer, class Query, class Ask>
std::vector<Answer> AskInPackets(const std::vector<Query>& queries, const Ask& ask) {
  std::vector<Answer> answers(queries.size());
  for (size_t first = 0; first < queries.size(); first += hn::Lanes(hn::ScalableTag<T>())) {
    ask(QueryPacket<Query, Answer, T>{queries, &answers, first});
  }
  return answers;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
