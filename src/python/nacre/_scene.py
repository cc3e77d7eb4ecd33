# SPDX-License-Identifier: Apache-2.0
"""Scenes, sessions, and renders of them."""
import contextlib
import functools
import inspect
import json
import operator
import sys
from typing import (Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, TypeVar,
                    Union, cast)

import numpy as np

from . import _nacre
from ._arguments import PathLike, numbers, path as _path, real, text, whole
from ._brdf import Brdf, Function
from ._errors import Error
from ._image import Array, Image
from ._json import to_json

Progress = Union[bool, Callable[[float], object], None]
Point = Union[Sequence[float], Array]


@contextlib.contextmanager
def _report(progress: Progress) -> Iterator[Optional[Callable[[float], object]]]:
    """What to call with the share done."""
    if progress is None or progress is False:
        yield None
    elif callable(progress):
        yield progress
    elif progress is not True:
        raise TypeError(f"progress is a function, True or False, not {progress!r}")
    else:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            yield lambda share: sys.stderr.write(
                f"\rrender: {100 * share:3.0f} %" + ("\n" if share >= 1 else ""))
            return
        with tqdm(total=100, unit="%", bar_format="{l_bar}{bar}| {elapsed}<{remaining}") as bar:
            yield lambda share: bar.update(100 * share - bar.n)


def _doubles(values: Any, name: str) -> Array:
    """Not a copy where they are doubles."""
    return numbers(values, name).astype(np.float64, copy=False)


def _count(value: Optional[int], name: str) -> int:
    """As C++ has it, where 0 is what None is here."""
    if value is None:
        return 0
    if whole(value, name) == 0:
        raise ValueError(f"{name} is 0; None is the default")
    return whole(value, name)


def _settings(width: Optional[int], height: Optional[int], samples: Optional[int],
              max_error: Optional[float], seed: Optional[int], region: Optional[Sequence[int]],
              layers: Union[str, Sequence[str]], threads: Optional[int],
              intersector: str, others: Sequence[Tuple[str, str]]) -> Dict[str, Any]:
    window = (0, 0, 0, 0) if region is None else tuple(whole(x, "region") for x in region)
    if len(window) != 4:
        raise ValueError(f"region is (x0, y0, x1, y1), not {region!r}")
    if seed is not None:
        try:
            seed = operator.index(seed)
        except TypeError:
            raise TypeError(f"seed is a whole number, not {seed!r}") from None
        if not 0 <= seed < 2**32:
            raise ValueError(f"seed is out of range: {seed}")
    if max_error is not None and real(max_error, "max_error") == 0:
        raise ValueError("max_error is 0, which takes for ever; None is a fixed number of samples")
    return {"width": _count(width, "width"), "height": _count(height, "height"),
            "samples": _count(samples, "samples"),
            "max_error": 0.0 if max_error is None else real(max_error, "max_error"), "seed": seed,
            "region": window, "layers": [text(layer, "a layer") for layer in
                                         ([layers] if isinstance(layers, str) else layers)],
            "threads": whole(0 if threads is None else threads, "threads"),
            "intersector": text(intersector, "intersector"), "others": others}


_Render = TypeVar("_Render", bound=Callable[..., Image])


def _with_named_settings(render: _Render, named: Mapping[str, str] = _nacre.named_settings()) -> _Render:
    """Adds an argument, with its documentation, for each setting that the renderer's table has and that
    is not written out here, where alone type checkers look."""
    @functools.wraps(render)
    def with_named(*arguments: Any, **settings: Any) -> Image:
        given = [(name, settings.pop(name, None)) for name in named]
        others = [(name, to_json(value, name)) for name, value in given if value is not None]
        return render(*arguments, **settings, **({"_others": others} if others else {}))

    signature = inspect.signature(render)
    new = [name for name in named if name not in signature.parameters]
    own = [parameter for name, parameter in signature.parameters.items() if name != "_others"]
    place = [parameter.name for parameter in own].index("progress")
    own[place:place] = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None) for name in new]
    setattr(with_named, "__signature__", signature.replace(parameters=own))
    meanings = "".join(f"        {name}: {named[name]}.\n" for name in new)
    before, progress, after = (render.__doc__ or "").partition("        progress:")
    with_named.__doc__ = before + meanings + progress + after
    return cast(_Render, with_named)


