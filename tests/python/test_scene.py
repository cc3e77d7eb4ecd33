# SPDX-License-Identifier: Apache-2.0
"""Scenes, renders and sessions from Python."""
import copy
import inspect
import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import tracemalloc

import numpy as np
import pytest

import nacre
from conftest import not_sanitized

SMALL = {"width": 64, "height": 48, "samples": 4}


def ball():
    return nacre.Scene.from_dict({
        "camera": {"position": [0, 0, 5]},
        "materials": {"red": {"model": "metallic_roughness", "base_color": [0.8, 0.1, 0.1]}},
        "lights": {"key": {"type": "point", "position": [3, 4, 5], "intensity": 100}},
        "shapes": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "red"}]})


def same(a, b):
    return set(a.channels) == set(b.channels) and all(np.array_equal(a[n], b[n]) for n in a.channels)


def test_arrays_of_doubles_are_not_copied():
    scene, count = nacre.Scene(), 100_000
    points, sizes = np.zeros((count, 3)), np.ones(count)
    triangles, uvs = np.zeros((count, 3), np.uint32), np.zeros((count, 2))
    for add in (lambda: scene.add_spheres(points, sizes, "red"),
                lambda: scene.add_mesh(points, triangles, "red", normals=points, uvs=uvs)):
        tracemalloc.start()  # of numpy's arrays, not of C++
        add()
        copied = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert copied < sizes.nbytes / 2  # the least of the arrays is that of sizes


def test_a_render_has_the_bits_of_the_program(scenes, program, tmp_path):
    picture = tmp_path / "a.exr"
    subprocess.run([program, "render", scenes / "first_scene.json", "-o", picture, "--depth", "float",
                    "--target", nacre.active_target(), "--size", "64x48", "--layers", "all", "--set", "/materials/red/roughness=0.2"],
                   check=True, capture_output=True)
    scene = nacre.Scene.from_file(scenes / "first_scene.json")
    scene["/materials/red/roughness"] = 0.2
    image = scene.render(width=64, height=48, layers="all")
    assert same(image, nacre.read(picture))
    assert image["id.object"].dtype == np.uint32 and image["id.object"].max() == 2


def test_a_scene_built_in_code_is_that_of_a_file():
    scene = nacre.Scene()
    scene.set_camera(position=(0, 0, 5))
    scene.add_material("red", "metallic_roughness", base_color=np.array([0.8, 0.1, 0.1]))
    scene.add_light("key", "point", position=np.array([3, 4, 5]), intensity=np.float32(100))
    scene.add_sphere((0, 0, 0), 1, "red")
    assert same(scene.render(**SMALL), ball().render(**SMALL))
    assert (scene.sphere_count, scene.mesh_count) == (1, 0)
    assert (scene.material_names, scene.light_names) == (["red"], ["key"])


def test_shapes_come_as_arrays():
    scene = ball()
    scene.add_spheres(np.arange(6, dtype=np.float32).reshape(2, 3), 0.5, "red")
    scene.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.array([[0, 1, 2]]), "red")
    scene.add_shape("sphere", center=[2, 0, 0], radius=0.5, material="red")
    assert (scene.sphere_count, scene.mesh_count) == (4, 1)


def test_values_are_read_as_they_were_set(scenes):
    scene = nacre.Scene.from_file(scenes / "first_scene.json")
    assert scene["/materials/red/roughness"] == 0.3
    scene["/materials/red/roughness"] = np.float64(0.25)
    assert scene["/materials/red"]["roughness"] == 0.25
    assert scene["/shapes/1/center"] == [0, -1000, 0]
    assert scene.get("/materials/red/metallic", 0) == 0 and "/materials/red/metallic" not in scene
    assert scene.to_dict()["materials"]["red"]["roughness"] == 0.25
    with pytest.raises(KeyError, match="/materials/blue"):
        scene["/materials/blue"]
    with pytest.raises(nacre.Error, match="JSON pointer"):
        scene["materials"]
    other = scene.copy()
    other["/materials/red/roughness"] = 1
    assert scene["/materials/red/roughness"] == 0.25
    with nacre.Session(scene) as session:
        assert session["/materials/red/roughness"] == 0.25
        assert session["/shapes/0/radius"] == 1


