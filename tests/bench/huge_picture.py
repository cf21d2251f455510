"""A picture of any size made from two photographs, and what its tile set costs (docs/scale.md).

    huge_picture.py make SIZE OUT.tif                          # SIZE x SIZE pixels, a tiled TIFF, in bounded memory
    huge_picture.py measure BIN SIZE FOLDER [--tiles 2048] [--threads 1] [--memory 2048] [--options "--preset fast"]

The photographs lie beside each other, mirrored so that they go on without an edge, and are seen through a map that turns and stretches
them by another amount everywhere: no two tiles are alike, and none has an edge that a photograph has not.
"""
import argparse
import json
import math
import os
import pathlib
import resource
import shlex
import subprocess
import sys
import time

import numpy as np
import OpenImageIO as oiio
from PIL import Image

DATA = pathlib.Path(__file__).resolve().parents[1] / "data"
CELL = 256  # [pixels]; the map is bilinear in each
TURN = 0.61  # [radians]; no simple part of a turn, so that nothing repeats


def mirrored() -> tuple[Image.Image, int, int]:
    """Returns the photographs and their mirror images, one period and as much as a cell can reach, and the period's size."""
    # Without the dark line around each.
    pair = np.concatenate([np.asarray(Image.open(DATA / name))[4:-4, 4:-4] for name in ("kodim05.png", "kodim23.png")], axis=1)
    period = np.block([[[pair], [pair[:, ::-1]]], [[pair[::-1]], [pair[::-1, ::-1]]]])
    height, width = period.shape[:2]
    return Image.fromarray(np.pad(period, ((0, 3 * CELL), (0, 3 * CELL), (0, 0)), mode="wrap")), width, height


def seen_at(x: float, y: float) -> tuple[float, float]:
    """Returns the place of the periodic photographs that is seen at a pixel: turned by up to 20 degrees and scaled by 0.7 to 1.4."""
    u = math.cos(TURN) * x - math.sin(TURN) * y + 1500 * math.sin(y / 5300) + 700 * math.sin(x / 3100)
    v = math.sin(TURN) * x + math.cos(TURN) * y + 1500 * math.sin(x / 6100) + 700 * math.sin(y / 2900)
    return u, v


def strip(photos: tuple[Image.Image, int, int], left: int, top: int, width: int) -> np.ndarray:
    """Returns CELL rows of the picture."""
    base, period_x, period_y = photos
    cells = []
    for x in range(0, width, CELL):
        corners = [seen_at(left + x + dx, top + dy) for dx, dy in ((0, 0), (0, CELL), (CELL, CELL), (CELL, 0))]
        shift_x = math.floor(min(u for u, _ in corners) / period_x) * period_x
        shift_y = math.floor(min(v for _, v in corners) / period_y) * period_y
        quad = [c for u, v in corners for c in (u - shift_x, v - shift_y)]
        cells.append(((x, 0, x + CELL, CELL), quad))
    return np.asarray(base.transform((width, CELL), Image.Transform.MESH, cells, Image.Resampling.BICUBIC))


def make(size: int, path: pathlib.Path, left: int = 0, top: int = 0) -> None:
    photos = mirrored()
    out = oiio.ImageOutput.create(str(path))
    spec = oiio.ImageSpec(size, size, 3, "uint8")
    spec.tile_width = spec.tile_height = CELL
    spec.attribute("compression", "zip")
    spec.attribute("tiff:zipquality", 1)
    spec.attribute("tiff:bigtiff", 1)
    if not out.open(str(path), spec):
        raise OSError(out.geterror())
    for y in range(0, size, CELL):
        rows = strip(photos, left, top + y, (size + CELL - 1) // CELL * CELL)
        end = min(y + CELL, size)
        if not out.write_tiles(0, size, y, end, 0, 1, np.ascontiguousarray(rows[:end - y, :size])):
            raise OSError(out.geterror())
    out.close()


def run(command: list[str], memory_mb: int | None) -> dict[str, float]:
    """Runs a command with no more memory than that, and returns what it took."""
    limit = (lambda: resource.setrlimit(resource.RLIMIT_AS, (memory_mb << 20, memory_mb << 20))) if memory_mb else None
    start = time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, preexec_fn=limit) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise RuntimeError(f"exit code {process.returncode}: {shlex.join(command)}")
    return {"seconds": time.monotonic() - start, "cpu": usage.ru_utime + usage.ru_stime, "peak_mb": usage.ru_maxrss / 1024}


