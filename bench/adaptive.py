# SPDX-License-Identifier: Apache-2.0
"""What adaptive sampling is worth: the time that as many samples for every pixel need to reach the
same error. A few pixels with highlights make most of the RMSE, so it is that of several seeds."""
import json
import math

import estimates

FRAME = ("--depth", "float")


def _frame(runner, scene, folder, settings, errors, truth, option, seed):
    """(seconds, RMSE, camera rays) of one picture."""
    frame = runner.frame(scene, folder, (*FRAME, "--size", settings.precision_size, "--seed", seed,
                                         *option))
    counts = json.loads((folder / "stats.json").read_text())["counts"]
    return (frame["frame"], errors(runner.nacre, folder / "frame.exr", truth)["rmse"],
            counts["camera_rays"])


def _point(option, frames):
    seconds, rmse, rays = zip(*frames)
    return {"what": " ".join(map(str, option)), "seconds": estimates.median(seconds),
            "error": math.sqrt(math.fsum(e * e for e in rmse) / len(rmse)),
            "camera_rays": estimates.median(rays)}


def measure(runner, scene, folder, settings, errors, truth):
    """{"uniform" and "adaptive": [{"what", "seconds" of a frame on one thread, "error",
    "camera_rays"}...]}. `errors`(nacre, image, truth) has the "rmse". The ways to sample take
    turns, seed by seed, so that what disturbs the machine disturbs all."""
    options = {"uniform": [("--spp", spp) for spp in settings.adaptive_spp],
               "adaptive": [("--max-error", error) for error in settings.adaptive_max_errors]}
    frames = {option: [] for kind in options for option in options[kind]}
    for seed in range(1, settings.adaptive_seeds + 1):
        for option, found in frames.items():
            found.append(_frame(runner, scene, folder, settings, errors, truth, option, seed))
    return {kind: [_point(option, frames[option]) for option in options[kind]] for kind in options}


def headlines(series):
    """(name, times) for each tolerance: how much longer uniform samples take to its error, and how
    many times as many camera rays."""
    for point in series.get("adaptive", ()):
        name = point["what"].split()[-1]
        for key, suffix in (("seconds", ""), ("camera_rays", "_in_rays")):
            uniform = [{"error": p["error"], "seconds": p[key]} for p in series["uniform"]]
            reached = uniform[0]["error"] >= point["error"]
            cost = estimates.seconds_to(uniform, point["error"]) if reached else None
            yield (f"adaptive_{name}_over_uniform{suffix}",
                   None if cost is None else cost / point[key])
