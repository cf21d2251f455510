#!/usr/bin/python3
"""Time, memory and error of imgmesh, of its stages and of other simplifiers, in one run.

    bench.py --bin FOLDER [options]        measures and prints tables; --json FILE keeps the figures
    bench.py compare A.json B.json         the ratios B / A of what both have

--against FOLDER measures the tools of another build as well, turn by turn with ours, and prints the ratios ours /
theirs. Processor time is user and system time; with other work on the machine only it means anything, and ratios
from turns mean more than any figure.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import bench_peers
import bench_tables
from bench_process import BenchError, run

ROOT = pathlib.Path(__file__).resolve().parents[2]
PICTURES = [ROOT / "tests/data/kodim23.png", ROOT / "tests/data/kodim05.png"]
SCHEMA = "imgmesh-bench.report.schema.json"


def numbers(kind, least, most):
    """A parser of lists as in 0.25,1,4."""
    def parse(text):
        values = [kind(part) for part in text.split(",")]
        if not all(least <= v <= most for v in values):
            raise argparse.ArgumentTypeError(f"'{text}': expected numbers from {least} to {most}")
        return values
    return parse


def options(arguments):
    parser = argparse.ArgumentParser(prog="bench", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--bin", type=pathlib.Path, required=True, help="folder of the tools and of bench-tool")
    parser.add_argument("--sides", type=numbers(int, 16, 16384), default=[256, 512, 1024],
                        help="sides of the square images [pixels] (default 256,512,1024)")
    parser.add_argument("--densities", type=numbers(float, 0.01, 100), default=[1.0],
                        help="vertices in percent of the pixels (default 1)")
    parser.add_argument("--threads", type=numbers(int, 1, 1024), default=[1, 2], help="default 1,2")
    parser.add_argument("--preset", default="default", choices=["fast", "default", "best", "max", "fem"])
    parser.add_argument("--repeats", type=int, default=3, help="runs of everything; the least time counts (default 3)")
    parser.add_argument("--only", default="process,stage,peer",
                        help="kinds of rows: process, stage, peer (default all)")
    parser.add_argument("--max-peer-side", type=int, default=2048, help="larger images without peers (default 2048)")
    parser.add_argument("--against", type=pathlib.Path, help="folder of another build's tools")
    parser.add_argument("--pictures", type=pathlib.Path, nargs="+", default=PICTURES,
                        help="what the mosaics are made of: RGB images of one size")
    parser.add_argument("--json", type=pathlib.Path, help="file for the figures")
    o = parser.parse_args(arguments)
    o.only = set(o.only.split(","))
    if not o.only <= {"process", "stage", "peer"}:
        parser.error(f"--only {','.join(sorted(o.only))}: expected process, stage, peer")
    if o.repeats < 1:
        parser.error("--repeats: expected at least 1")
    return o


class Case:
    """One image, density and number of threads."""

    def __init__(self, o, folder, picture, side, density, threads):
        self.o, self.folder, self.picture = o, folder, picture
        self.side, self.density, self.threads = side, density, threads

    def row(self, kind, subject, usages, **result):
        """The run that took the least processor time, and what came out."""
        least = min(usages, key=lambda u: u["user_seconds"] + u["system_seconds"])
        row = {"kind": kind, "subject": subject, "side": self.side, "density": self.density, "threads": self.threads,
               "preset": self.o.preset, "runs": len(usages)}
        row.update({k: round(v, 6) for k, v in least.items()})
        row.update({k: v for k, v in result.items() if v is not None})
        return row

    def build(self, bin_folder, glb):
        usage, out = run([bin_folder / "imgmesh-build", self.picture, "-o", glb, "--preset", self.o.preset, "--density",
                          self.density, "--threads", self.threads, "--json"])
        image = json.loads(out)["images"][0]
        return usage, {"rms": image["map_rms"], "gouraud_rms": image["gouraud_rms"], "vertices": image["vertices"],
                       "bytes": image["bytes"]}

    def reconstruct(self, bin_folder, glb):
        png = self.folder / "again.png"
        usage, _ = run([bin_folder / "imgmesh-reconstruct", glb, "-o", png, "--threads", self.threads])
        _, out = run([bin_folder / "imgmesh-compare", self.picture, png, "--json"])
        return usage, {"rms": json.loads(out)["difference"]["rms_luv"], "bytes": png.stat().st_size}

    def info(self, bin_folder, glb):
        usage, out = run([bin_folder / "imgmesh-info", glb, "--threads", self.threads, "--json"])
        return usage, {"bytes": json.loads(out)["bytes"]["total"]}

    def processes(self):
        """Whole programs, turn by turn with those of the other build."""
        builds = {"ours": self.o.bin} | ({"theirs": self.o.against} if self.o.against else {})
        for subject, measure in (("imgmesh-build", self.build), ("imgmesh-reconstruct", self.reconstruct),
                                 ("imgmesh-info", self.info)):
            runs = {name: [] for name in builds}
            for _ in range(self.o.repeats):
                for name, folder in builds.items():
                    runs[name].append(measure(folder, self.folder / f"{name}.glb"))
            row = self.row("process", subject, [u for u, _ in runs["ours"]], **runs["ours"][0][1])
            if "theirs" in runs:
                row["against"] = self.ratios(runs)
            yield row

    @staticmethod
    def ratios(runs):
        """Ours / theirs, from each turn."""
        def time(usage):
            return usage["user_seconds"] + usage["system_seconds"]
        times = [time(a) / time(b) for (a, _), (b, _) in zip(runs["ours"], runs["theirs"])]
        wall = [a["wall_seconds"] / b["wall_seconds"] for (a, _), (b, _) in zip(runs["ours"], runs["theirs"])]
        memory = [a["peak_mib"] / b["peak_mib"] for (a, _), (b, _) in zip(runs["ours"], runs["theirs"])]
        out = {"time_ratio": statistics.median(times), "least_time_ratio": min(times), "most_time_ratio": max(times),
               "wall_ratio": statistics.median(wall), "memory_ratio": statistics.median(memory)}
        ours, theirs = runs["ours"][0][1], runs["theirs"][0][1]
        for key in ("rms", "bytes"):
            if theirs.get(key):
                out[f"{key}_ratio"] = ours[key] / theirs[key]
        return {k: round(v, 4) for k, v in out.items()}

    def stages(self):
        command = [self.o.bin / "bench-tool", "stages", self.picture, self.folder, self.o.preset, self.density,
                   self.threads, self.o.repeats]
        for stage in json.loads(run(command)[1]):
            rms = stage.pop("rms", None)
            row = self.row("stage", stage.pop("stage"), [stage], rms=rms)
            row["runs"] = self.o.repeats
            yield row

    def peers(self, features):
        vertices = round(self.density / 100 * self.side * self.side)
        for subject, usages, result in bench_peers.measure(self.o.bin, features, vertices, self.folder, self.o.repeats):
            yield self.row("peer", subject, usages, **result)

    def rows(self, features):
        if "process" in self.o.only:
            yield from self.processes()
        if "stage" in self.o.only:
            yield from self.stages()
        if features and self.threads == 1:  # they know one
            yield from self.peers(features)


def machine():
    model = [line.split(":", 1)[1].strip() for line in pathlib.Path("/proc/cpuinfo").read_text("utf-8").splitlines()
             if line.startswith("model name")]
    return {"processor": model[0] if model else "unknown", "cores": len(model)}


def bench(o):
    rows = []
    with tempfile.TemporaryDirectory(prefix="imgmesh-bench-") as name:
        folder = pathlib.Path(name)
        for side in o.sides:
            picture, features = folder / f"{side}.png", None
            run([o.bin / "bench-tool", "mosaic", side, picture, *o.pictures])
            if "peer" in o.only and side <= o.max_peer_side:
                features = folder / "features"
                run([o.bin / "bench-tool", "features", picture, features])
            for density in o.densities:
                for threads in o.threads:
                    print(f"bench: {side} x {side}, {density:g} %, {threads} threads", file=sys.stderr, flush=True)
                    case = list(Case(o, folder, picture, side, density, threads).rows(features))
                    print(bench_tables.tables({"rows": case}), end="\n\n", flush=True)  # of a long run, what there is
                    rows += case
            picture.unlink()
    return {"$schema": SCHEMA, "machine": machine(), "pictures": [p.name for p in o.pictures], "rows": rows}


def main(arguments):
    if arguments[:1] == ["compare"]:
        if len(arguments) != 3:
            sys.exit("usage: bench compare A.json B.json")
        reports = [json.loads(pathlib.Path(a).read_text("utf-8")) for a in arguments[1:]]
        print(bench_tables.comparison(*reports))
        return
    o = options(arguments)
    report = bench(o)
    if o.json:
        o.json.write_text(json.dumps(report, indent=2) + "\n", "utf-8")


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except (BenchError, OSError, json.JSONDecodeError) as error:
        sys.exit(f"bench: error: {error}")
    except subprocess.SubprocessError as error:
        sys.exit(f"bench: error: {error}")
