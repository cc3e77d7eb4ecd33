# SPDX-License-Identifier: Apache-2.0
"""Images: channels as numpy arrays, files, metrics, and pictures of them for a display."""
import dataclasses
import math
import os
from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _nacre
from ._arguments import PathLike, numbers, path as _path, real, refuse_masked, text, whole
from ._errors import fault

Array = np.ndarray


class Window(NamedTuple):
    """Pixels x0 <= x < x1, y0 <= y < y1, y downwards from the top."""

    x0: int
    y0: int
    x1: int
    y1: int


def _as_array(array: Array, dtype: Any, copy: Optional[bool]) -> Array:
    """What numpy, version 1 or 2, asks of __array__."""
    converted = array.astype(dtype or array.dtype, copy=bool(copy))
    if copy is False and not np.shares_memory(converted, array):
        raise ValueError(f"a copy is needed to make {dtype} of {array.dtype}")
    return converted


class Picture:
    """What a display shows: an array of sRGB codes, which notebooks show as a picture.

    pixels: uint8 of shape (height, width, 3).
    """

    def __init__(self, pixels: Array) -> None:
        array = np.asarray(pixels)
        if array.ndim != 3 or array.shape[2] not in (3, 4) or array.dtype != np.uint8:
            raise ValueError("a picture is an array of shape (height, width, 3) and type uint8, not "
                             f"{array.shape} and {array.dtype}")
        self.pixels = array[:, :, :3]

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> Array:
        """np.asarray(picture): its pixels."""
        return _as_array(self.pixels, dtype, copy)

    def _repr_png_(self) -> bytes:
        return _nacre.encode_png(self.pixels)

    def png(self) -> bytes:
        """The bytes of a PNG file."""
        return _nacre.encode_png(self.pixels)

    def jpeg(self, quality: int = 90) -> bytes:
        """The bytes of a JPEG file, quality 1 to 100, colours at full resolution."""
        return _nacre.encode_jpeg(self.pixels, whole(quality, "quality"))

    def write(self, path: PathLike) -> None:
        """Writes a .png or .jpg file, whole or not at all."""
        name = os.fsdecode(_path(path))
        if not name.lower().endswith((".png", ".jpg", ".jpeg")):
            raise fault(name, "unknown output extension", "pictures are written to .png and .jpg")
        data = self.png() if name.lower().endswith(".png") else self.jpeg()
        target = os.path.realpath(name)  # a link stays one
        if os.path.exists(target) and not os.path.isfile(target) and not os.path.isdir(target):
            raise fault(name, "exists and is not a regular file", "choose another name", exit_code=74)
        part = f"{target}.{os.urandom(6).hex()}.part"  # of this call: others may write the same file
        try:
            try:
                with open(part, "wb") as file:
                    file.write(data)
                os.replace(part, target)
            except BaseException:
                if os.path.exists(part):
                    os.remove(part)
                raise
        except OSError as error:
            raise fault(name, f"cannot be written: {error.strerror}", exit_code=74) from None

    def __repr__(self) -> str:
        return f"<nacre.Picture of {self.pixels.shape[1]} x {self.pixels.shape[0]} pixels>"


@dataclasses.dataclass
class LayerMetrics:
    """How far a layer is from the reference's.

    samples: how many were compared. mean, mean_reference: of them.
    rmse: the root of the mean of difference^2.
    rel_mse: the mean of difference^2 / (reference^2 + 1e-4).
    psnr_db: in decibels, relative to the reference's largest magnitude.
    max_abs: the largest |difference|. max_rel: of |difference| / |reference|, where that is not 0;
        zero_mismatches: how many samples differ where it is 0.
    ssim, flip, hdr_flip: with perceptual=True, of layers that are colours; else None. SSIM (Wang et al.
        2004) is 1 for equal images, FLIP (Andersson et al. 2020, 2021) 0.
    """

    layer: str
    samples: int
    rmse: float
    rel_mse: float
    psnr_db: float
    max_abs: float
    max_rel: float
    zero_mismatches: int
    mean: float
    mean_reference: float
    ssim: Optional[float] = None
    flip: Optional[float] = None
    hdr_flip: Optional[float] = None


@dataclasses.dataclass(repr=False)
class Comparison:
    """What `compare` finds. True where the images match; str(comparison) is a line for each layer.

    match: whether all layers are within the tolerances; reason: why not, in words.
    pixels, exceeding_pixels: how many there are, and how many are beyond the tolerances.
    layers: a `LayerMetrics` by name.
    """

    match: bool
    reason: str
    pixels: int
    exceeding_pixels: int
    layers: Dict[str, LayerMetrics]

    def __bool__(self) -> bool:
        return self.match

    def __str__(self) -> str:
        lines = ["match" if self.match else f"no match: {self.reason}"]
        for m in self.layers.values():
            numbers_of = [("rmse", m.rmse), ("relMSE", m.rel_mse), ("PSNR", m.psnr_db),
                          ("max", m.max_abs), ("SSIM", m.ssim), ("FLIP", m.flip),
                          ("HDR-FLIP", m.hdr_flip)]
            lines.append(f"{m.layer:12} " + "  ".join(
                f"{name} {number:.4g}" for name, number in numbers_of if number is not None))
        return "\n".join(lines)

    __repr__ = __str__


