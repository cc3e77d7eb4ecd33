# SPDX-License-Identifier: Apache-2.0
"""Run time against error: pictures of fewer samples beside one of very many."""
import json

import adaptive
import estimates
import others
from processes import Failed, output_of, say

SCENE = "material_grid"


def errors(nacre, image, truth):
    """RMSE and relative MSE of the beauty. The first is mostly that of the few pixels with
    highlights a hundred times brighter than the rest; diagrams show the root of the second."""
    command = [nacre, "compare", image, truth, "--layers", "beauty", "--json"]
    text = output_of(command, accepted=(0, 1))  # 1: they differ
    layer = json.loads(text)["layers"][0]
    return {"rmse": layer["rmse"], "rel_mse": layer["rel_mse"]}


def _wall(runner, command, rounds):
    return estimates.median([runner.run(command)["seconds"] for _ in range(rounds)])


def _render(nacre, scenes, settings, image, *arguments):
    return [nacre, "render", scenes / f"{SCENE}.json", "-o", image, "--depth", "float", "--size",
            settings.precision_size, "--quiet", *arguments]


def samplers(help_text):
    """The names that --sampler takes, if there is one."""
    for line in help_text.splitlines():
        if "--sampler" in line and "{" in line:
            return line[line.index("{") + 1:line.index("}")].split(",")
    return []


def _nacre_series(runner, scenes, folder, settings, truth):
    """Process wall against error: uniform sampling, and adaptive sampling and other samplers where
    nacre has them."""
    help_text = output_of([runner.nacre, "render", "--help"])
    image = folder / "image.exr"
    runs = {"nacre, uniform samples":
            [("--spp", spp) for spp in settings.precision_spp]}
    for sampler in samplers(help_text):
        runs[f"nacre, {sampler}"] = [("--sampler", sampler, "--spp", spp)
                                     for spp in settings.precision_spp]
    if "--max-error" in help_text:
        runs["nacre, --max-error"] = [("--max-error", error) for error in settings.max_errors]
    series = {}
    for name, options in runs.items():
        for arguments in options:
            command = _render(runner.nacre, scenes, settings, image, *arguments)
            seconds = _wall(runner, command, settings.precision_rounds)
            point = {"what": " ".join(map(str, arguments)), "seconds": seconds,
                     **errors(runner.nacre, image, truth)}
            series.setdefault(name, []).append(point)
    return series


def _target_errors(runner, scenes, folder, settings, truth, targets):
    """{target: {spp: errors}}: every target rounds its own way."""
    image = folder / "image.exr"
    found = {}
    for target in targets:
        for spp in settings.precision_spp:
            runner.run(_render(runner.nacre, scenes, settings, image, "--spp", spp, "--target",
                               target))
            found.setdefault(target, {})[spp] = errors(runner.nacre, image, truth)
    return found


def frame_series(benchmarks, target_errors, size):
    """Time of the frame in memory on one thread against error, by target, intersector and skips.
    The intersector and what is skipped change no bits, so their error is that of the target."""
    series = {}
    for name, result in benchmarks.items():
        parts = name.split("/")
        if parts[:3] != ["frame", SCENE, size]:
            continue
        spp = int(parts[3].removesuffix("spp"))
        target, variant = parts[4], parts[5] if len(parts) > 5 else ""
        if spp not in target_errors.get(target, {}):
            continue
        label = {"": target, "embree": f"{target}, --intersector embree",
                 "general_path": f"{target}, nothing skipped"}.get(variant)
        if label:
            series.setdefault(label, []).append(
                {"spp": spp, "seconds": 1e-9 * estimates.median(result["ns"]),
                 **target_errors[target][spp]})
    return series


def measure(runner, scenes, folder, settings, benchmarks, targets):
    """{"frame": series, "process": series}, a series being {label: [point...]}, and {"adaptive":
    adaptive.measure's}."""
    truth = folder / "truth.exr"
    say(f"  truth: {settings.truth_spp} samples a pixel")
    runner.run(_render(runner.nacre, scenes, settings, truth, "--spp", settings.truth_spp,
                       "--seed", 77))
    by_target = _target_errors(runner, scenes, folder, settings, truth, targets)
    process = _nacre_series(runner, scenes, folder, settings, truth)
    for renderer in (others.povray, others.blender):
        try:
            process |= renderer(runner, folder, settings, errors)
        except (others.Absent, Failed) as reason:
            say(f"  {reason}")
    return {"frame": frame_series(benchmarks, by_target, settings.precision_size),
            "process": process,
            "adaptive": adaptive.measure(runner, scenes / f"{SCENE}.json", folder, settings,
                                         errors)}
