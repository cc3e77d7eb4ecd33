# SPDX-License-Identifier: Apache-2.0
"""The diagrams: what is on which axis."""
import estimates
import lights
import plots
import report
from processes import say

_TARGETS = ("scalar_baseline", "scalar", "sse4", "avx2", "avx3")
_SPHERES = {"grid": 25, "1e3": 1024, "1e4": 10000, "1e5": 99856}


def kernels(results, path):
    """Nanoseconds per hit and light: a row a kernel, a mark a target."""
    # One material in the cache is what the bare names are measured with.
    rows = [(model if mode == "cached" else f"{model}, {mode}", mode, target, ns)
            for model, mode, target, ns, *_ in report.kernel_rows(results["benchmarks"])
            if mode != "one material"]
    best = results["best_target"]
    speed = {row[0]: row[3] for row in rows if row[2] == best}
    fastest = {}
    for label, ns in speed.items():
        model = label.split(",")[0]
        fastest[model] = min(ns, fastest.get(model, ns))
    models = sorted(speed, key=lambda label: (fastest[label.split(",")[0]], label), reverse=True)
    place = {model: i for i, model in enumerate(models)}
    commands = f"set yrange [-0.7:{len(models) - 0.3}]\nset logscale x\n"
    commands += "set xlabel 'ns per hit and light (one thread)'\nset grid ytics\n"
    commands += "set key outside top right horizontal samplen 0.5 width -1\n"
    commands += "set xtics (0.5, 1, 2, 5, 10, 20, 50, 100, 200)\n"
    commands += "set ytics (" + ", ".join(
        f"{plots.quote(m.replace('_', ' '))} {i}" for m, i in place.items()) + ")\n"
    drawn = []
    for i, target in enumerate(_TARGETS):
        points = [(row[3], place[row[0]]) for row in rows if row[2] == target and row[0] in place]
        if not points:
            continue
        commands += plots.block(f"t{i}", points)
        label = "plain C++" if target == "scalar_baseline" else target
        drawn.append(f"$t{i} using 1:2 with points {plots.style(i, 2, 1.7)} "
                     f"title {plots.quote(label)}")
    plots.draw(path, commands + "plot " + ", ".join(drawn) + "\n", 1280,
               max(560, 170 + 40 * len(models)))


def visibility(results, path):
    """A frame's camera rays against spheres: nacre, Embree with its own test, bare Embree; exact
    and in float."""
    series = []
    for key, label in (("embree_sphere_point", "Embree's spheres, bare trace in float"),
                       ("embree_user", "nacre on Embree's tree, exact"),
                       ("embree_float_user", "Embree's tree with our test in float, bare trace"),
                       ("tiles", "nacre's tiles, exact, binning included"),
                       ("float_tiles", "nacre's tiles in float, binning included, depths alone")):
        points = [(count, 1e-6 * estimates.median(results["benchmarks"][name]["ns"]))
                  for scene, count in _SPHERES.items()
                  if (name := f"visibility/{key}/{scene}") in results["benchmarks"]]
        series.append((label, points))
    options = ("set logscale xy\nset format x '10^{%T}'\nset xrange [18:200000]\n"
               "set xlabel 'spheres'\nset ylabel 'ms per frame of 1920x1080 camera rays'\n"
               "set yrange [0.02:*]\nset key bottom right\n")  # room for the key below the curves
    plots.draw(path, plots.curves(series, options), 1280, 760)


