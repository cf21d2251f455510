#!/usr/bin/python3
"""VTK's vtkQuadricDecimation on the pixel grid with L*u*v* as attributes.

    vtk_decimation.py FEATURES VERTICES OUT    prints the processor time of the call as JSON
"""
import json
import resource
import sys

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkQuadricDecimation


def grid_faces(luv):
    """Two triangles a cell, split along the diagonal whose ends differ less, as imgmesh does it."""
    height, width, _ = luv.shape
    index = numpy.arange(width * height).reshape(height, width)
    a, b, c, d = (index[:-1, :-1].ravel(), index[:-1, 1:].ravel(), index[1:, :-1].ravel(), index[1:, 1:].ravel())
    flat = luv.reshape(-1, 3)
    falls = ((flat[a] - flat[d]) ** 2).sum(1) <= ((flat[b] - flat[c]) ** 2).sum(1)
    first = numpy.stack([a, c, numpy.where(falls, d, b)], 1)
    second = numpy.stack([numpy.where(falls, a, b), numpy.where(falls, d, c), numpy.where(falls, b, d)], 1)
    return numpy.concatenate([first, second])


def main(features, vertices, out):
    with open(features, "rb") as file:
        if file.read(8) != b"IMFEAT1\n":
            sys.exit(f"{features}: no file of features")
        width, height = numpy.fromfile(file, "<u4", 2)
        luv = numpy.fromfile(file, "<f4").reshape(height, width, 3)
    faces = grid_faces(luv)
    y, x = numpy.mgrid[0:height, 0:width].astype("<f4")
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.stack([x.ravel(), y.ravel(), numpy.zeros(x.size, "<f4")], 1), deep=True))
    cells = numpy.concatenate([numpy.full((len(faces), 1), 3), faces], 1).astype(numpy.int64)
    triangles = vtkCellArray()
    triangles.SetCells(len(faces), numpy_to_vtkIdTypeArray(cells.ravel(), deep=True))
    mesh = vtkPolyData()
    mesh.SetPoints(points)
    mesh.SetPolys(triangles)
    mesh.GetPointData().SetScalars(numpy_to_vtk(luv.reshape(-1, 3), deep=True))

    decimation = vtkQuadricDecimation()
    decimation.SetInputData(mesh)
    decimation.SetTargetReduction(1 - 2 * int(vertices) / len(faces))
    decimation.AttributeErrorMetricOn()
    decimation.ScalarsAttributeOn()
    before = resource.getrusage(resource.RUSAGE_SELF)
    decimation.Update()
    after = resource.getrusage(resource.RUSAGE_SELF)

    result = decimation.GetOutput()
    xy = vtk_to_numpy(result.GetPoints().GetData())[:, :2]
    colors = vtk_to_numpy(result.GetPointData().GetScalars())
    corners = vtk_to_numpy(result.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    with open(out, "wb") as file:
        file.write(b"IMMESH1\n")
        numpy.array([len(xy), len(corners)], "<u4").tofile(file)
        numpy.concatenate([xy, colors], 1).astype("<f4").tofile(file)
        corners.astype("<u4").tofile(file)
    print(json.dumps({"user_seconds": after.ru_utime - before.ru_utime,
                      "system_seconds": after.ru_stime - before.ru_stime}))


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: vtk_decimation.py FEATURES VERTICES OUT")
    main(*sys.argv[1:])
