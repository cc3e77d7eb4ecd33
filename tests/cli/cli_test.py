#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The program from outside: exit codes, what is written and what is not, and what it prints.

Usage: cli_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
"""
import json
import os
import pathlib
import re
import signal
import stat
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
FIRST_SCENE = str(SOURCE / 'scenes/first_scene.json')
SMALL = ['--size', '64x36', '--spp', '1']


def run(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120, **options)


def exr_chunks(data):
    """The bytes of each chunk of a single-part scanline file."""
    at = 8  # magic number and version; then attributes: name, type, size, value
    while data[at] != 0:
        at = data.index(b'\0', data.index(b'\0', at) + 1) + 1
        at += 4 + int.from_bytes(data[at:at + 4], 'little')
    at += 1
    first = int.from_bytes(data[at:at + 8], 'little')
    offsets = [int.from_bytes(data[i:i + 8], 'little') for i in range(at, first, 8)]
    sizes = [int.from_bytes(data[i + 4:i + 8], 'little') for i in offsets]
    return [data[i + 8:i + 8 + size] for i, size in zip(offsets, sizes)]


class CliTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.out = pathlib.Path(self.folder.name)

    def check_fails(self, code, message, *arguments):
        """Fails with this code, one clear message with a hint, no output and nothing left."""
        before = sorted(self.out.iterdir())
        result = run(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertIn('error: ', result.stderr)
        self.assertIn(message, result.stderr)
        self.assertEqual(result.stdout, '')
        self.assertEqual(sorted(self.out.iterdir()), before)
        return result

    def render(self, *arguments, scene=FIRST_SCENE):
        result = run('render', scene, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    # ---- What it promises ----

    def test_renders_exr_and_png_and_tells_on_stderr_only(self):
        result = self.render('-o', self.out / 'a.exr', '-o', self.out / 'a.png', *SMALL)
        self.assertEqual(result.stdout, '')
        self.assertIn('64x36', result.stderr)
        self.assertEqual((self.out / 'a.exr').read_bytes()[:4], b'\x76\x2f\x31\x01')
        self.assertEqual((self.out / 'a.png').read_bytes()[:4], b'\x89PNG')

    def test_quiet_says_nothing(self):
        self.assertEqual(self.render('-o', self.out / 'a.png', '--quiet', *SMALL).stderr, '')

    def test_options_for_files_that_are_not_written_are_told(self):
        for kind, other, options in (
                ('png', 'exr', (['--layers', 'N'], ['--depth', 'float'], ['--compression', 'piz'])),
                ('exr', 'png', (['--tonemap', 'aces'], ['--exposure', '1'], ['--labels']))):
            for option in options:
                with self.subTest(option=option):
                    one = ['-o', self.out / f'a.{kind}', *option, *SMALL]
                    told = f'warning: {option[0]} changes nothing: it is for .{other} files'
                    self.assertIn(told, self.render(*one).stderr)
                    self.assertEqual(self.render(*one, '--quiet').stderr, '')
                    both = ['-o', self.out / f'a.{other}', *one]
                    self.assertNotIn('warning', self.render(*both).stderr)

    def test_reproducible_files_are_equal_to_the_byte(self):
        for name in 'a.exr', 'b.exr', 'a.png', 'b.png':
            threads = '1' if name[0] == 'a' else '2'
            self.render('-o', self.out / name, '--reproducible', '--threads', threads, *SMALL)
        for kind in '.exr', '.png':
            self.assertEqual((self.out / ('a' + kind)).read_bytes(),
                             (self.out / ('b' + kind)).read_bytes())

    def test_reproducible_files_are_deflated_by_zlib(self):
        # ISA-L, which is faster, makes other bytes of the same input in some processes.
        for options, by_zlib in (['--reproducible'], True), ([], False):
            self.render('-o', self.out / 'a.exr', *options, *SMALL)
            chunks = exr_chunks((self.out / 'a.exr').read_bytes())
            self.assertGreater(len(chunks), 1)
            same = []
            for chunk in chunks:
                deflate = zlib.compressobj(2, zlib.DEFLATED, zlib.MAX_WBITS, 9)
                same.append(deflate.compress(zlib.decompress(chunk)) + deflate.flush() == chunk)
            self.assertEqual(all(same), by_zlib)

    def test_every_compression_is_what_its_name_says(self):
        for name in 'none', 'zip', 'zips', 'piz', 'dwaa':
            self.render('-o', self.out / 'a.exr', '--compression', name, *SMALL)
            self.assertRegex(run('info', self.out / 'a.exr').stdout, rf'compression +{name}\n')

    def test_what_half_cannot_hold_is_told(self):
        bright = ['-o', self.out / 'a.exr', '--set', '/lights/key/intensity=1e9', *SMALL]
        self.assertIn('samples beyond +-65504 were clamped', self.render(*bright).stderr)
        self.assertNotIn('clamped', self.render(*bright, '--depth', 'float').stderr)

    def test_the_target_and_the_threads_are_those_asked_for(self):
        seen = []
        for target in 'scalar', 'sse4', 'avx2', 'avx3', 'neon':
            result = run('render', FIRST_SCENE, '-o', self.out / 'a.exr', '--target', target, *SMALL)
            if result.returncode == 64:  # none of this machine's, or of this build's
                self.assertIn(f'cannot run {target}\n  hint: it can run ', result.stderr)
                continue
            seen.append(target)
            self.assertRegex(run('info', self.out / 'a.exr').stdout, rf'nacre:target +{target}\n')
        self.assertTrue(seen)
        for threads in 1, 2:
            stats = self.render('-o', self.out / 'a.exr', '--stats', '-', '--threads', threads,
                                *SMALL).stdout
            self.assertEqual(json.loads(stats)['threads'], threads)

    def test_the_seed_chooses_the_samples(self):
        for name, seed in ('a.png', '1'), ('b.png', '1'), ('c.png', '2'):
            self.render('-o', self.out / name, '--size', '64x36', '--spp', '2', '--seed', seed,
                        '--reproducible')
        pictures = [(self.out / name).read_bytes() for name in ('a.png', 'b.png', 'c.png')]
        self.assertEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[0], pictures[2])

    def test_stats_are_json(self):
        self.render('-o', self.out / 'a.exr', '--stats', self.out / 's.json', *SMALL)
        stats = json.loads((self.out / 's.json').read_text())
        self.assertEqual(stats['counts']['camera_rays'], 64 * 36)
        self.assertEqual(stats['image']['samples_per_pixel'], {'min': 1, 'mean': 1, 'max': 1})
        self.assertGreater(stats['counts']['hits'], 0)
        self.assertIn('render', stats['time_ms'])
        for stage in 'intersect', 'shade', 'film', 'output':
            self.assertGreater(stats['time_ms']['stages_all_threads'][stage], 0)

    def test_explain_of_layers_in_ambient_light_speaks_of_no_images(self):
        scene = self.out / 'velvet.json'
        scene.write_text(json.dumps({
            'nacre': 1,
            'camera': {'position': [0, 0, 5], 'look_at': [0, 0, 0]},
            'materials': {'velvet': {'model': 'metallic_roughness', 'sheen_color': [1, 1, 1],
                                     'sheen_roughness': 0.5}},
            'lights': {'sky': {'type': 'ambient', 'radiance': [1, 1, 1]}},
            'shapes': [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1,
                        'material': 'velvet'}]}))
        result = run('render', scene, '-o', 'null:', '--explain', *SMALL)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("no shape's material has a map, but of 1 materials with coats or layers",
                      result.stdout)

    def test_explain_names_each_decision(self):
        text = self.render('-o', self.out / 'a.exr', '--explain', *SMALL).stdout
        self.assertIn('intersector', text)
        self.assertIn('skipped', text)
        shares = dict(re.findall(r'^  (\w+) +([\d.]+) % +[\d.]+ ms$', text, re.MULTILINE))
        self.assertGreater(float(shares['intersect']), 0)
        self.assertAlmostEqual(sum(map(float, shares.values())), 100, delta=0.5)  # each rounded

    def test_progress_for_programs_is_json_lines(self):
        result = self.render('-o', self.out / 'a.exr', '--progress=json', '--size', '1280x720',
                             '--spp', '64', scene=str(SOURCE / 'scenes/material_grid.json'))
        lines = [line for line in result.stderr.splitlines() if line.startswith('{')]
        self.assertTrue(lines)
        self.assertEqual(lines, result.stderr.splitlines())
        for line in lines:
            self.assertIn('progress', json.loads(line))
        self.assertEqual(json.loads(lines[-1])['progress'], 1)

    def test_set_changes_the_scene(self):
        self.render('-o', self.out / 'a.exr', '--set', '/image/width=33', '--spp', '1')
        self.assertIn('33x', run('info', self.out / 'a.exr').stdout)

    def test_max_error_tells_what_it_took_and_what_did_not_settle(self):
        grid = str(SOURCE / 'scenes/material_grid.json')
        options = ['--size', '96x54', '--max-error', '0.05', '-o', self.out / 'a.exr']
        text = self.render(*options, '--stats', self.out / 's.json', '--explain',
                           scene=grid)
        self.assertIn('adaptive sampling', text.stdout)
        image = json.loads((self.out / 's.json').read_text())['image']
        self.assertEqual(image['max_error'], 0.05)
        self.assertLess(image['unsettled_pixels'], 96 * 54 / 20)
        self.assertIn('nacre:maxError', run('info', self.out / 'a.exr').stdout)
        for spp, most in ('8', 8), ('9', 16):
            told = self.render(*options, '--spp', spp, '--stats', self.out / 's.json', scene=grid).stderr
            self.assertIn(f'did not settle within {most} samples', told)
            counts = json.loads((self.out / 's.json').read_text())['image']['samples_per_pixel']
            self.assertEqual(counts['max'], most)
            self.assertEqual(counts['min'], 0)  # the background around the spheres
            self.assertIn(f"0 to {most} samples a pixel, {counts['mean']:.1f} on average", told)

    def test_region_writes_a_data_window_in_the_display_window(self):
        self.render('-o', self.out / 'a.exr', '--region', '5,6,25,30', *SMALL)
        text = run('info', self.out / 'a.exr').stdout
        self.assertIn('display window  64x36 at 0,0', text)
        self.assertIn('data window     20x24 at 5,6', text)

    def test_header_says_how_the_picture_was_made(self):
        self.render('-o', self.out / 'a.exr', '--layers', 'diffuse,Z,id.object', *SMALL)
        text = run('info', self.out / 'a.exr').stdout
        for word in ('worldToCamera', 'worldToNDC', 'chromaticities', 'nacre:shadowing',
                     'nacre:sceneHash', 'nacre:target', 'nacre:commit', 'Software',
                     'diffuse.R:half', 'Z:float', 'id.object:uint'):
            self.assertIn(word, text)

    def test_schema_is_the_one_beside_the_scenes(self):
        schema = (SOURCE / 'scenes/nacre.schema.json').read_text()
        self.assertEqual(run('schema').stdout, schema)

    def test_grid_and_pair_need_no_scene(self):
        for command in (['grid', '--rows', 'shininess=4:64:2', '--columns', 'ks=0:1:3',
                         '--material', 'phong'],
                        ['pair'], ['pair', '--layout', 'side', '--a', 'lambert']):
            result = run(*command, '-o', self.out / 'a.png', *SMALL)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_grid_takes_every_kind_of_axis(self):
        for arguments in (
                ['--rows', 'shininess=1:1024:6:log', '--columns', 'ks=0,0.5,1',
                 '--material', 'phong'],
                ['--rows', 'base_color=#ff0000,[0.8,0.2,0.1]', '--columns', 'roughness=0.1:1:5'],
                ['--rows', 'shadowing=height_correlated,separable',
                 '--columns', 'compensation=turquin,none'],
                ['--columns', 'material=phong,blinn_phong', '--rows', 'shininess=4,64'],
                ['--rows', 'material=[{"model": "lambert", "name": "matte"}, "dielectric"]',
                 '--columns', 'emission=0:1:2'],
                ['--rows', 'preset=gold,copper', '--columns', 'roughness=0.2:0.2:1',
                 '--material', 'conductor'],
                ['--rows', 'roughness=0.5', '--columns', 'metallic=0:1:64']):
            with self.subTest(arguments=arguments):
                result = run('grid', *arguments, '-o', self.out / 'a.png', '--spp', '1',
                             '--sphere-size', '20')
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(result.stdout, '')

    def test_grid_spheres_lie_in_their_cells(self):
        """The EXR has the PNG's size, and as many spheres as asked for, of the size asked for."""
        result = run('grid', '--rows', 'roughness=0.1:1:2', '--columns', 'metallic=0:1:3',
                     '-o', self.out / 'a.exr', '-o', self.out / 'a.png', '--sphere-size', '88',
                     '--spp', '1', '--no-labels')
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn('300x200', run('info', self.out / 'a.exr').stdout)
        labelled = run('grid', '--rows', 'roughness=0.1:1:2', '--columns', 'metallic=0:1:3',
                       '-o', self.out / 'b.exr', '--sphere-size', '88', '--spp', '1')
        self.assertEqual(labelled.returncode, 0, labelled.stderr)
        self.assertNotIn('300x200', run('info', self.out / 'b.exr').stdout)

    def test_sheets_take_every_light(self):
        lights = self.out / 'lights.json'
        lights.write_text('{"sun": {"type": "directional", "direction_of_travel": [0, -1, -1], '
                          '"irradiance": 3}}')
        self.render('-o', self.out / 'sky.exr', *SMALL)
        for light in (['--light', 'point'], ['--light', 'studio'], ['--light', 'sky'],
                      ['--light', 'rectangle'], ['--light', 'furnace', '--background', '#fff'],
                      ['--lights', lights], ['--lights', lights.read_text()],
                      ['--lights', FIRST_SCENE], ['--environment', self.out / 'sky.exr']):
            for command in (['grid'], ['pair', '--layout', 'side'],
                            ['pair', '--layout', 'difference']):
                with self.subTest(command=command, light=light):
                    result = run(*command, '-o', self.out / 'a.png', *SMALL, *light)
                    self.assertEqual(result.returncode, 0, result.stderr)

    def test_sheets_under_lights_with_an_extent_take_more_samples(self):
        flat = {'facing': [0, 0, -1], 'radiance': 1}
        for light, samples in (({'type': 'point', 'position': [0, 0, 9], 'intensity': 1}, 16),
                               ({'type': 'directional', 'direction_of_travel': [0, 0, -1], 'irradiance': 1}, 16),
                               ({'type': 'sphere', 'center': [0, 0, 9], 'radius': 1, 'radiance': 1}, 64),
                               ({'type': 'rectangle', 'center': [0, 0, 9], 'width': 1, 'height': 1, **flat}, 64),
                               ({'type': 'disk', 'center': [0, 0, 9], 'radius': 1, **flat}, 64),
                               ({'type': 'mesh', 'icosphere': {'center': [0, 0, 9], 'radius': 1}, 'radiance': 1}, 64)):
            with self.subTest(light=light['type']):
                result = run('grid', '-o', self.out / 'a.png', '--sphere-size', '8', '--lights',
                             json.dumps({'lamp': light}), '--stats', self.out / 's.json')
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(json.loads((self.out / 's.json').read_text())['image']['spp'], samples)

    def test_pair_prints_both_materials_and_measures_the_difference(self):
        out = ['-o', self.out / 'a.png', *SMALL]
        self.assertIn('shininess 19', run('pair', *out).stdout)
        given = json.loads(run('pair', '--json', *out).stdout)
        self.assertEqual(given['b']['roughness'], 0.4)
        self.assertNotIn('difference', given)
        measured = json.loads(run('pair', '--json', '--layout', 'difference', *out).stdout)
        self.assertGreater(measured['difference']['rmse'], 0)
        self.assertGreaterEqual(measured['difference']['max'], measured['difference']['rmse'])
        same = json.loads(run('pair', '--json', '--layout', 'difference', '--a', 'phong', '--b',
                              'phong', *out).stdout)
        self.assertEqual(same['difference'], {'rmse': 0, 'max': 0, 'mean': 0})

    def test_pair_difference_is_that_of_constant_spheres(self):
        """White light from everywhere on matte spheres: radiance is the albedo."""
        result = run('pair', '--json', '--layout', 'difference', '--light', 'furnace',
                     '--a', '{"model": "lambert", "albedo": 0.75}',
                     '--b', '{"model": "lambert", "albedo": [0.5, 0.25, 0.75]}',
                     '-o', self.out / 'a.png', '--sphere-size', '64', '--spp', '1')
        measures = json.loads(result.stdout)['difference']
        # Floats, and the closed form of a constant sky.
        self.assertAlmostEqual(measures['mean'], 0.25, delta=1e-5)
        self.assertAlmostEqual(measures['max'], 0.5, delta=1e-5)
        self.assertAlmostEqual(measures['rmse'], (0.3125 / 3) ** 0.5, delta=1e-5)

    def test_convert_prints_a_material_that_renders(self):
        for source, target in (('phong', 'metallic_roughness'), ('metallic_roughness', 'phong'),
                               ('{"model": "conductor", "preset": "gold", "roughness": 0.3}',
                                'blinn_phong'), ('dielectric', 'modified_phong'),
                               ('phong', 'dielectric'), ('lambert', 'phong')):
            with self.subTest(source=source, target=target):
                result = run('convert', source, '--to', target)
                self.assertEqual(result.returncode, 0, result.stderr)
                material = result.stdout.splitlines()[0]
                self.assertEqual(json.loads(material)['model'], target)
                self.render('-o', self.out / 'a.png', *SMALL, '--set',
                            '/materials/red=' + material)
        told = json.loads(run('convert', 'phong', '--json', '-o', self.out / 'fit.png', *SMALL).stdout)
        self.assertEqual(told['material']['model'], 'metallic_roughness')
        self.assertEqual(len(told['residual']['views']), 4)
        self.assertGreater(told['picture']['rmse'], 0)
        self.assertTrue((self.out / 'fit.png').exists())
        table = run('convert', 'lambert', '--to', 'metallic_roughness').stdout
        self.assertEqual(json.loads(table.splitlines()[0])['specular'], 0)
        self.assertNotIn('inf', table)
        self.assertIn('      -  ', table)

    def test_tonemap_makes_what_render_makes(self):
        self.render('-o', self.out / 'a.exr', '-o', self.out / 'a.png', '--depth', 'float',
                    '--tonemap', 'aces', '--exposure', '0.5', *SMALL)
        result = run('tonemap', self.out / 'a.exr', '-o', self.out / 'b.png', '--tonemap', 'aces',
                     '--exposure', '0.5')
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(run('compare', self.out / 'a.png', self.out / 'b.png').returncode, 0)

    def test_compare_tells_equal_from_different(self):
        self.render('-o', self.out / 'a.exr', *SMALL)
        self.render('-o', self.out / 'b.exr', '--spp', '4', '--size', '64x36')
        a, b = self.out / 'a.exr', self.out / 'b.exr'
        self.assertEqual(run('compare', a, a).returncode, 0)
        result = run('compare', a, b, '--heat-map', self.out / 'heat.png')
        self.assertEqual(result.returncode, 1)
        self.assertIn('RMSE', result.stdout)
        self.assertTrue((self.out / 'heat.png').exists())
        self.assertEqual(run('compare', a, b, '--max-abs', '1000').returncode, 0)
        self.assertFalse(json.loads(run('compare', a, b, '--json').stdout)['match'])
        self.assertEqual(run('compare', a, b, '--layers', 'beauty', '--max-abs', '1000',
                             '--heat-map', self.out / 'h.png', '--heat-layer', 'beauty').returncode,
                         0)

    def test_help_teaches(self):
        for command in ([], ['render'], ['grid'], ['pair'], ['convert'], ['compare'], ['explain'], ['plot'],
                        ['study']):
            result = run(*command, '--help')
            self.assertEqual(result.returncode, 0)
            self.assertIn('xample' if command else 'Exit codes', result.stdout)

    # ---- The founding lesson ----

    def test_textbook_preset_makes_the_lessons_files(self):
        references = SOURCE / 'tests/references/textbook'
        for name, size in ('phong_vs_pbr', '400x200'), ('material_grid', '600x400'):
            with self.subTest(name=name):
                exr, png = self.out / f'{name}.exr', self.out / f'{name}.png'
                scene = str(SOURCE / f'scenes/{name}.json')
                result = self.render('--preset', 'textbook', '-o', exr, '-o', png, scene=scene)
                self.assertEqual(result.stdout, '')
                # Float, though --depth's default is half, and its own size, not the scene's.
                text = run('info', exr).stdout
                self.assertIn(f'display window  {size}', text)
                self.assertIn('B:float G:float R:float', text)
                self.assertRegex(text, 'nacre:preset +textbook')
                self.assertRegex(run('info', png).stdout, 'nacre:preset +textbook')
                # Double rounded to float: half an ulp below 1 is 3e-8.
                self.assertEqual(run('compare', exr, references / exr.name, '--max-abs',
                                     '1e-7').returncode, 0)
                # One code, should another C library's pow round otherwise.
                self.assertEqual(run('compare', png, references / png.name, '--max-abs',
                                     str(1.01 / 255)).returncode, 0)

    def test_textbook_preset_takes_the_options_that_apply(self):
        scene = str(SOURCE / 'scenes/material_grid.json')
        for name in 'a.exr', 'b.exr', 'a.png', 'b.png':
            result = self.render('--preset', 'textbook', '-o', self.out / name, '--size', '90x60',
                                 '--depth', 'half', '--compression', 'zips', '--small',
                                 '--reproducible', '--quiet', scene=scene)
            self.assertEqual(result.stderr, '')
        text = run('info', self.out / 'a.exr').stdout
        self.assertIn('display window  90x60', text)
        self.assertIn('R:half', text)
        for kind in '.exr', '.png':
            self.assertEqual((self.out / ('a' + kind)).read_bytes(),
                             (self.out / ('b' + kind)).read_bytes())

    def test_textbook_preset_refuses_what_cannot_apply(self):
        scene = str(SOURCE / 'scenes/phong_vs_pbr.json')
        start = ['--preset', 'textbook', '-o', self.out / 'a.exr']
        for option in (['--tonemap', 'aces'], ['--exposure', '1'], ['--labels'],
                       ['--layers', 'diffuse'], ['--spp', '4'], ['--seed', '1'],
                       ['--region', '0,0,9,9'], ['--set', '/image/spp=1'], ['--threads', '1'],
                       ['--target', 'scalar'], ['--tile-size', '8'], ['--explain'],
                       ['--stats', self.out / 's.json'], ['--progress', 'none']):
            with self.subTest(option=option):
                result = self.check_fails(64, option[0], 'render', scene, *start, *option)
                self.assertIn('--preset textbook', result.stderr)
                self.assertIn('hint: ', result.stderr)
        for name in 'first_scene', 'phong_vs_pbr_pair', 'mesh_and_spheres':
            with self.subTest(name=name):
                other = SOURCE / f'scenes/{name}.json'
                result = self.check_fails(64, str(other), 'render', other, *start)
                self.assertIn('has no picture of this scene', result.stderr)
                self.assertIn('hint: ', result.stderr)
        self.check_fails(64, '--preset', 'render', scene, '-o', self.out / 'a.exr', '--preset', 'x')
        self.check_fails(64, '--size', 'render', scene, *start, '--size', '65536x65536')
        self.check_fails(64, 'twice', 'render', scene, *start, '-o', self.out / 'a.exr')
        self.check_fails(74, 'nowhere', 'render', scene, '--preset', 'textbook', '-o',
                         self.out / 'a.exr', '-o', self.out / 'nowhere/a.png')
        # The other commands that render have no scene to choose by.
        self.check_fails(64, '--preset', 'grid', *start)

    def test_explain_textbook_tells_every_fault_with_measured_amounts(self):
        result = run('explain', 'textbook')
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, '')
        text = result.stdout
        for number in range(1, 31):
            self.assertRegex(text, rf'(?m)^E{number} +\S')
        self.assertEqual(text.count('     lesson '), 30)
        self.assertEqual(text.count('     amount '), 30)
        # Known values, of pictures, quadrature and formulas.
        for value in ('332 pixels clipped', 'loses 55.6 % at n.v = 0.2, 77.9 % at n.v = 0.1',
                      'all directions: 0.8345', 'n.v = 0.18: 1.100', '10.6 % of each disc',
                      '0.225 degrees an axis, 0.318 in all', '0.0335 (8.5 codes)'):
            self.assertIn(value, ' '.join(text.split()))
        self.assertLessEqual(max(map(len, text.splitlines())), 100)

    def test_explain_textbook_draws_both_pictures(self):
        folder = self.out / 'new/folder'
        result = run('explain', 'textbook', '-o', folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sorted(path.name for path in folder.iterdir()),
                         ['material_grid.png', 'phong_vs_pbr.png'])
        self.assertIn('1880x548', run('info', folder / 'material_grid.png').stdout)

    def test_explain_refuses_other_topics(self):
        self.check_fails(64, 'unknown topic "shading"', 'explain', 'shading')
        self.check_fails(64, 'did you mean "textbook"', 'explain', 'textbok')
        self.check_fails(64, 'TOPIC', 'explain')
        (self.out / 'file').write_text('')
        self.check_fails(74, str(self.out / 'file'), 'explain', 'textbook', '-o', self.out / 'file')

    # ---- Metrics and reports ----

    def test_compare_measures_what_is_seen_when_asked(self):
        a, b = self.out / 'a.exr', self.out / 'b.exr'
        self.render('-o', a, *SMALL)
        self.render('-o', b, *SMALL, '--set', '/lights/key/intensity=500')
        plain = json.loads(run('compare', a, b, '--json').stdout)['layers'][-1]
        self.assertNotIn('ssim', plain)
        result = run('compare', a, b, '--json', '--metrics', 'all', '--flip-exposures', '-2,3,4')
        self.assertEqual(result.returncode, 1)
        layer = next(m for m in json.loads(result.stdout)['layers'] if m['layer'] == 'beauty')
        self.assertLess(layer['ssim'], 1)
        self.assertLess(0, layer['flip']['mean'])
        self.assertLess(layer['flip']['mean'], layer['flip']['max'])
        flip = layer['hdr_flip']
        self.assertEqual((flip['start_exposure'], flip['stop_exposure'], flip['exposures']), (-2, 3, 4))
        text = run('compare', a, a, '--metrics', 'ssim,flip')
        self.assertEqual(text.returncode, 0)
        self.assertIn('FLIP mean', text.stdout)
        self.assertIn('1.000000    0.000000    0.000000', text.stdout)

    def test_bad_metrics_are_named(self):
        image = self.out / 'a.exr'
        self.render('-o', image, *SMALL)
        self.check_fails(64, 'psnr', 'compare', image, image, '--metrics', 'psnr')
        for exposures in '1', '3,1', '1,2,0', '1,2,3,4', '1,nan', '0,1,65', '1,2,2.5':
            self.check_fails(64, 'range of exposures', 'compare', image, image, '--flip-exposures',
                             exposures)
        self.check_fails(64, '--ppd', 'compare', image, image, '--ppd', '0')

    def test_pictures_of_different_sizes_do_not_match(self):
        a, b = self.out / 'a.exr', self.out / 'b.exr'
        self.render('-o', a, *SMALL)
        self.render('-o', b, '--size', '32x18', '--spp', '1')
        result = run('compare', a, b, '--metrics', 'all')
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn('the display window is 64x36', result.stdout)
        self.check_fails(2, 'is 64x36', 'report', self.out / 'r.html', a, b)

    def report(self, *arguments):
        page = self.out / 'r.html'
        result = run('report', page, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout, '')
        return page.read_text()

    def report_data(self, page):
        text = page.split('id="report">')[1].split('</script>')[0]
        return json.loads(text)

    def test_report_of_a_scene_has_its_plan_and_needs_no_network(self):
        page = self.report(FIRST_SCENE, *SMALL, '--layers', 'N')
        image = self.report_data(page)['sections'][0]['sets'][0]['images'][0]
        self.assertTrue(any(item['used'] for item in image['stats']['plan']))
        self.assertGreater(image['stats']['time_ms']['stages_all_threads']['shade'], 0)
        self.assertEqual([layer['name'] for layer in image['layers']], ['', 'A', 'N'])
        self.assertIn("default-src 'none'", page)
        self.assertNotIn('src=', page.replace("img-src=", ''))

    def test_report_takes_the_stats_of_a_render(self):
        self.render('-o', self.out / 'a.exr', '--stats', self.out / 's.json', *SMALL)
        page = self.report(self.out / 'a.exr', self.out / 's.json')
        image = self.report_data(page)['sections'][0]['sets'][0]['images'][0]
        self.assertEqual(image['stats'], json.loads((self.out / 's.json').read_text()))
        self.check_fails(64, 'counts and times', 'report', self.out / 'q.html', self.out / 's.json')

    def test_report_compares_with_the_reference_named(self):
        a, b, c = (self.out / name for name in ('a.exr', 'b.exr', 'c.exr'))
        for path in a, b, c:
            self.render('-o', path, *SMALL)
        for options, reference in ([], 1), (['--reference', c], 2), (['--reference', a], 0):
            data = self.report_data(self.report(a, b, c, '--metrics', 'none', *options))
            shown = data['sections'][0]['sets'][0]
            self.assertEqual(shown['reference'], reference)
            self.assertEqual([m['image'] for m in shown['comparisons']],
                             [i for i in range(3) if i != reference])
            self.assertTrue(all(m['verdict']['match'] for m in shown['comparisons']))
        self.check_fails(64, 'not one of the pictures', 'report', self.out / 'r2.html', a, b,
                         '--reference', self.out / 'd.exr')

    def test_report_refuses_what_it_cannot_show(self):
        image = self.out / 'a.exr'
        self.render('-o', image, *SMALL)
        out = self.out / 'r.html'
        self.check_fails(64, 'unknown output extension', 'report', self.out / 'r.htm', image)
        self.check_fails(64, 'INPUT', 'report', out)
        self.check_fails(74, 'r.html', 'report', self.out / 'none' / 'r.html', image)
        self.check_fails(65, 'none.exr', 'report', out, self.out / 'none.exr')
        self.check_fails(65, 'none.json', 'report', out, self.out / 'none.json')
        self.check_fails(2, 'no *.reference.json', 'report', out, self.out)
        (self.out / 'bench.json').write_text('{"benchmarks": {}, "machine": {}}')
        self.check_fails(65, 'has no "targets"', 'report', out, self.out / 'bench.json')
        (self.out / 'bad.exr').write_bytes(image.read_bytes()[:200])
        self.check_fails(65, 'bad.exr', 'report', out, image, self.out / 'bad.exr')

    def test_a_report_that_fails_leaves_the_old_one(self):
        out, image = self.out / 'r.html', self.out / 'a.exr'
        self.render('-o', image, *SMALL)
        out.write_text('old')
        self.check_fails(65, 'none.exr', 'report', out, image, self.out / 'none.exr')
        self.assertEqual(out.read_text(), 'old')

    # ---- What it refuses ----

    def test_two_dashes_end_the_options(self):
        out, png = self.out / 'a.exr', self.out / 'x.png'
        for arguments in (['render', '-o', out, '--size', '8x8', '--', FIRST_SCENE], ['info', '--', out],
                          ['compare', '--', out, out], ['tonemap', '-o', png, '--', out]):
            with self.subTest(arguments=arguments):
                self.assertEqual(run(*arguments).returncode, 0)
        self.check_fails(64, '--output: is required', 'render', '--', FIRST_SCENE)
        self.check_fails(64, '-o: is behind --', 'render', '--', FIRST_SCENE, '-o', self.out / 'b.exr')
        self.check_fails(64, 'unexpected argument "c"', 'compare', '--', out, out, 'c')

    def test_usage_errors(self):
        scene = FIRST_SCENE
        out = ['-o', self.out / 'a.exr']
        cases = [
            ('the command is missing', []),
            ('paint', ['paint']),
            ('--output', ['render', scene]),
            ('SCENE', ['render', *out]),
            ('extension', ['render', scene, '-o', self.out / 'a.jpg']),
            ('twice', ['render', scene, *out, *out]),
            ('twice', ['render', scene, *out, '-o', self.out / '.' / '..' / self.out.name / 'a.exr']),
            ('twice', ['render', scene, *out, '--stats', self.out / 'a.exr']),
            ('--size', ['render', scene, *out, '--size', '0x10']),
            ('--size', ['render', scene, *out, '--size', '100000x10']),
            ('--size', ['render', scene, *out, '--size', '10']),
            ('--spp', ['render', scene, *out, '--spp', '0']),
            ('--spp', ['render', scene, *out, '--spp', 'many']),
            ('--region', ['render', scene, *out, '--region', '5,5,5,9']),
            ('--region', ['render', scene, *out, '--region', '9999,0,10000,5']),
            ('--layers', ['render', scene, *out, '--layers', 'difuse']),
            ('did you mean "diffuse"', ['render', scene, *out, '--layers', 'difuse']),
            ('--tonemap', ['render', scene, *out, '--tonemap', 'filmic']),
            ('--exposure', ['render', scene, *out, '--exposure', '1000']),
            ('--exposure', ['render', scene, *out, '--exposure', 'nan']),
            ('--max-abs', ['compare', scene, scene, '--max-abs', 'nan']),
            ('--target', ['render', scene, *out, '--target', 'mmx']),
            ('--threads', ['render', scene, *out, '--threads', '-3']),
            ('"image.spp" is not /json/pointer=value', ['render', scene, *out, '--set', 'image.spp']),
            ('/image/spp: { is not JSON', ['render', scene, *out, '--set', '/image/spp={']),
            ('--rows', ['grid', *out, '--rows', 'roughness']),
            ('--material', ['grid', *out, '--material', '{broken']),
            ('--rows', ['grid', *out, '--rows', 'roughness=0:1:65']),
            ('--columns', ['grid', *out, '--rows', 'roughness=0:1:2', '--columns', 'roughness=0:1:2']),
            ('--light', ['grid', *out, '--light', 'moon']),
            ('--lights', ['grid', *out, '--lights', '{broken']),
            ('--background', ['grid', *out, '--background', 'reddish']),
            ('--sphere-size', ['grid', *out, '--sphere-size', '0']),
            ('--sphere-size', ['grid', *out, '--sphere-size', '20', '--size', '64x64']),
            ('--sphere-size', ['grid', *out, '--sphere-size', '8000', '--rows', 'roughness=0:1:9']),
            ('--layout', ['pair', *out, '--layout', 'above']),
            ('--a', ['pair', *out, '--a', '{broken']),
            ('.png', ['pair', *out, '--layout', 'difference']),
            ('.png', ['convert', 'phong', *out]),
            ('--to', ['convert', 'phong', '--to', 'wood']),
            ('MATERIAL', ['convert', '{broken']),
            ('MATERIAL', ['convert']),
        ]
        for message, arguments in cases:
            with self.subTest(arguments=arguments):
                self.check_fails(64, message, *arguments)
        # The nearest of the command's options and of other programs' names for them.
        for word, meant in (('--smaples', '--spp'), ('--sampels', '--spp'), ('--samples', '--spp'),
                            ('--nthread', '--threads'), ('--envmpa', '--environment'), ('--smal', '--small'),
                            ('--spp-', '--spp'), ('--wdith', '--size')):
            with self.subTest(word=word):
                self.check_fails(64, f'did you mean {meant}?', 'render', scene, *out, word, '4')
        self.check_fails(64, 'the fast mode is gone', 'render', scene, *out, '--fast')
        # A command without that option: plot has no samples.
        self.check_fails(64, 'tells every option', 'plot', 'fresnel', '-o', self.out / 'a.png', '--smaples', '4')

    def test_bad_input(self):
        out = ['-o', self.out / 'a.exr']
        self.check_fails(65, 'missing.json', 'render', 'missing.json', *out)
        self.check_fails(65, str(self.out), 'render', self.out, *out)
        self.check_fails(65, 'roughnes', 'render', FIRST_SCENE, *out, '--set',
                         '/materials/x={"model":"metallic_roughness","roughnes":1}')
        self.check_fails(65, 'spp', 'render', FIRST_SCENE, *out, '--set', '/image/spp=-1')
        self.check_fails(65, 'shininess', 'grid', *out, '--rows', 'shininess=1:2:2')
        self.check_fails(65, 'did you mean "roughness"', 'grid', *out, '--rows', 'roughnes=0:1:2')
        self.check_fails(65, 'range', 'grid', *out, '--rows', 'roughness=0:2:3')
        self.check_fails(65, 'smith', 'grid', *out, '--rows', 'shadowing=smith')
        self.check_fails(65, 'fong', 'grid', *out, '--columns', 'material=fong,lambert')
        self.check_fails(65, 'missing.json', 'grid', *out, '--lights', 'missing.json')
        self.check_fails(65, 'missing.exr', 'grid', *out, '--environment', 'missing.exr')
        for scene in FIRST_SCENE, SOURCE / 'scenes/models/pawns.glb':
            for missing in 'missing.hdr', self.out / 'missing.hdr':
                self.check_fails(65, f'error: --environment: there is no file "{missing}"\n', 'render',
                                 scene, *out, '--environment', missing)
            self.check_fails(65, 'error: --environment: ', 'render', scene, *out, '--environment', self.out)
        for text, place in ('{"k": 1, "k": 2}', ''), ('{"a": {"k": 1, "k": 2}}', ': /a'):
            (self.out / 'twice.json').write_text(text)
            self.check_fails(65, f'error: {self.out / "twice.json"}{place}: "k" is there twice', 'grid', *out,
                             '--lights', self.out / 'twice.json')
        self.check_fails(65, '--b', 'pair', *out, '--b', 'fong')
        self.check_fails(65, 'MATERIAL', 'convert', 'fong')
        (self.out / 'bad.json').write_text('{"nacre": 1,')
        self.check_fails(65, 'bad.json', 'render', self.out / 'bad.json', *out)
        (self.out / 'bad.exr').write_bytes(b'\x76\x2f\x31\x01 not really')
        self.check_fails(65, 'bad.exr', 'tonemap', self.out / 'bad.exr', '-o', self.out / 'b.png')
        self.check_fails(65, 'bad.exr', 'info', self.out / 'bad.exr')

    def test_a_working_folder_that_is_gone_is_no_internal_error(self):
        gone = self.out / 'gone'
        scene, out = pathlib.Path(FIRST_SCENE).resolve(), ['-o', self.out / 'a.png', *SMALL]
        for arguments, message in ((['render', scene, *out], None),
                                   (['render', scene, *out, '--environment', 'sky.hdr'],
                                    'error: --environment: there is no file "sky.hdr"\n'),
                                   (['render', 'scene.json', *out], 'error: scene.json')):
            gone.mkdir()
            result = run(*arguments, cwd=gone, preexec_fn=gone.rmdir)
            self.assertEqual(result.returncode, 65 if message else 0, result.stderr)
            self.assertIn(message or 'a.png', result.stderr)

    def test_output_that_cannot_be_written_is_refused_before_rendering(self):
        (self.out / 'folder.exr').mkdir()
        os.mkfifo(self.out / 'pipe.exr')
        cases = [self.out / 'nowhere/a.exr', self.out / 'folder.exr', self.out / 'pipe.exr']
        for path in cases:
            with self.subTest(path=path):
                start = time.monotonic()
                self.check_fails(74, str(path), 'render', SOURCE / 'scenes/material_grid.json',
                                 '-o', path, '--size', '8192x8192', '--spp', '1024')
                self.assertLess(time.monotonic() - start, 30)  # rendering would take hours
        self.assertTrue(stat.S_ISFIFO((self.out / 'pipe.exr').stat().st_mode))

    def test_cannot_compare(self):
        self.render('-o', self.out / 'a.exr', *SMALL)
        (self.out / 'b.exr').write_text('no picture')
        self.check_fails(2, 'b.exr', 'compare', self.out / 'a.exr', self.out / 'b.exr')
        self.check_fails(2, 'missing.exr', 'compare', self.out / 'a.exr', self.out / 'missing.exr')
        self.check_fails(2, 'empty', 'validate', self.out / 'empty')

    def test_validate_goes_on_after_a_reference_that_cannot_be_compared(self):
        for name, scene in ('a', 'missing.json'), ('b', FIRST_SCENE):
            (self.out / f'{name}.reference.json').write_text(json.dumps({
                'scene': scene, 'image': 'missing.exr', 'tolerances': {}, 'reason': 'none'}))
        result = run('validate', self.out)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stdout.count('ERROR'), 2)

    def test_validate_differs_when_any_reference_does(self):
        small = json.loads(pathlib.Path(FIRST_SCENE).read_text())
        small['image'] = {'width': 64, 'height': 36, 'spp': 1}
        scene = self.out / 'scene.json'
        scene.write_text(json.dumps(small))
        for name, brightness in ('a', '70'), ('b', '140'):
            self.render('-o', self.out / f'{name}.exr', '--depth', 'float', '--set',
                        f'/lights/key/intensity={brightness}', scene=scene)
            (self.out / f'{name}.reference.json').write_text(json.dumps({
                'scene': 'scene.json', 'image': f'{name}.exr', 'layers': [''], 'tolerances': {},
                'reason': 'the same program'}))
        result = run('validate', self.out)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertEqual(result.stdout.count(' match '), 1)
        (self.out / 'a.reference.json').unlink()
        self.assertEqual(run('validate', self.out).returncode, 0)

    def test_tonemap_shows_the_layer_that_is_asked_for(self):
        self.render('-o', self.out / 'a.exr', '--layers', 'diffuse,specular', *SMALL)
        pictures = set()
        for layer in [], ['--layer', 'diffuse'], ['--layer', 'specular']:
            self.assertEqual(run('tonemap', self.out / 'a.exr', '-o', self.out / 'a.png',
                                 *layer).returncode, 0)
            pictures.add((self.out / 'a.png').read_bytes())
        self.assertEqual(len(pictures), 3)

    def test_a_full_standard_error_does_not_change_the_exit_code(self):
        with open('/dev/full', 'w') as full:
            result = subprocess.run([PROGRAM, 'render', 'missing.json', '-o',
                                     str(self.out / 'a.exr')], stderr=full)
        self.assertEqual(result.returncode, 65)

    def test_closed_and_full_streams_harm_no_file(self):
        command = f"'{PROGRAM}' render '{FIRST_SCENE}' -o '{self.out}/a.exr' --progress=json " \
                  '--size 320x180 --spp 64'
        for redirection in '2>&-', '2>/dev/full', '>&- 2>&- <&-':
            with self.subTest(redirection=redirection):
                self.assertEqual(subprocess.run(['sh', '-c', f'{command} {redirection}']).returncode,
                                 0)
                self.assertEqual(run('info', self.out / 'a.exr').returncode, 0)
        for what in 'schema', 'info', '--help':
            with self.subTest(what=what), open('/dev/full', 'w') as full:
                self.assertEqual(subprocess.run([PROGRAM, what], stdout=full).returncode, 74)

    def test_labels_may_cross_the_edge(self):
        for arguments in (['--size', '64x36'], ['--size', '32x18'],
                          ['--size', '640x360', '--region', '90,10,300,100'],
                          ['--rows', 'roughness=0.1:0.9:30', '--columns', 'metallic=0:1:30']):
            with self.subTest(arguments=arguments):
                result = run('grid', '-o', self.out / 'a.png', '--labels', '--spp', '1', *arguments)
                self.assertEqual(result.returncode, 0, result.stderr)

    def test_names_do_not_widen_a_sheet_without_end(self):
        for length in 400, 20000:
            with self.subTest(length=length):
                name = json.dumps({'model': 'phong', 'name': 'n' * length})
                result = run('grid', '-o', self.out / 'a.png', '--rows', f'material={name},blinn_phong',
                             '--sphere-size', '24', '--spp', '1')
                self.assertEqual(result.returncode, 0, result.stderr)
                width = int.from_bytes((self.out / 'a.png').read_bytes()[16:20], 'big')
                self.assertLess(width, 1000)

    def test_no_input_is_overwritten(self):
        self.render('-o', self.out / 'a.exr', *SMALL)
        scene = self.out / 'scene.json'
        scene.write_text(pathlib.Path(FIRST_SCENE).read_text())
        (self.out / 'b.png').symlink_to(self.out / 'a.exr')
        a = self.out / 'a.exr'
        self.check_fails(64, 'is read for this', 'render', scene, '-o', self.out / 'c.exr', '--stats', scene)
        self.check_fails(64, 'twice', 'tonemap', a, '-o', self.out / 'b.png')
        self.check_fails(64, 'twice', 'compare', a, a, '--heat-map', self.out / 'b.png')
        self.check_fails(64, 'extension', 'tonemap', a, '-o', self.out / 'c.exr')
        self.check_fails(64, 'extension', 'compare', a, a, '--heat-map', self.out / 'c.jpg')

    def test_the_main_path_does_not_load_openimageio(self):
        environment = dict(os.environ, LD_DEBUG='files')
        result = run('render', FIRST_SCENE, '-o', self.out / 'a.exr', '-o', self.out / 'a.png',
                     *SMALL, env=environment)
        self.assertEqual(result.returncode, 0)
        self.assertIn('libembree', result.stderr)
        self.assertNotIn('OpenImageIO', result.stderr)

    # ---- Plots and studies ----

    def plot(self, *arguments):
        result = run('plot', *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((result.stdout, result.stderr), ('', ''))

    def rows(self, name):
        lines = (self.out / name).read_text().splitlines()
        return lines[0].split(','), [line.split(',') for line in lines[1:]]

    def test_every_plot_is_drawn_without_any_option(self):
        for kind in ('brdf', 'polar', 'slice', 'ndf', 'masking', 'fresnel', 'albedo', 'tone',
                     'falloff'):
            with self.subTest(kind=kind):
                files = [self.out / (kind + extension) for extension in ('.svg', '.png', '.csv')]
                self.plot(kind, *[word for file in files for word in ('-o', file)])
                self.assertIn('</svg>', files[0].read_text())
                self.assertEqual(files[1].read_bytes()[:4], b'\x89PNG')
                titles, rows = self.rows(kind + '.csv')
                self.assertGreater(len(titles), 3)
                # What numpy.genfromtxt(file, delimiter=',', names=True) asks for: no quotes, no
                # comments, no empty names, rows of one length.
                self.assertFalse(set('"#') & set(''.join(titles)), titles)
                self.assertTrue(all(titles), titles)
                self.assertEqual({len(row) for row in rows}, {len(titles)})
                self.assertGreater(len(rows), 80)

    def test_a_plot_has_the_materials_that_it_is_told(self):
        self.plot('brdf', '--scene', FIRST_SCENE, '--material', 'floor', '-o', self.out / 'a.csv')
        titles, rows = self.rows('a.csv')
        self.assertEqual(titles[1:], ['floor'])
        for row in rows:  # Lambert of albedo 0.5
            self.assertAlmostEqual(float(row[1]), 0.5 / 3.141592653589793, places=12)
        self.plot('fresnel', '--material', '{"model": "dielectric", "ior": 2}', '--material',
                  'metallic_roughness', '-o', self.out / 'b.csv')
        titles, rows = self.rows('b.csv')
        self.assertEqual(float(rows[0][1]), 1 / 9)
        self.assertEqual(float(rows[0][-1]), 0.04)

    def test_a_plot_shows_the_kernels_beside_the_twins(self):
        self.plot('brdf', '--material', 'blinn_phong', '--angle', '30,60', '--cosine', '--kernel',
                  '-o', self.out / 'a.csv')
        titles, rows = self.rows('a.csv')
        self.assertEqual(len([title for title in titles if 'SIMD kernel' in title]), 2)

    def test_a_light_falls_off_as_the_scene_says(self):
        self.plot('falloff', '--scene', FIRST_SCENE, '--light', 'key', '-o', self.out / 'a.csv')
        _, rows = self.rows('a.csv')
        distance, irradiance = map(float, rows[-1])
        self.assertAlmostEqual(irradiance * distance**2, 140, places=9)
        # Of all lights of the scene those without a distance are left out, with a note.
        result = run('plot', 'falloff', '--scene', FIRST_SCENE, '-o', self.out / 'b.csv')
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count('note: "sky" is left out'), 1)
        self.assertEqual((self.out / 'b.csv').read_bytes(), (self.out / 'a.csv').read_bytes())

    def test_a_wrong_option_is_told_once(self):
        for layer in 'normal', 'light.kye':
            result = self.check_fails(64, 'unknown layer', 'render', FIRST_SCENE, '--layers', layer,
                                      '-o', self.out / 'a.png')
            self.assertNotIn('warning', result.stderr)

    def test_warnings_before_an_error_are_printed_before_it(self):
        """Of every reader: they may be its reason."""
        write = lambda name, text: (self.out / name).write_text(text)
        empty = {'asset': {'version': '2.0'}, 'extensionsUsed': ['EXT_unheard_of'],
                 'scenes': [{'nodes': []}]}
        write('empty.gltf', json.dumps(empty))
        write('a.obj', 'mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n')
        (self.out / 'sky.pfm').write_bytes(b'PF\n2 1\n-1.0\n' + struct.pack('<6f', *[-1.0] * 6))
        write('scene.json', json.dumps({'nacre': 1, 'lights': {'sky': {
            'type': 'environment', 'image': 'sky.pfm', 'clamp_negative': True}}, 'shapez': 1}))
        wrong = '--set', '/materials/nobody/roughness=1'
        for name, warning, error, *more in (
                ('empty.gltf', 'EXT_unheard_of is not known here', 'no triangles'),
                ('a.obj', 'there is no file "none.mtl"', 'nobody', *wrong),
                ('scene.json', 'samples below 0', 'shapez')):
            with self.subTest(name):
                result = run('render', self.out / name, '-o', self.out / 'a.png', *more)
                self.assertEqual(result.returncode, 65, result.stderr)
                lines = result.stderr.splitlines()
                self.assertRegex(lines[0], f'^warning: .*{warning}')
                self.assertRegex(lines[1], f'^error: .*{error}')
                quiet = run('render', self.out / name, '-o', self.out / 'a.png', *more, '--quiet')
                self.assertEqual(quiet.stderr.splitlines(), lines[1:])

    def test_names_of_small_spheres_are_all_written(self):
        """Names lie in tiers where they do not fit side by side: the page is higher for them."""
        heights = []
        for names in 'gold,silver,copper,iron,aluminium', 'gold,iron':
            result = run('grid', '--material', 'conductor', '--columns', 'preset=' + names, '-o',
                         self.out / 'a.exr', '--sphere-size', '40', '--spp', '1')
            self.assertEqual(result.returncode, 0, result.stderr)
            heights.append(int(re.search(r'window +\d+x(\d+)', run('info', self.out / 'a.exr').stdout)[1]))
        self.assertGreater(heights[0], heights[1] + 10)

    def test_small_difference_pages_keep_their_words_apart(self):
        """Below narrow cells the scale is not beside the measures but below them: 3.6 sizes of the
        text, which is 18 pixels high on either page, and nothing else differs."""
        strips = []
        for size in 120, 200:
            result = run('pair', '--layout', 'difference', '--a', 'lambert', '--b', 'burley', '-o',
                         self.out / 'a.png', '--sphere-size', str(size), '--spp', '1')
            self.assertEqual(result.returncode, 0, result.stderr)
            height = int(re.search(r'window +\d+x(\d+)', run('info', self.out / 'a.png').stdout)[1])
            strips.append(height - size / 0.88)
        self.assertAlmostEqual(strips[0] - strips[1], 3.6 * 18, delta=2)

    def test_bad_plots_are_refused_with_a_hint(self):
        out = ['-o', self.out / 'a.png']
        self.check_fails(64, 'did you mean "fresnel"', 'plot', 'fresnell', *out)
        self.check_fails(64, '.svg, .png and .csv', 'plot', 'fresnel', '-o', self.out / 'a.pdf')
        self.check_fails(64, '--output: is required', 'plot', 'fresnel')
        self.check_fails(64, 'is not a material', 'plot', 'brdf', '--material', '{"model"', *out)
        self.check_fails(65, 'did you mean "phong"', 'plot', 'brdf', '--material', 'phon', *out)
        self.check_fails(65, 'did you mean "floor"', 'plot', 'brdf', '--scene', FIRST_SCENE,
                         '--material', 'flor', *out)
        self.check_fails(65, 'has no Fresnel term', 'plot', 'fresnel', '--material', 'lambert',
                         *out)
        self.check_fails(65, 'is all around', 'plot', 'falloff', '--scene', FIRST_SCENE,
                         '--light', 'sky', *out)
        self.check_fails(65, 'missing.json', 'plot', 'brdf', '--scene', 'missing.json', *out)
        self.check_fails(64, 'is not a number', 'plot', 'brdf', '--angle', '95', *out)
        self.check_fails(74, 'no/a.png', 'plot', 'tone', '-o', self.out / 'no/a.png')

    def test_without_gnuplot_there_is_csv_still(self):
        bare = dict(os.environ, PATH=str(self.out))
        result = run('plot', 'tone', '-o', self.out / 'a.svg', env=bare)
        self.assertEqual(result.returncode, 74)
        self.assertIn('gnuplot-nox', result.stderr)
        self.assertEqual(run('plot', 'tone', '-o', self.out / 'a.csv', env=bare).returncode, 0)
        self.assertEqual([file.name for file in self.out.iterdir()], ['a.csv'])

    def test_a_study_answers_with_words_pictures_and_numbers(self):
        folder = self.out / 'made/for it'
        result = run('study', 'fresnel', '-o', folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout, '')
        answer = (folder / 'answer.md').read_text()
        self.assertIn('82.136', answer)
        named = set(re.findall(r'\]\(([^)]+)\)', answer))
        for name in named:
            self.assertTrue((folder / name).is_file(), name)
        self.assertEqual({name for name in named if name.endswith('.svg')}, {'fresnel.svg'})
        self.assertIn('the angle,82.13565962', (folder / 'numbers.csv').read_text())

    def test_studies_are_listed_and_slips_are_refused(self):
        listed = run('study', 'list')
        self.assertEqual(listed.returncode, 0)
        for name in ('components', 'blinn-exponent', 'interpolation', 'grid', 'fresnel', 'energy',
                     'precision', 'tonemap'):
            self.assertIn(name, listed.stdout)
        self.check_fails(64, 'did you mean "energy"', 'study', 'enery', '-o', self.out / 'a')
        self.check_fails(64, 'needs a folder', 'study', 'energy')
        (self.out / 'file').write_text('')
        self.check_fails(74, 'file', 'study', 'energy', '-o', self.out / 'file')

    def test_an_old_file_survives_a_failed_render(self):
        self.render('-o', self.out / 'a.exr', *SMALL)
        old = (self.out / 'a.exr').read_bytes()
        self.check_fails(65, 'spp', 'render', FIRST_SCENE, '-o', self.out / 'a.exr', '--set',
                         '/image/spp=-1')
        self.assertEqual((self.out / 'a.exr').read_bytes(), old)

    def test_signals_stop_it_and_leave_nothing(self):
        for number, code in (signal.SIGINT, 130), (signal.SIGTERM, 143):
            with self.subTest(signal=number):
                process = subprocess.Popen(
                    [PROGRAM, 'render', str(SOURCE / 'scenes/material_grid.json'), '-o',
                     str(self.out / 'a.exr'), '-o', str(self.out / 'a.png'), '--size',
                     '4096x4096', '--spp', '256', '--progress=json'], stderr=subprocess.PIPE)
                process.stderr.readline()  # rendering has begun
                process.send_signal(number)
                process.communicate(timeout=60)
                self.assertEqual(process.returncode, code)
                self.assertEqual(list(self.out.iterdir()), [])


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=1)
