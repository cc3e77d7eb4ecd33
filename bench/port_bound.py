# SPDX-License-Identifier: Apache-2.0
"""What a processor's ports allow the shading kernels and the exact hits of a sphere, and how much
of that they reach.

perf samples which loops of nacre_bench run, objdump gives their instructions, llvm-mca the ports
that each can go to; the busiest ports are those that any assignment must load most. The clock is
measured: a chain of multiplications takes three cycles each, and under vectors, where many
processors run slower, whole products start a whole number of times a cycle. Without perf and
llvm-mca, of Debian's packages linux-perf and llvm-19, there is no such column. An llvm that does
not know this processor, as Debian 12's 14 does not know Zen 4 and as none knows the Xeons that
multiply two vectors of 512 bits a cycle by their own names, counts for one that does as many
products a cycle as are measured: the tables say for which.
"""
import bisect
import collections
import itertools
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import tempfile

# The processors to count for: the first one whose model agrees with what is measured of this one.
_PROCESSORS = ("native", "icelake-server", "skylake-avx512")
_PRODUCT = "vmulps %{0}0, %{0}1, %{0}2\n"
_LOAD_AND_STORE = "vmovups (%rdi), %xmm0\nvmovups %xmm0, (%rdi)\n"
_AGREE = 1.5  # the models say one or two products a cycle; measured ones miss their number by a tenth
# Hits of a packet: a vector of floats.
_HITS = {"avx3": 16, "avx2": 8, "sse4": 4}
# Rays of a vector of doubles, which a turn of the loops over exact rays takes.
_RAYS = {"avx3": 8, "avx2": 4, "sse4": 2}
# Those loops, of src/visibility/single_sphere-inl.h, and where they are measured.
_EXACT = re.compile(r"TestRays|AppendBlock")
EXACT_HITS = "visibility/tiles/grid"
_REGISTERS = {"avx3": "zmm", "avx2": "ymm", "sse4": "xmm"}
_LEAST_VECTORS = 8  # instructions on these, in a loop over hits
_SECONDS = 2  # long enough for what prepares a benchmark to be below _LEAST_SHARE
_LEAST_SHARE = 0.01  # of the samples, of a loop that counts
# Of the samples an instruction of most of its loop, those of a basic block that a turn takes.
_LEAST_DENSITY = 0.25
_LONGEST_LOOP = 1000  # instructions; longer ones are loops over loops
_JUMP = re.compile(r"j\w+\s+([0-9a-f]+)")
# Jumps, padding, and copies between registers, which are renamed and go to no port.
NOT_COUNTED = re.compile(r"(j|call|ret|nop|data16|cs nop|xchg|v?mov(ap[sd]|dqa\d*)?\s+%\w+,%\w+$)")


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


def most_loaded(instructions):
    """Cycles a turn that some set of ports cannot do with less: the work that has nowhere else to
    go, shared evenly. `instructions`: {port: cycles} of each."""
    work = collections.Counter()
    for ports in instructions:
        if ports:
            work[frozenset(ports)] += sum(ports.values())
    sets = set()
    for ports in work:
        sets |= {ports | other for other in sets} | {ports}
    return max((sum(work[ports] for ports in work if ports <= group) / len(group)
                for group in sets), default=0)


def vector_clock(products, hertz):
    """The clock under vectors of which so many products a second start; `hertz` without them."""
    return min(hertz, products / max(1, round(products / hertz)))


