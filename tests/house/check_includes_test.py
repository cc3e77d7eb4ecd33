#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests check_includes.py: a small sound tree has no faults, and each planted fault is found."""
import pathlib
import tempfile
import unittest

import check_includes

CMAKE = """
nacre_library(base DEPENDS hwy::hwy)
nacre_library(color DEPENDS nacre_base)
nacre_library(scene DEPENDS nacre_base nacre_color)
nacre_library(hit DEPENDS nacre_base)
nacre_library(visibility DEPENDS nacre_hit nacre_scene)
nacre_library(embree DEPENDS nacre_visibility embree TBB::tbb)
nacre_library(shading DEPENDS nacre_hit nacre_scene)
nacre_library(render DEPENDS nacre_visibility  # a comment
  nacre_shading)
nacre_library(image_io DEPENDS nacre_base nacre_color)
nacre_library(scene_io DEPENDS nacre_scene nacre_image_io)
nacre_library(textbook DEPENDS nacre_base)
nacre_library(api DEPENDS nacre_render)
add_library(nacre_cli OBJECT main.cc)
target_link_libraries(nacre_cli PUBLIC nacre_render
  nacre_scene_io nacre_textbook CLI11::CLI11)
add_subdirectory(oiio_module)
"""

SOUND_TREE = {
    "CMakeLists.txt": CMAKE,
    "nacre.h": "#include <vector>\n",
    "base/target.cc": '#include "hwy/highway.h"\n',
    "color/tone.h": '#include "base/vec.h"\n',
    "color/tone-inl.h": '#include "hwy/contrib/math/math-inl.h"\n#include "hwy/highway.h"\n',
    "color/display_kernel.cc": '#include "hwy/foreach_target.h"\n#include "color/tone-inl.h"\n',
    "scene/scene.h": '#include <Imath/ImathVec.h>\n#include "color/tone.h"\n',
    "hit/batch.h": '#include "base/vec.h"\n',
    "visibility/trace.cc": '#include "scene/scene.h"\n',
    "embree/embree_api.h": '#include <embree3/rtcore.h>\n',
    "embree/tbb_threads.cc": "#include <tbb/task_arena.h>\n",
    "embree/trees.cc": '#include "embree/embree_api.h"\n#include "visibility/trace.h"\n',
    "shading/shade.cc": '// #include "visibility/trace.h"\n#include "hit/batch.h"\n',
    "render/render.cc": '#include "base/vec.h"\n#include "visibility/trace.h"\n',
    "image_io/exr.cc": "#include <OpenEXR/openexr.h>\n#include <zlib.h>\n",
    "scene_io/json.cc": '#include <nlohmann/json.hpp>\n#include "color/tone.h"\n',
    "api/border.h": '#include "nacre.h"\n#include "render/render.h"\n',
    "textbook/shading.h": '#include "base/vec.h"\n',
    "cli/main.cc": '#include <CLI/CLI.hpp>\n#include "render/render.h"\n',
    "cli/textbook.cc": '#include "textbook/shading.h"\n',
    "oiio_module/CMakeLists.txt": "add_library(nacre_oiio MODULE read.cc)\n",
    "oiio_module/read.cc": '#include <OpenImageIO/imageio.h>\n#include "image_io/exr.h"\n',
}