_COLORS, _VECTORS = ("R", "G", "B"), ("X", "Y", "Z")


def _layer(name: Any) -> str:
    """As C++ has it."""
    return "" if text(name, "a layer") == "beauty" else name


class Image:
    """A picture of any number of channels, linear.

    `image["R"]` is a channel, an array of shape (height, width); `image["beauty"]` the channels R, G
    and B, and `image["diffuse"]` or `image["N"]` another layer, of shape (height, width, 3). The type
    is float32; that of ids ("id.object") is uint32. All of them are views, not copies: what is
    written to one is written to the image, and they outlive it. `np.asarray(image)` is
    `image["beauty"]`, without A, or its only layer.

    `layers` and `channels` list the names. `data` is the window that the channels cover, `frame` the
    whole picture. `metadata` holds text by name, `stats` of renders what was counted and timed: of
    max_error "unsettled_pixels", those that have not converged, which "notes" tells as well.
    """

    frame: Window
    data: Window
    metadata: Dict[str, str]
    stats: Optional[Dict[str, Any]]

    def __init__(self, channels: Union[Array, Mapping[str, Array]],
                 metadata: Optional[Mapping[str, str]] = None) -> None:
        """Of arrays, which are copied and converted to float32 (integers of ids: to uint32): one of
        shape (height, width, 3 or 4), the beauty and A; or several by the names of channels, of
        shape (height, width), and of layers, of shape (height, width, 3)."""
        if isinstance(channels, Image):
            raise TypeError("image: `copy` copies an image with all of its layers")
        if not isinstance(channels, Mapping):
            refuse_masked(channels, "the image")
            array = np.asarray(channels)
            if array.ndim != 3 or array.shape[2] not in (3, 4):
                raise ValueError("an image is an array of shape (height, width, 3 or 4), or several "
                                 f"by name; this one has the shape {array.shape}")
            channels = dict(zip("RGBA", np.moveaxis(array, 2, 0)))
        planes: Dict[str, Array] = {}
        for name, values in channels.items():
            if not isinstance(name, str):
                raise TypeError(f"image: the name of a channel is a text, not {name!r}")
            if not name.isprintable() or not name.rpartition(".")[2]:
                raise ValueError(f"image: {name!r} is no name of a channel")
            array = numbers(values, f"image: {name}", "fiub")
            if array.ndim == 3 and array.shape[2] == 3:
                prefix = "" if name == "beauty" else name + "."
                parts = _VECTORS if name in ("N", "T", "P") else _COLORS
                planes.update({prefix + part: array[:, :, i] for i, part in enumerate(parts)})
            elif array.ndim == 2:
                planes[name] = array
            else:
                raise ValueError(f"image: {name} has the shape {array.shape}, not (height, width) or "
                                 "(height, width, 3)")
        shapes = {plane.shape for plane in planes.values()}
        if len(shapes) != 1 or 0 in next(iter(shapes)):
            raise ValueError("image: there are no pixels" if len(shapes) < 2 else
                             f"image: channels differ in shape: {sorted(shapes)}")
        height, width = shapes.pop()
        # The channels of a layer are neighbours, so that it is a view.
        prefixes = [name.rpartition(".")[0] for name in planes]
        planes = dict(sorted(planes.items(), key=lambda item: (
            prefixes.index(item[0].rpartition(".")[0]), "RGBAXYZ".find(item[0][-1]))))
        types = ["uint" if name.startswith("id.") else "float" for name in planes]
        block = np.empty((len(planes), height, width), np.float32)
        for i, plane in enumerate(planes.values()):
            if types[i] == "uint":
                if not ((plane >= 0) & (plane < 2**32) & (plane == np.floor(plane))).all():
                    raise ValueError("image: ids are whole numbers from 0 to 2^32 - 1")
                block[i].view(np.uint32)[...] = plane
            else:
                block[i] = plane
        window = (0, 0, width, height)
        texts = {str(key): str(value) for key, value in (metadata or {}).items()}
        for key, value in texts.items():
            try:  # as files have them, where bytes that are no UTF-8 are surrogates
                (key + value).encode("utf-8", "surrogateescape")
            except UnicodeEncodeError:
                raise ValueError(f"image: metadata {key!r} is no text that can be written") from None
        self._init(block, list(planes), types, window, window, texts)

    def _init(self, block: Array, names: List[str], types: List[str],
              frame: Sequence[int], data: Sequence[int], metadata: Dict[str, str]) -> None:
        self._block, self._names, self._types = block, names, types
        self.frame, self.data = Window(*frame), Window(*data)
        self.metadata = metadata
        self.stats = None

    @classmethod
    def _of(cls, *parts: Any) -> "Image":
        image = cls.__new__(cls)
        image._init(*parts)
        return image

    @property
    def width(self) -> int:
        """In pixels, of the channels."""
        return self.data.x1 - self.data.x0

    @property
    def height(self) -> int:
        """In pixels, of the channels."""
        return self.data.y1 - self.data.y0

    @property
    def channels(self) -> Tuple[str, ...]:
        """The names of all channels: "R", "diffuse.G", "N.X", "Z", "id.object"."""
        return tuple(self._names)

    @property
    def layers(self) -> Tuple[str, ...]:
        """The names of what `image[name]` gives as a whole: "beauty", "diffuse", "N", "Z"."""
        names: Dict[str, None] = {}
        for name in self._names:
            names[self._layer_of(name)] = None
        return tuple(names)

    def _layer_of(self, channel: str) -> str:
        layer, dot, part = channel.rpartition(".")
        prefix = layer + dot
        for parts in (_COLORS, _VECTORS):
            if part in parts and all(prefix + p in self._names for p in parts):
                return layer or "beauty"
        return channel

    def __contains__(self, name: object) -> bool:
        return name in self._names or name in self.layers

    def __iter__(self) -> Iterator[str]:
        return iter(self.layers)

    def __getitem__(self, name: str) -> Array:
        """A channel, of shape (height, width), or a layer, of shape (height, width, 3): a view. KeyError
        where there is no such."""
        if name in self._names:
            i = self._names.index(name)
            return self._block[i].view(np.uint32) if self._types[i] == "uint" else self._block[i]
        prefix = "" if name == "beauty" else f"{name}."
        for parts in (_COLORS, _VECTORS):
            if all(prefix + part in self._names for part in parts):
                first = self._names.index(prefix + parts[0])
                return np.moveaxis(self._block[first:first + 3], 0, 2)
        raise KeyError(f"the image has no channel or layer {name!r}; it has {', '.join(self)}")

    def __setitem__(self, name: str, values: Any) -> None:
        """Of a channel or layer that there is: what broadcasts to its shape."""
        view = self[name]
        if view is not values:
            view[...] = numbers(values, name, "fiub")

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> Array:
        """np.asarray(image): the beauty, of shape (height, width, 3), a view; of an image that has none,
        its only layer. ValueError where that is not one."""
        layers = self.layers
        if "beauty" not in layers and len(layers) != 1:
            raise ValueError(f"which layer? image[name] is one of {', '.join(layers)}")
        return _as_array(self["beauty" if "beauty" in layers else layers[0]], dtype, copy)

    def copy(self) -> "Image":
        """One that shares no memory with this one."""
        image = Image._of(self._block.copy(), list(self._names), list(self._types), self.frame,
                          self.data, dict(self.metadata))
        image.stats = self.stats
        return image

    def __copy__(self) -> "Image":
        return self.copy()

    def write(self, path: PathLike, *, half_floats: bool = True, compression: str = "zip",
              small: bool = False, tonemap: str = "neutral", exposure: float = 0) -> None:
        """Writes .exr (linear, all channels) or .png (tone-mapped). The file appears whole or not at
        all.

        half_floats: EXR colours and normals in half precision; all else always in full.
        compression: of EXR: "none", "zip", "zips", "piz" or "dwaa".
        small: smaller files, several times slower to write.
        tonemap, exposure: of PNG; see `tone_map`.
        """
        _nacre.write(self, _path(path), bool(half_floats), text(compression, "compression"), bool(small),
                     text(tonemap, "tonemap"), real(exposure, "exposure"))

    def tone_map(self, layer: str = "beauty", *, tonemap: str = "neutral",
                 exposure: float = 0) -> Array:
        """What a display shows of a layer: sRGB codes, uint8 of shape (height, width, 3).

        tonemap: "neutral", "reinhard", "reinhard_extended", "aces", "agx" or "none".
        exposure: in stops, -60 to 60.
        Pixels that hold a NaN are magenta.
        """
        return _nacre.tone_map(self, _layer(layer), text(tonemap, "tonemap"),
                               real(exposure, "exposure"))[:, :, :3]

    def picture(self, layer: str = "beauty", *, tonemap: str = "neutral",
                exposure: float = 0) -> Picture:
        """`tone_map`, as something that notebooks show."""
        return Picture(self.tone_map(layer, tonemap=tonemap, exposure=exposure))

    def show(self, layer: str = "beauty", *, tonemap: str = "neutral", exposure: float = 0) -> None:
        """Shows the picture in a notebook."""
        show(self.picture(layer, tonemap=tonemap, exposure=exposure))

    def compare(self, reference: "Image", **settings: Any) -> Comparison:
        """`nacre.compare(self, reference, ...)`."""
        return compare(self, reference, **settings)

    def _repr_png_(self) -> Optional[bytes]:
        return self.picture().png() if "beauty" in self.layers else None

    def __repr__(self) -> str:
        return f"<nacre.Image of {self.width} x {self.height} pixels: {', '.join(self.layers)}>"


