// SPDX-License-Identifier: Apache-2.0
// view/html/hand.js: what a hand does to the picture: it moves the camera, by mouse, fingers and keys,
// and lights by their handles.

const add = (a, b, s = 1) => a.map((v, i) => v + s * b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => a.map(v => v / (Math.hypot(...a) || 1));
// About a unit axis, right-handed (Rodrigues).
function rotate(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle), along = dot(axis, v) * (1 - c), turned = cross(axis, v);
  return v.map((x, i) => c * x + s * turned[i] + along * axis[i]);
}

// A scene's camera as it sees: unit vectors, and half of the picture's height at distance 1.
function sight(camera) {
  const forward = unit(add(camera.look_at, camera.position, -1));
  const right = unit(cross(forward, camera.up)), up = cross(right, forward);
  const flat = camera.type === 'orthographic';
  return {forward, right, up, flat, half: flat ? camera.height / 2 : Math.tan(camera.fov_y_deg * Math.PI / 360)};
}
// Where a point is in the frame, in pixels, and how many world units a pixel is there; or null behind.
function project(camera, frame, point) {
  const {forward, right, up, flat, half} = sight(camera), d = add(point, camera.position, -1);
  const depth = dot(d, forward), size = flat ? half : half * depth;
  if (!(depth > 0) && !flat) return null;
  const pixel = 2 * size / frame.height;
  return {x: frame.width / 2 + dot(d, right) / pixel, y: frame.height / 2 - dot(d, up) / pixel, pixel};
}

// Where a light's handle is, and by which member it moves: {member, at}. A directional light has its
// handle where it comes from, on a sphere around what the camera looks at.
function handleOf(light, camera) {
  const member = ['position', 'center'].find(name => Array.isArray(light?.[name]));
  if (member) return {member, at: light[member]};
  if (light?.type !== 'directional') return null;
  const reach = camera.type === 'orthographic' ? camera.height : Math.hypot(...add(camera.position, camera.look_at, -1)) * sight(camera).half * 2;
  return {member: 'direction_of_travel', at: add(camera.look_at, unit(light.direction_of_travel), -0.35 * reach)};
}

class Hand {
  // `act`: {set(pointer, value, gesture)}
  constructor(viewer, act) {
    this.viewer = viewer;
    this.act = act;
    this.camera = null;
    this.lights = {};
    this.lamps = new Map();
    this.gesture = newGesture();
  }

  // The scene says so, unless the hand has moved on since.
  show(camera, lights) {
    this.camera = camera;
    this.lights = lights || {};
    this.placeLamps();
  }

  move(camera) {
    this.camera = camera;
    this.act.set('/camera', camera, this.gesture);
    this.placeLamps();
  }

  // ---- The camera ----

  orbit(dx, dy) {
    const {camera} = this, {right} = sight(camera), up = unit(camera.up);
    let arm = rotate(add(camera.position, camera.look_at, -1), up, -dx);
    const turned = rotate(right, up, -dx), tilted = rotate(arm, turned, -dy);
    // Not over the pole: there the picture would turn round.
    if (Math.abs(dot(unit(tilted), up)) < 0.999) arm = tilted;
    this.move({...camera, position: add(camera.look_at, arm).map(tidy6)});
  }
  // By pixels of the frame.
  pan(dx, dy) {
    const {camera} = this, {right, up, flat, half} = sight(camera);
    const distance = Math.hypot(...add(camera.look_at, camera.position, -1));
    const pixel = 2 * (flat ? half : half * distance) / this.viewer.set.frame.height;
    const by = add(right.map(v => -v * dx * pixel), up, dy * pixel);
    this.move({...camera, position: add(camera.position, by).map(tidy6), look_at: add(camera.look_at, by).map(tidy6)});
  }
  dolly(factor) {
    const {camera} = this;
    if (camera.type === 'orthographic') return this.move({...camera, height: tidy6(camera.height * factor)});
    const arm = add(camera.position, camera.look_at, -1).map(v => v * factor);
    this.move({...camera, position: add(camera.look_at, arm).map(tidy6)});
  }

  // ---- Pointers ----

