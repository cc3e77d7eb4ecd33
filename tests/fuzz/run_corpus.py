#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders every scene and model of a folder, small, and reports what a program must not do: die of a
signal, hang, end with another code than 0, 64 or 65, refuse without words, or leave part of a file.

Usage: run_corpus.py NACRE FOLDER [--seconds S] [--memory-gib G]
SECONDS are of computing; 10 without it.
"""
import argparse
import collections
import concurrent.futures
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

ALLOWED = (0, 64, 65)
KINDS = ('.json', '.gltf', '.glb', '.obj', '.ply')


def is_whole_png(path):
    data = path.read_bytes()
    return data[:8] == b'\x89PNG\r\n\x1a\n' and data[-8:-4] == b'IEND'


def render(options, file):
    """(how it ended, the fault or None)"""
    # Seconds of computing: a busy machine is no fault. What only waits is caught by the clock.
    limits = ['prlimit', f'--as={int(options.memory_gib * 2**30)}', f'--cpu={options.seconds}']
    patience = 12 * options.seconds
    with tempfile.TemporaryDirectory() as name:
        out = pathlib.Path(name) / 'x.png'
        try:
            result = subprocess.run(
                limits + [options.nacre, 'render', file, '-o', out, '--size', '64x36', '--spp', '1',
                          '--threads', '1'], capture_output=True, timeout=patience, check=False)
        except subprocess.TimeoutExpired:
            return 'hang', f'still waiting after {patience} s'
        code, text = result.returncode, result.stderr.decode(errors='replace')
        left = sorted(os.listdir(name))
        if code in (-signal.SIGXCPU, -signal.SIGKILL):
            return 'hang', f'computed for {options.seconds} s'
        if code < 0:
            return f'signal {-code}', text[-300:]
        if code not in ALLOWED:
            return str(code), text[-300:]
        if code == 0 and (left != ['x.png'] or not is_whole_png(out)):
            return str(code), f'left {left}'
        if code != 0 and left:
            return str(code), f'refused it and left {left}'
        if code != 0 and 'error: ' not in text:
            return str(code), 'refused it without a word'
        return str(code), None


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('nacre')
    parser.add_argument('folder', type=pathlib.Path)
    parser.add_argument('--seconds', type=int, default=10)
    parser.add_argument('--memory-gib', type=float, default=16)
    options = parser.parse_args()
    files = sorted(path for path in options.folder.iterdir() if path.suffix in KINDS)
    ends, faults = collections.Counter(), []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for file, (end, fault) in zip(files, pool.map(lambda file: render(options, file), files)):
            ends[end] += 1
            if fault is not None:
                faults.append(f'{file}: {end}: {fault}')
    print(f'{len(files)} files: ' + ', '.join(f'{end}: {count}' for end, count in sorted(ends.items())))
    for fault in faults:
        print(fault)
    print(f'{len(faults)} faults')
    return 1 if faults or not files else 0


if __name__ == '__main__':
    sys.exit(main())
