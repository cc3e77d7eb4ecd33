# SPDX-License-Identifier: Apache-2.0
"""Slips of the pen: operators and constants of a file changed one at a time, for `mutate.py FILE...`.

No text is written down for them, as it is for the faults of the list, so that they cost nobody
anything where code changes. Some change nothing that a test could see (a bound that is never met):
each that survives is a question, not a verdict.
"""
import random
import re

import fault_list

# What stands in the place of what. Spaces around operators keep templates and pointers out.
SWAPS = {
    " < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > ", " == ": " != ", " != ": " == ",
    " + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " && ": " || ", " || ": " && ",
    " += ": " -= ", " -= ": " += ", "++": "--", "std::min(": "std::max(", "std::max(": "std::min(",
    "true": "false", "false": "true", "hn::Add(": "hn::Sub(", "hn::Sub(": "hn::Add(",
    "hn::Mul(": "hn::Div(", "hn::Min(": "hn::Max(", "hn::Max(": "hn::Min(", "hn::Lt(": "hn::Ge(",
    "hn::Le(": "hn::Gt(", "hn::Gt(": "hn::Le(", "hn::Ge(": "hn::Lt(", "hn::MulAdd(": "hn::MulSub(",
    "hn::And(": "hn::Or(", "hn::Or(": "hn::And(", "if (!": "if (", "std::cos(": "std::sin(",
    "std::sin(": "std::cos(", "continue;": ";", "break;": ";",
}
WORDS = {"true", "false"}
SWAP = re.compile("|".join(rf"\b{re.escape(text)}\b" if text in WORDS else re.escape(text)
                           for text in sorted(SWAPS, key=len, reverse=True)))
NUMBER = re.compile(r"(?<![\w.])(\d+\.\d*|\d+)(?![\w.'])")
WHY = "A slip of the pen."
# Lines whose changes do not compile, or say nothing.
LEFT_OUT = re.compile(r"\s*(#|//|\*|using |namespace |template|static_assert|HWY_(BEFORE|AFTER|EXPORT|DYNAMIC)|\}|case )")
# The tests of a folder, cheapest first; of others the test of its name.
TESTS = {"brdf": ["brdf", "shading"], "light": ["light", "shading"], "hit": ["visibility"],
         "texture": ["texture", "shading"], "scene": ["scene", "scene_io"], "embree": ["visibility", "render"],
         "visibility": ["visibility", "render"], "shading": ["shading", "render"],
         "sampling": ["sampling", "render"], "view": ["view", "view_protocol"], "python": ["python"],
         "cli": ["cli"], "output": ["cli"], "color": ["color", "image_io"]}


def tests_of(path):
    """The tests that should see a slip in src/FOLDER/..."""
    folder = path.split("/")[1]
    return TESTS.get(folder, [folder])


def code_of(line):
    """The line with comments and strings blanked out, of the same length."""
    blank = lambda match: " " * len(match[0])
    return re.sub(r"//.*", blank, re.sub(r'"(\\.|[^"\\])*"', blank, line))


def changes_of(line):
    """(begin, end, replacement) of each slip in a line of code."""
    if LEFT_OUT.match(line):
        return
    code = code_of(line)
    for match in SWAP.finditer(code):
        yield match.start(), match.end(), SWAPS[match[0]]
    for match in NUMBER.finditer(code):
        number = match[0]
        yield match.start(), match.end(), repr(float(number) * 1.5 + 0.5) if "." in number else str(int(number) + 1)


def unique_part(path, lines, row, changed):
    """A Part that replaces one line, with as many lines around it as make it unique."""
    text = "\n".join(lines)
    for around in range(len(lines)):
        first, last = max(row - around, 0), min(row + around, len(lines) - 1) + 1
        find = "\n".join(lines[first:last])
        if text.count(find) == 1:
            return fault_list.Part(path, find, "\n".join(lines[first:row] + [changed] + lines[row + 1:last]))
    raise fault_list.ListError(f"{path}:{row + 1}: the line cannot be told from others")


def slips_of(path, text, most):
    """At most `most` slips of a file, always the same ones, as faults; in the order of its lines."""
    lines = text.split("\n")
    places = [(row, *change) for row, line in enumerate(lines) for change in changes_of(line)]
    chosen = sorted(random.Random(path).sample(places, min(most, len(places))))
    faults = []
    for row, begin, end, replacement in chosen:
        line = lines[row]
        changed = line[:begin] + replacement + line[end:]
        name = f"{path}:{row + 1}: {line[begin:end].strip()} -> {replacement.strip()}"
        fault = fault_list.Fault(name, tests_of(path), f"{path}:{row + 1}", WHY)
        fault.parts.append(unique_part(path, lines, row, changed))
        faults.append(fault)
    return faults
