# SPDX-License-Identifier: Apache-2.0
"""Other renderers on the material grid, where they are installed: the same spheres, camera, light
and size, a material as near as theirs comes. Their shading is their own, so each is held against
its own picture of very many samples."""
import math
import shutil

import estimates
from processes import say


class Absent(Exception):
    """A renderer is not installed."""


def _camera():
    """scenes/material_grid.json: at z = 17, 20 degrees high, 16:9; returns the width in degrees."""
    return 2 * math.degrees(math.atan(16 / 9 * math.tan(math.radians(10))))


def _centers():
    return [(column - 2, 2 - row, row, column) for row in range(5) for column in range(5)]


def _series(runner, label, commands, truth_command, image, truth, rounds, errors):
    """[point...] of commands {what: command}, each of which writes `image`."""
    say(f"  {label}")
    runner.run(truth_command)
    points = []
    for what, command in commands.items():
        seconds = estimates.median([runner.run(command)["seconds"] for _ in range(rounds)])
        points.append({"what": what, "seconds": seconds, **errors(runner.nacre, image, truth)})
    return {label: points}


def povray(runner, folder, settings, errors):
    """POV-Ray 3.7: n x n samples in every pixel (+AM1 with threshold 0)."""
    program = shutil.which("povray")
    if program is None:
        raise Absent("POV-Ray is not installed: left out")
    scene = folder / "grid.pov"
    lines = ["#version 3.7; global_settings { assumed_gamma 1 max_trace_level 1 }",
             "background { rgb <0.05, 0.05, 0.08> }",
             "camera { perspective location <0, 0, 17> look_at <0, 0, 0> right -16/9*x "
             f"angle {_camera():.9g} }}",
             "light_source { <12, 13.5, 16.5> rgb 3 }"]
    for x, y, row, column in _centers():
        lines.append(
            f"sphere {{ <{x}, {y}, 0>, 0.4 texture {{ pigment {{ rgb <0.9, 0.6, 0.2> }} finish {{ "
            f"ambient 0.08 diffuse {1 - column / 4:g} specular albedo 0.5 "
            f"roughness {(0.1 + 0.2 * row) ** 4:g} metallic {column / 4:g} }} }} }}")
    scene.write_text("\n".join(lines))
    width, height = settings.precision_size.split("x")

    def command(depth, output):
        return [program, f"+I{scene}", f"+O{output}", "+FE", f"+W{width}", f"+H{height}", "-D",
                "-GA", "-J", "+AM1", "+A0.0", f"+R{depth}"]
    image, truth = folder / "pov.exr", folder / "pov_truth.exr"
    commands = {f"{depth}x{depth}": command(depth, image) for depth in settings.povray_depths}
    return _series(runner, "POV-Ray 3.7", commands, command(settings.povray_truth_depth, truth),
                   image, truth, min(settings.precision_rounds, 3), errors)


_BLENDER_SCRIPT = """
import bpy, math, sys
samples, seed, output, width, height = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples, scene.cycles.seed = int(samples), int(seed)
scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
scene.cycles.max_bounces = 0
scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
scene.render.filepath = output
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.world = bpy.data.worlds.new("sky")
scene.world.color = (0.05, 0.05, 0.08)
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.location = (0, 0, 17)
camera.data.angle = math.radians(ANGLE)
scene.collection.objects.link(camera)
scene.camera = camera
light = bpy.data.objects.new("key", bpy.data.lights.new("key", "POINT"))
light.location = (12, 13.5, 16.5)
light.data.energy = 4 * math.pi * math.pi * 1800
light.data.shadow_soft_size = 0
scene.collection.objects.link(light)
for x, y, row, column in CENTERS:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=128, ring_count=64, radius=0.4,
                                         location=(x, y, 0))
    bpy.ops.object.shade_smooth()
    material = bpy.data.materials.new("m")
    material.use_nodes = True
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (0.9, 0.6, 0.2, 1)
    surface.inputs["Roughness"].default_value = 0.1 + 0.2 * row
    surface.inputs["Metallic"].default_value = column / 4
    bpy.context.object.data.materials.append(material)
bpy.ops.render.render(write_still=True)
"""


def blender(runner, folder, settings, errors):
    """Blender's Cycles on the processor: direct light only, no denoising, spheres as meshes."""
    program = shutil.which("blender")
    if program is None:
        raise Absent("Blender is not installed: left out")
    script = folder / "grid_blender.py"
    script.write_text(_BLENDER_SCRIPT.replace("ANGLE", repr(_camera()))
                      .replace("CENTERS", repr(_centers())))
    width, height = settings.precision_size.split("x")

    def command(spp, seed, output):
        return [program, "--background", "--factory-startup", "--python-exit-code", "1",
                "--python", script, "--", spp, seed, output, width, height]
    image, truth = folder / "cycles.exr", folder / "cycles_truth.exr"
    return _series(runner, "Blender Cycles", {f"{n} samples": command(n, 1, image)
                                      for n in settings.blender_spp},
                   command(settings.blender_truth_spp, 2, truth), image, truth, 1, errors)
