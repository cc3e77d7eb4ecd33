# SPDX-License-Identifier: Apache-2.0
"""Images, files, metrics and pictures from Python."""
import gc
import io
import math
import os

import numpy as np
import pytest

import nacre
from conftest import not_sanitized


@pytest.fixture
def image(scenes):
    return nacre.Scene.from_file(scenes / "first_scene.json").render(
        width=64, height=48, samples=2, layers="all")


def test_channels_are_views(image):
    beauty = image["beauty"]
    assert beauty.shape == (48, 64, 3) and beauty.dtype == np.float32
    assert np.shares_memory(beauty, image["G"]) and np.shares_memory(image["N"], image["N.Y"])
    image["G"][3, 4] = 7
    assert beauty[3, 4, 1] == 7
    image["beauty"] *= 2
    assert image["G"][3, 4] == 14
    image["A"] = 0.5
    assert (image["A"] == 0.5).all()
    parts = image["diffuse"] + image["specular"] + image["ambient"] + image["emission"]
    assert parts.shape == beauty.shape
    assert {"beauty", "A", "diffuse", "N", "Z", "id.object", "light.key"} <= set(image.layers)
    assert "diffuse" in image and "R" in image and "difuse" not in image


def test_arrays_outlive_their_image(image):
    expected, channel = image["beauty"].copy(), image["beauty"]
    del image
    gc.collect()
    filler = [np.full((48, 64), 5.0, np.float32) for _ in range(100)]
    assert np.array_equal(channel, expected) and filler


@pytest.mark.parametrize("name", ["a.exr", "b.png"])
def test_files_are_written_and_read(image, tmp_path, name):
    image.write(tmp_path / name, half_floats=False)
    again = nacre.read(tmp_path / name)
    if name == "a.exr":
        assert set(again.channels) == set(image.channels)
        for channel in image.channels:
            assert np.array_equal(again[channel], image[channel], equal_nan=True), channel
        assert again["id.object"].dtype == np.uint32
        for layer in "beauty", "diffuse", "N":
            assert np.array_equal(again[layer], image[layer], equal_nan=True), layer
    else:
        codes = np.rint(again["beauty"] * 255).astype(np.uint8)
        assert np.array_equal(codes, image.tone_map())


def test_an_image_of_arrays():
    values = np.random.default_rng(1).random((5, 7, 3))
    image = nacre.Image(values)
    assert image.layers == ("beauty",) and np.array_equal(image["beauty"], values.astype(np.float32))
    image = nacre.Image({"Z": np.ones((5, 7), int), "B": values[:, :, 2], "N": values[:, ::-1],
                         "R": values[:, :, 0], "G": values[:, :, 1], "id.object": np.full((5, 7), 9)})
    assert image.layers == ("beauty", "Z", "N", "id.object")
    assert np.shares_memory(image["beauty"], image["B"]) and image["id.object"].dtype == np.uint32
    assert image.copy()["id.object"][0, 0] == 9
    assert (image.width, image.height) == (7, 5)


@pytest.mark.parametrize("channels, error", [
    (np.ones((4, 4)), ValueError), (np.ones((0, 4, 3)), ValueError), ({}, ValueError),
    ({"R": np.ones((2, 2)), "G": np.ones((2, 3))}, ValueError),
    ({"R": np.ones((2, 2), complex)}, TypeError), ("abc", ValueError),
    ({"R": np.array([["a", "b"]])}, TypeError), ({1: np.ones((2, 2))}, TypeError),
    ({"": np.ones((2, 2))}, ValueError), ({"R\0": np.ones((2, 2))}, ValueError),
    ({"id.object": np.full((2, 2), -1)}, ValueError), ({"id.object": np.full((2, 2), 1.5)}, ValueError)])
def test_arrays_that_are_no_image_are_refused(channels, error):
    with pytest.raises(error):
        nacre.Image(channels)


def test_an_image_is_an_array(image):
    array = np.asarray(image)
    assert array.shape == (48, 64, 3) and array.dtype == np.float32
    assert np.shares_memory(array, image["beauty"]) and np.array_equal(array, image["beauty"])
    assert np.asarray(image, np.float64).dtype == np.float64 and np.array(image, dtype=int).dtype == int
    assert not np.shares_memory(np.array(image), image["beauty"])
    assert np.mean(image) == image["beauty"].mean() and (image + np.zeros(3))[0, 0, 0] == image["R"][0, 0]
    assert np.asarray(nacre.Image({"Z": image["Z"]})).shape == (48, 64)
    assert np.asarray(nacre.Image({"id.object": image["id.object"]})).dtype == np.uint32
    with pytest.raises(ValueError, match="which layer.* N, Z$"):
        np.asarray(nacre.Image({"N": image["N"], "Z": image["Z"]}))
    # As numpy 2 calls it.
    assert np.shares_memory(image.__array__(copy=False), image["beauty"])
    assert not np.shares_memory(image.__array__(copy=True), image["beauty"])
    assert image.__array__(np.float64, copy=None).dtype == np.float64
    with pytest.raises(ValueError, match="copy"):
        image.__array__(np.float64, copy=False)
    picture = image.picture()
    assert np.asarray(picture).dtype == np.uint8 and np.array_equal(np.asarray(picture), picture.pixels)


