# SPDX-License-Identifier: Apache-2.0
"""Holds scenes/nacre.schema.json against the scenes that ship and against bad_scenes.json.

Usage: schema_test.py SOURCE_DIR. Needs python3-jsonschema.
"""
import copy
import json
import pathlib
import sys

import jsonschema


def steps(pointer):
    return [token.replace("~1", "/").replace("~0", "~") for token in pointer.split("/")[1:]]


def edited(base, case):
    """The base scene with the case's values set and removed by JSON pointer."""
    scene = copy.deepcopy(base)
    for pointer, value in case.get("set", {}).items():
        parent, last = parent_of(scene, pointer)
        parent[last] = value
    for pointer in case.get("remove", []):
        parent, last = parent_of(scene, pointer)
        del parent[last]
    return scene


def parent_of(scene, pointer):
    *path, last = steps(pointer)
    for token in path:
        scene = scene[int(token) if isinstance(scene, list) else token]
    return scene, int(last) if isinstance(scene, list) else last


def main():
    source = pathlib.Path(sys.argv[1])
    schema = json.loads((source / "scenes/nacre.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    failures = []

    scenes = [path for path in sorted((source / "scenes").rglob("*.json")) if path.name != "nacre.schema.json"]
    if not scenes:
        failures.append("no scenes to check")
    for path in scenes:
        scene = json.loads(path.read_text())
        for error in validator.iter_errors(scene):
            failures.append(f"{path.name}: {error.json_path}: {error.message}")

    table = json.loads((source / "tests/scene_io/bad_scenes.json").read_text())
    if not validator.is_valid(table["base"]):
        failures.append("the base of bad_scenes.json is refused")
    for case in table["cases"]:
        if case.get("schema") is False:
            continue
        scene = json.loads(case["text"]) if "text" in case else edited(table["base"], case)
        if validator.is_valid(scene):
            failures.append(f"accepted: {json.dumps(case)}")

    print("\n".join(failures) or f"{len(scenes)} scenes and {len(table['cases'])} bad scenes")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
