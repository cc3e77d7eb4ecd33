# SPDX-License-Identifier: Apache-2.0
"""The list of faults: tests/mutation/faults/*.txt, read and checked. No building here.

    fault NAME: TEST...
      Why a person could make this mistake.
    @ PATH
    - text of the tree, which occurs in that file exactly once
    + text that takes its place

TESTs are names of ctest, cheapest first: brdf stands for brdf and brdf_table, shading for
shading and shading_long. A text may have several lines, and a fault several @ parts: a
misunderstanding, unlike a slip, is in both twins of a formula.
A text begins and ends anywhere in its lines. Lines that begin with # are comments.
"""
import dataclasses
import pathlib
import re

# ctests that are no folder of tests/ with a program of its own, and what to build for them.
OTHER_TESTS = {"cli": "nacre", "references": "nacre", "report_browser": "nacre",
               "scene_schema": None, "tiles": "nacre", "farm_local": "nacre", "cli_options": "nacre",
               "cli_security": "nacre", "cli_images": "nacre", "cli_watch": "nacre",
               "view_attack": "nacre", "view_protocol": "nacre", "view_browser": "nacre",
               "python": "nacre nacre_python"}


class ListError(Exception):
    """A mistake of the list, as PLACE: what."""


@dataclasses.dataclass
class Part:
    path: str
    find: str
    replace: str


@dataclasses.dataclass
class Fault:
    name: str
    tests: list[str]
    place: str  # FILE:LINE of the list
    why: str = ""
    parts: list[Part] = dataclasses.field(default_factory=list)


def parse(text, file):
    """The faults of one file of the list."""
    faults, find, replace = [], [], []

    def finish_part():
        if faults and faults[-1].parts:
            part = faults[-1].parts[-1]
            part.find, part.replace = "\n".join(find), "\n".join(replace)
        find.clear()
        replace.clear()

    for number, line in enumerate(text.splitlines(), 1):
        place = f"{file}:{number}"
        if line.startswith("fault "):
            finish_part()
            head = re.fullmatch(r"fault ([a-z0-9_]+): ([a-z0-9_ ]+)", line)
            if not head:
                raise ListError(f"{place}: a fault begins \"fault NAME: TEST...\"")
            faults.append(Fault(head[1], head[2].split(), place))
        elif line.startswith("#") or not line.strip():
            continue
        elif not faults:
            raise ListError(f"{place}: text before the first fault")
        elif line.startswith("@ "):
            finish_part()
            faults[-1].parts.append(Part(line[2:].strip(), "", ""))
        elif line.startswith("  ") and not faults[-1].parts:
            faults[-1].why = f"{faults[-1].why} {line.strip()}".strip()
        elif faults[-1].parts and (line[:2] in ("- ", "+ ") or line in ("-", "+")):
            (find if line[0] == "-" else replace).append(line[2:])
        else:
            raise ListError(f"{place}: neither a path nor a text nor a reason: {line}")
    finish_part()
    return faults


def read_list(folder):
    """All faults, in the order of the files' names."""
    faults = []
    for path in sorted(pathlib.Path(folder).glob("*.txt")):
        faults += parse(path.read_text(encoding="utf-8"), path.name)
    return faults


def plant(fault, root):
    """{path: content with the fault}; a ListError unless each text occurs exactly once."""
    contents = {}
    for part in fault.parts:
        try:
            content = contents.get(part.path) or (root / part.path).read_text(encoding="utf-8")
        except OSError as error:
            raise ListError(f"{fault.place}: {fault.name}: {part.path}: {error.strerror}") from error
        count = content.count(part.find) if part.find else 0
        if count != 1:
            raise ListError(f"{fault.place}: {fault.name}: {part.path} holds the text {count} "
                            "times, and should once")
        if part.find == part.replace:
            raise ListError(f"{fault.place}: {fault.name}: the text takes its own place")
        contents[part.path] = content.replace(part.find, part.replace)
    return contents


def check(faults, root):
    """All mistakes of the list, as texts."""
    mistakes, names = [], set()
    for fault in faults:
        if fault.name in names:
            mistakes.append(f"{fault.place}: a second fault {fault.name}")
        names.add(fault.name)
        if not fault.why or not fault.parts:
            mistakes.append(f"{fault.place}: {fault.name}: no reason, or nothing to replace")
        for test in fault.tests:
            if test not in OTHER_TESTS and not list((root / "tests" / test).glob("*_test.cc")):
                mistakes.append(f"{fault.place}: {fault.name}: there is no test {test}")
        try:
            plant(fault, root)
        except ListError as error:
            mistakes.append(str(error))
    return mistakes
