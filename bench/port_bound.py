# SPDX-License-Identifier: Apache-2.0
"""What a processor's ports allow the shading kernels, and how much of that they reach.

perf samples which loops of nacre_bench run, objdump gives their instructions, llvm-mca the cycles
that the busiest port needs for one turn when nothing waits for anything. The clock is measured: a
chain of multiplications takes three cycles each. Without perf and llvm-mca, of Debian's packages
linux-perf and llvm-19, there is no such column. An llvm that does not know this processor, as
Debian 12's 14 does not know Zen 4, counts for another one: the tables say for which.
"""
import bisect
import collections
import itertools
import os
import pathlib
import re
import shutil
import subprocess
import tempfile

# The processors to count for: the first one whose model has vectors of 512 bits, if this one has.
_PROCESSORS = ("native", "icelake-server")
_WIDE = "vaddps %zmm0, %zmm1, %zmm2\n"
# Hits that a loop's turn shades: ShadeTag of src/base/target_ops-inl.h.
_HITS_A_TURN = {"avx3": 32, "avx2": 8, "sse4": 4}
_REGISTERS = {"avx3": "zmm", "avx2": "ymm", "sse4": "xmm"}
_LEAST_VECTORS = 8  # instructions on these, in a loop over hits
_SECONDS = 0.6
_LEAST_SHARE = 0.01  # of the samples, of a loop that counts
_LEAST_DENSITY = 0.1  # of its loop's samples an instruction, of a basic block that a turn takes
_LONGEST_LOOP = 1000  # instructions; longer ones are loops over loops
_JUMP = re.compile(r"j\w+\s+([0-9a-f]+)")
_NOT_COUNTED = re.compile(r"(j|call|ret|nop|data16|cs nop|xchg)")


def _newest_mca():
    """The path of llvm-mca, of the newest llvm that is installed; None without any."""
    found = [pathlib.Path(folder, name) for folder in os.get_exec_path() if os.path.isdir(folder)
             for name in os.listdir(folder) if re.fullmatch(r"llvm-mca(-\d+)?", name)]
    return max(found, key=lambda path: int((re.findall(r"\d+", path.name) or [0])[0]),
               default=None)


def available():
    return bool(_newest_mca()) and all(shutil.which(tool) for tool in ("perf", "objdump"))


def _output(command, text=None):
    return subprocess.run(command, input=text, capture_output=True, text=True, check=True).stdout


class PortModel:
    """What llvm-mca counts cycles with: program, processor; `name` tells which one that is."""

    def __init__(self, wide):
        self._program = _newest_mca()
        self._processor = next(p for p in _PROCESSORS if not wide or self._knows_wide(p))
        version = _output([self._program, "--version"])
        host = re.search(r"Host CPU:\s+(\S+)", version)
        number = re.search(r"version (\d+)", version)
        known = host[1] if self._processor == "native" and host else self._processor
        self.name = f"llvm-mca {number[1]} for {known}"

    def _run(self, processor, instructions):
        return _output([self._program, f"-mcpu={processor}", "-iterations=2"], instructions)

    def _knows_wide(self, processor):
        try:
            return "Block RThroughput" in self._run(processor, _WIDE)
        except subprocess.CalledProcessError:
            return False

    def cycles(self, instructions):
        """Of the busiest port, a turn."""
        text = self._run(self._processor, "\n".join(instructions) + "\n")
        return float(re.search(r"Block RThroughput:\s+([\d.]+)", text)[1])


def disassemble(program):
    """[(address, instruction)] of the whole program."""
    found = []
    for line in _output(["objdump", "-d", "--no-show-raw-insn", str(program)]).splitlines():
        match = re.match(r"\s+([0-9a-f]+):\s+(.*)", line)
        if match:
            found.append((int(match[1], 16), match[2].split("#")[0].strip()))
    return found


