# SPDX-License-Identifier: Apache-2.0
"""What arguments are taken as. Each function refuses what is of another kind, and names it."""
import operator
import os
from typing import Any, Union

import numpy as np

PathLike = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]


def path(value: PathLike) -> bytes:
    """A file's name in the system's own bytes, whatever they are."""
    name = os.fsencode(value)
    if b"\0" in name:
        raise ValueError(f"no file can have the name {os.fsdecode(name)!r}")
    return name


def text(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} is a text, not {value!r}")
    try:
        value.encode()
    except UnicodeEncodeError:  # half of a pair of surrogates
        raise ValueError(f"{name} is no text that can be written: {value!r}") from None
    return value


def whole(value: Any, name: str) -> int:
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is a whole number, not {value!r}") from None
    if abs(number) >= 2**31:
        raise ValueError(f"{name} is out of range: {number}")
    return number


def real(value: Any, name: str) -> float:
    try:
        return float(value)
    except OverflowError:
        raise ValueError(f"{name} is out of range") from None
    except (TypeError, ValueError):
        raise TypeError(f"{name} is a number, not {value!r}") from None


def numbers(values: Any, name: str, kinds: str = "fiu") -> np.ndarray:
    """An array of real numbers of any type. Nothing stands for those that are masked."""
    try:
        array = np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise ValueError(f"{name} is no array: {error}") from None
    if array.dtype.kind not in kinds:
        raise TypeError(f"{name} is an array of {array.dtype}, not of real numbers")
    refuse_masked(values, name)
    return array


def refuse_masked(values: Any, name: str) -> None:
    if isinstance(values, np.ma.MaskedArray) and np.any(values.mask):
        raise ValueError(f"{name} is masked in part: give it values there, by its method filled")