def least_seconds(call):
    """The quickest of a few: a busy machine may keep any of them waiting."""
    seconds = []
    for _ in range(5):
        start = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - start)
    return min(seconds)


def test_values_cost_the_same_however_much_was_set():
    def seconds(count):
        scene = ball()
        for i in range(count):
            scene["/materials/red/roughness"] = i / count
        assert scene["/materials/red/roughness"] == (count - 1) / count
        with nacre.Session(scene) as session:
            return [least_seconds(lambda: scene["/materials/red/roughness"]),
                    least_seconds(lambda: "/materials/red" in scene),
                    least_seconds(lambda: scene.to_dict()),
                    least_seconds(lambda: scene.__setitem__("/materials/red/metallic", 0)),
                    least_seconds(lambda: session["/materials/red/roughness"])]
    # Those of 20 000 took 500 times as long where all of them were applied again.
    assert all(many < 20 * few + 1e-3 for few, many in zip(seconds(10), seconds(20_000)))


def test_many_materials_are_added_in_time_that_each_takes():
    def seconds(count):
        scene = nacre.Scene()
        start = time.perf_counter()
        for i in range(count):
            scene.add_material(f"m{i}", "lambert", albedo=0.5)
            scene[f"/materials/m{i}/albedo"] = 0.25
            scene.add_sphere((3 * i, 0, 0), 1, f"m{i}")
        return (time.perf_counter() - start) / count
    # Where each is looked for among all, 16 000 take 16 times as long each as 1 000 do.
    assert min(seconds(16_000) for _ in range(2)) < 6 * min(seconds(1000) for _ in range(3)) + 1e-5


def test_one_sphere_of_many_is_read_without_the_others():
    count = 200_000
    scene = nacre.Scene.from_dict({
        "materials": {"red": {"model": "lambert"}},
        "shapes": [{"type": "sphere", "center": [3 * i, 0, 0.5], "radius": 1 + i, "material": "red"}
                   if i not in (5, 6, 9) else {"type": "sphere", "center": [0, 0, 0], "radius": 0.5 + i,
                                           "material": {"model": "lambert"}}
                   for i in range(count)]})
    with nacre.Session(scene) as session:
        for of in scene, session:
            for i in 0, 1, 4, 5, 6, 7, 8, 9, 10, 11, count - 1:
                assert of[f"/shapes/{i}/radius"] == (0.5 if i in (5, 6, 9) else 1) + i
                assert f"/shapes/{i}/radius" in of and f"/shapes/{i}/angle" not in of
            assert of["/shapes/7"] == {"type": "sphere", "center": [21, 0, 0.5], "radius": 8, "material": "red"}
            assert of["/shapes/7/center/2"] == 0.5 and of.get(f"/shapes/{count}") is None
            assert "/shapes" in of and "/shapes/-" not in of and "/shapes/07" not in of
            # A hundredth of what it takes to write all of them down.
            assert least_seconds(lambda: of[f"/shapes/{count - 2}/radius"]) < 5e-3
            assert least_seconds(lambda: "/shapes" in of) < 5e-3
        assert len(scene["/shapes"]) == count and scene["/shapes"][count - 1]["radius"] == count
    scene["/shapes/3/radius"] = 0.25
    assert scene["/shapes/3/radius"] == 0.25 and scene["/shapes/10/radius"] == 11
    scene.add_shape("sphere", radius=2, material="red")
    assert scene[f"/shapes/{count}/radius"] == 2


