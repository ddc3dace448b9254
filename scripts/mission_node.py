#!/usr/bin/env python3
from roomba_ros.mission.mission_node import main

main()