class _Values:
    """What scenes and sessions share: values by JSON pointer."""

    _native: Any

    def __getitem__(self, pointer: str) -> Any:
        """The value at a JSON pointer, as the file and what was set since say it."""
        value = self._native.get(text(pointer, "a JSON pointer"))
        if value is None:
            raise KeyError(f"nothing is set at {pointer!r}: there a default holds, or nothing")
        return json.loads(value)

    def __setitem__(self, pointer: str, value: Any) -> None:
        self._native.set(text(pointer, "a JSON pointer"), to_json(value, pointer))

    def get(self, pointer: str, default: Any = None) -> Any:
        """The value at a JSON pointer, or `default` where nothing is set."""
        value = self._native.get(text(pointer, "a JSON pointer"))
        return default if value is None else json.loads(value)

    def __contains__(self, pointer: object) -> bool:
        return isinstance(pointer, str) and self._native.has(text(pointer, "a JSON pointer"))

    def to_dict(self) -> Dict[str, Any]:
        """The scene as a scene file has it, without the shapes of add_spheres and add_mesh. Of a model
        without its meshes and maps, and without the room that lights it where it has no light."""
        scene = json.loads(self._native.get("") or "{}")
        for name, light in list(scene.get("lights", {}).items()):
            if isinstance(light, dict) and light.get("type") == "environment" and "scale" in light and not (
                    light.keys() & {"radiance", "gradient", "quadratic", "image"}):
                del scene["lights"][name]
        return scene


def _scene_of_bytes(scene: bytes) -> "Scene":
    """What pickle makes of a scene."""
    return Scene._of(_nacre.Scene.from_bytes(scene))