def read(path: PathLike) -> Image:
    """Reads an image file: EXR, PNG, JPEG, TIFF, Radiance HDR, PNM, TGA, as the program does."""
    return _nacre.read(_path(path))


def _want_images(*values: object) -> None:
    for value in values:
        if not isinstance(value, Image):
            raise TypeError(f"a nacre.Image is wanted, not {type(value).__name__}")


def compare(image: Image, reference: Image, *, layers: Union[str, Sequence[str]] = (), max_abs: float = 0,
            max_rel: float = 0, exceeding_fraction: float = 0, max_rmse: float = math.inf,
            perceptual: bool = False, crop: bool = False) -> Comparison:
    """How far an image is from a reference, layer by layer, and whether they match.

    layers: what to compare; all by default, and then both must have the same channels.
    max_abs, max_rel: samples may differ by max_abs + max_rel |reference|, in all but
        exceeding_fraction of the pixels.
    max_rmse: of any layer. If it is the only tolerance, single samples may differ by any amount.
    perceptual: measures SSIM, FLIP and HDR-FLIP, too, which takes longer.
    crop: compares only the pixels that both have; else windows that differ are a difference.
    """
    _want_images(image, reference)
    names = [_layer(name) for name in ([layers] if isinstance(layers, str) else layers)]
    match, reason, pixels, exceeding, measured = _nacre.compare(
        image, reference, names, real(max_abs, "max_abs"), real(max_rel, "max_rel"),
        real(exceeding_fraction, "exceeding_fraction"), real(max_rmse, "max_rmse"), bool(perceptual),
        bool(crop))
    return Comparison(match, reason, pixels, exceeding,
                      {m["layer"]: LayerMetrics(**m) for m in measured})


