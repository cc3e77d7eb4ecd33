# SPDX-License-Identifier: Apache-2.0
"""scripts/farm_measure.py: what farm_local --measure prints: the costs of tiles, merging and Slurm on
this machine, and what they grow to. It is imported, not run.

nacre is measured in seconds of a core (CPU time of the process, one thread), which other work on
this machine changes little; Slurm in wall time. Growth is arithmetic on these numbers:
nodes are taken to be like this machine, and nothing but what stands in the table to be shared.
"""
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import tempfile
import time

import farm

FRAMES = 1_000_000
NODES = (1, 10, 100, 1_000, 10_000)
JOBS = 64  # of the array that measures Slurm
RUNS = 5  # of what is short: the median counts


def run(command, **options):
    """(core seconds, wall seconds, peak MiB) of a command that must succeed."""
    start = time.monotonic()
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, **options)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        farm.fail(f'{command[0]} {command[1]}: exit code {process.returncode}')
    return usage.ru_utime + usage.ru_stime, time.monotonic() - start, usage.ru_maxrss / 1024


def median(command, which=0):
    return statistics.median(run(command)[which] for _ in range(RUNS))


def measure_tiles(picture, folder):
    """The costs of one frame and of its tiles, as a dictionary."""
    render = [picture.nacre, 'render', picture.scene, '--quiet', '--threads', '1', *picture.options]
    whole = folder / 'whole.exr'
    costs = {'startup': median([picture.nacre, '--version']),
             'fixed': median([*render, '-o', whole, '--dry-run']),
             'frame': run([*render, '-o', whole])[0],
             'frame_bytes': whole.stat().st_size}
    picture.folder = folder
    tiles = [run(picture.render_command(i, 1))[0] for i in range(picture.count)]
    files = [picture.tile(i) for i in range(picture.count)]
    costs.update(tile_times=tiles, tiles=sum(tiles), slowest=max(tiles),
                 tile_bytes=sum(file.stat().st_size for file in files))
    merge = [picture.nacre, 'merge', '--quiet', '-o', folder / 'merged.exr', *files]
    runs = [run(merge) for _ in range(RUNS)]
    costs['merge'] = statistics.median(core for core, _, _ in runs)
    costs['merge_mib'] = max(peak for _, _, peak in runs)
    return costs


def controller_seconds():
    """CPU time of Slurm's controller so far, or None if it is not on this machine."""
    config = slurm_says('scontrol', 'show', 'config') or ''
    found = re.search(r'SlurmctldPidFile\s*=\s*(\S+)', config)
    try:
        pid = pathlib.Path(found[1]).read_text().strip()
        times = pathlib.Path(f'/proc/{pid}/stat').read_text().rsplit(')', 1)[1].split()[11:13]
    except (TypeError, OSError):
        return None
    return sum(map(int, times)) / os.sysconf('SC_CLK_TCK')


def slurm_says(*command):
    """What a Slurm command prints, or None if there is no Slurm."""
    if not shutil.which(command[0]):
        return None
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    return result.stdout if result.returncode == 0 else None


def measure_slurm(folder):
    """Seconds of a submission; then of an array of jobs that do nothing: seconds until the first
    begins, how many begin per second, and what each takes of a core and of the controller."""
    total = slurm_says('sinfo', '--noheader', '--format=%C')
    if not total:
        return None
    cores = sum(int(line.split('/')[3]) for line in total.split())
    starts = folder / 'starts.txt'
    sbatch = ['sbatch', '--parsable', '--output=/dev/null', f'--chdir={folder}', '--ntasks=1',
              f'--job-name={folder.name}']
    submit = median([*sbatch, '--hold', '--wrap', 'true'], which=1)
    slurm_says('scancel', f'--name={folder.name}')
    before, now = controller_seconds(), time.time()
    run([*sbatch, f'--array=1-{JOBS}', '--wrap', f'date +%s.%N >> {starts}'])
    while not starts.is_file() or len(starts.read_text().split()) < JOBS:
        time.sleep(0.2)
    times = sorted(map(float, starts.read_text().split()))
    rate = (JOBS - 1) / (times[-1] - times[0])
    after = controller_seconds()
    return {'submit': submit, 'first': times[0] - now, 'rate': rate, 'cores': cores,
            'controller': None if before is None else (after - before) / JOBS}


def row(label, value, note=''):
    print(f'  {label:<38} {value:>12}  {note}'.rstrip())


