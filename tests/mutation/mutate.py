#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plants the faults of tests/mutation/faults/ one at a time and runs the tests on each; or, of each
FILE in src/, slips: other operators and constants (slips.py).

A fault that no test sees has SURVIVED: a test is missing. Works on a copy of the tree, in one build
folder; only the programs of the tests that a fault names are built. A run without a fault comes
first and must pass; with each fault the fast cases of a test run before the whole of it.

Two runs can go side by side, each in a folder of its own:
`--part 1/2 --build build-mutation-1` and `--part 2/2 --build build-mutation-2`. With `--targets sse4`
less is compiled and tested for each fault: try what survives again without it, as some faults are
in code of other targets.

Exit code: 0 every fault was killed, 1 one survived or did not compile (of slips: survived), 2 no run
was possible.
"""
import argparse
import collections
import fcntl
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

import fault_list
import slips

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
# Of a test: what computes for longer, or waits for longer, hangs. The first is as long on a busy machine.
MOST_CPU_SECONDS, MOST_SECONDS = 600, 900
# Tests by unittest that pass --failfast on.
FAIL_FAST = ("cli_test.py", "tiles_test.py", "attack_test.py", "browser_test.py", "protocol_test.py")


class NoRun(Exception):
    """Something is wrong before the first fault."""


def list_files(root):
    """What is, or would be, in the repository."""
    listing = subprocess.run(
        ["git", "-c", f"safe.directory={root}", "-C", str(root), "ls-files", "-z", "--cached",
         "--others", "--exclude-standard"], capture_output=True, check=False)
    if listing.returncode != 0:
        raise NoRun(f"{root} is no git checkout: {os.fsdecode(listing.stderr).strip()}")
    names = {os.fsdecode(name) for name in listing.stdout.split(b"\0") if name}
    return sorted(name for name in names if (root / name).is_file())


def copy_tree(root, copy):
    """Makes `copy` equal; files that are so already keep their times, so that little is built."""
    names = list_files(root)
    for path in [path for path in copy.rglob("*") if path.is_file()]:
        if path.relative_to(copy).as_posix() not in names:
            path.unlink()
    for name in names:
        source, target = root / name, copy / name
        if target.is_file() and target.read_bytes() == source.read_bytes():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)
        shutil.copymode(source, target)


class Workshop:
    """The copy of the tree and its build folder."""

    def __init__(self, folder, jobs, targets):
        self.tree, self.build, self.jobs = folder / "tree", folder / "build", jobs
        self.log = folder / "log.txt"
        self.targets = targets
        self.lock = None  # held while the program runs
        self.fast = {}  # by test: files with the names of its fast cases, which tell most faults

    def prepare(self):
        self.tree.mkdir(parents=True, exist_ok=True)
        self.lock = self.log.with_name("lock").open("w")
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise NoRun(f"another run works in {self.tree.parent}") from error
        self.log.write_text("")
        copy_tree(ROOT, self.tree)
        # -O2: tests that render are slow at -O1. No -Werror: that a fault leaves a variable unused is
        # no reason not to run it.
        options = ["-DNACRE_BENCH=OFF", "-DNACRE_WERROR=OFF", "-DCMAKE_CXX_FLAGS_RELEASE=-O2",
                   f"-DNACRE_TARGETS={self.targets}" if self.targets else "-UNACRE_TARGETS"]
        if shutil.which("ccache"):  # most of what is built again is what was there before a fault
            options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
        if not self.run(["cmake", "-S", self.tree, "-B", self.build, "-G", "Ninja", *options])[0]:
            raise NoRun(f"cmake failed, see {self.log}")

    def run(self, command, is_test=False):
        """Whether it succeeded, and what it printed."""
        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (MOST_CPU_SECONDS, MOST_CPU_SECONDS + 5))

        try:
            result = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, text=True, errors="replace",
                                    cwd=self.tree, check=False,
                                    **({"timeout": MOST_SECONDS, "preexec_fn": limit} if is_test else {}))
        except subprocess.TimeoutExpired:
            return False, "took too long"
        with self.log.open("a") as log:
            log.write(f"$ {' '.join(map(str, command))}\n{result.stdout}\n")
        if result.returncode == -signal.SIGXCPU:
            return False, "took too long"
        return result.returncode == 0, result.stdout

    def compile(self, tests):
        targets = {fault_list.OTHER_TESTS.get(test, f"nacre_{test}_test") for test in tests}
        names = sorted({name for target in targets for name in (target or "").split()})
        return not names or self.run(["ninja", "-C", self.build, f"-j{self.jobs}", *names])[0]

    def commands(self, test):
        """What ctest runs for a test, the quick comparison with a table first, up to the first
        failure."""
        listing = self.run(["ctest", "--test-dir", self.build, "-R", f"^{test}(_table|_long)?$",
                            "--show-only=json-v1"])[1]
        commands = [entry["command"] for entry in json.loads(listing)["tests"]]
        if not commands:
            raise NoRun(f"ctest knows no test {test}")
        fast = []
        for command in commands:
            if command[0].endswith("_test"):
                if test in self.fast and not {"[table]", "[long]"} & set(command):
                    fast += [[command[0], "--abort", "--input-file", names] for names in self.fast[test]]
                command += ["--abort", "--durations", "yes"]
            elif "pytest" in command:
                command.append("-x")
            elif command[1].endswith(FAIL_FAST):
                command.append("--failfast")
        return commands[:0:-1] + fast + commands[:1]

    def list_fast(self, test, program, output):
        """Lists the fastest cases of a test that passed: those that took a fiftieth of its time, nine
        tenths of the cases of render; then of the others up to a sixth, and up to a half."""
        names = set(self.run([program, "--list-test-names-only"])[1].splitlines())
        found = re.findall(r"^([0-9.]+) s: (.*)$", output, re.MULTILINE)
        seconds = sorted((float(time), name) for time, name in found if name in names)
        whole, passed = sum(time for time, _ in seconds), 0
        lists = ([], [], [])
        for time, name in seconds:
            passed += time
            if passed < whole / 2:
                lists[(passed >= whole / 50) + (passed >= whole / 6)].append(name)
        self.fast[test] = []
        for number, chosen in enumerate(lists):
            if chosen:
                file = self.log.with_name(f"fast_{test}_{number}.txt")
                escaped = "\n".join(chosen).replace(",", "\\,")  # Catch2 takes a list at each comma
                file.write_text(escaped + "\n", encoding="utf-8")
                self.fast[test].append(file)

    def failing_case(self, test):
        """The first case of a test that fails, or None."""
        for command in self.commands(test):
            passes, output = self.run(command, is_test=True)
            if not passes:
                return first_failure(output)
            if test not in self.fast and command[0].endswith("_test") and "[table]" not in command:
                self.list_fast(test, command[0], output)
        return None

    def put(self, contents):
        for name, content in contents.items():
            (self.tree / name).write_text(content, encoding="utf-8")


def first_failure(output):
    """The first case that a test's output tells to have failed."""
    # Catch2 names cases that only warn, too.
    named = re.findall(r"^-{70,}\n(\S.*)\n(?: .*\n)*-{70,}\n", output.partition("FAILED:")[0],
                       re.MULTILINE)
    if named:
        return named[-1]
    for pattern in (r"^FAILED \S*::(\S+)", r"^(?:FAIL|ERROR): (\S+)", r"^(\S+) +(?:FAIL|ERROR)\b", r"(took too long)"):
        found = re.search(pattern, output, re.MULTILINE)
        if found:
            return found[1]
    return "failed"


