# SPDX-License-Identifier: Apache-2.0
"""Renders of the user's own reflection model."""
import threading

import numpy as np
import pytest

import nacre
from models import WHITE_METAL, ggx, lambert

LIGHTS = {
    "point": {"type": "point", "position": [4, 4, 5], "intensity": 80},
    "sun": {"type": "directional", "direction_of_travel": [-1, -1, -1], "irradiance": 3},
    "disk": {"type": "disk", "center": [3, 3, 3], "facing": [-1, -1, -1], "radius": 1, "radiance": 10},
    "sky": {"type": "environment", "gradient": {"zenith": 2, "horizon": 1, "ground": 0.1}}}


def spheres(light):
    scene = nacre.Scene()
    scene.set_camera(position=(0, 1, 6), fov_y_deg=35)
    scene.add_light("light", **LIGHTS[light])
    scene.add_spheres([[-0.6, 0, 0], [1.2, 0.6, 0.8]], [1, 0.5], "ball")
    return scene


def render(light, model, samples=4, **parameters):
    scene = spheres(light)
    scene.add_material("ball", model, **parameters)
    return scene.render(width=48, height=36, samples=samples)["beauty"]


@pytest.mark.parametrize("light", LIGHTS)
def test_a_function_is_rendered_as_the_model_that_it_is(light):
    samples = 4 if light in ("point", "sun") else 64
    mine = render(light, ggx(0.36), samples)
    other = render(light, "metallic_roughness", samples, roughness=0.6, **WHITE_METAL)
    if samples == 4:
        assert np.abs(mine - other).max() < 2e-5 * other.mean()
    else:  # different directions: noise
        assert abs(mine.mean() / other.mean() - 1) < 0.02


def test_layers_and_what_ambient_light_sees_are_the_rest():
    scene = spheres("point")
    scene.add_material("ball", lambert(0.5), rest="metallic_roughness", coat=1, coat_roughness=0.3,
                       base_color=0.25)
    image = scene.render(width=48, height=36, samples=1, layers="all")
    assert image["specular"].max() > 0 and abs(image["albedo"].max() - 0.25) < 1e-6
    assert scene["/materials/ball/coat"] == 1
    with nacre.Session(scene) as session:
        again = session.render(width=48, height=36, samples=1)
        assert np.array_equal(again["beauty"], image["beauty"])


def test_a_sampler_is_used():
    brdf = nacre.Brdf("conductor", preset="gold", roughness=0.3)
    asked = set()

    def evaluate(n, v, l):
        return brdf.evaluate(n, v, l) / (n * l).sum(axis=1, keepdims=True)

    def sample(n, v, u):
        asked.add(u.shape[1])
        return brdf.sample(n, v, u)
    mine = nacre.Brdf(evaluate, sample=sample, pdf=brdf.pdf)
    got = render("sky", mine, 64)
    expected = render("sky", "conductor", 64, preset="gold", roughness=0.3)
    assert asked == {2} and abs(got.mean() / expected.mean() - 1) < 0.02
    assert np.sqrt(((got - expected)**2).mean()) < 0.05 * expected.mean()


def test_functions_are_called_one_at_a_time():
    busy, clashes, sizes, large = threading.Lock(), [], [], np.ones(500_000)

    def brdf(n, v, l):
        if not busy.acquire(blocking=False):
            clashes.append(1)
        sizes.append(len(n))
        np.sqrt(large, out=large)  # numpy lets go of the interpreter
        assert n.shape == v.shape == l.shape == (len(n), 3) and n.dtype == np.float64
        busy.release()
        return np.full((len(n), 1), 0.3)
    scene = spheres("point")
    scene.add_material("ball", brdf)
    scene.render(width=320, height=240, samples=4, threads=4)
    assert not clashes and np.median(sizes) > 200


def test_arrays_may_be_kept():
    kept = []

    def brdf(n, v, l):
        kept.append((n, v, l))
        return np.full((len(n), 3), 0.3)
    render("point", brdf)
    for vectors in kept:
        for array in vectors:
            assert np.allclose((array * array).sum(axis=1), 1, atol=1e-6)


@pytest.mark.parametrize("result, text", [
    (lambda n: np.full((n, 3), np.nan), "material \"ball\": its function returned nan for sample 0 of"),
    (lambda n: np.full((n, 3), np.inf), "returned inf"),
    (lambda n: np.ones(n), "returned the shape"), (lambda n: np.ones((n, 2)), "value[:, None]"),
    (lambda n: np.ones((3, n)), "returned the shape"), (lambda n: None, "not of real numbers"),
    (lambda n: np.ones((n, 3), complex), "complex"), (lambda n: "abc", "not of real numbers")])
def test_wrong_results_are_told(result, text):
    with pytest.raises(nacre.Error) as caught:
        render("point", lambda n, v, l: result(len(n)))
    assert text in str(caught.value)


def test_what_a_function_raises_comes_out():
    def brdf(n, v, l):
        raise ZeroDivisionError("mine")
    with pytest.raises(ZeroDivisionError, match="mine"):
        render("sky", brdf)
    with pytest.raises(TypeError):
        render("point", lambda n: n)


def test_wrong_samplers_are_told():
    brdf = nacre.Brdf(lambert(0.5), sample=lambda n, v, u: 2 * n, pdf=lambda n, v, l: np.ones(len(n)))
    with pytest.raises(nacre.Error, match="sampler returned"):
        render("sky", brdf)
    brdf = nacre.Brdf(lambert(0.5), sample=lambda n, v, u: n, pdf=lambda n, v, l: -np.ones(len(n)))
    with pytest.raises(nacre.Error, match="its pdf is -1"):
        render("sky", brdf)