def frame_stages(results, path):
    """Where the time of a frame goes, on the best target, one thread."""
    best, benchmarks = results["best_target"], results["benchmarks"]
    scenes = ("material_grid", "material_grid_plain", "material_grid_shadows", "phong_vs_pbr",
              "mesh_and_spheres")
    found = [(scene, report.stages_of(benchmarks[name])) for scene in scenes
             if (name := f"frame/{scene}/1920x1080/1spp/{best}") in benchmarks]
    if not found:
        return
    stages = [s for s in found[0][1] if any(values.get(s, 0) > 0.05 for _, values in found)]
    place = {scene: len(found) - 1 - i for i, (scene, _) in enumerate(found)}
    commands = "set style fill solid 1 border rgb 'white'\nset grid noytics xtics\n"
    commands += "set key outside top center horizontal maxrows 1 samplen 0.8 width -2\n"
    commands += f"set yrange [-0.6:{len(found) - 0.4}]\nset xrange [0:*]\n"
    commands += f"set xlabel 'ms per frame of 1920x1080, one sample a pixel (one thread, {best})'\n"
    commands += "set ytics (" + ", ".join(
        f"{plots.quote(scene.replace('_', ' '))} {y}" for scene, y in place.items()) + ")\n"
    drawn, ends = [], {scene: 0.0 for scene in place}
    for i, stage in enumerate(stages):
        rows = []
        for scene, values in found:
            begin, ends[scene] = ends[scene], ends[scene] + values.get(stage, 0)
            rows.append((ends[scene], place[scene], begin, ends[scene], place[scene] - 0.33,
                         place[scene] + 0.33))
        commands += plots.block(f"s{i}", rows)
        drawn.append(f"$s{i} using 1:2:3:4:5:6 with boxxyerror lc rgb "
                     f"{plots.quote(plots.FILLS[i % len(plots.FILLS)])} title {plots.quote(stage)}")
    plots.draw(path, commands + "plot " + ", ".join(drawn) + "\n", 1280, 140 + 90 * len(found))


def processes(results, path):
    """Wall time from spawn to exit, with the interval of the median, and peak memory."""
    names = list(results["processes"])[::-1]
    rows, labels = [], ""
    for y, name in enumerate(names):
        found = results["processes"][name]
        low, high = estimates.median_interval(found["seconds"])
        middle = estimates.median(found["seconds"])
        rows.append((1e3 * middle, y, 1e3 * low, 1e3 * high))
        shown = f"{1e3 * middle:.3g} ms" if middle < 1 else f"{middle:.3g} s"
        text = f"{shown}, {estimates.median(found['mib']):.0f} MiB"
        labels += f"set label {plots.quote(text)} at {1e3 * middle:.9g}, {y + 0.32} center\n"
    commands = plots.block("p", rows) + labels
    commands += f"set yrange [-0.6:{len(names) - 0.2}]\nset logscale x\nset grid ytics\n"
    commands += "set ytics (" + ", ".join(
        f"{plots.quote(name.replace('_', ' '))} {y}" for y, name in enumerate(names)) + ")\n"
    commands += "set xlabel 'ms per process, all threads (95 % interval of the median)'\n"
    commands += f"plot $p using 1:2:3:4 with xerrorbars {plots.style(0)} notitle\n"
    plots.draw(path, commands, 1280, 160 + 76 * len(names))


def scaling(results, path):
    """Time above, memory below: spheres and triangles, lights, pixels; time by threads."""
    shapes = ("spheres or triangles", ("spheres", "triangles"))
    lights = ("lights", ("point lights", "spot lights"))
    pixels, threads = ("pixels", ("pixels",)), ("threads", ("threads",))
    time, memory = ("frame_s", 1e3, "frame, ms"), ("mib", 1, "peak memory, MiB")
    panels = ((shapes, time), (lights, time), (pixels, time),
              (shapes, memory), (pixels, memory), (threads, time))
    commands = "set multiplot layout 2,3 margins 0.08,0.985,0.1,0.98 spacing 0.09,0.15\n"
    commands += "set logscale xy\nset format xy '10^{%T}'\nset key top left Left reverse\n"
    for number, ((axis, names), (field, factor, unit)) in enumerate(panels):
        series = []
        for name in names:
            curve = results["scaling"].get(name)
            if curve is None:  # one core has no curve of threads
                continue
            growth = round(curve["fits"][field]["exponent"], 2) + 0.0  # no -0.00
            points = [(p["size"], factor * p[field]) for p in curve["points"]]
            series.append((f"{name}: n^{{{growth:.2f}}}", points))
        options = f"set xlabel '{axis}'\nset ylabel '{unit}' offset 0.8\n"
        if axis == "threads":
            options += "set logscale x 2\nset format x '%g'\nset xtics 2\nunset mxtics\n"
            options += "set xrange [0.9:]\nset key bottom left\n"
        commands += plots.curves(series, options, f"p{number}_") if series else ""
    plots.draw(path, commands + "unset multiplot\n", 1700, 1060)


