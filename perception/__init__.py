"""From pictures to frames: what stands where on the table, and how sure that is."""

from perception.board import Board as Board
from perception.board import BoardView as BoardView
from perception.board import find_board as find_board
from perception.calibration import FEWEST_VIEWS as FEWEST_VIEWS
from perception.calibration import CameraCalibration as CameraCalibration
from perception.calibration import LensCalibration as LensCalibration
from perception.calibration import calibrate_camera as calibrate_camera
from perception.calibration import calibrate_lens as calibrate_lens
from perception.detector import Detector as Detector
from perception.detector import detect as detect
from perception.detector import detector_for as detector_for
from perception.feature_detector import FeatureDetector as FeatureDetector
from perception.markers import MarkerDetector as MarkerDetector
from perception.reference import learn_appearance as learn_appearance
from perception.shape_detector import ShapeDetector as ShapeDetector
