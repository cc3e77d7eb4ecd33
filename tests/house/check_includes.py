#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks every #include and every nacre_library() of src/ against the dependency order.

Within a folder no includes form a ring. Between folders the order is the table below. A folder may use those that its DEPENDS line in src/CMakeLists.txt
names, and what these depend on; and that line may name only what the table allows.
"""
import argparse
import pathlib
import re
import sys

# The trunk: a folder may depend on those above it.
TRUNK = (
    ("base",),
    ("color",),
    ("sampling",),
    ("texture",),
    ("brdf",),
    ("light",),
    ("scene",),
    ("hit",),
    ("visibility", "shading"),  # side by side: they meet in hit/ and never see each other
    ("render",),
)
TRUNK_FOLDERS = {folder for tier in TRUNK for folder in tier}
# Side branches, and what each may depend on.
BRANCHES = {
    # One of the two defines what visibility/box_trees.h declares.
    "embree": {"base", "hit", "visibility"},
    "no_embree": {"base", "hit", "visibility"},
    "image_io": {"base", "color"},
    "oiio_module": {"image_io"},  # loaded by it; they share one header
    "scene_io": {"base", "scene", "image_io"},
    "compare": {"base", "color"},
    "report": {"base", "color", "compare", "image_io"},
    # What the files of a render say about it: for the program and the API alike.
    "output": TRUNK_FOLDERS | {"image_io"},
    # What the lesson's exercises ask: the renderer's terms and pictures as curves and numbers.
    "study": TRUNK_FOLDERS | {"image_io", "report"},
    # Tables of BRDFs, and what is wrong with those of other programs: for the program and the API.
    "table": TRUNK_FOLDERS | {"image_io", "scene_io"},
    # The public API, nacre.h.
    "api": TRUNK_FOLDERS | {"image_io", "scene_io", "compare", "output", "table"},
    # The live view: its scene and render thread, its page and the server of it.
    "view": TRUNK_FOLDERS | {"image_io", "scene_io", "compare", "report", "study", "output"},
    "python": set(),  # the Python package, on nacre.h alone
    "textbook": {"base"},  # shares nothing with the renderer; only lesson/ and cli/ may use it
    "lesson": TRUNK_FOLDERS | {"textbook", "scene_io", "image_io", "compare"},
}
# In src/ itself, and the folders that have it: that whose header it is, and one of users.
PUBLIC_HEADER, PUBLIC_FOLDERS = "nacre.h", ("api", "python")
# Depends on whatever it likes; nothing depends on it.
TOP = "cli"

FOLDERS = TRUNK_FOLDERS | set(BRANCHES) | {TOP}

# The files of render/ in the order in which a pixel's samples go through them: each includes only
# headers of those before it.
RENDER_ORDER = """
    settings stats explanation output_layers camera camera_kernel frame_window prepared_materials
    plan_notes
    film_kernel small_triangles adaptive_plan interval lighting_kernel mesh_windows
    outline_coverage sphere_projections
    prepared_scene camera_cost hits_plan tile_shapes samples hits surfaces
    lights_plan highlights texel_maps mesh_glints shadow_plan white_level direct_batch
    shadow_origins sampled_shadows sampled_lights mesh_radiance direct mesh_shading
    film hit_positions film_layers
    frame_plan tile_work tile
    cell filter_shares dust footprint outline_pixels cell_film evidence convergence
    glints probes rare_features rare_triangles rare_texels adaptive
    render forecast
