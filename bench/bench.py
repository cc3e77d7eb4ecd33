#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures nacre: kernels, visibility, frames, processes, scaling, run time against error.

Run by scripts/bench, which builds first; its --help says what there is.
"""
import argparse
import dataclasses
import json
import pathlib
import sys

import against
import cases
import figures
import google
import lights
import machine
import port_bound
import precision
import readme
import report
import scaling
import settings
import summary
import waiting
from processes import Failed, Runner, say, scratch_folder

ROOT = pathlib.Path(__file__).resolve().parent.parent


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--summary", action="store_true")
    parser.add_argument("--readme", action="store_true")
    parser.add_argument("--redraw", action="store_true")
    parser.add_argument("--waiting", action="store_true")
    parser.add_argument("--against", metavar="REV")
    parser.add_argument("--only", metavar="REGEX", default=".")
    parser.add_argument("--instructions", action="store_true")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out" / "bench")
    return parser.parse_args()


def measure_processes(runner, folder, sizes):
    """Wall time and peak memory of whole processes; the slow ones in fewer rounds."""
    commands = cases.commands(runner.nacre, ROOT / "scenes", folder)
    fast = {name: command for name, command in commands.items() if name not in cases.SLOW}
    slow = {name: command for name, command in commands.items() if name in cases.SLOW}
    return (runner.interleave(fast, sizes.process_rounds) |
            runner.interleave(slow, sizes.slow_process_rounds))


def measure(build, sizes, summary_only):
    """Everything, or what the headline numbers need, as one dictionary."""
    runner = Runner(build)
    results = {"machine": machine.describe(ROOT, build), "settings": dataclasses.asdict(sizes)}
    say(machine.line(results["machine"]))
    say("in one process, by Google Benchmark")
    results["benchmarks"] = {}
    for pattern in sizes.groups:
        say(f"  {pattern}")
        context, found = google.run(build / "bench" / "nacre_bench", pattern, sizes.repetitions,
                                    sizes.min_time)
        results["benchmarks"] |= found
    targets = context["simd_targets"].split()
    results["targets"], results["best_target"] = targets, targets[-1]
    results["scalar_baseline"] = context["scalar_baseline"]
    if sizes.port_bounds and port_bound.available() and not summary_only:
        say("port bounds of the kernels")
        results["port_bounds"], results["port_model"] = port_bound.measure(
            build / "bench" / "nacre_bench", results["benchmarks"], results["best_target"])
    with scratch_folder() as name:
        folder = pathlib.Path(name)
        say("whole processes")
        results["processes"] = measure_processes(runner, folder, sizes)
        if not summary_only:
            say("scaling, one thread")
            results["scaling"] = scaling.measure(
                runner, ROOT / "scenes", folder, sizes, results["machine"]["cores"])
            say("run time against error")
            results["precision"] = precision.measure(runner, ROOT / "scenes", folder, sizes,
                                                     results["benchmarks"], targets)
            say("run time against error under lights that are sampled")
            results["lights"] = lights.measure(runner, ROOT / "scenes", folder, sizes)
    return results


def main():
    arguments = parse_arguments()
    sizes = settings.QUICK if arguments.quick else settings.FULL
    if arguments.against:
        return against.main(ROOT, arguments)
    if arguments.summary:
        sizes = dataclasses.replace(sizes, groups=settings.SUMMARY_GROUPS)
    arguments.out.mkdir(parents=True, exist_ok=True)
    if arguments.waiting:
        return waiting.main(ROOT, arguments, Runner(arguments.build))
    file = arguments.out / "bench.json"
    if arguments.redraw:
        results = json.loads(file.read_text())
    else:
        results = measure(arguments.build, sizes, arguments.summary)
        results["command"] = "scripts/bench" + (" --quick" if arguments.quick else "")
    results["summary"], results["not_measured"] = summary.headlines(results)
    file.write_text(json.dumps(results, indent=1))
    if not arguments.summary:
        print(report.text(results))
        figures.draw_all(results, arguments.out)
    print("\n".join(summary.lines(results["summary"])))
    for name in results["not_measured"]:
        say(f"not measured: {name}")
    if arguments.readme:
        readme.update(ROOT, results, arguments.out)
    say(f"{file}" + ("" if arguments.summary else f" and the plots beside it"))
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Failed, OSError) as error:
        sys.exit(f"bench: {error}")
    except KeyboardInterrupt:
        sys.exit(130)
