# SPDX-License-Identifier: Apache-2.0
"""Right and wrong reflection models, checked."""
import numpy as np
import pytest

import nacre
from nacre._check import _ENERGY, _furnace, _sampler
from models import WHITE_METAL, dot, ggx, lambert, phong


def verdicts(found):
    return {name for name, verdict in found.verdicts.items() if verdict.ok is not True}


def clamped(f):
    """As if its 4 n.l n.v were kept above 0.01."""
    def brdf(n, v, l):
        denominator = 4 * (n * l).sum(axis=1, keepdims=True) * (n * v).sum(axis=1, keepdims=True)
        return f(n, v, l) * denominator / np.maximum(denominator, 0.01)
    return brdf


def test_a_right_model_passes(capsys):
    found = nacre.check(ggx(0.16), against="metallic_roughness", roughness=0.4, size=64, **WHITE_METAL)
    page = capsys.readouterr().out
    assert found and str(found) in page and "FAIL" not in page
    assert found.error.max() < 1e-6 and found.values.shape == found.reference.shape
    assert found.comparison.layers["beauty"].max_abs < 1e-4
    assert found.picture().pixels.shape[0] == 64
    assert repr(found) == "<nacre.Check of brdf: ok>"  # as the last line of a notebook's cell


@pytest.mark.parametrize("wrong, hint", [
    (lambda f: lambda n, v, l: np.pi * f(n, v, l), "pi: the 1/pi"),
    (lambda f: lambda n, v, l: 4 * f(n, v, l), "4: the 1/4"),
    (lambda f: lambda n, v, l: f(n, v, l) * (n * l).sum(axis=1, keepdims=True), "n.l is not part"),
    (lambda f: lambda n, v, l: 1.25 * f(n, v, l), "times 1.25"),
    (lambda f: ggx(0.4), "alpha is the square"), (lambda f: clamped(f), "only grazing angles"),
    (lambda f: ggx(0.17), None)])
def test_wrong_models_do_not(wrong, hint):
    found = nacre.check(wrong(ggx(0.16)), against="metallic_roughness", roughness=0.4, size=32,
                        quiet=True, **WHITE_METAL)
    assert not found and "agrees" in verdicts(found)
    assert (hint in str(found)) if hint else not found.hints


def test_properties_are_judged():
    assert {"reciprocal", "energy"} <= verdicts(nacre.check(phong(1, 1.0), size=32, quiet=True))
    assert verdicts(nacre.check(lambert(0.9), size=32, quiet=True)) == set()
    assert verdicts(nacre.check(lambert(1.05), size=32, quiet=True)) == {"energy"}
    assert "positive" in verdicts(nacre.check(lambert(-0.1), size=32, quiet=True))

    def leaning(n, v, l):  # depends on the world's x axis
        return 0.1 + 0.05 * l[:, :1]
    assert "isotropic" in verdicts(nacre.check(leaning, size=32, quiet=True))


def test_single_precision_is_no_fault():
    def rounded(n, v, l):
        return ggx(0.16)(*(array.astype(np.float32) for array in (n, v, l)))
    assert nacre.check(rounded, against="metallic_roughness", roughness=0.4, size=32, quiet=True,
                       **WHITE_METAL)


def test_a_factor_n_dot_l_is_found_without_a_reference():
    found = nacre.check(lambda n, v, l: (n * l).sum(axis=1, keepdims=True) * ggx(0.16)(n, v, l), size=32,
                        quiet=True)
    assert "reciprocal" in verdicts(found) and "n.l is not part" in found.hints[0]


def test_functions_of_single_vectors_are_made_to_take_arrays():
    def one(n, v, l):
        half = (v + l) / np.linalg.norm(v + l)
        return 0.2 / np.pi + 0.1 * np.dot(n, half)**30
    with pytest.raises(ValueError) as caught:
        nacre.check(one, quiet=True)
    assert not hasattr(caught.value, "__notes__") or "np.vectorize" in caught.value.__notes__[0]
    many = np.vectorize(one, signature="(k),(k),(k)->()")
    found = nacre.check(lambda n, v, l: many(n, v, l)[:, None], size=16, quiet=True)
    assert verdicts(found) == set() and "loop over the samples" in found.hints[0]


def test_samplers_are_judged():
    gold = nacre.Brdf("conductor", preset="gold", roughness=0.4, compensation="none")

    def evaluate(n, v, l):
        return gold.evaluate(n, v, l) / (n * l).sum(axis=1, keepdims=True)
    right = nacre.Brdf(evaluate, sample=gold.sample, pdf=gold.pdf)
    assert nacre.check(right, size=32, quiet=True).verdicts["sampler"].ok
    wrong = nacre.Brdf(evaluate, sample=gold.sample, pdf=lambda n, v, l: 0.8 * gold.pdf(n, v, l))
    assert not nacre.check(wrong, size=32, quiet=True).verdicts["sampler"].ok
    assert nacre.check(gold, against=gold, size=32, quiet=True)


