"""Valetudo's map format (``ValetudoMap``, version 2; version 1 is read as well): a home in JSON.

Its pixels are counted from the upper left corner, ``y`` downwards; a layer has them as runs, x, y
and count. Entities have whole cm from that corner; their angles are degrees, 0 up, clockwise. The
source is Valetudo's ``backend/lib/entities/map``, with the schemas in its folder ``doc``.

Files that were written here name the map's own corner (``metaData.origin``, m), so that they come
back in the same frame. Other maps are cut to what they show, and begin at their station; the
seams and doorways that some robots leave out (:mod:`roomba.raster.seams`) are floor.
"""
