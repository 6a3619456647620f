"""Task-parameterised Gaussian mixtures: paths and frames to a model, a model and new frames to a path.

``model`` is the way in, and ``fitting`` tells the steps: ``kinds`` finds out which frames have a direction,
``selection`` which of them count; ``mixtures`` and ``product`` are the paper's method, ``course`` is the
improved one. ``experiments`` compares them.
"""
