"""The robot looked for on the map: near a guess, or everywhere."""
