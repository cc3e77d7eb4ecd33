# SPDX-License-Identifier: Apache-2.0
"""The results as text tables; readme.py has their short form."""
import estimates
import machine

_ORDER = ("scalar_baseline", "scalar", "sse4", "avx2", "avx3")
_CLIFF = 1.3  # the exponent of a step that is no longer near linear growth
_STAGES = ("sample", "intersect", "surfaces", "light", "shadow", "shade", "film", "output")


def table(header, rows):
    """Columns as wide as their widest cell, the first one flush left."""
    cells = [list(map(str, row)) for row in (header, *rows)]
    widths = [max(len(row[i]) for row in cells) for i in range(len(header))]
    return "\n".join(
        "  ".join([row[0].ljust(widths[0])] + [c.rjust(w) for c, w in zip(row[1:], widths[1:])])
        for row in cells)


def _spread(values):
    """Half of what the middle half of the values covers, in per cent of the median."""
    ordered = sorted(values)
    quarter = len(ordered) // 4
    middle = estimates.median(ordered)
    return 50 * (ordered[-1 - quarter] - ordered[quarter]) / middle


def _hits_of(result):
    """How many hits one iteration shades: Google Benchmark knows items and seconds."""
    rate = result["counters"].get("items_per_second")
    return rate * estimates.median(result["ns"]) * 1e-9 if rate else None


def kernel_rows(benchmarks):
    """[model, access mode, target, ns a hit and light, hits/s, ratio to scalar, spread]."""
    found = []
    for name, result in benchmarks.items():
        parts = name.split("/")
        if parts[0] == "shade" and len(parts) == 3:
            found.append((parts[1], "cached", parts[2], result))
        elif parts[0] == "access" and len(parts) == 4:
            found.append((parts[1], parts[2].replace("_", " "), parts[3], result))
    scalar = {model: estimates.median(result["ns"]) / _hits_of(result)
              for model, _, target, result in found if target == "scalar_baseline"}
    # The same model in a form that has no baseline of its own.
    for model, other in (("ggx_plain_schlick_direct", "ggx_schlick_direct"),
                         ("ggx_plain_height_correlated", "ggx_height_correlated"),
                         ("ggx_default", "ggx_height_correlated"),
                         ("ggx_default", "ggx_plain_height_correlated")):
        if model not in scalar and other in scalar:
            scalar[model] = scalar[other]
    rows = []
    for model, mode, target, result in found:
        hits = _hits_of(result)
        if not hits:
            continue
        ns = estimates.median(result["ns"]) / hits
        rows.append((model, mode, target, ns, 1e9 / ns,
                     scalar[model] / ns if model in scalar else None, _spread(result["ns"])))
    order = {target: i for i, target in enumerate(_ORDER)}
    return sorted(rows, key=lambda row: (row[0], row[1] != "cached", row[1],
                                         order.get(row[2], 9)))


def share_of_bound(results, model, target, ns):
    """How much of what the processor's ports allow a kernel reaches, as text."""
    bound = results.get("port_bounds", {}).get(f"shade/{model}/{target}")
    return f"{100 * bound / ns:.0f} %" if bound else ""


def ratio_at_bound(results, model, target, ns, ratio):
    """How many times as fast as plain C++ the kernel would be if nothing but ports held it up."""
    bound = results.get("port_bounds", {}).get(f"shade/{model}/{target}")
    return f"{ratio * ns / bound:.1f}" if bound and ratio else ""


def ports(results):
    """Which processor's ports those are."""
    name = results.get("port_model")
    return (f"of port bound: what {name} counts for the busiest port, nothing waiting" if name
            else None)


def _kernels(results):
    rows = [(model, mode, target, f"{ns:.2f}", f"{rate / 1e6:.0f}",
             f"{ratio:.1f}" if ratio else "",
             share_of_bound(results, model, target, ns) if mode == "cached" else "",
             ratio_at_bound(results, model, target, ns, ratio) if mode == "cached" else "",
             f"{spread:.0f} %")
            for model, mode, target, ns, rate, ratio, spread in kernel_rows(results["benchmarks"])]
    return table(("kernel", "hits", "target", "ns", "M/s", "x scalar", "of port bound", "x at it",
                  "+-"), rows)


def _plain(benchmarks, prefix, unit, scale):
    rows = [(name[len(prefix):], f"{scale * estimates.median(r['ns']):.3g}",
             f"{_spread(r['ns']):.0f} %")
            for name, r in benchmarks.items() if name.startswith(prefix)]
    return table((prefix.strip("/"), unit, "+-"), rows) if rows else None


