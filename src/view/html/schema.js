// SPDX-License-Identifier: Apache-2.0
// view/html/schema.js: what the schema of scene files says of a value: the one table of parameters,
// with ranges, defaults and meanings.

const token = name => String(name).replaceAll('~', '~0').replaceAll('/', '~1');
const untoken = text => text.replaceAll('~1', '/').replaceAll('~0', '~');
const steps = pointer => pointer.split('/').slice(1).map(untoken);

// The value at a pointer of a tree, or undefined.
const valueAt = (tree, pointer) => steps(pointer).reduce((at, name) => at?.[name], tree);

// Puts it there; objects on the way are made.
function putAt(tree, pointer, value) {
  const path = steps(pointer), last = path.pop();
  if (last === undefined) return value;
  let at = tree;
  for (const name of path) at = at[name] = at[name] ?? {};
  at[last] = value;
  return tree;
}

// The schema with what it refers to; its own words win.
function resolve(schema) {
  while (schema && schema.$ref) {
    const {$ref, ...own} = schema;
    schema = {...valueAt(SCHEMA, $ref.slice(1)), ...own};
  }
  return schema;
}

// Members that tell variants apart: "model" of materials, "type" of lights and shapes.
const TELLING = ['model', 'type', 'kind'];
const constOf = variant => TELLING.map(name => [name, resolve(variant.properties?.[name])?.const]).find(([, v]) => v !== undefined);

// The variants of a choice of objects, by the name that tells them: [[name, schema]...]
function variantsOf(schema) {
  const all = (resolve(schema).oneOf || []).map(resolve).filter(v => v.properties);
  return all.map(v => [constOf(v)?.[1], v]).filter(([name]) => name !== undefined);
}

// The object's own variant, or the schema itself. A material of a file alone has no model.
function variantOf(schema, value) {
  const variants = variantsOf(schema);
  if (!variants.length) return resolve(schema);
  const ofFile = value?.file !== undefined && value.model === undefined &&
      resolve(schema).oneOf.map(resolve).find(v => !constOf(v) && v.required?.includes('file'));
  if (ofFile) return ofFile;
  const found = variants.find(([, v]) => {
    const [member, name] = constOf(v);
    return (value?.[member] ?? resolve(v.properties[member]).default) === name;
  });
  return found ? found[1] : variants[0][1];
}

const isColor = schema => schema.anyOf?.length === 2 && schema.anyOf[0].type === 'number' &&
    schema.anyOf[1].type === 'array' && schema.anyOf[1].maxItems === 3;
const isPoint = schema => schema.type === 'array' && schema.minItems === 3 && schema.maxItems === 3;
// Other forms of the value of which one is an object: {schema of the object}.
const objectForm = schema => schema.properties ? schema : (schema.anyOf || []).map(resolve).find(s => s.properties || s.oneOf);

// Materials that nacre convert can make Phong of physically based and back: [{pointer, phong, other}...]. Those
// of grids stay, whose axes are parameters of one model.
const PHONG = ['phong', 'modified_phong', 'blinn_phong'], PBR = ['metallic_roughness', 'dielectric', 'conductor'];
function convertible(scene) {
  const named = Object.entries(scene.materials || {}).map(([name, material]) => [`/materials/${token(name)}`, material]);
  const own = (scene.shapes || []).map((shape, i) => [`/shapes/${i}/material`, !shape.rows && !shape.columns && shape.material]);
  return [...named, ...own].filter(([, material]) => material && typeof material === 'object')
      .map(([pointer, material]) => ({pointer, material, model: material.model ?? 'metallic_roughness'}))
      .filter(({model}) => PHONG.includes(model) || PBR.includes(model))
      .map(found => ({...found, phong: PHONG.includes(found.model)}))
      .map(found => ({...found, other: found.phong ? nearestPbr(found.material) : 'phong'}));
}

// The model by which a Phong material is nearest to a physically based one: a lobe without a colour over
// a base that has one is a dielectric's.
function nearestPbr(material) {
  const {ks} = material;
  return Array.isArray(ks) && ks.some(v => v !== ks[0]) ? 'metallic_roughness' : 'dielectric';
}

// Parameters of models that mean the same, and how a value becomes another's.
const MEANINGS = [['color', 'albedo', 'base_color'], ['diffuse_map', 'albedo_map', 'base_color_map'],
                  ['roughness', 'shininess']];
// Exponent 2 / alpha^2 - 2 (Walter et al. 2007), alpha = roughness^2.
const CONVERSIONS = {
  'roughness shininess': r => Math.min(Math.max(2 / Math.max(r, 0.01) ** 4 - 2, 0), 1e8),
  'shininess roughness': n => (2 / (n + 2)) ** 0.25,
};

// The material as one of another model: parameters are kept where they mean the same.
function asModel(material, model) {
  const variant = variantsOf({$ref: '#/$defs/material'}).find(([name]) => name === model)[1];
  const made = {model};
  for (const [name, value] of Object.entries(material)) {
    if (name === 'model') continue;
    const group = MEANINGS.find(names => names.includes(name)) || [name];
    const to = name in variant.properties ? name : group.find(other => other in variant.properties);
    if (to === undefined || to in made) continue;
    const convert = CONVERSIONS[`${name} ${to}`];
    const property = resolve(variant.properties[to]);
    if (property.enum && !property.enum.includes(value)) continue;
    made[to] = convert && typeof value === 'number' ? Number(convert(value).toPrecision(4)) : value;
  }
  return made;
}