@pytest.mark.parametrize("change", [
    lambda s: s.__setitem__("materials", 1), lambda s: s.__setitem__("/shapes/1/radius", 1),
    lambda s: s.__setitem__("/shapes/-", {}), lambda s: s.__setitem__("/materials/rod/roughness", 1),
    lambda s: s.__setitem__("/lights/kay/intensity", 1), lambda s: s.__setitem__("/camera/position/x/y", 1),
    lambda s: s.__setitem__("/background/~2", 1), lambda s: s.__setitem__("/a" * 200, 1)])
def test_a_place_that_is_not_there_is_refused_where_it_is_set(change):
    scene = ball()
    before = scene.to_dict()
    with pytest.raises(nacre.Error) as caught:
        change(scene)
    assert caught.value.exit_code == 64 and scene.to_dict() == before
    scene.check()


def test_scenes_are_pickled(scenes, tmp_path):
    scene = ball()
    scene.add_spheres(np.arange(6).reshape(2, 3), [0.5, 0.25], "red")
    scene.add_material("blue", "lambert", albedo=(0, 0.1, 1 / 3))
    scene.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], "blue", normals=[[0, 0, 1.0]] * 3,
                   uvs=[[0, 0], [1, 0], [0, 1]])
    again = pickle.loads(pickle.dumps(scene))
    assert same(again.render(**SMALL), scene.render(**SMALL)) and again.to_dict() == scene.to_dict()
    again.add_sphere((0, 2, 0), 0.5, "blue")  # to which shapes may be added
    assert (scene.sphere_count, again.sphere_count, again.mesh_count) == (3, 4, 1)
    # Of a model, and of a file in another folder, read by a process that works elsewhere.
    (tmp_path / "far").mkdir()
    for name in "meshes/torus_knot.obj", "textures.json":
        own = nacre.Scene.from_file(os.path.relpath(scenes / name))
        own["/image/spp"] = 2
        (tmp_path / "s.pickle").write_bytes(pickle.dumps(own))
        code = ("import pickle, sys, nacre; scene = pickle.load(open('../s.pickle', 'rb')); "
                "scene.render(width=64, height=48).write('a.exr', half_floats=False)")
        subprocess.run([sys.executable, "-c", code], cwd=tmp_path / "far", check=True)
        assert same(nacre.read(tmp_path / "far/a.exr"), own.render(width=64, height=48))
    scene.add_material("mine", lambda n, v, l: n)
    with pytest.raises(TypeError, match='^cannot pickle a nacre.Scene: the material "mine" is a function'):
        pickle.dumps(scene)
    with pytest.raises(TypeError, match="^cannot pickle a nacre.Session"):
        pickle.dumps(nacre.Session(ball()))
    with pytest.raises(TypeError, match="^cannot pickle the nacre.Brdf of a scene"):
        pickle.dumps(nacre.Brdf.from_scene(ball(), "red"))


