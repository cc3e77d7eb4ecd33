# SPDX-License-Identifier: Apache-2.0
"""Reflection models over arrays: nacre's, and functions of the user's."""
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple, Union

import numpy as np

from . import _nacre
from ._arguments import numbers, text
from ._errors import Error, fault
from ._image import Array
from ._json import to_json

Function = Callable[[Array, Array, Array], Any]


# Pairs in one call of C++, which Ctrl-C does not end: a second or less.
_PIECE = 2**20


def _vectors(values: Any, name: str, columns: int = 3) -> Array:
    array = numbers(values, name)
    if array.ndim == 0 or array.shape[-1] != columns:
        raise ValueError(f"{name} has the shape {array.shape}, not (..., {columns})")
    return array


def _common_shape(*arrays: Tuple[str, Array]) -> Tuple[int, ...]:
    """That of the arrays together, without their last axis."""
    shapes = {array.shape[:-1] for _, array in arrays}
    shapes.discard(())
    if len(shapes) < 2:
        return shapes.pop() if shapes else ()
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        named = ", ".join(f"{name} {array.shape}" for name, array in arrays)
        raise ValueError(f"the shapes do not go together: {named}") from None


def _broadcast(*arrays: Tuple[str, Array]) -> Tuple[Tuple[int, ...], List[Array]]:
    """The common shape without the last axis, and copies of the arrays as planes, of shape (columns,
    count): functions may write to them."""
    shape = _common_shape(*arrays)
    planes = []
    for _, array in arrays:
        block = np.empty((array.shape[-1],) + shape)
        rows = block.T if len(shape) < 2 else np.moveaxis(block, 0, -1)
        rows[...] = array
        planes.append(block.reshape(array.shape[-1], -1) if len(shape) != 1 else block)
    return shape, planes


def _check_units(planes: Mapping[str, Array]) -> None:
    """As nacre's own models do: |v|^2 may be off by what float32 rounds to."""
    for name, plane in planes.items():
        squared = np.einsum("ij,ij->j", plane, plane)
        right = np.abs(squared - 1) <= 16 * 2.0**-24
        if not right.all():
            i = int(np.argmin(right))
            raise fault("Brdf", f"{name} {i} {tuple(plane[:, i].tolist())} has length "
                        f"{float(np.sqrt(squared[i])):.6g}, not 1",
                        "directions are unit vectors: divide them by their lengths in double")


def _rows(planes: Array, shape: Tuple[int, ...]) -> Array:
    """Planes of shape (3, count) as (..., 3)."""
    return planes.T.reshape(shape + (planes.shape[0],))


def _named(planes: List[Array]) -> Dict[str, Array]:
    return dict(zip(("normal", "to_view", "to_light"), planes))


def _hemisphere(cosine: float, fine: int = 1) -> Tuple[Array, Array, Array]:
    """A viewer at n.v = cosine about +z, and a quadrature over directions to light: (i, j, 3), and their
    weights. By circles about the mirror direction, each as far as it is above the horizon. `fine`: how
    many times as dense."""
    sine = float(np.sqrt((1 - cosine) * (1 + cosine)))
    mirror = np.array([-sine, 0, cosine])
    along, across = np.array([cosine, 0, sine]), np.array([0.0, 1, 0])
    gauss: Any = np.polynomial.legendre.leggauss
    # Of the circles' radii: panels that halve towards the mirror direction, with an edge where
    # circles begin to touch the horizon.
    touch = float(np.arctan2(cosine, sine))
    edges = np.unique([0, touch, *((np.pi - touch) * 0.5**np.arange(5 + 8 * fine))])
    nodes, weights = gauss(6 * fine)
    radius = (edges[:-1, None] + np.diff(edges)[:, None] * (nodes + 1) / 2).reshape(-1, 1)
    w_radius = (np.diff(edges)[:, None] * weights / 2).reshape(-1, 1) * np.sin(radius)
    # Whole circles by equal steps, closer where lobes of grazing viewers are narrow: these are
    # about `cosine` times as wide across the plane of incidence as along it.
    count = 96 * fine
    step = (np.arange(count) + 0.5) * (2 * np.pi / count)
    squeeze = np.clip(radius, cosine, 1)
    whole = np.arctan2(squeeze * np.sin(step), np.cos(step))
    w_whole = squeeze / (np.cos(step)**2 + (squeeze * np.sin(step))**2) * (2 * np.pi / count)
    # Arcs by Gauss's rule, closer about their middle for the same reason.
    end = np.arccos(np.clip(-cosine * np.cos(radius) / np.maximum(sine * np.sin(radius), 1e-300),
                            -1, 1))
    x, w_x = gauss(count)
    is_arc = end < np.pi
    phi = np.where(is_arc, end * (0.05 * x + 0.95 * x**3), whole)
    w_phi = np.where(is_arc, end * (0.05 + 2.85 * x**2) * w_x, w_whole)
    light = (np.cos(radius)[..., None] * mirror + (np.sin(radius) * np.cos(phi))[..., None] * along +
             (np.sin(radius) * np.sin(phi))[..., None] * across)
    light /= np.linalg.norm(light, axis=-1, keepdims=True)
    return np.array([sine, 0, cosine]), light, w_radius * w_phi


