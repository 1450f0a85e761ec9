# SPDX-License-Identifier: BSD-3-Clause
"""One fit with the settings of the paper, and what is said about it."""

from dataclasses import dataclass, replace
import time

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from ipia import vtkIPIAImplicitFitter, vtkIPIAImplicitFunction

# The paper gives no domain: the points' box and this margin, in units of its longest side.
MARGIN = 0.1
OFFSET_DISTANCE = 0.1
OFFSET_VALUE = 0.01
TOLERANCE = 1e-7
# Where the tolerance ends an iteration, and not the number of iterations.
MOST_ITERATIONS = 100000
SAMPLES_PER_SPACING = 8


@dataclass(frozen=True)
class Settings:
    """tau None: the B-spline basis. tolerance 0: all iterations are done."""

    grid: int
    tau: float = None
    weight: float = 0.0
    as_printed: bool = True
    iterations: int = MOST_ITERATIONS
    tolerance: float = TOLERANCE

    def but(self, **changes):
        return replace(self, **changes)


@dataclass(frozen=True)
class Fit:
    """
    field and contour are of the spline alone, without the filter's far field; extra are the loops
    and open lines of f = 0 beside one.
    """

    field: vtk.vtkImageData
    contour: vtk.vtkPolyData
    extra: int
    iterations: int
    energy: float
    max_error: float
    average_error: float
    oscillation: float
    smallest_weight: float
    largest_weight: float
    largest_distance: float
    seconds: float


def fit(cloud, settings):
    """Returns the fit, or the message of the refusal."""
    fitter = new_fitter(cloud)
    errors = []

    def record(_caller, _event, text):
        errors.append(text.split("): ", 1)[-1].strip())
    record.CallDataType = vtk.VTK_STRING
    fitter.AddObserver("ErrorEvent", record)
    prepare(fitter, cloud, settings)
    start = time.perf_counter()
    fitter.Update()
    seconds = time.perf_counter() - start
    if errors:
        return errors[0]
    field = _spline_alone(fitter)
    contour = contour_of(field)
    weights = fitter.GetOutputDataObject(2).GetPointData().GetArray("Weight")
    low, high = weights.GetRange() if weights else (1.0, 1.0)
    return Fit(field=field, contour=contour, extra=extra_loops(contour),
               iterations=fitter.GetNumberOfIterationsUsed(), energy=fitter.GetEnergy(),
               max_error=fitter.GetMaximumError(), average_error=fitter.GetAverageError(),
               oscillation=fitter.GetOscillation(), smallest_weight=low, largest_weight=high,
               largest_distance=largest_distance(fitter), seconds=seconds)


def new_fitter(cloud):
    """Nothing set; warnings (of regions with both signs around them) are not shown."""
    fitter = vtkIPIAImplicitFitter()
    fitter.AddObserver("WarningEvent", lambda *_: None)
    fitter.SetInputData(cloud.polydata())
    return fitter


def apply_domain(fitter, cloud, settings):
    low, high = cloud.points.min(axis=0), cloud.points.max(axis=0)
    margin = MARGIN * (high - low).max()
    fitter.SetModelBounds(low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin, 0, 0)
    fitter.SetGridSize(settings.grid, settings.grid, 0)
    samples = SAMPLES_PER_SPACING * (settings.grid - 3) + 1
    fitter.SetSampleDimensions(samples, samples, 0)
    fitter.SetOutputScalarTypeToDouble()


def prepare(fitter, cloud, settings):
    apply_domain(fitter, cloud, settings)
    fitter.SetNumberOfLevels(1)
    fitter.SetNormalConstraintToTwoSidedOffset()
    fitter.SetOffsetDistance(OFFSET_DISTANCE)
    fitter.SetOffsetValue(OFFSET_VALUE)
    fitter.SetSolverToProgressiveIteration()
    fitter.SetMaximumNumberOfIterations(settings.iterations)
    fitter.SetStoppingRuleToEnergyChange()
    fitter.SetTolerance(settings.tolerance)
    if settings.tau is not None:
        fitter.SetBasisTypeToUniformRational()
        fitter.SetWeightStepSize(settings.tau)
    fitter.SetOscillationWeight(settings.weight)
    if settings.as_printed:
        fitter.SetOscillationStepToAsPrinted()


def _spline_alone(fitter):
    """The image of f without the far field, by a control lattice without it."""
    lattice = vtk.vtkImageData()
    lattice.ShallowCopy(fitter.GetOutputDataObject(2))
    lattice.GetFieldData().Initialize()
    function = vtkIPIAImplicitFunction()
    function.SetControlLattice(lattice)
    image = vtk.vtkImageData()
    image.CopyStructure(fitter.GetOutput())
    values = vtk.vtkDoubleArray()
    values.SetName("f")
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    points.SetNumberOfPoints(image.GetNumberOfPoints())
    for i in range(image.GetNumberOfPoints()):
        points.SetPoint(i, image.GetPoint(i))
    function.FunctionValue(points.GetData(), values)
    image.GetPointData().SetScalars(values)
    return image


def contour_of(field):
    contour = vtk.vtkFlyingEdges2D()
    contour.SetInputData(field)
    contour.SetValue(0, 0.0)
    contour.Update()
    return contour.GetOutput()


def extra_loops(contour):
    components = vtk.vtkPolyDataConnectivityFilter()
    components.SetInputData(contour)
    components.SetExtractionModeToAllRegions()
    components.Update()
    return components.GetNumberOfExtractedRegions() - 1


def largest_distance(fitter):
    """The largest distance of a point from the curve, to first order: |f| / |grad f|."""
    distances = fitter.GetOutputDataObject(1).GetPointData().GetArray("Distance")
    return np.abs(vtk_to_numpy(distances)).max()
