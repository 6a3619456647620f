"""The paper's kinds of figures, drawn with our methods on made-up tasks.

python tools/paper_figures.py --out docs
"""

import argparse
import warnings
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Ellipse

from cobot_lfd.arrays import Array
from cobot_lfd.frame import Frame
from cobot_lfd.learning.data import Scenes, collect, stack_scenes
from cobot_lfd.learning.experiments.synthetic import TASKS, demonstrations, draw_scene, planar, true_path
from cobot_lfd.learning.mixtures.encoding import MixtureEncoding
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.learning.product.directions import nearest_directions
from cobot_lfd.learning.product.frame_product import FrameProduct
from cobot_lfd.learning.product.information import oriented_means

COLOURS = {"start": "tab:pink", "end": "tab:green"}
METHODS = {"conventional": "conventional", "paper": "paper's method", "improved": "this product"}
PAGE = """# The paper's figures, drawn anew

Made by `python tools/paper_figures.py`; frames with a slot are drawn as a stroke along it, the start in pink
and the end in green. The numbers are in [paper_tables.md](paper_tables.md).

Demonstrations of the three tasks (the paper's Fig. 18):

![demonstrations](figures/demonstrations.png)

Task 2 seen from each frame, with the mixture's Gaussians (Fig. 7):

![gaussians](figures/gaussians.png)

Distance to the orientation-less frame with its ring Gaussians, and rings at three times (Figs. 15, 16):

![rings](figures/rings.png)

Rings and the Gaussians that stand for them in a new scene (Fig. 17):

![conversion](figures/conversion.png)

Paths in five new scenes (Table 3); the truth is dotted, the shade is two standard deviations:

![reproductions](figures/reproductions.png)
"""


def draw_frame(axes: Axes, name: str, frame: Frame, *, oriented: bool) -> None:
    """A dot, and a stroke along the slot."""
    colour = COLOURS[name]
    axes.plot(*frame.position, "o", color=colour, ms=4)
    if oriented:
        tip = frame.apply(np.array([0.2, 0.0]))
        axes.plot(*np.stack([frame.position, tip]).T, color=colour, lw=4, alpha=0.6)


def draw_gaussian(
    axes: Axes, mean: Array, covariance: Array, colour: str | tuple[float, ...], alpha: float = 0.35
) -> None:
    """The ellipse of two standard deviations."""
    values, vectors = np.linalg.eigh(covariance)
    angle = np.degrees(np.arctan2(vectors[1, 1], vectors[0, 1]))
    width, height = 4 * np.sqrt(values[::-1])
    axes.add_patch(Ellipse((mean[0], mean[1]), width, height, angle=angle, color=colour, alpha=alpha, lw=0))


def demonstrations_figure() -> Figure:
    """The demonstrations of Tasks 1-3."""
    figure, rows = plt.subplots(1, 3, figsize=(12, 4), sharey=True)
    for axes, (number, task) in zip(rows, TASKS.items(), strict=True):
        for demo in demonstrations(task, 6, np.random.default_rng(number)):
            axes.plot(*demo.path.T, color="0.4", lw=1)
            for name, frame in demo.frames.items():
                if isinstance(frame, Frame):
                    draw_frame(axes, name, frame, oriented=task.kinds[name])
        axes.set(title=f"Task {number}", aspect="equal")
    return figure


def mixture_model(seed: int = 2) -> tuple[TaskParameterisedGMM, MixtureEncoding, FrameProduct]:
    """The paper's method on Task 2."""
    demos = demonstrations(TASKS[2], 6, np.random.default_rng(seed))
    model = TaskParameterisedGMM.fit(demos, method="paper")
    if not (
        isinstance(model.generator, FrameProduct) and isinstance(model.generator.encoding, MixtureEncoding)
    ):
        raise TypeError("the paper's method keeps mixtures.")
    return model, model.generator.encoding, model.generator


def gaussians_figure() -> Figure:
    """The paths seen from each frame, with the mixture."""
    _, encoding, _ = mixture_model()
    data = collect(demonstrations(TASKS[2], 6, np.random.default_rng(2)))
    figure, rows = plt.subplots(1, 2, figsize=(9, 4))
    for j, (axes, name) in enumerate(zip(rows, data.names, strict=True)):
        for path in data.local[:, j]:
            axes.plot(*path.T, color="0.5", lw=0.8)
        for k in range(len(encoding.mixture.weights)):
            mean, covariance = encoding.mixture.means[k, j, 1:], encoding.mixture.covariances[k, j, 1:, 1:]
            draw_gaussian(axes, mean, covariance, f"C{k}")
        draw_frame(axes, name, Frame(np.zeros(2), 0.0), oriented=TASKS[2].kinds[name])
        axes.set(title=f"seen from '{name}'", aspect="equal")
    return figure


