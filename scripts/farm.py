# SPDX-License-Identifier: Apache-2.0
"""scripts/farm.py: what farm_local and farm_slurm share: a picture as tiles that can be lost and
made again. It is imported by them, not run.

Tiles are kept in OUT.tiles/KEY. KEY is a digest of all that decides the picture's bits (scene,
settings, SIMD target, build, layers, compression, as nacre render --dry-run tells them) and of the
number of tiles; and nacre's files appear whole or not at all. So a file there is a tile that need
not be made again.
"""
import argparse
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
USAGE, BAD_INPUT = 64, 65  # exit codes of nacre that another attempt cannot change
# Options of nacre render that are about the merged picture, or make no sense for a tile.
MERGE_OPTIONS = {'--tonemap', '--exposure'}
REFUSED = {
    '--tile': 'tiles are what this script makes', '--region': 'tiles span the whole frame',
    '--labels': 'labels are drawn into whole pictures', '--dry-run': 'see --measure',
    '--stats': 'every tile would write it', '--explain': 'every tile would print it',
    '--preset': 'the preset has no tiles'}


def printable(text):
    """The text with what would act on a terminal spelled out, as nacre does it (base/printable.h)."""
    def spell(c):
        code = ord(c)
        if 0xdc80 <= code <= 0xdcff:  # how Python keeps a byte that is not UTF-8
            return f'\\x{code - 0xdc00:02x}'
        acts = (code < 0x20 or 0x7f <= code <= 0x9f or 0x2028 <= code <= 0x202e or
                0x2066 <= code <= 0x2069)
        return {'\n': '\\n', '\r': '\\r', '\t': '\\t'}.get(c, f'\\u{code:04x}') if acts else c
    return ''.join(map(spell, str(text)))


def fail(message, code=1):
    sys.exit(print(f'error: {printable(message)}', file=sys.stderr) or code)


def add_arguments(parser):
    parser.add_argument('scene', metavar='SCENE', help='scene file or model; comes first')
    parser.add_argument('-o', '--output', action='append', default=[], metavar='FILE',
                        help='.exr or .png to write; repeatable')
    parser.add_argument('--tiles', type=int, metavar='M',
                        help='tiles to cut the picture into; four for each process if not given')
    parser.add_argument('--retries', type=int, default=2, metavar='R',
                        help='how often failed tiles are tried again (2)')
    parser.add_argument('--keep-tiles', action='store_true', help='leave the tiles when done')
    parser.add_argument('--quiet', action='store_true', help='print nothing but errors')
    parser.add_argument('--nacre', default=str(ROOT / 'build/nacre'), metavar='PROGRAM',
                        help='the program (build/nacre)')


def make_parser(text):
    """A parser whose help is the script's own comment and the options added to it."""
    return argparse.ArgumentParser(description=text, allow_abbrev=False,
                                   formatter_class=argparse.RawDescriptionHelpFormatter,
                                   usage='%(prog)s SCENE -o FILE... [OPTIONS] [RENDER OPTIONS]')


def split_options(options):
    """Options of render as (those of the tiles, those of the merge)."""
    tile, merge = [], []
    words = iter(options)
    for word in words:
        name = word.split('=')[0]
        if name in REFUSED:
            fail(f'{name} cannot be used on a farm: {REFUSED[name]}', USAGE)
        if name in MERGE_OPTIONS:
            merge += [word] if '=' in word else [word, next(words, '')]
        else:
            tile.append(word)
    return tile, merge + [word for word in tile if word == '--small']