""".split()

# SIMD code: these files are compiled once for every target.
SIMD_FILE = r"\w+/(\w+-inl\.h|\w+_kernel\.cc)"
# Headers with a rule of their own: their names, the files of src/ that may include them, the rule.
HEADER_RULES = (
    (r"embree\d/", r"embree/embree_api\.h", "Embree only in embree/embree_api.h"),
    (r"OpenImageIO/", r"oiio_module/", "OpenImageIO only in oiio_module/"),
    (r"OpenEXR/|Imf\w*\.h|openexr\w*\.h", r"image_io/", "OpenEXR only in image_io/"),
    (r"isa-l|igzip|zlib\.h", r"image_io/", "deflate only in image_io/"),
    (r"spng\.h|jpeglib\.h|jerror\.h|webp/|ft2build\.h", r"image_io/",
     "libspng, libjpeg, libwebp and FreeType only in image_io/"),
    (r"(oneapi/)?tbb/", r"embree/tbb_threads\.cc", "TBB only in embree/tbb_threads.cc"),
    (r"hwy/highway\.h", rf"{SIMD_FILE}|base/(highway_targets|target)\.cc",
     "Highway only in *-inl.h and *_kernel.cc, highway.h also in base/{highway_targets,target}.cc"),
    (r"hwy/", SIMD_FILE, "Highway only in *-inl.h and *_kernel.cc"),
    (r"\w+/\w+-inl\.h", SIMD_FILE, "-inl.h only in *-inl.h and *_kernel.cc"),
    (r"nlohmann/", rf"(?!({'|'.join(sorted(TRUNK_FOLDERS))})/)", "JSON in no folder up to render/"),
    (r"CLI/", r"cli/", "CLI11 only in cli/"),
    (r"boost/", r"view/server\.cc", "Boost only in view/server.cc"),
    (r"pybind11/", r"python/", "pybind11 only in python/"),
)

INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')
LIBRARY_CALL = re.compile(r"nacre_library\(\s*(\w+)([^)]*)\)")
# The program `nacre` is all of cli/.
PROGRAM_CALL = re.compile(r"target_link_libraries\(\s*nacre_cli\s([^)]*)\)")


def allowed_by_table(folder):
    """The folders that `folder` may name in its DEPENDS line."""
    if folder == TOP:
        return FOLDERS - {TOP}
    if folder in BRANCHES:
        return BRANCHES[folder]
    above = set()
    for tier in TRUNK:
        if folder in tier:
            break
        above.update(tier)
    return above


def read_cmake(src):
    """{folder: folders it depends on directly}, from src/CMakeLists.txt."""
    depends = {}
    text = re.sub(r"#.*", "", (src / "CMakeLists.txt").read_text())
    for folder, arguments in LIBRARY_CALL.findall(text):
        depends[folder] = re.findall(r"\bnacre_(\w+)", arguments)
    depends[TOP] = [folder for arguments in PROGRAM_CALL.findall(text)
                    for folder in re.findall(r"\bnacre_(\w+)", arguments)]
    # A folder with a CMakeLists.txt of its own has no DEPENDS line: it is held to the table.
    for cmake in src.glob("*/CMakeLists.txt"):
        depends[cmake.parent.name] = sorted(BRANCHES.get(cmake.parent.name, ()))
    return depends


def closure(folder, depends):
    """`folder` and all that it depends on, directly or not."""
    found, todo = set(), [folder]
    while todo:
        name = todo.pop()
        if name not in found:
            found.add(name)
            todo.extend(depends.get(name, ()))
    return found


def check_cmake(depends, folders_on_disk):
    """Faults of the DEPENDS lines against the table."""
    where = "src/CMakeLists.txt"
    for folder in sorted(folders_on_disk - set(depends)):
        yield f"{where}: src/{folder} is there, but no line names what it DEPENDS on"
    for folder, names in depends.items():
        if folder not in FOLDERS:
            yield f"{where}: {folder} is not in the table of tests/house/check_includes.py"
            continue
        for name in names:
            if name not in allowed_by_table(folder):
                yield f"{where}: {folder} depends on {name}, which the dependency order forbids"


def check_quoted(file, path, depends):
    """Fault of an #include "path" in src/<file>, or None."""
    included, slash, _ = path.partition("/")
    folder = file.partition("/")[0]
    if path == PUBLIC_HEADER:
        return None if folder in PUBLIC_FOLDERS else f'"{path}" is for others: only api/ has it'
    if not slash:
        return f'"{path}": write "folder/file.h"'
    if not path.endswith(".h"):
        return f'"{path}" is not a header'
    if included not in FOLDERS:
        return f'"{path}": src/ has no folder {included}'
    if included not in closure(folder, depends):
        return f'"{path}": {folder} does not depend on {included} (DEPENDS in src/CMakeLists.txt)'
    if folder == included == "render":
        return check_render_order(pathlib.PurePath(file).stem, pathlib.PurePath(path).stem, path)
    return None


