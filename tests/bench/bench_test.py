#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the arithmetic of scripts/bench: medians, intervals, ratios, fits, names. No clock here."""
import collections
import json
import pathlib
import random
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))

import adaptive
import estimates
import google
import lights
import plots
import port_bound
import precision
import readme
import report
import scaling
import summary
import waiting
import waiting_files


class Lights(unittest.TestCase):
    def test_time_to_an_error_lies_on_the_line_of_logarithms(self):
        points = [{"error": 0.1 / 2 ** i, "seconds": 4.0 ** i} for i in range(4)]
        self.assertAlmostEqual(estimates.seconds_to(points, 0.05), 4)
        self.assertAlmostEqual(estimates.seconds_to(points, 0.1 / 2 ** 1.5), 8)
        self.assertEqual(estimates.seconds_to(points, 0.2), 1)
        self.assertIsNone(estimates.seconds_to(points, 0.01))

    def test_error_is_that_of_the_spheres_pixels(self):
        # A quarter of the picture, of value 2, off by 0.1 everywhere; the rest is black.
        layers = {"A": {"mean_reference": 0.25},
                  "beauty": {"rmse": 0.1 * 0.5, "mean_reference": 0.5}}
        self.assertAlmostEqual(lights.relative_rmse(layers), 0.05)


class Adaptive(unittest.TestCase):
    def test_headlines_are_ratios_at_the_same_error(self):
        uniform = [{"error": 0.1 / 2 ** i, "relative_error": 0.2 / 4 ** i, "seconds": 4.0 ** i,
                    "camera_rays": 100 * 4 ** i} for i in range(3)]
        def point(error):
            return {"what": f"--max-error {error}", "error": error, "relative_error": error / 4,
                    "seconds": 2, "camera_rays": 40}
        found = dict(adaptive.headlines({"uniform": uniform, "adaptive": [point(0.05)]}))
        self.assertAlmostEqual(found["adaptive_0.05_over_uniform"], 2)
        self.assertAlmostEqual(found["adaptive_0.05_over_uniform_in_rays"], 10)
        self.assertAlmostEqual(found["adaptive_0.05_over_uniform_at_equal_relative_error"], 8)
        for beyond in (0.9, 0.01):  # uniform sampling was not measured there
            found = dict(adaptive.headlines({"uniform": uniform, "adaptive": [point(beyond)]}))
            self.assertEqual(set(found.values()), {None})


class Intervals(unittest.TestCase):
    def test_ranks_are_those_of_the_tables(self):
        # Conover, Practical Nonparametric Statistics: 95 % for n = 6 from 1st to 6th value, n = 10
        # from 2nd to 9th, n = 20 from 6th to 15th.
        for n, low, high in ((6, 1, 6), (10, 2, 9), (20, 6, 15)):
            self.assertEqual(estimates.median_interval(range(1, n + 1)), (low, high))

    def test_few_values_give_all_there_is(self):
        self.assertEqual(estimates.median_interval([3, 1]), (1, 3))
        self.assertEqual(estimates.median_interval([2]), (2, 2))

    def test_covers_the_median_as_often_as_it_says(self):
        draw = random.Random(4)
        covered = 0
        for _ in range(2000):
            low, high = estimates.median_interval([draw.expovariate(1) for _ in range(15)])
            covered += low <= 0.6931471805599453 <= high  # the median is log 2
        # n = 15 gives 96.5 %; six standard deviations of 2000 draws are 2.5 %.
        self.assertGreater(covered / 2000, 0.94)
        self.assertLess(covered / 2000, 0.99)


