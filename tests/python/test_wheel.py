# SPDX-License-Identifier: Apache-2.0
"""The wheel, and the examples of the README."""
import os
import pathlib
import re
import subprocess
import sys
import zipfile

from conftest import SOURCE, module

sys.path.insert(0, str(SOURCE / "src/python"))
import build_wheel  # noqa: E402 pylint: disable=wrong-import-position


def test_a_wheel_is_whole(tmp_path):
    build = os.environ["NACRE_BUILD"]
    name = build_wheel.build_wheel(str(tmp_path), {"build-folder": build})
    assert re.fullmatch(r"nacre-[\d.]+-cp\d+-cp\d+-linux_\w+\.whl", name)
    place = tmp_path / "site"
    with zipfile.ZipFile(tmp_path / name) as wheel:
        wheel.extractall(place)
        names = wheel.namelist()
    assert {"nacre/__init__.py", "nacre/py.typed", "nacre/libnacre.so.0"} <= set(names)
    record = (place / next(n for n in names if n.endswith("RECORD"))).read_text()
    assert [line.split(",")[0] for line in record.splitlines()] == names
    code = ("import nacre, pathlib; print(pathlib.Path(nacre.__file__).parent);"
            "nacre.Scene().render(width=8, height=8);"
            "print([l.split()[-1] for l in open('/proc/self/maps') if 'libnacre' in l][0])")
    environment = {**os.environ, "PYTHONPATH": str(place)}
    out = subprocess.run([sys.executable, "-c", code], env=environment, check=True, cwd=tmp_path,
                         capture_output=True, text=True).stdout.split()
    assert [pathlib.Path(line) for line in out] == [place / "nacre", place / "nacre/libnacre.so.0"]


def test_pip_makes_the_same_wheel(tmp_path):
    module("pip")
    pip = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-build-isolation", "--no-deps",
           "--wheel-dir", tmp_path, SOURCE / "src/python", "--config-settings"]
    build = os.environ["NACRE_BUILD"]
    subprocess.run([*pip, f"build-folder={build}"], check=True, env={**os.environ, "PIP_NO_INDEX": "1"})
    made, = tmp_path.iterdir()
    assert made.name == build_wheel.build_wheel(str(tmp_path / ".."), {"build-folder": build})
    assert made.read_bytes() == (tmp_path / ".." / made.name).read_bytes()
    # What is not built is told in one line, with the command.
    done = subprocess.run([*pip, f"build-folder={tmp_path}"], check=False, capture_output=True, text=True)
    assert done.returncode == 1 and "Traceback" not in done.stderr, done.stderr
    assert "--target nacre_python" in done.stderr


def test_the_readme_runs(tmp_path):
    text = (SOURCE / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", text, re.M | re.S)
    assert blocks
    (tmp_path / "scenes").symlink_to(SOURCE / "scenes")
    for block in blocks:
        (tmp_path / "example.py").write_text(block)
        done = subprocess.run([sys.executable, "example.py"], cwd=tmp_path, capture_output=True,
                              text=True, check=False)
        assert done.returncode == 0, done.stderr
        if "nacre.check" in block:
            assert re.search("ok +agrees", done.stdout), done.stdout
