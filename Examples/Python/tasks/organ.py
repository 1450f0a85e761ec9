#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Organ: the segmented liver of a CT as a smooth surface, without the steps of its voxels.

    python3 organ.py --data build/data

The segmentation is images/liver.inr.gz of Debian's package libcgal-demo.
"""
import gzip
import sys

from common import SCALE, dots, light, lines, options, points_of, shaded, show, write
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from ipia import vtkIPIASurfaceReconstruction
from ipia_2019.drawing import BLUE, INK, RED, Sheet, View
from reconstruct import distances, number_of_components, number_of_open_edges, polydata

LIVER = 255  # its label
SMOOTH = 1.5  # standard deviation of the normals' smoothing, in voxels of the slices' spacing
COARSE = 60  # coefficients along x of a planar fit that does not follow the steps of the voxels
CLOSE_UP = (0.2, 0.9, 0)  # near the place that the picture shows, in sides of the slice
HEADER = 256  # bytes of an .inr file


def read_labels(path):
    """The labels as an array (z, y, x) and the size of a voxel (x, y, z) in mm."""
    with gzip.open(path) as file:
        data = file.read()
    header = dict(line.split("=", 1) for line in data[:HEADER].decode().splitlines() if "=" in line)
    shape = [int(header[key]) for key in ("ZDIM", "YDIM", "XDIM")]
    voxel = np.array([float(header[key]) for key in ("VX", "VY", "VZ")])
    return np.frombuffer(data[HEADER:], dtype=np.uint8).reshape(shape), voxel


def part_with(mask, margin):
    """The box of the voxels that are set, with a margin."""
    box = []
    for axis in range(3):
        used = np.flatnonzero(mask.any(axis=tuple(k for k in range(3) if k != axis)))
        box.append(slice(max(used[0] - margin, 0), used[-1] + margin + 1))
    return mask[tuple(box)]


def smooth_gradient(mask, voxel):
    """The gradient of the mask, smoothed as far on all axes, as an array (z, y, x, 3)."""
    image = vtk.vtkImageData()
    image.SetDimensions(mask.shape[::-1])
    image.SetSpacing(voxel)
    image.GetPointData().SetScalars(numpy_to_vtk(mask.astype(np.float32).ravel(), deep=True))
    smooth = vtk.vtkImageGaussianSmooth()
    smooth.SetInputData(image)
    smooth.SetStandardDeviations(*(SMOOTH * voxel.max() / voxel))
    gradient = vtk.vtkImageGradient()
    gradient.SetInputConnection(smooth.GetOutputPort())
    gradient.SetDimensionality(3)
    gradient.Update()
    values = vtk_to_numpy(gradient.GetOutput().GetPointData().GetScalars())
    return values.reshape(*mask.shape, 3)


def boundary(mask, voxel):
    """The middles between voxels inside and their neighbours outside, with normals outward."""
    gradient = smooth_gradient(mask, voxel)
    points, normals = [], []
    for axis in range(3):  # z, y, x
        first, second = ([slice(None)] * 3 for _ in range(2))
        first[axis], second[axis] = slice(None, -1), slice(1, None)
        first, second = tuple(first), tuple(second)
        at = np.argwhere(mask[first] != mask[second])
        one = tuple(at.T)
        step = np.eye(3, dtype=int)[axis]
        other = tuple((at + step).T)
        points.append((at + step / 2)[:, ::-1] * voxel)
        normals.append(-(gradient[one] + gradient[other]))
    return polydata(np.vstack(points), np.vstack(normals))


def slice_contour(mask, voxel, z):
    """Boundary points of one slice with normals in its plane: the input of a planar fit."""
    data = boundary(np.repeat(mask[z][None], 3, axis=0), voxel)
    points = points_of(data)
    middle = points[:, 2] == voxel[2]  # the copies above and below make the gradient planar
    normals = vtk_to_numpy(data.GetPointData().GetNormals())[middle] * (1, 1, 0)
    return polydata(points[middle], normals)


def volume_of(surface):
    mass = vtk.vtkMassProperties()
    mass.SetInputData(surface)
    mass.Update()
    return mass.GetVolume()


def main():
    given = options(__doc__.splitlines()[0])
    labels, voxel = read_labels(given.data / "images" / "liver.inr.gz")
    mask = part_with(labels == LIVER, 4)
    show("voxel, mm", *(f"{v:.3f}" for v in voxel))
    points = boundary(mask, voxel)
    show("boundary points", points.GetNumberOfPoints())
    reconstruction = vtkIPIASurfaceReconstruction()
    reconstruction.SetInputData(points)
    reconstruction.Update()
    surface, fitter = reconstruction.GetOutput(), reconstruction.GetFitter()
    show("GridSize", *fitter.GetGridSizeUsed())
    show("noise found, mm", f"{fitter.GetNoiseFound():.2f}")
    show("smoothing length, mm", f"{fitter.GetSmoothingLengthUsed():.2f}")
    show("components", number_of_components(surface))
    show("left out", reconstruction.GetNumberOfComponentsLeftOut())
    show("open edges", number_of_open_edges(surface))
    apart = distances(points_of(points)[::10], surface)
    show("distance of the points, mean and 99 %, mm",
         *(f"{v:.2f}" for v in (apart.mean(), np.percentile(apart, 99))))
    voxels = np.count_nonzero(mask) * np.prod(voxel)
    show("volume of the voxels, ml", f"{voxels / 1000:.1f}")
    show("volume of the surface, ml", f"{volume_of(surface) / 1000:.1f}")

    profile = slice_contour(mask, voxel, mask.shape[0] // 2)
    show("one slice: points", profile.GetNumberOfPoints())
    curves = []
    for size in (0, COARSE):
        planar = vtkIPIASurfaceReconstruction()
        planar.SetInputData(profile)
        planar.GetFitter().SetGridSize(size, 0, 0)  # the other axis follows
        planar.Update()
        curves.append(planar.GetOutput())
        name = f"one slice, GridSize {size}: "
        show(name + "curves", number_of_components(curves[-1]))
        function = planar.GetFitter().GetImplicitFunction()
        apart = np.abs([function.FunctionValue(x) for x in points_of(profile)])
        show(name + "points off, mean and max, mm", f"{apart.mean():.2f}", f"{apart.max():.2f}")

    write(surface, given.output / "organ.vtp")
    if not given.no_picture:
        seen = View(direction=(0.3, -1, 0.35), up=(0, 0, 1))
        sheet = Sheet(1, 3, (340, 330), SCALE)
        steps = vtk.vtkDiscreteFlyingEdges3D()
        image = vtk.vtkImageData()
        image.SetDimensions(mask.shape[::-1])
        image.SetSpacing(voxel)
        image.GetPointData().SetScalars(numpy_to_vtk(mask.astype(np.uint8).ravel(), deep=True))
        steps.SetInputData(image)
        steps.SetValue(0, 1)
        steps.Update()
        blocks = steps.GetOutput()
        blocks.GetPointData().Initialize()
        light(sheet.tile(0, 0, "boundary of the voxels", [shaded(blocks)], seen))
        light(sheet.tile(0, 1, "the surface", [shaded(surface)], seen))
        at = points_of(profile)
        corner = at.min(axis=0) + np.ptp(at, axis=0) * CLOSE_UP
        centre = at[np.argmin(np.linalg.norm(at - corner, axis=1))]
        detail = [dots(profile, INK, 4), lines(curves[0], RED, 2), lines(curves[1], BLUE, 2)]
        for actor in detail[1:]:
            actor.SetPosition(0, 0, 1)  # in front of the points
        sheet.tile(0, 2, f"30 mm of a slice; blue: GridSize {COARSE}", detail,
                   View(centre=tuple(centre), half_height=15))
        sheet.write(given.output / "task-organ.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