def rings_figure() -> Figure:
    """Radius over time, and rings."""
    _, encoding, _ = mixture_model()
    data = collect(demonstrations(TASKS[2], 6, np.random.default_rng(2)))
    profile = encoding.profile(data.times)
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4))
    for path in data.local[:, 1]:
        left.plot(data.times, np.linalg.norm(path, axis=-1), color="0.5", lw=0.8)
        right.plot(*path.T, color="0.5", lw=0.8)
    deviation = np.sqrt(profile.radius_variance[1])
    low, high = profile.radius[1] - 2 * deviation, profile.radius[1] + 2 * deviation
    left.fill_between(data.times, np.maximum(low, 0), high, color="C0", alpha=0.3)
    left.plot(data.times, profile.radius[1], color="C0")
    left.set(title="distance to 'end'", xlabel="time", ylabel="r [m]")
    for i, step in enumerate((60, 120, 180)):
        for radius in (profile.radius[1, step] - deviation[step], profile.radius[1, step] + deviation[step]):
            right.add_patch(Circle((0, 0), max(radius, 0.0), fill=False, color=f"C{i}", lw=1.5))
    draw_frame(right, "end", Frame(np.zeros(2), 0.0), oriented=False)
    right.set(title="rings at 30, 60 and 90 % of the time", aspect="equal")
    return figure


def conversion_figure() -> Figure:
    """Rings in a new scene, and what stands for them."""
    model, encoding, generator = mixture_model()
    frames = planar(draw_scene(TASKS[2], np.random.default_rng(5)))
    scenes: Scenes = stack_scenes([frames], model.used_frames)
    times = np.linspace(0, 1, 9)
    profile = encoding.profile(times)
    means = oriented_means(profile, scenes)
    figure, axes = plt.subplots(figsize=(6, 5))
    if not generator.oriented[1]:
        directions = nearest_directions(scenes, means, generator.oriented, 1)
        for t in range(2, 8):
            colour = plt.get_cmap("viridis")(t / 8)
            centre = scenes.positions[0, 1] + profile.radius[1, t] * directions[0, :, t]
            axes.add_patch(
                Circle(tuple(scenes.positions[0, 1]), profile.radius[1, t], fill=False, color=colour, lw=1)
            )
            draw_gaussian(axes, centre, profile.radius_variance[1, t] * np.eye(2), colour)
            axes.plot(*means[0, 0, :, t], "+", color=colour)
    for name, frame in frames.items():
        draw_frame(axes, name, frame, oriented=TASKS[2].kinds[name])
    axes.set(title="rings of 'end', their stand-ins, means of 'start' (+)", aspect="equal")
    return figure


def reproductions_figure() -> Figure:
    """The three methods on the three tasks."""
    figure, rows = plt.subplots(3, 3, figsize=(12, 12), sharex=True, sharey=True)
    for i, (number, task) in enumerate(TASKS.items()):
        rng = np.random.default_rng(number)
        demos = demonstrations(task, 6, rng)
        scenes = [draw_scene(task, rng) for _ in range(5)]
        for j, (method, title) in enumerate(METHODS.items()):
            axes = rows[i, j]
            model = TaskParameterisedGMM.fit(demos, method=method)
            for scene in scenes:
                frames = planar(scene)
                path = model.reproduce(frames)
                for t in range(0, 200, 10):
                    draw_gaussian(axes, path.mean[t], path.covariance[t], "C0", alpha=0.06)
                axes.plot(*true_path(task, scene).T, ":", color="0.3", lw=1)
                axes.plot(*path.mean.T, color="C0", lw=1.5)
                for name, frame in frames.items():
                    draw_frame(axes, name, frame, oriented=task.kinds[name])
            axes.set(title=f"Task {number}, {title}", aspect="equal", xlim=(-1.3, 1.3), ylim=(-1.2, 1.2))
    return figure


def main() -> int:
    """Draw all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--out", type=Path, default=Path("docs"), help="folder of the page")
    options = parser.parse_args()
    warnings.filterwarnings("ignore", message="component", category=UserWarning)
    folder = options.out / "figures"
    folder.mkdir(parents=True, exist_ok=True)
    figures = {
        "demonstrations": demonstrations_figure,
        "gaussians": gaussians_figure,
        "rings": rings_figure,
        "conversion": conversion_figure,
        "reproductions": reproductions_figure,
    }
    for name, draw in figures.items():
        figure = draw()
        figure.tight_layout()
        figure.savefig(folder / f"{name}.png", dpi=70)
        plt.close(figure)
        print(f"written: {folder / name}.png")
    (options.out / "paper_figures.md").write_text(PAGE, encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
