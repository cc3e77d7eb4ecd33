// SPDX-License-Identifier: Apache-2.0
// view/html/live.js: the report's viewer with a picture that is rendered while one looks, and, to
// compare with, one that was kept.

KEYS.splice(0, 2, ['drag, arrows', 'go round the middle of the scene'], ['Shift drag, w a s d', 'move the camera sideways'],
            ['wheel, Page up, Page down', 'nearer, farther'], ['click, Shift arrows', 'a pixel, the next pixel']);
HANDS.splice(0, 1, 'Two fingers move the camera, sideways and nearer. A double click shows all of the picture.');
KEYS.push(['k', 'keep the picture as A'], ['/', 'find a parameter'], ['Ctrl Z, Ctrl Shift Z', 'undo, redo']);

class LiveViewer extends Viewer {
  constructor(act) {
    const canvas = el('canvas', {});
    const live = {name: 'now', x0: 0, y0: 0, width: 1280, height: 720, factor: 1, cell: 1, transfer: 'linear', canvas,
                  layers: [describeLayer('')], samples: layer => this.samples(layer)};
    super({sets: [{name: 'view', frame: {width: 1280, height: 720}, reference: 0, images: [live]}]}, 0);
    this.live = live;
    this.context = canvas.getContext('2d', {alpha: false});
    this.head = null;
    this.marked = false;  // a pixel has been asked for
    this.kept = new Map();  // samples of the picture at rest, by layer
    this.act = act;
    this.hand = new Hand(this, act);
    this.pending = [];  // own changes that no picture shows yet
    this.metrics = el('div', {class: 'metrics', 'aria-live': 'polite', hidden: true});
    this.readout.before(this.metrics);
    this.readout.append(el('p', {class: 'soft'}, 'Click the picture: where does this value come from? Drag it: the camera goes round. “?” lists the keys.'));
    new ResizeObserver(() => this.hand.placeLamps()).observe(this.stage);
  }

  // A picture came, what is new of it. It is drawn at once: the screen takes it when it takes the next
  // one. The finest smoothing takes milliseconds, which a hand that goes on does not have.
  frame(head, parts) {
    const {live} = this, {canvas} = live, frame = this.set.frame;
    if (canvas.width !== head.width || canvas.height !== head.height) {
      canvas.width = head.width;
      canvas.height = head.height;
    }
    for (const {x, y, image} of parts) this.context.putImageData(image, x, y);
    const reframed = frame.width !== head.frameWidth || frame.height !== head.frameHeight;
    live.cell = head.frameWidth / head.width;
    this.head = head;
    this.smoothing = 'low';
    clearTimeout(this.smooth);
    if (head.done) this.smooth = setTimeout(() => { this.smoothing = 'high'; this.draw(); }, 250);
    this.kept.clear();
    if (reframed) {
      Object.assign(frame, {width: head.frameWidth, height: head.frameHeight});
      this.camera = new Camera(frame);
      this.mark = {x: frame.width >> 1, y: frame.height >> 1};
    }
    if (head.done) {
      live.width = head.width;
      live.height = head.height;
      live.factor = Math.max(1, Math.round(live.cell));
    }
    if (reframed || !this.panes.length) this.update();
    for (const pane of this.panes) {
      for (const picture of pane.content?.pictures || []) if (picture.canvas === canvas) picture.cell = live.cell;
    }
    if (this.panes.length) this.drawPanes();
    while (this.pending.length && this.pending[0].revision <= head.revision) this.element.dataset.serial = this.pending.shift().serial;
    this.element.dataset.revision = head.revision;
    this.element.dataset.done = head.done;
    this.metrics.classList.toggle('old', this.measured !== head.revision);
    if (head.done) this.rested();
  }

  // Nothing is refined any more: what needs the samples themselves is made of them.
  rested() {
    this.cache.clear();
    if (this.mode === 'error' || this.live.layers.find(l => l.name === this.layer)?.kind !== 'color') this.update();
    else if (this.reads || this.images.length > 1) this.read();
  }

