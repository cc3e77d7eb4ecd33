# SPDX-License-Identifier: Apache-2.0
"""Random scenes for determinism_test.py: every material model, light, shape and map, in mixtures
that no scene made by hand has. They look like nothing; all that counts is that they are valid and
that hits of many kinds meet in one tile."""
import base64
import json
import math
import struct
import zlib

TEXTURES = ('colors', 'grey', 'normals', 'steep')
MAPPINGS = ('spherical', 'cylindrical', 'planar', 'cube')


def write_assets(folder, random):
    """The images and meshes that the scenes refer to, in a folder beside them."""
    folder.mkdir(parents=True, exist_ok=True)
    write_png(folder / 'colors.png', 16, 8, lambda: [random.randrange(256) for _ in range(3)])
    # Roughness 0 and 1 among others: narrow, wide and perfect lobes in one batch.
    write_png(folder / 'grey.png', 8, 8, lambda: [random.choice((0, 1, 9, 80, 255))] * 3)
    write_png(folder / 'normals.png', 8, 8,
              lambda: [128 + random.randrange(-40, 41), 128 + random.randrange(-40, 41), 240])
    # Steeper than that: normals that point below the surface, and away from most viewers.
    write_png(folder / 'steep.png', 8, 8,
              lambda: [random.randrange(256), random.randrange(256), random.randrange(100, 256)])
    write_sky(folder / 'sky.hdr', 16, 8, random)
    write_torus(folder / 'torus.obj', 16, 8)
    write_soup(folder / 'soup.ply', 12, random)
    write_model(folder / 'model.gltf', 40, random)
    write_spheres(folder / 'spheres.csv', 20, random)


def write_png(path, width, height, pixel):
    rows = b''.join(b'\0' + bytes(v for _ in range(width) for v in pixel())
                    for _ in range(height))
    with open(path, 'wb') as file:
        file.write(b'\x89PNG\r\n\x1a\n')
        for kind, data in ((b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0)),
                           (b'IDAT', zlib.compress(rows)), (b'IEND', b'')):
            file.write(struct.pack('>I', len(data)) + kind + data +
                       struct.pack('>I', zlib.crc32(kind + data)))


def write_sky(path, width, height, random):
    """An environment of unequal texels, one of them a sun."""
    texels = b''.join(bytes([random.randrange(1, 256) for _ in range(3)] +
                            [137 if i == 37 else 127]) for i in range(width * height))
    path.write_bytes(b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n' % (height, width) +
                     texels)


def write_torus(path, around, across):
    """With normals and texture coordinates."""
    lines = []
    for i in range(around):
        for k in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * k / across
            normal = (math.cos(a) * math.cos(b), math.sin(b), math.sin(a) * math.cos(b))
            center = (math.cos(a), 0, math.sin(a))
            lines.append('v %r %r %r' % tuple(c + 0.4 * n for c, n in zip(center, normal)))
            lines.append('vn %r %r %r' % normal)
            lines.append('vt %r %r' % (3 * i / around, k / across))
    for i in range(around):
        for k in range(across):
            corners = [((i + di) % around) * across + (k + dk) % across + 1
                       for di, dk in ((0, 0), (0, 1), (1, 1), (1, 0))]
            lines.append('f ' + ' '.join('%d/%d/%d' % (c, c, c) for c in corners))
    path.write_text('\n'.join(lines) + '\n')


def write_soup(path, triangles, random):
    """Triangles anywhere, without normals."""
    corners = '\n'.join('%r %r %r' % tuple(random.uniform(-1, 1) for _ in range(3))
                        for _ in range(3 * triangles))
    faces = '\n'.join('3 %d %d %d' % (i, i + 1, i + 2) for i in range(0, 3 * triangles, 3))
    path.write_text('ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\n'
                    'property float y\nproperty float z\nelement face %d\n'
                    'property list uchar int vertex_indices\nend_header\n%s\n%s\n' %
                    (3 * triangles, triangles, corners, faces))


