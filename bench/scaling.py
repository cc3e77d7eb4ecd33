# SPDX-License-Identifier: Apache-2.0
"""How time and memory grow: with spheres, triangles, lights, pixels and threads."""
import estimates
import scene_files
from processes import say


def fits(points):
    """Of a curve, [{size, frame_s, process_s, mib}...]: the growth of each number over the last
    decade of sizes, where what does not grow has become small beside what does, and the steepest
    step of all, which a cliff would show in."""
    sizes = [point["size"] for point in points]
    first = estimates.first_of_last_decade(sizes)
    found = {}
    for key in ("frame_s", "process_s", "mib"):
        values = [point[key] for point in points]
        exponent, _ = estimates.log_fit(sizes[first:], values[first:])
        steepest, begin, end = estimates.steepest_step(sizes, values)
        found[key] = {"exponent": exponent, "steepest": steepest, "from": begin, "to": end}
    return found


def _run_often(run, settings):
    """Small sizes are soon repeated: up to five times as often, within half a second."""
    runs = [run()]
    enough = min(5 * settings.scaling_rounds,
                 max(settings.scaling_rounds, int(0.5 / runs[0]["seconds"])))
    while len(runs) < enough:
        runs.append(run())
    return {"frame_s": estimates.median([found["frame"] for found in runs]),
            "process_s": estimates.median([found["seconds"] for found in runs]),
            "mib": estimates.median([found["mib"] for found in runs])}


def measure(runner, scenes, folder, settings, cores):
    """{curve: {"points": [...], "fits": {...}}}, one sample a pixel on one thread; "threads": 16
    samples on 1, 2, 4... threads."""
    curves = {}

    def add(curve, size, scene, frame, spp=1, threads=1):
        arguments = ["--compression", "none", "--size", frame, "--spp", spp]
        point = {"size": size, **_run_often(
            lambda: runner.frame(scene, folder, arguments, threads), settings)}
        curves.setdefault(curve, []).append(point)
        say(f"  {size} {curve}: frame {1e3 * point['frame_s']:.1f} ms, process "
            f"{1e3 * point['process_s']:.0f} ms, {point['mib']:.0f} MiB")

    scene = folder / "scaling.json"
    for count in settings.spheres:
        add("spheres", count, scene_files.write_spheres(scene, count), settings.size)
    for count in settings.triangles:
        path, triangles = scene_files.write_triangles(scene, count)
        add("triangles", triangles, path, settings.size)
        path.with_suffix(".obj").unlink()
    for kind in ("point", "spot"):
        for count in settings.lights:
            add(f"{kind} lights", count, scene_files.write_lights(scene, count, kind),
                settings.size)
    grid = scenes / "material_grid.json"
    for side in settings.sides:
        add("pixels", side * side, grid, f"{side}x{side}")
    if cores > 1:
        for threads in sorted({*(2 ** i for i in range(cores.bit_length())), cores}):
            add("threads", threads, grid, settings.size, spp=16, threads=threads)
    return {name: {"points": points, "fits": fits(points)} for name, points in curves.items()}
