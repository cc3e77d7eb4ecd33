# SPDX-License-Identifier: Apache-2.0
"""The package as a whole: what it shows, and what it says of it."""
import inspect
import pydoc
import subprocess
import sys

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
