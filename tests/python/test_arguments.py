# SPDX-License-Identifier: Apache-2.0
"""Arguments of the wrong kind: one clear error each."""
import copy
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import nacre
from models import lambert
from test_brdf import UP, directions
from test_scene import ball, same

GOLD = nacre.Brdf("conductor", preset="gold", roughness=0.2)
MASKED = np.ma.masked_array(np.array([UP, UP]), mask=[[0, 0, 0], [1, 1, 1]])
IMAGE = nacre.Image(np.ones((4, 5, 3)))
HALF_PAIR = "\ud800"  # a surrogate


def masked_result(n, v, l):
    return np.ma.masked_array(np.ones((len(n), 3)), mask=True)


@pytest.mark.parametrize("call, error, text", [
    (lambda: GOLD.evaluate(UP, UP, MASKED), ValueError, "to_light is masked"),
    (lambda: GOLD.evaluate(UP, UP, MASKED, exact=False), ValueError, "to_light is masked"),
    (lambda: GOLD.sample(UP, UP, MASKED[:, :2]), ValueError, "u is masked"),
    (lambda: nacre.Brdf(masked_result).evaluate(UP, UP, UP), nacre.Error, "returned an array that is masked"),
    (lambda: nacre.Image(np.ma.masked_array(np.ones((2, 2, 3)), mask=True)), ValueError, "image is masked"),
    (lambda: ball().add_spheres(MASKED, 1, "red"), ValueError, "centers is masked"),
    (lambda: ball().set_background(MASKED[1]), nacre.Error, "/background: the array is masked"),
    (lambda: ball().add_spheres(np.ones((2, 3)) * 1j, 1, "red"), TypeError, "centers is an array of complex"),
    (lambda: ball().add_spheres([[0, 0, 0], [1]], 1, "red"), ValueError, "centers is no array"),
    (lambda: ball().add_spheres([[0, 0, 0]], 1, 5), TypeError, "a material is a text, not 5"),
    (lambda: IMAGE.copy().__setitem__("R", np.ones((4, 5)) * 1j), TypeError, "R is an array of complex"),
    (lambda: nacre.compare(IMAGE, IMAGE, max_abs="a"), TypeError, "^max_abs is a number, not 'a'$"),
    (lambda: nacre.compare(IMAGE, IMAGE, layers=[5]), TypeError, "^a layer is a text"),
    (lambda: nacre.heat_map(IMAGE, IMAGE, low="a"), TypeError, "^low is a number"),
    (lambda: IMAGE.write("a.exr", compression=5), TypeError, "^compression is a text"),
    (lambda: IMAGE.picture().jpeg("a"), TypeError, "^quality is a whole number"),
    (lambda: nacre.side_by_side(IMAGE, gap=1.5), TypeError, "^gap is a whole number"),
    (lambda: nacre.set_target(5), TypeError, "^a target is a text"),
    (lambda: nacre.Brdf(HALF_PAIR), ValueError, "no text that can be written"),
    (lambda: ball().add_material(HALF_PAIR, "lambert"), ValueError, "no text that can be written"),
    (lambda: ball()[f"/materials/{HALF_PAIR}"], ValueError, "no text that can be written"),
    (lambda: ball().add_shape(HALF_PAIR), ValueError, "no text that can be written"),
    (lambda: ball().add_shape("sphere", material=HALF_PAIR), ValueError, "no text that can be written"),
    (lambda: ball().add_shape("sphere", **{HALF_PAIR: 1}), ValueError, "no text that can be written"),
    (lambda: ball().add_light("key", HALF_PAIR), ValueError, "no text that can be written"),
    (lambda: ball().add_texture("t", "caf\udce9.png"), ValueError, "no text that can be written"),
    (lambda: ball().add_texture("t", pathlib.Path("caf\udce9.png")), ValueError, "no text that can be written"),
    (lambda: ball().add_material("m", lambda n, v, l: n, rest=HALF_PAIR), ValueError, "no text that can be written"),
    (lambda: ball().add_spheres([[0, 0, 0]], 1, HALF_PAIR), ValueError, "no text that can be written"),
    (lambda: ball().__setitem__("/materials", {"a": [{HALF_PAIR: 1}]}), ValueError, "no text that can be written"),
    (lambda: nacre.Scene.from_dict({"materials": {HALF_PAIR: {}}}), ValueError, "no text that can be written"),
    (lambda: nacre.Session(ball()).__setitem__("/image", {"a": HALF_PAIR}), ValueError, "no text that can be written"),
    (lambda: f"/materials/{HALF_PAIR}" in ball(), ValueError, "no text that can be written"),
    (lambda: ball().render(layers=HALF_PAIR), ValueError, "no text that can be written"),
    (lambda: nacre.Brdf("lambert", albedo=HALF_PAIR), ValueError, "no text that can be written"),
    (lambda: nacre.Image(np.ones((2, 2, 3)), {"a": HALF_PAIR}), ValueError, "no text that can be written"),
    (lambda: nacre.Image({HALF_PAIR: np.ones((2, 2))}), ValueError, "no name of a channel"),
    (lambda: nacre.Scene.from_file(HALF_PAIR), ValueError, "surrogates not allowed|can't encode"),
    (lambda: nacre.Image(IMAGE), TypeError, "`copy` copies"),
    (lambda: nacre.Brdf.from_scene(ball(), 5), TypeError, "a material is a text"),
    (lambda: nacre.Brdf.from_scene(nacre.Session(ball()), "red"), TypeError, "a nacre.Scene is wanted"),
    (lambda: nacre.render(5), TypeError, "a nacre.Scene is wanted"),
    (lambda: nacre.grid(5, a=[1]), TypeError, "grid: a model is"),
    (lambda: nacre.Scene.from_dict([1]), TypeError, "a scene is a dictionary"),
    (lambda: ball().render(width=0), ValueError, "width is 0"),
    (lambda: ball().render(max_error=0), ValueError, "max_error is 0"),
    (lambda: nacre.check(lambert(0.5), size=0), ValueError, "size is"),
    (lambda: nacre.check(lambert(0.5), tolerance=np.nan), ValueError, "tolerance is"),
    (lambda: nacre.Brdf(lambert(1), albedo=lambda c: np.full((len(c), 3), np.nan)).albedo(0.5), nacre.Error,
     "the albedo of .* returned .nan, nan, nan. for n.v = 0.5")])
