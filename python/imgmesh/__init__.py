"""Raster images as small triangle meshes with a pixel map.

    import imgmesh
    mesh = imgmesh.build("photo.png", faces=4000)
    mesh.write("photo.glb")
    imgmesh.write_image("drawn.png", mesh.reconstruct())

Parameters, colours and files are those of the imgmesh tools. The page python.md of the documentation has examples.
"""
from ._errors import (ArgumentError, BadFileError, Error, FileError, InternalError, OutOfMemoryError, UnsupportedError,
                      Warning)
from ._imgmesh import (NO_FACE, Comparison, Image, Level, Mesh, Segmentation, __version__, build, build_parameters,
                       compare, decode, encode, read, read_image, write_image)

__all__ = [
    "NO_FACE", "ArgumentError", "BadFileError", "Comparison", "Error", "FileError", "Image", "InternalError", "Level",
    "Mesh", "OutOfMemoryError", "Segmentation", "UnsupportedError", "Warning", "__version__", "build",
    "build_parameters", "compare", "decode", "encode", "read", "read_image", "write_image",
]
for _name in __all__:
    if hasattr(globals()[_name], "__module__"):
        globals()[_name].__module__ = "imgmesh"
del _name