def faults_of(changes):
    """What the check says of the sound tree with some files added or replaced."""
    with tempfile.TemporaryDirectory() as root:
        for name, text in {**SOUND_TREE, **changes}.items():
            path = pathlib.Path(root, "src", name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return check_includes.check(root)[0]


class CheckIncludes(unittest.TestCase):
    def test_sound_tree_has_no_faults(self):
        self.assertEqual(faults_of({}), [])

    def test_forbidden_includes(self):
        for file, include in (
            ("color/a.h", '"scene/scene.h"'),  # upwards
            ("color/a.h", '"image_io/exr.h"'),  # from the trunk into a branch
            ("visibility/a.cc", '"shading/shade.h"'),  # sideways
            ("shading/a.cc", '"visibility/trace.h"'),
            ("hit/a.h", '"scene/scene.h"'),  # allowed by the order, not by the DEPENDS line
            ("image_io/a.cc", '"scene/scene.h"'),
            ("scene_io/a.cc", '"render/render.h"'),
            ("oiio_module/a.cc", '"scene/scene.h"'),
            ("render/a.cc", '"cli/main.h"'),
            ("render/a.cc", '"nowhere/a.h"'),
            ("render/a.cc", '"render.h"'),
            ("render/a.cc", '"render/render.cc"'),
            ("visibility/a.cc", '"embree/embree_api.h"'),
            ("embree/trees.cc", "<embree3/rtcore.h>"),
            ("embree/trees.cc", "<tbb/task_arena.h>"),
            ("render/a.cc", "<embree4/rtcore.h>"),
            ("image_io/a.cc", "<OpenImageIO/imageio.h>"),
            ("render/a.cc", "<OpenEXR/ImfHeader.h>"),
            ("render/a.cc", "<ImfHeader.h>"),
            ("render/a.cc", "<zlib.h>"),
            ("render/a.cc", "<tbb/parallel_for.h>"),
            ("render/a.cc", "<oneapi/tbb/parallel_for.h>"),
            ("render/a.cc", '"hwy/highway.h"'),
            ("color/a.h", "<hwy/highway.h>"),
            ("base/target.cc", '"hwy/contrib/math/math-inl.h"'),
            ("base/a.cc", '"hwy/aligned_allocator.h"'),
            ("color/a.cc", '"color/tone-inl.h"'),
            ("scene/a.cc", "<nlohmann/json.hpp>"),
            ("render/a.cc", "<nlohmann/json_fwd.hpp>"),
            ("scene_io/a.cc", "<CLI/CLI.hpp>"),
            ("color/deeper/a.cc", '"scene/scene.h"'),
            ("render/a.cc", '"textbook/shading.h"'),  # the lesson's program stays apart
            ("shading/a.cc", '"textbook/shading.h"'),
            ("image_io/a.cc", '"textbook/shading.h"'),
            ("textbook/a.cc", '"color/tone.h"'),
            ("textbook/a.cc", '"scene/scene.h"'),
            ("textbook/a.cc", '"shading/shade.h"'),
            ("render/a.cc", '"nacre.h"'),  # the public header is for others
            ("nacre.h", '"base/vec.h"'),
            ("nacre.h", "<Imath/ImathVec.h>"),
        ):
            with self.subTest(file=file, include=include):
                faults = faults_of({file: f"// A fault\n  # include {include}\n"})
                self.assertEqual(len(faults), 1, faults)
                self.assertTrue(faults[0].startswith(f"src/{file}:2: "), faults)

    def test_cmake_against_the_table(self):
        for old, new, expected in (
            ("color DEPENDS nacre_base", "color DEPENDS nacre_scene", "color depends on scene"),
            ("nacre_hit nacre_scene)", "nacre_hit nacre_scene nacre_visibility)",
             "shading depends on visibility"),
            ("nacre_hit nacre_scene)", "nacre_hit nacre_scene nacre_textbook)",
             "shading depends on textbook"),
            ("textbook DEPENDS nacre_base", "textbook DEPENDS nacre_base nacre_color",
             "textbook depends on color"),
            ("image_io DEPENDS nacre_base", "image_io DEPENDS nacre_scene",
             "image_io depends on scene"),
            ("nacre_library(hit DEPENDS nacre_base)", "", "src/hit is there, but"),
            ("add_subdirectory", "nacre_library(extra)\nadd_subdirectory", "extra is not in"),
        ):
            with self.subTest(expected=expected):
                self.assertIn(old, CMAKE)
                faults = faults_of({"CMakeLists.txt": CMAKE.replace(old, new)})
                self.assertTrue(any(expected in fault for fault in faults), faults)

    def test_rings_within_a_folder(self):
        order = {"scene/a.h": '#include "scene/b.h"\n', "scene/b.h": '#include "scene/c.h"\n',
                 "scene/c.h": "", "scene/b.cc": '#include "scene/b.h"\n#include "scene/c.h"\n'}
        self.assertEqual(faults_of(order), [])
        for ring in ({"scene/c.h": '#include "scene/a.h"\n'},
                     {"scene/c.cc": '#include "scene/c.h"\n#include "scene/a.h"\n'},
                     {"scene/c-inl.h": '#include "scene/b.h"\n'},
                     {"scene/c_kernel.cc": '#include "scene/b.h"\n'}):
            with self.subTest(ring):
                faults = [fault for fault in faults_of({**order, **ring}) if "ring" in fault]
                self.assertEqual(len(faults), 1)

    def test_folder_that_nobody_knows(self):
        faults = faults_of({"extra/a.cc": ""})
        self.assertEqual(len(faults), 1, faults)
        self.assertIn("src/extra", faults[0])


if __name__ == "__main__":
    unittest.main()
