# SPDX-License-Identifier: Apache-2.0
"""Runs nacre_bench and reads what Google Benchmark writes."""
import json
import math
import re
import subprocess

import estimates
from processes import Failed

_NANOSECONDS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}
# Fields of Google Benchmark's own; all other numbers are counters of ours.
_OWN_FIELDS = {"family_index", "per_family_instance_index", "repetitions", "repetition_index",
               "threads", "iterations", "real_time", "cpu_time"}


def parse(text):
    """(context, {name: {"ns": [...], "wall_ns": [...], "counters": {...}}}) of Google Benchmark's
    JSON.

    ns are the repetitions' times of one iteration, in the order of their numbers: of the processor
    where one thread works, which other programs disturb less; of the wall's clock for benchmarks
    that ask for it. Counters are medians.
    """
    data = json.loads(text)
    found = {}
    for entry in data["benchmarks"]:
        if entry.get("run_type") != "iteration" or entry.get("error_occurred"):
            continue
        name, real = re.subn(r"/real_time$", "", entry["run_name"])
        unit = _NANOSECONDS[entry["time_unit"]]
        wall = entry["real_time"] * unit
        time = wall if real else entry["cpu_time"] * unit
        numbers = {key: value for key, value in entry.items()
                   if isinstance(value, (int, float)) and key not in _OWN_FIELDS}
        found.setdefault(name, []).append((entry.get("repetition_index", 0), time, wall, numbers))
    results = {}
    for name, rows in found.items():
        rows.sort(key=lambda row: row[0])
        counters = {key: estimates.median([row[3][key] for row in rows]) for key in rows[0][3]}
        # JSON has no infinity, and Google Benchmark writes one all the same.
        counters = {key: value if math.isfinite(value) else None
                    for key, value in counters.items()}
        results[name] = {"ns": [row[1] for row in rows], "wall_ns": [row[2] for row in rows],
                         "counters": counters}
    return data["context"], results


def run(program, pattern, repetitions, min_time):
    """Measures the benchmarks that match the regular expression."""
    command = [str(program), f"--benchmark_filter={pattern}", "--benchmark_format=json",
               f"--benchmark_repetitions={repetitions}", f"--benchmark_min_time={min_time}",
               "--benchmark_enable_random_interleaving=true"]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode != 0 or not result.stdout.startswith("{"):
        raise Failed(f"{program}: {(result.stdout + result.stderr).strip()[-500:]}")
    context, results = parse(result.stdout)
    # The random order is for measuring; tables are in the order of the sources.
    return context, {name: results[name] for name in names(program, pattern) if name in results}


def names(program, pattern="."):
    """The names of the benchmarks that match."""
    command = [str(program), f"--benchmark_filter={pattern}", "--benchmark_list_tests=true"]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    return [re.sub(r"/real_time$", "", line) for line in result.stdout.split()]
