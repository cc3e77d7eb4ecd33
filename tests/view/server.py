# SPDX-License-Identifier: Apache-2.0
"""`nacre view`, started for a test, and a WebSocket client that can misbehave."""
import base64
import json
import os
import socket
import struct
import subprocess
import tempfile
import time
import urllib.parse

WAIT_SECONDS = 60  # for one message: machines that test are busy


class Server:
    def __init__(self, program, *arguments, stderr=subprocess.PIPE, state=None):
        """`state`: the folder of edits that are kept; of its own and gone with the server if not given."""
        self.own_state = None if state else tempfile.TemporaryDirectory()
        # The address sanitizer keeps what is freed, 256 MiB of it, for a while: tests measure memory.
        sanitizer = ':'.join(filter(None, [os.environ.get('ASAN_OPTIONS'), 'quarantine_size_mb=8']))
        self.process = subprocess.Popen([program, 'view', '--no-open', *map(str, arguments)],
                                        stdout=subprocess.PIPE, stderr=stderr, text=True,
                                        env=os.environ | {'ASAN_OPTIONS': sanitizer, 'XDG_STATE_HOME': state or self.own_state.name})
        self.url = self.process.stdout.readline().strip()
        if not self.url:
            raise RuntimeError(self.process.stderr.read())
        parts = urllib.parse.urlsplit(self.url)
        self.port, self.token, self.address = parts.port, parts.path.strip('/'), parts.hostname
        self.host = parts.netloc

    def memory_mib(self):
        with open(f'/proc/{self.process.pid}/status', encoding='utf-8') as status:
            return next(int(line.split()[1]) / 1024 for line in status if line.startswith('VmRSS'))

    def close(self):
        """Ends it; returns the exit code."""
        if self.process.poll() is None:
            self.process.terminate()
        code = self.process.wait(20)
        for stream in self.process.stdout, self.process.stderr:
            if stream:
                stream.close()
        if self.own_state:
            self.own_state.cleanup()
        return code

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    # ---- Raw requests ----

    def connect(self):
        connection = socket.create_connection((self.address, self.port), 10)
        connection.settimeout(WAIT_SECONDS)
        return connection

    def request(self, path, method='GET', **headers):
        """Status, headers in lower case, body. A header of None is left out."""
        fields = {'Host': self.host, **{k.replace('_', '-'): v for k, v in headers.items()}}
        lines = [f'{method} {path} HTTP/1.1', *(f'{k}: {v}' for k, v in fields.items() if v is not None), '', '']
        with self.connect() as connection:
            connection.sendall('\r\n'.join(lines).encode())
            answer = b''
            try:
                while chunk := connection.recv(1 << 16):
                    answer += chunk
            except ConnectionResetError:
                pass
        head, _, body = answer.partition(b'\r\n\r\n')
        rows = head.decode('latin-1').split('\r\n')
        status = int(rows[0].split()[1]) if rows[0] else 0
        return status, dict((k.lower(), v) for k, _, v in (row.partition(': ') for row in rows[1:])), body

    def upgrade(self, path=None, **headers):
        """A WebSocket, or the status by which it was refused."""
        fields = {'Host': self.host, 'Origin': f'http://{self.host}', 'Upgrade': 'websocket', 'Connection': 'Upgrade',
                  'Sec-WebSocket-Key': base64.b64encode(os.urandom(16)).decode(), 'Sec-WebSocket-Version': '13',
                  **{k.replace('_', '-'): v for k, v in headers.items()}}
        path = path or f'/{self.token}/socket'
        lines = [f'GET {path} HTTP/1.1', *(f'{k}: {v}' for k, v in fields.items() if v is not None), '', '']
        connection = self.connect()
        connection.sendall('\r\n'.join(lines).encode())
        head = b''
        while b'\r\n\r\n' not in head:
            chunk = connection.recv(1)
            if not chunk:
                break
            head += chunk
        status = int(head.split()[1]) if head else 0
        if status != 101:
            connection.close()
            return status
        return WebSocket(connection)


