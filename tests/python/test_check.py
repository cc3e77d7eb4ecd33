# SPDX-License-Identifier: Apache-2.0
"""Right and wrong reflection models, checked."""
import numpy as np
import pytest

import nacre
from models import WHITE_METAL, ggx, lambert, phong


def verdicts(found):
    return {name for name, verdict in found.verdicts.items() if not verdict.ok}


def test_a_right_model_passes(capsys):
    found = nacre.check(ggx(0.16), against="metallic_roughness", roughness=0.4, size=64, **WHITE_METAL)
    page = capsys.readouterr().out
    assert found and str(found) in page and "FAIL" not in page
    assert found.error.max() < 1e-6 and found.values.shape == found.reference.shape
    assert found.comparison.layers["beauty"].max_abs < 1e-4
    assert found.picture().pixels.shape[0] == 64


@pytest.mark.parametrize("wrong, hint", [
    (lambda f: lambda n, v, l: np.pi * f(n, v, l), "pi: the 1/pi"),
    (lambda f: lambda n, v, l: 4 * f(n, v, l), "4: the 1/4"),
    (lambda f: lambda n, v, l: f(n, v, l) * (n * l).sum(axis=1, keepdims=True), "without it"),
    (lambda f: lambda n, v, l: 1.25 * f(n, v, l), "times 1.25"),
    (lambda f: ggx(0.17), None)])
def test_wrong_models_do_not(wrong, hint):
    found = nacre.check(wrong(ggx(0.16)), against="metallic_roughness", roughness=0.4, size=32,
                        quiet=True, **WHITE_METAL)
    assert not found and "agrees" in verdicts(found)
    assert (hint in str(found)) if hint else not found.hints


def test_properties_are_judged():
    assert {"reciprocal", "energy"} <= verdicts(nacre.check(phong(1, 1.0), size=32, quiet=True))
    assert verdicts(nacre.check(lambert(0.9), size=32, quiet=True)) == set()
    assert "positive" in verdicts(nacre.check(lambert(-0.1), size=32, quiet=True))

    def leaning(n, v, l):  # depends on the world's x axis
        return 0.1 + 0.05 * l[:, :1]
    assert "isotropic" in verdicts(nacre.check(leaning, size=32, quiet=True))


def test_samplers_are_judged():
    gold = nacre.Brdf("conductor", preset="gold", roughness=0.4, compensation="none")

    def evaluate(n, v, l):
        return gold.evaluate(n, v, l) / (n * l).sum(axis=1, keepdims=True)
    right = nacre.Brdf(evaluate, sample=gold.sample, pdf=gold.pdf)
    assert nacre.check(right, size=32, quiet=True).verdicts["sampler"].ok
    wrong = nacre.Brdf(evaluate, sample=gold.sample, pdf=lambda n, v, l: 0.8 * gold.pdf(n, v, l))
    assert not nacre.check(wrong, size=32, quiet=True).verdicts["sampler"].ok
    assert nacre.check(gold, against=gold, size=32, quiet=True)


def test_errors_come_out():
    with pytest.raises(nacre.Error, match="returned"):
        nacre.check(lambda n, v, l: np.full((len(n), 3), np.nan))
    with pytest.raises(TypeError, match="parameters"):
        nacre.check(lambert(0.5), roughness=1)
    with pytest.raises(nacre.Error, match="did you mean"):
        nacre.check(lambert(0.5), against="conductr")
