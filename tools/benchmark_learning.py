"""How fast learning and generating are, beside scikit-learn's mixture on the same data in the same run.

    OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python tools/benchmark_learning.py

Both fits get the same data, the same time-based start and the same tolerance; the best of some runs counts.
"""

import argparse
import os
import time
import tracemalloc
import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from sklearn.mixture import GaussianMixture

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import TaskData, collect
from cobot_lfd.learning.experiments.synthetic import TASKS, SyntheticTask, demonstrations, draw_scene, planar
from cobot_lfd.learning.mixtures.em import EMSettings, fit_mixture
from cobot_lfd.learning.model import TaskParameterisedGMM

TOL = 1e-4
REG_COVAR = 1e-6


def best_time(work: Callable[[], object], repetitions: int) -> float:
    """Shortest wall-clock time of some runs [s]."""
    times = []
    for _ in range(repetitions):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def stacked(data: TaskData) -> Array:
    """[t, local points of all frames] of every sample."""
    local = np.moveaxis(data.local, 1, 2)
    n, t = local.shape[:2]
    return np.concatenate([np.tile(data.times, n)[:, None], local.reshape(n * t, -1)], axis=1)


def task_with(n_frames: int) -> SyntheticTask:
    """A task with two to four frames."""
    return replace(TASKS[2], via=n_frames > 2, irrelevant=n_frames > 3)


def compare_fits(n: int, t: int, n_frames: int, k: int, repetitions: int) -> None:
    """Fit one data set with both."""
    data = collect(demonstrations(task_with(n_frames), n, np.random.default_rng(0), t))
    flat = stacked(data)
    labels = np.tile(np.arange(t) * k // t, n)
    parts = [flat[labels == i] for i in range(k)]
    scale = float(np.var(flat[:, 1:], axis=0).mean())

    def theirs() -> GaussianMixture:
        covariances = [np.cov(p.T, bias=True) + REG_COVAR * scale * np.eye(flat.shape[1]) for p in parts]
        return GaussianMixture(
            k,
            tol=TOL,
            max_iter=200,
            reg_covar=REG_COVAR * scale,
            weights_init=[len(p) / len(flat) for p in parts],
            means_init=[p.mean(axis=0) for p in parts],
            precisions_init=[np.linalg.inv(c) for c in covariances],
        ).fit(flat)

    settings = EMSettings(k, tol=TOL, max_iter=200, reg_covar=REG_COVAR)
    local, times = data.local, data.times
    ours_time = best_time(lambda: fit_mixture(local, times, settings), repetitions)
    theirs_time = best_time(theirs, repetitions)
    rounds = fit_mixture(local, times, settings).n_iterations
    print(
        f"fit N={n} T={t} J={n_frames} K={k}: {1e3 * ours_time:.1f} ms ({rounds} iterations), scikit-learn "
        f"{1e3 * theirs_time:.1f} ms ({theirs().n_iter_} iterations), ratio {ours_time / theirs_time:.2f}"
    )


def generating(repetitions: int) -> None:
    """The default method: its fit, one scene, a thousand scenes."""
    rng = np.random.default_rng(0)
    demos = demonstrations(TASKS[1], 6, rng)
    print(f"default fit, two frames: {best_time(lambda: TaskParameterisedGMM.fit(demos), 3):.3f} s")
    three = demonstrations(task_with(4), 6, rng)
    print(f"default fit, four frames: {best_time(lambda: TaskParameterisedGMM.fit(three), 3):.3f} s")
    scenes = [planar(draw_scene(TASKS[1], rng)) for _ in range(1000)]
    for method in ("improved", "paper", "conventional"):
        model = TaskParameterisedGMM.fit(demos, method=method)
        one = best_time(partial(model.reproduce, scenes[0]), 20 * repetitions)
        many = best_time(partial(model.reproduce_many, scenes), repetitions)
        print(f"{method}: one scene {1e3 * one:.3f} ms, 1000 scenes {1e3 * many:.1f} ms")


def growth() -> None:
    """Time and memory of the fit over N T."""
    for samples in (10_000, 100_000, 1_000_000):
        data = collect(demonstrations(TASKS[2], 10, np.random.default_rng(0), samples // 10))
        local, times = data.local, data.times
        settings = EMSettings(4, tol=0, max_iter=10)
        seconds = best_time(partial(fit_mixture, local, times, settings), 2)
        tracemalloc.start()
        fit_mixture(local, times, settings)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        print(f"N T = {samples}: ten iterations {seconds:.3f} s, peak memory {peak / 2**20:.0f} MiB")


def main() -> int:
    """Run all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--repetitions", type=int, default=5)
    options = parser.parse_args()
    if os.environ.get("OMP_NUM_THREADS") != "1":
        print("note: OMP_NUM_THREADS is not 1, so numpy may use several threads")
    warnings.simplefilter("ignore")
    compare_fits(6, 200, 2, 4, options.repetitions)
    compare_fits(20, 1000, 4, 8, max(2, options.repetitions // 2))
    generating(options.repetitions)
    growth()
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
