"""Scenes: a file each, the simulated world that is built from it, and the check of success."""

from cobot_lfd.quiet import import_quietly

import_quietly("pybullet")

from scenes.description import SceneDescription as SceneDescription
from scenes.description import load_scene as load_scene
from scenes.description import scene_names as scene_names
from scenes.in_view import could_be_seen as could_be_seen
from scenes.obstacles import object_obstacle as object_obstacle
from scenes.obstacles import obstacles as obstacles
from scenes.outlines import object_model as object_model
from scenes.outlines import object_models as object_models
from scenes.placement import draw_placements as draw_placements
from scenes.portrait import Portrait as Portrait
from scenes.portrait import take_portrait as take_portrait
from scenes.renderer import Renderer as Renderer
from scenes.success import check_success as check_success
from scenes.task import Task as Task
from scenes.task import YawRule as YawRule
from scenes.variants import variant_names as variant_names
from scenes.view import CameraDescription as CameraDescription
from scenes.world import World as World
from scenes.world import connect as connect
