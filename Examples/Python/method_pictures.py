#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""
The pictures of Documentation/Method.md: levels of the hierarchy, its bands, and noise.

  PYTHONPATH=<build>/lib/python3/dist-packages python3 method_pictures.py

They need a display; without one run it under xvfb-run -a.
"""

import argparse
from pathlib import Path
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from ipia import vtkIPIASurfaceReconstruction
from ipia_2019.cloud import Cloud, points_polydata, unit
from ipia_2019.curves import dolphin_like
from ipia_2019.drawing import (BLUE, INK, RED, Sheet, View, curve_actor, points_actor,
                               surface_actor)
from ipia_2019.meshes import MeshError, mesh_cloud, mesh_folder

DEFAULT_OUTPUT = Path("ipia-output/method")
SEED = 1
TILE_SIZE = (340, 340)

BUNNY_POINTS = 37706  # all vertices
BUNNY_VIEW = View(direction=(0.15, 0.2, 1.0))

BANDED_LEVELS = 3  # shown, the finest ones
CURVE_POINTS = 160
CELL_COLOURS = ((0.80, 0.88, 0.96), (0.60, 0.75, 0.90))  # within a cell of the data, with data

NOISE = 0.0025  # standard deviation, of the diagonal
NORMAL_NOISE = 0.17  # radians, about 10 degrees
CLEAN_FAIRING = 5e-5  # what the fitter takes where it finds no noise


def reconstruction_of(cloud):
    reconstruction = vtkIPIASurfaceReconstruction()
    reconstruction.SetInputData(cloud.polydata())
    return reconstruction


def levels_picture(cloud):
    """The surface of each level: the finest of a hierarchy that ends there, on the same knots."""
    finest = reconstruction_of(cloud)
    finest.Update()
    fitter = finest.GetFitter()
    cells = np.array(fitter.GetGridSizeUsed()) - 3
    bounds = np.array(fitter.GetModelBoundsUsed()).reshape(3, 2)
    spacing = (bounds[:, 1] - bounds[:, 0]) / cells
    count = fitter.GetNumberOfLevelsUsed()
    columns = (count + 1) // 2
    sheet = Sheet(2, columns, TILE_SIZE)
    for level in range(count):
        step = 2 ** (count - 1 - level)
        coarse = -(-cells // step)
        made = finest
        if step > 1:
            made = reconstruction_of(cloud)
            made.GetFitter().SetGridSize(*(int(n) + 3 for n in coarse))
            upper = bounds[:, 0] + coarse * step * spacing
            made.GetFitter().SetModelBounds(*np.column_stack((bounds[:, 0], upper)).ravel())
            made.Update()
        kind = "dense" if coarse.max() <= 32 else "band"
        title = f"level {level + 1}: {' x '.join(str(n) for n in coarse)} cells, {kind}"
        sheet.tile(level // columns, level % columns, title, [surface_actor(made.GetOutput())],
                   BUNNY_VIEW)
    if count % 2:
        sheet.tile(1, columns - 1, f"the {len(cloud)} points",
                   [points_actor(cloud.points[cloud.normals @ BUNNY_VIEW.direction > 0], BLUE, 1)],
                   BUNNY_VIEW)
    return sheet


def squares_actor(corners, side, colour):
    """Squares in the plane z = 0, by their lower left corners."""
    steps = side * np.array(((0, 0), (1, 0), (1, 1), (0, 1)))
    points = (corners[:, None, :] + steps).reshape(-1, 2)
    squares = points_polydata(np.column_stack((points, np.full(len(points), -1.0))))
    cells = vtk.vtkCellArray()
    for first in range(0, len(points), 4):
        cells.InsertNextCell(4, range(first, first + 4))
    squares.SetPolys(cells)
    actor = surface_actor(squares, colour)
    actor.GetProperty().LightingOff()
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(1, 1, 1)
    return actor


def bands_picture(cloud):
    """The knot cells that the levels of a planar fit hold coefficients for, with the curve."""
    made = reconstruction_of(cloud)
    made.Update()
    fitter = made.GetFitter()
    low = np.array(fitter.GetModelBoundsUsed()).reshape(3, 2)[:2, 0]
    finest = (np.array(fitter.GetModelBoundsUsed()).reshape(3, 2)[0, 1] - low[0]) / (
        fitter.GetGridSizeUsed()[0] - 3)
    sheet = Sheet(1, BANDED_LEVELS, (480, 320))
    for column in range(BANDED_LEVELS):
        halvings = BANDED_LEVELS - 1 - column
        side = finest * 2**halvings
        count = -(-(np.array(fitter.GetGridSizeUsed())[:2] - 3) // 2**halvings)
        occupied = np.unique(((cloud.points[:, :2] - low) / side).astype(int), axis=0)
        around = [occupied + (i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
        band = np.unique(np.vstack(around), axis=0)
        if count.max() <= 32:
            band = np.array([(i, j) for i in range(count[0]) for j in range(count[1])])
        title = f"level {fitter.GetNumberOfLevelsUsed() - halvings}: {count[0]} x {count[1]} cells"
        curve = curve_actor(made.GetOutput())
        curve.SetPosition(0, 0, 0.5)
        sheet.tile(0, column, title,
                   [squares_actor(low + side * band, side, CELL_COLOURS[0]),
                    squares_actor(low + side * occupied, side, CELL_COLOURS[1]),
                    curve, points_actor(cloud.points + (0, 0, 1), INK, 3)])
    return sheet


def noise_picture(cloud, random):
    """Noisy points, their fit as if they were clean, and with nothing set."""
    noisy = cloud.with_noise(NOISE * np.linalg.norm(np.ptp(cloud.points, axis=0)), random)
    noisy = Cloud(noisy.points,
                  unit(noisy.normals + random.normal(0, NORMAL_NOISE / 2**0.5, (len(noisy), 3))))
    sheet = Sheet(1, 3, TILE_SIZE)
    facing = noisy.points[noisy.normals @ BUNNY_VIEW.direction > 0]
    sheet.tile(0, 0, f"{len(noisy)} points with noise", [points_actor(facing, BLUE, 1)], BUNNY_VIEW)
    for column, weight in ((1, CLEAN_FAIRING), (2, -1)):
        made = reconstruction_of(noisy)
        made.GetFitter().SetFairingWeight(weight)
        made.Update()
        spacings = made.GetFitter().GetSmoothingLengthUsed() / knot_spacing(made.GetFitter())
        title = (f"nothing set: smoothed below {spacings:.1f} knot spacings" if weight < 0 else
                 f"FairingWeight {weight:g}, as on clean data")
        sheet.tile(0, column, title, [surface_actor(made.GetOutput())], BUNNY_VIEW)
    return sheet


def knot_spacing(fitter):
    bounds = fitter.GetModelBoundsUsed()
    return (bounds[1] - bounds[0]) / (fitter.GetGridSizeUsed()[0] - 3)


def main():
    parser = argparse.ArgumentParser(description="Makes the pictures of Documentation/Method.md.")
    parser.add_argument("--output", type=Path, default=DEFAULT_OUTPUT,
                        help="folder of the pictures (default: %(default)s)")
    parser.add_argument("--data", type=Path,
                        help="folder with the meshes of Debian's package libcgal-demo; without it "
                             "the package is fetched with apt-get download into the output folder")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    random = np.random.default_rng(SEED)
    try:
        mesh = mesh_folder(options.data, options.output) / "bunny00.off"
    except MeshError as error:
        return f"method_pictures.py: {error}"
    bunny = mesh_cloud(mesh, BUNNY_POINTS, random)
    for name, sheet in (("levels", levels_picture(bunny)),
                        ("bands", bands_picture(dolphin_like(CURVE_POINTS))),
                        ("noise", noise_picture(bunny, random))):
        path = options.output / f"method-{name}.png"
        sheet.write(path)
        print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
