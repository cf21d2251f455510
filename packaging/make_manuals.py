#!/usr/bin/python3
"""make_manuals.py OUT PROGRAM...: man pages (OUT/man1) and completions of shells (OUT/bash, OUT/zsh,
OUT/fish) from --help-all."""
import pathlib
import re
import subprocess
import sys

sys.dont_write_bytecode = True
import completions  # noqa: E402

ESCAPES = {"\\": "\\e", "-": "\\-"}


def roff(text):
    escaped = "".join(ESCAPES.get(c, c) for c in text)
    return re.sub(r"^([.'])", r"\\&\1", escaped, flags=re.M)


def sections(text):
    """The help's description, usage, and its sections: {title: [(head, what it does)]}."""
    description, rest = text.split("\n", 1)
    usage = re.search(r"Usage: (.*)", rest).group(1)
    found, title = {}, None
    for line in rest.splitlines():
        if re.match(r"\S.*:$", line):
            title = line.rstrip(":")
            found[title] = []
        elif title and line.strip():
            item = re.match(r"  (\S.*?)(?:  +(.*))?$", line)
            if item:
                found[title].append([item.group(1), item.group(2) or ""])
            elif found[title]:
                found[title][-1][1] += " " + line.strip()
    return description, usage, found


def man_page(name, version, text):
    description, usage, found = sections(text)
    lines = [f'.TH {name.upper()} 1 "" "{version}" "imgmesh"', ".nh", ".ad l", ".SH NAME",
             roff(f"{name} - {description.rstrip('.')}"), ".SH SYNOPSIS", roff(usage), ".SH DESCRIPTION",
             roff(description)]
    for title, items in found.items():
        lines.append(f".SH {title.upper()}")
        for head, body in items:
            lines += [".TP", ".B " + roff(head), roff(body.strip())]
    lines += [".SH SEE ALSO", "/usr/share/doc/imgmesh/README.md"]
    return "\n".join(lines) + "\n"


def main():
    out = pathlib.Path(sys.argv[1])
    for folder in ("man1", "bash", "zsh", "fish"):
        (out / folder).mkdir(parents=True, exist_ok=True)
    for program in map(pathlib.Path, sys.argv[2:]):
        def output(option):
            return subprocess.run([program, option], capture_output=True, text=True, check=True).stdout
        text = output("--help-all")
        (out / "man1" / f"{program.name}.1").write_text(man_page(program.name, output("--version").strip(), text))
        options = completions.options_of(sections(text)[2])
        for path, completion in completions.SHELLS.items():
            (out / path.format(program.name)).write_text(completion(program.name, options))


if __name__ == "__main__":
    main()
