# SPDX-License-Identifier: Apache-2.0
"""Tables of BRDFs: their values over pairs of directions, and what is wrong with those of others."""
import dataclasses
import json
import os
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _nacre
from ._arguments import PathLike, numbers, path, real, text
from ._brdf import Brdf, Function
from ._image import Array

_AXES, _CHANNELS = ("x", "y", "z"), ("r", "g", "b")
_UP = (0.0, 0.0, 1.0)


class Table:
    """Numbers with named columns, row by row.

        table = nacre.table("open_pbr", specular_roughness=0.2)
        table["light"], table["view"]      # (rows, 3), unit vectors about the normal +z
        table["f"]                         # (rows, 3), the BRDF in 1/sr, without n.l
        table["diffuse"], table["specular"], table["coat"]     # what each lobe contributes
        table["pdf"], table["albedo"]
        table.write("nacre.csv")           # or .json, .npy

    header: what the numbers depend on: versions, every parameter and every option of the material.
    columns: the names, "light_x", ..., "f_r", ...
    values: of shape (rows, columns), float64.
    """

    def __init__(self, columns: Sequence[str], values: Any,
                 header: Optional[Mapping[str, Any]] = None) -> None:
        self.columns: Tuple[str, ...] = tuple(text(name, "a column") for name in columns)
        self.values: Array = np.array(numbers(values, "values"), np.float64, ndmin=2)
        self.header: Dict[str, Any] = dict(header or {})
        if self.values.ndim != 2 or self.values.shape[1] != len(self.columns):
            raise ValueError(f"values has the shape {self.values.shape}, for {len(self.columns)} columns")

    @classmethod
    def _of(cls, native: Tuple[str, List[str], Array]) -> "Table":
        header, columns, values = native
        table = cls.__new__(cls)
        table.columns, table.values = tuple(columns), values
        table.header = json.loads(header) if header else {}
        return table

    def _native(self) -> Tuple[str, List[str], Array]:
        return json.dumps(self.header), list(self.columns), self.values

    def __len__(self) -> int:
        return len(self.values)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and (name in self.columns or self._group(name) is not None)

    def _group(self, name: str) -> Optional[List[int]]:
        for suffixes in (_CHANNELS, _AXES):
            wanted = [f"{name}_{suffix}" for suffix in suffixes]
            if all(column in self.columns for column in wanted):
                return [self.columns.index(column) for column in wanted]
        return None

    def __getitem__(self, name: str) -> Array:
        """A column, or the three columns of a vector or a colour, as a view or a copy."""
        if name in self.columns:
            return self.values[:, self.columns.index(name)]
        group = self._group(name)
        if group is None:
            raise KeyError(f"{name!r}: the columns are {', '.join(self.columns)}")
        if group == list(range(group[0], group[0] + 3)):
            return self.values[:, group[0]:group[0] + 3]
        return self.values[:, group]

    @property
    def array(self) -> Array:
        """All rows as one axis with named columns, a copy."""
        result = np.empty(len(self.values), [(name, "<f8") for name in self.columns])
        for i, name in enumerate(self.columns):
            result[name] = self.values[:, i]
        return result

    def write(self, file: PathLike) -> None:
        """Writes a .csv, .json or .npy file; of .npy, numpy.load reads the named columns, and the
        header is in FILE.npy.json."""
        _nacre.write_table(*self._native(), path(file))

    def __repr__(self) -> str:
        return f"<nacre.Table of {len(self)} rows: {', '.join(self.columns)}>"


@dataclasses.dataclass(repr=False, eq=False)
class TableCheck:
    """What `check_table` has found. True where all values are finite and within the tolerance;
    str(check) is its page.

    numbers: the same as dictionaries and lists: "f" with "rms", "largest", ...; "explanation", the
        mistakes that explain the errors together; "mistakes" and "choices", the nearest ones, with
        the error that each leaves; "fit", the factors of nacre's lobes that come nearest.
    """

    ok: bool
    page: str
    numbers: Dict[str, Any]

    @property
    def explanation(self) -> List[str]:
        """The mistakes that explain the errors together; empty if none does."""
        return list(self.numbers["explanation"])

    def __bool__(self) -> bool:
        return self.ok

    def __str__(self) -> str:
        return self.page

    def __repr__(self) -> str:
        found = "ok" if self.ok else "; ".join(self.explanation) or "differs"
        return f"<nacre.TableCheck of {self.numbers['file']}: {found}>"


def read_table(file: PathLike) -> Table:
    """Reads a .csv, .json or .npy file of any program. Columns keep their names."""
    return Table._of(_nacre.read_table(path(file)))


def _angles(values: Any, name: str, otherwise: Sequence[float]) -> List[float]:
    if values is None:
        return list(otherwise)
    return [float(v) for v in np.atleast_1d(numbers(values, name)).reshape(-1)]


# The grid, unless angles are given: that of `nacre table`.
_THETA = (0, 15, 30, 45, 60, 75, 85, 89)
_PHI = (0, 45, 90, 135, 165, 175, 180)


def _as_table(given: Any, name: str) -> Table:
    """A table of what users have: arrays by name, or an array with named columns."""
    if isinstance(given, Table):
        return given
    if isinstance(given, np.ndarray) and given.dtype.names:
        given = {field: given[field] for field in given.dtype.names}
    if isinstance(given, Mapping):
        columns: List[str] = []
        parts: List[Array] = []
        for key, values in given.items():
            array = numbers(values, f"{name}[{key!r}]")
            if array.ndim not in (1, 2):
                raise ValueError(f"{name}[{key!r}] has the shape {array.shape}, not (rows,) or (rows, 3)")
            if array.ndim == 1 or array.shape[1] == 1:
                columns.append(str(key))
            else:
                columns += [f"{key}_{i}" for i in range(array.shape[1])]
            parts.append(array.reshape(len(array), -1))
        if len({len(part) for part in parts}) != 1:
            raise ValueError(f"{name} has arrays of {sorted({len(part) for part in parts})} rows")
        return Table(columns, np.concatenate(parts, axis=1))
    raise TypeError(f"{name} is a nacre.Table, arrays by name, or an array with named columns, not "
                    f"{type(given).__name__}")


