// SPDX-License-Identifier: Apache-2.0
// report/html/viewer.js: one or several pictures of a set, under one camera and one look.

const MODES = {single: 'Single', slider: 'Slider', side: 'Side by side', error: 'Error map'};

class Viewer {
  constructor(section, number) {
    this.section = section;
    this.number = number;
    this.look = {tone: REPORT.tone, exposure: REPORT.exposure, quantity: 'relative', low: 1e-4, high: 1};
    this.cache = new Map();
    this.split = 0.5;
    this.panes = [];
    this.stage = el('div', {class: 'stage'});
    this.readout = el('div', {class: 'read'});
    this.legend = el('div', {class: 'legend'});
    this.controls = new Controls(this);
    this.element = el('div', {class: 'viewer', id: `viewer${number}`}, this.controls.element, this.stage,
                      this.controls.splitRow, this.legend, this.readout);
    this.element.addEventListener('keydown', event => this.key(event));
    new ResizeObserver(() => this.draw()).observe(this.stage);
    this.open(0);
  }

  get set() { return this.section.sets[this.at]; }
  get images() { return this.set.images; }
  get reference() { return this.set.reference; }

  // Shows a set: its first picture that is no reference, against the reference.
  open(at) {
    const before = this.mode;
    this.at = at;
    this.cache.clear();
    this.camera = new Camera(this.set.frame);
    this.a = this.images.findIndex((_, i) => i !== this.reference);
    if (this.a < 0) this.a = 0;
    this.layer = this.images[0].layers[0].name;
    this.mark = {x: this.set.frame.width >> 1, y: this.set.frame.height >> 1};
    this.mode = before && this.modes().includes(before) ? before : 'single';
    this.shown = this.a;
    this.controls.open();
    this.update();
  }

  modes() { return this.images.length > 1 ? Object.keys(MODES) : ['single']; }
  quantities() {
    const maps = this.maps().map(m => m.kind);
    return [...Object.keys(QUANTITIES), ...maps];
  }
  maps() {
    const found = (this.set.comparisons || []).find(c => c.image === this.a);
    return found ? found.maps.filter(m => m.layer === this.layer) : [];
  }
  cell() { return this.images[0].factor; }

  // The pictures of the present mode, by pane: [{label, second, pictures: [promise of canvas]}...]
  async pictures() {
    const part = async (index, from = 0, to = 1) => this.place(this.images[index], await this.paint(index), from, to);
    const several = this.images.length > 1;  // and a number that is also a key
    const name = index => (several ? `${index + 1} ` : '') + this.images[index].name +
                          (index === this.reference && this.images.length > 1 ? ' (reference)' : '');
    if (this.mode === 'side') {
      return Promise.all(this.images.map(async (_, i) => ({label: name(i), pictures: [await part(i)]})));
    }
    if (this.mode === 'slider') {
      return [{label: `◀ ${name(this.a)}`, second: `${name(this.reference)} ▶`, divider: this.split,
               pictures: [await part(this.a, 0, this.split), await part(this.reference, this.split, 1)]}];
    }
    if (this.mode === 'error') {
      return [{label: `error of ${name(this.a)}`, pictures: [await this.error()]}];
    }
    return [{label: name(this.shown), pictures: [await part(this.shown)]}];
  }

  place(image, canvas, from, to) {
    return {canvas, x0: image.x0, y0: image.y0, cell: image.cell ?? image.factor, from, to};
  }

  // A few pictures are kept: sliders go back and forth.
  async keep(key, make) {
    if (!this.cache.has(key)) {
      if (this.cache.size > 8) this.cache.delete(this.cache.keys().next().value);
      this.cache.set(key, await make());
    }
    return this.cache.get(key);
  }

  paint(index) {
    const image = this.images[index], {tone, exposure} = this.look;
    if (image.canvas) return image.canvas;  // it is painted elsewhere
    return this.keep(`${index} ${this.layer} ${tone} ${exposure}`, async () => {
      const layer = await loadLayer(image, this.layer);
      return layer ? paintLayer(image, layer, this.look) : blank(image).canvas;
    });
  }

