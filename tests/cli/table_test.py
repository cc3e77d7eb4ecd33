#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""nacre table from outside: what it writes, and what it says of the tables of others.

Usage: table_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
"""
import csv
import json
import math
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
FIRST_SCENE = SOURCE / 'scenes/first_scene.json'
COATED = '{"model": "open_pbr", "coat_weight": 1, "coat_roughness": 0.3, "coat_color": [0.9, 0.6, 0.4]}'
MATERIALX = COATED.replace('{', '{"rules": "materialx", ', 1)
SMALL = ['--theta-light', '0,30,75', '--theta-view', '20,60', '--phi', '0,100,180']


def run(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120, check=False, **options)


def rows_of(text):
    """The comments' members and the rows of a CSV file as dictionaries."""
    comments = [line[2:].split(': ', 1) for line in text.splitlines() if line.startswith('# ')]
    lines = [line for line in text.splitlines() if not line.startswith('#')]
    return ({key: json.loads(value) for key, value in comments},
            [{key: float(value) for key, value in row.items()} for row in csv.DictReader(lines)])


class TableTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.out = pathlib.Path(self.folder.name)

    def write(self, *arguments, code=0):
        result = run('table', *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stdout

    def check_fails(self, code, message, *arguments):
        """Fails with this code and one clear message, and leaves nothing."""
        before = sorted(self.out.iterdir())
        result = run('table', *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertIn('error: ', result.stderr)
        self.assertIn(message, result.stderr)
        self.assertEqual(result.stdout, '')
        self.assertEqual(sorted(self.out.iterdir()), before)

    def edited(self, material, change, name='theirs.csv'):
        """A table that another program has changed row by row."""
        text = self.write(material, *SMALL)
        _, rows = rows_of(text)
        with open(self.out / name, 'w', newline='') as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            for row in rows:
                change(row)
                writer.writerow(row)
        return self.out / name

    # ---- Tables ----

    def test_a_table_says_all_that_it_depends_on(self):
        header, rows = rows_of(self.write(COATED, *SMALL))
        self.assertEqual(header['nacre_table'], 1)
        self.assertEqual(header['rules'], 'spec_1_1')
        self.assertEqual(header['material']['coat_color'], [0.9, 0.6, 0.4])
        self.assertEqual(header['material']['coat_partial'], 'exponent_then_lerp')
        self.assertIn('without n.l', header['f'])
        self.assertEqual(header['color_space'], 'linear Rec. 709')
        self.assertEqual(len(rows), 2 * (1 + 3 + 3))
        for row in rows:
            self.assertAlmostEqual(math.hypot(*(row[f'light_{axis}'] for axis in 'xyz')), 1, 14)
            for channel in 'rgb':
                lobes = sum(row[f'{lobe}_{channel}'] for lobe in header['lobes'])
                self.assertAlmostEqual(row[f'f_{channel}'] / lobes, 1, 13)
            self.assertGreater(row['pdf'], 0)
            self.assertLessEqual(row['albedo_r'], 1.001)

    def test_all_formats_have_the_same_numbers(self):
        csv_file, json_file, npy = (self.out / f'a.{kind}' for kind in ('csv', 'json', 'npy'))
        printed = self.write(COATED, *SMALL, '-o', csv_file, '-o', json_file, '-o', npy, '-o', '-')
        self.assertEqual(printed, csv_file.read_text())
        header, rows = rows_of(printed)
        table = json.loads(json_file.read_text())
        self.assertEqual(table['header'], header)
        self.assertEqual(table['columns'], list(rows[0]))
        self.assertEqual(table['rows'], [list(row.values()) for row in rows])
        self.assertEqual(json.loads((self.out / 'a.npy.json').read_text()), header)
        data = npy.read_bytes()
        self.assertEqual(data[:8], b'\x93NUMPY\1\0')
        begin = 10 + int.from_bytes(data[8:10], 'little')
        self.assertEqual(begin % 64, 0)
        count = len(rows) * len(rows[0])
        self.assertEqual(list(struct.unpack(f'<{count}d', data[begin:])),
                         [value for row in rows for value in row.values()])
        self.assertEqual(self.write(COATED, *SMALL, '--json'), json_file.read_text())

    def test_directions_come_from_files_too(self):
        csv_file, npy = self.out / 'd.csv', self.out / 'd.npy'
        text = self.write('lambert', *SMALL, '--no-albedo')
        csv_file.write_text(text)
        self.write('lambert', *SMALL, '-o', npy)
        self.assertEqual(self.write('lambert', '--no-albedo', '--directions', csv_file), text)
        self.assertEqual(self.write('lambert', '--no-albedo', '--directions', npy), text)
        csv_file.write_text('0,0,1,0.6,0,0.8\n0,0,1,0,0,2\n0,0,1,nan,0,1\n')
        self.check_fails(65, 'd.csv: line 2: view (0, 0, 2) has length 2, not 1', 'lambert', '--directions',
                         csv_file)

    def test_materials_come_from_scenes_too(self):
        header, _ = rows_of(self.write('red', '--scene', FIRST_SCENE, *SMALL))
        self.assertEqual(header['material']['roughness'], 0.3)
        self.check_fails(65, 'did you mean "red"', 'rad', '--scene', FIRST_SCENE)
        self.check_fails(65, 'unknown model "gravel"', 'gravel')
        self.check_fails(65, 'unknown key "roughnes"', '{"model": "dielectric", "roughnes": 1}')

    def test_mirrors_are_named(self):
        header, rows = rows_of(self.write('{"model": "open_pbr", "specular_roughness": 0}', *SMALL))
        self.assertAlmostEqual(header['mirrors']['specular'][0], 0.04, 12)
        self.assertEqual({row['specular_r'] for row in rows}, {0.0})

    def test_what_cannot_be_is_refused_before_anything_is_written(self):
        self.check_fails(64, 'ends in .csv, .json or .npy', 'lambert', '-o', self.out / 'a.txt')
        self.check_fails(64, 'the same file is named twice', 'lambert', '-o', self.out / 'a.npy', '-o',
                         self.out / 'a.npy.json')
        self.check_fails(74, '', 'lambert', '-o', self.out / 'missing/a.csv')
        self.check_fails(64, '--tolerance: cannot be used', 'lambert', '--tolerance', '0.1')
        self.check_fails(64, '--phi: cannot be used', 'lambert', '--directions', 'd.csv', '--phi', '1')
        for option in ['-o', 'a.csv'], ['--directions', 'd.csv'], ['--theta-light', '1'], ['--no-albedo']:
            self.check_fails(64, 'cannot be used with --check', 'lambert', '--check', 'a.csv', *option)
        self.check_fails(64, '', 'lambert', '--theta-light', '100')

    def test_a_stopped_table_leaves_nothing(self):
        angles = ','.join(str(0.2 * i) for i in range(250))
        process = subprocess.Popen(
            [PROGRAM, 'table', COATED, '--theta-light', angles, '--theta-view', angles, '-o',
             self.out / 'a.csv'], stderr=subprocess.PIPE, text=True)
        try:
            process.wait(timeout=0.3)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, 130)
            self.assertEqual(list(self.out.iterdir()), [])

    # ---- Checks ----

    def test_its_own_table_agrees_in_every_format(self):
        for kind in 'csv', 'json', 'npy':
            self.write(COATED, *SMALL, '-o', self.out / f'a.{kind}')
            page = self.write(COATED, '--check', self.out / f'a.{kind}')
            self.assertIn('they agree', page)

    def check_found(self, words, material, change):
        path = self.edited(material, change)
        page = self.write(material, '--check', path, code=1)
        self.assertIn('they differ', page)
        self.assertIn(words, page)
        found = json.loads(self.write(material, '--check', path, '--json', code=1))
        self.assertFalse(found['ok'])
        everything = found['explanation'] + [also['what'] for also in found['also']]
        self.assertTrue(any(words in what for what in everything), everything)
        return found

    def test_mistakes_are_told(self):
        def times(factor, lobe='f'):
            def change(row):
                for channel in 'rgb':
                    row[f'f_{channel}'] += row[f'{lobe}_{channel}'] * (factor(row) - 1)
            return change
        self.check_found('all of f is times pi', COATED, times(lambda row: math.pi))
        self.check_found('n.l is part of f', COATED, times(lambda row: row['light_z']))
        self.check_found('the lobe "diffuse" is divided by pi', COATED,
                         times(lambda row: 1 / math.pi, 'diffuse'))

    def test_rules_are_told(self):
        self.write(MATERIALX, *SMALL, '-o', self.out / 'x.csv')
        found = json.loads(self.write(COATED, '--check', self.out / 'x.csv', '--json', code=1))
        self.assertEqual(found['explanation'], ['rules: materialx'])
        self.assertEqual(found['choices'][0]['what'], 'rules: materialx')
        self.assertIn('note: its header is of another material',
                      self.write(COATED, '--check', self.out / 'x.csv', code=1))

    def test_the_tolerance_decides(self):
        def change(row):
            row['f_r'] *= 1.005
        path = self.edited('lambert', change)
        self.write('lambert', '--check', path, code=1)
        self.write('lambert', '--check', path, '--tolerance', '0.01')

    def test_what_is_not_finite_is_named_with_its_line(self):
        def change(row):
            if row['light_z'] == 1:
                row['f_g'] = math.nan
        page = self.write('lambert', '--check', self.edited('lambert', change), code=1)
        self.assertIn('not in 2 of 14 rows: line 2, line 3', page)

    def test_what_cannot_be_compared_is_told(self):
        for name, data, message in (
                ('a.csv', b'', 'is empty'), ('a.csv', b'a,b\n1,2\n', 'has no columns light_x'),
                ('a.csv', b'a,b\n1\n', 'line 2 has 1 values'), ('a.json', b'{"a": ', 'not JSON'),
                ('a.npy', b'\x93NUMPY\1\0', 'ends in its header'),
                ('a.csv', b'wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f\n0,0,1,0,0,1,1\n', 'light_x, ..., view_z'),
                ('a.csv', b'light_x,\x1b[31m\n0,0\n', 'has no columns')):
            with self.subTest(data=data):
                (self.out / name).write_bytes(data)
                self.check_fails(2, message, 'lambert', '--check', self.out / name)
        self.check_fails(2, 'missing.csv', 'lambert', '--check', self.out / 'missing.csv')
        os.mkfifo(self.out / 'pipe.csv')
        self.check_fails(2, 'is not a regular file', 'lambert', '--check', self.out / 'pipe.csv')
        # The material is nacre's own.
        self.check_fails(65, 'unknown model "gravel"', 'gravel', '--check', self.out / 'missing.csv')


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
