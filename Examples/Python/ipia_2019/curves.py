# SPDX-License-Identifier: BSD-3-Clause
"""The planar models: closed curves, sampled at equal arc length, with outward normals.

The paper gives no formulas for its curves. The flower is a polar curve; the others are closed cubic
B-splines through hand-made control polygons that resemble the paper's pictures.
"""

import numpy as np

from .cloud import Cloud, unit

DENSE_SAMPLES = 20000

FLOWER_PETALS = 5
FLOWER_DEPTH = 0.3

COONS_POLYGON = np.array([
    (4.2, 0.3), (3.4, 2.2), (1.4, 1.5), (0.3, 3.6), (-1.6, 3.4), (-1.7, 1.4), (-4.0, 1.0),
    (-4.0, -0.9), (-1.9, -0.9), (-1.8, -3.2), (0.2, -3.5), (0.9, -1.4), (3.6, -2.2)])

DOLPHIN_POLYGON = np.array([
    (10.2, 2.6), (9.4, 3.1), (8.9, 3.3), (8.5, 4.0), (7.6, 4.8), (6.6, 5.2), (5.9, 5.4), (5.2, 6.4),
    (4.3, 7.2), (4.5, 6.2), (4.6, 5.2), (3.6, 4.8), (2.4, 4.0), (1.5, 3.2), (0.8, 2.8), (0.1, 3.4),
    (-1.0, 3.7), (-0.4, 2.7), (0.1, 2.0), (-0.4, 1.2), (-0.6, 0.1), (0.5, 0.9), (1.2, 1.7),
    (2.2, 2.4), (3.6, 2.7), (5.0, 2.5), (5.9, 2.3), (5.5, 1.4), (4.8, 0.4), (6.2, 1.0), (7.0, 2.0),
    (7.8, 2.2), (8.8, 2.4), (9.6, 2.2)])

BUTTERFLY_RIGHT_HALF = np.array([
    (0.0, -2.2), (0.45, -1.6), (0.5, -0.7), (1.3, -1.9), (2.2, -2.9), (3.4, -2.7), (3.7, -1.5),
    (3.1, -0.5), (2.2, -0.1), (3.6, 0.3), (4.9, 1.3), (5.4, 2.9), (4.4, 3.7), (2.8, 3.0), (1.5, 1.9),
    (0.6, 0.9), (0.6, 1.7), (0.0, 2.2)])


def flower(count):
    angle = 2 * np.pi * np.arange(DENSE_SAMPLES) / DENSE_SAMPLES
    radius = 1 + FLOWER_DEPTH * np.cos(FLOWER_PETALS * angle)
    return _sampled(np.column_stack((radius * np.cos(angle), radius * np.sin(angle))), count)


def coons_type_curve(count):
    return _sampled(_closed_spline(COONS_POLYGON), count)


def dolphin_like(count):
    return _sampled(_closed_spline(DOLPHIN_POLYGON), count)


def butterfly(count):
    left = BUTTERFLY_RIGHT_HALF[-2:0:-1] * (-1, 1)
    return _sampled(_closed_spline(np.vstack((BUTTERFLY_RIGHT_HALF, left))), count)


def _closed_spline(polygon):
    """A closed uniform cubic B-spline of a control polygon, densely sampled."""
    n = len(polygon)
    t = n * np.arange(DENSE_SAMPLES) / DENSE_SAMPLES
    span = t.astype(int)
    u = t - span
    basis = ((1 - u)**3, 3 * u**3 - 6 * u**2 + 4, -3 * u**3 + 3 * u**2 + 3 * u + 1, u**3)
    return sum(b[:, None] / 6 * polygon[(span + i) % n] for i, b in enumerate(basis))


def _sampled(curve, count):
    """count points at equal arc length of a dense closed counter-clockwise curve, normalised."""
    closed = np.vstack((curve, curve[:1]))
    arc = np.concatenate(([0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))))
    tangents = (np.roll(curve, -1, axis=0) - np.roll(curve, 1, axis=0))
    normals = unit(np.column_stack((tangents[:, 1], -tangents[:, 0])))
    closed_normals = np.vstack((normals, normals[:1]))
    at = arc[-1] * np.arange(count) / count

    def interpolated(values):
        return np.column_stack([np.interp(at, arc, values[:, a]) for a in range(2)]
                               + [np.zeros(count)])

    return Cloud(interpolated(closed), unit(interpolated(closed_normals))).normalised()
