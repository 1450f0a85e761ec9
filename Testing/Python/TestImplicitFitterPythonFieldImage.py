# SPDX-License-Identifier: BSD-3-Clause
"""f of two circles as colours, blue inside over white to red outside, its zero contour black."""
import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, the rendering itself
from vtkmodules.test import Testing
from vtkmodules.vtkFiltersCore import vtkFlyingEdges2D
from vtkmodules.vtkFiltersGeometry import vtkImageDataGeometryFilter
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

from python_testing import actor_of, classic_fitter, cloud, window_of


def circles():
    """200 points on each of two circles, with normals."""
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    normals = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    positions = np.concatenate([normals + (-1.4, 0, 0), 0.8 * normals + (1, 0.5, 0)])
    return positions, np.concatenate([normals, normals])


class TestImplicitFitterPythonFieldImage(Testing.vtkTest):
    def test_image(self):
        positions, normals = circles()
        fitter = classic_fitter(cloud(positions, normals))
        fitter.SetSolverToProgressiveIteration()
        fitter.SetMaximumNumberOfIterations(100)
        fitter.SetGridSize(60, 60, 0)
        fitter.SetSampleDimensions(300, 300, 0)
        fitter.Update()

        colours = vtkColorTransferFunction()
        colours.SetColorSpaceToDiverging()
        end = fitter.GetOffsetDistanceUsed()
        colours.AddRGBPoint(-end, 0.23, 0.3, 0.75)
        colours.AddRGBPoint(end, 0.7, 0.02, 0.15)
        field = vtkImageDataGeometryFilter()
        field.SetInputConnection(fitter.GetOutputPort())
        image = actor_of(field)
        image.GetMapper().SetLookupTable(colours)
        image.GetProperty().LightingOff()

        curve = vtkFlyingEdges2D()
        curve.SetInputConnection(fitter.GetOutputPort())
        curve.SetValue(0, 0.0)
        line = actor_of(curve)
        line.GetMapper().ScalarVisibilityOff()
        line.GetProperty().SetColor(0, 0, 0)
        line.GetProperty().SetLineWidth(2)
        line.SetPosition(0, 0, 0.01)  # in front of the colours

        window, renderer = window_of(image, line)
        renderer.ResetCamera()
        renderer.GetActiveCamera().Zoom(1.4)
        window.Render()
        Testing.compareImage(
            window, Testing.getAbsImagePath("TestImplicitFitterPythonFieldImage.png")
        )


if __name__ == "__main__":
    Testing.main([(TestImplicitFitterPythonFieldImage, "test")])
