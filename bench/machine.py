# SPDX-License-Identifier: Apache-2.0
"""What the numbers were measured on and with: stands above everything that is printed."""
import os
import pathlib
import platform
import re
import subprocess


def _first(pattern, path, default="unknown"):
    """The first match of a pattern in a file."""
    try:
        text = pathlib.Path(path).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return default
    match = re.search(pattern, text, re.MULTILINE)
    return match.group(1).strip() if match else default


def _processor():
    """Its name; AMD's, of which hosts tell no more than the line, with the generation."""
    info = "/proc/cpuinfo"
    name = _first(r"model name\s*: (.*)", info)
    if _first(r"vendor_id\s*: (.*)", info) != "AuthenticAMD":
        return name
    family = _first(r"cpu family\s*: (.*)", info)
    has_avx512 = _first(r"flags\s*:.*(avx512f)", info, "") != ""
    generation = {"25": "Zen 4" if has_avx512 else "Zen 3", "26": "Zen 5"}
    return f"{name}, {generation.get(family, f'family {family}')}"


def _compiler(build):
    """The compiler that CMake found for a build folder."""
    for path in sorted(build.glob("CMakeFiles/*/CMakeCXXCompiler.cmake")):
        name = _first(r'CMAKE_CXX_COMPILER_ID "(.*?)"', path)
        version = _first(r'CMAKE_CXX_COMPILER_VERSION "(.*?)"', path)
        return f"{name} {version}"
    return "unknown"


def commit_of(root):
    """Short commit of a checkout, and whether files differ from it."""
    def git(*arguments):
        # safe.directory: the tree may belong to somebody else, as it does in many containers.
        command = ["git", "-c", f"safe.directory={root}", "-C", str(root), *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()
    dirty = git("status", "--porcelain", "--untracked-files=no") != ""
    return (git("rev-parse", "--short=12", "HEAD") or "unknown") + (", changed" if dirty else "")


def describe(root, build):
    """All of it as a dictionary of text and numbers."""
    cores = len(os.sched_getaffinity(0))
    memory = int(_first(r"MemTotal:\s*(\d+)", "/proc/meminfo", "0")) / 2 ** 20
    return {
        "processor": _processor(),
        "cores": cores,
        "memory_gib": round(memory, 1),
        "system": f"{platform.system()} {platform.release()}",
        "compiler": _compiler(build),
        "build": _first(r"CMAKE_BUILD_TYPE:STRING=(.*)", build / "CMakeCache.txt"),
        "commit": commit_of(root),
        "load": round(os.getloadavg()[0], 2),
    }


def line(info):
    """The same as one line."""
    return (f"{info['processor']}, {info['cores']} cores, {info['memory_gib']} GiB, "
            f"{info['system']}; {info['compiler']}, {info['build']}; commit {info['commit']}; "
            f"load {info['load']} at the start")
