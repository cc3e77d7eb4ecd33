# SPDX-License-Identifier: Apache-2.0
"""The whole processes that are timed: from spawn to exit, two files written."""
import pathlib

# scenes/material_grid.json with the light beside the grid, so that spheres shadow one another.
# bench/frame_bench.cc renders the same.
SHADOWS = ("--set", "/lights/key/position=[12, 1.5, 3]")
SLOW = ("million_1spp", "million_16spp")  # take a second: fewer rounds


def commands(nacre, scenes, folder):
    """{name: command}. All threads of the machine; EXR (ZIP, half) and PNG."""
    def render(scene, *arguments, exr="frame.exr"):
        return [nacre, "render", pathlib.Path(scenes) / f"{scene}.json", "-o", folder / exr,
                "-o", folder / "frame.png", "--size", "1920x1080", "--quiet", *arguments]
    return {
        "grid_1080p_1spp": render("material_grid", "--spp", "1"),
        "grid_1080p_16spp": render("material_grid", "--spp", "16"),
        "grid_shadows_1080p_1spp": render("material_grid", "--spp", "1", *SHADOWS),
        "grid_uncompressed_1080p_1spp":
            render("material_grid", "--spp", "1", "--compression", "none"),
        "phong_vs_pbr_1080p_1spp": render("phong_vs_pbr", "--spp", "1"),
        "mesh_and_spheres_1080p_1spp": render("mesh_and_spheres", "--spp", "1"),
        "million_1spp": render("million_spheres", "--spp", "1"),
        "million_16spp": render("million_spheres", "--spp", "16"),
        # All libraries of the main job are loaded, and nothing is rendered.
        "startup": [nacre, "--version"],
    }
