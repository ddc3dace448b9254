"""The compiled step of the world: one file for each part of it, :mod:`.step_kernels` composes."""
