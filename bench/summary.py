# SPDX-License-Identifier: Apache-2.0
"""The headline numbers, one name and one value each, out of what a run measured.

`_over_` between two ways to do the same work is how many times faster the first is, or with fewer
rays where the name ends in _in_rays; names that end in _time, _ms, _s, _mib or _ghz are what they
say.
"""
import adaptive
import estimates
import lights
import port_bound

# Headline name: benchmarks of ours, and of the plain scalar baseline; the first one there counts.
_KERNELS = {
    "lambert": (("lambert",), ("lambert",)),
    "phong": (("phong",), ("phong",)),
    "phong_in_lobe": (("phong_in_lobe",), ("phong_in_lobe",)),
    "blinn": (("blinn_phong",), ("blinn_phong",)),
    "ggx": (("ggx_plain_schlick_direct", "ggx_schlick_direct"),
            ("ggx_plain_schlick_direct", "ggx_schlick_direct")),
    "height_correlated": (("ggx_plain_height_correlated", "ggx_height_correlated"),
                          ("ggx_plain_height_correlated", "ggx_height_correlated")),
    "ggx_default": (("ggx_default", "ggx_height_correlated"),
                    ("ggx_default", "ggx_plain_height_correlated", "ggx_height_correlated")),
}
_SCENES = {"grid": "grid_visibility", "1e3": "visibility_1e3", "1e4": "visibility_1e4",
           "1e5": "visibility_1e5"}


class _Times:
    """Median times by name; a ratio of what was not measured is None, and so left out."""

    def __init__(self, benchmarks):
        self._ns = {name: estimates.median(result["ns"]) for name, result in benchmarks.items()}
        self._wall = {name: estimates.median(result.get("wall_ns", result["ns"]))
                      for name, result in benchmarks.items()}

    def ns(self, *names):
        return next((self._ns[name] for name in names if name in self._ns), None)

    def ratio(self, above, below):
        a, b = self.ns(*above), self.ns(*below)
        return None if a is None or b is None else a / b

    def wall_ratio(self, above, below):
        a, b = self._wall.get(above[0]), self._wall.get(below[0])
        return None if a is None or b is None else a / b


def _shade(models, target):
    return tuple(f"shade/{model}/{target}" for model in models)


def _kernels(times, best):
    for name, (ours, scalar) in _KERNELS.items():
        yield f"{name}_over_scalar", times.ratio(_shade(scalar, "scalar_baseline"),
                                                 _shade(ours, best))
    shares = {name: times.ratio(_shade(ours, "avx3"), _shade(ours, "avx2"))
              for name, (ours, _) in _KERNELS.items()}
    yield "avx2_share_of_avx3", min((s for s in shares.values() if s is not None), default=None)
    for name, share in shares.items():
        yield f"avx2_share_of_avx3_{name}", share
    plain = _KERNELS["ggx"][0]
    yield "stable_over_textbook_time", times.ratio(_shade(plain, best),
                                                   _shade(("textbook_ggx",), best))
    yield "stable_over_textbook_as_written_time", times.ratio(
        _shade(plain, best), _shade(("textbook_ggx_as_written",), best))
    yield "stable_phong_over_naive_time", times.ratio(_shade(("given_phong",), best),
                                                      _shade(("naive_phong",), best))
    yield "stable_blinn_over_naive_time", times.ratio(_shade(("given_blinn_phong",), best),
                                                      _shade(("naive_blinn_phong",), best))
    yield "double_over_float_terms_time", times.ratio(("math/ggx/0.3/double_terms",),
                                                      ("math/ggx/0.3/stable_float",))
    for naive, plain in (("naive_phong", "phong"), ("naive_phong_in_lobe", "phong_in_lobe"),
                         ("naive_blinn_phong", "blinn_phong")):
        yield f"{naive}_over_scalar", times.ratio(_shade((plain,), "scalar_baseline"),
                                                  _shade((naive,), best))


def _clocks(benchmarks):
    """What milliseconds are to be read with: shared machines change their clocks."""
    chain = benchmarks.get("machine/multiply_chain", {}).get("counters", {}).get("cycles")
    products = benchmarks.get("machine/products", {}).get("counters", {}).get("products")
    yield "clock_ghz", 1e-9 * chain if chain else None
    yield "clock_under_vectors_ghz", (1e-9 * port_bound.vector_clock(products, chain)
                                      if chain and products else None)


