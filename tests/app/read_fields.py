"""Reads the fields of a mesh cycle with VTK and checks them.

usage: read_fields.py CYCLE.pvd CENTRE_DISTANCE_MM MESH=PINION,WHEEL ...
Ends with an error where anything is wrong; prints the number of steps and of meshes.
"""
import pathlib
import sys
import xml.etree.ElementTree

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance
from vtkmodules.vtkFiltersGeneral import vtkWarpVector
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataReader


def blocks(path):
    reader = vtkXMLMultiBlockDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    output = reader.GetOutput()
    names = [output.GetMetaData(i).Get(output.NAME()) for i in range(output.GetNumberOfBlocks())]
    return {name: output.GetBlock(i) for i, name in enumerate(names)}


def fact(grid, name):
    return grid.GetFieldData().GetArray(name).GetValue(0)


def components(grid, name):
    array = grid.GetPointData().GetArray(name)
    return [array.GetComponentName(i) for i in range(array.GetNumberOfComponents())]


def values(grid, name):
    return vtk_to_numpy(grid.GetPointData().GetArray(name)).astype(float)


def check_body(grid):
    assert grid.GetNumberOfCells() > 100
    assert components(grid, "displacement_m") == ["x", "y", "z"]
    assert components(grid, "stress_Pa") == ["xx", "yy", "zz", "xy", "yz", "zx"]
    xx, yy, zz, xy, yz, zx = values(grid, "stress_Pa").T
    mises = numpy.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * (xy**2 + yz**2 + zx**2))
    assert numpy.allclose(mises, values(grid, "von_mises_Pa"), rtol=1e-5, atol=1e-5 * mises.max())


def main(course, centre_distance_mm, *meshes):
    course, a = pathlib.Path(course), float(centre_distance_mm) / 1000
    sets = xml.etree.ElementTree.parse(course).getroot().findall("Collection/DataSet")
    bodies = dict(mesh.split("=") for mesh in meshes)
    for mesh, names in bodies.items():
        steps = [(float(s.get("timestep")), course.parent / s.get("file")) for s in sets if f"/{mesh}_" in s.get("file")]
        times = numpy.array([time for time, _ in steps])
        assert len(times) >= 8 and times[0] == 0 and times[-1] < 1
        assert numpy.allclose(numpy.diff(times), 1 / len(times)), times
        turned = []
        for time, path in steps:
            found = blocks(path)
            assert list(found) == names.split(","), list(found)
            pinion, wheel = found.values()
            for grid in (pinion, wheel):
                check_body(grid)
                assert fact(grid, "mesh_phase") == time and fact(grid, "load_N") > 0
                assert 1 < fact(grid, "exaggeration") < 1e6
            print(mesh, time, gaps(pinion, wheel), file=sys.stderr)
    print(len(times), len(bodies))


def outline(grid, exaggeration):
    warp = vtkWarpVector()
    warp.SetInputData(grid)
    warp.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "displacement_m")
    warp.SetScaleFactor(exaggeration)
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputConnection(warp.GetOutputPort())
    surface.Update()
    return surface.GetOutput()


def gaps(pinion, wheel):
    return pinion.GetNumberOfPoints(), wheel.GetNumberOfPoints(), pinion.GetBounds(), wheel.GetBounds()


if __name__ == "__main__":
    main(*sys.argv[1:])
