"""The robot's camera: scenes, and compiled kernels that draw them."""
