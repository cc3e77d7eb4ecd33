#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What files may be, and who is blamed for what is wrong with them: kinds and sizes, pipes and
devices, characters 0, broken images beside a model, a missing gnuplot.

Usage: reading_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
"""

import json
import os
import pathlib
import resource
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
SOURCE = pathlib.Path(sys.argv[2]).resolve()
SCENE = '{"nacre": 1, "image": {"width": 8, "height": 8, "spp": 1}}'
# Sanitizers map terabytes of shadow memory: of their builds only what is refused is checked.
SANITIZED = b'__asan_init' in pathlib.Path(PROGRAM).read_bytes() or \
    b'__tsan_init' in pathlib.Path(PROGRAM).read_bytes()
SECONDS = 20  # nothing here takes one; what waits for a pipe never ends


class ReadingTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)

    def run_nacre(self, *arguments, memory=None, **options):
        def bound():
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.out, capture_output=True, text=True,
                              timeout=SECONDS, check=False, preexec_fn=bound if memory and not SANITIZED else None, **options)

    def check_refused(self, result, code, *words):
        self.assertEqual(result.returncode, code, result.stderr)
        for word in words:
            self.assertIn(word, result.stdout + result.stderr)

    def sparse(self, name, beginning, size):
        with open(self.out / name, 'wb') as file:
            file.write(beginning)
            file.truncate(size)
        return name

    def test_pipes_and_devices_are_refused_at_once_by_every_command(self):
        for name in 'pipe.json', 'pipe.gltf', 'pipe.obj', 'pipe.ply', 'pipe.png':
            os.mkfifo(self.out / name)
        (self.out / 'a').mkdir()
        (self.out / 'a/s.json').write_text(SCENE)
        os.mkfifo(self.out / 'a/pipe.json')
        small = ['--size', '16x16', '--spp', '1', '-o', 'x.png']
        commands = [(['render', name, *small], 65) for name in
                    ('pipe.json', 'pipe.gltf', 'pipe.obj', 'pipe.ply', 'pipe.png', '/dev/zero')]
        commands += [(['info', name], 65) for name in ('pipe.json', 'pipe.png', 'pipe.gltf')]
        commands += [(['grid', '--lights', name, *small], 65) for name in ('pipe.json', '/dev/zero')]
        commands += [(['plot', 'brdf', '--scene', 'pipe.json', '-o', 'x.csv'], 65), (['tonemap', 'pipe.png', '-o', 'x.png'], 65),
                     (['report', 'x.html', 'pipe.json'], 65), (['compare', 'pipe.png', 'pipe.png'], 2),
                     (['table', 'lambert', '--check', 'pipe.json'], 2), (['table', 'lambert', '--check', '/dev/zero'], 2),
                     (['table', 'lambert', '--directions', 'pipe.json', '-o', 'x.csv'], 65),
                     (['table', 'a', '--scene', 'pipe.json', '-o', 'x.csv'], 65)]
        for command, code in commands:
            with self.subTest(command=command):
                self.check_refused(self.run_nacre(*command), code, 'is not a regular file')
        for member in 'scene', 'image':
            for name in 'pipe.json', 'zero':
                with self.subTest(member=member, name=name):
                    if name == 'zero' and not (self.out / 'a/zero').is_symlink():
                        (self.out / 'a/zero').symlink_to('/dev/zero')
                    reference = {'scene': 's.json', 'image': 's.exr', 'tolerances': {}, 'reason': 'none', member: name}
                    (self.out / 'a/x.reference.json').write_text(json.dumps(reference))
                    self.check_refused(self.run_nacre('validate', 'a', '--allow-paths' if self.takes_paths() else '--threads=1'),
                                       2, 'is not a regular file')

    def test_what_other_readers_want_is_refused_at_once_too(self):
        os.mkfifo(self.out / 'pipe.png')
        os.mkfifo(self.out / 'pipe.exr')
        small = ['--size', '16x16', '--spp', '1', '-o', 'x.png']
        for command in (['merge', 'pipe.exr', '-o', 'x.exr'], ['info', '--verify', 'pipe.exr'], ['info', '--verify', 'pipe.png'],
                        ['grid', '--environment', 'pipe.png', *small], ['report', 'x.html', 'pipe.png']):
            with self.subTest(command=command):
                self.check_refused(self.run_nacre(*command), 65, 'is not a regular file')

    def test_files_of_the_kernel_that_say_they_are_empty_are_not_waited_for(self):
        """/proc/kmsg is a regular file, and whoever reads it waits for the kernel's next message."""
        for command, code in ((['compare', '/proc/kmsg', '/proc/kmsg'], 2), (['info', '/proc/kmsg'], 65),
                              (['tonemap', '/proc/kmsg', '-o', 'x.png'], 65), (['merge', '/proc/kmsg', '-o', 'x.exr'], 65),
                              (['info', '--verify', '/proc/kmsg'], 65), (['report', 'x.html', '/proc/kmsg'], 65)):
            with self.subTest(command=command):
                self.check_refused(self.run_nacre(*command), code, 'is empty')

    def test_a_pointer_of_git_lfs_is_named_as_what_it_is(self):
        """What a clone without git-lfs has in the place of a large file, by every reader."""
        pointer = 'version https://git-lfs.github.com/spec/v1\noid sha256:' + '0' * 64 + '\nsize 27700317\n'
        names = ['m.gltf', 'm.glb', 'm.obj', 'm.ply', 's.json', 'i.png', 'i.jpg', 'i.hdr', 'i.exr', 'i.tif', 'i.tga', 'i.pfm',
                 's.npy', 's.csv', 'b.bin', 'm.mtl']
        for name in names:
            (self.out / name).write_text(pointer)
        said = 'is a pointer of git-lfs'
        small = ['--size', '16x16', '--spp', '1', '-o', 'x.png']
        for name in names[:5]:
            self.check_refused(self.run_nacre('render', name, *small), 65, said, 'git lfs pull')
        for name in names[5:12]:
            self.check_refused(self.run_nacre('info', name), 65, said)
            self.check_refused(self.run_nacre('compare', name, name), 2, said)
            self.check_refused(self.run_nacre('tonemap', name, '-o', 'x.png'), 65, said)
            self.check_refused(self.run_nacre('grid', '--environment', name, *small), 65, said)
            scene = json.loads(SCENE)
            scene['textures'] = {'t': {'file': name}}
            scene['shapes'] = [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1,
                                'material': {'model': 'lambert', 'albedo': 1, 'albedo_map': 't'}}]
            (self.out / 't.json').write_text(json.dumps(scene))
            self.check_refused(self.run_nacre('render', 't.json', *small), 65, said)
        self.check_refused(self.run_nacre('merge', 'i.exr', '-o', 'x.exr'), 65, said)
        for name in 's.npy', 's.csv', 's.json':
            self.check_refused(self.run_nacre('table', 'lambert', '--check', name), 2, said)
        for name in 's.npy', 's.csv', 'm.ply':
            scene = dict(json.loads(SCENE), shapes=[{'type': 'spheres', 'file': name, 'material': {'model': 'lambert', 'albedo': 1}}])
            (self.out / 't.json').write_text(json.dumps(scene))
            self.check_refused(self.run_nacre('render', 't.json', *small), 65, said)
        (self.out / 'b.gltf').write_text(json.dumps({'asset': {'version': '2.0'}, 'buffers': [{'uri': 'b.bin', 'byteLength': 99}]}))
        self.check_refused(self.run_nacre('render', 'b.gltf', *small), 65, said)
        (self.out / 'o.obj').write_text('mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n')
        self.check_refused(self.run_nacre('render', 'o.obj', *small), 65, said)

    def takes_paths(self):
        return '--allow-paths' in self.run_nacre('validate', '--help-all').stdout

    def test_files_too_large_are_refused_by_their_size(self):
        gib = 1 << 30
        binary = b'glTF' + struct.pack('<IIII', 2, 300, 280, 0x4e4f534a) + b'{}'
        for name, beginning, size, words in (
                ('s.json', b'{}', gib + 1, 'longer than 1 GiB'), ('m.obj', b'v', 4 * gib + 1, 'longer than 4 GiB'),
                ('n.obj', b'v 0 0 0\n\0', 3 * gib, 'n.obj:2: is not text'), ('p.ply', b'plx\n', 3 * gib, 'is not a PLY file'),
                ('t.gltf', b'{\n\n\0', 3 * gib, 't.gltf:3: is not text'), ('b.glb', binary, 2 * gib, 'has no "asset"'),
                ('c.glb', binary.replace(b'JSON', b'JSOM'), 2 * gib, 'its first chunk is not JSON'),
                ('d.glb', binary[:8] + struct.pack('<I', 0xfffffff0) + binary[12:], 2 * gib, 'says that it has'),
                ('e.glb', binary[:4] + struct.pack('<I', 1) + binary[8:], 2 * gib, 'is glTF 1')):
            with self.subTest(name=name):
                self.sparse(name, beginning, size)
                # The program, its libraries and the stacks of its threads; not half of the file.
                self.check_refused(self.run_nacre('info', name, memory=gib), 65, words)
                os.remove(self.out / name)

    def test_files_behind_a_character_zero(self):
        (self.out / 's.json').write_bytes(SCENE.encode() + b'\n\0{"image": 1}')
        self.check_refused(self.run_nacre('info', 's.json'), 65, 's.json:2: is not text: there is a character 0')
        for encoding in 'utf-16-le', 'utf-16-be', 'utf-32-le', 'utf-32-be', 'utf-16', 'utf-32':
            for name, text in ('s.json', SCENE), ('s.gltf', '{"asset": {"version": "2.0"}}'), ('s.obj', 'v 0 0 0\n'), ('s.ply', 'ply\n'):
                with self.subTest(encoding=encoding, name=name):
                    (self.out / name).write_bytes(text.encode(encoding))
                    self.check_refused(self.run_nacre('info', name), 65, 'is text in UTF-16 or UTF-32')

    def test_the_file_is_blamed_for_what_no_override_can_mend(self):
        for text, words in (('[]', 'not a scene'), ('null', 'not a scene'), ('3', 'not a scene'),
                            ('{"nacre": 1, "image": []}', 's.json: /image: expected an object'),
                            ('{"nacre": 1, "image": "large"}', 's.json: /image: expected an object')):
            with self.subTest(text=text):
                (self.out / 's.json').write_text(text)
                self.check_refused(self.run_nacre('render', 's.json', '-o', 'x.png', '--size', '16x16'), 65, words)
        (self.out / 's.json').write_text(SCENE)
        for override in '/image/width/a=1', '/image=[]':
            result = self.run_nacre('render', 's.json', '-o', 'x.png', '--set', override, '--set', '/image/height/b=2')
            self.check_refused(result, 64, 'error: /image/')

    def test_a_name_with_a_line_end_hides_nothing(self):
        scene = json.loads(SCENE)
        for name, shown in ('a\nb', r'/materials/a\nb/base_color: expected'), ('x' * 500, 'xxx.../base_color: expected'), \
                ('', '/materials//base_color: expected'):
            with self.subTest(name=name):
                scene['materials'] = {name: {'model': 'metallic_roughness', 'base_color': 'red'}}
                (self.out / 's.json').write_text(json.dumps(scene))
                self.check_refused(self.run_nacre('info', 's.json'), 65, shown)
        del scene['materials']
        scene['lights'] = {'': {'type': 'ambient', 'radiance': 1}}
        (self.out / 's.json').write_text(json.dumps(scene))
        self.check_refused(self.run_nacre('info', 's.json'), 65, 's.json: /lights/: the name cannot')

    def test_an_image_that_cannot_be_read_is_left_out_of_a_model(self):
        (self.out / 'm.obj').write_text('mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n')
        (self.out / 't.bmp').write_bytes(b'BM' + bytes(60))
        (self.out / 'cut.png').write_bytes((SOURCE / 'scenes/gallery/metals.png').read_bytes()[:3000])
        for image, line in ('t.bmp', 'map_Kd'), ('cut.png', 'map_Kd'), ('cut.png', 'map_Pr'), ('t.bmp', 'norm'):
            with self.subTest(image=image, line=line):
                (self.out / 'm.mtl').write_text(f'newmtl a\nKd 1 0 0\n{line} {image}\nnewmtl b\n{line} {image}\n')
                result = self.run_nacre('render', 'm.obj', '-o', 'x.png', '--size', '16x16', '--spp', '1')
                self.check_refused(result, 0, 'an image is left out: ', f'm.mtl:3: "{image}": ')
                self.assertEqual(result.stderr.count('warning:'), 1, result.stderr)

    def test_materials_of_materialx_documents(self):
        document = SOURCE / 'scenes/materials.mtlx'
        small = ['--rows', 'opacity=1', '--columns', 'emission=0', '--size', '64x64', '--spp', '1']
        for name in 'brass', 'wood', 'enamel':
            result = self.run_nacre('grid', '--material', f'{document}#{name}', *small, '-o', f'{name}.png')
            self.assertEqual((result.returncode, 'warning' in result.stderr), (0, False), result.stderr)
        for words in (['table', f'{document}#brass', '--no-albedo'], ['convert', f'{document}#enamel', '--to', 'phong'],
                      ['grid', '--rows', f'material={document}#brass,{document}#enamel', '--columns',
                       'opacity=1', '--size', '64x64', '--spp', '1', '-o', 'both.png'],
                      ['pair', '--a', f'{document}#brass', '--b', 'phong', '--size', '64x64', '-o', 'pair.png']):
            result = self.run_nacre(*words)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.check_refused(self.run_nacre('grid', '--material', document, '-o', 'a.png'), 65,
                           'has 3 materials, of which none is named', 'brass, wood, enamel')
        self.check_refused(self.run_nacre('render', document, '-o', 'a.png'), 65,
                           'is a MaterialX document, which has materials and no shapes')
        # What a document leaves out is told once, and its images must be in its folder.
        (self.out / 'sub').mkdir()
        (self.out / 'image.png').write_bytes((SOURCE / 'scenes/textures/wood.png').read_bytes())
        (self.out / 'sub/a.mtlx').write_text(
            '<materialx version="1.39"><image name="i" type="color3"><input name="file" type="filename" '
            'value="../image.png"/></image><gltf_pbr name="s" type="surfaceshader"><input name="base_color" '
            'type="color3" nodename="i"/><input name="transmission" type="float" value="1"/></gltf_pbr></materialx>')
        grid = ['grid', '--material', 'sub/a.mtlx', *small, '-o', 'a.png']
        self.check_refused(self.run_nacre(*grid), 65, 'sub', '"../image.png" is outside')
        result = self.run_nacre(*grid, '--allow-paths')
        self.assertEqual((result.returncode, result.stderr.count('warning: ')), (0, 1), result.stderr)
        self.assertIn('warning: sub/a.mtlx:1: s: transmission: 1: transmission is not rendered', result.stderr)

    def test_a_plot_without_gnuplot(self):
        result = self.run_nacre('plot', 'fresnel', '-o', 'f.svg', env={'PATH': str(self.out)})
        self.check_refused(result, 74, 'gnuplot is missing', 'install the package gnuplot-nox')
        self.assertFalse((self.out / 'f.svg').exists())
        self.assertEqual(self.run_nacre('plot', 'fresnel', '-o', 'f.csv', env={'PATH': str(self.out)}).returncode, 0)


if __name__ == '__main__':
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
