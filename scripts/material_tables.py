#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the tables of material parameters between two marks of scenes/README.md.

They are made of scenes/nacre.schema.json, which the program makes of the one table that its reader
uses (src/scene/material_parameters.cc). With --check nothing is written: exit code 1 if the README
says something else.
"""
import argparse
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- materials: begin -->", "<!-- materials: end -->"
# What these definitions of the schema are called in the tables.
KINDS = {"radiance": "radiance, `[r, g, b]` or a number, from 0", "texture_name": "texture",
         "normal_map": "normal map", "bump_map": "bump map"}


def range_text(number):
    return f"{number['minimum']:g} to {number['maximum']:g}"


def values_text(schema, key):
    """What a key may be."""
    reference = key.get("$ref", "").rpartition("/")[2]
    if reference in KINDS:
        return KINDS[reference]
    if reference:
        return values_text(schema, schema["$defs"][reference])
    if "enum" in key:
        return ", ".join(f"`{option}`" for option in key["enum"])
    if key.get("type") == "string":
        return "a file's name"
    if "anyOf" in key:  # a number, or one for each channel
        return f"colour, {range_text(key['anyOf'][0])}"
    return range_text(key)


def rank(item):
    """Numbers and colours come first, then choices, then maps."""
    name, key = item
    return 2 if name.endswith("_map") else 1 if "enum" in key else 0


def rows_of(schema, model):
    """[table row] of the model's definition."""
    rows = []
    for name, key in sorted(model["properties"].items(), key=rank):
        if name == "model":
            continue
        default = key.get("default", "")
        if isinstance(default, str) and default:
            default = f"`{default}`"
        reference = schema["$defs"].get(key.get("$ref", "").rpartition("/")[2], {})
        meaning = key.get("description", reference.get("description", ""))
        rows.append(f"| `{name}` | {values_text(schema, key)} | {default} | {meaning} |")
    return rows


def table(rows):
    return ["| key | values | default | meaning |", "|---|---|---|---|", *rows, ""]


def tables(schema):
    """All of it, as Markdown: a table for the models that have the same keys, and one of the keys
    that every model has."""
    models = {}  # by name: title and rows
    for option in schema["$defs"]["material"]["oneOf"]:
        model = schema["$defs"][option["$ref"].rpartition("/")[2]]
        name = model["properties"].get("model", {}).get("const")
        if name not in ("split", None):  # a split has no parameters, a file no model of its own
            models[name] = model["title"], rows_of(schema, model)
    every = [rows for _, rows in models.values()]
    common = [row for row in every[0] if all(row in rows for rows in every)]
    lines, pending = [], []
    names = list(models)
    for name, following in zip(names, [*names[1:], None]):
        title, rows = models[name]
        head, colon, rest = title.partition(": ")
        says_the_name = re.sub(r"\W", "_", head.lower()) == name
        pending.append(f"- **`{name}`**: {rest if colon and says_the_name else title}")
        if following is None or models[following][1] != rows:
            lines += [*pending, "", *table([row for row in rows if row not in common])]
            pending = []
    return "\n".join([*lines, "Every model has, too:", "", *table(common)]).strip()


def with_tables(text, new):
    """`text` with what stands between the marks replaced."""
    head, begin, rest = text.partition(BEGIN)
    _, end, tail = rest.partition(END)
    if not begin or not end:
        raise SystemExit(f"error: no {BEGIN} ... {END}")
    return f"{head}{BEGIN}\n{new}\n{END}{tail}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing, tell whether it is so")
    options = parser.parse_args()
    readme = ROOT / "scenes/README.md"
    text = readme.read_text()
    new = with_tables(text, tables(json.loads((ROOT / "scenes/nacre.schema.json").read_text())))
    if options.check:
        if new != text:
            sys.exit("scenes/README.md: the tables of materials are old: scripts/material_tables.py")
    else:
        readme.write_text(new)


if __name__ == "__main__":
    main()
