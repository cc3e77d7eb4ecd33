# SPDX-License-Identifier: Apache-2.0
"""What the tests of the Python package share. PYTHONPATH names the folder of the package under test."""
import os
import pathlib

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture
def scenes():
    return SOURCE / "scenes"


@pytest.fixture
def program():
    return os.environ["NACRE_PROGRAM"]