def test_what_is_of_another_kind_is_refused_in_a_line(call, error, text):
    with pytest.raises(error, match=text) as caught:
        call()
    assert "incompatible function arguments" not in str(caught.value)


def test_values_that_hold_themselves_are_refused():
    ring, deep = [], []
    ring.append(ring)
    for _ in range(100_000):
        deep = [deep]
    with pytest.raises(nacre.Error, match="Circular") as caught:
        ball()["/background"] = ring
    assert "finite" not in str(caught.value)
    with pytest.raises(ValueError, match="too deep"):
        ball()["/background"] = deep


def test_files_may_have_any_name(tmp_path):
    for name in (tmp_path / "a.exr", os.fsencode(tmp_path / "b.exr"), str(tmp_path / "c\udce9.exr")):
        IMAGE.write(name)
        assert same(nacre.read(name), IMAGE)
    picture = IMAGE.picture()
    for name in (os.fsencode(tmp_path / "b.png"), str(tmp_path / "c\udce9.png")):
        picture.write(name)
        assert nacre.read(name).width == 5
    for call in IMAGE.write, picture.write, nacre.read, nacre.Scene.from_file:
        with pytest.raises(ValueError, match="no file can have the name"):
            call(str(tmp_path / "d.png\0.exr"))
    assert not (tmp_path / "d.png").exists()
    scene = ball()
    scene.add_texture("t", pathlib.Path("t.png"))
    assert scene["/textures/t/file"] == "t.png"
    with pytest.raises(nacre.Error, match="caf"):
        nacre.read(b"caf\xe9.exr")
    image = IMAGE.copy()
    image.metadata["owner"] = "caf\udce9"  # as older programs write it
    image.write(tmp_path / "a.exr")
    assert nacre.read(tmp_path / "a.exr").metadata["owner"] == "caf\udce9"
    image.metadata["owner"] = 5
    with pytest.raises(TypeError, match="metadata texts by name"):
        image.write(tmp_path / "a.exr")


def test_a_picture_is_written_whole_or_not_at_all(tmp_path):
    with pytest.raises(nacre.Error, match="cannot be written") as caught:
        IMAGE.picture().write(tmp_path / "no" / "a.png")
    assert caught.value.exit_code == 74
    (tmp_path / "a.png").mkdir()
    with pytest.raises(nacre.Error, match="cannot be written"):
        IMAGE.picture().write(tmp_path / "a.png")
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


def test_arrays_need_not_be_aligned():
    v = directions(5)
    room = np.zeros(v.nbytes + 1, np.uint8)
    packed = room[1:].view(np.float64).reshape(v.shape)
    packed[...] = v
    assert not packed.flags.aligned
    for exact in True, False:
        expected = GOLD.evaluate(UP, UP, v, exact=exact)
        assert np.array_equal(GOLD.evaluate(UP, UP, packed, exact=exact), expected)
        mirrored = np.ascontiguousarray(v[::-1, ::-1])[::-1, ::-1]
        assert np.array_equal(GOLD.evaluate(UP, UP, mirrored, exact=exact), expected)


