#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A pixel depends on (scene, pixel, sample, target) alone: random scenes and settings, each picture
rendered twice in ways that must not change a bit.

Usage: determinism_test.py PROGRAM SOURCE_FOLDER [--first SEED] [--count N] [--out FOLDER]

Configuration SEED is a scene (a random one, or one that ships), a size, samples or a wanted error,
and a SIMD target. It is rendered whole, and once more: both with threads, width of tiles, layers and
intersector drawn at random, the second also as a region, or as bands that are merged. All channels
that both have must agree in all bits. Of those that do not, the command lines are printed, and the
scenes stay in FOLDER (out/determinism).
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import shlex
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / 'report'))
import pictures  # noqa: E402
import random_scene  # noqa: E402

LAYERS = ('diffuse', 'specular', 'ambient', 'emission', 'albedo', 'N', 'T', 'P', 'Z', 'id.object',
          'id.material')
# More spheres than are needed here.
SMALLER = {'million_spheres.json': ['--set', '/shapes/1/count=3000']}


class Configuration:
    def __init__(self, seed, program, source, folder, targets):
        self.seed, self.program, self.folder, self.commands = seed, program, folder, []
        self.random = r = random.Random(seed)
        self.width, self.height = r.randint(33, 160), r.randint(17, 100)
        if r.random() < 0.1:
            self.width, self.height = r.randint(1, 40), r.randint(1, 20)
        self.picture = ['--size', f'{self.width}x{self.height}', '--depth', 'float',
                        '--compression', 'none', '--quiet']
        self.scene = self.choose_scene(source)
        # What adaptive sampling decides from, the intersectors must agree on, too.
        self.adaptive = r.random() < 0.25
        if self.adaptive:
            self.picture += ['--max-error', r.choice(('0.3', '0.1', '0.03')),
                             '--spp', r.choice(('16', '64', '64', '300'))]
        else:
            self.picture += ['--spp', str(r.choice((1, 1, 2, 3, 4, 5, 8, 9, 16)))]
        self.picture += ['--target', r.choice(targets)]

    def choose_scene(self, source):
        """One in five is a scene that ships, and one in fifteen a model."""
        if self.seed % 5 == 0:
            shipped = sorted(path for path in (source / 'scenes').rglob('*.json')
                             if path.name != 'nacre.schema.json')
            path = self.random.choice(shipped)
            self.picture += SMALLER.get(path.name, [])
            return path
        if self.random.random() < 1 / 15:
            return self.folder / 'assets' / 'model.gltf'
        path = self.folder / f'scene_{self.seed}.json'
        path.write_text(json.dumps(random_scene.SceneMaker(self.random).make()))
        return path

    def way(self):
        """Options that change no bit."""
        r = self.random
        options = ['--threads', str(r.choice((1, 2, 3)))]
        if r.random() < 0.6:
            options += ['--tile-size', str(r.choice((r.randint(1, 64), 16, 32)))]
        if r.random() < 0.4:
            options += ['--layers', r.choice(('all', ','.join(r.sample(LAYERS, 3))))]
        if r.random() < (0.9 if self.adaptive else 0.5):
            options += ['--intersector', r.choice(('embree', 'tiles', 'shells'))]
        return options

    def render(self, name, *options):
        path = self.folder / f'{self.seed}_{name}.exr'
        self.run('render', self.scene, '-o', path, *self.picture, *options)
        return path

    def run(self, *arguments):
        command = [str(self.program), *map(str, arguments)]
        self.commands.append(shlex.join(command))
        result = subprocess.run(command, capture_output=True, text=True, timeout=300)
        if result.returncode != 0:
            raise RuntimeError(f'code {result.returncode}: {result.stderr.strip()}')

    def render_again(self):
        r, way = self.random, self.way()
        bands = (self.height + 15) // 16
        choice = r.random()
        if choice < 0.35:
            x, y = r.randrange(self.width), r.randrange(self.height)
            return self.render('again', *way, '--region',
                               f'{x},{y},{r.randint(x + 1, self.width)},'
                               f'{r.randint(y + 1, self.height)}')
        if choice < 0.6 and bands > 1:
            count = r.randint(2, bands)
            tiles = [self.render(f'again_{i}', *way, '--tile', f'{i}/{count}')
                     for i in range(count)]
            whole = self.folder / f'{self.seed}_again.exr'
            self.run('merge', '-o', whole, *tiles)
            return whole
        return self.render('again', *way)

    def check(self):
        """None, or what is wrong."""
        try:
            whole = self.render('whole', *self.way())
            wrong = compare(whole, self.render_again())
        except (RuntimeError, subprocess.TimeoutExpired) as error:
            wrong = str(error)
        if wrong is None:
            for path in self.folder.glob(f'{self.seed}_*.exr'):
                path.unlink()
            (self.folder / f'scene_{self.seed}.json').unlink(missing_ok=True)
            return None
        return '\n  '.join([f'configuration {self.seed}: {wrong}', *self.commands])


def compare(whole, part):
    """None if the part's pixels have the bits of the whole, in all channels that both have."""
    a, b = pictures.read_exr_rows(whole), pictures.read_exr_rows(part)
    left, top = b.x0 - a.x0, b.y0 - a.y0
    different, first = 0, ''
    shared = a.rows.keys() & b.rows.keys()
    assert {'R', 'G', 'B', 'A'} <= shared
    for name in sorted(shared):
        for y, row in enumerate(b.rows[name]):
            other = a.rows[name][top + y][4 * left:4 * left + len(row)]
            if other == row:
                continue
            places = [x for x in range(0, len(row), 4) if row[x:x + 4] != other[x:x + 4]]
            different += len(places)
            if not first:
                x = places[0]
                first = (f'{name} at ({b.x0 + x // 4}, {b.y0 + y}): {other[x:x + 4][::-1].hex()} '
                         f'and {row[x:x + 4][::-1].hex()}')
    return f'{different} samples differ; {first}' if different else None


def find_targets(program):
    """The SIMD targets of this machine."""
    text = subprocess.run([program, 'info'], capture_output=True, text=True, check=True).stdout
    line = next(line for line in text.splitlines() if line.strip().startswith('SIMD targets here'))
    return [name.strip(',') for name in line.split()[3:]]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('program', type=pathlib.Path)
    parser.add_argument('source', type=pathlib.Path)
    parser.add_argument('--first', type=int, default=0, help='the first SEED; 0 if not given')
    parser.add_argument('--count', type=int, default=60, help='how many; 60 if not given')
    parser.add_argument('--out', type=pathlib.Path, default=pathlib.Path('out/determinism'))
    options = parser.parse_args()

    options.out.mkdir(parents=True, exist_ok=True)
    random_scene.write_assets(options.out / 'assets', random.Random(1))
    targets = find_targets(options.program)

    def check(seed):
        return Configuration(seed, options.program, options.source, options.out, targets).check()

    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        seeds = range(options.first, options.first + options.count)
        for wrong in pool.map(check, seeds):
            if wrong is not None:
                failed += 1
                print(wrong, flush=True)
    print(f'determinism: {failed} of {options.count} configurations differ, from seed '
          f'{options.first} on')
    sys.exit(1 if failed else 0)


if __name__ == '__main__':
    main()
