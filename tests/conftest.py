"""The project's own end-to-end tests use the fixtures that the package brings for everybody's."""

pytest_plugins = ["cobot_lfd.app.pytest_plugin", "pytester"]
