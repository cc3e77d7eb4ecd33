#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""nacre's reports in headless Chromium: what the page shows is what the files hold.

Usage: browser_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
Exits with 77, which ctest counts as skipped, where Chromium or its driver is missing; with 1
where nothing may be skipped (NACRE_SKIP_NOTHING).
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import pictures
import webdriver

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
TONES = ['neutral', 'reinhard', 'reinhard_extended', 'aces', 'agx', 'none']
PHONE, DESK = (390, 844), (1280, 900)
SIZE = (96, 64)
# Spheres, edges and background of the picture.
PIXELS = [(48, 32), (40, 20), (55, 30), (60, 45), (5, 5), (95, 63), (0, 60)]


def nacre(*arguments):
    result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                            timeout=300, check=False)
    assert result.returncode in (0, 1), result.stderr
    return result


class BrowserTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.out = pathlib.Path(cls.folder.name)
        scene = SOURCE / 'scenes/first_scene.json'
        size = ['--size', 'x'.join(map(str, SIZE)), '--compression', 'none', '--reproducible']
        nacre('render', scene, '-o', cls.out / 'a.exr', '--spp', 4, '--layers', 'all', *size)
        nacre('render', scene, '-o', cls.out / 'b.exr', '--spp', 1, '--layers', 'all',
              '--set', '/lights/key/intensity=500', *size)
        cls.a = pictures.read_exr(cls.out / 'a.exr')
        cls.b = pictures.read_exr(cls.out / 'b.exr')
        cls.browser = webdriver.Browser()
        cls.addClassCleanup(cls.browser.close)

    def report(self, *inputs, width=DESK, options=()):
        path = self.out / 'report.html'
        nacre('report', path, *inputs, '--metrics', 'ssim,flip', *options)
        self.browser.resize(*width)
        self.browser.open(path)
        return path

    def tearDown(self):
        """Nothing on the console, nothing from a network, whatever was done."""
        messages = [entry['message'] for entry in self.browser.log('browser')]
        self.assertEqual(messages, [])
        # Objects that were to be spelt out: 'textContent' has what is folded away as well.
        self.assertNotIn('[object', self.browser.script('return document.body.textContent'))
        urls = []
        for entry in self.browser.log('performance'):
            message = json.loads(entry['message'])['message']
            if message['method'] == 'Network.requestWillBeSent':
                urls.append(message['params']['request']['url'])
        self.assertTrue(any(url.startswith('file:') for url in urls))  # the log is one
        self.assertEqual([url for url in urls if not url.startswith(('file:', 'data:'))], [])
        self.assertLessEqual(len([url for url in urls if url.startswith('file:')]), 1)

    # ---- What the page says ----

    def focus(self):
        self.browser.wait('return document.querySelector(".viewer").dataset.ready')
        self.browser.script('document.querySelector(".pane").focus()')

    def reading(self, row=0):
        """What the read-out says: (x, y, values, codes)."""
        return self.browser.script('''
            const read = document.querySelector('.read'), head = read.querySelector('[data-x]');
            const row = read.querySelectorAll('tbody tr')[arguments[0]];
            const numbers = (name) => {
              const cell = row.querySelector(`[${name}]`);
              return cell && cell.getAttribute(name).split(' ').map(Number);
            };
            return [Number(head.dataset.x), Number(head.dataset.y), numbers('data-values'),
                    numbers('data-codes')];''', row)

    def inspect(self, x, y):
        """By the keyboard: Shift and arrows, from wherever the mark is."""
        at = self.reading()
        for keys, steps in (('right', x - at[0]), ('down', y - at[1])):
            key = keys if steps > 0 else {'right': 'left', 'down': 'up'}[keys]
            if steps:
                self.browser.press(*[key] * abs(steps), shift=True)
        self.browser.wait('''const head = document.querySelector('.read [data-x]');
                             return head.dataset.x == arguments[0] && head.dataset.y == arguments[1]''',
                          x, y)
        return self.reading()

    def check_codes(self, tone, exposure):
        """The display codes are those of nacre tonemap, or one off (color/display.h says why)."""
        png = self.out / 'code.png'
        nacre('tonemap', self.out / 'a.exr', '-o', png, '--tonemap', tone, '--exposure', exposure)
        rows = pictures.read_png(png)
        for x, y in PIXELS:
            _, _, _, codes = self.inspect(x, y)
            for got, expected in zip(codes, rows[y][x]):
                self.assertLessEqual(abs(got - expected), 1, (tone, exposure, x, y))

    def check_width(self):
        wide = self.browser.script('return document.scrollingElement.scrollWidth - innerWidth')
        self.assertLessEqual(wide, 0)

    def ready_after(self, action):
        """The viewer has shown what the action asked for."""
        before = self.browser.script('return document.querySelector(".viewer").dataset.ready')
        action()
        self.browser.wait('return document.querySelector(".viewer").dataset.ready !== arguments[0]',
                          before)

    def mode(self):
        return self.browser.script(
            'return document.querySelector("[data-mode][aria-pressed=true]").dataset.mode')

    def canvas_pixel(self, part_x, part_y):
        """The colour that the first canvas shows there."""
        return self.browser.script('''
            return new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => {
              const from = document.querySelector('.pane canvas');
              const to = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true});
              to.drawImage(from, -Math.floor(arguments[0] * from.width),
                           -Math.floor(arguments[1] * from.height));
              done([...to.getImageData(0, 0, 1, 1).data].slice(0, 3));
            })))'''.replace('arguments[0]', repr(part_x)).replace('arguments[1]', repr(part_y)))

    # ---- Tests ----

    def test_pixels_are_those_of_the_file(self):
        for width in DESK, PHONE:
            self.report(self.out / 'a.exr', width=width)
            self.focus()
            for x, y in PIXELS:
                got = self.inspect(x, y)
                self.assertEqual(got[:2], [x, y])
                self.assertEqual(got[2], [self.a[c][y][x] for c in 'RGB'])
            self.check_width()

    def test_codes_are_those_of_tonemap(self):
        self.report(self.out / 'a.exr')
        self.focus()
        for tone in TONES:
            self.check_codes(tone, 0)
            self.ready_after(lambda: self.browser.press('t'))

    def test_the_exposure_slider_and_its_number(self):
        self.report(self.out / 'a.exr', options=['--tonemap', 'aces'])
        self.focus()
        self.browser.script('document.querySelector("input[type=range]").focus()')
        self.ready_after(lambda: self.browser.press(*['right'] * 10))  # steps of 0.05
        self.browser.wait('return document.querySelector("input[type=number]").value == 0.5')
        self.browser.script('document.querySelector(".pane").focus()')
        self.check_codes('aces', 0.5)
        self.ready_after(lambda: self.browser.press('e', 'e'))
        self.browser.wait('return document.querySelector("input[type=number]").value == 1')
        self.check_codes('aces', 1)

    def test_layers(self):
        self.report(self.out / 'a.exr')
        self.focus()
        layers = self.browser.script('''return [...document.querySelectorAll('select')].map(
            s => [...s.options].map(o => o.value)).find(o => o.includes('diffuse'))''')
        self.assertEqual(layers[0], '')
        self.assertIn('id.object', layers)
        for layer in layers[1:]:
            self.ready_after(lambda: self.browser.press('l'))
            x, y = 48, 32
            names = sorted((name for name in self.a if name.rpartition('.')[0] == layer or name == layer),
                           key=lambda name: 'RGBXYZ'.find(name[-1]))
            self.assertEqual(self.inspect(x, y)[2], [self.a[name][y][x] for name in names], layer)

    def test_comparison_slider_flip_and_error_map(self):
        self.report(self.out / 'b.exr', self.out / 'a.exr')
        self.focus()
        self.assertEqual(self.inspect(48, 32)[2], [self.b[c][32][48] for c in 'RGB'])
        self.assertEqual(self.reading(1)[2], [self.a[c][32][48] for c in 'RGB'])
        self.ready_after(lambda: self.browser.press('1'))
        image = self.canvas_pixel(0.51, 0.51)
        self.ready_after(lambda: self.browser.press('f'))
        reference = self.canvas_pixel(0.51, 0.51)
        self.assertNotEqual(image, reference)
        self.ready_after(lambda: self.browser.press(' '))
        self.assertEqual(self.canvas_pixel(0.51, 0.51), image)
        # The slider: what is right of it is the reference.
        self.ready_after(lambda: self.browser.press('m'))
        self.assertEqual(self.mode(), 'slider')
        self.ready_after(lambda: self.browser.script('document.querySelector(".split").focus()')
                         or self.browser.press(*['right'] * 10))
        self.browser.wait('return document.querySelector(".split").value == 0.55')
        self.assertEqual(self.canvas_pixel(0.51, 0.51), image)
        self.ready_after(lambda: self.browser.press(*['left'] * 20))
        self.browser.wait('return document.querySelector(".split").value == 0.45')
        self.assertEqual(self.canvas_pixel(0.51, 0.51), reference)
        self.browser.script('document.querySelector(".pane").focus()')
        self.ready_after(lambda: self.browser.press('m'))
        self.assertEqual(self.mode(), 'side')
        self.assertEqual(self.browser.script('return document.querySelectorAll(".pane").length'), 2)
        self.ready_after(lambda: self.browser.press('m'))
        self.assertEqual(self.mode(), 'error')
        self.check_error_maps()

    def check_error_maps(self):
        quantities = self.browser.script('''return [...document.querySelectorAll('select')].map(
            s => [...s.options].map(o => o.value)).find(o => o.includes('signed'))''')
        self.assertEqual(quantities, ['relative', 'absolute', 'signed', 'flip'])
        seen = set()
        for quantity in quantities:
            self.ready_after(lambda: self.browser.script('''
                const select = [...document.querySelectorAll('select')].find(
                    s => [...s.options].some(o => o.value === 'signed'));
                select.value = arguments[0];
                select.dispatchEvent(new Event('change'));''', quantity))
            seen.add((tuple(self.canvas_pixel(0.51, 0.51)), self.browser.script(
                'return document.querySelector(".legend svg").getAttribute("aria-label")')))
        self.assertEqual(len(seen), len(quantities))

    def test_metric_table_says_what_compare_says(self):
        figures = json.loads(nacre('compare', self.out / 'b.exr', self.out / 'a.exr', '--metrics',
                                   'ssim', '--json').stdout)['layers']
        figures = next(layer for layer in figures if layer['layer'] == 'beauty')
        self.report(self.out / 'b.exr', self.out / 'a.exr')
        self.focus()
        table = self.browser.script('''
            const table = [...document.querySelectorAll('table')].find(t => t.caption &&
                t.caption.textContent.includes('against'));
            return [...table.rows].filter(r => ['layer', 'beauty'].includes(r.cells[0].textContent)).map(r => [...r.cells].map(c => c.textContent))''')
        for name, key, digits in ('RMSE', 'rmse', 4), ('SSIM', 'ssim', 5):
            shown = float(table[1][table[0].index(name)])
            self.assertAlmostEqual(shown, figures[key], delta=0.6 * 10 ** -digits * 10)

    def test_help_and_focus(self):
        self.report(self.out / 'a.exr')
        self.focus()
        self.browser.press('?')
        self.browser.wait('return document.querySelector("dialog").open')
        self.browser.press('escape')
        self.browser.wait('return !document.querySelector("dialog").open')
        nameless = self.browser.script('''
            return [...document.querySelectorAll('button, select, input, [tabindex]')].filter(e =>
                !e.textContent.trim() && !e.getAttribute('aria-label') && !e.closest('label')).length''')
        self.assertEqual(nameless, 0)
        self.browser.press('tab')
        outline = self.browser.script('return getComputedStyle(document.activeElement).outlineStyle')
        self.assertEqual(outline, 'solid')

    def test_zoom_and_pan(self):
        self.report(self.out / 'a.exr')
        self.focus()
        whole = self.canvas_pixel(0.02, 0.02)
        self.browser.press('+', '+', '+', '+', '+', '+', 'right', 'right', 'down')
        zoom = 'return document.querySelector("output").textContent'
        self.assertGreater(float(self.browser.wait(zoom).split()[0]), 1000)
        self.browser.press('0')
        self.assertEqual(self.canvas_pixel(0.02, 0.02), whole)

    def test_names_are_text(self):
        evil = self.out / '<img src=x onerror=alert(1)>&"\'.exr'
        evil.write_bytes((self.out / 'a.exr').read_bytes())
        self.report(evil, self.out / 'a.exr', options=['--title', '</title><script>alert(1)</script>'])
        self.focus()
        self.assertEqual(self.browser.script('return document.querySelectorAll("img").length'), 0)
        self.assertIn(evil.name, self.browser.script('return document.querySelector(".name").textContent'))
        self.assertEqual(self.browser.script('return document.title'), '</title><script>alert(1)</script>')

    def test_what_had_to_shrink_is_said(self):
        self.report(self.out / 'a.exr', options=['--limit', '0.1'])
        self.focus()
        self.assertIn('is the mean of', self.browser.script('return document.querySelector(".note").textContent'))
        x, y, values, _ = self.reading()
        text = self.browser.script('return document.querySelector(".read th").textContent')
        factor = int(text.split('mean of ')[1].split('×')[0])
        x0, y0 = x - x % factor, y - y % factor
        for value, name in zip(values, 'RGB'):
            cell = [v for row in self.a[name][y0:y0 + factor] for v in row[x0:x0 + factor]]
            # A half is within 2^-11 of the mean.
            self.assertAlmostEqual(value, sum(cell) / len(cell), delta=abs(value) * 2 ** -11 + 1e-7)

    def test_the_plan_of_a_render_is_spelt_out(self):
        """Its lists of objects too: tearDown looks for those that were not."""
        self.report(SOURCE / 'scenes/area_lights.json', options=['--size', '64x36', '--spp', '1'])
        self.assertIn('in closed form', self.browser.script('return document.body.textContent'))

    def test_validation_opens_its_cases(self):
        folder = self.out / 'references'
        folder.mkdir(exist_ok=True)
        nacre('render', SOURCE / 'scenes/first_scene.json', '-o', folder / 'one.exr', '--depth', 'float')
        (folder / 'one.json').write_text((SOURCE / 'scenes/first_scene.json').read_text())
        case = {'scene': 'one.json', 'image': 'one.exr', 'layers': [''], 'reason': 'the same bits',
                'tolerances': {}}
        (folder / 'one.reference.json').write_text(json.dumps(case))
        (folder / 'two.reference.json').write_text(json.dumps({**case, 'image': 'none.exr'}))
        for width in DESK, PHONE:
            self.report(folder, width=width)
            self.focus()
            cells = self.browser.script('''return [...document.querySelectorAll('tbody tr')].slice(0, 2).map(
                r => r.cells[1].textContent)''')
            self.assertEqual(cells, ['match', 'error'])
            self.ready_after(lambda: self.browser.script('document.querySelector("td button").click()'))
            self.check_width()

    def test_benchmark_is_drawn(self):
        data = {'machine': {'processor': '<b>cpu', 'cores': 2}, 'settings': {'precision_size': '96x54'},
                'targets': ['scalar', 'avx2'], 'best_target': 'avx2', 'summary': {'a_over_b': 3.5},
                'benchmarks': {f'shade/lambert/{t}': {'ns': [5.0, 7.0, 6.0], 'counters': {'items_per_second': r}}
                               for t, r in (('scalar', 1e8), ('avx2', 1e9))},
                'processes': {'grid': {'seconds': [0.02, 0.03, 0.01], 'mib': [16, 17, 18]}},
                'precision': {'frame': {'avx2': [{'spp': s, 'seconds': 1e-3 * s, 'rel_mse': 1e-2 / s}
                                                 for s in (1, 4, 16)]}}}
        (self.out / 'bench.json').write_text(json.dumps(data))
        for width in DESK, PHONE:
            self.report(self.out / 'bench.json', width=width)
            self.browser.wait('return document.querySelectorAll("svg.plot").length >= 2')
            text = self.browser.script('return document.body.textContent')
            self.assertIn('<b>cpu', text)
            self.assertIn('20', text)  # the median, ms
            self.check_width()


if __name__ == '__main__':
    if webdriver.missing():
        print(f'skipped: no {" and no ".join(webdriver.missing())}\n  hint: scripts/setup --ci')
        sys.exit(1 if os.environ.get('NACRE_SKIP_NOTHING') else 77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
