"""ROS programs of the benchmarks: they run inside a graph of their own."""
