#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Options: those that cannot apply are refused, help is readable; and files that options ask for.

Usage: options_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
FIRST_SCENE = str(SOURCE / 'scenes/first_scene.json')
SMALL = ['--size', '64x36', '--spp', '1']


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120, check=False)


class OptionsTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.out = pathlib.Path(self.folder.name)

    def check_works(self, *arguments):
        result = run(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def check_refused(self, option, *arguments):
        result = run(*arguments)
        self.assertEqual(result.returncode, 64, arguments)
        self.assertIn(f'error: {option[0]}: cannot be used with', result.stderr)
        self.assertIn('hint: ', result.stderr)
        self.assertEqual(list(self.out.iterdir()), [])

    # What no page of differences has.
    OF_FILES = (['--region', '0,0,9,9'], ['--tile', '0/2'], ['--layers', 'diffuse'],
                ['--depth', 'float'], ['--compression', 'piz'], ['--dry-run'], ['--explain'],
                ['--stats', '-'], ['--progress', 'json'])

    def test_pages_of_differences_take_what_means_something_to_them(self):
        page = ['-o', self.out / 'a.png', *SMALL]
        for option in self.OF_FILES:
            with self.subTest(option=option):
                self.check_refused(option, 'pair', '--layout', 'difference', *page, *option)
                self.check_refused(option, 'convert', 'phong', *page, *option)
        taken = ['--seed', '2', '--small', '--reproducible', '--threads', '1',
                 '--tonemap', 'agx', '--light', 'studio', '--no-labels', '--set', '/image/spp=2']
        self.check_works('pair', '--layout', 'difference', *page, *taken)
        self.check_works('convert', 'phong', *page, *taken)

    def test_null_writes_no_file(self):
        stats = self.out / 'stats.json'
        result = self.check_works('render', FIRST_SCENE, '-o', 'null:', *SMALL, '--stats', stats)
        self.assertIn('no file: 64x36', result.stderr)
        self.assertEqual([path.name for path in self.out.iterdir()], ['stats.json'])
        self.assertGreater(json.loads(stats.read_text())['time_ms']['render'], 0)
        self.check_works('render', FIRST_SCENE, '-o', 'null:', '-o', self.out / 'a.png', *SMALL)
        self.assertTrue((self.out / 'a.png').exists())
        self.check_works('grid', '-o', 'null:', *SMALL)

    def test_convert_without_a_picture_takes_no_options_of_pictures(self):
        for option in (['--spp', '4'], ['--light', 'studio'], ['--size', '9x9'], ['--labels'],
                       ['--tonemap', 'aces'], *self.OF_FILES):
            with self.subTest(option=option):
                self.check_refused(option, 'convert', 'phong', *option)
        self.check_works('convert', 'phong', '--to', 'dielectric', '--json')

    def test_plots_take_the_options_of_their_kind(self):
        out = ['-o', self.out / 'a.csv']
        for kind, option in (('tone', ['--material', 'phong']), ('tone', ['--scene', FIRST_SCENE]),
                             ('fresnel', ['--angle', '30']), ('slice', ['--log']),
                             ('polar', ['--cosine']), ('ndf', ['--channel', 'red']),
                             ('falloff', ['--material', 'phong']), ('brdf', ['--one-light']),
                             ('albedo', ['--exposure', '1']), ('masking', ['--kernel'])):
            with self.subTest(kind=kind, option=option):
                self.check_refused(option, 'plot', kind, *out, *option)

    # ---- Values ----

    def check_usage(self, message, *arguments):
        result = run(*arguments)
        self.assertEqual(result.returncode, 64, (arguments, result.stderr))
        self.assertIn(message, result.stderr)
        self.assertEqual(result.stderr.count('error: '), 1)
        self.assertIn('hint: ', result.stderr)
        self.assertEqual(result.stdout, '')
        self.assertEqual(list(self.out.iterdir()), [])

    # Every option that takes a list, with a list that is right, of commands that end with -o FILE
    # or with positional arguments: an option that took one word too many would take these.
    def lists(self):
        image = SOURCE / 'tests/references/textbook/phong_vs_pbr.exr'
        out = ['-o', self.out / 'a.exr', *SMALL]
        return (('--layers', 'N,Z', ['render', FIRST_SCENE], out),
                ('--layers', 'N,Z', ['grid', '--rows', 'roughness=0.5'], out),
                ('--layers', 'beauty', ['compare'], [image, image]),
                ('--metrics', 'ssim,flip', ['compare'], [image, image]),
                ('--angle', '30,60', ['plot', 'brdf'], ['-o', self.out / 'a.csv']),
                ('--layers', 'N,Z', ['report'], [self.out / 'a.html', FIRST_SCENE, *SMALL]),
                ('--metrics', 'ssim,flip', ['report'], [self.out / 'a.html', image, image]))

    def test_lists_have_no_empty_elements(self):
        for name, right, before, after in self.lists():
            first = right.split(',')[0]
            for wrong in ',', '', f'{first},', f',{first}', f'{first},,{first}':
                with self.subTest(command=before[0], name=name, list=wrong):
                    self.check_usage(f'error: {name}: ', *before, name, wrong, *after)
            with self.subTest(command=before[0], name=name, list='='):
                self.check_usage(f'error: {name}: its value is missing', *before, name + '=', *after)

    def test_lists_take_one_word(self):
        for name, right, before, after in self.lists():
            for given in [name, right], [f'{name}={right}'], [name, right.split(',')[0], name, right]:
                with self.subTest(command=before[0], given=given):
                    self.check_works(*before, *given, *after)

    def test_an_option_is_no_value_of_the_option_before(self):
        out = ['-o', self.out / 'a.exr', *SMALL]
        for option, before, after in (
                ('--size', ['render', FIRST_SCENE], out),
                ('--layers', ['render', FIRST_SCENE], out),
                ('--set', ['render', FIRST_SCENE], out),
                ('--stats', ['render', FIRST_SCENE], ['--exposure=1', *out]),
                ('-o', ['render', FIRST_SCENE], SMALL),
                ('--title', ['plot', 'brdf'], ['--log', '-o', self.out / 'a.csv']),
                ('--part', ['tonemap', 'a.exr'], ['--layer', 'N', '-o', self.out / 'a.png'])):
            with self.subTest(option=option):
                self.check_usage(f'error: {option}: its value is missing', *before, option, *after)
                self.check_usage(f'error: {option}: its value is missing', *before, *after, option)
                if option != '-o':
                    self.check_usage(f'error: {option}: its value is missing', *before, option + '=',
                                     *after)
        # Negative numbers, "-" for standard output and what is written with "=" are values.
        self.check_works('render', FIRST_SCENE, '-o', self.out / 'a.png', *SMALL, '--exposure', '-1',
                         '--stats', '-')
        self.check_works('plot', 'brdf', '--title=--log', '-o', self.out / 'a.csv')

    # What CLI11 finds is told in nacre's own words: where, what, and a hint.
    def test_messages_are_of_one_form(self):
        image = SOURCE / 'tests/references/textbook/phong_vs_pbr.exr'
        out = ['-o', self.out / 'a.exr']
        scene = ['render', FIRST_SCENE, *out]
        for message, arguments in (
                ('--spp: is given 2 times\n  hint: give it once\n', [*scene, '--spp', '1', '--spp', '1']),
                ('--tonemap: is given 3 times\n  hint: give it once\n',
                 [*scene, '--tonemap=aces', '--tonemap=aces', '--tonemap', 'agx']),
                ('--max-abs: is given 2 times', ['compare', image, image, '--max-abs', '1', '--max-abs', '2']),
                ('--depth: "16" is none of its values\n  hint: one of: half, float\n',
                 [*scene, '--depth', '16']),
                ('--progress: "off" is none of its values\n  hint: one of: auto, bar, json, none\n',
                 [*scene, '--progress', 'off']),
                ('--tonemap: "nuetral" is none of its values\n  hint: did you mean "neutral"?\n',
                 [*scene, '--tonemap', 'nuetral']),
                ('--metrics: "hdr_flop" is none of its values\n  hint: did you mean "hdr_flip"?\n',
                 ['compare', image, image, '--metrics', 'flip,hdr_flop']),
                ('--seed: "x" is not a number\n', [*scene, '--seed', 'x']),
                ('--spp: x is not a whole number from 1 to 65536\n  hint: ', [*scene, '--spp', 'x']),
                ('--quiet: takes no value\n  hint: write --quiet alone\n', [*scene, '--quiet=maybe']),
                ('--output: is required\n  hint: ', ['render', FIRST_SCENE]),
                ('SCENE: is required\n  hint: ', ['render', *out]),
                ('REFERENCE: is required\n  hint: ', ['compare', image]),
                ('unexpected argument "b.json"\n  hint: ', [*scene, 'b.json']),
                ('unknown option --loud\n  hint: ', [*scene, '--loud']),
                ('--material: "fong" is no model\n', ['grid', *out, '--material', 'fong']),
                ('--columns: "fong" is no model\n', ['grid', *out, '--columns', 'material=phong,fong']),
                ('--rows: "fong" is no model\n', ['grid', *out, '--rows', 'material=phong,fong'])):
            with self.subTest(arguments=arguments):
                result = run(*arguments)
                self.assertIn(result.returncode, (64, 65))
                self.assertIn(f'error: {message}', result.stderr)
                self.assertEqual(result.stderr.count('\n'), 2)
                for word in 'required but', 'Could not', 'At Most', 'not in {', 'expected:':
                    self.assertNotIn(word, result.stderr)
        self.assertEqual(list(self.out.iterdir()), [])

    # What people type who come from Blender, Cycles, Mitsuba, pbrt, POV-Ray, appleseed and
    # OpenImageIO's tools.
    def test_other_programs_options_are_known(self):
        for word, ours in (('--outfile', '-o'), ('--render-output', '-o'), ('+Oa.png', '-o'),
                           ('--resolution', '--size'), ('-r', '--size'), ('--scale', '--size'),
                           ('--resize', '--size'), ('+W640', '--size'), ('+H480', '--size'),
                           ('--nthreads', '--threads'), ('--num-threads', '--threads'), ('-t', '--threads'),
                           ('--aov', '--layers'), ('-d', '--depth'), ('-q', '--quiet'), ('-v', '--explain'),
                           ('--verbose', '--explain'), ('--device', '--target'), ('--define', '--set'),
                           ('--override', '--set'), ('--pixelbounds', '--region'), ('--passes', '--spp'),
                           ('+A0.1', '--spp'), ('--gamma', '--tonemap')):
            with self.subTest(word=word):
                self.check_usage(f'did you mean {ours}?', 'render', FIRST_SCENE, '-o', self.out / 'a.png', word)
        for word, hint in (('--frame', 'a scene is one picture'), ('-f', 'a scene is one picture'),
                           ('--format', 'the name behind -o'), ('-F', 'the name behind -o'),
                           ('--gpu', 'renders on the processor'), ('--integrator', 'without further bounces'),
                           ('--max-depth', 'without further bounces'), ('-i', 'without an option'),
                           ('--camera', '/camera/position'), ('--denoise', '--max-error'),
                           ('-b', 'opens no window')):
            with self.subTest(word=word):
                self.check_usage(f'error: unknown option {word}\n', 'render', FIRST_SCENE, '-o',
                                 self.out / 'a.png', word)
                self.check_usage(hint, 'render', FIRST_SCENE, '-o', self.out / 'a.png', word, '4')
        image = SOURCE / 'tests/references/textbook/phong_vs_pbr.exr'
        self.check_usage('did you mean --max-abs?', 'compare', image, image, '--fail', '0.1')
        self.check_usage('did you mean --fraction?', 'compare', image, image, '--failpercent', '1')

    def test_set_takes_words_where_strings_are_wanted(self):
        scene = self.out / 'scene.json'
        text = json.loads(pathlib.Path(FIRST_SCENE).read_text())
        text['materials']['7'] = {'model': 'lambert', 'albedo': 0.1}
        text['textures'] = {'1e3': {'file': '12'}}
        scene.write_text(json.dumps(text))
        (self.out / '12').write_bytes(b'P6\n1 1\n255\nabc')
        picture = self.out / 'a.exr'

        def bits(*sets):
            options = [word for value in sets for word in ('--set', value)]
            result = run('render', scene, '-o', picture, *SMALL, '--reproducible', *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            return picture.read_bytes()[-1000:]  # the samples: the header has the options

        for word, quoted in (('/shapes/0/material=floor', '/shapes/0/material="floor"'),
                             ('/shapes/0/material=7', '/shapes/0/material="7"'),
                             ('/camera/type=perspective', '/camera/type="perspective"'),
                             ('/materials/red/shadowing=separable', '/materials/red/shadowing="separable"'),
                             ('/materials/red/base_color_map=1e3', '/materials/red/base_color_map="1e3"'),
                             ('/textures/1e3/file=12', '/textures/1e3/file="12"'),
                             ('/image/filter/type=box', '/image/filter/type="box"'),
                             ('/lights/key/attenuation=none', '/lights/key/attenuation="none"')):
            with self.subTest(word=word):
                self.assertEqual(bits(word), bits(quoted))
        bits('/materials/red/base_color_map=null', '/materials/red/roughness=1')
        picture.unlink()

        def refused(message, value, code=64):
            result = run('render', scene, '-o', picture, *SMALL, '--set', value)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertIn(message, result.stderr)
            self.assertFalse(picture.exists())

        refused('/image/spp: many is not JSON\n  hint: a whole number is wanted there\n', '/image/spp=many')
        refused('/materials/red/roughness: rough is not JSON\n  hint: a number is wanted there\n',
                '/materials/red/roughness=rough')
        refused('a list in brackets or a number is wanted there', '/materials/red/base_color=red')
        refused('a list in brackets is wanted there', '/camera/position=front')
        refused('true or false is wanted there', '/image/shadows=off')
        refused('write 0.5', '/materials/red/roughness=.5')
        refused('a string needs quotes', '/nothing/here=word')
        refused('did you mean "orthographic"?', '/camera/type=ortographic', 65)
        refused('is not JSON', '/shapes/0/material="floor')
        refused('/shapes/0/material', '/shapes/0/material=gold', 65)

    def test_a_heat_scale_goes_up(self):
        image = SOURCE / 'tests/references/textbook/phong_vs_pbr.exr'
        for low, high in (['1', '0.1'], ['0.1', '0.1'], ['2', None], [None, '1e-7']):
            ends = (['--heat-low', low] if low else []) + (['--heat-high', high] if high else [])
            for heat_map in [], ['--heat-map', self.out / 'a.png']:
                with self.subTest(ends=ends, heat_map=heat_map):
                    self.check_usage('error: --heat-low: ', 'compare', image, image, *ends, *heat_map)
        self.check_works('compare', image, image, '--heat-low', '0.1', '--heat-high', '0.2',
                         '--heat-map', self.out / 'a.png')

    # ---- Files ----

    def test_slices_are_drawn_with_their_numbers(self):
        files = [self.out / name for name in ('a.svg', 'a.png', 'a.csv')]
        self.check_works('plot', 'slice', '--material', 'phong', '--material', 'lambert', '--title',
                         'Two', *[word for file in files for word in ('-o', file)])
        self.assertIn('</svg>', files[0].read_text())
        self.assertEqual(files[1].read_bytes()[:4], b'\x89PNG')
        lines = files[2].read_text().splitlines()
        self.assertEqual(len(lines), 1 + 180 * 180)
        self.assertAlmostEqual(float(lines[-1].split(',')[5]), 0.5 / 3.141592653589793, places=12)

    def test_conversions_are_drawn_as_curves(self):
        files = [self.out / name for name in ('a.svg', 'a.csv')]
        told = self.check_works('convert', 'phong', '--curves', files[0], '--curves', files[1])
        self.assertEqual(json.loads(told.stdout.splitlines()[0])['model'], 'metallic_roughness')
        self.assertIn('</svg>', files[0].read_text())
        titles = next(csv.reader([files[1].read_text().splitlines()[0]]))
        self.assertEqual(len(titles), 4 * (1 + 3))  # views; an angle, and three lobes
        for word in 'viewer at 75', 'closed form', 'fit':
            self.assertTrue(any(word in title for title in titles), word)

    def test_validations_are_reported(self):
        scene = json.loads(pathlib.Path(FIRST_SCENE).read_text())
        scene['image'] = {'width': 64, 'height': 36, 'spp': 1}
        (self.out / 'scene.json').write_text(json.dumps(scene))
        self.check_works('render', self.out / 'scene.json', '-o', self.out / 'a.exr', '--depth',
                         'float')
        for name, image in ('a', 'a.exr'), ('b', 'missing.exr'):
            (self.out / f'{name}.reference.json').write_text(json.dumps({
                'scene': 'scene.json', 'image': image, 'layers': [''], 'tolerances': {},
                'reason': 'the same program'}))
        report = self.out / 'r.html'
        result = run('validate', self.out, '--report', report)
        self.assertEqual(result.returncode, 2)
        self.assertIn(' match ', result.stdout)
        page = report.read_text()
        for word in 'the same program', '"outcome":"error"', '"outcome":"match"':
            self.assertIn(word, page)
        (self.out / 'b.reference.json').unlink()
        self.check_works('validate', self.out, '--report', report)
        result = run('validate', self.out, '--report', self.out / 'r.txt')
        self.assertEqual(result.returncode, 64)
        self.assertEqual(result.stdout, '')  # before anything is rendered

    # ---- Help ----

    def check_help_all(self, name, short):
        """--help-all has all options; --help names those that it leaves out, and cuts no words."""
        whole = self.check_works(name, '--help-all').stdout
        listed = r'(?m)^  (?:-\w,)?(--[a-z][a-z-]*)'
        shown, every = re.findall(listed, short), re.findall(listed, whole)
        self.assertEqual(len(every), len(set(every)))
        self.assertLessEqual(set(shown), set(every))
        more = re.search(rf'(?s)\nMore: nacre {name} --help-all(.*?)\n\n', short)
        self.assertEqual(set(re.findall(r'--[a-z][a-z-]*', more.group(1)) if more else []),
                         set(every) - set(shown))
        if not more:
            self.assertEqual(short, whole)
        for text in re.findall(r'(?m)^ {24}.*[a-z]$', short):
            self.assertNotRegex(text, r'\be\.g$')

    def test_help_fits_a_terminal_and_has_examples(self):
        text = self.check_works('--help').stdout
        names = re.findall(r'^  ([a-z]+) ', text.partition('Commands:')[2], re.M)
        self.assertGreater(len(names), 10)
        for name in names:
            help_text = self.check_works(name, '--help').stdout
            self.assertIn('Usage: nacre ' + name, help_text)
            self.assertRegex(help_text, r'(?s)Examples?:\n.*  nacre ' + name)
            options = help_text.partition('xample')[0]
            self.assertLessEqual(len(help_text.partition('Example')[0].splitlines()), 48)
            self.check_help_all(name, help_text)
            # Ends of text and examples, which are lines to be copied, may be longer.
            for line in options.splitlines():
                self.assertLessEqual(len(line), 100, line)
            body = re.findall(r'^ {24}.*', options, re.M)
            self.assertLessEqual(max(map(len, body), default=0), 80)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
