"""A Slurm cluster of one node, this computer, for tests: python3 slurm_cluster.py COMMAND... runs a command on it.

All its files are in a temporary folder, its ports are free ones, and its daemons end with this program, however that ends. Needs the
Debian packages slurm-wlm and munge; no configuration of the system is read or changed.
"""
import contextlib
import getpass
import os
import secrets
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

NODE = "node"
PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch"]


def is_there() -> bool:
    """Returns whether Slurm is installed."""
    return all(shutil.which(name, path=search_path()) for name in PROGRAMS)


def search_path() -> str:
    """Daemons are not on the path of users."""
    return os.environ["PATH"] + ":/usr/sbin"


def free_ports(count: int) -> list[int]:
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


def configuration(folder: Path) -> str:
    controller, node = free_ports(2)
    user = getpass.getuser()
    return f"""ClusterName=imgmesh
SlurmctldHost={socket.gethostname().split(".")[0]}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/linux
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
ReturnToService=2
MpiDefault=none
MailProg=/bin/true
NodeName={NODE} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} RealMemory=2000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
"""


@contextlib.contextmanager
def slurm_cluster(seconds: float = 30) -> Iterator[dict[str, str]]:
    """Yields the environment in which sbatch and all other commands find the cluster, as soon as its node takes jobs."""
    daemons: list[subprocess.Popen[bytes]] = []
    # munged refuses a socket in a folder that others may write to, or may not pass.
    folder = Path(tempfile.mkdtemp(prefix="imgmesh-slurm-"))
    try:
        folder.chmod(0o755)
        (folder / "state").mkdir()
        (folder / "spool").mkdir()
        (folder / "slurm.conf").write_text(configuration(folder))
        key = folder / "munge.key"
        key.write_bytes(secrets.token_bytes(128))
        key.chmod(0o600)
        environment = {**os.environ, "PATH": search_path(), "SLURM_CONF": str(folder / "slurm.conf")}
        options = [f"--{name}={folder}/munge.{end}" for name, end in
                   [("key-file", "key"), ("socket", "socket"), ("pid-file", "pid"), ("log-file", "log"), ("seed-file", "seed")]]
        for command in (["munged", "-F", *options], ["slurmctld", "-D"], ["slurmd", "-D", "-N", NODE]):
            with (folder / f"{command[0]}.out").open("wb") as out:
                daemons.append(subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *command], env=environment,
                                                stdout=out, stderr=subprocess.STDOUT))
            if command[0] == "munged":
                wait_for(lambda: (folder / "munge.socket").exists(), daemons, folder, seconds)
        wait_for(lambda: "idle" in subprocess.run(["sinfo", "-h", "-o", "%T"], env=environment, stdout=subprocess.PIPE, check=False,
                                                  stderr=subprocess.DEVNULL, text=True).stdout, daemons, folder, seconds)
        yield environment
        subprocess.run(["scancel", "-u", getpass.getuser()], env=environment, check=False)
    finally:
        for daemon in reversed(daemons):
            daemon.terminate()
        for daemon in daemons:
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        shutil.rmtree(folder, ignore_errors=True)


def wait_for(is_ready, daemons, folder: Path, seconds: float) -> None:
    end = time.monotonic() + seconds
    while not is_ready():
        if time.monotonic() > end or any(daemon.poll() is not None for daemon in daemons):
            logs = "\n".join(f"{path.name}: {path.read_text(errors='replace')[-2000:]}"
                             for path in sorted([*folder.glob("*.log"), *folder.glob("*.out")]))
            raise RuntimeError(f"the Slurm cluster did not start\n{logs}")
        time.sleep(0.1)


def main() -> int:
    with slurm_cluster() as environment:
        return subprocess.run(sys.argv[1:], env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
