# SPDX-License-Identifier: Apache-2.0
"""What a processor's ports allow the shading kernels, and how much of that they reach.

perf samples which loops of nacre_bench run, objdump gives their instructions, llvm-mca the cycles
that the busiest port needs for one turn when nothing waits for anything. The clock is measured: a
chain of multiplications takes three cycles each. Without perf and llvm-mca, both of Debian's
packages linux-perf and llvm, there is no such column.
"""
import bisect
import collections
import itertools
import pathlib
import re
import shutil
import subprocess
import tempfile

# llvm 14's newest model of a processor with AVX-512 whose ports are like those of its successors.
PROCESSOR = "icelake-server"
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


def available():
    return all(shutil.which(tool) for tool in ("perf", "llvm-mca", "objdump"))


def _output(command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


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


def _cycles(instructions):
    """Of the busiest port, a turn."""
    with tempfile.NamedTemporaryFile("w", suffix=".s") as file:
        file.write("\n".join(instructions) + "\n")
        file.flush()
        text = _output(["llvm-mca", f"-mcpu={PROCESSOR}", "-iterations=2", file.name])
    return float(re.search(r"Block RThroughput:\s+([\d.]+)", text)[1])


def cycles_a_hit(program, code, benchmark, target):
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
    return sum(_cycles(loop) for loop in loops) / _HITS_A_TURN[target] if loops else None


def measure(program, benchmarks, target):
    """{benchmark: least ns a hit} of the shading kernels for a target, at the measured clock."""
    hertz = benchmarks["machine/multiply_chain"]["counters"]["cycles"]
    code = disassemble(program)
    found = {}
    for name in benchmarks:
        parts = name.split("/")
        if parts[0] == "shade" and len(parts) == 3 and parts[2] == target:
            cycles = cycles_a_hit(program, code, name, target)
            if cycles:
                found[name] = 1e9 * cycles / hertz
    return found
