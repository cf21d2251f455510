"""Other simplifiers on the same pixel grid, as far as they are installed: optional, in the same run.

Their time is that of the one call that simplifies, without a pixel map; imgmesh's rows are all that it does.
"""
import json
import pathlib
import shutil
import subprocess

from bench_process import run

PEERS = pathlib.Path(__file__).resolve().parent / "peers"


def installed(bin_folder):
    """(name, command up to FEATURES VERTICES, arguments between VERTICES and OUT)."""
    native = pathlib.Path(bin_folder) / "meshopt-native"
    if native.exists():
        yield "meshoptimizer 0.18, native, L* as height", [native], []
    if shutil.which("node") and (PEERS / "node_modules/meshoptimizer").is_dir():
        for method in ("attributes", "update", "halving"):
            yield f"meshoptimizer 1.3, wasm, {method}", ["node", PEERS / "meshoptimizer.mjs"], [method]
    probe = subprocess.run(["/usr/bin/python3", "-c", "import vtkmodules.vtkFiltersCore"], check=False,
                           capture_output=True)
    if probe.returncode == 0:
        yield "VTK, vtkQuadricDecimation", ["/usr/bin/python3", "-B", PEERS / "vtk_decimation.py"], []


def measure(bin_folder, features, vertices, folder, repeats):
    """Yields (name, usages, result) for every peer that is there."""
    mesh = folder / "peer.mesh"
    for name, command, method in installed(bin_folder):
        usages = []
        # The slow one is far enough away for one run to tell.
        for _ in range(1 if name.startswith("VTK") else repeats):
            process, out = run([*command, features, vertices, *method, mesh])
            usages.append(json.loads(out) | {"peak_mib": process["peak_mib"]})
        result = json.loads(run([pathlib.Path(bin_folder) / "bench-tool", "measure", features, mesh])[1])
        yield name, usages, result