def check_render_order(user, used, path):
    """Fault of an include within render/, or None."""
    for name in (user, used):
        if name not in RENDER_ORDER:
            return f"render/{name} is not in RENDER_ORDER of tests/house/check_includes.py"
    if RENDER_ORDER.index(used) > RENDER_ORDER.index(user):
        return f'"{path}" runs back up: render/{used} comes after render/{user} (RENDER_ORDER)'
    return None


def check_source(src, source, depends):
    """Faults of one source file's includes."""
    file = source.relative_to(src).as_posix()
    for number, line in enumerate(source.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        quote, path = match.groups()
        at = f"src/{file}:{number}"
        for pattern, users, rule in HEADER_RULES:
            if re.match(pattern, path):
                if not re.match(users, file):
                    yield f"{at}: {path}: {rule}"
                break
        if quote == '"' and not path.startswith("hwy/"):
            fault = check_quoted(file, path, depends)
            if fault:
                yield f"{at}: {fault}"


def part_of(path):
    """The part of its folder that a file belongs to: NAME of NAME.h, NAME.cc, NAME-inl.h and NAME_kernel.cc."""
    return (path.parent.as_posix(), re.sub(r"(_kernel)?(-inl)?$", "", path.stem))


def check_rings(src, sources):
    """Parts of one folder that include one another in a circle."""
    uses = {}
    for source in sources:
        file = source.relative_to(src)
        part = part_of(file)
        for match in map(INCLUDE.match, source.read_text().splitlines()):
            used = match and pathlib.PurePath(match.group(2))
            if used and used.parent == file.parent and part_of(used) != part:
                uses.setdefault(part, {}).setdefault(part_of(used), file.as_posix())
    done = set()

    def walk(part, trail):
        if part in trail:
            ring = trail[trail.index(part):] + [part]
            files = [uses[a][b] for a, b in zip(ring, ring[1:])]
            yield f"src/{files[0]}: a ring of includes: {' -> '.join(name for _, name in ring)}"
        elif part not in done:
            for used in sorted(uses.get(part, ())):
                yield from walk(used, trail + [part])
            done.add(part)

    for part in sorted(uses):
        yield from walk(part, [])


def check_public_header(header):
    """Faults of the public header, which others compile: it includes the standard library only."""
    for number, line in enumerate(header.read_text().splitlines(), 1):
        if INCLUDE.match(line) and not re.match(r"\s*#\s*include <[a-z_]+>", line):
            yield f"src/{header.name}:{number}: {line.strip()}: only the standard library"


def check(root):
    """All faults of the tree at `root`, and how many files were read."""
    src = pathlib.Path(root) / "src"
    depends = read_cmake(src)
    # The public header, in src/ itself, is no folder of the order.
    sources = sorted(path for path in src.glob("*/**/*") if path.suffix in (".h", ".cc"))
    on_disk = {source.relative_to(src).parts[0] for source in sources}
    faults = list(check_cmake(depends, on_disk))
    for source in sources:
        faults.extend(check_source(src, source, depends))
    faults.extend(check_rings(src, sources))
    if (src / PUBLIC_HEADER).is_file():
        faults.extend(check_public_header(src / PUBLIC_HEADER))
    return faults, len(sources)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", help="the root of the repository")
    faults, count = check(parser.parse_args().root)
    for fault in faults:
        print(fault)
    print(f"{count} files in src/, {len(faults)} faults")
    # No file read is a fault too: a check that saw nothing has checked nothing.
    return 1 if faults or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
