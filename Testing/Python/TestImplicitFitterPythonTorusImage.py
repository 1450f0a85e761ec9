# SPDX-License-Identifier: BSD-3-Clause
"""A torus from points."""
import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, the rendering itself
from vtkmodules.test import Testing
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

from python_testing import actor_of, classic_fitter, cloud, window_of


def torus(ring, tube, count):
    """Points at equal steps of both angles, with normals."""
    u, v = np.meshgrid(
        np.linspace(0, 2 * np.pi, 2 * count, endpoint=False),
        np.linspace(0, 2 * np.pi, count, endpoint=False),
    )
    u, v = u.ravel(), v.ravel()
    normals = np.stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)], axis=1)
    centres = ring * np.stack([np.cos(u), np.sin(u), 0 * u], axis=1)
    return centres + tube * normals, normals


class TestImplicitFitterPythonTorusImage(Testing.vtkTest):
    def test_image(self):
        positions, normals = torus(1, 0.4, 60)
        fitter = classic_fitter(cloud(positions, normals))
        fitter.SetGridSize(40, 40, 40)
        surface = vtkFlyingEdges3D()
        surface.SetInputConnection(fitter.GetOutputPort())
        surface.SetValue(0, 0.0)

        actor = actor_of(surface)
        actor.GetMapper().ScalarVisibilityOff()
        actor.GetProperty().SetColor(0.9, 0.6, 0.3)
        window, renderer = window_of(actor)
        camera = renderer.GetActiveCamera()
        camera.SetPosition(0, -2, 1.5)
        camera.SetViewUp(0, 0, 1)
        renderer.ResetCamera()
        camera.Zoom(1.4)
        window.Render()
        Testing.compareImage(
            window, Testing.getAbsImagePath("TestImplicitFitterPythonTorusImage.png")
        )


if __name__ == "__main__":
    Testing.main([(TestImplicitFitterPythonTorusImage, "test")])