def test_faults_of_samplers_are_named():
    def phong(n, v, l, exponent=40):
        mirrored = 2 * (n * l).sum(axis=1, keepdims=True) * n - l
        return 0.1 * np.maximum((mirrored * v).sum(axis=1, keepdims=True), 0)**exponent

    def about_z(n, v, u):  # as if all normals were +z
        return nacre.Brdf("lambert").sample([0, 0, 1], [0, 0, 1], u)
    lambert_pdf = nacre.Brdf("lambert").pdf
    found = nacre.check(nacre.Brdf(phong, sample=about_z, pdf=lambert_pdf), size=16, quiet=True)
    assert "sampler" in verdicts(found) and "only where the normal is not +z" in str(found)

    def too_large(n, v, l):
        return 1.02 * lambert_pdf(n, v, l)
    wrong = nacre.Brdf(lambert(0.5), sample=nacre.Brdf("lambert").sample, pdf=too_large)
    found = nacre.check(wrong, size=16, quiet=True)
    assert "its pdf is 1.0200 in all, more than 1" in found.verdicts["sampler"].text


def test_faults_where_the_normal_is_up_are_not_of_turned_ones():
    own = nacre.Brdf("lambert")

    def sample(n, v, u):  # about +z where the viewer is steep
        steep = ((n * v).sum(axis=1) > 0.5)[:, None]
        return np.where(steep, own.sample([0, 0, 1], [0, 0, 1], u), own.sample(n, v, u))

    def pdf(n, v, l):  # too little where it grazes
        return np.where((n * v).sum(axis=1) > 0.5, 1, 0.8) * own.pdf(n, v, l)
    found = nacre.check(nacre.Brdf(lambert(0.5), sample=sample, pdf=pdf), size=16, quiet=True)
    assert "sampler" in verdicts(found) and "only where" not in str(found)


@pytest.mark.parametrize("roughness, alone", [(0.02, True), (0.01, False), (0.005, False)])
def test_narrow_samplers_are_right(roughness, alone):
    gold = nacre.Brdf("conductor", preset="gold", roughness=roughness, compensation="none")

    def evaluate(n, v, l):
        return gold.evaluate(n, v, l) / (n * l).sum(axis=1, keepdims=True)
    mine = gold if alone else nacre.Brdf(evaluate, sample=gold.sample, pdf=gold.pdf)
    cosines = np.cos(np.radians([0.5, 70, 80, 85, 88]))
    furnace = _furnace(mine, cosines)
    for integral, albedo in zip(furnace, gold.albedo(cosines)):
        assert integral.at_most_one() and integral.spread <= _ENERGY / 4
        assert np.abs(integral.value - albedo).max() < _ENERGY / 4
    assert _sampler(mine, cosines, furnace).ok

    def too_large(n, v, l):
        return 1.02 * gold.pdf(n, v, l)
    wrong = nacre.Brdf(evaluate, sample=gold.sample, pdf=too_large)
    found = _sampler(wrong, cosines, furnace)
    assert found.ok is False and "pdf is 1.0200 in all" in found.text


def needle(n, v, l):
    """Of 1e-12 sr about the mirror direction: rules meet it or do not."""
    mirrored = 2 * dot(n, v)[:, None] * n - v
    return (3e12 / np.pi * (((l - mirrored)**2).sum(axis=1) < 1e-12 / 3))[:, None]


def test_what_is_too_narrow_is_unknown():
    own = nacre.Brdf("lambert")
    narrow = nacre.Brdf(needle, sample=own.sample, pdf=lambda n, v, l: needle(n, v, l)[:, 0])
    found = nacre.check(narrow, size=16, quiet=True)
    assert not found and found.verdicts["energy"].ok is None and found.verdicts["sampler"].ok is None
    assert "cannot be told at 0, " in found.verdicts["energy"].text
    assert "unknown  energy" in str(found) and "unknown: energy, sampler" in repr(found)


def bright(n, v, l):
    """GGX whose shadowing terms are factors where they are divisors: the integral has no end."""
    half = (v + l) / np.linalg.norm(v + l, axis=1, keepdims=True)
    d = 0.0256 / (np.pi * (dot(n, half)**2 * (0.0256 - 1) + 1)**2)
    g = [1 + np.sqrt(1 + 0.0256 * (1 / dot(n, x)**2 - 1)) for x in (v, l)]
    return (d * g[0] * g[1] / (4 * dot(n, v) * dot(n, l)))[:, None]


