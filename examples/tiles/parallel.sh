#!/usr/bin/env bash
# parallel.sh 2 imgmesh-build huge.tif -o set/ --tiles 4096 --threads 1
# Makes a tile set with so many processes at a time, by GNU parallel and jq. Run again, it goes on where it was ended.
set -euo pipefail
if [[ $# -lt 2 || ! $1 =~ ^[1-9][0-9]*$ ]]; then
    echo "usage: parallel.sh PROCESSES imgmesh-build PICTURE -o SET/ --tiles 4096 --threads 1" >&2
    exit 2
fi
for program in parallel jq; do
    command -v "$program" >/dev/null || { echo "parallel.sh: error: there is no $program; ./run setup engines installs it" >&2; exit 1; }
done
processes=$1
shift
plan=$("$@" --plan --json)
of_plan() { jq -r "$@" <<<"$plan"; }
bar=()
[ ! -t 2 ] || bar=(--bar) # how many jobs of a step are done, and the time left

# The jobs of a step need only those of the steps before.
levels=$(of_plan '.images[0].levels')
for step in spool sample threshold $(seq -f tile/%g 0 $((levels - 1))); do
    jobs=$(of_plan --arg step "$step" \
        '.images[0].jobs[] | select(.name | sub("/[^/]*$"; "") == $step) | .command + ["--quiet"] | @sh')
    [ -n "$jobs" ] || continue
    echo "jobs of $step: $(wc -l <<<"$jobs")" >&2
    parallel -j "$processes" --retries 3 "${bar[@]}" <<<"$jobs"
done
code=0
eval "$(of_plan '.images[0].jobs[] | select(.name == "index") | .command + ["--quiet"] | @sh')" || code=$? # 4: tiles are missing
out=$(of_plan '.images[0].out')
[ ! -f "$out/index.json" ] || jq -r --arg out "$out" \
    '"\($out): \(.tiles | length) tiles of \(.levels | length) levels, \(.missing | length) missing"' "$out/index.json" >&2
exit "$code"
