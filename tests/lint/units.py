"""Files that clang-tidy reads together, and headers that files read in common.

Reading Eigen, the standard library and JSON, and walking through them, is nine tenths of what clang-tidy takes for one
file. A unit is a file that includes many of ours, so that it is paid once for all of them.
"""
import collections
import json
import re
import shlex

UNIT_FILES = 16
LARGE_HEADERS = ("<Eigen/Core>", "<nlohmann/json.hpp>", "<CLI/CLI.hpp>", "<pybind11/pybind11.h>", "<lcms2.h>")

CONSTANT = re.compile("k[A-Z]")
LOCAL_CONSTANT = re.compile(r"^\s+(?:static )?const(?:expr)? [^=({\[;]*\b(k[A-Z]\w*)\s*[=({\[]", re.M)
MACRO_CALL = re.compile("[A-Z][A-Z0-9_]+")  # TEST_CASE and the like
PLAIN_ENUM = re.compile(r"^enum (?!class)[^{;]*{([^}]*)}", re.M)
INCLUDE = re.compile(r'^\s*#\s*include\s+(?:"([^"]+)"|<([^>]+)>)', re.M)
# In our layout what stands outside functions and types begins its line. An alias may be told twice, all else may not.
DEFINITION = re.compile(r"^(?:(?:struct|class|union|enum(?: class)?) (?:alignas\(\w+\) )?(?P<type>\w+)"
                        r"|(?P<alias>using .*)"
                        r"|#define (?P<macro>\w+)"
                        r"|(?!\s|namespace|using|template|extern|#|//)[\w:<>,&*\[\] ]*?\b(?P<name>\w+)\s*[({=\[;])", re.M)


def layer_flags(build, root, layers):
    """{layer: flags that compile any of its files}, and all its files."""
    flags, files = collections.defaultdict(dict), set()
    for entry in json.loads((build / "compile_commands.json").read_text()):
        name = layer(entry["file"], root)
        if name not in layers:
            continue
        files.add(root / entry["file"])
        words = shlex.split(entry["command"])[1:]
        end = words.index("-o")  # then: -o OBJECT -c FILE
        pairs = [(word, words[i + 1]) if word in ("-isystem", "-include") else (word,)
                 for i, word in enumerate(words[:end]) if words[i - 1] not in ("-isystem", "-include")]
        flags[name].update(dict.fromkeys(pairs))
    return {name: [word for pair in pairs for word in pair] for name, pairs in flags.items()}, files


def layer(file, root):
    return root.joinpath(file).relative_to(root).parts[0]


def definitions(file):
    """{name: None, or the whole line of an alias}: what two files of one unit must not both define."""
    found = {}
    for match in DEFINITION.finditer(file.read_text()):
        if match["alias"]:
            found[re.findall(r"\w+", match["alias"].split("=")[0])[-1]] = match["alias"]
        elif not MACRO_CALL.fullmatch(match["name"] or ""):
            found[match["type"] or match["macro"] or match["name"]] = None
    for name in ("main", "static_assert", "__attribute__"):
        found.pop(name, None)
    return found


class Names:
    """What one file defines, and what the headers define that it reads."""

    def __init__(self, file, root, header_names):
        self.own = definitions(file)
        self.text = file.read_text()
        self.local = set(LOCAL_CONSTANT.findall(self.text))
        self.headers = {name for name in headers_read(file, root) if (root / name.strip('"')).exists()}
        self.of_headers = header_names

    def clash(self, other, rename):
        """Whether the compiler would refuse or confuse names where both files are read together, this one after `other`. With
        `rename`, constants that both define have names of their own there."""
        for name, line in self.own.items():
            if name in other.own and not (line and line == other.own[name]) and not (rename and CONSTANT.match(name)):
                return True
        if not rename and other.shadowed_in(self):
            return True
        return (self.hidden_by(other.headers) or other.hidden_by(self.headers) or
                bool(self.constants(self.headers - other.headers) & self.constants(other.headers - self.headers)))

    def shadowed_in(self, other):
        """Whether something within a function of `other` has the name of a constant or alias here. Compilers warn of it where
        they have read this file before."""
        aliases = [name for name, line in self.own.items() if line and not line.startswith("using namespace")]
        return bool(self.own.keys() & other.local) or any(
            name not in other.own and re.search(rf"[\w>&*] {name}\s*[({{=;,)]", other.text) for name in aliases)

    def hidden_by(self, headers):
        return any(name in self.own for header in headers - self.headers for name in self.of_headers[header])

    def constants(self, headers):
        return {name for header in headers for name in self.of_headers[header] if CONSTANT.match(name)}


def units(files, root, most=UNIT_FILES, rename=True):
    """Lists of up to `most` files of one layer, of about equal length; in each no name is defined twice."""
    out = []
    header_names = HeaderNames(root)
    by_layer = collections.defaultdict(list)
    for file in files:
        by_layer[layer(file, root)].append(file)
    for members in by_layer.values():
        limit = -(-len(members) // -(-len(members) // most))
        open_units = []
        for file in members:
            names = Names(file, root, header_names)
            for unit in open_units:
                if len(unit) < limit and not any(names.clash(other, rename) for _, other in unit):
                    break
            else:
                unit = []
                open_units.append(unit)
            unit.append((file, names))
        out += [[file for file, _ in unit] for unit in open_units]
    return out


class HeaderNames(dict):
    """{"header.h" with its quotes: names of its types and constants, and of functions where tests include it}."""

    def __init__(self, root):
        super().__init__()
        self.root = root

    def __missing__(self, header):
        file = self.root / header.strip('"')
        for_tests = header.startswith('"tests/')  # their functions are short words, which tests have for their own, too
        self[header] = {name for name, alias in definitions(file).items()
                        if name[0].isupper() or CONSTANT.match(name) or for_tests and not alias}
        for values in PLAIN_ENUM.findall(file.read_text()):
            self[header].update(re.findall(r"\bk[A-Z]\w*", values))
        return self[header]


def unit_text(unit):
    """Includes the files of a unit. Each main() has a name of its own there, and so has a constant that several files define."""
    text = ""
    constants = collections.Counter(name for file in unit for name in definitions(file) if CONSTANT.match(name))
    first = [file for file in unit if re.search("^extern template", file.read_text(), re.M)]
    for i, file in enumerate(first + [file for file in unit if file not in first]):
        renamed = [name for name in definitions(file) if constants[name] > 1] + ["main"]
        text += "".join(f"#define {name} {name}In{i}\n" for name in renamed)
        text += f'#include "{file}"\n'
        text += "".join(f"#undef {name}\n" for name in renamed)
    return text


def headers_read(file, root):
    """All headers that `file` includes, also by ours that it includes: as they are written, with quotes or brackets."""
    found, todo = set(), [file]
    while todo:
        for ours, other in INCLUDE.findall(todo.pop().read_text()):
            name = f'"{ours}"' if ours else f"<{other}>"
            if name not in found:
                found.add(name)
                if ours and (root / ours).exists():
                    todo.append(root / ours)
    return found


def same_headers(files, root):
    """Lists of (files, headers that all of them read): files of one layer that read the same large headers."""
    groups = collections.defaultdict(list)
    for file in files:
        read = headers_read(file, root)
        groups[layer(file, root), tuple(name in read for name in LARGE_HEADERS)].append((file, read))
    return [([file for file, _ in group], sorted(set.intersection(*(read for _, read in group))))
            for group in sorted(groups.values(), key=len, reverse=True)]
