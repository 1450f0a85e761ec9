# SPDX-License-Identifier: BSD-3-Clause
"""The analytic surface models: points on F = 0 with the normals grad F / |grad F|."""

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from .cloud import Cloud, unit

TORUS_RADII = (1.0, 0.4)
TORUS_ROWS = 100
DOUBLE_TORUS_THICKNESS = 0.03
DOUBLE_TORUS_BOX = ((-0.3, 2.3), (-0.8, 0.8), (-0.3, 0.3))
DOUBLE_TORUS_SPACING = 0.02
GYROID_BOX = ((0.0, 3 * np.pi),) * 3
GYROID_SPACING = 3 * np.pi / 110
NEWTON_STEPS = 4


def torus(count):
    """A product grid of the two angles, TORUS_ROWS around the tube (count is a multiple of it)."""
    ring, tube = TORUS_RADII
    u, v = np.meshgrid(2 * np.pi * np.arange(count // TORUS_ROWS) / (count // TORUS_ROWS),
                       2 * np.pi * np.arange(TORUS_ROWS) / TORUS_ROWS, indexing="ij")
    u, v = u.ravel(), v.ravel()
    normals = np.column_stack((np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)))
    centres = ring * np.column_stack((np.cos(u), np.sin(u), np.zeros_like(u)))
    return Cloud(centres + tube * normals, normals).normalised()


def double_torus(count):
    """(x (x - 1)^2 (x - 2) + y^2)^2 + z^2 = constant, evenly covered by few points."""
    points = _on_surface(_double_torus, DOUBLE_TORUS_BOX, DOUBLE_TORUS_SPACING)
    return _oriented(_double_torus, points[_farthest_points(points, count)]).normalised()


def gyroid(count, random):
    """sin x cos y + sin y cos z + sin z cos x = 0 in a cube: an open surface that ends at the box."""
    points = _on_surface(_gyroid, GYROID_BOX, GYROID_SPACING)
    cloud = _oriented(_gyroid, points)
    return cloud.random_subset(count, random).normalised()


def _double_torus(x, y, z):
    """F and its gradient."""
    p = x * (x - 1)**2 * (x - 2) + y**2
    value = p**2 + z**2 - DOUBLE_TORUS_THICKNESS
    p_x = (x - 1)**2 * (x - 2) + 2 * x * (x - 1) * (x - 2) + x * (x - 1)**2
    return value, np.column_stack((2 * p * p_x, 4 * p * y, 2 * z))


def _gyroid(x, y, z):
    value = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    return value, np.column_stack((np.cos(x) * np.cos(y) - np.sin(z) * np.sin(x),
                                   np.cos(y) * np.cos(z) - np.sin(x) * np.sin(y),
                                   np.cos(z) * np.cos(x) - np.sin(y) * np.sin(z)))


def _on_surface(function, box, spacing):
    """The vertices of a contour of F = 0, drawn onto it by Newton steps."""
    axes = [np.arange(low, high + spacing / 2, spacing) for low, high in box]
    z, y, x = np.meshgrid(*axes[::-1], indexing="ij")
    values, _ = function(x.ravel(), y.ravel(), z.ravel())
    image = vtk.vtkImageData()
    image.SetOrigin([low for low, _ in box])
    image.SetSpacing(spacing, spacing, spacing)
    image.SetDimensions([len(axis) for axis in axes])
    image.GetPointData().SetScalars(numpy_to_vtk(values, deep=True))
    contour = vtk.vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, 0.0)
    contour.Update()
    points = vtk_to_numpy(contour.GetOutput().GetPoints().GetData()).astype(float)
    for _ in range(NEWTON_STEPS):
        value, gradient = function(*points.T)
        points = points - value[:, None] * gradient / (gradient**2).sum(axis=1)[:, None]
    low, high = np.array(box).T
    return points[((points >= low) & (points <= high)).all(axis=1)]


def _oriented(function, points):
    return Cloud(points, unit(function(*points.T)[1]))


def _farthest_points(points, count):
    """Indices of count points, each the one farthest from those before it."""
    chosen = [0]
    distance = np.full(len(points), np.inf)
    while len(chosen) < count:
        step = points - points[chosen[-1]]
        distance = np.minimum(distance, np.einsum("ij,ij->i", step, step))
        chosen.append(int(distance.argmax()))
    return np.array(chosen)
