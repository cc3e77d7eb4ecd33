# SPDX-License-Identifier: Apache-2.0
"""Tables of BRDFs: their values, files, and what is found wrong with those of others."""
import json
import subprocess

import numpy as np
import pytest

import nacre
from models import WHITE_METAL, ggx

UP = (0.0, 0.0, 1.0)
PLASTIC = dict(base_color=(0.7, 0.4, 0.2), specular_roughness=0.4)
COATED = dict(PLASTIC, coat_weight=1, coat_roughness=0.3, coat_color=(0.9, 0.6, 0.4))


def small(model="open_pbr", **parameters):
    return nacre.table(model, theta_light=[0, 30, 75], theta_view=[20, 60], phi=[0, 100, 180],
                       **parameters)


def test_a_table_is_what_the_model_evaluates():
    table, brdf = small(**COATED), nacre.Brdf("open_pbr", **COATED)
    light, view = table["light"], table["view"]
    np.testing.assert_allclose(table["f"] * light[:, 2:], brdf.evaluate(UP, view, light), rtol=1e-14)
    np.testing.assert_array_equal(table["pdf"], brdf.pdf(UP, view, light))
    np.testing.assert_allclose(table["albedo"], brdf.albedo(view[:, 2]), rtol=1e-14)
    lobes = sum(table[lobe] for lobe in table.header["lobes"])
    np.testing.assert_allclose(lobes, table["f"], rtol=1e-14)
    assert table.header["material"]["coat_color"] == [0.9, 0.6, 0.4]
    assert len(table) == 14 and "coat" in table and "fuzz" not in table
    assert table.array["f_g"][3] == table["f_g"][3]
    with pytest.raises(KeyError, match="fuzz"):
        table["fuzz"]


def test_directions_are_arrays_or_tables():
    grid = small(**PLASTIC)
    pair = (grid["light"], grid["view"])
    for directions in pair, grid, dict(light=pair[0], view=pair[1]), grid.array:
        other = nacre.table("open_pbr", directions, albedo=False, **PLASTIC)
        np.testing.assert_array_equal(other["f"], grid["f"])
        assert "albedo" not in other
    one = nacre.table("lambert", (UP, [[0.6, 0, 0.8], [0, 0.6, 0.8]]))
    assert len(one) == 2
    with pytest.raises(nacre.Error, match="length 2"):
        nacre.table("lambert", ([(0, 0, 2)], [UP]))
    with pytest.raises(TypeError, match="grid"):
        nacre.table("lambert", pair, phi=[0])


@pytest.mark.parametrize("kind", ["csv", "json", "npy"])
def test_files_keep_everything(tmp_path, kind):
    table = small(**COATED)
    table.write(tmp_path / f"a.{kind}")
    read = nacre.read_table(tmp_path / f"a.{kind}")
    assert read.columns == table.columns
    np.testing.assert_array_equal(read.values, table.values)
    if kind == "npy":
        loaded = np.load(tmp_path / "a.npy")  # no pickle
        np.testing.assert_array_equal(loaded["specular_r"], table["specular_r"])
        assert json.loads((tmp_path / "a.npy.json").read_text()) == table.header
    else:
        assert read.header["material"] == table.header["material"]


def test_numpys_files_are_read_whatever_they_are(tmp_path):
    table = small(**PLASTIC)
    nine = np.concatenate([table["light"], table["view"], table["f"]], axis=1)
    named = np.empty(len(nine), [("light", "<f4", 3), ("view", ">f4", 3), ("f", "<f4", 3)])
    named["light"], named["view"], named["f"] = table["light"], table["view"], table["f"]
    for array in nine, np.asfortranarray(nine), nine.astype(">f4"), named:
        np.save(tmp_path / "a.npy", array)
        assert nacre.check_table(tmp_path / "a.npy", "open_pbr", quiet=True, **PLASTIC)
    np.save(tmp_path / "o.npy", np.array([[object()]]), allow_pickle=True)
    with pytest.raises(nacre.Error, match="pickled objects"):
        nacre.read_table(tmp_path / "o.npy")
    np.savetxt(tmp_path / "a.csv", nine)  # blanks between, no names
    assert nacre.check_table(tmp_path / "a.csv", "open_pbr", quiet=True, **PLASTIC)