class Picture:
    """One picture, its tiles and the folder that holds them."""

    def __init__(self, arguments, options, tiles_wanted):
        if not arguments.output:
            fail('-o FILE is required', USAGE)
        self.nacre = os.path.abspath(arguments.nacre)
        if not os.path.exists(self.nacre):
            fail(f'{self.nacre} is not there: scripts/build release nacre builds build/nacre', USAGE)
        self.scene = os.path.abspath(arguments.scene)
        self.outputs = [os.path.abspath(path) for path in arguments.output]
        self.options, self.merge_options = split_options(options)
        self.keep_tiles = arguments.keep_tiles
        plan = self.dry_run()
        if not any(option.split('=')[0] == '--target' for option in self.options):
            # Another machine might choose another one, whose bits differ.
            self.options += ['--target', plan['attributes']['nacre:target']]
        self.count = arguments.tiles or min(tiles_wanted, plan['most_tiles'])
        if not 1 <= self.count <= plan['most_tiles']:
            fail(f'--tiles {self.count}: the picture has {plan["most_tiles"]} at most', USAGE)
        text = json.dumps([plan, self.count], sort_keys=True)
        key = hashlib.sha256(text.encode()).hexdigest()[:16]
        self.folder = pathlib.Path(self.outputs[0] + '.tiles') / key

    def dry_run(self):
        outputs = [word for path in self.outputs for word in ('-o', path)]
        result = subprocess.run([self.nacre, 'render', self.scene, *outputs, '--dry-run', '--quiet',
                                 *self.options], capture_output=True, text=True, check=False)
        if result.returncode != 0:
            sys.stderr.write(result.stderr)
            sys.exit(result.returncode)
        return json.loads(result.stdout)

    def tile(self, index):
        return self.folder / f'tile_{index:04}_of_{self.count:04}.exr'

    def missing(self):
        return [index for index in range(self.count) if not self.tile(index).is_file()]

    def render_command(self, index, threads):
        named = any(option.split('=')[0] == '--threads' for option in self.options)
        return [self.nacre, 'render', self.scene, '-o', str(self.tile(index)), '--tile',
                f'{index}/{self.count}', '--quiet', *self.options,
                *([] if named else ['--threads', str(threads)])]

    def merge(self):
        """Merges, and reads the picture back. Tiles that nacre finds fault with are removed; True if
        there were none: then the tiles are no longer needed."""
        outputs = [word for path in self.outputs for word in ('-o', path)]
        tiles = [str(self.tile(index)) for index in range(self.count)]
        result = subprocess.run([self.nacre, 'merge', *outputs, '--quiet', *self.merge_options,
                                 *tiles], capture_output=True, text=True, check=False)
        sys.stderr.write(result.stderr)
        if result.returncode == 0:
            self.prove()
            return True
        bad = [tile for tile in tiles if tile in result.stderr]
        if result.returncode != BAD_INPUT or not bad:
            sys.exit(result.returncode)
        for tile in bad:
            os.unlink(tile)
        return False

    def prove(self):
        """That all of the merged files is on the disk, by their checksums. Tiles stay if it is not."""
        result = subprocess.run([self.nacre, 'info', '--verify', *self.outputs], capture_output=True,
                                text=True, check=False)
        if result.returncode != 0:
            sys.stderr.write(result.stderr)
            fail(f'the merged picture is not what was written; its tiles are kept in {self.folder}')

    def remove_tiles(self):
        if self.keep_tiles:
            return
        shutil.rmtree(self.folder)
        try:
            self.folder.parent.rmdir()
        except OSError:
            pass  # tiles of another picture


class Progress:
    """How many tiles there are, on standard error: a line that changes, or one for each tenth."""

    def __init__(self, total, done, quiet):
        self.total, self.first, self.told, self.quiet = total, done, -1, quiet
        self.start = time.monotonic()

    def tell(self, done):
        line = f'tiles {done}/{self.total}'
        if self.first < done < self.total:
            left = (time.monotonic() - self.start) / (done - self.first) * (self.total - done)
            line += f', {left:.0f} s left'
        if self.quiet:
            return
        if sys.stderr.isatty():
            print(f'\r{line}\033[K', end='\n' if done == self.total else '', file=sys.stderr,
                  flush=True)
        elif done * 10 // self.total != self.told:
            self.told = done * 10 // self.total
            print(line, file=sys.stderr, flush=True)