class Scene(_Values):
    """What is rendered: a scene file, a model (glTF, OBJ, PLY), or built in code, or both.

        scene = nacre.Scene.from_file("scenes/first_scene.json")
        scene["/materials/red/roughness"] = 0.2
        image = scene.render(width=640, height=360)

    Names, values and units are those of scene files (scenes/README.md, `nacre.scene_schema()`), and
    so are the checks. These run, on all of it at once, when the scene is first rendered, or by
    `check`; they raise `nacre.Error`. A place that there is not, in a list or below a material, light
    or texture, is refused where it is set.

    A scene is copied by `copy`, and pickled, for other processes; not with a function as a material.
    Files that it names are not part of a pickle.
    """

    def __init__(self) -> None:
        """An empty scene: black, with the default camera."""
        self._native = _nacre.Scene.empty()

    @classmethod
    def _of(cls, native: Any) -> "Scene":
        scene = cls.__new__(cls)
        scene._native = native
        return scene

    @classmethod
    def from_file(cls, path: PathLike) -> "Scene":
        """Reads a scene file (.json) or a model (.gltf, .glb, .obj, .ply)."""
        return cls._of(_nacre.Scene.from_file(_path(path)))

    @classmethod
    def from_dict(cls, scene: Mapping[str, Any], folder: PathLike = ".") -> "Scene":
        """Of what a scene file would hold. `folder` is where files that it names are looked for."""
        if not isinstance(scene, Mapping):
            raise TypeError(f"a scene is a dictionary, not a {type(scene).__name__}")
        whole_scene = {"nacre": 1, **scene}
        return cls._of(_nacre.Scene.from_json(to_json(whole_scene, "scene"), _path(folder)))

    def copy(self) -> "Scene":
        """Another scene of the same values."""
        return Scene._of(self._native.copy())

    def __copy__(self) -> "Scene":
        return self.copy()

    def __deepcopy__(self, memo: Any) -> "Scene":
        return self.copy()

    def __reduce__(self) -> Any:
        try:
            return _scene_of_bytes, (self._native.to_bytes(),)
        except Error as error:
            raise TypeError(f"cannot pickle a nacre.Scene: {error.faults[0].what}") from None

    def set_camera(self, **camera: Any) -> None:
        """set_camera(position=(0, 1, 5), look_at=(0, 1, 0), fov_y_deg=40)"""
        self["/camera"] = camera

    def set_background(self, radiance: Union[float, Point]) -> None:
        """What rays see that hit nothing: linear Rec. 709, or a number for grey."""
        self["/background"] = radiance

    def _add(self, part: str, name: str, value: Dict[str, Any]) -> None:
        self[f"/{part}/" + text(name, "a name").replace("~", "~0").replace("/", "~1")] = value

    def add_material(self, name: str, model: Union[str, Brdf, Function], **parameters: Any) -> None:
        """add_material("gold", "conductor", preset="gold", roughness=0.2)

        model: the name of one, or a function of one's own, bare or as a `nacre.Brdf`, which may have
            a sampler. Its parameters are then those of a material of which all but the lobes holds:
            emission, coats and layers, normal maps, and the albedo that ambient light sees; of the model
            "lambert" unless `rest` names another: add_material("mine", f, rest="metallic_roughness",
            coat=1). Or a `nacre.Brdf` of one of nacre's models, whose parameters are added to.

        A function is called from the render's threads, one call at a time, with hundreds of points;
        what it raises ends the render and comes out of it. Adaptive sampling (max_error) measures how
        narrow its highlights are; a note in image.stats names a lobe that the samples of an environment
        hardly find, which takes a sampler.
        """
        if isinstance(model, str):
            self._add("materials", name, {"model": model, **parameters})
            return
        brdf = model if isinstance(model, Brdf) else Brdf(model)
        if brdf._material is not None:
            self._add("materials", name, {**brdf._material, **parameters})
            return
        if not brdf.is_own:
            raise TypeError("the material of another scene is added by its values: "
                            "add_material(name, model, ...)")
        members = {"model": parameters.pop("rest", "lambert"), **parameters}
        self._native.add_user_material(text(name, "a name"), *brdf._functions(), [
            (text(key, "a parameter"), to_json(value, key)) for key, value in members.items()])

    def add_light(self, name: str, type: str, **parameters: Any) -> None:
        """add_light("key", "point", position=(3, 4, 5), intensity=100)"""
        self._add("lights", name, {"type": type, **parameters})

    def add_texture(self, name: str, file: str, **parameters: Any) -> None:
        """add_texture("wood", "wood.png")"""
        self._add("textures", name, {"file": file, **parameters})

    def add_shape(self, type: str, **parameters: Any) -> None:
        """add_shape("sphere", center=(0, 0, 0), radius=1, material="gold"); also "mesh", "icosphere",
        "uv_sphere", "grid", "pair", "cloud" and the others of the schema."""
        members = [("type", to_json(type, "type"))]
        members += [(text(name, "a parameter"), to_json(value, name)) for name, value in parameters.items()]
        self._native.add_shape(members)

    def add_sphere(self, center: Point, radius: float, material: str) -> None:
        """One sphere. Spheres and meshes of this form come after all other shapes."""
        self.add_spheres([center], [radius], material)

    def add_spheres(self, centers: Any, radii: Any, material: str) -> None:
        """Many spheres as arrays: centers of shape (count, 3), radii of shape (count,) or a
        number."""
        where = _doubles(centers, "centers")
        if where.ndim != 2 or where.shape[1] != 3:
            raise ValueError(f"centers has the shape (count, 3), not {where.shape}")
        sizes = _doubles(radii, "radii")
        if sizes.shape not in ((), (len(where),)):
            raise ValueError(f"radii has one number for each of {len(where)} centers, not the shape "
                             f"{sizes.shape}")
        self._native.add_spheres(where, np.broadcast_to(sizes, (len(where),)),
                                 text(material, "a material"))

    def add_mesh(self, positions: Any, triangles: Any, material: str, *, normals: Any = None,
                 uvs: Any = None) -> None:
        """Triangles in world space.

        positions: (vertices, 3). triangles: (count, 3) indices, counter-clockwise from outside.
        normals: (vertices, 3), or None for flat faces. uvs: (vertices, 2), or None.
        """
        indices = numbers(triangles, "triangles")
        if indices.ndim != 2 or indices.shape[1] != 3:
            hint = "; reshape(-1, 3) makes it of a flat one" if indices.ndim == 1 else ""
            raise ValueError(f"triangles has the shape (count, 3), not {indices.shape}{hint}")
        if indices.dtype.kind not in "iu":
            raise TypeError(f"triangles are indices, not {indices.dtype}")
        if indices.size and (indices.min() < 0 or indices.max() >= 2**32):
            i, corner = (int(n) for n in np.argwhere((indices < 0) | (indices >= 2**32))[0])
            raise ValueError(f"triangles: triangle {i} names position {indices[i, corner]}")
        self._native.add_mesh(_doubles(positions, "positions"), indices.astype(np.uint32, copy=False),
                              text(material, "a material"),
                              None if normals is None else _doubles(normals, "normals"),
                              None if uvs is None else _doubles(uvs, "uvs"))

    def check(self) -> None:
        """Raises `nacre.Error` with everything that is wrong."""
        self._native.check()

    @property
    def sphere_count(self) -> int:
        """Of all shapes together. Raises `nacre.Error` where the scene is wrong."""
        return self._native.sphere_count()

    @property
    def mesh_count(self) -> int:
        """Of all shapes together. Raises `nacre.Error` where the scene is wrong."""
        return self._native.mesh_count()

    @property
    def material_names(self) -> List[str]:
        """In the scene's order."""
        return self._native.material_names()

    @property
    def light_names(self) -> List[str]:
        """In the scene's order."""
        return self._native.light_names()

    @_with_named_settings
    def render(self, *, width: Optional[int] = None, height: Optional[int] = None,
               samples: Optional[int] = None, max_error: Optional[float] = None,
               seed: Optional[int] = None, region: Optional[Sequence[int]] = None,
               layers: Union[str, Sequence[str]] = (), threads: Optional[int] = None,
               intersector: str = "auto", progress: Progress = None,
               _others: Sequence[Tuple[str, str]] = ()) -> Image:
        """Renders the scene. Other Python threads run meanwhile, and Ctrl-C ends it.

        width, height: pixels; the scene's by default.
        samples: a pixel; the scene's by default. With max_error the most, 4096 by default.
        max_error: adaptive sampling, as the program's --max-error: 95 % of the pixels are within it.
        seed: of the sample pattern; the scene's by default.
        region: (x0, y0, x1, y1), pixels to render, with the bits of the full frame.
        layers: besides R, G, B and A: "diffuse", "specular", "ambient", "emission", "albedo", "N",
            "P", "Z", "id.object", "id.material", "light.NAME", or "all".
        threads: as many as the machine has by default.
        intersector: "auto", "embree", "tiles" or "shells": the same bits.
        progress: a function of the share done, in (0, 1], which ends the render by raising; or True
            for a bar (tqdm's, where that is installed).
        """
        with _report(progress) as report:
            return self._native.render(
                _settings(width, height, samples, max_error, seed, region, layers, threads,
                          intersector, _others), report)

    def __repr__(self) -> str:
        return "<nacre.Scene>"