def test_a_right_table_agrees(capsys):
    table = small(**COATED)
    found = nacre.check_table(table, "open_pbr", **COATED)
    assert found and found.explanation == [] and repr(found) == "<nacre.TableCheck of table: ok>"
    assert capsys.readouterr().out == str(found)


@pytest.mark.parametrize("change, words", [
    (lambda t: np.pi * t["f"], "all of f is times pi"),
    (lambda t: t["f"] * t["light"][:, 2:], "n.l is part of f"),
    (lambda t: t["f"] - t["coat"], 'the lobe "coat" is missing'),
    (lambda t: small(**dict(COATED, specular_roughness=0.4**0.5))["f"],
     "specular_roughness is taken for alpha"),
    (lambda t: small(**dict(COATED, coat_color=(0.81, 0.36, 0.16)))["f"], "coat_color is squared"),
    (lambda t: small(rules="adobe", **COATED)["f"], "rules: adobe"),
    (lambda t: small(smith="separable", **COATED)["f"], "smith: separable")])
def test_mistakes_are_told(change, words):
    table = small(**COATED)
    found = nacre.check_table(dict(light=table["light"], view=table["view"], f=change(table)),
                              "open_pbr", tolerance=1e-5, quiet=True, **COATED)
    assert not found
    everything = found.explanation + [also["what"] for also in found.numbers["also"]]
    assert any(words in what for what in everything), str(found)
    assert words in str(found)


def test_functions_are_checked_without_a_file():
    parameters = dict(WHITE_METAL, roughness=0.4)
    assert nacre.check_table(ggx(0.16), "metallic_roughness", quiet=True, **parameters)
    wrong = nacre.check_table(ggx(0.4), "metallic_roughness", quiet=True, **parameters)
    assert not wrong and "roughness is taken for alpha" in wrong.explanation[0]
    table = nacre.table(ggx(0.16), phi=[0, 90])
    assert table.header["material"]["model"] == "function" and "pdf" not in table


def test_the_program_says_the_same(tmp_path, program):
    small(rules="materialx", **COATED).write(tmp_path / "x.npy")
    material = json.dumps(dict(COATED, model="open_pbr"))
    done = subprocess.run([program, "table", material, "--check", str(tmp_path / "x.npy")],
                          capture_output=True, text=True, check=False)
    found = nacre.check_table(tmp_path / "x.npy", "open_pbr", quiet=True, **COATED)
    assert done.returncode == 1 and done.stdout == str(found)


def test_wrong_arguments_are_refused():
    table = small(**PLASTIC)
    with pytest.raises(TypeError, match="Table, arrays by name"):
        nacre.check_table(7, "open_pbr", quiet=True)
    with pytest.raises(TypeError, match="one of nacre's models"):
        nacre.check_table(table, nacre.Brdf(ggx(0.2)), quiet=True)
    with pytest.raises(ValueError, match="tolerance"):
        nacre.check_table(table, "open_pbr", tolerance=-1, quiet=True)
    with pytest.raises(nacre.Error, match="has no columns view_x"):
        nacre.check_table(dict(light=table["light"], f=table["f"]), "open_pbr", quiet=True)
    with pytest.raises(ValueError, match="rows"):
        nacre.check_table(dict(light=table["light"], f=[1.0]), "open_pbr", quiet=True)
    with pytest.raises(ValueError, match="columns"):
        nacre.Table(["a"], [[1, 2]])
    with pytest.raises(nacre.Error, match="ends in .csv"):
        table.write("a.txt")
