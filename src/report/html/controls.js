// SPDX-License-Identifier: Apache-2.0
// report/html/controls.js: what a viewer is set by, and what it says of a pixel.

const KEYS = [
  ['arrows', 'move'], ['Shift arrows', 'next pixel'], ['+ −', 'zoom'], ['0', 'all of the picture'],
  ['1 … 9', 'picture of that number'], ['f, Space', 'flip between picture and reference'],
  ['m', 'next view'], ['[ ]', 'move the comparison slider'], ['e E', 'brighter, darker by ¼ stop'],
  ['x', 'exposure 0'], ['l L', 'next, last layer'], ['t T', 'next, last tone operator'], ['?', 'this help'],
];

const HANDS = ['Drag to move, wheel or two fingers to zoom, double-click for all of the picture.'];

function showKeys() {
  let dialog = document.getElementById('keys');
  if (!dialog) {
    dialog = el('dialog', {id: 'keys', 'aria-label': 'Keys'}, el('h3', {}, 'Keys'),
                el('p', {}, 'While a viewer has the focus:'),
                el('table', {}, el('tbody', {}, KEYS.map(([key, what]) =>
                    el('tr', {}, el('td', {}, el('kbd', {}, key)), el('td', {}, what))))),
                HANDS.map(text => el('p', {}, text)),
                el('button', {onclick: () => dialog.close()}, 'Close'));
    document.body.append(dialog);
  }
  if (!dialog.open) dialog.showModal();
}

const field = (label, control, grow) =>
    el('label', {class: grow ? 'field grow' : 'field'}, el('span', {}, label), control);
const options = (select, list) => select.replaceChildren(...list.map(([value, text]) => el('option', {value}, text)));

class Controls {
  constructor(viewer) {
    this.viewer = viewer;
    const change = action => ({onchange: event => action(event.target.value)});
    this.set = el('select', change(value => viewer.open(Number(value))));
    this.image = el('select', change(value => viewer.choose(Number(value))));
    this.layer = el('select', change(value => { viewer.layer = value; viewer.checkQuantity(); viewer.update(); }));
    this.tone = el('select', change(value => { viewer.look.tone = value; viewer.update(); }));
    options(this.tone, Object.keys(TONES).map(name => [name, name.replace('_', ' ')]));
    this.quantity = el('select', change(value => { viewer.look.quantity = value; viewer.update(); }));
    this.exposure = el('input', {type: 'range', min: -10, max: 10, step: 0.05, 'aria-label': 'Exposure in stops',
                                 oninput: event => this.expose(Number(event.target.value))});
    this.stops = el('input', {type: 'number', min: -60, max: 60, step: 0.25, 'aria-label': 'Exposure in stops, as a number',
                              onchange: event => this.expose(Number(event.target.value) || 0)});
    this.modes = el('div', {class: 'row tight', role: 'group', 'aria-label': 'View'});
    this.split = el('input', {type: 'range', class: 'split', min: 0, max: 1, step: 0.005, 'aria-label': 'Comparison slider',
                              oninput: event => this.divide(Number(event.target.value))});
    this.splitRow = el('div', {hidden: true}, this.split);
    this.scale = el('output', {'aria-label': 'Zoom'});
    this.scaleFields = [el('div', {class: 'row'}, this.limit('low', 'Darkest'), this.limit('high', 'Brightest'))];
    this.element = el('div', {}, this.bar());
  }

  bar() {
    const {viewer} = this, zoom = f => () => viewer.panes[0].zoomBy(f, viewer.camera.x, viewer.camera.y);
    this.setField = field('Case', this.set);
    this.imageField = field('Picture', this.image);
    this.layerField = field('Layer', this.layer);
    this.quantityField = field('Error', this.quantity);
    this.modeField = el('div', {class: 'group'}, el('span', {}, 'View'), this.modes);
    return el('div', {class: 'bar'}, this.setField, this.modeField, this.imageField, this.layerField, this.quantityField,
              field('Tone operator', this.tone),
              el('div', {class: 'field grow'}, el('span', {}, 'Exposure, stops'),
                 el('div', {class: 'row'}, this.exposure, this.stops)),
              el('div', {class: 'group'}, el('span', {}, 'Zoom '), this.scale,
                 el('div', {class: 'row tight', role: 'group', 'aria-label': 'Zoom'},
                    el('button', {onclick: zoom(0.8), 'aria-label': 'Zoom out'}, '−'),
                    el('button', {onclick: zoom(1.25), 'aria-label': 'Zoom in'}, '+'),
                    el('button', {onclick: () => { viewer.camera.scale = 1; viewer.draw(); }, 'aria-label': 'One to one'}, '1:1'),
                    el('button', {onclick: () => { viewer.camera.fit(); viewer.draw(); }}, 'Fit'))),
              el('button', {onclick: showKeys, 'aria-label': 'Keys and help'}, '?'));
  }

