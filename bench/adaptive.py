# SPDX-License-Identifier: Apache-2.0
"""What adaptive sampling is worth: the time that as many samples for every pixel need to reach the
same error, in frames of full size. A few pixels with highlights make most of the RMSE, so it is
that of several seeds; relative errors are those of all pixels."""
import json
import math

import estimates

FRAME = ("--depth", "float")


def _frame(runner, scene, folder, settings, errors, truth, option, seed):
    """(seconds, {"rmse", "rel_mse"}, camera rays) of one picture."""
    frame = runner.frame(scene, folder, (*FRAME, "--size", settings.size, "--seed", seed, *option))
    counts = json.loads((folder / "stats.json").read_text())["counts"]
    return (frame["frame"], errors(runner.nacre, folder / "frame.exr", truth),
            counts["camera_rays"])


def _point(option, frames):
    seconds, found, rays = zip(*frames)
    mean = {key: math.fsum(e) / len(found) for key, e in
            (("mse", [e["rmse"] ** 2 for e in found]), ("rel_mse", [e["rel_mse"] for e in found]))}
    return {"what": " ".join(map(str, option)), "seconds": estimates.median(seconds),
            "error": math.sqrt(mean["mse"]), "relative_error": math.sqrt(mean["rel_mse"]),
            "camera_rays": estimates.median(rays)}


def measure(runner, scene, folder, settings, errors):
    """{"uniform" and "adaptive": [{"what", "seconds" of a frame on one thread, "error" (RMSE),
    "relative_error" (root of relMSE), "camera_rays"}...]}. `errors`(nacre, image, truth) has the
    squares. The ways to sample take turns, seed by seed, so that what disturbs the machine disturbs
    all."""
    truth = folder / "truth_adaptive.exr"
    runner.run([runner.nacre, "render", scene, "-o", truth, *FRAME, "--size", settings.size,
                "--quiet", "--spp", settings.truth_spp, "--seed", 77])
    options = {"uniform": [("--spp", spp) for spp in settings.adaptive_spp],
               "adaptive": [("--max-error", error) for error in settings.adaptive_max_errors]}
    frames = {option: [] for kind in options for option in options[kind]}
    for seed in range(1, settings.adaptive_seeds + 1):
        for option, found in frames.items():
            found.append(_frame(runner, scene, folder, settings, errors, truth, option, seed))
    return {kind: [_point(option, frames[option]) for option in options[kind]] for kind in options}


def headlines(series):
    """(name, times) for each tolerance: how much longer uniform samples take to its RMSE and to its
    relative error, and how many times as many camera rays to its RMSE."""
    for point in series.get("adaptive", ()):
        name = point["what"].split()[-1]
        for cost, error, suffix in (("seconds", "error", ""), ("camera_rays", "error", "_in_rays"),
                                    ("seconds", "relative_error", "_at_equal_relative_error")):
            uniform = [{"error": p[error], "seconds": p[cost]} for p in series["uniform"]]
            reached = uniform[0]["error"] >= point[error]
            found = estimates.seconds_to(uniform, point[error]) if reached else None
            yield (f"adaptive_{name}_over_uniform{suffix}",
                   None if found is None else found / point[cost])
