# SPDX-License-Identifier: Apache-2.0
"""Puts the diagrams into scenes/gallery and the tables between two marks of bench/README.md.

The headlines of every processor that they were measured on are kept in bench/machines.json, the
latest run of each, and stand side by side: which way is faster goes with the processor.
"""
import json
import shutil

import figures
import machine
import report

BEGIN, END = "<!-- bench: begin -->", "<!-- bench: end -->"
WAITING_BEGIN, WAITING_END = "<!-- waiting: begin -->", "<!-- waiting: end -->"


def replace_between(text, begin, end, new):
    """`text` with what stands between the lines `begin` and `end` replaced."""
    head, found_begin, rest = text.partition(begin)
    _, found_end, tail = rest.partition(end)
    if not found_begin or not found_end:
        raise ValueError(f"no {begin} ... {end}")
    return f"{head}{begin}\n{new.strip()}\n{end}{tail}"


def _number(value):
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def with_this_run(runs, results):
    """The latest runs of each processor, this one first."""
    processor = results["machine"]["processor"]
    own = {"processor": processor, "line": machine.line(results["machine"]),
           "headlines": {name: value for name, value in results["summary"].items()
                         if not name.startswith(("growth", "steepest"))}}
    return [own] + [run for run in runs if run["processor"] != processor]


# The numbers that come first, in words.
FIRST = {
    "process_ms_grid_1080p_1spp": "`material_grid.json` at 1920x1080, one sample a pixel, to EXR: the "
                                  "whole process, ms",
    "frame_ms_grid_1080p_16spp": "the same with 16 samples, the frame in memory, ms",
    "process_s_million_1spp": "a million spheres at 1920x1080, one sample: the whole process, s",
    "grid_visibility_over_embree_spheres": "exact hits of the grid, times Embree's own spheres in "
                                           "float",
    "visibility_1e5_over_embree_spheres": "the same of 100 000 spheres",
    "ggx_over_scalar": "GGX shading, times plain C++",
    "phong_over_scalar": "Phong shading, times plain C++",
    "adaptive_0.03_over_uniform": "`--max-error 0.03` on the grid, times equal samples for all pixels "
                                  "that reach the same error",
}


def headline_table(runs, words=None):
    """A column a processor; blank what one was not asked for. `words`: the rows, by name; without
    it all there are, by their names."""
    names = words or list(dict.fromkeys(name for run in runs for name in run["headlines"]))
    rows = ["| headline | " + " | ".join(run["processor"] for run in runs) + " |",
            "|---|" + "---|" * len(runs)]
    for name in names:
        values = [_number(run["headlines"][name]) if name in run["headlines"] else ""
                  for run in runs]
        rows.append(f"| {words[name] if words else f'`{name}`'} | " + " | ".join(values) + " |")
    return rows


def _folded(title, lines):
    """Shown when it is asked for."""
    return ["<details>", f"<summary>{title}</summary>", "", *lines, "", "</details>", ""]


def markdown(results, runs):
    """The headline numbers of all runs, of which the first one is this: a few, and folded behind
    them the kernels beside plain C++ and all numbers."""
    best = results["best_target"]
    rows = [row for row in report.kernel_rows(results["benchmarks"])
            if row[1] == "cached" and row[2] in ("avx2", best)]
    by_model = {}
    for model, _, target, ns, rate, ratio, _ in rows:
        by_model.setdefault(model, {})[target] = (ns, rate, ratio)
    lines = [f"Per hit and light, one thread; \"plain\" is {results['scalar_baseline']}"
             + (f"; {report.ports(results)}." if report.ports(results) else "."), "",
             f"| kernel | {best}, ns | million/s | times plain | of port bound | times plain at it "
             "| avx2, ns |", "|---|---|---|---|---|---|---|"]
    for model, found in by_model.items():
        if best not in found:
            continue
        ns, rate, ratio = found[best]
        avx2 = f"{found['avx2'][0]:.2f}" if "avx2" in found else ""
        lines.append(f"| {model.replace('_', ' ')} | {ns:.2f} | {rate / 1e6:.0f} | "
                     f"{f'{ratio:.1f}' if ratio else ''} | "
                     f"{report.share_of_bound(results, model, best, ns)} | "
                     f"{report.ratio_at_bound(results, model, best, ns, ratio)} | {avx2} |")
    ways = ["`a_over_b` compares two ways to do the same work: how many times faster a is, or how "
            "many times fewer rays it takes if the name ends in `in_rays`. Frames are rendered in "
            "memory, each into that of the one before, unless the name says process. Embree's "
            "spheres are traced alone, in float, with their tree built before; `in_float` finds "
            "the nearest sphere and its depth on both sides, all others exact hits with points "
            "and normals on nacre's. `at_port_bound` is counted, not timed: the exact test alone, "
            "with full vectors and no stalls.",
            "", *headline_table(runs)]
    measured = [f"Measured by `{results['command']}`: {machine.line(results['machine'])}."]
    if runs[1:]:
        measured.append("The other columns: " + "; ".join(run["line"] for run in runs[1:]) + ".")
    return "\n".join([*headline_table(runs, FIRST), "", *measured, "",
                      *_folded("Kernels", lines), *_folded("All numbers", ways)])


def update_waiting(root, table):
    """Rewrites the table of what people wait for."""
    readme = root / "bench" / "README.md"
    readme.write_text(replace_between(readme.read_text(), WAITING_BEGIN, WAITING_END, table))


def update(root, results, folder):
    """Copies the diagrams, keeps the headlines and rewrites the part of bench/README.md."""
    for name in figures.ALL:
        for suffix in ("svg", "png"):
            if (folder / f"{name}.{suffix}").exists():
                shutil.copy(folder / f"{name}.{suffix}", root / "scenes" / "gallery")
    kept = root / "bench" / "machines.json"
    runs = with_this_run(json.loads(kept.read_text()) if kept.exists() else [], results)
    kept.write_text(json.dumps(runs, indent=1) + "\n")
    readme = root / "bench" / "README.md"
    readme.write_text(replace_between(readme.read_text(), BEGIN, END, markdown(results, runs)))