def write_spheres(path, count, random):
    """Rows of x, y, z and radius."""
    rows = ([random.uniform(-2, 2) for _ in range(3)] + [10 ** random.uniform(-2, -0.3)]
            for _ in range(count))
    path.write_text('x,y,z,radius\n' + ''.join('%r,%r,%r,%r\n' % tuple(row) for row in rows))


def write_model(path, triangles, random):
    """Triangles with tangents of their own, and some of whose vertices are not there."""
    def unit():
        v = [random.gauss(0, 1) for _ in range(3)]
        length = math.sqrt(sum(x * x for x in v))
        return [x / length for x in v]

    buffer, views, accessors = b'', [], []

    def add(kind, rows):
        nonlocal buffer
        data = b''.join(struct.pack('<%df' % len(row), *row) for row in rows)
        views.append({'buffer': 0, 'byteOffset': len(buffer), 'byteLength': len(data)})
        accessor = {'bufferView': len(accessors), 'componentType': 5126, 'count': len(rows),
                    'type': kind}
        if not accessors:  # the first ones are positions
            accessor['min'] = [min(column) for column in zip(*rows)]
            accessor['max'] = [max(column) for column in zip(*rows)]
        accessors.append(accessor)
        buffer += data
        return len(accessors) - 1

    corners = range(3 * triangles)
    attributes = {
        'POSITION': add('VEC3', [[random.uniform(-1, 1) for _ in range(3)] for _ in corners]),
        'NORMAL': add('VEC3', [unit() for _ in corners]),
        'TANGENT': add('VEC4', [unit() + [random.choice((-1, 1))] for _ in corners]),
        'TEXCOORD_0': add('VEC2', [[random.uniform(-2, 2) for _ in range(2)] for _ in corners]),
        'TEXCOORD_1': add('VEC2', [[random.uniform(-2, 2) for _ in range(2)] for _ in corners]),
        'COLOR_0': add('VEC4', [[random.random() for _ in range(3)] +
                                [random.choice((0, 0.5, 1, 1))] for _ in corners])}
    uri = 'data:application/octet-stream;base64,' + base64.b64encode(buffer).decode()
    materials = [
        {'pbrMetallicRoughness': {'metallicFactor': metallic, 'roughnessFactor': roughness,
                                  'baseColorTexture': {'index': 0}},
         'normalTexture': {'index': 1, 'texCoord': texcoord}, **more}
        for metallic, roughness, texcoord, more in (
            (1, 0, 0, {}), (1, 0.3, 1, {'alphaMode': 'MASK'}),
            (0, 0.5, 0, {'alphaMode': 'MASK', 'alphaCutoff': 1}))]
    path.write_text(json.dumps({
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0, 1, 2]}],
        'nodes': [{'mesh': i, 'translation': [i - 1, 0, 0]} for i in range(3)],
        'meshes': [{'primitives': [{'attributes': attributes, 'material': i}]} for i in range(3)],
        'materials': materials, 'images': [{'uri': 'colors.png'}, {'uri': 'steep.png'}],
        'textures': [{'source': 0}, {'source': 1}], 'accessors': accessors,
        'bufferViews': views, 'buffers': [{'uri': uri, 'byteLength': len(buffer)}]}))


