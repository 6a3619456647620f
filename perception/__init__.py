"""From pictures to frames: what stands where on the table, and how sure that is."""

from perception.markers import Marker as Marker
from perception.markers import detect_markers as detect_markers
from perception.shape_detector import detect as detect
