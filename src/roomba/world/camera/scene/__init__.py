"""The scene of the camera: surfaces, their textures, and light."""
