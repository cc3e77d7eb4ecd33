# SPDX-License-Identifier: Apache-2.0
"""Right and wrong reflection models, checked."""
import numpy as np
import pytest

import nacre
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
