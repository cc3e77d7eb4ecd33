#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What each special path of bench/special_paths.txt is worth: a frame with it and without it.

    bench/special_paths.py [--rounds N] [--target T] [--table] [NAME...]

One program is built, of a copy of the tree in which every path can be switched off, so that both
sides of a pair are the same code in the same places. Prints, for each path, how many times longer
the frame takes without it, the median of pairs, and the interval of that. --table: as a table for
src/README.md. --check: only that each text of the list occurs once.
"""
import argparse
import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path += [str(HERE), str(ROOT / "tests" / "mutation")]

import estimates  # noqa: E402
import fault_list  # noqa: E402
from processes import Failed, output_of, say, scratch_folder  # noqa: E402

LEAST = 1.10  # what a path must be worth to stay


@dataclasses.dataclass
class Path:
    name: str
    frame: list[str]  # scene and options
    change: fault_list.Fault


def read_paths():
    """The list has the faults' form, but for its first lines: a frame in the place of tests."""
    text = (HERE / "special_paths.txt").read_text(encoding="utf-8")
    frames = {name: frame.split() for name, frame in
              re.findall(r"^path (\w+): (.+)$", text, re.MULTILINE)}
    changes = fault_list.parse(re.sub(r"^path (\w+): .+$", r"fault \1: none", text, flags=re.M),
                               "special_paths.txt")
    return [Path(change.name, frames[change.name], change) for change in changes]


def change_sources(paths, tree):
    """All changes at once: each text is looked for in what those before it left. What is so already
    keeps its time, so that little is built anew."""
    changed = {part.path for path in paths for part in path.change.parts}
    before = {file: ((tree / file).read_bytes(), (tree / file).stat())
              for file in changed if (tree / file).exists()}
    for file in output_of(["git", "-C", ROOT, "ls-files"]).splitlines():
        if (ROOT / file).exists():
            (tree / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / file, tree / file)
    for path in paths:
        for file, content in fault_list.plant(path.change, tree).items():
            (tree / file).write_text(content, encoding="utf-8")
    for file, (content, status) in before.items():
        if (tree / file).read_bytes() == content:
            os.utime(tree / file, ns=(status.st_atime_ns, status.st_mtime_ns))


def switch(paths):
    """What every source includes first: OFF(name), by the environment."""
    names = "".join(f"constexpr int {path.name} = {number};\n"
                    for number, path in enumerate(paths, 1))
    return ("#pragma once\n#ifdef __cplusplus\n#include <cstdlib>\nnamespace special_path {\n"
            f"{names}inline const int off = [] {{\n"
            "  const char* const number = std::getenv(\"NACRE_PATH_OFF\");\n"
            "  return number == nullptr ? 0 : std::atoi(number);\n}();\n}\n"
            "#define OFF(name) (::special_path::off == ::special_path::name)\n#endif\n")


def build(paths):
    """The program whose paths can be switched off; kept under out/, so that it is built once."""
    tree = ROOT / "out" / "special_paths"
    tree.mkdir(parents=True, exist_ok=True)
    change_sources(paths, tree)
    off = tree / "off.h"
    if not off.exists() or off.read_text(encoding="utf-8") != switch(paths):
        off.write_text(switch(paths), encoding="utf-8")
    folder = tree / "build"
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DNACRE_TESTS=OFF", "-DNACRE_UNITY=ON",
               f"-DCMAKE_CXX_FLAGS=-include {off}"]
    if shutil.which("ccache"):
        options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    say(f"building {folder}")
    output_of(["cmake", "-S", tree, "-B", folder, "-G", "Ninja", *options])
    output_of(["cmake", "--build", folder, "--target", "nacre"])
    return folder / "nacre"


def milliseconds(nacre, path, number, folder, extra):
    """Of planning and rendering a frame, by one thread, written nowhere; `number` is the path not to
    be taken."""
    stats = pathlib.Path(folder) / "stats.json"
    scene, *options = path.frame
    command = [nacre, "render", ROOT / "scenes" / scene, "-o", "null:",
               "--threads", "1", "--stats", stats, "--progress", "none", *options, *extra]
    result = subprocess.run([str(part) for part in command], capture_output=True, text=True,
                            env={**os.environ, "NACRE_PATH_OFF": str(number)}, check=False)
    if result.returncode != 0:
        raise Failed(result.stderr.strip())
    times = json.loads(stats.read_text(encoding="utf-8"))["time_ms"]
    return times["plan"] + times["render"]


def measure(nacre, paths, names, rounds, extra):
    """{name: (ratio without over with, low, high)}; `extra`: further options of nacre render."""
    found = {}
    with scratch_folder() as folder:
        for number, path in enumerate(paths, 1):
            if names and path.name not in names:
                continue
            times = ([], [])
            for turn in range(-1, rounds):  # the first, not counted, fills caches
                for off in ((0, 1) if turn % 2 else (1, 0)):
                    time = milliseconds(nacre, path, number * off, folder, extra)
                    if turn >= 0:
                        times[off].append(time)
            found[path.name] = estimates.paired_ratio(times[1], times[0])
            ratio, low, high = found[path.name]
            say(f"{path.name:26} {ratio:6.3f}  ({low:.3f} to {high:.3f})  {estimates.median(times[0]):8.1f} ms"
                f"  {' '.join(path.frame)}{'' if ratio >= LEAST else '   LESS THAN ' + str(LEAST)}")
    return found


def table(paths, found):
    """In Markdown, the most valuable first."""
    rows = ["| path | without it | frame |", "|---|---|---|"]
    for path in sorted(paths, key=lambda path: -found.get(path.name, (0,))[0]):
        if path.name in found:
            rows.append(f"| {path.change.why} | {found[path.name][0]:.2f} times the time "
                        f"| `{' '.join(path.frame)}` |")
    return "\n".join(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--target", help="the SIMD target; by default the best")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    paths = read_paths()
    unknown = set(arguments.names) - {path.name for path in paths}
    if unknown:
        parser.error(f"no path is called {', '.join(sorted(unknown))}")
    try:
        if arguments.check:
            for path in paths:
                fault_list.plant(path.change, ROOT)
            return 0
        found = measure(build(paths), paths, arguments.names, arguments.rounds,
                        ["--target", arguments.target] if arguments.target else [])
    except (Failed, fault_list.ListError) as error:
        say(f"special_paths: {error}")
        return 2
    if arguments.table:
        print(table(paths, found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
