"""blender -b --python blender_facts.py -- OUT.npz CONTAINER...: what Blender's importer makes of each level of each
container, by names as "0/lod1/corners": the places of the faces' corners in the scene (F, 3, 3), their linear colours
(F, 3, 4), and the faces' normals (F, 3); and the numbers of vertices."""
import pathlib
import sys

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs" / "blender"))
from render_container import import_container  # noqa: E402


def facts_of(item):
    mesh, matrix = item.data, np.array(item.matrix_world)
    if any(len(polygon.vertices) != 3 for polygon in mesh.polygons):
        sys.exit("a face is no triangle")
    vertices = np.array([vertex.co for vertex in mesh.vertices])
    corners = vertices[[loop.vertex_index for loop in mesh.loops]] @ matrix[:3, :3].T + matrix[:3, 3]
    (attribute,) = mesh.color_attributes
    if attribute.domain != "CORNER":
        sys.exit(f"colours are at each {attribute.domain}")
    # .color is linear light, whatever is stored.
    colours = np.array([entry.color for entry in attribute.data])
    return {"vertices": len(vertices), "corners": corners.reshape(-1, 3, 3), "colours": colours.reshape(-1, 3, 4),
            "normals": np.array([polygon.normal for polygon in mesh.polygons])}


def main(output, *containers):
    facts = {}
    for index, path in enumerate(containers):
        for name, item in import_container(path).items():
            facts.update({f"{index}/{name}/{key}": value for key, value in facts_of(item).items()})
    np.savez(output, **facts)


if __name__ == "__main__":
    main(*sys.argv[sys.argv.index("--") + 1:])
