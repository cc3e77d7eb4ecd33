#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a stranger on this machine, or a page of elsewhere, gets from `nacre view`: nothing.

Usage: attack_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
"""
import json
import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.parse

from server import Server

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENE = SOURCE / 'scenes/first_scene.json'
SMALL = ('--size', '64x36', '--spp', '4', '--quiet')
# What sanitizers take, by their manuals: the address sanitizer three times, the thread sanitizer up to ten.
CODE = pathlib.Path(PROGRAM).read_bytes()
TIMES = 10 if b'__tsan_init' in CODE else 3 if b'__asan_init' in CODE else 1


def done(message):
    return message.get('kind') == 1 and message['done'] == 1


class AttackTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(PROGRAM, SCENE, *SMALL)
        cls.addClassCleanup(cls.server.close)

    def tearDown(self):
        """Whatever was tried, a page is served as before."""
        page = self.server.upgrade()
        self.assertTrue(hasattr(page, 'until'), page)
        page.until(done)
        page.close()

    def page(self):
        page = self.server.upgrade()
        page.until(done)
        return page

    # ---- Who is let in ----

    def test_the_page_and_its_policy(self):
        status, headers, body = self.server.request(f'/{self.server.token}/')
        self.assertEqual(status, 200)
        self.assertIn(b'<script type="application/json"', body)
        policy = headers['content-security-policy']
        self.assertIn("default-src 'none'", policy)
        self.assertIn("script-src 'sha256-", policy)
        self.assertNotIn('unsafe', policy)
        self.assertEqual(headers['referrer-policy'], 'no-referrer')
        self.assertEqual(headers['cache-control'], 'no-store')
        self.assertEqual(headers['x-content-type-options'], 'nosniff')
        self.assertNotIn('access-control-allow-origin', headers)

    def test_tokens_are_new_and_long(self):
        with Server(PROGRAM, SCENE, *SMALL) as other:
            self.assertNotEqual(other.token, self.server.token)
            self.assertRegex(other.token, '^[0-9a-f]{32}$')

    def test_wrong_tokens(self):
        token = self.server.token
        wrong = ['', 'x', token[:-1], token + '0', token[:-1] + ('0' if token[-1] != '0' else '1'), token.upper() + 'A',
                 '%00', '..', '0' * 4000]
        for path in wrong:
            status, _, body = self.server.request(f'/{path}/')
            self.assertIn(status, (403, 404), path)
            self.assertNotIn(token.encode(), body)
            self.assertIn(self.server.upgrade(f'/{path}/socket'), (403, 404), path)
        self.assertEqual(self.server.request('/')[0], 404)
        for path in ('/etc/passwd', '/../first_scene.json', '/socket', '/page.js', '//'):
            self.assertIn(self.server.request(f'/{token}{path}')[0], (403, 404), path)

    def test_wrong_hosts(self):
        path = f'/{self.server.token}/'
        for host in (None, '', 'evil.example', f'evil.example:{self.server.port}', '127.0.0.1', 'localhost',
                     f'127.0.0.1:{self.server.port}.evil.example', f'127.0.0.2:{self.server.port}'):
            self.assertEqual(self.server.request(path, Host=host)[0], 403, host)
            self.assertEqual(self.server.upgrade(Host=host), 403, host)
        self.assertEqual(self.server.request(path, Host=f'localhost:{self.server.port}')[0], 200)

    def test_wrong_origins(self):
        for origin in (None, 'null', 'https://evil.example', 'http://127.0.0.1', 'http://localhost',
                       f'https://127.0.0.1:{self.server.port}', f'http://127.0.0.1:{self.server.port + 1}',
                       f'http://127.0.0.1:{self.server.port}.evil.example'):
            self.assertEqual(self.server.upgrade(Origin=origin), 403, origin)
            if origin is not None:
                self.assertEqual(self.server.request(f'/{self.server.token}/', Origin=origin)[0], 403, origin)

    def test_other_methods_and_long_heads(self):
        path = f'/{self.server.token}/'
        for method in ('POST', 'PUT', 'DELETE', 'OPTIONS', 'TRACE', 'HEAD', 'PROPFIND'):
            self.assertEqual(self.server.request(path, method)[0], 405, method)
        self.assertEqual(self.server.request(path, X_Long='x' * 20000)[0], 0)  # closed
        self.assertEqual(self.server.request(path, Content_Length='1000000000')[0], 0)

    # ---- What is too much ----

    def test_two_hundred_connections(self):
        page, idle = self.page(), []
        try:
            for _ in range(200):
                idle.append(socket.create_connection(('127.0.0.1', self.server.port), 5))
            page.send({'set': '/materials/red/roughness', 'value': 0.4})
            page.until(lambda m: 'changed' in m)
        finally:
            for connection in idle:
                connection.close()
            page.close()
        time.sleep(0.2)

    def test_strangers_keep_nobody_out_who_has_the_token(self):
        """Half-open connections, however many, and while they stay."""
        strangers = []
        try:
            for i in range(300):
                strangers.append(self.server.connect())
                if i % 3:
                    strangers[-1].sendall(b'GET /' if i % 3 == 1 else b'GET / HTTP/1.1\r\nHost: ')
            # At once: their time is not over for seconds.
            start = time.monotonic()
            pages = [self.page() for _ in range(3)]
            self.assertEqual(self.server.request(f'/{self.server.token}/')[0], 200)
            self.assertLess(time.monotonic() - start, 4)
            for page in pages:
                page.close()
            # The oldest have gone.
            self.assertEqual(strangers[0].recv(1), b'')
        finally:
            for stranger in strangers:
                stranger.close()
        time.sleep(0.3)

    def test_half_and_slow_requests_are_dropped(self):
        with self.server.connect() as half, self.server.connect() as slow:
            half.sendall(b'GET / HTTP/1.1\r\nHost: ')
            start = time.monotonic()
            with self.assertRaises(OSError):
                while time.monotonic() - start < 20:
                    slow.sendall(b'G')
                    time.sleep(0.2)
            self.assertEqual(half.recv(10), b'')
            self.assertLess(time.monotonic() - start, 10)

    def test_sixteen_pages_and_no_more(self):
        pages = [self.page() for _ in range(16)]
        self.assertEqual(self.server.upgrade(), 503)
        for page in pages:
            page.close()
        time.sleep(0.3)

    def test_bad_frames(self):
        def oversized(page):
            page.frame(page.TEXT, b'', length=1 << 40)

        def too_long(page):
            page.send('"' + 'x' * (1 << 20) + '"')

        def unmasked(page):
            page.frame(page.TEXT, b'{}', masked=False)

        def unknown_opcode(page):
            page.frame(3, b'')

        def long_ping(page):
            page.frame(page.PING, b'x' * 200)

        def continuation_of_nothing(page):
            page.frame(0, b'x')

        def binary(page):
            page.frame(page.BINARY, b'{}')

        def no_utf8(page):
            page.frame(page.TEXT, b'\xff\xfe')

        for attack in (oversized, too_long, unmasked, unknown_opcode, long_ping, continuation_of_nothing, binary,
                       no_utf8):
            with self.subTest(attack.__name__):
                page = self.page()
                with self.assertRaises(OSError):  # it is closed
                    attack(page)
                    for _ in range(1000):
                        page.receive()
                page.close()

    # ---- What a page says ----

    def fault_of(self, page, message):
        page.send(message)
        return page.until(lambda m: 'fault' in m)

    def test_nonsense_gets_faults(self):
        page = self.page()
        for message in ('', '{', 'null', '[]', '{}', '{"set": 1, "value": 2}', '{"set": "/image/spp"}',
                        '{"look": "no such"}', '{"history": "rewind"}', '{"set": "/image/spp", "value": 1, "gesture": -1}',
                        '{"samples": "", "id": 1e10}', '[' * 5000, '{"set": "", "set": "", "value": 1}',
                        '{"set": "/image/spp", "value": 1e999}'):
            faults = self.fault_of(page, message)['faults']
            self.assertTrue(faults and faults[0]['what'], message)
        for pointer, value in (('/materials/red/roughness', 7), ('/materials/red/roughnes', 0.5), ('/nowhere', 1),
                               ('no pointer', 1), ('/materials/none', 3), ('', 3), ('/lights/key/type', 'laser'),
                               ('/image/width', 1e9), ('/shapes/7', {}), ('/shapes/-1/radius', 1)):
            answer = self.fault_of(page, {'set': pointer, 'value': value})
            self.assertEqual(answer['fault'], pointer)
            self.assertTrue(answer['faults'][0]['what'])
        # The scene is what it was.
        page.send({'set': '/materials/red/roughness', 'value': 0.3})
        self.assertIn('changed', page.until(lambda m: 'changed' in m or 'fault' in m))
        page.close()

    def test_files_of_other_folders(self):
        with tempfile.TemporaryDirectory() as folder:
            secret = pathlib.Path(folder, 'secret.png')
            secret.write_bytes(b'\x89PNG')
            page = self.page()
            for name in (str(secret), os.path.relpath(secret, SOURCE / 'scenes'), '/etc/passwd', '/dev/zero',
                         '../README.md'):
                answer = self.fault_of(page, {'set': '/textures/t', 'value': {'file': name}})
                self.assertTrue(answer['faults'], name)
            page.close()

    def test_links_that_lead_out_of_the_folder(self):
        with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as other:
            shutil.copy(SOURCE / 'scenes/textures/tiles.png', pathlib.Path(other, 'secret.png'))
            shutil.copy(SCENE, pathlib.Path(folder, 's.json'))
            shutil.copy(SOURCE / 'scenes/textures/tiles.png', pathlib.Path(folder, 'own.png'))
            pathlib.Path(folder, 'out.png').symlink_to(pathlib.Path(other, 'secret.png'))
            pathlib.Path(folder, 'in.png').symlink_to('own.png')
            with Server(PROGRAM, pathlib.Path(folder, 's.json'), *SMALL) as server:
                page = server.upgrade()
                self.assertEqual(page.until(lambda m: 'scene' in m)['files'], ['in.png', 'own.png'])
                page.until(done)
                answer = self.fault_of(page, {'set': '/textures/t', 'value': {'file': 'out.png'}})
                self.assertIn('outside the scene', answer['faults'][0]['what'])
                page.close()

    # ---- Floods ----

    def test_more_changes_than_may_wait(self):
        """Of as many values as one likes; a page that opens meanwhile is served."""
        with Server(PROGRAM, SCENE, *SMALL) as server:
            page = server.upgrade()
            page.until(done)
            for i in range(4000):
                page.send({'set': f'/materials/m{i}', 'value': {'model': 'lambert'}, 'serial': i + 1})
            other = server.upgrade()
            other.until(done)
            # Of each change the page is told what became of it.
            told = set()
            while len(told) < 4000 and 4000 not in told:
                message = page.message()
                if message.get('kind') == 1:
                    page.send('taken')
                elif 'changed' in message:
                    told.add(message['serial'])
                elif 'fault' in message:
                    self.assertIn('too many changes wait', message['faults'][0]['what'])
                    break
            page.close()
            other.close()
            last = server.upgrade()
            last.until(done)
            last.close()
            self.assertIsNone(server.process.poll())

    def test_thousands_of_drags_of_one_slider(self):
        with Server(PROGRAM, SCENE, *SMALL) as server:
            page, other = server.upgrade(), server.upgrade()
            page.until(done)
            for i in range(5000):
                page.send({'set': '/materials/red/roughness', 'value': 0.2 + 0.0001 * i, 'gesture': i + 1, 'serial': i + 1})
                if i % 500 == 0:
                    other.close()
                    other = server.upgrade()
                    other.until(lambda m: 'scene' in m)
            answer = page.until(lambda m: 'fault' in m or m.get('serial') == 5000)
            self.assertEqual(answer.get('value'), 0.2 + 0.0001 * 4999)
            self.assertIsNone(server.process.poll())
            page.close()
            other.close()

    def test_large_messages_take_bounded_memory(self):
        with Server(PROGRAM, SCENE, *SMALL) as server:
            page = server.upgrade()
            page.until(done)
            before = server.memory_mib()
            # Trees of many small parts, of which the text is but a twentieth.
            for i in range(40):
                page.send('{"set": "/x%d", "value": [%s]}' % (i, ','.join(['[]'] * 300000)))
            page.send({'set': '/materials/red/roughness', 'value': 0.25, 'serial': 1})
            page.until(lambda m: m.get('serial') == 1 or 'too many' in str(m.get('faults')))
            # 8 MiB of messages, twenty times as much as trees, and a tree or two at work.
            self.assertLess(server.memory_mib() - before, 500 * TIMES)
            page.close()
            self.assertIsNone(server.process.poll())

    def test_steps_take_bounded_memory(self):
        with Server(PROGRAM, SCENE, *SMALL) as server:
            page = server.upgrade()
            materials = page.until(lambda m: 'scene' in m)['scene']['materials']
            page.until(done)
            sizes = []
            # 130 kB of text each before and after: forty steps are 10 MB, measured as 12 to 14 of the process.
            # Texts that keep the room which they grew in take 20 to 32, trees would take 100.
            for i in range(150):
                many = {f'm{k}': {'model': 'lambert', 'albedo': i / 150} for k in range(3000)}
                page.send({'set': '/materials', 'value': {**materials, **many}, 'serial': i + 1})
                page.until(lambda m, i=i: m.get('serial') == i + 1)
                sizes.append(server.memory_mib())
            self.assertLess(sizes[-1] - sizes[20], 150 * TIMES)
            self.assertLess(sizes[-1] - sizes[-40], 18 * TIMES)
            page.close()

    def test_a_scene_too_large(self):
        page, before = self.page(), self.server.memory_mib()
        cloud = {'type': 'cloud', 'count': 1e8, 'material': 'red', 'box': [[-1, -1, -1], [1, 1, 1]], 'radius': 0.01}
        self.fault_of(page, {'set': '/shapes', 'value': [cloud]})
        self.assertLess(self.server.memory_mib() - before, 300 * TIMES)
        page.close()

    def test_a_thousand_random_messages(self):
        rng = random.Random(7)
        names = ['set', 'value', 'look', 'history', 'samples', 'id', 'gesture', 'serial', 'exposure', 'layer', 'x']
        values = [0, 1, -1, 1e30, 1e308, True, None, '', 'neutral', 'undo', 'redo', 'reset', '/materials/red/roughness',
                  '/lights/key/position', '/camera', '/image', '', 'N', 'all', [], {}, [1, 2, 3], {'a': {}}, 'é\u202e\x1b[2J']
        page = self.page()
        # The picture stays small.
        for _ in range(1000):
            message = {rng.choice(names): rng.choice(values) for _ in range(rng.randrange(4))}
            text = json.dumps(message).encode()
            if rng.random() < 0.3:
                text = bytes(rng.choice(text or b'x') for _ in range(len(text)))
            page.send(text)
        page.send({'history': 'reset'})
        page.send({'set': '/materials/red/roughness', 'value': 0.25, 'serial': 4711})
        page.until(lambda m: m.get('serial') == 4711)
        page.send({'history': 'reset'})
        page.close()

    def test_looks_while_pictures_grow(self):
        """What is shown is whole, though the next picture, a larger one, is given up as it begins."""
        rng = random.Random(7)
        with Server(PROGRAM, SCENE, '--size', '320x180', '--spp', '64', '--quiet') as server:
            page, moved = server.upgrade(), threading.Event()

            def take_all():
                while True:
                    try:
                        message = page.message()
                    except OSError:
                        return
                    if message.get('kind') == 1:
                        page.send('taken')
                        if message['moving']:
                            moved.set()

            reader = threading.Thread(target=take_all)
            reader.start()
            for height in range(300, 2160, 47):
                moved.clear()
                page.send({'set': '/image', 'value': {'width': height * 16 // 9, 'height': height, 'spp': 64}})
                self.assertTrue(moved.wait(10))
                time.sleep(rng.uniform(0.08, 0.12))  # it is refined 90 ms after a change
                for i in range(6):
                    page.send({'look': 'neutral', 'exposure': i / 100})
                    time.sleep(0.004)
                time.sleep(0.1)
            page.close()
            reader.join()

    def test_a_page_that_takes_nothing(self):
        """Pictures do not pile up for it, and do not wait for it."""
        lazy = self.server.upgrade()
        page, before = self.page(), self.server.memory_mib()
        for i in range(50):
            page.send({'set': '/materials/red/roughness', 'value': 0.2 + 0.01 * i, 'serial': i + 1})
            page.until(lambda m, i=i: m.get('serial') == i + 1)
        self.assertLess(self.server.memory_mib() - before, 50)
        # A page that has not said "taken" has at most two pieces of pictures on their way
        # (kPiecesAhead in server.cc). The answer to nonsense comes behind all that was sent.
        lazy.send({'look': 'x'})
        pieces = 0
        while True:
            message = lazy.message()
            if 'fault' in message or 'faults' in message:
                break
            pieces += message.get('kind') == 1
        self.assertTrue(0 < pieces <= 2, pieces)
        lazy.close()
        page.close()


class EndTest(unittest.TestCase):
    """How it ends."""

    def test_signals(self):
        # A terminal that is closed sends the last one.
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, -signal.SIGHUP)):
            server = Server(PROGRAM, SCENE, '--size', '1920x1080', '--spp', '4096')
            page = server.upgrade()
            page.until(lambda m: m.get('kind') == 1)
            start = time.monotonic()
            server.process.send_signal(number)
            self.assertEqual(server.process.wait(20), code)
            self.assertLess(time.monotonic() - start, 5)
            page.close()
            server.close()

    def test_a_signal_ends_it_whatever_the_worker_does(self):
        """In what the worker does not leave by itself: it reads, plans, fits, measures, explains."""
        cloud = {'type': 'cloud', 'count': 3e6, 'material': 'red', 'box': [[-9, -9, -9], [9, 9, 9]], 'radius': 0.01}
        grid = {'type': 'uv_sphere', 'center': [0, 0, 0], 'radius': 1, 'rings': 1500, 'segments': 3000, 'material': 'red'}
        long_works = [({'set': '/shapes', 'value': [cloud]}, 0.3), ({'set': '/shapes', 'value': [cloud]}, 2), ({'set': '/shapes', 'value': [grid]}, 0.3),
                      ({'set': '/a' * 60000, 'value': 1}, 0.3), ({'explain': 1000, 'y': 500}, 0.1), ({'keep': True}, 1)]
        for i, (message, wait) in enumerate(long_works):
            number, code = ((signal.SIGINT, 130), (signal.SIGTERM, 143))[i % 2]
            with tempfile.TemporaryDirectory() as state:
                server = Server(PROGRAM, SCENE, '--size', '1920x1080', '--spp', '1', '--quiet', state=state)
                page = server.upgrade()
                page.until(done)
                page.send({'set': '/materials/red/roughness', 'value': 0.77, 'serial': 1})
                page.until(lambda m: m.get('serial') == 1)
                page.send(message)
                if 'keep' in message:
                    page.send({'set': '/materials/red/roughness', 'value': 0.78})
                time.sleep(wait)
                start = time.monotonic()
                server.process.send_signal(number)
                self.assertEqual(server.process.wait(20), code)
                took = time.monotonic() - start
                page.close()
                server.close()
                # A second, and what a busy machine may add.
                self.assertLess(took, 2.5, message)
                kept, = pathlib.Path(state, 'nacre').glob('*.json')
                self.assertIn('"/materials/red/roughness"', kept.read_text(encoding='utf-8'))

    def test_the_port_is_free_again_and_taken_ports_are_told(self):
        with Server(PROGRAM, SCENE, *SMALL) as server:
            port = server.port
            second = subprocess.run([PROGRAM, 'view', '--no-open', '--port', str(port), SCENE], capture_output=True,
                                    text=True, timeout=60, check=False)
            self.assertEqual(second.returncode, 64)
            self.assertIn('cannot listen', second.stderr)
            self.assertEqual(second.stdout, '')
        with Server(PROGRAM, SCENE, *SMALL, '--port', port) as again:
            self.assertEqual(again.port, port)

    def test_addresses_for_others(self):
        with Server(PROGRAM, SCENE, *SMALL, '--listen', '127.0.0.2') as server:
            self.assertTrue(server.url.startswith('http://127.0.0.2:'))
        # All addresses are none that a browser says; behind a proxy it says the proxy's.
        command = [PROGRAM, 'view', '--no-open', *SMALL, '--listen', '0.0.0.0']
        refused = subprocess.run([*command, SCENE], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual((refused.returncode, refused.stdout), (64, ''))
        self.assertIn('--origin', refused.stderr)
        for origin in ('nacre.example', 'javascript:x', 'https://', 'https://nacre.example/view', 'https://NACRE.example'):
            refused = subprocess.run([*command, '--origin', origin, SCENE], capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual((refused.returncode, refused.stdout), (64, ''))
            self.assertIn('is no origin', refused.stderr)
        with Server(PROGRAM, SCENE, *SMALL, '--listen', '0.0.0.0', '--origin', 'https://nacre.example/') as server:
            self.assertTrue(server.url.startswith('https://nacre.example/'))
            self.assertIn('TLS', server.process.stderr.readline())

    def test_another_name_is_told_with_what_mends_it(self):
        """Through ssh -L browsers call it by another port; a proxy may leave that to the Origin."""
        with Server(PROGRAM, SCENE, '--size', '64x36', '--spp', '4') as server:
            path = f'/{server.token}/'
            status, _, body = server.request(path, Host='localhost:9999')
            self.assertEqual(status, 403)
            self.assertIn(b'--origin http://localhost:9999', body)
            self.assertEqual(server.request(path, Host='localhost:9999')[0], 403)
            self.assertEqual(server.upgrade(Origin='https://proxy.example'), 403)
            # Who has not got the token is told nothing, and the terminal no word of it; nor of what is no name.
            for host, other in (('strange.example', '/x/'), ('a b"<script>', path), ('evil.example\x1b[2J', path)):
                body = server.request(other, Host=host)[2]
                self.assertNotIn(b'--origin', body, host)
            server.process.send_signal(signal.SIGINT)
            _, errors = server.process.communicate(timeout=20)
            self.assertEqual(errors.count('--origin http://localhost:9999'), 1)
            self.assertEqual(errors.count('--origin https://proxy.example'), 1)
            self.assertEqual(errors.count('--origin'), 2)
        with Server(PROGRAM, SCENE, *SMALL, '--origin', 'http://localhost:9999') as server:
            self.assertTrue(server.url.startswith('http://localhost:9999/'))
            server.address, server.host = '127.0.0.1', 'localhost:9999'
            with open(f'/proc/{server.process.pid}/net/tcp', encoding='ascii') as table:
                inodes = {os.readlink(f'/proc/{server.process.pid}/fd/{fd}') for fd in os.listdir(f'/proc/{server.process.pid}/fd')}
                rows = [row.split() for row in table.readlines()[1:]]
            server.port = next(int(row[1].split(':')[1], 16) for row in rows if row[3] == '0A' and f'socket:[{row[9]}]' in inodes)
            self.assertEqual(server.request(f'/{server.token}/')[0], 200)
            page = server.upgrade(Origin='http://localhost:9999')
            page.until(done)
            page.close()

    def test_a_display_opens_a_browser(self):
        """By a file of the user's own: every user of the machine sees a program's arguments."""
        with tempfile.TemporaryDirectory() as folder:
            session = pathlib.Path(folder, 'session ü')
            session.mkdir(mode=0o700)
            opened, opener = pathlib.Path(folder, 'opened'), pathlib.Path(folder, 'xdg-open')
            opener.write_text(f'#!/bin/sh\necho noise\necho "$1" > {opened}.new\nmv {opened}.new {opened}\n', encoding='utf-8')
            opener.chmod(0o755)
            for path, display in ((f'{folder}:{os.environ["PATH"]}', ':7'), (f'{folder}:{os.environ["PATH"]}', None), (folder, ':7')):
                opened.unlink(missing_ok=True)
                if path == folder:
                    opener.unlink()
                environment = {k: v for k, v in os.environ.items() if k not in ('DISPLAY', 'WAYLAND_DISPLAY')}
                environment.update({'PATH': path, 'XDG_RUNTIME_DIR': str(session), 'XDG_STATE_HOME': folder}, **({'DISPLAY': display} if display else {}))
                process = subprocess.Popen([PROGRAM, 'view', SCENE, *SMALL], env=environment, stdout=subprocess.PIPE,
                                           stderr=subprocess.PIPE, text=True)
                url = process.stdout.readline().strip()
                end = time.monotonic() + (20 if display and path != folder else 0.5)
                while not opened.exists() and time.monotonic() < end:
                    time.sleep(0.05)
                if opened.exists():
                    argument = opened.read_text(encoding='utf-8').strip()
                    self.assertNotIn(url.split('/')[3], argument)
                    page = pathlib.Path(urllib.parse.unquote(argument.removeprefix('file://')))
                    self.assertEqual(page.parent, session)
                    self.assertEqual(page.stat().st_mode & 0o777, 0o600)
                    self.assertIn(f'url={url}"', page.read_text(encoding='utf-8'))
                process.send_signal(signal.SIGINT)
                out, errors = process.communicate(timeout=20)
                self.assertEqual((process.returncode, out), (130, ''))
                self.assertEqual(opened.exists(), bool(display) and path != folder)
                self.assertEqual(list(session.iterdir()), [])
                self.assertEqual('no xdg-open' in errors, path == folder)

    def test_broken_scenes(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, 'broken.json')
            scene.write_text('{"nacre": 1, "materials": {"a": {"model": "phung"}}}', encoding='utf-8')
            outcome = {}
            for command in (['view', '--no-open'], ['render', '-o', 'null:']):
                result = subprocess.run([PROGRAM, *command, str(scene)], capture_output=True, text=True, timeout=60,
                                        check=False)
                self.assertEqual(result.returncode, 65, result.stderr)
                self.assertEqual(result.stdout, '')
                outcome[command[0]] = result.stderr
            self.assertEqual(outcome['view'], outcome['render'])


if __name__ == '__main__':
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
