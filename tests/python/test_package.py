# SPDX-License-Identifier: Apache-2.0
"""The package as a whole: what it shows, and what it says of it."""
import inspect
import os
import pathlib
import pydoc
import re
import shutil
import subprocess
import sys
import sysconfig

import pytest

import nacre
from conftest import module, not_sanitized


def test_everything_shown_is_documented():
    for name in nacre.__all__:
        thing = getattr(nacre, name)
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    assert inspect.getdoc(value), f"{name}.{member}"
    assert "Scene" in pydoc.render_doc(nacre)


def test_versions_and_targets():
    assert nacre.__version__ == "0.2.0"
    assert nacre.active_target() in nacre.supported_targets()
    with pytest.raises(nacre.Error, match="cannot run"):
        nacre.set_target("mmx")
    assert '"$schema"' in nacre.scene_schema()


def failed_import(folder, *options):
    """The line that `import nacre` ends with, of the package in the folder."""
    done = subprocess.run([sys.executable, *options, "-c", "import nacre"], check=False, text=True,
                          capture_output=True, env={**os.environ, "PYTHONPATH": str(folder)})
    assert done.returncode == 1 and "During handling" not in done.stderr, done.stderr
    return done.stderr.splitlines()[-1]


@pytest.mark.parametrize("module_name, says", [
    (None, r"ImportError: nacre's compiled module is not built in .*/nacre: scripts/build, .*"),
    ("_nacre.cpython-399-x86_64-linux-gnu.so",
     r"ImportError: nacre's compiled module is for Python 3\.99, and this is 3\.\d+: run python3\.99, .*"),
    (f"_nacre{sysconfig.get_config_var('EXT_SUFFIX')}",
     r"ImportError: nacre's compiled module cannot be loaded, build it anew \(.*: file too short\): .*")])
def test_a_module_that_is_not_there_is_told_in_one_line(tmp_path, module_name, says):
    shutil.copytree(pathlib.Path(nacre.__file__).parent, tmp_path / "nacre",
                    ignore=shutil.ignore_patterns("_nacre*.so"))
    if module_name:
        (tmp_path / "nacre" / module_name).touch()
    assert re.fullmatch(says, failed_import(tmp_path))


def test_a_python_without_numpy_is_told_in_one_line():
    line = failed_import(pathlib.Path(nacre.__file__).parents[1], "-S")  # no packages of Debian's
    assert re.fullmatch(r"ImportError: nacre needs numpy, which .* does not have: run /usr/bin/python3, .*", line)


def test_it_prints_nothing():
    done = subprocess.run([sys.executable, "-c", "import nacre; nacre.Scene().render(width=8, height=8)"],
                          capture_output=True, check=True)
    assert done.stdout == done.stderr == b""


@not_sanitized
def test_types_are_sound():
    mypy = module("mypy.api")
    package = nacre.__path__[0]
    out, _, status = mypy.run(["--strict", "--allow-any-generics", "--no-warn-return-any",
                               "--ignore-missing-imports", "--cache-dir=/dev/null", "-p", "nacre"])
    assert status == 0, out
    assert package
