"""The arms: their descriptions, and the arm in the simulation."""

from cobot_lfd.quiet import import_quietly

import_quietly("pybullet")

from robots.arm import Arm as Arm
from robots.arm import ArmState as ArmState
from robots.collision import CollisionCheck as CollisionCheck
from robots.collision import thinned as thinned
from robots.compose import has_urdf as has_urdf
from robots.description import RobotDescription as RobotDescription
from robots.description import load_robot as load_robot
from robots.description import robot_names as robot_names
from robots.description import tool_names as tool_names
from robots.kinematics import CollisionError as CollisionError
from robots.kinematics import JointLimitError as JointLimitError
from robots.kinematics import Kinematics as Kinematics
from robots.kinematics import KinematicsError as KinematicsError
from robots.kinematics import NotConvergedError as NotConvergedError
