#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""minimal_test.py NACRE MINIMAL SOURCE: a build without Embree, TBB and OpenImageIO renders spheres,
bit for bit as NACRE does, and says in one line what it cannot do.

In a build of that kind the two programs are one, whose ways of finding hits are held together.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

NACRE, MINIMAL, SOURCE = (pathlib.Path(argument) for argument in sys.argv[1:4])
SCENES = SOURCE / 'scenes'
SMALL = ['--size', '96x54', '--spp', '4', '--depth', 'float', '--reproducible']
FLAT_LIGHTS = ('area_lights.json', 'mesh_lights.json')  # seen by the camera: triangles
LAYERS = ['--layers', 'N,P,Z,id.object']

# Many spheres within one another, which the eye is in the middle of, and others beside them.
NESTED = {
    'nacre': 1,
    'camera': {'position': [0.1, 0.2, 0.1], 'look_at': [3, 1, -4], 'fov_y_deg': 60},
    'materials': {'a': {'model': 'metallic_roughness', 'base_color': [0.8, 0.3, 0.1], 'roughness': 0.3}},
    'lights': {'lamp': {'type': 'point', 'position': [0.3, 0.6, 0.2], 'intensity': 60},
               'room': {'type': 'sphere', 'center': [1, 3, -1], 'radius': 0.5, 'radiance': 5}},
    'shapes': [{'type': 'sphere', 'center': [0.001 * i, 0, 0], 'radius': 3 + 0.01 * i, 'material': 'a'}
               for i in range(200)] +
              [{'type': 'sphere', 'center': [2, 0.1 * i, -1], 'radius': 0.1, 'material': 'a'}
               for i in range(9)],
}


def run(program, *arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True, check=False)


class Minimal(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)

    def render(self, program, scene, *arguments):
        out = self.out / 'a.exr'
        result = run(program, 'render', scene, '-o', out, *SMALL, *LAYERS, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return out.read_bytes()

    def check_refused(self, code, text, *arguments):
        result = run(MINIMAL, *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertRegex(result.stderr, rf'^error: [^\n]*{text}[^\n]*\n  hint: [^\n]*\n$')

    def test_nothing_that_is_missing_is_linked(self):
        needed = subprocess.run(['readelf', '-d', MINIMAL], capture_output=True, text=True, check=True).stdout
        self.assertIn('libOpenEXR', needed)
        self.assertIsNone(re.search('embree|tbb|OpenImageIO|tiff', needed), needed)
        self.assertRegex(run(MINIMAL, 'info').stdout, r'Embree +none: spheres only\n')

    def test_spheres_have_the_same_bits(self):
        nested = self.out / 'nested.json'
        nested.write_text(json.dumps(NESTED))
        scenes = [nested]
        for scene in sorted(SCENES.glob('*.json')):
            if scene.name in ('nacre.schema.json', 'million_spheres.json') + FLAT_LIGHTS:
                continue
            if '  meshes      0 ' in run(NACRE, 'info', scene).stdout:
                scenes.append(scene)
        self.assertGreater(len(scenes), 6)
        for scene in scenes:
            with self.subTest(scene=scene.name):
                expected = self.render(NACRE, scene)
                self.assertEqual(self.render(MINIMAL, scene), expected)
                self.assertEqual(self.render(MINIMAL, scene, '--intersector', 'shells'), expected)

    def test_meshes_are_refused(self):
        for scene in ('mesh_and_spheres.json', *FLAT_LIGHTS):
            with self.subTest(scene=scene):
                self.check_refused(65, 'this build has no Embree: it renders spheres only', 'render',
                                   SCENES / scene, '-o', self.out / 'a.exr', *SMALL)
                self.assertFalse((self.out / 'a.exr').exists())

    def test_embree_is_refused(self):
        self.check_refused(64, 'this build has no Embree', 'render', SCENES / 'first_scene.json', '-o',
                           self.out / 'a.exr', '--intersector', 'embree')

    def test_tiff_is_refused_without_its_module(self):
        alone = self.out / 'alone'
        alone.mkdir()
        shutil.copy(MINIMAL, alone / 'nacre')
        result = run(alone / 'nacre', 'info', SOURCE / 'tests/fuzz/corpus/texture_image/a.tif')
        self.assertEqual(result.returncode, 65, result.stderr)
        self.assertRegex(result.stderr, r'^error: [^\n]*a\.tif: cannot be read: nacre_oiio\.so [^\n]*\n  hint: ')


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
