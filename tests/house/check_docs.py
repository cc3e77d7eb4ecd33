#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the READMEs: links lead somewhere, the source files that they name are there, and every
picture is made by a script of the tree.

Pictures of scenes/gallery come from scripts/gallery (its --list) or, bench_*, from bench/figures.py;
what lies there and no README shows is a fault too, but for the SVG twin of a diagram. Diagrams of
speed are drawn on a quiet machine, by hand: one that is not there yet is told and is no fault.

Where a README says `grep -rlw WORD src`, it goes on to name every file of src/ that holds the word: so
the lists of what a new light or command touches stay whole.
"""
import argparse
import ast
import pathlib
import re
import subprocess
import sys

GALLERY = "scenes/gallery"
# Text or a picture in brackets, then the target.
LINK = re.compile(r"!?\[(?:[^\[\]]|!\[[^\]]*\]\([^)]*\))*\]\(([^)\s]+)\)")
PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```.*?^```$", re.M | re.S)
# A source file in backquotes; NAME stands for the name of what is added.
SOURCE_FILE = re.compile(r"`(\w[\w./-]*\.(?:h|cc|py|in))`")
USERS = re.compile(r"`grep -rlw (\w+) src`")


def readmes(root):
    """All README.md of the tree, but not of its builds."""
    return sorted(path for path in root.rglob("README.md")
                  if not re.fullmatch(r"build.*|out|\.git", path.relative_to(root).parts[0]))


def anchor(heading):
    """What a heading is called in links, as GitHub and GitLab have it."""
    words = re.sub(r"[^\w\- ]", "", heading.replace("`", "").strip().lower())
    return words.replace(" ", "-")


def prose(path):
    """The text without its fenced blocks."""
    return FENCE.sub("", path.read_text())


def headings(path):
    return {anchor(text) for text in re.findall(r"^#+ (.+)$", prose(path), re.M)}


def check_links(root, path):
    name = path.relative_to(root).as_posix()
    for target in LINK.findall(prose(path)):
        if re.match(r"\w+:", target):
            continue  # of the web: not looked at
        file, _, part = target.partition("#")
        there = path if not file else path.parent / file
        if not there.exists():
            is_bench = target.endswith(".png") and there.stem in made_by_bench(root)
            yield f"{'note: ' if is_bench else ''}{name}: {target}: there is no such file"
            continue
        page = there / "README.md" if there.is_dir() else there
        if part and part not in headings(page):
            yield f"{name}: {target}: no heading of that name"


def sources(root):
    """All source files of the tree, by their paths in it."""
    return {path.relative_to(root).as_posix() for path in root.rglob("*")
            if path.suffix in (".h", ".cc", ".py", ".in")
            and not re.fullmatch(r"build.*|out|\.git", path.relative_to(root).parts[0])}


def check_source_files(page, text, files):
    for name in SOURCE_FILE.findall(text):
        if "NAME" not in name and not any(f"/{file}".endswith(f"/{name}") for file in files):
            yield f"{page}: {name}: there is no such file"


def check_lists(root, page, text, files):
    """Up to the next list or heading the files that hold the word are named, each."""
    for match in USERS.finditer(text):
        part = re.split(r"^#|`grep ", text[match.end():], maxsplit=1, flags=re.M)[0]
        named = [re.escape(name).replace("NAME", r"\w+") for name in SOURCE_FILE.findall(part)]
        word = re.compile(rf"\b{match.group(1)}\b")
        users = [file for file in sorted(files) if re.fullmatch(r"src/.*\.(h|cc)", file)
                 and word.search((root / file).read_text())]
        if not users:
            yield f"{page}: no file of src/ holds {match.group(1)}"
        for file in users:
            if not any(re.search(rf"(^|/){name}$", file) for name in named):
                yield f"{page}: {file} holds {match.group(1)} and is not named"


def made_by_gallery(root):
    result = subprocess.run(["bash", root / "scripts/gallery", "--list"], capture_output=True,
                            text=True, check=True)
    return set(result.stdout.split())


def made_by_bench(root):
    """The keys of ALL in bench/figures.py."""
    for node in ast.parse((root / "bench/figures.py").read_text()).body:
        if isinstance(node, ast.Assign) and node.targets[0].id == "ALL":
            return {key.value for key in node.value.keys}
    return set()


def check_pictures(root, pages):
    made = {f"{GALLERY}/{name}.png" for name in made_by_gallery(root) | made_by_bench(root)}
    shown = set()
    for page in pages:
        name = page.relative_to(root).as_posix()
        for words, target in PICTURE.findall(prose(page)):
            file = (page.parent / target).resolve()
            picture = file.relative_to(root).as_posix() if file.is_relative_to(root) else target
            shown.add(picture)
            if picture not in made:
                yield f"{name}: {target}: neither scripts/gallery nor scripts/bench makes it"
            if not words:
                yield f"{name}: {target}: no words for those who cannot see it"
    for file in sorted((root / GALLERY).glob("*.png")):
        if f"{GALLERY}/{file.name}" not in shown:
            yield f"{GALLERY}/{file.name}: no README shows it"


def check(root):
    """All faults, and the pages looked at."""
    pages = readmes(root)
    files = sources(root)
    faults = [fault for page in pages for fault in check_links(root, page)]
    for page in pages:
        name = page.relative_to(root).as_posix()
        faults += check_source_files(name, prose(page), files)
        faults += check_lists(root, name, prose(page), files)
    return faults + list(check_pictures(root, pages)), pages


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", type=pathlib.Path, help="the root of the repository")
    faults, pages = check(parser.parse_args().root.resolve())
    for fault in faults:
        print(fault)
    faults = [fault for fault in faults if not fault.startswith("note: ")]
    print(f"{len(pages)} READMEs, {len(faults)} faults")
    # No page read is a fault too: a check that saw nothing has checked nothing.
    return 1 if faults or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