def test_vectors_of_any_precision_are_judged_in_double():
    v = directions(5).astype(np.float16)
    for exact in True, False:
        with pytest.raises(nacre.Error, match="to_light 0 .*has length 0.99997"):
            GOLD.evaluate(UP, UP, v, exact=exact)


def test_many_pairs_are_evaluated_in_pieces(monkeypatch):
    from nacre import _brdf
    v, points = directions(50), np.random.default_rng(1).random((50, 2))
    wrong = v.copy()
    wrong[47] *= 2

    def results():
        terms = GOLD.terms(UP, v, v[::-1])
        return [GOLD.evaluate(UP, v, v[::-1]), GOLD.pdf(UP, v, v[::-1]), GOLD.sample(UP, v, points),
                *GOLD.evaluate(UP, v, v, components=True), *terms.values()]
    expected = results()
    monkeypatch.setattr(_brdf, "_PIECE", 7)
    assert all(np.array_equal(a, b) for a, b in zip(results(), expected))
    with pytest.raises(nacre.Error, match="to_view 47 "):
        GOLD.evaluate(UP, wrong, v)


def test_control_c_ends_albedos():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # jobs in the background ignore it
    threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        GOLD.albedo(np.full(10**6, 0.5))
    assert time.monotonic() - start < 20


def test_renders_that_call_themselves_are_told_so():
    def brdf(n, v, l):
        scene.render(width=2, height=2, samples=1)
        return np.full((len(n), 3), 0.1)
    scene = ball()
    scene.add_material("red", brdf)
    with pytest.raises(nacre.Error, match="renders its own scene|does a function render"):
        scene.render(width=2, height=2, samples=1)


def test_what_is_refused_leaves_a_scene_as_it_was():
    scene = ball()
    before = scene.to_dict()
    for change in (lambda: scene.add_shape(HALF_PAIR), lambda: scene.add_shape("sphere", radius=np.nan),
                   lambda: scene.add_shape("sphere", **{"center": [[[[0]]]] * 2, "type ": object()}),
                   lambda: scene.add_material("m", HALF_PAIR), lambda: scene.add_light(HALF_PAIR, "point")):
        with pytest.raises((ValueError, TypeError, nacre.Error)):
            change()
        assert scene.to_dict() == before
    scene.check()


