# SPDX-License-Identifier: Apache-2.0
"""Is my BRDF right? Its reciprocity, energy, sampler and cost, and its difference from another."""
import dataclasses
import threading
import time
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Tuple, Union

import numpy as np

from ._arguments import real, whole
from ._brdf import Brdf, Function, _hemisphere, _Own
from ._errors import Error
from ._image import Array, Comparison, Image, Picture, difference
from ._scene import Scene

# Angles in degrees; of phi, 0 is where the viewer is and 180 where mirrors look.
_THETA = (0.5, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 88.0)
_PHI = (0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 165.0, 175.0, 180.0)
# Reciprocity and isotropy hold to the rounding of a formula that is not written for precision: float32
# makes 1e-5 of it in a lobe of alpha 0.16. Somebody's mistake is larger.
_ROUNDING = 1e-4
# What integrals are right to that have settled, and a margin for what other quadratures call 1.
_ENERGY = 1e-3
# Of a mean of samples: chance reaches that far once in 1e9 times.
_SIGMAS = 6
# A numpy function takes some 100 ns for a sample; a Python loop over the samples, thousands.
_SLOW = 2e-6


_WORDS = {True: "ok", False: "FAIL", None: "unknown"}


class Verdict(NamedTuple):
    """Whether a property holds, and how it was found, in words."""

    ok: Optional[bool]  #: None: that cannot be told
    text: str


@dataclasses.dataclass(repr=False, eq=False)
class Check:
    """What `check` has found. True where all verdicts are, and none is unknown; str(check) is its page.

    theta_light, theta_view, phi: the angles of the grid, in degrees; phi 180 is the mirror's side.
    values, reference: the BRDF without n.l, of shape (theta_light, theta_view, phi, 3).
    error: |values - reference| / reference, of the channel where it is largest, of shape
        (theta_light, theta_view, phi); None without a reference.
    cosines, furnace, furnace_reference: n.v, and the albedos there, of shape (count, 3).
    image, image_reference, comparison: a ball rendered with either, and their difference.
    verdicts: by name.
    seconds: per sample, of the function alone, in arrays of 65536.
    """

    name: str
    against: str
    theta_light: Array
    theta_view: Array
    phi: Array
    values: Array
    reference: Optional[Array]
    error: Optional[Array]
    cosines: Array
    furnace: Array
    furnace_reference: Optional[Array]
    image: Image
    image_reference: Optional[Image]
    comparison: Optional[Comparison]
    verdicts: Dict[str, Verdict]
    seconds: float
    hints: List[str]

    def __bool__(self) -> bool:
        return all(verdict.ok is True for verdict in self.verdicts.values())

    def __str__(self) -> str:
        lines = [f"{self.name}" + (f", against {self.against}" if self.against else "")]
        for name, verdict in self.verdicts.items():
            lines.append(f"  {_WORDS[verdict.ok]:7}  {name:10} {verdict.text}")
        lines += [f"  hint: {hint}" for hint in self.hints]
        lines += ["", "  furnace: what is seen of light of radiance 1 from everywhere, by the viewer's angle",
                  "    degrees  " + "".join(f"{np.degrees(np.arccos(c)):9.1f}" for c in self.cosines),
                  "    albedo   " + "".join(f"{a:9.3g}" for a in self.furnace.max(axis=1))]
        if self.furnace_reference is not None:
            lines.append("    against  " + "".join(
                f"{a:9.3g}" for a in self.furnace_reference.max(axis=1)))
        if self.error is not None:
            lines += ["", "  relative error, the largest over phi; light down, viewer across, degrees",
                      "           " + "".join(f"{t:9.3g}" for t in self.theta_view)]
            for theta, row in zip(self.theta_light, self.error.max(axis=2)):
                lines.append(f"    {theta:7.3g}" + "".join(f"{e:9.1e}" for e in row))
        if self.comparison is not None:
            m = self.comparison.layers["beauty"]
            lines += ["", f"  picture of a ball: RMSE {m.rmse:.3g}, relMSE {m.rel_mse:.3g}, largest "
                      f"difference {m.max_abs:.3g} of a mean of {m.mean_reference:.3g}"]
        lines.append(f"  cost: {1e9 * self.seconds:.0f} ns a sample")
        return "\n".join(lines)

    def __repr__(self) -> str:
        found = "; ".join(f"{word}: {', '.join(names)}" for word, names in (
            (word, [name for name, verdict in self.verdicts.items() if verdict.ok is ok])
            for ok, word in _WORDS.items() if ok is not True) if names)
        return f"<nacre.Check of {self.name}: {found or 'ok'}>"

    def picture(self) -> Picture:
        """The ball with the model, with the reference, and where their radiance differs."""
        if self.image_reference is None:
            return self.image.picture()
        return difference(self.image, self.image_reference, low=1e-4)