  async error() {
    const image = this.images[this.a], reference = this.images[this.reference];
    const {quantity, low, high} = this.look;
    const map = this.maps().find(m => m.kind === quantity);
    if (map) return this.place({...map, factor: this.cell()}, await this.keep(`map ${this.a} ${this.layer} ${quantity}`,
      async () => paintMap(map, await plane(map))), 0, 1);
    const canvas = await this.keep(`error ${this.a} ${this.layer} ${quantity} ${low} ${high}`, async () => {
      const [got, expected] = await Promise.all([loadLayer(image, this.layer), loadLayer(reference, this.layer)]);
      return got && expected ? paintError(image, got, reference, expected, this.look) : blank(image).canvas;
    });
    return this.place(image, canvas, 0, 1);
  }

  // Anything but the camera changed.
  async update() {
    const asked = this.asked = {};
    const panes = await this.pictures();
    if (asked !== this.asked) return;  // something newer is on its way
    while (this.panes.length < panes.length) this.panes.push(new Pane(this));
    this.stage.classList.toggle('side', this.mode === 'side');
    const elements = panes.map((pane, i) => {
      const {element, label, second} = this.panes[i];
      this.panes[i].content = pane;
      label.textContent = pane.label;
      second.textContent = pane.second || '';
      second.hidden = !pane.second;
      element.setAttribute('aria-label', `${pane.label}. Arrows move, plus and minus zoom, question mark lists the keys`);
      return element;
    });
    // Panes that stay are left where they are: one of them may have the focus.
    while (this.stage.children.length > elements.length) this.stage.lastChild.remove();
    this.stage.append(...elements.slice(this.stage.children.length));
    this.fitPanes();
    this.controls.refresh();
    this.drawLegend();
    this.draw();
    this.read();
    this.element.dataset.ready = String(Number(this.element.dataset.ready || 0) + 1);
  }

  // Panes as high as the frame asks, but no higher than most of the window.
  fitPanes() {
    const {width, height} = this.set.frame, limit = this.highest();
    for (const {element} of this.panes) {
      const wide = element.clientWidth || this.stage.clientWidth || 300;
      const high = `${Math.round(Math.min(limit, wide * height / width))}px`;
      if (element.style.height !== high) element.style.height = high;
    }
  }
  highest() { return Math.max(240, window.innerHeight * 0.72); }

  draw() {
    if (this.drawing) return;
    this.drawing = requestAnimationFrame(() => {
      this.drawing = 0;
      this.fitPanes();
      this.drawPanes();
    });
  }

  drawPanes() {
    const cell = this.cell(), mark = {x: this.mark.x - this.mark.x % cell, y: this.mark.y - this.mark.y % cell, cell,
                  shown: this.marked};
    this.panes.forEach((pane, i) => {
      if (this.stage.contains(pane.element)) pane.draw(pane.content.pictures, mark, pane.content.divider ?? null);
    });
    this.controls.zoomText();
  }

  drawLegend() {
    const on = this.mode === 'error', {quantity, low, high} = this.look;
    this.legend.hidden = !on;
    if (!on) return;
    const embedded = quantity in QUANTITIES ? ' (from the samples in this page)' : '';
    this.legend.replaceChildren(
        el('div', {}, errorLegend(quantity, low, high),
           el('div', {class: 'soft'}, `${QUANTITIES[quantity] || 'what is seen: 0 nothing, 1 all'}${embedded}; ` +
              (quantity === 'signed' ? 'grey: equal' : quantity in QUANTITIES ? 'black: equal' : '') +
              (quantity in QUANTITIES ? ', magenta: not finite in one only' : ''))),
        ...(quantity in QUANTITIES ? this.controls.scaleFields : []));
  }

  inspect(x, y) {
    const {width, height} = this.set.frame;
    this.mark = {x: Math.min(Math.max(Math.floor(x), 0), width - 1),
                 y: Math.min(Math.max(Math.floor(y), 0), height - 1)};
    this.draw();
    this.read();
  }

