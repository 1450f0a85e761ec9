# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the results."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402; after the choice of what it draws with
from matplotlib import ticker  # noqa: E402

from .tables import geometric_mean  # noqa: E402

RED = 3  # of the colours of tab10
OURS_COLOUR = plt.get_cmap("tab10").colors[RED]


def _styles(names, ours):
    """Colour and marker by name; ours are red."""
    marks = "osD^v<>PX*d"
    others = [colour for k, colour in enumerate(plt.get_cmap("tab10").colors) if k != RED]
    return {name: (OURS_COLOUR if name in ours else others[k % len(others)], marks[k % len(marks)])
            for k, name in enumerate(names)}


def _tidy(ax):
    """Plain numbers at 1, 2 and 5 times the powers of ten."""
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(ticker.NullLocator())
    ax.grid(True, alpha=0.3)
    ax.tick_params(labelsize=7)


def _save(figure, path):
    figure.savefig(path, dpi=110, bbox_inches="tight")
    plt.close(figure)


def comparison(report, ours, folder):
    """comparison-clouds.png: error against time on each cloud; comparison-ratios.png: all clouds."""
    names = [job.name for job in report.jobs]
    styles = _styles(names, ours)
    columns = (len(report.clouds) + 1) // 2
    figure, axes = plt.subplots(2, columns, figsize=(3 * columns, 6.4), squeeze=False)
    # A cloud and its noisy variant below each other.
    for ax, cloud in zip(axes.T.flat, report.clouds):
        for job in report.jobs:
            one = report.results[cloud["name"], job.name]
            if "chamfer" in one.quality:
                colour, mark = styles[job.name]
                ax.loglog(one.run.cpu, one.quality["chamfer"], mark, color=colour, label=job.name)
        ax.set_title(f"{cloud['name']} ({cloud['points']} points)", fontsize=9)
        _tidy(ax)
    for ax in axes.T.flat[len(report.clouds):]:
        ax.set_visible(False)
    for ax in axes[:, 0]:
        ax.set_ylabel("chamfer distance, % of diagonal", fontsize=8)
    for ax in axes[-1]:
        ax.set_xlabel("processor time, s", fontsize=8)
    handles = {}
    for ax in axes.flat:
        handles.update({label: line for line, label in zip(*ax.get_legend_handles_labels())})
    figure.tight_layout()
    figure.legend(handles.values(), handles.keys(), loc="upper center", ncol=4, fontsize=8,
                  bbox_to_anchor=(0.5, 0.0))
    _save(figure, folder / "comparison-clouds.png")

    figure, axes = plt.subplots(1, 3, figsize=(13, 0.36 * len(names) + 1.2), sharey=True)
    for ax, (title, value) in zip(axes, report.quantities().items()):
        means = [geometric_mean(report.ratio(cloud, job, value) for cloud in report.clouds)
                 for job in report.jobs]
        ax.barh(names, [mean or 0 for mean in means], color=[styles[name][0] for name in names])
        for k, mean in enumerate(means):
            ax.text(mean or 0, k, f" {mean:.2g}" if mean else " –", va="center", fontsize=8)
        ax.set_title(f"{title}, times ours", fontsize=9)
        ax.set_xlim(0, 1.15 * max(filter(None, means), default=1))
        ax.axvline(1, color="grey", linewidth=0.8)
        ax.tick_params(labelsize=8)
    axes[0].invert_yaxis()
    figure.tight_layout()
    _save(figure, folder / "comparison-ratios.png")


def scaling(measurements, folder):
    """scaling.png: cost against points and against cells."""
    figure, axes = plt.subplots(2, len(measurements), figsize=(5.2 * len(measurements), 7),
                                squeeze=False)
    for column, (label, runs) in zip(axes.T, measurements.items()):
        runs = [one for one in runs if not one.failure]
        stages = [stage["stage"] for stage in runs[0].one.stages][1:] if runs else []
        for k, stage in enumerate(stages):
            column[0].loglog(
                [one.size for one in runs],
                [max(1e-3, one.cpu_of(stage)) for one in runs], "o-", color=plt.get_cmap("tab10").colors[k], label=stage)
        column[0].loglog([one.size for one in runs], [one.one.wall for one in runs], "s--",
                         color="black", label="wall, 1 thread")
        column[0].loglog([one.size for one in runs], [one.two.wall for one in runs], "D:",
                         color="grey", label="wall, 2 threads")
        column[0].set_ylabel("s", fontsize=8)
        column[0].legend(fontsize=7)
        column[1].loglog([one.size for one in runs], [one.one.peak_mb for one in runs], "o-",
                         color=OURS_COLOUR)
        column[1].set_ylabel("peak memory, MB", fontsize=8)
        for ax in column:
            ax.set_xlabel(label, fontsize=8)
            _tidy(ax)
            ax.set_xticks([one.size for one in runs])
    figure.tight_layout()
    _save(figure, folder / "scaling.png")