def heat_map(image: Image, reference: Image, layer: str = "beauty", *, relative: bool = False,
             low: float = 1e-6, high: float = 1) -> Array:
    """Where two images differ: uint8 of shape (height, width, 3).

    The largest error of each pixel over the layer's channels, from dark violet (`low`) to yellow
    (`high`) by its logarithm. Equal pixels are black; magenta are those that are not finite in one
    image only. relative: errors relative to the reference's magnitude.
    """
    _want_images(image, reference)
    return _nacre.heat_map(image, reference, _layer(layer), bool(relative), real(low, "low"),
                           real(high, "high"))[:, :, :3]


Showable = Union[Image, Picture, Array]


def _pixels(picture: Showable) -> Array:
    if isinstance(picture, Image):
        return picture.tone_map()
    return (picture if isinstance(picture, Picture) else Picture(picture)).pixels


def side_by_side(*pictures: Showable, gap: int = 4) -> Picture:
    """Pictures beside one another, from the left, with `gap` white pixels between them. Images are
    tone-mapped; arrays are uint8 of shape (height, width, 3)."""
    if not pictures:
        raise ValueError("side_by_side: there is no picture")
    if whole(gap, "gap") < 0:
        raise ValueError(f"side_by_side: the gap is {gap}")
    parts = [_pixels(picture) for picture in pictures]
    height = max(part.shape[0] for part in parts)
    width = sum(part.shape[1] for part in parts) + gap * (len(parts) - 1)
    pixels = np.full((height, width, 3), 255, np.uint8)
    x = 0
    for part in parts:
        pixels[:part.shape[0], x:x + part.shape[1]] = part
        x += part.shape[1] + gap
    return Picture(pixels)


def difference(image: Image, reference: Image, layer: str = "beauty", *, relative: bool = False,
               low: float = 1e-6, high: float = 1) -> Picture:
    """Both images and the map of their differences (`heat_map`), side by side."""
    _want_images(image, reference)
    return side_by_side(image.tone_map(layer), reference.tone_map(layer),
                        heat_map(image, reference, layer, relative=relative, low=low, high=high))


def show(*pictures: Showable) -> None:
    """Shows pictures in a notebook, side by side. Elsewhere there is no display: write them to
    files."""
    try:
        from IPython import get_ipython
        from IPython.display import display
        shell = get_ipython()
    except ImportError:
        shell = None
    if shell is None:
        raise fault("show", "there is no notebook", "image.write(\"picture.png\") writes a file")
    display(side_by_side(*pictures))
