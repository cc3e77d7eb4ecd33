"""How time and memory grow: with spheres, triangles, lights, pixels and threads."""
import estimates
import scene_files
from processes import say


def fits(points):
    """Of a curve, [{size, frame_s, process_s, mib}...]: the growth of each number over all of it,
    and the steepest step, which a cliff would show in."""
    sizes = [point["size"] for point in points]
    found = {}
    for key in ("frame_s", "process_s", "mib"):
        values = [point[key] for point in points]
        exponent, _ = estimates.log_fit(sizes, values)
        steepest, begin, end = estimates.steepest_step(sizes, values)
        found[key] = {"exponent": exponent, "steepest": steepest, "from": begin, "to": end}
    return found


def measure(runner, scenes, folder, settings):
    """{curve: {"points": [...], "fits": {...}}}, on one thread, one sample a pixel."""
    curves = {}

    def add(curve, size, scene, frame):
        arguments = ["--compression", "none", "--size", frame, "--spp", "1"]
        runs = [runner.frame(scene, folder, arguments) for _ in range(settings.scaling_rounds)]
        point = {"size": size, "frame_s": estimates.median([run["frame"] for run in runs]),
                 "process_s": estimates.median([run["seconds"] for run in runs]),
                 "mib": estimates.median([run["mib"] for run in runs])}
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
    for side in settings.sides:
        add("pixels", side * side, scenes / "material_grid.json", f"{side}x{side}")
    return {name: {"points": points, "fits": fits(points)} for name, points in curves.items()}
