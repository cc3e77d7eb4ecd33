# SPDX-License-Identifier: Apache-2.0
"""Runs programs and tells wall time from spawn to exit and peak memory."""
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile


class Failed(Exception):
    """A program that should have worked did not."""


def say(text):
    """Progress, on stderr: stdout is for results."""
    print(text, file=sys.stderr, flush=True)


def scratch_folder():
    """A new folder in memory where there is one, so that no disk is measured."""
    shm = pathlib.Path("/dev/shm")
    parent = shm if os.access(shm, os.W_OK) else None
    return tempfile.TemporaryDirectory(prefix="nacre_bench_", dir=parent)


class Runner:
    """Times processes by build/bench/time_process (bench/time_process.cc)."""

    def __init__(self, build):
        self._timer = build / "bench" / "time_process"
        self.nacre = build / "nacre"

    def run(self, command):
        """{"seconds", "cpu", "mib"} of a program that must exit with 0: wall time from spawn to
        exit, processor time, peak memory."""
        command = [str(argument) for argument in command]
        result = subprocess.run([self._timer, *command], stdin=subprocess.DEVNULL,
                                capture_output=True, text=True, check=False)
        if result.returncode != 0:
            raise Failed(result.stderr.strip())
        seconds, cpu, mib, code = result.stdout.split()
        if code != "0":
            raise Failed(f"exit code {code}: {shlex.join(command)}\n{result.stderr.strip()[-500:]}")
        return {"seconds": float(seconds), "cpu": float(cpu), "mib": float(mib)}

    def interleave(self, commands, rounds):
        """Runs each of the named commands once a round: {name: {"seconds": [...], "cpu": [...],
        "mib": [...]}}. A round before the first one, not counted, brings files and libraries into
        memory."""
        results = {name: {"seconds": [], "cpu": [], "mib": []} for name in commands}
        for number in range(-1, rounds):
            for name, command in commands.items():
                found = self.run(command)
                for key, values in results[name].items():
                    if number >= 0:
                        values.append(found[key])
        return results

    def frame(self, scene, folder, arguments, threads=1):
        """Renders a scene file: what `run` returns, and "frame", seconds of the frame in memory:
        planning and rendering without packing and files, whose share is taken to be that of the
        stages' times (on one thread it is exactly theirs)."""
        stats = folder / "stats.json"
        found = self.run([self.nacre, "render", scene, "-o", folder / "frame.exr", "--quiet",
                          "--threads", threads, "--stats", stats, *arguments])
        times = json.loads(stats.read_text())["time_ms"]
        output = times["stages_all_threads"]["output"] / threads
        return {**found, "frame": 1e-3 * (times["plan"] + times["render"] - output)}


def output_of(command, accepted=(0,)):
    """What a program prints on stdout."""
    result = subprocess.run([str(argument) for argument in command], capture_output=True,
                            text=True, check=False)
    if result.returncode not in accepted:
        raise Failed(f"exit code {result.returncode}: {result.stderr.strip()[-500:]}")
    return result.stdout
