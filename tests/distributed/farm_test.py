#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/farm_local from outside: failures, resumption, and the picture that comes of it.

Usage: farm_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
"""
import importlib.machinery
import importlib.util
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, SOURCE = (os.path.abspath(word) for word in sys.argv[1:3])
SCENE = SOURCE + '/scenes/first_scene.json'
OPTIONS = ['--size', '64x300', '--spp', '2', '--reproducible']
WRAPPER = SOURCE + '/tests/distributed/fails_at_first'


class FarmTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)
        self.failed = self.out / 'failed'
        self.failed.mkdir()

    def command(self, *arguments, scene=SCENE, nacre=WRAPPER):
        return [sys.executable, '-B', SOURCE + '/scripts/farm_local', scene, '-o',
                str(self.out / 'a.exr'), '--nacre', nacre, *map(str, arguments)]

    def environment(self, failing=''):
        return dict(os.environ, NACRE=PROGRAM, FAILING=failing, FAILED=str(self.failed))

    def farm(self, *arguments, failing='', **options):
        return subprocess.run(self.command(*arguments, **options), env=self.environment(failing),
                              capture_output=True, text=True, timeout=120, check=False)

    def check_picture(self, result, *options):
        """It is the single render's, and no tile is left."""
        self.assertEqual(result.returncode, 0, result.stderr)
        single = self.out / 'single.exr'
        subprocess.run([PROGRAM, 'render', SCENE, '-o', single, '--quiet', *OPTIONS, *options],
                       check=True)
        self.assertEqual((self.out / 'a.exr').read_bytes(), single.read_bytes())
        self.assertEqual(list(self.out.glob('*.tiles')), [])

    def tiles(self):
        return {path.name: path for path in self.out.rglob('tile_*.exr')}

    def test_killed_tiles_are_rendered_again_and_the_picture_is_the_single_renders(self):
        result = self.farm('--tiles', '8', '--processes', '3', *OPTIONS, failing='0 3 7')
        self.check_picture(result)
        self.assertEqual(sorted(path.name for path in self.failed.iterdir()), ['0', '3', '7'])
        self.assertIn('tile 3/8: exit code -9', result.stderr)
        self.assertIn('tiles 8/8', result.stderr)

    def test_a_program_that_is_not_built_is_told_in_one_line(self):
        result = self.farm('--tiles', '8', nacre=str(self.out / 'nacre'))
        self.assertEqual(result.returncode, 64)
        self.assertRegex(result.stderr, r'^error: \S*/nacre is not there: scripts/build release nacre [^\n]*\n$')

    def test_names_are_printed_as_nacre_prints_them(self):
        """scripts/farm.py has a printable() of its own: a script is no place for the library."""
        loader = importlib.machinery.SourceFileLoader('farm', SOURCE + '/scripts/farm.py')
        farm = importlib.util.module_from_spec(importlib.util.spec_from_loader('farm', loader))
        loader.exec_module(farm)
        # Every character from 1 to U+3000, some further ones, and bytes that are no UTF-8.
        codes = [*range(1, 0x3001), 0xd7ff, 0xe000, 0xfeff, 0xfffd, 0xffff, 0x10000, 0x1f469, 0x10ffff]
        texts = [''.join(map(chr, codes[i:i + 500])).encode() for i in range(0, len(codes), 500)]
        texts += [bytes(range(0x80, 0x100)), b'\xed\xa0\x80 \xc0\x9b \xf4\x90\x80\x80 \xe2\x80', b'\xe2\x1b[m']
        for text in texts:
            name = text + b'.json'
            result = subprocess.run([os.fsencode(PROGRAM), b'info', name], capture_output=True, timeout=120,
                                    check=False)
            self.assertEqual(result.returncode, 65)
            shown = farm.printable(os.fsdecode(name)).encode()
            self.assertTrue(result.stderr.startswith(b'error: ' + shown + b': '), (result.stderr, shown))

    def test_all_tiles_may_fail_once(self):
        self.check_picture(self.farm('--tiles', '5', *OPTIONS, failing='all'))

    def test_what_failed_too_often_is_told_and_resumed(self):
        result = self.farm('--tiles', '6', '--retries', '0', *OPTIONS, failing='2')
        self.assertEqual(result.returncode, 1)
        self.assertIn('1 of 6 tiles failed 1 times', result.stderr)
        self.assertFalse((self.out / 'a.exr').exists())
        self.assertEqual(len(self.tiles()), 5)
        before = {name: path.stat().st_mtime_ns for name, path in self.tiles().items()}
        result = self.farm('--tiles', '6', '--keep-tiles', *OPTIONS)
        self.assertIn('5 of 6 tiles are there already', result.stderr)
        for name, time_ns in before.items():
            self.assertEqual(self.tiles()[name].stat().st_mtime_ns, time_ns)

    def test_a_tile_that_is_damaged_is_made_anew(self):
        self.farm('--tiles', '4', '--retries', '0', *OPTIONS, failing='2')
        tile = self.tiles()['tile_0001_of_0004.exr']
        tile.write_bytes(tile.read_bytes()[:-50])
        result = self.farm('--tiles', '4', *OPTIONS)
        self.assertIn('tile_0001', result.stderr)
        self.check_picture(result)

    def test_tiles_with_a_flipped_bit_are_made_anew(self):
        self.farm('--tiles', '4', '--retries', '0', *OPTIONS, failing='2')
        for name in 'tile_0000_of_0004.exr', 'tile_0001_of_0004.exr', 'tile_0003_of_0004.exr':
            tile = self.tiles()[name]
            data = tile.read_bytes()
            tile.write_bytes(data[:-40] + bytes([data[-40] ^ 8]) + data[-39:])
        result = self.farm('--tiles', '4', *OPTIONS)
        self.assertIn('tile_0001', result.stderr)
        self.check_picture(result)

    def test_no_tile_is_removed_before_the_picture_is_proven(self):
        """Between merge's end and the farm's look at it, somebody damages the merged file."""
        for output in 'a.exr', 'a.png':
            with self.subTest(output=output):
                wrapper = self.out / 'wrapper'
                wrapper.write_text(f'#!/bin/sh\n"{PROGRAM}" "$@" || exit\n'
                                   'if [ "$1" = merge ]; then\n'
                                   f'  size=$(stat -c %s "{self.out}/{output}")\n'
                                   f'  printf X | dd of="{self.out}/{output}" bs=1 seek=$((size / 2)) '
                                   'conv=notrunc 2>/dev/null\nfi\n')
                wrapper.chmod(0o755)
                result = self.farm('--tiles', '4', '-o', self.out / 'a.png', *OPTIONS, nacre=str(wrapper))
                self.assertNotEqual(result.returncode, 0)
                self.assertIn('its tiles are kept', result.stderr)
                self.assertIn(output, result.stderr)
                self.assertEqual(len(self.tiles()), 4)
        self.check_picture(self.farm('--tiles', '4', '-o', self.out / 'a.png', *OPTIONS))

    def test_tiles_of_other_settings_are_not_taken(self):
        self.farm('--tiles', '4', '--retries', '0', *OPTIONS, failing='2')
        brighter = ['--set', '/lights/key/intensity=200']
        result = self.farm('--tiles', '4', *OPTIONS, *brighter)
        self.assertNotIn('there already', result.stderr)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(self.tiles()), 3)  # those of the first, kept for it
        self.check_picture(self.farm('--tiles', '4', *OPTIONS))

    def test_exr_and_png_in_any_compression(self):
        options = ['--compression', 'dwaa', '--layers', 'all']
        result = self.farm('-o', self.out / 'a.png', '--exposure', '1', '--tonemap=aces', '--quiet',
                           *OPTIONS, *options)
        self.check_picture(result, *options)
        self.assertEqual((self.out / 'a.png').read_bytes()[:4], b'\x89PNG')
        self.assertEqual(result.stderr, '')

    def test_what_another_attempt_cannot_change_is_not_tried_again(self):
        for arguments, code, message in ((['--spp', 'many'], 64, '--spp'),
                                         (['--tiles', '20'], 64, '19 at most'),
                                         (['--tile', '0/2'], 64, '--tile cannot be used'),
                                         (['--stats=s.json'], 64, '--stats cannot be used'),
                                         (['-o', self.out / 'no/a.png'], 74, 'no/a.png')):
            result = self.farm(*OPTIONS, *arguments)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertIn(message, result.stderr)
        result = self.farm(scene=str(self.out / 'missing.json'))
        self.assertEqual(result.returncode, 65, result.stderr)
        self.assertEqual([path.name for path in self.out.iterdir()], ['failed'])

    def test_a_stopped_farm_goes_on_where_it_was(self):
        scene = SOURCE + '/scenes/material_grid.json'
        slow = ['--tiles', '8', '--processes', '1', '--size', '960x1000', '--spp', '64',
                '--reproducible']
        process = subprocess.Popen(self.command(*slow, scene=scene), env=self.environment(),
                                   stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while not self.tiles() and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 143, said)
        self.assertIn('run the same command again', said)
        done = len(self.tiles())
        self.assertTrue(0 < done < 8, done)
        self.assertFalse((self.out / 'a.exr').exists())
        result = self.farm(*slow, scene=scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f'{done} of 8 tiles are there already', result.stderr)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=1)
