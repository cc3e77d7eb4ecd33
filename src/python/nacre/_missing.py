# SPDX-License-Identifier: Apache-2.0
"""What `import nacre` says where it cannot work: one line, with the command that mends it."""
import importlib.machinery
import pathlib
import re
import shlex
import sys


def numpy() -> str:
    python = shlex.quote(sys.executable)
    return (f"nacre needs numpy, which {python} does not have: run /usr/bin/python3, Debian's, for which "
            f"scripts/setup installs it, or {python} -m pip install numpy")


def native(error: ImportError) -> str:
    """Of the compiled module _nacre, whose import raised the error."""
    # A build folder holds links to this file: it is where they lie, not where they point.
    folder = pathlib.Path(__file__).absolute().parent
    build = shlex.quote(str(folder.parents[1]))
    command = "scripts/build, which makes build/python, the folder for PYTHONPATH"
    if (folder.parents[1] / "CMakeCache.txt").is_file():
        command = f"cmake --build {build} --target nacre_python"
    modules = " ".join(sorted(path.name for path in folder.glob("_nacre.*so")))
    if not modules:
        return f"nacre's compiled module is not built in {folder}: {command}"
    versions = re.findall(r"_nacre\.cpython-3(\d+)", modules)
    if versions and str(sys.version_info[1]) not in versions:
        return (f"nacre's compiled module is for Python 3.{versions[0]}, and this is 3.{sys.version_info[1]}: "
                f"run python3.{versions[0]}, or build it for this one: cmake "
                f"-DNACRE_PYTHON_EXECUTABLE={shlex.quote(sys.executable)} {build} && {command}")
    return f"nacre's compiled module cannot be loaded, build it anew ({error}): {command}"
