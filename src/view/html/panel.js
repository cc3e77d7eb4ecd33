// SPDX-License-Identifier: Apache-2.0
// view/html/panel.js: a control for everything that the scene says, in the order of its parts.

// Models that nacre convert makes.
const FITTED = ['phong', 'modified_phong', 'blinn_phong', 'metallic_roughness', 'dielectric'];
const MOST_SHAPES = 40;  // with controls; more are a cloud, and have none
// Members that are no numbers to play with.
const NO_CONTROLS = new Set(['$schema', 'nacre']);

// Of an environment light: what it looks like, of which it has one, and what goes with an image.
const SKIES = ['radiance', 'gradient', 'quadratic', 'image'], OF_IMAGES = ['part', 'clamp_negative', 'scale'];

class Panel {
  // `act`: {set(pointer, value, gesture)}
  constructor(act) {
    this.act = act;
    this.scene = {};
    this.controls = new Map();  // by pointer
    this.find = el('input', {type: 'search', placeholder: 'Find a parameter ( / )', 'aria-label': 'Find a parameter', oninput: () => this.filter()});
    this.list = el('div', {});
    // What the parameter at hand means: the schema's words, which its row has as a tooltip as well.
    this.about = el('p', {class: 'about', hidden: true, 'aria-hidden': 'true'});
    for (const event of ['focusin', 'pointerover']) this.list.addEventListener(event, ({target}) => this.tell(target));
    this.element = el('div', {class: 'panel', role: 'region', 'aria-label': 'Scene'}, el('div', {class: 'find'}, this.find), this.list, this.about);
    this.files = [];  // images of the scene's folder
    this.open = new Map();  // whether a group is open, by pointer
  }

  // The scene is another, or has other members.
  build(scene, camera) {
    this.scene = scene;
    this.camera = camera;
    this.controls.clear();
    const focused = document.activeElement?.closest?.('.control')?.dataset.pointer;
    let first = true;  // the only group that is open by itself
    const groups = [], group = (title, schema, value, pointer) => {
      groups.push(this.group(title, schema, value, pointer, first));
      first = false;
    };
    for (const [name, material] of Object.entries(scene.materials || {})) {
      group(`Material ${name}`, {$ref: '#/$defs/material'}, material, `/materials/${token(name)}`);
    }
    (scene.shapes || []).slice(0, MOST_SHAPES).forEach((shape, i) => {
      for (const [name, value] of Object.entries(shape)) {
        if (name === 'material' && value && typeof value === 'object') {
          group(`Material of ${shape.type} ${i + 1}`, {$ref: '#/$defs/material'}, value, `/shapes/${i}/material`);
        }
      }
    });
    for (const [name, light] of Object.entries(scene.lights || {})) {
      group(`Light ${name}`, {$ref: '#/$defs/light'}, light, `/lights/${token(name)}`);
    }
    group('Camera', {$ref: '#/$defs/camera'}, camera, '/camera');
    group('Picture', {$ref: '#/$defs/image'}, scene.image || {}, '/image');
    const background = this.control('background', resolve(SCHEMA.properties.background), '/background');
    groups.push(el('details', {}, el('summary', {}, 'Background'), background.element));
    for (const [name, texture] of Object.entries(scene.textures || {})) {
      group(`Texture ${name}`, {$ref: '#/$defs/texture'}, texture, `/textures/${token(name)}`);
    }
    (scene.shapes || []).slice(0, MOST_SHAPES).forEach((shape, i) => {
      group(`Shape ${i + 1}`, {$ref: '#/$defs/shape'}, shape, `/shapes/${i}`);
    });
    this.list.replaceChildren(...groups);
    this.show();
    this.filter();
    if (focused && this.controls.has(focused)) this.controls.get(focused).focus();
  }

  group(title, schema, value, pointer, open) {
    const variant = variantOf(schema, value), telling = constOf(variant);
    const details = el('details', {'data-group': pointer, open: this.open.get(pointer) ?? open,
                                   ontoggle: () => { if (!this.find.value) this.open.set(pointer, details.open); }},
                       el('summary', {}, title, telling ? el('span', {class: 'soft'}, String(telling[1]).replaceAll('_', ' ')) : null));
    details.append(...this.members(schema, variant, value, pointer));
    return details;
  }

  members(schema, variant, value, pointer) {
    const rows = [], maps = [], telling = constOf(variant), variants = variantsOf(schema);
    if (telling && variants.length > 1 && telling[0] === 'model') {
      const control = makeControl('model', {enum: variants.map(([name]) => name), description: 'The reflection model. Parameters are kept where they mean the same.'},
          `${pointer}/model`, (_, name, gesture) => this.act.set(pointer, asModel(valueAt(this.scene, pointer), name), gesture), null);
      this.controls.set(control.pointer, control);
      rows.push(control.element);
      const fit = choiceInput(['', ...FITTED], 'Convert to the nearest material of another model', to => { if (to) this.act.convert(pointer, to); });
      fit.focus.options[0].textContent = 'to the nearest…';
      rows.push(el('div', {class: 'control'}, el('span', {class: 'label', title: 'As nacre convert: the lobe is fitted, the base keeps its albedo.'}, 'convert'), fit.element));
    }
    for (const [name, property] of Object.entries(variant.properties || {})) {
      if (NO_CONTROLS.has(name) || (telling && name === telling[0])) continue;
      const own = resolve(property), now = value?.[name], inner = objectForm(own);
      if (name === 'material' && pointer.startsWith('/shapes/') && now && typeof now === 'object') continue;
      if (inner && now && typeof now === 'object' && !Array.isArray(now)) {
        rows.push(this.group(name.replaceAll('_', ' '), inner, now, `${pointer}/${token(name)}`, false));
      } else {
        (name.endsWith('_map') ? maps : rows).push(this.control(name, own, `${pointer}/${token(name)}`).element);
      }
    }
    if (maps.length) {
      const at = `${pointer} maps`;
      rows.push(el('details', {open: this.open.get(at), ontoggle: event => this.open.set(at, event.target.open)}, el('summary', {}, 'maps'), maps));
    }
    return rows;
  }