def test_a_session_reads_changed_files_again(tmp_path):
    def texture(value):
        nacre.Picture(np.full((4, 4, 3), value, np.uint8)).write(tmp_path / "t.png")

    def mesh(size):
        (tmp_path / "m.obj").write_text(f"v {-size} -1 0\nv {size} -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                        "f 1/1 2/2 3/3\n")
    texture(200)
    mesh(1)
    (tmp_path / "s.json").write_text(json.dumps({
        "nacre": 1, "camera": {"position": [0, 0, 5]}, "textures": {"t": {"file": "t.png"}},
        "materials": {"red": {"model": "lambert", "albedo_map": "t"}},
        "lights": {"sky": {"type": "ambient", "radiance": 1}},
        "shapes": [{"type": "mesh", "file": "m.obj", "material": "red"}]}))
    with nacre.Session(nacre.Scene.from_file(tmp_path / "s.json")) as session, \
            nacre.Session(nacre.Scene.from_file(tmp_path / "m.obj")) as of_model:
        session["/background"] = of_model["/background"] = 0.25  # stays

        def is_fresh():
            for one, file in (session, "s.json"), (of_model, "m.obj"):
                fresh = nacre.Scene.from_file(tmp_path / file)
                fresh["/background"] = 0.25
                assert same(one.render(**SMALL), fresh.render(**SMALL))
        assert not session.reload() and not of_model.reload()
        for change in (lambda: texture(50)), (lambda: mesh(0.5)), (lambda: texture(90)):
            before = session.render(**SMALL)
            change()
            assert same(session.render(**SMALL), before)  # until it is asked for
            assert session.reload() and not session.reload()
            of_model.reload()
            assert not same(session.render(**SMALL), before)
            is_fresh()
        (tmp_path / "m.obj").write_text("f 1 2 3\n")
        for one in session, of_model:
            before = one.render(**SMALL)
            for _ in range(2):
                with pytest.raises(nacre.Error, match="m.obj"):
                    one.reload()
                assert same(one.render(**SMALL), before)
        mesh(0.75)
        assert session.reload() and of_model.reload()
        is_fresh()
    with pytest.raises(nacre.Error, match="closed"):
        session.reload()


def test_errors_are_those_of_the_program():
    scene = ball()
    scene["/materials/red/roughnes"] = 0.2
    scene["/materials/red/metallic"] = 2
    with pytest.raises(nacre.Error) as caught:
        scene.check()
    error = caught.value
    assert len(error.faults) == 2 and error.exit_code == 65
    fault = next(f for f in error.faults if "roughnes" in f.what)
    assert fault.where.endswith("/materials/red") and fault.hint == 'did you mean "roughness"?'
    assert 'unknown key "roughnes"' in str(error)
    with pytest.raises(nacre.Error, match="no such file|there is no file|No such file"):
        nacre.Scene.from_file("nowhere.json")


@pytest.mark.parametrize("value", [float("nan"), float("inf"), {"a": float("nan")}])
def test_numbers_of_scenes_are_finite(value):
    with pytest.raises(nacre.Error, match="finite"):
        ball()["/materials/red/roughness"] = value


@pytest.mark.parametrize("value, where", [
    (float("nan"), "/materials/red/roughness"), (10**400, "/materials/red/roughness"),
    (10**5000, "/materials/red/roughness"), (-10**400, "/materials/red/roughness"),
    ([1, {"a/b": np.array([1, np.inf])}], "/materials/red/roughness/1/a~1b/1")],
                         ids=["nan", "large", "huge", "negative", "nested"])
def test_a_number_that_is_not_finite_is_told_with_its_place(value, where):
    with pytest.raises(nacre.Error) as caught:
        ball()["/materials/red/roughness"] = value
    fault, = caught.value.faults
    assert fault.where == where and fault.what.endswith("is no finite number")
    ball()["/nothing"] = "1" * 400  # a text


@pytest.mark.parametrize("settings, error", [
    ({"width": -1}, nacre.Error), ({"samples": 10**7}, nacre.Error), ({"max_error": 2}, nacre.Error),
    ({"layers": ["difuse"]}, nacre.Error), ({"intersector": "magic"}, nacre.Error),
    ({"region": (5, 5, 1, 1)}, nacre.Error), ({"region": (1, 2)}, ValueError),
    ({"region": "abcd"}, TypeError), ({"threads": -1}, nacre.Error), ({"threads": 1.5}, TypeError),
    ({"width": "wide"}, TypeError), ({"width": 2**40}, ValueError), ({"widht": 4}, TypeError),
    ({"max_error": "low"}, TypeError), ({"max_error": float("nan")}, nacre.Error),
    ({"seed": -1}, ValueError), ({"seed": 1.5}, TypeError), ({"layers": [3]}, TypeError),
    ({"layers": None}, TypeError), ({"intersector": None}, TypeError), ({"progress": 5}, TypeError)])
def test_settings_out_of_range_are_refused(settings, error):
    with pytest.raises(error):
        ball().render(**settings)


def test_settings_of_the_table_are_keyword_arguments():
    plain = list(inspect.signature(nacre.Scene.render).parameters)
    assert plain == ["self", "width", "height", "samples", "max_error", "seed", "region", "layers", "threads",
                     "intersector", *nacre._nacre.named_settings(), "progress"]
    assert list(inspect.signature(nacre.Session.render).parameters) == [*plain, "show"]
    # As if three were not written out.
    render = nacre._scene._with_named_settings(nacre.Scene.render.__wrapped__, {
        "tolerance": "The error of a pixel", "max_error": "The same", "threads": "How many"})
    assert inspect.signature(render).parameters["tolerance"].default is None
    assert "\n        tolerance: The error of a pixel.\n" in render.__doc__
    for settings in {"max_error": 0.1}, {"max_error": None}:
        assert same(render(ball(), **SMALL, **settings), ball().render(**SMALL, **settings))
    for settings, error in (({"tolerance": 1}, nacre.Error), ({"max_error": "low"}, nacre.Error),
                            ({"max_error": 2}, nacre.Error), ({"threads": 1.5}, nacre.Error), ({"x": 1}, TypeError)):
        with pytest.raises(error):
            render(ball(), **SMALL, **settings)


@pytest.mark.parametrize("call, error", [
    (lambda s: s.add_spheres([[0, 0]], 1, "red"), ValueError),
    (lambda s: s.add_spheres([[0, 0, 0]], [1, 2], "red"), ValueError),
    (lambda s: s.add_spheres([["a", 0, 0]], 1, "red"), TypeError),
    (lambda s: s.add_mesh([[0, 0, 0]], [[0.5, 0, 0]], "red"), TypeError),
    (lambda s: s.add_mesh([[0, 0, 0]], [[-1, 0, 0]], "red"), ValueError),
    (lambda s: s.add_mesh([[0, 0, 0]], [[0, 0, 2**32]], "red"), ValueError),
    (lambda s: s.add_mesh([[0, 0, 0]], [0, 0, 0], "red"), ValueError),
    (lambda s: s.add_shape("sphere", center=object()), TypeError),
    (lambda s: nacre.Session("scene.json"), TypeError), (lambda s: s[3], TypeError),
    (lambda s: s.add_material(3, "lambert"), TypeError), (lambda s: nacre.Brdf.from_scene(None, "red"), TypeError),
    (lambda s: nacre.Scene.from_file(7), TypeError)])
def test_arguments_of_other_types_are_refused(call, error):
    with pytest.raises(error):
        call(ball())


def test_a_shape_out_of_range_is_found_when_checked():
    scene = ball()
    scene.add_spheres([[0, 0, np.nan]], -1, "red")
    scene.add_mesh([[0, 0, 0]], [[0, 0, 7]], "blue")
    with pytest.raises(nacre.Error, match="blue"):
        scene.check()


@pytest.mark.parametrize("triangles, error, text", [
    ([0, 1, 2], ValueError, r"not \(3,\); reshape\(-1, 3\)"), ([[0, 1]], ValueError, r"not \(1, 2\)$"),
    (np.array([[0, 1, 2], [0, 1, -2]]), ValueError, "triangle 1 names position -2$"),
    (np.array([[0, 1, 2], [0, 2**40, 2]]), ValueError, "triangle 1 names position 1099511627776$"),
    ([[0, 1, 2], [0, 1, 2], [2, 1, 3]], nacre.Error, "/triangles/2: there is no position 3\n.*the mesh has 3"),
    (np.zeros((0, 3), int), nacre.Error, "no triangles")])
def test_triangles_are_counted_as_triangles(triangles, error, text):
    scene = ball()
    with pytest.raises(error, match=text):
        scene.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles, "red")
        scene.check()