def _float_visibility(benchmarks):
    rows = [(name.split("/")[-1], f"{c['hits']:.0f}", f"{c['wrong_pixels']:.0f}",
             f"{c['depth_error']:.1e}")
            for name, result in benchmarks.items() if name.startswith("visibility/float_tiles/")
            for c in (result["counters"],)]
    return table(("tiles in float", "hits", "of another sphere or none",
                  "largest error of a depth, radii"), rows) if rows else None


def stages_of(result):
    """{stage: ms} of a frame in the order of the work, and "rest", what no stage claims: planning,
    mostly. By the wall's clock, as the stages are."""
    counters = result["counters"]
    stages = {stage: counters[f"ms_{stage}"] for stage in _STAGES if f"ms_{stage}" in counters}
    stages |= {key[3:]: value for key, value in counters.items()
               if key.startswith("ms_") and key[3:] not in stages}
    stages["rest"] = max(0.0, 1e-6 * estimates.median(result["wall_ns"]) - sum(stages.values()))
    return stages


def _frames(benchmarks):
    frames = {name[6:]: r for name, r in benchmarks.items()
              if name.startswith("frame/") and "1920x1080" in name}
    if not frames:
        return None
    names = list(stages_of(next(iter(frames.values()))))
    rows = [(name, f"{1e-6 * estimates.median(r['ns']):.2f}",
             *(f"{stages_of(r).get(stage, 0):.2f}" for stage in names))
            for name, r in frames.items()]
    return table(("frame in memory", "ms", *names), rows)


def _processes(processes):
    rows = []
    for name, found in processes.items():
        low, high = estimates.median_interval(found["seconds"])
        rows.append((name, f"{1e3 * estimates.median(found['seconds']):.1f}",
                     f"{1e3 * low:.1f}", f"{1e3 * high:.1f}",
                     f"{1e3 * estimates.median(found['cpu']):.1f}",
                     f"{estimates.median(found['mib']):.0f}"))
    return table(("process, from spawn to exit", "ms", "95 % from", "to", "cpu ms", "MiB"), rows)


def _scaling(curves):
    parts = []
    for name, curve in curves.items():
        rows = [(f"{p['size']:,}", f"{1e3 * p['frame_s']:.2f}", f"{1e3 * p['process_s']:.1f}",
                 f"{p['mib']:.0f}") for p in curve["points"]]
        fit = curve["fits"]
        growth = "; ".join(
            f"{label} ~ n^{fit[key]['exponent']:.2f} in the last decade, steepest step n^{fit[key]['steepest']:.2f} "
            f"from {fit[key]['from']:,} to {fit[key]['to']:,}"
            f"{', a CLIFF' if fit[key]['steepest'] > _CLIFF else ''}"
            for label, key in (("frame", "frame_s"), ("memory", "mib")))
        parts.append(table((name, "frame ms", "process ms", "MiB"), rows) + "\n  " + growth)
    return "\n\n".join(parts)


def _precision(precision):
    parts = []
    for title, series in (("frame in memory, one thread", precision["frame"]),
                          ("process", precision["process"])):
        rows = [(label, str(p.get("what", p.get("spp"))), f"{1e3 * p['seconds']:.2f}",
                 f"{p['rmse']:.2e}", f"{p['rel_mse'] ** 0.5:.2e}")
                for label, points in series.items() for p in points]
        parts.append(table((f"error, {title}", "samples", "ms", "RMSE", "relative"), rows))
    return "\n\n".join(parts)


def _lights(series):
    rows = [(f"under a {name}", p["what"], f"{1e3 * p['seconds']:.1f}", f"{100 * p['error']:.2f} %")
            for name, light in series.items() for points in light["curves"].values()
            for p in points]
    rows += [(f"under a {name}", "the truth itself", "", f"{100 * light['truth_error']:.2f} %")
             for name, light in series.items()]
    return table(("error, one thread", "samples", "ms", "relative RMSE"), rows)


def text(results):
    """All tables."""
    benchmarks = results["benchmarks"]
    math = _plain({name: r for name, r in benchmarks.items()}, "math/", "us per 512 hits", 1e-3)
    parts = [machine.line(results["machine"]),
             f"x scalar: times as fast as {results['scalar_baseline']}", ports(results),
             _kernels(results), _plain(benchmarks, "visibility/", "ms", 1e-6),
             _float_visibility(benchmarks), _plain(benchmarks, "nested/", "ms", 1e-6),
             _frames(benchmarks), math, _processes(results["processes"]),
             _scaling(results.get("scaling", {})) or None,
             _precision(results["precision"]) if "precision" in results else None,
             _lights(results["lights"]) if "lights" in results else None]
    return "\n\n".join(part for part in parts if part) + "\n"
