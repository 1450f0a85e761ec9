# SPDX-License-Identifier: BSD-3-Clause
"""
The closed curves of the examples, with outward normals.

Examples 1 and 10 (and 9, which is 1 with noise) have formulas. The others are "sampled from the
figure" in the paper; the outlines here stand in for them. They have the paper's numbers of points
and are as large as the curve of Example 1, and as the paper's they have parts that are thin, bays
and corners, more of them the finer the grid.
"""

import numpy as np

from ipia_2019.cloud import Cloud, unit

DENSE = 20000
LONGEST_SIDE = 8.0


def example_1(count):
    """x = 4 cos t, y = sin t (3 - 5 sin t), at equal steps of t."""
    t = 2 * np.pi * np.arange(count) / count
    s, c = np.sin(t), np.cos(t)
    return _planar(4 * c, s * (3 - 5 * s), 3 * c - 10 * s * c, 4 * s)


def example_10(count):
    """The ellipse x = 4 cos t, y = 5 sin t, at equal steps of t."""
    t = 2 * np.pi * np.arange(count) / count
    return _planar(4 * np.cos(t), 5 * np.sin(t), 5 * np.cos(t), 4 * np.sin(t))


def pear(count):
    """For Example 2."""
    return _polar(count, lambda t: 1 + 0.25 * np.cos(t) + 0.18 * np.cos(2 * t) - 0.1 * np.sin(3 * t))


def clover(count):
    """For Example 3: three leaves."""
    return _polar(count, lambda t: 1 + 0.35 * np.cos(3 * t))


def star(count):
    """For Example 4: five arms."""
    return _polar(count, lambda t: 1 + 0.38 * np.cos(5 * t))


def leaf(count):
    """For Example 5: a leaf with five uneven lobes."""
    return _polar(count, lambda t: 1 + 0.3 * np.cos(5 * t) + 0.22 * np.cos(t) + 0.08 * np.sin(2 * t))


def flower(count):
    """For Examples 6 and 11: nine petals."""
    return _polar(count, lambda t: 1 + 0.45 * np.cos(9 * t))


def splash(count):
    """For Examples 7 and 8: five drops around a thin middle."""
    return _polar(count, lambda t: 1 + 0.6 * np.cos(5 * t))


def _planar(x, y, normal_x, normal_y):
    zero = np.zeros(len(x))
    return Cloud(np.column_stack((x, y, zero)), unit(np.column_stack((normal_x, normal_y, zero))))


def _polar(count, radius):
    """Points at equal arc length of r(t), the longest side of whose box is LONGEST_SIDE."""
    t = 2 * np.pi * np.arange(DENSE + 1) / DENSE
    r = radius(t)
    x, y = r * np.cos(t), r * np.sin(t)
    scale = LONGEST_SIDE / max(np.ptp(x), np.ptp(y))
    x, y = scale * x, scale * y
    arc = np.concatenate(([0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))))
    at = np.interp(arc[-1] * np.arange(count) / count, arc, t)
    step = 2 * np.pi / DENSE
    r_at = scale * radius(at)
    slope = scale * (radius(at + step) - radius(at - step)) / (2 * step)
    tangent_x = slope * np.cos(at) - r_at * np.sin(at)
    tangent_y = slope * np.sin(at) + r_at * np.cos(at)
    return _planar(r_at * np.cos(at), r_at * np.sin(at), tangent_y, -tangent_x)