class Ratios(unittest.TestCase):
    def test_pairs_cancel_what_disturbs_both(self):
        disturbance = [1, 5, 2, 9, 1, 3, 7]
        old = [10.0 * d for d in disturbance]
        new = [10.5 * d for d in disturbance]
        for got in estimates.paired_ratio(new, old):
            self.assertAlmostEqual(got, 1.05)

    def test_lengths_must_agree(self):
        for numerators, denominators in (([1, 2], [1]), ([], [])):
            with self.assertRaises(ValueError):
                estimates.paired_ratio(numerators, denominators)

    def test_slower_needs_both_size_and_certainty(self):
        self.assertTrue(estimates.is_slower((1.05, 1.01, 1.09)))
        self.assertFalse(estimates.is_slower((1.05, 0.99, 1.2)))  # may be chance
        self.assertFalse(estimates.is_slower((1.02, 1.015, 1.025)))  # certain and small
        self.assertFalse(estimates.is_slower((0.9, 0.8, 0.95)))

    def test_a_slowdown_of_five_per_cent_is_seen_in_noise_of_five(self):
        draw = random.Random(1)

        def times(scale):
            return [scale * (1 + 0.05 * draw.random()) for _ in range(25)]
        self.assertTrue(estimates.is_slower(estimates.paired_ratio(times(1.05), times(1))))
        self.assertFalse(estimates.is_slower(estimates.paired_ratio(times(1), times(1))))


class Growth(unittest.TestCase):
    def test_a_power_is_found(self):
        sizes = [25, 1e3, 1e5, 1e7]
        exponent, factor = estimates.log_fit(sizes, [3 * n ** 0.75 for n in sizes])
        self.assertAlmostEqual(exponent, 0.75)
        self.assertAlmostEqual(factor, 3)

    def test_growth_is_that_of_the_last_decade(self):
        first = estimates.first_of_last_decade
        self.assertEqual(first([1, 3, 10, 30, 100]), 2)
        self.assertEqual(first([4 ** i for i in range(6)]), 4)
        self.assertEqual(first([1, 2, 4]), 0)
        self.assertEqual(first([1, 100, 10_000]), 1)  # a line needs two
        self.assertEqual(first([7]), 0)
        # What a frame costs without any spheres hides what they cost while they are few.
        points = [{"size": n, "frame_s": 1 + n ** 0.9, "process_s": 1, "mib": 10 + n}
                  for n in (1, 10, 100, 1e6, 1e7)]
        fits = scaling.fits(points)
        self.assertAlmostEqual(fits["frame_s"]["exponent"], 0.9, places=4)
        self.assertAlmostEqual(fits["mib"]["exponent"], 1, places=4)

    def test_a_cliff_is_the_steepest_step(self):
        steepest, begin, end = estimates.steepest_step([1, 10, 100, 1000], [1, 10, 1000, 10000])
        self.assertAlmostEqual(steepest, 2)
        self.assertEqual((begin, end), (10, 100))

    def test_one_point_is_no_curve(self):
        with self.assertRaises(ValueError):
            estimates.log_fit([1], [1])

    def test_fits_of_a_curve(self):
        points = [{"size": n, "frame_s": n * 1e-6, "process_s": 0.1, "mib": n ** 0.5}
                  for n in (10, 100, 1000)]
        found = scaling.fits(points)
        self.assertAlmostEqual(found["frame_s"]["exponent"], 1)
        self.assertAlmostEqual(found["process_s"]["exponent"], 0)
        self.assertAlmostEqual(found["mib"]["exponent"], 0.5)


def entry(name, number, time, **more):
    return {"run_name": name, "run_type": "iteration", "repetition_index": number,
            "real_time": 2 * time, "cpu_time": time, "time_unit": "us", "iterations": 7, **more}


class GoogleBenchmark(unittest.TestCase):
    def test_reads_times_units_and_counters(self):
        text = ('{"context": {"x": "y"}, "benchmarks": ['
                + ", ".join(map(json.dumps, (
                    entry("a/b", 1, 30, rays=5.0), entry("a/b", 0, 10, rays=3.0),
                    entry("c/real_time", 0, 1),
                    {**entry("a/b", 0, 99), "run_type": "aggregate"}))) + "]}")
        context, found = google.parse(text)
        self.assertEqual(context, {"x": "y"})
        self.assertEqual(found["a/b"], {"ns": [10e3, 30e3], "wall_ns": [20e3, 60e3],
                                        "counters": {"rays": 4.0}})
        self.assertEqual(found["c"]["ns"], [2e3])  # the wall's clock was asked for

    def test_an_infinite_counter_is_none(self):
        text = ('{"context": {}, "benchmarks": [{"run_name": "a", "run_type": "iteration", '
                '"cpu_time": 1, "real_time": 1, "time_unit": "ns", "error": Infinity}]}')
        self.assertIsNone(google.parse(text)[1]["a"]["counters"]["error"])


