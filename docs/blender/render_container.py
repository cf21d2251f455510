"""Imports a container into Blender and draws it as imgmesh means it: upright, in its own colours, without light.

blender -b --factory-startup --python-exit-code 1 --python render_container.py -- PHOTO.glb OUT.png [ZOOM [LEVEL]]

The container must have been written with --draco none where Blender has no Draco library, as Debian's. OUT.png gets
ZOOM x ZOOM pixels (default 1) for one of the image. Without -b the scene stays open, to go on with.
"""
import math
import pathlib
import sys

import bpy
import numpy

# Blender 3.4's importer wants a name that NumPy 1.24 no longer has.
if "bool" not in numpy.__dict__:
    numpy.bool = bool


def import_container(path):
    """The objects lod0, lod1, ... of a container, in an empty scene."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(path))
    return {item.name: item for item in bpy.data.objects}


def picture_size(item):
    """Width and height in pixels: the object puts the middle between the first pixel's centre and the last's at the
    origin. (The mesh of a masked image may be smaller.)"""
    return tuple(round(2 * abs(item.location[i]) / item.scale[i]) + 1 for i in (0, 2))


def look_from_the_front(width, height, zoom):
    """An orthographic camera whose frame is the image's: the longer side is one unit, centred at the origin."""
    scene = bpy.context.scene
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = 1
    camera.location = (0, -1, 0)
    camera.rotation_euler = (math.pi / 2, 0, 0)  # along +Y, up is +Z
    scene.render.resolution_x, scene.render.resolution_y = zoom * width, zoom * height
    scene.render.resolution_percentage = 100


def keep_colours():
    """No tone mapping, no filter between pixels, nothing where the mesh is not."""
    scene = bpy.context.scene
    scene.view_settings.view_transform = "Standard"
    scene.render.film_transparent = True
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1  # without light there is no noise
    scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 0.01
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGBA"


def main(source, output, zoom="1", level="0"):
    items = import_container(source)
    shown = items[f"lod{level}"]
    for item in items.values():
        item.hide_render = item is not shown
        item.hide_set(item is not shown)
    look_from_the_front(*picture_size(shown), int(zoom))
    keep_colours()
    bpy.context.scene.render.filepath = str(pathlib.Path(output).resolve())
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main(*sys.argv[sys.argv.index("--") + 1:])