def _of_material(material: Dict[str, Any]) -> "Brdf":
    """What pickle makes of one of nacre's models."""
    parameters = dict(material)
    return Brdf(parameters.pop("model"), **parameters)


class _Own:
    """A user's function, its results checked and in the form that C++ takes."""

    def __init__(self, function: Callable[..., Any], what: str, columns: Optional[int]) -> None:
        self.function, self.what, self.columns = function, what, columns

    def __call__(self, *arrays: Array) -> Array:
        count = len(arrays[0])
        try:
            returned = self.function(*arrays)
        except (TypeError, ValueError, IndexError) as error:
            if hasattr(error, "add_note"):  # Python 3.11
                error.add_note(f"{self.what} was called with arrays of the shapes "
                               f"{', '.join(str(array.shape) for array in arrays)}: one row for each "
                               "of many points. np.vectorize(f, signature=\"(k),(k),(k)->(k)\") makes "
                               "such a function of one for single vectors.")
            raise
        try:
            result = np.asarray(returned)
        except ValueError as error:
            raise fault(self.what, f"returned no array: {error}") from None
        if result.dtype.kind not in "fiub":
            raise fault(self.what, f"returned an array of {result.dtype}, not of real numbers")
        if isinstance(returned, np.ma.MaskedArray) and np.any(returned.mask):
            raise fault(self.what, "returned an array that is masked in part",
                        "its method filled gives it values there")
        wanted = (count,) if self.columns is None else (count, self.columns)
        grey = self.columns is not None and result.shape == (count, 1)
        if result.shape != wanted and not grey:
            hint = (f"(count, {self.columns}) for arrays of shape (count, 3); grey is (count, 1): "
                    "value[:, None]") if self.columns else "(count,) for arrays of shape (count, 3)"
            raise fault(self.what, f"returned the shape {result.shape} for {count} samples", hint)
        if self.columns is None:
            return np.ascontiguousarray(result, np.float64)
        planes = np.empty((self.columns, count))
        planes[...] = result.T
        return planes