  async samples(layer) {
    const {head} = this;
    if (!head || !head.done) return null;
    if (!this.kept.has(layer.name)) this.kept.set(layer.name, this.act.samples(layer.name));
    const answer = await this.kept.get(layer.name);
    return answer && answer.head.width === this.live.width && answer.head.height === this.live.height ? answer.planes : null;
  }

  paint(index) {
    const image = this.images[index], layer = image.layers.find(l => l.name === this.layer);
    if (image === this.live && layer && layer.kind !== 'color' && this.head?.done) {
      return this.keep(`live ${this.layer} ${this.head.revision}`, async () => {
        const loaded = await loadLayer(image, this.layer);
        return loaded ? paintLayer(image, loaded, this.look) : image.canvas;
      });
    }
    return super.paint(index);
  }

  update() {
    this.tell();
    const done = super.update();
    done.then(() => this.hand?.placeLamps());
    return done;
  }
  // The server shows the picture as the controls say.
  tell() {
    const {tone, exposure} = this.look, said = JSON.stringify([tone, exposure, this.layer]);
    if (!this.act || said === this.said) return;
    this.said = said;
    this.act.look(tone, exposure, this.layer);
  }

  draw() {
    super.draw();
    this.hand?.placeLamps();
  }

  inspect(x, y) {
    this.reads = this.marked = true;
    super.inspect(x, y);
    this.act.explain(this.mark.x, this.mark.y);
  }
  read() {
    return this.head?.done && (this.reads || this.images.length > 1) ? super.read() : undefined;
  }

  // As large as the window has room for, controls and read-out beside it.
  highest() {
    const narrow = window.innerWidth <= 832;
    return narrow ? 0.38 * window.innerHeight : Math.max(240, window.innerHeight - 290);
  }

  layersAre(names) {
    this.live.layers = ['', ...names.filter(name => name && name !== 'beauty')].map(describeLayer);
    if (!this.live.layers.some(l => l.name === this.layer)) this.layer = '';
    this.controls.open();
    this.controls.refresh();
  }

  actionOf(event) {
    return this.hand?.action(event) || super.actionOf(event);
  }

  // How far B is from A, by the server's measure.
  showMetrics(metrics, revision) {
    this.measured = revision;
    this.metrics.classList.remove('old');
    if (!metrics) { this.metrics.textContent = this.images.length > 1 ? 'A and B have no figures: their sizes differ, or the server is another' : ''; return; }
    const {rmse, rel_mse: relative, psnr_db: psnr, ssim, flip, max_abs: most, max_abs_at: [x, y]} = metrics;
    const figures = [['RMSE', rmse], ['relMSE', relative], ['PSNR', psnr === null ? '∞' : `${show(psnr, 4)} dB`], ['SSIM', ssim], ['FLIP', flip],
                     [`largest difference, at ${x}, ${y}`, most]];
    this.metrics.replaceChildren('B against A: ', ...figures.map(([name, value]) => el('span', {'data-metric': name.split(' ')[0]}, `${name} `, el('b', {}, typeof value === 'number' ? show(value, 4) : value ?? '–'))));
  }

  // The present picture stays as A, to compare what follows with.
  async keepA(scene) {
    const {live, set} = this, layer = live.layers[0], planes = await this.samples(layer);
    if (!planes) return false;
    const kept = {name: 'A', x0: 0, y0: 0, width: live.width, height: live.height, factor: live.factor, transfer: 'linear',
                  layers: [layer], samples: async () => planes, scene};
    live.name = 'B, now';
    set.images = [live, kept];
    set.reference = 1;
    this.controls.open();
    this.a = 0;
    this.shown = 0;
    this.mode = 'slider';
    this.metrics.hidden = false;
    this.metrics.textContent = 'B against A: equal so far';
    this.update();
    return true;
  }
  dropA() {
    const {live, set} = this;
    live.name = 'now';
    set.images = [live];
    set.reference = 0;
    this.mode = 'single';
    this.metrics.hidden = true;
    this.a = this.shown = 0;
    this.controls.open();
    this.update();
  }
}
