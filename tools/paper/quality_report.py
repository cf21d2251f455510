#!/usr/bin/env python3
"""Error and shape over size for every preset and for Hoppe's metric: a page with tables and curves.

    quality_report.py BIN IMAGES OUT    folders of the tools, of PNG images, and of quality.md and its SVGs
"""
import pathlib
import statistics
import struct
import subprocess
import sys

import svg_plot
from tools_runner import Tools

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "bench"))
import bench_peers  # noqa: E402

DENSITIES = (0.5, 1, 2, 4)
METHODS = {"fast": ("--preset", "fast"), "default": (), "best, luv": ("--preset", "best"),
           "best, rgb": ("--preset", "best", "--objective", "rgb"), "max, luv": ("--preset", "max"),
           "fem": ("--preset", "fem"), "Hoppe's metric": ("--metric", "hoppe")}
# Columns: title, key of measure(), format
COLUMNS = (("map RMS", "map", ".2f"), ("mesh RMS", "mesh", ".2f"), ("mesh PSNR [dB]", "psnr", ".2f"),
           ("edge ratio", "edge_ratio", ".2f"), ("mean q", "mean_q", ".3f"), ("least q", "least_q", ".3f"),
           ("folds", "folds", "d"), ("CPU seconds", "seconds", ".2f"))


def measure(tools, image, density, options):
    report = tools.build(image, "--density", density, "--threads", 1, *options)
    seconds = tools.cpu_seconds
    compared = tools.compare(image, "gouraud")
    shape = tools.mesh()
    return {"map": report["map_rms"], "mesh": report["gouraud_rms"], "psnr": compared["psnr"],
            "edge_ratio": report["mean_edge_ratio"], "mean_q": shape["shape"]["mean"],
            "least_q": shape["shape"]["min"], "folds": report["flipped_pixel_triangles"],
            "seconds": seconds}


def peer_results(bin_folder, paths, work):
    """{(name, density): figures} of the other simplifiers that are installed (./run bench peers): the error and shape of
    their mesh with colours refitted, and the CPU seconds of the one call that simplifies."""
    tool, results = pathlib.Path(bin_folder) / "bench-tool", {}
    features = work / "features"
    for density in DENSITIES:
        rows = {}
        for path in paths:
            subprocess.run([tool, "features", path, features], check=True)
            width, height = struct.unpack("<II", features.read_bytes()[8:16])
            vertices = round(width * height * density / 100)
            for name, usages, result in bench_peers.measure(bin_folder, features, vertices, work, 1):
                print(f"quality: {name}, {density} %", flush=True)
                rows.setdefault(name, []).append(
                    {"mesh": result["refitted_rms"], "edge_ratio": result["mean_edge_ratio"], "mean_q": result["mean_shape"],
                     "seconds": usages[0]["user_seconds"] + usages[0]["system_seconds"]})
        for name, figures in rows.items():
            results[name, density] = {key: statistics.fmean(f[key] for f in figures) for key in figures[0]}
    return results


def cell(figures, key, form):
    return format(figures[key], form) if key in figures else ""


def summary(rows):
    """Means over images; the least of q, the sum of folds."""
    out = {key: statistics.fmean(r[key] for r in rows) for key in rows[0]}
    out["least_q"] = min(r["least_q"] for r in rows)
    out["folds"] = sum(r["folds"] for r in rows)
    return out


def main(bin_folder, images, out):
    paths, out = sorted(pathlib.Path(images).glob("*.png")), pathlib.Path(out)
    if not paths:
        sys.exit(f"quality: {images} has no .png images")
    tools = Tools(bin_folder, out / "work")
    results = {}
    for name, options in METHODS.items():
        for density in DENSITIES:
            print(f"quality: {name}, {density} %", flush=True)
            results[name, density] = summary([measure(tools, p, density, options) for p in paths])
    peers = peer_results(bin_folder, paths, out / "work")
    results |= peers
    names = [*METHODS, *dict.fromkeys(name for name, _ in peers)]
    text = ["# Error over size", "",
            "    ./run quality FOLDER      # measures every preset on the PNG images of FOLDER; this page is its quality-out/quality.md",
            "    ./run bench peers         # installs the other simplifiers first", "",
            f"All figures are means over {len(paths)} images.", "",
            "| column | meaning |", "|---|---|",
            "| map RMS | error of the reconstruction through the pixel map, Euclidean distance in L\\*u\\*v\\* |",
            "| mesh RMS | error of the mesh drawn alone, likewise |",
            "| mesh PSNR | of the mesh drawn alone (`imgmesh-reconstruct --mode gouraud`), in 8-bit sRGB |",
            "| edge ratio | longest edge of a triangle / its shortest edge |",
            "| mean q, least q | q = 4 sqrt(3) area / sum of squared edges; the least is over all images |",
            "| folds | folded pixel triangles in all images |",
            "| CPU seconds | of the whole program on one thread; for other simplifiers, of the one call that simplifies |", "",
            "Other simplifiers get the same pixel grid. Their error is that of the mesh with least-squares colours.", ""]
    for density in DENSITIES:
        text += [f"## {density} % of the pixels as vertices", "",
                 "| | " + " | ".join(c[0] for c in COLUMNS) + " |", "|---" * (len(COLUMNS) + 1) + "|"]
        text += [f"| {name} | " + " | ".join(cell(results[name, density], key, f) for _, key, f in COLUMNS) + " |"
                 for name in names] + [""]
    for key, title, unit in (("map", "Error through the map", "RMS in L*u*v*"), ("mesh", "Error of the mesh", "RMS in L*u*v*"),
                             ("psnr", "The mesh drawn alone", "PSNR [dB]")):
        curves = {name: [(d, results[name, d][key]) for d in DENSITIES] for name in names
                  if key in results[name, DENSITIES[0]]}
        (out / f"quality-{key}.svg").write_text(svg_plot.curves(title, "vertices, % of the pixels", unit, curves) + "\n",
                                                encoding="utf-8")
        text += [f"![{title}](quality-{key}.svg)"]
    (out / "quality.md").write_text("\n".join(text) + "\n", encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: quality_report.py BIN PICTURES OUT")
    main(*sys.argv[1:])
