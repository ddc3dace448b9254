"""`./roomba export FILE --to mcap|ros2`: recordings for other programs."""
