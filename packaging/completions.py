"""What shells complete of a program, from its --help-all: completions of bash, zsh and fish."""
import dataclasses
import re

# What an option's argument is in --help-all: files are completed, numbers and the like are not.
FILES = {"FILE", "NAME"}


@dataclasses.dataclass
class Option:
    names: list  # as "-o", "--output"
    argument: str  # as "FILE", or "" of a flag
    choices: list  # what the argument may be, or none where that is anything
    others: list  # what it excludes
    text: str

    def long_names(self):
        return [name for name in self.names if name.startswith("--")]


def options_of(sections):
    """The options of {title: [(head, what it does)]}. What an option does ends with what is told of all in one way:
    "TEXT: WORD, WORD (default WORD); needs --NAME; not with --NAME, --NAME"."""
    found = []
    for items in sections.values():
        for head, body in items:
            if not head.startswith("-"):
                continue
            names, *words = head.split()
            argument = words[0] if words and words[0] != "REQUIRED" else ""
            text, _, others = body.strip().partition("; not with ")
            text = re.sub(r"( \(default [^()]*\))?(; needs --\S+)?$", "", text)
            listed = re.search(r": ([\w.-]+(?:, [\w.-]+)+)$", text) if argument == "NAME" else None
            found.append(Option(names.split(","), argument, listed[1].split(", ") if listed else [],
                                re.findall(r"--[\w-]+", others), text[: listed.start()] if listed else text))
    return found


def bash(name, options):
    function = "_" + name.replace("-", "_")
    cases = []
    for option in options:
        if option.argument and (option.choices or option.argument not in FILES):
            words = " ".join(option.choices)
            cases.append(f"""    {"|".join(option.names)})
        COMPREPLY=($(compgen -W "{words}" -- "$word"))
        return
        ;;""")
    newline = "\n"
    return f"""{function}() {{
    local word=${{COMP_WORDS[COMP_CWORD]}}
    case ${{COMP_WORDS[COMP_CWORD - 1]}} in
{newline.join(cases)}
    esac
    case $word in
    -*) COMPREPLY=($(compgen -W "{' '.join(sorted(n for o in options for n in o.long_names()))}" -- "$word")) ;;
    *) compopt -o default ;;
    esac
}}
complete -F {function} {name}
"""


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def zsh(name, options):
    specs = []
    for option in options:
        text = re.sub(r"([\[\]\\])", r"\\\1", option.text)
        action = f"({' '.join(option.choices)})" if option.choices else "_files" if option.argument in FILES else " "
        argument = f":{option.argument.replace(':', '-')}:{action}" if option.argument else ""
        for spelling in option.names:
            specs.append(quoted(f"({' '.join(option.names + option.others)}){spelling}[{text}]{argument}"))
    lines = " \\\n    ".join(specs + ["'*:file:_files'"])
    return f"#compdef {name}\n_arguments \\\n    {lines}\n"


def fish(name, options):
    lines = []
    for option in options:
        text = option.text.replace("\\", "\\\\").replace("'", "\\'")
        for spelling in option.names:
            word = f"-l {spelling[2:]}" if spelling.startswith("--") else f"-s {spelling[1:]}"
            if option.choices:
                word += f" -x -a '{' '.join(option.choices)}'"
            elif option.argument:
                word += " -r -F" if option.argument in FILES else " -x"
            lines.append(f"complete -c {name} {word} -d '{text}'")
    return "\n".join(lines) + "\n"


# Where each goes below the folder of completions, and what writes it.
SHELLS = {"bash/{}": bash, "zsh/_{}": zsh, "fish/{}.fish": fish}
