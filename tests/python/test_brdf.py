# SPDX-License-Identifier: Apache-2.0
"""Reflection models over arrays."""
import numpy as np
import pytest

import nacre
from conftest import not_sanitized
from models import WHITE_METAL, ggx, lambert

UP = [0.0, 0, 1]


def directions(count, seed=1):
    rng = np.random.default_rng(seed)
    v = rng.normal(size=(count, 3))
    v[:, 2] = np.abs(v[:, 2])
    return v / np.linalg.norm(v, axis=1, keepdims=True)


MODELS = [("lambert", {}), ("phong", {"shininess": 30}), ("conductor", {"preset": "gold"}),
          ("dielectric", {"roughness": 0.3}),
          ("metallic_roughness", {"metallic": 0.5, "coat": 0.8, "coat_roughness": 0.3, "sheen_color": 0.5,
                                  "sheen_roughness": 0.4})]


def test_lambert_is_albedo_over_pi_times_the_cosine():
    light = directions(100)
    value = nacre.Brdf("lambert", albedo=[0.2, 0.4, 0.6]).evaluate(UP, UP, light)
    assert value.shape == (100, 3) and value.dtype == np.float64
    assert np.allclose(value, np.array([0.2, 0.4, 0.6]) / np.pi * light[:, 2:], rtol=1e-14)


@pytest.mark.parametrize("model, parameters", MODELS)
def test_kernels_agree_with_formulas(model, parameters):
    brdf = nacre.Brdf(model, **parameters)
    view, light = directions(1000), directions(1000, 2)
    exact, fast = brdf.evaluate(UP, view, light), brdf.evaluate(UP, view, light, exact=False)
    assert fast.dtype == np.float32
    assert np.allclose(exact, fast, rtol=2e-4, atol=1e-6)
    diffuse, specular = brdf.evaluate(UP, view, light, components=True)
    assert np.array_equal(diffuse + specular, exact)
    diffuse, specular = brdf.evaluate(UP, view[::-1], light, exact=False, components=True)
    assert np.array_equal(diffuse + specular, brdf.evaluate(UP, view[::-1], light, exact=False))


