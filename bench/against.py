# SPDX-License-Identifier: Apache-2.0
"""Is the working tree slower than a commit? Both programs run in turns; ratios are paired."""
import dataclasses
import pathlib
import re
import shutil
import subprocess

import cases
import estimates
import google
import machine
import noise
import report
from processes import Failed, Runner, output_of, say, scratch_folder

LIMIT = 1.03  # new over old: beyond that is a slowdown
# What is compared: short enough that rounds are many. The best targets; no baselines.
BENCHMARKS = (r"^shade/.*/(avx2|avx3|sse4)$|^visibility/tiles/"
              r"|^frame/[a-z_]+/1920x1080/1spp/avx3$|^frame/material_grid/1920x1080/1spp/")
PROCESSES = ("grid_1080p_1spp", "grid_1080p_16spp", "grid_shadows_1080p_1spp", "startup",
             "mesh_and_spheres_1080p_1spp", "million_1spp")


@dataclasses.dataclass(frozen=True)
class Rounds:
    first: int = 11   # of everything
    again: int = 25   # of what looks slower, measured anew: chance does not strike twice
    min_time: float = 0.03
    slow: int = 5     # of processes of a second


FULL, QUICK = Rounds(), Rounds(first=7, again=15, min_time=0.01, slow=3)


def build_revision(root, revision):
    """The build folder of a commit, in a worktree that is kept under out/against."""
    name = output_of(["git", "-C", root, "rev-parse", "--verify", "--short=12",
                      f"{revision}^{{commit}}"]).strip()
    tree = root / "out" / "against" / name
    if not (tree / "CMakeLists.txt").exists():
        output_of(["git", "-C", root, "worktree", "prune"])
        output_of(["git", "-C", root, "worktree", "add", "--force", "--detach", tree, name])
    build = tree / "build"
    say(f"building {name} in {build}")
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DNACRE_TESTS=OFF"]
    if shutil.which("ccache"):
        options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    output_of(["cmake", "-S", tree, "-B", build, "-G", "Ninja", *options])
    output_of(["cmake", "--build", build, "--target", "nacre", "nacre_bench"])
    return name, build


def _in_turns(old, new, rounds):
    """Calls old() and new() once a round, each first in every other one: two lists of what they
    return."""
    results = ([], [])
    for number in range(rounds):
        for which in ((0, 1) if number % 2 == 0 else (1, 0)):
            results[which].append((old, new)[which]())
    return results


def _benchmark_ratios(old, new, names, rounds, min_time):
    """{name: paired ratio} of benchmarks that both programs have."""
    if not names:
        return {}
    pattern = "^(" + "|".join(map(re.escape, sorted(names))) + ")(/real_time)?$"
    # Google Benchmark's expressions are POSIX: no escapes but those of its own characters.
    pattern = pattern.replace("\\-", "-").replace("\\_", "_")

    def run(build):
        _, found = google.run(build / "bench" / "nacre_bench", pattern, 1, min_time)
        return {name: result["ns"][0] for name, result in found.items()}
    before, after = _in_turns(lambda: run(old), lambda: run(new), rounds)
    return {name: estimates.paired_ratio([r[name] for r in after], [r[name] for r in before])
            for name in names}


def _process_ratios(old, new, names, root, folder, rounds):
    """{name: paired ratio} of whole processes; both render the working tree's scenes."""
    runner = Runner(new)  # the timer is the working tree's for both
    commands = [cases.commands(build / "nacre", root / "scenes", folder) for build in (old, new)]
    ratios = {}
    for name in names:
        count = rounds.slow if name in cases.SLOW else rounds.first
        try:
            for which in commands:
                runner.run(which[name])  # brings files into memory
            before, after = _in_turns(lambda: runner.run(commands[0][name])["seconds"],
                                      lambda: runner.run(commands[1][name])["seconds"], count)
        except Failed as reason:
            say(f"{name}: not comparable: {reason}")
            continue
        ratios[name] = estimates.paired_ratio(after, before)
    return ratios


def _measure(old, new, root, folder, names, rounds):
    """{name: ratio} of benchmarks and, by names that begin with "process/", processes."""
    prefix = "process/"
    inside = {name for name in names if not name.startswith(prefix)}
    outside = [name.removeprefix(prefix) for name in names if name.startswith(prefix)]
    ratios = _benchmark_ratios(old, new, inside, rounds.first, rounds.min_time)
    found = _process_ratios(old, new, outside, root, folder, rounds)
    return ratios | {prefix + name: ratio for name, ratio in found.items()}


