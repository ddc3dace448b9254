"""The web page: shows a robot and its home to any number of viewers, and passes on wishes."""
