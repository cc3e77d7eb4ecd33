// SPDX-License-Identifier: Apache-2.0
// report/html/dom.js: elements without markup: whatever text comes in stays text.

const SVG = 'http://www.w3.org/2000/svg';

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : value);
  }
  for (const child of children.flat(Infinity)) {
    if (child !== null && child !== undefined) element.append(child);
  }
  return element;
}

function el(tag, attributes = {}, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

function svg(tag, attributes = {}, ...children) {
  return fill(document.createElementNS(SVG, tag), attributes, children);
}

// Rows of cells: text, elements, or {text, class}. `words`: columns of words and not of numbers.
function table(header, rows, {caption, words} = {}) {
  const cell = (tag, value) => {
    const rich = value !== null && typeof value === 'object' && !(value instanceof Node);
    return el(tag, {class: rich ? value.class : null, scope: tag === 'th' ? 'col' : null},
              rich ? value.text : String(value instanceof Node ? '' : value ?? ''),
              value instanceof Node ? value : null);
  };
  return el('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': caption || 'table'},
            el('table', {class: words ? 'words' : null},
               caption ? el('caption', {}, caption) : null,
               header ? el('thead', {}, el('tr', {}, header.map(h => cell('th', h)))) : null,
               el('tbody', {}, rows.map(row => el('tr', {}, row.map(c => cell('td', c)))))));
}

// A number with `digits` that count, without an exponent where it would be longer than the number.
function show(value, digits = 4) {
  if (value === null || value === undefined) return '–';
  if (typeof value !== 'number') return String(value);
  if (!Number.isFinite(value)) return Number.isNaN(value) ? 'NaN' : value > 0 ? '∞' : '−∞';
  if (value === 0) return '0';
  const size = Math.abs(value);
  const text = size >= 1e-3 && size < 1e6 ? String(Number(value.toPrecision(digits)))
                                          : value.toExponential(Math.max(0, digits - 1));
  return text.replace('-', '−').replace('e−', 'e-').replace('e+', 'e');
}

// A file that is dropped would be opened in the place of the page. Calls `say` instead.
function refuseDrops(say) {
  for (const name of ['dragover', 'drop']) {
    document.addEventListener(name, event => {
      if (!event.dataTransfer?.types.includes('Files')) return;
      event.preventDefault();
      if (name === 'drop') say();
    });
  }
}
const DROPPED = 'A page is not told where a file lies that is dropped on it: start nacre view FILE to see a scene, a model or pictures. Maps are chosen among the files of the scene’s folder.';
