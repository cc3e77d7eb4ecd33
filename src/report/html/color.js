// SPDX-License-Identifier: Apache-2.0
// report/html/color.js: from linear radiance to 8-bit codes, as nacre tonemap makes them: the tone
// operators and the sRGB curve in double. Sources are cited in src/color/{tone,agx,transfer}.h.

const srgbOetf = x => x <= 0.0031308 ? 12.92 * x : 1.055 * Math.pow(x, 1 / 2.4) - 0.055;
const srgbEotf = v => v <= 0.04045 ? v / 12.92 : Math.pow((v + 0.055) / 1.055, 2.4);

// CODE_FROM[k]: the least light of code k. A table of guesses, never too high and at most a step or
// two too low, is put right by the thresholds: codes are exact.
const CODE_FROM = new Float64Array(257);
for (let k = 1; k < 256; ++k) CODE_FROM[k] = srgbEotf((k - 0.5) / 255);
CODE_FROM[256] = Infinity;
const CODE_GUESS = new Uint8Array(4097);
for (let i = 0, k = 0; i <= 4096; ++i) {
  while (i / 4096 >= CODE_FROM[k + 1]) ++k;
  CODE_GUESS[i] = k;
}
function srgbCode(light) {
  const x = light < 0 ? 0 : light > 1 ? 1 : light;
  let code = CODE_GUESS[x * 4096 | 0];
  while (x >= CODE_FROM[code + 1]) ++code;
  return code;
}

// Each takes radiance >= 0 and leaves display light in `out`.
const reinhard = x => x <= 1 ? x / (1 + x) : 1 / (1 + 1 / x);
function reinhardExtended(x) {
  const white = 4, below = Math.min(x, white);
  return Math.min(below * (1 + below / (white * white)) / (1 + below), 1);
}
function aces(x) {
  const u = Math.min(x, 1), v = x > 1 ? 1 / x : 1;
  return Math.min(u * (2.51 * u + 0.03 * v) / (u * (2.43 * u + 0.59 * v) + 0.14 * v * v), 1);
}
const each = curve => (r, g, b, out) => {
  out[0] = curve(r);
  out[1] = curve(g);
  out[2] = curve(b);
};

function neutral(r, g, b, out) {
  const start = 0.8 - 0.04, headroom = 1 - start;
  r = Math.min(r, Number.MAX_VALUE);
  g = Math.min(g, Number.MAX_VALUE);
  b = Math.min(b, Number.MAX_VALUE);
  const lowest = Math.min(r, g, b);
  const kept = lowest < 0.08 ? 6.25 * lowest * lowest : lowest - 0.04;
  r = r - lowest + kept;
  g = g - lowest + kept;
  b = b - lowest + kept;
  const peak = Math.max(r, g, b);
  if (peak >= start) {
    const newPeak = 1 - headroom * headroom / (peak + (headroom - start));
    const shrink = newPeak / (0.15 * (peak - newPeak) + 1) / peak;
    r = newPeak - shrink * (peak - r);
    g = newPeak - shrink * (peak - g);
    b = newPeak - shrink * (peak - b);
  }
  out[0] = r;
  out[1] = g;
  out[2] = b;
}

const AGX_INSET = [[0.842479062253094, 0.0784335999999992, 0.0792237451477643],
                   [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
                   [0.0423756549057051, 0.0784336, 0.879142973793104]];
const AGX_OUTSET = [[1.19687900512017, -0.0980208811401368, -0.0990297440797205],
                    [-0.0528968517574562, 1.15190312990417, -0.0989611768448433],
                    [-0.0529716355144438, -0.0980434501171241, 1.15107367264116]];
const AGX_SUMS = AGX_INSET.map(row => row[0] + row[1] + row[2]);
const AGX_IN = AGX_INSET.map((row, i) => row.map(v => v / AGX_SUMS[i]));
const AGX_OUT = AGX_OUTSET.map(row => row.map((v, j) => v * AGX_SUMS[j]));
function agxCurve(x) {
  const light = Math.min(Math.max(x, 0.18 / 1024), 0.18 * 90.509667991878083);
  const s = (Math.log2(light / 0.18) + 10) / 16.5 - 10 / 16.5;
  if (s < 0) return 0.5 + 2 * s / Math.cbrt(1 - 59.507875 * s * s * s);
  return 0.5 + 2 * s * Math.pow(1 + 69.8627891354554 * Math.pow(s, 3.25), -4 / 13);
}
function agx(r, g, b, out) {
  r = Math.min(r, 1e6);
  g = Math.min(g, 1e6);
  b = Math.min(b, 1e6);
  const row = (m, x, y, z) => m[0] * x + m[1] * y + m[2] * z;
  const x = agxCurve(row(AGX_IN[0], r, g, b));
  const y = agxCurve(row(AGX_IN[1], r, g, b));
  const z = agxCurve(row(AGX_IN[2], r, g, b));
  for (let i = 0; i < 3; ++i) {
    out[i] = Math.pow(Math.min(Math.max(row(AGX_OUT[i], x, y, z), 0), 1), 2.2);
  }
}

const TONES = {
  neutral, reinhard: each(reinhard), reinhard_extended: each(reinhardExtended), aces: each(aces),
  agx, none: each(x => Math.min(x, 1)),
};

const light = new Float64Array(3);

// The codes of a colour at out[at], [at + 1], [at + 2]; NaN is magenta.
function displayCodes(tone, scale, r, g, b, out, at) {
  if (r !== r || g !== g || b !== b) {
    out[at] = out[at + 2] = 255;
    out[at + 1] = 0;
    return;
  }
  tone(r > 0 ? r * scale : 0, g > 0 ? g * scale : 0, b > 0 ? b * scale : 0, light);
  out[at] = srgbCode(light[0]);
  out[at + 1] = srgbCode(light[1]);
  out[at + 2] = srgbCode(light[2]);
}
