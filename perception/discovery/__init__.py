"""From pictures of demonstrations to things that can be found again: no object list, no training."""

from perception.discovery.describe import Description as Description
from perception.discovery.describe import describe as describe
from perception.discovery.frames import recognise_frames as recognise_frames
from perception.discovery.match import Kind as Kind
from perception.discovery.match import match as match
from perception.discovery.merge import Motion as Motion
from perception.discovery.merge import Track as Track
from perception.discovery.merge import base_track as base_track
from perception.discovery.merge import merge as merge
from perception.discovery.names import names_of as names_of
from perception.discovery.propose import Thing as Thing
from perception.discovery.propose import propose as propose
from perception.discovery.recognise import recognise as recognise
from perception.discovery.texture import textured as textured
