"""Arrays to VTK and back."""

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

# Edges of a mesh sharper than this stay sharp.
FEATURE_ANGLE = 35.0


def vtk_points(positions):
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions, dtype=np.float64), deep=True))
    return points


def id_array(values):
    return numpy_to_vtkIdTypeArray(np.ascontiguousarray(values, dtype=np.int64), deep=True)


def smooth_surface(vertices, triangles):
    """Mesh with normals, smooth but for its sharp edges."""
    data = vtk.vtkPolyData()
    data.SetPoints(vtk_points(vertices))
    cells = vtk.vtkCellArray()
    cells.SetData(id_array(3 * np.arange(len(triangles) + 1)), id_array(triangles.ravel()))
    data.SetPolys(cells)
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SetFeatureAngle(FEATURE_ANGLE)
    normals.Update()
    return normals.GetOutput()


def positions_of(data):
    """[n, 3]"""
    return vtk_to_numpy(data.GetPoints().GetData())


def normals_of(data):
    """Unit vectors [n, 3]."""
    return vtk_to_numpy(data.GetPointData().GetNormals())