@pytest.mark.parametrize("kind", [np.uint8, np.int16, np.uint32, np.int64, np.uint64])
def test_triangles_may_be_of_any_integers_and_strides(kind):
    square = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
    pair = np.array([[0, 1, 2], [0, 2, 3]])

    def rendered(triangles):
        scene = ball()
        scene["/shapes"] = []
        scene.add_mesh(square, triangles, "red")
        return scene.render(**SMALL, layers=["id.object", "N"])
    expected = rendered(pair)
    assert expected["A"].max() == 1
    assert same(rendered(pair.astype(kind)), expected)
    assert same(rendered(np.repeat(pair.astype(kind), 2, axis=0)[::2]), expected)
    assert same(rendered(np.asfortranarray(pair.astype(kind))), expected)


def test_a_session_gives_the_bits_of_a_render():
    scene = ball()
    with nacre.Session(scene) as session:
        for roughness in 0.1, 0.6:
            session["/materials/red/roughness"] = scene["/materials/red/roughness"] = roughness
            assert same(session.render(**SMALL), scene.render(**SMALL))
        with pytest.raises(nacre.Error, match="roughness"):
            session["/materials/red/roughness"] = 2
        assert session["/materials/red/roughness"] == 0.6
        shown = []
        image = session.render(**SMALL, show=lambda i, n: shown.append((n, i["R"].mean())))
        assert [n for n, _ in shown] == [1, 2, 4] and shown[-1][1] == image["R"].mean()
    with pytest.raises(nacre.Error, match="closed"):
        session.render()
    with pytest.raises(nacre.Error, match="closed"):
        session["/image"]
    session.close()


