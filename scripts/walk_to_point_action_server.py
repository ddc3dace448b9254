#!/usr/bin/env python3
from roomba_ros.walking.walk_to_point_action_server import main

main()
