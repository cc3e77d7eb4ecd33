#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the files in tests/fuzz/regressions that can be said in a line: each was, or would have been,
too much for a reader or for a library beneath it.

Usage: make_regressions.py ROOT
"""
import json
import pathlib
import struct
import sys

ROOT = pathlib.Path(sys.argv[1])
sys.argv = ['', '', str(ROOT)]
import make_seeds  # noqa: E402


def write(target, name, data):
    folder = ROOT / 'tests/fuzz/regressions' / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())


def scenes():
    scene = {'nacre': 1, 'materials': {'a': {'model': 'lambert'}}}
    cloud = {'type': 'cloud', 'count': 100_000_000, 'min': [0, 0, 0], 'max': [1, 1, 1], 'radius': 1,
             'materials': ['a']}
    write('scene_json', 'clouds', json.dumps({**scene, 'shapes': [cloud] * 9}))
    write('scene_json', 'name_with_nul', json.dumps({**scene, 'shapes': [
        {'type': 'mesh', 'file': 'mesh.obj\0.ply', 'material': 'a'}]}))
    write('scene_json', 'long_names', json.dumps({'nacre': 1, 'materials': {'a' * 9000: {'model': 'lambert'}},
                                                  'shapes': [{'type': 'sphere', 'center': [0, 0, 0],
                                                              'radius': 1, 'material': 'a' * 9001}]}))
    write('scene_json', 'deep', '[' * 5000)
    write('scene_json', 'deep_objects', '{"nacre":' * 2000)
    write('scene_json', 'overflow', '{"nacre": 1e999}')
    write('scene_json', 'half_a_surrogate', '{"nacre": 1, "background": "\\ud800"}')
    write('scene_json', 'grids', json.dumps({**scene, 'shapes': [
        {'type': 'grid', 'material': 'a', 'rows': {'count': 1000}, 'columns': {'count': 1000}}] * 9}))
    write('set_path', 'deep', '/a' * 3000 + '=1\n')
    write('set_path', 'no_pointer', 'a=1\n/~2=1\n/shapes/99999999999999999999=1\n/shapes/-=1\n')


def models():
    document, data = make_seeds.gltf_document()
    for name, change in (
            ('cycle', lambda d: d['nodes'][1].update(children=[0])),
            ('image_offset', lambda d: d['bufferViews'][6].update(byteOffset=1 << 40)),
            ('image_without_buffer', lambda d: d['bufferViews'][6].update(buffer=1 << 30)),
            ('zeros', lambda d: [a.update(count=1 << 24) or a.pop('bufferView') for a in d['accessors'][:3]]),
            ('count', lambda d: d['accessors'][0].update(count=1 << 52)),
            ('stride', lambda d: d['bufferViews'][0].update(byteStride=1 << 52)),
            ('no_bytes', lambda d: d['buffers'][0].update(byteLength=0))):
        spoilt = json.loads(json.dumps(document))
        change(spoilt)
        write('glb', name, make_seeds.glb(spoilt, data))
    empty = {'asset': {'version': '2.0'}, 'images': [{'bufferView': 0}], 'buffers': [{'byteLength': 0}],
             'bufferViews': [{'buffer': 0, 'byteOffset': 100, 'byteLength': 1}]}
    write('glb', 'offset_into_nothing', make_seeds.glb(empty, b''))
    write('glb', 'chunk_too_long', b'glTF' + struct.pack('<III4s', 2, 24, 1 << 31, b'JSON') + b'{}  ')
    write('gltf', 'deep_chain', json.dumps({
        'asset': {'version': '2.0'}, 'scenes': [{'nodes': [0]}],
        'nodes': [{'children': [i + 1]} for i in range(1000)] + [{}]}))
    write('gltf', 'base64', '{"asset":{"version":"2.0"},"buffers":[{"byteLength":9,'
          '"uri":"data:application/octet-stream;base64,====!"}]}')
    write('obj', 'tags', 't a 2147483647/2147483647/2147483647\nv 0 0 0\nf 1 1 1\n')
    write('obj', 'indices', 'v 0 0 0\nf 2147483647 -2147483648 1\n')
    write('obj', 'exponent', 'v 0 0 0\nvw 1 1 1e2147483649\nf 1 1 1\n')
    write('obj', 'long_name', 'v 0 0 0\nmtllib ' + 'x' * 5000 + '\nf 1 1 1\n')
    write('obj', 'smoothing', 'v 0 0 0\ns 99999999999999999999\nf 1 1 1\n')
    write('obj', 'corners', 'v 0 0 0\nf ' + '1 ' * 300 + '\n')
    head = 'ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n'
    write('ply', 'count', head.format('binary_little_endian', 2**64 - 1) + 'end_header\n')
    write('ply', 'empty_elements', head.format('ascii', 1) + 'element face 4000000000\nend_header\n0 0 0\n')
    write('ply', 'list', head.format('binary_big_endian', 1) + 'element face 1\n'
          'property list uint int vertex_indices\nend_header\n' + '\0' * 12 + '\x7f' * 8)


def images():
    png = make_seeds.png(2, 2)
    write('texture_image', 'huge.png', png[:16] + struct.pack('>II', 1 << 31, 1 << 31) + png[24:])
    write('texture_image', 'gif', b'GIF89a\1\0\1\0\x80\0\0\0\0\0\xff\xff\xff,\0\0\0\0\1\0\1\0\0\2\2D\1\0;')
    write('texture_image', 'no_rows.png', make_seeds.png(2, 0))
    write('compare_image', 'only_magic.exr', b'\x76\x2f\x31\x01')
    write('environment_image', 'huge.hdr', b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n')
    write('environment_image', 'huge.pfm', b'PF\n60000 60000\n-1.0\n')


if __name__ == '__main__':
    scenes()
    models()
    images()
