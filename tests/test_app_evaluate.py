"""Evaluation of real episodes: a result depends on its trial only; options say what is tried."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import scenes
from cobot_lfd.app.commands.evaluate import evaluate
from cobot_lfd.app.demonstrations.store import load_demonstrations, load_episode
from cobot_lfd.app.evaluation.contender import Contender, fit_method, learnt
from cobot_lfd.app.evaluation.demonstration_bytes import demonstrations_from_bytes, demonstrations_to_bytes
from cobot_lfd.app.evaluation.measures import hand_path, measures_beside
from cobot_lfd.app.evaluation.options import PlanOptions
from cobot_lfd.app.evaluation.perform import bench_of, perform
from cobot_lfd.app.evaluation.perturbation import Perturbation, Sweep
from cobot_lfd.app.evaluation.plan import Plan, fingerprints
from cobot_lfd.app.evaluation.run import Where, run
from cobot_lfd.app.perceive import View
from cobot_lfd.app.provenance import Provenance
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.app.run_folder import RunFolder
from cobot_lfd.camera_file import save_camera
from cobot_lfd.errors import CobotError, DataError, DescriptionError, ModelError
from cobot_lfd.outcome import Outcome
from cobot_lfd.pose import Pose
from scenes import load_scene
from tests.app_examples import detection
from tests.evaluation_examples import sweep_demonstrations

pytestmark = pytest.mark.simulator

SCENE = load_scene("pick_and_place")


@pytest.fixture(scope="module")
def plan(model_file: Path, demonstrations_folder: Path) -> Plan:
    """A good and a bad contender in one scene: two trials."""
    options = PlanOptions(
        models=(model_file,),
        scene=("pick_and_place",),
        method=("world-gmr",),
        demos=demonstrations_folder,
        episodes=1,
        seed=1000,
    )
    return options.plan()


@pytest.fixture(scope="module")
def folder(plan: Plan, tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    """The plan, run in two processes."""
    path = tmp_path_factory.mktemp("evaluation") / "run"
    folder = RunFolder.create(path, plan, Provenance.collect(seeds=plan.seeds, options={}))
    run(folder, Where(workers=2))
    return folder


def test_results_do_not_depend_on_where_episodes_run(folder: RunFolder) -> None:
    here = [perform(trial).result.comparable_json() for trial in reversed(list(folder.plan.trials()))]
    assert [result.comparable_json() for result in folder.results()] == here[::-1]


def test_the_contenders_are_told_apart(folder: RunFolder) -> None:
    good, bad = folder.results()
    assert (good.contender, good.verdict.outcome) == ("model.npz", Outcome.SUCCESS)
    assert (bad.contender, bad.verdict.succeeded) == ("world-gmr", False)
    assert good.metrics["d_end"] < 0.02 < bad.metrics["d_end"]  # [m]
    assert (good.metrics["reachability"], bad.metrics["reachability"]) == (100.0, 0.0)


def test_an_episode_can_be_filmed(plan: Plan) -> None:
    """Even one that ends before the arm moves has a picture."""
    trial = replace(plan.trial(0), perturbation=Perturbation(covered=True))
    failed = perform(trial, film_failures=True)
    assert failed.video.startswith(b"\x1aE\xdf\xa3")  # how a WebM file begins
    assert failed.picture[8:12] == b"WEBP"


def test_trials_are_the_cross_product_and_their_seeds_vary_slowest() -> None:
    contenders = tuple(Contender(name, "line", b"") for name in "ab")
    perturbations = Sweep(detection_noise_mm=(0.0, 5.0), friction=(1.0, 0.5)).perturbations()
    trials = list(
        Plan.of(
            scenes=("pick_and_place",),
            robots=("panda",),
            contenders=contenders,
            perturbations=perturbations,
            seeds=range(3),
        ).trials()
    )
    assert len(trials) == len(set(trials)) == 2 * 4 * 3
    assert [trial.number for trial in trials] == list(range(24))
    assert [trial.seed for trial in trials] == sorted(trial.seed for trial in trials)


def test_a_run_is_known_by_all_that_decides_its_results(plan: Plan) -> None:
    changes: list[dict[str, Any]] = [
        {"seeds": range(1000, 1002)},
        {"perturbations": (Perturbation(friction=0.5),)},
        {"contenders": (replace(plan.contenders[0], content=b"other"), plan.contenders[1])},
        {"fingerprints": {"scene pick_and_place": "other"}},
    ]
    assert len({plan.run, *(replace(plan, **change).run for change in changes)}) == 5
    assert replace(plan).run == plan.run


def test_demonstrations_keep_every_bit(demonstrations_folder: Path) -> None:
    before = load_demonstrations(demonstrations_folder)
    after = demonstrations_from_bytes(demonstrations_to_bytes(before))
    assert demonstrations_to_bytes(after) == demonstrations_to_bytes(before)
    assert_allclose(after[3].path, before[3].path, rtol=0, atol=0)


def test_the_hand_in_the_measures_is_the_hand_that_demonstrates(demonstrations_folder: Path) -> None:
    """The recorded path follows what the hand wants, as closely as a compliant arm can."""
    episode = load_episode(demonstrations_folder / "episode_000000.h5")
    frames = {seen.name: seen.frame for seen in episode.detections}
    wanted = hand_path(SCENE, frames, episode.seed)
    recorded = episode.demonstration().path
    wanted = wanted[np.linspace(0, len(wanted) - 1, len(recorded)).round().astype(int)]
    assert np.linalg.norm(recorded - wanted, axis=1).max() < 0.02  # [m]


def test_a_path_beside_itself_is_reached_and_nowhere_apart() -> None:
    path = np.column_stack([np.linspace(0.0, 1.0, 50), np.zeros(50)])
    measures = measures_beside(path, path)
    assert measures["d_total"] == measures["sharp_edges"] == measures["turns"] == 0.0
    assert (measures["reachability"], measures["efficiency"]) == (100.0, 1.0)
    shifted = measures_beside(path + np.array([0.0, 0.04]), path)
    assert_allclose([shifted["d_total"], shifted["d_start"], shifted["d_end"]], 0.04)
    half = measures_beside(np.vstack([path[:25], path[:25] + 1.0]), path)
    assert half["reachability"] == 50.0


@pytest.mark.parametrize("method", ["line", "dmp", "world-gmr", "improved", "conventional"])
def test_every_method_learns_and_leads(method: str) -> None:
    demonstrations = sweep_demonstrations()
    model = fit_method(method, demonstrations)
    path = model.reproduce(demonstrations[0].frames).mean
    assert path.shape == (len(path), 2)
    assert np.isfinite(path).all()
    assert_allclose(model.reproduce(demonstrations[0].frames).mean, path, rtol=0, atol=0)


@pytest.mark.parametrize("method", ["line", "dmp"])
def test_baselines_with_frames_reach_start_and_end(method: str) -> None:
    demonstrations = sweep_demonstrations()
    frames = sweep_demonstrations(6)[-1].frames
    path = fit_method(method, demonstrations).reproduce(frames).mean
    assert_allclose(path[0], frames["a"].apply([0.05, 0.0]), atol=0.03)  # [m]
    assert_allclose(path[-1], frames["b"].position, atol=0.03)  # [m]


class Unreliable:
    """Somebody's method, with an fit that returns nothing and a reproduce that fails."""

    def fit(self, _: object) -> None:
        """Learn nothing."""

    def reproduce(self, _: object) -> list[float]:
        """Return what is no path."""
        return [1.0, 2.0]


