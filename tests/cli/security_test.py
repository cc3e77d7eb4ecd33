#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a stranger's files and folders can do to whoever runs nacre in them: nothing.

Usage: security_test.py PROGRAM SOURCE_FOLDER COMPILER [UNITTEST-ARGUMENTS...]
"""
import json
import os
import pathlib
import re
import shutil
import signal
import stat
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.dom.minidom

PROGRAM = os.path.abspath(sys.argv[1])
SOURCE = pathlib.Path(sys.argv[2]).resolve()
COMPILER = sys.argv[3]
BUILD = pathlib.Path(PROGRAM).parent
FIRST = SOURCE / 'scenes/first_scene.json'
SMALL = ['--size', '32x18', '--spp', '1']
IS_ROOT = os.geteuid() == 0
# What a terminal obeys: controls but for line feeds, and what reorders text. Of bytes that are not
# UTF-8 all those from 0x80 on.
ACTING = re.compile('[\x00-\x09\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\udc80-\udcff]')
EVIL = 'x\x1b[2J\x1b]0;owned\x07\x9b31m\u202egnp\x7f\nerror: forged\r  hint: rm -rf ~'


def run(*arguments, program=PROGRAM, **options):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, timeout=120,
                          check=False, **options)


def text_of(data):
    return data.decode('utf-8', 'surrogateescape')


class SecurityTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)

    def check_refused(self, result, code, *words):
        self.assertEqual(result.returncode, code, result.stderr)
        for word in words:
            self.assertIn(word, text_of(result.stderr))


class PlantedCodeTest(SecurityTest):
    """Whatever lies in the working folder, or where relative paths lead, is not run."""

    @classmethod
    def setUpClass(cls):
        cls.traps = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.traps.cleanup)
        cls.trap = pathlib.Path(cls.traps.name) / 'trap.so'
        # What the process was started with: the program removes what it does not know.
        source = ('#include <fstream>\n#include <string>\n'
                  'static struct Trap { Trap() { std::ifstream all("/proc/self/environ"); '
                  'for (std::string v; std::getline(all, v, char()); ) '
                  'if (v.rfind("TRAP=", 0) == 0) std::ofstream(v.substr(5)); } } trap;\n')
        subprocess.run([COMPILER, '-shared', '-fPIC', '-x', 'c++', '-', '-o', cls.trap],
                       input=source, text=True, check=True)

    def setUp(self):
        super().setUp()
        self.sprung = self.out / 'sprung'
        self.folder = self.out / 'work'
        self.folder.mkdir()
        self.env = dict(os.environ, TRAP=str(self.sprung))

    def plant(self, *folders):
        for folder in folders:
            path = self.folder / folder
            path.mkdir(parents=True, exist_ok=True)
            shutil.copy(self.trap, path / 'nacre_oiio.so')
            for name in 'libOpenImageIO.so.2.4', 'trap.imageio.so', 'libtbbmalloc.so.2':
                shutil.copy(self.trap, path / name)

    PLACES = ('.', 'nacre', 'lib/nacre', 'lib/x86_64-linux-gnu/nacre', '../lib/nacre', '..',
              '../lib/x86_64-linux-gnu/nacre', 'bin', 'build', 'plugins', 'usr/lib/nacre',
              'home', 'home/.local/lib/nacre', 'home/nacre')

    def check_not_sprung(self, result, code=0):
        self.assertFalse(self.sprung.exists(), 'planted code ran')
        self.assertEqual(result.returncode, code, result.stderr)

    def test_the_trap_springs(self):
        # A program with the address sanitizer asks to come before all that is preloaded.
        options = os.environ.get('ASAN_OPTIONS', '') + ':verify_asan_link_order=0'
        run('info', env=dict(self.env, LD_PRELOAD=str(self.trap), ASAN_OPTIONS=options))
        self.assertTrue(self.sprung.exists())

    def test_no_variable_of_a_library_names_code(self):
        """OpenImageIO, oneTBB, libheif, OpenSSL, glibc, ... load what these name: plug-ins of a folder, or a file."""
        plugins = self.folder / 'plugins'
        plugins.mkdir()
        for name in 'trap.imageio.so', 'libtrap.so', 'heif_trap.so', 'libopencv_core_parallel_tbb.so', 'UTF-16.so':
            shutil.copy(self.trap, plugins / name)
        (plugins / 'gconv-modules').write_text('module UTF-8// INTERNAL UTF-16 1\nmodule INTERNAL UTF-8// UTF-16 1\n')
        conf = plugins / 'openssl.cnf'
        conf.write_text('openssl_conf = a\n[a]\nproviders = b\n[b]\nc = d\n[d]\nactivate = 1\n'
                        f'module = {plugins}/libtrap.so\n')
        folders = ('OIIO_LIBRARY_PATH', 'LD_LIBRARY_PATH', 'LIBHEIF_PLUGIN_PATH', 'GCONV_PATH', 'OPENCV_CORE_PLUGIN_PATH',
                   'GIO_EXTRA_MODULES', 'GIO_MODULE_DIR', 'OPENSSL_MODULES', 'OPENSSL_ENGINES', 'GDAL_DRIVER_PATH',
                   'HDF5_PLUGIN_PATH', 'GST_PLUGIN_PATH', 'LIBVA_DRIVERS_PATH', 'QT_PLUGIN_PATH', 'GNUPLOT_LIB')
        files = 'INTEL_LIBITTNOTIFY64', 'KMP_LIBRARY', 'GTK_MODULES', 'OCL_ICD_FILENAMES'
        shutil.copy(SOURCE / 'tests/fuzz/corpus/texture_image/a.tif', self.folder / 'a.tif')
        everything = {**{name: str(plugins) for name in folders}, **{name: str(self.trap) for name in files},
                      'OPENSSL_CONF': str(conf)}
        for variables in ({'OIIO_LIBRARY_PATH': str(plugins)}, {'INTEL_LIBITTNOTIFY64': str(self.trap)}, everything):
            for command in (['info', 'a.tif'], ['compare', 'a.tif', 'a.tif'],
                            ['grid', '-o', 'g.png', '--sphere-size', '8', '--rows', 'roughness=0.1,1',
                             '--columns', 'metallic=0,1', '--spp', '1'],
                            ['plot', 'fresnel', '-o', 'f.svg']):
                with self.subTest(variables=list(variables), command=command):
                    self.check_not_sprung(run(*command, cwd=self.folder, env=dict(self.env, **variables)))

    def test_the_module_is_not_taken_from_the_working_folder(self):
        self.plant(*self.PLACES)
        (self.folder / 'link').symlink_to(PROGRAM)
        (self.folder / 'bin/nacre_link').symlink_to(PROGRAM)
        env = dict(self.env, HOME=str(self.folder / 'home'), XDG_DATA_HOME='home',
                   XDG_CONFIG_HOME='', OIIO_LIBRARY_PATH='', PYTHONPATH='')
        grid = ['grid', '-o', 'g.png', '--sphere-size', '8', '--labels', '--rows', 'roughness=0.1,1',
                '--columns', 'metallic=0,1', '--spp', '1']
        shutil.copy(SOURCE / 'tests/fuzz/corpus/texture_image/a.tif', self.folder / 'a.tif')
        for argv0 in 'nacre', './nacre', 'bin/nacre', '../work/nacre', '', '/nacre', 'link':
            with self.subTest(argv0=argv0):
                result = subprocess.run([argv0, *grid], executable=PROGRAM, cwd=self.folder, env=env,
                                        capture_output=True, check=False)
                self.check_not_sprung(result)
        for program in './link', 'bin/nacre_link', '../work/link':
            with self.subTest(program=program):
                self.check_not_sprung(run(*grid, program=program, cwd=self.folder, env=env))
        for path in f'{BUILD}:/usr/bin', f':{BUILD}', f'.:bin:{BUILD}:':
            with self.subTest(path=path):
                env['PATH'] = path
                result = subprocess.run(['sh', '-c', 'exec nacre "$@"', 'sh', *grid], cwd=self.folder,
                                        env=env, capture_output=True, check=False,
                                        executable='/bin/sh')
                self.check_not_sprung(result)
        for verb in (['info', 'a.tif'], ['compare', 'a.tif', 'a.tif'], ['tonemap', 'a.tif', '-o', 'b.png'],
                     ['report', 'r.html', 'a.tif']):
            with self.subTest(verb=verb):
                result = subprocess.run(['nacre', *verb], executable=PROGRAM, cwd=self.folder, env=env,
                                        capture_output=True, check=False)
                self.check_not_sprung(result)  # the file has floats: tonemap takes it

    def test_a_program_without_its_module_takes_no_other(self):
        """A copy of the program alone: neither its parent folder's nor the caller's will do. (lib/ beside
        the folder that it is in is where it would be installed.)"""
        self.plant(*(place for place in self.PLACES if not place.startswith('lib/')))
        alone = self.folder / 'alone'
        alone.mkdir()
        shutil.copy(PROGRAM, alone / 'nacre')
        for cwd in self.folder, alone:
            for argv0 in 'nacre', 'alone/nacre':
                # TIFF files are what the module is for.
                result = subprocess.run([argv0, 'info', SOURCE / 'tests/fuzz/corpus/texture_image/a.tif'],
                                        executable=alone / 'nacre', cwd=cwd, env=self.env,
                                        capture_output=True, check=False)
                self.check_not_sprung(result, 65)
                self.assertIn(b'nacre_oiio.so is neither beside', result.stderr)

    def test_the_library_takes_its_own_module(self):
        """A program of somebody else's, called by a bare name, with the library by a relative path."""
        self.plant(*self.PLACES)
        source = self.out / 'user.cc'
        source.write_text('#include "nacre.h"\n#include <cstdio>\nint main(int, char** v) {\n'
                          '  try { return nacre::Read(v[1]).width() > 0 ? 0 : 1; }\n'
                          '  catch (const nacre::Error& e) { std::puts(e.what()); return 70; } }\n')
        user = self.folder / 'bin/nacre'
        link = os.path.relpath(BUILD, self.folder)
        built = subprocess.run([COMPILER, '-std=c++17', *os.environ.get('CXXFLAGS', '').split(), source,
                                '-I', SOURCE / 'src', BUILD / 'libnacre.so', f'-Wl,-rpath,{link}', '-o',
                                user], capture_output=True, text=True, check=False)
        self.assertEqual(built.returncode, 0, built.stderr)
        result = subprocess.run(['nacre', SOURCE / 'scenes/textures/tiles.png'], executable=user,
                                cwd=self.folder, env=self.env, capture_output=True, check=False)
        self.check_not_sprung(result)

    def test_nothing_built_looks_for_libraries_in_relative_folders(self):
        for name in 'nacre', 'libnacre.so', 'nacre_oiio.so':
            dynamic = subprocess.run(['readelf', '-d', BUILD / name], capture_output=True, text=True,
                                     check=True).stdout
            for paths in re.findall(r'\((?:RPATH|RUNPATH)\).*\[(.*)\]', dynamic):
                for path in paths.split(':'):
                    self.assertTrue(path.startswith(('/', '$ORIGIN')), f'{name}: {path!r}')

    @unittest.skipUnless(shutil.which('gnuplot'), 'gnuplot is missing')
    def test_gnuplot_is_the_installed_one_with_no_settings_of_the_folder(self):
        script = f'#!/bin/sh\ntouch "{self.sprung}"\n'
        home = self.folder / 'home'
        for folder in self.folder, self.folder / 'bin', home, home / 'bin':
            folder.mkdir(exist_ok=True)
            for name in 'gnuplot', 'gnuplot-nox', 'gnuplot_x11', 'sh', 'fc-cache':
                (folder / name).write_text(script)
                (folder / name).chmod(0o755)
            for name in '.gnuplot', 'gnuplotrc', '.gnuplotrc', 'gnuplot.cfg':
                (folder / name).write_text(f'system "touch {self.sprung}"\n')
        installed = os.path.dirname(shutil.which('gnuplot'))
        for path in f':{installed}', f'.:{installed}', f'bin:{installed}', f'{installed}:', 'bin::.':
            env = dict(self.env, PATH=path, HOME=str(home), GNUPLOT_LIB=str(self.folder),
                       GNUTERM='x11', GNUPLOT_DRIVER_DIR=str(self.folder), XDG_CONFIG_HOME='.',
                       FONTCONFIG_FILE='fonts.conf')
            for name in 'a.svg', 'a.png':
                with self.subTest(path=path, name=name):
                    result = run('plot', 'tone', '-o', name, cwd=self.folder, env=env)
                    self.check_not_sprung(result, 0 if installed in path else 74)

    @unittest.skipUnless(shutil.which('gnuplot'), 'gnuplot is missing')
    def test_titles_are_no_commands(self):
        for title in (f"x'; system('touch {self.sprung}'); '", f'`touch {self.sprung}`',
                      f'x\nsystem "touch {self.sprung}"', f'x\r!touch {self.sprung}',
                      f'@x $(touch {self.sprung})', 'a{/Symbol=99 b}_c^d', "it's", "'", "''", '\\', '\\n',
                      '%s %g', '<b>&amp;</b>]]>', '&#x1b;[2J', '&#27;', EVIL, 'Grün 漢字'):
            with self.subTest(title=title):
                result = run('plot', 'tone', '--title', title, '-o', self.out / 'a.svg', env=self.env)
                self.check_not_sprung(result)
                svg = (self.out / 'a.svg').read_text()
                drawn = xml.dom.minidom.parseString(svg)  # well-formed
                self.assertIsNone(ACTING.search(svg.replace('\t', ' ')))
                words = ' '.join(node.toprettyxml() for node in drawn.getElementsByTagName('text'))
                if title == 'Grün 漢字':
                    self.assertIn(title, words)