class PortModel:
    """What llvm-mca counts cycles with: program, processor; `name` tells which one that is."""

    def __init__(self, registers, products):
        """`products`: of these registers, that this processor starts in a cycle."""
        self._program = _newest_mca()
        off = {p: self._disagreement(p, registers, products) for p in _PROCESSORS}
        self._processor = next((p for p in _PROCESSORS if off[p] < _AGREE), min(off, key=off.get))
        version = _output([self._program, "--version"])
        host = re.search(r"Host CPU:\s+(\S+)", version)
        number = re.search(r"version (\d+)", version)
        known = host[1] if self._processor == "native" and host else self._processor
        self._beside = frozenset().union(*self._port_table(_LOAD_AND_STORE))
        self.name = f"llvm-mca {number[1]} for {known}"

    def _run(self, processor, instructions, *options):
        return _output([self._program, f"-mcpu={processor}", "-iterations=2", *options],
                       instructions)

    def _disagreement(self, processor, registers, products):
        """How many times more or fewer products a cycle the model says than are measured."""
        try:
            ratio = products * self._block(processor, _PRODUCT.format(registers))
            return max(ratio, 1 / ratio)
        except subprocess.CalledProcessError:
            return math.inf

    def _block(self, processor, instructions):
        found = re.search(r"Block RThroughput:\s+([\d.]+)", self._run(processor, instructions))
        return float(found[1]) if found else math.inf

    def _port_table(self, instructions):
        """{port: cycles} of each instruction. Dividers, which work beside the port that feeds them,
        are left to llvm-mca's own number."""
        text = self._run(self._processor, instructions, "-instruction-tables",
                         "-instruction-info=0")
        names = re.findall(r"^\[([\d.]+)\]\s+- (\S+)$", text, re.MULTILINE)
        rows = text.split("Resource pressure by instruction:")[1].splitlines()[2:]
        for row in rows:
            cells = row.split()[:len(names)]
            if len(cells) == len(names):
                yield {number: float(cell) for (number, name), cell in zip(names, cells)
                       if cell != "-" and "Divider" not in name}

    def cycles(self, instructions):
        """Of the busiest ports, a turn. llvm-mca's own number looks at each port and at each group
        of ports that an instruction may choose from by itself; here they are taken together, but
        for those of loads and stores, which an instruction takes beside others, not instead."""
        text = "\n".join(instructions) + "\n"
        table = [{port: cycles for port, cycles in row.items() if port not in self._beside}
                 for row in self._port_table(text)]
        return max(self._block(self._processor, text), most_loaded(table))


def disassemble(program):
    """[(address, instruction)] of the whole program, and [(address, name)] of its functions."""
    found, functions = [], []
    for line in _output(["objdump", "-d", "--no-show-raw-insn", str(program)]).splitlines():
        match = re.match(r"\s+([0-9a-f]+):\s+(.*)", line)
        name = re.match(r"([0-9a-f]+) <(.*)>:", line)
        if match:
            found.append((int(match[1], 16), match[2].split("#")[0].strip()))
        elif name:
            functions.append((int(name[1], 16), name[2]))
    return found, functions


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
    """The instructions of the basic blocks in which the loop was seen: as often as the one that its
    middle instruction lies in, by how often they were seen. A mean would be that of the few
    instructions that most of the time is waited at."""
    starts = {begin}
    for i in range(begin, end + 1):
        jump = _JUMP.match(code[i][1])
        if jump:
            starts.add(i + 1)
            starts.add(bisect.bisect_left(code, (int(jump[1], 16), "")))
    edges = sorted(i for i in starts if begin <= i <= end) + [end + 1]
    def seen(first, last):
        return sum(samples[address] for address, _ in code[first:last]) / (last - first)
    blocks = list(zip(edges, edges[1:]))
    typical = statistics.median(
        itertools.chain.from_iterable([seen(*block)] * (block[1] - block[0]) for block in blocks))
    for first, last in blocks:
        if seen(first, last) > _LEAST_DENSITY * typical:
            yield from (text for _, text in code[first:last] if not NOT_COUNTED.match(text))


def turns_a_hit(function, target):
    """How many turns a hit takes of a loop in this function."""
    if _EXACT.search(function):
        return 1 / _RAYS[target]
    return 1 / _HITS[target]


def cycles_a_hit(model, program, disassembly, benchmark, target, only=""):
    """Least cycles a hit of all its loops together, or None where no loop was seen. `only`: the
    functions that count."""
    code, functions = disassembly
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
    found = 0
    for begin, end in _innermost(spans):
        loop = list(_taken(code, begin, end, samples))
        if sum(_REGISTERS[target] in text for text in loop) < _LEAST_VECTORS:
            continue
        function = functions[bisect.bisect_right(functions, (code[begin][0], "~")) - 1][1]
        if not re.search(only, function):
            continue
        found += model.cycles(loop) * turns_a_hit(function, target)
    return found or None


def measure(program, benchmarks, target):
    """({benchmark: least ns a hit} of the shading kernels for a target and of exact hits, at the
    measured clock; the model's name)."""
    hertz = benchmarks["machine/multiply_chain"]["counters"]["cycles"]
    products = benchmarks["machine/products"]["counters"]["products"]
    model = PortModel(_REGISTERS[target], products / hertz)
    disassembly = disassemble(program)
    clock = vector_clock(products, hertz)
    found = {}
    if EXACT_HITS in benchmarks:
        cycles = cycles_a_hit(model, program, disassembly, EXACT_HITS, target, only=_EXACT)
        if cycles:
            found[EXACT_HITS] = 1e9 * cycles / clock
    for name in benchmarks:
        parts = name.split("/")
        if parts[0] == "shade" and len(parts) == 3 and parts[2] == target:
            cycles = cycles_a_hit(model, program, disassembly, name, target)
            if cycles:
                found[name] = 1e9 * cycles / clock
    return found, model.name
