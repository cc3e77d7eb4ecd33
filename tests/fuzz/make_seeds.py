#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the seeds in tests/fuzz/corpus: small valid files, one or more for each target.

Usage: make_seeds.py NACRE ROOT. Needs oiiotool for the image formats that nacre does not write.
"""
import base64
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

NACRE, ROOT = sys.argv[1], pathlib.Path(sys.argv[2])
CORPUS = ROOT / 'tests/fuzz/corpus'
SCENES = ROOT / 'scenes'


def write(target, name, data):
    folder = CORPUS / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())


# ---- Scenes ----

def replace_files(value):
    """A scene that names the files that the targets have beside it, small enough for a fuzzer."""
    if isinstance(value, list):
        return [replace_files(v) for v in value]
    if not isinstance(value, dict):
        return value
    value = {k: replace_files(v) for k, v in value.items() if k != '$schema'}
    if isinstance(value.get('file'), str):
        value['file'] = 'mesh.obj' if value.get('type') == 'mesh' else 'texture.png'
    if isinstance(value.get('image'), str):
        value['image'] = 'floats.pfm'
    if value.get('type') == 'cloud':
        value['count'] = 20
    for key, most in ('subdivisions', 1), ('segments', 8), ('rings', 4):
        if key in value:
            value[key] = min(value[key], most)
    return value


EVERYTHING = {
    'nacre': 1,
    'camera': {'type': 'orthographic', 'height': 4, 'position': [0, 0, 5], 'look_at': [0, 0, 0]},
    'image': {'width': 8, 'height': 4, 'spp': 2, 'seed': 1, 'shadows': True,
              'filter': {'type': 'mitchell', 'width': 2}},
    'textures': {'t': {'file': 'texture.png', 'filter': 'nearest', 'wrap_u': 'mirror',
                       'mapping': {'kind': 'planar', 'axis': [0, 0, 1], 'size': 2},
                       'scale': [2, 1], 'offset': 0.5, 'encoding': 'linear', 'rotate_deg': 5},
                 'u': {'file': 'texture.png', 'mapping': 'cube'}},
    'materials': {
        'a': {'model': 'conductor', 'preset': 'gold', 'roughness': 0.3, 'compensation': 'kulla_conty'},
        'b': {'model': 'dielectric', 'ior': 1.5, 'base_color': [0.5, 0.2, 0.1], 'diffuse': 'burley'},
        'c': {'model': 'oren_nayar', 'albedo': 0.5, 'albedo_map': 'u', 'bump_map': 't',
              'normal_map': {'texture': 't', 'scale': 2, 'convention': 'literal'}},
        'd': {'model': 'split', 'at': [0.5], 'materials': ['a', 'b']}},
    'lights': {'sky': {'type': 'environment', 'image': 'floats.pfm', 'rotate_deg': 30},
               'm': {'type': 'mesh', 'file': 'mesh.ply', 'radiance': 2,
                     'transform': {'scale': 2, 'rotate_deg': [0, 90, 0]}},
               'r': {'type': 'rectangle', 'center': [0, 2, 0], 'facing': [0, -1, 0], 'width': 1,
                     'height': 2, 'radiance': [1, 2, 3], 'two_sided': True}},
    'shapes': [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'c',
                'displacement': {'texture': 't', 'distance': 0.1, 'segments': 8}},
               {'type': 'mesh', 'file': 'mesh.obj', 'material': 'a', 'normals': 'area',
                'crease_angle_deg': 30, 'interpolation': 'gouraud',
                'transform': {'translate': [1, 0, 0], 'scale': [1, 2, 3]}},
               {'type': 'pair', 'a': {'material': 'a', 'parameter': 'roughness', 'values': [0.1, 0.2]},
                'b': {'material': 'b', 'parameter': 'roughness', 'from': 0.1, 'to': 1, 'count': 2}}],
    'background': [0.1, 0.2, 0.3]}


def scenes():
    for path in sorted(SCENES.glob('*.json')):
        if path.name == 'nacre.schema.json':
            continue
        scene = replace_files(json.loads(path.read_text()))
        write('scene_json', path.name, json.dumps(scene))
    write('scene_json', 'everything.json', json.dumps(EVERYTHING))
    write('set_path', 'numbers', '/image/spp=4\n/camera/position=[0,1,6]\n/materials/a/roughness=0.5\n')
    write('set_path', 'objects', '/lights/key={"type":"ambient","radiance":1}\n/shapes/0/radius=2\n'
          '/materials/b~1~0/shininess=20\n/image/filter/type="box"\n')
    write('set_path', 'model', '/materials/default/base_color=[1,0,0]\n/background=0.2\n')


# ---- MaterialX ----

def materialx():
    def of(shader, inputs, nodes=''):
        return (f'<materialx version="1.39" colorspace="acescg" fileprefix="">{nodes}'
                f'<{shader} name="s" type="surfaceshader">{inputs}</{shader}>'
                '<surfacematerial name="m" type="material"><input name="surfaceshader" '
                'type="surfaceshader" nodename="s"/></surfacematerial></materialx>\n')

    def value(name, kind, text, more=''):
        return f'<input name="{name}" type="{kind}" value="{text}" {more}/>'

    def link(name, kind, node, more=''):
        return f'<input name="{name}" type="{kind}" nodename="{node}" {more}/>'

    image = value('file', 'filename', 'texture.png', 'colorspace="srgb_texture"')
    write('materialx', 'open_pbr', of('open_pbr_surface', (
        value('base_color', 'color3', '0.1, 0.6, 0.9') + value('coat_weight', 'float', '1') +
        value('subsurface_weight', 'float', '0.5') + value('transmission_weight', 'float', '1'))))
    write('materialx', 'standard', of('standard_surface', (
        link('base_color', 'color3', 'a') + link('normal', 'vector3', 'n') +
        '<input name="specular_roughness" type="float" nodegraph="g" output="o"/>' +
        value('specular_anisotropy', 'float', '0.5') + value('sheen', 'float', '0.2')), (
        f'<tiledimage name="i" type="color3">{image}{value("uvtiling", "vector2", "2, 3")}</tiledimage>'
        f'<mix name="a" type="color3">{link("fg", "color3", "i")}{value("mix", "float", "0.5")}</mix>'
        '<texcoord name="t" type="vector2"/>'
        f'<place2d name="p" type="vector2">{link("texcoord", "vector2", "t")}'
        f'{value("rotate", "float", "30")}{value("scale", "vector2", "2, 2")}</place2d>'
        f'<image name="v" type="vector3">{image}{link("texcoord", "vector2", "p")}</image>'
        f'<normalmap name="n" type="vector3">{link("in", "vector3", "v")}</normalmap>'
        f'<nodegraph name="g">{value("r", "float", "0.25")}<power name="q" type="float">'
        '<input name="in1" type="float" interfacename="r"/></power>'
        '<output name="o" type="float" nodename="q"/></nodegraph>')))
    write('materialx', 'gltf', of('gltf_pbr', (
        link('base_color', 'color3', 'c', 'output="outcolor"') +
        link('alpha', 'float', 'c', 'output="outa"') + value('alpha_mode', 'integer', '1') +
        link('metallic', 'float', 'e', 'output="outz"') +
        link('roughness', 'float', 'e', 'output="outy"') + value('clearcoat', 'float', '1')), (
        f'<gltf_colorimage name="c" type="multioutput">{image}</gltf_colorimage>'
        f'<gltf_image name="i" type="vector3">{image}{value("rotate", "float", "90")}</gltf_image>'
        f'<separate3 name="e" type="multioutput">{link("in", "vector3", "i")}</separate3>')))
    write('materialx', 'included', (
        '<materialx version="1.39"><xi:include href="included.mtlx"/><look name="l">'
        '<materialassign name="x" geom="b" material="m"/></look></materialx>'
        '\n<!-- included -->\n' + of('open_pbr_surface', value('fuzz_weight', 'float', '1'))))


# ---- OBJ and PLY ----

def meshes():
    write('obj', 'square', 'mtllib fuzz.mtl\no a\ng b c\nv 0 0 0\nv 1 0 0 1 1 1\nv 1 1 0\nv 0 1 0\n'
          'vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nusemtl m\ns 1\nf 1/1/1 2/2/1 3/3/1\nf -4//-1 -2//-1 -1//-1\n'
          'usemtl n\ns off\nf 1 2 3 4\nl 1 2\np 1\n'
          '\n# mtl\nnewmtl m\nKa 0 0 0\nKd 1 0.5 0.5\nKs 1 1 1\nNs 20\nillum 2\nd 1\n'
          'map_Kd -s 2 2 2 -o 0.1 0 0 -clamp on texture.png\nnorm texture.png\nKe 1 1 1\nNi 1.5\n'
          'newmtl n\nillum 0\nTr 0.5\nmap_Ns -mm 0 1 -bm 2 -imfchan r texture.png\nPr 0.1\nPm 1\n'
          'newmtl o\nPr 0.5\nPs 0.5\nPc 1\nPcr 0.1\nmap_Ps texture.png\nmap_Pc texture.png\nmap_Pcr texture.png\n')
    write('obj', 'bare', 'v 0 0 0\nv 1 0 0\nv 0 1e0 0.5\nvt 0.5\nvw 1 0 1\nt x 1/1/1 1 2 a\nf 1/1 2/1 3/1\n')
    head = ('ply\nformat {} 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty float y\n'
            'property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n'
            'element face 2\nproperty list uchar int vertex_indices\nend_header\n')
    text = '0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 1 2 3\n3 0 1 2\n4 0 1 2 3\n'
    write('ply', 'text', head.format('ascii') + text)
    for name, order in ('binary_little_endian', '<'), ('binary_big_endian', '>'):
        body = b''.join(struct.pack(order + 'fffBBB', x, y, 0, 1, 2, 3)
                        for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
        body += struct.pack(order + 'B3i', 3, 0, 1, 2) + struct.pack(order + 'B4i', 4, 0, 1, 2, 3)
        write('ply', name, head.format(name).encode() + body)
    write('ply', 'cloud', 'ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\n'
          'property double y\nproperty double z\nproperty float radius\nend_header\n0 0 0 1\n2 0 0 0.5\n')
    write('ply', 'strips', 'ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n'
          'property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\n'
          'property float t\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n'
          '0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n1 1 0 0 0 1 1 1\n6 0 1 2 3 -1 0\n')
    write('ply', 'points', 'ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n'
          'property float z\nproperty uchar material\nend_header\n0 0 0 1\n2 0 0 0\n')
    write('sphere_file', 'points', (CORPUS / 'ply/points').read_bytes())
    write('sphere_file', 'named', 'x,y,z,id,radius,material\r\n# a comment\r\n1,2,3,7,0.5,a\r\n\r\n4,5,6,8,,1\r\n')
    write('sphere_file', 'in_order', '1 2 3 .5 0\n4 5 6 1e-1 1\n')
    write('sphere_file', 'semicolons', '\ufeff1;2;3\n4;5;6\n')
    for name, kind, order in ('floats', '<f4', False), ('doubles', '>f8', True):
        header = str({'descr': kind, 'fortran_order': order, 'shape': (2, 5)}).ljust(117) + '\n'
        write('sphere_file', name, b'\x93NUMPY\1\0' + struct.pack('<H', len(header)) + header.encode() +
              struct.pack(kind[0] + '10' + {'4': 'f', '8': 'd'}[kind[2]], *[1] * 10))


# ---- Tables of BRDFs ----

def tables():
    names = [f'{what}_{axis}' for what in ('light', 'view') for axis in 'xyz'] + ['f_r', 'f_g', 'f_b']
    row = [0, 0, 1, 0.6, 0, 0.8, 0.1, 0.2, 0.3]
    write('table', 'csv', '# material: {"model": "lambert"}\n' + ','.join(names) + ',pdf,diffuse\n' +
          ','.join(map(str, row)) + ',1,nan\n0,0,1,0.70711,0,0.70711,1e300,-inf,0,1,1\n')
    write('table', 'nameless', ' '.join(map(str, row)) + '\n')
    write('table', 'rows_json', json.dumps({'header': {'material': {}}, 'columns': names, 'rows': [row, row]}))
    write('table', 'arrays_json', '{"light": [[0,0,1]], "view": [[0,0,1]], "f": [NaN], "albedo": [[1,-Infinity,0]]}')
    write('table', 'records_json', '[{"light": [0,0,1], "view": [0,0,1], "f": 1}]')
    records = [('light', '<f4', (3,)), ('view', '<f4', (3,)), ('f', '<f4')]
    for name, kind, shape, letter, numbers in (('npy', '>f8', (1, 9), '>9d', row),
                                               ('records', records, (1,), '<7f', row[:7])):
        header = str({'descr': kind, 'fortran_order': True, 'shape': shape}).ljust(181) + '\n'
        write('table', name, b'\x93NUMPY\1\0' + struct.pack('<H', len(header)) + header.encode() +
              struct.pack(letter, *numbers))


# ---- Measured BRDFs ----

def tensors(fields):
    """fields: {name: (shape, type, numbers)}."""
    kinds = {1: 'B', 10: 'f', 11: 'd'}
    size = 18 + sum(13 + len(name) + 8 * len(shape) for name, (shape, _, _) in fields.items())
    head, data = b'tensor_file\0' + struct.pack('<BBI', 1, 0, len(fields)), b''
    for name, (shape, kind, numbers) in fields.items():
        head += struct.pack('<H', len(name)) + name.encode()
        head += struct.pack(f'<HBQ{len(shape)}Q', len(shape), kind, size + len(data), *shape)
        data += struct.pack(f'<{len(numbers)}{kinds[kind]}', *numbers)
    return head + data


def measured():
    write('merl', 'table', struct.pack('<3id', 90, 90, 180, 1500))
    write('merl', 'black', struct.pack('<3id', 90, 90, 180, -1))
    write('merl', 'whole_circle', struct.pack('<3id', 90, 90, 360, 1))
    write('merl', 'big_endian', struct.pack('>3id', 90, 90, 180, 1))

    def ramp(*shape):
        count = 1
        for n in shape:
            count *= n
        return shape, 10, [1 + i % 7 / 7 for i in range(count)]

    angles = {'theta_i': ((2,), 10, [0, 1.5])}
    squares = {'ndf': ramp(2, 3), 'sigma': ramp(2, 2)}
    rgb = {**angles, 'phi_i': ((1,), 10, [0]), **squares, 'vndf': ramp(1, 2, 2, 3),
           'luminance': ramp(1, 2, 2, 2), 'rgb': ramp(1, 2, 3, 2, 2),
           'jacobian': ((1,), 1, [1]), 'description': ((4,), 1, [110, 111, 110, 101])}
    write('rgl', 'isotropic', tensors(rgb))
    write('rgl', 'quarter', tensors({**angles, 'phi_i': ((3,), 10, [-3.1415927, -2.3, -1.5707964]),
                                     **squares, 'vndf': ramp(3, 2, 2, 2),
                                     'rgb': ramp(3, 2, 3, 2, 2), 'jacobian': ((1,), 1, [0])}))
    spectra = {name: value for name, value in rgb.items() if name not in ('rgb', 'luminance')}
    write('rgl', 'spectra', tensors({**spectra, 'wavelengths': ((4,), 11, [400, 500, 600, 700]),
                                     'spectra': ramp(1, 2, 4, 2, 2)}))


# ---- glTF ----

def png(width=2, height=2, kind=2, filter_type=0, bits=8, extra=b''):
    samples = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[kind] * bits // 8
    raw = b''.join(bytes([filter_type]) + bytes((x * 37 + y * 11) % (4 if kind == 3 else 256)
                                                for x in range(width * samples))
                   for y in range(height))

    def chunk(name, data):
        return struct.pack('>I', len(data)) + name + data + struct.pack('>I', zlib.crc32(name + data))
    palette = chunk(b'PLTE', bytes(range(12))) if kind == 3 else b''
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, bits, kind, 0, 0, 0))
            + palette + extra + chunk(b'IDAT', zlib.compress(raw, 9)) + chunk(b'IEND', b''))


def gltf_document():
    """(document, the bytes of its buffer): a square with whatever nacre reads of a glTF file."""
    positions = struct.pack('<12f', 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0)
    normals = struct.pack('<12f', *([0, 0, 1] * 4))
    uvs = struct.pack('<8f', 0, 0, 1, 0, 1, 1, 0, 1)
    indices = struct.pack('<6H', 0, 1, 2, 0, 2, 3)
    sparse_at, sparse_values = struct.pack('<2H', 1, 2), struct.pack('<6f', 1, 0, 0, 1, 1, 0)
    views, data = [], b''
    for part in (positions, normals, uvs, indices, sparse_at, sparse_values, png()):
        data += bytes(-len(data) % 4)
        views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(part)})
        data += part
    document = {
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0, 2]}],
        'extensionsUsed': ['KHR_lights_punctual', 'KHR_materials_ior', 'KHR_texture_transform'],
        'extensions': {'KHR_lights_punctual': {'lights': [
            {'type': 'spot', 'color': [1, 1, 0.5], 'intensity': 20, 'range': 10,
             'spot': {'innerConeAngle': 0.1, 'outerConeAngle': 0.5}},
            {'type': 'directional'}, {'type': 'point', 'name': 'p'}]}},
        'nodes': [{'mesh': 0, 'children': [1], 'translation': [0, 0, 1], 'rotation': [0, 0, 0, 1],
                   'scale': [1, 1, 1]},
                  {'camera': 0, 'matrix': [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 4, 1]},
                  {'extensions': {'KHR_lights_punctual': {'light': 0}}, 'translation': [0, 0, 5]}],
        'meshes': [{'primitives': [
            {'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2}, 'indices': 3, 'material': 0},
            {'attributes': {'POSITION': 4}, 'mode': 5}]}],
        'materials': [{'pbrMetallicRoughness': {
            'baseColorFactor': [1, 0.5, 0.5, 1], 'metallicFactor': 0, 'roughnessFactor': 0.4,
            'baseColorTexture': {'index': 0, 'extensions': {'KHR_texture_transform': {
                'offset': [0.1, 0.2], 'rotation': 0.3, 'scale': [2, 1]}}}},
            'normalTexture': {'index': 0, 'scale': 0.5}, 'emissiveFactor': [0, 0, 0],
            'extensions': {'KHR_materials_ior': {'ior': 1.4},
                           'KHR_materials_specular': {'specularColorFactor': [1, 1, 1]}}}],
        'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 0.1}}],
        'textures': [{'source': 0, 'sampler': 0}],
        'samplers': [{'magFilter': 9728, 'minFilter': 9987, 'wrapS': 33071, 'wrapT': 33648}],
        'images': [{'bufferView': 6, 'mimeType': 'image/png'}],
        'accessors': [
            {'bufferView': 0, 'componentType': 5126, 'type': 'VEC3', 'count': 4,
             'min': [0, 0, 0], 'max': [1, 1, 0]},
            {'bufferView': 1, 'componentType': 5126, 'type': 'VEC3', 'count': 4},
            {'bufferView': 2, 'componentType': 5126, 'type': 'VEC2', 'count': 4},
            {'bufferView': 3, 'componentType': 5123, 'type': 'SCALAR', 'count': 6},
            {'bufferView': 0, 'componentType': 5126, 'type': 'VEC3', 'count': 4, 'sparse': {
                'count': 2, 'indices': {'bufferView': 4, 'componentType': 5123},
                'values': {'bufferView': 5}}}],
        'bufferViews': views, 'buffers': [{'byteLength': len(data)}]}
    return document, data


def glb(document, data, magic=b'glTF', version=2, length=None):
    text = json.dumps(document).encode()
    text += b' ' * (-len(text) % 4)
    data += bytes(-len(data) % 4)
    chunks = struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(data), b'BIN\0') + data
    return struct.pack('<4sII', magic, version, 12 + len(chunks) if length is None else length) + chunks


def data_uri(data, kind='application/octet-stream'):
    return f'data:{kind};base64,' + base64.b64encode(data).decode()


def gltf_files():
    document, data = gltf_document()
    write('glb', 'everything', glb(document, data))
    document['buffers'][0]['uri'] = data_uri(data)
    write('gltf', 'everything', json.dumps(document))
    document['images'] = [{'uri': data_uri(png(), 'image/png')}]
    write('gltf', 'image_uri', json.dumps(document))
    document['images'] = [{'uri': 'texture.png'}]
    document['buffers'].append({'uri': 'buffer.bin', 'byteLength': 90})
    write('gltf', 'files', json.dumps(document))


# ---- Images ----

def images():
    for kind in 0, 2, 3, 4, 6:
        for filter_type in (0, 4) if kind == 2 else (1 + kind % 3,):
            write('texture_image', f'kind{kind}_filter{filter_type}.png', png(5, 3, kind, filter_type))
    write('texture_image', 'words.png', png(3, 2, 2, 2, 16))
    write('texture_image', 'lossless.webp', bytes.fromhex(  # 2 x 2 pixels
        '524946462c000000574542505650384c1f0000002f014000001f201048de1f3a8df9171014fc1fddfc47640fe0060c'
        '11fd0f0100'))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        base = [NACRE, 'render', SCENES / 'first_scene.json', '--spp', '1', '--reproducible', '--quiet']
        for compression in 'none', 'zip', 'zips', 'piz', 'dwaa':
            path = folder / (compression + '.exr')
            subprocess.run(base + ['-o', path, '--compression', compression, '--size', '9x7'], check=True)
        subprocess.run(base + ['-o', folder / 'layers.exr', '--size', '4x4', '--depth', 'float',
                               '--layers', 'Z,id.object,N', '--region', '1,1,3,3'], check=True)
        tool = ['oiiotool', str(folder / 'none.exr'), '--ch', 'R,G,B']
        for options, path in ((['--compression', 'rle'], 'rle.exr'), (['--compression', 'b44'], 'b44.exr'),
                              (['--compression', 'pxr24'], 'pxr24.exr'), (['--tile', '4', '4'], 'tiled.exr'),
                              ([], 'a.jpg'), ([], 'a.hdr'), ([], 'a.tif'), ([], 'a.ppm'),
                              (['--compression', 'none', '-d', 'uint8'], 'plain.tif'),
                              (['--compression', 'lzw', '-d', 'half', '--tile', '16', '16'], 'tiled.tif')):
            subprocess.run(tool + options + ['-o', str(folder / path)], check=True, capture_output=True)
        (folder / 'a.pfm').write_bytes(b'PF\n2 1\n-1.0\n' + struct.pack('<6f', 0, 1, 2, 3, 4, 5))
        for path in sorted(folder.iterdir()):
            data = path.read_bytes()
            if path.suffix == '.exr':
                write('compare_image', path.name, data)
                write('environment_image', path.name, data)
            elif path.suffix in ('.hdr', '.pfm'):
                write('environment_image', path.name, data)
            else:
                write('texture_image', path.name, data)
    write('compare_image', 'grey.png', png(4, 4, 0, 3))
    write('compare_image', 'alpha.png', png(4, 4, 6, 4))
    write('texture_image', 'none.exr', (CORPUS / 'compare_image/none.exr').read_bytes())


if __name__ == '__main__':
    scenes()
    materialx()
    meshes()
    tables()
    measured()
    gltf_files()
    images()
    print(sum(1 for path in CORPUS.rglob('*') if path.is_file()), 'seeds')
