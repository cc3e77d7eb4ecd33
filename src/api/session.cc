// SPDX-License-Identifier: Apache-2.0
// api/session.cc: sessions of the public API.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>

#include "api/render_impl.h"
#include "api/scene_impl.h"

namespace nacre::v0 {

struct Session::Impl {
  nacre::LiveScene live;
  PreparedScene prepared;
  std::atomic<bool> cancelled = false;
};

Session::Session(const Scene& scene)
    : impl_(AtBorder(
          [&] { return std::make_unique<Impl>(Scene::Impl::MakeLive(scene.impl().source)); })) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

void Session::Set(const std::string& pointer, const Value& value) {
  AtBorder([&] { impl_->prepared.versions.Change(impl_->live.Set(pointer, value.json())); });
}

std::optional<Value> Session::Get(const std::string& pointer) const {
  return AtBorder([&]() -> std::optional<Value> {
    std::optional<std::string> text = impl_->live.Get(pointer);
    if (!text) return std::nullopt;
    return Value::Json(*std::move(text));
  });
}

bool Session::Has(const std::string& pointer) const {
  return AtBorder([&] { return impl_->live.Has(pointer); });
}

bool Session::Reload() {
  return AtBorder([&] {
    const SceneParts changed = impl_->live.ReadNamedFiles();
    impl_->prepared.versions.Change(changed);
    return !changed.empty();
  });
}

Image Session::Render(const RenderSettings& settings, RenderStats* stats) {
  return RenderProgressively(settings, {}, stats);
}

Image Session::RenderProgressively(const RenderSettings& settings,
                                   const std::function<void(const Image&, int samples)>& show,
                                   RenderStats* stats) {
  Impl& s = *impl_;
  const auto render = [&] {
    nacre::RenderSettings own = ToOwn(settings);
    if (own.cancel == nullptr) own.cancel = &s.cancelled;
    const nacre::ImageSettings image = Adjusted(s.live.own_image(), settings);
    if (!(image == s.live.scene().image)) {
      s.live.UseImage(image);
      s.prepared.versions.Change(ScenePart::kImage);
    }
    const auto start = std::chrono::steady_clock::now();
    const FramePlan plan = MakePlan(s.live.scene(), own, &s.prepared);
    const std::chrono::duration<double> plan_time = std::chrono::steady_clock::now() - start;
    nacre::RenderStats counted;
    const auto finish = [&](nacre::Image rendered) {
      return Finish(plan, &s.prepared, std::move(rendered), counted, plan_time.count(), stats);
    };
    if (!show || own.max_error > 0 || image.spp == 1) {
      Image whole = finish(RenderImage(plan, own, &counted));
      if (show) show(whole, image.spp);
      return whole;
    }
    FrameFilm film;
    nacre::Image so_far;
    FitImage(plan, own, &so_far);
    for (int end = 1;; end = std::min(2 * end, image.spp)) {
      const nacre::RenderStats pass = RenderPass(plan, own, end, &film, &so_far);
      counted.Add(pass);
      counted.threads = pass.threads;
      counted.render_seconds += pass.render_seconds;
      if (end == image.spp) break;
      show(finish(so_far), end);
    }
    Image whole = finish(std::move(so_far));
    show(whole, image.spp);
    return whole;
  };
  try {
    return Cancellable(render);
  } catch (const Cancelled&) {
    s.cancelled = false;
    throw;
  }
}

void Session::Cancel() { impl_->cancelled = true; }

}  // namespace nacre::v0
