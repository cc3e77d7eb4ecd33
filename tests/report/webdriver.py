# SPDX-License-Identifier: Apache-2.0
"""Headless Chromium by the WebDriver protocol of chromedriver, with Python's own library only."""
import json
import os
import shutil
import subprocess
import tempfile
import time
import urllib.request

ELEMENT = 'element-6066-11e4-a52e-4f735466cecf'
KEYS = {'shift': '\ue008', 'left': '\ue012', 'up': '\ue013', 'right': '\ue014', 'down': '\ue015',
        'tab': '\ue004', 'enter': '\ue007', 'escape': '\ue00c'}
SECONDS = 60  # for the browser to start, and for a page to show something: machines may be busy


def missing():
    """What the tests need and this machine lacks."""
    return [name for name in ('chromium', 'chromedriver') if shutil.which(name) is None]


class Browser:
    def __init__(self, network_log=True):
        """`network_log`: what a page fetches can be read; it costs time for each byte of it."""
        self.profile = tempfile.TemporaryDirectory()
        self.driver = subprocess.Popen(['chromedriver', '--port=0'], stdout=subprocess.PIPE,
                                       stderr=subprocess.DEVNULL, text=True)
        for line in self.driver.stdout:
            if 'started successfully on port' in line:
                self.root = f'http://127.0.0.1:{line.split()[-1].rstrip(".")}'
                break
        arguments = ['--headless=new', '--disable-gpu', '--hide-scrollbars', '--no-first-run',
                     '--force-device-scale-factor=1', f'--user-data-dir={self.profile.name}']
        if os.geteuid() == 0:  # Chromium's sandbox refuses to run as root
            arguments.append('--no-sandbox')
        options = {'args': arguments, 'binary': shutil.which('chromium')}
        logs = {'browser': 'ALL', **({'performance': 'ALL'} if network_log else {})}
        capabilities = {'browserName': 'chrome', 'goog:chromeOptions': options, 'goog:loggingPrefs': logs}
        self.session = ''
        answer = self.post('/session', {'capabilities': {'alwaysMatch': capabilities}})
        self.session = '/session/' + answer['sessionId']

    def request(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.root + path, data, method=method,
                                         headers={'Content-Type': 'application/json'})
        try:
            with urllib.request.urlopen(request, timeout=2 * SECONDS) as answer:
                return json.load(answer)['value']
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)['value']['message']) from None

    def post(self, path, body):
        return self.request('POST', path, body)

    def close(self):
        try:
            self.request('DELETE', self.session)
        finally:
            self.driver.terminate()
            self.driver.wait()
            self.profile.cleanup()

    def cdp(self, command, **parameters):
        return self.post(self.session + '/goog/cdp/execute', {'cmd': command, 'params': parameters})

    def resize(self, width, height):
        self.cdp('Emulation.setDeviceMetricsOverride', width=width, height=height,
                 deviceScaleFactor=1, mobile=width < 600)

    def open(self, path):
        self.log('performance')
        self.log('browser')
        self.post(self.session + '/url', {'url': path.absolute().as_uri()})

    def log(self, kind):
        return self.post(self.session + '/se/log', {'type': kind})

    def script(self, text, *arguments):
        return self.post(self.session + '/execute/sync',
                         {'script': text, 'args': list(arguments)})

    def find(self, selector):
        return self.post(self.session + '/element', {'using': 'css selector', 'value': selector})

    def element(self, selector, action, body=None):
        path = f'{self.session}/element/{self.find(selector)[ELEMENT]}/{action}'
        return self.post(path, body or {})

    def press(self, *keys, shift=False):
        """Keys to whatever has the focus."""
        actions = [{'type': 'keyDown', 'value': KEYS['shift']}] if shift else []
        for key in keys:
            value = KEYS.get(key, key)
            actions += [{'type': 'keyDown', 'value': value}, {'type': 'keyUp', 'value': value}]
        if shift:
            actions.append({'type': 'keyUp', 'value': KEYS['shift']})
        self.post(self.session + '/actions',
                  {'actions': [{'type': 'key', 'id': 'keys', 'actions': actions}]})

    def wait(self, text, *arguments):
        """Until the script's value is true; returns it."""
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            value = self.script(text, *arguments)
            if value:
                return value
            time.sleep(0.03)
        raise AssertionError(f'never became true: {text} {arguments}')
