# SPDX-License-Identifier: BSD-3-Clause
"""Points with unit normals, and what the figures do to them: normalise, thin out, disturb."""

from dataclasses import dataclass

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

VECTOR_LENGTH_TINY = 1e-30


@dataclass(frozen=True)
class Cloud:
    """n points and n unit normals, both of shape (n, 3); planar models have z = 0."""

    points: np.ndarray
    normals: np.ndarray

    def __len__(self):
        return len(self.points)

    def select(self, mask_or_indices):
        return Cloud(self.points[mask_or_indices], self.normals[mask_or_indices])

    def normalised(self):
        """Centred at the origin, longest side of the bounding box 1."""
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        return Cloud((self.points - (low + high) / 2) / (high - low).max(), self.normals)

    def offset(self, distance):
        """The points moved by a distance along their normals."""
        return self.points + distance * self.normals

    def with_noise(self, deviation, random):
        """Gaussian noise on every coordinate; the normals stay as they were."""
        return Cloud(self.points + random.normal(0, deviation, self.points.shape), self.normals)

    def random_subset(self, count, random):
        return self.select(np.sort(random.choice(len(self), count, replace=False)))

    def polydata(self):
        data = points_polydata(self.points)
        normals = numpy_to_vtk(self.normals, deep=True)
        normals.SetName("Normals")
        data.GetPointData().SetNormals(normals)
        return data


def unit(vectors):
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / np.maximum(lengths, VECTOR_LENGTH_TINY)


def points_polydata(points, values=None):
    """Points without cells, on request with active scalars."""
    vtk_points = vtk.vtkPoints()
    vtk_points.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=float), deep=True))
    data = vtk.vtkPolyData()
    data.SetPoints(vtk_points)
    if values is not None:
        scalars = numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True)
        scalars.SetName("Values")
        data.GetPointData().SetScalars(scalars)
    return data