def _sample(program, benchmark):
    """Counter of the addresses, as the disassembly has them, at which the benchmark was seen."""
    with tempfile.TemporaryDirectory(prefix="nacre_perf.") as folder:
        data = pathlib.Path(folder) / "perf.data"
        subprocess.run(["perf", "record", "-o", data, "-e", "cpu-clock", program,
                        f"--benchmark_filter=^{benchmark}$", f"--benchmark_min_time={_SECONDS}"],
                       capture_output=True, check=True)
        maps = _output(["perf", "script", "-i", str(data), "--show-mmap-events"])
        name = re.escape(pathlib.Path(program).name)
        mapped = re.search(rf"\[0x([0-9a-f]+)\(0x[0-9a-f]+\) @ (0x[0-9a-f]+|0) .*r-xp.*{name}", maps)
        if not mapped:
            return collections.Counter()
        base = int(mapped[1], 16) - int(mapped[2], 16)
        samples = _output(["perf", "script", "-i", str(data), "-F", "ip,dso"])
    return collections.Counter(int(line.split()[0], 16) - base for line in samples.splitlines()
                               if pathlib.Path(program).name in line)


def _innermost(spans):
    """Loops that hold no other; those that overlap are one loop with several ways through."""
    merged = []
    for begin, end in sorted(set(spans), key=lambda span: span[1] - span[0]):
        if any(begin <= b and e <= end for b, e in merged):
            continue
        for other in [(b, e) for b, e in merged if begin <= e and b <= end]:
            merged.remove(other)
            begin, end = min(begin, other[0]), max(end, other[1])
        merged.append((begin, end))
    return merged


def _taken(code, begin, end, samples):
    """The instructions of the basic blocks in which the loop was seen."""
    starts = {begin}
    for i in range(begin, end + 1):
        jump = _JUMP.match(code[i][1])
        if jump:
            starts.add(i + 1)
            starts.add(bisect.bisect_left(code, (int(jump[1], 16), "")))
    edges = sorted(i for i in starts if begin <= i <= end) + [end + 1]
    def seen(first, last):
        return sum(samples[address] for address, _ in code[first:last]) / (last - first)
    least = _LEAST_DENSITY * seen(begin, end + 1)
    for first, last in zip(edges, edges[1:]):
        if seen(first, last) > least:
            yield from (text for _, text in code[first:last] if not _NOT_COUNTED.match(text))


def cycles_a_hit(model, program, code, benchmark, target):
    """Least cycles a hit of all its loops together, or None where no loop was seen."""
    samples = _sample(program, benchmark)
    total = sum(samples.values())
    before = [0, *itertools.accumulate(samples[address] for address, _ in code)]
    spans = []
    for i, (address, text) in enumerate(code):
        jump = _JUMP.match(text)
        to = int(jump[1], 16) if jump else address
        if to < address:
            first = bisect.bisect_left(code, (to, ""))
            seen = before[i + 1] - before[first]
            if i - first < _LONGEST_LOOP and seen > _LEAST_SHARE * total:
                spans.append((first, i))
    loops = [list(_taken(code, begin, end, samples)) for begin, end in _innermost(spans)]
    loops = [loop for loop in loops
             if sum(_REGISTERS[target] in text for text in loop) >= _LEAST_VECTORS]
    return sum(model.cycles(loop) for loop in loops) / _HITS_A_TURN[target] if loops else None


def measure(program, benchmarks, target):
    """({benchmark: least ns a hit} of the shading kernels for a target, at the measured clock; the
    model's name)."""
    hertz = benchmarks["machine/multiply_chain"]["counters"]["cycles"]
    model = PortModel(wide=target == "avx3")
    code = disassemble(program)
    found = {}
    for name in benchmarks:
        parts = name.split("/")
        if parts[0] == "shade" and len(parts) == 3 and parts[2] == target:
            cycles = cycles_a_hit(model, program, code, name, target)
            if cycles:
                found[name] = 1e9 * cycles / hertz
    return found, model.name
