#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/farm_slurm on a Slurm of one node that the test starts: 64 tiles, failures, resumption.

Usage: slurm_test.py PROGRAM SOURCE_FOLDER. Exit code 77: there is no Slurm here, or no root.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import cluster

PROGRAM, SOURCE = (os.path.abspath(word) for word in sys.argv[1:3])
SCENE = SOURCE + '/scenes/first_scene.json'
OPTIONS = ['--size', '64x1024', '--spp', '4', '--layers', 'all', '--reproducible']
TILES = 64


class SlurmTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory(prefix='nacre_slurm_')
        cls.addClassCleanup(cls.holder.cleanup)
        # Smaller than the tiles are many: they take two arrays.
        cls.slurm = cluster.Cluster(cls.holder.name, max_array_size=41)
        cls.addClassCleanup(cls.slurm.stop)
        cls.slurm.start()
        cls.single = pathlib.Path(cls.holder.name) / 'single.exr'
        subprocess.run([PROGRAM, 'render', SCENE, '-o', cls.single, '--quiet', *OPTIONS],
                       check=True)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)
        (self.out / 'failed').mkdir()

    def farm(self, failing, *arguments):
        self.slurm.environment.update(NACRE=PROGRAM, FAILING=failing, FAILED=str(self.out / 'failed'))
        return self.slurm.run(SOURCE + '/scripts/farm_slurm', SCENE, '-o', self.out / 'a.exr',
                              '--tiles', TILES, '--wait', '--nacre',
                              SOURCE + '/tests/distributed/fails_at_first', *OPTIONS, *arguments)

    def check_picture(self, result):
        logs = '\n'.join(path.read_text() for path in self.out.rglob('logs/*.txt'))
        self.assertEqual(result.returncode, 0, result.stderr + logs)
        self.assertEqual((self.out / 'a.exr').read_bytes(), self.single.read_bytes())
        self.assertEqual(sorted(path.name for path in self.out.iterdir()), ['a.exr', 'failed'])

    def test_failed_tiles_are_rendered_again_and_the_picture_is_the_single_renders(self):
        start = time.monotonic()
        result = self.farm('3 17 63')
        self.check_picture(result)
        self.assertEqual({path.name for path in (self.out / 'failed').iterdir()}, {'3', '17', '63'})
        print(f'{TILES} tiles, 3 of them twice: {time.monotonic() - start:.1f} s')

    def test_what_failed_too_often_is_told_and_resumed(self):
        result = self.farm('5', '--retries', '0')
        self.assertEqual(result.returncode, 1)
        self.assertIn('1 of 64 tiles failed 1 times', result.stderr)
        queue = self.slurm.run('squeue', '--noheader')  # nothing is in the way of the next call
        self.assertEqual((queue.returncode, queue.stdout), (0, ''))
        self.assertFalse((self.out / 'a.exr').exists())
        tiles = {path: path.stat().st_mtime_ns for path in self.out.rglob('tile_*.exr')}
        self.assertEqual(len(tiles), TILES - 1)
        result = self.farm('', '--keep-tiles')
        self.assertIn('63 of 64 tiles are there', result.stderr)
        self.assertEqual((self.out / 'a.exr').read_bytes(), self.single.read_bytes())
        for path, time_ns in tiles.items():
            self.assertEqual(path.stat().st_mtime_ns, time_ns)


if __name__ == '__main__':
    cluster.skip_unless_possible()
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=1)
