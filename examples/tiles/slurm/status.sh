#!/bin/sh
# Tells Snakemake what became of a Slurm job. Without it, a job that was killed for its memory would be waited for forever.
state=$(scontrol -o show job "$1" 2>/dev/null | sed -n 's/.* JobState=\([A-Z_]*\).*/\1/p')
# Slurm forgets jobs after MinJobAge, by default 5 minutes; where accounts are kept, sacct still knows them.
[ -n "$state" ] || state=$(sacct -j "$1" -X -n -P -o State 2>/dev/null | head -n 1)
case $state in
COMPLETED) echo success ;;
PENDING | CONFIGURING | RUNNING | SUSPENDED | COMPLETING | REQUEUED) echo running ;;
*) echo failed ;;
esac
