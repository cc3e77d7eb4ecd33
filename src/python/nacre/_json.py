# SPDX-License-Identifier: Apache-2.0
"""Values of scenes as JSON text."""
import json
import os
import re
import sys
from typing import Any, Mapping, Optional, Tuple

import numpy as np

from ._arguments import refuse_masked
from ._errors import fault


def _not_finite(value: Any, place: str) -> Optional[Tuple[str, str]]:
    """The first number that no double holds, and where it is."""
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, Mapping):
        parts = [(str(key).replace("~", "~0").replace("/", "~1"), part) for key, part in value.items()]
    elif isinstance(value, (list, tuple)):
        parts = [(str(i), part) for i, part in enumerate(value)]
    else:
        is_wrong = isinstance(value, (int, float)) and not abs(value) <= sys.float_info.max
        return (place, str(value) if isinstance(value, float) else "the whole number") if is_wrong else None
    found = (_not_finite(part, f"{place}/{name}") for name, part in parts)
    return next(filter(None, found), None)


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
        wrong = None if "Circular" in str(error) else _not_finite(value, what)
        if not wrong:
            raise fault(what, "a name is no finite number" if "float" in str(error) else f"{error}") from None
    else:  # so many digits are what no double holds, or a text
        wrong = _not_finite(value, what) if re.search(r"[0-9]{309}", written) else None
    if wrong:
        raise fault(wrong[0], f"{wrong[1]} is no finite number", "numbers of scenes are finite")
    try:
        written.encode()
    except UnicodeEncodeError as error:  # half of a pair of surrogates
        around = written[max(error.start - 20, 0):error.end + 20]
        raise ValueError(f"{what}: there is no text that can be written at {around!r}") from None
    return written