def results_of(**times):
    """Results with these benchmarks: name=ns, / written as __."""
    return {"best_target": "avx3",
            "benchmarks": {name.replace("__", "/"): {"ns": [ns], "counters": {}}
                           for name, ns in times.items()}}


class Headlines(unittest.TestCase):
    def test_ratios_point_the_right_way(self):
        values, missing = summary.headlines(results_of(
            shade__ggx_plain_schlick_direct__avx3=10, shade__ggx_plain_schlick_direct__avx2=16,
            shade__ggx_schlick_direct__scalar_baseline=220, shade__ggx_schlick_direct__avx3=50,
            shade__textbook_ggx__avx3=9, shade__textbook_ggx_as_written__avx3=25, visibility__tiles__1e3=2e6,
            shade__given_phong__avx3=11, shade__naive_phong__avx3=10,
            visibility__embree_sphere_point__1e3=160e6))
        self.assertAlmostEqual(values["stable_phong_over_naive_time"], 1.1)
        self.assertAlmostEqual(values["ggx_over_scalar"], 22)  # the plain form, where there is one
        self.assertAlmostEqual(values["avx2_share_of_avx3_ggx"], 10 / 16)
        self.assertAlmostEqual(values["avx2_share_of_avx3"], 10 / 16)  # the smallest of all
        self.assertAlmostEqual(values["stable_over_textbook_time"], 10 / 9)
        self.assertAlmostEqual(values["stable_over_textbook_as_written_time"], 10 / 25)
        self.assertAlmostEqual(values["visibility_1e3_over_embree_spheres"], 80)
        self.assertIn("phong_over_scalar", missing)
        self.assertNotIn("phong_over_scalar", values)

    def test_the_promised_names_are_there(self):
        values, missing = summary.headlines(results_of())
        for name in ("ggx_over_scalar", "phong_over_scalar", "blinn_over_scalar",
                     "lambert_over_scalar", "height_correlated_over_scalar",
                     "ggx_default_over_scalar", "avx2_share_of_avx3_ggx",
                     "grid_visibility_over_embree_spheres", "grid_visibility_over_embree_user",
                     "visibility_1e3_over_embree_spheres", "visibility_1e4_over_embree_spheres",
                     "visibility_1e5_over_embree_spheres", "frame_over_bare_embree_trace",
                     "frame_ms_grid_1080p_1spp", "frame_ms_grid_1080p_16spp",
                     "frame_ms_plain_grid_1080p_1spp", "frame_ms_plain_grid_1080p_16spp",
                     "process_ms_grid_1080p_1spp", "process_ms_grid_1080p_16spp",
                     "process_ms_grid_shadows_1080p_1spp", "process_s_million_1spp",
                     "process_s_million_16spp", "process_mib_million_1spp", "startup_ms", "stable_over_textbook_time",
                     "skips_on_over_off"):
            self.assertIn(name, {*values, *missing})

    def test_exact_hits_at_the_ports_bound(self):
        name = "grid_visibility_at_port_bound_over_embree_spheres"
        values, missing = summary.headlines(results_of())
        self.assertNotIn(name, {*values, *missing})
        results = results_of() | {"port_bounds": {port_bound.EXACT_HITS: 2}}
        self.assertIn(name, summary.headlines(results)[1])
        results["benchmarks"] = results["benchmarks"] | {
            port_bound.EXACT_HITS: {"ns": [9000, 9000, 9000], "counters": {"hits": 1000}},
            "visibility/embree_sphere_point/grid": {"ns": [100000] * 3, "counters": {}}}
        self.assertAlmostEqual(summary.headlines(results)[0][name], 50)

    def test_processes_and_scaling(self):
        results = results_of() | {
            "processes": {"startup": {"seconds": [0.002, 0.004, 0.003], "mib": [5, 5, 5]}},
            "scaling": {"spheres": {"points": [{"size": 2 ** 20, "mib": 64}],
                                    "fits": {"frame_s": {"exponent": 0.8, "steepest": 1.1}}}}}
        values, _ = summary.headlines(results)
        self.assertAlmostEqual(values["startup_ms"], 3)
        self.assertAlmostEqual(values["bytes_per_sphere"], 64)
        self.assertAlmostEqual(values["growth_of_frame_time_with_spheres"], 0.8)

    def test_lines(self):
        self.assertEqual(summary.lines({"a": 1.23456, "b": 123456.7}), ["a: 1.235", "b: 123457"])


