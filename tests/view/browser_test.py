#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`nacre view` in headless Chromium: what a hand does arrives in the picture, and how fast.

Usage: browser_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
Exits with 77, which ctest counts as skipped, where Chromium or its driver is missing; with 1
where nothing may be skipped (NACRE_SKIP_NOTHING).
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / 'report'))
import pictures  # noqa: E402
import webdriver  # noqa: E402
from server import Server  # noqa: E402

PROGRAM, SOURCE = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
PHONE, DESK = (390, 844), (1280, 900)
# The shipped sphere scenes with their first slider to move. The first two are measured always, and all
# with as many pictures as NACRE_VIEW_PICTURES says.
SCENES = {'first_scene': '/materials/red/roughness', 'material_grid': '/shapes/0/material/dielectric_f0',
          'phong_vs_pbr': None, 'metals': None}
QUICK = ('--size', '192x108', '--spp', '4', '--quiet')

# Moves a slider to one place after another, and waits for the picture of each: the times in ms until
# the canvas was drawn, and until the frame with it was painted.
LATENCY = '''
const [selector, count, done] = [arguments[0], arguments[1], arguments[arguments.length - 1]];
const slider = document.querySelector(selector), viewer = document.querySelector('.viewer'), times = [];
const pause = ms => new Promise(then => setTimeout(then, ms));
(async () => {
  for (let i = 0; i < count; ++i) {
    const place = 100 + (i * 37) % 800;
    const drawn = new Promise(then => {
      const watch = new MutationObserver(() => {
        if (Number(viewer.dataset.serial || 0) < VIEW.connection.serial) return;
        watch.disconnect();
        then();
      });
      watch.observe(viewer, {attributes: true});
    });
    const start = performance.now();
    slider.value = place;
    slider.dispatchEvent(new Event('input'));
    await drawn;
    const ready = performance.now();
    await new Promise(then => requestAnimationFrame(() => {
      const channel = new MessageChannel();
      channel.port1.onmessage = then;
      channel.port2.postMessage(0);
    }));
    times.push([ready - start, performance.now() - start]);
    await pause(20 + (i * 29) % 180);
  }
  done(times);
})();
'''
# Moves it with every frame of the browser's: how many pictures were drawn a second, and how many after
# the last move, until that was seen.
DRAG = '''
const [selector, seconds, done] = [arguments[0], arguments[1], arguments[arguments.length - 1]];
const slider = document.querySelector(selector), viewer = document.querySelector('.viewer');
let pictures = 0, frames = 0;
const watch = new MutationObserver(() => { ++pictures; });
watch.observe(viewer, {attributeFilter: ['data-revision']});
const start = performance.now();
(function step(now) {
  if (now - start > 1000 * seconds) {
    const rate = pictures / seconds;
    pictures = 0;
    (function rest() {
      if (Number(viewer.dataset.serial || 0) < VIEW.connection.serial) return setTimeout(rest, 1);
      watch.disconnect();
      done([rate, frames / seconds, pictures]);
    })();
    return;
  }
  ++frames;
  slider.value = 500 + 400 * Math.sin((now - start) / 300);
  slider.dispatchEvent(new Event('input'));
  requestAnimationFrame(step);
})(start);
'''


# Texts whose contrast with what is behind them is less than WCAG's 4.5.
FAINT = '''
const rgba = text => text.match(/[\\d.]+/g).map(Number);
const light = c => { c /= 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; };
const luminance = ([r, g, b]) => 0.2126 * light(r) + 0.7152 * light(g) + 0.0722 * light(b);
function behind(element) {
  for (let at = element; at; at = at.parentElement) {
    const color = rgba(getComputedStyle(at).backgroundColor);
    if (color.length === 3 || color[3] === 1) return color;
  }
  return [255, 255, 255];
}
const faint = [];
for (const element of document.querySelectorAll('body *')) {
  const own = [...element.childNodes].some(node => node.nodeType === 3 && node.textContent.trim());
  if (!own || !element.checkVisibility() || element.disabled || element.closest('.pane, svg, script, style, option')) continue;
  const [a, b] = [rgba(getComputedStyle(element).color), behind(element)].map(luminance);
  const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  if (contrast < 4.5) faint.push(`${element.tagName} ${element.className} "${element.textContent.slice(0, 30)}": ${contrast.toFixed(2)}`);
}
return faint;
'''


class ViewTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.scene = pathlib.Path(cls.folder.name, 'first_scene.json')
        cls.browser = webdriver.Browser(network_log=False)
        cls.addClassCleanup(cls.browser.close)

    def view(self, *arguments, width=DESK):
        shutil.copy(SOURCE / 'scenes/first_scene.json', self.scene)
        server = Server(PROGRAM, *(arguments or (self.scene, *QUICK)))
        self.addCleanup(server.close)
        self.show(server, width)
        return server

    def show(self, server, width=DESK):
        self.browser.resize(*width)
        self.browser.log('browser')
        self.browser.post(self.browser.session + '/url', {'url': server.url})
        self.rest()

    def rest(self):
        self.browser.wait('return document.querySelector(".viewer")?.dataset.done === "1"')

    def tearDown(self):
        messages = [entry['message'] for entry in self.browser.log('browser')]
        # The browser says so itself when a server has gone.
        self.assertEqual([m for m in messages if 'ERR_CONNECTION' not in m and 'WebSocket connection' not in m], [])
        self.assertNotIn('[object', self.browser.script('return document.body.textContent'))

    def later(self, text, *arguments):
        """A script that calls its last argument when it is done."""
        self.browser.post(self.browser.session + '/timeouts', {'script': 120000})
        return self.browser.post(self.browser.session + '/execute/async', {'script': text, 'args': list(arguments)})

    def slide(self, pointer, place):
        """Puts a slider somewhere in [0, 1000], and waits until the picture shows it."""
        return self.later('''
            const [pointer, place, done] = arguments, viewer = document.querySelector('.viewer');
            const slider = document.querySelector(`[data-pointer="${pointer}"] input[type=range]`);
            slider.value = place;
            slider.dispatchEvent(new Event('input'));
            slider.dispatchEvent(new Event('change'));
            (function look() {
              if (Number(viewer.dataset.serial || 0) >= VIEW.connection.serial && viewer.dataset.done === '1') return done(true);
              setTimeout(look, 20);
            })();''', pointer, place)

    def pixel(self, part_x=0.5, part_y=0.5):
        return self.browser.script('''
            const from = VIEW.viewer.live.canvas, to = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true});
            to.drawImage(from, -Math.floor(arguments[0] * from.width), -Math.floor(arguments[1] * from.height));
            return [...to.getImageData(0, 0, 1, 1).data].slice(0, 3)''', part_x, part_y)

    def value(self, pointer):
        return self.browser.script('return valueAt(VIEW.scene, arguments[0])', pointer)

    def click(self, selector):
        self.browser.script('document.querySelector(arguments[0]).click()', selector)

    def changed(self, pixel, part_x=0.5, part_y=0.5):
        end = time.monotonic() + 20
        while self.pixel(part_x, part_y) == pixel and time.monotonic() < end:
            time.sleep(0.03)
        self.rest()
        self.assertNotEqual(self.pixel(part_x, part_y), pixel)

    # ---- Tests ----

    def test_a_slider_changes_the_picture_and_undo_brings_it_back(self):
        self.view()
        before = self.pixel()
        self.slide('/materials/red/roughness', 900)
        self.assertAlmostEqual(self.value('/materials/red/roughness'), 0.9)
        rough = self.pixel()
        self.assertNotEqual(rough, before)
        self.slide('/materials/red/metallic', 1000)
        metal = self.pixel()
        self.assertNotEqual(metal, rough)
        for label, expected in (('Undo', rough), ('Undo', before), ('Redo', rough), ('Redo', metal),
                                ('Reset everything', before), ('Undo', metal)):
            now = self.pixel()
            self.click(f'[aria-label="{label}"]')
            self.changed(now)
            self.assertEqual(self.pixel(), expected, label)

    def test_models_are_swapped(self):
        self.view()
        before = self.pixel()
        self.browser.script('''
            const select = document.querySelector('[data-pointer="/materials/red/model"] select');
            select.value = 'phong';
            select.dispatchEvent(new Event('change'));''')
        self.changed(before)
        self.assertEqual(self.value('/materials/red/color'), [0.8, 0.1, 0.08])
        self.assertAlmostEqual(self.value('/materials/red/shininess'), 2 / 0.3 ** 4 - 2, delta=0.1)
        self.slide('/materials/red/shininess', 300)

    def test_faults_stand_below_their_control(self):
        self.view()
        before = self.pixel()
        self.browser.script('''
            const field = document.querySelector('[data-pointer="/materials/red/roughness"] input[type=number]');
            field.value = 7;
            field.dispatchEvent(new Event('change'));''')
        text = self.browser.wait('''return document.querySelector('[data-pointer="/materials/red/roughness"] .fault').textContent''')
        self.assertIn('0 to 1', text)
        self.rest()
        self.assertEqual(self.pixel(), before)
        self.assertEqual(self.value('/materials/red/roughness'), 0.3)
        self.slide('/materials/red/roughness', 500)
        self.assertEqual(self.browser.script('''return document.querySelector('[data-pointer="/materials/red/roughness"] .fault').textContent'''), '')

    def test_the_camera_by_mouse_and_keys(self):
        self.view()
        before = self.pixel()
        box = self.browser.script('''const b = document.querySelector('.pane canvas').getBoundingClientRect();
                                     return [b.left + b.width / 2, b.top + b.height / 2]''')
        x, y = map(round, box)
        self.browser.post(self.browser.session + '/actions', {'actions': [{
            'type': 'pointer', 'id': 'mouse', 'actions': [
                {'type': 'pointerMove', 'x': x, 'y': y}, {'type': 'pointerDown', 'button': 0},
                {'type': 'pointerMove', 'x': x + 90, 'y': y + 25, 'duration': 100}, {'type': 'pointerUp', 'button': 0}]}]})
        self.changed(before)
        moved = self.value('/camera/position')
        self.assertLess(moved[0], 0)  # the scene follows the hand to the right
        self.assertAlmostEqual(sum((a - b) ** 2 for a, b in zip(moved, [0, 0.9, 0])), 36 + 0.7 ** 2, places=3)
        self.browser.script('document.querySelector(".pane").focus()')
        self.browser.press('right', 'right', 'w', 'd')
        self.browser.wait('return VIEW.scene.camera.look_at[0] !== 0')
        # All of the drag is one step.
        self.click('[aria-label="Undo"]')
        self.click('[aria-label="Undo"]')
        self.browser.wait('return VIEW.scene.camera.look_at[0] === 0')

    def test_a_light_is_moved_by_its_handle(self):
        self.view()
        before = self.pixel(0.5, 0.3)
        self.browser.script('document.querySelector(".lamp").focus()')
        self.browser.press(*['left'] * 12)
        self.browser.wait('return VIEW.scene.lights.key.position[0] < 2.9')
        self.changed(before, 0.5, 0.3)

    def test_a_click_reads_a_pixel(self):
        self.view()
        self.browser.script('VIEW.viewer.inspect(96, 54)')
        values = self.browser.wait('''
            const cell = document.querySelector('.read [data-values]');
            return cell && cell.dataset.values.split(' ').map(Number)''')
        image = pathlib.Path(self.folder.name, 'pixel.exr')
        subprocess.run([PROGRAM, 'render', str(self.scene), '-o', str(image), '--size', '192x108', '--spp', '4',
                        '--depth', 'float', '--compression', 'none', '--reproducible', '--quiet'], check=True, timeout=60)
        planes = pictures.read_exr(image)
        self.assertEqual(values, [planes[c][54][96] for c in 'RGB'])

    def test_a_and_b(self):
        self.view()
        self.browser.wait('return !VIEW.keep.disabled')
        self.browser.script('VIEW.keep.click()')
        self.browser.wait('return VIEW.viewer.images.length === 2')
        self.slide('/materials/red/roughness', 800)
        modes = self.browser.script('return [...document.querySelectorAll("[data-mode]")].map(b => b.dataset.mode)')
        self.assertEqual(modes, ['single', 'slider', 'side', 'error'])
        for mode in modes:
            self.click(f'[data-mode={mode}]')
            self.browser.wait('return document.querySelector("[data-mode][aria-pressed=true]").dataset.mode === arguments[0]', mode)
        rows = self.browser.wait('''const rows = document.querySelectorAll('.read tbody tr');
                                    return rows.length === 2 && [...rows].map(r => r.textContent)''')
        self.assertIn('B, now', rows[0])

    def test_figures_of_a_and_b(self):
        self.view()
        self.browser.wait('return !VIEW.keep.disabled')
        self.browser.script('VIEW.keep.click()')
        self.browser.wait('return VIEW.viewer.images.length === 2')
        self.slide('/materials/red/roughness', 800)
        text = self.browser.wait("""const m = document.querySelector('.metrics:not(.old)');
                                    return m && m.querySelector('[data-metric=FLIP]') && m.textContent""")
        for name in ('RMSE', 'relMSE', 'PSNR', 'SSIM', 'FLIP', 'largest difference'):
            self.assertIn(name, text)
        self.browser.script('VIEW.drop.click()')
        self.browser.wait('return document.querySelector(".metrics").hidden')

    def test_phong_against_pbr_in_one_click(self):
        self.view()
        before = self.pixel()
        self.browser.wait('return !VIEW.both.disabled')
        self.browser.script('VIEW.both.click()')
        self.browser.wait('return VIEW.scene.materials.red.model === "phong"')
        self.changed(before)
        self.assertEqual(self.browser.script('return VIEW.viewer.images.map(i => i.name)'), ['B, now', 'A'])
        self.assertEqual(self.value('/materials/floor/model'), 'lambert')
        self.assertEqual(self.browser.script('return VIEW.banner.textContent'), '')
        # One step back.
        self.click('[aria-label="Undo"]')
        self.browser.wait('return VIEW.scene.materials.red.model === "metallic_roughness"')
        # A lobe without a colour over a base that has one is a dielectric's, any other a metal's.
        nearest = [self.browser.script('return convertible({materials: {m: arguments[0]}})[0].other', {'model': 'phong', 'ks': ks})
                   for ks in (0.3, [0.2, 0.2, 0.2], [0.9, 0.6, 0.2])]
        self.assertEqual(nearest, ['dielectric', 'dielectric', 'metallic_roughness'])

    def test_a_pixel_is_explained(self):
        server = self.view()
        page = server.upgrade()
        self.browser.script('VIEW.viewer.inspect(96, 54)')
        text = self.browser.wait('const e = document.querySelector(".explain"); return !e.hidden && e.textContent')
        page.send({'explain': 96, 'y': 54})
        told = page.until(lambda m: 'explained' in m)['explained']
        page.close()
        key = next(light for light in told['lights'] if light['name'] == 'key')
        for value, digits in ((key['terms']['D'], 5), (key['terms']['G'], 5), (key['n_dot_l'], 4), (key['n_dot_h'], 4)):
            self.assertIn(self.browser.script('return show(...arguments)', value, digits), text)
        self.assertEqual(self.browser.script('return document.querySelectorAll(".explain svg").length'), 4)
        # It explains what is seen, after a change as well.
        self.slide('/materials/red/roughness', 800)
        page = server.upgrade()
        page.send({'explain': 96, 'y': 54})
        told = page.until(lambda m: 'explained' in m)['explained']
        page.close()
        key = next(light for light in told['lights'] if light['name'] == 'key')
        now = self.browser.script('return show(...arguments)', key['terms']['D'], 5)
        self.assertNotIn(now, text)
        self.browser.wait('return document.querySelector(".explain:not(.old)")?.textContent.includes(arguments[0])', now)

    def test_the_page_finds_a_server_that_starts_anew(self):
        with tempfile.TemporaryDirectory() as folder:
            before = os.environ.get('XDG_RUNTIME_DIR')
            os.environ['XDG_RUNTIME_DIR'] = folder
            try:
                with Server(PROGRAM, SOURCE / 'scenes/first_scene.json', *QUICK) as first:
                    port = first.port
                shutil.copy(SOURCE / 'scenes/first_scene.json', self.scene)
                arguments = (self.scene, *QUICK, '--port', port)
                server = self.view(*arguments)
                before_change = self.pixel()
                self.slide('/materials/red/roughness', 900)
                # A change that the server has not looked at when it ends is made again.
                server.process.send_signal(signal.SIGSTOP)
                self.browser.script("""
                    const slider = document.querySelector('[data-pointer="/materials/red/metallic"] input[type=range]');
                    slider.value = 600;
                    slider.dispatchEvent(new Event('input'));
                    slider.dispatchEvent(new Event('change'));""")
                server.process.kill()
                server.close()
                self.browser.wait('return VIEW.status.textContent.startsWith("no connection")')
                # It is told where nobody overlooks it, and nothing can be changed that would be lost.
                self.assertIn('server has gone', self.browser.wait('return VIEW.lost.checkVisibility() && VIEW.lost.textContent'))
                self.assertTrue(self.browser.script("""
                    const all = [VIEW.panel.element, VIEW.viewer.stage, VIEW.steps.undo, VIEW.steps.reset, VIEW.both];
                    return all.every(element => element.inert)"""))
                self.browser.script('takeAway(VIEW)')
                self.assertEqual(self.browser.script('return [...document.querySelectorAll("dialog button")].map(b => b.disabled)'),
                                 [False, False, True, True, False, False])
                self.browser.script('document.querySelector("dialog").close()')
                again = Server(PROGRAM, *arguments)
                self.addCleanup(again.close)
                self.assertEqual(again.url, server.url)
                self.browser.wait('return VIEW.scene.materials.red.roughness === 0.3 && VIEW.scene.materials.red.metallic === 0.6')
                self.rest()
                self.browser.wait('return !VIEW.status.textContent.startsWith("no connection")')
                self.assertFalse(self.browser.script('return VIEW.lost.checkVisibility() || VIEW.panel.element.inert'))
                self.click('[aria-label="Undo"]')
                self.browser.wait('return VIEW.scene.materials.red.metallic !== 0.6')
                self.browser.wait('return VIEW.steps.undo.disabled')
                self.rest()
                self.assertEqual(self.pixel(), before_change)
                self.slide('/materials/red/roughness', 900)
                self.assertNotEqual(self.pixel(), before_change)
            finally:
                if before is None:
                    del os.environ['XDG_RUNTIME_DIR']
                else:
                    os.environ['XDG_RUNTIME_DIR'] = before

    def test_edits_of_a_server_that_has_ended_are_offered(self):
        with tempfile.TemporaryDirectory() as state:
            shutil.copy(SOURCE / 'scenes/first_scene.json', self.scene)
            arguments = (self.scene, *QUICK)
            first = Server(PROGRAM, *arguments, state=state)
            self.addCleanup(first.close)
            self.show(first)
            self.assertFalse(self.browser.script('return VIEW.offer.checkVisibility()'))
            before = self.pixel()
            self.slide('/materials/red/roughness', 900)
            rough = self.pixel()
            first.process.terminate()
            first.process.wait(20)
            for button, expected in (('Restore', rough), ('Discard', before)):
                second = Server(PROGRAM, *arguments, state=state)
                self.addCleanup(second.close)
                self.show(second)
                text = self.browser.wait('return VIEW.offer.checkVisibility() && VIEW.offer.textContent')
                self.assertRegex(text, r'^Edits of .* \(1\) were kept')
                self.assertEqual(self.pixel(), before)
                self.browser.script('[...VIEW.offer.querySelectorAll("button")].find(b => b.textContent === arguments[0]).click()', button)
                self.browser.wait('return !VIEW.offer.checkVisibility()')
                self.browser.wait('return VIEW.scene.materials.red.roughness === arguments[0]', 0.9 if button == 'Restore' else 0.3)
                if button == 'Restore':
                    self.changed(before)
                self.rest()
                self.assertEqual(self.pixel(), expected)
                second.process.terminate()
                second.process.wait(20)

    def test_dropped_files_do_not_lead_away(self):
        self.view()
        prevented = self.browser.script("""
            const files = new DataTransfer(), text = new DataTransfer();
            files.items.add(new File(['x'], 'a.png'));
            text.setData('text/plain', '0.5');
            const drop = (name, dataTransfer) => !document.querySelector('.pane canvas').dispatchEvent(
                new DragEvent(name, {dataTransfer, bubbles: true, cancelable: true}));
            return [drop('dragover', files), drop('drop', files), drop('drop', text)]""")
        self.assertEqual(prevented, [True, True, False])
        self.assertIn('nacre view FILE', self.browser.wait('return VIEW.banner.checkVisibility() && VIEW.banner.textContent'))

    def test_a_choice_that_was_not_made_shows_none(self):
        scene = json.loads((SOURCE / 'scenes/first_scene.json').read_text(encoding='utf-8'))
        scene['materials']['red'] = {'model': 'dielectric', 'base_color': [0.8, 0.1, 0.08]}
        path = pathlib.Path(self.folder.name, 'dielectric.json')
        path.write_text(json.dumps(scene), encoding='utf-8')
        self.view(path, *QUICK)
        shown = """const select = document.querySelector('[data-pointer="/materials/red/preset"] select');
                   return select.selectedOptions[0].textContent"""
        self.assertEqual(self.browser.script(shown), 'none')
        before = self.pixel()
        self.browser.script("""
            const select = document.querySelector('[data-pointer="/materials/red/preset"] select');
            select.value = 'diamond';
            select.dispatchEvent(new Event('change'));""")
        self.changed(before)
        self.assertEqual(self.browser.script(shown), 'diamond')
        self.click('[aria-label="Undo"]')
        self.browser.wait('return !("preset" in VIEW.scene.materials.red)')
        self.assertEqual(self.browser.script(shown), 'none')
        # Of those that have a default, that is shown.
        self.assertEqual(self.browser.script("""return document.querySelector('[data-pointer="/materials/red/model"] select').value"""), 'dielectric')

    def test_a_models_sky_has_controls(self):
        self.view(SOURCE / 'scenes/models/pawns.glb', *QUICK)
        before = self.pixel(0.5, 0.6)
        self.slide('/lights/sky/scale', 0)
        dark = self.pixel(0.5, 0.6)
        self.assertLess(sum(dark), sum(before))
        self.click('[aria-label="Undo"]')
        self.changed(dark, 0.5, 0.6)
        self.assertEqual(self.pixel(0.5, 0.6), before)
        # Another sky in its place.
        self.browser.script("""
            const field = document.querySelector('[data-pointer="/lights/sky/radiance"] input[type=number]');
            field.value = 3;
            field.dispatchEvent(new Event('change'));""")
        self.changed(before, 0.5, 0.6)
        self.assertEqual(self.value('/lights/sky/radiance'), 3)
        self.assertIsNone(self.value('/lights/sky/scale'))

    def test_enlarged_pictures_are_smooth_until_pixels_are_seen(self):
        self.view()
        self.browser.script("""
            const draw = CanvasRenderingContext2D.prototype.drawImage;
            CanvasRenderingContext2D.prototype.drawImage = function(...args) {
              window.drawn = [this.getTransform().a, this.imageSmoothingEnabled];
              return draw.apply(this, args);
            };""")
        seen = {}
        for factor in (1.5, 2, 2.9, 3.2, 8):
            self.browser.script("""
                const pane = VIEW.viewer.panes[0], camera = VIEW.viewer.camera, [w, h] = pane.size();
                camera.fit();
                window.drawn = null;
                pane.zoomBy(arguments[0] / devicePixelRatio / camera.scaleIn(w, h), 96, 54);
                VIEW.viewer.draw();""", factor)
            scale, smooth = self.browser.wait('return window.drawn')
            self.assertAlmostEqual(scale, factor, delta=0.01 * factor)
            seen[factor] = smooth
        self.assertEqual(seen, {1.5: True, 2: True, 2.9: True, 3.2: False, 8: False})

    def test_a_map_is_chosen_among_files(self):
        self.view()
        pathlib.Path(self.folder.name, 'maps').mkdir(exist_ok=True)
        shutil.copy(next((SOURCE / 'scenes').rglob('*.png')), pathlib.Path(self.folder.name, 'maps/a b.png'))
        self.browser.post(self.browser.session + '/refresh', {})
        self.rest()
        before = self.pixel()
        self.browser.script("""
            const select = document.querySelector('[data-pointer="/materials/red/base_color_map"] select');
            select.value = 'maps/a b.png';
            select.dispatchEvent(new Event('change'));""")
        self.browser.wait('return VIEW.scene.materials.red.base_color_map === "a b"')
        self.assertEqual(self.value('/textures/a b/file'), 'maps/a b.png')
        self.changed(before)
        self.browser.wait("""return document.querySelector('[data-pointer="/materials/red/base_color_map"] select').value === 'a b'""")

    def test_an_environment_is_turned(self):
        scene = json.loads((SOURCE / 'scenes/first_scene.json').read_text(encoding='utf-8'))
        scene['lights'] = {'sky': {'type': 'environment', 'quadratic': {'radiance': 1, 'axis': [1, 0, 0], 'constant': 1, 'linear': 1}}}
        path = pathlib.Path(self.folder.name, 'sky.json')
        path.write_text(json.dumps(scene), encoding='utf-8')
        self.view(path, *QUICK)
        before = self.pixel()
        self.slide('/lights/sky/rotate_deg', 750)
        self.assertEqual(self.value('/lights/sky/rotate_deg'), 90)
        self.assertNotEqual(self.pixel(), before)

    def test_the_command_line_renders_the_picture(self):
        """What is taken away, of a scene and of a model, after changes of all kinds."""
        for source in ('first_scene.json', 'models/pawns.glb'):
            self.view(SOURCE / 'scenes' / source, *QUICK)
            self.browser.script('takeAway(VIEW)')
            command = self.browser.script('return document.querySelector("textarea").value')
            self.assertNotIn('--set', command)
            self.browser.script('document.querySelector("dialog").close()')
            material = self.browser.script('return Object.keys(VIEW.scene.materials)[0]')
            sun = source == 'models/pawns.glb'
            self.slide(f'/materials/{material}/roughness', 700)
            self.slide('/lights/key/irradiance' if sun else '/lights/key/intensity', 560)
            self.browser.script('document.querySelector(".lamp").focus()')
            self.browser.press(*['left'] * 3)
            self.browser.script('document.querySelector(".pane").focus()')
            self.browser.press(*['right'] * 3)
            self.browser.wait('return Number(document.querySelector(".viewer").dataset.serial) === VIEW.connection.serial')
            self.rest()
            picture = self.browser.script("""
                const {canvas, context} = VIEW.viewer.live;
                return [...VIEW.viewer.context.getImageData(0, 0, canvas.width, canvas.height).data].filter((_, i) => i % 4 < 3);""")
            self.browser.script('takeAway(VIEW)')
            command = self.browser.script('return document.querySelector("textarea").value')
            self.assertTrue(command.startswith('nacre render '))
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run(['sh', '-c', '"$0" ' + command.removeprefix('nacre ') + ' --quiet', PROGRAM], cwd=folder, check=True, timeout=60)
                rendered = pictures.read_png(pathlib.Path(folder, 'picture.png'))
            flat = [value for row in rendered for pixel in row for value in pixel]
            self.assertEqual(sum(a != b for a, b in zip(flat, picture)), 0, command)
            self.assertEqual(len(flat), len(picture))

    def test_images_alone(self):
        images = [pathlib.Path(self.folder.name, f'{name}.exr') for name in 'ab']
        for image, spp in zip(images, '12'):
            subprocess.run([PROGRAM, 'render', str(SOURCE / 'scenes/first_scene.json'), '--size', '96x54', '--spp', spp, '-o', str(image),
                            '--quiet'], check=True, timeout=60)
        with Server(PROGRAM, *images, '--quiet') as server:
            self.browser.post(self.browser.session + '/url', {'url': server.url})
            self.browser.wait('return Number(document.querySelector(".viewer")?.dataset.ready) > 0')
            self.assertIn('FLIP', self.browser.script('return document.body.textContent'))
            # The page follows its files, and looks at them as before.
            self.click('[data-mode=side]')
            self.browser.script('VIEWERS[0].inspect(40, 30); window.old = true')
            whole = images[0].read_bytes()
            images[0].write_bytes(b'no image')
            text = self.browser.wait('return document.querySelector(".bad:not([hidden])")?.textContent')
            self.assertIn('a.exr', text)
            images[0].write_bytes(images[1].read_bytes())
            self.browser.wait('return !window.old && document.querySelector("[data-x]")?.dataset.x === "40"')
            self.browser.wait('return document.querySelector("[data-mode=side]").getAttribute("aria-pressed") === "true"')
            images[0].write_bytes(whole)
            self.browser.script('window.old = true')
            self.browser.wait('return !window.old')

    def test_a_saved_file_and_a_broken_one(self):
        self.view()
        before = self.pixel()
        text = self.scene.read_text(encoding='utf-8')
        self.scene.write_text(text.replace('[0.8, 0.1, 0.08]', '[0.1, 0.1, 0.8]'), encoding='utf-8')
        self.changed(before)
        blue = self.pixel()
        self.scene.write_text('{', encoding='utf-8')
        banner = self.browser.wait('const b = document.querySelector(".banner"); return !b.hidden && b.textContent')
        self.assertIn('first_scene.json', banner)
        self.assertEqual(self.pixel(), blue)
        self.scene.write_text(text, encoding='utf-8')
        self.changed(blue)
        self.assertEqual(self.pixel(), before)
        self.browser.wait('return document.querySelector(".banner").hidden')

    def test_edits_outlive_a_saved_file(self):
        self.view()
        disabled = 'return [VIEW.steps.undo, VIEW.steps.redo, VIEW.steps.reset].map(button => button.disabled)'
        field = """return document.querySelector('[data-pointer="/materials/red/roughness"] input[type=number]').value"""
        self.assertEqual(self.browser.script(disabled), [True, True, True])
        self.slide('/materials/red/roughness', 900)
        self.assertEqual(self.browser.script(disabled), [False, True, False])
        # Another member of the file: the edit stays, and is no step any more, but can be reset.
        text = self.scene.read_text(encoding='utf-8')
        self.scene.write_text(text.replace('140', '90'), encoding='utf-8')
        self.browser.wait('return VIEW.scene.lights.key.intensity === 90')
        self.rest()
        self.assertEqual(self.browser.script(field), '0.9')
        self.assertEqual(self.value('/materials/red/roughness'), 0.9)
        self.assertEqual(self.browser.script(disabled), [True, True, False])
        self.click('[aria-label="Reset everything"]')
        self.browser.wait('return VIEW.scene.materials.red.roughness === 0.3')
        self.assertEqual(self.browser.script(field), '0.3')
        self.assertEqual(self.value('/lights/key/intensity'), 90)
        self.click('[aria-label="Undo"]')
        self.browser.wait('return VIEW.scene.materials.red.roughness === 0.9')
        self.assertEqual(self.browser.script(disabled), [True, False, False])
        # The member that was edited: it is the file's.
        self.scene.write_text(text.replace('"roughness": 0.3', '"roughness": 0.6'), encoding='utf-8')
        self.browser.wait('return VIEW.scene.materials.red.roughness === 0.6')
        self.assertEqual(self.browser.script(field), '0.6')
        self.assertEqual(self.browser.script(disabled), [True, True, True])

    def test_two_pages_show_the_same(self):
        server = self.view()
        other = server.upgrade()
        other.until(lambda m: 'scene' in m)
        self.slide('/materials/red/roughness', 700)
        other.until(lambda m: m.get('changed') == '/materials/red/roughness' and m['value'] == 0.7)
        before = self.pixel()
        other.send({'set': '/materials/red/base_color', 'value': [0, 1, 0]})
        self.changed(before)
        self.assertEqual(self.value('/materials/red/base_color'), [0, 1, 0])
        other.close()

    def test_narrow_and_wide(self):
        server = self.view()
        for width in (PHONE, (768, 1024), DESK, (1920, 1080), (3840, 2160)):
            self.show(server, width)
            wide = self.browser.script('return document.scrollingElement.scrollWidth - innerWidth')
            self.assertLessEqual(wide, 0, width)
        labels = self.browser.script('''return [...document.querySelectorAll('input, select, button')].filter(
            e => !e.getAttribute('aria-label') && !e.textContent.trim() && !(e.labels && e.labels.length)).length''')
        self.assertEqual(labels, 0)

    def test_contrast(self):
        try:
            for scheme in ('light', 'dark'):
                self.browser.cdp('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': scheme}])
                self.view()
                self.browser.script('VIEW.viewer.inspect(96, 54)')
                self.browser.wait('return !document.querySelector(".explain").hidden')
                self.assertEqual(self.browser.script(FAINT), [], scheme)
        finally:
            self.browser.cdp('Emulation.setEmulatedMedia', features=[])

    def test_nothing_moves_while_a_slider_does(self):
        self.view()
        places = """return ['.stage', '.read', '.panel', '[data-pointer="/materials/red/roughness"] input'].map(
                        selector => JSON.stringify(document.querySelector(selector).getBoundingClientRect()))"""
        before = self.browser.script(places)
        for place in (100, 930, 500):
            self.slide('/materials/red/roughness', place)
            self.assertEqual(self.browser.script(places), before)
        # Nor where pictures that move must be smaller, which the status says.
        for width in (PHONE, (768, 1024), DESK, (1920, 1080)):
            self.browser.resize(*width)
            self.later('const done = arguments[0]; requestAnimationFrame(() => setTimeout(done, 100))')  # panes fit themselves
            texts = [self.browser.script("VIEW.status.textContent = arguments[0]; " + places, text) for text in
                     ('1 of 1 samples · 1280×720 · 9 ms', '1024 of 1024 samples · 320×180 of 1280×720 · 10.5 ms')]
            self.assertEqual(*texts, width)

    def test_names_are_text(self):
        name = '<img src=x onerror=alert(1)>'
        scene = json.loads((SOURCE / 'scenes/first_scene.json').read_text(encoding='utf-8'))
        scene['materials'][name] = {'model': 'lambert'}
        path = pathlib.Path(self.folder.name, 'names.json')
        path.write_text(json.dumps(scene), encoding='utf-8')
        self.view(path, *QUICK)
        self.assertEqual(self.browser.script('return document.querySelectorAll("img").length'), 0)
        self.assertIn(name, self.browser.script('return document.body.textContent'))

    def test_parameters_say_what_they_mean(self):
        self.view()
        self.browser.script("""document.querySelector('[data-pointer="/materials/red/roughness"] input').focus()""")
        about = self.browser.wait('const a = document.querySelector(".about"); return !a.hidden && a.textContent')
        self.assertTrue(about.startswith('roughness '), about)
        self.assertEqual(about, self.browser.script("""
            const row = document.querySelector('[data-pointer="/materials/red/roughness"]');
            return 'roughness ' + row.querySelector('input').getAttribute('aria-description')"""))

    def test_search(self):
        self.view()
        self.browser.script('document.querySelector(".pane").focus()')
        self.browser.press('/', *'rough')
        shown = self.browser.script('''return [...document.querySelectorAll('.control')].filter(c => c.offsetParent).map(c => c.dataset.pointer)''')
        self.assertIn('/materials/red/roughness', shown)
        self.assertNotIn('/materials/red/metallic', shown)

    def test_latency(self):
        """Printed: from a slider's event to the picture, at 1280x720."""
        asked = os.environ.get('NACRE_VIEW_PICTURES')
        count = int(asked or 20)
        for name, pointer in list(SCENES.items())[:None if asked else 2]:
            self.view(SOURCE / f'scenes/{name}.json', '--size', '1280x720', '--spp', '16', '--quiet')
            if pointer is None:
                pointer = self.browser.script('return document.querySelector(".control:has(input[type=range])").dataset.pointer')
            selector = f'[data-pointer="{pointer}"] input[type=range]'
            drawn, painted = map(sorted, zip(*self.later(LATENCY, selector, count)))
            rate, frames, late = self.later(DRAG, selector, 1.5)
            half, most = count // 2, count * 95 // 100
            load = os.getloadavg()[0]
            print(f'{name}: {pointer}: drawn after {drawn[half]:.1f} ms (median), {drawn[most]:.1f} ms (p95), painted after '
                  f'{painted[half]:.1f} and {painted[most]:.1f} ms; while dragging {rate:.0f} pictures/s '
                  f'of {frames:.0f} browser frames/s (load {load:.1f} on {os.cpu_count()} cores)', flush=True)
            # Times are printed, not judged: machines that test are busy. However busy, no more than three
            # pictures come after the last move: one that the page had before it drew it, one that was being
            # rendered, and that of the move itself. More would have been waiting one behind the other.
            self.assertLessEqual(late, 3)


if __name__ == '__main__':
    if webdriver.missing():
        print('skipped: without', ', '.join(webdriver.missing()))
        sys.exit(1 if os.environ.get('NACRE_SKIP_NOTHING') else 77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