def _direction(theta: Array, phi: Array) -> Array:
    """Angles from the normal and about it, in degrees, as (..., 3) about +z."""
    t, p = np.broadcast_arrays(np.radians(theta), np.radians(phi))
    return np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1)


_UP = np.array([0.0, 0, 1])


def _turned(v: Array) -> Array:
    """Turned by a rotation that maps no axis to another."""
    a, b, c = 0.7, 1.1, 0.4
    x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    y = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    z = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    turned: Array = v @ (x @ y @ z).T
    return turned / np.linalg.norm(turned, axis=-1, keepdims=True)


def _relative(a: Array, b: Array) -> Array:
    """|a - b| / max(|a|, |b|); of values below a billionth of the largest one, relative to that."""
    scale = np.maximum(np.abs(a), np.abs(b))
    least = 1e-9 * float(scale.max())
    return np.abs(a - b) / np.maximum(scale, least if least > 0 else 1)


def _angles(normal: Array, to_view: Array, to_light: Array) -> str:
    """Three unit vectors in words."""
    light, view = (float(np.degrees(np.arccos(np.clip(normal @ v, -1, 1)))) for v in (to_light, to_view))
    along, across = to_view - (normal @ to_view) * normal, to_light - (normal @ to_light) * normal
    phi = float(np.degrees(np.arctan2(np.linalg.norm(np.cross(along, across)), along @ across)))
    return (f"light {light:.4g}, viewer {view:.4g}, phi {phi:.4g} degrees (normal {normal.round(6).tolist()}, "
            f"to_view {to_view.round(6).tolist()}, to_light {to_light.round(6).tolist()})")


class _Watched:
    """A user's function, of whose values all that is asked for is watched: what is not finite is taken
    for 0, so that the rest can be judged."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function
        self.asked = self.not_finite = 0
        self.least, self.first = np.inf, ""
        self.lock = threading.Lock()  # renders call it from threads of theirs

    def __call__(self, normal: Array, to_view: Array, to_light: Array) -> Any:
        kept = normal.copy(), to_view.copy(), to_light.copy()  # functions may write to theirs
        returned = self.function(normal, to_view, to_light)
        if isinstance(returned, np.ma.MaskedArray) or getattr(returned, "dtype", None) is None or \
                returned.dtype.kind not in "fiu" or returned.ndim != 2 or len(returned) != len(normal):
            return returned  # whoever asked for it refuses it, or can take it
        values = np.asarray(returned, np.float64)
        finite = np.isfinite(values)
        with self.lock:
            self.asked += len(values)
            self.least = min(self.least, float(values.min(initial=np.inf, where=finite)))
            if not finite.all():
                rows = ~finite.all(axis=1)
                i = int(np.argmax(rows))
                self.first = self.first or f"{values[i].tolist()} at {_angles(*(v[i] for v in kept))}"
                self.not_finite += int(rows.sum())
        return np.where(finite, values, 0)

    def verdict(self) -> Verdict:
        if self.not_finite == 0:
            return Verdict(True, f"at all of {self.asked} pairs of directions")
        return Verdict(False, f"{self.not_finite} of {self.asked} values are not: the first is {self.first}; "
                       "below, they count as 0")


def _watched(brdf: Brdf) -> Tuple[Brdf, Optional[_Watched]]:
    """The same model, and what watches it; nothing for nacre's own."""
    if brdf._evaluate is None:
        return brdf, None
    watch = _Watched(brdf._evaluate.function)
    other = Brdf(watch)
    other.name = brdf.name
    other._evaluate = _Own(watch, brdf._evaluate.what, brdf._evaluate.columns)
    other._sample, other._pdf, other._albedo = brdf._sample, brdf._pdf, brdf._albedo
    return other, watch


