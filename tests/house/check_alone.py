#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that every source and every header compiles alone, SIMD headers included: the syntax, no code.

A header that a source includes first is compiled with that. Others are with the flags of a source beside
them, SIMD headers as in a kernel, once for every target: each target's part of Highway brings along other
headers of the standard library. Kernels are left out: every build compiles them alone.

Usage: check_alone.py BUILD_FOLDER SOURCE_FOLDER. The build is configured with NACRE_UNITY=OFF; nothing need
be built.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

FOLDERS = ("src", "tests", "bench")
KERNEL = """#define HWY_TARGET_INCLUDE "{kernel}"
#include "hwy/foreach_target.h"
#include "{header}"
"""
FIRST_INCLUDE = re.compile(r'\s*#\s*include "([^"]+)"')


def first_include(source):
    """The path that a source includes before anything else, or None."""
    for line in source.read_text(encoding="utf-8").splitlines():
        if line.lstrip().startswith("#"):
            found = FIRST_INCLUDE.match(line)
            return found and found[1]
    return None


def read_commands(build, root):
    """{source of the tree: its compiler and flags}."""
    commands = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        source = pathlib.Path(entry["file"])
        words = shlex.split(entry["command"])
        if source.is_relative_to(root) and not source.is_relative_to(build):
            end = words.index("-o")
            commands[source] = words[:end] + words[end + 2:words.index("-c")]
    return commands


def flags_for(header, commands):
    """Those of a source in the header's folder or below, else of the folders above."""
    return next(words for folder in header.parents for source, words in commands.items()
                if folder in source.parents)


def fault_of(file, words, build, root):
    """What the compiler says of a file, or ""."""
    with tempfile.NamedTemporaryFile("w", suffix=".cc") as kernel:
        if file.name.endswith("-inl.h"):
            kernel.write(KERNEL.format(kernel=kernel.name, header=file))
            kernel.flush()
            inputs = [kernel.name]
        elif file.suffix == ".h":  # as the file itself it would be warned of for its #pragma once
            inputs = ["-include", file, os.devnull]
        else:
            inputs = [file]
        result = subprocess.run([*words, "-fsyntax-only", "-x", "c++", *inputs],
                                cwd=build, capture_output=True, text=True, check=False)
    return f"{file.relative_to(root)} does not compile alone:\n{result.stderr}" if result.returncode else ""


def check(build, root):
    """Prints all faults. Returns them, and how many sources and headers were compiled."""
    commands = read_commands(build, root)
    with_a_source = {first_include(source) for source in commands}
    headers = [header for folder in FOLDERS for header in sorted((root / folder).rglob("*.h"))
               if header.relative_to(root / folder).as_posix() not in with_a_source]
    sources = [item for item in commands.items() if not item[0].name.endswith("_kernel.cc")]
    files = [*sources, *((header, flags_for(header, commands)) for header in headers)]
    faults = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for done, fault in enumerate(pool.map(lambda file: fault_of(*file, build, root), files), 1):
            if fault:
                print(fault, flush=True)
                faults.append(fault)
            if done % 50 == 0:
                print(f"{done} of {len(files)}", flush=True)
    return faults, len(sources), len(headers)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path, help="the build folder")
    parser.add_argument("root", type=pathlib.Path, help="the root of the repository")
    arguments = parser.parse_args()
    faults, sources, headers = check(arguments.build.resolve(), arguments.root.resolve())
    print(f"{sources} sources and {headers} headers compiled alone, {len(faults)} faults")
    # Nothing compiled is a fault too: a check that saw nothing has checked nothing.
    return 1 if faults or sources == 0 or headers == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
