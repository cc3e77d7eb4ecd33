#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests fault_list.py: a list is read as it is written, and each of its mistakes is found."""
import pathlib
import tempfile
import unittest

import fault_list
import slips

LIST = """
# A comment.

fault first: base cli
  A reason
  of two lines.
@ src/base/one.h
- int one = 1;
- int two = 2;
+ int one = 2;
@ src/base/two.h
- gone
+
"""
TREE = {
    "src/base/one.h": "int zero;\nint one = 1;\nint two = 2;\n",
    "src/base/two.h": "// gone with the wind\n",
    "tests/base/one_test.cc": "",
}


class FaultList(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name, text in TREE.items():
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)

    def mistakes(self, text):
        return fault_list.check(fault_list.parse(text, "a.txt"), self.root)

    def assert_mistake(self, text, message):
        mistakes = self.mistakes(text)
        self.assertEqual(len(mistakes), 1, mistakes)
        self.assertIn(message, mistakes[0])

    def test_a_list_is_read(self):
        fault, = fault_list.parse(LIST, "a.txt")
        self.assertEqual((fault.name, fault.tests, fault.why, fault.place),
                         ("first", ["base", "cli"], "A reason of two lines.", "a.txt:4"))
        self.assertEqual(fault.parts, [
            fault_list.Part("src/base/one.h", "int one = 1;\nint two = 2;", "int one = 2;"),
            fault_list.Part("src/base/two.h", "gone", "")])

    def test_faults_are_planted(self):
        fault, = fault_list.parse(LIST, "a.txt")
        self.assertEqual(fault_list.check([fault], self.root), [])
        self.assertEqual(fault_list.plant(fault, self.root), {
            "src/base/one.h": "int zero;\nint one = 2;\n",
            "src/base/two.h": "//  with the wind\n"})

    def test_two_texts_of_one_file(self):
        fault, = fault_list.parse("fault a: base\n  Why.\n@ src/base/one.h\n- one\n+ 1\n"
                                  "@ src/base/one.h\n- two\n+ 2\n", "a.txt")
        self.assertEqual(fault_list.plant(fault, self.root),
                         {"src/base/one.h": "int zero;\nint 1 = 1;\nint 2 = 2;\n"})

    def test_texts_occur_once(self):
        self.assert_mistake(LIST.replace("- gone", "- there"), "holds the text 0 times")
        self.assert_mistake(LIST.replace("- gone", "- i"), "holds the text 2 times")
        self.assert_mistake(LIST.replace("- gone\n", ""), "holds the text 0 times")

    def test_other_mistakes(self):
        self.assert_mistake(LIST + LIST, "a second fault first")
        self.assert_mistake(LIST.replace("base cli", "bass cli"), "there is no test bass")
        self.assert_mistake(LIST.replace("  A reason\n  of two lines.\n", ""), "no reason")
        self.assert_mistake(LIST.replace("two.h", "three.h"), "three.h: No such file")
        self.assert_mistake(LIST.replace("+\n", "+ gone\n"), "takes its own place")

    def test_lines_that_are_nothing(self):
        for text in ("fault A: base", "x\n" + LIST, LIST + "x\n", LIST + "  late reason\n"):
            with self.assertRaises(fault_list.ListError, msg=text):
                fault_list.parse(text, "a.txt")


SOURCE = """// a + b < 1
#include "base/a < b.h"
if (a < b && name == "1 + 2") {
  total += a * 0.5;  // a * b
}
if (a < b && name == "1 + 2") {
"""


class Slips(unittest.TestCase):
    def test_operators_and_constants_of_code_alone(self):
        found = slips.slips_of("src/base/a.cc", SOURCE, 100)
        self.assertEqual([fault.name.partition(": ")[2] for fault in found],
                         ["< -> <=", "&& -> ||", "== -> !=", "+= -> -=", "* -> /", "0.5 -> 1.25",
                          "< -> <=", "&& -> ||", "== -> !="])

    def test_each_changes_one_place(self):
        for fault in slips.slips_of("src/base/a.cc", SOURCE, 100):
            part, = fault.parts
            self.assertEqual(SOURCE.count(part.find), 1)
            self.assertNotEqual(part.find, part.replace)
            changed = SOURCE.replace(part.find, part.replace).split("\n")
            row = int(fault.place.rpartition(":")[2]) - 1
            self.assertEqual([k for k, line in enumerate(SOURCE.split("\n")) if line != changed[k]], [row])

    def test_the_same_few_each_time(self):
        few = slips.slips_of("src/base/a.cc", SOURCE, 3)
        self.assertEqual(len(few), 3)
        self.assertEqual(few, slips.slips_of("src/base/a.cc", SOURCE, 3))


if __name__ == "__main__":
    unittest.main()
