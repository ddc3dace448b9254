"""A home as it is: walls, furniture, materials, what moves, dirt."""