  limit(end, label) {
    const input = el('input', {type: 'number', step: 'any', min: 1e-12, value: this.viewer.look[end], onchange: () => {
      const value = Number(input.value), {look} = this.viewer;
      const valid = value > 0 && (end === 'low' ? value < look.high : value > look.low);
      if (valid) look[end] = value;
      input.value = look[end];
      this.viewer.update();
    }});
    return field(label, input);
  }

  // A set of pictures was opened.
  open() {
    const {viewer} = this, {images} = viewer;
    options(this.set, viewer.section.sets.map((set, i) => [i, set.name]));
    this.setField.hidden = viewer.section.sets.length < 2;
    this.set.value = viewer.at;
    options(this.image, images.map((image, i) => [i, `${i + 1} ${image.name}`]));
    this.imageField.hidden = images.length < 2;
    const names = [...new Set(images.flatMap(image => image.layers.map(layer => layer.name)))];
    options(this.layer, names.map(name => [name, name || 'beauty']));
    this.layerField.hidden = names.length < 2;
    this.modes.replaceChildren(...viewer.modes().map(mode =>
        el('button', {'data-mode': mode, onclick: () => viewer.setMode(mode)}, MODES[mode])));
    this.modeField.hidden = viewer.modes().length < 2;
  }

  // The controls say what is shown.
  refresh() {
    const {viewer} = this, {look} = viewer;
    for (const button of this.modes.children) {
      button.setAttribute('aria-pressed', button.dataset.mode === viewer.mode);
    }
    this.image.value = viewer.mode === 'single' ? viewer.shown : viewer.a;
    this.layer.value = viewer.layer;
    this.tone.value = look.tone;
    this.exposure.value = look.exposure;
    this.stops.value = Number(look.exposure.toFixed(3));
    this.quantityField.hidden = viewer.mode !== 'error';
    const names = {flip: 'FLIP', hdr_flip: 'HDR-FLIP'};
    options(this.quantity, viewer.quantities().map(name => [name, names[name] || name]));
    this.quantity.value = look.quantity;
    this.splitRow.hidden = viewer.mode !== 'slider';
    this.split.value = viewer.split;
  }

  expose(stops) {
    this.viewer.look.exposure = Math.min(Math.max(stops, -60), 60);
    this.exposure.value = this.stops.value = Number(this.viewer.look.exposure.toFixed(3));
    this.viewer.update();
  }
  divide(part) {
    this.viewer.split = Math.min(Math.max(part, 0), 1);
    this.split.value = this.viewer.split;
    this.viewer.update();
  }
  next(name, step) {
    const select = this[name], count = select.options.length;
    select.selectedIndex = (select.selectedIndex + step + count) % count;
    select.dispatchEvent(new Event('change'));
  }
  zoomText() {
    const {viewer} = this, pane = viewer.panes[0];
    if (pane) this.scale.textContent = `${show(100 * viewer.camera.scaleIn(...pane.size()), 3)} %`;
  }

  showReading(x, y, rows) {
    const {viewer} = this, kinds = viewer.images[0].layers.find(l => l.name === viewer.layer);
    const names = kinds ? kinds.channels.map(c => c.name).join(' ') : '', several = rows.length > 1;
    const cell = viewer.cell() > 1 ? `, mean of ${viewer.cell()}×${viewer.cell()} pixels` : '';
    const body = rows.map(([name, values, codes, error]) => {
      const swatch = codes && codes.codes ? el('span', {class: 'swatch', 'aria-hidden': 'true'}) : null;
      if (swatch) swatch.style.background = `rgb(${codes.codes.join(' ')})`;
      return el('tr', {}, el('th', {scope: 'row'}, swatch, name),
                el('td', {'data-values': values.values ? values.values.join(' ') : null}, values.text),
                codes ? el('td', {'data-codes': codes.codes ? codes.codes.join(' ') : null}, codes.text) : null,
                error ? el('td', {}, error.text) : null);
    });
    viewer.readout.replaceChildren(el('table', {class: 'words', 'aria-live': 'polite'},
        el('thead', {}, el('tr', {}, el('th', {'data-x': x, 'data-y': y}, `x ${x}, y ${y}${cell}`), el('th', {}, names),
                           el('th', {}, rows.some(r => r[2] && r[2].codes) ? 'display code' : ''),
                           several ? el('th', {}, 'relative error') : null)),
        el('tbody', {}, body)));
  }
}