def _visibility(times):
    for scene, name in _SCENES.items():
        tiles = (f"visibility/tiles/{scene}",)
        yield f"{name}_over_embree_spheres", times.ratio(
            (f"visibility/embree_sphere_point/{scene}",), tiles)
        yield f"{name}_over_embree_user", times.ratio((f"visibility/embree_user/{scene}",), tiles)
        in_float = (f"visibility/float_tiles/{scene}",)
        yield f"{name}_in_float_over_embree_spheres", times.ratio(
            (f"visibility/embree_sphere_point/{scene}",), in_float)
        yield f"{name}_in_float_over_embree_float_user", times.ratio(
            (f"visibility/embree_float_user/{scene}",), in_float)


def _exact_at_bound(times, benchmarks, bounds):
    """Embree's time over what the ports need for the exact test of as many rays as hit, full
    vectors of them: no binning, no outlines, no places of samples."""
    if not bounds:  # without the tools, or in a run of the headlines alone
        return
    name = port_bound.EXACT_HITS
    hits = benchmarks.get(name, {}).get("counters", {}).get("hits")
    spheres = times.ns("visibility/embree_sphere_point/grid")
    bound = bounds.get(name)
    yield "grid_visibility_at_port_bound_over_embree_spheres", (
        spheres / (bound * hits) if bound and hits and spheres else None)


def _frames(times, best):
    def frame(scene, spp=1, target=best, variant=""):
        return (f"frame/{scene}/1920x1080/{spp}spp/{target}{variant}",)
    yield "frame_over_bare_embree_trace", times.ratio(
        ("visibility/embree_sphere_point/grid",), frame("material_grid"))
    for kind, scene in (("", "material_grid"), ("plain_", "material_grid_plain")):
        for spp in (1, 16):
            for of, variant in (("", ""), ("_no_shadows", "/no_shadows")):
                ns = times.ns(*frame(scene, spp, variant=variant))
                yield f"frame_ms_{kind}grid{of}_1080p_{spp}spp", None if ns is None else 1e-6 * ns
    ns = times.ns(*frame("material_grid_shadows"))
    yield "frame_ms_grid_shadows_1080p_1spp", None if ns is None else 1e-6 * ns
    yield "skips_on_over_off", times.ratio(frame("material_grid", variant="/general_path"),
                                           frame("material_grid"))
    yield "tiles_over_embree_frame", times.ratio(frame("material_grid", variant="/embree"),
                                                 frame("material_grid"))
    yield "frame_avx2_share_of_avx3", times.ratio(frame("material_grid", target="avx3"),
                                                  frame("material_grid", target="avx2"))
    yield "frame_two_threads_over_one", times.wall_ratio(
        frame("material_grid"), frame("material_grid", variant="/threads2"))


def _processes(processes):
    def middle(name, field):
        found = processes.get(name)
        return estimates.median(found[field]) if found else None
    for name in ("grid_1080p_1spp", "grid_1080p_16spp", "grid_shadows_1080p_1spp",
                 "grid_uncompressed_1080p_1spp"):
        seconds = middle(name, "seconds")
        yield f"process_ms_{name}", None if seconds is None else 1e3 * seconds
    yield "process_s_million_1spp", middle("million_1spp", "seconds")
    yield "process_s_million_16spp", middle("million_16spp", "seconds")
    yield "process_mib_million_1spp", middle("million_1spp", "mib")
    yield "process_mib_grid_1080p_1spp", middle("grid_1080p_1spp", "mib")
    seconds = middle("startup", "seconds")
    yield "startup_ms", None if seconds is None else 1e3 * seconds


def _scaling(curves):
    for name, curve in curves.items():
        key = name.replace(" ", "_")
        yield f"growth_of_frame_time_with_{key}", curve["fits"]["frame_s"]["exponent"]
        yield f"steepest_step_with_{key}", curve["fits"]["frame_s"]["steepest"]
    if "spheres" in curves:
        last = curves["spheres"]["points"][-1]
        yield "bytes_per_sphere", last["mib"] * 2 ** 20 / last["size"]


def headlines(results):
    """({name: value}, [names that could not be measured])."""
    benchmarks = results.get("benchmarks", {})
    times = _Times(benchmarks)
    best = results.get("best_target", "avx3")
    pairs = [*_clocks(benchmarks), *_kernels(times, best), *_visibility(times),
             *_exact_at_bound(times, benchmarks, results.get("port_bounds", {})),
             *_frames(times, best), *_processes(results.get("processes", {})),
             *adaptive.headlines(results.get("precision", {}).get("adaptive", {})),
             *lights.headlines(results.get("lights", {})),
             *_scaling(results.get("scaling", {}))]
    return ({name: value for name, value in pairs if value is not None},
            [name for name, value in pairs if value is None])


def lines(values):
    """One line a headline, with four digits."""
    return [f"{name}: {value:.4g}" if abs(value) < 1e4 else f"{name}: {value:.0f}"
            for name, value in values.items()]
