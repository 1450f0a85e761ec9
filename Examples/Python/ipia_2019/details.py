# SPDX-License-Identifier: BSD-3-Clause
"""Figures 6, 7 and 8: fine grids, an open surface and details."""

from dataclasses import dataclass, replace

from .drawing import BLUE, RED, WHITE, Sheet, View, points_actor, surface_actor
from .fitting import fit
from .robustness import facing

TILE_SIZE = (420, 420)

ARMADILLO_VIEW = View(direction=(-0.35, 0.15, -1.0))
COARSE_GRID = 100
SPARSE_SHARE = 0.3

GYROID_VIEW = View(direction=(0.6, 0.4, 1.0))

@dataclass(frozen=True)
class Enlarged:
    """A model, how it is looked at, and its parts: title, centre, half height."""

    name: str
    view: View
    parts: tuple


ENLARGED = (
    Enlarged("Buddha", View(direction=(0.2, 0.15, 1.0)),
             (("face", (0.0, 0.25, 0.2), 0.16), ("paw", (-0.12, -0.4, 0.3), 0.12))),
    Enlarged("BU", View(direction=(0.1, -1.0, 0.1), up=(0, 0, 1)),
             (("forehead", (0.0, -0.3, 0.2), 0.17), ("mouth", (0.0, -0.3, -0.15), 0.14))),
)


def figure_6(lab):
    title, full = lab.library.title("Armadillo"), lab.library.cloud("Armadillo")
    sparse = full.random_subset(int(SPARSE_SHARE * len(full)), lab.library.random("sparse"))
    fine_settings = lab.library.settings("Armadillo")
    coarse_grid = lab.library.grid(COARSE_GRID)
    coarse = lab.record(f"{title}, coarse grid {coarse_grid}",
                        fit(full, fine_settings.but(grid=coarse_grid)))
    fine = lab.record(f"{title}, 30 % of the points, fine grid {fine_settings.grid}",
                      fit(sparse, fine_settings))
    sheet = Sheet(1, 4, TILE_SIZE)
    for column, (letter, cloud) in enumerate((("a", full), ("b", sparse))):
        sheet.tile(0, column, f"({letter}) {len(cloud)} points",
                   [points_actor(facing(cloud, ARMADILLO_VIEW), BLUE)], ARMADILLO_VIEW)
    sheet.tile(0, 2, f"(c) from (a), grid {coarse_grid}\u00b3", [surface_actor(coarse.contour)],
               ARMADILLO_VIEW)
    sheet.tile(0, 3, f"(d) from (b), grid {fine_settings.grid}\u00b3",
               [surface_actor(fine.contour)], ARMADILLO_VIEW)
    lab.note_on_meshes("(d) shows more of the plates and scales than (c), and its rims are rough: "
                       "the points of (b) lie two knot spacings apart")
    return sheet


def figure_7(lab):
    cloud = lab.library.cloud("Gyroid")
    made = lab.record("gyroid", lab.standard_fit("Gyroid"), closed=False)
    sheet = Sheet(1, 3, TILE_SIZE)
    # The white surface hides the points behind it.
    sheet.tile(0, 0, f"(a) gyroid, {len(cloud)} points",
               [surface_actor(made.contour, WHITE), points_actor(cloud.points, BLUE)],
               GYROID_VIEW)
    sheet.tile(0, 1, "(b) surface", [surface_actor(made.contour)], GYROID_VIEW)
    sheet.tile(0, 2, "(c) with the points", [surface_actor(made.contour),
                                             points_actor(cloud.points, RED, size=1)], GYROID_VIEW)
    return sheet


def figure_8(lab):
    sheet = Sheet(len(ENLARGED), 3, TILE_SIZE)
    for row, model in enumerate(ENLARGED):
        title = lab.library.title(model.name)
        made = lab.record(title, lab.standard_fit(model.name))
        sheet.tile(row, 0, title, [surface_actor(made.contour)], model.view)
        for column, (part, centre, half_height) in enumerate(model.parts, start=1):
            sheet.tile(row, column, part, [surface_actor(made.contour)],
                       replace(model.view, centre=centre, half_height=half_height))
    return sheet
