#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What `nacre view` answers a page: pictures, samples, explanations, and how it bears use.

Usage: protocol_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
"""
import json
import math
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / 'report'))
import pictures  # noqa: E402
from server import Server  # noqa: E402

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENE = SOURCE / 'scenes/first_scene.json'
SIZE = ('--size', '160x90')


def is_done(message):
    return message.get('kind') == 1 and message['done'] == 1


class ProtocolTest(unittest.TestCase):
    def open(self, *arguments):
        server = Server(PROGRAM, *(arguments or (SCENE, *SIZE, '--spp', 8)), '--quiet')
        self.addCleanup(server.close)
        page = server.upgrade()
        self.addCleanup(page.close)
        return server, page

    def set(self, page, pointer, value, **more):
        page.send({'set': pointer, 'value': value, **more})
        answer = page.until(lambda m: 'changed' in m or 'fault' in m)
        self.assertIn('changed', answer, answer)
        return answer

    def rested(self, page, revision):
        return page.until(lambda m: is_done(m) and m['revision'] >= revision)

    def render(self, folder, *arguments):
        png = pathlib.Path(folder, 'out.png')
        subprocess.run([PROGRAM, 'render', *map(str, arguments), '-o', png, '--quiet'], check=True, timeout=120)
        return [[list(pixel) for pixel in row] for row in pictures.read_png(png)]

    def picture(self, head):
        pixels = head['pixels']
        return [[list(pixels[4 * (y * head['width'] + x):][:3]) for x in range(head['width'])]
                for y in range(head['height'])]

    def test_the_resting_picture_is_that_of_render(self):
        _, page = self.open()
        with tempfile.TemporaryDirectory() as folder:
            first = page.until(is_done)
            self.assertEqual((first['samples'], first['of_samples']), (8, 8))
            self.assertEqual(self.picture(first), self.render(folder, SCENE, *SIZE, '--spp', 8))
            for pointer, value, text in (('/materials/red/roughness', 0.7, '0.7'),
                                         ('/camera', {'position': [2, 2, 5]}, '{"position": [2, 2, 5]}'),
                                         ('/lights/key/position', [0, 4, 4], '[0, 4, 4]')):
                answer = self.set(page, pointer, value)
                head = self.rested(page, answer['revision'])
                self.assertEqual(head['width'], 160)
                page.send({'history': 'undo'})
                page.until(lambda m: 'scene' in m)
                self.assertEqual(self.picture(head), self.render(folder, SCENE, *SIZE, '--spp', 8, '--set', f'{pointer}={text}'),
                                 pointer)

    def test_samples_are_exact(self):
        _, page = self.open()
        page.until(is_done)
        page.send({'samples': '', 'id': 77})
        answer = page.until(lambda m: m.get('kind') == 2)
        self.assertEqual((answer['samples'], answer['of_samples'], answer['width'], answer['height']), (77, 3, 160, 90))
        with tempfile.TemporaryDirectory() as folder:
            image = pathlib.Path(folder, 'a.exr')
            subprocess.run([PROGRAM, 'render', SCENE, *SIZE, '--spp', '8', '-o', image, '--depth', 'float', '--compression', 'none',
                            '--reproducible', '--quiet'], check=True, timeout=120)
            planes = pictures.read_exr(image)
        values = struct.unpack(f'<{3 * 160 * 90}f', answer['pixels'])
        for i, channel in enumerate('RGB'):
            self.assertEqual(list(values[i * 14400:(i + 1) * 14400]), [v for row in planes[channel] for v in row])

    def adds_up(self, answer):
        """Lights, components and what covers a base, to the linear value. Returns how many lights are lit."""
        layers, lights, lit = answer['layers'], answer['lights'], 0
        for c, value in enumerate(answer['value']):
            # Sums of floats in another order.
            delta = 1e-5 * max(1, abs(value))
            self.assertAlmostEqual(sum(layers[name][c] for name in ('diffuse', 'specular', 'ambient', 'emission')), value, delta=delta)
            for name in ('diffuse', 'specular'):
                self.assertAlmostEqual(sum(light[f'rendered_{name}'][c] for light in lights), layers[name][c], delta=delta)
        for light in lights:
            for c in range(3):
                self.assertAlmostEqual(light['rendered_diffuse'][c] + light['rendered_specular'][c], light['rendered'][c], delta=1e-9)
            if light.get('state') != 'lit':
                continue
            lit += 1
            terms = light['terms']
            if 'V' in terms:  # Heitz 2014: the geometry term, and the same over 4 n.l n.v
                self.assertAlmostEqual(terms['G'], 4 * terms['V'] * light['n_dot_l'] * light['n_dot_v'], places=12)
                self.assertLessEqual(terms['G'], 1 + 1e-12)
            for name in ('diffuse', 'specular'):
                for c in range(3):
                    # Double against float, at a position that was rounded to float: highlights are steep.
                    self.assertAlmostEqual(light[name][c], light[f'rendered_{name}'][c], delta=1e-4 * max(1, light['rendered'][c]))
                    if 'covers' not in light:
                        continue
                    total = light['base'][name][c]
                    for cover in light['covers']:
                        total = total * cover['below'][c] + cover[name][c]
                    self.assertAlmostEqual(total, light[name][c], delta=1e-12 * max(1, light[name][c]))
        return lit

    def test_an_explained_pixel_adds_up(self):
        spot = {'type': 'spot', 'position': [0, 4, 4], 'direction_of_travel': [0, -3, -4], 'intensity': 80, 'cutoff_deg': 30, 'inner_deg': 5}
        sun = {'type': 'directional', 'direction_of_travel': [0.3, -0.5, -1], 'irradiance': 2}
        for scene, light in (('first_scene', spot), ('phong_vs_pbr', None), ('metals', None), ('textures', None), ('coat_and_sheen', sun),
                             ('area_lights', sun)):
            _, page = self.open(SOURCE / f'scenes/{scene}.json', *SIZE, '--spp', 2, *(('--set', f'/lights/own={json.dumps(light)}') if light else ()))
            page.until(is_done)
            lit = mapped = covered = sampled = 0
            for x, y in ((80, 45), (70, 40), (40, 45), (120, 45), (85, 50), (20, 50), (46, 34), (114, 34), (60, 53), (100, 53), (2, 2)):
                page.send({'explain': x, 'y': y})
                answer = page.until(lambda m: 'explained' in m)['explained']
                if answer.get('background'):
                    continue
                mapped += len(answer['mapped'])
                covered += any('covers' in light for light in answer['lights'])
                sampled += any('samples' in light['state'] and light['rendered_diffuse'][0] > 0 for light in answer['lights'])
                self.assertLess(max(value for _, value in answer['curves']['albedo']), 1.001)
                self.assertAlmostEqual(sum(v * v for v in answer['normal']), 1, places=6)
                with self.subTest(scene=scene, x=x, y=y):
                    lit += self.adds_up(answer)
                for light in answer['lights']:
                    if 'to_light' not in light:
                        continue
                    half = [a + b for a, b in zip(light['to_light'], answer['to_view'])]
                    length = math.hypot(*half)
                    self.assertAlmostEqual(sum(a * b for a, b in zip(answer['normal'], half)) / length, light['n_dot_h'], places=9)
            self.assertGreater(lit, 0, scene)
            self.assertEqual(mapped > 0, scene in ('textures', 'coat_and_sheen'))
            self.assertEqual(covered > 0, scene == 'coat_and_sheen')
            self.assertEqual(sampled > 0, scene in ('coat_and_sheen', 'area_lights'))

    def test_a_coat_is_explained_with_its_own_normal(self):
        """Over flakes it is smooth: the sun is put where the coat's highlight is, far from that of the flake."""
        sun = {'type': 'directional', 'direction_of_travel': [0, -1, 0], 'irradiance': 2}
        _, page = self.open(SOURCE / 'scenes/coat_and_sheen.json', *SIZE, '--spp', 1, '--set', f'/lights/sun={json.dumps(sun)}',
                            '--set', '/materials/car paint/coat_roughness=0.3')
        page.until(is_done)

        def explained():
            page.send({'explain': 46, 'y': 34})
            return page.until(lambda m: 'explained' in m)['explained']

        before = explained()
        self.assertEqual(before['material'], 'car paint')
        center, radius = (-1.6, 0.72, -1.3), 0.72
        sphere_normal = [(p - c) / radius for p, c in zip(before['position'], center)]
        cosine = sum(a * b for a, b in zip(sphere_normal, before['to_view']))
        self.set(page, '/lights/sun/direction_of_travel',
                 [v - 2 * cosine * n for n, v in zip(sphere_normal, before['to_view'])])
        page.until(is_done)
        answer = explained()
        self.assertGreater(self.adds_up(answer), 0)
        mirrored, coat = next(light for light in answer['lights'] if light['name'] == 'sun')['covers']
        self.assertEqual(mirrored['name'], 'mirrored at the horizon')
        self.assertGreater(coat['specular'][1], 0.5)
        # The terms are those of the coat's own normal, which has no flakes: the sphere's.
        terms = coat['terms']
        self.assertAlmostEqual(terms['n_dot_v'], cosine, places=5)
        self.assertAlmostEqual(terms['n_dot_l'], cosine, places=5)
        self.assertAlmostEqual(terms['n_dot_h'], 1, places=9)
        # And what it leaves of the light below is seen through it from the same angle as without flakes.
        self.set(page, '/materials/car paint/normal_map', {'texture': 'flakes', 'scale': 0})
        smooth = explained()
        self.assertGreater(math.dist(smooth['normal'], answer['normal']), 0.05)
        over_smooth = next(light for light in smooth['lights'] if light['name'] == 'sun')['covers'][-1]
        for through, without_flakes in zip(coat['below'], over_smooth['below']):
            self.assertAlmostEqual(through, without_flakes, places=6)

    def test_a_coat_under_maps_of_its_own_adds_up(self):
        sun = {'type': 'directional', 'direction_of_travel': [0.3, -0.5, -1], 'irradiance': 2}
        _, page = self.open(SOURCE / 'scenes/coat_and_sheen.json', *SIZE, '--spp', 1, '--set', f'/lights/sun={json.dumps(sun)}',
                            '--set', '/textures/grain={"file": "textures/wood.png", "mapping": "spherical"}',
                            '--set', '/materials/car paint/coat_map="grain"', '--set', '/materials/car paint/coat_roughness=0.8',
                            '--set', '/materials/car paint/coat_roughness_map="grain"')
        page.until(is_done)
        seen = 0
        for x, y in ((46, 34), (42, 30), (50, 40)):
            page.send({'explain': x, 'y': y})
            answer = page.until(lambda m: 'explained' in m)['explained']
            self.assertEqual(answer['material'], 'car paint')
            self.assertLess(answer['mapped']['coat specular'], 0.9)
            seen += self.adds_up(answer)
        self.assertGreater(seen, 0)

    def test_a_lobe_that_leans_below_the_surface_adds_up(self):
        """What it loses there is reflected by way of the horizon, which the explanation of a pixel names."""
        sun = {'type': 'directional', 'direction_of_travel': [0.9, -0.4, -0.6], 'irradiance': 2}
        for coat in 1, 0:
            _, page = self.open(SOURCE / 'scenes/coat_and_sheen.json', *SIZE, '--spp', 1, '--set', f'/lights/sun={json.dumps(sun)}',
                                '--set', '/materials/car paint/normal_map={"texture": "flakes", "scale": 4}',
                                '--set', '/materials/car paint/roughness=0.9', '--set', f'/materials/car paint/coat={coat}')
            page.until(is_done)
            by_way_of_the_horizon = 0
            for x in range(36, 58, 2):
                for y in range(26, 44, 2):
                    page.send({'explain': x, 'y': y})
                    answer = page.until(lambda m: 'explained' in m)['explained']
                    if answer.get('material') != 'car paint':
                        continue
                    with self.subTest(x=x, y=y, coat=coat):
                        self.adds_up(answer)
                    sun_there = next(light for light in answer['lights'] if light['name'] == 'sun')
                    by_way_of_the_horizon += sun_there['state'] == 'lit' and any(
                        cover['name'] == 'mirrored at the horizon' and cover['specular'][1] > 1e-3 for cover in sun_there.get('covers', []))
            self.assertGreater(by_way_of_the_horizon, 3)

    def test_an_explained_lobe_lies_opposite_the_viewer(self):
        _, page = self.open(SOURCE / 'scenes/first_scene.json', *SIZE, '--spp', 1, '--set', '/materials/red/roughness=0.1')
        page.until(is_done)
        oblique = 0
        for x, y in ((72, 40), (86, 40), (80, 50)):
            page.send({'explain': x, 'y': y})
            answer = page.until(lambda m: 'explained' in m)['explained']
            lobe = answer['lobe']
            if answer['material'] != 'red' or lobe['view_deg'] > -10:
                continue
            oblique += 1
            peak = max(range(len(lobe['specular'])), key=lobe['specular'].__getitem__)
            # The curve's own step is a degree; a lobe of roughness 0.1 peaks that near to the mirror direction.
            self.assertAlmostEqual(lobe['first_deg'] + peak, -lobe['view_deg'], delta=1.5)
        self.assertGreater(oblique, 0)

    def test_it_refines_while_nothing_moves(self):
        _, page = self.open(SCENE, '--size', '320x180', '--spp', 64)
        page.until(is_done)
        answer = self.set(page, '/materials/red/roughness', 0.8)
        counts = []
        while not counts or counts[-1] != 64:
            head = page.until(lambda m: m.get('kind') == 1)
            if head['revision'] >= answer['revision']:
                counts.append(head['samples'])
        self.assertEqual(counts, sorted(counts))
        self.assertEqual(counts[0], 1)

    def test_a_page_is_sent_what_has_changed(self):
        server, page = self.open(SCENE, '--size', '64x36', '--spp', '1')

        def pixels_sent(before, after):
            """How many pixels came for the second colour. Where pictures take 16 ms or more, those that move are
            smaller, and the one after them comes whole: that is another path, and it is tried again."""
            for _ in range(50):
                sizes = []
                for color in before, after:
                    sizes.clear()
                    answer = self.set(page, '/materials/red/base_color', color)
                    head = page.until(lambda m: m.get('kind') == 1 and m['revision'] >= answer['revision'] and (
                        sizes.append(m['width']) or is_done(m)))
                if sizes == [64]:
                    return head['part_width'] * head['part_height'], head['pixels']
            self.fail('every picture that moved was smaller')

        page.until(is_done)
        sent, pixels = pixels_sent([0, 1, 0], [0, 0, 1])
        self.assertTrue(0 < sent < 64 * 36 / 2, sent)
        other = server.upgrade()
        self.addCleanup(other.close)
        self.assertEqual(other.until(is_done)['pixels'], pixels)
        self.assertEqual(pixels_sent([0, 0, 1], [0, 0, 1]), (0, pixels))

    def test_pieces_of_pictures(self):
        """A picture made while things move comes whole; a refined one is left where a change overtakes it."""
        def piece(page, wanted=lambda m: True):
            return next(m for m in iter(page.message, None) if m.get('kind') == 1 and wanted(m))

        server, slow = self.open(SCENE, '--size', '1280x720', '--spp', '4')
        head = piece(slow)
        self.assertEqual((head['moving'], head['piece']), (1, 0))
        self.assertGreater(head['pieces'], 2)
        quick = server.upgrade()
        self.addCleanup(quick.close)
        quick.until(is_done)
        slow.whole(head)
        while head['piece'] + 1 < head['pieces']:
            slow.send('taken')
            before, head = head, piece(slow)
            slow.whole(head)
            self.assertEqual((head['moving'], head['piece']), (1, before['piece'] + 1))
        slow.send('taken')
        # Now the refined one, of which two pieces come.
        head = piece(slow)
        self.assertEqual((head['moving'], head['piece']), (0, 0))
        self.assertGreater(head['pieces'], 2)
        answer = self.set(quick, '/materials/red/base_color', [0, 1, 0])
        quick.until(lambda m: m.get('kind') == 1 and m['revision'] >= answer['revision'])
        self.assertEqual(piece(slow)['piece'], 1)
        slow.send('taken')
        slow.send('taken')
        head = piece(slow)
        self.assertEqual((head['moving'], head['piece']), (1, 0))
        self.assertGreaterEqual(head['revision'], answer['revision'])
        slow.send('taken')
        slow.whole(head)
        whole = slow.until(is_done)
        self.assertEqual(whole['pixels'], quick.until(is_done)['pixels'])

    def two_pages(self, *options):
        """Both have the first picture. Tests answer for the second themselves: "taken" comes late."""
        server, quick = self.open(SCENE, *options)
        quick.until(is_done)
        slow = server.upgrade()
        self.addCleanup(slow.close)
        slow.until(is_done)
        return quick, slow

    def test_pieces_that_were_left_are_no_picture(self):
        """What a page has of a picture that was overtaken is not what the next one is told against."""
        quick, slow = self.two_pages('--size', '1280x720', '--spp', '1')
        quick.send({'look': 'neutral', 'layer': '', 'exposure': 1})
        quick.until(is_done)
        pieces = [m for m in (slow.message() for _ in range(2)) if m.get('kind') == 1]
        self.assertEqual([m['piece'] for m in pieces], [0, 1])
        self.assertGreater(pieces[0]['pieces'], 2)
        answer = self.set(quick, '/materials/red/roughness', 0.3)
        now = quick.until(lambda m: is_done(m) and m['revision'] >= answer['revision'])
        slow.send('taken')
        slow.send('taken')
        self.assertEqual(slow.until(lambda m: is_done(m) and m['revision'] >= answer['revision'])['pixels'], now['pixels'])

    def test_pictures_on_their_way_are_what_the_next_is_told_against(self):
        """A refined picture that is sent whole will be shown, though the page has not said so yet."""
        quick, slow = self.two_pages('--size', '320x180', '--spp', '4')
        answer = self.set(quick, '/materials/red/base_color', [0, 1, 0])
        slow.until(lambda m: m.get('kind') == 1 and m['revision'] >= answer['revision'] and m['moving'] == 1)
        head = next(m for m in iter(slow.message, None) if m.get('kind') == 1)
        self.assertEqual((head['moving'], head['piece'], head['pieces']), (0, 0, 1))
        slow.whole(head)
        quick.until(is_done)
        answer = self.set(quick, '/materials/red/base_color', [0, 0, 1])

        def moves(m):
            return m.get('kind') == 1 and m['revision'] >= answer['revision'] and m['moving'] == 1

        now = quick.until(moves)
        slow.send('taken')
        self.assertEqual(slow.until(moves)['pixels'], now['pixels'])

    def test_conversions_are_those_of_convert(self):
        _, page = self.open()
        page.until(is_done)
        page.send({'convert': '/materials/red', 'model': 'blinn_phong'})
        value = page.until(lambda m: 'changed' in m)['value']
        self.assertEqual(value['model'], 'blinn_phong')
        text = subprocess.run([PROGRAM, 'convert', '{"model": "metallic_roughness", "base_color": [0.8, 0.1, 0.08], "roughness": 0.3}',
                               '--to', 'blinn_phong', '--quiet'], capture_output=True, text=True, check=True, timeout=60).stdout
        self.assertEqual(value, json.loads(text))

    def test_metrics_are_those_of_compare(self):
        _, page = self.open()
        page.until(is_done)
        page.send({'keep': True})
        self.assertTrue(page.until(lambda m: 'kept' in m)['kept'])
        self.assertEqual(page.until(lambda m: 'metrics' in m)['metrics']['rmse'], 0)
        answer = self.set(page, '/materials/red/roughness', 0.7)
        metrics = page.until(lambda m: 'metrics' in m and m['revision'] >= answer['revision'])['metrics']
        with tempfile.TemporaryDirectory() as folder:
            paths = [pathlib.Path(folder, f'{name}.exr') for name in 'ab']
            for path, change in zip(paths, ((), ('--set', '/materials/red/roughness=0.7'))):
                subprocess.run([PROGRAM, 'render', SCENE, *SIZE, '--spp', '8', *change, '-o', path, '--depth', 'float', '--quiet'],
                               check=True, timeout=120)
            text = subprocess.run([PROGRAM, 'compare', paths[1], paths[0], '--metrics', 'ssim,flip', '--json'], capture_output=True,
                                  text=True, check=False, timeout=120).stdout
        beauty, = (layer for layer in json.loads(text)['layers'] if layer['layer'] in ('', 'beauty'))
        beauty['flip'] = beauty['flip']['mean']
        # The same samples, by the same functions; but a file's channels are summed in the order of their names.
        for name, value in metrics.items():
            with self.subTest(metric=name):
                if isinstance(value, float):
                    self.assertAlmostEqual(value / beauty[name], 1, delta=1e-14)
                else:
                    self.assertEqual(value, beauty[name])
        page.send({'keep': False})
        page.until(lambda m: m.get('kept') is False)

    def test_files_to_take_away(self):
        _, page = self.open()
        page.until(is_done)
        page.send({'take': 'report'})
        self.assertIn('no A', page.until(lambda m: 'fault' in m)['faults'][0]['what'])
        with tempfile.TemporaryDirectory() as folder:
            exr = pathlib.Path(folder, 'a.exr')
            subprocess.run([PROGRAM, 'render', SCENE, *SIZE, '--spp', '8', '--layers', 'all', '--reproducible', '--quiet', '-o', exr],
                           check=True, timeout=120)
            page.send({'take': 'exr'})
            self.assertEqual(page.until(lambda m: m.get('kind') == 3)['pixels'], exr.read_bytes())
        page.send({'keep': True})
        page.until(lambda m: 'kept' in m)
        self.set(page, '/materials/red/roughness', 0.7)
        page.until(is_done)
        page.send({'take': 'report'})
        html = page.until(lambda m: m.get('kind') == 4)['pixels'].decode()
        self.assertTrue(html.startswith('<!DOCTYPE html>'))
        self.assertIn('B against A', html)

    def test_images_are_shown_by_the_report(self):
        with tempfile.TemporaryDirectory() as folder:
            images = [pathlib.Path(folder, f'{name}.exr') for name in 'ab']
            for image, spp in zip(images, '12'):
                subprocess.run([PROGRAM, 'render', SCENE, *SIZE, '--spp', spp, '-o', image, '--quiet'], check=True, timeout=60)
            with Server(PROGRAM, *images, '--quiet') as server:
                status, headers, body = server.request(f'/{server.token}/')
                self.assertEqual(status, 200)
                self.assertIn(b'a.exr against b.exr', body)
                self.assertNotIn('unsafe', headers['content-security-policy'])
                # Pages are told of a broken file, and keep what they show; a good one is to be loaded.
                page = server.upgrade()
                self.assertEqual(page.until(lambda m: True), {'banner': ''})
                whole = images[1].read_bytes()
                images[0].write_bytes(b'no image')
                self.assertIn('a.exr', page.until(lambda m: True)['banner'])
                self.assertEqual(server.request(f'/{server.token}/')[2], body)
                images[0].write_bytes(whole)
                self.assertEqual(page.until(lambda m: 'reload' in m), {'reload': True})
                self.assertNotEqual(server.request(f'/{server.token}/')[2], body)
                page.close()
            result = subprocess.run([PROGRAM, 'view', '--no-open', images[0], SCENE], capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(result.returncode, 64)
            self.assertIn('one scene, or images', result.stderr)
            result = subprocess.run([PROGRAM, 'view', '--no-open', images[0], '--spp', '4'], capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(result.returncode, 64)
            self.assertIn('--spp: cannot be used with images', result.stderr)

    def test_conversions_keep_the_maps_that_both_models_have(self):
        _, page = self.open(SOURCE / 'scenes/textures.json', *SIZE, '--spp', 1)
        page.until(is_done)
        page.send({'convert': '/materials/planet', 'model': 'phong'})
        value = page.until(lambda m: 'changed' in m or 'fault' in m)['value']
        before = json.loads((SOURCE / 'scenes/textures.json').read_text(encoding='utf-8'))['materials']['planet']
        self.assertEqual((value['model'], value['diffuse_map']), ('phong', before['base_color_map']))
        self.assertEqual(page.until(lambda m: 'not_kept' in m)['not_kept'][0], 'metallic_roughness_map')

    def test_memory_stays_flat(self):
        """Some seconds of dragging with four pages open; NACRE_VIEW_SECONDS for more."""
        size = ('--size', '640x360', '--spp', 16)
        server, page = self.open(SCENE, *size)
        others = [server.upgrade() for _ in range(3)]
        takers = [threading.Thread(target=self.take_all, args=(other,)) for other in others]
        for taker in takers:
            taker.start()
        page.until(is_done)
        seconds, count, sizes = float(os.environ.get('NACRE_VIEW_SECONDS', 5)), 0, []
        start = time.monotonic()
        while time.monotonic() - start < seconds:
            count += 1
            self.set(page, '/materials/red/roughness', 0.2 + 0.3 * (1 + math.sin(count / 7)), gesture=count // 50 + 1)
            if count % 40 == 0:
                time.sleep(0.15)  # it refines
            if time.monotonic() - start > seconds / 3:
                sizes.append(server.memory_mib())
        print(f'{count} changes in {seconds:.0f} s; {sizes[0]:.0f} MiB after a third, {max(sizes):.0f} at most, {sizes[-1]:.0f} at the end', flush=True)
        server.close()
        for taker in takers:
            taker.join()
        self.assertLess(sizes[-1] - sizes[0], 20)
        # `render` of the scene takes less than 40.
        self.assertLess(max(sizes), 300)

    @staticmethod
    def take_all(page):
        """A page that takes its pictures until the server goes."""
        try:
            page.until(lambda m: False)
        except OSError:
            page.close()

    def test_edits_outlive_the_server(self):
        """However it ends: the next one of the scene offers them, and does with them what it is told."""
        edits = {'/materials/red/roughness': 0.75, '/camera': {'position': [2, 2, 5]}}
        for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
            with tempfile.TemporaryDirectory() as state, self.subTest(number=number):
                def start():
                    with unittest.mock.patch.dict(os.environ, TZ='XYZ-5:30'):
                        server = Server(PROGRAM, SCENE, *SIZE, '--spp', 1, state=state)
                    self.addCleanup(server.close)
                    page = server.upgrade()
                    self.addCleanup(page.close)
                    return server, page, page.until(lambda m: 'scene' in m)

                def end(server, number=signal.SIGTERM):
                    server.process.send_signal(number)
                    return server.process.communicate(timeout=20)[1]

                server, page, told = start()
                self.assertIsNone(told['offered'])
                before = told['scene']
                for pointer, value in edits.items():
                    self.set(page, pointer, value)
                if number == signal.SIGKILL:  # nothing can be done then: it was done before
                    time.sleep(0.6)
                else:
                    page.send({'set': '/background', 'value': 0.5})  # kept, though it was a moment ago
                    page.send({'samples': '', 'id': 1})
                    page.until(lambda m: m.get('kind') == 2)
                errors = end(server, number)
                # Nobody decides, and there are new ones: nothing is lost.
                server, page, told = start()
                count = told['offered']['edits']
                self.assertEqual(count, 2 if number == signal.SIGKILL else 3)
                self.assertLess(abs(told['offered']['time'] - time.time()), 600)
                here = time.strftime('%Y-%m-%d %H:%M', time.gmtime(told['offered']['time'] + (5 * 60 + 30) * 60))
                self.assertEqual(told['scene'], before)
                self.set(page, '/lights/key/intensity', 7)
                errors = end(server)
                self.assertIn(f'note: {count} edits of {here} were not saved; the page offers them', errors)
                # Restored, as one step.
                server, page, told = start()
                self.assertEqual(told['offered']['edits'], count + 1)
                page.send({'offered': 'restore'})
                told = page.until(lambda m: 'scene' in m)
                self.assertIsNone(told['offered'])
                self.assertEqual(told['scene']['materials']['red']['roughness'], 0.75)
                self.assertEqual(told['scene']['camera'], edits['/camera'])
                self.assertEqual(told['scene']['lights']['key']['intensity'], 7)
                page.send({'history': 'undo'})
                self.assertEqual(page.until(lambda m: 'scene' in m)['scene'], before)
                page.send({'history': 'redo'})
                self.assertEqual(page.until(lambda m: 'scene' in m)['scene'], told['scene'])
                end(server, signal.SIGTERM)
                # They are those of the next one, until they are undone or forgotten.
                server, page, told = start()
                self.assertEqual(told['offered']['edits'], count + 1)
                page.send({'offered': 'discard'})
                told = page.until(lambda m: 'scene' in m)
                self.assertEqual((told['offered'], told['scene']), (None, before))
                self.set(page, '/background', 0.25)
                page.send({'history': 'undo'})
                page.until(lambda m: 'scene' in m)
                end(server)
                self.assertEqual(os.listdir(pathlib.Path(state, 'nacre')), [])
                server, page, told = start()
                self.set(page, '/background', 0.25)
                end(server)
                server, page, told = start()
                self.assertRegex(end(server), 'note: 1 edit of 20.* was not saved; the page offers it\n')

    def test_edits_that_have_been_saved_are_not_offered(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, 's.json')
            scene.write_bytes(SCENE.read_bytes())
            with Server(PROGRAM, scene, *SIZE, '--spp', 1, '--quiet', state=folder) as server:
                page = server.upgrade()
                page.until(is_done)
                self.set(page, '/materials/red/roughness', 0.75)
                self.set(page, '/materials/new', {'model': 'lambert'})
                page.send({'history': 'reset'})
                page.until(lambda m: 'scene' in m)
                page.send({'history': 'undo'})
                tree = page.until(lambda m: 'scene' in m)['scene']
                # Taken away as JSON, and put in the place of the file.
                scene.write_text(json.dumps(tree), encoding='utf-8')
                page.until(lambda m: 'scene' in m)
                page.close()
                server.process.terminate()
                server.process.wait(20)
            with Server(PROGRAM, scene, *SIZE, '--spp', 1, '--quiet', state=folder) as server:
                page = server.upgrade()
                told = page.until(lambda m: 'scene' in m)
                self.assertEqual((told['offered'], told['scene']), (None, tree))
                page.close()

    def test_two_servers_of_one_scene(self):
        """The second keeps nothing, and says so; what the first keeps stays its own."""
        with tempfile.TemporaryDirectory() as state:
            with Server(PROGRAM, SCENE, *SIZE, state=state) as first, Server(PROGRAM, SCENE, *SIZE, state=state) as second:
                pages = [first.upgrade(), second.upgrade()]
                for page, value in zip(pages, (0.6, 0.7)):
                    page.until(is_done)
                    self.set(page, '/materials/red/roughness', value)
                    page.close()
                second.process.terminate()
                self.assertIn('another nacre view', second.process.communicate(timeout=20)[1])
            kept, = pathlib.Path(state, 'nacre').iterdir()
            self.assertEqual([edit['value'] for edit in json.loads(kept.read_text(encoding='utf-8'))['edits']], [0.6])

    def test_pages_share_one_history(self):
        """Changes of two pages, each with gestures of its own, go back and come again in their order, for both."""
        server, page = self.open()
        other = server.upgrade()
        self.addCleanup(other.close)
        page.until(is_done)
        other.until(is_done)

        def told(what):
            page.send({'history': what})
            trees = [p.until(lambda m: 'scene' in m)['scene'] for p in (page, other)]
            self.assertEqual(*trees)
            return trees[0]

        self.set(page, '/background', 0.5)
        told('undo')
        # Two gestures at a time, of two pages, change by change; then one of two values.
        for i, (who, pointer, value, gesture) in enumerate((
                (page, '/materials/red/roughness', 0.4, 1), (other, '/materials/red/metallic', 0.5, 2),
                (page, '/materials/red/roughness', 0.5, 1), (other, '/materials/red/metallic', 0.6, 2),
                (page, '/materials/red/roughness', 0.6, 3), (page, '/materials/red/metallic', 0.7, 3))):
            answer = self.set(who, pointer, value, gesture=gesture, serial=i + 1)
            for watcher in (page, other):
                if watcher is not who:
                    self.assertEqual(watcher.until(lambda m: 'changed' in m)['revision'], answer['revision'])
        seen = []
        for _ in range(5):
            tree = told('undo')['materials']['red']
            seen.append((tree['roughness'], tree.get('metallic', 0)))
        self.assertEqual(seen, [(0.5, 0.6), (0.5, 0.5), (0.4, 0.5), (0.4, 0), (0.3, 0)])
        for expected in [(0.4, 0), (0.4, 0.5), (0.5, 0.5), (0.5, 0.6), (0.6, 0.7)]:
            tree = told('redo')['materials']['red']
            self.assertEqual((tree['roughness'], tree.get('metallic', 0)), expected)

    def test_each_page_keeps_its_own_a(self):
        """Measured each against its own, also after the other has dropped or kept anew."""
        server, page = self.open()
        other = server.upgrade()
        self.addCleanup(other.close)
        page.until(is_done)
        other.until(is_done)

        def rmse(who, revision):
            return who.until(lambda m: 'metrics' in m and m['revision'] >= revision)['metrics']['rmse']

        def keep(who, kept=True):
            who.send({'keep': kept})
            self.assertEqual(who.until(lambda m: 'kept' in m)['kept'], kept)

        keep(page)
        answer = self.set(page, '/materials/red/roughness', 0.7)
        for who in (page, other):
            self.rested(who, answer['revision'])
        keep(other)
        far = rmse(page, answer['revision'])
        self.assertGreater(far, 0)
        self.assertEqual(rmse(other, answer['revision']), 0)
        answer = self.set(other, '/materials/red/roughness', 0.3)
        self.assertEqual(rmse(page, answer['revision']), 0)
        self.assertEqual(rmse(other, answer['revision']), far)
        keep(other, False)
        answer = self.set(other, '/materials/red/roughness', 0.7)
        self.assertEqual(rmse(page, answer['revision']), far)
        other.send({'take': 'report'})
        self.assertIn('no A', other.until(lambda m: 'fault' in m)['faults'][0]['what'])

    def test_the_address_stays_where_a_port_is_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            before = os.environ.get('XDG_RUNTIME_DIR')
            os.environ['XDG_RUNTIME_DIR'] = folder
            try:
                first = Server(PROGRAM, SCENE, *SIZE, '--quiet')
                port = first.port
                first.close()
                self.assertEqual(os.listdir(folder), [])
                urls = set()
                for _ in range(2):
                    with Server(PROGRAM, SCENE, *SIZE, '--quiet', '--port', port) as server:
                        urls.add(server.url)
                self.assertEqual(len(urls), 1)
                kept, = pathlib.Path(folder).iterdir()
                self.assertEqual(kept.stat().st_mode & 0o777, 0o600)
                # One that others may read is not believed.
                kept.chmod(0o644)
                with Server(PROGRAM, SCENE, *SIZE, '--quiet', '--port', port) as server:
                    self.assertNotIn(server.url, urls)
            finally:
                if before is None:
                    del os.environ['XDG_RUNTIME_DIR']
                else:
                    os.environ['XDG_RUNTIME_DIR'] = before


if __name__ == '__main__':
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
