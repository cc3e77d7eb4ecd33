# SPDX-License-Identifier: Apache-2.0
"""Just enough of EXR and PNG to know what is in nacre's own files."""
import struct
import zlib


class ExrRows:
    """The place of an image's pixels and, by channel, its form ('e', 'f', 'I') and rows of bytes."""

    def __init__(self, window):
        self.x0, self.y0, self.x1, self.y1 = window
        self.forms, self.rows = {}, {}


def read_exr_rows(path):
    """An uncompressed scanline file of halves, floats and uints."""
    data = path.read_bytes()
    place, header = 8, {}
    while data[place]:
        name_end = data.index(b'\0', place)
        type_end = data.index(b'\0', name_end + 1)
        size = struct.unpack_from('<i', data, type_end + 1)[0]
        header[data[place:name_end].decode()] = data[type_end + 5:type_end + 5 + size]
        place = type_end + 5 + size
    assert header['compression'] == b'\0', 'the file is compressed'
    image = ExrRows(struct.unpack('<4i', header['dataWindow']))
    entry = header['channels']
    while entry[0]:
        end = entry.index(b'\0')
        image.forms[entry[:end].decode()] = 'Ief'[entry[end + 1]]
        entry = entry[end + 17:]
    image.rows = {name: [] for name in image.forms}
    width = image.x1 - image.x0 + 1
    for row in range(image.y1 - image.y0 + 1):
        at = struct.unpack_from('<Q', data, place + 1 + 8 * row)[0] + 8
        for name, form in image.forms.items():
            size = width * struct.calcsize(form)
            image.rows[name].append(data[at:at + size])
            at += size
    return image


def read_exr(path):
    """{channel: rows of numbers} of such a file."""
    image = read_exr_rows(path)
    return {name: [struct.unpack(f'<{len(row) // struct.calcsize(form)}{form}', row)
                   for row in image.rows[name]] for name, form in image.forms.items()}


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
