# SPDX-License-Identifier: Apache-2.0
"""Is the noise of a picture dearer than at a commit? Of scenes whose light is sampled, relMSE times
the time it takes: the time to any error is in proportion to it."""
import json
import math

import estimates
from processes import output_of, say

SCENES = ("area_lights", "skies", "mesh_lights", "metals", "specular", "textures",
          "coat_and_sheen")
LIMIT = 1.1  # of the product, new over old
SIZE, SAMPLES, TRUTH_SAMPLES = "160x90", 64, 8192
SEEDS = range(1, 9)  # not 77, the truth's


def _render(nacre, scene, path, *arguments):
    return [nacre, "render", scene, "-o", path, "--depth", "float", "--size", SIZE, "--quiet",
            *arguments]


def _errors(nacre, runner, scene, truth, folder):
    """The sum over the seeds of relMSE, of the beauty layer."""
    image, errors = folder / "image.exr", []
    for seed in SEEDS:
        runner.run(_render(nacre, scene, image, "--spp", SAMPLES, "--set", f"/image/seed={seed}"))
        text = output_of([runner.nacre, "compare", image, truth, "--layers", "beauty", "--json"],
                         accepted=(0, 1))  # 1: they differ
        errors.append(json.loads(text)["layers"][0]["rel_mse"])
    return math.fsum(errors)


def measure(runner, programs, scenes, folder, names, rounds):
    """{name: (relMSE, time, product)}, each new over old. `programs` are the old one and the new
    one; the truth is the new one's."""
    ratios = {}
    for name in names:
        say(f"noise of {name}")
        scene, truth = scenes / f"{name}.json", folder / "truth.exr"
        runner.run(_render(programs[1], scene, truth, "--spp", TRUTH_SAMPLES, "--set",
                           "/image/seed=77"))
        old, new = (_errors(nacre, runner, scene, truth, folder) for nacre in programs)
        commands = {nacre: _render(nacre, scene, folder / "image.exr", "--spp", SAMPLES)
                    for nacre in programs}
        times = runner.interleave(commands, rounds)
        time, *_ = estimates.paired_ratio(*(times[nacre]["seconds"] for nacre in programs[::-1]))
        ratios[name] = (new / old, time, new / old * time)
    return ratios


def geometric_mean(ratios):
    return math.exp(math.fsum(math.log(product) for *_, product in ratios.values()) / len(ratios))
