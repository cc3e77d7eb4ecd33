// SPDX-License-Identifier: Apache-2.0
// report/html/panes.js: canvases that look at the same part of the frame.

// What is seen: the frame's point at the middle of each pane, and how many CSS pixels a pixel takes.
class Camera {
  constructor(frame) {
    this.frame = frame;
    this.fit();
  }
  fitting(width, height) { return Math.min(width / this.frame.width, height / this.frame.height); }
  scaleIn(width, height) { return this.scale || this.fitting(width, height); }
  pan(dx, dy) {
    this.x = Math.min(Math.max(this.x + dx, 0), this.frame.width);
    this.y = Math.min(Math.max(this.y + dy, 0), this.frame.height);
  }
  fit() {
    this.scale = 0;  // 0: as large as fits
    this.x = this.frame.width / 2;
    this.y = this.frame.height / 2;
  }
  // About a point of the frame, which stays where it is.
  zoom(scale, x, y, width, height) {
    const old = this.scaleIn(width, height), fit = this.fitting(width, height);
    this.scale = Math.min(Math.max(scale, fit / 4), 64);
    const kept = old / this.scale;
    this.x = x + (this.x - x) * kept;
    this.y = y + (this.y - y) * kept;
  }
}

// What a drag does is the pane's own, to move and zoom, unless the viewer has a hand for it: the live
// view's, which moves what the picture shows (view/html/hand.js).
class Pane {
  constructor(viewer) {
    this.viewer = viewer;
    this.canvas = el('canvas', {});
    this.label = el('span', {class: 'name'});
    this.second = el('span', {class: 'name right', hidden: true});
    this.element = el('div', {class: 'pane', tabindex: 0, role: 'application'}, this.canvas, this.label,
                      this.second);
    this.fingers = new Map();
    this.listen();
  }

  size() { return [this.canvas.clientWidth || 1, this.canvas.clientHeight || 1]; }

  // From a point of the canvas to the frame.
  frameAt(event) {
    const box = this.canvas.getBoundingClientRect(), [w, h] = this.size();
    const camera = this.viewer.camera, scale = camera.scaleIn(w, h);
    return [camera.x + (event.clientX - box.left - w / 2) / scale,
            camera.y + (event.clientY - box.top - h / 2) / scale];
  }

  listen() {
    const {canvas, viewer, fingers} = this;
    canvas.addEventListener('wheel', event => {
      event.preventDefault();
      if (viewer.hand) return viewer.hand.wheel(event);
      this.zoomBy(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0016)), ...this.frameAt(event));
    }, {passive: false});
    canvas.addEventListener('pointerdown', event => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, event);
      if (viewer.hand) return viewer.hand.down(event, this);
      viewer.inspect(...this.frameAt(event));
    });
    canvas.addEventListener('pointermove', event => this.moved(event));
    for (const end of ['pointerup', 'pointercancel']) {
      canvas.addEventListener(end, event => {
        fingers.delete(event.pointerId);
        if (viewer.hand) viewer.hand.up(event, this);
      });
    }
    canvas.addEventListener('contextmenu', event => { if (viewer.hand) event.preventDefault(); });
    canvas.addEventListener('dblclick', () => { viewer.camera.fit(); viewer.draw(); });
  }

  zoomBy(factor, x, y) {
    const camera = this.viewer.camera, [w, h] = this.size();
    camera.zoom(camera.scaleIn(w, h) * factor, x, y, w, h);
    this.viewer.draw();
  }

  moved(event) {
    const last = this.fingers.get(event.pointerId);
    if (this.viewer.hand) {
      if (last) this.viewer.hand.drag(event, last, [...this.fingers.values()].find(f => f.pointerId !== event.pointerId), this);
      if (last) this.fingers.set(event.pointerId, event);
      return;
    }
    if (!last) {
      if (event.pointerType === 'mouse') this.viewer.inspect(...this.frameAt(event));
      return;
    }
    const [w, h] = this.size(), scale = this.viewer.camera.scaleIn(w, h);
    const other = [...this.fingers.values()].find(f => f.pointerId !== event.pointerId);
    if (other) {
      const span = e => Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY) || 1;
      this.zoomBy(span(event) / span(last), ...this.frameAt(other));
    } else {
      this.viewer.camera.pan((last.clientX - event.clientX) / scale, (last.clientY - event.clientY) / scale);
      this.viewer.draw();
    }
    this.fingers.set(event.pointerId, event);
  }

  // `pictures`: [{canvas, x0, y0, cell, from, to}], each shown between two parts of the width.
  draw(pictures, mark, divider) {
    const [w, h] = this.size(), ratio = window.devicePixelRatio || 1, {canvas} = this;
    if (canvas.width !== Math.round(w * ratio) || canvas.height !== Math.round(h * ratio)) {
      canvas.width = Math.round(w * ratio);
      canvas.height = Math.round(h * ratio);
    }
    const context = canvas.getContext('2d'), camera = this.viewer.camera, scale = camera.scaleIn(w, h);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, w, h);
    for (const picture of pictures) {
      context.save();
      context.beginPath();
      context.rect(picture.from * w, 0, (picture.to - picture.from) * w, h);
      context.clip();
      context.translate(w / 2 - camera.x * scale, h / 2 - camera.y * scale);
      context.scale(scale * picture.cell, scale * picture.cell);
      // Pixels are seen as such once they are large enough to be told apart.
      context.imageSmoothingEnabled = scale * picture.cell * ratio <= 3 || (picture.cell > 1 && this.viewer.smoothing === 'low');
      context.imageSmoothingQuality = this.viewer.smoothing || 'high';
      context.drawImage(picture.canvas, picture.x0, picture.y0);
      context.restore();
    }
    if (divider !== null) {
      context.fillStyle = 'rgb(0 0 0 / .6)';
      context.fillRect(divider * w - 1.5, 0, 3, h);
      context.fillStyle = '#fff';
      context.fillRect(divider * w - 0.5, 0, 1, h);
    }
    if (mark && (mark.shown ?? scale >= 2)) {
      const side = Math.max(scale * mark.cell, 6), middle = mark.cell / 2;
      const x = w / 2 + (mark.x + middle - camera.x) * scale - side / 2, y = h / 2 + (mark.y + middle - camera.y) * scale - side / 2;
      context.lineWidth = 1;
      context.strokeStyle = '#000';
      context.strokeRect(x - 1.5, y - 1.5, side + 3, side + 3);
      context.strokeStyle = '#fff';
      context.strokeRect(x - 0.5, y - 0.5, side + 1, side + 1);
    }
  }
}
