// SPDX-License-Identifier: Apache-2.0
// report/html/error_map.js: where and how much two pictures differ, in the colours of nacre compare.

// "Viridis" by van der Walt and Smith (2015), and for signs blue through grey to red.
const VIRIDIS = ['#440154', '#482878', '#3e4989', '#31688e', '#26828e', '#1f9e89', '#35b779',
                 '#6ece58', '#b5de2b', '#fde725'].map(hex);
const SIGNED = ['#053061', '#2166ac', '#4393c3', '#92c5de', '#dddddd', '#f4a582', '#d6604d',
                '#b2182b', '#67001f'].map(hex);
function hex(text) { return [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16)); }

function colorOf(stops, t, out, at) {
  const place = Math.min(Math.max(t, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(place), stops.length - 2), f = place - i;
  for (let c = 0; c < 3; ++c) {
    out[at + c] = Math.round(stops[i][c] + f * (stops[i + 1][c] - stops[i][c]));
  }
}

const QUANTITIES = {
  relative: 'relative to √(reference² + 0.01²)', absolute: 'absolute', signed: 'signed: image − reference',
};

// As SampleError: infinite if only one is finite, 0 for the same infinity or two NaN.
function sampleError(got, reference) {
  if (Number.isFinite(got) && Number.isFinite(reference)) return got - reference;
  return got === reference || (got !== got && reference !== reference) ? 0 : Infinity;
}

// The error of a pixel: of the channel where it is largest.
function pixelError(got, gotIndex, reference, referenceIndex, quantity) {
  let worst = 0;
  for (let c = 0; c < reference.planes.length; ++c) {
    const expected = reference.planes[c][referenceIndex];
    let error = sampleError(got.planes[c][gotIndex], expected);
    if (quantity === 'relative') error = Math.abs(error) / Math.hypot(expected, 0.01);
    else if (quantity === 'absolute') error = Math.abs(error);
    if (Math.abs(error) > Math.abs(worst)) worst = error;
  }
  return worst;
}

// t in [0, 1] of an error on the scale, logarithmic but for FLIP, which has its own.
function scalePlace(error, quantity, low, high) {
  if (quantity === 'flip' || quantity === 'hdr_flip') return error;
  const place = Math.min(Math.max(Math.log(Math.abs(error) / low) / Math.log(high / low), 0), 1);
  return quantity === 'signed' ? 0.5 + 0.5 * Math.sign(error) * place : place;
}

function errorColor(error, quantity, low, high, out, at) {
  out[at + 3] = 255;
  if (error === 0) out[at] = out[at + 1] = out[at + 2] = quantity === 'signed' ? 0xdd : 0;
  else if (!Number.isFinite(error)) { out[at] = out[at + 2] = 255; out[at + 1] = 0; }
  else colorOf(quantity === 'signed' ? SIGNED : VIRIDIS, scalePlace(error, quantity, low, high), out, at);
}

// The scale with its ticks, as an SVG.
function errorLegend(quantity, low, high) {
  const width = 440, left = 30, span = width - 2 * left, bar = [];
  const stops = quantity === 'signed' ? SIGNED : VIRIDIS;
  const color = [0, 0, 0], steps = 88;
  for (let i = 0; i < steps; ++i) {
    colorOf(stops, (i + 0.5) / steps, color, 0);
    bar.push(svg('rect', {x: left + span * i / steps, y: 4, width: span / steps + 0.6, height: 12,
                          fill: `rgb(${color.join(' ')})`}));
  }
  const ticks = [];
  const tick = (t, text) => ticks.push(
      svg('line', {x1: left + t * span, x2: left + t * span, y1: 16, y2: 21, class: 'axis'}),
      svg('text', {x: left + t * span, y: 34, 'text-anchor': 'middle', class: 'soft'}, text));
  const flip = quantity === 'flip' || quantity === 'hdr_flip';
  if (flip) for (const t of [0, 0.25, 0.5, 0.75, 1]) tick(t, String(t));
  else {
    const decades = Math.log10(high / low), step = Math.max(1, Math.ceil(decades / (quantity === 'signed' ? 3 : 7)));
    for (let p = Math.ceil(Math.log10(low) - 1e-9); p <= Math.log10(high) + 1e-9; p += step) {
      const t = Math.log10(10 ** p / low) / decades;
      if (quantity !== 'signed') tick(t, `1e${p}`);
      else { tick(0.5 + t / 2, `1e${p}`); if (t > 0) tick(0.5 - t / 2, `−1e${p}`); }
    }
  }
  return svg('svg', {viewBox: `0 0 ${width} 40`, width, height: 40, role: 'img',
                     'aria-label': `scale of the error map, ${flip ? 'FLIP from 0 to 1' : `${quantity}, from ${low} to ${high}`}`}, bar, ticks);
}
