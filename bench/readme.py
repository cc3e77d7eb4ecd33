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


def headline_table(runs):
    """A column a processor; blank what one was not asked for."""
    names = list(dict.fromkeys(name for run in runs for name in run["headlines"]))
    rows = ["| headline | " + " | ".join(run["processor"] for run in runs) + " |",
            "|---|" + "---|" * len(runs)]
    for name in names:
        values = [_number(run["headlines"][name]) if name in run["headlines"] else ""
                  for run in runs]
        rows.append(f"| `{name}` | " + " | ".join(values) + " |")
    return rows


def markdown(results, runs):
    """The short form: kernels beside plain C++, and the headline numbers of all runs, of which
    the first one is this."""
    best = results["best_target"]
    rows = [row for row in report.kernel_rows(results["benchmarks"])
            if row[1] == "cached" and row[2] in ("avx2", best)]
    by_model = {}
    for model, _, target, ns, rate, ratio, _ in rows:
        by_model.setdefault(model, {})[target] = (ns, rate, ratio)
    lines = [f"Measured by `{results['command']}`: {machine.line(results['machine'])}.", "",
             f"Per hit and light, one thread; \"plain\" is {results['scalar_baseline']}"
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
    lines += ["", "Ways to do the same work: `a_over_b` is how many times faster a is, or in how "
              "many times fewer rays if its name ends in `in_rays`; in memory, each frame in that "
              "of the one before, unless it says process. Embree's spheres are traced bare, in "
              "float, their tree built before; what says in_float is the nearest sphere and its "
              "depth on both sides, the rest exact hits with points and normals on ours. What says "
              "at_port_bound is counted: the exact test alone, its vectors full and nothing waiting.",
              "", *headline_table(runs)]
    if runs[1:]:
        lines += ["", "The other columns: " + "; ".join(run["line"] for run in runs[1:]) + "."]
    return "\n".join(lines)


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
