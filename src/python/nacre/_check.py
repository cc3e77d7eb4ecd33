# SPDX-License-Identifier: Apache-2.0
"""Is my BRDF right? Its reciprocity, energy, sampler and cost, and its difference from another."""
import dataclasses
import time
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Tuple, Union

import numpy as np

from ._arguments import real, whole
from ._brdf import Brdf, Function, _hemisphere
from ._image import Array, Comparison, Image, Picture, difference
from ._scene import Scene

# Angles in degrees; of phi, 0 is where the viewer is and 180 where mirrors look.
_THETA = (0.5, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 88.0)
_PHI = (0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 165.0, 175.0, 180.0)
# Reciprocity and isotropy hold to the rounding of a formula that is not written for precision: float32
# makes 1e-5 of it in a lobe of alpha 0.16. Somebody's mistake is larger.
_ROUNDING = 1e-4
# What `Brdf.albedo` of a function is right to, and a margin for what other quadratures call 1.
_ENERGY = 1e-3
# The same of the integral of a pdf.
_CHANCE = 1e-3
# Of a mean of samples: chance reaches that far once in 1e9 times.
_SIGMAS = 6
# A numpy function takes some 100 ns for a sample; a Python loop over the samples, thousands.
_SLOW = 2e-6


class Verdict(NamedTuple):
    """Whether a property holds, and how it was found, in words."""

    ok: bool
    text: str


@dataclasses.dataclass(repr=False, eq=False)
class Check:
    """What `check` has found. True where all verdicts are; str(check) is its page.

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
        return all(verdict.ok for verdict in self.verdicts.values())

    def __str__(self) -> str:
        lines = [f"{self.name}" + (f", against {self.against}" if self.against else "")]
        for name, verdict in self.verdicts.items():
            lines.append(f"  {'ok  ' if verdict.ok else 'FAIL'}  {name:12} {verdict.text}")
        lines += [f"  hint: {hint}" for hint in self.hints]
        lines += ["", "  furnace: what is seen of light of radiance 1 from everywhere, by the viewer's angle",
                  "    degrees  " + "".join(f"{np.degrees(np.arccos(c)):8.1f}" for c in self.cosines),
                  "    albedo   " + "".join(f"{a:8.3g}" for a in self.furnace.max(axis=1))]
        if self.furnace_reference is not None:
            lines.append("    against  " + "".join(
                f"{a:8.3g}" for a in self.furnace_reference.max(axis=1)))
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
        wrong = [name for name, verdict in self.verdicts.items() if not verdict.ok]
        return f"<nacre.Check of {self.name}: {'FAIL: ' + ', '.join(wrong) if wrong else 'ok'}>"

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


def _integral(of: Callable[[Array, Array], Array], cosine: float,
              tolerance: float) -> Tuple[Array, bool]:
    """int of(view, light) dl, by denser and denser rules; and whether the last two agree to a
    quarter of the tolerance. If not, the lobe is too narrow for them."""
    last: Optional[Array] = None
    for fine in (1, 2, 3):
        view, light, weights = _hemisphere(float(cosine), fine)
        total: Array = np.einsum("ijk,ij->k", of(view, light), weights)
        if last is not None and np.abs(total - last).max() <= tolerance / 4:
            return total, True
        last = total
    return total, False


def _furnace(brdf: Brdf, cosines: Array) -> Tuple[Array, Array]:
    """The albedo, of shape (count, 3), and where it is certain. That of a function is integrated,
    by more than one rule where something hangs on it."""
    furnace, settled = brdf.albedo(cosines), np.full(len(cosines), True)
    if brdf.is_own and brdf._albedo is None:
        for i in range(len(cosines)):
            if brdf._sample is not None or furnace[i].max() > 1 + _ENERGY:
                furnace[i], settled[i] = _integral(lambda v, l: brdf.evaluate(_UP, v, l), cosines[i],
                                                   _ENERGY)
    return furnace, settled


def _untold(cosines: Array, tellable: Array) -> str:
    """What a verdict adds where lobes are too narrow for the quadrature."""
    if tellable.all():
        return ""
    angles = ", ".join(f"{angle:.0f}" for angle in np.degrees(np.arccos(cosines[~tellable])))
    return f"; too narrow to tell at {angles} degrees"


def _unbiased(brdf: Brdf, up: Array, view: Array, points: Array, albedo: float) -> Tuple[float, str]:
    """How many standard errors the mean of f n.l / pdf over the model's own samples is off its albedo."""
    light = brdf.sample(up, view, points)
    f = brdf.evaluate(up, view, light).max(axis=-1)
    pdf = brdf.pdf(up, view, light)
    if ((f > 0) & ~(pdf > 0)).any():
        return np.inf, "samples have pdf 0"
    weight = np.where(pdf > 0, f / np.where(pdf > 0, pdf, 1), 0)
    error = abs(weight.mean() - albedo)
    sigmas = error / (weight.std() / len(points)**0.5 + 1e-3 * albedo + 1e-12)
    return float(sigmas), f"samples mean {weight.mean():.4f}, the albedo is {albedo:.4f}"


