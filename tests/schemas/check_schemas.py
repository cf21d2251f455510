#!/usr/bin/python3
"""Checks schemas/ with a standard validator.

check_schemas.py SCHEMAS            every example is as valid as its folder says; every schema has some of both
check_schemas.py SCHEMAS CONTAINERS what write_container wrote into the folder CONTAINERS is valid as well
"""
import json
import pathlib
import struct
import sys

import jsonschema

EXTENSION = "IMGMESH_pixel_map"


def load(path):
    return json.loads(path.read_text(encoding="utf-8"))


def load_schemas(folder):
    schemas = {}
    for path in sorted(folder.glob("*.schema.json")):
        schema = load(path)
        jsonschema.Draft202012Validator.check_schema(schema)
        schemas[path.name.removesuffix("schema.json")] = jsonschema.Draft202012Validator(schema)
    return schemas


def check_examples(folder, schemas):
    problems = []
    seen = set()
    for kind in ("valid", "invalid"):
        for path in sorted((folder / "examples" / kind).glob("*.json")):
            prefix = max((p for p in schemas if path.name.startswith(p)), key=len, default=None)
            if prefix is None:
                problems.append(f"{path}: no schema of this name")
                continue
            seen.add((prefix, kind))
            errors = list(schemas[prefix].iter_errors(load(path)))
            if kind == "valid" and errors:
                problems.append(f"{path}: {errors[0].message}")
            if kind == "invalid" and len(errors) != 1:
                problems.append(f"{path}: {len(errors)} errors, an invalid example shows exactly one")
    for prefix in schemas:
        for kind in ("valid", "invalid"):
            if (prefix, kind) not in seen:
                problems.append(f"{prefix}schema.json has no {kind} example")
    return problems


def gltf_document(path):
    data = path.read_bytes()
    if data[:4] == b"glTF":
        (length,) = struct.unpack_from("<I", data, 12)
        data = data[20 : 20 + length]
    return json.loads(data)


def check_containers(folder, schemas):
    problems = []
    paths = sorted([*folder.glob("*.glb"), *folder.glob("*.gltf")])
    if not paths:
        problems.append(f"{folder}: no containers")
    for path in paths:
        document = gltf_document(path)
        instances = [("glTF.", document["extensions"][EXTENSION])]
        instances += [("node.", node["extensions"][EXTENSION]) for node in document["nodes"]]
        for prefix, instance in instances:
            for error in schemas[f"{prefix}{EXTENSION}."].iter_errors(instance):
                problems.append(f"{path}: {prefix}{EXTENSION}: {error.message}")
    return problems


def main():
    folder = pathlib.Path(sys.argv[1])
    schemas = load_schemas(folder)
    if len(sys.argv) > 2:
        problems = check_containers(pathlib.Path(sys.argv[2]), schemas)
    else:
        problems = check_examples(folder, schemas)
    print("\n".join(problems))
    return 1 if problems or not schemas else 0


if __name__ == "__main__":
    sys.exit(main())