def _special_pairs() -> Tuple[Array, Array]:
    """Viewers and lights where formulas divide 0 by 0: along the normal, along one another, mirrored,
    and at the horizon."""
    theta = np.array([0.0, 1e-4, 30, 60, 89.99, 89.999999])
    view = _direction(theta, np.array(0.0))
    mirrored = view * [-1, -1, 1]
    up = np.broadcast_to(_UP, view.shape)
    across = _direction(theta, np.array(90.0))
    return (np.concatenate([view, view, view, up, view]),
            np.concatenate([view, mirrored, up, view, across]))


def _ball(brdf: Brdf, size: int) -> Image:
    model: Union[Brdf, Function] = brdf
    if not brdf.is_own and brdf._material is None:  # of a scene

        def reflect(normal: Array, to_view: Array, to_light: Array) -> Array:
            n_dot_l = (normal * to_light).sum(axis=1, keepdims=True)
            result: Array = brdf.evaluate(normal, to_view, to_light) / n_dot_l
            return result
        model = reflect
    scene = Scene()
    scene.set_camera(position=(0, 0, 8), look_at=(0, 0, 0), fov_y_deg=16)
    scene.add_material("ball", model)
    scene.add_light("key", "point", position=(6, 7, 8), intensity=500)
    scene.add_light("rim", "directional", direction_of_travel=(1, -0.2, 1), irradiance=1.5)
    scene.add_sphere((0, 0, 0), 1, "ball")
    return scene.render(width=size, height=size, samples=4)


def _worst(grid: Array, light: Array, view: Array, phi: Array) -> str:
    i, j, k = (int(n) for n in np.unravel_index(int(np.argmax(grid)), grid.shape))
    return f"light {light[i]:g}, viewer {view[j]:g}, phi {phi[k]:g} degrees"


class _Integral(NamedTuple):
    """int of(view, light) dl by rules of which each is twice as dense as the one before: two that agree,
    or three."""

    value: Array  #: of the densest
    spread: float  #: how far the last two are apart
    most: Tuple[float, ...]  #: of each rule, the largest component

    @property
    def grows(self) -> bool:
        """Whether a denser rule gives more again and again, as of an integral that has no end."""
        if len(self.most) < 3 or not np.isfinite(self.most).all():
            return False
        first, second = np.diff(self.most)
        return bool(first > 0 and second > max(first / 2, _ENERGY / 4))

    def at_most_one(self) -> Optional[bool]:
        """None: these rules do not tell."""
        least, last = min(self.most), self.most[-1]
        if not np.isfinite(self.most).all():
            return False
        if self.spread <= _ENERGY / 4:
            return last <= 1 + _ENERGY
        if least > 1 + _ENERGY and (self.grows or self.spread <= (last - 1) / 4):
            return False
        return True if not self.grows and last + 4 * self.spread <= 1 + _ENERGY else None

    def __str__(self) -> str:
        return ", ".join(f"{value:.4g}" for value in self.most)


def _integral(of: Callable[[Array, Array], Array], cosine: float) -> _Integral:
    totals: List[Array] = []
    spread = np.inf
    with np.errstate(over="ignore", invalid="ignore"):
        for fine in (1, 2, 4):
            view, light, weights = _hemisphere(float(cosine), fine)
            totals.append(np.einsum("ijk,ij->k", of(view, light), weights))
            if len(totals) > 1:
                spread = float(np.abs(totals[-1] - totals[-2]).max())
            if spread <= _ENERGY / 4:
                break
    return _Integral(totals[-1], spread, tuple(float(total.max()) for total in totals))


def _furnace(brdf: Brdf, cosines: Array) -> List[_Integral]:
    """The albedos. Those of a function are integrated, whatever it says itself."""
    if brdf.is_own:
        return [_integral(lambda v, l: brdf.evaluate(_UP, v, l), cosine) for cosine in cosines]
    return [_Integral(albedo, 0.0, (float(albedo.max()),)) for albedo in brdf.albedo(cosines)]