@pytest.mark.parametrize("model, ok, text", [
    (bright, False, "it has no end"),
    (lambda n, v, l: 0.01 * bright(n, v, l), None, "denser rules do not agree"),  # albedos of 0.04
    (lambda n, v, l: (1 / dot(n, l)**3)[:, None], False, "it has no end"),  # albedos of 1e6 and more
    (lambda n, v, l: (1e-3 / dot(n, l)**2)[:, None], None, "denser rules do not agree"),
    (lambda n, v, l: np.full((len(n), 1), 1e308), False, "reflects up to inf"),
    (lambert(1.0011), False, "reflects up to 1.0011"), (lambert(1), True, "reflects up to 1.0000"),
    (ggx(1e-4), True, "reflects up to 1.0000"),  # which one rule alone makes 1.02
    (lambda n, v, l: 0.2 + 0.1 * (dot(n, l) > 0.5)[:, None], True, "reflects up to 0.8")])  # edges
def test_integrals_that_do_not_settle_are_no_success(model, ok, text):
    found = nacre.check(model, size=16, quiet=True)
    assert found.verdicts["energy"].ok is ok and text in found.verdicts["energy"].text
    assert bool(found) is (ok is True and all(verdict.ok for verdict in found.verdicts.values()))


def only_where(condition, value):
    """A grey Lambert but for some directions."""
    return lambda n, v, l: np.where(condition(n, v, l), value, 0.1)[:, None]


@pytest.mark.parametrize("model, where", [
    (only_where(lambda n, v, l: dot(v, l) > 1 - 1e-15, np.nan), "phi 0 "),  # light and viewer are one
    (only_where(lambda n, v, l: dot(2 * dot(n, v)[:, None] * n - v, l) > 1 - 1e-15, np.inf), "[inf]"),
    (only_where(lambda n, v, l: dot(n, v) == 1, -np.inf), "viewer 0,"),  # seen straight from above
    (only_where(lambda n, v, l: dot(n, l) < 1e-4, np.nan), "light 90,"),  # at the horizon
    (only_where(lambda n, v, l: n[:, 2] < 0.9, np.nan), "normal [0."),  # of other normals alone
    (lambda n, v, l: np.array([0.1, np.nan, 0.1]) * np.ones((len(n), 1)), "[0.1, nan, 0.1] at light 0.5")])
def test_what_is_not_finite_is_a_failure_with_a_page(model, where, capsys):
    found = nacre.check(model, size=16)
    verdict = found.verdicts["finite"]
    assert not found and verdict.ok is False and where in verdict.text and "to_light [" in verdict.text
    assert "FAIL     finite" in capsys.readouterr().out
    assert np.isfinite(found.values).all() and found.verdicts["energy"].ok  # the rest is judged


def test_where_nothing_is_finite_nothing_is_known():
    found = nacre.check(lambda n, v, l: np.full((len(n), 3), np.nan), size=16, quiet=True)
    assert found.verdicts.pop("finite").ok is False
    assert {verdict.ok for verdict in found.verdicts.values()} == {None}


@pytest.mark.parametrize("model, name", [
    (only_where(lambda n, v, l: (dot(n, l) < 0.02) & (dot(n, v) > 0.99), -1e-9), "positive"),  # off the grid
    (lambda n, v, l: np.full((len(n), 1), -1), "positive"),  # of integers
    (lambda n, v, l: (0.1 + 1e-3 * dot(n, l))[:, None], "reciprocal"),
    (lambda n, v, l: (0.1 + 1e-3 * l[:, 1])[:, None], "isotropic"),
    (lambda n, v, l: np.array([0.1, 0.1, 0.1 + 0.4]) * np.ones((len(n), 1)), "energy")])  # blue alone
def test_each_property_can_fail(model, name):
    found = nacre.check(model, size=16, quiet=True)
    assert found.verdicts[name].ok is False and not found


def test_the_albedo_that_a_function_tells_is_its_integral():
    def says(albedo):
        return nacre.check(nacre.Brdf(lambert(1.5), albedo=lambda c: np.full((len(c), 3), albedo)), size=16,
                           quiet=True)
    wrong = says(0.5)  # it makes light, whatever it says
    assert verdicts(wrong) == {"energy", "albedo"} and "0.5000" in wrong.verdicts["albedo"].text
    assert verdicts(says(1.5)) == {"energy"}
    assert "returned" in says(np.nan).verdicts["albedo"].text


LAMBERT = nacre.Brdf("lambert")


def uniform(n, v, u):
    """All of the hemisphere about the normal alike."""
    z, phi = u[:, :1], 2 * np.pi * u[:, 1:]
    side = np.cross(n, np.where(np.abs(n[:, :1]) < 0.6, [1.0, 0, 0], [0.0, 1, 0]))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    return z * n + np.sqrt(1 - z * z) * (np.cos(phi) * side + np.sin(phi) * np.cross(n, side))


