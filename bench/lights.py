# SPDX-License-Identifier: Apache-2.0
"""Run time against error under lights that are sampled: the material grid under a sky, under a
rectangle and under the picture of a sky with a small sun, one thread."""
import json
import math
import struct

import estimates
from processes import output_of, say

SIZE = "480x270"
# Times to these errors are headlines. Cycles, on two cores of this class: 1.5 s and 7.9 s under the
# sky, 2.6 s and 10 s under the rectangle; Mitsuba 3 (LLVM) 6.8 s under a sky with a sun.
GOALS = {"sky": (0.043, 0.015), "rectangle": (0.16, 0.089), "sun": (0.25,)}


def _rgbe(color):
    largest = max(color)
    if largest < 1e-32:
        return bytes(4)
    mantissa, exponent = math.frexp(largest)
    scale = mantissa * 256 / largest
    return bytes([*(int(channel * scale) for channel in color), exponent + 128])


def write_sun(path, width=512, height=256):
    """A Radiance picture of a gradient with a sun of 4 by 4 texels, as bright as all the rest."""
    rows = [f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()]
    for y in range(height):
        up = math.cos(math.pi * (y + 0.5) / height)
        sky = (0.3 + 0.2 * up, 0.4 + 0.3 * up, 0.6 + 0.4 * up) if up > 0 else (0.2, 0.18, 0.15)
        row = [sky] * width
        if 60 <= y < 64:
            row[180:184] = [(8000, 7600, 6800)] * 4
        rows.append(b"".join(map(_rgbe, row)))
    path.write_bytes(b"".join(rows))


def scenes_of(grid, folder):
    """{name: file} of the grid under each light, before black."""
    write_sun(folder / "sun.hdr")
    lights = {
        "sky": {"type": "environment", "radiance": 1, "background": False},
        "rectangle": {"type": "rectangle", "center": [3, 4, 4], "facing": [-3, -4, -4],
                      "up": [0, 1, 0], "width": 2, "height": 2, "radiance": 20},
        "sun": {"type": "environment", "image": "sun.hdr", "background": False},
    }
    found = {}
    for name, light in lights.items():
        scene = json.loads(grid.read_text()) | {"lights": {name: light}, "background": 0}
        scene.pop("$schema", None)
        found[name] = folder / f"{name}.json"
        found[name].write_text(json.dumps(scene))
    return found


def relative_rmse(layers):
    """sqrt(mean d^2) / mean(reference) over the spheres' pixels, of what `nacre compare` tells of
    the beauty and of the coverage: before black, all others are equal."""
    coverage = layers["A"]["mean_reference"]
    beauty = layers["beauty"]
    return beauty["rmse"] * math.sqrt(coverage) / beauty["mean_reference"]


def _error(nacre, image, truth):
    text = output_of([nacre, "compare", image, truth, "--layers", "A,beauty", "--json"],
                     accepted=(0, 1))  # 1: they differ
    return relative_rmse({layer["layer"]: layer for layer in json.loads(text)["layers"]})


def measure(runner, scenes, folder, settings):
    """{name: {"truth_error", "curves": {"uniform" and "adaptive": [{"what", "seconds",
    "error"}...]}}} of each light. The truth is sampled adaptively: most of the error is a few
    highlights', and `truth_error` is that of two truths by other samples, a root of 2 apart."""
    found = {}
    image, truths = folder / "image.exr", (folder / "truth.exr", folder / "truth2.exr")
    curves = {"uniform": [("--spp", spp) for spp in settings.lights_spp],
              "adaptive": [("--spp", settings.lights_truth_spp, "--max-error", error)
                           for error in settings.lights_max_errors]}
    for name, scene in scenes_of(scenes / "material_grid.json", folder).items():
        say(f"  under a {name}")

        def render(path, *arguments, scene=scene):
            return [runner.nacre, "render", scene, "-o", path, "--depth", "float", "--size", SIZE,
                    "--quiet", *arguments]
        for seed, truth in enumerate(truths, 77):
            runner.run(render(truth, "--spp", settings.lights_truth_spp, "--max-error",
                              settings.lights_truth_error, "--seed", seed))
        light = {"truth_error": _error(runner.nacre, truths[1], truths[0]) / math.sqrt(2)}
        light["curves"] = {kind: [] for kind in curves}
        for kind, arguments in ((kind, point) for kind in curves for point in curves[kind]):
            command = render(image, *arguments, "--threads", 1)
            seconds = [runner.run(command)["seconds"] for _ in range(settings.precision_rounds)]
            light["curves"][kind].append(
                {"what": " ".join(map(str, arguments)), "seconds": estimates.median(seconds),
                 "error": _error(runner.nacre, image, truths[0])})
        found[name] = light
    return found


def headlines(series):
    """(name, milliseconds) for each goal, by the faster of the two ways to sample."""
    for name, goals in GOALS.items():
        for goal in goals:
            curves = series[name]["curves"].values() if name in series else ()
            seconds = [estimates.seconds_to(points, goal) for points in curves]
            found = min((time for time in seconds if time is not None), default=None)
            yield (f"{name}_ms_to_{100 * goal:g}_percent", None if found is None else 1e3 * found)
