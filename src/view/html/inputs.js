// SPDX-License-Identifier: Apache-2.0
// view/html/inputs.js: one control for one value: a slider with a field, a colour, a choice. Each is
// {element, show(value)}; `edit(value, gesture)` is called with what the hand makes.

// Changes of one drag, or of one stay in a field, are one step of the history. The numbers of two
// pages must not be the same.
const gestures = {last: Math.floor(Math.random() * 2 ** 40) * 256};
const newGesture = () => ++gestures.last;

const tidy = value => Number(Number(value).toPrecision(5));
let lastControl = 0;

// Where a slider's ends are, and whether its steps are ratios: ranges of more than three decades
// are logarithmic, those that the schema does not bound lie around the value.
function sliderScale(schema, value) {
  const min = schema.minimum ?? schema.exclusiveMinimum ?? -1e15, max = schema.maximum ?? schema.exclusiveMaximum ?? 1e15;
  if (schema.turns && min === -1e15 && max === 1e15) return {low: -180, high: 180, log: false};
  if (max - min <= 1000 && !(min > 0 && max / min > 1000)) return {low: min, high: max, log: false};
  const size = Math.abs(value) || Math.abs(schema.default) || 1;
  if (min < 0) return {low: Math.max(min, value - 3 * size), high: Math.min(max, value + 3 * size), log: false};
  const decade = 10 ** Math.round(Math.log10(size));
  return {low: Math.max(min, decade / 1000), high: Math.min(max, decade * 1000), log: true, zero: min === 0};
}
const STEPS = 1000;
function sliderPlace(scale, value) {
  const {low, high, log} = scale;
  const t = log ? Math.log(Math.max(value, low) / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.round(STEPS * Math.min(Math.max(t, 0), 1));
}
function sliderValue(scale, place, whole) {
  const {low, high, log, zero} = scale, t = place / STEPS;
  if (log && zero && place === 0) return 0;
  const value = log ? low * (high / low) ** t : low + t * (high - low);
  return whole ? Math.round(value) : tidy(value);
}

// A gesture lasts from a press to the next, on whatever it is pressed.
function gestured(element) {
  let gesture = newGesture();
  for (const name of ['pointerdown', 'focus']) element.addEventListener(name, () => { gesture = newGesture(); });
  return () => gesture;
}

function numberInput(schema, label, edit) {
  const whole = schema.type === 'integer';
  let value = schema.default ?? 0, scale = sliderScale(schema, value), held = false;
  const slider = el('input', {type: 'range', min: 0, max: STEPS, step: 1, 'aria-label': label});
  const exact = el('input', {type: 'number', step: 'any', 'aria-label': `${label}, exactly`});
  const sliding = gestured(slider), typing = gestured(exact);
  const say = () => slider.setAttribute('aria-valuetext', show(value));
  slider.addEventListener('input', () => {
    value = sliderValue(scale, Number(slider.value), whole);
    exact.value = value;
    say();
    edit(value, sliding());
  });
  slider.addEventListener('pointerdown', () => { held = true; });
  for (const end of ['pointerup', 'pointercancel', 'change']) {
    slider.addEventListener(end, () => { held = false; });
  }
  exact.addEventListener('change', () => {
    if (exact.value === '') { exact.value = value; return; }
    value = Number(exact.value);
    scale = sliderScale(schema, value);
    slider.value = sliderPlace(scale, value);
    say();
    edit(value, typing());
  });
  return {
    element: el('div', {class: 'row'}, slider, exact), focus: slider,
    show(now) {
      if (held || now === undefined) return;
      value = now;
      if (!(value >= scale.low && value <= scale.high)) scale = sliderScale(schema, value);
      slider.value = sliderPlace(scale, value);
      if (document.activeElement !== exact) exact.value = value;
      say();
    },
  };
}

function threeInput(names, label, edit) {
  let value = [0, 0, 0];
  const fields = names.map((name, i) => el('input', {type: 'number', step: 'any', 'aria-label': `${label}, ${name}`, onchange: event => {
    if (event.target.value === '') { event.target.value = value[i]; return; }
    value = [...value];
    value[i] = Number(event.target.value);
    edit(value, newGesture());
  }}));
  return {
    element: el('div', {class: 'three'}, fields), focus: fields[0],
    show(now) {
      if (!Array.isArray(now)) return;
      value = now;
      fields.forEach((field, i) => {
        if (document.activeElement === field) return;
        field.value = Number(Number(now[i]).toPrecision(4));  // what there is room for
        field.title = now[i];
      });
    },
  };
}

// A picker of what fits a display, three linear numbers for what does not, and for light a slider
// and greys a slider of how much of it there is.
function colorInput(schema, label, edit, grey) {
  const most = schema.anyOf[0].maximum;
  let value = [0, 0, 0];
  const picker = el('input', {type: 'color', 'aria-label': `${label}, as a colour`}), picking = gestured(picker);
  const three = threeInput(['red, linear', 'green, linear', 'blue, linear'], label, edit);
  const level = () => most > 1 ? Math.max(...value) || 1 : 1;
  picker.addEventListener('input', () => {
    const rgb = hex(picker.value).map(code => srgbEotf(code / 255));
    // The brightest channel of a light stays as bright.
    const scale = most > 1 ? level() / (Math.max(...rgb) || 1) : 1;
    edit(rgb.map(v => tidy(Math.min(v * scale, most))), picking());
  });
  const amount = most > 1 || grey ? numberInput({...schema.anyOf[0], default: 1}, `${label}, amount`, (size, gesture) => {
    const before = Math.max(...value), color = before > 0 ? value.map(v => v / before) : [1, 1, 1];
    if (color.every(v => v === 1)) edit(size, gesture);
    else edit(color.map(v => tidy(v * size)), gesture);
  }) : null;
  return {
    element: el('div', {}, amount ? amount.element : null, el('div', {class: 'row'}, picker, three.element)), focus: amount ? amount.focus : picker,
    show(now) {
      if (now === undefined) return;
      value = typeof now === 'number' ? [now, now, now] : now;
      if (!Array.isArray(value)) return;
      const codes = value.map(v => Math.round(255 * Math.min(Math.max(srgbOetf(v / level()), 0), 1)));
      if (document.activeElement !== picker) picker.value = '#' + codes.map(code => code.toString(16).padStart(2, '0')).join('');
      three.show(value);
      if (amount) amount.show(Math.max(...value));
    },
  };
}

// Without a value none of them is shown: the first one would look like it.
function choiceInput(names, label, edit) {
  const select = el('select', {'aria-label': label, onchange: () => edit(select.value, newGesture())});
  options(select, names.map(name => [name, String(name).replaceAll('_', ' ')]));
  const none = el('option', {value: '', disabled: true, hidden: true}, 'none');
  return {element: select, focus: select, show(now) {
    if (now === undefined) select.prepend(none);
    else none.remove();
    select.value = now ?? '';
  }};
}

function switchInput(label, edit) {
  const box = el('input', {type: 'checkbox', 'aria-label': label, onchange: () => edit(box.checked, newGesture())});
  return {element: box, focus: box, show(now) { box.checked = Boolean(now); }};
}

// Anything else, as JSON.
function textInput(label, edit) {
  let shown = '';
  const input = el('input', {type: 'text', spellcheck: 'false', 'aria-label': `${label}, as JSON`, onchange: () => {
    if (input.value === shown) return;
    let value = input.value;
    try { value = JSON.parse(input.value); } catch { /* a name without quotes */ }
    edit(value, newGesture());
  }});
  return {element: input, focus: input, show(now) {
    shown = now === undefined ? '' : JSON.stringify(now);
    if (document.activeElement !== input) input.value = shown;
  }};
}

// A texture by its name, or a file of the scene's folder, of which one is made.
function mapInput(names, files, label, edit, useFile, none) {
  const select = el('select', {'aria-label': label, onchange: () => {
    const {kind} = select.selectedOptions[0].dataset;
    if (kind === 'file') useFile(select.value, newGesture());
    else edit(select.value, newGesture());
  }});
  const group = (title, kind, values) => values.length ? el('optgroup', {label: title}, values.map(value => el('option', {value, 'data-kind': kind}, value))) : null;
  select.append(...[el('option', {value: '', disabled: true}, none), group('Textures', 'texture', names), group('Files of the scene’s folder', 'file', files)].filter(Boolean));
  return {element: select, focus: select, show(now) { select.value = typeof now === 'string' ? now : ''; }};
}

// A file of the scene's folder.
function fileInput(files, label, edit) {
  const select = el('select', {'aria-label': label, onchange: () => edit(select.value, newGesture())});
  return {element: select, focus: select, show(now) {
    const all = now && !files.includes(now) ? [now, ...files] : files;
    options(select, all.map(name => [name, name]));
    select.value = now ?? '';
  }};
}

// The control that suits a schema.
function makeInput(schema, label, edit, {names, files, useFile, none, value}) {
  if (useFile) return mapInput(names, files, label, edit, useFile, none);
  if (files) return fileInput(files, label, edit);
  if (schema.enum) return choiceInput(schema.enum, label, edit);
  if (schema.type === 'boolean') return switchInput(label, edit);
  if (schema.type === 'number' || schema.type === 'integer') return numberInput(schema, label, edit);
  if (isColor(schema)) return colorInput(schema, label, edit, typeof (value ?? schema.default) === 'number');
  if (isPoint(schema)) return threeInput(['x', 'y', 'z'], label, edit);
  if (names) return choiceInput(names, label, edit);
  return textInput(label, edit);
}

// A labelled row for the value at a pointer: {pointer, element, show, fault}. `drop` makes the value
// what it is by default.
function makeControl(name, schema, pointer, edit, drop, known = {}) {
  const label = name.replaceAll('_', ' '), id = `control${++lastControl}`;
  const input = makeInput({...schema, turns: name.endsWith('_deg')}, label, (value, gesture) => edit(pointer, value, gesture), known);
  input.focus.id = id;
  if (schema.description) input.focus.setAttribute('aria-description', schema.description);
  const fault = el('div', {class: 'fault', role: 'alert', hidden: true});
  const dropper = drop ? el('button', {class: 'drop', title: 'Back to the default', 'aria-label': `${label}: back to the default`,
                                       onclick: () => drop(pointer)}, '×') : null;
  const element = el('div', {class: 'control', 'data-pointer': pointer, title: schema.description || null},
                     el('label', {for: id}, label), el('div', {class: 'row'}, el('div', {class: 'grow'}, input.element), dropper), fault);
  return {
    pointer, element, words: `${pointer} ${label} ${schema.description || ''}`.toLowerCase(),
    show(value) {
      element.classList.toggle('absent', value === undefined);
      input.show(value === undefined ? schema.default : value);
    },
    focus() { input.focus.focus(); },
    // `note`: nothing is wrong, but worth to know.
    fault(text, note = false) {
      fault.classList.toggle('note', note);
      fault.textContent = text;
      fault.hidden = !text;
    },
  };
}