@pytest.mark.parametrize("model, parameters", MODELS)
def test_many_rows_are_those_of_few(model, parameters):
    """Kernels take 50 000 rows at a time; each row is that which it is among others."""
    brdf, count = nacre.Brdf(model, **parameters), 120_001
    normal, view, light = directions(count, 3), directions(count), directions(count, 2)
    some = [0, 1, 4999, 49_998, 49_999, 50_000, 50_001, 75_000, 99_999, 100_000, 100_001, count - 1]
    whole = brdf.evaluate(normal, view, light, exact=False)
    parts = brdf.evaluate(normal, view, light, exact=False, components=True)
    assert np.array_equal(parts[0] + parts[1], whole)
    few = brdf.evaluate(normal[some], view[some], light[some], exact=False, components=True)
    for part, rows in zip(parts, few):
        assert part.shape == (count, 3) and part.dtype == np.float32
        assert np.array_equal(part[some], rows)
    exact = brdf.evaluate(normal[some], view[some], light[some], components=True)
    for rows, right in zip(few, exact):
        assert np.allclose(rows, right, rtol=1e-3, atol=1e-6)  # as kernels agree with formulas
    # Of arrays of any type, strides and shape.
    flat = (normal, np.asfortranarray(view), np.repeat(light, 2, axis=0)[::2])
    for given, shape in (flat, (count, 3)), ([v[:120_000].reshape(300, 400, 3) for v in flat], (300, 400, 3)):
        for part, right in zip(brdf.evaluate(*given, exact=False, components=True), parts):
            assert part.shape == shape and np.array_equal(part.reshape(-1, 3), right[:part.size // 3])
    single = brdf.evaluate(*(v.astype(np.float32) for v in flat), exact=False, components=True)
    doubles = brdf.evaluate(*(v.astype(np.float32).astype(float) for v in flat), exact=False, components=True)
    assert all(np.array_equal(a, b) for a, b in zip(single, doubles))
    one = brdf.evaluate(UP, view, UP, exact=False, components=True)
    rows = brdf.evaluate([UP], view[some], [UP], exact=False, components=True)
    assert all(np.array_equal(a[some], b) for a, b in zip(one, rows))


def test_many_albedos_are_those_of_few():
    """They are computed 256 at a time."""
    brdf, cosines = nacre.Brdf("conductor", preset="gold", roughness=0.3), np.linspace(0.01, 1, 600)
    whole, some = brdf.albedo(cosines), [0, 1, 254, 255, 256, 257, 511, 512, 599]
    assert np.array_equal(whole[some], np.concatenate([brdf.albedo(cosines[[i]]) for i in some]))
    assert len(np.unique(whole[:, 0])) > 500 and np.array_equal(brdf.albedo(cosines.reshape(2, 300)).reshape(-1, 3), whole)


def test_components_of_a_function_are_its_own():
    """Without a sampler it is all diffuse, with one all specular."""
    own = nacre.Brdf("lambert")
    view, light = directions(60_000), directions(60_000, 2)
    plain, sampled = nacre.Brdf(ggx(0.16)), nacre.Brdf(ggx(0.16), sample=own.sample, pdf=own.pdf)
    whole = plain.evaluate(UP, view, light)
    for brdf, place in (plain, 0), (sampled, 1):
        parts = brdf.evaluate(UP, view, light, components=True)
        assert np.array_equal(parts[place], whole) and not parts[1 - place].any()


def test_shapes_broadcast():
    brdf = nacre.Brdf("conductor", preset="gold", roughness=0.2)
    view, light = directions(4).reshape(4, 1, 3), directions(5, 2)
    value = brdf.evaluate(UP, view, light)
    assert value.shape == (4, 5, 3)
    assert np.array_equal(value[2, 3], brdf.evaluate(UP, view[2, 0], light[3]))
    assert brdf.evaluate(UP, UP, UP).shape == (3,)
    assert brdf.evaluate(np.zeros((0, 3)), UP, UP).shape == (0, 3)
    assert brdf.pdf(UP, view, light).shape == (4, 5)
    assert brdf.albedo([[1, 0.5]]).shape == (1, 2, 3) and brdf.albedo(0.5).shape == (3,)
    assert brdf.sample(UP, view, np.zeros((4, 7, 2))).shape == (4, 7, 3)
    assert brdf.terms(UP, view, light)["F"].shape == (4, 5, 3)


@pytest.mark.parametrize("change", [
    lambda v: v.astype(np.float32), lambda v: v[::-1][::-1], lambda v: np.asfortranarray(v),
    lambda v: v.tolist(), lambda v: np.repeat(v, 2, axis=0)[::2],
    lambda v: v.astype(v.dtype.newbyteorder())])
def test_arrays_may_have_any_type_and_strides(change):
    brdf = nacre.Brdf("dielectric", roughness=0.4)
    view, light = directions(20), directions(20, 2)
    view.setflags(write=False)
    got = brdf.evaluate(UP, change(view), light)
    assert np.allclose(got, brdf.evaluate(UP, view, light), rtol=1e-4)


@pytest.mark.parametrize("wrong, error", [
    ([0, 0, 2.0], nacre.Error), ([np.nan, 0, 1], nacre.Error), ([np.inf, 0, 1], nacre.Error),
    ([[0, 0, 0.0]], nacre.Error), ([0, 1], ValueError), (1.0, ValueError), ("abc", TypeError),
    (["a", "b", "c"], TypeError), ([0, 0, 1j], TypeError), (None, TypeError),
    (np.ones((2, 3)) / 3**.5, None), (np.ones((4, 3)) / 3**.5, ValueError)])
def test_what_is_no_direction_is_refused(wrong, error):
    for brdf in nacre.Brdf("lambert"), nacre.Brdf(lambert(0.5)):
        if error is None:
            brdf.evaluate(UP, wrong, np.ones((2, 3)) / 3**.5)
            continue
        for arguments in ((wrong, UP, UP), (UP, wrong, np.array([UP, UP])), (UP, UP, wrong)):
            if error is ValueError and np.shape(wrong) == (4, 3):
                arguments = (UP, wrong, np.array([UP, UP]))
            with pytest.raises(error):
                brdf.evaluate(*arguments)


def test_the_wrong_vector_is_named():
    wrong = directions(60_000)
    wrong[54_321] *= 2
    for exact in True, False:
        with pytest.raises(nacre.Error, match="to_view 54321 "):
            nacre.Brdf("lambert").evaluate(UP, wrong, UP, exact=exact)


def test_a_function_returns_finite_numbers():
    def brdf(n, v, l):
        return np.where(l[:, 2:] < 0.5, np.nan, 1)
    with pytest.raises(nacre.Error, match="returned .nan, nan, nan. for sample 1 of 2"):
        nacre.Brdf(brdf).evaluate(UP, UP, [[0, 0, 1], [np.sqrt(0.84), 0, 0.4]])


def test_rows_of_different_lengths_are_refused():
    for brdf in nacre.Brdf("lambert"), nacre.Brdf(lambert(0.5)):
        with pytest.raises(ValueError, match="to_view is no array"):
            brdf.evaluate(UP, [[0, 0, 1], [0, 1]], UP)
    with pytest.raises(nacre.Error, match="returned no array"):
        nacre.Brdf(lambda n, v, l: [[1, 2, 3], [4]]).evaluate(UP, UP, UP)


def test_models_and_parameters_are_checked():
    with pytest.raises(nacre.Error, match='did you mean "conductor"'):
        nacre.Brdf("conductr")
    with pytest.raises(nacre.Error, match="roughness"):
        nacre.Brdf("conductor", roughness=2)
    for wrong in (lambda: nacre.Brdf(7), lambda: nacre.Brdf("lambert", sample=lambert),
                  lambda: nacre.Brdf(lambert(1), albedo_=1),
                  lambda: nacre.Brdf(lambert(1), sample=lambert(1))):
        with pytest.raises(TypeError):
            wrong()
    with pytest.raises(nacre.Error, match="microfacet"):
        nacre.Brdf("lambert").terms(UP, UP, UP)
    for brdf in nacre.Brdf("lambert"), nacre.Brdf(lambert(1)):
        for cosine in 0, -1, 1.5, np.nan:
            with pytest.raises(nacre.Error):
                brdf.albedo(cosine)
        for wrong in None, "a":
            with pytest.raises(TypeError):
                brdf.albedo(wrong)
        for points in [1.0, 0], [-0.1, 0], [np.nan, 0]:
            with pytest.raises(nacre.Error, match="point 0"):
                brdf.sample(UP, UP, points)


def test_the_material_of_a_scene(scenes):
    scene = nacre.Scene.from_file(scenes / "first_scene.json")
    brdf = nacre.Brdf.from_scene(scene, "red")
    same = nacre.Brdf("metallic_roughness", base_color=[0.8, 0.1, 0.08], roughness=0.3)
    light = directions(10)
    assert np.array_equal(brdf.evaluate(UP, UP, light), same.evaluate(UP, UP, light))
    with pytest.raises(nacre.Error, match="unknown material"):
        nacre.Brdf.from_scene(scene, "blue")


def test_a_lobe_is_the_product_of_its_terms():
    brdf = nacre.Brdf("metallic_roughness", roughness=0.4, **WHITE_METAL)
    view, light = directions(100), directions(100, 2)
    t = brdf.terms(UP, view, light)
    lobe = (t["D"] * t["G"] / (4 * view[:, 2]))[:, None] * t["F"]
    assert np.allclose(lobe, brdf.evaluate(UP, view, light), rtol=1e-13)
    g1 = 1 / (1 + t["lambda_view"]) / (1 + t["lambda_light"])
    assert np.allclose(t["G"], g1, rtol=1e-13)


@pytest.mark.parametrize("model, parameters", MODELS)
def test_samples_reflect_the_albedo(model, parameters):
    brdf = nacre.Brdf(model, **parameters)
    view = [0.6, 0, 0.8]
    light = brdf.sample(UP, view, np.random.default_rng(5).random((40000, 2)))
    assert np.allclose(np.linalg.norm(light, axis=1), 1, atol=1e-6)
    f, pdf = brdf.evaluate(UP, view, light)[:, 1], brdf.pdf(UP, view, light)
    weight = np.where(f > 0, f / np.where(pdf > 0, pdf, 1), 0)
    assert abs(weight.mean() - brdf.albedo(0.8)[1]) < 5 * weight.std() / 200 + 1e-3


def test_a_function_is_a_model():
    mine, other = nacre.Brdf(ggx(0.16)), nacre.Brdf("metallic_roughness", roughness=0.4, **WHITE_METAL)
    view, light = directions(500), directions(500, 2)
    assert np.allclose(mine.evaluate(UP, view, light), other.evaluate(UP, view, light), rtol=1e-9)
    assert (mine.evaluate(UP, view, -light) == 0).all()
    cosines = np.array([1, 0.7, 0.3, 0.05])
    assert np.allclose(mine.albedo(cosines), other.albedo(cosines), atol=2e-4)
    assert np.allclose(nacre.Brdf(lambert(0.5)).albedo(cosines), 0.5, atol=1e-4)
    points = np.random.default_rng(5).random((1000, 2))
    cosine_law = nacre.Brdf("lambert")
    assert np.array_equal(mine.sample(UP, UP, points), cosine_law.sample(UP, UP, points))
    assert np.array_equal(mine.pdf(UP, view, light), cosine_law.pdf(UP, view, light))


def test_functions_may_write_to_their_arrays():
    def brdf(n, v, l):
        l *= 2
        return np.full((len(n), 3), 0.5)
    light = np.asfortranarray(directions(5))
    kept = light.copy()
    assert np.allclose(nacre.Brdf(brdf).evaluate(UP, UP, light), 0.5 * light[:, 2:])
    assert np.array_equal(light, kept)


@not_sanitized
def test_memory_is_flat():
    def resident():
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * 4096
    brdf = nacre.Brdf("conductor", preset="gold")
    view, light = directions(500), directions(500, 2)
    before = 0
    for i in range(10_000):
        brdf.evaluate(UP, view, light, exact=False)
        if i == 1000:
            before = resident()
    # A leak of one result a call would be 54 MB.
    assert resident() - before < 8_000_000
