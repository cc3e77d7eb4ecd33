# SPDX-License-Identifier: Apache-2.0
"""Values of scenes as JSON text."""
import json
import os
from typing import Any

import numpy as np

from ._arguments import refuse_masked
from ._errors import fault


def to_json(value: Any, what: str) -> str:
    """The JSON text of a value that may hold numpy's numbers and arrays."""
    def plain(other: Any) -> Any:
        if isinstance(other, (np.ndarray, np.generic)):
            refuse_masked(other, "the array")
            return other.tolist()
        if isinstance(other, os.PathLike):
            return os.fspath(other)
        raise TypeError(f"{what}: a {type(other).__name__} is no value of a scene: these are numbers, "
                        "texts, lists and dictionaries")
    try:
        written = json.dumps(value, allow_nan=False, ensure_ascii=False, default=plain)
    except RecursionError:
        raise ValueError(f"{what}: lists in lists in lists are too deep") from None
    except ValueError as error:
        hint = "numbers of scenes are finite" if "float" in str(error) else ""
        raise fault(what, f"{error}", hint) from None
    try:
        written.encode()
    except UnicodeEncodeError as error:  # half of a pair of surrogates
        around = written[max(error.start - 20, 0):error.end + 20]
        raise ValueError(f"{what}: there is no text that can be written at {around!r}") from None
    return written