CRASHES = """
import numpy as np, nacre
from nacre import _nacre

UP = np.array([[0.0, 0, 1]]).T  # as planes
image, scene = nacre.Image(np.ones((4, 5, 3))), nacre.Scene()
brdf, own = nacre.Brdf("conductor", preset="gold"), nacre.Brdf(lambda n, v, l: n)
session = nacre.Session(scene)


def with_members(**members):
    other = image.copy()
    for name, value in members.items():
        setattr(other, name, value)
    return other


class Other(object):
    pass


def rendered_by(**members):
    one = nacre.Brdf(lambda n, v, l: n)
    for name, value in members.items():
        setattr(one, name, value)
    ball = nacre.Scene()
    ball.add_material("m", one)
    ball.add_light("sky", "environment", radiance=1)
    ball.set_camera(position=(0, 0, 5))
    ball.add_sphere((0, 0, 0), 1, "m")
    return ball.render(width=8, height=8, samples=1)


calls = []
for made in _nacre.Scene, _nacre.Session, _nacre.Brdf:
    calls += [lambda c=made: c(), lambda c=made: c.__new__(c), lambda c=made: object.__new__(c),
              lambda c=made: c.__base__.__new__(c), lambda c=made: type("Sub", (c,), {}),
              lambda c=made: c.__init__(), lambda c=made: setattr(c, "set", None),
              lambda c=made: setattr(scene._native, "__class__", c),
              lambda c=made: setattr(Other(), "__class__", c)]
calls += [lambda: _nacre.Scene.set(session._native, "/a", "1"), lambda: _nacre.Session.of(session._native),
          lambda: _nacre.Scene.from_bytes(b""), lambda: _nacre.Scene.from_bytes(scene._native.to_bytes()[:-5]),
          lambda: _nacre.Scene.from_bytes(b"\\x9f" * 100), lambda: scene._native.render({}, None),
          lambda: _nacre.Brdf.of_model("lambert", [("albedo", "[")]), lambda: scene._native.set("/a", "{")]
big = 2**31 - 1
calls += [lambda m=m: with_members(**m).write("/dev/null/a.exr") for m in (
    {"_types": []}, {"_types": ["float"] * 9}, {"_types": ["half"] * 2 + ["wide"]}, {"_types": None},
    {"_names": []}, {"_names": ["R"] * 9}, {"_names": [1, 2, 3]}, {"_names": None}, {"_block": None},
    {"_block": np.ones((3, 4), np.float32)}, {"_block": np.ones((9, 4, 5), np.float32)},
    {"_block": np.ones((3, 4, 5))}, {"_block": np.ones((3, 0, 5), np.float32)}, {"_block": np.float32(1)},
    {"data": (0, 0, 50, 40)}, {"data": (0, 0, -5, -4)}, {"data": (-big, -big, big, big)}, {"data": "abcd"},
    {"frame": (-big, -big, big, big)}, {"frame": (5, 5, 0, 0)}, {"frame": (1,)}, {"metadata": None})]
calls += [lambda m=m: nacre.compare(with_members(**m), image) for m in (
    {"_types": []}, {"_names": []}, {"frame": (-big, -big, big, big)},
    {"_names": [], "_types": [], "_block": np.ones((0, 4, 5), np.float32)})]
for native in _nacre.Brdf.of_model("conductor", []),:
    for function in native.evaluate, native.pdf, native.terms:
        calls += [lambda f=function, a=a: f(*a) for a in (
            (UP, UP, np.ones((3, 0))), (UP, UP, UP[:2]), (UP, UP[:1], UP), (UP.T, UP.T, UP.T), (UP, UP, UP[0]),
            (UP[0], UP, UP), (np.float64(1),) * 3, (UP.reshape(3, 1, 1),) * 3, (None,) * 3)]
    calls += [lambda a=a: native.shade(*a, True) for a in (
        (UP, UP, UP), (UP.T, UP.T, np.ones((1, 2))), (UP.T, np.ones((0, 3)), UP.T), (UP[0],) * 3)]
    calls += [lambda p=p: native.sample(UP, UP, p) for p in (UP, UP[0], UP[:2].T, np.ones((2, 0)))]
wrong = [lambda *a: np.ones((3, 1)), lambda *a: np.ones(2), lambda *a: None, lambda *a: np.ones((0, 0))]
calls += [lambda f=f: rendered_by(_evaluate=f) for f in wrong]
calls += [lambda f=f: rendered_by(_sample=f, _pdf=lambda n, v, l: np.ones(len(n))) for f in wrong]
calls += [lambda f=f: rendered_by(_sample=lambda n, v, u: n.T, _pdf=f) for f in wrong]
picture = nacre.Picture(np.zeros((2, 2, 3), np.uint8))
for pixels in np.zeros((0, 0, 3), np.uint8), np.zeros((2, 2), np.uint8), np.zeros((2, 2, 5), np.uint8), None:
    calls += [lambda p=pixels: _nacre.encode_png(p), lambda p=pixels: _nacre.encode_jpeg(p, 90)]
passed = []
for i, call in enumerate(calls):
    try:
        call()
        passed.append(i)
    except Exception as error:
        assert "\\n" not in str(error).split("hint:")[0].strip() or "incompatible" in str(error), error
assert not passed, passed
_nacre.after_fork()  # in no child, while a render runs
assert scene.render(width=4, height=4, progress=lambda share: _nacre.after_fork()).width == 4
print(len(calls))
"""


def test_no_private_member_crashes_the_process():
    done = subprocess.run([sys.executable, "-X", "faulthandler", "-c", CRASHES], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) > 100


def test_models_are_copied_and_pickled():
    for other in copy.copy(GOLD), copy.deepcopy(GOLD), pickle.loads(pickle.dumps(GOLD)):
        assert np.array_equal(other.evaluate(UP, UP, UP), GOLD.evaluate(UP, UP, UP))
    own = pickle.loads(pickle.dumps(nacre.Brdf(masked_result)))
    assert own.is_own and own.name == "masked_result"
    image = pickle.loads(pickle.dumps(IMAGE))
    assert same(image, IMAGE)
    other = copy.copy(IMAGE)
    other["R"] = 5
    assert IMAGE["R"].max() == 1
    try:
        nacre.Brdf("lambret")
    except nacre.Error as error:
        again = pickle.loads(pickle.dumps(error))
        assert (str(again), again.faults, again.exit_code) == (str(error), error.faults, error.exit_code)


def test_other_interpreters_are_refused():
    code = """import sys, nacre
try:
    import _interpreters as sub  # its name since Python 3.13
    other = sub.create('legacy')
except ImportError:
    import _xxsubinterpreters as sub
    other = sub.create()
sub.run_string(other, f'''import sys
sys.path = {sys.path}
try:
    import nacre
except Exception:
    print('refused', end=' ', flush=True)
''')
print(nacre.Scene().render(width=4, height=4).width)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0 and done.stdout == "refused 4\n", done.stderr
