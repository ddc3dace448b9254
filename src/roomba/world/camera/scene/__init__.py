"""What there is to see: surfaces, their textures, and light."""
