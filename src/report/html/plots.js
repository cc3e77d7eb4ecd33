// SPDX-License-Identifier: Apache-2.0
// report/html/plots.js: diagrams as SVG: lines over two logarithmic axes, dots and stacked bars in
// rows. Okabe and Ito's colours (2008), and a mark of its own for each series.

const MARKS = [
  (x, y) => svg('circle', {cx: x, cy: y, r: 4}),
  (x, y) => svg('rect', {x: x - 3.7, y: y - 3.7, width: 7.4, height: 7.4}),
  (x, y) => svg('path', {d: `M${x} ${y - 5}l4.6 8h-9.2z`}),
  (x, y) => svg('path', {d: `M${x} ${y - 5.2}l5.2 5.2-5.2 5.2-5.2-5.2z`}),
  (x, y) => svg('path', {d: `M${x} ${y + 5}l4.6-8h-9.2z`}),
  (x, y) => svg('circle', {cx: x, cy: y, r: 4, 'fill-opacity': 0, 'stroke-width': 2}),
  (x, y) => svg('rect', {x: x - 3.7, y: y - 3.7, width: 7.4, height: 7.4, 'fill-opacity': 0, 'stroke-width': 2}),
  (x, y) => svg('path', {d: `M${x} ${y - 5}l4.6 8h-9.2z`, 'fill-opacity': 0, 'stroke-width': 2}),
];
const mark = (i, x, y, title) => svg('g', {class: `k${i % 8}`}, title ? svg('title', {}, title) : null,
                                     MARKS[i % MARKS.length](x, y));

// What each series looks like: 'line', 'dot' or 'bar'.
function keys(names, form) {
  const sample = i => form === 'bar' ? svg('rect', {x: 6, y: 1, width: 15, height: 12, class: `k${i % 8}`})
                                     : [form === 'line' ? svg('line', {x1: 0, x2: 27, y1: 7, y2: 7, class: `line k${i % 8}`}) : null,
                                        mark(i, 13.5, 7)];
  return el('div', {class: 'keys'}, names.map((name, i) => el('span', {},
      svg('svg', {viewBox: '0 0 27 14', 'aria-hidden': 'true'}, sample(i)), name)));
}

// A logarithmic axis over the values: place(value) in [0, 1] and labelled ticks.
function logAxis(values) {
  let low = Math.log10(Math.min(...values)), high = Math.log10(Math.max(...values));
  const margin = Math.max(0.06 * (high - low), 0.08);
  low -= margin;
  high += margin;
  const ticks = [], wide = high - low, steps = wide > 2.5 ? [1] : wide > 1 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 7];
  const skip = Math.max(1, Math.ceil(wide / (window.innerWidth < 640 ? 5 : 8)));
  for (let p = Math.floor(low); p <= high; ++p) {
    for (const s of steps) {
      const value = s * 10 ** p;
      if (p % skip === 0 && Math.log10(value) >= low && Math.log10(value) <= high) ticks.push(value);
    }
  }
  return {place: v => (Math.log10(v) - low) / (high - low), ticks};
}
const tickText = v => v >= 1e-3 && v < 1e5 ? String(Number(v.toPrecision(3))) : `1e${Math.round(Math.log10(v))}`;

// series: [{name, points: [[x, y, title]...]}...], both axes logarithmic.
function linePlot(title, series, xLabel, yLabel) {
  const kept = series.map(s => ({...s, points: s.points.filter(([x, y]) => x > 0 && y > 0)})).filter(s => s.points.length);
  if (!kept.length) return null;
  const narrow = window.innerWidth < 640, width = narrow ? 370 : 620, height = narrow ? 300 : 400, box = {left: 62, right: 14, top: 10, bottom: 48};
  const all = kept.flatMap(s => s.points), X = logAxis(all.map(p => p[0])), Y = logAxis(all.map(p => p[1]));
  const x = v => box.left + X.place(v) * (width - box.left - box.right);
  const y = v => height - box.bottom - Y.place(v) * (height - box.top - box.bottom);
  const picture = svg('svg', {viewBox: `0 0 ${width} ${height}`, class: 'plot', role: 'img', 'aria-label': `${title}: ${yLabel} by ${xLabel}`},
    X.ticks.map(v => [svg('line', {x1: x(v), x2: x(v), y1: box.top, y2: height - box.bottom, class: 'grid'}),
                      svg('text', {x: x(v), y: height - box.bottom + 18, 'text-anchor': 'middle', class: 'soft'}, tickText(v))]).flat(),
    Y.ticks.map(v => [svg('line', {x1: box.left, x2: width - box.right, y1: y(v), y2: y(v), class: 'grid'}),
                      svg('text', {x: box.left - 7, y: y(v) + 4.5, 'text-anchor': 'end', class: 'soft'}, tickText(v))]).flat(),
    svg('path', {d: `M${box.left} ${box.top}V${height - box.bottom}H${width - box.right}`, class: 'frame'}),
    svg('text', {x: (box.left + width - box.right) / 2, y: height - 8, 'text-anchor': 'middle'}, xLabel),
    svg('text', {x: 14, y: (box.top + height - box.bottom) / 2, 'text-anchor': 'middle',
                 transform: `rotate(-90 14 ${(box.top + height - box.bottom) / 2})`}, yLabel),
    kept.map((s, i) => [svg('polyline', {class: `line k${i % 8}`, points: s.points.map(p => `${x(p[0])},${y(p[1])}`).join(' ')}),
                        s.points.map(p => mark(i, x(p[0]), y(p[1]), `${s.name}: ${p[2] || `${show(p[0], 3)}, ${show(p[1], 3)}`}`))].flat()));
  return el('figure', {}, el('h3', {}, title), picture, keys(kept.map(s => s.name), 'line'));
}