class Ports(unittest.TestCase):
    def test_work_that_only_some_ports_do_is_shared_by_these(self):
        either, second, any_of_three = {"0": 0.5, "5": 0.5}, {"5": 1.0}, {"0": .3, "1": .4, "5": .3}
        self.assertEqual(port_bound.most_loaded([either] * 4), 2)
        self.assertEqual(port_bound.most_loaded([either] * 4 + [second] * 2), 3)
        self.assertEqual(port_bound.most_loaded([either] * 2 + [second] * 6), 6)
        self.assertEqual(port_bound.most_loaded([any_of_three] * 9 + [{}]), 3)
        self.assertEqual(port_bound.most_loaded([either] * 4 + [any_of_three] * 20), 8)
        self.assertEqual(port_bound.most_loaded([]), 0)

    def test_vectors_slow_the_clock(self):
        self.assertEqual(port_bound.vector_clock(7e9, 4e9), 3.5e9)  # two a cycle
        self.assertEqual(port_bound.vector_clock(3.5e9, 4e9), 3.5e9)  # one
        self.assertEqual(port_bound.vector_clock(4.1e9, 4e9), 4e9)
        self.assertEqual(port_bound.vector_clock(5e9, 4e9), 4e9)  # disturbed
        self.assertEqual(port_bound.vector_clock(1e9, 4e9), 1e9)

    def test_a_turn_takes_the_blocks_that_are_seen_as_often_as_most(self):
        # A waiting root, a branch that one turn in ten takes, and the jump back.
        code = [(0, "vmulpd a"), (1, "vsqrtpd b"), (2, "je     5"), (3, "vpermpd c"),
                (4, "vpermpd d"), (5, "vaddpd e"), (6, "vaddpd f"), (7, "jmp    0")]
        samples = collections.Counter({0: 10, 1: 900, 2: 10, 3: 1, 4: 1, 5: 10, 6: 10, 7: 10})
        self.assertEqual(list(port_bound._taken(code, 0, 7, samples)),
                         ["vmulpd a", "vsqrtpd b", "vaddpd e", "vaddpd f"])

    def test_turns_a_hit(self):
        self.assertEqual(port_bound.turns_a_hit("FillHalf", "avx3"), 1 / 16)
        self.assertEqual(port_bound.turns_a_hit("FillHalf", "avx2"), 1 / 8)
        self.assertEqual(port_bound.turns_a_hit("N_AVX38TestRaysE", "avx3"), 1 / 8)
        self.assertEqual(port_bound.turns_a_hit("N_AVX211AppendBlockE", "avx2"), 1 / 4)

    def test_copies_are_not_counted(self):
        for copy in ("vmovaps %zmm1,%zmm2", "mov    %rax,%rbx", "movaps %xmm1,%xmm0", "jne    10"):
            self.assertTrue(port_bound.NOT_COUNTED.match(copy), copy)
        for work in ("vmovaps (%rax),%zmm2", "vmovaps %zmm1,%zmm2{%k1}{z}", "vmovq  %xmm0,%rax",
                     "vmovups %zmm1,(%rdi)", "vmulps %zmm1,%zmm2,%zmm3"):
            self.assertFalse(port_bound.NOT_COUNTED.match(work), work)


class Precision(unittest.TestCase):
    def test_samplers_are_read_from_the_help(self):
        text = "  --spp INT\n  --sampler TEXT:{sobol,random} [sobol]\n"
        self.assertEqual(precision.samplers(text), ["sobol", "random"])
        self.assertEqual(precision.samplers("  --spp INT\n"), [])

    def test_variants_have_the_error_of_their_target(self):
        name = "frame/material_grid/480x270/4spp/avx3"
        found = precision.frame_series(
            {name: {"ns": [2e6]}, name + "/general_path": {"ns": [3e6]},
             "frame/material_grid/480x270/8spp/avx3": {"ns": [9e6]}, "shade/x/avx3": {"ns": [1]}},
            {"avx3": {4: {"rmse": 0.5, "rel_mse": 0.01}}}, "480x270")
        self.assertEqual(found, {
            "avx3": [{"spp": 4, "seconds": 0.002, "rmse": 0.5, "rel_mse": 0.01}],
            "avx3, nothing skipped": [{"spp": 4, "seconds": 0.003, "rmse": 0.5, "rel_mse": 0.01}]})


