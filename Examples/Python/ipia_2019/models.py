# SPDX-License-Identifier: BSD-3-Clause
"""The models of the paper's Tables 1 and 2 with its figures, and where ours come from."""

from dataclasses import dataclass

import numpy as np

from . import curves, meshes, surfaces
from .fitting import Settings

RANDOM_SEED = 2019

# --quick: no mesh is read and everything is small.
QUICK_POINTS = 3000
QUICK_GRID = 30


@dataclass(frozen=True)
class Model:
    """A row of Table 1 or 2 (points, grid, maximum error, seconds) and what stands for it here."""

    name: str
    title: str
    count: int
    grid: int
    paper_error: float
    paper_seconds: float
    planar: bool = False
    mesh: str = ""
    open_at_domain: bool = False
    remark: str = ""


ANALYTIC = {
    "Flower": curves.flower,
    "Coons curve": curves.coons_type_curve,
    "Dolphin": curves.dolphin_like,
    "Butterfly": curves.butterfly,
    "Double-torus": surfaces.double_torus,
    "Torus": surfaces.torus,
}

MODELS = {model.name: model for model in (
    Model("Flower", "polar flower", 509, 30, 2.924e-3, 1.88, planar=True),
    Model("Coons curve", "Coons-type curve", 780, 30, 1.2524e-3, 2.05, planar=True),
    Model("Dolphin", "dolphin-like outline", 371, 30, 3.2457e-3, 1.67, planar=True),
    Model("Butterfly", "butterfly-like outline", 508, 28, 2.8881e-3, 1.79, planar=True),
    Model("Double-torus", "analytic double torus", 766, 30, 1.0574e-3, 3.61),
    Model("Torus", "analytic torus", 10100, 30, 3.0412e-6, 8.22),
    Model("Gyroid", "analytic gyroid", 36627, 50, 4.8708e-6, 34.26, open_at_domain=True),
    Model("Elephant", "elephant", 52100, 50, 9.6839e-4, 44.55, mesh="refined_elephant"),
    Model("Bunny", "bunny", 35947, 70, 9.5983e-2, 88.24, mesh="bunny00"),
    Model("Fertility", "camel, for fertility", 241607, 70, 9.5989e-5, 902.35, mesh="camel",
          remark="the gap between the camel's lips is a fifth of a knot spacing wide; of two "
                 "components one is what is left of it, a bubble inside the head"),
    Model("Armadillo", "armadillo", 51892, 190, 1.9831e-2, 2732.32, mesh="armadillo"),
    Model("Buddha", "temple lion, for Buddha", 80000, 150, 7.4594e-2, 1835.73,
          mesh="ChineseDragon-10kv"),
    Model("BU", "mannequin, for BU", 70000, 160, 1.1899e-3, 2028.01, mesh="mannequin-devil",
          remark="the mesh is open at the neck; the cut there is the edge of the far field"),
)}

# Half the longest side of a normalised model: the domain of a surface that ends at its box.
MODEL_HALF_SIDE = 0.5


class ModelLibrary:
    """Makes each model's points once. find_meshes returns the folder of the meshes when asked."""

    def __init__(self, find_meshes, quick=False):
        self._find_meshes = find_meshes
        self.quick = quick
        self._clouds = {}

    def cloud(self, name):
        if name not in self._clouds:
            self._clouds[name] = self._make(MODELS[name])
        return self._clouds[name]

    def title(self, name):
        """What the points are, for pictures and table."""
        model = MODELS[name]
        return f"double torus for {name}" if self.quick and model.mesh else model.title

    def source(self, name):
        """The title with the mesh that was read, if any."""
        mesh = "" if self.quick else MODELS[name].mesh
        return f"{self.title(name)} ({mesh}.off)" if mesh else self.title(name)

    def settings(self, name):
        model = MODELS[name]
        grid = min(model.grid, QUICK_GRID) if self.quick else model.grid
        settings = Settings(grid=grid, planar=model.planar)
        return settings.but(half_side=MODEL_HALF_SIDE) if model.open_at_domain else settings

    def grid(self, size):
        """A grid size that a figure asks for, as --quick allows it."""
        return min(size, QUICK_GRID) if self.quick else size

    @staticmethod
    def random(purpose):
        """A generator of random numbers that does not depend on what was drawn before."""
        return np.random.default_rng([RANDOM_SEED, *purpose.encode()])

    def _make(self, model):
        if model.name in ANALYTIC:
            return ANALYTIC[model.name](model.count)
        random = self.random(model.name)
        count = min(model.count, QUICK_POINTS) if self.quick else model.count
        if model.name == "Gyroid":
            return surfaces.gyroid(count, random)
        if self.quick:
            return self.cloud("Double-torus")
        return meshes.mesh_cloud(self._find_meshes() / f"{model.mesh}.off", count, random)