class Session(_Values):
    """A scene that is rendered again and again while it changes.

        with nacre.Session(scene) as session:
            for roughness in np.linspace(0.1, 1, 10):
                session["/materials/red/roughness"] = roughness
                session.render().show()

    It works on a copy of the scene. What a change does not touch is not read or made again, and
    pictures have the bits that Scene.render would give them. Values are checked as they are set: one
    that is wrong raises `nacre.Error` and changes nothing. One call at a time; `cancel` alone may
    come from any thread.

    Files are read when the session is made, and again by `reload`, or where a change touches what
    they are named in.
    """

    def __init__(self, scene: Scene) -> None:
        if not isinstance(scene, Scene):
            raise TypeError(f"a nacre.Scene is wanted, not {type(scene).__name__}")
        self._native = _nacre.Session.of(scene._native)

    @_with_named_settings
    def render(self, *, width: Optional[int] = None, height: Optional[int] = None,
               samples: Optional[int] = None, max_error: Optional[float] = None,
               seed: Optional[int] = None, region: Optional[Sequence[int]] = None,
               layers: Union[str, Sequence[str]] = (), threads: Optional[int] = None,
               intersector: str = "auto", progress: Progress = None,
               show: Optional[Callable[[Image, int], object]] = None,
               _others: Sequence[Tuple[str, str]] = ()) -> Image:
        """As Scene.render. Raises `nacre.Cancelled` where `cancel` has ended it.

        show: called with the means of the first 1, 2, 4, ... samples and their number, and last with
            the picture itself. Under max_error there is no other.
        """
        with _report(progress) as report:
            return self._native.render(
                _settings(width, height, samples, max_error, seed, region, layers, threads,
                          intersector, _others), report, show)

    def reload(self) -> bool:
        """Reads the files again that have changed on disk of those that the scene names: textures,
        models, skies. Returns whether there were any. Values stay what they are; those of the scene's
        own file are read by `Scene.from_file` alone. Raises `nacre.Error` where a file is wrong now:
        the scene is then the one before, and the next call tries again."""
        return self._native.reload()

    def cancel(self) -> None:
        """Ends a render that runs, within some milliseconds, or else the next one as it begins."""
        self._native.cancel()

    def close(self) -> None:
        """Frees what the session holds. Everything but `close` then raises `nacre.Error`."""
        self._native.close()

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __reduce__(self) -> Any:
        raise TypeError("cannot pickle a nacre.Session: pickle its scene, and open another there")

    def __repr__(self) -> str:
        return "<nacre.Session>"