  down(event, pane) {
    this.gesture = newGesture();
    this.moved = 0;
    pane.element.focus({preventScroll: true});
  }
  drag(event, last, other, pane) {
    if (!this.camera) return;
    const dx = event.clientX - last.clientX, dy = event.clientY - last.clientY, [w, h] = pane.size();
    this.moved += Math.abs(dx) + Math.abs(dy);
    if (this.moved < 4) return;
    const scale = this.viewer.camera.scaleIn(w, h);
    if (other) {
      const span = e => Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY) || 1;
      this.pan(dx / 2 / scale, dy / 2 / scale);
      this.dolly(span(last) / span(event));
    } else if (event.shiftKey || event.buttons & 6) this.pan(dx / scale, dy / scale);
    else this.orbit(2.5 * dx / h, 2.5 * dy / h);
  }
  up(event, pane) {
    if (this.moved < 4 && event.type === 'pointerup' && event.button === 0) this.viewer.inspect(...pane.frameAt(event));
  }
  wheel(event) {
    if (!this.camera) return;
    const now = performance.now();
    if (!(now - this.wheeled < 400)) this.gesture = newGesture();
    this.wheeled = now;
    this.dolly(Math.exp(event.deltaY * (event.deltaMode ? 0.05 : 0.0012)));
  }

  // ---- Keys: those of a pane that has the focus ----

  action({key, shiftKey, repeat}) {
    if (!this.camera) return undefined;
    const step = 0.05, far = this.viewer.set.frame.height / 24;
    const keys = {a: () => this.pan(far, 0), d: () => this.pan(-far, 0), w: () => this.pan(0, far), s: () => this.pan(0, -far),
                  PageUp: () => this.dolly(0.95), PageDown: () => this.dolly(1 / 0.95)};
    if (!shiftKey) {
      Object.assign(keys, {ArrowLeft: () => this.orbit(-step, 0), ArrowRight: () => this.orbit(step, 0),
                           ArrowUp: () => this.orbit(0, -step), ArrowDown: () => this.orbit(0, step)});
    }
    const act = keys[key];
    return act && (() => {
      if (!repeat) this.gesture = newGesture();
      act();
    });
  }

  // ---- Lights ----

  // A handle for each light that is somewhere, over the first pane.
  placeLamps() {
    const pane = this.viewer.panes[0];
    if (!pane || !this.camera) return;
    for (const [name, lamp] of this.lamps) {
      if (handleOf(this.lights[name], this.camera)) continue;
      lamp.remove();
      this.lamps.delete(name);
    }
    const [w, h] = pane.size(), view = this.viewer.camera, scale = view.scaleIn(w, h);
    for (const [name, light] of Object.entries(this.lights)) {
      const handle = handleOf(light, this.camera);
      if (!handle) continue;
      const lamp = this.lamps.get(name) || this.makeLamp(name);
      if (lamp.parentNode !== pane.element) pane.element.append(lamp);
      const at = project(this.camera, this.viewer.set.frame, handle.at);
      lamp.hidden = !at || this.viewer.mode === 'side';
      if (!at) continue;
      // Lights beside the picture have their handles at its edge.
      const x = w / 2 + (at.x - view.x) * scale, y = h / 2 + (at.y - view.y) * scale;
      lamp.style.left = `${Math.min(Math.max(x, 16), w - 16)}px`;
      lamp.style.top = `${Math.min(Math.max(y, 16), h - 16)}px`;
    }
  }

  makeLamp(name) {
    const lamp = el('button', {class: 'lamp', 'aria-label': `Light ${name}: drag it, or move it by arrows; with Shift towards you and away`,
                               title: `Light ${name}`}, '☀');
    const gesture = gestured(lamp);
    let last = null;
    lamp.addEventListener('pointerdown', event => { lamp.setPointerCapture(event.pointerId); last = event; });
    lamp.addEventListener('pointermove', event => {
      if (!last) return;
      const pane = this.viewer.panes[0], scale = this.viewer.camera.scaleIn(...pane.size());
      this.moveLight(name, (event.clientX - last.clientX) / scale, (event.clientY - last.clientY) / scale, 0, gesture());
      last = event;
    });
    for (const end of ['pointerup', 'pointercancel']) lamp.addEventListener(end, () => { last = null; });
    lamp.addEventListener('keydown', event => {
      const arrows = {ArrowLeft: [-8, 0], ArrowRight: [8, 0], ArrowUp: [0, -8], ArrowDown: [0, 8]}[event.key];
      if (!arrows) return;
      event.preventDefault();
      event.stopPropagation();
      const [dx, dy] = arrows;
      if (event.shiftKey) this.moveLight(name, 0, 0, dy, gesture());
      else this.moveLight(name, dx, dy, 0, gesture());
    });
    this.lamps.set(name, lamp);
    return lamp;
  }

  // By pixels of the frame at the light's depth, and `away` of them along the view.
  moveLight(name, dx, dy, away, gesture) {
    const light = this.lights[name], {member, at} = handleOf(light, this.camera), {right, up, forward} = sight(this.camera);
    const seen = project(this.camera, this.viewer.set.frame, at);
    if (!seen) return;
    const by = add(add(right.map(v => v * dx * seen.pixel), up, -dy * seen.pixel), forward, -away * seen.pixel);
    let moved = add(at, by);
    if (light.type === 'directional') moved = unit(add(this.camera.look_at, moved, -1));
    moved = moved.map(tidy6);
    this.lights = {...this.lights, [name]: {...light, [member]: moved}};
    this.act.set(`/lights/${token(name)}/${member}`, moved, gesture);
    this.placeLamps();
  }
}

const tidy6 = value => Math.abs(value) < 1e-12 ? 0 : Number(value.toPrecision(6));
