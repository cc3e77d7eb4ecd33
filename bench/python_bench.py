# SPDX-License-Identifier: Apache-2.0
"""What Python adds: to a function that is rendered, and to a call of the library. Prints JSON, rows of
bench/waiting.py, or with --text a line for each.

    python3 bench/python_bench.py build build/bench/waiting_bench ROUNDS [--text]
"""
import json
import pathlib
import subprocess
import sys
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests/python"))
from models import ggx  # noqa: E402 pylint: disable=wrong-import-position

PAIRS = 100_000


def seconds(work):
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def rendered_function(nacre, rounds):
    """25 balls of 25 functions, and the functions alone with the arrays that the render gives them."""
    calls = []

    def scene(keep):
        def material(roughness, column):
            del column
            function = ggx(roughness**2)
            if not keep:
                return function

            def kept(*arrays):
                calls.append((function, arrays))
                return function(*arrays)
            return kept
        return nacre.grid(material, roughness=np.linspace(0.1, 0.9, 5), column=range(5))

    size = {"width": 1920, "height": 1080, "samples": 1}
    scene(True).render(**size)

    def alone():
        for function, arrays in calls:
            function(*arrays)
    whole = scene(False)
    times = [(seconds(lambda: whole.render(**size)), seconds(alone)) for _ in range(rounds)]
    return {"seconds": [pair[0] for pair in times], "against": [pair[1] for pair in times],
            "what": "the function alone, on the same arrays"}


def evaluated_model(nacre, tool, rounds):
    rng = np.random.default_rng(1)
    directions = rng.normal(size=(2, PAIRS, 3))
    directions[:, :, 2] = np.abs(directions[:, :, 2])
    view, light = directions / np.linalg.norm(directions, axis=2, keepdims=True)
    normal = np.tile([0.0, 0, 1], (PAIRS, 1))
    gold = nacre.Brdf("conductor", preset="gold", roughness=0.2)
    times, other = [], []
    for _ in range(rounds):  # in turns
        times += [seconds(lambda: gold.evaluate(normal, view, light, exact=False)) for _ in range(7)]
        other += json.loads(subprocess.run([tool, "brdf", str(PAIRS), "7"], check=True,
                                           capture_output=True).stdout)["seconds"]
    return {"seconds": times, "against": other, "what": "the call in C++"}


def main(build, tool, rounds, *text):
    sys.path.insert(0, str(pathlib.Path(build).resolve() / "python"))
    import nacre  # pylint: disable=import-outside-toplevel
    rows = {"Python: a numpy GGX, 25 balls, 1080p": rendered_function(nacre, int(rounds)),
            "Python: a model at 100 000 pairs, float": evaluated_model(nacre, tool, int(rounds))}
    if not text:
        print(json.dumps(rows))
        return
    for name, row in rows.items():
        mine, other = (float(np.median(row[key])) for key in ("seconds", "against"))
        print(f"{name}: {1e3 * mine:.2f} ms, {mine / other:.2f} times {row['what']}")


if __name__ == "__main__":
    main(*sys.argv[1:])
