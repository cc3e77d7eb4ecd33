#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/farm_local --measure on a Slurm of one node that is started for it.

Usage: measure_on_slurm.py PROGRAM SOURCE_FOLDER
"""
import os
import subprocess
import sys
import tempfile

import cluster

PROGRAM, SOURCE = (os.path.abspath(word) for word in sys.argv[1:3])

cluster.skip_unless_possible()
with tempfile.TemporaryDirectory(prefix='nacre_slurm_') as folder:
    slurm = cluster.Cluster(folder)
    try:
        slurm.start()
        sys.exit(subprocess.run(
            [SOURCE + '/scripts/farm_local', SOURCE + '/scenes/material_grid.json', '--measure',
             '--tiles', '64', '--size', '3840x2160', '--spp', '256', '--nacre', PROGRAM],
            env=slurm.environment, check=False).returncode)
    finally:
        slurm.stop()
