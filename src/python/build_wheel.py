# SPDX-License-Identifier: Apache-2.0
"""Builds the wheel of nacre: a PEP 517 backend that needs CMake and what scripts/setup installs, and
no network. `pip wheel --no-build-isolation --no-deps ./src/python`

The wheel holds the package with libnacre.so; the libraries of Debian that this needs are not in it.
Of an existing build: `--config-settings build-folder=build`.
"""
import base64
import hashlib
import os
import pathlib
import re
import shlex
import subprocess
import sys
import sysconfig
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
MODULE = f"_nacre{sysconfig.get_config_var('EXT_SUFFIX')}"


def _version():
    text = (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(nacre VERSION (\S+)", text)[1]


def _build(folder):
    subprocess.run(["cmake", "-S", SOURCE, "-B", folder, "-G", "Ninja", "--log-level=NOTICE",
                    "-DCMAKE_BUILD_TYPE=Release", "-DNACRE_TESTS=OFF", "-DNACRE_BENCH=OFF",
                    "-DNACRE_UNITY=ON", f"-DNACRE_PYTHON_EXECUTABLE={sys.executable}"], check=True)
    subprocess.run(["cmake", "--build", folder, "--target", "nacre_python"], check=True)


def _files(folder):
    """What the wheel's folder nacre/ holds, by name."""
    package = folder / "python/nacre"
    for path in sorted(package.iterdir()):
        if path.suffix in (".py", ".pyi") or path.name in (MODULE, "py.typed"):
            yield path.name, path
    yield "libnacre.so.0", folder / "libnacre.so.0"
    if (folder / "nacre_oiio.so").exists():
        yield "nacre_oiio.so", folder / "nacre_oiio.so"


def _metadata():
    return (f"Metadata-Version: 2.1\nName: nacre\nVersion: {_version()}\n"
            "Summary: Renders, measures and compares reflection models\n"
            "License: Apache-2.0\nRequires-Python: >=3.9\nRequires-Dist: numpy\n")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    del metadata_directory
    chosen = (config_settings or {}).get("build-folder")
    folder = SOURCE / (chosen or "build-wheel")
    if not chosen:
        _build(folder)
    if not (folder / "python/nacre" / MODULE).exists():
        # Ends the process that pip has started, without a traceback.
        where, python = shlex.quote(str(folder)), shlex.quote(sys.executable)
        sys.exit(f"error: {where} holds no package for {python}: cmake -DNACRE_PYTHON_EXECUTABLE={python} "
                 f"{where} && cmake --build {where} --target nacre_python")
    files = {f"nacre/{name}": path.read_bytes() for name, path in _files(folder)}
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"\W", "_", sysconfig.get_platform())
    tag = f"{python}-{python}-{platform}"
    info = f"nacre-{_version()}.dist-info"
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/LICENSE"] = (SOURCE / "LICENSE").read_bytes()
    files[f"{info}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: nacre\nRoot-Is-Purelib: false\n"
                              f"Tag: {tag}\n").encode()
    record = []
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record.append(f"{name},sha256={digest},{len(data)}")
    files[f"{info}/RECORD"] = ("\n".join(record + [f"{info}/RECORD,,"]) + "\n").encode()
    wheel = f"nacre-{_version()}-{tag}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name)  # of 1980: the same files make the same wheel
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    raise RuntimeError("nacre is passed on as a git repository: there is no source archive")
