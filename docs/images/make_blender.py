#!/usr/bin/python3
"""Draws the image of docs/blender.md: make_blender.py BIN, with BIN the folder of the tools.

tests/data/kodim23.png as Blender shows its mesh: from the front, and from aside with the edges drawn.
"""
import math
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PHOTO = HERE.parents[1] / "tests" / "data" / "kodim23.png"
sys.path.insert(0, str(HERE.parent / "blender"))


def draw_aside(source, output):
    """In Blender."""
    import bpy
    from render_container import import_container, keep_colours

    mesh = import_container(source)["lod0"]
    edges = mesh.copy()
    bpy.context.collection.objects.link(edges)
    edges.data = mesh.data.copy()
    edges.location.y -= 0.001
    modifier = edges.modifiers.new("edges", "WIREFRAME")
    modifier.thickness = 0.6  # of a pixel
    black = bpy.data.materials.new("black")
    black.use_nodes = True
    black.node_tree.nodes.clear()
    emission = black.node_tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value = (0.01, 0.01, 0.01, 1)
    surface = black.node_tree.nodes.new("ShaderNodeOutputMaterial")
    black.node_tree.links.new(emission.outputs[0], surface.inputs["Surface"])
    edges.data.materials.clear()
    edges.data.materials.append(black)

    scene = bpy.context.scene
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.data.lens = 50
    camera.location = (0.85, -1.31, 0.1)
    camera.rotation_euler = (math.radians(86), 0, math.radians(33))
    scene.render.resolution_x, scene.render.resolution_y = 512, 342
    keep_colours()
    scene.cycles.samples = 64  # smooth edges
    scene.cycles.filter_width = 1.5
    scene.render.filepath = output
    bpy.ops.render.render(write_still=True)


def main(bin_folder):
    from PIL import Image

    with tempfile.TemporaryDirectory() as folder:
        container = f"{folder}/photo.glb"
        subprocess.run([f"{bin_folder}/imgmesh-build", PHOTO, "-o", container, "--draco", "none", "-q"], check=True)
        shots = []
        for script, name in ((HERE.parent / "blender" / "render_container.py", "front"), (__file__, "aside")):
            shots.append(f"{folder}/{name}.png")
            subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", script, "--", container,
                            shots[-1]], check=True, stdout=subprocess.DEVNULL)
        sheet = Image.new("RGB", (1032, 342), "white")
        for place, shot in zip((0, 520), shots):
            image = Image.open(shot).convert("RGBA").resize((512, 342), Image.LANCZOS)
            sheet.paste(image, (place, 0), image)
        sheet.save(HERE / "blender.jpg", quality=88)


if __name__ == "__main__":
    if "--" in sys.argv:
        draw_aside(*sys.argv[sys.argv.index("--") + 1:])
    else:
        main(sys.argv[1])