def hemisphere_pdf(n, v, l):
    return np.full(len(n), 1 / (2 * np.pi))


@pytest.mark.parametrize("model, sample, pdf, text", [
    (lambert(0.5), uniform, hemisphere_pdf, None),
    (lambert(0.5), LAMBERT.sample, LAMBERT.pdf, None),
    # f / pdf is the same for all samples: their mean is right, wherever they are.
    (lambert(0.5), uniform, LAMBERT.pdf, "more or less steep"),
    (lambert(0.5), LAMBERT.sample, hemisphere_pdf, "samples mean"),
    (lambert(0.5), uniform, lambda n, v, l: 2 * hemisphere_pdf(n, v, l), "its pdf is 2.0000 in all"),
    (lambert(0.5), uniform, lambda n, v, l: 0.5 * hemisphere_pdf(n, v, l), "more or fewer are above"),
    (lambert(0.5), uniform, lambda n, v, l: dot(n, l) - 0.1, "below 0"),
    (lambert(0.5), uniform, lambda n, v, l: np.where(dot(n, l) > 0.5, np.nan, 0.1), "nan"),
    (lambert(0.5), uniform, lambda n, v, l: np.full((len(n), 1), 0.1), "returned the shape"),
    (lambert(0.5), uniform, lambda n, v, l: hemisphere_pdf(n, v, l) * (dot(n, l) > 0.1), "samples have pdf 0"),
    (lambert(0.5), lambda n, v, u: -uniform(n, v, u), hemisphere_pdf, "more or fewer are above"),
    (lambert(0.5), lambda n, v, u: 1.1 * uniform(n, v, u), hemisphere_pdf, "has length 1.1"),
    (lambert(0.5), lambda n, v, u: np.nan * n, hemisphere_pdf, "has length nan"),
    (lambert(0.5), lambda n, v, u: 1j * n, hemisphere_pdf, "complex128")])
def test_samplers_and_pdfs_that_do_not_fit_are_told(model, sample, pdf, text):
    found = nacre.check(nacre.Brdf(model, sample=sample, pdf=pdf), size=16, quiet=True)
    verdict = found.verdicts["sampler"]
    assert verdict.ok is (text is None) and (text is None or text in verdict.text), verdict


@pytest.mark.parametrize("reference, text", [
    (only_where(lambda n, v, l: dot(n, l) < 0.1, np.nan), "the reference is not finite"),
    (lambert(-0.1 * np.pi), "differs by"),  # relative to a magnitude, not a negative number
    (lambert(0), "differs by inf")])
def test_references_that_are_wrong_agree_with_nothing(reference, text):
    for model in lambert(0.1 * np.pi), lambert(-0.3):
        found = nacre.check(model, against=reference, size=16, quiet=True)
        assert found.verdicts["agrees"].ok is False and text in found.verdicts["agrees"].text


@pytest.mark.parametrize("returned", [
    lambda n: np.ones((len(n), 3), complex), lambda n: np.ones((len(n), 2)), lambda n: np.ones(3),
    lambda n: "white", lambda n: np.ma.masked_array(np.ones((len(n), 3)), mask=True)])
def test_what_is_no_brdf_at_all_is_an_error(returned):
    with pytest.raises(nacre.Error, match="the BRDF <lambda>: returned"):
        nacre.check(lambda n, v, l: returned(n), size=16, quiet=True)


def test_what_makes_light_is_named():
    bright = nacre.check(lambert(1.5), size=16, quiet=True)
    assert verdicts(bright) == {"energy"} and "at all angles" in bright.hints[0]

    def without_shadowing(n, v, l):
        half = (v + l) / np.linalg.norm(v + l, axis=1, keepdims=True)
        n_l, n_v, n_h = ((n * x).sum(axis=1, keepdims=True) for x in (l, v, half))
        return 42 / (2 * np.pi) * n_h**40 / (4 * n_l * n_v)
    lobe = nacre.check(without_shadowing, size=16, quiet=True)
    assert "energy" in verdicts(lobe) and "shadowing term" in lobe.hints[0]


def test_functions_are_compared():
    assert nacre.check(lambert(0.5), against=lambert(0.5), size=16, quiet=True)
    found = nacre.check(lambert(0.5), against=lambert(0.25), size=16, quiet=True)
    assert verdicts(found) == {"agrees"} and found.hints == ["it is the other times 2"]


def test_errors_come_out():
    with pytest.raises(ZeroDivisionError):
        nacre.check(lambda n, v, l: 1 / 0)
    with pytest.raises(TypeError, match="parameters"):
        nacre.check(lambert(0.5), roughness=1)
    with pytest.raises(nacre.Error, match="did you mean"):
        nacre.check(lambert(0.5), against="conductr")