def _degrees(cosines: Array) -> str:
    return ", ".join(f"{angle:.0f}" for angle in np.degrees(np.arccos(cosines))) + " degrees"


def _no_more_than_one(text: str, cosines: Array, integrals: List[_Integral]) -> Verdict:
    """The verdict of integrals that may not be above 1. `text` has a place for the largest."""
    found = [integral.at_most_one() for integral in integrals]
    if False in found:
        worst = max((n for n, ok in enumerate(found) if ok is False), key=lambda n: integrals[n].most[-1])
        text = f"{text.format(f'{integrals[worst].most[-1]:.4f}')}, at {_degrees(cosines[[worst]])}"
        if integrals[worst].grows:
            text += f"; denser rules give more and more, {integrals[worst]}: it has no end"
        return Verdict(False, text)
    if None in found:
        unknown = np.array([ok is None for ok in found])
        return Verdict(None, f"cannot be told at {_degrees(cosines[unknown])}: denser rules do not agree, but give "
                       f"{integrals[int(np.argmax(unknown))]} at the first of these")
    return Verdict(True, text.format(f"{max(integral.most[-1] for integral in integrals):.4f}"))


def _own_albedo(brdf: Brdf, cosines: Array, furnace: List[_Integral]) -> Verdict:
    """Whether what a function says of its albedo is its integral."""
    try:
        told = brdf.albedo(cosines)
    except Error as error:
        return Verdict(False, error.faults[0].what)
    off = np.array([np.abs(albedo - integral.value).max() - 4 * integral.spread
                    for albedo, integral in zip(told, furnace)])
    i = int(np.argmax(off))
    return Verdict(bool(off.max() <= _ENERGY), f"it says {told[i].max():.4f} at {_degrees(cosines[[i]])}"
                   f", its integral is {furnace[i].value.max():.4f}")


def _unbiased(brdf: Brdf, up: Array, view: Array, points: Array, integral: _Integral) -> Tuple[float, str]:
    """How many standard errors the mean of f n.l / pdf over the model's own samples is off its albedo."""
    light = brdf.sample(up, view, points)
    f = brdf.evaluate(up, view, light).max(axis=-1)
    pdf = brdf.pdf(up, view, light)
    if ((f > 0) & ~(pdf > 0)).any():
        return np.inf, "samples have pdf 0"
    albedo = integral.most[-1]
    weight = np.where(pdf > 0, f / np.where(pdf > 0, pdf, 1), 0)
    error = abs(weight.mean() - albedo)
    known = max(1e-3 * abs(albedo), integral.spread) + 1e-12
    sigmas = error / (weight.std() / len(points)**0.5 + known)
    return float(sigmas), f"samples mean {weight.mean():.4f}, the albedo is {albedo:.4f}"


# By what samples may differ from their pdf; see _moments.
_MOMENTS = ("more or fewer are above the surface", "they are more or less steep",
            "they are more or less on the viewer's side", "they are more or less to the sides",
            "they are nearer to the mirror direction, or farther")


def _moments(light: Array, mirror: Array) -> Array:
    """Numbers from -1 to 1 by which distributions of directions over +z differ, of shape (..., 5)."""
    z = light[..., 2]
    moments: Array = (z[..., None] > 0) * np.stack(
        [np.ones_like(z), z, light[..., 0], light[..., 1]**2, (light @ mirror)**8], axis=-1)
    return moments


