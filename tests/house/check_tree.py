#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the tree itself: scripts run, no file is huge, each source file says what it is, and the
files that comments and READMEs name exist.

Long files are listed, not refused.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

MAX_BYTES = 2_000_000  # of any file: clones stay small
LONG_FILE, LONG_HEADER = 350, 150  # lines: over that, something may be off
SOURCE_FOLDERS = ("src", "tests", "bench")
SCRIPT_FOLDERS = ("scripts", ".ci")
CODE_SUFFIXES = (".h", ".cc", ".py", ".js", ".cmake", ".sh")
LICENSE_TAG = "SPDX-License-Identifier: " + "Apache-2.0"
# A source file or page that a text names, with or without folders. Not what a word goes on with
# (-inl.h), nor patterns ({a,b}_c.h, *.h).
NAMED_FILE = re.compile(r"(?<![\w./<{}*-])(?:\.\./)*(\w[\w./-]*\.(?:h|cc|py|md))(?![\w/*(])")
PRODUCT = re.compile(r"\w\.h")  # n.h and v.h: of the normal or the view direction and the half vector
# Files of others, and those that the program or its user writes.
NO_FILES_OF_OURS = ("AgX.py", "answer.md", "sysexits.h")
COMMENT = {"//": re.compile(r"(?:^|\s)//(.*)"), "#": re.compile(r"(?:^|\s)# (.*)")}
FENCE = re.compile(r"^```.*?^```$", re.M | re.S)


def list_files(root):
    """All files that are, or would be, in the repository; without git, all files."""
    # safe.directory: the tree may belong to somebody else, as it does in many containers.
    git = ["git", "-c", f"safe.directory={root}", "-C", str(root)]
    listing = subprocess.run(
        git + ["ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        capture_output=True, check=False)
    if listing.returncode == 0:
        names = [os.fsdecode(name) for name in listing.stdout.split(b"\0") if name]
    else:
        names = [path.relative_to(root).as_posix() for path in root.rglob("*")
                 if not re.fullmatch(r"build.*|out|\.git", path.relative_to(root).parts[0])]
    return sorted(name for name in set(names) if (root / name).is_file())


def first_lines(path):
    """The first two, without their ends; "" for one that is not there."""
    with open(path, encoding="utf-8", errors="replace") as file:
        return [file.readline().rstrip("\n") for _ in range(2)]


def first_line(path):
    return first_lines(path)[0]


def check_size(root, name):
    size = (root / name).stat().st_size
    if size > MAX_BYTES:
        yield f"{name}: {size} bytes, over {MAX_BYTES}"


def check_script(root, name):
    """A script has #! and the run bit, and its shell code is sound."""
    path = root / name
    if path.parent.relative_to(root).as_posix() not in SCRIPT_FOLDERS:
        return
    first = first_line(path)
    if not path.suffix and not first.startswith("#!"):
        yield f"{name}:1: no #! line"
    if first.startswith("#!") and not os.access(path, os.X_OK):
        yield f"{name}: has no run bit"
    if path.suffix != ".sh" and not first.endswith("bash"):
        return
    tools = [["bash", "-n"]]
    if shutil.which("shellcheck"):
        tools.append(["shellcheck", "--format=gcc", "-x", "--source-path=SCRIPTDIR"])
    for tool in tools:
        result = subprocess.run(tool + [name], cwd=root, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            yield f"{name}: {' '.join(tool)}:\n{(result.stdout + result.stderr).rstrip()}"


def check_license(root, name):
    """Every source file and script names its licence in its first line, or under #!."""
    path = root / name
    code = path.suffix in CODE_SUFFIXES or path.name == "CMakeLists.txt"
    if not code and not first_line(path).startswith("#!"):
        return
    if not any(line in (f"// {LICENSE_TAG}", f"# {LICENSE_TAG}") for line in first_lines(path)):
        yield f"{name}:1: no line with {LICENSE_TAG}"


def check_first_line(root, name):
    """Under its licence a source file has a comment; a .cc beside its .h may include that."""
    path = root / name
    if path.suffix not in (".h", ".cc") or path.relative_to(root).parts[0] not in SOURCE_FOLDERS:
        return
    first = next((line for line in first_lines(path) if not line.endswith(LICENSE_TAG)), "")
    header = path.with_suffix(".h")
    own = re.fullmatch(r'#include "(.+)"', first)
    if path.suffix == ".cc" and own and header.is_file() and header.as_posix().endswith(
            f"/{own.group(1)}"):
        return
    if not re.match(r"// \S", first):
        yield f"{name}:1: the first line does not say what the file is"


def texts_of(root, name):
    """(line number, text) of a file's comments; of a README all lines but its fenced blocks."""
    path = root / name
    cpp = path.suffix in (".h", ".cc")
    if not cpp and path.name not in ("README.md", "CMakeLists.txt") and (
            path.suffix not in CODE_SUFFIXES and path.parts[-2] != "scripts"):
        return
    text = path.read_text(encoding="utf-8", errors="replace")
    if path.name == "README.md":
        text = FENCE.sub(lambda block: "\n" * block.group().count("\n"), text)
    comment = COMMENT["//" if cpp or path.suffix == ".js" else "#"]
    for number, line in enumerate(text.split("\n"), 1):
        found = comment.search(line)
        if path.name == "README.md":
            yield number, line
        elif found:
            yield number, found.group(1)


def check_named_files(root, names):
    """Every source file and page that a comment or a README names is there, in some folder."""
    ends = {"/".join(parts[i:]) for parts in (name.split("/") for name in names)
            for i in range(len(parts))}
    for name in names:
        for number, text in texts_of(root, name):
            for named in NAMED_FILE.findall(text):
                if PRODUCT.fullmatch(named) or named in NO_FILES_OF_OURS or "NAME" in named:
                    continue
                if named not in ends:
                    yield f"{name}:{number}: names {named}, which is not there"


def long_files(root, names):
    """(lines, name) of source files longer than this house likes, longest first."""
    found = []
    for name in names:
        path = pathlib.PurePath(name)
        if path.parts[0] in SOURCE_FOLDERS and path.suffix in (".h", ".cc", ".py"):
            lines = (root / name).read_bytes().count(b"\n")
            if lines > (LONG_HEADER if path.suffix == ".h" else LONG_FILE):
                found.append((lines, name))
    return sorted(found, reverse=True)


def check(root):
    """All faults of the tree at `root`, and the names of the files looked at."""
    names = list_files(root)
    faults = [fault for name in names for check_file in (check_size, check_script, check_license,
                                                     check_first_line)
              for fault in check_file(root, name)]
    return faults + list(check_named_files(root, names)), names


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", type=pathlib.Path, help="the root of the repository")
    root = parser.parse_args().root.resolve()
    faults, names = check(root)
    for lines, name in long_files(root, names):
        print(f"note: {name}: {lines} lines")
    for fault in faults:
        print(fault)
    print(f"{len(names)} files, {len(faults)} faults")
    # No file read is a fault too: a check that saw nothing has checked nothing.
    return 1 if faults or not names else 0


if __name__ == "__main__":
    sys.exit(main())