def _directions(given: Any, theta_light: Any, theta_view: Any, phi: Any, phi_view: float) -> Table:
    if given is None:
        return Table._of(_nacre.table_directions(
            _angles(theta_light, "theta_light", _THETA), _angles(theta_view, "theta_view", _THETA),
            _angles(phi, "phi", _PHI), real(phi_view, "phi_view")))
    if not (theta_light is None and theta_view is None and phi is None):
        raise TypeError("angles are those of a grid: directions have their own")
    if isinstance(given, tuple) and len(given) == 2:
        light, view = np.broadcast_arrays(*(np.atleast_2d(numbers(part, name)) for part, name in
                                            zip(given, ("to_light", "to_view"))))
        if light.ndim != 2 or light.shape[1] != 3:
            raise ValueError(f"directions have the shape {light.shape}, not (rows, 3)")
        return Table([f"{name}_{axis}" for name in ("light", "view") for axis in _AXES],
                     np.concatenate([light, view], axis=1))
    return _as_table(given, "directions")


def _model(model: Any, parameters: Dict[str, Any]) -> Brdf:
    if isinstance(model, Brdf):
        if parameters:
            raise TypeError("parameters are those of a model that is named")
        return model
    return Brdf(model, **parameters)


def _of_function(brdf: Brdf, directions: Table) -> Table:
    """The table of a user's function: f, and pdf where it has a sampler."""
    light, view = directions["light"], directions["view"]
    n_dot_l = light[:, 2:]
    f = np.divide(brdf.evaluate(_UP, view, light), n_dot_l, out=np.zeros_like(light),
                  where=n_dot_l > 0)
    columns = [*(f"{name}_{axis}" for name in ("light", "view") for axis in _AXES),
               *(f"f_{channel}" for channel in _CHANNELS)]
    parts = [light, view, f]
    if brdf._sample is not None:
        columns.append("pdf")
        parts.append(brdf.pdf(_UP, view, light)[:, None])
    return Table(columns, np.concatenate(parts, axis=1),
                 {"nacre_table": 1, "nacre": _nacre.version(),
                  "material": {"model": "function", "name": brdf.name}})


def table(model: Union[str, Function, Brdf], directions: Any = None, *, theta_light: Any = None,
          theta_view: Any = None, phi: Any = None, phi_view: float = 30.0, albedo: bool = True,
          **parameters: Any) -> Table:
    """The values of a BRDF over pairs of directions, about the normal +z with the tangent +x.

    model: the name of one of nacre's models with its parameters, a `Brdf`, or a function as of
        `Brdf`, of which there are f and, with a sampler, pdf alone.
    directions: a pair of arrays (to_light, to_view) of shape (rows, 3), a Table or arrays by name;
        None: a grid of all pairs of
    theta_light, theta_view: angles from the normal in degrees,
    phi: azimuths of the light, counted from the view, and
    phi_view: the azimuth of the view, counted from the tangent.
    albedo: whether to integrate the directional albedo at each view, which takes longest.
    """
    brdf = _model(model, parameters)
    pairs = _directions(directions, theta_light, theta_view, phi, phi_view)
    if brdf.is_own:
        return _of_function(brdf, pairs)
    _, columns, values = pairs._native()
    return Table._of(brdf._native.tabulate(columns, values, bool(albedo)))


def check_table(theirs: Any, against: Union[str, Brdf], *, tolerance: float = 1e-3,
                quiet: bool = False, name: Optional[str] = None, **parameters: Any) -> TableCheck:
    """Compares the table of another program with nacre's values, prints one page, and returns what
    it found.

        nacre.check_table("theirs.csv", "open_pbr", specular_roughness=0.2)
        nacre.check_table({"light": l, "view": v, "f": f}, "open_pbr", specular_roughness=0.2)
        nacre.check_table(my_function, "open_pbr", specular_roughness=0.2)

    theirs: a file (.csv, .json, .npy), a Table, arrays by name ("light", "view", "f", and if there
        are such "pdf", "albedo" and the lobes), or a function as of `Brdf`, which is evaluated over
        the grid of `table`.
    against: the name of a model with its parameters, or one of nacre's as a `Brdf`.
    tolerance: the largest difference that is right, relative to the larger of both values.
    quiet: prints nothing.

    The page tells where they differ and by how much, by angle and by lobe; which mistake explains
    that, each tried by evaluating the model with it; and which options and rules come nearest.
    """
    brdf = _model(against, parameters)
    if brdf.is_own:
        raise TypeError("against is one of nacre's models: nacre.check compares two functions")
    if not real(tolerance, "tolerance") >= 0:
        raise ValueError(f"tolerance is not below 0, and is {tolerance}")
    if isinstance(theirs, (str, bytes, os.PathLike)):
        name = name or os.fsdecode(theirs)
        theirs = read_table(theirs)
    elif callable(theirs) or isinstance(theirs, Brdf):
        own = theirs if isinstance(theirs, Brdf) else Brdf(theirs)
        name = name or own.name
        theirs = table(own, albedo=False)
    found = brdf._native.check_table(*_as_table(theirs, "theirs")._native(), float(tolerance),
                                     text(name or "table", "name"))
    check = TableCheck(found[0], found[1], json.loads(found[2]))
    if not quiet:
        print(check, end="")
    return check
