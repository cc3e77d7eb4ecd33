// SPDX-License-Identifier: Apache-2.0
// report/html/paint.js: layers and errors as pictures of 8 bits.

function blank(image) {
  const canvas = document.createElement('canvas');
  canvas.width = image.width;
  canvas.height = image.height;
  const context = canvas.getContext('2d');
  return {canvas, context, pixels: context.createImageData(image.width, image.height)};
}

// The range of the finite samples, for layers that are no colours.
function rangeOf(layer) {
  if (!layer.range) {
    let low = Infinity, high = -Infinity;
    for (const samples of layer.planes) {
      for (const v of samples) {
        if (v < low && v !== -Infinity) low = v;
        if (v > high && v !== Infinity) high = v;
      }
    }
    layer.range = low <= high ? [low, high] : [0, 1];
  }
  return layer.range;
}

// A colour for each number, far from that of the next: multiples of the golden ratio.
function idColor(id, out, at) {
  const hue = (id + 1) * 0.61803398875 % 1 * 6;
  for (let c = 0; c < 3; ++c) {
    const t = Math.abs((hue + [0, 4, 2][c]) % 6 - 3) - 1;
    out[at + c] = 60 + 170 * Math.min(Math.max(t, 0), 1);
  }
}

function paintLayer(image, layer, look) {
  const {canvas, context, pixels} = blank(image);
  const [p0, p1 = p0, p2 = p0] = layer.planes, out = pixels.data, count = p0.length;
  const scale = 2 ** look.exposure, tone = TONES[look.tone];
  const paintCodes = code => {
    for (let i = 0; i < count; ++i) [p0, p1, p2].forEach((p, c) => { out[4 * i + c] = code(p[i]); });
  };
  if (layer.kind === 'color' && image.transfer === 'display') {
    paintCodes(v => Math.round(255 * v));
  } else if (layer.kind === 'color') {
    for (let i = 0; i < count; ++i) displayCodes(tone, scale, p0[i], p1[i], p2[i], out, 4 * i);
  } else if (layer.kind === 'normal') {
    paintCodes(v => 127.5 + 127.5 * v);
  } else if (layer.kind === 'id') {
    for (let i = 0; i < count; ++i) if (p0[i] > 0) idColor(p0[i], out, 4 * i);
  } else {
    const [low, high] = rangeOf(layer), gain = 255 / (high - low || 1);
    paintCodes(v => gain * (v - low));
  }
  for (let i = 0; i < count; ++i) out[4 * i + 3] = 255;
  context.putImageData(pixels, 0, 0);
  return canvas;
}

// The sample index of `image` at the cell (x, y) of the frame, or -1.
function cellIndex(image, x, y) {
  const u = x - image.x0, v = y - image.y0;
  return u >= 0 && v >= 0 && u < image.width && v < image.height ? v * image.width + u : -1;
}

// Where only one picture has pixels, nothing is painted.
function paintError(image, got, referenceImage, reference, look) {
  const {canvas, context, pixels} = blank(image);
  for (let y = 0, i = 0; y < image.height; ++y) {
    for (let x = 0; x < image.width; ++x, ++i) {
      const r = cellIndex(referenceImage, x + image.x0, y + image.y0);
      if (r < 0) continue;
      errorColor(pixelError(got, i, reference, r, look.quantity), look.quantity, look.low, look.high,
                 pixels.data, 4 * i);
    }
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}

// A map that came with the report, of values in [0, 1].
function paintMap(map, samples) {
  const {canvas, context, pixels} = blank(map);
  for (let i = 0; i < samples.length; ++i) {
    colorOf(VIRIDIS, samples[i], pixels.data, 4 * i);
    pixels.data[4 * i + 3] = 255;
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}