class Tables(unittest.TestCase):
    def test_kernels_have_their_ratio_to_plain_code(self):
        found = {}
        for name, ns in (("shade/lambert/scalar_baseline", 5120), ("shade/lambert/avx3", 512)):
            found[name] = {"ns": [ns], "counters": {"items_per_second": 512 / ns * 1e9}}
        rows = {row[2]: row for row in report.kernel_rows(found)}
        self.assertAlmostEqual(rows["avx3"][3], 1)
        self.assertAlmostEqual(rows["avx3"][5], 10)

    def test_readme_keeps_the_latest_headlines_of_each_processor(self):
        def results(processor, value):
            info = {"processor": processor, "cores": 2, "memory_gib": 1, "system": "S",
                    "compiler": "C", "build": "Release", "commit": "c", "load": 0}
            return {"machine": info, "summary": {"a": value, "growth_of_b": 1}}
        runs = []
        for processor, value in (("one", 1), ("two", 2.5), ("one", 300)):
            runs = readme.with_this_run(runs, results(processor, value))
        self.assertEqual(readme.headline_table(runs),
                         ["| headline | one | two |", "|---|---|---|", "| `a` | 300 | 2.5 |"])
        self.assertEqual(readme.headline_table(runs, {"a": "in words", "b": "not measured"}),
                         ["| headline | one | two |", "|---|---|---|", "| in words | 300 | 2.5 |",
                          "| not measured |  |  |"])
        del runs[0]["headlines"]["a"]
        self.assertEqual(readme.headline_table(runs)[-1], "| `a` |  | 2.5 |")

    def test_readme_begins_with_eight_numbers_that_are_measured(self):
        self.assertEqual(len(readme.FIRST), 8)
        values, missing = summary.headlines(results_of())
        for name in readme.FIRST:
            if not name.startswith("adaptive"):  # named by the tolerances of the run
                self.assertIn(name, {*values, *missing})

    def test_readme_keeps_what_is_outside_the_marks(self):
        text = readme.replace_between("a\n<B>\nold\n<E>\nz", "<B>", "<E>", "new\n")
        self.assertEqual(text, "a\n<B>\nnew\n<E>\nz")
        with self.assertRaises(ValueError):
            readme.replace_between("no marks", "<B>", "<E>", "new")

    def test_rows_of_waiting_are_medians_and_what_they_are_held_against(self):
        rows = {"a": {"seconds": [3, 1, 2], "mib": [7, 7, 8], "against": [4, 4, 5], "what": "b"},
                "c": {"seconds": [0.5]}}
        table = waiting.markdown({"rows": rows, "command": "x", "machine": dict.fromkeys(
            ("processor", "cores", "memory_gib", "system", "compiler", "build", "commit", "load"))})
        self.assertIn("| a | 2 | 7 | 4 | 0.50 | b |", table)
        self.assertIn("| c | 0.5 |  |  |  |  |", table)
        growth = waiting.growth_of_spheres({"1e6 spheres, 1080p": {"seconds": [0.1, 0.2]},
                                            "1e7 spheres, 1080p": {"seconds": [1.5, 1.5]}})
        self.assertAlmostEqual(growth, 1)

    def test_files_of_waiting_are_what_they_say(self):
        positions, normals, indices = waiting_files._grid(3)
        self.assertEqual((len(positions), len(normals), len(indices)), (48, 48, 54))
        self.assertEqual(max(indices), 15)
        self.assertAlmostEqual(sum(value ** 2 for value in normals[:3]), 1, 6)
        glb = waiting_files._glb({"asset": {}}, b"12345")
        self.assertEqual(int.from_bytes(glb[8:12], "little"), len(glb))
        self.assertEqual(len(glb) % 4, 0)

    def test_gnuplot_strings(self):
        self.assertEqual(plots.quote("Embree's"), "'Embree''s'")
        self.assertIn("1 NaN", plots.block("d", [(1, None)]))


if __name__ == "__main__":
    unittest.main()
