#!/usr/bin/python3
"""coverage.py BUILD: share of the lines of libcore and formats that the in-process tests have run.

BUILD is configured with IMGMESH_COVERAGE, and its tests have left their counts in BUILD/counts.
"""
import json
import pathlib
import subprocess
import sys

# Not ours, or no library: the distribution's headers, tests, tools.
IGNORED = r"^/usr/|/tests/|/tools/"


def main(build):
    counts = sorted((build / "counts").glob("*.profraw"))
    programs = sorted(path for pattern in ("unit-*", "property-*") for path in (build / "bin").glob(pattern))
    if not counts or not programs:
        sys.exit(f"coverage.py: no counts in {build}/counts or no tests in {build}/bin")
    merged = build / "counts" / "all.profdata"
    subprocess.run(["llvm-profdata", "merge", "-sparse", "-o", merged, *counts], check=True)
    objects = [argument for program in programs[1:] for argument in ("-object", program)]
    report = subprocess.run(["llvm-cov", "export", "-summary-only", f"-instr-profile={merged}",
                             f"-ignore-filename-regex={IGNORED}", programs[0], *objects],
                            capture_output=True, text=True, check=True)
    print(f"coverage: {json.loads(report.stdout)['data'][0]['totals']['lines']['percent']:.1f} % of lines")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]))
