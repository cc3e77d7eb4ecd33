# SPDX-License-Identifier: Apache-2.0
"""What the tests of the Python package share. PYTHONPATH names the folder of the package under test."""
import importlib
import os
import pathlib

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def module(name):
    """A module that tests are skipped without, but where nothing may be skipped."""
    if os.environ.get("NACRE_SKIP_NOTHING"):
        return importlib.import_module(name)
    return pytest.importorskip(name)


# With a sanitizer memory is not given back, and all is many times slower.
not_sanitized = pytest.mark.skipif("NACRE_SANITIZED" in os.environ, reason="a sanitizer runs")


@pytest.fixture
def scenes():
    return SOURCE / "scenes"


@pytest.fixture
def program():
    return os.environ["NACRE_PROGRAM"]
