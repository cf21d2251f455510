#!/usr/bin/env bash
# parallel.sh 2 imgmesh-build huge.tif -o set/ --tiles 4096 --threads 1
# Makes a tile set with so many processes at a time, by GNU parallel and jq. Run again, it goes on where it was ended.
set -euo pipefail
processes=$1
shift
plan=$("$@" --plan --json)
jobs() {
    jq -r --arg step "$1" '.images[0].jobs[] | select(.name | sub("/[^/]*$"; "") == $step) | .command + ["--quiet"] | @sh' \
        <<<"$plan"
}
# The jobs of a step need only those of the steps before.
levels=$(jq '.images[0].levels' <<<"$plan")
for step in spool sample threshold $(seq -f tile/%g 0 $((levels - 1))); do
    jobs "$step" | parallel -j "$processes" --retries 3
done
eval "$(jobs index)" # exit code 4: tiles are missing