  control(name, schema, pointer) {
    const control = makeControl(name, schema, pointer, (at, value, gesture) => this.edit(at, value, gesture),
                                at => this.drop(at), {...this.choices(name, pointer), value: this.valueOf(pointer)});
    this.controls.set(pointer, control);
    return control;
  }

  // The names and files that a value may be, and what it is without: {names, files, useFile, none}.
  choices(name, pointer) {
    const {scene, files} = this, textures = Object.keys(scene.textures || {});
    if ((name.endsWith('_map') || name === 'texture') && textures.length + files.length) {
      return {names: textures, files, useFile: (file, gesture) => this.useFile(pointer, file, gesture),
              none: this.ofModel && pointer.startsWith('/materials/') ? 'as in the model' : 'none'};
    }
    if (name === 'file' && pointer.startsWith('/textures/')) return {files};
    if (name === 'image' && pointer.startsWith('/lights/')) return {files: files.filter(file => /\.(exr|hdr)$/i.test(file))};
    const materials = name === 'material' ? Object.keys(scene.materials || {}) : [];
    return {names: materials.length ? materials : null};
  }

  // The map of this file: a texture that has it, or a new one.
  useFile(pointer, file, gesture) {
    const textures = this.scene.textures || {}, stem = file.replace(/^.*\//, '').replace(/\.\w+$/, '');
    let name = Object.keys(textures).find(known => textures[known].file === file);
    if (!name) {
      for (let i = 1; !name || name in textures; ++i) name = i > 1 ? `${stem} ${i}` : stem;
      this.act.set(`/textures/${token(name)}`, {file}, gesture);
    }
    this.act.set(pointer, name, gesture);
  }

  edit(pointer, value, gesture) {
    const [part, name, member] = steps(pointer);
    // The camera is set whole: of one of its members alone the others would be defaults.
    if (part === 'camera' && name) return this.act.set('/camera', {...this.camera, [name]: value}, gesture);
    // What an environment looks like is one of four.
    const light = part === 'lights' && this.scene.lights[name];
    if (light?.type === 'environment' && SKIES.includes(member) && !(member in light)) {
      const others = Object.entries(light).filter(([key]) => !SKIES.includes(key) && !(OF_IMAGES.includes(key) && member !== 'image'));
      return this.act.set(`/lights/${token(name)}`, {...Object.fromEntries(others), [member]: value}, gesture);
    }
    this.act.set(pointer, value, gesture);
  }

  // The value by default: the object around it without the member.
  drop(pointer) {
    const around = pointer.slice(0, pointer.lastIndexOf('/')), name = steps(pointer).pop();
    const {[name]: _, ...rest} = around ? valueAt(this.scene, around) ?? {} : this.scene;
    this.act.set(around, rest, newGesture());
  }

  valueOf(pointer) {
    return pointer.startsWith('/camera/') ? valueAt({camera: this.camera}, pointer) : valueAt(this.scene, pointer);
  }

  // All controls say what the scene says.
  show(below = '') {
    for (const [pointer, control] of this.controls) {
      if (pointer.startsWith(below) || below.startsWith(pointer + '/') || pointer.startsWith('/camera')) control.show(this.valueOf(pointer));
    }
  }

  // A value has changed, by whomever.
  changed(pointer, value, camera) {
    const before = valueAt(this.scene, pointer);
    const reshaped = value && typeof value === 'object' && !Array.isArray(value) && !pointer.startsWith('/camera');
    this.scene = putAt(this.scene, pointer, value);
    this.camera = camera;
    for (const [at, control] of this.controls) if (at.startsWith(pointer)) control.fault('');
    // Members may have come or gone.
    if (reshaped || (before && typeof before === 'object' && !Array.isArray(before) && typeof value !== 'object')) this.build(this.scene, camera);
    else this.show(pointer);
  }

  // What is wrong stands below the control that asked for it; returns whether there is one.
  fault(pointer, text, note = false) {
    let control = null;
    for (const [at, candidate] of this.controls) if (pointer && (at === pointer || pointer.startsWith(at + '/') || at === `${pointer}/model`)) control = candidate;
    if (!control) return false;
    control.fault(text, note);
    control.show(this.valueOf(control.pointer));
    return control.element.checkVisibility();  // in a group that is closed nobody sees it
  }

  tell(element) {
    const row = element.closest('.control[title]');
    if (!row) return;
    this.about.hidden = false;
    this.about.replaceChildren(el('b', {}, row.querySelector('label, .label').textContent), ` ${row.title}`);
  }

  filter() {
    const words = this.find.value.toLowerCase().split(/\s+/).filter(Boolean);
    const fits = control => words.every(word => control.words.includes(word));
    for (const control of this.controls.values()) control.element.hidden = words.length > 0 && !fits(control);
    for (const details of [...this.list.querySelectorAll('details')].reverse()) {
      const any = details.querySelector('.control:not([hidden])');
      details.hidden = words.length > 0 && !any;
      if (words.length && any) details.open = true;
    }
  }
}