def _instructions(build, root, folder, target):
    """Instructions of a small frame by callgrind; it knows no AVX-512."""
    out = folder / "callgrind.out"
    output_of(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--quiet",
               build / "nacre", "render", root / "scenes" / "material_grid.json", "-o",
               folder / "frame.exr", "--size", "320x180", "--spp", "4", "--threads", "1",
               "--target", target, "--quiet"])
    return int(re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.MULTILINE).group(1))


def compare_instructions(old, new, root, folder):
    """Rows of the instruction counts; whether one grew beyond the limit."""
    if shutil.which("valgrind") is None:
        say("valgrind is not installed: no instruction counts")
        return [], False
    rows, slower = [], False
    for target in ("scalar", "sse4"):
        before, after = (_instructions(build, root, folder, target) for build in (old, new))
        slower |= after / before > LIMIT
        rows.append((f"instructions/material_grid/{target}", f"{after / before:.4f}",
                     f"{before:,}", f"{after:,}", "MORE" if after / before > LIMIT else ""))
    return rows, slower


def _common_names(old, new, only):
    """Benchmarks that both have and the processes, those that match."""
    both = [set(google.names(build / "bench" / "nacre_bench", BENCHMARKS)) for build in (old, new)]
    for name in sorted(both[0] ^ both[1]):
        say(f"{name}: only in the {'old' if name in both[0] else 'new'} program")
    names = sorted(both[0] & both[1]) + [f"process/{name}" for name in PROCESSES]
    names += [f"noise/{name}" for name in noise.SCENES]
    return [name for name in names if re.search(only, name)]


def compare_noise(old, new, names, root, folder, rounds):
    """Prints relMSE times time of the scenes; returns whether one grew beyond its limit."""
    ratios = noise.measure(Runner(new), [build / "nacre" for build in (old, new)],
                           root / "scenes", folder, names, rounds)
    rows = [(name, *(f"{ratio:.3f}" for ratio in found), "MORE" if found[2] > noise.LIMIT else "")
            for name, found in ratios.items()]
    print(report.table(("noise", "relMSE", "time", "product", ""), rows))
    print(f"geometric mean of the products: {noise.geometric_mean(ratios):.3f}")
    return any(found[2] > noise.LIMIT for found in ratios.values())


def main(root, arguments):
    """Exit code 1 if anything is slower or noisier."""
    rounds = QUICK if arguments.quick else FULL
    revision, old = build_revision(root, arguments.against)
    new = arguments.build
    print(f"{machine.line(machine.describe(root, new))}\nnew / old: the working tree over "
          f"{revision}; median of paired ratios and its 95 % interval", flush=True)
    names = _common_names(old, new, arguments.only)
    if not names:
        raise Failed(f"nothing matches {arguments.only}")
    noisy = [name.removeprefix("noise/") for name in names if name.startswith("noise/")]
    names = [name for name in names if not name.startswith("noise/")]
    with scratch_folder() as name:
        folder = pathlib.Path(name)
        ratios = _measure(old, new, root, folder, names, rounds)
        suspects = [name for name, ratio in ratios.items() if ratio[0] > LIMIT]
        if suspects:
            say(f"measuring again: {', '.join(suspects)}")
            again = dataclasses.replace(rounds, first=rounds.again, slow=2 * rounds.slow)
            ratios |= _measure(old, new, root, folder, suspects, again)
        slower = [name for name in suspects if estimates.is_slower(ratios[name], LIMIT)]
        rows = [(name, f"{middle:.3f}", f"{low:.3f}", f"{high:.3f}",
                 "SLOWER" if name in slower else "")
                for name, (middle, low, high) in ratios.items()]
        if rows:
            print(report.table(("benchmark", "new/old", "from", "to", ""), rows))
        more = bool(noisy) and compare_noise(old, new, noisy, root, folder, rounds.first)
        if arguments.instructions:
            rows, grew = compare_instructions(old, new, root, folder)
            more |= grew
            if rows:
                print(report.table(("callgrind", "new/old", "old", "new", ""), rows))
    unsure = [name for name, (_, low, high) in ratios.items() if high / low > LIMIT ** 2]
    if unsure:
        print(f"{len(unsure)} intervals are wider than +-{100 * (LIMIT - 1):.0f} %: "
              "let the machine be quiet, or more rounds run (bench/against.py)")
    print(f"{len(slower)} of {len(ratios)} slower by more than {100 * (LIMIT - 1):.0f} %")
    return 1 if slower or more else 0
