# SPDX-License-Identifier: Apache-2.0
"""All sizes of a run: how often, how large, how far. `--quick` takes the small end of each."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Settings:
    # Google Benchmark: repetitions of each benchmark in random order, and seconds of each. Many short
    # ones: a shared machine is fast for some seconds and slow for others, and the median of few
    # repetitions falls now among these, now among those.
    repetitions: int = 27
    min_time: float = 0.03
    port_bounds: bool = True  # seconds a kernel, and their tools need not be there
    # Rounds of whole processes; every round runs each case once.
    process_rounds: int = 15
    slow_process_rounds: int = 5  # of those that take a second or more
    # Scaling, on one thread: what grows, and how often each size is run.
    scaling_rounds: int = 3
    spheres: tuple = (25, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000)
    triangles: tuple = (100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000)
    lights: tuple = (1, 3, 10, 30, 100, 300, 1_000)
    sides: tuple = (256, 512, 1024, 2048, 4096, 8192)
    size: str = "1920x1080"  # of the frames that spheres, triangles and lights are counted in
    # Run time against error: sample counts, the truth's, and the tolerances of adaptive sampling.
    precision_size: str = "480x270"  # as in frame_bench.cc
    precision_spp: tuple = (1, 2, 4, 8, 16, 32, 64, 128, 256)
    precision_rounds: int = 7
    truth_spp: int = 16384
    max_errors: tuple = (0.03, 0.01, 0.003, 0.001, 0.0003)
    # Adaptive sampling against uniform at the same error, of so many seeds, in frames of `size`.
    adaptive_seeds: int = 4
    adaptive_spp: tuple = (4, 16, 64, 256, 1024, 4096)
    adaptive_max_errors: tuple = (0.1, 0.03, 0.01)
    # The same under lights that are sampled.
    lights_spp: tuple = (1, 4, 16, 32, 64, 256, 1024)
    lights_max_errors: tuple = (0.5, 0.3, 0.1, 0.03, 0.01)
    lights_truth_spp: int = 65536  # at most; fewer where the truth's error is below this
    lights_truth_error: float = 0.004
    # Other renderers, where installed: antialiasing depths of POV-Ray, samples of Blender.
    povray_depths: tuple = (1, 2, 3, 4, 5)
    povray_truth_depth: int = 9
    blender_spp: tuple = (1, 4, 16, 64)
    blender_truth_spp: int = 1024
    # Which benchmarks, as regular expressions of Google Benchmark; what one of them names is run in
    # random order.
    groups: tuple = ("^(shade|machine)/", "^access/", "^math/", "^visibility/", "^frame/.*/1920x1080/",
                     "^frame/.*/480x270/", "^nested/")


FULL = Settings()
QUICK = Settings(
    repetitions=15,
    min_time=0.005,
    port_bounds=False,
    process_rounds=7,
    slow_process_rounds=2,
    scaling_rounds=1,
    spheres=(25, 1_000, 10_000, 100_000, 1_000_000),
    triangles=(100, 1_000, 10_000, 100_000),
    lights=(1, 10, 100),
    sides=(256, 512, 1024, 2048),
    precision_spp=(1, 4, 16, 64),
    precision_rounds=3,
    truth_spp=4096,
    max_errors=(0.03, 0.01, 0.003),
    adaptive_seeds=2,
    adaptive_spp=(4, 16, 64, 256, 1024),
    adaptive_max_errors=(0.1, 0.03),
    lights_spp=(4, 16, 32, 64, 256),
    lights_max_errors=(0.5, 0.3, 0.1),
    lights_truth_spp=16384,
    lights_truth_error=0.02,
    povray_depths=(1, 2, 3),
    povray_truth_depth=7,
    blender_spp=(1, 4),
    blender_truth_spp=256,
    groups=("^(shade|machine)/", "^access/.*/avx[23]$", "^math/",
            "^visibility/", "^frame/[a-z_]+/1920x1080/1spp/(avx2|avx3.*)$"
            "|^frame/material_grid(_plain)?/1920x1080/16spp/",
            "^frame/material_grid/480x270/(1|4|16)spp/", "^nested/"),
)
# What the headline numbers are made of, and no more.
SUMMARY_GROUPS = ("^(shade|machine)/", "^math/ggx/0.3/", "^visibility/",
                  "^frame/material_grid[a-z_]*/1920x1080/")