def test_functions_may_render():
    inner = spheres("point")
    inner.add_material("ball", lambert(0.5))

    def brdf(n, v, l):
        inner.render(width=8, height=6)
        return np.full((len(n), 1), 0.3)

    def waiting(n, v, l):
        thread = threading.Thread(target=brdf, args=(n, v, l))
        thread.start()
        thread.join()
        return np.full((len(n), 1), 0.3)
    expected = render("point", lambert(0.3))
    assert np.allclose(render("point", brdf), np.pi * expected, rtol=1e-5)
    assert np.isclose(render("point", waiting, samples=1).max(), np.pi * expected.max(), rtol=0.1)


def small(model):
    scene = spheres("point")
    scene.add_material("ball", model)
    return lambda **settings: scene.render(width=8, height=6, samples=1, **settings)


def test_functions_may_render_beside_many_renders():
    inner = small(lambert(0.5))

    def brdf(n, v, l):
        inner()
        return np.full((len(n), 1), 0.3)
    many, begun, end = 64, threading.Semaphore(0), threading.Event()

    def wait(share):
        begun.release()
        end.wait()
    threads = [threading.Thread(target=inner, kwargs={"progress": wait}) for _ in range(many)]
    for thread in threads:
        thread.start()
    try:
        for _ in threads:
            assert begun.acquire(timeout=60)
        assert small(brdf)()["beauty"].max() > 0
    finally:
        end.set()
        for thread in threads:
            thread.join()


def test_functions_that_render_themselves_are_told():
    def brdf(n, v, l):
        render()
        return np.full((len(n), 1), 0.3)
    render = small(brdf)
    with pytest.raises(nacre.Error, match="64 renders wait for functions that render"):
        render()


def test_models_of_nacre_are_materials():
    gold = nacre.Brdf("conductor", preset="gold", roughness=0.3)
    assert np.array_equal(render("sky", gold), render("sky", "conductor", preset="gold", roughness=0.3))
    coated = render("point", nacre.Brdf("metallic_roughness", roughness=0.3), coat=1)
    assert np.array_equal(coated, render("point", "metallic_roughness", roughness=0.3, coat=1))
    with pytest.raises(TypeError, match="another scene"):
        scene = spheres("point")
        scene.add_material("ball", gold)
        scene.add_material("other", nacre.Brdf.from_scene(scene, "ball"))


def test_adaptive_sampling_treats_a_function_as_the_model_that_it_is():
    def adaptive(model, **parameters):
        scene = spheres("point")
        scene.add_material("ball", model, **parameters)
        return scene.render(width=48, height=36, max_error=0.05)["beauty"]
    mine = adaptive(ggx(0.04))
    other = adaptive("metallic_roughness", roughness=0.2, **WHITE_METAL)
    assert (np.abs(mine - other) <= 0.05 * np.maximum(other, 0.05)).mean() > 0.95


def test_a_lobe_that_samples_of_surroundings_do_not_find_is_told():
    def notes(model, light="sky", **settings):
        scene = spheres(light)
        scene.add_material("ball", model)
        return "".join(scene.render(width=8, height=6, samples=64, **settings).stats["notes"])
    told = 'material "ball": 64 samples of its surroundings hardly find its lobe'
    narrow = ggx(1e-4)
    assert told in notes(narrow, max_error=0.05) and "sample= and pdf=" in notes(narrow, max_error=0.05)
    sampled = nacre.Brdf(narrow, sample=lambda n, v, u: n, pdf=lambda n, v, l: np.ones(len(n)))
    assert told not in notes(sampled, max_error=0.05)
    assert told not in notes(ggx(0.5), max_error=0.05) + notes(lambert(0.5), max_error=0.05)
    assert told not in notes(narrow, "point", max_error=0.05)


def test_grids_over_parameters():
    def make(roughness, albedo=1):
        def brdf(n, v, l):
            return albedo * ggx(roughness**2)(n, v, l)
        return brdf
    scene = nacre.grid(make, roughness=[0.4, 0.8], albedo=np.array([1, 0.5, 0.25]))
    assert scene.material_names[:2] == ["roughness=0.4 albedo=1", "roughness=0.8 albedo=1"]
    image = scene.render()["beauty"]
    assert image.shape == (480, 320, 3)
    # Each ball is half as bright as the one above: the light is far away.
    balls = image.reshape(3, 160, 2, 160, 3).mean(axis=(1, 3, 4))
    assert np.allclose(balls[:-1] / balls[1:], 2, rtol=0.02)
    other = nacre.grid("metallic_roughness", roughness=[0.4, 0.8], **WHITE_METAL).render()["beauty"]
    assert np.abs(nacre.grid(make, roughness=[0.4, 0.8]).render()["beauty"] - other).max() < 1e-3
    for wrong in ({}, {"roughness": 0.4}, {"roughness": []}, {"roughness": [1], "b": [1], "c": [1]}):
        with pytest.raises(ValueError, match="grid"):
            nacre.grid(make, **wrong)


def test_a_scene_lives_as_long_as_its_functions_are_needed():
    scene = spheres("point")
    scene.add_material("ball", lambert(0.5))
    session = nacre.Session(scene.copy())
    del scene
    assert session.render(width=16, height=12)["beauty"].max() > 0
    session.close()
