# SPDX-License-Identifier: BSD-3-Clause
"""
Figure 3: inaccurate distance values at the offset points.

The offset points are rows of their own (input port 1 of the filter), the normals give none.
"""

import numpy as np

from .drawing import BLUE, GREEN, MAGENTA, Sheet, curve_actor, points_actor
from .fitting import ITERATIONS, fit
from .iterations import ITERATIONS as SHOWN_ITERATIONS

TILE_SIZE = (300, 200)
POINT_SIZE = 3
POINT_SIZE_UNDER_CURVE = 5

RANDOM_VALUE = 0.5
DEVIATIONS = (0.0, 0.02, 0.05, 0.1)

# Distance of the (nearer) offset points, as a share of the longest side.
LAYER_DISTANCE = 0.01

# From inside to outside: distance along the normal and value of f there, larger where nearer.
REVERSED_LAYERS = ((-2 * LAYER_DISTANCE, -0.1), (-LAYER_DISTANCE, -0.2),
                   (LAYER_DISTANCE, 0.2), (2 * LAYER_DISTANCE, 0.1))

# As in figures 1 and 2; what more iterations do is noted.
FEW_ITERATIONS = SHOWN_ITERATIONS[-1]


def figure_3(lab):
    sheet = Sheet(2, len(DEVIATIONS) + 1, TILE_SIZE)
    lab.note(f"{FEW_ITERATIONS} iterations; the offset points lie {LAYER_DISTANCE} and "
             f"{2 * LAYER_DISTANCE} of the longest side from the data (the paper does not say)")
    _random_row(lab, sheet)
    _reversed_row(lab, sheet)
    return sheet


def _random_row(lab, sheet):
    cloud = lab.library.cloud("Dolphin")
    layers = ((-LAYER_DISTANCE, -RANDOM_VALUE), (LAYER_DISTANCE, RANDOM_VALUE))
    sheet.tile(0, 0, f"(a) {lab.library.title('Dolphin')}", _layer_actors(cloud, layers))
    random = lab.library.random("offset values")
    for column, deviation in enumerate(DEVIATIONS):
        positions, values = _extra_rows(cloud, layers)
        values = values + random.uniform(-deviation, deviation, len(values))
        _fit_tile(lab, sheet, (0, column + 1), f"({'bcde'[column]}) sigma = {deviation:g}",
                  "Dolphin", (positions, values))


def _reversed_row(lab, sheet):
    for column, (name, letters) in enumerate((("Butterfly", "fg"), ("Dolphin", "hi"))):
        cloud = lab.library.cloud(name)
        sheet.tile(1, 2 * column, f"({letters[0]}) {lab.library.title(name)}",
                   _layer_actors(cloud, REVERSED_LAYERS))
        _fit_tile(lab, sheet, (1, 2 * column + 1), f"({letters[1]}) reversed values", name,
                  _extra_rows(cloud, REVERSED_LAYERS))


def _extra_rows(cloud, layers):
    """Positions and values of all layers."""
    return (np.vstack([cloud.offset(distance) for distance, _ in layers]),
            np.repeat([value for _, value in layers], len(cloud)))


def _fit_tile(lab, sheet, place, label, name, extra_rows):
    cloud = lab.library.cloud(name)
    settings = lab.library.settings(name).but(
        iterations=FEW_ITERATIONS, offset_value=float(np.abs(extra_rows[1]).min()))
    made = lab.record(f"{label}, {lab.library.title(name)}", fit(cloud, settings, extra_rows))
    sheet.tile(*place, label, [points_actor(cloud.points, BLUE, POINT_SIZE_UNDER_CURVE),
                               curve_actor(made.contour)])
    _note_more_iterations(lab, label, fit(cloud, settings.but(iterations=ITERATIONS), extra_rows))


def _note_more_iterations(lab, label, made):
    if made.components != 1:
        lab.note(
            f"{label}: after {ITERATIONS} iterations f = 0 has {made.components} components. Values "
            "that fall with the distance make f go on falling and change its sign beyond the outer "
            "layers, where no row holds it; the paper's claim that no extra level set appears "
            "holds for few iterations only")


def _layer_actors(cloud, layers):
    return [points_actor(cloud.points, BLUE, POINT_SIZE)] + [
        points_actor(cloud.offset(distance), GREEN if distance > 0 else MAGENTA, POINT_SIZE)
        for distance, _ in layers]
