"""Which frames have a direction that matters: the paper's criteria, and the bearing likelihood ratio."""