def math_error(results, path):
    """Time per hit against the highlight's worst error, by formula; a mark a width of the lobe."""
    benchmarks = results["benchmarks"]
    hits = 512
    commands = "set multiplot layout 1,2 margins 0.08,0.98,0.13,0.93 spacing 0.07,0.1\n"
    commands += "set logscale xy\nset format x '10^{%T}'\nset yrange [0.5:150]\n"
    commands += "set xlabel 'worst relative error of the highlight'\n"
    for number, (lobe, title) in enumerate((("ggx", "GGX, roughness 0.5 to 0.01"),
                                            ("phong", "Phong, exponent 10 to 10^6"))):
        series = []
        for form, label in (("textbook_scalar", "textbook, plain C++ float"),
                            ("textbook", f"textbook, float, {results['best_target']}"),
                            ("stable_float", f"stable, float, {results['best_target']}"),
                            ("double_terms", f"stable, double terms, {results['best_target']}")):
            points = _math_points(benchmarks, lobe, form, results["best_target"], hits)
            if points:
                series.append((label, points))
        # Above the plain code's times.
        key = 'off' if number else 'at graph 0.98,0.99 right top Left reverse'
        options = f"set title '{title}' offset 0,-0.5\nset key {key}\n"
        options += f"set ylabel '{'ns per hit and light' if number == 0 else ''}'\n"
        commands += plots.curves(series, options, f"m{number}_")
    plots.draw(path, commands + "unset multiplot\n", 1700, 760)


# The kernels of shading_bench.cc whose times stand for the forms on SIMD: at one width, but all
# under lights that are found in float, in one way.
_FORM_KERNELS = {
    ("ggx", "textbook"): "textbook_ggx",
    ("ggx", "stable_float"): "ggx_plain_schlick_direct",
    ("ggx", "double_terms"): "ggx_double_terms",
    # On hits that all have a lobe, as those of all points have.
    ("phong", "textbook"): "naive_phong_in_lobe",
    ("phong", "stable_float"): "given_phong_in_lobe",
    ("phong", "double_terms"): "phong_double_terms",
}


def _math_points(benchmarks, lobe, form, best, hits):
    """[(error, ns a hit)...], a point a width of the lobe. The textbook's formula on SIMD has the
    scalar one's errors."""
    kernel = _FORM_KERNELS.get((lobe, form))
    found = benchmarks.get(f"shade/{kernel}/{best}")
    if kernel and found is None:
        return []
    points = []
    for name, result in benchmarks.items():
        parts = name.split("/")
        wanted = "textbook_scalar" if form == "textbook" else form
        if parts[0] != "math" or parts[1] != lobe or parts[3] != wanted:
            continue
        error = result["counters"].get("max_rel_error")
        if error:
            ns = (found or result)["ns"]
            points.append((error, estimates.median(ns) / hits))
    return points


def _precision(series, scale, ylabel, key, path):
    lines = [(label, [(p["rel_mse"] ** 0.5, scale * p["seconds"]) for p in points
                      if p["rel_mse"] > 0]) for label, points in series.items()]
    options = ("set logscale xy\nset xlabel 'relative error (root of relMSE)'\n"
               f"set format x '10^{{%T}}'\nset key {key} Left reverse\n"
               f"set ylabel '{ylabel}'\n")
    plots.draw(path, plots.curves(lines, options), 1280, 800)


def frame_error(results, path):
    _precision(results["precision"]["frame"], 1e3,
               f"ms per frame of {results['settings']['precision_size']}, one thread",
               "bottom left", path)


def process_error(results, path):
    _precision(results["precision"]["process"], 1,
               f"seconds per process, {results['settings']['precision_size']}, all threads",
               "top left", path)


def lights_error(results, path):
    lines = [(f"under a {name}, {kind}", [(p["error"], p["seconds"]) for p in points])
             for name, light in results["lights"].items()
             for kind, points in light["curves"].items()]
    options = ("set logscale xy\nset xlabel 'relative RMSE over the spheres'\n"
               "set format x '10^{%T}'\nset key top right Left reverse\n"
               f"set ylabel 'seconds per process, {lights.SIZE}, one thread'\n")
    plots.draw(path, plots.curves(lines, options), 1280, 800)


ALL = {"bench_kernels": kernels, "bench_visibility": visibility, "bench_frame": frame_stages,
       "bench_process": processes, "bench_scaling": scaling, "bench_error_math": math_error,
       "bench_error_frame": frame_error, "bench_error_process": process_error,
       "bench_error_lights": lights_error}


def draw_all(results, folder):
    """Every diagram whose numbers are there, as folder/bench_*.svg and .png."""
    for name, figure in ALL.items():
        try:
            figure(results, folder / name)
        except KeyError as missing:
            say(f"no {name}: {missing} was not measured")
