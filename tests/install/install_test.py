#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""An installed nacre: what it shows, a program that uses it, and that it can be moved.

Usage: install_test.py BUILD_FOLDER SOURCE_FOLDER CXX

With NACRE_PREFIX in the environment, of what is installed there, e.g. by packages, not of the build.
"""
import gzip
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD, SOURCE, CXX = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
EXAMPLE = SOURCE / 'tests/install'


def run(*command, **options):
    result = subprocess.run([str(part) for part in command], capture_output=True, text=True,
                            timeout=120, check=False, **options)
    if result.returncode != 0:
        raise AssertionError(f'{command}: {result.returncode}\n{result.stdout}{result.stderr}')
    return result.stdout


class InstallTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.top = pathlib.Path(cls.folder.name)
        if 'NACRE_PREFIX' in os.environ:
            shutil.copytree(os.environ['NACRE_PREFIX'], cls.top / 'first', symlinks=True)
        else:
            run('cmake', '--install', BUILD, '--prefix', cls.top / 'first')
        # Whatever an installation knows of its place is now wrong.
        cls.prefix = cls.top / 'moved'
        (cls.top / 'first').rename(cls.prefix)
        cls.library = next(cls.prefix.glob('lib/**/libnacre.so'))

    def check_example(self, program, environment):
        output = self.top / 'grid.exr'
        printed = run(program, output, env=environment).split()
        self.assertEqual(printed[0], 'beauty')
        self.assertGreater(float(printed[2]), 0)  # two forms of shadowing differ
        self.assertIn('gold', printed)
        self.assertIn('specular', run(self.prefix / 'bin/nacre', 'info', output))

    def test_a_program_finds_it_by_cmake(self):
        build = self.top / 'example'
        run('cmake', '-G', 'Ninja', '-S', EXAMPLE, '-B', build, f'-DCMAKE_PREFIX_PATH={self.prefix}',
            f'-DCMAKE_CXX_COMPILER={CXX}')
        run('cmake', '--build', build)
        self.check_example(build / 'example', None)

    def test_a_program_finds_it_by_pkg_config(self):
        pc = self.library.parent / 'pkgconfig'
        flags = run('pkg-config', '--cflags', '--libs', 'nacre',
                    env={**os.environ, 'PKG_CONFIG_PATH': str(pc)}).split()
        program = self.top / 'by_pkg_config'
        run(CXX, *os.environ.get('CXXFLAGS', '').split(), '-std=c++17', '-Wall', '-Wextra', '-Werror',
            EXAMPLE / 'example.cc', '-o', program, *flags)
        self.check_example(program, {**os.environ, 'LD_LIBRARY_PATH': str(self.library.parent)})

    def test_the_programs_of_the_readme_build_and_run(self):
        readme = (SOURCE / 'README.md').read_text()
        blocks = re.findall(r'^```(cpp|cmake)\n(.*?)^```$', readme, re.M | re.S)
        check, picture = (text for kind, text in blocks if kind == 'cpp')
        project, = (text for kind, text in blocks if kind == 'cmake')
        folder = self.top / 'readme'
        folder.mkdir()
        (folder / 'check.cc').write_text(check)
        (folder / 'picture.cc').write_text(picture)
        (folder / 'CMakeLists.txt').write_text(
            project + project[project.index('add_executable'):].replace('check', 'picture'))
        run('cmake', '-G', 'Ninja', '-S', folder, '-B', folder / 'build', f'-DCMAKE_PREFIX_PATH={self.prefix}',
            f'-DCMAKE_CXX_COMPILER={CXX}')
        run('cmake', '--build', folder / 'build')
        self.assertIn('largest relative difference', run(folder / 'build/check'))
        run(folder / 'build/picture', cwd=folder)
        self.assertIn('specular', run(self.prefix / 'bin/nacre', 'info', folder / 'gold.exr'))

    def test_the_library_shows_the_api_alone(self):
        names = run('nm', '-DC', '--defined-only', self.library).splitlines()
        self.assertTrue(any('nacre::v0::Render(' in name for name in names))
        self.assertEqual([name for name in names if 'nacre::v0::' not in name], [])

    def test_nothing_names_the_folder_that_it_was_built_in(self):
        for pattern in '**/*.cmake', '**/*.pc':
            for path in self.prefix.glob(pattern):
                self.assertNotIn(str(BUILD), path.read_text(), path)
        for path in self.prefix / 'bin/nacre', self.library:
            self.assertNotRegex(run('readelf', '-d', path), 'RPATH|RUNPATH')

    def test_the_program_finds_its_module_and_scenes(self):
        scene = self.prefix / 'share/nacre/scenes/material_grid.json'
        self.assertTrue((scene.parent / 'nacre.schema.json').is_file())
        run(self.prefix / 'bin/nacre', 'render', scene, '-o', self.top / 'a.png', '--labels', '--size',
            '200x200', '--spp', '1')
        tiff = [self.prefix / 'bin/nacre', 'info', pathlib.Path(__file__).resolve().parents[2] / 'tests/fuzz/corpus/texture_image/a.tif']
        run(*tiff)
        module = next(self.prefix.glob('lib/**/nacre_oiio.so'))
        away = self.top / 'away.so'
        shutil.move(module, away)
        try:
            with self.assertRaisesRegex(AssertionError, 'nacre_oiio.so'):
                run(*tiff)
        finally:
            shutil.move(away, module)

    def test_the_manual_page_is_there(self):
        page = gzip.decompress((self.prefix / 'share/man/man1/nacre.1.gz').read_bytes()).decode()
        self.assertTrue(page.startswith('.TH NACRE 1'))
        completion = self.prefix / 'share/bash-completion/completions/nacre'
        self.assertIn('complete', completion.read_text())


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
