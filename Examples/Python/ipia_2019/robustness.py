# SPDX-License-Identifier: BSD-3-Clause
"""Figures 4 and 5: holes, thinned out and noisy points."""

from dataclasses import dataclass

import numpy as np

from .drawing import BLUE, RED, Sheet, View, points_actor, surface_actor
from .fitting import DOMAIN_HALF_SIDE, fit
from .models import MODELS

TILE_SIZE = (420, 420)

FRONT = View(direction=(0.15, 0.2, 1.0))
SIDE = View(direction=(1.0, 0.2, 0.5))

# Radii of the holes in knot spacings: shown, and tried on the bunny for the note on the limit.
HOLE_RADIUS = 3.0
WIDE_HOLE_RADIUS = 4.0


@dataclass(frozen=True)
class Holes:
    """The points nearest to these places are the centres of the holes of a model."""

    name: str
    places: tuple
    view: View


HOLES = (
    Holes("Elephant", ((-0.3, -0.05, 0.3), (-0.15, -0.1, 0.3), (0.02, 0.0, 0.5)), FRONT),
    Holes("Bunny", ((0.15, -0.15, 0.6), (0.0, -0.3, 0.6), (-0.3, 0.1, 0.6), (-0.1, 0.0, 0.6)),
          FRONT),
    Holes("Fertility", ((0.5, 0.1, 0.0), (0.5, 0.0, -0.2), (0.5, 0.25, 0.3), (0.5, 0.3, -0.05)),
          SIDE),
)

THINNED_SHARE = 0.1
NOISE = 0.003  # standard deviation, of the longest side


def figure_4(lab):
    sheet = Sheet(2, len(HOLES), TILE_SIZE)
    for column, holes in enumerate(HOLES):
        title = MODELS[holes.name].title
        left = _with_holes(lab, holes, HOLE_RADIUS)
        made = lab.record(f"{title}, with holes", fit(left, lab.library.settings(holes.name)))
        sheet.tile(0, column, f"({'abc'[column]}) {title}", [surface_actor(made.contour)],
                   holes.view)
        sheet.tile(1, column, f"({'def'[column]}) with the {len(left)} points",
                   [surface_actor(made.contour), points_actor(left.points, RED, size=1)],
                   holes.view)
    _note_limit_of_holes(lab)
    return sheet


def _note_limit_of_holes(lab):
    holes = HOLES[1]
    made = fit(_with_holes(lab, holes, WIDE_HOLE_RADIUS), lab.library.settings(holes.name))
    result = "closes them too" if not made.warnings else "does not: the filter warns of them"
    lab.note(f"the holes have a radius of {HOLE_RADIUS:g} knot spacings, as far as the rows beside "
             f"them reach; with {WIDE_HOLE_RADIUS:g} on the bunny a single level {result}. The "
             "paper does not give the size of its holes")


def figure_5(lab):
    cloud, settings = lab.library.cloud("Bunny"), lab.library.settings("Bunny")
    variants = (
        ("bunny", cloud, lab.standard_fit("Bunny")),
        ("90 % of the right part removed", *_cloud_and_fit(_thinned(cloud, lab), settings)),
        (f"noise, {NOISE:g} of the longest side", *_cloud_and_fit(
            cloud.with_noise(NOISE, lab.library.random("noise")), settings)))
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


def _spacing(grid):
    return 2 * DOMAIN_HALF_SIDE / (grid - 3)


def _with_holes(lab, holes, radius):
    """The cloud without what is within so many knot spacings of the holes' centres, on that side."""
    cloud = lab.library.cloud(holes.name)
    distance = radius * _spacing(lab.library.settings(holes.name).grid)
    keep = np.ones(len(cloud), dtype=bool)
    for place in holes.places:
        centre = np.linalg.norm(cloud.points - place, axis=1).argmin()
        near = np.linalg.norm(cloud.points - cloud.points[centre], axis=1) <= distance
        keep &= ~(near & (cloud.normals @ cloud.normals[centre] > 0))
    return cloud.select(keep)


def _thinned(cloud, lab):
    """A tenth of the points on the right, all points on the left."""
    right = np.flatnonzero(cloud.points[:, 0] > 0)
    kept = lab.library.random("thinning").choice(right, int(THINNED_SHARE * len(right)),
                                                 replace=False)
    left = np.flatnonzero(cloud.points[:, 0] <= 0)
    return cloud.select(np.sort(np.concatenate((left, kept))))
