"""Reads the fields of a mesh cycle of plane bodies with VTK and checks them.

usage: read_fields.py CYCLE.pvd MESH=PINION,WHEEL ...
Ends with an error where anything is wrong; prints the number of steps and of meshes.
"""
import pathlib
import sys
import xml.etree.ElementTree

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkStaticCellLocator
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkFeatureEdges
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


def boundary(grid, exaggeration):
    """Points and edges of the outline of a plane body with its displacements, and its cells."""
    warp = vtkWarpVector()
    warp.SetInputData(grid)
    warp.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "displacement_m")
    warp.SetScaleFactor(exaggeration)
    faces = vtkDataSetSurfaceFilter()
    faces.SetInputConnection(warp.GetOutputPort())
    joined = vtkCleanPolyData()  # sectors have vertices of their own
    joined.SetInputConnection(faces.GetOutputPort())
    joined.ToleranceIsAbsoluteOn()
    joined.SetAbsoluteTolerance(1e-7 * exaggeration)
    edges = vtkFeatureEdges()
    edges.SetInputConnection(joined.GetOutputPort())
    edges.FeatureEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.Update()
    found = edges.GetOutput()
    points = vtk_to_numpy(found.GetPoints().GetData())[:, :2].astype(float)
    return points, vtk_to_numpy(found.GetLines().GetConnectivityArray()).reshape(-1, 2), joined.GetOutput()


def gap(pinion, wheel, pinion_factor, wheel_factor):
    """m, between the outlines; negative: how deep the pinion stands in the wheel."""
    points, _, _ = boundary(pinion, pinion_factor)
    places, edges, faces = boundary(wheel, wheel_factor)
    locator = vtkStaticCellLocator()
    locator.SetDataSet(faces)
    locator.BuildLocator()
    begin, along = places[edges[:, 0]], places[edges[:, 1]] - places[edges[:, 0]]
    least = numpy.inf
    for point in points:
        share = numpy.clip(((point - begin) * along).sum(1) / (along**2).sum(1), 0, 1)
        distance = numpy.linalg.norm(begin + share[:, None] * along - point, axis=1).min()
        least = min(least, -distance if locator.FindCell([*point, 0.0]) >= 0 else distance)
    return least


def check_touch(pinion, wheel):
    """Flanks touch with and without load. What is left is the flattening beside the contact, which elements do not
    resolve: 0.03 to 0.16 of the largest displacement. Against its load the pinion overlaps by most of that."""
    moved = max(numpy.linalg.norm(values(grid, "displacement_m"), axis=1).max() for grid in (pinion, wheel))
    at_rest, loaded, reversed_load = (gap(pinion, wheel, *factors) / moved for factors in ((0, 0), (1, 1), (-1, 1)))
    assert abs(at_rest) < 0.2 and abs(loaded) < 0.25 and reversed_load < -0.5, (at_rest, loaded, reversed_load)


def main(course, *meshes):
    course = pathlib.Path(course)
    sets = xml.etree.ElementTree.parse(course).getroot().findall("Collection/DataSet")
    for mesh, names in (mesh.split("=") for mesh in meshes):
        steps = [(float(s.get("timestep")), course.parent / s.get("file")) for s in sets if f"/{mesh}_" in s.get("file")]
        times = numpy.array([time for time, _ in steps])
        assert len(times) >= 8 and times[0] == 0 and numpy.allclose(numpy.diff(times), 1 / len(times)), times
        factors = set()
        for number, (time, path) in enumerate(steps):
            found = blocks(path)
            assert list(found) == names.split(","), list(found)
            for grid in found.values():
                check_body(grid)
                assert fact(grid, "mesh_phase") == time and fact(grid, "load_N") > 0 and fact(grid, "wheel_tooth") == 0
            factors |= {fact(grid, "exaggeration") for grid in found.values()}
            if number % 4 == 0:
                check_touch(*found.values())
        assert len(factors) == 1 and 1 < factors.pop() < 1e6
    print(len(steps), len(meshes))


if __name__ == "__main__":
    main(*sys.argv[1:])
