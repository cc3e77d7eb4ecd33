#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""nacre render --watch: what changes on disk is rendered again, and nothing else happens.

Usage: watch_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
"""
import json
import os
import pathlib
import queue
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SMALL = ['--size', '48x32', '--spp', '1', '--reproducible']
SECONDS = 60  # nothing here takes one; busy machines and sanitizers are slower


def scene(**members):
    return {'nacre': 1, 'camera': {'position': [0, 0, 6], 'look_at': [0, 0, 0], 'fov_y_deg': 30},
            'materials': {'red': {'model': 'lambert', 'albedo': [0.8, 0.1, 0.1]}},
            'lights': {'key': {'type': 'directional', 'direction_of_travel': [-1, -1, -1], 'irradiance': 3}},
            'shapes': [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'red'}], **members}


class Watch:
    """The program, and what it says line by line."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen([PROGRAM, 'render', *map(str, arguments), '--watch'],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.lines = queue.Queue()
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        for line in self.process.stderr:
            self.lines.put(line.rstrip('\n'))

    def next(self):
        return self.lines.get(timeout=SECONDS)

    def until(self, *words):
        """The next line with one of the words, and those before it."""
        seen = []
        while True:
            seen.append(self.next())
            if any(word in seen[-1] for word in words):
                return seen

    def picture(self):
        """Waits for the next picture; nothing else may be said before it."""
        seen = self.until(': 48x32, ', 'error: ')
        assert len(seen) == 1 and 'error: ' not in seen[0], seen

    def end(self, number=signal.SIGINT):
        """Seconds from the signal to the end, the exit code, and what was still said."""
        start = time.monotonic()
        self.process.send_signal(number)
        code = self.process.wait(timeout=SECONDS)
        took = time.monotonic() - start
        self.reader.join(SECONDS)
        self.process.stdout.close()
        self.process.stderr.close()
        rest = []
        while not self.lines.empty():
            rest.append(self.lines.get())
        return took, code, rest


class WatchTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)
        self.file = self.out / 's.json'
        self.png = self.out / 'a.png'

    def write(self, **members):
        self.file.write_text(json.dumps(scene(**members)))

    def watch(self, *arguments, file=None):
        started = Watch(file or self.file, '-o', self.png, *SMALL, *arguments)
        self.addCleanup(lambda: started.process.poll() is None and started.process.kill())
        started.picture()
        self.assertIn('watching', started.next())
        return started

    def check_picture(self, *arguments, file=None):
        """The picture is that of a process of its own."""
        fresh = self.out / 'fresh.png'
        result = subprocess.run([PROGRAM, 'render', file or self.file, '-o', fresh, '--quiet', *SMALL, *arguments],
                                capture_output=True, text=True, timeout=SECONDS, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.png.read_bytes(), fresh.read_bytes())

    def check_ends(self, watch):
        self.assertEqual(watch.end()[1:], (130, []))

    def test_renders_again_what_is_saved(self):
        self.write()
        options = ['--set', '/image/seed=5']
        watch = self.watch(*options)
        first = self.png.read_bytes()
        for members in ({'background': [0.1, 0.2, 0.3]},
                        {'materials': {'red': {'model': 'modified_phong', 'shininess': 30, 'kd': 0.5, 'ks': 0.3}}},
                        {'camera': {'position': [1, 2, 6], 'look_at': [0, 0, 0]}},
                        {'lights': {'sky': {'type': 'ambient', 'radiance': 0.5}}},
                        {'shapes': [{'type': 'icosphere', 'center': [0, 0, 0], 'radius': 1, 'subdivisions': 1,
                                     'material': 'red'}]},
                        {}):
            with self.subTest(members=members):
                self.write(**members)
                watch.picture()
                self.check_picture(*options)
        self.assertEqual(self.png.read_bytes(), first)
        self.check_ends(watch)

    def test_files_that_are_replaced_by_renaming(self):
        self.write()
        watch = self.watch()
        for albedo in 0.2, 0.7:
            new = self.out / 's.json.tmp'
            new.write_text(json.dumps(scene(materials={'red': {'model': 'lambert', 'albedo': albedo}})))
            # Times and size may be those of the old one.
            os.utime(new, ns=(self.file.stat().st_atime_ns, self.file.stat().st_mtime_ns))
            new.rename(self.file)
            watch.picture()
            self.check_picture()
        # The old one is moved away first, and the new one appears later.
        self.file.rename(self.out / 's.json~')
        time.sleep(0.03)
        self.write(background=[0, 1, 0])
        watch.picture()
        self.check_picture()
        self.check_ends(watch)

    def test_a_file_that_is_written_slowly_is_read_when_it_is_whole(self):
        self.write()
        watch = self.watch()
        text = json.dumps(scene(background=[0, 0, 1]))
        with open(self.file, 'w', encoding='utf-8') as file:
            for i in range(0, len(text), len(text) // 12):
                file.write(text[i:i + len(text) // 12])
                file.flush()
                time.sleep(0.02)
        # On a busy machine it may have looked complete: then there is an error, and the picture follows.
        watch.until(': 48x32, ')
        self.check_picture()
        self.check_ends(watch)

    def test_an_error_is_one_line_and_the_picture_stays(self):
        self.write()
        watch = self.watch()
        good = self.png.read_bytes()
        for text, words in (('{"nacre": 1,', 's.json'),
                            (json.dumps(scene(materials={'red': {'model': 'lambert', 'albdo': 1}})),
                             'unknown key "albdo" (did you mean "albedo"?)'),
                            (json.dumps(scene(background=[9, -1, 0], camera={'position': 1})), ', and '),
                            (json.dumps(scene(textures={'t': {'file': 'no.png'}})), 'no.png')):
            with self.subTest(words=words):
                self.file.write_text(text)
                line = watch.next()
                self.assertIn('error: ', line)
                self.assertIn(words, line)
                time.sleep(0.3)
                self.assertTrue(watch.lines.empty())
                self.assertEqual(self.png.read_bytes(), good)
        # The texture that was missing comes.
        shutil.copy(SOURCE / 'scenes/textures/tiles.png', self.out / 'no.png')
        watch.picture()
        self.check_picture()
        self.file.unlink()
        self.assertIn('error: ', watch.next())
        self.write()
        watch.picture()
        self.assertEqual(self.png.read_bytes(), good)
        self.check_ends(watch)

    def test_textures_and_environments(self):
        for name in 'tiles.png', 'evening.exr':
            shutil.copy(SOURCE / 'scenes/textures' / name, self.out / name)
        self.write(textures={'t': {'file': 'tiles.png'}},
                   materials={'red': {'model': 'metallic_roughness', 'base_color_map': 't'}},
                   lights={'sky': {'type': 'environment', 'image': 'evening.exr'}})
        watch = self.watch()
        shutil.copy(SOURCE / 'scenes/textures/waves.png', self.out / 'tiles.png')
        watch.picture()
        self.check_picture()
        subprocess.run([PROGRAM, 'render', SOURCE / 'scenes/first_scene.json', '-o', self.out / 'evening.exr',
                        '--size', '64x32', '--spp', '1', '--quiet'], check=True, timeout=SECONDS)
        watch.picture()
        self.check_picture()
        self.check_ends(watch)

    def test_links_that_are_pointed_elsewhere(self):
        """To files, to folders, of scenes, models and environments."""
        def point(link, target):
            new = self.out / 'new'
            new.symlink_to(target)
            new.rename(self.out / link)

        for number, texture in ((1, 'tiles'), (2, 'waves')):
            version = self.out / f'v{number}'
            version.mkdir()
            shutil.copy(SOURCE / f'scenes/textures/{texture}.png', version / 'a.png')
            subprocess.run([PROGRAM, 'render', SOURCE / 'scenes/first_scene.json', '-o', version / 'sky.exr', '--size', '64x32',
                            '--spp', str(number), '--quiet'], check=True, timeout=SECONDS)
            (version / 'm.mtl').write_text(f'newmtl a\nKd 0 {number / 4} 1\n')
        (self.out / 'm.obj').write_text('mtllib now/m.mtl\nusemtl a\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n')
        self.write(textures={'t': {'file': 'now/a.png'}}, materials={'red': {'model': 'lambert', 'albedo_map': 't'}})
        for link, targets, file, options in (
                ('now', ('v1', 'v2'), self.file, []), ('now', ('v1', 'v2'), self.out / 'm.obj', []),
                ('sky.exr', ('v1/sky.exr', 'v2/sky.exr'), self.file, ['--environment', self.out / 'sky.exr']),
                ('s2.json', ('s.json', 'other.json'), self.out / 's2.json', [])):
            with self.subTest(link=link, file=file.name):
                (self.out / 'other.json').write_text(json.dumps(scene(background=1)))
                for other in {'now', 'sky.exr'} - {link}:
                    (self.out / other).unlink(missing_ok=True)
                    (self.out / other).symlink_to('v1' if other == 'now' else 'v1/sky.exr')
                (self.out / link).unlink(missing_ok=True)
                (self.out / link).symlink_to(targets[0])
                watch = self.watch(*options, file=file)
                before = self.png.read_bytes()
                point(link, targets[1])
                watch.picture()
                self.check_picture(*options, file=file)
                self.assertNotEqual(self.png.read_bytes(), before)
                self.check_ends(watch)

    def test_meshes_of_scenes(self):
        shutil.copy(SOURCE / 'scenes/meshes/torus_knot.obj', self.out / 'm.obj')
        self.write(shapes=[{'type': 'mesh', 'file': 'm.obj', 'material': 'red'}])
        watch = self.watch()
        # Another colour of the same mesh, then another mesh.
        self.write(shapes=[{'type': 'mesh', 'file': 'm.obj', 'material': 'red'}],
                   materials={'red': {'model': 'lambert', 'albedo': 0.3}})
        watch.picture()
        self.check_picture()
        (self.out / 'm.obj').write_text('v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n')
        watch.picture()
        self.check_picture()
        self.check_ends(watch)

    def test_models_with_their_materials(self):
        obj, mtl = self.out / 'm.obj', self.out / 'm.mtl'
        obj.write_text('mtllib m.mtl\nusemtl a\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n')
        mtl.write_text('newmtl a\nKd 1 0 0\n')
        watch = self.watch(file=obj)
        mtl.write_text('newmtl a\nKd 0 0 1\n')
        watch.picture()
        self.check_picture(file=obj)
        obj.write_text('mtllib m.mtl\nusemtl a\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 x\n')
        self.assertIn('error: ', watch.next())
        obj.write_text('mtllib m.mtl\nusemtl a\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n')
        watch.picture()
        self.check_picture(file=obj)
        self.check_ends(watch)

    def test_signals_end_it_at_once(self):
        self.write()
        for number, code in (signal.SIGINT, 130), (signal.SIGTERM, 143):
            watch = self.watch()
            took, ended, rest = watch.end(number)
            self.assertEqual((ended, rest), (code, []))
            self.assertLess(took, 2)
        # While it renders, too: this would take hours.
        self.write(image={'width': 48, 'height': 32, 'spp': 1})
        watch = Watch(self.file, '-o', self.png)
        self.addCleanup(lambda: watch.process.poll() is None and watch.process.kill())
        watch.until('watching')
        old = self.png.read_bytes()
        self.write(image={'width': 4096, 'height': 4096, 'spp': 65536})
        time.sleep(1)
        took, code, rest = watch.end()
        self.assertEqual((code, rest), (130, []))
        self.assertLess(took, 2)
        self.assertEqual(self.png.read_bytes(), old)
        self.assertEqual(sorted(path.name for path in self.out.iterdir()), ['a.png', 's.json'])

    def test_a_change_ends_the_render_of_what_was_before(self):
        self.write(image={'width': 48, 'height': 32, 'spp': 1})
        watch = Watch(self.file, '-o', self.png)
        self.addCleanup(lambda: watch.process.poll() is None and watch.process.kill())
        watch.until('watching')
        self.write(image={'width': 4096, 'height': 4096, 'spp': 65536})
        time.sleep(1)
        self.write(image={'width': 48, 'height': 32, 'spp': 2})
        watch.picture()
        self.check_ends(watch)

    def test_what_is_wrong_from_the_start_ends_it(self):
        self.file.write_text('{')
        for arguments, code in (([], 65), (['--dry-run'], 64), (['--preset', 'textbook'], 64), (['--layers', 'no'], 65)):
            result = subprocess.run([PROGRAM, 'render', self.file, '-o', self.png, '--watch', *arguments],
                                    capture_output=True, text=True, timeout=SECONDS, check=False)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertIn('error: ', result.stderr)

    def test_what_is_printed_comes_with_each_picture(self):
        self.write()
        process = subprocess.Popen([PROGRAM, 'render', self.file, '-o', 'null:', '--stats', '-', '--quiet', '--watch',
                                    *SMALL], stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        decoder, text, seen = json.JSONDecoder(), '', 0
        while seen < 2:
            text += process.stdout.readline()
            try:
                _, end = decoder.raw_decode(text)
            except ValueError:
                continue
            text, seen = text[end:].lstrip(), seen + 1
            self.write(background=[0, 0, 1])
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=SECONDS), 143)
        process.stdout.close()


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=1)