def test_tone_mapping_is_that_of_png_files(image):
    codes = image.tone_map("diffuse", tonemap="aces", exposure=1)
    assert codes.shape == (48, 64, 3) and codes.dtype == np.uint8
    assert nacre.Image(np.full((2, 2, 3), np.nan)).tone_map()[0, 0].tolist() == [255, 0, 255]
    for wrong in {"tonemap": "acse"}, {"exposure": 99}, {"layer": "difuse"}:
        with pytest.raises(nacre.Error):
            image.tone_map(**wrong)
    for wrong in {"tonemap": 3}, {"exposure": "high"}, {"layer": None}:
        with pytest.raises(TypeError, match=next(iter(wrong))):
            image.tone_map(**wrong)


def test_metrics(image):
    other = image.copy()
    assert nacre.compare(other, image)
    other["G"][10:20] += 0.25
    found = other.compare(image, layers=["beauty"], perceptual=True)
    assert not found and "beauty" in str(found)
    difference = other["beauty"].astype(float) - image["beauty"]
    metrics = found.layers["beauty"]
    assert math.isclose(metrics.rmse, np.sqrt((difference**2).mean()), rel_tol=1e-6)
    assert math.isclose(metrics.max_abs, 0.25, rel_tol=1e-6) and metrics.flip > 0
    assert 0 < metrics.ssim < 1 and found.exceeding_pixels == 10 * 64
    assert nacre.compare(other, image, layers=["beauty"], max_abs=0.3)
    heat = nacre.heat_map(other, image, low=1e-3)
    assert heat.shape == (48, 64, 3) and (heat[0] == 0).all() and (heat[15] != 0).any()
    with pytest.raises(nacre.Error, match="scale"):
        nacre.heat_map(other, image, low=2)
    with pytest.raises(nacre.Error) as caught:
        nacre.compare(image, nacre.Image(np.ones((4, 4, 3))), layers=["beauty"])
    assert caught.value.exit_code == 2
    for wrong in nacre.compare, nacre.heat_map, nacre.difference:
        with pytest.raises(TypeError, match="nacre.Image"):
            wrong(image, image["beauty"])
    assert nacre.compare(image, image, layers="beauty")


def test_each_metric_is_that_of_its_definition(image):
    """Of two layers whose images and references have nothing in common."""
    rng = np.random.default_rng(4)
    got = {"beauty": rng.random((30, 40, 3)), "diffuse": 2 + rng.random((30, 40, 3))}
    reference = {"beauty": 4 + rng.random((30, 40, 3)), "diffuse": 0.5 * rng.random((30, 40, 3))}
    reference["diffuse"][3, 5:9] = 0
    a, b = nacre.Image(got), nacre.Image(reference)
    found = nacre.compare(a, b, max_abs=4)
    assert (found.pixels, set(found.layers)) == (1200, {"beauty", "diffuse"})
    for name, m in found.layers.items():
        x, r = a[name].astype(float), b[name].astype(float)
        d, some = x - r, r != 0
        expected = {"samples": x.size, "mean": x.mean(), "mean_reference": r.mean(), "rmse": np.sqrt((d**2).mean()),
                    "rel_mse": (d**2 / (r**2 + 1e-4)).mean(), "max_abs": np.abs(d).max(),
                    "max_rel": (np.abs(d)[some] / r[some]).max(), "zero_mismatches": (~some).sum(),
                    "psnr_db": 20 * np.log10(r.max() / np.sqrt((d**2).mean()))}
        for key, value in expected.items():
            assert math.isclose(getattr(m, key), value, rel_tol=1e-9), (name, key)  # sums in double
        assert m.layer == name and m.ssim is None and m.flip is None and m.hdr_flip is None
    beyond = (np.abs(a["beauty"] - b["beauty"]) > 4).any(axis=2) | (np.abs(a["diffuse"] - b["diffuse"]) > 4).any(axis=2)
    assert found.exceeding_pixels == beyond.sum() > 0
    # A layer that differs is found wherever it stands.
    for name in reference:
        other = b.copy()
        other[name][29, 39, 2] += 1
        found = nacre.compare(other, b)
        assert not found and found.exceeding_pixels == 1
        assert found.layers[name].max_abs == float(other[name][29, 39, 2]) - float(b[name][29, 39, 2]) > 0.9
        assert nacre.compare(other, b, layers=[n for n in reference if n != name])
        heat = nacre.heat_map(other, b, name, low=1e-3)
        assert (heat != 0).any(axis=2).sum() == 1 and heat[29, 39].any()


