# SPDX-License-Identifier: Apache-2.0
"""nacre renders, measures and compares reflection models on spheres and meshes.

    import nacre

    scene = nacre.Scene.from_file("scenes/first_scene.json")
    scene["/materials/red/roughness"] = 0.2
    image = scene.render(width=640, height=360, layers="all")
    image["beauty"]                    # float32 of shape (360, 640, 3), a view
    image.write("red.exr")

What there is:

    Scene, Session      what is rendered, once or again and again
    Brdf                a reflection model over arrays, nacre's or a function of your own
    check               is a BRDF right? one page of verdicts, errors and curves
    table, check_table  a BRDF's values over directions, and what is wrong with those of others
    grid                spheres over one or two parameters of a model
    Image, Picture      channels as numpy arrays, files, tone mapping
    read                an image file
    compare, heat_map   metrics between images, and where they differ
    show, side_by_side, difference      pictures in notebooks
    Error               what is raised, with `.faults`

Conventions are those of scene files (scenes/README.md): right-handed, +y up, linear Rec. 709 colours,
angles in degrees, unit directions that point away from the surface, BRDFs with their 1/pi. Arrays may
have any numeric type and strides; they are converted to float64 where directions are meant, and to
float32 in images. `nacre.Error` says what of a scene or file is wrong; TypeError and ValueError say
that an argument is of the wrong type or shape.
"""
import atexit as _atexit
import os as _os
from typing import List

from . import _missing
try:
    from . import _nacre
except ImportError as _error:
    raise ImportError(_missing.native(_error), name="nacre._nacre") from None
if not _nacre.is_main_interpreter():
    raise ImportError("nacre works in Python's main interpreter alone", name="nacre")
try:
    import numpy as _numpy
except ModuleNotFoundError as _error:
    if _error.name != "numpy":
        raise
    raise ImportError(_missing.numpy(), name="numpy") from None

from ._arguments import text as _text
from ._brdf import Brdf
from ._check import Check, Verdict, check
from ._errors import Cancelled, Error, Fault
from ._image import (Comparison, Image, LayerMetrics, Picture, Window, compare, difference, heat_map,
                     read, show, side_by_side)
from ._scene import Scene, Session, grid, render
from ._table import Table, TableCheck, check_table, read_table, table

__version__: str = _nacre.version()

_atexit.register(_nacre.stop_all)
_os.register_at_fork(after_in_child=_nacre.after_fork)


def supported_targets() -> List[str]:
    """The SIMD targets that this machine can run, slowest first."""
    return _nacre.supported_targets()


def active_target() -> str:
    """The one that is used: the fastest, unless `set_target` chose another."""
    return _nacre.active_target()


def set_target(target: str) -> None:
    """Chooses a SIMD target for the whole process, before anything runs. Pictures differ in their
    last digits."""
    _nacre.set_target(_text(target, "a target"))


def scene_schema() -> str:
    """The JSON Schema of scene files: every name that parameters may have."""
    return _nacre.scene_schema()


__all__ = [
    "Brdf", "Cancelled", "Check", "Comparison", "Error", "Fault", "Image", "LayerMetrics", "Picture",
    "Scene", "Session", "Table", "TableCheck", "Verdict", "Window", "active_target", "check", "check_table",
    "compare", "difference", "grid", "heat_map", "read", "read_table", "render", "scene_schema", "set_target",
    "show", "side_by_side", "supported_targets", "table"]
