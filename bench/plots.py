# SPDX-License-Identifier: Apache-2.0
"""Draws with gnuplot: the same commands for SVG and PNG."""
import os
import shutil
import subprocess

from processes import Failed

# Okabe and Ito 2008: told apart with any kind of colour vision. Black last but one; no yellow,
# which is pale on white.
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000", "#999999")
# For areas, which stand beside each other and may be paler: Okabe and Ito's eight.
FILLS = ("#56B4E9", "#0072B2", "#009E73", "#F0E442", "#000000", "#E69F00", "#CC79A7", "#D55E00",
         "#999999")
POINTS = (7, 5, 9, 11, 13, 6, 4, 8)  # gnuplot's point types, so that no line needs its colour
FONT = "DejaVu Sans,19"

_COMMON = """
set encoding utf8
set border 3 lw 1.5 lc rgb "#555555"
set tics nomirror out scale 0.6 textcolor rgb "#222222"
set grid lw 1 lc rgb "#dddddd"
set format x "%h"
set format y "%h"
set key textcolor rgb "#222222" samplen 2 spacing 1.15
"""


def quote(text):
    """A string for gnuplot, in single quotes, where nothing but the quote itself is special."""
    return "'" + str(text).replace("'", "''") + "'"


def block(name, rows):
    """A data block; None becomes a missing value."""
    lines = [" ".join("NaN" if value is None else f"{value:.9g}" for value in row) for row in rows]
    return f"${name} << EOD\n" + "\n".join(lines) + "\nEOD\n"


def style(index, width=3, size=1.3):
    """Line and points of a series."""
    i = index % len(COLORS)
    return f"lc rgb {quote(COLORS[i])} pt {POINTS[i]} lw {width} ps {size}"


def curves(series, options, prefix="c"):
    """One panel: [(label, [(x, y)...])...] as lines with points. `options` are gnuplot commands."""
    commands, plots = [], []
    for i, (label, points) in enumerate(series):
        commands.append(block(f"{prefix}{i}", points))
        plots.append(f"${prefix}{i} using 1:2 with linespoints {style(i)} title {quote(label)}")
    return "".join(commands) + options + "\nplot " + ", ".join(plots) + "\n"


def draw(path, commands, width=1280, height=800):
    """Writes path.svg and path.png."""
    # Not one that happens to lie in the working folder; nor (-d) settings of whoever runs this.
    folders = [folder for folder in os.environ.get("PATH", "").split(":") if os.path.isabs(folder)]
    gnuplot = shutil.which("gnuplot", path=":".join(folders))
    if gnuplot is None:
        raise Failed("gnuplot is missing: scripts/setup installs it")
    size = f"size {width},{height}"
    terminals = (("svg", f"set terminal svg {size} font {quote(FONT)} background rgb 'white'"),
                 ("png", f"set terminal pngcairo {size} font {quote(FONT)} background rgb 'white'"))
    for suffix, terminal in terminals:
        script = f"{terminal}\nset output {quote(path.with_suffix('.' + suffix))}\n"
        result = subprocess.run([gnuplot, "-d"], input=script + _COMMON + commands, text=True,
                                capture_output=True, check=False)
        if result.returncode != 0:
            raise Failed(f"gnuplot: {path.name}: {result.stderr.strip()[-500:]}")
