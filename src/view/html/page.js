// SPDX-License-Identifier: Apache-2.0
// view/html/page.js: the page: picture, panel, and what goes between them and the server.

class View {
  constructor() {
    this.unanswered = new Map();  // the newest own change {value, gesture, serial} of which the server has said nothing yet, by pointer
    this.scene = {};
    const act = this.act = {
      set: (pointer, value, gesture) => this.set(pointer, value, gesture),
      look: (tone, exposure, layer) => this.connection?.send({look: tone, exposure, layer}),
      samples: layer => this.connection.samples(layer),
      explain: (x, y) => this.connection.send({explain: x, y}),
      convert: (pointer, model, gesture = newGesture()) => this.connection.send({convert: pointer, model, gesture}),
      take: what => this.connection.send({take: what}),
    };
    this.panel = new Panel(act);
    this.viewer = new LiveViewer(act);
    this.explanation = new Explanation();
    // What is read out says when the picture is complete, and not every picture on the way.
    this.status = el('span', {class: 'status'}, 'connecting…');
    this.spoken = el('span', {class: 'unseen', role: 'status'});
    this.banner = el('div', {class: 'banner', role: 'alert', hidden: true});
    this.lost = el('div', {class: 'banner', role: 'alert', hidden: true},
                   'The server has gone, or cannot be reached. What is changed now would be lost, so the controls wait until it is back, which is tried every second. The scene, as it is, and the picture can be taken away.');
    this.offer = el('div', {class: 'banner offer', role: 'status', hidden: true});
    this.name = el('h1', {}, 'nacre view');
    const step = (what, label, text) => el('button', {'aria-label': label, title: label, disabled: true, onclick: () => this.history(what)}, text);
    this.steps = {undo: step('undo', 'Undo', '↶'), redo: step('redo', 'Redo', '↷'), reset: step('reset', 'Reset everything', 'Reset')};
    this.keep = el('button', {onclick: () => this.compare(), title: 'Keep this picture as A, and compare what follows with it'}, 'Keep as A');
    this.both = el('button', {onclick: () => this.compareModels(), title: 'Keep this picture as A, and go on with the nearest materials of the other family, as nacre convert finds them'}, 'Phong | PBR');
    this.drop = el('button', {hidden: true, onclick: () => this.dropA()}, 'Drop A');
    document.body.append(el('main', {class: 'app'},
        el('section', {class: 'picture', 'aria-label': 'Picture'},
           el('div', {class: 'top'}, this.name, el('div', {class: 'row tight'}, Object.values(this.steps)), el('div', {class: 'row'}, this.keep, this.both, this.drop, el('button', {onclick: () => takeAway(this)}, 'Take away')), this.status, this.spoken),
           this.banner, this.lost, this.offer, this.viewer.element, this.explanation.element),
        this.panel.element));
    document.addEventListener('keydown', event => this.key(event));
    refuseDrops(() => this.showBanner(DROPPED));
    this.connection = new Connection({text: message => this.received(message), frame: (head, parts) => this.frame(head, parts),
                                      file: (extension, bytes) => {
                                        save(`${baseName(this)}.${extension}`, new Blob([bytes]));
                                        this.status.textContent = this.spoken.textContent = 'the file is made';
                                      },
                                      state: open => this.connected(open)});
  }

  connected(open) {
    this.viewer.said = undefined;
    this.open = open;
    this.lost.hidden = open;
    // What is read out and looked at stays in hand.
    for (const element of [this.panel.element, this.viewer.stage, this.offer, this.keep, this.both, this.drop, ...Object.values(this.steps)]) element.inert = !open;
    if (open) {
      this.viewer.pending = [];
      // What this page shows is kept when the server comes back.
      this.viewer.tell();
    } else {
      this.status.textContent = this.spoken.textContent = 'no connection: trying again…';
      this.viewer.showMetrics(null);
    }
  }

  set(pointer, value, gesture) {
    const serial = this.connection.set(pointer, value, gesture);
    this.unanswered.set(pointer, {value, gesture, serial});
    // A light's handle and its fields, the camera and its fields: the server's answer moves the others.
  }
  // Changes that went out when the server was already gone.
  setAgain() {
    for (const [pointer, {value, gesture}] of [...this.unanswered]) this.set(pointer, value, gesture);
  }
  history(what) { this.connection.send({history: what}); }

  received(message) {
    if ('scene' in message) this.sceneIs(message);
    else if ('changed' in message) this.changed(message);
    else if ('fault' in message) this.fault(message);
    else if ('explained' in message) this.explanation.show(message.explained, this.viewer.look, message.revision);
    else if ('kept' in message) { if (!message.kept && this.viewer.images.length > 1) this.viewer.showMetrics(null); }
    else if ('metrics' in message) this.viewer.showMetrics(message.metrics, message.revision);
    else if ('not_kept' in message) this.panel.fault(message.convert, `What is not the same: ${message.not_kept.join('; ')}`, true);
    if ('banner' in message) this.showBanner(message.banner);
    if ('undo' in message) {
      this.steps.undo.disabled = !message.undo;
      this.steps.redo.disabled = !message.redo;
      this.steps.reset.disabled = !message.reset;
    }
  }

