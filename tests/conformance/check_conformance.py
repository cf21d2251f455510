#!/usr/bin/python3
"""check_conformance.py IMGMESH_INFO FOLDER: what make-conformance wrote has the finding that its folder is named
after up to a +, and no other; the reader refuses the errors and nothing else."""
import json
import pathlib
import subprocess
import sys

import jsonschema

SCHEMA = pathlib.Path(__file__).resolve().parents[2] / "schemas" / "imgmesh-info.report.schema.json"
UNSUPPORTED = {"gltf.version", "gltf.required", "ext.version", "layers.version"}


def check(info, folder, validator):
    """What is wrong with the verdict on one container, as lines."""
    (path,) = [p for p in folder.iterdir() if p.suffix in (".glb", ".gltf")]
    options = (folder / "options").read_text().split() if (folder / "options").exists() else []

    def run(*more):
        return subprocess.run([info, path, *options, *more], capture_output=True, text=True, check=False, timeout=60)

    result = run("--validate", "--json")
    report = json.loads(result.stdout)
    problems = [e.message for e in validator.iter_errors(report)]
    found = {f["code"]: f["severity"] for f in report["findings"]}
    code = folder.name.split("+")[0]
    expected = set() if code.startswith("valid-") else {code}
    if set(found) != expected:
        problems.append(f"findings {[(f['code'], f['message']) for f in report['findings']]}")
    refused = 5 if code in UNSUPPORTED else 4
    severity = found.get(code)
    for got, errors in ((result.returncode, ("error",)), (run().returncode, ("error",)),
                        (run("--validate", "--warnings-as-errors").returncode, ("error", "warning"))):
        if got != (refused if severity in errors else 0):
            problems.append(f"exit code {got} where {errors} fail: {result.stderr}")
    if severity == "error" and not report["findings"][0]["place"] and code not in NO_PLACE:
        problems.append("no place")
    return [f"{folder.name}: {p}" for p in problems]


# Findings about a file as a whole.
NO_PLACE = {"limits.bytes", "limits.json", "json.syntax", "json.depth", "ext.missing"}


def main():
    info, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    validator = jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text()))
    folders = sorted(p for p in folder.iterdir() if p.is_dir())
    problems = [line for f in folders for line in check(info, f, validator)]
    print("\n".join(problems + [f"{len(folders)} containers"]))
    return 1 if problems or len(folders) < 60 else 0


if __name__ == "__main__":
    sys.exit(main())
