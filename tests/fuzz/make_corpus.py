#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes valid and invalid files by seeded mutation, for run_corpus.py to render.

Usage: make_corpus.py NACRE ROOT FOLDER [--seed N] [--models N] [--images N] [--scenes N]
Models are glTF and GLB files, spoilt in their structure; images are textures and environments, cut
and with bits turned over, each named by a scene of its own; scenes are scene files, spoilt likewise.
"""
import argparse
import copy
import json
import pathlib
import random
import struct
import sys

sys.argv, arguments = sys.argv[:3], sys.argv[1:]  # make_seeds reads the first two
import make_seeds  # noqa: E402

HOSTILE = [None, True, [], {}, '', 'x', 0, 1, -1, 0.5, 7, 255, 65536, 2**31 - 1, 2**31, 2**32, 2**53,
           2**63, 2**64, -2**63, 1e30, 1e308, -1e308, 1e-320, '../../../etc/passwd', '/dev/zero',
           'data:;base64,AAAA', 'data:application/octet-stream;base64,!!!!', 'https://example.org/a',
           'a\0b', '\ud800', [0] * 50, [1e300] * 16, [-1], [[]]]


def places(value, path=()):
    """All places in a tree, as paths."""
    items = value.items() if isinstance(value, dict) else enumerate(value) \
        if isinstance(value, list) else ()
    for key, inner in items:
        yield path + (key,)
        yield from places(inner, path + (key,))


def parent_of(tree, path):
    for key in path[:-1]:
        tree = tree[key]
    return tree


def spoil(tree, rng):
    """Drops, replaces, moves or repeats something in a tree."""
    for _ in range(rng.choice([1, 1, 1, 2, 5])):
        all_places = list(places(tree))
        if not all_places:
            return
        path = rng.choice(all_places)
        parent, key = parent_of(tree, path), path[-1]
        act = rng.randrange(6)
        if act == 0:
            del parent[key]
        elif act in (1, 2):
            parent[key] = copy.deepcopy(rng.choice(HOSTILE))
        elif act == 3 and isinstance(parent[key], (int, float)) and not isinstance(parent[key], bool):
            parent[key] = rng.choice([parent[key] + 1, -parent[key] - 1, parent[key] * 1000, 1 << 30])
        elif act == 4:
            parent[key] = copy.deepcopy(parent_of(tree, (p := rng.choice(all_places)))[p[-1]])
        elif isinstance(parent[key], list) and parent[key]:
            parent[key] = parent[key] * rng.choice([2, 100])


def damage(data, rng):
    """Cuts bytes off, turns bits over, writes large numbers, or repeats a part."""
    data = bytearray(data)
    act = rng.randrange(5)
    if act == 0:
        return bytes(data[:rng.randrange(len(data))])
    for _ in range(rng.choice([1, 2, 8, 64])):
        at = rng.randrange(len(data))
        if act in (1, 2):
            data[at] ^= 1 << rng.randrange(8)
        elif act == 3:
            word = struct.pack(rng.choice('<>') + 'I', rng.choice([0, 1, 65535, 2**31 - 1, 2**31, 2**32 - 1]))
            data[at:at + 4] = word
        else:
            data[at:at] = data[at:at + rng.randrange(1, 200)]
            break
    return bytes(data)


def make_model(rng):
    """(extension, bytes): a glTF or GLB file, valid one time in ten."""
    document, data = make_seeds.gltf_document()
    kind = rng.randrange(10)
    if kind == 1:  # cycles and shared nodes
        nodes = document['nodes']
        for _ in range(rng.randrange(1, 4)):
            rng.choice(nodes)['children'] = [rng.randrange(len(nodes)) for _ in range(rng.choice([1, 3]))]
    elif kind == 2:  # a deep chain
        count = rng.choice([10, 1000, 100_000])
        document['nodes'] = [{'children': [i + 1]} for i in range(count)] + [{'mesh': 0}]
        document['scenes'] = [{'nodes': [0]}]
        del document['cameras']
    elif kind == 3:  # bounds
        part = rng.choice(['accessors', 'bufferViews', 'buffers'])
        for name in rng.sample(['count', 'byteOffset', 'byteLength', 'byteStride', 'bufferView', 'buffer'], 3):
            rng.choice(document[part])[name] = rng.choice([-1, 0, 1, 3, 17, 4096, 2**24, 2**31 - 1, 2**32, 2**52])
    elif kind == 4:  # no buffer view: zeros that cost nothing in the file
        for accessor in document['accessors'][:3]:
            accessor['count'] = rng.choice([4, 2**16, 2**24, 2**25])
            accessor.pop('bufferView', None)
    elif kind != 0:
        spoil(document, rng)
    if rng.random() < 0.5:
        if kind != 0 and rng.random() < 0.3:
            data = data[:rng.randrange(len(data) + 1)]
        uri = make_seeds.data_uri(data)
        if kind != 0 and rng.random() < 0.2:
            at = rng.randrange(40, len(uri))
            uri = uri[:at] + rng.choice(['!', '=', '\n', '', '====', '\0']) + uri[at + 1:]
        if isinstance(document.get('buffers'), list) and document['buffers'] \
                and isinstance(document['buffers'][0], dict):
            document['buffers'][0].setdefault('uri', uri)
        return '.gltf', json.dumps(document).encode()
    head = {}
    if kind == 5:
        head = rng.choice([{'magic': b'glTG'}, {'version': rng.choice([0, 1, 3, 2**32 - 1])},
                           {'length': rng.choice([0, 11, 12, 20, 2**31, 2**32 - 1])}])
    file = make_seeds.glb(document, data, **head)
    return '.glb', damage(file, rng) if kind in (6, 7) else file


TEXTURE_SCENE = {
    'nacre': 1, 'camera': {'position': [0, 0, 4], 'look_at': [0, 0, 0]},
    'textures': {'t': {'file': '', 'mapping': 'spherical'}},
    'materials': {'a': {'model': 'lambert', 'albedo': 0.8, 'albedo_map': 't'}},
    'lights': {'sky': {'type': 'ambient', 'radiance': 1}},
    'shapes': [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'a'}]}
SKY_SCENE = {
    'nacre': 1, 'camera': {'position': [0, 0, 4], 'look_at': [0, 0, 0]},
    'materials': {'a': {'model': 'lambert', 'albedo': 0.8}},
    'lights': {'sky': {'type': 'environment', 'image': ''}},
    'shapes': [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'a'}]}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('nacre')
    parser.add_argument('root', type=pathlib.Path)
    parser.add_argument('folder', type=pathlib.Path)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--models', type=int, default=700)
    parser.add_argument('--images', type=int, default=300)
    parser.add_argument('--scenes', type=int, default=300)
    options = parser.parse_args(arguments)
    rng = random.Random(options.seed)
    options.folder.mkdir(parents=True, exist_ok=True)
    (options.folder / 'texture.png').write_bytes(make_seeds.png())
    (options.folder / 'floats.pfm').write_bytes(b'PF\n2 1\n-1.0\n' + bytes(24))
    (options.folder / 'mesh.obj').write_text('v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n')
    (options.folder / 'mesh.ply').write_bytes((make_seeds.CORPUS / 'ply/text').read_bytes())

    for i in range(options.models):
        extension, data = make_model(rng)
        (options.folder / f'model{i:04}{extension}').write_bytes(data)

    corpus = options.root / 'tests/fuzz/corpus'
    textures = sorted((corpus / 'texture_image').iterdir())
    skies = sorted((corpus / 'environment_image').iterdir())
    for i in range(options.images):
        is_sky = rng.random() < 0.4
        source = rng.choice(skies if is_sky else textures)
        name = f'image{i:04}{source.suffix}.data{source.suffix}'
        data = source.read_bytes()
        (options.folder / name).write_bytes(data if rng.random() < 0.1 else damage(data, rng))
        scene = copy.deepcopy(SKY_SCENE if is_sky else TEXTURE_SCENE)
        if is_sky:
            scene['lights']['sky']['image'] = name
        else:
            scene['textures']['t']['file'] = name
        (options.folder / f'image{i:04}.json').write_text(json.dumps(scene))

    seeds = [json.loads(path.read_text()) for path in sorted((corpus / 'scene_json').iterdir())]
    for i in range(options.scenes):
        scene = copy.deepcopy(rng.choice(seeds))
        spoil(scene, rng)
        scene.get('image', {}).pop('spp', None) if isinstance(scene.get('image'), dict) else None
        text = json.dumps(scene).encode()
        (options.folder / f'scene{i:04}.json').write_bytes(damage(text, rng) if rng.random() < 0.2 else text)
    print(f'{options.models} models, {options.images} images, {options.scenes} scenes')


if __name__ == '__main__':
    main()
