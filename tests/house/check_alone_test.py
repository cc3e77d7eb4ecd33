#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests check_alone.py: a small sound tree has no faults, and each planted fault is found."""
import json
import pathlib
import tempfile
import unittest

import check_alone

LANE = """#include "hwy/highway.h"
#if defined(LANE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LANE_INL_H
#undef LANE_INL_H
#else
#define LANE_INL_H
#endif
namespace HWY_NAMESPACE {
const double kHalf = kTurn / 2;
}
#endif
"""
TREE = {
    "src/base/angle.h": "#pragma once\n#include <cmath>\nconst double kTurn = 2 * M_PI;\n",
    "src/base/angle.cc": '// first\n#include "base/angle.h"\n',
    "src/base/lane-inl.h": '#include "base/angle.h"\n' + LANE,
    "src/hit/ray.h": "#pragma once\nstruct Ray {};\n",  # a folder without a source
}


class CheckAlone(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        for name, text in TREE.items():
            self.write(name, text)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def check(self):
        build = self.root / "build"
        entries = [{"directory": str(build), "file": str(source),
                    "command": f"c++ -I{self.root}/src -std=c++20 '-DHWY_DISABLED_TARGETS=~HWY_SSE4' -msse4.2 -maes -mpclmul -o a.o -c {source}"}
                   for source in self.root.glob("src/*/*.cc")]
        self.write("build/compile_commands.json", json.dumps(entries))
        return check_alone.check(build, self.root)

    def assert_faults(self, *names):
        self.assertEqual([fault.split(" ")[0] for fault in self.check()[0]], list(names))

    def test_a_sound_tree_has_no_faults(self):
        self.assertEqual(self.check(), ([], 1, 2))  # the third header is compiled with its source

    def test_headers_that_lack_an_include_are_found(self):
        self.write("src/base/lane-inl.h", LANE)
        self.write("src/base/pi.h", "#include <cstddef>\nconst double kPi = M_PI;\n")
        self.assert_faults("src/base/lane-inl.h", "src/base/pi.h")

    def test_a_header_behind_another_include_is_compiled(self):
        self.write("src/base/angle.h", "const double kTurn = 2 * M_PI;\n")
        self.write("src/base/angle.cc", '#include <cmath>\n\n#include "base/angle.h"\n')
        self.write("src/base/lane-inl.h", "")
        self.assert_faults("src/base/angle.h")

    def test_a_source_that_lives_on_another_of_its_unit_is_found(self):
        self.write("src/base/use.cc", '#include "base/angle.h"\nint Use() { return Helper(); }\n')
        self.assert_faults("src/base/use.cc")


if __name__ == "__main__":
    unittest.main()
