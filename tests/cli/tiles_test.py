#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tiles and what merges them, from outside: nacre render --tile, nacre merge, --dry-run.

Usage: tiles_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
"""
import json
import pathlib
import random
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
FIRST_SCENE = str(SOURCE / 'scenes/first_scene.json')
# Six strips and four rows more: no number of tiles divides it.
SMALL = ['--size', '64x100', '--spp', '2', '--reproducible']


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120)


def with_right_checksum(data):
    """The file with the checksum that nacre would give it."""
    mark = b'nacre:checksum\0string\0\x08\0\0\0'
    place = data.index(mark) + len(mark)
    crc = zlib.crc32(data[:place] + b'00000000' + data[place + 8:])
    return data[:place] + f'{crc:08x}'.encode() + data[place + 8:]


def with_attribute(path, name, kind, value):
    """The tile with another value, of any type, for an attribute; its checksum is right."""
    data = path.read_bytes()
    at, changed = 8, data[:8]
    while data[at]:
        end_of_name = data.index(b'\0', at)
        end_of_kind = data.index(b'\0', end_of_name + 1)
        size = struct.unpack('<i', data[end_of_kind + 1:end_of_kind + 5])[0]
        end = end_of_kind + 5 + size
        if data[at:end_of_name] == name.encode():
            changed += name.encode() + b'\0' + kind + b'\0' + struct.pack('<i', len(value)) + value
        else:
            changed += data[at:end]
        at = end
    table, grown = at + 1, len(changed) - at
    count = (struct.unpack('<Q', data[table:table + 8])[0] - table) // 8
    places = struct.unpack(f'<{count}Q', data[table:table + 8 * count])
    changed += b'\0' + struct.pack(f'<{count}Q', *(place + grown for place in places))
    result = path.with_name('changed_' + path.name)
    result.write_bytes(with_right_checksum(changed + data[table + 8 * count:]))
    return result


class TilesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)

    def render(self, name, *arguments, scene=FIRST_SCENE):
        result = run('render', scene, '-o', self.out / name, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.out / name

    def tiles(self, count, *arguments, scene=FIRST_SCENE):
        return [self.render(f't{i}.exr', '--tile', f'{i}/{count}', *arguments, scene=scene)
                for i in range(count)]

    def merge(self, *arguments):
        result = run('merge', *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def check_refused(self, tiles, *messages, code=65):
        """Fails with this code and one error, whose line has all messages; nothing is left."""
        before = sorted(self.out.iterdir())
        result = run('merge', '-o', self.out / 'whole.exr', *tiles)
        self.assertEqual(result.returncode, code, result.stderr)
        errors = [line for line in result.stderr.splitlines() if line.startswith('error: ')]
        self.assertEqual(len(errors), 1, result.stderr)
        for message in messages:
            self.assertIn(str(message), errors[0])
        self.assertEqual(sorted(self.out.iterdir()), before)
        return result

    # ---- Tiles ----

    def test_tiles_are_bands_of_whole_strips_in_the_full_frame(self):
        windows = []
        for tile in self.tiles(3, *SMALL):
            text = run('info', tile).stdout
            self.assertIn('display window  64x100 at 0,0', text)
            windows.append(text.split('data window')[1].split('\n')[0].strip())
        self.assertEqual(windows, ['64x32 at 0,0', '64x32 at 0,32', '64x36 at 0,64'])
        self.assertRegex(run('info', self.out / 't1.exr').stdout, r'nacre:tile +1/3\n')

    def test_bad_tiles_are_refused(self):
        for tile, message in (('3/3', 'is not a tile'), ('-1/3', 'is not a tile'),
                              ('1', 'is not a tile'), ('1/0', 'is not a tile'),
                              ('0/8', 'has 7 bands of 16 rows at most')):
            result = run('render', FIRST_SCENE, '-o', self.out / 'a.exr', f'--tile={tile}', *SMALL)
            self.assertEqual(result.returncode, 64)
            self.assertIn(message, result.stderr)
        result = run('render', FIRST_SCENE, '-o', self.out / 'a.exr', '--tile', '0/2', '--region',
                     '0,0,8,8', *SMALL)
        self.assertEqual(result.returncode, 64)
        self.assertIn('cannot be used with --region', result.stderr)
        result = run('render', FIRST_SCENE, '-o', self.out / 'a.exr', '--tile', '0/5',
                     '--compression', 'piz', *SMALL)
        self.assertIn('has 4 bands of 32 rows at most', result.stderr)
        self.assertEqual(list(self.out.iterdir()), [])

    def test_a_dry_run_tells_all_that_decides_the_bits_and_writes_nothing(self):
        result = run('render', FIRST_SCENE, '-o', self.out / 'a.exr', '--dry-run', '--layers', 'Z',
                     '--max-error', '0.1', *SMALL)
        self.assertEqual(result.returncode, 0, result.stderr)
        plan = json.loads(result.stdout)
        self.assertEqual(plan['display_window'], [64, 100])
        self.assertEqual(plan['most_tiles'], 7)
        self.assertEqual(plan['channels'], dict(R='half', G='half', B='half', A='half', Z='float'))
        attributes = plan['attributes']
        for name in 'sceneHash', 'settings', 'target', 'commit', 'maxError', 'maxSamples':
            self.assertIn('nacre:' + name, attributes)
        self.assertEqual(list(self.out.iterdir()), [])
        self.render('a.exr', '--layers', 'Z', '--max-error', '0.1', *SMALL)
        self.assertIn(attributes['nacre:sceneHash'], run('info', self.out / 'a.exr').stdout)

    # ---- Merged ----

    def test_the_merged_file_is_the_single_renders_to_the_byte(self):
        for depth in 'half', 'float':
            for compression in 'none', 'zip', 'zips', 'piz', 'dwaa':
                with self.subTest(depth=depth, compression=compression):
                    options = [*SMALL, '--layers', 'all', '--depth', depth, '--compression',
                               compression]
                    single = self.render('single.exr', *options)
                    tiles = self.tiles(4, *options)
                    self.merge('-o', self.out / 'whole.exr', *reversed(tiles))
                    self.assertEqual(single.read_bytes(), (self.out / 'whole.exr').read_bytes())

    def test_any_number_of_tiles_will_do(self):
        single = self.render('single.exr', *SMALL).read_bytes()
        for count in 1, 2, 5, 7:
            self.merge('-o', self.out / 'whole.exr', *self.tiles(count, *SMALL))
            self.assertEqual(single, (self.out / 'whole.exr').read_bytes())

    def test_tiles_of_a_picture_with_a_wanted_error_are_its_bits(self):
        options = ['--size', '96x75', '--max-error', '0.05', '--reproducible']
        scene = str(SOURCE / 'scenes/material_grid.json')
        single = self.render('single.exr', *options, scene=scene)
        self.merge('-o', self.out / 'whole.exr', *self.tiles(3, *options, scene=scene))
        self.assertEqual(single.read_bytes(), (self.out / 'whole.exr').read_bytes())

    def test_the_png_is_that_of_the_tiles_samples(self):
        display = ['--tonemap', 'aces', '--exposure', '1']
        single = self.render('single.exr', '-o', self.out / 'single.png', '--depth', 'float',
                             *display, *SMALL)
        tiles = self.tiles(3, '--depth', 'float', *SMALL)
        result = self.merge('-o', self.out / 'whole.exr', '-o', self.out / 'whole.png', *display,
                            *tiles)
        self.assertEqual(single.read_bytes(), (self.out / 'whole.exr').read_bytes())
        self.assertEqual((self.out / 'single.png').read_bytes(),
                         (self.out / 'whole.png').read_bytes())
        self.assertIn('of 3 tiles', result.stderr)
        # A half is not what was rendered: the PNG then is that of tonemap.
        self.render('half.exr', *SMALL)
        self.merge('-o', self.out / 'half.png', *self.tiles(3, *SMALL))
        self.assertEqual(run('tonemap', self.out / 'half.exr', '-o', self.out / 'tone.png')
                         .returncode, 0)
        self.assertEqual(run('compare', self.out / 'half.png', self.out / 'tone.png').returncode, 0)

    def test_regions_that_are_bands_merge_too(self):
        single = self.render('single.exr', *SMALL)
        tiles = [self.render('a.exr', '--region', '0,0,64,48', *SMALL),
                 self.render('b.exr', '--region', '0,48,64,100', *SMALL)]
        self.merge('-o', self.out / 'whole.exr', *tiles, '--quiet')
        self.assertEqual(single.read_bytes(), (self.out / 'whole.exr').read_bytes())

    def test_render_times_add_up(self):
        def seconds(file):
            text = run('info', file).stdout
            return float(text.split('renderTime')[1].split()[0])
        tiles = self.tiles(3, '--size', '64x100', '--spp', '2')
        self.merge('-o', self.out / 'whole.exr', *tiles)
        total = sum(seconds(tile) for tile in tiles)
        self.assertGreater(total, 0)
        # Each is a float as printed, and so is their sum.
        self.assertAlmostEqual(seconds(self.out / 'whole.exr') / total, 1, places=6)

    # ---- Refused ----

    def test_gaps_are_refused_with_what_is_missing(self):
        a, b, c = self.tiles(3, *SMALL)
        middle = self.check_refused([c, a], a, c, 'rows 32 to 63 between them are in no tile')
        self.assertIn('--tile 1/3', middle.stderr)
        self.check_refused([b, c], b, 'rows 0 to 31 above it are in no tile')
        self.check_refused([b, a], b, 'rows 64 to 99 below it are in no tile')

    def test_texts_of_foreign_tiles_are_not_believed(self):
        """What a tile says that it is, with the checksum of the bytes that say it."""
        first, _, third = self.tiles(3, *SMALL, '--reproducible')
        for words in (('0/x', '2/x'), ('0/2x', '2/2x'), ('0', '2'), ('/', '/'), ('-1/3', '2/3'), ('0/0', '2/0'),
                      ('3/3', '2/3'), ('0/3', '2/4'), ('0/999999999', '2/999999999'), ('0/101', '2/101'),
                      ('0/2147483648', '2/2147483648'), ('0/99999999999999999999', '2/99999999999999999999')):
            with self.subTest(words=words):
                tiles = [with_attribute(tile, 'nacre:tile', b'string', word.encode())
                         for tile, word in zip((first, third), words)]
                result = self.check_refused(tiles, 'rows 32 to 63 between them are in no tile')
                self.assertIn('hint: render what is missing with --tile\n', result.stderr)
        # A tile for each row of the picture can be: not all that are missing are named.
        tiles = [with_attribute(tile, 'nacre:tile', b'string', word)
                 for tile, word in ((first, b'0/100'), (third, b'2/100'))]
        result = self.check_refused(tiles, 'rows 32 to 63 between them are in no tile')
        self.assertIn('--tile 1/100, 3/100, 4/100, ', result.stderr)
        self.assertIn(', 21/100 and 78 more\n', result.stderr)

    def test_attributes_may_be_of_any_type(self):
        for name in 'Software', 'nacre:shadowing':
            tiles = [with_attribute(tile, name, b'int', struct.pack('<i', 7))
                     for tile in self.tiles(2, *SMALL, '--reproducible')]
            self.merge('-o', self.out / 'whole.png', '-o', self.out / 'whole.exr', *tiles)

    def test_overlaps_are_refused(self):
        a, b, c = self.tiles(3, *SMALL)
        lower = self.render('lower.exr', '--tile', '1/2', *SMALL)  # from row 48
        self.check_refused([a, b, lower], b, lower, 'both hold rows 48 to 63')
        again = self.out / 'again.exr'
        again.write_bytes(b.read_bytes())
        self.check_refused([a, b, c, again], b, again, 'both hold rows 32 to 63')
        self.check_refused([a, b, b, c], 'the same file is named twice', code=64)

    def test_tiles_that_differ_are_refused(self):
        first, _ = self.tiles(2, *SMALL)
        targets = re.search(r'SIMD targets here +(.*)', run('info').stdout).group(1).split(', ')
        other = ['--tile', '1/2', '--reproducible', '--size', '64x100']
        brighter = ['--set', '/lights/key/intensity=150']
        for options, message in (
                ([*other, '--spp', '2', *brighter], 'nacre:sceneHash'),
                ([*other, '--spp', '4'], 'nacre:settings'),
                ([*other, '--spp', '2', '--max-error', '0.1'], 'nacre:maxError'),
                # Only where the build has another target than the one that is chosen by itself.
                *([([*other, '--spp', '2', '--target', targets[0]], 'nacre:target')]
                  if len(targets) > 1 else []),
                ([*other, '--spp', '2', '--layers', 'Z'], 'layers'),
                ([*other, '--spp', '2', '--depth', 'float'], 'layers'),
                ([*other, '--spp', '2', '--compression', 'piz'], 'compression'),
                ([*other[:2], '--size', '64x100', '--spp', '2'], 'renderTime'),
                ([*other[:3], '--size', '32x100', '--spp', '2'], 'size')):
            with self.subTest(message=message):
                second = self.render('other.exr', *options)
                result = self.check_refused([first, second], first, second, f'differ in {message}')
                self.assertIn('hint: ', result.stderr)

    def test_tiles_of_another_build_are_refused(self):
        a, b = self.tiles(2, *SMALL)
        for name in b'nacre:commit\0string\0', b'nacre:version\0string\0':
            bytes_of_b = b.read_bytes()
            place = bytes_of_b.index(name) + len(name) + 4  # after the value's size
            changed = self.out / 'changed.exr'
            changed.write_bytes(
                with_right_checksum(bytes_of_b[:place] + b'?' + bytes_of_b[place + 1:]))
            self.check_refused([a, changed], a, changed, 'differ in ' + name.split(b'\0')[0].decode())

    def test_what_is_no_tile_is_refused(self):
        a, b = self.tiles(2, *SMALL)
        text = self.out / 'text.exr'
        text.write_text('no picture')
        self.check_refused([a, text], text, 'cannot be read as EXR')
        self.check_refused([a, self.out / 'missing.exr'], 'missing.exr', 'no such file')
        half = self.out / 'half.exr'
        half.write_bytes(b.read_bytes()[:-100])
        self.check_refused([a, half], half)
        self.check_refused([a, self.render('r.exr', '--region', '0,48,32,100', *SMALL)], 'r.exr',
                           'does not hold whole rows')
        self.check_refused([a, self.render('r.exr', '--region', '0,40,64,100', *SMALL)], 'r.exr',
                           'begins at row 40')
        foreign = str(next((SOURCE / 'tests/references').rglob('*.exr')))
        self.check_refused([foreign], foreign, 'is not a')
        result = run('merge', '-o', a, a, b)
        self.assertEqual(result.returncode, 64)
        result = run('merge', '-o', self.out / 'whole.jpg', a, b)
        self.assertEqual(result.returncode, 64)

    # ---- Damage ----

    def test_a_flipped_bit_anywhere_in_a_tile_is_refused_by_name(self):
        """In header, table and rows, in every compression; not one such picture is written."""
        rng = random.Random(43)
        for compression in 'none', 'zip', 'zips', 'piz', 'dwaa':
            options = ['--size', '48x64', '--spp', '2', '--reproducible', '--compression', compression]
            tiles = self.tiles(2, *options)
            damaged = self.out / 'damaged.exr'
            data = tiles[1].read_bytes()
            places = sorted(set(rng.randrange(len(data)) for _ in range(40)))
            taken = []
            for place in places:
                bit = 1 << rng.randrange(8)
                damaged.write_bytes(data[:place] + bytes([data[place] ^ bit]) + data[place + 1:])
                result = run('merge', '-o', self.out / 'whole.exr', tiles[0], damaged)
                if result.returncode != 65 or str(damaged) not in result.stderr:
                    taken.append((place, bit, result.returncode, result.stderr))
                self.assertFalse((self.out / 'whole.exr').exists())
            self.assertEqual(taken, [], compression)

    def test_a_flipped_bit_anywhere_in_a_large_tile_is_refused(self):
        """The tiles above are smaller than what is read at a time, a mebibyte; real ones are not."""
        rng = random.Random(44)
        for options in (['--compression', 'none'], ['--compression', 'zip', '--layers', 'all']):
            tiles = self.tiles(2, '--size', '560x480', '--spp', '1', '--depth', 'float', '--reproducible', *options)
            data = bytearray(tiles[1].read_bytes())
            mebibyte = 1 << 20
            self.assertGreater(len(data), 3 * mebibyte // 2)
            damaged = self.out / 'damaged.exr'
            for place in [mebibyte - 1, mebibyte, len(data) - 1] + [rng.randrange(mebibyte, len(data)) for _ in range(9)]:
                data[place] ^= 1 << place % 8
                damaged.write_bytes(data)
                data[place] ^= 1 << place % 8
                result = run('merge', '-o', self.out / 'whole.exr', tiles[0], damaged)
                self.assertEqual(result.returncode, 65, place)
                self.assertIn(str(damaged), result.stderr)
                self.assertEqual(run('info', '--verify', damaged).returncode, 65, place)

    def test_the_png_is_made_on_the_target_that_was_asked_for(self):
        """That of the tiles, unless another is given; so that it equals the one of `render` there."""
        targets = run('info').stdout.split('SIMD targets here')[1].split('\n')[0].replace(',', ' ').split()
        size = ['--size', '480x270', '--spp', '1', '--reproducible']
        shown = ['--tonemap', 'agx', '--exposure', '2.37']
        png, merged, whole = (self.out / name for name in ('a.png', 'b.png', 'whole.exr'))
        for target in targets:
            self.render('a.png', '--target', target, *size, *shown)
            tiles = self.tiles(2, '--target', target, '--depth', 'float', *size)
            self.merge('-o', merged, '-o', whole, *tiles, *shown)
            self.assertEqual(run('compare', merged, png).returncode, 0, target)
            result = run('tonemap', whole, '-o', merged, *shown)
            self.assertEqual((result.returncode, run('compare', merged, png).returncode), (0, 0), target)
            self.merge('-o', png, *tiles, *shown, '--target', targets[0])
            result = run('tonemap', whole, '-o', merged, *shown, '--target', targets[0])
            self.assertEqual((result.returncode, run('compare', merged, png).returncode), (0, 0), target)
        if 'neon' not in targets:
            self.assertEqual(run('merge', '-o', png, whole, '--target', 'neon').returncode, 64)
            self.assertEqual(run('tonemap', whole, '-o', png, '--target', 'neon').returncode, 64)

    def test_a_flipped_bit_of_the_first_header_does_not_reach_the_picture(self):
        """The merged file's header is that of the first tile: alone it has nobody to differ from."""
        tile = self.render('t.exr', *SMALL)
        data = tile.read_bytes()
        header = data.index(b'\0\0', data.index(b'worldToNDC')) + 80
        damaged = self.out / 'damaged.exr'
        for place in range(header):
            damaged.write_bytes(data[:place] + bytes([data[place] ^ 1 << place % 8]) + data[place + 1:])
            if place % 9:
                continue  # every ninth, each time another bit
            result = run('merge', '-o', self.out / 'whole.exr', damaged)
            if result.returncode == 0:  # the checksum's own name: it is told, and the rest is decoded
                self.assertIn('has no checksum', result.stderr)
                self.assertEqual(run('compare', self.out / 'whole.exr', tile).returncode, 0)
                name = data.index(b'nacre:checksum')
                self.assertTrue(name <= place < name + len('nacre:checksum'), place)
                (self.out / 'whole.exr').unlink()
            else:
                self.assertEqual(result.returncode, 65, result.stderr)
                self.assertIn(str(damaged), result.stderr)

    def test_all_damaged_tiles_are_named_at_once(self):
        tiles = self.tiles(4, *SMALL)
        for tile in tiles[1], tiles[3]:
            data = tile.read_bytes()
            tile.write_bytes(data[:-9] + bytes([data[-9] ^ 16]) + data[-8:])
        result = run('merge', '-o', self.out / 'whole.exr', *tiles)
        self.assertEqual(result.returncode, 65)
        self.assertEqual([str(tile) in result.stderr for tile in tiles], [False, True, False, True])

    def without_checksum(self, tile):
        """The tile as nacre wrote it before it had checksums: the attribute is another one."""
        data = tile.read_bytes()
        old = self.out / ('old_' + tile.name)
        old.write_bytes(data.replace(b'nacre:checksum', b'nacre:older_it'))
        return old

    def test_old_tiles_without_a_checksum_are_decoded(self):
        for compression in 'none', 'zip', 'zips', 'piz', 'dwaa':
            with self.subTest(compression=compression):
                options = [*SMALL, '--compression', compression]
                single = self.render('single.exr', *options)
                tiles = [self.without_checksum(tile) for tile in self.tiles(2, *options)]
                for tile in tiles:  # of one value: tiles must agree in all attributes
                    data = tile.read_bytes()
                    place = data.index(b'nacre:older_it') + len(b'nacre:older_it\0string\0') + 4
                    tile.write_bytes(data[:place] + b'00000000' + data[place + 8:])
                result = self.merge('-o', self.out / 'whole.exr', *tiles)
                self.assertEqual(result.stderr.count('has no checksum'), 2)
                self.assertEqual(run('compare', self.out / 'whole.exr', single).returncode, 0)
                # Whatever is wrong with them is found as far as decoding can tell: never a picture
                # that cannot be read.
                data = tiles[1].read_bytes()
                chunks = data.index(b'worldToNDC') + 200
                rng = random.Random(7)
                for _ in range(12):
                    place = rng.randrange(chunks, len(data))
                    damaged = self.out / 'damaged.exr'
                    damaged.write_bytes(data[:place] + bytes([data[place] ^ 1 << rng.randrange(8)]) +
                                        data[place + 1:])
                    result = run('merge', '-o', self.out / 'whole.exr', tiles[0], damaged)
                    self.assertIn(result.returncode, (0, 65), result.stderr)
                    if result.returncode == 0:
                        # Not by --verify, which looks at no more than merge did.
                        again = run('compare', self.out / 'whole.exr', self.out / 'whole.exr')
                        self.assertEqual(again.returncode, 0, again.stderr)

    def test_the_checksum_is_that_of_the_files_bytes(self):
        for depth in 'half', 'float':
            for compression in 'none', 'zip', 'zips', 'piz', 'dwaa':
                for times in [], ['--reproducible']:
                    path = self.render('a.exr', '--size', '64x100', '--compression', compression, '--depth', depth,
                                       *times)
                    data = path.read_bytes()
                    mark = b'nacre:checksum\0string\0\x08\0\0\0'
                    self.assertEqual(data.count(mark), 1)
                    place = data.index(mark) + len(mark)
                    crc = zlib.crc32(data[:place] + b'00000000' + data[place + 8:])
                    self.assertEqual(data[place:place + 8].decode(), f'{crc:08x}')

    def test_files_are_verified(self):
        picture = self.render('a.exr', '-o', self.out / 'a.png', *SMALL)
        for path, words in (picture, 'its checksum is right'), (self.out / 'a.png', 'its checksums are right'):
            result = run('info', '--verify', path)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(words, result.stdout)
            data = path.read_bytes()
            rng = random.Random(5)
            for _ in range(40):
                place = rng.randrange(len(data))
                damaged = self.out / ('damaged' + path.suffix)
                damaged.write_bytes(data[:place] + bytes([data[place] ^ 1 << rng.randrange(8)]) + data[place + 1:])
                result = run('info', '--verify', damaged)
                name = data.find(b'nacre:checksum')
                if path.suffix == '.png' or not name <= place < name + 15:
                    self.assertEqual(result.returncode, 65, f'{path.suffix} {place}')
                    self.assertIn(str(damaged), result.stderr)
            for cut in data[:-1], data[:len(data) // 2], data[:20], data + b'x':
                (self.out / ('cut' + path.suffix)).write_bytes(cut)
                self.assertEqual(run('info', '--verify', self.out / ('cut' + path.suffix)).returncode, 65)

    def test_a_whole_picture_is_a_tile_of_its_own(self):
        whole = self.render('whole_of_it.exr', *SMALL)
        self.merge('-o', self.out / 'copy.exr', whole)
        self.assertEqual(whole.read_bytes(), (self.out / 'copy.exr').read_bytes())


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=1)
