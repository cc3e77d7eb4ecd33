#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`nacre view` in headless Firefox, by the WebDriver BiDi protocol that it has built in: what
browser_test.py asks of Chromium, in short.

Usage: firefox_test.py PROGRAM SOURCE_FOLDER [UNITTEST-ARGUMENTS...]
Exits with 77, which ctest counts as skipped, where Firefox is missing; with 1 where nothing may be
skipped (NACRE_SKIP_NOTHING).
"""
import base64
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest

from server import Server, WebSocket

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
NAME = next((name for name in ('firefox-esr', 'firefox') if shutil.which(name)), None)


class Firefox:
    def __init__(self):
        self.profile = tempfile.TemporaryDirectory()
        # Its home is the profile's: it writes to no other folder.
        environment = {**os.environ, 'HOME': self.profile.name}
        self.process = subprocess.Popen([NAME, '--headless', '--no-remote', '--remote-debugging-port=0', '--profile', self.profile.name],
                                        env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        port = None
        for line in self.process.stderr:
            found = re.search(r'BiDi listening on ws://[^:]*:(\d+)', line)
            if found:
                port = int(found[1])
                break
        if port is None:
            raise RuntimeError('Firefox does not start')
        connection = socket.create_connection(('127.0.0.1', port), 60)
        connection.settimeout(120)
        key = base64.b64encode(os.urandom(16)).decode()
        connection.sendall((f'GET /session HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n'
                            f'Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n').encode())
        head = b''
        while b'\r\n\r\n' not in head:
            head += connection.recv(1)
        self.socket, self.last, self.complaints = WebSocket(connection), 0, []
        self.ask('session.new', capabilities={})
        self.ask('session.subscribe', events=['log.entryAdded'])
        self.context = self.ask('browsingContext.getTree')['contexts'][0]['context']

    def ask(self, method, **parameters):
        self.last += 1
        self.socket.send({'id': self.last, 'method': method, 'params': parameters})

        def is_answer(message):
            if message.get('method') == 'log.entryAdded' and message['params']['level'] in ('warn', 'error'):
                self.complaints.append(message['params']['text'])
            return message.get('id') == self.last
        answer = self.socket.until(is_answer)
        if answer.get('type') == 'error':
            raise RuntimeError(answer)
        return answer['result']

    def show(self, url):
        self.ask('browsingContext.navigate', context=self.context, url=url, wait='complete')

    def wait(self, expression):
        """Until the expression is true; returns it as text."""
        text = f'''new Promise((done, failed) => {{
            const end = Date.now() + 60000;
            (function look() {{
                const value = {expression};
                if (value) return done(String(value));
                if (Date.now() > end) return failed(Error('never became true'));
                setTimeout(look, 30);
            }})();
        }})'''
        answer = self.ask('script.evaluate', expression=text, target={'context': self.context}, awaitPromise=True)
        if answer['type'] != 'success':
            raise AssertionError(f'{answer["exceptionDetails"]["text"]}: {expression}')
        return answer['result'].get('value')

    def close(self):
        self.socket.close()
        self.process.terminate()
        self.process.wait(60)
        self.process.stderr.close()
        self.profile.cleanup()


class FirefoxTest(unittest.TestCase):
    def test_the_page(self):
        browser = Firefox()
        self.addCleanup(browser.close)
        with Server(PROGRAM, SOURCE / 'scenes/first_scene.json', '--size', '192x108', '--spp', '4', '--quiet') as server:
            browser.show(server.url)
            rested = 'document.querySelector(".viewer")?.dataset.done === "1"'
            browser.wait(rested)
            pixel = '''[...VIEW.viewer.context.getImageData(VIEW.viewer.live.canvas.width >> 1, VIEW.viewer.live.canvas.height >> 1, 1, 1).data].join()'''
            before = browser.wait(pixel)
            browser.wait('''(slider => { slider.value = 900; slider.dispatchEvent(new Event('input')); slider.dispatchEvent(new Event('change')); return true; })(
                document.querySelector('[data-pointer="/materials/red/roughness"] input[type=range]'))''')
            browser.wait(f'valueAt(VIEW.scene, "/materials/red/roughness") === 0.9 && {rested} && {pixel} !== "{before}"')
            browser.wait('!VIEW.keep.disabled')
            browser.wait('(VIEW.keep.click(), true)')
            browser.wait('VIEW.viewer.images.length === 2')
            browser.wait('(VIEW.viewer.inspect(96, 54), true)')
            browser.wait('!document.querySelector(".explain").hidden')
            browser.wait('document.querySelector("[data-metric=FLIP]")')
            self.assertEqual(browser.wait('String(document.scrollingElement.scrollWidth - innerWidth <= 0)'), 'true')
            self.assertEqual(browser.complaints, [])


if __name__ == '__main__':
    if NAME is None:
        print('skipped: without Firefox')
        sys.exit(1 if os.environ.get('NACRE_SKIP_NOTHING') else 77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
