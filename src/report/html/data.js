// SPDX-License-Identifier: Apache-2.0
// report/html/data.js: what the file holds: the report, and samples that are unpacked when needed.

const REPORT = JSON.parse(document.getElementById('report').textContent);
const planes = new Map();  // by number of blob: promises of Float32Array

function bytesOf(number) {
  const text = atob(document.getElementById('blob' + number).textContent);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// All halves as floats.
const HALVES = new Float32Array(65536);
for (let bits = 0; bits < 65536; ++bits) {
  const exponent = bits >> 10 & 31, fraction = bits & 1023;
  const size = exponent === 31 ? (fraction ? NaN : Infinity)
             : exponent ? (1 + fraction / 1024) * 2 ** (exponent - 15) : fraction * 2 ** -24;
  HALVES[bits] = bits >> 15 ? -size : size;
}

// Samples lie byte by byte: all lowest bytes, then the next ones.
function assemble(bytes, type) {
  if (type === 'byte') return Float32Array.from(bytes, b => b / 255);
  if (type === 'half') {
    const count = bytes.length / 2, out = new Float32Array(count);
    for (let i = 0; i < count; ++i) out[i] = HALVES[bytes[i] | bytes[count + i] << 8];
    return out;
  }
  const count = bytes.length / 4, words = new Uint32Array(count);
  for (let i = 0; i < count; ++i) {
    words[i] = bytes[i] | bytes[count + i] << 8 | bytes[2 * count + i] << 16 |
               bytes[3 * count + i] << 24;
  }
  return new Float32Array(words.buffer);
}

function plane(channel) {
  if (!planes.has(channel.blob)) {
    planes.set(channel.blob, inflate(bytesOf(channel.blob)).then(b => assemble(b, channel.type)));
  }
  return planes.get(channel.blob);
}

// A layer of an image with its samples, or null: {kind, names, planes}.
async function loadLayer(image, name) {
  const layer = image.layers.find(l => l.name === name);
  if (!layer) return null;
  return {kind: layer.kind, names: layer.channels.map(c => c.name),
          planes: await Promise.all(layer.channels.map(plane))};
}
