# SPDX-License-Identifier: Apache-2.0
"""A Slurm cluster of one node on this machine, for a test: munge, a controller and a node with a
configuration and ports of their own, all in one folder."""
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import time

PROGRAMS = ('munged', 'slurmctld', 'slurmd', 'sbatch', 'squeue')

# Nothing is confined or accounted: no control groups, which containers often lack.
CONFIGURATION = '''
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=5,bf_interval=5
ReturnToService=2
MinJobAge=300
MaxArraySize={max_array_size}
JobRequeue=1
NodeName=node NodeHostname={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=node Default=YES MaxTime=INFINITE State=UP
'''


def missing_programs():
    path = os.environ.get('PATH', '') + ':/usr/sbin:/sbin'
    return [name for name in PROGRAMS if shutil.which(name, path=path) is None]


def skip_unless_possible():
    """Ends the process, with a reason, where no cluster can be started: with code 77, which ctest
    counts as skipped, or with 1 where nothing may be skipped."""
    missing = missing_programs()
    if missing or os.geteuid() != 0:
        print(f'skipped: needs root and Slurm; not here: {", ".join(missing) or "root"}\n'
              '  hint: scripts/setup --ci')
        sys.exit(1 if os.environ.get('NACRE_SKIP_NOTHING') else 77)


def free_port():
    with socket.socket() as probe:
        probe.bind(('127.0.0.1', 0))
        return probe.getsockname()[1]


class Cluster:
    def __init__(self, folder, max_array_size=1001):
        self.folder = pathlib.Path(folder)
        self.daemons = []
        for name in 'state', 'spool':
            (self.folder / name).mkdir()
        config = self.folder / 'slurm.conf'
        config.write_text(CONFIGURATION.format(
            folder=self.folder, host=socket.gethostname().split('.')[0], cpus=os.cpu_count(),
            controller_port=free_port(), node_port=free_port(), max_array_size=max_array_size))
        (self.folder / 'cgroup.conf').write_text('CgroupPlugin=cgroup/v1\nCgroupAutomount=no\n')
        self.environment = dict(os.environ, SLURM_CONF=str(config),
                                PATH=os.environ.get('PATH', '') + ':/usr/sbin:/sbin')

    def start(self):
        key = self.folder / 'munge.key'
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        # --force: the folder above is /tmp, which others may write to.
        self.run_daemon('munged', '--foreground', '--force', f'--key-file={key}',
                        *(f'--{what}-file={self.folder}/munge.{what}'
                          for what in ('pid', 'log', 'seed')), f'--socket={self.folder}/munge.socket')
        self.wait_for(lambda: (self.folder / 'munge.socket').exists(), 'munge')
        self.run_daemon('slurmctld', '-D', '-c')
        self.run_daemon('slurmd', '-D', '-N', 'node')
        self.wait_for(lambda: 'idle' in self.run('sinfo', '--noheader', '--format=%T').stdout,
                      'an idle node')

    def run_daemon(self, name, *arguments):
        out = open(self.folder / f'{name}.out', 'w')
        self.daemons.append(subprocess.Popen([name, *arguments], env=self.environment, stdout=out,
                                             stderr=out, stdin=subprocess.DEVNULL))
        out.close()

    def run(self, *command, **options):
        return subprocess.run([str(word) for word in command], env=self.environment,
                              capture_output=True, text=True, check=False, timeout=300, **options)

    def wait_for(self, condition, what, seconds=60):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end or any(d.poll() is not None for d in self.daemons):
                raise RuntimeError(f'no {what}:\n' + self.logs())
            time.sleep(0.1)

    def logs(self):
        return '\n'.join(f'{path.name}:\n{path.read_text()[-2000:]}'
                         for pattern in ('*.out', '*.log') for path in self.folder.glob(pattern))

    def stop(self):
        self.run('scancel', '--user=root')
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
