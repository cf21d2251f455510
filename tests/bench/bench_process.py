"""Runs a program and gives what it took."""
import os
import subprocess
import tempfile
import time


class BenchError(Exception):
    """A program failed; one line."""


def run(command, cwd=None):
    """Runs it to its end: (usage, what it wrote to standard output)."""
    words = [str(word) for word in command]
    with tempfile.TemporaryFile("w+", encoding="utf-8") as out, tempfile.TemporaryFile("w+", encoding="utf-8") as err:
        start = time.perf_counter()
        with subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=out, stderr=err, cwd=cwd) as process:
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        wall = time.perf_counter() - start
        if process.returncode != 0:
            err.seek(0)
            reason = " ".join(err.read().split())[-300:]
            raise BenchError(f"{' '.join(words)}: exit code {process.returncode}: {reason}")
        out.seek(0)
        usage = {"user_seconds": used.ru_utime, "system_seconds": used.ru_stime, "wall_seconds": wall,
                 "peak_mib": used.ru_maxrss / 1024}
        return usage, out.read()