  sceneIs({scene, original, whole, camera, name, file, given, layers, files, client, generator, offered}) {
    if (generator !== REPORT.generator) return location.reload();  // another nacre serves another page
    Object.assign(this, {original, whole, file, given});
    this.showOffer(offered);
    this.scene = scene;
    this.name.textContent = name;
    this.panel.files = files;
    this.panel.ofModel = isModel(file);
    this.panel.build(scene, camera);
    this.viewer.layersAre(layers);
    this.viewer.hand.show(camera, scene.lights);
    if (!client) return;
    this.client = client;
    this.setAgain();
  }

  // Edits of an earlier server, which nobody has taken away before it ended.
  showOffer(offered) {
    this.offer.hidden = !offered;
    if (!offered) return;
    const choose = (what, text, title) => el('button', {title, onclick: () => this.connection.send({offered: what})}, text);
    this.offer.replaceChildren(`Edits of ${new Date(1000 * offered.time).toLocaleString()} (${offered.edits}) were kept when the server ended. `,
                               choose('restore', 'Restore', 'Makes these edits again, as one step that can be undone'), ' ', choose('discard', 'Discard', 'Forgets them'));
  }

  changed({changed, value, revision, client, serial, camera, lights, original_lights: originalLights}) {
    const mine = client === this.client;
    if (mine) {
      this.viewer.pending.push({serial, revision});
      for (const [pointer, waits] of this.unanswered) if (waits.serial <= serial) this.unanswered.delete(pointer);
    }
    this.scene = this.panel.scene = putAt(this.scene, changed, value);
    if (lights) {  // of a model: they may follow the camera
      this.scene.lights = lights;
      this.original.lights = originalLights;
      if (changed.startsWith('/camera')) this.panel.show('/lights');
    }
    // A newer own value is on its way: this one would move the control back under the hand.
    if (mine && this.unanswered.has(changed)) return;
    this.panel.changed(changed, value, camera);
    this.viewer.hand.show(camera, this.scene.lights);
    this.showBanner('');
  }

  fault({fault, faults}) {
    this.unanswered.delete(fault);
    const text = faults.map(({what, hint}) => hint ? `${what}: ${hint}` : what).join('\n');
    if (!this.panel.fault(fault, text)) {
      this.showBanner(faults.map(({where, what, hint}) => `${where ? where + ': ' : ''}${what}${hint ? '\n  ' + hint : ''}`).join('\n'));
    }
  }
  showBanner(text) {
    this.banner.textContent = text;
    this.banner.hidden = !text;
  }

  frame(head, parts) {
    this.viewer.frame(head, parts);
    const size = head.width === head.frameWidth ? `${head.width}×${head.height}` : `${head.width}×${head.height} of ${head.frameWidth}×${head.frameHeight}`;
    const ms = head.renderUs / 1000, time = ms < 1000 ? `${show(ms, 3)} ms` : `${show(ms / 1000, 3)} s`;
    this.status.textContent = `${head.samples} of ${head.ofSamples} samples · ${size} · ${time}`;
    // What is explained is what is seen.
    if (this.explanation.outdated(head.revision) && head.done) this.act.explain(this.viewer.mark.x, this.viewer.mark.y);
    this.keep.disabled = this.both.disabled = !head.done;
    if (head.done) this.spoken.textContent = `Picture complete, ${head.ofSamples} samples`;
  }

  async compare() {
    if (!await this.viewer.keepA(structuredClone(this.scene))) return false;
    this.connection.send({keep: true});
    this.drop.hidden = false;
    return true;
  }
  dropA() {
    this.connection.send({keep: false});
    this.viewer.dropA();
    this.drop.hidden = true;
  }

  // All materials of the first one's family become those of the other: one step of the history.
  async compareModels() {
    const all = convertible(this.scene), [first] = all, gesture = newGesture();
    if (!first) return this.showBanner('No material here is a Phong or a physically based one that converts');
    if (!await this.compare()) return;
    for (const {pointer, phong, other} of all) if (phong === first.phong) this.act.convert(pointer, other, gesture);
  }

  key(event) {
    const typing = event.target.matches('input:not([type="range"]):not([type="checkbox"]), select');
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 'z' && !typing) {
      event.preventDefault();
      this.history(event.shiftKey ? 'redo' : 'undo');
    }
    if (typing || event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    if (event.key === '/') { event.preventDefault(); this.panel.find.focus(); }
    if (event.key === 'k') this.compare();
    if (event.key === '?') showKeys();
  }
}

const VIEW = new View();