def _sampler(brdf: Brdf, cosines: Array, furnace: List[_Integral]) -> Verdict:
    """Whether samples are unbiased, also where the normal is no axis, and distributed as the pdf says,
    which is nowhere below 0 and not above 1 in all."""
    rng = np.random.default_rng(7)
    worst, found, least = 0.0, "unbiased, and where the pdf says", 0.0
    turned_only, any_upright = False, False
    chances: List[_Integral] = []
    tellable = []
    for cosine, integral in zip(cosines, furnace):
        view = _hemisphere(float(cosine))[0]
        mirror = view * [-1, -1, 1]

        def pdf_of_moments(v: Array, l: Array) -> Array:
            nonlocal least
            pdf = brdf.pdf(_UP, v, l)
            least = min(least, float(pdf.min()))
            moments: Array = pdf[..., None] * _moments(l, mirror)
            return moments
        told = _integral(pdf_of_moments, float(cosine))
        chances.append(told)
        tellable.append(all(i.at_most_one() is not None and not i.grows for i in (integral, told)))
        if not tellable[-1]:
            continue
        upright, text = _unbiased(brdf, _UP, view, rng.random((8192, 2)), integral)
        turned, of_turned = _unbiased(brdf, _turned(_UP), _turned(view), rng.random((8192, 2)), integral)
        got = _moments(brdf.sample(_UP, view, rng.random((8192, 2))), mirror)
        off = np.abs(got.mean(axis=0) - told.value) / (
            got.std(axis=0) / len(got)**0.5 + max(1e-3, told.spread))
        placed = float(off.max())
        most, what = max((upright, text), (turned, of_turned),
                         (placed, f"samples are not where the pdf says: {_MOMENTS[int(np.argmax(off))]}"),
                         key=lambda pair: pair[0])
        if most >= max(worst, _SIGMAS):
            found = f"at {_degrees(np.array([cosine]))} {what}"
        worst = max(worst, most)
        turned_only |= turned >= _SIGMAS > max(upright, placed)
        any_upright |= max(upright, placed) >= _SIGMAS
    if least < 0:
        return Verdict(False, f"its pdf is {least:.4g} somewhere, below 0")
    chance = _no_more_than_one("its pdf is {} in all, more than 1", cosines, chances)
    if chance.ok is False:
        return chance
    if worst >= _SIGMAS:
        only = ": only where the normal is not +z" if turned_only and not any_upright else ""
        return Verdict(False, found + only)
    if not all(tellable):
        return Verdict(None, f"cannot be told at {_degrees(cosines[~np.array(tellable)])}: denser rules do not agree "
                       "about the albedo or the pdf")
    return Verdict(True, found)


def _cost(brdf: Brdf) -> float:
    """Seconds a sample: in arrays of 65536, or as many as take a tenth of a second."""
    rng = np.random.default_rng(3)
    light, view = (_direction(80 * rng.random(65536), 360 * rng.random(65536)) for _ in range(2))
    normal = np.tile(_UP, (65536, 1))
    function: Any = brdf._evaluate.function if brdf._evaluate is not None else brdf.evaluate
    count = 256
    while True:
        seconds = []
        for _ in range(3):
            start = time.perf_counter()
            function(normal[:count], view[:count], light[:count])
            seconds.append(time.perf_counter() - start)
        if count == 65536 or min(seconds) > 0.02:
            return min(seconds) / count
        count *= 4


def _factor_hints(values: Array, reference: Array, theta_light: Array) -> List[str]:
    """What a wrong factor may be."""
    good = (reference > 0) & (values > 0)
    if not good.any():
        return ["it is black wherever the other is not"]
    ratio = np.where(good, values / np.where(good, reference, 1), np.nan)
    n_dot_l = np.cos(np.radians(theta_light))[:, None, None, None]
    known: Tuple[Tuple[float, str], ...] = (
        (np.pi, "pi: the 1/pi is missing"), (1 / np.pi, "1/pi: divided by pi once too often"),
        (4, "4: the 1/4 of the microfacet lobe is missing"), (1 / 4, "1/4"), (2, "2"), (1 / 2, "1/2"))
    for by, what in ((1.0, ""), (n_dot_l, "n.l: which is not part of the BRDF"), (1 / n_dot_l, "1/n.l")):
        left = ratio / by
        median = float(np.nanmedian(left))
        if not np.nanquantile(np.abs(left / median - 1), 0.98) < 1e-3:
            continue
        factors = [what] if what else []
        if abs(median - 1) > 1e-3:
            named = [text for factor, text in known if abs(median / factor - 1) < 1e-3]
            factors.append(named[0] if named else f"{median:.6g}")
        if factors:
            return ["it is the other times " + ", and times ".join(factors)]
    return []