class SceneMaker:
    """One scene, from one random.Random."""

    def __init__(self, random):
        self.random = random
        self.mapped = random.random() < 0.4
        # Images placed by the meshes' own coordinates, which not all meshes have.
        self.by_uvs = self.mapped and random.random() < 0.4

    def make(self):
        r = self.random
        scene = {'nacre': 1, 'camera': self.camera(), 'image': {'filter': self.filter()},
                 'background': self.color()}
        if r.random() < 0.3:
            scene['image']['shadows'] = False
        if self.mapped:
            scene['textures'] = {name: self.texture(name) for name in TEXTURES}
            # The first channel of the image is the opacity: it has no alpha.
            scene['textures']['mask'] = {**self.texture('colors'), 'encoding': 'linear'}
        scene['materials'] = {f'm{i}': self.material() for i in range(r.randint(1, 6))}
        self.names = list(scene['materials'])
        if r.random() < 0.15:
            scene['materials']['split'] = {'model': 'split', 'at': [r.uniform(0.2, 0.8)],
                                           'materials': [r.choice(self.names) for _ in range(2)]}
            self.names.append('split')
        # Holes are for meshes of triangles.
        self.mesh_names = [name for name in self.names if name != 'split']
        if r.random() < 0.3:
            scene['materials']['leaf'] = self.leaf()
            self.mesh_names += ['leaf'] * 2
        scene['lights'] = self.lights()
        scene['shapes'] = [self.shape() for _ in range(r.choice((1, 1, 2, 3, 5, 9, 20)))]
        if r.random() < 0.3:
            scene['shapes'].append({'type': 'sphere', 'center': [0, -1001.5, 0], 'radius': 1000,
                                    'material': r.choice(self.names)})
        return scene

    def camera(self):
        r = self.random
        far = r.choice((0.1, 4, 10, 12, 300))
        position = [r.uniform(-1, 1), r.uniform(-0.5, 1), far]
        if r.random() < 0.2:
            return {'type': 'orthographic', 'position': position, 'height': r.uniform(2, 8)}
        return {'position': position, 'look_at': [0, 0, -1 if far < 1 else 0],
                'fov_y_deg': min(2 * math.degrees(math.atan(r.uniform(1, 4) / far)), 120)}

    def filter(self):
        name = self.random.choice(('box', 'box', 'gaussian', 'blackman_harris', 'mitchell'))
        return {'type': name}

    def color(self, most=1.0):
        r = self.random
        if r.random() < 0.15:
            return r.choice((0, most))
        return [r.uniform(0, most) for _ in range(3)]

    def point(self, reach):
        return [self.random.uniform(-reach, reach) for _ in range(3)]

    def texture(self, name):
        r = self.random
        texture = {'file': f'assets/{name}.png',
                   'mapping': 'uv' if self.by_uvs else r.choice(MAPPINGS),
                   'filter': r.choice(('nearest', 'bilinear', 'trilinear')),
                   'scale': r.choice((1, 3, 0.3))}
        if r.random() < 0.3:
            texture['wrap_u'] = r.choice(('repeat', 'clamp', 'mirror'))
        return texture

    def maybe_map(self, material, **maps):
        for key, value in maps.items():
            if self.mapped and self.random.random() < 0.35:
                material[key] = value

    def material(self):
        r = self.random
        model = r.choice(('lambert', 'oren_nayar', 'burley', 'phong', 'modified_phong',
                          'blinn_phong', 'metallic_roughness', 'metallic_roughness', 'conductor',
                          'dielectric', 'open_pbr'))
        material = {'model': model}
        if model in ('lambert', 'oren_nayar', 'burley'):
            material['albedo'] = self.color()
            if model != 'lambert':
                material['roughness'] = r.random()
            self.maybe_map(material, albedo_map='colors')
        elif 'phong' in model:
            material.update(color=self.color(), ks=self.color(), kd=self.color(),
                            shininess=r.choice((0, 1, 7.5, 60, 900, 3e4, 1e6)),
                            convention=r.choice(('classic', 'radiometric')))
            self.maybe_map(material, diffuse_map='colors', specular_map='colors',
                           shininess_map='grey')
        elif model == 'open_pbr':
            self.open_pbr(material)
        else:
            self.microfacet(material)
        if r.random() < 0.15:
            material['emission'] = self.color(0.3)
            self.maybe_map(material, emission_map='colors')
        steep = {'texture': 'steep', 'scale': r.choice((0.3, 1, 4))}
        self.maybe_map(material, normal_map=r.choice(('normals', steep)))
        if 'normal_map' not in material:
            self.maybe_map(material, bump_map={'texture': 'grey', 'distance': 0.02})
        return material

    def leaf(self):
        """A material of meshes: it cuts holes, and may be single-sided."""
        r = self.random
        leaf = self.material()
        leaf['sides'] = r.choice(('double', 'single'))
        leaf['opacity'] = r.choice((1, 1, 0.8))
        leaf['opacity_cutoff'] = r.choice((0.1, 0.5, 0.8, 1))
        if self.mapped and r.random() < 0.8:
            leaf['opacity_map'] = 'mask'
        return leaf

    def microfacet(self, material):
        r = self.random
        material.update(
            roughness=r.choice((0, 0.01, 0.05, 0.1, 0.2, 0.35, 0.6, 1)),
            shadowing=r.choice(('height_correlated', 'separable', 'schlick_direct', 'schlick_ibl')),
            compensation=r.choice(('turquin', 'kulla_conty', 'none')))
        if material['model'] == 'conductor':
            material['fresnel'] = r.choice(('exact', 'f82_tint', 'schlick'))
            if r.random() < 0.5:
                material['preset'] = r.choice(('gold', 'silver', 'copper', 'iron', 'aluminium'))
            self.maybe_map(material, roughness_map='grey')
            return
        material['diffuse_coupling'] = r.choice(('albedo_scaled', 'one_minus_fresnel', 'none'))
        material['base_color'] = self.color()
        material['diffuse'] = r.choice(('lambert', 'lambert', 'oren_nayar', 'burley'))
        if material['diffuse'] != 'lambert' and r.random() < 0.5:
            material['diffuse_roughness'] = r.random()
        self.maybe_map(material, base_color_map='colors')
        if material['model'] == 'dielectric':
            material['ior'] = r.choice((1, 1.1, 1.5, 2.4))
            material['fresnel'] = r.choice(('exact', 'schlick'))
            self.maybe_map(material, roughness_map='grey')
            return
        material['metallic'] = r.choice((0, 0, 0.5, 1))
        if r.random() < 0.3 and not material['shadowing'].startswith('schlick'):
            material.update(anisotropy=r.choice((0.3, 0.9, 1)),
                            anisotropy_rotation_deg=r.uniform(-180, 180))
            self.maybe_map(material, anisotropy_map='colors')
        material['dielectric_f0'] = r.choice((0.04, 0, 0.01, 0.1))
        if r.random() < 0.3:
            material['specular'] = r.random()
        if r.random() < 0.3:
            material['f82_tint'] = self.color()
        self.maybe_map(material, metallic_roughness_map='grey', specular_map='grey',
                       specular_color_map='colors')
        if r.random() < 0.3:
            material.update(coat=r.choice((1, 1, 0.5)), coat_ior=r.choice((1.3, 1.5, 2)),
                            coat_roughness=r.choice((0, 0.01, 0.1, 0.3, 1)))
            self.maybe_map(material, coat_map='grey', coat_roughness_map='grey',
                           coat_normal_map='normals')
        if r.random() < 0.3:
            material.update(sheen_color=self.color(), sheen_roughness=r.choice((0, 0.1, 0.4, 1)))
            self.maybe_map(material, sheen_color_map='colors', sheen_roughness_map='grey')
        if r.random() < 0.2:
            material.update(iridescence=r.choice((1, 1, 0.5)),
                            iridescence_thickness_nm=r.choice((0, 200, 500, 2000)),
                            iridescence_ior=r.choice((1, 1.3, 2)),
                            iridescence_model=r.choice(('gltf', 'spectral', 'lines')))

    def open_pbr(self, material):
        r = self.random
        roughness = (0, 0.01, 0.1, 0.3, 1)
        material.update(rules=r.choice(('spec_1_1', 'spec_1_2', 'materialx', 'adobe')),
                        base_color=self.color(), base_metalness=r.choice((0, 0, 0.5, 1)),
                        base_diffuse_roughness=r.choice((0, 0, 1)),
                        specular_color=self.color(), specular_roughness=r.choice(roughness),
                        specular_ior=r.choice((1, 1.1, 1.5, 2.4)))
        self.maybe_map(material, base_color_map='colors', base_metalness_map='grey',
                       specular_color_map='colors', specular_roughness_map='grey')
        if r.random() < 0.3:
            material.update(specular_roughness_anisotropy=r.choice((0.3, 0.9, 1)),
                            geometry_tangent_deg=r.uniform(-180, 180))
        if r.random() < 0.4:
            material.update(coat_weight=r.choice((1, 1, 0.5)), coat_color=self.color(),
                            coat_roughness_anisotropy=r.choice((0, 0, 0.9)),
                            coat_ior=r.choice((1, 1.3, 1.6, 2)),
                            coat_metal=r.choice(('unchanged', 'unchanged', 'gulbrandsen')),
                            coat_roughness=r.choice(roughness))
        if r.random() < 0.3:
            material.update(fuzz_weight=r.random(), fuzz_color=self.color(),
                            fuzz_roughness=r.choice((0, 0.1, 0.4, 1)))
            self.maybe_map(material, fuzz_color_map='colors', fuzz_roughness_map='grey')
        if r.random() < 0.2:
            material.update(emission_luminance=r.choice((0.1, 1, 10)), emission_color=self.color(),
                            emission_through=r.choice(('coat_path', 'coat_color', 'base_factors',
                                                       'materialx')))
        if r.random() < 0.3:
            material.update(thin_film_weight=r.choice((1, 1, 0.5)),
                            thin_film_thickness=r.choice((0, 0.2, 0.5, 2)),
                            thin_film_ior=r.choice((1, 1.4, 2)))

    # Punctual lights are the most frequent: of theirs there are the most forms of kernels.
    def lights(self):
        r = self.random
        lights, sky = {}, False
        for i in range(r.choice((0, 1, 1, 2, 2, 3, 4, 6, 20))):
            kind = r.choice(('ambient', 'directional', 'directional', 'point', 'point', 'point',
                             'point', 'spot', 'spot', 'sphere', 'rectangle', 'disk', 'mesh',
                             'environment'))
            if kind == 'environment':
                if sky:
                    continue
                sky = True
            light = {'type': kind, **getattr(self, kind + '_light')()}
            if kind != 'ambient' and r.random() < 0.4:
                light['shadows'] = False
            lights[f'light {i}'] = light
        return lights

    def ambient_light(self):
        return {'radiance': self.color(0.2)}

    def directional_light(self):
        return {'direction_of_travel': self.point(1), 'irradiance': self.color(3)}

    def attenuation(self):
        return self.random.choice(('inverse_square', 'inverse_square', 'none',
                                   {'constant': 1, 'linear': 0.1, 'quadratic': 0.01}))

    def point_light(self):
        return {'position': self.point(self.random.choice((1, 3, 9, 9, 900))),
                'intensity': self.color(300), 'attenuation': self.attenuation()}

    def spot_light(self):
        cutoff = self.random.uniform(5, 90)
        return {'position': self.point(6), 'intensity': self.color(300),
                'attenuation': self.attenuation(), 'direction_of_travel': self.point(1),
                'cutoff_deg': cutoff, 'inner_deg': cutoff * self.random.choice((0, 0.5, 1)),
                'exponent': self.random.choice((0, 1, 20)),
                'edge': self.random.choice(('smoothstep', 'square'))}

    def area(self):
        return {'radiance': self.color(20), 'visible': self.random.random() < 0.5}

    def sphere_light(self):
        return {'center': self.point(5), 'radius': self.random.uniform(0.05, 1), **self.area()}

    def rectangle_light(self):
        return {'center': self.point(5), 'facing': self.point(1), 'up': [0.1, 1, 0.2],
                'width': self.random.uniform(0.1, 3), 'height': self.random.uniform(0.1, 3),
                'two_sided': self.random.random() < 0.5, **self.area()}

    def disk_light(self):
        return {'center': self.point(5), 'facing': self.point(1),
                'radius': self.random.uniform(0.1, 2),
                'two_sided': self.random.random() < 0.5, **self.area()}

    def mesh_light(self):
        r = self.random
        light = {'two_sided': r.random() < 0.5, **self.area()}
        kind = r.choice(('icosphere', 'uv_sphere', 'file'))
        if kind == 'file':
            light.update(file=r.choice(('assets/torus.obj', 'assets/soup.ply')),
                         transform={'translate': self.point(4), 'scale': r.uniform(0.2, 1)})
        elif kind == 'icosphere':
            light[kind] = {'center': self.point(4), 'radius': 0.5,
                           'subdivisions': r.randrange(3)}
        else:
            light[kind] = {'center': self.point(4), 'radius': 0.5, 'segments': 6, 'rings': 4}
        return light

    def environment_light(self):
        r = self.random
        sky = r.choice(({'radiance': self.color()},
                        {'gradient': {'zenith': self.color(), 'ground': self.color()}},
                        {'quadratic': {'radiance': self.color(), 'axis': self.point(1),
                                       'linear': 0.5, 'quadratic': 0.5}},
                        {'image': 'assets/sky.hdr', 'scale': self.color()}))
        return {**sky, 'rotate_deg': r.uniform(0, 360), 'background': r.random() < 0.5}

    def shape(self):
        r = self.random
        kinds = ('uv_sphere', 'mesh', 'grid', 'pair', 'cloud', 'spheres')
        kind = r.choice(('sphere',) * 12 + kinds + (() if self.by_uvs else ('icosphere',)))
        return {'type': kind, **getattr(self, kind + '_shape')()}

    def sphere_shape(self):
        r = self.random
        sphere = {'center': r.choice(([0, 0, 0], self.point(2))),
                  'radius': r.choice((1, 10 ** r.uniform(-2, 0.5))),
                  'material': r.choice(self.names)}
        if self.mapped and sphere['material'] != 'split' and r.random() < 0.1:
            sphere['displacement'] = {'texture': 'grey', 'distance': 0.1, 'segments': 24}
        return sphere

    def faces(self):
        return {'interpolation': self.random.choice(('phong', 'phong', 'gouraud', 'flat',
                                                     'faceted')),
                'smooth_terminator': self.random.random() < 0.5,
                'material': self.random.choice(self.mesh_names)}

    def icosphere_shape(self):
        return {'center': self.point(2), 'radius': self.random.uniform(0.2, 1.5),
                'subdivisions': self.random.randrange(4), **self.faces()}

    def uv_sphere_shape(self):
        return {'center': self.point(2), 'radius': self.random.uniform(0.2, 1.5), 'segments': 12,
                'rings': 7, **self.faces()}

    def mesh_shape(self):
        soup = 'assets/torus.obj' if self.by_uvs else 'assets/soup.ply'
        return {'file': self.random.choice(('assets/torus.obj', soup)),
                'transform': {'translate': self.point(1.5), 'rotate_deg': self.point(180)},
                **self.faces()}

    def grid_shape(self):
        return {'center': self.point(1), 'spacing': 0.9,
                'material': self.random.choice([n for n in self.names if n != 'split']),
                'rows': {'count': 2}, 'columns': {'count': 3}}

    def pair_shape(self):
        side = {'material': self.random.choice([n for n in self.names if n != 'split']),
                'count': 2}
        return {'center': self.point(1), 'a': side, 'b': side}

    def cloud_shape(self):
        return {'count': self.random.choice((10, 500)), 'seed': self.random.randrange(9),
                'min': [-2, -2, -2], 'max': [2, 2, 2], 'radius': [0.01, 0.3],
                'materials': self.random.sample(self.names, 1)}

    def spheres_shape(self):
        return {'file': 'assets/spheres.csv',
                'material': self.random.choice([n for n in self.names if n != 'split'])}
