# SPDX-License-Identifier: BSD-3-Clause
"""The filters from NumPy arrays, one round at a time."""

from dataclasses import dataclass
import time

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from ipia import vtkFairingPIACurveFilter, vtkFairingPIASurfaceFilter

# The paper's bound of the iteration error was lost; with this one the numbers of iterations are near
# those of its Table 1.
TOLERANCE = 1e-3
MOST_ITERATIONS = 20000


@dataclass
class Round:
    """What a round of fairing-PIA gave, and the control points to go on with."""

    output: object  # vtkPolyData: the samples
    controls: object  # vtkPolyData: the control points
    fitting_error: float
    energy: float
    iterations: int
    seconds: float
    iteration_errors: np.ndarray
    fitting_errors: np.ndarray
    energies: np.ndarray
    warnings: list

    def array(self, name):
        return vtk_to_numpy(self.output.GetPointData().GetArray(name))

    @property
    def points(self):
        return vtk_to_numpy(self.output.GetPoints().GetData())

    @property
    def control_count(self):
        return self.controls.GetNumberOfPoints()

    @property
    def knots(self):
        return vtk_to_numpy(self.controls.GetFieldData().GetArray("Knots"))


def fair_curve(points, *, weights=1e-6, closed=False, controls=0, order=2, start=None, knots=(),
               samples=0, direct=False, parametrization="Chord", **more):
    """
    One round on ordered points (m, 3). weights: one number, or one per control point of the start
    (another round); knots are inserted first.
    """
    fair = vtkFairingPIACurveFilter()
    fair.SetInputData(_polyline(points, closed))
    fair.SetNumberOfControlPoints(controls)
    fair.SetSampleDimensions(samples)
    for knot in knots:
        fair.InsertKnot(knot)
    return _run(fair, weights, order, start, direct, parametrization, **more)


def fair_surface(points, size, *, weights=1e-6, controls=(0, 0), start=None, samples=(0, 0),
                 direct=False, parametrization="Chord", **more):
    """One round on a grid of points (m, 3), the first axis of size (u, v) fastest."""
    grid = vtk.vtkStructuredGrid()
    grid.SetDimensions(*size, 1)
    grid.SetPoints(_points(points))
    fair = vtkFairingPIASurfaceFilter()
    fair.SetInputData(grid)
    fair.SetNumberOfControlPoints(*controls)
    fair.SetSampleDimensions(*samples)
    return _run(fair, weights, 2, start, direct, parametrization, **more)


def _run(fair, weights, order, start, direct, parametrization, tolerance=TOLERANCE,
         iterations=MOST_ITERATIONS, step_size=0):
    fair.SetDerivativeOrder(order)
    getattr(fair, f"SetParametrizationTo{parametrization}")()
    fair.SetTolerance(tolerance)
    fair.SetMaximumNumberOfIterations(iterations)
    fair.SetStepSize(step_size)
    if direct:
        fair.SetSolverToSparseDirect()
    if start is not None:
        controls = vtk.vtkPolyData()
        controls.DeepCopy(start.controls)
        array = vtk_to_numpy(controls.GetPointData().GetArray("FairingWeight"))
        array[:] = weights
        fair.SetControlPointsData(controls)
    elif np.ndim(weights) == 0:
        fair.SetFairingWeight(weights)
    else:
        raise ValueError("weights of control points need a start that has them")
    warnings = []

    def keep(caller, event, text):
        warnings.append(text.strip().splitlines()[-1])

    keep.CallDataType = vtk.VTK_STRING
    fair.AddObserver("WarningEvent", keep)
    begin = time.perf_counter()
    fair.Update()
    seconds = time.perf_counter() - begin
    output = vtk.vtkPolyData()
    output.ShallowCopy(fair.GetOutput())
    controls = vtk.vtkPolyData()
    controls.ShallowCopy(fair.GetOutputDataObject(1))
    field = output.GetFieldData()
    if field.GetArray("IterationErrorHistory") is None:
        raise RuntimeError("the filter refused; see its message")
    history = [vtk_to_numpy(field.GetArray(name)).copy() for name in
               ("IterationErrorHistory", "FittingErrorHistory", "FairingEnergyHistory")]
    return Round(output, controls, fair.GetFittingError(), fair.GetFairingEnergy(),
                 fair.GetNumberOfIterationsUsed(), seconds, *history, warnings)


def _points(positions):
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions, dtype=float), deep=True))
    return points


def _polyline(positions, closed):
    data = vtk.vtkPolyData()
    data.SetPoints(_points(positions))
    lines = vtk.vtkCellArray()
    count = len(positions)
    lines.InsertNextCell(count + int(closed))
    for k in range(count):
        lines.InsertCellPoint(k)
    if closed:
        lines.InsertCellPoint(0)
    data.SetLines(lines)
    return data