def try_fault(workshop, fault):
    """(how it ended, by which test)."""
    contents = fault_list.plant(fault, ROOT)
    originals = {name: (ROOT / name).read_text(encoding="utf-8") for name in contents}
    try:
        workshop.put(contents)
        for test in fault.tests:  # each is built only if those before it pass
            if not workshop.compile([test]):
                return "did not compile", ""
            case = workshop.failing_case(test)
            if case:
                return "killed", f"{test}: {case}"
        return "SURVIVED", ""
    finally:
        workshop.put(originals)


def slips_of_file(file, most):
    path = pathlib.Path(file).resolve()
    if not path.is_file() or not path.is_relative_to(ROOT / "src"):
        raise NoRun(f"{file}: no file of {ROOT / 'src'}")
    return slips.slips_of(path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8"), most)


def run_all(workshop, chosen):
    """Prints the table; true if every fault was killed."""
    tests = sorted({test for fault in chosen for test in fault.tests})
    print(f"without a fault: {' '.join(tests)}", flush=True)
    workshop.prepare()
    if not workshop.compile(tests):
        raise NoRun(f"the tree does not compile without a fault, see {workshop.log}")
    for test in tests:
        case = workshop.failing_case(test)
        if case:
            raise NoRun(f"a test fails without a fault: {test}: {case}")
    counts = collections.Counter()
    begin = time.monotonic()
    for number, fault in enumerate(chosen, 1):
        start = time.monotonic()
        outcome, killer = try_fault(workshop, fault)
        counts[outcome] += 1
        print(f"{number:3}/{len(chosen)} {time.monotonic() - start:5.1f} s  {fault.name:32} "
              f"{outcome}{' by ' + killer if killer else ''}", flush=True)
    told = ", ".join(f"{counts[o]} {o}" for o in ("killed", "SURVIVED", "did not compile"))
    print(f"{len(chosen)} faults in {(time.monotonic() - begin) / 60:.1f} min: {told}")
    # A slip that does not compile is the compiler's find.
    return counts["killed"] == len(chosen) or all(f.why == slips.WHY for f in chosen) and not counts["SURVIVED"]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", metavar="FILE", nargs="*", help="files of src/: slips of these, not the list")
    parser.add_argument("--most", type=int, default=30, metavar="N", help="slips of each file; default: 30")
    parser.add_argument("--only", metavar="PATTERN", default="",
                        help="faults whose name or files match this regular expression")
    parser.add_argument("--list", action="store_true", help="print the faults, and build nothing")
    parser.add_argument("--check", action="store_true",
                        help="only check that every fault's text occurs exactly once in the tree")
    parser.add_argument("--part", metavar="I/N", default="1/1", help="every N-th of the faults, from the I-th")
    parser.add_argument("--targets", default="", help="SIMD targets to build, as NACRE_TARGETS has them; default: all")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compilers at once")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build-mutation",
                        help="folder for the copy and its build")
    arguments = parser.parse_args()
    try:
        faults = [slip for file in arguments.files for slip in slips_of_file(file, arguments.most)]
        faults = faults or fault_list.read_list(HERE / "faults")
        mistakes = fault_list.check(faults, ROOT)
        if mistakes:
            raise NoRun("\n".join(mistakes))
        chosen = [fault for fault in faults if any(
            re.search(arguments.only, text) for text in
            [fault.name, *(part.path for part in fault.parts)])]
        part, parts = map(int, arguments.part.split("/"))
        chosen = chosen[part - 1::parts]
        if not chosen:
            raise NoRun("no fault is chosen")
        if arguments.list:
            for fault in chosen:
                print(f"{fault.name} ({', '.join(part.path for part in fault.parts)}): {fault.why}")
            return 0
        if arguments.check:
            print(f"{len(faults)} faults, each found once in the tree")
            return 0
        return 0 if run_all(Workshop(arguments.build.resolve(), arguments.jobs, arguments.targets), chosen) else 1
    except (NoRun, fault_list.ListError) as error:
        print(error, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
