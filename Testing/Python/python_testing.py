# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the package share: points as VTK has them, fitters, and a window."""
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow

from ipia import vtkIPIAImplicitFitter


def vtk_points(positions):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions), deep=True))
    return points


def cloud(positions, normals):
    data = vtkPolyData()
    data.SetPoints(vtk_points(positions))
    array = numpy_to_vtk(normals, deep=True)
    array.SetName("Normals")
    data.GetPointData().SetNormals(array)
    return data


def classic_fitter(data):
    """The method of one level, with few iterations for a quick test."""
    fitter = vtkIPIAImplicitFitter()
    fitter.SetNumberOfLevels(1)
    fitter.SetNormalConstraintToTwoSidedOffset()
    fitter.SetSolverToConjugateGradient()
    fitter.SetMaximumNumberOfIterations(15)
    fitter.SetInputData(data)
    return fitter


def actor_of(algorithm):
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(algorithm.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    return actor


def window_of(*actors):
    """A window of 300 x 300 pixels on a white ground, and its renderer."""
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    for actor in actors:
        renderer.AddActor(actor)
    window = vtkRenderWindow()
    window.SetSize(300, 300)
    window.SetMultiSamples(0)
    window.AddRenderer(renderer)
    return window, renderer