def _other_roughness(values: Array, against: str, parameters: Dict[str, Any], tolerance: float,
                     values_of: Callable[[Brdf], Array]) -> List[str]:
    """Whether roughness has been taken for alpha, or alpha for roughness."""
    roughness = parameters.get("roughness")
    if not isinstance(roughness, (int, float)):
        return []
    for other in (float(roughness)**0.5, float(roughness)**2):
        reference = values_of(Brdf(against, **{**parameters, "roughness": other}))
        if (np.abs(values - reference) <= tolerance * reference).all():
            return [f"it is that of roughness {other:.4g}: alpha is the square of the roughness"]
    return []


def _energy_hint(furnace: Array, cosines: Array) -> str:
    """Where a model makes light, and what usually does."""
    too_much = furnace > 1 + _ENERGY
    if too_much.all():
        return ("it makes light at all angles: a diffuse part without its 1/pi, or one that does not give "
                "up what the highlight takes?")
    if too_much[-1] and not too_much[0]:
        first = np.degrees(np.arccos(cosines[int(np.argmax(too_much))]))
        return (f"it makes light for viewers at {first:.0f} degrees and more alone: a lobe over "
                "4 n.l n.v without a shadowing term G, or a highlight on top of a whole diffuse part?")
    return "the table below tells at which angles it makes light"


def _hints(found: Check, known: List[str]) -> List[str]:
    """What may be wrong, of what is not right, and what is known of that."""
    hints = list(known)
    wrong = {name for name, verdict in found.verdicts.items() if verdict.ok is False}
    if "reciprocal" in wrong:
        alone = found.values / np.cos(np.radians(found.theta_light))[:, None, None, None]
        if _relative(alone, alone.swapaxes(0, 1)).max() < _ROUNDING:
            hints.append("without a factor n.l it is reciprocal: n.l is not part of the BRDF")
    if found.reference is not None and found.error is not None and "agrees" in wrong and not hints:
        hints = _factor_hints(found.values, found.reference, found.theta_light)
        steep = np.maximum(found.theta_light[:, None], found.theta_view) >= 80
        if not hints and found.error[~steep].max() < 1e-3 < found.error[steep].max():
            hints.append("only grazing angles are wrong: a denominator that is kept above 0 by too much?")
    if "energy" in wrong and not hints:
        hints.append(_energy_hint(found.furnace.max(axis=1), found.cosines))
    if found.seconds > _SLOW:
        hints.append(f"{1e6 * found.seconds:.1f} us a sample: a loop over the samples? One expression "
                     "over whole arrays takes about a hundredth")
    return hints