def test_somebodys_method_is_found_and_its_faults_are_those_of_a_model() -> None:
    demonstrations = sweep_demonstrations()
    model = fit_method("tests.test_app_evaluate:Unreliable", demonstrations)
    with pytest.raises(
        ModelError, match=r"Unreliable raised ValueError: reproduce returned an array of shape"
    ):
        model.reproduce(demonstrations[0].frames)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("imroved", "no method named 'imroved'; choose one of: improved, paper"),
        ("nowhere.at_all:Method", "cannot find the method 'nowhere.at_all:Method'"),
        ("tests.test_app_evaluate:SCENE", "has no fit"),
    ],
)
def test_a_method_that_is_none_is_told(name: str, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        fit_method(name, sweep_demonstrations())


def test_the_number_of_demonstrations_is_a_perturbation() -> None:
    contender = Contender("line", "line", demonstrations_to_bytes(sweep_demonstrations()))
    few = learnt(contender, 2).reproduce(sweep_demonstrations()[0].frames).mean
    assert not np.allclose(few, learnt(contender).reproduce(sweep_demonstrations()[0].frames).mean)
    with pytest.raises(DataError, match="6 demonstrations are to be used and there are 5"):
        learnt(contender, 6)
    with pytest.raises(DataError, match="is fitted already"):
        learnt(Contender("model.npz", None, b""), 3)


def test_a_perturbed_scene_differs_where_it_was_asked_to() -> None:
    assert Perturbation().of_scene(SCENE) == SCENE
    harder = Perturbation(friction=0.5, range=1.2, camera_noise=4.0, light=0.5, distractors=3).of_scene(SCENE)
    assert harder.distractors == 3
    cube, before = harder.objects["cube"], SCENE.objects["cube"]
    assert cube.friction == 0.5 * before.friction
    assert_allclose(np.ptp(cube.place.x), 1.2 * np.ptp(before.place.x))
    assert_allclose(np.mean(cube.place.x), np.mean(before.place.x))
    assert harder.camera.sensor.noise == 4.0
    assert harder.light.ambient == 0.5 * SCENE.light.ambient
    turned = Perturbation(light_turn_deg=90.0).of_scene(SCENE).light.direction
    x, y, z = SCENE.light.direction
    assert_allclose(turned, (-y, x, z), atol=1e-12)


def test_the_arms_manner_is_a_perturbation(plan: Plan) -> None:
    manners = Sweep(compliant=(False, True), timing=("near_optimal",)).perturbations()
    assert [manner.label for manner in manners] == [
        "timing near_optimal",
        "compliant 1, timing near_optimal",
    ]
    bench = bench_of(replace(plan.trial(0), perturbation=manners[1]))
    assert bench.timing == "near_optimal"
    assert bench.compliance is not None


def test_detection_noise_has_the_size_that_is_asked_for() -> None:
    seen = detection()
    view = View(np.zeros((2, 2, 3), np.uint8), (seen,), (), (seen,))
    noise = Perturbation(detection_noise_mm=3.0, detection_noise_deg=2.0)
    frames = [noise.of_view(view, seed).detections[0].frame for seed in range(2000)]
    shifts = np.array([frame.position - seen.frame.position for frame in frames])
    assert_allclose(shifts.std(axis=0), 0.003, rtol=0.1)  # [m]
    turns = [frame.angle - seen.frame.angle for frame in frames]
    assert_allclose(np.rad2deg(np.std(turns)), 2.0, rtol=0.1)
    assert len(noise.of_view(view, 0).others) == 1
    again = noise.of_view(view, 7).detections[0].frame
    assert_allclose(again.position, frames[7].position, rtol=0, atol=0)


def test_a_covered_lens_ends_every_episode(plan: Plan) -> None:
    trial = replace(plan.trial(0), perturbation=Perturbation(covered=True))
    assert perform(trial).result.verdict.outcome is Outcome.OBJECT_NOT_SEEN
    assert bench_of(trial).covered


def test_a_plan_file_says_what_the_options_say(model_file: Path, tmp_path: Path) -> None:
    file = tmp_path / "plan.toml"
    file.write_text(
        f'models = ["{model_file}"]\nscene = ["pick_and_place"]\nepisodes = 2\nseed = 5\n'
        "[sweep]\ndetection_noise_mm = [0, 2]\ndistractors = [0, 5]\n"
    )
    options = PlanOptions(
        models=(model_file,),
        scene=("pick_and_place",),
        episodes=2,
        seed=5,
        sweep=Sweep(detection_noise_mm=(0.0, 2.0), distractors=(0, 5)),
    )
    assert PlanOptions.read(file).plan() == options.plan()
    save_camera(SCENE.camera.camera, tmp_path / "camera.toml")
    file.write_text('camera = "camera.toml"\n' + file.read_text())
    seen = options.model_copy(update={"camera": tmp_path / "camera.toml"})
    assert PlanOptions.read(file).plan() == seen.plan() != options.plan()
    file.write_text('scene = ["pick_and_place"]\nepisode = 3\n')
    with pytest.raises(DescriptionError, match=r"plan.toml: episode: is no key that is known here"):
        PlanOptions.read(file)


def test_pictures_are_read_by_the_calibrated_camera(model_file: Path, tmp_path: Path) -> None:
    """A camera that stands 10 mm beside where it is believed to sees all 10 mm beside where it is."""
    file, shift = tmp_path / "camera.toml", np.array([0.01, 0.0, 0.0])
    true = SCENE.camera.camera
    pose = Pose(true.world_from_camera.position + shift, true.world_from_camera.rotation)
    save_camera(replace(true, world_from_camera=pose), file)
    options = PlanOptions(models=(model_file,), scene=("pick_and_place",), episodes=1, camera=file)
    seen_by = options.plan()
    read = Plan.from_json(seen_by.to_json(), {c.sha256: c.content for c in seen_by.contenders})
    assert read == seen_by
    assert read.run == seen_by.run != options.model_copy(update={"camera": None}).plan().run
    file.unlink()  # The plan is complete in itself.
    performed = perform(read.trial(0)).result
    assert {round(1e3 * item.position_error) for item in performed.objects} == {10}
    assert EpisodeResult.from_json(performed.to_json()).perturbation == performed.perturbation


def test_another_file_of_a_scenes_camera_is_another_scene(tmp_path: Path) -> None:
    source = (Path(scenes.__file__).parent / "pick_and_place.toml").read_text(encoding="utf-8")
    scene = tmp_path / "mine.toml"
    scene.write_text(source.replace("[camera]", '[camera]\ncalibration = "camera.toml"'), encoding="utf-8")
    camera, told = SCENE.camera.camera, set()
    for matrix in (camera.matrix, camera.matrix * [[1.01], [1.01], [1.0]]):
        save_camera(replace(camera, matrix=matrix), tmp_path / "camera.toml")
        told |= set(fingerprints((str(scene),), ()).values())
    assert len(told) == 2


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"camera": Path("none.toml")}, "none.toml: cannot be read"),
        ({"scene": ("nowhere",)}, "no scene named 'nowhere'"),
        ({"models": (Path("none.npz"),)}, "none.npz"),
        ({"models": ()}, "there is nothing to evaluate"),
        ({"method": ("line",)}, "say where they are: --demos FOLDER"),
        (
            {"sweep": Sweep(distractors=(99,))},
            "--distractors is 99: input should be less than or equal to 20",
        ),
        ({"sweep": Sweep(friction=(0.0,))}, "--friction is 0.0: input should be greater than 0"),
    ],
)
def test_a_mistake_is_told_before_the_first_episode(
    changes: dict[str, object], message: str, model_file: Path
) -> None:
    options = PlanOptions(models=(model_file,), scene=("pick_and_place",), episodes=1)
    with pytest.raises(CobotError, match=message):
        options.model_copy(update=changes).plan()


@pytest.mark.parametrize(
    "beside", [{"seed": 3}, {"episodes": 2}, {"covered": True}, {"sweep": Sweep(light=(2.0,))}]
)
def test_a_plan_file_takes_no_options_beside_it(beside: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(CobotError, match="--plan says what is evaluated; leave out"):
        evaluate(plan=tmp_path / "plan.toml", out=tmp_path / "run", **beside)


def test_the_method_in_the_documentation_learns_and_leads(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (Path(__file__).parents[1] / "docs" / "evaluation.md").read_text(encoding="utf-8")
    code = next(block for block in text.split("```python\n")[1:] if "NearestDemonstration" in block)
    (tmp_path / "nearest.py").write_text(code.split("```")[0])
    monkeypatch.syspath_prepend(tmp_path)
    demonstrations = sweep_demonstrations()
    model = fit_method("nearest:NearestDemonstration", demonstrations)
    for shown in demonstrations:
        assert_allclose(model.reproduce(shown.frames).mean, shown.path, atol=1e-12)
