# SPDX-License-Identifier: Apache-2.0
"""The errors of the package."""
from typing import List, NamedTuple, Sequence, Tuple


class Fault(NamedTuple):
    """One thing that is wrong."""

    where: str  #: file and JSON pointer, as in "grid.json: /materials/gold/roughness"
    what: str
    hint: str  #: how to fix it; may be empty


class Error(Exception):
    """What nacre cannot do, with all that is wrong at once.

    `str(error)` is the text that the program `nacre` prints. `faults` lists each fault, and
    `exit_code` is the program's (sysexits.h): 2 for images that cannot be compared, 64 wrong
    arguments, 65 bad input, 70 an internal error or out of memory, 74 output that cannot be written.
    """

    def __init__(self, message: str, faults: Sequence[Tuple[str, str, str]] = (),
                 exit_code: int = 64) -> None:
        super().__init__(message, faults, exit_code)
        self.message = message
        self.faults: List[Fault] = [Fault(*fault) for fault in faults]
        self.exit_code = exit_code

    def __str__(self) -> str:
        return self.message


class Cancelled(Exception):
    """A render that `Session.cancel` has ended."""


# As which users know them.
Error.__module__ = Cancelled.__module__ = "nacre"


def fault(where: str, what: str, hint: str = "", exit_code: int = 64) -> Error:
    """An error of one fault."""
    text = f"error: {where}: {what}" + (f"\n  hint: {hint}" if hint else "")
    return Error(text, [(where, what, hint)], exit_code)
