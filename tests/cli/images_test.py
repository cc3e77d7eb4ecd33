#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Image files of other makers, through the commands that read them: parts, windows, names of
channels, orientation, exposure, damage, and how much memory they take.

All files are made here. Usage: images_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
"""
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
MIB = 1 << 20
# The libraries of OpenImageIO take 105 MiB when they are loaded; a band of rows, and threads.
ROOM = 200 * MIB
# Where they are not: a band, threads, and what the allocator keeps.
SMALL_ROOM = 48 * MIB
NONE, RLE, ZIP = 0, 1, 3
LINES = {NONE: 1, RLE: 1, ZIP: 16}
# Programs take five to ten times their memory with the thread sanitizer, three with the address
# sanitizer, as their manuals say.
SANITIZED = b'__asan_init' in pathlib.Path(PROGRAM).read_bytes() or \
    b'__tsan_init' in pathlib.Path(PROGRAM).read_bytes()


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=600)


def run_measured(*arguments):
    """The exit code, standard error, and the most memory that the program had, in bytes."""
    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.DEVNULL,
                                   stderr=errors)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        return process.returncode, errors.read().decode(), usage.ru_maxrss * 1024


def attribute(name, kind, value):
    return name.encode() + b'\0' + kind.encode() + b'\0' + struct.pack('<i', len(value)) + value


def box(window):
    return struct.pack('<4i', *window)


class Part:
    """A scanline part. Windows have their last pixel; `channels` maps names to rows of floats, or
    to one number; halves where `half`."""

    def __init__(self, channels, data, display=None, name=None, compression=NONE, half=False,
                 extra=b'', order=0, sampling=None):
        self.channels = dict(sorted(channels.items()))
        self.data, self.display, self.name = data, display or data, name
        self.compression, self.half, self.extra, self.order = compression, half, extra, order
        self.sampling = sampling or {}
        self.width = data[2] - data[0] + 1
        self.height = data[3] - data[1] + 1

    def chunk_count(self):
        return -(-self.height // LINES[self.compression])

    def header(self, multipart):
        channels = b''
        for name in self.channels:
            x, y = self.sampling.get(name, (1, 1))
            channels += name.encode() + b'\0' + struct.pack('<iiii', 1 if self.half else 2, 0, x, y)
        parts = [attribute('channels', 'chlist', channels + b'\0'),
                 attribute('compression', 'compression', bytes([self.compression])),
                 attribute('dataWindow', 'box2i', box(self.data)),
                 attribute('displayWindow', 'box2i', box(self.display)),
                 attribute('lineOrder', 'lineOrder', bytes([self.order])),
                 attribute('pixelAspectRatio', 'float', struct.pack('<f', 1)),
                 attribute('screenWindowCenter', 'v2f', struct.pack('<2f', 0, 0)),
                 attribute('screenWindowWidth', 'float', struct.pack('<f', 1)), self.extra]
        if multipart:
            parts += [attribute('name', 'string', self.name.encode()),
                      attribute('type', 'string', b'scanlineimage'),
                      attribute('chunkCount', 'int', struct.pack('<i', self.chunk_count()))]
        return b''.join(parts) + b'\0'

    def row(self, y):
        code = 'e' if self.half else 'f'
        row = b''
        for values in self.channels.values():
            if isinstance(values, (int, float)):
                row += struct.pack('<' + code, values) * self.width
            else:
                row += struct.pack(f'<{self.width}{code}', *values[y])
        return row

    def chunk(self, index):
        lines = LINES[self.compression]
        raw = b''.join(self.row(y) for y in range(index * lines,
                                                  min((index + 1) * lines, self.height)))
        packed = raw
        if self.compression == ZIP:
            split = raw[0::2] + raw[1::2]
            predicted = bytearray(split[:1])
            predicted += bytes((b - a + 128) & 255 for a, b in zip(split, split[1:]))
            packed = zlib.compress(bytes(predicted))
        return packed if len(packed) < len(raw) else raw


def exr(*parts, damage=lambda index, chunk: chunk):
    """An EXR file. `damage` changes the bytes of chunks."""
    multipart = len(parts) > 1
    head = b'\x76\x2f\x31\x01' + struct.pack('<I', 2 | (0x1000 if multipart else 0))
    head += b''.join(part.header(multipart) for part in parts) + (b'\0' if multipart else b'')
    at = len(head) + 8 * sum(part.chunk_count() for part in parts)
    tables, body = b'', b''
    for number, part in enumerate(parts):
        offsets, last = {}, (None, None)
        indices = range(part.chunk_count())
        for i in indices if part.order == 0 else reversed(indices):
            constant = all(isinstance(v, (int, float)) for v in part.channels.values())
            full = (i + 1) * LINES[part.compression] <= part.height
            if not (constant and last[0] == full):
                last = (full, part.chunk(i))
            packed = damage(i, last[1])
            offsets[i] = at + len(body)
            body += struct.pack('<i', number) if multipart else b''
            body += struct.pack('<ii', part.data[1] + i * LINES[part.compression], len(packed))
            body += packed
        tables += b''.join(struct.pack('<Q', offsets[i]) for i in indices)
    return head + tables + body


def ramp(width, height, start=0.0, step=0.01):
    return [[start + step * (y * width + x) for x in range(width)] for y in range(height)]


def grey(width, height, **options):
    rows = ramp(width, height)
    return Part({'R': rows, 'G': rows, 'B': rows}, (0, 0, width - 1, height - 1), **options)


def constant_zip(width, height, half=True):
    """A black RGB picture, compressed as far as zip can: chunks are alike, so it is made fast."""
    part = Part({'R': 0, 'G': 0, 'B': 0}, (0, 0, width - 1, height - 1), compression=ZIP,
                half=half)

    def chunk(index):
        lines = min(16, height - index * 16)
        raw = bytes([0]) + bytes([128]) * (lines * width * (6 if half else 12) - 1)
        return zlib.compress(raw, 9)
    part.chunk = chunk
    return exr(part)


def hdr(pixels, resolution, lines=()):
    """A Radiance file of flat RGBE pixels; `pixels` are rows as they are stored."""
    head = '#?RADIANCE\n' + ''.join(line + '\n' for line in lines)
    head += 'FORMAT=32-bit_rle_rgbe\n\n' + resolution + '\n'
    return head.encode() + b''.join(bytes([*pixel, 129]) for row in pixels for pixel in row)


def png_chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))


def png(rows, kind=2, extra=b'', size=None, interlace=0):
    """An 8-bit PNG; `rows` of bytes. `extra`: chunks before the pixels."""
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[kind]
    width, height = size or (len(rows[0]) // channels, len(rows))
    data = zlib.compress(b''.join(b'\0' + bytes(row) for row in rows))
    return (b'\x89PNG\r\n\x1a\n' +
            png_chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, kind, 0, 0, interlace)) +
            extra + png_chunk(b'IDAT', data) + png_chunk(b'IEND', b''))


def tiff(rows, orientation=1, strip_bytes=None, declared_height=None):
    """A grey 8-bit TIFF of one strip."""
    width, height = len(rows[0]), declared_height or len(rows)
    data = b''.join(bytes(row) for row in rows)
    tags = [(256, 3, width), (257, 3, height), (258, 3, 8), (259, 3, 1), (262, 3, 1),
            (273, 4, 8 + 2 + 11 * 12 + 4), (274, 3, orientation), (277, 3, 1), (278, 3, height),
            (279, 4, strip_bytes or len(data)), (284, 3, 1)]
    body = struct.pack('<H', len(tags))
    for tag, kind, value in tags:
        body += struct.pack('<HHI', tag, kind, 1) + struct.pack('<I', value)
    return b'II*\0' + struct.pack('<I', 8) + body + struct.pack('<I', 0) + data


def tiff_of(blocks, drop=(), **tags):
    """A TIFF of strips or tiles that are stored as they are given; without the tags in `drop`. The
    tags are those of 16 x 16 pixels of 8 bits in strips of 4 rows, but for those in `tags`."""
    places, data = [], b''
    for block in blocks:
        places.append(8 + len(data))
        data += block + b'\0' * (len(block) % 2)
    names = {'width': 256, 'height': 257, 'bits': 258, 'compression': 259, 'meaning': 262, 'places': 273,
             'samples': 277, 'rows': 278, 'bytes': 279, 'planes': 284, 'palette': 320,
             'tile_width': 322, 'tile_height': 323, 'tile_places': 324, 'tile_bytes': 325}
    is_tiled = 'tile_width' in tags
    values = {'width': 16, 'height': 16, 'bits': 8, 'compression': 1, 'meaning': 1, 'samples': 1, 'planes': 1}
    values |= {'tile_places' if is_tiled else 'places': places,
               'tile_bytes' if is_tiled else 'bytes': [len(block) for block in blocks]}
    values |= ({} if is_tiled else {'rows': 4}) | tags
    entries, rest = b'', b''
    fields = sorted((names[name], value) for name, value in values.items() if name not in drop)
    behind = 8 + len(data) + 2 + 12 * len(fields) + 4
    for tag, value in fields:
        value = value if isinstance(value, list) else [value]
        kind = 3 if tag == 320 else 4
        packed = struct.pack('<%d%s' % (len(value), 'H' if kind == 3 else 'I'), *value)
        if len(packed) > 4:
            packed, rest = struct.pack('<I', behind + len(rest)), rest + packed
        entries += struct.pack('<HHI', tag, kind, len(value)) + packed.ljust(4, b'\0')
    return (b'II*\0' + struct.pack('<I', 8 + len(data)) + data + struct.pack('<H', len(fields)) + entries +
            b'\0' * 4 + rest)


def icc_profile(gamma):
    """The primaries of sRGB (ICC.1, adapted to D50) with a power for a curve."""
    def xyz(*values):
        return b'XYZ \0\0\0\0' + struct.pack('>3i', *(round(65536 * value) for value in values))
    curve = b'curv\0\0\0\0' + struct.pack('>IH', 1, round(256 * gamma)) + b'\0\0'
    tags = {b'wtpt': xyz(.9642, 1, .8249), b'rXYZ': xyz(.4360, .2225, .0139),
            b'gXYZ': xyz(.3851, .7169, .0971), b'bXYZ': xyz(.1431, .0606, .7141),
            b'rTRC': curve, b'gTRC': curve, b'bTRC': curve}
    table, data = struct.pack('>I', len(tags)), b''
    for name, tag in tags.items():
        table += name + struct.pack('>2I', 128 + 4 + 12 * len(tags) + len(data), len(tag))
        data += tag
    header = struct.pack('>I4sI4s4s4s12s4s28s', 128 + len(table) + len(data), b'', 0x02400000, b'mntr',
                         b'RGB ', b'XYZ ', b'', b'acsp', b'')
    header += struct.pack('>3i', *(round(65536 * value) for value in (.9642, 1, .8249)))
    return header.ljust(128, b'\0') + table + data


def jpeg_segment(marker, data):
    return b'\xff' + bytes([marker]) + struct.pack('>H', len(data) + 2) + data


def jpeg_of(planes, application):
    """A baseline JPEG, whose blocks of 8 x 8 pixels are of one value each: of each component, rows of
    them as they are stored. Quantized by 8 they have that value exactly. `application`: segments."""
    bits, last = '', [128] * len(planes)
    for blocks in zip(*[[value for row in plane for value in row] for plane in planes]):
        for c, value in enumerate(blocks):
            difference, last[c] = value - last[c], value
            size = abs(difference).bit_length()
            low = difference if difference >= 0 else difference + (1 << size) - 1
            # The code of the size, the difference, and that all other coefficients are 0.
            bits += f'{size:04b}' + (f'{low:0{size}b}' if size else '') + '0'
    bits += '1' * (-len(bits) % 8)
    scan = bytes(int(bits[i:i + 8], 2) for i in range(0, len(bits), 8)).replace(b'\xff', b'\xff\0')
    count, rows, columns = len(planes), len(planes[0]), len(planes[0][0])
    return (b'\xff\xd8' + application + jpeg_segment(0xdb, b'\0' + bytes([8]) * 64) +
            jpeg_segment(0xc0, struct.pack('>BHHB', 8, 8 * rows, 8 * columns, count) +
                         b''.join(bytes([c + 1, 0x11, 0]) for c in range(count))) +
            jpeg_segment(0xc4, bytes([0, 0, 0, 0, 9] + [0] * 12) + bytes(range(9))) +
            jpeg_segment(0xc4, bytes([0x10, 1] + [0] * 15) + b'\0') +
            jpeg_segment(0xda, bytes([count]) + b''.join(bytes([c + 1, 0]) for c in range(count)) +
                         bytes([0, 63, 0])) + scan + b'\xff\xd9')


def jpeg(blocks, orientation):
    """A grey one with an EXIF block."""
    exif = b'Exif\0\0II*\0' + struct.pack('<IHHHII', 8, 1, 274, 3, 1, orientation) + b'\0' * 4
    return jpeg_of([blocks], jpeg_segment(0xe1, exif))


class ImagesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)

    def write(self, name, data):
        (self.out / name).write_bytes(data)
        return self.out / name

    def check(self, code, message, *arguments):
        result = run(*arguments)
        self.assertEqual(result.returncode, code, (arguments, result.stdout, result.stderr))
        self.assertIn(message, result.stdout + result.stderr)
        if code not in (0, 1):  # one line, and maybe a hint
            self.assertRegex(result.stderr, r'\Aerror: [^\n]*\n(  hint: [^\n]*\n)?\Z')
        return result

    def check_quiet(self, message, *arguments):
        self.assertNotIn(message, self.check(0, '', *arguments).stderr)

    def same(self, a, b):
        self.check(0, 'match', 'compare', a, b)

    def environment(self, image, **more):
        scene = self.out / 'environment.json'
        light = {'type': 'environment', 'image': image.name, **more}
        scene.write_text(json.dumps({'nacre': 1, 'lights': {'sky': light}, 'shapes': [
            {'type': 'sphere', 'center': [0, 0, 0], 'radius': 1,
             'material': {'model': 'lambert', 'albedo': [1, 1, 1]}}]}))
        return scene

    def textured(self, image, **more):
        scene = self.out / 'textured.json'
        scene.write_text(json.dumps({
            'nacre': 1, 'textures': {'t': {'file': image.name, 'filter': 'nearest', **more}},
            'lights': {'sky': {'type': 'environment', 'radiance': 1}},
            'shapes': [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': {
                'model': 'lambert', 'albedo': [1, 1, 1], 'albedo_map': 't'}}]}))
        return scene

    def render(self, scene, name='r.exr'):
        picture = self.out / name
        self.check(0, '', 'render', scene, '-o', picture, '--size', '32x32', '--spp', '4',
                   '--depth', 'float', '--quiet')
        return picture

    def png_rows(self, path):
        """The rows of an 8-bit RGB PNG that nacre wrote."""
        data = path.read_bytes()
        at, packed = 8, b''
        while at < len(data):
            size, kind = struct.unpack('>I4s', data[at:at + 8])
            if kind == b'IHDR':
                width, height = struct.unpack('>II', data[at + 8:at + 16])
            if kind == b'IDAT':
                packed += data[at + 8:at + 8 + size]
            at += size + 12
        raw, stride = zlib.decompress(packed), 3 * width + 1
        rows, above = [], bytes(3 * width)
        for y in range(height):
            line = bytearray(raw[y * stride + 1:(y + 1) * stride])
            kind = raw[y * stride]
            for i, byte in enumerate(line):
                left = line[i - 3] if i >= 3 else 0
                up, corner = above[i], above[i - 3] if i >= 3 else 0
                guess = [0, left, up, (left + up) // 2,
                         min((left, up, corner), key=lambda v: abs(left + up - corner - v))][kind]
                line[i] = (byte + guess) & 255
            rows.append([tuple(line[x:x + 3]) for x in range(0, 3 * width, 3)])
            above = bytes(line)
        return rows

    def test_names_on_sheets_stay_on_the_page(self):
        """Long ones are wrapped or shortened: none reaches the page's edge, where ink would be cut
        off. Titles, names of rows, of columns in tiers, and of both materials of a pair."""
        named = lambda name: json.dumps({'model': 'phong', 'name': name})
        four = lambda name: 'material=' + ','.join(named(name + str(i)) for i in range(4))
        one_row = ['--rows', 'ks=0.1']
        words, letters, control = 'of varnished wood ' * 30, 'W' * 300, 'W\x01' * 150
        by_size, by_spheres = ['--size', '320x240'], ['--sphere-size', '24']
        for sheet in (['pair', '--a', named(words), '--b', named(letters), *by_size],
                      ['pair', '--layout', 'side', '--a', named(control), '--b', 'phong', *by_size],
                      ['grid', '--title', letters, *by_size],
                      ['grid', *one_row, '--columns', four(words), *by_size],
                      ['grid', *one_row, '--columns', four(letters), *by_size],
                      ['grid', '--columns', four(control), *by_spheres],
                      ['grid', '--rows', four(letters), *by_size],
                      ['grid', '--rows', four(control), *by_spheres]):
            with self.subTest(sheet=[part[:30] for part in sheet]):
                out = self.out / 'sheet.png'
                result = run(*sheet, '--spp', '1', '--background', '0', '-o', out)
                self.assertEqual(result.returncode, 0, result.stderr)
                rows = self.png_rows(out)
                edge = [*rows[0], *rows[1], *rows[-2], *rows[-1]]
                for row in rows:
                    edge += [row[0], row[1], row[-2], row[-1]]
                self.assertEqual(set(edge), {(0, 0, 0)})
                self.assertGreater(max(max(row) for row in rows), (0, 0, 0))

    def test_a_pair_without_a_difference_shows_none(self):
        """Not at the sphere's outline either, where the picture of A was to be seen."""
        result = run('pair', '--layout', 'difference', '--a', 'phong', '--b', 'phong', '--light',
                     'furnace', '--background', '0', '--sphere-size', '120', '--spp', '4', '--no-labels',
                     '-o', self.out / 'a.png')
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = self.png_rows(self.out / 'a.png')
        beside = {pixel for row in rows[:150] for pixel in row[300:]}  # of the spheres of A and B
        self.assertEqual(beside, {(0, 0, 0)})
        self.assertGreater(rows[80][100], (200, 200, 200))

    def test_labels_of_a_small_picture_do_not_touch(self):
        """Names of columns that have no room beside their neighbours are left out."""
        grid = str(SOURCE / 'scenes/material_grid.json')
        files = [self.out / 'with.png', self.out / 'without.png']
        for path, labels in zip(files, (['--labels'], [])):
            result = run('render', grid, *labels, '--size', '240x135', '--spp', '1', '-o', path)
            self.assertEqual(result.returncode, 0, result.stderr)
        rows, bare = map(self.png_rows, files)
        # The rows above the spheres; the names of rows are to the left of all spheres.
        inked = [any(rows[y][x] != bare[y][x] for y in range(14)) for x in range(240)]
        gaps = ''.join('x' if ink else ' ' for ink in inked).split('x')
        words = [gap for gap in gaps[1:-1] if len(gap) > 4]  # wider than a space
        self.assertEqual(len(words), 2)  # three names, of five

    # ---- Parts ----

    def two_parts(self, name, second=0.0, window=(0, 0, 5, 3)):
        rows = ramp(6, 4)
        width, height = window[2] - window[0] + 1, window[3] - window[1] + 1
        return self.write(name, exr(
            Part({'R': rows, 'G': rows, 'B': rows}, (0, 0, 5, 3), name='rgba'),
            Part({'Z': ramp(width, height, second), 'left.Z': 1.0}, window, (0, 0, 5, 3),
                 name='depth')))

    def test_all_parts_are_compared(self):
        a, b = self.two_parts('a.exr'), self.two_parts('b.exr', 0.5)
        self.check(1, 'depth', 'compare', a, b)
        self.same(a, a)
        self.check(0, 'match', 'compare', a, b, '--part', 'rgba')
        self.check(1, 'differ', 'compare', a, b, '--part', 'depth')
        layers = json.loads(run('compare', a, a, '--json').stdout)['layers']
        self.assertEqual([layer['layer'] for layer in layers], ['rgba', 'depth', 'depth.left'])
        self.check(2, 'did you mean "depth"', 'compare', a, b, '--part', 'dept')
        single = self.write('s.exr', exr(grey(6, 4)))
        self.check(2, 'has no part', 'compare', single, single, '--part', 'rgba')

    def test_parts_whose_windows_differ_are_no_match(self):
        a = self.two_parts('a.exr')
        b = self.write('b.exr', exr(
            Part({c: ramp(6, 4) for c in 'RGB'}, (0, 0, 5, 3), name='rgba'),
            Part({'Z': [row[:4] for row in ramp(6, 4)], 'left.Z': 1.0}, (0, 0, 3, 3), (0, 0, 5, 3),
                 name='depth')))
        self.check(1, '', 'compare', a, b)
        self.check(1, 'part "depth" is', 'compare', a, b, '--max-abs', '10')
        self.check(0, 'match', 'compare', a, b, '--max-abs', '10', '--crop')

    def test_info_lists_all_parts(self):
        text = self.check(0, 'part 2 of 2: depth', 'info', self.two_parts('a.exr')).stdout
        self.assertIn('part 1 of 2: rgba', text)
        self.assertIn('left.Z:float', text)
        only = run('info', self.out / 'a.exr', '--part', 'depth').stdout
        self.assertNotIn('rgba', only)
        self.check(65, 'has no part', 'info', self.out / 'a.exr', '--part', 'x')

    def test_parts_are_chosen(self):
        a = self.two_parts('a.exr')
        whole = self.write('w.exr', exr(grey(6, 4)))
        self.check(0, 'shows part "rgba" of 2', 'tonemap', a, '-o', self.out / 'a.png')
        self.check(0, '', 'tonemap', whole, '-o', self.out / 'w.png')
        self.same(self.out / 'a.png', self.out / 'w.png')
        self.check(0, '', 'tonemap', a, '-o', self.out / 'z.png', '--part', 'depth', '--layer', 'Z')
        self.check(65, 'has 2 parts', 'render', self.textured(a), '-o', self.out / 'x.exr')
        self.check(65, 'has 2 parts', 'render', self.environment(a), '-o', self.out / 'x.exr')
        for scene in (self.textured, self.environment):
            got = self.render(scene(a, part='rgba'), 'got.exr')
            self.same(got, self.render(scene(whole), 'expected.exr'))

    def test_deep_and_chroma_parts_are_described_and_refused(self):
        chroma = Part({'Y': 0.5, 'RY': 0.0, 'BY': 0.0}, (0, 0, 3, 3),
                      sampling={'RY': (2, 2), 'BY': (2, 2)})
        chroma.chunk = lambda index: struct.pack('<4f', *[0.5] * 4) + (
            struct.pack('<4f', 0, 0, 0, 0) if index % 2 == 0 else b'')
        path = self.write('yc.exr', exr(chroma))
        self.assertIn('RY:float/2x2', self.check(0, 'luminance and chroma', 'info', path).stdout)
        deep = Part({'Z': 1.0}, (0, 0, 3, 3), name='d', extra=attribute(
            'version', 'int', struct.pack('<i', 1)) + attribute(
                'maxSamplesPerPixel', 'int', struct.pack('<i', 1)))
        # A single deep part: version flag 0x800, its type, its name and the count of its chunks.
        header = deep.header(True).replace(b'scanlineimage', b'deepscanline').replace(
            b'type\0string\0' + struct.pack('<i', 13), b'type\0string\0' + struct.pack('<i', 12))
        body = b'\x76\x2f\x31\x01' + struct.pack('<I', 2 | 0x800) + header
        start = len(body) + 8 * 4
        chunk = struct.pack('<4i', 1, 2, 3, 4) + struct.pack('<4f', *[1.0] * 4)
        table, chunks = b'', b''
        for y in range(4):
            table += struct.pack('<Q', start + len(chunks))
            chunks += struct.pack('<iQQQ', y, 16, 16, 16) + chunk
        deep_path = self.write('deep.exr', body + table + chunks)
        self.check(0, 'is a deep image', 'info', deep_path)
        for path, word in ((path, 'luminance and chroma'), (deep_path, 'is a deep image')):
            self.check(65, word, 'tonemap', path, '-o', self.out / 'x.png')
            self.check(2, word, 'compare', path, path)
            self.check(65, word, 'render', self.textured(path), '-o', self.out / 'x.exr')
            self.check(65, word, 'render', self.environment(path), '-o', self.out / 'x.exr')

    # ---- Windows ----

    def test_tonemap_shows_the_display_window(self):
        rows = [[1.0] * 4 for _ in range(3)]
        part = Part({c: rows for c in 'RGB'}, (-1, 2, 2, 4), (0, 0, 4, 3))
        path = self.write('w.exr', exr(part))
        self.check(0, '', 'tonemap', path, '-o', self.out / 'w.png', '--tonemap', 'none')
        white, black = (255,) * 3, (0,) * 3
        seen = [white] * 3 + [black] * 2
        self.assertEqual(self.png_rows(self.out / 'w.png'), [[black] * 5] * 2 + [seen] * 2)

    def test_windows_that_differ_are_no_match(self):
        rows = ramp(8, 6)
        full = self.write('full.exr', exr(Part({'R': rows}, (0, 0, 7, 5))))
        crop = self.write('crop.exr', exr(
            Part({'R': [row[2:5] for row in rows[1:4]]}, (2, 1, 4, 3), (0, 0, 7, 5))))
        self.check(1, 'the data window is 3x3 at 2,1, not 8x6 at 0,0', 'compare', crop, full)
        self.check(0, 'none of 9 pixels', 'compare', crop, full, '--crop')
        verdict = json.loads(run('compare', crop, full, '--json').stdout)
        self.assertFalse(verdict['match'])

    def test_display_windows_of_different_sizes(self):
        full = self.write('full.exr', exr(Part({c: ramp(8, 6) for c in 'RGB'}, (0, 0, 7, 5))))
        part = self.write('part.exr', exr(Part({c: [row[:4] for row in ramp(8, 6)[:3]] for c in 'RGB'}, (0, 0, 3, 2))))
        for a, b in (full, part), (part, full):
            self.check(1, 'the display window is', 'compare', a, b)
            self.check(0, 'none of 12 pixels', 'compare', a, b, '--crop')
        apart = self.write('apart.exr', exr(Part({c: 1.0 for c in 'RGB'}, (20, 20, 23, 22))))
        self.check(2, 'no pixel in common', 'compare', full, apart, '--crop')

    def test_the_worst_pixel_is_the_one_of_the_table(self):
        """An error of .5 where the reference is dark, and one of 2 where it is bright."""
        rows = [[100.0] * 8 for _ in range(6)]
        rows[1][2] = .001
        reference = self.write('r.exr', exr(Part({c: rows for c in 'RGB'}, (0, 0, 7, 5))))
        rows = [list(row) for row in rows]
        rows[1][2] += .5
        rows[4][5] += 2
        image = self.write('i.exr', exr(Part({c: rows for c in 'RGB'}, (0, 0, 7, 5))))
        text = self.check(1, 'worst', 'compare', image, reference).stdout
        at = re.search(r'beauty.* (\d+),(\d+) (\w)\n', text).groups()
        self.assertEqual(at[:2], ('5', '4'))
        self.assertIn('worst {2} at ({0}, {1}): 102 instead of 100'.format(*at), text)

    def test_crops_are_no_textures_and_overscan_is_cut_off(self):
        rows = ramp(8, 4)
        whole = self.write('whole.exr', exr(Part({c: rows for c in 'RGB'}, (0, 0, 7, 3))))
        wide_rows = [[9.0] * 10] + [[9.0] + row + [9.0] for row in rows] + [[9.0] * 10]
        wide = self.write('wide.exr', exr(
            Part({c: wide_rows for c in 'RGB'}, (-1, -1, 8, 4), (0, 0, 7, 3))))
        crop = self.write('crop.exr', exr(
            Part({c: rows for c in 'RGB'}, (0, 0, 7, 3), (0, 0, 9, 3))))
        for scene in (self.textured, self.environment):
            self.same(self.render(scene(wide), 'a.exr'), self.render(scene(whole), 'b.exr'))
            self.check(65, 'is a crop', 'render', scene(crop), '-o', self.out / 'x.exr')

    # ---- Names ----

    def test_other_names_of_colours(self):
        rows = ramp(8, 4)
        upper = self.write('u.exr', exr(Part({c: rows for c in 'RGB'}, (0, 0, 7, 3))))
        names = {'lower': 'r g b', 'dot': '.R .G .B', 'y': 'Y', 'other': 'height', 'z': 'Z',
                 'alpha': 'Y A'}
        for name, channels in names.items():
            with self.subTest(name):
                path = self.write(name + '.exr', exr(
                    Part({c: rows for c in channels.split()}, (0, 0, 7, 3))))
                self.check(0, '', 'tonemap', path, '-o', self.out / 'a.png')
                self.check(0, '', 'tonemap', upper, '-o', self.out / 'b.png')
                self.assertEqual(self.png_rows(self.out / 'a.png'),
                                 self.png_rows(self.out / 'b.png'))
                for scene in (self.textured, self.environment):
                    self.same(self.render(scene(path), 'a.exr'), self.render(scene(upper), 'b.exr'))
        views = self.write('v.exr', exr(Part(
            {'R': 0.0, 'G': 0.0, 'B': 0.0, **{'left.' + c: rows for c in 'RGB'}}, (0, 0, 7, 3))))
        self.check(0, '', 'tonemap', views, '-o', self.out / 'a.png', '--layer', 'left')
        self.assertEqual(self.png_rows(self.out / 'a.png'), self.png_rows(self.out / 'b.png'))
        self.check(65, 'did you mean "left"', 'tonemap', views, '-o', self.out / 'x.png',
                   '--layer', 'lft')

    def test_negative_radiance_is_clamped_where_it_is_asked_for(self):
        rows = ramp(8, 4)
        clean = self.write('clean.exr', exr(Part({c: rows for c in 'RGB'}, (0, 0, 7, 3))))
        below = [list(row) for row in rows]
        below[0][0] = -1e-3
        tiny = self.write('tiny.exr', exr(
            Part({'R': below, 'G': rows, 'B': rows}, (0, 0, 7, 3))))
        self.check(65, '"clamp_negative": true', 'render', self.environment(tiny), '-o',
                   self.out / 'x.exr')
        ball = self.textured(clean)
        self.check(65, '--set /lights/environment/clamp_negative=true', 'render', ball, '--environment', tiny,
                   '-o', self.out / 'x.exr')
        self.check(0, 'count as 0', 'render', ball, '--environment', tiny, '-o', self.out / 'x.exr', '--size', '8x8',
                   '--set', '/lights/environment/clamp_negative=true')
        scene = self.environment(tiny, clamp_negative=True)
        self.check(0, 'tiny.exr: 1 samples below 0, down to -0.001, count as 0', 'render', scene,
                   '-o', self.out / 'x.exr', '--size', '8x8', '--spp', '1')
        self.same(self.render(scene, 'a.exr'), self.render(self.environment(clean), 'b.exr'))

    def test_formats_are_told_by_first_bytes(self):
        rows = ramp(8, 4)
        plain = self.write('p.exr', exr(Part({c: rows for c in 'RGB'}, (0, 0, 7, 3))))
        radiance = hdr([[(10, 20, 30), (40, 50, 60)]], '-Y 1 +X 2')
        known = self.write('k.hdr', radiance)
        old = radiance.replace(b'#?RADIANCE', b'Xim format conversion by:\nFORMAT=32-bit_rle_rgbe')
        for name in 'a.exr', 'a.png', 'a.tga', 'a.tif', 'a.pic', 'a.jpg':
            with self.subTest(name):
                self.same(self.write(name, plain.read_bytes()), plain)
                self.same(self.write(name, radiance), known)
                self.same(self.write(name, old), known)
                self.same(self.write(name, tiff([[10, 20], [30, 40]])), self.write('t.tif', tiff([[10, 20], [30, 40]])))

    def test_channels_of_other_names_are_listed(self):
        custom = self.write('c.exr', exr(Part({'red2': 0.5, 'green2': 0.5, 'depth': 1.0}, (0, 0, 7, 3))))
        listed = 'it has depth, green2, red2'
        self.check(65, listed, 'render', self.environment(custom), '-o', self.out / 'x.exr')
        self.check(65, listed, 'render', self.textured(custom), '-o', self.out / 'x.exr')
        self.check(65, listed, 'tonemap', custom, '-o', self.out / 'x.png')

    def test_surroundings_that_are_not_2_to_1_are_told(self):
        ends = ['-o', self.out / 'x.exr', '--size', '8x8', '--spp', '1']
        told = 'are not 2:1'
        self.check(0, '64 x 64 pixels are not 2:1', 'render', self.environment(self.write('f.exr', exr(grey(64, 64)))), *ends)
        latlong = attribute('envmap', 'envmap', b'\0')  # its maker says what it is
        for part in grey(64, 32), grey(64, 33), grey(64, 64, extra=latlong):
            self.check_quiet(told, 'render', self.environment(self.write('f.exr', exr(part))), *ends)

    # ---- What files say of their pixels ----

    def test_radiance_orientations(self):
        width, height = 5, 3
        image = [[(10 * y + x + 3, 100 + x, 200 - y) for x in range(width)] for y in range(height)]
        plain = self.write('plain.hdr', hdr(image, f'-Y {height} +X {width}'))
        columns = [list(column) for column in zip(*image)]
        for x in '+-':
            for y in '+-':
                rows = image if y == '-' else image[::-1]
                rows = rows if x == '+' else [row[::-1] for row in rows]
                turned = columns if x == '+' else columns[::-1]
                turned = turned if y == '-' else [column[::-1] for column in turned]
                for name, stored, text in (
                        ('rows', rows, f'{y}Y {height} {x}X {width}'),
                        ('columns', turned, f'{x}X {width} {y}Y {height}')):
                    with self.subTest(text):
                        path = self.write('o.hdr', hdr(stored, text))
                        self.same(path, plain)
                        self.same(self.render(self.environment(path), 'a.exr'),
                                  self.render(self.environment(plain), 'b.exr'))

    def test_radiance_exposure(self):
        image = [[(16 * (x + 1), 8, 128) for x in range(4)] for _ in range(2)]
        third = [[(8 * (x + 1), 4, 64) for x in range(4)] for _ in range(2)]
        plain = self.write('plain.hdr', hdr(image, '-Y 2 +X 4'))
        half = self.write('half.hdr', hdr(third, '-Y 2 +X 4'))
        for lines in (['EXPOSURE=2'], ['EXPOSURE=4', 'EXPOSURE=0.5'], ['COLORCORR=2 2 2'],
                      ['EXPOSURE= 1.000000e+00', 'COLORCORR=4 4 4', 'COLORCORR=.5 .5 .5']):
            with self.subTest(lines):
                exposed = self.write('e.hdr', hdr(image, '-Y 2 +X 4', lines))
                self.same(exposed, half)
        for line, message in (('EXPOSURE=-1', 'above 0'), ('EXPOSURE=x', 'is not 1 number'),
                              ('GAMMA=2.2', 'GAMMA is not 1')):
            path = self.write('bad.hdr', hdr(image, '-Y 2 +X 4', [line]))
            self.check(65, message, 'tonemap', path, '-o', self.out / 'x.png')
        known = self.write('p.hdr', hdr(image, '-Y 2 +X 4', [
            'PRIMARIES=0.640 0.330 0.290 0.600 0.150 0.060 0.333 0.333', 'GAMMA=1.0', 'PIXASPECT=2']))
        self.same(known, plain)
        self.check(0, 'shown as squares', 'tonemap', known, '-o', self.out / 'x.png')
        unknown = self.write('u.hdr', hdr(image, '-Y 2 +X 4', ['PRIMARIES=0 0 0 0 0 0 0 0', 'EXPOSURE=0']))
        self.same(unknown, plain)
        # Nobody can act on that: most skies of the world have it.
        self.check_quiet('primaries', 'tonemap', unknown, '-o', self.out / 'x.png')
        self.check_quiet('primaries', 'render', self.environment(unknown), '-o', self.out / 'x.exr', '--size', '8x8')
        self.assertIn("0 0 0 0 0 0 0 0 (none: Rec. 709's are taken)", run('info', unknown).stdout)
        odd = self.write('u.hdr', hdr(image, '-Y 2 +X 4', ['PRIMARIES=1 1 1 1 1 1 1 1', 'EXPOSURE=0']))
        self.same(odd, plain)
        told = 'u.hdr: its primaries (1 1 1 1 1 1 1 1) are none, and its colours are taken as Rec. 709'
        self.check(0, told, 'tonemap', unknown, '-o', self.out / 'x.png')
        self.check(0, told, 'report', self.out / 'x.html', unknown)
        self.check(0, told, 'render', self.environment(unknown), '-o', self.out / 'x.exr', '--size', '8x8')
        self.check(0, told, 'render', self.textured(unknown), '-o', self.out / 'x.exr', '--size', '8x8')
        for scene in self.environment, self.textured:
            self.same(self.render(scene(unknown), 'a.exr'), self.render(scene(plain), 'b.exr'))

    def test_tags_of_orientation(self):
        image = [[10, 20, 30], [40, 50, 60]]
        columns = [list(column) for column in zip(*image)]
        stored = {1: image, 2: [r[::-1] for r in image], 3: [r[::-1] for r in image[::-1]],
                  # Stored so that what is seen is `image`: row 0 of 6 is its right side, of 8 its left.
                  4: image[::-1], 5: columns, 6: columns[::-1],
                  7: [c[::-1] for c in columns[::-1]], 8: [c[::-1] for c in columns]}
        plain = self.write('plain.tif', tiff(image))
        for tag, rows in stored.items():
            with self.subTest(tag):
                self.same(self.write('t.tif', tiff(rows, tag)), plain)
                exif = b'MM\0*' + struct.pack('>IHHHIHH', 8, 1, 274, 3, 1, tag, 0) + b'\0' * 4
                upright = self.write('plain.png', png(image, 0))
                self.same(self.write('t.png', png(rows, 0, png_chunk(b'eXIf', exif))), upright)
                pixels = [[value for value in row for _ in range(8)] for row in image for _ in range(8)]
                blocks = self.write('blocks.png', png(pixels, 0))
                # A reader may have another last bit for a code of 255: half an ulp of at most 1.
                self.check(0, 'match', 'compare', self.write('t.jpg', jpeg(rows, tag)), blocks,
                           '--max-abs', 2 ** -24)

    def test_exr_attributes(self):
        plain = self.write('plain.exr', exr(grey(8, 4)))
        chroma = attribute('chromaticities', 'chromaticities',
                           struct.pack('<8f', .713, .293, .165, .83, .128, .044, .32168, .33767))
        aces = self.write('aces.exr', exr(grey(8, 4, extra=chroma)))
        self.same(aces, aces)
        self.check(2, 'primaries', 'compare', aces, plain)
        self.check(2, 'primaries', 'compare', plain, aces)
        rec709 = attribute('chromaticities', 'chromaticities',
                           struct.pack('<8f', .64, .33, .3, .6, .15, .06, .3127, .329))
        known = self.write('known.exr', exr(grey(8, 4, extra=rec709)))
        self.same(known, plain)
        self.check(2, 'primaries', 'compare', aces, known)
        self.check(0, '', 'tonemap', known, '-o', self.out / 'x.png')
        cube = self.write('cube.exr', exr(grey(8, 48, extra=attribute('envmap', 'envmap', b'\1'))))
        self.check(65, 'cube map', 'render', self.environment(cube), '-o', self.out / 'x.exr')
        down = self.write('down.exr', exr(grey(8, 4, order=1)))
        self.same(down, plain)

    # Rec. 2020, whose colours in Rec. 709 are those times the matrix of ITU-R BT.2407-0, section 2.
    REC2020 = (.708, .292, .17, .797, .131, .046, .3127, .329)
    FROM_REC2020 = ((1.6605, -.5876, -.0728), (-.1246, 1.1329, -.0083), (-.0182, -.1006, 1.1187))

    def flat(self, name, color, primaries=None):
        extra = b'' if primaries is None else attribute('chromaticities', 'chromaticities',
                                                        struct.pack('<8f', *primaries))
        return self.write(name, exr(Part({c: [[x] * 8] * 4 for c, x in zip('RGB', color)}, (0, 0, 7, 3), extra=extra)))

    def test_other_primaries_are_converted_where_colours_are_shown(self):
        wide = (.3, .5, .2)
        narrow = [sum(m * x for m, x in zip(row, wide)) for row in self.FROM_REC2020]
        a, b = self.flat('a.exr', wide, self.REC2020), self.flat('b.exr', narrow)
        line = 'PRIMARIES=' + ' '.join(map(str, self.REC2020))
        c = self.write('c.hdr', hdr([[(77, 128, 51)] * 8] * 4, '-Y 4 +X 8', [line]))
        of_c = [x / 128 for x in (77, 128, 51)]  # of hdr()'s exponent
        d = self.flat('d.exr', [sum(m * x for m, x in zip(row, of_c)) for row in self.FROM_REC2020])
        for other, known in (a, b), (c, d):
            for scene in self.textured, self.environment:
                with self.subTest(other=other.name, scene=scene.__name__):
                    first = self.render(scene(other), 'x.exr')
                    # The matrix has four digits.
                    self.check(0, 'match', 'compare', first, self.render(scene(known), 'y.exr'), '--max-rel', '1e-3')
            for path, png in (other, 'x.png'), (known, 'y.png'):
                result = self.check(0, '', 'tonemap', path, '-o', self.out / png, '--tonemap', 'none')
                self.assertEqual('converted to Rec. 709' in result.stderr, path == other)
            x, y = self.png_rows(self.out / 'x.png')[0][0], self.png_rows(self.out / 'y.png')[0][0]
            self.assertLessEqual(max(abs(p - q) for p, q in zip(x, y)), 1)
        self.check(0, 'chromaticities', 'info', c)
        self.check(2, 'primaries', 'compare', a, b)
        self.check(0, 'converted to Rec. 709', 'report', self.out / 'r.html', a)
        # Data have no primaries.
        scene = self.textured(a, encoding='linear')
        self.same(self.render(scene, 'x.exr'), self.render(self.textured(self.flat('e.exr', wide), encoding='linear'), 'y.exr'))

    def test_colours_outside_of_rec709_are_cut_off_at_0(self):
        green = self.flat('green.exr', (0, 1, 0), self.REC2020)
        cut = self.flat('cut.exr', (0, self.FROM_REC2020[1][1], 0))
        for scene in self.textured, self.environment:
            first = self.render(scene(green), 'x.exr')
            self.check(0, 'match', 'compare', first, self.render(scene(cut), 'y.exr'), '--max-rel', '1e-3')
        self.check(0, 'samples below 0', 'render', self.environment(green), '-o', self.out / 'x.exr', '--size', '8x8')
        outside = "32 pixels lie outside of Rec. 709's gamut"
        self.check(0, outside, 'render', self.textured(green), '-o', self.out / 'x.exr', '--size', '8x8')
        self.check(0, outside, 'tonemap', green, '-o', self.out / 'x.png')
        self.check(0, outside, 'report', self.out / 'r.html', green)
        inside = self.flat('inside.exr', (.3, .5, .2), self.REC2020)
        self.assertNotIn('gamut', self.check(0, '', 'tonemap', inside, '-o', self.out / 'x.png').stderr)

    def test_radiance_up_to_the_float_nearest_1e30(self):
        bright = self.flat('bright.exr', (1e30, 1e30, 1e30))  # as a float it is above 1e30
        above = self.flat('above.exr', (1.0001e30, 1, 1))
        picture = self.render(self.environment(bright), 'x.exr')
        self.assertNotRegex(run('info', picture).stdout, 'nan|inf')
        self.check(65, 'radiance is from 0 to 1e+30', 'render', self.environment(above), '-o', self.out / 'y.exr')

    def test_colours_of_png_files(self):
        rows = [[10 * x + y for x in range(12)] for y in range(4)]
        plain = self.write('plain.png', png(rows))
        gamma = png_chunk(b'gAMA', struct.pack('>I', 100000))
        for name, extra, refused in (
                ('linear', gamma, True), ('srgb', png_chunk(b'gAMA', struct.pack('>I', 45455)), False),
                ('both', png_chunk(b'sRGB', b'\0') + gamma, False),
                ('wide', png_chunk(b'cHRM', struct.pack('>8I', 31270, 32900, 68000, 32000, 26500,
                                                        69000, 15000, 6000)), True),
                ('icc', png_chunk(b'iCCP', b'Display P3\0\0' + zlib.compress(b'x' * 200)), True),
                ('icc_srgb', png_chunk(b'iCCP', b'ICC\0\0' + zlib.compress(icc_profile(2.2))), False),
                ('icc_linear', png_chunk(b'iCCP', b'sRGB\0\0' + zlib.compress(icc_profile(1))), True),
                ('cicp', gamma + png_chunk(b'cICP', bytes([1, 13, 0, 1])), False),
                ('pq', png_chunk(b'sRGB', b'\0') + png_chunk(b'cICP', bytes([9, 16, 0, 1])), True)):
            with self.subTest(name):
                path = self.write(name + '.png', png(rows, 2, extra))
                scene = self.textured(path)
                if refused:
                    self.check(65, 'convert it to sRGB', 'render', scene, '-o', self.out / 'x.exr')
                else:
                    self.render(scene)
                told = self.textured(path, encoding='srgb')
                self.same(self.render(told, 'a.exr'), self.render(self.textured(plain), 'b.exr'))
        self.check(0, 'gamma           1', 'info', self.out / 'linear.png')

    # ---- Damage ----

    def refused_everywhere(self, path, word):
        self.check(2, word, 'compare', path, path)
        if path.suffix in ('.exr', '.hdr'):
            self.check(65, word, 'tonemap', path, '-o', self.out / 'x.png')
            self.check(65, word, 'render', self.environment(path), '-o', self.out / 'x.exr')
        self.check(65, word, 'render', self.textured(path), '-o', self.out / 'x.exr')

    def test_chunks_that_are_not_what_the_header_says(self):
        short = zlib.compress(bytes([128]) * 40)
        for name, compression, damage in (
                ('short', NONE, lambda i, c: c[:-4] if i == 1 else c),
                ('empty', NONE, lambda i, c: b'' if i == 1 else c),
                ('zip', ZIP, lambda i, c: short),
                ('broken', ZIP, lambda i, c: c[:10]),
                ('rle', RLE, lambda i, c: bytes([20, 7]) if i == 2 else c)):
            with self.subTest(name):
                path = self.write(name + '.exr', exr(grey(40, 20, compression=compression),
                                                     damage=damage))
                self.refused_everywhere(path, 'cannot be read as EXR')

    def test_missing_chunks(self):
        data = bytearray(exr(grey(8, 4)))
        header = len(grey(8, 4).header(False)) + 8
        data[header + 8:header + 16] = bytes(8)  # the second chunk's place
        self.refused_everywhere(self.write('hole.exr', bytes(data)), 'cannot be read as EXR')
        whole = exr(grey(8, 4))
        self.refused_everywhere(self.write('cut.exr', whole[:-10]), 'cannot be read as EXR')

    def test_other_formats_that_end_early(self):
        rows = [[(x * y) % 251 for x in range(90)] for y in range(60)]
        photo = (SOURCE / 'tests/fuzz/corpus/texture_image/a.jpg').read_bytes()
        for name, data in (
                ('a.png', png(rows[:30], 2, size=(30, 60))),
                ('i.png', png(rows[:30], 2, size=(30, 60), interlace=1)),
                ('cut.png', png(rows)[:-40]),
                ('a.tif', tiff(rows, declared_height=90)),
                ('cut.tif', tiff(rows)[:-100]),
                ('cut.jpg', photo[:-30]),
                ('end.jpg', photo[:-30] + b'\xff\xd9'),
                ('a.hdr', hdr([[(9, 9, 9)] * 9] * 9, '-Y 18 +X 9')),
                ('a.pfm', b'Pf\n9 9\n-1.0\n' + bytes(200))):
            with self.subTest(name):
                self.refused_everywhere(self.write(name, data), 'cannot be read')

    # Rows of 16 bytes in strips of four, and in tiles of 16 x 16 of a picture of 32 x 32.
    STRIPS = [bytes((16 * y + x) % 251 for y in range(4 * i, 4 * i + 4) for x in range(16))
              for i in range(4)]
    TILES = {'width': 32, 'height': 32, 'tile_width': 16, 'tile_height': 16}

    def test_tiff_blocks_that_are_short_or_missing(self):
        deflate, plain = zlib.compress, bytes
        for name, compression, pack in ('none', 1, plain), ('deflate', 8, deflate):
            blocks = [pack(strip) for strip in self.STRIPS]
            tiles = [pack(b''.join(self.STRIPS))] * 4
            lengths = [len(block) for block in blocks]
            places = [8 + sum(length + length % 2 for length in lengths[:i]) for i in range(4)]
            more = {'compression': compression}
            self.check(0, 'match', 'compare', *[self.write('whole.tif', tiff_of(blocks, **more))] * 2)
            self.check(0, 'match', 'compare', *[self.write('tiles.tif', tiff_of(tiles, **self.TILES, **more))] * 2)
            for what, data in (
                    ('cut', tiff_of([*blocks[:2], blocks[2][:-9], blocks[3]], **more)),
                    ('last cut', tiff_of([*blocks[:3], blocks[3][:-9]], **more)),
                    ('counted short', tiff_of(blocks, bytes=[length - 9 for length in lengths], **more)),
                    ('of fewer rows', tiff_of([*blocks[:3], pack(self.STRIPS[3][:48])], **more)),
                    ('counted as 0', tiff_of(blocks, bytes=[*lengths[:3], 0], **more)),
                    ('at 0', tiff_of(blocks, places=[*places[:3], 0], **more)),
                    ('beyond the end', tiff_of(blocks, places=[*places[:3], 1 << 20], **more)),
                    ('longer than the file', tiff_of(blocks, bytes=[*lengths[:3], 1 << 20], **more)),
                    ('too few', tiff_of(blocks[:2], **more)),
                    ('too few lengths', tiff_of(blocks, bytes=lengths[:2], **more)),
                    ('without lengths', tiff_of(blocks, drop=['bytes'], **more)),
                    ('tile cut', tiff_of([*tiles[:3], tiles[3][:-9]], **self.TILES, **more)),
                    ('tile short', tiff_of([*tiles[:3], pack(self.STRIPS[0])], **self.TILES, **more)),
                    ('tiles too few', tiff_of(tiles[:3], **self.TILES, **more)),
                    ('tile 0', tiff_of(tiles, tile_bytes=[*[len(t) for t in tiles[:3]], 0], **self.TILES, **more))):
                with self.subTest(compression=name, blocks=what):
                    self.refused_everywhere(self.write('a.tif', data), 'cannot be read: ')

    def test_a_fax_that_ends_early(self):
        # White rows below white ones are a 1 each; then twice the mark of the end.
        white = {'compression': 4, 'bits': 1, 'meaning': 0, 'rows': 16}
        whole = self.write('whole.tif', tiff_of([b'\xff\xff\0\x10\x01'], **white))
        self.check(0, 'match', 'compare', whole, whole)
        self.refused_everywhere(self.write('a.tif', tiff_of([b'\xff'], **white)), 'cannot be read: ')

    def test_tiff_samples_without_a_meaning(self):
        colors = {'samples': 3, 'rows': 4}
        triples = [strip * 3 for strip in self.STRIPS]
        palette = [257 * (i % 256) for i in range(768)]
        grey = self.write('grey.tif', tiff_of(self.STRIPS))
        shown = self.write('palette.tif', tiff_of(self.STRIPS, meaning=3, palette=palette))
        self.check(2, 'channel', 'compare', grey, shown)  # read as grey and as colours
        for what, data in (
                ('no palette', tiff_of(self.STRIPS, meaning=3)),
                ('short palette', tiff_of(self.STRIPS, meaning=3, palette=palette[:300])),
                ('palette of 4 bits', tiff_of(self.STRIPS, meaning=3, palette=palette, bits=4)),
                ('palette of colours', tiff_of(triples, meaning=3, palette=palette, **colors)),
                ('no palette of colours', tiff_of(triples, meaning=3, **colors)),
                ('no meaning', tiff_of(self.STRIPS, drop=['meaning'])),
                ('unknown meaning', tiff_of(self.STRIPS, meaning=99)),
                ('one sample of colours', tiff_of(self.STRIPS, meaning=2))):
            with self.subTest(what):
                self.refused_everywhere(self.write('a.tif', data), 'cannot be read: ')

    def test_jpegs_of_four_inks_and_of_unknown_ones(self):
        inks = [[[0, 51, 255]], [[102, 0, 0]], [[255, 204, 51]], [[0, 51, 153]]]
        adobe = jpeg_segment(0xee, b'Adobe' + struct.pack('>HHHB', 100, 0, 0, 0))
        inverted = [[[255 - code for code in row] for row in plane] for plane in inks]
        # What light each ink leaves, of what black leaves: whole codes of these values.
        rgb = [[round((255 - inks[c][0][i]) * (255 - inks[3][0][i]) / 255) for i in range(3)] for c in range(3)]
        row = [rgb[c][i] for i in range(3) for _ in range(8) for c in range(3)]
        expected = self.write('rgb.png', png([row] * 8, 2))
        for name, data in (('plain', jpeg_of(inks, b'')), ('adobe', jpeg_of(inverted, adobe))):
            with self.subTest(name):
                image = self.write('a.jpg', data)
                # Products of codes that are no multiple of 255 are off the nearest code by half of one.
                self.check(0, 'match', 'compare', image, expected, '--max-abs', str(0.51 / 255))
                self.check(65, 'display-referred', 'tonemap', image, '-o', self.out / 'x.png')
                self.check(65, 'display codes', 'render', self.environment(image), '-o',
                           self.out / 'x.exr')
                # sRGB's curve rises by 2.28 at most; an albedo under light 1 is what is seen.
                self.check(0, 'match', 'compare', self.render(self.textured(image), 'a.exr'),
                           self.render(self.textured(expected), 'b.exr'), '--layers', 'beauty',
                           '--max-abs', str(2.28 * 0.51 / 255))
        for count in 2, 5:
            with self.subTest(components=count):
                self.refused_everywhere(self.write('a.jpg', jpeg_of((inks + inks)[:count], b'')), 'cannot be read')

    # ---- Memory ----

    def costs(self, limit, code, *arguments):
        """The program ends with this code and takes no more than `limit` bytes over what it takes
        for nothing; refusals are one line."""
        if SANITIZED:
            self.skipTest('sanitizers take memory of their own')
        _, _, idle = run_measured('info')
        got, errors, peak = run_measured(*arguments)
        self.assertEqual(got, code, errors)
        self.assertLess(peak - idle, limit, arguments)

    def test_a_header_that_promises_pixels_costs_nothing(self):
        # OpenEXR's own damaged sample is like this: a huge window, one chunk of a few bytes.
        part = Part({'R': 0.0}, (0, 0, 268435455, 0))
        part.chunk = lambda index: b'abcd'
        wide = self.write('wide.exr', exr(part))
        self.costs(ROOM, 0, 'info', wide)
        self.costs(ROOM, 2, 'compare', wide, wide)
        self.costs(ROOM, 65, 'tonemap', wide, '-o', self.out / 'x.png')
        self.costs(ROOM, 65, 'render', self.textured(wide), '-o', self.out / 'x.exr')
        self.costs(ROOM, 65, 'render', self.environment(wide), '-o', self.out / 'x.exr')
        for name, data in (('a.hdr', hdr([], '-Y 60000 +X 60000')),
                           ('a.png', png([[0] * 9], 2, size=(60000, 60000))),
                           ('i.png', png([[0] * 9], 2, size=(30000, 30000), interlace=1)),
                           ('a.tif', tiff([[0]] * 2, declared_height=60000)),
                           ('a.pfm', b'PF\n60000 60000\n-1.0\n' + bytes(100))):
            path = self.write(name, data)
            with self.subTest(name):
                self.costs(ROOM, 2, 'compare', path, path)
                self.costs(ROOM, 65, 'render', self.textured(path), '-o', self.out / 'x.exr')

    def test_a_small_file_of_many_pixels_is_refused(self):
        black = self.write('black.exr', constant_zip(12288, 12288))
        self.assertLess(black.stat().st_size, MIB)
        self.costs(ROOM, 0, 'info', black)
        self.costs(ROOM, 2, 'compare', black, black)
        self.costs(ROOM, 65, 'tonemap', black, '-o', self.out / 'x.png')
        self.costs(ROOM, 65, 'render', self.textured(black), '-o', self.out / 'x.exr')
        self.costs(ROOM, 65, 'render', self.environment(black), '-o', self.out / 'x.exr')
        self.check(65, 'save it with less compression', 'render', self.environment(black), '-o',
                   self.out / 'x.exr')

    def test_an_honest_picture_takes_a_small_multiple_of_its_samples(self):
        width, height = 4096, 2048
        path = self.write('sky.exr', constant_zip(width, height))
        samples, pixels = 3 * width * height, width * height
        self.costs(2 * 4 * samples + SMALL_ROOM, 0, 'compare', path, path)
        self.costs(4 * samples + SMALL_ROOM, 0, 'tonemap', path, '-o', self.out / 'x.png')
        small = ['-o', self.out / 'x.exr', '--size', '16x16', '--spp', '1']
        self.costs(16 * samples // 3 + SMALL_ROOM, 0, 'render', self.textured(path), *small)
        self.costs(ENVIRONMENT_BYTES * pixels + SMALL_ROOM, 0, 'render', self.environment(path), *small)


# Three floats of the picture, four of a texel and 16 bytes to sample it by.
ENVIRONMENT_BYTES = 44

if __name__ == '__main__':
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
