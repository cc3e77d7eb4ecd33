#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs nacre under Valgrind on its SSE path: renders, compares, converts, refuses, with no error.

Valgrind knows no AVX-512, so the target is given: sse4, and once scalar. Embree walks its tree with
SSE4.2 then, too. What counts: reads of what was never written, accesses out of bounds, and memory
that is lost for certain. TBB and Embree keep stores of their own to the end, which is no loss.
Usage: run_valgrind.py PROGRAM SOURCE_FOLDER
"""
import pathlib
import subprocess
import sys
import tempfile

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
VALGRIND = ['valgrind', '--quiet', '--error-exitcode=99', '--leak-check=full',
            '--errors-for-leak-kinds=definite', '--show-leak-kinds=definite']
# Spheres by tiles and by Embree, meshes, sampled area lights, environments, textures.
RENDERS = [
    ('first_scene', ['--target', 'sse4', '--intersector', 'tiles']),
    ('first_scene', ['--target', 'scalar', '--intersector', 'embree']),
    ('mesh_and_spheres', ['--target', 'sse4', '--layers', 'all']),
    ('area_lights', ['--target', 'sse4', '--max-error', '0.1']),
    ('evening_sky', ['--target', 'sse4']),
    ('textures', ['--target', 'sse4', '--intersector', 'embree']),
]


def run(expected, *arguments):
    """Whether the program ended as expected and Valgrind saw nothing."""
    result = subprocess.run([*VALGRIND, PROGRAM, *map(str, arguments)], capture_output=True,
                            text=True, timeout=1800, check=False)
    good = result.returncode == expected and '==' not in result.stderr
    print(f"{'ok  ' if good else 'FAIL'} {' '.join(map(str, arguments))}", flush=True)
    if not good:
        print(f'exit code {result.returncode}\n{result.stderr}')
    return good


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        results = []
        for number, (scene, options) in enumerate(RENDERS):
            results.append(run(0, 'render', SOURCE / f'scenes/{scene}.json', '--size', '48x27',
                               '--spp', '4', '--threads', '2', '--quiet', *options,
                               '-o', folder / f'{number}.exr', '-o', folder / f'{number}.png'))
        results += [
            run(0, 'compare', folder / '0.exr', folder / '0.exr'),
            run(1, 'compare', folder / '0.exr', folder / '2.exr', '--layers', 'beauty'),
            run(0, 'tonemap', folder / '2.exr', '-o', folder / 'tones.png'),
            run(65, 'render', SOURCE / 'README.md', '-o', folder / 'none.png'),
        ]
    failed = results.count(False)
    print(f'{len(results) - failed} passed, {failed} failed')
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
