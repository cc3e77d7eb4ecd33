#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests check_tree.py: a small sound tree has no faults, and each planted fault is found."""
import pathlib
import subprocess
import tempfile
import unittest

import check_tree

SCRIPT_LICENSE = f"# {check_tree.LICENSE_TAG}\n"
LICENSE = f"// {check_tree.LICENSE_TAG}\n"
SOUND_TREE = {
    "scripts/build": f"#!/usr/bin/env bash\n{SCRIPT_LICENSE}source scripts/common.sh\n",
    "scripts/common.sh": SCRIPT_LICENSE + "# shellcheck shell=bash\nset -eu\n",
    "src/base/error.h": LICENSE + "// base/error.h: the one error type.\n",
    "src/base/error.cc": LICENSE + '#include "base/error.h"\n',
    "tests/base/error_test.cc": LICENSE + "// Tests of base/error.h.\n",
}


class CheckTree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        for name, text in SOUND_TREE.items():
            self.write(name, text)
        (self.root / "scripts/build").chmod(0o755)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def faults(self):
        return check_tree.check(self.root)[0]

    def assert_one_fault(self, start):
        faults = self.faults()
        self.assertEqual(len(faults), 1, faults)
        self.assertTrue(faults[0].startswith(start), faults)

    def test_sound_tree_has_no_faults(self):
        faults, names = check_tree.check(self.root)
        self.assertEqual(faults, [])
        self.assertEqual(names, sorted(SOUND_TREE))

    def test_git_lists_new_files_but_not_ignored_ones(self):
        subprocess.run(["git", "init", "-q", str(self.root)], check=True)
        self.write(".gitignore", "/junk/\n")
        self.write("junk/big", "x" * (check_tree.MAX_BYTES + 1))
        self.assertEqual(self.faults(), [])
        self.write("big", "x" * (check_tree.MAX_BYTES + 1))
        self.assert_one_fault("big: ")

    def test_named_files_exist(self):
        for comment in ("base/error.h", "error.h, error.cc", "src/base/error.h.", "n.h over v.h",
                        "NAME.h and NAME-inl.h", "NAME-inl.h", "{a,b}_c.h", "sysexits.h",
                        "a.handle"):
            with self.subTest(comment=comment):
                self.write("src/base/one.h", f"{LICENSE}// One: {comment}\n")
                self.assertEqual(self.faults(), [])
        for comment in ("base/gone.h", "gone-inl.h", "scene/error.h", "(gone.cc)", "`gone.py`."):
            with self.subTest(comment=comment):
                self.write("src/base/one.h", f"{LICENSE}// One: {comment}\n")
                self.assert_one_fault("src/base/one.h:2: names ")
        self.write("src/base/one.h", f"{LICENSE}// One.\nint x;  // as gone.h has it\n")
        self.assert_one_fault("src/base/one.h:3: names gone.h")
        self.write("src/base/one.h", f'{LICENSE}// One.\n#include "gone.h"\n')
        self.assertEqual(self.faults(), [])
        self.write("README.md", "See `base/error.h`.\n```\ngone.cc\n```\nAnd gone.md.\n")
        self.assert_one_fault("README.md:5: names gone.md")
        self.write("README.md", "See [this](gone.md).\n")
        self.assert_one_fault("README.md:1: names gone.md")

    def test_size_limit_is_inclusive(self):
        self.write("data.bin", "x" * check_tree.MAX_BYTES)
        self.assertEqual(self.faults(), [])

    def test_run_bit(self):
        (self.root / "scripts/build").chmod(0o644)
        self.assert_one_fault("scripts/build: has no run bit")

    def test_first_line_of_scripts(self):
        self.write("scripts/other", SCRIPT_LICENSE + "echo\n")
        self.assert_one_fault("scripts/other:1: ")

    def test_shell_syntax(self):
        self.write("scripts/common.sh", "# shellcheck shell=bash\nif true; then\n")
        self.assertTrue(any("bash -n" in fault for fault in self.faults()))

    def test_first_line_of_sources(self):
        for name, text in (
            ("src/base/vec.h", "#pragma once\n"),
            ("src/base/vec.h", ""),
            ("src/base/vec.h", "//\n"),
            ("src/base/main.cc", "#include <vector>\n"),
            ("src/base/main.cc", '#include "base/main.h"\n'),  # there is no such header
            ("src/base/main.cc", '#include "base/error.h"\n'),  # another file's header
            ("tests/base/vec_test.cc", '#include "base/error.h"\n'),
        ):
            with self.subTest(name=name, text=text):
                self.write(name, LICENSE + text)
                self.assert_one_fault(f"{name}:1: the first line")
                (self.root / name).unlink()

    def test_every_source_and_script_names_its_license(self):
        for name, text in (
            ("src/base/vec.h", "// base/vec.h: vectors.\n"),
            ("src/base/vec.h", f"// base/vec.h: vectors.\n\n{LICENSE}"),  # too far down
            ("tests/a_test.py", '"""Tests."""\n'),
            ("src/CMakeLists.txt", "project(x)\n"),
            ("tests/tool", "#!/usr/bin/env bash\n"),
        ):
            with self.subTest(name=name, text=text):
                self.write(name, text)
                self.assert_one_fault(f"{name}:1: no line with ")
                (self.root / name).unlink()

    def test_long_files_are_noted(self):
        self.write("src/base/vec.h", LICENSE + "// A header\n" * check_tree.LONG_HEADER)
        self.write("src/base/error.cc", LICENSE + "// A source\n" * (check_tree.LONG_FILE - 1))
        faults, names = check_tree.check(self.root)
        self.assertEqual(faults, [])
        self.assertEqual(check_tree.long_files(self.root, names),
                         [(check_tree.LONG_HEADER + 1, "src/base/vec.h")])


if __name__ == "__main__":
    unittest.main()