class Brdf:
    """A reflection model, for measuring: nacre's, or a function of one's own.

        gold = nacre.Brdf("conductor", preset="gold", roughness=0.2)
        gold.evaluate(normal, to_view, to_light)       # (..., 3), the BRDF times n.l

        mine = nacre.Brdf(lambda normal, to_view, to_light: ...)
        scene.add_material("mine", mine)

    Directions are arrays of shape (..., 3) that broadcast against one another, of unit length, and
    point away from the surface. Where light or viewer is not above it, nothing is reflected. Of
    nacre's models maps, emission, ambient light and the lobe of a perfect mirror (roughness below
    2^-20) are left out. scenes/README.md lists their parameters, with the papers that they are from.

    Calls raise `nacre.Error` for vectors that are not finite and unit, with the number of the first (its
    |v|^2 may be off by 1e-6, which float32 makes of it), and for what functions return that is not
    finite or of another shape; ValueError for shapes that do not broadcast; TypeError for what is no
    array of real numbers.
    """

    def __init__(self, model: Union[str, Function], *, sample: Optional[Callable[..., Any]] = None,
                 pdf: Optional[Function] = None, albedo: Any = None, **parameters: Any) -> None:
        """model: the name of one, with its parameters as in scene files; or a function

            f(normal, to_view, to_light)        three float64 arrays of shape (count, 3)

        that returns the BRDF itself, in 1/sr, of shape (count, 3), or (count, 1) for grey, of any real
        type. n.l is not part of it: nacre multiplies by it. It is only asked where light and viewer
        are above the surface. One for single vectors, f(n, v, l) of shape (3,), becomes one for
        arrays by np.vectorize(f, signature="(k),(k),(k)->(k)"), a hundred times slower than numpy.
        With a function come, optionally, both of

            sample(normal, to_view, u)          directions to light, (count, 3), of u in [0, 1)^2
            pdf(normal, to_view, to_light)      how often, per solid angle, (count,)

        in the place of the cosine law, and albedo(n_dot_v), (count, 3) of (count,).
        """
        self._native: Any = None
        self._evaluate: Optional[_Own] = None
        self._sample: Optional[_Own] = None
        self._pdf: Optional[_Own] = None
        self._albedo: Optional[Callable[[Array], Any]] = None
        self._material: Optional[Dict[str, Any]] = None  # as scenes have it
        if isinstance(model, str):
            if sample or pdf:
                raise TypeError("sample and pdf are for models that are functions")
            self.name = model
            if albedo is not None:  # a parameter of some models
                parameters["albedo"] = albedo
            members = [(text(name, "a parameter"), to_json(value, name))
                       for name, value in parameters.items()]
            self._native = _nacre.Brdf.of_model(text(model, "a model"), members)
            self._material = {"model": model, **parameters}
            return
        if not callable(model):
            raise TypeError(f"a model is a name or a function, not a {type(model).__name__}")
        if parameters:
            raise TypeError(f"a function has no parameter {next(iter(parameters))!r}: "
                            "functools.partial, or a closure, gives it some")
        if (sample is None) != (pdf is None):
            raise TypeError("a sampler needs its pdf, and a pdf its sampler")
        if albedo is not None and not callable(albedo):
            raise TypeError(f"the albedo of a function is a function, not a {type(albedo).__name__}")
        self._albedo = albedo
        self.name = getattr(model, "__name__", "function")
        self._evaluate = _Own(model, f"the BRDF {self.name}", 3)
        if sample is not None and pdf is not None:
            self._sample = _Own(sample, f"the sampler of {self.name}", 3)
            self._pdf = _Own(pdf, f"the pdf of {self.name}", None)

    @classmethod
    def from_scene(cls, scene: Any, material: str) -> "Brdf":
        """The model of a scene's material."""
        if not isinstance(getattr(scene, "_native", None), _nacre.Scene):
            raise TypeError(f"a nacre.Scene is wanted, not {type(scene).__name__}")
        brdf = cls.__new__(cls)
        brdf.name = text(material, "a material")
        brdf._evaluate = brdf._sample = brdf._pdf = brdf._albedo = brdf._material = None
        brdf._native = _nacre.Brdf.of_material(scene._native, material)
        return brdf

    # It never changes.
    def __copy__(self) -> "Brdf":
        return self

    def __deepcopy__(self, memo: Any) -> "Brdf":
        return self

    def __reduce__(self) -> Any:
        if self._evaluate is not None:
            return super().__reduce__()  # with functions that pickle finds by their names
        if self._material is None:
            raise TypeError("cannot pickle the nacre.Brdf of a scene's material: pickle the scene")
        return _of_material, (self._material,)

    @property
    def is_own(self) -> bool:
        """Whether it is a function of the user's."""
        return self._native is None

    def _functions(self) -> Tuple[Optional[_Own], Optional[_Own], Optional[_Own]]:
        return self._evaluate, self._sample, self._pdf

    def _directions(self, normal: Any, to_view: Any,
                    to_light: Any) -> Tuple[Tuple[int, ...], List[Array]]:
        return _broadcast(("normal", _vectors(normal, "normal")),
                          ("to_view", _vectors(to_view, "to_view")),
                          ("to_light", _vectors(to_light, "to_light")))

    def _in_pieces(self, function: Callable[..., Any], planes: Mapping[str, Array]) -> List[Array]:
        """What a function of C++ returns, of any number of pairs; Ctrl-C comes between its calls."""
        count = next(iter(planes.values())).shape[1]
        pieces = []
        try:
            for i in range(0, max(count, 1), _PIECE):
                piece = function(*(plane[:, i:i + _PIECE] for plane in planes.values()))
                pieces.append(piece if isinstance(piece, tuple) else (piece,))
        except Error:
            if pieces:  # it counts vectors from a piece's beginning
                _check_units({name: plane for name, plane in planes.items() if len(plane) == 3})
            raise
        return [parts[0] if len(parts) == 1 else np.concatenate(parts, axis=-1)
                for parts in zip(*pieces)]

    def _own(self, function: _Own, planes: List[Array]) -> Tuple[Array, Array]:
        """What a function returns where light and viewer are above the surface, as planes, 0
        elsewhere; and n.l."""
        n, v, l = planes
        _check_units({"normal": n, "to_view": v, "to_light": l})
        n_dot_l = np.einsum("ij,ij->j", n, l)
        above = (n_dot_l > 0) & (np.einsum("ij,ij->j", n, v) > 0)
        whole = above.all()
        rows = [plane.T if whole else plane[:, above].T for plane in planes]
        values = function(*rows)
        if not np.isfinite(values).all():
            i = int(np.argmin(np.isfinite(values).reshape(-1, values.shape[-1]).all(axis=0)))
            raise fault(function.what, f"returned {values[..., i].tolist()} for sample {i} of "
                        f"{values.shape[-1]}: normal {rows[0][i].tolist()}, to_view "
                        f"{rows[1][i].tolist()}, to_light {rows[2][i].tolist()}",
                        "results are finite wherever n.l and n.v are above 0")
        if whole:
            return values, n_dot_l
        result = np.zeros(values.shape[:-1] + above.shape)
        result[..., above] = values
        return result, n_dot_l

    def evaluate(self, normal: Any, to_view: Any, to_light: Any, *, exact: bool = True,
                 components: bool = False) -> Any:
        """The BRDF times n.l: radiance towards the viewer per irradiance of a surface that faces the
        light, an array of shape (..., 3). Unlike the BRDF itself it is finite for every model.

        exact: in double, by the formulas of the papers in their stable form; else in float32 through
            the SIMD kernels of the renderer, tens of times as fast. Of functions always in double.
        components: returns (diffuse, specular) instead of their sum.
        """
        if not exact and self._evaluate is None:
            return self._shade(normal, to_view, to_light, components)
        shape, planes = self._directions(normal, to_view, to_light)
        if self._evaluate is not None:
            values, n_dot_l = self._own(self._evaluate, planes)
            result = _rows(values * np.maximum(n_dot_l, 0), shape)
            if not components:
                return result
            nothing = np.zeros_like(result)
            return (nothing, result) if self._sample else (result, nothing)
        diffuse, specular = self._in_pieces(self._native.evaluate, _named(planes))
        if components:
            return _rows(diffuse, shape), _rows(specular, shape)
        return _rows(diffuse + specular, shape)

    def _shade(self, normal: Any, to_view: Any, to_light: Any, components: bool) -> Any:
        named = (("normal", _vectors(normal, "normal")), ("to_view", _vectors(to_view, "to_view")),
                 ("to_light", _vectors(to_light, "to_light")))
        shape = _common_shape(*named)
        rows = [np.broadcast_to(array, shape + (3,)).reshape(-1, 3) for _, array in named]
        try:
            found = self._native.shade(*rows, components)
        except Error:  # which counts vectors from a piece's beginning
            _check_units({name: array.T.astype(np.float64) for (name, _), array in zip(named, rows)})
            raise
        if components:
            return tuple(part.reshape(shape + (3,)) for part in found)
        return found.reshape(shape + (3,))

    def sample(self, normal: Any, to_view: Any, u: Any) -> Array:
        """Unit directions to light, (..., 3), by points u of shape (..., 2) in [0, 1)^2, chosen about
        as often as light is reflected from there. Those below the surface are light that is lost."""
        shape, (n, v, points) = _broadcast(("normal", _vectors(normal, "normal")),
                                           ("to_view", _vectors(to_view, "to_view")),
                                           ("u", _vectors(u, "u", 2)))
        _check_units({"normal": n, "to_view": v})
        right = ((points >= 0) & (points < 1)).all(axis=0)
        if not right.all():
            i = int(np.argmin(right))
            raise fault("Brdf.sample", f"point {i} is {tuple(points[:, i].tolist())}",
                        "points lie in [0, 1)^2")
        if self._evaluate is None:
            sampled, = self._in_pieces(self._native.sample, {"normal": n, "to_view": v, "u": points})
            return _rows(sampled, shape)
        if self._sample is not None:
            directions = self._sample(n.T, v.T, points.T)
            _check_units({"a sampled direction": directions})
            return _rows(directions, shape)
        lambert = _nacre.Brdf.of_model("lambert", [])
        return _rows(lambert.sample(n, v, points), shape)

    def pdf(self, normal: Any, to_view: Any, to_light: Any) -> Array:
        """How often `sample` chooses directions, per solid angle: an array of shape (...)."""
        shape, planes = self._directions(normal, to_view, to_light)
        if self._evaluate is None:
            return self._in_pieces(self._native.pdf, _named(planes))[0].reshape(shape)
        if self._pdf is None:
            return _nacre.Brdf.of_model("lambert", []).pdf(*planes).reshape(shape)
        return self._own(self._pdf, planes)[0].reshape(shape)

    def albedo(self, n_dot_v: Any) -> Array:
        """The directional albedo: what is seen at n.v, an array of cosines in (0, 1], of light of
        radiance 1 from everywhere, of shape (..., 3). By quadrature; of functions to about 3e-4, if
        they are isotropic, without edges, and their lobes no narrower than GGX's at roughness 0.05."""
        cosines = numbers(n_dot_v, "n_dot_v").astype(np.float64, copy=False)
        flat = cosines.reshape(-1)
        if not ((flat > 0) & (flat <= 1)).all():
            raise fault("Brdf.albedo", "n.v is not above 0 and up to 1")
        if self._evaluate is None:
            pieces = [self._native.albedo(flat[i:i + 256].tolist())
                      for i in range(0, max(len(flat), 1), 256)]
            return _rows(np.concatenate(pieces, axis=-1), cosines.shape)
        if self._albedo is not None:
            values = _Own(self._albedo, f"the albedo of {self.name}", 3)(flat)
            if not np.isfinite(values).all():
                i = int(np.argmin(np.isfinite(values).all(axis=0)))
                raise fault(f"the albedo of {self.name}", f"returned {values[:, i].tolist()} for n.v = "
                            f"{flat[i]:g}")
            return _rows(values, cosines.shape)
        result = np.array([self._integrate(float(cosine)) for cosine in flat]).reshape(-1, 3)
        return result.reshape(cosines.shape + (3,))

    def _integrate(self, cosine: float) -> Array:
        """int f n.l dl over the hemisphere."""
        view, light, weights = _hemisphere(cosine)
        albedo: Array = np.einsum("ijk,ij->k", self.evaluate([0.0, 0, 1], view, light), weights)
        return albedo

    def terms(self, normal: Any, to_view: Any, to_light: Any) -> Dict[str, Array]:
        """The terms of a microfacet lobe by name: "D", "G", "lambda_view" and "lambda_light" of shape
        (...), "F" of shape (..., 3). The lobe is D G F / (4 n.l n.v), without compensation; lambda is
        Smith's. Below the surface all are 0."""
        if self._evaluate is not None:
            raise fault("Brdf.terms", "a function has no terms", "nacre's microfacet models have")
        shape, planes = self._directions(normal, to_view, to_light)
        d, g, f, lambda_view, lambda_light = self._in_pieces(self._native.terms, _named(planes))
        return {"D": d.reshape(shape), "G": g.reshape(shape), "F": _rows(f, shape),
                "lambda_view": lambda_view.reshape(shape),
                "lambda_light": lambda_light.reshape(shape)}

    def __repr__(self) -> str:
        return f"<nacre.Brdf {self.name}>"