def test_progress_comes_to_an_end():
    shares = []
    ball().render(width=300, height=200, progress=shares.append)
    assert shares[-1] == 1 and shares == sorted(shares)
    ball().render(**SMALL, progress=True)


def test_what_a_callback_raises_comes_out():
    def fail(_):
        raise KeyError("mine")
    with pytest.raises(KeyError, match="mine"):
        ball().render(**SMALL, progress=fail)
    with nacre.Session(ball()) as session:
        with pytest.raises(KeyError, match="mine"):
            session.render(**SMALL, show=lambda image, samples: fail(image))
        assert session.render(**SMALL).stats["camera_rays"] > 0


def test_what_has_not_converged_is_in_the_stats():
    stats = ball().render(width=64, height=64, samples=16, max_error=1e-5).stats
    assert stats["unsettled_pixels"] > 0
    assert "did not settle within 16 samples" in stats["notes"][-1]
    samples = stats["samples_per_pixel"]
    assert samples["min"] < samples["mean"] < samples["max"] == 16
    assert ball().render(**SMALL).stats["unsettled_pixels"] == 0


@pytest.mark.parametrize("opened", [lambda scene: scene, nacre.Session])
def test_models_tell_what_they_hold(opened, scenes):
    model = opened(nacre.Scene.from_file(scenes / "models" / "pawns.glb"))
    brass = model["/materials/brass"]
    assert brass["model"] == "metallic_roughness" and 0 < model["/materials/brass/roughness"] == brass["roughness"] < 1
    key = model["/lights/key"]
    assert key["type"] == "directional" and len(model["/camera/position"]) == 3 and model["/image/width"] == 1280
    assert "/lights/key" in model and "/lights/kay" not in model and model.get("/materials/none") is None
    model["/materials/brass/roughness"] = 0.9
    assert model["/materials/brass"] == {**brass, "roughness": 0.9, "diffuse_roughness": 0.9}
    model["/lights/key/irradiance"] = 7
    assert model["/lights/key"] == {**key, "irradiance": 7}
    model["/lights/fill"] = None
    assert "/lights/fill" not in model and set(model["/lights"]) == {"key", "rim", "sky"}
    told = model.to_dict()  # all but meshes, maps, and the room, which no scene file says
    again = nacre.Scene.from_dict(told)
    assert again["/materials/brass"] == model["/materials/brass"] and again["/camera"] == model["/camera"]
    again.check()


