#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Points without normals: estimate them, turn them to one side, reconstruct the surface.

    python3 EstimateNormals.py kitten.xyz oni.pwn mesh.off

The normals (or faces) that a file has are only used to tell how many of the estimated ones are right.
"""
import os
import sys

import numpy as np
from ipia import vtkIPIASurfaceReconstruction
from ipia_2019.meshes import mesh_polydata
from reconstruct import (number_of_components, number_of_open_edges, polydata, read,
                         share_pointing_outward, with_normals)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkReverseSense
from vtkmodules.vtkFiltersPoints import vtkPCANormalEstimation

NEIGHBOURS = 16


def estimate(points):
    """The points with normals of their neighbours, all on the same side, and outward."""
    normals = vtkPCANormalEstimation()
    normals.SetInputData(points)
    normals.SetSampleSize(NEIGHBOURS)
    normals.SetNormalOrientationToGraphTraversal()  # each like its neighbours', from point to point
    normals.Update()
    result = normals.GetOutput()
    outward = share_pointing_outward(*arrays(result))
    if outward < 0.5:  # which of the two sides came first is left to chance
        turn = vtkReverseSense()
        turn.SetInputData(result)
        turn.ReverseCellsOff()
        turn.ReverseNormalsOn()
        turn.Update()
        result = turn.GetOutput()
    return result


def arrays(data):
    """Points and normals as (n, 3) arrays."""
    points, normals = data.GetPoints().GetData(), data.GetPointData().GetNormals()
    return vtk_to_numpy(points).astype(float), vtk_to_numpy(normals).astype(float)


print("file                points  right side  angle  components  open edges")
for path in sys.argv[1:]:
    given = mesh_polydata(path) if path.endswith(".off") else read(path)
    points, true_normals = arrays(with_normals(given)[0])
    true_normals /= np.maximum(np.linalg.norm(true_normals, axis=1, keepdims=True), 1e-30)
    middle, size = points.mean(axis=0), np.ptp(points, axis=0).max()

    reconstruction = vtkIPIASurfaceReconstruction()
    data = estimate(polydata((points - middle) / size))  # vtkPCANormalEstimation is in float
    reconstruction.SetInputData(data)
    reconstruction.Update()
    surface = reconstruction.GetOutput()

    cosine = np.sum(arrays(data)[1] * true_normals, axis=1)
    angle = np.degrees(np.median(np.arccos(np.minimum(np.abs(cosine), 1))))
    print(f"{os.path.basename(path):<18} {len(points):>7} {100 * np.mean(cosine > 0):9.2f} % "
          f"{angle:5.1f}° {number_of_components(surface):>11} "
          f"{number_of_open_edges(surface):>11}")