def root_mean(squares: float, count: float) -> float:
    return math.sqrt(squares / count) if count else 0.0


def measure(options: argparse.Namespace) -> dict[str, object]:
    folder = options.folder
    folder.mkdir(parents=True, exist_ok=True)
    small, huge, out = folder / "small.tif", folder / f"huge-{options.size}.tif", folder / f"set-{options.size}"
    start = time.monotonic()
    if not huge.exists():
        make(options.size, folder / "part.tif")
        os.replace(folder / "part.tif", huge)
    report: dict[str, object] = {"size": options.size, "tiles": options.tiles, "made_seconds": time.monotonic() - start}
    build = [str(options.bin / "imgmesh-build"), "--quiet", "--threads", str(options.threads), *shlex.split(options.options)]
    # A picture of 4 megapixels is a spot, so several spots are the measure.
    spots, cpu = 4, 0.0
    for n in range(spots):
        place = options.size * (2 * n + 1) // (2 * spots)
        make(2048, small, left=place, top=options.size - place)
        cpu += run([*build, str(small), "-o", str(folder / "small.glb")], None)["cpu"]
    taken = run([*build, str(huge), "-o", f"{out}/", "--tiles", str(options.tiles)], options.memory)
    index = json.loads((out / "index.json").read_text())
    tiles = [tile for tile in index["tiles"] if tile["tile"].startswith("0/")]

    def total(key: str) -> float:
        return sum(tile[key] for tile in tiles)

    megapixels = total("pixels") / 1e6
    inside = root_mean(total("map_squares") - total("seam_squares"), total("pixels") - total("seam_pixels"))
    seams = root_mean(total("seam_squares"), total("seam_pixels"))
    small_cost = cpu / (spots * 2048 * 2048 / 1e6)
    report.update(
        cpu_of_megapixel=taken["cpu"] / megapixels, cpu_of_megapixel_at_4=small_cost, ratio=taken["cpu"] / megapixels / small_cost,
        seconds=taken["seconds"], peak_mb=taken["peak_mb"], limit_mb=options.memory,
        wanted_density=index["plan"]["density"], density=total("own_vertices") / megapixels / 1e4,
        seam_rms=seams, inside_rms=inside, seam_ratio=seams / inside, missing=len(index["missing"]),
        bytes_of_pixel=sum(path.stat().st_size for path in out.rglob("*") if path.is_file()) / megapixels / 1e6,
        bytes_of_level=[level["bytes"] for level in index["levels"]])
    info = options.bin / "imgmesh-info"
    if info.exists():
        start = time.monotonic()
        done = subprocess.run([str(info), "--validate", "--json", str(out)], stdout=subprocess.PIPE, text=True, check=False)
        report.update(valid=done.returncode == 0, validate_seconds=time.monotonic() - start)
        if done.returncode != 0:
            report["findings"] = done.stdout[-2000:]
    return report


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    maker = commands.add_parser("make")
    maker.add_argument("size", type=int)
    maker.add_argument("out", type=pathlib.Path)
    measurer = commands.add_parser("measure")
    measurer.add_argument("bin", type=pathlib.Path)
    measurer.add_argument("size", type=int)
    measurer.add_argument("folder", type=pathlib.Path)
    measurer.add_argument("--tiles", type=int, default=2048)
    measurer.add_argument("--threads", type=int, default=1)
    measurer.add_argument("--memory", type=int, default=2048, help="limit of the kernel on its address space [MiB]")
    measurer.add_argument("--options", default="", help="others of imgmesh-build")
    options = parser.parse_args()
    if options.command == "make":
        make(options.size, options.out)
    else:
        print(json.dumps(measure(options), indent=2))
    return 0


if __name__ == "__main__":
    sys.exit(main())
