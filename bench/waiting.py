# SPDX-License-Identifier: Apache-2.0
"""What people wait for: sessions, large files, comparisons. Each row has what it is held against: a part
of itself, or another program or library that does the same, where it is installed.

    scripts/bench --waiting
"""
import json
import pathlib
import re
import shutil

import estimates
import machine
import readme
import report
import waiting_files
from processes import Failed, output_of, say

# Rounds; every round runs each case once.
ROUNDS, QUICK_ROUNDS = 5, 2
SESSION_TURNS, RAY_TURNS, CANCELLED_TURNS = 15, 5, 12

# Of sessions: the scene, size and samples, and what is set.
_SESSIONS = {
    "session: a roughness under an 8k environment, 720p": (
        "sky.json", "1280x720", 1, "/materials/gold/roughness", ("0.2", "0.4")),
    "session: a roughness beside a 4k texture, 1080p": (
        "texture.json", "1920x1080", 1, "/materials/gold/roughness", ("0.2", "0.4")),
    "session: a roughness of a million triangles, 1080p": (
        "ball.json", "1920x1080", 1, "/materials/gold/roughness", ("0.2", "0.4")),
}


def _null(nacre, scene, *options):
    return [nacre, "render", scene, "-o", "null:", "--quiet", *options]


_FEW = ("--size", "64x36", "--spp", "1")


def _commands(files, nacre, oiiotool):
    """{row: command}, and {row: (command, what it is)} of what it is held against."""
    commands = {
        "8k environment, one sample, 1080p": _null(nacre, files["sky.json"], "--size", "1920x1080",
                                                   "--spp", "1"),
        "4k PNG texture": _null(nacre, files["texture.json"], *_FEW),
        "five 4k JPEG maps of a model": _null(nacre, files["maps.gltf"], *_FEW),
        "OBJ, 1 million triangles": _null(nacre, files["ball.json"], *_FEW),
        "GLB, 4.2 million triangles": _null(nacre, files["grid.glb"], *_FEW),
        "JSON, 1 million spheres": _null(nacre, files["spheres.json"], *_FEW),
        "1e6 spheres, 1080p": _null(nacre, files["cloud1000000.json"], "--size", "1920x1080", "--spp",
                                    "1"),
        "1e7 spheres, 1080p": _null(nacre, files["cloud10000000.json"], "--size", "1920x1080", "--spp",
                                    "1"),
        "mesh light of 320 triangles, 1080p, 16 samples": _null(
            nacre, files["mesh_light.json"], "--size", "1920x1080", "--spp", "16"),
        "compare, 4k floats": [nacre, "compare", files["a.exr"], files["b.exr"], "--rmse", "9"],
        "compare --metrics all, 4k floats": [nacre, "compare", files["a.exr"], files["b.exr"],
                                             "--metrics", "all", "--rmse", "9"],
        "report, 4k pair": [nacre, "report", files["a.exr"].with_name("report.html"), files["a.exr"],
                            files["b.exr"]],
        "tonemap, 4k floats": [nacre, "tonemap", files["a.exr"], "-o",
                               files["a.exr"].with_name("tonemap.png")],
    }
    others = {"mesh light of 320 triangles, 1080p, 16 samples": (
        _null(nacre, files["rectangle_light.json"], "--size", "1920x1080", "--spp", "16"),
        "a rectangle light")}
    if oiiotool:
        # All of an image is read, and one pixel of it written.
        pixel = ["--cut", "1x1+0+0", "-o", files["a.exr"].with_name("pixel.exr")]
        others["8k environment, one sample, 1080p"] = (
            [oiiotool, files["sky.hdr"], *pixel], "oiiotool reads it")
        others["five 4k JPEG maps of a model"] = (
            [oiiotool, *(word for i in range(5) for word in (files[f"map{i}.jpg"], *pixel))],
            "oiiotool reads them")
        others["compare, 4k floats"] = (
            [oiiotool, "--fail", "1e9", "--hardfail", "1e9", "--warn", "1e9", "--hardwarn", "1e9",
             "--diff", files["a.exr"], files["b.exr"]],
            "oiiotool --diff")
    return commands, others


def _tool(tool, *arguments):
    return json.loads(output_of([tool, *arguments]))