def check(model: Union[Function, Brdf], against: Union[str, Function, Brdf, None] = None, *,
          tolerance: float = 1e-3, size: int = 192, quiet: bool = False, **parameters: Any) -> Check:
    """Checks a BRDF, prints one page, and returns its numbers.

        nacre.check(my_ggx, against="metallic_roughness", base_color=1, metallic=1, roughness=0.4,
                    shadowing="separable", compensation="none")

    model: a function, as of `nacre.Brdf`, or a Brdf.
    against: another such, or the name of one of nacre's models, with its parameters; None: nothing.
    tolerance: the relative difference from it that is right.
    size: of the pictures of a ball, in pixels.
    quiet: prints nothing.

    Verdicts: `finite`, `positive`; `reciprocal`: f(l, v) = f(v, l); `isotropic`: turning light,
    viewer and normal changes nothing; `energy`: no albedo is above 1, but for the 0.001 that quadratures may be off by; `albedo`, of models that tell
    theirs: it is the integral; `sampler`, of models with one: the mean of f n.l / pdf over its samples
    is the albedo, also where the normal is no axis, samples are where the pdf says, and that is not
    above 1 in all; `agrees`, with `against`: within the tolerance at all angles.

    `energy` and `sampler` integrate by three rules. Where these do not agree, because a lobe is too
    narrow for them or the integral has no end, the verdict is a failure if each of them is above 1, and
    otherwise unknown; bool(found) is then False as well. What is not finite is named by `finite`, and
    counts as 0 in the rest. An error of the function itself comes out of it.
    """
    brdf = model if isinstance(model, Brdf) else Brdf(model)
    other = (against if against is None or isinstance(against, Brdf) else
             Brdf(against, **(parameters if isinstance(against, str) else {})))
    if parameters and not isinstance(against, str):
        raise TypeError("parameters are those of the model that `against` names")
    if not real(tolerance, "tolerance") > 0:
        raise ValueError(f"tolerance is above 0, not {tolerance}")
    if whole(size, "size") < 1:
        raise ValueError(f"size is a number of pixels, not {size}")
    theta, phi = np.array(_THETA), np.array(_PHI)
    light = _direction(theta[:, None, None], phi)
    view = _direction(theta[:, None], np.array(0.0))
    cos_light, cos_view = light[..., 2:], view[..., 2:]

    def values_of(of: Brdf) -> Array:
        result: Array = of.evaluate(_UP, view, light) / cos_light
        return result

    model_itself = brdf
    brdf, watch = _watched(brdf)
    of_other = None
    if other is not None:
        other, of_other = _watched(other)
    values = values_of(brdf)
    brdf.evaluate(_UP, *_special_pairs())
    brdf.evaluate(_turned(_UP), *(_turned(v) for v in _special_pairs()))
    swapped = brdf.evaluate(_UP, light, view) / cos_view
    turned = brdf.evaluate(_turned(_UP), _turned(view), _turned(light)) / cos_light
    cosines = np.cos(np.radians(np.array([0.5, 15, 30, 45, 60, 70, 80, 85, 88])))
    furnace = _furnace(brdf, cosines)
    image = _ball(brdf, size)
    # Of all values that were asked for so far.
    verdicts = {"finite": Verdict(True, "at all angles") if watch is None else watch.verdict()}
    least = float(values.min()) if watch is None else watch.least
    verdicts["positive"] = Verdict(least >= 0, f"the least value is {least:.4g}")
    asymmetry = _relative(values, swapped).max(axis=-1)
    verdicts["reciprocal"] = Verdict(
        bool(asymmetry.max() < _ROUNDING), f"f(l, v) and f(v, l) differ by {asymmetry.max():.1e} at "
        f"most, at {_worst(asymmetry, theta, theta, phi)}")
    turning = _relative(values, turned).max(axis=-1)
    verdicts["isotropic"] = Verdict(
        bool(turning.max() < _ROUNDING),
        f"turned with its surface it differs by {turning.max():.1e} at most")
    verdicts["energy"] = _no_more_than_one(
        f"reflects up to {{}} of the light ({1 + _ENERGY:g} is allowed)", cosines, furnace)
    if watch is not None and watch.least == np.inf:
        for name in "positive", "reciprocal", "isotropic", "energy":
            verdicts[name] = Verdict(None, "no value is finite")
    if brdf._albedo is not None:
        verdicts["albedo"] = _own_albedo(brdf, cosines, furnace)
    if brdf._sample is not None:
        try:
            verdicts["sampler"] = _sampler(brdf, cosines, furnace)
        except Error as refused:  # for what it returns
            verdicts["sampler"] = Verdict(False, refused.faults[0].what)
    reference = error = furnace_reference = image_reference = comparison = None
    if other is not None:
        reference = values_of(other)
        off = np.abs(values - reference)
        error = np.divide(off, np.abs(reference), out=np.where(off > 0, np.inf, 0.0),
                          where=reference != 0).max(axis=-1)
        furnace_reference = other.albedo(cosines)
        image_reference = _ball(other, size)
        comparison = image.compare(image_reference, layers=["beauty"])
        verdicts["agrees"] = Verdict(
            bool(error.max() <= tolerance),
            f"differs by {error.max():.1e} at most, at {_worst(error, theta, theta, phi)}; half of "
            f"the angles by less than {np.median(error):.1e}")
        if of_other is not None and of_other.not_finite:
            verdicts["agrees"] = Verdict(False, f"the reference is not finite: {of_other.verdict().text}")
    found = Check(brdf.name, "" if other is None else other.name, theta, theta, phi, values, reference,
                  error, cosines, np.array([integral.value for integral in furnace]), furnace_reference, image, image_reference, comparison,
                  verdicts, _cost(model_itself), [])
    known = (_other_roughness(values, against, parameters, tolerance, values_of)
             if isinstance(against, str) and not verdicts["agrees"].ok else [])
    found.hints = _hints(found, known)
    if not quiet:
        print(found)
    return found
