"""Paths to trajectories: joint paths, limits and timing."""

from cobot_lfd.motion.limit_check import LimitRatios as LimitRatios
from cobot_lfd.motion.limit_check import check_limits as check_limits
from cobot_lfd.motion.limit_check import limit_ratios as limit_ratios
from cobot_lfd.motion.limits import JointLimits as JointLimits
from cobot_lfd.motion.path import JointPath as JointPath
from cobot_lfd.motion.timing import TimingMethod as TimingMethod
from cobot_lfd.motion.timing import move as move
from cobot_lfd.motion.timing import time_path as time_path
from cobot_lfd.motion.trajectory import JointSamples as JointSamples
from cobot_lfd.motion.trajectory import JointTrajectory as JointTrajectory
