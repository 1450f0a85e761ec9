#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Photogrammetry: noisy coloured points, normals estimated and turned to the cameras.

    python3 photos.py --data build/data

A set of photographs is simulated: points on refined_elephant.off of Debian's package libcgal-demo,
denser here than there, with errors of depth and of colour. So the true surface and its colours are
known.
"""
import sys

from common import (SCALE, dots, estimated_normals, light, options, points_of, shaded, show, write)
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from ipia import vtkIPIASurfaceReconstruction
from ipia_2019.cloud import unit
from ipia_2019.drawing import Sheet, View
from ipia_2019.meshes import mesh_cloud, mesh_polydata
from reconstruct import coloured, distances, number_of_components, number_of_open_edges, polydata

SIZE = 300.0  # mm, the longest side
POINTS = 60_000
DEPTH_ERROR, SIDE_ERROR = 0.6, 0.1  # mm, standard deviations along and across the view
COLOUR_ERROR = 25.0  # of 255
CAMERAS, AWAY = 24, 900.0  # mm from the middle
NEIGHBOURS = 24  # of a point for its normal: more than on clean points
SEED = 1


def true_colours(points):
    """Of the painted model: bands along it, darker below."""
    x, y, z = (points / SIZE).T
    wave = np.column_stack((np.sin(22 * y + 6 * x), np.sin(17 * z + 2), np.sin(19 * x + 8 * y)))
    return np.clip(np.array((165, 130, 105)) + wave * (55, 45, 60) + 60 * y[:, None], 0, 255)


def camera_places():
    """Evenly around the model (a Fibonacci lattice)."""
    z = 1 - (2 * np.arange(CAMERAS) + 1) / CAMERAS
    angle = np.pi * (1 + 5**0.5) * np.arange(CAMERAS)
    across = np.sqrt(1 - z * z)
    return AWAY * np.column_stack((across * np.cos(angle), z, across * np.sin(angle)))


def photographed(mesh_file, random):
    """Points, the camera each is seen from, true positions and true normals."""
    cloud = mesh_cloud(mesh_file, 4 * POINTS, random)
    points = SIZE * cloud.points
    density = 0.15 + 0.85 * (0.5 + 0.5 * np.sin(9 * cloud.points[:, 0] + 5 * cloud.points[:, 1]))
    taken = random.choice(len(points), POINTS, replace=False, p=density / density.sum())
    points, normals = points[taken], cloud.normals[taken]
    places = camera_places()
    views = np.array([unit(place - points) for place in places])
    best = np.argmax(np.einsum("cpk,pk->cp", views, normals), axis=0)
    view = views[best, np.arange(POINTS)]
    noisy = (points + random.normal(0, DEPTH_ERROR, (POINTS, 1)) * view +
             random.normal(0, SIDE_ERROR, points.shape))
    return noisy, places[best], normals


def towards(normals, points, cameras):
    """The normals, each turned to the side of the camera that saw its point."""
    away = np.sum(normals * (cameras - points), axis=1) < 0
    return np.where(away[:, None], -normals, normals)


def of_size(mesh):
    """The mesh as mesh_cloud normalises it, SIZE long."""
    points = points_of(mesh)
    low, high = points.min(axis=0), points.max(axis=0)
    result = vtk.vtkPolyData()
    result.DeepCopy(mesh)
    corners = SIZE * (points - (low + high) / 2) / (high - low).max()
    result.GetPoints().SetData(numpy_to_vtk(corners, deep=True))
    return result


def colours_of(data):
    return vtk_to_numpy(data.GetPointData().GetArray("RGB")).astype(float)


def rms(differences):
    return np.sqrt(np.mean(differences**2))


def main():
    given = options(__doc__.splitlines()[0])
    random = np.random.default_rng(SEED)
    file = given.data / "meshes" / "refined_elephant.off"
    truth = of_size(mesh_polydata(file))
    points, cameras, true_normals = photographed(file, random)
    estimated = estimated_normals(points, points.mean(axis=0), NEIGHBOURS)
    normals = towards(estimated, points, cameras)
    cosine = np.sum(normals * true_normals, axis=1)
    show("points", len(points))
    show("normals on the right side", f"{100 * np.mean(cosine > 0):.2f} %")
    angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    show("angle of the normals, median", f"{np.median(angle):.1f}°")
    show("distance of the points from the truth, rms, mm", f"{rms(distances(points, truth)):.3f}")

    colours = np.clip(true_colours(points) + random.normal(0, COLOUR_ERROR, points.shape), 0, 255)
    data = coloured(polydata(points, normals), colours)
    reconstruction = vtkIPIASurfaceReconstruction()
    reconstruction.SetInputData(data)
    reconstruction.Update()
    surface, fitter = reconstruction.GetOutput(), reconstruction.GetFitter()
    show("noise found, mm", f"{fitter.GetNoiseFound():.3f}")
    show("smoothing length, mm", f"{fitter.GetSmoothingLengthUsed():.2f}")
    show("components", number_of_components(surface))
    show("open edges", number_of_open_edges(surface))
    at = points_of(surface)
    show("distance of the surface from the truth, rms, mm", f"{rms(distances(at, truth)):.3f}")
    locator = vtk.vtkStaticPointLocator()
    locator.SetDataSet(data)
    locator.BuildLocator()
    some = slice(None, None, 10)
    nearest = np.array([locator.FindClosestPoint(x) for x in at[some]])
    true = true_colours(at[some])
    show("colours of the nearest points, rms error", f"{rms(colours[nearest] - true):.1f} of 255")
    show("colours of the surface, rms error",
         f"{rms(colours_of(surface)[some] - true):.1f} of 255")

    clean = vtkIPIASurfaceReconstruction()
    clean.SetInputData(data)
    clean.GetFitter().SetFairingWeight(5e-5)
    clean.GetFitter().FitPointArraysOff()
    clean.Update()
    rough = clean.GetOutput()
    show("without smoothing: distance, rms, mm",
         f"{rms(distances(points_of(rough), truth)):.3f}")

    write(surface, given.output / "photos.vtp")
    if not given.no_picture:
        seen = View(direction=(0.5, 0.25, 1), up=(0, 1, 0))
        sheet = Sheet(1, 3, (340, 300), SCALE)
        facing = normals @ seen.direction > 0
        sheet.tile(0, 0, f"{POINTS:,} points",
                   [dots(coloured(polydata(points[facing]), colours[facing]), size=1.5)], seen)
        light(sheet.tile(0, 1, "FairingWeight 5e-5, no smoothing", [shaded(rough)], seen))
        light(sheet.tile(0, 2, "nothing set", [shaded(surface)], seen))
        sheet.write(given.output / "task-photos.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