def measure(runner, root, folder, quick):
    """{row: {"seconds": [...], "mib": [...], "against": [...], "what": ...}}; `against` is seconds, too."""
    tool = runner.nacre.parent / "bench" / "waiting_bench"
    say("inputs of the rows")
    files = waiting_files.make(folder, root, runner.nacre, tool)
    commands, others = _commands(files, runner.nacre, shutil.which("oiiotool"))
    rounds = QUICK_ROUNDS if quick else ROUNDS
    say("whole processes")
    pairs = {}
    for row, command in commands.items():
        pairs[row] = command
        if row in others:
            pairs["beside " + row] = others[row][0]
    found = runner.interleave(pairs, rounds)
    rows = {}
    for row in commands:
        rows[row] = {"seconds": found[row]["seconds"], "mib": found[row]["mib"]}
        if row in others:
            rows[row] |= {"against": found["beside " + row]["seconds"], "what": others[row][1]}
    say("bare libraries")
    rows["4k PNG texture"] |= {
        "against": _tool(tool, "spng", files["texture.png"], rounds)["seconds"],
        "what": "libspng decodes it"}
    rows["GLB, 4.2 million triangles"] |= {
        "against": _tool(tool, "embree", waiting_files.GLB_TRIANGLES, rounds)["seconds"],
        "what": "Embree builds a tree of as many"}
    rows["1e7 spheres, 1080p"] |= {
        "against": [10 * seconds for seconds in rows["1e6 spheres, 1080p"]["seconds"]],
        "what": "ten times 1e6 spheres"}
    say("sessions")
    for row, (scene, size, samples, pointer, values) in _SESSIONS.items():
        times = _tool(tool, "session", files[scene], size, samples, SESSION_TURNS, pointer, *values)
        rows[row] = {"seconds": times["seconds"], "against": times["render"], "what": "its render part",
                     "first": times["first"]}
    rows["session: cancelled while a tree of a million triangles is built"] = _tool(
        tool, "cancel", files["ball.json"], CANCELLED_TURNS)
    say("incoherent rays")
    for count, name in ((100_000, "1e5"), (1_000_000, "1e6")):
        times = _tool(tool, "rays", count, RAY_TURNS)
        for kind, other in (("closest", "intersect1"), ("occluded", "occluded1")):
            rows[f"a million incoherent rays, {kind}, {name} spheres"] = {
                "seconds": [1e-3 * ns for ns in times[f"{kind}_ns"]],
                "against": [1e-3 * ns for ns in times[f"embree_{other}_ns"]],
                "what": f"Embree's {other}, in float"}
    return rows | _python_rows(runner, tool, rounds)


def _python_rows(runner, tool, rounds):
    """Those of the Python package, if it is built: by the Python that it is for."""
    build = runner.nacre.parent
    found = re.search("^NACRE_PYTHON_EXECUTABLE:[A-Z]+=(.+)$", (build / "CMakeCache.txt").read_text(), re.M)
    if not found or not any((build / "python/nacre").glob("_nacre.*.so")):
        return {}
    say("Python")
    script = pathlib.Path(__file__).with_name("python_bench.py")
    return _tool(found[1], script, build, tool, 3 * rounds)


def _cells(row):
    seconds = estimates.median(row["seconds"])
    cells = [f"{seconds:.3g}", f"{estimates.median(row['mib']):.0f}" if "mib" in row else ""]
    if "against" not in row:
        return [*cells, "", "", ""]
    other = estimates.median(row["against"])
    return [*cells, f"{other:.3g}", f"{seconds / other:.2f}", row["what"]]


_HEAD = ("waiting for", "s", "MiB", "beside, s", "times", "beside")


def text(rows):
    return report.table(_HEAD, [(name, *_cells(row)) for name, row in rows.items()])


def markdown(results):
    """The table of bench/README.md."""
    lines = ["| waiting for | s | MiB | beside it, s | times | which is |", "|---|---|---|---|---|---|"]
    lines += ["| " + " | ".join((name, *_cells(row))) + " |" for name, row in results["rows"].items()]
    return "\n".join([*lines, "", f"Measured by `{results['command']}`: "
                      f"{machine.line(results['machine'])}."])


def growth_of_spheres(rows):
    """The exponent from 1e6 to 1e7 spheres: the last decade."""
    values = [estimates.median(rows[f"{name} spheres, 1080p"]["seconds"]) for name in ("1e6", "1e7")]
    return estimates.log_fit([1e6, 1e7], values)[0]


def main(root, arguments, runner):
    if not runner.nacre.exists():
        raise Failed(f"{runner.nacre} is missing")
    results = {"machine": machine.describe(root, arguments.build), "command": "scripts/bench --waiting"}
    say(machine.line(results["machine"]))
    results["rows"] = measure(runner, root, arguments.out / "waiting", arguments.quick)
    results["growth_of_spheres"] = growth_of_spheres(results["rows"])
    file = arguments.out / "waiting.json"
    file.write_text(json.dumps(results, indent=1))
    print(text(results["rows"]))
    print(f"growth_of_time_with_spheres_from_1e6_to_1e7: {results['growth_of_spheres']:.3g}")
    if arguments.readme:
        readme.update_waiting(root, markdown(results))
    say(f"{file}")
    return 0