def grid(model: Union[str, Callable[..., Any]], **parameters: Any) -> Scene:
    """Spheres over one or two parameters of a model: the first that is a list or array varies to the
    right, the second downwards.

        def ggx(roughness, f0): ...        # returns a function of directions, or a nacre.Brdf
        nacre.grid(ggx, roughness=np.linspace(0.2, 1, 5), f0=[0.04, 0.5, 1]).render()
        nacre.grid("conductor", preset=["gold", "copper"], roughness=[0.1, 0.2, 0.4]).render()

    model: a function that makes one of parameters, or the name of one of nacre's. A colour that does
        not vary is a tuple.

    The scene has a camera, the size of its image and the point light "key", all of which may be set
    anew; its materials are named by their values, "roughness=0.2 f0=0.04".
    """
    if not isinstance(model, str) and not callable(model):
        raise TypeError(f"grid: a model is a name or a function, not a {type(model).__name__}")
    axes = [(name, list(values)) for name, values in parameters.items()
            if isinstance(values, (list, range, np.ndarray))]
    if not 1 <= len(axes) <= 2 or not all(values for _, values in axes):
        raise ValueError("grid: one or two parameters are lists or arrays of values; here, "
                         f"{len(axes)} are" if len(axes) not in (1, 2) else
                         "grid: a parameter has no values")
    fixed = {name: value for name, value in parameters.items() if name not in dict(axes)}
    (across, columns), (down, rows) = axes[0], axes[1] if len(axes) == 2 else ("", [None])
    scene = Scene()
    scene.set_camera(type="orthographic", position=(0, 0, 100), height=len(rows))
    scene["/image"] = {"width": 160 * len(columns), "height": 160 * len(rows), "spp": 4}
    scene.add_light("key", "point", position=(120, 135, 165), intensity=180000)
    for j, row in enumerate(rows):
        for i, column in enumerate(columns):
            values = {across: column, **({down: row} if down else {})}
            name = " ".join(f"{key}={value:g}" if isinstance(value, (int, float)) else f"{key}={value}"
                            for key, value in values.items())
            if isinstance(model, str):
                scene.add_material(name, model, **fixed, **values)
            else:
                scene.add_material(name, model(**fixed, **values))
            scene.add_sphere((i - (len(columns) - 1) / 2, (len(rows) - 1) / 2 - j, 0), 0.42, name)
    return scene


def render(scene: Scene, **settings: Any) -> Image:
    """`scene.render(...)`."""
    if not isinstance(scene, Scene):
        raise TypeError(f"a nacre.Scene is wanted, not {type(scene).__name__}")
    return scene.render(**settings)