class WebSocket:
    TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10

    def __init__(self, connection):
        self.connection = connection
        self.picture, self.pieces = b'', []

    def frame(self, opcode, payload, fin=True, masked=True, length=None):
        size = len(payload) if length is None else length
        head = bytes([(128 if fin else 0) | opcode])
        bit = 128 if masked else 0
        if size < 126:
            head += bytes([bit | size])
        elif size < 65536:
            head += bytes([bit | 126]) + struct.pack('>H', size)
        else:
            head += bytes([bit | 127]) + struct.pack('>Q', size)
        if masked:
            mask = os.urandom(4)
            head += mask
            size = len(payload)
            masked_by = (mask * (size // 4 + 1))[:size]
            payload = (int.from_bytes(payload, 'big') ^ int.from_bytes(masked_by, 'big')).to_bytes(size, 'big')
        self.connection.sendall(head + payload)

    def send(self, message):
        text = message if isinstance(message, (str, bytes)) else json.dumps(message)
        self.frame(self.TEXT, text if isinstance(text, bytes) else text.encode())

    def _bytes(self, count):
        data = bytearray()
        while len(data) < count:
            chunk = self.connection.recv(min(count - len(data), 1 << 20))
            if not chunk:
                raise ConnectionError('closed')
            data += chunk
        return bytes(data)

    def receive(self):
        """(opcode, payload) of the next frame. Raises ConnectionError once it is closed."""
        first, second = self._bytes(2)
        size = second & 127
        if size == 126:
            size, = struct.unpack('>H', self._bytes(2))
        elif size == 127:
            size, = struct.unpack('>Q', self._bytes(8))
        payload = self._bytes(size)
        if first & 15 == self.CLOSE:
            raise ConnectionError('closed by the server')
        return first & 15, payload

    def message(self):
        """The next one: a dict, or the head of what came as bytes with its "pixels"."""
        start = time.monotonic()
        while True:
            # Pings come all the time, and no socket's timeout with them.
            if time.monotonic() - start > WAIT_SECONDS:
                raise TimeoutError('nothing but pings')
            opcode, payload = self.receive()
            if opcode == self.TEXT:
                return json.loads(payload)
            if opcode != self.PING:
                break
            self.frame(self.PONG, payload)
        names = ('kind', 'revision', 'width', 'height', 'frame_width', 'frame_height', 'samples', 'of_samples', 'done',
                 'render_us', 'moving', 'part_x', 'part_y', 'part_width', 'part_height', 'piece', 'pieces')
        return dict(zip(names, struct.unpack('<17I', payload[:68])), pixels=payload[68:])

    def whole(self, piece):
        """All pixels once this piece of a picture, and those before it, have come; or None."""
        if piece['piece'] == 0:
            self.pieces = []
        self.pieces.append(dict(piece))
        if piece['piece'] + 1 < piece['pieces']:
            return None
        if len(self.picture) != 4 * piece['width'] * piece['height']:
            self.picture = bytearray(4 * piece['width'] * piece['height'])
        for part in self.pieces:
            row = 4 * part['part_width']
            for y in range(part['part_height']):
                at = 4 * ((part['part_y'] + y) * part['width'] + part['part_x'])
                self.picture[at:at + row] = part['pixels'][row * y:row * (y + 1)]
        return bytes(self.picture)

    def until(self, wanted):
        """Messages up to the first that `wanted` likes, which is returned; of pictures the whole ones."""
        start = time.monotonic()
        while time.monotonic() - start < 5 * WAIT_SECONDS:
            message = self.message()
            if message.get('kind') == 1:
                self.send('taken')
                message['pixels'] = self.whole(message)
                if message['pixels'] is None:
                    continue
            if wanted(message):
                return message
        raise TimeoutError('messages, but not the one that was waited for')

    def close(self):
        self.connection.close()