def test_cancel_ends_a_render():
    with nacre.Session(ball()) as session:
        timer = threading.Timer(0.2, session.cancel)
        timer.start()
        start = time.monotonic()
        with pytest.raises(nacre.Cancelled):
            session.render(width=1920, height=1080, samples=65536)
        assert time.monotonic() - start < 10
        timer.join()


def test_control_c_ends_a_render():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # jobs in the background ignore it
    start = time.monotonic()
    threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        ball().render(width=1920, height=1080, samples=65536)
    assert time.monotonic() - start < 10


def test_other_threads_run_while_it_renders():
    count = 0

    def work():
        nonlocal count
        while not done.wait(0.001):
            count += 1
    done = threading.Event()
    thread = threading.Thread(target=work)
    thread.start()
    ball().render(width=640, height=480, samples=16)
    done.set()
    thread.join()
    assert count > 0


def test_threads_may_share_a_scene_but_not_change_it_meanwhile():
    scene = ball()
    images, errors = [], []
    threads = [threading.Thread(target=lambda: images.append(scene.render(**SMALL)))
               for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(images) == 4 and all(same(image, images[0]) for image in images)

    def change(_):
        try:
            scene["/image/spp"] = 1
        except nacre.Error as error:
            errors.append(str(error))
    scene.render(**SMALL, progress=change)
    assert errors and "in use" in errors[0]
    with nacre.Session(scene) as session:
        with pytest.raises(nacre.Error, match="in use"):
            session.render(**SMALL, show=lambda image, samples: session.close())


def exit_code_of_child(work):
    """The number that `work` returns in a child after a fork; None if it does not end in time."""
    child = os.fork()
    if child == 0:
        code = 255
        try:
            code = work()
        finally:
            os._exit(code)  # whatever happens, the child runs no further tests
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:
        pid, status = os.waitpid(child, os.WNOHANG)
        if pid:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.01)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return None


def child_renders(expected):
    """Whether a child after a fork does, and with the same bits."""
    return exit_code_of_child(lambda: 0 if same(ball().render(**SMALL), expected) else 1) == 0


@not_sanitized  # the thread sanitizer allows no threads after a fork
def test_a_child_renders_after_a_fork():
    expected = ball().render(**SMALL)
    assert child_renders(expected)


@not_sanitized  # likewise
def test_a_child_has_threads_of_its_own():
    def threads():
        ball().render(width=64, height=64, samples=1, threads=3)
        return len(os.listdir("/proc/self/task"))
    ball().render(width=64, height=64, samples=1, threads=3)  # so that its parent has some
    assert exit_code_of_child(threads) in range(3, 100)


@not_sanitized  # the sanitizers' own locks do not survive a fork
def test_a_child_renders_after_a_fork_amid_renders():
    def work():
        while not done.is_set():
            ball().render(**SMALL)
    expected = ball().render(**SMALL)
    done = threading.Event()
    thread = threading.Thread(target=work)
    thread.start()
    try:
        assert all(child_renders(expected) for _ in range(10))
    finally:
        done.set()
        thread.join()


def test_a_process_ends_whatever_its_threads_render():
    code = """
import threading, time, nacre
scene = nacre.Scene()
scene.set_camera(position=(0, 0, 5))
scene.add_light("key", "point", position=(3, 4, 5), intensity=100)
scene.add_material("mine", lambda n, v, l: n * 0 + 0.3)
scene.add_sphere((0, 0, 0), 1, "mine")
def render():
    while True:
        scene.render(width=400, height=400, samples=16)


threading.Thread(target=render, daemon=True).start()
time.sleep(0.1)


class Late:
    def __del__(self, sleep=time.sleep):
        sleep(0.1)  # while the interpreter ends, threads may come back to it


late = Late()
"""
    for _ in range(4):  # it is a matter of microseconds
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, timeout=60, check=False)
        assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")


def test_scenes_are_copied():
    for other in copy.copy(ball()), copy.deepcopy(ball()):
        assert same(other.render(**SMALL), ball().render(**SMALL))