// Room for the longest name, in the page's 13 pixel letters.
const nameWidth = rows => 20 + 7.2 * Math.max(...rows.map(row => row.name.length));

// rows: [{name, values: [number or undefined...]}...], one mark a series on a logarithmic axis.
function dotPlot(title, names, rows, xLabel) {
  const all = rows.flatMap(r => r.values).filter(v => v > 0);
  if (!all.length) return null;
  const left = nameWidth(rows), width = 760, line = 23, top = 8, height = top + line * rows.length + 46, X = logAxis(all);
  const x = v => left + X.place(v) * (width - left - 14), bottom = top + line * rows.length;
  return el('figure', {}, el('h3', {}, title), keys(names, 'dot'),
    el('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': title},
    svg('svg', {viewBox: `0 0 ${width} ${height}`, class: 'plot wide', role: 'img', 'aria-label': `${title}: ${xLabel}`},
      X.ticks.map(v => [svg('line', {x1: x(v), x2: x(v), y1: top, y2: bottom, class: 'grid'}),
                        svg('text', {x: x(v), y: bottom + 17, 'text-anchor': 'middle', class: 'soft'}, tickText(v))]).flat(),
      svg('text', {x: (left + width) / 2, y: height - 8, 'text-anchor': 'middle'}, xLabel),
      rows.map((row, r) => [
        svg('line', {x1: left, x2: width - 14, y1: top + line * (r + 0.5), y2: top + line * (r + 0.5), class: 'grid'}),
        svg('text', {x: left - 9, y: top + line * (r + 0.5) + 4.5, 'text-anchor': 'end'}, row.name),
        row.values.map((v, i) => v > 0 ? mark(i, x(v), top + line * (r + 0.5), `${row.name}, ${names[i]}: ${show(v, 3)}`) : null)]).flat(2))));
}

// rows: [{name, values: [number...]}...], parts of a bar on a linear axis.
function barPlot(title, names, rows, xLabel) {
  const totals = rows.map(r => r.values.reduce((a, b) => a + b, 0)), most = Math.max(...totals);
  if (!(most > 0)) return null;
  const left = nameWidth(rows), width = 760, line = 30, top = 6, bottom = top + line * rows.length, height = bottom + 46;
  const step = [1, 2, 5, 10].map(s => s * 10 ** Math.floor(Math.log10(most / 5))).find(s => most / s <= 7);
  const x = v => left + v / most * (width - left - 60), ticks = [];
  for (let v = 0; v <= most * 1.0001; v += step) ticks.push(v);
  return el('figure', {}, el('h3', {}, title), keys(names, 'bar'),
    el('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': title},
    svg('svg', {viewBox: `0 0 ${width} ${height}`, class: 'plot wide', role: 'img', 'aria-label': `${title}: ${xLabel}`},
      ticks.map(v => [svg('line', {x1: x(v), x2: x(v), y1: top, y2: bottom, class: 'grid'}),
                      svg('text', {x: x(v), y: bottom + 17, 'text-anchor': 'middle', class: 'soft'}, show(v, 3))]).flat(),
      svg('text', {x: (left + width - 60) / 2, y: height - 8, 'text-anchor': 'middle'}, xLabel),
      rows.map((row, r) => {
        let from = 0;
        return [svg('text', {x: left - 9, y: top + line * (r + 0.5) + 4.5, 'text-anchor': 'end'}, row.name),
          row.values.map((v, i) => {
            const part = svg('rect', {x: x(from), y: top + line * r + 5, width: Math.max(0, x(v) - x(0)), height: line - 10, class: `k${i % 8}`, 'stroke-width': 0},
                             svg('title', {}, `${row.name}, ${names[i]}: ${show(v, 3)}`));
            from += v;
            return part;
          }),
          svg('text', {x: x(totals[r]) + 7, y: top + line * (r + 0.5) + 4.5}, show(totals[r], 3))];
      }).flat(2))));
}
