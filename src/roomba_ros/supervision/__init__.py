"""The robot's processes: started, watched, started anew, ended."""