  // The samples of every picture at the mark.
  async read() {
    const {x, y} = this.mark, cell = this.cell(), rows = [], asked = this.reading = {};
    const u = Math.floor(x / cell), v = Math.floor(y / cell);
    const reference = this.images.length > 1 ? await loadLayer(this.images[this.reference], this.layer) : null;
    for (const [index, image] of this.images.entries()) {
      const layer = await loadLayer(image, this.layer), i = cellIndex(image, u, v);
      if (!layer || i < 0) { rows.push([image.name, {text: 'no pixel here'}]); continue; }
      const values = layer.planes.map(p => p[i]), codes = [0, 0, 0];
      const color = layer.kind === 'color' && values.length >= 3;
      if (color && image.transfer === 'display') values.forEach((value, c) => { codes[c] = Math.round(255 * value); });
      else if (color) displayCodes(TONES[this.look.tone], 2 ** this.look.exposure, ...values, codes, 0);
      const row = [image.name, {text: values.map(value => show(value, 7)).join('  '), values},
                   color ? {text: codes.join(' '), codes} : {text: ''}];
      if (reference && index !== this.reference) {
        const r = cellIndex(this.images[this.reference], u, v);
        row.push({text: r < 0 ? '–' : show(pixelError(layer, i, reference, r, 'relative'), 3)});
      } else if (reference) row.push({text: ''});
      rows.push(row);
    }
    if (asked === this.reading) this.controls.showReading(x, y, rows);
  }

  key(event) {
    if (event.target.matches('input, select') && !['?'].includes(event.key)) return;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.matches('button') && [' ', 'Enter'].includes(event.key)) return;
    const action = this.actionOf(event);
    if (!action) return;
    event.preventDefault();
    action();
  }

  actionOf({key, shiftKey}) {
    const [w, h] = this.panes.length ? this.panes[0].size() : [1, 1], scale = this.camera.scaleIn(w, h);
    const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
    if (key in arrows) {
      const [dx, dy] = arrows[key], cell = this.cell();
      return shiftKey ? () => this.inspect(this.mark.x + dx * cell, this.mark.y + dy * cell)
                      : () => { this.camera.pan(40 * dx / scale, 40 * dy / scale); this.draw(); };
    }
    const zoom = factor => () => { this.panes[0].zoomBy(factor, this.camera.x, this.camera.y); };
    const digit = Number(key);
    if (key >= '1' && key <= '9' && digit <= this.images.length) {
      return () => this.choose(digit - 1);
    }
    const {controls} = this;
    return {
      '+': zoom(1.25), '=': zoom(1.25), '-': zoom(0.8), _: zoom(0.8),
      0: () => { this.camera.fit(); this.draw(); },
      e: () => controls.expose(this.look.exposure + 0.25), E: () => controls.expose(this.look.exposure - 0.25),
      x: () => controls.expose(0),
      '[': () => controls.divide(this.split - 0.02), ']': () => controls.divide(this.split + 0.02),
      l: () => controls.next('layer', 1), L: () => controls.next('layer', -1),
      t: () => controls.next('tone', 1), T: () => controls.next('tone', -1),
      m: () => this.setMode(this.modes()[(this.modes().indexOf(this.mode) + 1) % this.modes().length]),
      f: () => this.flip(), ' ': () => this.flip(), '?': () => showKeys(),
    }[key];
  }

  setMode(mode) { this.mode = mode; this.update(); }
  // A picture by number: the one shown, and the one compared if it is not the reference.
  choose(index) {
    this.shown = index;
    if (index !== this.reference || this.images.length === 1) this.a = index;
    if (this.mode === 'side') this.mode = 'single';
    this.checkQuantity();
    this.update();
  }
  flip() {
    if (this.images.length < 2) return;
    this.mode = 'single';
    this.shown = this.shown === this.reference ? this.a : this.reference;
    this.update();
  }
  checkQuantity() {
    if (!this.quantities().includes(this.look.quantity)) this.look.quantity = 'relative';
  }
}
