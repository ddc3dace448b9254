"""Computations over any grid of cells: distances, regions, values on another grid."""
