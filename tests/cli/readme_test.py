#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs every command of the READMEs as it is written there, in a folder that looks like the root.

The blocks of README.md run in the order in which they stand, programs and all, from the state that its
first command leaves: the program alone is built. Of scripts, which would build and install, the names and
options are checked; what `scripts/build` makes comes from the build under test.

Usage: readme_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
"""
import json
import os
import pathlib
import re
import shlex
import signal
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
BUILD = PROGRAM.parent
PACKAGE = list(BUILD.glob('python/nacre/_nacre.*.so'))
# A Python without the sanitizer's run time cannot load the package.
CAN_IMPORT = PACKAGE and '-fsanitize' not in os.environ.get('CXXFLAGS', '')
BLOCK = re.compile(r'^```(\w*)\n(.*?)^```$', re.M | re.S)
READMES = sorted(path for path in SOURCE.rglob('README.md')
                 if not re.match(r'build|out/|\.git', path.relative_to(SOURCE).as_posix()))
# Options in the text that belong to other programs: cmake, ctest, pip.
OTHERS = {'--install', '--prefix', '--preset', '--no-build-isolation', '--no-deps'}
IMPORTS = 'PYTHONPATH=build/python'
# Where README.md puts its programs.
PROGRAMS = {'python': 'check.py', 'cpp': 'out/check/check.cc', 'cmake': 'out/check/CMakeLists.txt'}


def blocks(path, kind):
    return [text for tag, text in BLOCK.findall(path.read_text()) if tag == kind]


def commands(block):
    """[(command line, exit code)] of a sh block; the code is told by a comment behind it."""
    found = []
    for line in block.replace('\\\n', ' ').splitlines():
        words = shlex.split(line, comments=True)
        code = re.search(r'# exit code (\d+)$', line)
        if words:
            found.append((words, int(code.group(1)) if code else 0))
    return found


def run(words, cwd, **options):
    return subprocess.run(words, cwd=cwd, capture_output=True, text=True, timeout=900, check=False,
                          **options)


def built_targets():
    """The SIMD targets of this build that this machine has, the slowest first."""
    line = re.search(r'SIMD targets here +(.*)', run([PROGRAM, 'info'], SOURCE).stdout)
    return line.group(1).split(', ')


def with_built_target(words, targets):
    """The command for a build that has but some targets: with its slowest for one that it lacks."""
    return [targets[0] if flag == '--target' and word not in targets else word
            for flag, word in zip(['', *words], words)]


class ReadmeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """The python3 of the PATH has no numpy, as many a version manager's."""
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        python = pathlib.Path(folder.name) / 'python3'
        python.write_text('#!/bin/sh\nexec /usr/bin/python3 -S "$@"\n')
        python.chmod(0o755)
        os.environ['PATH'] = f'{folder.name}:{os.environ["PATH"]}'
        cls.targets = built_targets()

    def make_root(self):
        """The tree's entries under a folder of its own, and the program where a build puts it."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        root = pathlib.Path(folder.name)
        for entry in SOURCE.iterdir():
            if not re.fullmatch(r'build.*|out|\.git', entry.name):
                (root / entry.name).symlink_to(entry)
        (root / 'build').mkdir()
        (root / 'build/nacre').symlink_to(PROGRAM)
        return root

    def check_script(self, words):
        script = SOURCE / words[0]
        self.assertTrue(script.is_file(), words)
        told = run([script, '--help'], SOURCE)
        self.assertEqual(told.returncode, 0, told.stderr)
        for word in words[1:]:
            if word.startswith('--'):
                self.assertIn(word, told.stdout + run([PROGRAM, 'render', '--help-all'], SOURCE).stdout)

    def check_view(self, words, root):
        """It prints an address, and serves until Ctrl-C."""
        process = subprocess.Popen([*words, '--no-open'], cwd=root, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        address = process.stdout.readline()
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=60)[1]
        self.assertRegex(address, r'^http://127\.0\.0\.1:\d+/[0-9a-f]{32}/$', errors)
        self.assertEqual(process.returncode, 130, errors)

    def make_first_build(self):
        """A root whose build folder is as the first command leaves it: configured, with the program alone."""
        root = self.make_root()
        shutil.rmtree(root / 'build')
        result = run(['cmake', '--preset', 'release', '-DNACRE_TESTS=OFF', '-DNACRE_BENCH=OFF'], root)
        self.assertEqual(result.returncode, 0, result.stderr)
        shutil.copy(PROGRAM, root / 'build')
        shutil.copy(BUILD / 'nacre_oiio.so', root / 'build')
        return root

    def build_installed(self, root):
        """What `scripts/build release installed` adds to that."""
        for pattern in 'libnacre.so*', 'docs/nacre*', 'python/nacre/_nacre.*.so':
            for file in BUILD.glob(pattern):
                shutil.copy(file, root / 'build' / file.relative_to(BUILD), follow_symlinks=False)

    def check_command(self, words, code, root, done):
        if words[0].startswith('scripts/'):
            self.check_script(words)
            if words == ['scripts/build', 'release', 'installed']:
                self.build_installed(root)
            elif words[0] == 'scripts/make_measured.py':  # which writes a file, and builds nothing
                result = run(words, root)
                self.assertEqual(result.returncode, 0, result.stderr)
            return
        self.assertIn(words[0], ('build/nacre', 'cp', 'cmake', 'out/check/build/check', IMPORTS))
        if words[0] == IMPORTS and not CAN_IMPORT:
            return
        if words[1:2] == ['view']:
            self.check_view(words, root)
            return
        # The same line elsewhere, and files that none of the later lines reads.
        if tuple(words) in done and 'render' not in words:
            return
        done.add(tuple(words))
        result = run(['env', *with_built_target(words, self.targets)], root)
        self.assertEqual(result.returncode, code, result.stderr)
        for flag, value in zip(words, words[1:]):
            if flag == '-o':
                self.assertTrue((root / value).exists(), value)

    def check_blocks(self, path, root, done):
        """Those of one README, in their order."""
        for kind, text in BLOCK.findall(path.read_text()):
            if kind == 'sh':
                for words, code in commands(text):
                    with self.subTest(path=path.relative_to(SOURCE).as_posix(), command=words):
                        self.check_command(words, code, root, done)
            elif path != SOURCE / 'README.md' or kind not in PROGRAMS:
                continue
            elif kind == 'cmake' or re.match(rf'\S+ {pathlib.Path(PROGRAMS[kind]).name}: ', text):
                (root / PROGRAMS[kind]).parent.mkdir(parents=True, exist_ok=True)
                (root / PROGRAMS[kind]).write_text(text)
            elif kind == 'python' and CAN_IMPORT:  # without a name, as if it were typed
                result = run(['env', IMPORTS, '/usr/bin/python3', '-'], root, input=text)
                self.assertEqual(result.returncode, 0, result.stderr)

    def test_every_command_does_what_it_says(self):
        done = set()
        for path in READMES:
            root = self.make_first_build() if path == SOURCE / 'README.md' else self.make_root()
            self.check_blocks(path, root, done)
        self.assertGreater(len(done), 30)

    def test_what_is_not_built_yet_says_what_builds_it(self):
        root = self.make_first_build()
        tried = [(['cmake', '--install', 'build', '--prefix', 'out/nacre'],
                  r" *Nothing is installed: \S+ is not built yet: (cmake --build \S+ --target installed)")]
        if PACKAGE:
            tried.append((['env', IMPORTS, '/usr/bin/python3', '-c', 'import nacre'],
                          r"ImportError: nacre's compiled module is not built in \S+: "
                          r"(cmake --build \S+ --target nacre_python)"))
        for words, says in tried:
            result = run(words, root)
            self.assertEqual(result.returncode, 1, result.stderr)
            command, = re.findall(rf'^{says}$', result.stderr, re.M)
            dry = run([*shlex.split(command), '--', '-n'], root)
            self.assertEqual(dry.returncode, 0, dry.stdout)
        self.assertFalse((root / 'out').exists())

    def test_no_command_hides_in_a_block_of_another_kind(self):
        for path in READMES:
            for tag, text in BLOCK.findall(path.read_text()):
                if tag != 'sh':
                    self.assertNotRegex(text, r'(?m)^(build/nacre|scripts/\w+)', path)

    def test_the_picture_at_the_top_comes_of_the_command_below_it(self):
        root = self.make_root()
        line = re.search(r'`(build/nacre pair [^`]*)`', (SOURCE / 'README.md').read_text()).group(1)
        result = run(shlex.split(line), root)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((root / 'difference.png').exists())

    def test_the_scene_is_the_one_of_the_folder(self):
        scene, = blocks(SOURCE / 'README.md', 'json')
        self.assertEqual(json.loads(scene),
                         json.loads((SOURCE / 'scenes/first_scene.json').read_text()))

    def test_a_slip_gets_the_answer_that_is_shown(self):
        root = self.make_root()
        shown, = (text for text in blocks(SOURCE / 'README.md', '') if text.startswith('error: '))
        scene = (SOURCE / 'scenes/first_scene.json').read_text()
        slip = scene.replace('"roughness"', '"roughnes"')
        self.assertNotEqual(slip, scene)
        (root / 'my_scene.json').write_text(slip)
        result = run(['build/nacre', 'render', 'my_scene.json', '-o', 'mine.png'], root)
        self.assertEqual(result.returncode, 65)
        self.assertIn(shown.strip(), result.stderr)

    def test_every_command_has_a_row(self):
        text = (SOURCE / 'src/cli/README.md').read_text()
        for name in re.findall(r'^  ([a-z]+) ', run([PROGRAM, '--help'], SOURCE).stdout, re.M):
            self.assertRegex(text, rf'(?m)^\| `nacre {name}\b')

    def test_every_option_that_is_named_exists(self):
        names = re.findall(r'^  (\w+) ', run([PROGRAM, '--help'], SOURCE).stdout, re.M)
        known = ''.join(run([PROGRAM, name, '--help-all'], SOURCE).stdout for name in names)
        for script in sorted((SOURCE / 'scripts').iterdir()):
            if not script.suffix and script.is_file():
                known += run([script, '--help'], SOURCE).stdout
        known = set(re.findall(r'--[a-z][a-z-]*', known)) | OTHERS
        for path in READMES:
            text = '\n'.join(re.findall(r'`([^`\n]+)`', path.read_text()))
            named = set(re.findall(r'(?<![\w-])--[a-z][a-z-]*', text)) - {'--help', '--help-all'}
            self.assertEqual(named - known, set(), path)

    @unittest.skipUnless(shutil.which('gnuplot'), 'gnuplot is missing')
    def test_the_studies_answers_are_those_of_the_table(self):
        """The figures of README.md's table, where a study takes little time."""
        text = (SOURCE / 'README.md').read_text()
        root = self.make_root()
        for study, pattern in (('blinn-exponent', r'(\d+\.\d) in the plane of incidence, '
                                                  r'(\d+\.\d) over a sphere.*?, (\d+\.\d) at 85'),
                               ('fresnel', r'(\d+\.\d+)° by Schlick')):
            result = run(['build/nacre', 'study', study, '-o', study, '--quiet'], root)
            self.assertEqual(result.returncode, 0, result.stderr)
            answer = (root / study / 'answer.md').read_text()
            for figure in re.search(pattern, text).groups():
                digits = len(figure.partition('.')[2])
                rounded = {f'{float(number):.{digits}f}'
                           for number in re.findall(r'\d+\.\d+', answer)}
                self.assertIn(figure, rounded)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
