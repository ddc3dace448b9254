#!/usr/bin/env python3
from roomba_ros.turn_camera_service import main

main()