class TerminalTest(SecurityTest):
    """No file, name or option writes anything to the terminal that acts there."""

    def check_harmless(self, result, *words, allowed=''):
        for data in result.stdout, result.stderr:
            text = text_of(data)
            found = [c for c in ACTING.findall(text) if c not in allowed]
            self.assertEqual(found, [], repr(text[:2000]))
            self.assertIsNone(re.search('^(error|  hint): (forged|rm)', text, re.MULTILINE), text[:2000])
        for word in words:
            self.assertIn(word, text_of(result.stdout + result.stderr))
        return result

    def write(self, name, content):
        path = os.path.join(os.fsencode(self.out), name if isinstance(name, bytes) else os.fsencode(name))
        with open(path, 'wb') as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return os.fsdecode(path)

    def scene(self, **changes):
        scene = {'nacre': 1,
                 'materials': {EVIL: {'model': 'metallic_roughness', 'roughness': 0, 'metallic': 1},
                               'matte': {'model': 'lambert', 'albedo': 1}},
                 'lights': {'point': {'type': 'point', 'position': [3, 3, 3], 'intensity': 9},
                            'key': {'type': 'directional', 'direction_of_travel': [0, -1, -1],
                                    'irradiance': 1}},
                 'shapes': [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': EVIL}]}
        scene.update(changes)
        return scene

    def test_names_in_scenes(self):
        good = self.write('s.json', json.dumps(self.scene()))
        options = ['-o', self.out / 'a.exr', '-o', self.out / 'a.png', *SMALL, '--layers', 'all']
        self.check_harmless(run('render', good, *options, '--explain', '--stats', '-'), 'perfect mirror')
        self.check_harmless(run('render', good, *options, '--dry-run'))
        self.check_harmless(run('info', good), 'materials   2: x\\u001b[2J')
        self.check_harmless(run('info', self.out / 'a.exr'), 'light.')
        self.check_harmless(run('compare', self.out / 'a.exr', self.out / 'a.exr'), 'light.')
        compared = self.check_harmless(run('compare', self.out / 'a.exr', self.out / 'a.exr', '--json',
                                           '--metrics', 'all'))
        self.assertTrue(json.loads(compared.stdout)['match'])
        self.check_harmless(run('compare', self.out / 'a.exr', self.out / 'a.exr', '--layers', EVIL))
        self.check_harmless(run('tonemap', self.out / 'a.exr', '-o', self.out / 'b.png', '--layer', EVIL))
        for changes in ({EVIL: 1}, {'materials': {EVIL: {'model': EVIL, EVIL: EVIL}}},
                        {'lights': {EVIL: {'type': EVIL}}}, {'textures': {EVIL: {'file': EVIL}}},
                        {'shapes': [{'type': 'sphere', 'material': EVIL + 'y'}]},
                        {'shapes': [{'type': 'mesh', 'file': EVIL, 'material': 'matte'}]},
                        {'nacre': EVIL}, {'camera': EVIL}, {'background': [EVIL]}):
            with self.subTest(changes=changes):
                bad = self.write('bad.json', json.dumps(self.scene(**changes)))
                for verb in (['render', bad, *options], ['info', bad], ['plot', 'brdf', '--scene', bad, '-o',
                             self.out / 'p.csv'], ['report', self.out / 'r.html', bad]):
                    self.check_refused(self.check_harmless(run(*verb)), 65)
        for broken in ('{"nacre": 1, "a\x1b[2J": 1}', '{"nacre": \x1b[2J}', '\x1b[2J', '{"a": "\x9b"}'):
            self.check_harmless(run('info', self.write('bad.json', broken)))
        self.check_harmless(run('info', self.write('bad.json', b'{"nacre": 1, "\x9b31m": 1}')))

    def test_names_in_models(self):
        models = {
            'a.obj': f'mtllib {EVIL[:20]}.mtl\nusemtl {EVIL[:20]}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n',
            'b.obj': 'v \x1b[2J 0 0\n', 'c.obj': 'mtllib c.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\x1b[2J\n'
            'f 1 2 3\n',
            'd.ply': 'ply\nformat ascii 1.0\nelement \x1b[2J 1\nproperty \x1b]0;a\x07 x\nend_header\n1\n',
            'e.ply': 'ply\nformat \x1b[2J 1.0\nend_header\n',
            'f.gltf': json.dumps({'asset': {'version': EVIL}}),
            'g.gltf': json.dumps({'asset': {'version': '2.0'}, 'extensionsRequired': [EVIL]}),
            'h.gltf': json.dumps({'asset': {'version': '2.0'}, 'extensionsUsed': [EVIL], 'buffers':
                                  [{'uri': EVIL, 'byteLength': 3}]}),
            'i.gltf': json.dumps({'asset': {'version': '2.0'}, EVIL: 1, 'meshes': [{'name': EVIL, 'primitives':
                                  [{'attributes': {EVIL: 7}}]}], 'nodes': [{'mesh': 0}]}),
            'j.gltf': '{"asset": {"version": "2.0"}, "\x1b[2J": \x1b}'}
        self.write('c.mtl', 'newmtl m\x1b[2J\nmap_Kd no\x1b[2J.png\nKd 1 1 1\n\x1b[31mFoo 1\nillum \x1b[2J\n')
        for name, content in models.items():
            with self.subTest(name=name):
                path = self.write(name, content)
                for verb in (['info', path], ['render', path, '-o', self.out / 'a.exr', *SMALL, '--layers',
                             'all', '--explain', '--stats', '-'],
                             ['report', self.out / 'r.html', path, '--size', '16x9', '--spp', '1']):
                    self.check_harmless(run(*verb))
        latin = self.write('k.obj', b'mtllib k.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl gr\xfcn\x9b31m\nf 1 2 3\n')
        self.write('k.mtl', b'newmtl gr\xfcn\x9b31m\nKd 1 1 1\nNs 10\nKs 1 1 1\n')
        for verb in (['info', latin], ['render', latin, '-o', self.out / 'a.exr', *SMALL, '--stats', '-',
                     '--layers', 'all', '--explain'], ['render', latin, '-o', self.out / 'a.exr', *SMALL,
                     '--dry-run'], ['plot', 'brdf', '--scene', latin, '-o', self.out / 'p.csv'],
                     ['report', self.out / 'r.html', latin, '--size', '16x9', '--spp', '1']):
            with self.subTest(verb=verb[0]):
                self.assertEqual(self.check_harmless(run(*verb)).returncode, 0)

    def test_texts_in_images(self):
        """Attributes, channels and their texts, in files that other programs may have made."""
        self.assertEqual(run('render', FIRST, '-o', self.out / 'a.exr', *SMALL, '--layers', 'diffuse',
                             '--reproducible').returncode, 0)
        data = (self.out / 'a.exr').read_bytes()
        for old, new in ((b'nacre:settings', b'n\x1b[2J\x9b31m\r\nabc'), (b'diffuse.', b'd\x1b[2J\x7f\x9b.'),
                         (b'size=32x18', b'\x1b[2J\n\xc2\x9b31m')):
            self.assertIn(old, data)
            self.assertEqual(len(old), len(new))
            path = self.write('b.exr', data.replace(old, new))
            for verb in (['info', path], ['compare', path, path, '--json'], ['compare', path, path],
                         ['compare', self.out / 'a.exr', path], ['tonemap', path, '-o', self.out / 'b.png'],
                         ['merge', '-o', self.out / 'm.exr', path], ['report', self.out / 'r.html', path]):
                with self.subTest(new=new, verb=verb[0]):
                    self.check_harmless(run(*verb))
        self.check_harmless(run('info', self.write('e.png', '\x1b[2J')))
        self.check_harmless(run('info', self.write('e.hdr', '#?RADIANCE\n\x1b[2J=\x1b[31m\n\n-Y 1 +X 1\n')))

    def test_paths_and_options(self):
        name = EVIL.replace('/', '_')
        raw = b'r\xfc\x9b31m\xe2\x80\xae\x1b[2J'
        for folder in name, os.fsdecode(raw):
            with self.subTest(folder=folder):
                os.mkdir(self.out / folder)
                scene = self.out / folder / 's.json'
                shutil.copy(FIRST, scene)
                picture = self.out / folder / 'a.exr'
                self.assertEqual(self.check_harmless(run('render', scene, '-o', picture, *SMALL)).returncode,
                                 0)
                missing = self.out / folder / 'missing'
                for verb in (['info', picture], ['info', scene], ['info', missing], ['info', missing / 'a.json'],
                             ['render', missing, '-o', missing], ['render', scene, '-o', missing / 'a.exr'],
                             ['render', scene, '-o', self.out / folder], ['compare', picture, missing],
                             ['merge', '-o', self.out / 'm.exr', picture, missing],
                             ['report', self.out / folder / 'r.html', picture],
                             ['validate', self.out / folder], ['tonemap', picture, '-o', missing],
                             ['plot', 'tone', '-o', missing], ['study', 'fresnel', '-o', scene],
                             ['grid', '-o', self.out / 'g.png', '--environment', missing],
                             ['grid', '-o', self.out / 'g.png', '--lights', missing],
                             ['info', '--verify', picture]):
                    self.check_harmless(run(*verb))
        for verb in ([name], ['render', FIRST, '-o', self.out / 'a.exr', '--' + name],
                     ['render', FIRST, '-o', self.out / 'a.exr', '--size', name],
                     ['render', FIRST, '-o', self.out / 'a.exr', '--set', name],
                     ['render', FIRST, '-o', self.out / 'a.exr', '--set', f'/{name}={name}'],
                     ['render', FIRST, '-o', self.out / 'a.exr', '--set', f'/{name}=1'],
                     ['render', FIRST, '-o', self.out / 'a.exr', '--layers', name],
                     ['grid', '-o', self.out / 'a.png', '--material', name],
                     ['grid', '-o', self.out / 'a.png', '--rows', name], ['explain', name], ['study', name],
                     ['grid', '-o', self.out / 'a.png', '--title', name, '--spp', '1'],
                     ['plot', name, '-o', self.out / 'a.svg'], ['convert', name], ['pair', '--a', name],
                     ['table', name], ['table', 'lambert', '--check', name], ['table', 'lambert', '-o', name],
                     ['table', name, '--scene', FIRST],
                     ['pair', '-o', self.out / 'a.png', '--a', '{"model": "phong", "name": "%s"}' % 'a\\u001b[m']):
            with self.subTest(verb=verb[0]):
                self.check_harmless(run(*verb))

    def test_references(self):
        self.write('a\x1b[2J.reference.json', json.dumps({'scene': EVIL, 'image': EVIL, EVIL: 1}))
        self.write('b.reference.json', json.dumps({'scene': EVIL, 'image': EVIL, 'tolerances': {},
                                                   'reason': EVIL}))
        shutil.copy(FIRST, self.out / 's.json')
        self.assertEqual(run('render', FIRST, '-o', self.out / 's.exr').returncode, 0)
        self.write('c.reference.json', json.dumps({'scene': 's.json', 'image': 's.exr', 'layers': [''],
                                                   'tolerances': {'max_abs': 1}, 'reason': EVIL}))
        self.check_harmless(run('validate', self.out, '--report', self.out / 'r.html'), 'match')
        self.assertIsNone(ACTING.search((self.out / 'r.html').read_text().replace('\t', '')))

    def test_the_progress_bar_moves_its_own_line_only(self):
        scene = self.write(EVIL.replace('/', '_') + '.json', json.dumps(self.scene()))
        result = run('render', scene, '-o', self.out / 'a.exr', '--size', '640x360', '--spp', '64',
                     '--progress', 'bar')
        text = text_of(result.stderr).replace('\r\x1b[K', '').replace('\x1b[K', '').replace('\r', '')
        self.assertIsNone(ACTING.search(text), repr(text))


class FilesTest(SecurityTest):
    """Outputs replace nothing that they should not, and keep what belongs to the file's name."""

    def test_two_outputs_of_one_file(self):
        (self.out / 'folder').mkdir()
        (self.out / 'link').symlink_to('folder')
        (self.out / 'soft.png').symlink_to('x.png')
        (self.out / 'far.png').symlink_to(self.out / 'folder/../x.png')
        pairs = [('x.png', './x.png'), ('x.png', 'folder/../x.png'), ('x.png', self.out / 'x.png'),
                 ('folder/x.png', 'link/x.png'), ('x.png', 'soft.png'), ('far.png', 'soft.png'),
                 ('x.png', 'x.png'), ('.//x.png', 'x.png')]
        for there in False, True:
            if there:
                (self.out / 'x.png').write_bytes(b'old')
                os.link(self.out / 'x.png', self.out / 'hard.png')
                pairs.append(('x.png', 'hard.png'))
            for a, b in pairs:
                for verb in (['render', FIRST, *SMALL], ['grid'], ['plot', 'tone'], ['pair', '--layout', 'difference'],
                             ['render', SOURCE / 'scenes/phong_vs_pbr.json', '--preset', 'textbook']):
                    with self.subTest(a=a, b=b, verb=verb, there=there):
                        result = run(*verb, '-o', a, '-o', b, cwd=self.out)
                        self.check_refused(result, 64, 'the same file is named twice')
        self.assertEqual((self.out / 'x.png').read_bytes(), b'old')
        self.check_refused(run('render', FIRST, '-o', 'x.png', '--stats', './x.png', cwd=self.out), 64, 'twice')
        self.check_refused(run('convert', 'phong', '-o', 'x.png', '--curves', './x.png', cwd=self.out), 64,
                           'twice')

    def test_no_output_is_an_input_of_the_scene(self):
        textures = SOURCE / 'scenes/textures'
        (self.out / 'sub').mkdir()
        files = {'tex.png': (textures / 'tiles.png').read_bytes(), 'unused.png': (textures / 'tiles.png').read_bytes(),
                 'm.mtl': b'newmtl m\nKd 1 1 1\nmap_Kd kd.png\n', 'kd.png': (textures / 'tiles.png').read_bytes(),
                 'm.obj': b'mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n',
                 'sky.exr': (textures / 'evening.exr').read_bytes(), 'mesh.ply': b'ply\nformat ascii 1.0\nelement vertex 3\n'
                 b'property float x\nproperty float y\nproperty float z\nelement face 1\n'
                 b'property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n',
                 'img.png': (textures / 'tiles.png').read_bytes(), 'b.bin': struct.pack('<9f', 0, 0, 0, 1, 0, 0, 0, 1, 0)}
        files['s.json'] = json.dumps({
            'nacre': 1, 'textures': {'t': {'file': 'tex.png', 'mapping': 'spherical'}, 'u': {'file': 'unused.png'}},
            'materials': {'a': {'model': 'lambert', 'albedo': 1, 'albedo_map': 't'}},
            'lights': {'sky': {'type': 'environment', 'image': 'sky.exr'}},
            'shapes': [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'a'},
                       {'type': 'mesh', 'file': 'mesh.ply', 'material': 'a'}]}).encode()
        files['g.gltf'] = json.dumps({
            'asset': {'version': '2.0'}, 'buffers': [{'uri': 'b.bin', 'byteLength': 36}],
            'bufferViews': [{'buffer': 0, 'byteLength': 36}],
            'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3', 'min': [0, 0, 0],
                           'max': [1, 1, 1]}], 'images': [{'uri': 'img.png'}], 'textures': [{'source': 0}],
            'materials': [{'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}}}],
            'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'material': 0}]}],
            'nodes': [{'mesh': 0}], 'scenes': [{'nodes': [0]}], 'scene': 0}).encode()
        for name, content in files.items():
            (self.out / name).write_bytes(content)
        used = {'s.json': ['s.json', 'tex.png', 'unused.png', 'sky.exr', 'mesh.ply'],
                'm.obj': ['m.obj', 'm.mtl', 'kd.png'], 'g.gltf': ['g.gltf', 'b.bin', 'img.png']}
        for scene, inputs in used.items():
            self.assertEqual(run('info', scene, cwd=self.out).returncode, 0, scene)
            for name in inputs:
                links = [name] if name.endswith(('.png', '.exr')) else []
                for kind in 'hard', 'soft':
                    link = f'{kind}_{name}.png'
                    (self.out / link).unlink(missing_ok=True)
                    if kind == 'hard':
                        os.link(self.out / name, self.out / link)
                    else:
                        (self.out / link).symlink_to(name)
                    links.append(link)
                for output in links:
                    with self.subTest(scene=scene, output=output):
                        result = run('render', scene, '-o', './' + output, *SMALL, cwd=self.out)
                        self.check_refused(result, 64, 'is read for this picture')
        for verb in (['grid', '--environment', 'sky.exr', '-o', 'sky.exr'],
                     ['pair', '--environment', 'sky.exr', '-o', 'soft_sky.exr.png', '--layout', 'difference'],
                     ['plot', 'brdf', '--scene', 's.json', '-o', 'tex.png'],
                     ['render', 's.json', '-o', 'a.exr', '--stats', 'mesh.ply'],
                     ['render', 's.json', '-o', 'a.exr', '--stats', 's.json']):
            with self.subTest(verb=verb):
                self.check_refused(run(*verb, cwd=self.out), 64, 'is read for this picture')
        for name, content in files.items():
            self.assertEqual((self.out / name).read_bytes(), content, name)

    def test_a_replaced_file_keeps_its_mode(self):
        for name, verb in (('a.exr', ['render', FIRST, *SMALL]), ('a.png', ['render', FIRST, *SMALL]),
                           ('a.csv', ['plot', 'tone'])):
            for mode in 0o600, 0o640, 0o664, 0o777:
                (self.out / name).write_bytes(b'old')
                (self.out / name).chmod(mode)
                old_mask = os.umask(0o022)
                try:
                    self.assertEqual(run(*verb, '-o', self.out / name).returncode, 0)
                finally:
                    os.umask(old_mask)
                status = (self.out / name).stat()
                self.assertEqual(stat.S_IMODE(status.st_mode), mode)
                self.assertGreater(status.st_size, 3)

    @unittest.skipUnless(IS_ROOT, 'giving files away needs root')
    def test_a_replaced_file_keeps_its_owner_and_group(self):
        (self.out / 'a.png').write_bytes(b'old')
        os.chown(self.out / 'a.png', 12345, 23456)
        (self.out / 'a.png').chmod(0o640)
        (self.out / 'link.png').symlink_to('a.png')
        self.assertEqual(run('render', FIRST, '-o', self.out / 'link.png', *SMALL).returncode, 0)
        status = (self.out / 'a.png').stat()
        self.assertEqual((status.st_uid, status.st_gid, stat.S_IMODE(status.st_mode)), (12345, 23456, 0o640))
        self.assertTrue((self.out / 'link.png').is_symlink())

    def test_a_replaced_file_keeps_its_attributes(self):
        (self.out / 'a.png').write_bytes(b'old')
        try:
            os.setxattr(self.out / 'a.png', 'user.nacre', b'kept')
        except OSError:
            self.skipTest('this file system has no extended attributes')
        self.assertEqual(run('render', FIRST, '-o', self.out / 'a.png', *SMALL).returncode, 0)
        self.assertEqual(os.getxattr(self.out / 'a.png', 'user.nacre'), b'kept')


class MessagesTest(SecurityTest):
    def test_results_that_nobody_got_are_told(self):
        """Standard output closed, full, or open for reading only."""
        (self.out / 's.json').write_bytes(FIRST.read_bytes())
        self.assertEqual(run('render', FIRST, '-o', self.out / 'a.exr', *SMALL).returncode, 0)
        shutil.copytree(SOURCE / 'tests/references', self.out / 'refs', ignore=lambda _, names: [
            name for name in names if not name.startswith('pov_lambert')])
        a = self.out / 'a.exr'
        verbs = (['schema'], ['info'], ['info', a], ['info', self.out / 's.json'], ['--help'], ['--version'],
                 ['render', '--help'], ['compare', a, a], ['compare', a, a, '--json'], ['convert', 'phong'],
                 ['convert', 'phong', '--json'], ['pair', '-o', self.out / 'p.png', '--spp', '1'],
                 ['table', 'lambert', '--no-albedo'], ['table', 'lambert', '--json'],
                 ['study', 'list'], ['docs', 'man'], ['docs', 'bash'], ['validate', self.out / 'refs'],
                 ['render', FIRST, '-o', self.out / 'b.exr', '--dry-run', *SMALL],
                 ['render', FIRST, '-o', self.out / 'b.exr', '--explain', *SMALL],
                 ['render', FIRST, '-o', self.out / 'b.exr', '--stats', '-', *SMALL], ['explain', 'textbook'],
                 ['info', '--verify', a])
        for verb in verbs:
            for redirection in '>&-', '>/dev/full', '1</dev/null':
                with self.subTest(verb=verb, redirection=redirection):
                    result = subprocess.run(['sh', '-c', f'exec "$@" {redirection}', 'sh', PROGRAM,
                                             *map(str, verb)], stderr=subprocess.PIPE, check=False)
                    self.check_refused(result, 74, 'error: standard output: ')

    def test_a_stopped_study_tells_what_it_wrote(self):
        process = subprocess.Popen([PROGRAM, 'study', 'all', '-o', self.out / 'all'],
                                   stderr=subprocess.PIPE, text=True)
        first = process.stderr.readline()  # the first study's answer
        self.assertIn('answer.md', first)
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=120)[1]
        self.assertEqual(process.returncode, 130, said)
        self.assertNotIn('no output', said)
        count, last = re.search(r'hint: (\d+) files were written before, the last of them (.*)', said).groups()
        there = [path for path in (self.out / 'all').rglob('*') if path.is_file()]
        self.assertEqual(len(there), int(count))
        self.assertIn(pathlib.Path(last), there)

    def test_environments_come_from_anywhere_and_let_in_nothing_else(self):
        elsewhere = tempfile.TemporaryDirectory()
        self.addCleanup(elsewhere.cleanup)
        for name in 'sky.exr', 'other.exr':
            shutil.copy(SOURCE / 'scenes/textures/evening.exr', f'{elsewhere.name}/{name}')
        sky, other = f'{elsewhere.name}/sky.exr', f'{elsewhere.name}/other.exr'
        (self.out / 's.json').write_text(json.dumps({
            'nacre': 1, 'image': {'width': 32, 'height': 18, 'spp': 4}, 'shapes': [
                {'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': {'model': 'metallic_roughness'}}]}))
        lights = json.dumps({'environment': {'type': 'environment', 'image': sky, 'rotate_deg': 30}})
        for name, options in (('a.exr', ['--environment', sky, '--set', '/lights/environment/rotate_deg=30']),
                              ('b.exr', ['--set', '/lights=' + lights, '--allow-paths']),
                              ('c.exr', ['--environment', os.path.relpath(sky, self.out), '--set', '/lights/environment/rotate_deg=30'])):
            self.assertEqual(run('render', 's.json', '-o', name, *options, cwd=self.out).returncode, 0)
        for name in 'b.exr', 'c.exr':
            self.assertEqual(run('compare', 'a.exr', name, '--max-rel', '0', '--max-abs', '0', cwd=self.out).returncode, 0)
        self.check_refused(run('render', 's.json', '-o', 'd.exr', '--set', '/lights=' + lights, cwd=self.out), 65, 'outside')
        self.check_refused(run('render', 's.json', '-o', 'd.exr', '--environment', sky, '--set',
                               f'/textures/t={{"file": "{other}"}}', cwd=self.out), 65, 'other.exr" is outside')
        small = ['--size', '64x64', '--spp', '1', '-o', 'd.png']
        box = json.dumps({'box': {'type': 'environment', 'image': other}})
        for verb in ['grid'], ['pair', '--a', 'phong', '--b', 'blinn_phong'], \
                ['pair', '--a', 'phong', '--b', 'blinn_phong', '--layout', 'difference']:
            with self.subTest(verb=verb):
                result = run(*verb, *small, '--environment', sky, cwd=self.out)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.check_refused(run(*verb, *small, '--lights', box, cwd=self.out), 65, 'outside')
                self.check_refused(run(*verb, *small, '--environment', sky, '--lights', box, cwd=self.out), 65, 'outside')

    def test_references_are_read_as_scenes_are(self):
        path = self.out / 'a.reference.json'
        good = {'scene': 's.json', 'image': 's.exr', 'tolerances': {'max_abs': 0}, 'reason': 'none'}
        for change, *words in (
                ({'tolerance': {}}, 'unknown key "tolerance"', 'did you mean "tolerances"?'),
                ({'tolerances': {'max_abss': 1}}, '/tolerances: unknown key "max_abss"', 'did you mean "max_abs"?'),
                ({'tolerances': {'max_abs': 'a'}}, '/tolerances/max_abs: expected a number, got a string'),
                ({'tolerances': {'max_rel': -1}}, '/tolerances/max_rel: -1 is out of range'),
                ({'tolerances': {'exceeding_fraction': 2}}, '/tolerances/exceeding_fraction: 2 is out of range'),
                ({'tolerances': {'rmse': None}}, '/tolerances/rmse: expected a number, got null'),
                ({'tolerances': []}, '/tolerances: expected an object, got an array'),
                ({'layers': 'diffuse'}, '/layers: expected an array of names, got a string'),
                ({'layers': [1]}, '/layers/0: expected a string, got a number'),
                ({'scene': 7}, '/scene: expected a string, got a number'),
                ({'reason': None}, '/reason: expected a string, got null')):
            with self.subTest(change=change):
                path.write_text(json.dumps({**good, **change}))
                result = run('validate', self.out)
                self.check_refused(result, 2, f'error: {path}', *words)
                self.assertNotIn(b'json.exception', result.stderr + result.stdout)
        (self.out / 's.json').write_text('{"nacre": 1, "image": {"width": 8, "height": 8, "spp": 1}}')
        self.assertEqual(run('render', 's.json', '-o', 's.exr', cwd=self.out).returncode, 0)
        elsewhere = tempfile.TemporaryDirectory()
        self.addCleanup(elsewhere.cleanup)
        for suffix in 'json', 'exr':
            shutil.copy(self.out / f's.{suffix}', f'{elsewhere.name}/x.{suffix}')
            (self.out / f'link.{suffix}').symlink_to(f'{elsewhere.name}/x.{suffix}')
        (self.out / 'sub').mkdir()
        for member, suffix in ('scene', 'json'), ('image', 'exr'):
            for name, words in (('../x.' + suffix, 'outside'), (f'/x.{suffix}', 'outside'), ('link.' + suffix, 'outside'),
                                ('none.' + suffix, 'there is no file'), ('sub', 'not a regular file'), ('a\0b', 'character 0')):
                with self.subTest(member=member, name=name):
                    path.write_text(json.dumps({**good, member: name}))
                    self.check_refused(run('validate', self.out), 2, f'{path}: /{member}: ', words)
        path.write_text(json.dumps({**good, 'scene': 'link.json', 'image': 'link.exr'}))
        for verb, outcome in (['validate', self.out], b' match '), (['report', self.out / 'r.html', self.out], b''):
            result = run(*verb, '--allow-paths')
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(outcome, result.stdout)
        self.assertIn('"outcome":"match"', (self.out / 'r.html').read_text())
        self.assertEqual(run('report', self.out / 'r.html', self.out).returncode, 0)
        self.assertIn('outside the', (self.out / 'r.html').read_text())
        for name in good:
            path.write_text(json.dumps({key: value for key, value in good.items() if key != name}))
            self.check_refused(run('validate', self.out), 2, f'missing key "{name}"')
        for text, words in (('{', 'not JSON'), ('[]', 'expected an object'), ('', 'not JSON'),
                            ('{"scene": "a", "scene": "b"}', '"scene" is there twice'), ('[' * 100000, 'nested')):
            path.write_text(text)
            result = run('validate', self.out)
            self.check_refused(result, 2, words)
            self.assertNotIn(b'json.exception', result.stderr + result.stdout)

    def test_no_json_of_anybody_ends_in_the_librarys_words(self):
        deep = '{"a": ' + '[' * 30000 + ']' * 30000 + '}'
        bad = ['{', '[]', 'null', '7', '"a', '{"type": 7}', '{"model": 7}', '{"model": {}}', '{"model": "phong", "name": 7}',
               '{"a": 1e999}', '{"a": "\udc9b"}', '{"model": "phong", "kd": "\udcff"}', '{"lights": 7}', '{"lights": {"a": 7}}', deep]
        for text in bad:
            for verb in (['plot', 'brdf', '--material', text, '-o', self.out / 'a.csv'],
                         ['plot', 'falloff', '--light', text, '-o', self.out / 'a.csv'],
                         ['grid', '--lights', text, '-o', self.out / 'a.png'], ['convert', text], ['pair', '--a', text, '-o', self.out / 'a.png'],
                         ['table', text, '--no-albedo'],
                         ['grid', '--material', text, '-o', self.out / 'a.png'], ['grid', '--rows', 'material=' + text, '-o', self.out / 'a.png'],
                         ['grid', '--rows', 'roughness=' + text, '-o', self.out / 'a.png'],
                         ['render', FIRST, '--set', '/materials/red=' + text, '-o', self.out / 'a.exr', *SMALL]):
                with self.subTest(text=text[:40], verb=verb[:3]):
                    result = run(*verb)
                    self.assertIn(result.returncode, (0, 64, 65), result.stderr[:500])
                    self.assertNotIn(b'json.exception', result.stderr)
            for name in 'f.json', 'f.gltf', 'f.reference.json':
                (self.out / name).write_bytes(os.fsencode(text))
            for verb in (['info', self.out / 'f.json'], ['info', self.out / 'f.gltf'], ['validate', self.out],
                         ['table', 'lambert', '--check', self.out / 'f.json'], ['table', 'lambert', '--directions', self.out / 'f.json'],
                         ['grid', '--lights', self.out / 'f.json', '-o', self.out / 'a.png'],
                         ['report', self.out / 'r.html', self.out / 'f.json'], ['report', self.out / 'r.html', self.out]):
                with self.subTest(text=text[:40], verb=verb[:2]):
                    result = run(*verb)
                    self.assertIn(result.returncode, (0, 2, 64, 65), result.stderr[:500])
                    self.assertNotIn(b'json.exception', result.stderr)

    def test_libraries_say_nothing_themselves(self):
        """Around an error there are lines of ours alone, whatever image is damaged and how."""
        images = [SOURCE / 'scenes/textures/tiles.png', *sorted((SOURCE / 'tests/fuzz/corpus').rglob('*'))]
        images = [path for path in images if path.suffix in ('.png', '.jpg', '.tif', '.tiff', '.exr', '.hdr', '.tga', '.pnm',
                                                             '.ppm', '.pfm')]
        ours = re.compile(rb'(error: |  hint: |warning: |note: ).*')
        for image in images[:40]:
            data = image.read_bytes()
            for place in (len(data) // 3, len(data) // 2, len(data) - 20, 30, 45):
                if not 0 <= place < len(data):
                    continue
                for damaged in (data[:place], data[:place] + bytes([data[place] ^ 0x55]) + data[place + 1:]):
                    path = self.out / ('d' + image.suffix)
                    path.write_bytes(damaged)
                    # `compare` decodes what `info` only opens.
                    for verb, codes in (['info', path], (0, 65)), (['compare', path, path], (0, 1, 2)):
                        result = run(*verb)
                        with self.subTest(verb=verb[0], image=image.name, place=place):
                            self.assertIn(result.returncode, codes)
                            for line in result.stderr.splitlines():
                                self.assertTrue(ours.fullmatch(line), line)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=1)
