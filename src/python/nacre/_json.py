# SPDX-License-Identifier: Apache-2.0
"""Values of scenes as JSON text."""
import json
from typing import Any

import numpy as np

from ._errors import fault


def to_json(value: Any, what: str) -> str:
    """The JSON text of a value that may hold numpy's numbers and arrays."""
    def plain(other: Any) -> Any:
        if isinstance(other, (np.ndarray, np.generic)):
            return other.tolist()
        raise TypeError(f"{what}: a {type(other).__name__} is no value of a scene: these are numbers, "
                        "texts, lists and dictionaries")
    try:
        return json.dumps(value, allow_nan=False, default=plain)
    except ValueError as error:
        raise fault(what, f"{error}", "numbers of scenes are finite") from None
