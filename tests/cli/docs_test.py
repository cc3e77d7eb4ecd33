#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The manual page and the completion that the program writes of itself.

Usage: docs_test.py PROGRAM
"""
import re
import shutil
import subprocess
import sys
import unittest

PROGRAM = sys.argv[1]


def docs(kind):
    return subprocess.run([PROGRAM, 'docs', kind], capture_output=True, text=True, check=True).stdout


def commands():
    text = subprocess.run([PROGRAM, '--help'], capture_output=True, text=True, check=True).stdout
    return re.findall(r'^  ([a-z]+) ', text.partition('Commands:')[2], re.M)


class DocsTest(unittest.TestCase):
    def complete(self, *words):
        """What bash offers for the last of the words."""
        line = ' '.join(f"'{word}'" for word in words)
        script = (f'{docs("bash")}\nCOMP_WORDS=({line})\nCOMP_CWORD={len(words) - 1}\n_nacre\n'
                  'printf "%s\\n" "${COMPREPLY[@]}"\n')
        result = subprocess.run(['bash', '-c', script], capture_output=True, text=True, check=True)
        self.assertEqual(result.stderr, '')
        return result.stdout.split()

    def test_every_command_and_option_is_in_the_page(self):
        page = docs('man').replace('\\-', '-')
        self.assertGreater(len(commands()), 10)
        for command in commands():
            self.assertIn(f'.SS nacre {command}\n', page)
            text = subprocess.run([PROGRAM, command, '--help-all'], capture_output=True, text=True,
                                  check=True).stdout
            for option in set(re.findall(r'^  (?:-\w,)?(--[a-z][a-z-]*)', text, re.M)):
                self.assertIn(option, page)
        self.assertNotIn('nacre docs', page)

    @unittest.skipUnless(shutil.which('groff'), 'groff is missing')
    def test_the_page_is_sound(self):
        result = subprocess.run(['groff', '-man', '-ww', '-Tutf8', '-z'], input=docs('man'),
                                capture_output=True, text=True, check=True)
        self.assertEqual(result.stderr, '')

    def test_commands_options_and_choices_are_completed(self):
        self.assertEqual(self.complete('nacre', 'ren'), ['render'])
        self.assertEqual(sorted(self.complete('nacre', 'co')), ['compare', 'convert'])
        self.assertNotIn('docs', self.complete('nacre', ''))
        self.assertEqual(self.complete('nacre', 'render', '--tonem'), ['--tonemap'])
        self.assertEqual(self.complete('nacre', 'render', 'a.json', '--tonemap', 're'),
                         ['reinhard', 'reinhard_extended'])
        self.assertEqual(self.complete('nacre', 'render', '--depth', ''), ['half', 'float'])
        # Files are bash's own.
        self.assertEqual(self.complete('nacre', 'render', 'scen'), [])
        self.assertEqual(self.complete('nacre', 'render', '-o', ''), [])


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