def print_costs(costs, slurm, count):
    print('measured here')
    row('start of nacre', f'{1e3 * costs["startup"]:.1f} ms', 'core time')
    row('start, scene and plan: of every tile', f'{1e3 * costs["fixed"]:.1f} ms', 'core time')
    row('whole frame', f'{costs["frame"]:.3f} s', f'core time, {costs["frame_bytes"]} bytes')
    row(f'{count} tiles, together', f'{costs["tiles"]:.3f} s',
        f'core time, {costs["tile_bytes"]} bytes')
    row('slowest tile', f'{costs["slowest"]:.3f} s',
        f'{costs["slowest"] * count / costs["tiles"]:.1f} times the mean')
    row(f'merge of {count} tiles', f'{costs["merge"]:.3f} s',
        f'core time: {1e-6 * costs["frame_bytes"] / costs["merge"]:.0f} MB/s; '
        f'{costs["merge_mib"]:.0f} MiB of memory')
    if slurm is None:
        row('Slurm', 'not here')
        return
    row('sbatch returns after', f'{1e3 * slurm["submit"]:.0f} ms')
    row('the first job of an array begins after', f'{slurm["first"]:.2f} s')
    row('jobs of nothing that begin', f'{slurm["rate"]:.1f} /s',
        f'on {slurm["cores"]} cores: {slurm["cores"] / slurm["rate"]:.2f} s of a core each')
    if slurm['controller']:
        row('the controller, for each job', f'{1e3 * slurm["controller"]:.1f} ms',
            f'core time: at most {1 / slurm["controller"]:.0f} /s')


def slowest_of(count, times, fixed):
    """Seconds of the slowest of `count` tiles, from those of the tiles that were measured."""
    measured = len(times)
    if count > measured:
        return fixed + (max(times) - fixed) * measured / count
    bounds = [index * measured // count for index in range(count + 1)]
    return max(fixed + sum(time - fixed for time in times[first:end])
               for first, end in zip(bounds, bounds[1:]))


def print_one_frame(costs, slurm, most):
    """One frame sooner: tiles all at once, each on a core of its own."""
    print('\none frame, every tile on a core of its own')
    print('    tiles    seconds   of the time of the cores used')
    job = slurm['cores'] / slurm['rate'] if slurm else 0
    count = 1
    while True:
        merge = costs['merge'] + job if count > 1 else 0
        total = job + slowest_of(count, costs['tile_times'], costs['fixed']) + merge
        print(f'  {count:>7} {total:>10.2f}   {100 * costs["frame"] / (count * total):>6.1f} %')
        if count == most:
            return
        count = min(4 * count, most)


def print_many_frames(costs, slurm):
    cores = os.cpu_count() or 1
    frame, size = costs['frame'], costs['frame_bytes']
    most = 1 / slurm['controller'] if slurm and slurm['controller'] else None
    print(f'\n{FRAMES} frames, each by one core, on nodes of {cores} cores: '
          f'{1e-12 * FRAMES * size:.3g} TB in {FRAMES} files')
    print('    nodes       hours   frames/s   written GB/s'
          + ('   frames a job, for half the controller' if most else ''))
    for nodes in NODES:
        rate = nodes * cores / frame
        line = (f'  {nodes:>7} {FRAMES / rate / 3600:>11.2f} {rate:>10.2f} '
                f'{1e-9 * rate * size:>14.4f}')
        print(line + (f'   {math.ceil(rate / (0.5 * most)):>12}' if most else ''))
    if most:
        print(f'  With one frame a job the controller is full at {most * frame / cores:.0f} nodes.')
    if slurm:
        job = slurm['cores'] / slurm['rate']
        print(f'  Slurm takes {100 * job / (job + frame):.0f} % of a core with one frame a job, '
              f'{100 * job / (job + 100 * frame):.1f} % with 100.')


def print_tables(arguments, options):
    with tempfile.TemporaryDirectory(prefix='nacre_measure_') as name:
        folder = pathlib.Path(name)
        arguments.output = [str(folder / 'merged.exr')]
        picture = farm.Picture(arguments, options, 64)
        most = picture.dry_run()['most_tiles']
        costs = measure_tiles(picture, folder)
        slurm = measure_slurm(folder)
    print_costs(costs, slurm, picture.count)
    print_one_frame(costs, slurm, most)
    print_many_frames(costs, slurm)
