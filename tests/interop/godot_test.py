#!/usr/bin/python3
"""godot_test.py BIN GODOT FOLDER: Godot 3 imports scenes that imgmesh-convert writes, and draws the image's pixels where
the mesh is, one for one. FOLDER becomes the project.

The sprite has a hole with an island, and parts that touch at a corner; no pixel is half transparent. Xvfb gives the window,
and Mesa draws by software."""
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np
from PIL import Image

from viewers_test import DATA

PROJECT = """config_version=4

[rendering]

quality/driver/driver_name="GLES2"
"""

# Draws each scene named on the command line, and says what polygons it has.
SCRIPT = """extends SceneTree

func _init():
    call_deferred("draw")

func draw():
    var views = {}
    for file in OS.get_cmdline_args():
        if not file.ends_with(".tscn"):
            continue
        var view = Viewport.new()
        view.size = Vector2(WIDTH, HEIGHT)
        view.usage = Viewport.USAGE_2D
        view.transparent_bg = true
        view.render_target_v_flip = true
        view.render_target_update_mode = Viewport.UPDATE_ALWAYS
        var scene = load("res://" + file).instance()
        view.add_child(scene)
        root.add_child(view)
        views[file] = view
        for node in scene.get_children() if scene.get_child_count() > 0 else [scene]:
            if node is Polygon2D:
                print("node ", file, " ", node.polygon.size(), " ", node.internal_vertex_count)
    for _frame in range(3):
        yield(self, "idle_frame")
    for file in views:
        views[file].get_texture().get_data().save_png("res://" + file + ".png")
    quit()
"""


def make_images(folder):
    photograph = Image.open(DATA / "kodim23.png").convert("RGBA").crop((70, 80, 262, 208))
    photograph.save(folder / "photo.png")
    y, x = np.mgrid[:photograph.height, :photograph.width]
    radius = np.hypot(x - 80, y - 64)
    inside = ((radius < 60) & (radius > 30)) | (radius < 12)
    inside |= (x >= 150) & (x < 160) & (y < 10) | (x >= 160) & (x < 170) & (y >= 10) & (y < 20)
    sprite = np.array(photograph)
    sprite[..., 3] = np.where(inside, 255, 0)
    Image.fromarray(sprite).save(folder / "my sprite.png")
    Image.new("RGB", (1, 1), (200, 100, 50)).save(folder / "one.png")
    return photograph.size


def rgba_of(path, size):
    """The image at the top left of a canvas of that size; black where nothing is seen."""
    canvas = Image.new("RGBA", size)
    canvas.paste(Image.open(path).convert("RGBA"))
    pixels = np.array(canvas, int)
    pixels[pixels[..., 3] == 0] = 0
    return pixels


def main():
    bin_folder, godot, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    size = make_images(folder)
    (folder / "project.godot").write_text(PROJECT)
    (folder / "draw.gd").write_text(SCRIPT.replace("WIDTH", str(size[0])).replace("HEIGHT", str(size[1])))
    scenes = {}
    for name in ("photo", "my sprite", "one"):
        subprocess.run([bin_folder / "imgmesh-build", f"{name}.png", "-o", f"{name}.glb", "--density", "2", "-q"],
                       cwd=folder, check=True)
        for ending, options in (("", ()), (" mesh", ("--as", "meshinstance2d")), (" outline", ("--outline-tolerance", "0"))):
            scene = f"{name}{ending}.tscn"
            subprocess.run([bin_folder / "imgmesh-convert", f"{name}.glb", "-o", scene, "--image", f"{name}.png", "-q",
                            *options], cwd=folder, check=True)
            scenes[scene] = f"{name}.png"
        # Godot 3 would import it, cannot read Draco, and sometimes dies of that.
        (folder / f"{name}.glb").unlink()

    def run_godot(*arguments):
        environment = dict(os.environ, HOME=str(folder), XDG_CONFIG_HOME=str(folder / "home"),
                           XDG_DATA_HOME=str(folder / "home"), XDG_CACHE_HOME=str(folder / "home"), LC_ALL="C.UTF-8")
        command = ["xvfb-run", "-a", godot, "--audio-driver", "Dummy", *arguments]
        # Godot 3.2 dies now and then as it quits, in a thread of its own, whatever the project. Another fault is ours.
        for _try in range(4):
            result = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False,
                                    timeout=120)
            if "handle_crash" not in result.stdout + result.stderr:
                break
        if result.returncode != 0:
            sys.exit(f"{result.stdout}{result.stderr}\ngodot failed")
        return result.stdout

    run_godot("-e", "--quit")  # imports the images
    told = run_godot("-s", "draw.gd", *scenes)
    problems = []
    for scene, image in scenes.items():
        if not (folder / f"{scene}.png").exists():
            problems.append(f"{scene}: not drawn: {told}")
            continue
        drawn, expected = rgba_of(folder / f"{scene}.png", size), rgba_of(folder / image, size)
        wrong = (np.abs(drawn - expected) > 1).any(axis=2).sum()
        print(f"{scene}: {wrong} pixels differ")
        if wrong > 0:
            problems.append(f"{scene}: {wrong} pixels differ")
        if image != "one.png" and (np.abs(drawn[::-1] - expected) > 1).any(axis=2).sum() < 1000:
            problems.append(f"{scene}: upside down it would do as well")
    if told.count("node my sprite.tscn") != 4:
        problems.append(f"four parts expected: {told}")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
