"""From pictures to frames: what stands where on the table, and how sure that is."""

from perception.shape_detector import detect as detect
