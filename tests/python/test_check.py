# SPDX-License-Identifier: Apache-2.0
"""Right and wrong reflection models, checked."""
import numpy as np
import pytest

import nacre
from nacre._check import _furnace, _sampler
from models import WHITE_METAL, ggx, lambert, phong


def verdicts(found):
    return {name for name, verdict in found.verdicts.items() if not verdict.ok}


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
    furnace, settled = _furnace(mine, cosines)
    assert settled.all() and np.abs(furnace - gold.albedo(cosines)).max() < 2.5e-4  # _ENERGY / 4
    found = _sampler(mine, cosines, furnace, settled)
    assert found.ok and "narrow" not in found.text

    def too_large(n, v, l):
        return 1.02 * gold.pdf(n, v, l)
    wrong = nacre.Brdf(evaluate, sample=gold.sample, pdf=too_large)
    found = _sampler(wrong, cosines, furnace, settled)
    assert not found.ok and "pdf is 1.0200 in all" in found.text


def test_what_is_too_narrow_is_not_judged():
    def needle(n, v, l):  # of some 1e-9 sr about the mirror direction: no rule meets it
        mirrored = 2 * (n * v).sum(axis=1, keepdims=True) * n - v
        distance = ((l - mirrored)**2).sum(axis=1)
        return 3e8 / np.pi * (distance < 1e-8 / 3)
    own = nacre.Brdf("lambert")
    cosines = np.cos(np.radians([30, 60]))
    narrow = nacre.Brdf(lambda n, v, l: needle(n, v, l)[:, None], sample=own.sample, pdf=needle)
    furnace, settled = _furnace(narrow, cosines)
    assert not settled.any()
    found = _sampler(narrow, cosines, furnace, settled)
    assert found.ok and "too narrow to tell at 30, 60 degrees" in found.text


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
    with pytest.raises(nacre.Error, match="returned"):
        nacre.check(lambda n, v, l: np.full((len(n), 3), np.nan))
    with pytest.raises(TypeError, match="parameters"):
        nacre.check(lambert(0.5), roughness=1)
    with pytest.raises(nacre.Error, match="did you mean"):
        nacre.check(lambert(0.5), against="conductr")
