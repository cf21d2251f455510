#!/usr/bin/python3
"""completions_test.py FOLDER SHELL...: the shells (bash, zsh, fish) complete what the completions in FOLDER/SHELL say."""
import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time

# What is typed, and what must be among the answers, and what must not.
CASES = (("imgmesh-build --pres", ["--preset"], ["--json"]),
         ("imgmesh-build --draco ", ["edgebreaker", "sequential", "none"], ["half"]),
         ("imgmesh-build --color-space A", ["AdobeRGB"], ["sRGB"]),
         ("imgmesh-build --faces ", [], ["photo.png"]),
         ("imgmesh-build --shape", ["--shape-weight"], []),
         ("imgmesh-build --map ", ["relaxed", "tracked", "trivial"], ["half"]),
         ("imgmesh-build -o ", ["photo.png"], []),
         ("imgmesh-build pho", ["photo.png"], []),
         ("imgmesh-warp --no", ["--no-overwrite"], ["--overwrite"]),
         ("imgmesh-encode --tune ", ["psnr", "luma", "ssim"], ["half"]),
         ("imgmesh-decode pho", ["photo.png"], []),
         ("imgmesh-warp --handle 1,2:3,4 --sol", ["--solver"], []))


def bash(folder, line):
    """The words of the function's answer, or files where it leaves the answer to bash."""
    program = line.split()[0]
    words = line.split() + ([""] if line.endswith(" ") else [])
    script = f"""source {folder}/bash/{program}
compopt() {{ COMPREPLY=($(compgen -f -- "${{COMP_WORDS[COMP_CWORD]}}")); }}
COMP_WORDS=({' '.join(repr(word) for word in words)})
COMP_CWORD={len(words) - 1}
_{program.replace('-', '_')}
echo "${{COMPREPLY[@]}}" """
    return subprocess.run(["bash", "--norc", "-c", script], capture_output=True, text=True, check=True).stdout.split()


def fish(folder, line):
    script = f"source {folder}/fish/{line.split()[0]}.fish; complete -C '{line}'"
    out = subprocess.run(["fish", "--no-config", "-c", script], capture_output=True, text=True, check=True).stdout
    return [answer.split("\t")[0] for answer in out.splitlines()]


def zsh(folder, line):
    """What an interactive zsh shows when the line is typed, and tab."""
    child, terminal = pty.fork()
    if child == 0:
        os.environ.update(TERM="dumb", PS1="", LISTMAX="1000")
        os.execvp("zsh", ["zsh", "-f", "-i"])

    def read_until(done, seconds=30):
        shown, end = "", time.monotonic() + seconds
        while time.monotonic() < end:
            if select.select([terminal], [], [], 0.3)[0]:
                shown += os.read(terminal, 65536).decode(errors="replace")
            if done(shown):
                return shown
        raise TimeoutError(f"zsh shows only {shown!r}")

    try:
        os.write(terminal, f"fpath=({folder}/zsh $fpath); autoload -U compinit; compinit -u -D; PS1=; "
                           "show() { print -r \"<$BUFFER>\"; zle send-break }; zle -N show; bindkey '^X' show; "
                           "echo rea''dy\n".encode())
        read_until(lambda text: "ready\r" in text)
        os.write(terminal, line.encode() + b"\t\t\x18")  # the second tab lists
        shown = read_until(lambda text: re.search("<imgmesh[^>]*>", text))
        return re.findall(r"[^\s\x07\x08<>]+", shown.partition(line)[2])
    finally:
        os.kill(child, 9)
        os.close(terminal)
        os.waitpid(child, 0)


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    problems = []
    with tempfile.TemporaryDirectory() as place:
        pathlib.Path(place, "photo.png").touch()
        os.chdir(place)
        for shell in [{"bash": bash, "zsh": zsh, "fish": fish}[name] for name in sys.argv[2:]]:
            for line, wanted, unwanted in CASES:
                answers = shell(folder, line)
                print(shell.__name__, repr(line), answers)
                missing = [word for word in wanted if word not in answers]
                wrong = [word for word in unwanted if word in answers]
                if missing or wrong:
                    problems.append(f"{shell.__name__} '{line}': {answers}, without {missing} or with {wrong}")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
