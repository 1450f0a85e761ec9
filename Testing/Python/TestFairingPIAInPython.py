# SPDX-License-Identifier: BSD-3-Clause
"""The fairing filters from Python: NumPy in and out, a refusal, rounds."""
import numpy as np
from vtkmodules.numpy_interface import dataset_adapter as dsa
from vtkmodules.test import Testing
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkStructuredGrid

from ipia import vtkFairingPIACurveFilter, vtkFairingPIAFilter, vtkFairingPIASurfaceFilter
from python_testing import vtk_points


def circle(count=100):
    """A closed polyline on the unit circle."""
    angle = 2 * np.pi * np.arange(count) / count
    data = vtkPolyData()
    data.SetPoints(vtk_points(np.column_stack((np.cos(angle), np.sin(angle), 0 * angle))))
    lines = vtkCellArray()
    lines.InsertNextCell(count + 1)
    for k in range(count + 1):
        lines.InsertCellPoint(k % count)
    data.SetLines(lines)
    return data


class TestFairingPIAInPython(Testing.vtkTest):
    def test_refusal(self):
        messages = []
        fair = vtkFairingPIACurveFilter()
        fair.AddObserver("ErrorEvent", lambda caller, event: messages.append(event))
        fair.SetInputData(vtkPolyData())
        fair.Update()
        self.assertEqual(messages, ["ErrorEvent"])
        self.assertEqual(fair.GetOutput().GetNumberOfPoints(), 0)

    def test_curve(self):
        fair = vtkFairingPIACurveFilter()
        fair.SetInputData(circle())
        fair.SetNumberOfControlPoints(60)
        fair.SetFairingWeight(1e-10)
        fair.SetSampleDimensions(500)
        fair.Update()
        curve = dsa.WrapDataObject(fair.GetOutput())
        self.assertEqual(curve.PointData["Curvature"].shape, (500,))
        self.assertLess(np.abs(curve.PointData["Curvature"] - 1).max(), 1e-3)
        self.assertLess(np.abs(curve.PointData["CurvatureNormal"] + curve.Points).max(), 1e-3)
        history = curve.FieldData["IterationErrorHistory"]
        self.assertEqual(len(history), fair.GetNumberOfIterationsUsed() + 1)
        self.assertLess(history[-1], 1e-6)

    def test_rounds_change_weights(self):
        fair = vtkFairingPIACurveFilter()
        fair.SetInputData(circle())
        fair.Update()
        controls = vtkPolyData()
        controls.DeepCopy(fair.GetOutputDataObject(1))
        vtk_to_numpy(controls.GetPointData().GetArray("FairingWeight"))[:10] = 1e-4
        fair.SetControlPointsData(controls)
        fair.InsertKnot(0.5)
        fair.Update()
        used = dsa.WrapDataObject(fair.GetOutputDataObject(1)).PointData["FairingWeight"]
        self.assertEqual(len(used), controls.GetNumberOfPoints() + 1)
        self.assertEqual(used[5], 1e-4)

    def test_surface(self):
        u, v = np.meshgrid(np.linspace(0, 1, 40), np.linspace(0, 1, 30))
        grid = vtkStructuredGrid()
        grid.SetDimensions(40, 30, 1)
        grid.SetPoints(vtk_points(np.column_stack(
            (2 * np.cos(u.ravel()), 2 * np.sin(u.ravel()), v.ravel()))))
        fair = vtkFairingPIASurfaceFilter()
        fair.SetInputData(grid)
        fair.SetFairingWeight(1e-9)
        fair.SetSolver(vtkFairingPIAFilter.SparseDirect)
        fair.SetSampleDimensions(21, 31)
        fair.Update()
        surface = dsa.WrapDataObject(fair.GetOutput())
        middle = np.abs(surface.PointData["MeanCurvature"].reshape(31, 21)[5:-5, 5:-5])
        self.assertLess(np.abs(middle - 0.25).max(), 1e-3)
        self.assertEqual(surface.PointData["Normals"].shape, (21 * 31, 3))


if __name__ == "__main__":
    Testing.main([(TestFairingPIAInPython, "test")])
