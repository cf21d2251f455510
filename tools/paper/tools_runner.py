"""Runs the imgmesh tools and gives what they report."""
import base64
import io
import json
import pathlib
import resource
import subprocess

from PIL import Image


class Tools:
    """The programs in `bin`; files go to `folder`."""

    def __init__(self, bin_folder, folder):
        self.bin, self.folder = pathlib.Path(bin_folder), pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.cpu_seconds = 0.0  # of the last run

    def _run(self, tool, *args):
        command = [str(self.bin / tool), *map(str, args), "--json"]
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        result = subprocess.run(command, check=False, capture_output=True, text=True)
        self.cpu_seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        if result.returncode != 0:
            raise SystemExit(f"paper: {' '.join(command)} failed: {result.stderr.strip()}")
        return json.loads(result.stdout)

    def build(self, image, *args, output="mesh.glb"):
        """The report of the one image."""
        return self._run("imgmesh-build", image, "-o", self.folder / output, *args)["images"][0]

    def mesh(self, container="mesh.glb"):
        """Distributions of the container's mesh."""
        return self._run("imgmesh-compare", self.folder / container)["inputs"][0]["mesh"]

    def compare(self, original, mode, container="mesh.glb"):
        """How far the container, drawn in that mode, is from the image."""
        return self._run("imgmesh-compare", original, self.folder / container, "--mode", mode)["difference"]

    def draw(self, mode, *args, container="mesh.glb", width=384):
        """An HTML image of the container, that many pixels wide."""
        target = self.folder / f"{mode}.png"
        self._run("imgmesh-reconstruct", self.folder / container, "-o", target, "--mode", mode, *args)
        return image_tag(target, width)


def image_tag(path, width=384):
    """An HTML image that holds its bytes."""
    image = Image.open(path).convert("RGBA")
    white = Image.new("RGBA", image.size, "white")
    image = Image.alpha_composite(white, image).convert("RGB")  # what a masked image leaves empty
    image = image.resize((width, round(image.height * width / image.width)), Image.Resampling.LANCZOS)
    data = io.BytesIO()
    image.save(data, "JPEG", quality=88)
    return f'<img width="{width}" alt="" src="data:image/jpeg;base64,{base64.b64encode(data.getvalue()).decode()}">'
