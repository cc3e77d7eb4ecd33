#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What goes wrong around the program: full disks, folders that vanish, signals, no memory.

Each time: no crash, the right exit code with words, no part of a file, and old files as they were.
Usage: faults_test.py PROGRAM SOURCE_FOLDER COMPILER [UNITTEST-ARGUMENTS...]
"""
import contextlib
import os
import pathlib
import random
import resource
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import threading
import time
import unittest

PROGRAM, SOURCE, COMPILER = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
SANITIZED = b'__asan_init' in pathlib.Path(PROGRAM).read_bytes() or \
    b'__tsan_init' in pathlib.Path(PROGRAM).read_bytes()
GRID = SOURCE / 'scenes/material_grid.json'
FIRST = SOURCE / 'scenes/first_scene.json'
SMALL = ['--size', '64x36', '--spp', '1']
IS_ROOT = os.geteuid() == 0


def run(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120, check=False, **options)


def run_within(mib, *arguments):
    """With no more address space than that."""
    limit = int(mib * (1 << 20))
    return run(*arguments, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))


def is_whole(path):
    """Whether a PNG has its end, and an EXR can be read to its last row."""
    if path.suffix == '.png':
        data = path.read_bytes()
        return data[:4] == b'\x89PNG' and data[-8:-4] == b'IEND'
    return run('compare', path, path).returncode == 0


@contextlib.contextmanager
def small_disk(kib):
    """A file system of that size, or a skip."""
    folder = tempfile.mkdtemp()
    mounted = IS_ROOT and subprocess.run(
        ['mount', '-t', 'tmpfs', '-o', f'size={kib}k', 'tmpfs', folder],
        capture_output=True, check=False).returncode == 0
    try:
        if not mounted:
            raise unittest.SkipTest('a full disk needs the right to mount one')
        yield pathlib.Path(folder)
    finally:
        if mounted:
            subprocess.run(['umount', folder], check=True)
        os.rmdir(folder)


class FaultsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)

    def check_refused(self, result, code, folder, left):
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertIn('error: ', result.stderr)
        self.assertEqual({path.name: path.read_bytes() for path in folder.iterdir()}, left)

    # ---- Disks and folders ----

    def test_full_disk(self):
        """Both kinds of file, new ones and ones that were there."""
        with small_disk(256) as disk:
            (disk / 'old.exr').write_bytes(b'old')
            (disk / 'old.png').write_bytes(b'old')
            left = {'old.exr': b'old', 'old.png': b'old'}
            for name in 'new.exr', 'old.exr', 'new.png', 'old.png':
                with self.subTest(name=name):
                    result = run('render', GRID, '-o', disk / name, '--size', '1024x1024', '--spp', '1',
                                 '--compression', 'none')
                    self.check_refused(result, 74, disk, left)
                    self.assertIn('No space left on device', result.stderr)
                    self.assertIn('hint: make room', result.stderr)

    def test_disk_without_anonymous_files_or_room_for_a_name(self):
        """No inode left: the file system refuses any new file."""
        with small_disk(256) as disk:
            subprocess.run(['mount', '-o', 'remount,nr_inodes=2', disk], check=False, capture_output=True)
            (disk / 'old.png').write_bytes(b'old')
            result = run('render', FIRST, '-o', disk / 'new.png', *SMALL)
            if result.returncode == 0:
                self.skipTest('this system does not count inodes')
            self.check_refused(result, 74, disk, {'old.png': b'old'})

    def test_quota_of_a_file(self):
        limit = 20_000
        (self.out / 'old.exr').write_bytes(b'old')
        for name in 'new.exr', 'old.exr':
            result = run('render', GRID, '-o', self.out / name, '--size', '512x512', '--spp', '1',
                         '--compression', 'none', preexec_fn=lambda: resource.setrlimit(
                             resource.RLIMIT_FSIZE, (limit, limit)))
            self.check_refused(result, 74, self.out, {'old.exr': b'old'})

    def test_read_only_folder(self):
        folder = self.out / 'closed'
        folder.mkdir()
        (folder / 'old.png').write_bytes(b'old')
        folder.chmod(0o500)
        self.addCleanup(folder.chmod, 0o700)
        # Root may write anywhere by one capability. Giving up that one, and not becoming another
        # user, leaves the program readable wherever it lies, under root's home for example.
        limits = ['setpriv', '--bounding-set=-dac_override', '--inh-caps=-dac_override']
        for name in 'new.png', 'old.png':
            command = [PROGRAM, 'render', FIRST, '-o', folder / name, *SMALL]
            result = subprocess.run([*(limits if IS_ROOT else []), *map(str, command)],
                                    capture_output=True, text=True, timeout=120, check=False)
            self.check_refused(result, 74, folder, {'old.png': b'old'})
            self.assertIn('not writable', result.stderr)

    def test_outputs_that_are_devices_stay_devices(self):
        for path in ('/dev/null', '/dev/full', '/dev/stdout'):
            with self.subTest(path=path):
                link = self.out / 'a.png'
                link.unlink(missing_ok=True)
                link.symlink_to(path)
                result = run('render', FIRST, '-o', link, *SMALL)
                self.assertEqual(result.returncode, 74, result.stderr)
                self.assertIn('not a regular file', result.stderr)
                self.assertTrue(link.is_symlink())
        self.assertTrue(stat.S_ISCHR(os.stat('/dev/null').st_mode))

    def test_a_folder_that_goes_under_way(self):
        """The file is anonymous until it is whole: then its folder is not there."""
        for again in False, True:
            with self.subTest(again=again):
                folder = self.out / 'gone'
                folder.mkdir()
                process = subprocess.Popen(
                    [PROGRAM, 'render', GRID, '-o', folder / 'a.exr', '--size', '4096x4096', '--spp', '16',
                     '--progress=json'], stderr=subprocess.PIPE, text=True)
                process.stderr.readline()  # rendering has begun
                shutil.rmtree(folder)
                if again:
                    folder.mkdir()  # a new one of the same name
                text = process.communicate(timeout=120)[1]
                if again:  # the name is there again: either is right, as long as the file is whole
                    self.assertIn(process.returncode, (0, 74), text)
                    for path in folder.iterdir():
                        self.assertTrue(is_whole(path))
                    shutil.rmtree(folder)
                else:
                    self.assertEqual(process.returncode, 74, text)
                    self.assertIn('error: ', text)
                    self.assertFalse(folder.exists())

    # ---- Pipes ----

    def test_a_closed_pipe_harms_no_file(self):
        """Whoever read standard output has gone: the picture is written all the same, and 74 tells."""
        read_end, write_end = os.pipe()
        os.close(read_end)
        result = subprocess.run([PROGRAM, 'render', str(FIRST), '-o', str(self.out / 'a.png'), *SMALL,
                                 '--explain', '--stats', '-'], stdout=write_end, stderr=subprocess.PIPE,
                                timeout=120, check=False)
        os.close(write_end)
        self.assertEqual(result.returncode, 74, result.stderr)
        self.assertTrue(is_whole(self.out / 'a.png'))
        self.assertEqual(os.listdir(self.out), ['a.png'])

    def test_a_closed_pipe_for_messages_stops_nothing(self):
        read_end, write_end = os.pipe()
        os.close(read_end)
        result = subprocess.run([PROGRAM, 'render', str(FIRST), '-o', str(self.out / 'a.png'), *SMALL,
                                 '--progress=json'], stderr=write_end, timeout=120, check=False)
        os.close(write_end)
        self.assertEqual(result.returncode, 0)
        self.assertTrue(is_whole(self.out / 'a.png'))

    # ---- Signals ----

    def test_signals_at_any_time(self):
        """200 of them, from before main() to after the end. An old file is whole, old or new."""
        rng = random.Random(16)
        render = ['render', GRID, '-o', self.out / 'a.exr', '-o', self.out / 'a.png', '--size', '320x180',
                  '--spp', '1', '--quiet']
        start = time.monotonic()
        self.assertEqual(run(*render).returncode, 0)
        whole = time.monotonic() - start
        old = {name: (self.out / name).read_bytes() for name in ('a.exr', 'a.png')}
        ends = {}
        deadline = time.monotonic() + 50  # a busy machine kills fewer
        for i in range(200):
            if time.monotonic() > deadline:
                break
            number, code = rng.choice([(signal.SIGINT, 130), (signal.SIGTERM, 143)])
            process = subprocess.Popen([PROGRAM, *map(str, render)], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            time.sleep(rng.uniform(0, 1.2 * whole))
            process.send_signal(number)
            ended = process.wait(timeout=60)
            ends[ended] = ends.get(ended, 0) + 1
            # -number: before the program could say what it does with it
            self.assertIn(ended, (0, code, -number))
            self.assertEqual(sorted(os.listdir(self.out)), ['a.exr', 'a.png'])
            for name in old:
                data = (self.out / name).read_bytes()
                if data != old[name]:
                    self.assertTrue(is_whole(self.out / name), f'kill {i}: {name}')
        print(f'signals: {sum(ends.values())} kills, ended with {ends}')
        self.assertGreater(sum(ends.values()), 10)

    # ---- Memory ----

    def skip_without_limits(self):
        if run_within(4000, '--version').returncode != 0:
            self.skipTest('a sanitizer reserves more address space than any limit here')

    @unittest.skipIf(SANITIZED, 'a sanitizer brings its own')
    def test_no_thread_local_object_has_a_destructor(self):
        """glibc aborts where it has no memory to remember one: base/pool.h is used instead."""
        symbols = subprocess.run(['nm', '--dynamic', '--undefined-only', PROGRAM],
                                 capture_output=True, text=True, check=True).stdout
        self.assertIn('malloc', symbols)  # the symbols are there
        self.assertNotIn('__cxa_thread_atexit', symbols)

    def test_out_of_memory(self):
        """Address space from too little to enough: done, or 70 with words.

        What happens before main() is the loader's and the libraries': only limits count in which
        the program can say its version. Steps are fine near the least: TBB 2022 waits for ever
        where nothing is left for its first arena, a window of 2 MiB.
        """
        self.skip_without_limits()
        (self.out / 'old.png').write_bytes(b'old')
        least = next(mib for mib in range(16, 4000)
                     if run_within(mib, '--version').returncode == 0)
        seen = set()
        near = (step / 8 for step in range(32))
        for more in (*near, *range(4, 20), 40, 90, 140, 240, 340, 540, 940, 2000, 4000):
            mib = least + more
            if run_within(mib, '--version').returncode != 0:
                continue  # a library's own start takes more for a step or two: not monotonic
            result = run_within(mib, 'render', GRID, '-o', self.out / 'old.png', '--size', '2048x2048',
                                '--spp', '1', '--threads', '2')
            with self.subTest(mib=mib, text=result.stderr[-500:]):
                seen.add(result.returncode)
                self.assertIn(result.returncode, (0, 70))
                self.assertEqual(os.listdir(self.out), ['old.png'])
                if result.returncode == 70:
                    self.assertIn('error: ', result.stderr)
                    self.assertEqual((self.out / 'old.png').read_bytes(), b'old')
                else:
                    self.assertTrue(is_whole(self.out / 'old.png'))
                    (self.out / 'old.png').write_bytes(b'old')
        self.assertIn(0, seen)

    def test_out_of_memory_with_a_mesh(self):
        """Embree's device and the reader of the mesh say it in our words, not in their own."""
        self.skip_without_limits()
        mesh = SOURCE / 'scenes/mesh_and_spheres.json'
        seen = set()
        # Embree 3's tree of a scene in which TBB found no memory for a task waits for ever as it goes:
        # a window of 2 MiB and more. TBB 2022's first arena: one of less than 1 MiB.
        for mib in (*(half / 2 for half in range(128, 600)), 400, 600, 1000, 2000, 4000):
            if run_within(mib, '--version').returncode != 0:
                continue
            result = run_within(mib, 'render', mesh, '-o', self.out / 'a.png', *SMALL, '--threads', '2')
            with self.subTest(mib=mib, text=result.stderr[-500:]):
                seen.add(result.returncode)
                self.assertIn(result.returncode, (0, 65, 70))
                if result.returncode != 0:
                    self.assertRegex(result.stderr, 'error: .*(memory|pthread_create)')
                    self.assertEqual(os.listdir(self.out), [])
                else:
                    (self.out / 'a.png').unlink()
        self.assertLessEqual({0, 70}, seen)

    def test_a_scene_of_more_than_memory_is_refused(self):
        cloud = ('{"type": "cloud", "count": 100000000, "min": [0,0,0], "max": [1,1,1], "radius": 0.1, '
                 '"materials": ["a"]}')
        (self.out / 'a.json').write_text(
            '{"nacre": 1, "materials": {"a": {"model": "lambert"}}, "shapes": [%s]}'
            % ', '.join([cloud] * 1000))
        self.skip_without_limits()
        result = run_within(2000, 'info', self.out / 'a.json')
        self.assertIn(result.returncode, (65, 70), result.stderr)
        self.assertIn('error: ', result.stderr)

    # ---- Exceptions ----

    def test_an_exception_is_named_wherever_it_comes_from(self):
        """From setting the commands up, and again while that is being told."""
        if SANITIZED:
            self.skipTest('sanitizers come before any other library')
        # In the place of fmt's, which the program calls for its first option.
        library = self.out / 'failing_format.so'
        subprocess.run([COMPILER, '-std=c++20', '-shared', '-fPIC', '-x', 'c++', '-', '-o', library,
                        '-lfmt'], check=True, text=True, input='''
            #define FMT_SHARED
            #include <cstdlib>
            #include <cstring>
            #include <new>
            #include <stdexcept>
            #include <fmt/format.h>
            // The program removes others from its environment.
            static int left = std::atoi(std::getenv("NACRE_TEST_FAILURES"));
            static const char* const kind = std::getenv("NACRE_TEST_KIND");
            FMT_BEGIN_NAMESPACE
            std::string vformat(string_view format, format_args arguments) {
              if (left-- > 0) {
                if (std::strcmp(kind, "memory") == 0) throw std::bad_alloc();
                if (std::strcmp(kind, "number") == 0) throw 1;
                throw std::logic_error("set-up failed");
              }
              memory_buffer text;
              vformat_to(std::back_inserter(text), format, arguments);
              return to_string(text);
            }
            FMT_END_NAMESPACE
            ''')
        for kind, words in (('logic', 'error: internal: set-up failed\n'),
                            ('memory', 'error: out of memory\n  hint: '),
                            ('number', 'error: internal: an exception that is no std::exception\n')):
            for failures in 1, 100:
                with self.subTest(kind=kind, failures=failures):
                    result = run('render', FIRST, '-o', self.out / 'a.png', *SMALL, env=dict(
                        os.environ, LD_PRELOAD=str(library), NACRE_TEST_KIND=kind, NACRE_TEST_FAILURES=str(failures)))
                    self.assertEqual(result.returncode, 70, result.stderr)
                    self.assertTrue(result.stderr.startswith(words), result.stderr)
                    self.assertEqual(result.stderr.count('error: '), 1)
                    self.assertEqual(os.listdir(self.out), [library.name])

    # ---- Files that change while they are read ----

    def test_a_texture_cut_while_it_is_read(self):
        scene = self.out / 'scene.json'
        texture = self.out / 'texture.png'
        whole = (SOURCE / 'scenes/textures/globe.png').read_bytes()
        scene.write_text('''{"nacre": 1, "camera": {"position": [0, 0, 4], "look_at": [0, 0, 0]},
            "textures": {"t": {"file": "texture.png", "mapping": "spherical"}},
            "materials": {"a": {"model": "lambert", "albedo": 0.8, "albedo_map": "t"}},
            "lights": {"sky": {"type": "ambient", "radiance": 1}},
            "shapes": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "a"}]}''')
        texture.write_bytes(whole)
        stop = threading.Event()

        def cut():
            rng = random.Random(17)
            while not stop.is_set():
                os.truncate(texture, rng.randrange(len(whole)))
                time.sleep(rng.uniform(0, 0.01))
                with open(texture, 'r+b') as file:
                    file.write(whole)
                time.sleep(rng.uniform(0, 0.01))
        cutter = threading.Thread(target=cut)
        cutter.start()
        try:
            for _ in range(20):
                result = run('render', scene, '-o', self.out / 'a.png', *SMALL)
                self.assertIn(result.returncode, (0, 65), result.stderr)
                if result.returncode == 0:
                    self.assertTrue(is_whole(self.out / 'a.png'))
                else:
                    self.assertIn('error: ', result.stderr)
        finally:
            stop.set()
            cutter.join()


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=1)
