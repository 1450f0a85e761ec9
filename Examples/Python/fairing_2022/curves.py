# SPDX-License-Identifier: BSD-3-Clause
"""The paper's four curves. It gives no data: all are generated here, with noise of a fixed seed."""

import numpy as np

SEED = 2022

NOTE_POINTS, NOTE_CONTROLS = 245, 83
AIRFOIL_POINTS, AIRFOIL_CONTROLS = 49, 25
STARFISH_POINTS, STARFISH_CONTROLS = 100, 34
VIVIANI_POINTS, VIVIANI_CONTROLS = 200, 80

NOTE_NOISE = 0.01
AIRFOIL_NOISE = 4e-4
STARFISH_NOISE = 0.012
VIVIANI_NOISE = 0.03

# An eighth note: head, stem and flag, counter-clockwise.
NOTE_POLYGON = np.array([
    (0.0, 0.4), (0.2, -0.3), (1.0, -0.7), (2.0, -0.5), (2.7, 0.2), (2.8, 1.2), (2.8, 2.6), (2.8, 4.0),
    (2.9, 4.9), (3.5, 4.3), (4.2, 3.5), (4.4, 2.5), (4.0, 1.8), (4.8, 2.3), (5.0, 3.5), (4.4, 4.6),
    (3.6, 5.4), (3.1, 6.3), (2.9, 7.0), (2.45, 7.0), (2.4, 5.8), (2.4, 4.4), (2.4, 3.0), (2.4, 1.7),
    (1.7, 1.5), (0.7, 1.3)])

AIRFOIL_CAMBER, AIRFOIL_CAMBER_PLACE, AIRFOIL_THICKNESS = 0.03, 0.7, 0.12


def note():
    """245 points at equal arc length of a note-shaped closed curve."""
    return _noisy(_at_equal_arc(_closed_spline(NOTE_POLYGON), NOTE_POINTS), NOTE_NOISE, "note")


def airfoil():
    """
    49 points of the four-digit NACA section 3712, from the trailing edge over the upper side and back
    below, denser at both ends. Its camber lies aft, as that of supercritical sections.
    """
    half = (AIRFOIL_POINTS + 1) // 2
    x = (1 - np.cos(np.linspace(0, np.pi, half))) / 2
    t, m, p = AIRFOIL_THICKNESS, AIRFOIL_CAMBER, AIRFOIL_CAMBER_PLACE
    thickness = 5 * t * (0.2969 * np.sqrt(x) - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3
                         - 0.1015 * x**4)
    front = x < p
    camber = np.where(front, m / p**2 * (2 * p * x - x**2),
                      m / (1 - p)**2 * (1 - 2 * p + 2 * p * x - x**2))
    slope = np.where(front, 2 * m / p**2 * (p - x), 2 * m / (1 - p)**2 * (p - x))
    angle = np.arctan(slope)
    upper = np.column_stack((x - thickness * np.sin(angle), camber + thickness * np.cos(angle)))
    lower = np.column_stack((x + thickness * np.sin(angle), camber - thickness * np.cos(angle)))
    return _noisy(_in_space(np.vstack((upper[::-1], lower[1:]))), AIRFOIL_NOISE, "airfoil")


def starfish():
    """100 points at equal angles of r = 1 + 0.3 cos 5 t."""
    angle = 2 * np.pi * np.arange(STARFISH_POINTS) / STARFISH_POINTS
    radius = 1 + 0.3 * np.cos(5 * angle)
    points = np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))
    return _noisy(_in_space(points), STARFISH_NOISE, "starfish")


def viviani():
    """Points at equal steps of (1 + cos t, sin t, 2 sin t / 2), 0 <= t < 4 pi."""
    t = 4 * np.pi * np.arange(VIVIANI_POINTS) / VIVIANI_POINTS
    points = np.column_stack((1 + np.cos(t), np.sin(t), 2 * np.sin(t / 2)))
    return _noisy(points, VIVIANI_NOISE, "viviani", planar=False)


def _in_space(points):
    return np.column_stack((points, np.zeros(len(points))))


def _noisy(points, deviation, name, planar=True):
    noise = np.random.default_rng([SEED, *name.encode()]).normal(0, deviation, points.shape)
    if planar:
        noise[:, 2] = 0
    return points + noise


def _closed_spline(polygon, samples=20000):
    """A closed uniform cubic B-spline of a control polygon."""
    n = len(polygon)
    t = n * np.arange(samples) / samples
    span = t.astype(int)
    u = t - span
    basis = ((1 - u)**3, 3 * u**3 - 6 * u**2 + 4, -3 * u**3 + 3 * u**2 + 3 * u + 1, u**3)
    return sum(b[:, None] / 6 * polygon[(span + i) % n] for i, b in enumerate(basis))


def _at_equal_arc(curve, count):
    closed = np.vstack((curve, curve[:1]))
    arc = np.concatenate(([0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))))
    at = arc[-1] * np.arange(count) / count
    return _in_space(np.column_stack([np.interp(at, arc, closed[:, a]) for a in range(2)]))
