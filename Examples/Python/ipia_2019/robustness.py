# SPDX-License-Identifier: BSD-3-Clause
"""Figures 4 and 5: holes, thinned out and noisy points."""

from dataclasses import dataclass

import numpy as np
import vtk

from .drawing import BLUE, RED, Sheet, View, points_actor, surface_actor
from .fitting import fit
from .models import MODELS

TILE_SIZE = (420, 420)

FRONT = View(direction=(0.15, 0.2, 1.0))
SIDE = View(direction=(1.0, 0.2, 0.5))

# Radii of the holes in knot spacings: shown, and tried on the bunny for the note on the limit.
HOLE_RADIUS = 2.0
WIDE_HOLE_RADIUS = 3.0


@dataclass(frozen=True)
class Holes:
    """The points nearest to these places are the centres of the holes of a model."""

    name: str
    places: tuple
    view: View
    point_size: int = 1


HOLES = (
    Holes("Elephant", ((-0.3, 0.05, 0.3), (-0.12, -0.1, 0.3), (-0.25, -0.25, 0.3)), FRONT),
    Holes("Bunny", ((0.15, -0.15, 0.6), (0.0, -0.3, 0.6), (-0.3, 0.1, 0.6), (-0.1, 0.0, 0.6)),
          FRONT, point_size=2),
    Holes("Fertility", ((0.5, 0.1, 0.0), (0.5, 0.0, -0.2), (0.5, 0.25, 0.3), (0.5, 0.3, -0.05)),
          SIDE),
)

THINNED_SHARE = 0.1
THINNING_NOTE = (
    "(e): the points that are left lie 1.5 knot spacings apart on average, but at random; where gaps "
    "are wider than the rows reach (the chips on the back), f is the constant of the far field. The "
    "paper shows no artefact there, and does not say which points it kept")
NOISE = 0.003  # standard deviation, of the longest side


def figure_4(lab):
    sheet = Sheet(2, len(HOLES), TILE_SIZE)
    for column, holes in enumerate(HOLES):
        title = lab.library.title(holes.name)
        left, made = _fit_with_holes(lab, holes, HOLE_RADIUS)
        lab.record(f"{title}, with holes", made)
        if MODELS[holes.name].remark:
            lab.note_on_meshes(f"{title}: {MODELS[holes.name].remark}")
        sheet.tile(0, column, f"({'abc'[column]}) {title}", [surface_actor(made.contour)],
                   holes.view)
        sheet.tile(1, column, f"({'def'[column]}) with the {len(left)} points",
                   [surface_actor(made.contour), points_actor(left.points, RED, holes.point_size)],
                   holes.view)
    lab.note("the paper does not give the size of its holes")
    _fit_with_holes(lab, HOLES[1], WIDE_HOLE_RADIUS)
    return sheet


def _fit_with_holes(lab, holes, radius):
    """The points beside the holes and their fit; notes how far it is from the removed points."""
    cloud, settings = lab.library.cloud(holes.name), lab.library.settings(holes.name)
    spacing = 2 * settings.half_side / (settings.grid - 3)
    removed = _in_holes(cloud, holes.places, radius * spacing)
    left = cloud.select(~removed)
    made = fit(left, settings)
    gap = _largest_distance(cloud.points[removed], made.contour) / spacing
    lab.note(f"{lab.library.title(holes.name)}: holes of a radius of {radius:g} knot spacings; the "
             f"points removed there lie up to {gap:.2f} knot spacings from the surface")
    return left, made


def figure_5(lab):
    cloud, settings = lab.library.cloud("Bunny"), lab.library.settings("Bunny")
    variants = (
        (lab.library.title("Bunny"), cloud, lab.standard_fit("Bunny")),
        ("90 % of the right part removed", *_cloud_and_fit(_thinned(cloud, lab), settings)),
        (f"noise, {NOISE:g} of the longest side", *_cloud_and_fit(
            cloud.with_noise(NOISE, lab.library.random("noise")), settings)))
    lab.note_on_meshes(THINNING_NOTE)
    sheet = Sheet(2, len(variants), TILE_SIZE)
    for column, (title, points, made) in enumerate(variants):
        lab.record(title, made)
        sheet.tile(0, column, f"({'abc'[column]}) {title}, {len(points)} points",
                   [points_actor(facing(points, FRONT), BLUE)], FRONT)
        sheet.tile(1, column, f"({'def'[column]}) surface", [surface_actor(made.contour)], FRONT)
    return sheet


def facing(cloud, view):
    """The points whose normals look towards the viewer, so that the far side does not show."""
    return cloud.points[cloud.normals @ np.array(view.direction) > 0]


def _cloud_and_fit(cloud, settings):
    return cloud, fit(cloud, settings)


def _in_holes(cloud, places, radius):
    """Which points are within the radius of a hole's centre, on the same side of the model."""
    removed = np.zeros(len(cloud), dtype=bool)
    for place in places:
        centre = np.linalg.norm(cloud.points - place, axis=1).argmin()
        near = np.linalg.norm(cloud.points - cloud.points[centre], axis=1) <= radius
        removed |= near & (cloud.normals @ cloud.normals[centre] > 0)
    return removed


def _largest_distance(points, contour):
    distance = vtk.vtkImplicitPolyDataDistance()
    distance.SetInput(contour)
    return max(abs(distance.EvaluateFunction(point)) for point in points)


def _thinned(cloud, lab):
    """A tenth of the points on the right, all points on the left."""
    right = np.flatnonzero(cloud.points[:, 0] > 0)
    kept = lab.library.random("thinning").choice(right, int(THINNED_SHARE * len(right)),
                                                 replace=False)
    left = np.flatnonzero(cloud.points[:, 0] <= 0)
    return cloud.select(np.sort(np.concatenate((left, kept))))
