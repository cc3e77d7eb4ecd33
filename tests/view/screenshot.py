#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The live view as READMEs show it: screenshot.py PROGRAM OUT.png [WIDTHxHEIGHT] [dark]"""
import base64
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / 'report'))
import webdriver  # noqa: E402
from server import Server  # noqa: E402


def main():
    program, out = sys.argv[1], pathlib.Path(sys.argv[2])
    width, height = map(int, (sys.argv[3] if len(sys.argv) > 3 else '1280x860').split('x'))
    browser = webdriver.Browser(network_log=False)
    try:
        if 'dark' in sys.argv:
            browser.cdp('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': 'dark'}])
        browser.resize(width, height)
        with Server(program, '--spp', 16, '--quiet') as server:
            browser.post(browser.session + '/url', {'url': server.url})
            browser.wait('return document.querySelector(".viewer")?.dataset.done === "1"')
            browser.script('VIEW.viewer.inspect(345, 205)')
            browser.wait('return !document.querySelector(".explain").hidden')
            # Times are another every time.
            browser.script('VIEW.status.textContent = VIEW.status.textContent.replace(/ · [^·]*s$/, "")')
            picture = browser.request('GET', browser.session + '/screenshot')
            out.write_bytes(base64.b64decode(picture))
    finally:
        browser.close()


if __name__ == '__main__':
    main()
