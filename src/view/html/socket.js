// SPDX-License-Identifier: Apache-2.0
// view/html/socket.js: the connection: changes go out, pictures come in. When it breaks, it is tried
// again until the server is back.

const HEAD = ['kind', 'revision', 'width', 'height', 'frameWidth', 'frameHeight', 'samples', 'ofSamples', 'done', 'renderUs',
              'moving', 'partX', 'partY', 'partWidth', 'partHeight', 'piece', 'pieces'];
const HEAD_BYTES = 4 * HEAD.length;
const FILES = {3: 'exr', 4: 'html'};  // kinds of messages that are files

class Connection {
  // `on`: {text(message), frame(head, parts), file(extension, bytes), state(open)}
  constructor(on) {
    this.on = on;
    this.serial = 0;
    this.waiting = new Map();  // samples that were asked for, by id
    this.parts = [];  // of the picture that comes
    this.nextId = 1;
    this.open();
  }

  open() {
    const address = new URL('socket', location.href);
    address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = this.socket = new WebSocket(address);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => this.on.state(true);
    socket.onmessage = ({data}) => this.received(data);
    socket.onclose = () => {
      this.on.state(false);  // also of each try that fails
      for (const done of this.waiting.values()) done(null);
      this.waiting.clear();
      setTimeout(() => this.open(), 1000);
    };
  }

  received(data) {
    if (typeof data === 'string') return this.on.text(JSON.parse(data));
    const words = new Uint32Array(data, 0, HEAD.length);
    const head = Object.fromEntries(HEAD.map((name, i) => [name, words[i]]));
    if (head.kind === 1) {
      this.socket.send('taken');  // the next one may be made while this one is drawn
      if (head.piece === 0) this.parts = [];
      if (head.partHeight) this.parts.push({x: head.partX, y: head.partY, image: new ImageData(new Uint8ClampedArray(data, HEAD_BYTES), head.partWidth)});
      if (head.piece + 1 === head.pieces) this.on.frame(head, this.parts.splice(0));
      return undefined;
    }
    if (head.kind in FILES) return this.on.file(FILES[head.kind], new Uint8Array(data, HEAD_BYTES));
    const done = this.waiting.get(head.samples), size = head.width * head.height, planes = [];
    this.waiting.delete(head.samples);
    for (let i = 0; i < head.ofSamples; ++i) planes.push(new Float32Array(data, HEAD_BYTES + 4 * i * size, size));
    if (done) done(planes.length ? {head, planes} : null);
  }

  send(message) {
    if (this.socket.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }
  set(pointer, value, gesture) {
    this.send({set: pointer, value, gesture, serial: ++this.serial});
    return this.serial;
  }
  samples(layer) {
    return new Promise(done => {
      const id = this.nextId++;
      this.waiting.set(id, done);
      if (!this.send({samples: layer, id})) { this.waiting.delete(id); done(null); }
    });
  }
}
