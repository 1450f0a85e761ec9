# SPDX-License-Identifier: BSD-3-Clause
"""
Stand-ins for the paper's three surfaces, whose data and parameters are not public: height fields
over a rectangle, generated, with noise of a fixed seed. They share the names and the kind of shape,
nothing else.
"""

from dataclasses import dataclass

import numpy as np

from .curves import SEED


@dataclass(frozen=True)
class Model:
    """A grid of points, u fastest, with its number of control points and the weights of the figure."""

    name: str
    title: str
    size: tuple
    controls: tuple
    points: np.ndarray
    weight: float  # of the energy minimisation, and of most control points of fairing-PIA
    raised: float
    regions: tuple  # rectangles (u0, u1, v0, v1) of parameters whose control points are raised
    lowered: float = 0
    kept: tuple = ()  # rectangles whose control points are lowered

    def weights(self):
        """One per control point: by its place in the parameter rectangle."""
        u, v = np.meshgrid(*(np.linspace(0, 1, n) for n in self.controls))
        weights = np.full(u.shape, self.weight)
        for value, regions in ((self.raised, self.regions), (self.lowered, self.kept)):
            for u0, u1, v0, v1 in regions:
                weights[(u >= u0) & (u <= u1) & (v >= v0) & (v <= v1)] = value
        return weights.ravel()


def tooth(quick):
    """The crown of a molar: a dome with four cusps and a cross of fissures."""
    size, controls = ((40, 40), (20, 20)) if quick else ((120, 120), (50, 50))
    x, y = _plane(size)
    dome = 0.9 * np.exp(-((x / 0.85)**4 + (y / 0.85)**4))
    cusps = sum(0.25 * np.exp(-((x - a)**2 + (y - b)**2) / 0.06)
                for a, b in ((0.4, 0.4), (-0.4, 0.45), (0.45, -0.4), (-0.4, -0.4)))
    fissures = 0.12 * (np.exp(-(x / 0.1)**2) * (np.abs(y) < 0.6)
                       + np.exp(-(y / 0.1)**2) * (np.abs(x) < 0.6))
    return Model("Tooth", "molar crown, generated", size, controls,
                 _field(x, y, dome + cusps - fissures, 0.003, "tooth"), 1e-5, 1e-3,
                 ((0, 1, 0, 0.22), (0, 1, 0.78, 1), (0, 0.22, 0, 1), (0.78, 1, 0, 1)))


def fan_disk(quick):
    """A machined part: a plateau with a sharp rim, a ramp and a round pocket."""
    size, controls = ((40, 40), (20, 20)) if quick else ((100, 100), (45, 45))
    x, y = _plane(size)
    plateau = 0.5 * _ramp(0.75 - np.hypot(x, y), 0.2)
    ramp = 0.3 * np.clip(x + 0.2, 0, 0.8) * _ramp(0.62 - np.hypot(x, y), 0.15)
    pocket = 0.3 * _ramp(0.3 - np.hypot(x + 0.2, y), 0.2)
    return Model("Fan_disk", "machined disk, generated", size, controls,
                 _field(x, y, plateau + ramp - pocket, 0.003, "fan disk"), 3e-6, 1e-3,
                 ((0, 0.14, 0, 1), (0.86, 1, 0, 1), (0.55, 0.75, 0.3, 0.7)))


def mannequin(quick):
    """A face in relief: brow, eyes, nose, mouth, and an ear with folds."""
    size, controls = ((48, 48), (24, 24)) if quick else ((160, 160), (70, 70))
    x, y = _plane(size)
    head = 0.8 * np.sqrt(np.clip(1.3 - 0.55 * x**2 - 0.45 * y**2, 0, None))
    nose = 0.28 * np.exp(-(x / 0.12)**2 - ((y + 0.02) / 0.28)**2)
    eyes = sum(0.12 * np.exp(-((x - a) / 0.14)**2 - ((y - 0.28) / 0.08)**2) for a in (0.33, -0.33))
    mouth = (0.08 * np.exp(-(x / 0.25)**2 - ((y + 0.48) / 0.06)**2)
             - 0.08 * np.exp(-(x / 0.27)**2 - ((y + 0.54) / 0.03)**2)
             + 0.07 * np.exp(-(x / 0.22)**2 - ((y + 0.61) / 0.06)**2))
    r = np.hypot((x - 0.8) / 0.14, (y - 0.1) / 0.28)
    ear = 0.12 * np.exp(-((r - 1) / 0.25)**2) + 0.05 * np.cos(18 * r) * np.exp(-(r / 0.9)**2)
    return Model("Mannequin", "face in relief, generated", size, controls,
                 _field(x, y, head + nose - eyes + mouth + ear, 0.001, "mannequin"), 3e-6, 1e-4,
                 ((0.8, 1.0, 0.36, 0.74),), 1e-8, ((0.3, 0.7, 0.15, 0.32),))


MODELS = (tooth, fan_disk, mannequin)


def _plane(size):
    x, y = np.meshgrid(*(np.linspace(-1, 1, n) for n in size))
    return x.ravel(), y.ravel()


def _ramp(x, width):
    """From 0 to 1 over a width, with tangents of 0."""
    t = np.clip(x / width, 0, 1)
    return t * t * (3 - 2 * t)


def _field(x, y, z, deviation, name):
    noise = np.random.default_rng([SEED, *name.encode()]).normal(0, deviation, len(z))
    return np.column_stack((x, y, z + noise))
