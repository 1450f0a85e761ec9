# SPDX-License-Identifier: BSD-3-Clause
"""Figures 1 and 2: f = 0 after iterations 1, 5, 10 and 15, planar curves and surfaces."""

from .drawing import BLUE, PLANAR_VIEW, RED, Sheet, View, curve_actor, points_actor, surface_actor
from .fitting import fit

ITERATIONS = (1, 5, 10, 15)
CURVE_TILE = (300, 300)
SURFACE_TILE = (320, 240)
SURFACE_VIEW = View(direction=(0.2, -0.6, 1.0))

FIRST_ITERATION_NOTE = (
    "iteration 1 is shown with offset points on both sides: with outward ones alone, as in "
    "eq. 8 to 16, C1 = mu B^T b >= 0 after one iteration from 0, so f >= 0 everywhere and f = 0 is "
    "no curve or surface; from iteration 5 on the fits have outward offset points only")


def figure_1(lab):
    return _sheet(lab, ("Flower", "Coons curve"), CURVE_TILE, PLANAR_VIEW,
                  lambda cloud, contour: [points_actor(cloud.points, BLUE, size=4),
                                          curve_actor(contour)])


def figure_2(lab):
    return _sheet(lab, ("Torus", "Double-torus"), SURFACE_TILE, SURFACE_VIEW,
                  lambda cloud, contour: [surface_actor(contour),
                                          points_actor(cloud.points, RED, size=1)])


def _sheet(lab, names, tile_size, view, actors):
    sheet = Sheet(len(names), len(ITERATIONS), tile_size)
    for row, name in enumerate(names):
        cloud = lab.library.cloud(name)
        settings = lab.library.settings(name)
        for column, count in enumerate(ITERATIONS):
            # f >= 0 after one iteration with outward offsets; see FIRST_ITERATION_NOTE.
            made = fit(cloud, settings.but(iterations=count, two_sided=count == 1))
            label = f"{lab.library.title(name)}, iteration {count}"
            lab.record(label, made)
            sheet.tile(row, column, label + (" (two-sided)" if count == 1 else ""),
                       actors(cloud, made.contour), view)
    lab.note(FIRST_ITERATION_NOTE)
    return sheet
