#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests check_docs.py: a small sound tree has no faults, and each planted fault is found."""
import pathlib
import tempfile
import unittest

import check_docs

SOUND = {
    "README.md": "# A\n[b](sub/README.md#two-words) [c](#a) [web](https://example.org/x)\n"
                 "![one](scenes/gallery/one.png)\n```\n[not](a-link)\n```\n## `b` it's\n"
                 "[d](#b-its) [folder](sub)\n",
    "sub/README.md": "# X\n## Two words\n| ![t](../scenes/gallery/bench_t.png) |\n",
    "src/README.md": "## Adding\n`grep -rlw Spot src`: `src/light.h`, `read_NAME.cc`.\n## Else\n"
                     "`cone.h`\n",
    "src/light.h": "struct Spot;",
    "src/io/read_spot.cc": "Spot Read();",
    "src/cone.h": "struct Spotted;",
    "scripts/gallery": "echo one\n",
    "bench/figures.py": 'ALL = {"bench_t": None}\n',
    "scenes/gallery/one.png": "",
    "scenes/gallery/bench_t.png": "",
    "scenes/gallery/bench_t.svg": "",
    "build/README.md": "[gone](nowhere)\n",
}


def faults_of(changes):
    """What the check says of the sound tree with some files added or replaced (None: removed)."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve()
        for name, text in {**SOUND, **changes}.items():
            if text is not None:
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
        return check_docs.check(root)[0]


class CheckDocsTest(unittest.TestCase):
    def test_a_sound_tree_has_no_faults(self):
        self.assertEqual(faults_of({}), [])

    def test_a_diagram_of_speed_that_is_not_there_yet_is_told(self):
        fault, = faults_of({"scenes/gallery/bench_t.png": None})
        self.assertTrue(fault.startswith("note: sub/README.md"), fault)

    def test_each_fault_is_found(self):
        more = SOUND["README.md"]
        for changes, word in (
                ({"README.md": more + "[x](nowhere.md)\n"}, "nowhere.md: there is no such file"),
                ({"README.md": more + "[x](sub/README.md#three)\n"}, "no heading"),
                ({"README.md": more + "[x](#nothing)\n"}, "no heading"),
                ({"scripts/gallery": "echo two\n"}, "one.png: neither"),
                ({"bench/figures.py": "ALL = {}\n"}, "bench_t.png: neither"),
                ({"README.md": more + "![](scenes/gallery/one.png)\n"}, "no words"),
                ({"scenes/gallery/old.png": ""}, "old.png: no README shows it"),
                ({"scenes/gallery/one.png": None}, "one.png: there is no such file"),
                ({"README.md": more + "[![p](scenes/gallery/one.png)](gone.md)\n"}, "gone.md"),
                ({"README.md": more + "`gone.cc`\n"}, "gone.cc: there is no such file"),
                ({"src/cone.h": "Spot"}, "src/cone.h holds Spot and is not named"),
                ({"src/light.h": "", "src/io/read_spot.cc": ""}, "no file of src/ holds Spot")):
            with self.subTest(word=word):
                self.assertTrue(any(word in fault for fault in faults_of(changes)),
                                faults_of(changes))


if __name__ == "__main__":
    unittest.main()
