#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the costs of src/render/camera_cost.cc to what this machine takes, for each SIMD target.

  bench/camera_cost.py WAITING_BENCH [TABLE]   measures (half an hour, nothing beside it) and leaves
                                               out/camera_cost.txt, or reads the TABLE of an earlier run

Prints a row of costs for each target, and where the faster method would not be chosen.
"""
import pathlib
import re
import subprocess
import sys

import numpy as np  # Debian's python3 has it

COUNTS, SAMPLES, TURNS = (10_000, 100_000, 1_000_000), (1, 4, 16), 3
TARGETS = ("avx3", "avx2", "sse4", "scalar")


def measure(program, table):
    """Writes what `waiting_bench clouds` prints, each part below the line of its target."""
    with table.open("w") as file:
        for target in TARGETS:
            for spheres in COUNTS:
                for samples in SAMPLES:
                    if spheres * samples > 4_000_000:
                        continue  # minutes for each row
                    done = subprocess.run([program, "clouds", target, *map(str, (spheres, samples, TURNS))],
                                          capture_output=True, text=True, check=False)
                    if done.returncode != 0:
                        print(done.stderr.strip(), file=sys.stderr)
                        continue
                    file.write(f"# {target}\n{done.stdout}")
                    file.flush()


def rows_of(table):
    """By target: arrays of rows as the program prints them, without its heads."""
    rows = {}
    for line in table.read_text().splitlines():
        if line.startswith("#"):
            target = line.split()[1]
        elif re.match(r"\s*\d", line):
            rows.setdefault(target, []).append([float(word) for word in line.split()])
    return {target: np.array(found) for target, found in rows.items()}


def fit(rows):
    """Costs in nanoseconds: bin, gather, fetch, descend, overlap, build; and where they choose wrongly."""
    spheres, depth, bins, by_tiles, built, view, by_tree, _, _, cells, rays = rows.T
    tiles, tree = 1e6 * (bins + by_tiles), 1e6 * (view + by_tree)
    features = np.stack([cells, -cells / np.sqrt(np.maximum(depth, 1)), -rays, -rays * depth], axis=1)
    bin_cost = np.median(1e6 * (bins - view) / spheres)
    # What matters is which is less: errors count by the time that a wrong choice would lose.
    weight = 1 / np.minimum(tiles, tree)
    saves = tiles - tree
    costs = np.linalg.lstsq(features * weight[:, None], (saves - spheres * bin_cost) * weight, rcond=None)[0]
    said = features @ costs + spheres * bin_cost
    wrong = (said > 0) != (saves > 0)
    lost = np.abs(saves) / np.minimum(tiles, tree)
    return (bin_cost, *costs, np.median(1e6 * built / spheres)), [
        (int(n), d, r / 668_000, lost_here)
        for n, d, r, lost_here in np.stack([spheres, depth, rays, lost], axis=1)[wrong]]


def main():
    program, *rest = sys.argv[1:]
    table = pathlib.Path(rest[0] if rest else "out/camera_cost.txt")
    if not rest:
        table.parent.mkdir(exist_ok=True)
        measure(program, table)
    print("target   bin  gather  fetch  descend  overlap  build")
    for target, rows in rows_of(table).items():
        costs, wrong = fit(rows)
        print(f"{target:6} {costs[0]:5.0f} {costs[1]:7.0f} {costs[2]:6.0f} {costs[3]:8.0f} {costs[4]:8.2f} {costs[5]:6.0f}")
        for spheres, depth, samples, lost in wrong:
            print(f"  {spheres} spheres, depth {depth:g}, {samples:.0f} samples: {100 * lost:.0f} % lost")


if __name__ == "__main__":
    main()