def _sampler(brdf: Brdf, cosines: Array, furnace: Array, settled: Array) -> Verdict:
    """Whether samples are unbiased, also where the normal is no axis, and the pdf is one."""
    rng = np.random.default_rng(7)
    worst, found, turned_only, any_upright = 0.0, "unbiased", False, False
    tellable = settled.copy()
    for i, (cosine, albedo) in enumerate(zip(cosines, furnace.max(axis=1))):
        at = f"at {np.degrees(np.arccos(cosine)):.0f} degrees "
        view, around, weights = _hemisphere(float(cosine))
        chance = float((brdf.pdf(_UP, view, around) * weights).sum())
        if chance > 1 + _CHANCE:  # or the lobe is narrow for that rule
            total, tellable[i] = _integral(lambda v, l: brdf.pdf(_UP, v, l)[..., None], cosine, _CHANCE)
            chance = float(total[0])
        if tellable[i] and chance > 1 + _CHANCE:
            return Verdict(False, f"{at}its pdf is {chance:.4f} in all, more than 1")
        if not settled[i]:
            continue
        upright, text = _unbiased(brdf, _UP, view, rng.random((8192, 2)), albedo)
        turned, of_turned = _unbiased(brdf, _turned(_UP), _turned(view), rng.random((8192, 2)), albedo)
        if max(upright, turned) > worst:
            worst, found = max(upright, turned), at + (text if upright >= turned else of_turned)
        turned_only |= turned >= _SIGMAS > upright
        any_upright |= upright >= _SIGMAS
    if turned_only and not any_upright:
        found += ": only where the normal is not +z"
    return Verdict(worst < _SIGMAS, found + _untold(cosines, tellable))


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
    wrong = {name for name, verdict in found.verdicts.items() if not verdict.ok}
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
    viewer and normal changes nothing; `energy`: no albedo is above 1; `sampler`, of models with one:
    the mean of f n.l / pdf over its samples is the albedo, also where the normal is no axis, and its
    pdf is not above 1 in all; `agrees`, with `against`: within the tolerance at all angles. Where a
    lobe is too narrow for the integrals of `energy` and `sampler`, the verdict says so, and does not
    fail for it. An error of the function itself comes out of it.
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

    values = values_of(brdf)
    verdicts = {"finite": Verdict(True, "at all angles")}
    least = float(values.min())
    verdicts["positive"] = Verdict(least >= 0, f"the least value is {least:.4g}")
    swapped = brdf.evaluate(_UP, light, view) / cos_view
    asymmetry = _relative(values, swapped).max(axis=-1)
    verdicts["reciprocal"] = Verdict(
        bool(asymmetry.max() < _ROUNDING), f"f(l, v) and f(v, l) differ by {asymmetry.max():.1e} at "
        f"most, at {_worst(asymmetry, theta, theta, phi)}")
    turned = brdf.evaluate(_turned(_UP), _turned(view), _turned(light)) / cos_light
    turning = _relative(values, turned).max(axis=-1)
    verdicts["isotropic"] = Verdict(
        bool(turning.max() < _ROUNDING),
        f"turned with its surface it differs by {turning.max():.1e} at most")
    cosines = np.cos(np.radians(np.array([0.5, 15, 30, 45, 60, 70, 80, 85, 88])))
    furnace, settled = _furnace(brdf, cosines)
    most = float(furnace[settled].max(initial=0))
    verdicts["energy"] = Verdict(most <= 1 + _ENERGY, f"reflects up to {most:.4f} of the light" +
                                 _untold(cosines, settled))
    if brdf._sample is not None:
        verdicts["sampler"] = _sampler(brdf, cosines, furnace, settled)
    reference = error = furnace_reference = image_reference = comparison = None
    image = _ball(brdf, size)
    if other is not None:
        reference = values_of(other)
        error = (np.abs(values - reference) /
                 np.where(reference > 0, reference, np.inf)).max(axis=-1)
        error = np.where((reference <= 0).any(axis=-1) & (values > 0).any(axis=-1), np.inf, error)
        furnace_reference = other.albedo(cosines)
        verdicts["agrees"] = Verdict(
            bool(error.max() <= tolerance),
            f"differs by {error.max():.1e} at most, at {_worst(error, theta, theta, phi)}; half of "
            f"the angles by less than {np.median(error):.1e}")
        image_reference = _ball(other, size)
        comparison = image.compare(image_reference, layers=["beauty"])
    found = Check(brdf.name, "" if other is None else other.name, theta, theta, phi, values, reference,
                  error, cosines, furnace, furnace_reference, image, image_reference, comparison,
                  verdicts, _cost(brdf), [])
    known = (_other_roughness(values, against, parameters, tolerance, values_of)
             if isinstance(against, str) and not verdicts["agrees"].ok else [])
    found.hints = _hints(found, known)
    if not quiet:
        print(found)
    return found