@pytest.mark.parametrize("value, other", [(np.nan, 1), (1, np.nan), (np.inf, 1), (np.inf, -np.inf), (np.inf, np.nan)])
def test_what_is_not_finite_in_one_image_alone_never_matches(value, other):
    a, b = nacre.Image(np.ones((40, 70, 3))), nacre.Image(np.ones((40, 70, 3)))
    a["B"][39, 69], b["B"][39, 69] = value, other
    for tolerances in {}, {"max_abs": 1e30}, {"max_abs": math.inf}, {"max_rel": math.inf}, {"max_rmse": 1e30}:
        assert not nacre.compare(a, b, **tolerances), tolerances
    b["B"][39, 69] = value
    assert nacre.compare(a, b)


def test_an_image_without_channels_is_compared_with_nothing():
    empty = nacre.Image(np.ones((4, 4, 3)))
    empty._block, empty._names, empty._types = empty._block[:0], [], []
    for pair in (empty, empty), (nacre.Image(np.ones((4, 4, 3))), empty):
        with pytest.raises(nacre.Error):
            nacre.compare(*pair)


def test_notebooks_show_pictures(image):
    png = image._repr_png_()
    assert png.startswith(b"\x89PNG")
    pair = nacre.side_by_side(image, image.tone_map("diffuse"), gap=2)
    assert pair.pixels.shape == (48, 130, 3)
    assert nacre.difference(image, image).pixels.shape[1] == 3 * 64 + 8
    with pytest.raises(ValueError):
        nacre.side_by_side(image["beauty"])
    with pytest.raises(ValueError):
        nacre.side_by_side()
    with pytest.raises(ValueError, match="gap"):
        nacre.side_by_side(image, image, gap=-1)
    with pytest.raises(nacre.Error, match="no notebook"):
        nacre.show(image)


def test_pictures_are_written(image, tmp_path):
    picture = image.picture()
    picture.write(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes() == picture.png()
    picture.write(tmp_path / "a.jpg")
    assert (tmp_path / "a.jpg").read_bytes().startswith(b"\xff\xd8")
    with pytest.raises(nacre.Error, match="extension"):
        picture.write(tmp_path / "a.gif")
    with pytest.raises(nacre.Error, match="extension"):
        image.write(tmp_path / "a.gif")
    with pytest.raises(nacre.Error) as caught:
        image.write(tmp_path / "no" / "a.exr")
    assert caught.value.exit_code == 74


def test_two_calls_write_one_picture(image, tmp_path, monkeypatch):
    first, second, replace = image.picture(), image.picture("diffuse"), os.replace

    def late(*names):  # another thread has written all of it meanwhile
        monkeypatch.setattr(os, "replace", replace)
        second.write(tmp_path / "a.png")
        assert (tmp_path / "a.png").read_bytes() == second.png()
        replace(*names)
    monkeypatch.setattr(os, "replace", late)
    first.write(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes() == first.png()
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


def test_pictures_are_written_through_links(image, tmp_path):
    (tmp_path / "far").mkdir()
    (tmp_path / "a.png").symlink_to("far/b")
    for _ in range(2):  # where there is nothing yet, and where there is
        image.picture().write(tmp_path / "a.png")
        assert (tmp_path / "a.png").is_symlink()
        assert (tmp_path / "far" / "b").read_bytes() == image.picture().png()
    os.mkfifo(tmp_path / "pipe.png")
    with pytest.raises(nacre.Error, match="not a regular file"):
        image.picture().write(tmp_path / "pipe.png")


@not_sanitized
def test_memory_is_flat():
    def resident():
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * 4096
    image = nacre.Image(np.ones((64, 64, 3)))
    before = 0
    for i in range(10_000):
        image.tone_map()
        nacre.Image({"R": image["R"]})["R"]
        if i == 1000:
            gc.collect()
            before = resident()
    gc.collect()
    # A leak of one array a call would be 440 MB.
    assert resident() - before < 8_000_000
