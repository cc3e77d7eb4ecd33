# SPDX-License-Identifier: Apache-2.0
"""Just enough of EXR and PNG to know what is in nacre's own files."""
import struct
import zlib


def read_exr(path):
    """{channel: rows of floats} of an uncompressed scanline file of halves, floats and uints."""
    data = path.read_bytes()
    place, header = 8, {}
    while data[place]:
        name_end = data.index(b'\0', place)
        type_end = data.index(b'\0', name_end + 1)
        size = struct.unpack_from('<i', data, type_end + 1)[0]
        header[data[place:name_end].decode()] = data[type_end + 5:type_end + 5 + size]
        place = type_end + 5 + size
    assert header['compression'] == b'\0', 'the file is compressed'
    x0, y0, x1, y1 = struct.unpack('<4i', header['dataWindow'])
    channels, entry = [], header['channels']
    while entry[0]:
        end = entry.index(b'\0')
        channels.append((entry[:end].decode(), 'Ief'[entry[end + 1]]))
        entry = entry[end + 17:]
    width, height = x1 - x0 + 1, y1 - y0 + 1
    image = {name: [] for name, _ in channels}
    for row in range(height):
        at = struct.unpack_from('<Q', data, place + 1 + 8 * row)[0] + 8
        for name, form in channels:
            values = struct.unpack_from(f'<{width}{form}', data, at)
            image[name].append(values)
            at += struct.calcsize(f'<{width}{form}')
    return image


def read_png(path):
    """Rows of (r, g, b) of an 8-bit RGB file without interlacing."""
    data, place, packed, width = path.read_bytes(), 8, b'', 0
    while place < len(data):
        size, kind = struct.unpack_from('>I4s', data, place)
        if kind == b'IHDR':
            width = struct.unpack_from('>I', data, place + 8)[0]
        if kind == b'IDAT':
            packed += data[place + 8:place + 8 + size]
        place += size + 12
    raw, stride = zlib.decompress(packed), 3 * width
    rows, above = [], bytearray(stride)
    for start in range(0, len(raw), stride + 1):
        row = bytearray(raw[start + 1:start + 1 + stride])
        for i in range(stride):
            left = row[i - 3] if i >= 3 else 0
            corner = above[i - 3] if i >= 3 else 0
            row[i] = row[i] + predict(raw[start], left, above[i], corner) & 255
        rows.append([tuple(row[i:i + 3]) for i in range(0, stride, 3)])
        above = row
    return rows


def predict(kind, left, up, corner):
    """PNG's filters 0 to 4."""
    if kind == 4:
        guess = left + up - corner
        return min((left, up, corner), key=lambda value: abs(guess - value))
    return (0, left, up, (left + up) // 2)[kind]
